"""Geoms, spaces, contacts, heightfields. (pyode is built without meshes.)"""
import ode
from check import show, show_all

COMMON = "placeable isSpace isEnabled getAABB getCategoryBits getCollideBits"


def look(name, geom):
    show_all(name, geom, COMMON)
    if geom.placeable():
        show_all(name, geom, "getPosition getRotation getQuaternion")


def contacts(name, a, b, sort=False):
    found = ode.collide(a, b)
    lines = []
    for contact in found:
        position, normal, depth, first, second = contact.getContactGeomParams()
        lines.append((position, normal, depth, first is a, second is b))
    if sort:
        lines.sort(key=lambda line: [round(x, 5) for x in line[0]])
    show(name + ".count", len(found))
    for line in lines:
        show(name, line)


world = ode.World()
space = ode.HashSpace()
show("levels", space.getLevels())
space.setLevels(-2, 6)
show("levels", space.getLevels())

ball = ode.GeomSphere(space, 0.5)
box = ode.GeomBox(space, (1, 2, 3))
capsule = ode.GeomCapsule(space, 0.3, 1.2)
old_capsule = ode.GeomCCylinder(None, 0.3, 1.2)
cylinder = ode.GeomCylinder(space, 0.4, 1.1)
plane = ode.GeomPlane(space, (0, 0.6, 0.8), 0.3)
ray = ode.GeomRay(space, 10)
box.setPosition((0.2, 0.3, 0.4))
box.setQuaternion((0.9, 0.1, 0.2, 0.3))
ball.setPosition((0.4, 0.2, 1.9))
capsule.setPosition((1.35, 0.3, 0.4))
capsule.setRotation((1, 0, 0, 0, 0, -1, 0, 1, 0))
cylinder.setPosition((-0.7, 0.3, 0.4))
ray.set((0, 0, 5), (0.05, 0.02, -1))
old_capsule.setPosition((0.5, 0.5, 0.1))
shapes = [("ball", ball), ("box", box), ("capsule", capsule), ("cylinder", cylinder), ("plane", plane), ("ray", ray)]
for name, geom in shapes:
    look(name, geom)
show("sizes", [ball.getRadius(), box.getLengths(), capsule.getParams(), old_capsule.getParams(), cylinder.getParams(),
               plane.getParams(), ray.get(), ray.getLength()])
show("depths", [ball.pointDepth((0.1, 0.2, 1.8)), box.pointDepth((0.3, 0.3, 0.5)), capsule.pointDepth((0.8, 0.3, 0.4)),
                old_capsule.pointDepth((0.4, 0.4, 0.1)), plane.pointDepth((1, 2, -3))])
for i, (first, a) in enumerate(shapes):
    for second, b in shapes[i + 1:]:
        # Cylinder and capsule or cylinder, box and cylinder: by their figures in the C tests.
        if "cylinder" in (first, second) and {"capsule", "box"} & {first, second}:
            continue
        contacts(first + "-" + second, a, b)
ball.setRadius(0.7)
box.setLengths((2, 2, 2))
capsule.setParams(0.4, 1)
cylinder.setParams(0.5, 1)
plane.setParams((0, 0, 2), 1)
ray.setLength(4)
show("sizes", [ball.getRadius(), box.getLengths(), capsule.getParams(), cylinder.getParams(), plane.getParams(),
               ray.getLength()])

# Offsets, bits, switches.
body = ode.Body(world)
body.setPosition((1, 2, 3))
box.setBody(body)
show("on body", [box.getBody() is body, box.getPosition(), box.getRotation()])
box.setOffsetPosition((0.1, 0.2, 0.3))
box.setOffsetRotation((0, -1, 0, 1, 0, 0, 0, 0, 1))
show("offset", [box.getPosition(), box.getRotation(), box.getQuaternion()])
box.setOffsetQuaternion((0.8, 0, 0.6, 0))
show("offset", [box.getPosition(), box.getRotation(), box.getQuaternion()])
box.clearOffset()
show("clear", box.getPosition())
box.setBody(None)
box.setCategoryBits(0x5)
box.setCollideBits(0x3)
box.disable()
look("box", box)
box.enable()

# Spaces.
seen = []


def near(data, a, b):
    seen.append(tuple(sorted(names[id(g)] for g in (a, b))))


names = {id(geom): name for name, geom in shapes}
for name, geom in shapes:
    space.remove(geom)
# Not SAPSpace: pyode asks for an axis that is none, and libode then reads beyond its arrays.
for make in (ode.SimpleSpace, ode.HashSpace, lambda: ode.QuadTreeSpace((0, 0, 0), (10, 10, 10), 4)):
    other = make()
    for name, geom in shapes:
        other.add(geom)
    show("space", [other.getNumGeoms(), other.query(ball), other.query(old_capsule), other.getCleanup(),
                   other.getSublevel(), other.isSpace()])
    seen.clear()
    other.collide(None, near)
    show("pairs", len(seen))
    for pair in seen:
        print("pair", *pair)
    seen.clear()
    ode.collide2(ball, other, None, lambda data, a, b: seen.append(names[id(b if a is ball else a)]))
    print("around ball", *sorted(set(seen) - {"ball"}))
    # libode can't count the members of a quadtree.
    if not isinstance(other, ode.QuadTreeSpace):
        show("members", sum(1 for geom in other))
        for i in range(other.getNumGeoms()):
            print("member", names[id(other.getGeom(i))])
    for name, geom in shapes:
        other.remove(geom)

# An old wrapper.
wrapper = ode.GeomTransform(None)
inner = ode.GeomBox(None, (1, 1, 1))
inner.setPosition((0.5, 0, 0))
wrapper.setGeom(inner)
wrapper.setInfo(1)
wrapper.setPosition((0, 0, 1))
show("wrapper", [wrapper.getGeom() is inner, wrapper.getInfo(), wrapper.getAABB()])
contacts("wrapper", wrapper, ball)

# A heightfield, by a function.
field = ode.HeightfieldData()
field.build_callback(None, lambda user, x, z: 0.1 * x - 0.05 * z, 8, 8, 9, 9, 1, 0, 1, 0)
field.setBounds(-2, 2)
hills = ode.GeomHeightfield(field, 1, None)
look("field", hills)
ball.setPosition((0.4, 0.4, 0.3))
contacts("field-ball", hills, ball)
ode.CloseODE()
