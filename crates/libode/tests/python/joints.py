"""Every joint type: anchors, axes, angles, parameters, feedback, and where it takes its bodies."""
import ode
from check import show, show_all, show_body

PARAMETERS = [ode.ParamLoStop, ode.ParamHiStop, ode.ParamVel, ode.ParamFMax, ode.ParamFudgeFactor, ode.ParamBounce,
              ode.ParamCFM, ode.ParamStopERP, ode.ParamStopCFM, ode.ParamSuspensionERP, ode.ParamSuspensionCFM]


def setting():
    world = ode.World()
    world.setGravity((0, 0, -9.81))
    bodies = []
    for i in range(2):
        body = ode.Body(world)
        mass = ode.Mass()
        mass.setBoxTotal(1 + i, 1, 0.5, 0.3 + 0.2 * i)
        body.setMass(mass)
        body.setPosition((1.2 * i, 0.1, 1))
        body.setQuaternion((0.95, 0.1, -0.2 * i, 0.15))
        body.setAngularVel((0.2, 0.1 * i, -0.3))
        bodies.append(body)
    return world, bodies


def run(name, joint, world, bodies, getters):
    joint.setFeedback()
    show_all(name, joint, getters)
    show(name + ".bodies", [joint.getBody(0) is bodies[0], joint.getBody(1) is bodies[1]])
    for step in range(30):
        if step % 2:
            world.step(0.02)
        else:
            world.quickStep(0.02)
    show_all(name, joint, getters)
    show(name + ".feedback", joint.getFeedback())
    for body in bodies:
        show_body(name, body)
        show(name + ".joints", body.getNumJoints())
    show(name + ".connected", ode.areConnected(*bodies))
    if hasattr(joint, "getParam"):
        for parameter in PARAMETERS:
            show(name + ".param", joint.getParam(parameter))
        joint.setParam(ode.ParamHiStop, 0.5)
        joint.setParam(ode.ParamLoStop, -0.4)
        joint.setParam(ode.ParamVel, 0.3)
        joint.setParam(ode.ParamFMax, 2)
        joint.setParam(ode.ParamBounce, 0.2)
        for step in range(30):
            world.step(0.02)
        for body in bodies:
            show_body(name + ".driven", body)
    if name not in ("universal", "hinge2", "amotor", "lmotor", "euler"):
        joint.attach(bodies[1], ode.environment)
        show(name + ".connected", ode.areConnected(*bodies))
        world.step(0.02)
        show_body(name + ".alone", bodies[1])
    joint.attach(None, None)
    world.step(0.02)
    show_body(name + ".free", bodies[1])


world, bodies = setting()
joint = ode.BallJoint(world)
joint.attach(*bodies)
joint.setAnchor((0.6, 0.1, 1))
run("ball", joint, world, bodies, "getAnchor getAnchor2")

world, bodies = setting()
joint = ode.HingeJoint(world)
joint.attach(*bodies)
joint.setAnchor((0.6, 0.1, 1))
joint.setAxis((0.1, 1, 0.2))
joint.addTorque(0.7)
run("hinge", joint, world, bodies, "getAnchor getAnchor2 getAxis getAngle getAngleRate")

world, bodies = setting()
joint = ode.SliderJoint(world)
joint.attach(*bodies)
joint.setAxis((0.1, 0.2, 1))
joint.addForce(1.5)
run("slider", joint, world, bodies, "getAxis getPosition getPositionRate")

world, bodies = setting()
joint = ode.UniversalJoint(world)
joint.attach(*bodies)
joint.setAnchor((0.6, 0.1, 1))
joint.setAxis1((0, 1, 0))
joint.setAxis2((0, 0, 1))
joint.addTorques(0.3, -0.2)
run("universal", joint, world, bodies,
    "getAnchor getAnchor2 getAxis1 getAxis2 getAngle1 getAngle2 getAngle1Rate getAngle2Rate")

