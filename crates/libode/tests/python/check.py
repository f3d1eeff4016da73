"""What the Python programs share: each prints what it sees, a name and numbers a line."""
import numbers


def flat(value):
    if value is None or isinstance(value, bool):
        yield str(value)
    elif isinstance(value, numbers.Number):
        yield "%.15g" % (value + 0.0)
    elif isinstance(value, (list, tuple)):
        for part in value:
            yield from flat(part)
    else:
        yield type(value).__name__


def show(name, value):
    print(name, *flat(value))


def show_all(name, thing, methods):
    for method in methods.split():
        show(name + "." + method, getattr(thing, method)())


def show_body(name, body):
    show_all(name, body, "getPosition getQuaternion getRotation getLinearVel getAngularVel getForce getTorque")
