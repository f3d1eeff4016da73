"""Programs as people write them: things fall and collide, contacts are made in the callback."""
import random
import ode
from check import show, show_body


def near(data, a, b):
    world, group, counts = data
    if ode.areConnected(a.getBody(), b.getBody()) if a.getBody() and b.getBody() else False:
        return
    for contact in ode.collide(a, b):
        contact.setBounce(0.2)
        contact.setMu(50)
        contact.setSoftERP(0.3)
        contact.setSoftCFM(1e-4)
        joint = ode.ContactJoint(world, group, contact)
        joint.attach(a.getBody(), b.getBody())
        counts[0] += 1


for kind in range(2):
    random.seed(kind)
    world = ode.World()
    world.setGravity((0, 0, -9.81))
    world.setERP(0.8)
    world.setCFM(1e-5)
    space = [ode.SimpleSpace, ode.HashSpace][kind]()
    ground = ode.GeomPlane(space, (0, 0, 1), 0)
    group = ode.JointGroup()
    bodies, geoms, counts = [], [], [0]
    for i in range(12):
        body = ode.Body(world)
        mass = ode.Mass()
        if i % 3 == 0:
            mass.setBox(500, 1, 0.4, 0.6)
            geom = ode.GeomBox(space, (1, 0.4, 0.6))
        elif i % 3 == 1:
            mass.setSphere(500, 0.3)
            geom = ode.GeomSphere(space, 0.3)
        else:
            mass.setCappedCylinder(500, 3, 0.2, 0.7)
            geom = ode.GeomCapsule(space, 0.2, 0.7)
        body.setMass(mass)
        geom.setBody(body)
        body.setPosition((random.gauss(0, 0.3), random.gauss(0, 0.3), 0.5 + 0.8 * i))
        bodies.append(body)
        geoms.append(geom)
    for step in range(80):
        space.collide((world, group, counts), near)
        if kind == 1:
            world.step(0.01)
        else:
            world.quickStep(0.01)
        group.empty()
        if step % 20 == 19:
            show("contacts", counts[0])
            for body in bodies:
                show_body("body", body)
    # pyode does not mind which goes first; libode does.
    geoms.clear()
    bodies.clear()
    del body, geom, ground, group, space, world

# A pendulum in a bounded plane, and a cart with motors.
world = ode.World()
world.setGravity((0, -9.81, 0))
links, joints, above = [], [], ode.environment
for i in range(5):
    body = ode.Body(world)
    mass = ode.Mass()
    mass.setSphereTotal(1, 0.1)
    body.setMass(mass)
    body.setPosition((i + 1, 2, 0))
    joint = ode.HingeJoint(world) if i % 2 else ode.BallJoint(world)
    joint.attach(above, body) if i else joint.attach(body, above)
    joint.setAnchor((i, 2, 0))
    if i % 2:
        joint.setAxis((0, 0, 1))
    links.append(body)
    joints.append(joint)
    above = body
for step in range(100):
    world.step(0.01)
for body in links:
    show_body("link", body)
joints.clear()
links.clear()
del above, body, joint, world
ode.CloseODE()