world, bodies = setting()
joint = ode.Hinge2Joint(world)
joint.attach(*bodies)
joint.setAnchor((0.6, 0.1, 1))
joint.setAxis1((0, 0, 1))
joint.setAxis2((0, 1, 0))
joint.setParam(ode.ParamSuspensionERP, 0.4)
joint.setParam(ode.ParamSuspensionCFM, 0.01)
joint.setParam(ode.ParamVel2, 3)
joint.setParam(ode.ParamFMax2, 0.5)
joint.addTorques(0.3, -0.2)
run("hinge2", joint, world, bodies, "getAnchor getAnchor2 getAxis1 getAxis2 getAngle1 getAngle1Rate getAngle2Rate")

world, bodies = setting()
joint = ode.FixedJoint(world)
joint.attach(*bodies)
joint.setFixed()
run("fixed", joint, world, bodies, "")

world, bodies = setting()
joint = ode.AMotor(world)
joint.attach(*bodies)
joint.setMode(ode.AMotorUser)
joint.setNumAxes(2)
joint.setAxis(0, 0, (0, 0, 1))
joint.setAxis(1, 1, (0, 1, 0))
joint.setAngle(0, 0.2)
joint.setParam(ode.ParamVel, 1)
joint.setParam(ode.ParamFMax, 3)
joint.addTorques(0.1, 0.2, 0)
show("amotor.axes", [joint.getAxis(i) for i in range(2)] + [joint.getAxisRel(i) for i in range(2)])
show("amotor.angles", [joint.getAngle(i) for i in range(2)])
run("amotor", joint, world, bodies, "getMode getNumAxes")

world, bodies = setting()
ball = ode.BallJoint(world)
ball.attach(*bodies)
ball.setAnchor((0.6, 0.1, 1))
joint = ode.AMotor(world)
joint.attach(*bodies)
joint.setMode(ode.AMotorEuler)
joint.setAxis(0, 1, (0, 0, 1))
joint.setAxis(2, 2, (0, 1, 0))
for step in range(10):
    world.step(0.02)
show("euler.angles", [joint.getAngle(i) for i in range(3)] + [joint.getAngleRate(i) for i in range(3)])
run("euler", joint, world, bodies, "getMode getNumAxes")

world, bodies = setting()
joint = ode.LMotor(world)
joint.attach(*bodies)
joint.setNumAxes(2)
joint.setAxis(0, 0, (0, 0, 1))
joint.setAxis(1, 2, (1, 0, 0))
joint.setParam(ode.ParamVel, 1)
joint.setParam(ode.ParamFMax, 30)
show("lmotor.axes", [joint.getAxis(i) for i in range(2)])
run("lmotor", joint, world, bodies, "getNumAxes")

world, bodies = setting()
joint = ode.Plane2DJoint(world)
joint.attach(bodies[0], ode.environment)
joint.setXParam(ode.ParamVel, 1)
joint.setXParam(ode.ParamFMax, 5)
joint.setYParam(ode.ParamVel, -1)
joint.setYParam(ode.ParamFMax, 5)
joint.setAngleParam(ode.ParamVel, 0.5)
joint.setAngleParam(ode.ParamFMax, 5)
for step in range(40):
    world.step(0.01)
for body in bodies:
    show_body("plane2d", body)

# Groups, and joints whose bodies go first.
world, bodies = setting()
group = ode.JointGroup()
for i in range(3):
    joint = ode.BallJoint(world, group)
    joint.attach(*bodies)
    joint.setAnchor((0.5, 0, 1 + i))
show("group", [bodies[0].getNumJoints(), ode.areConnected(*bodies)])
group.empty()
show("group", [bodies[0].getNumJoints(), ode.areConnected(*bodies)])
joint = ode.HingeJoint(world)
joint.attach(*bodies)
del bodies[0]
world.step(0.01)
show_body("left", bodies[0])
# libode wants the world to go last.
bodies.clear()
del ball, joint, group
del world
ode.CloseODE()
