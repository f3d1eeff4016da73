"""Worlds, masses and bodies."""
import ode
from check import show, show_all, show_body

world = ode.World()
world.setGravity((0.1, -0.2, -9.81))
world.setERP(0.3)
world.setCFM(1e-6)
world.setContactMaxCorrectingVel(5)
world.setContactSurfaceLayer(0.002)
world.setQuickStepNumIterations(31)
world.setAutoDisableLinearThreshold(0.02)
world.setAutoDisableAngularThreshold(0.03)
world.setAutoDisableSteps(7)
world.setAutoDisableTime(0.1)
world.setLinearDamping(0.001)
world.setAngularDamping(0.002)
show_all("world", world, """getGravity getERP getCFM getContactMaxCorrectingVel getContactSurfaceLayer
    getQuickStepNumIterations getAutoDisableLinearThreshold getAutoDisableAngularThreshold getAutoDisableSteps
    getAutoDisableTime getAutoDisableFlag getLinearDamping getAngularDamping""")
show("impulse", world.impulseToForce(0.02, (1, 2, 3)))

masses = []
for make, arguments in [
    ("setSphere", (2, 0.5)), ("setSphereTotal", (2, 0.5)), ("setBox", (1, 1, 2, 3)), ("setBoxTotal", (4, 1, 2, 3)),
    ("setCylinder", (1, 3, 0.3, 2)), ("setCylinderTotal", (3, 1, 0.3, 2)),
    ("setCappedCylinder", (1, 2, 0.3, 2)), ("setCappedCylinderTotal", (3, 3, 0.3, 2)),
    ("setParameters", (2, 0, 0, 0, 1, 2, 2.5, 0.1, 0.2, 0.3)),
]:
    mass = ode.Mass()
    getattr(mass, make)(*arguments)
    show(make, (mass.mass, mass.c, mass.I))
    masses.append(mass)
mass = ode.Mass()
mass.setZero()
show("zero", (mass.mass, mass.c, mass.I))
mass.setBox(1, 1, 1, 1)
mass.translate((0.1, 0.2, 0.3))
show("translated", (mass.mass, mass.c, mass.I))
mass.adjust(5)
show("adjusted", (mass.mass, mass.c, mass.I))
mass.add(masses[0])
show("added", (mass.mass, mass.c, mass.I))
show("sum", ((masses[0] + masses[1]).mass,))

bodies = []
for i, mass in enumerate(masses):
    body = ode.Body(world)
    body.setMass(mass)
    show("mass", body.getMass().mass)
    body.setPosition((i, 0.1 * i, -0.2 * i))
    body.setQuaternion((0.9, 0.1 * i, 0.2, -0.1))
    body.setLinearVel((0.1, 0.2, 0.3 * i))
    body.setAngularVel((0.3, -0.1 * i, 0.2))
    bodies.append(body)
bodies[1].setRotation((0, -1, 0, 1, 0, 0, 0, 0, 1))
moved = []
bodies[2].setMovedCallback(lambda body: moved.append(body is bodies[2]))
bodies[3].setGravityMode(False)
bodies[4].setFiniteRotationMode(1)
bodies[4].setFiniteRotationAxis((0, 0.6, 0.8))
bodies[5].setKinematic()
bodies[6].disable()
for body in bodies:
    show_body("before", body)
    show_all("before", body, """getFiniteRotationMode getFiniteRotationAxis getNumJoints getGravityMode isEnabled
        isKinematic""")
for step in range(20):
    body = bodies[step % 4]
    body.addForce((1, 2, 3))
    body.addTorque((0.1, 0.2, -0.3))
    body.addRelForce((1, 0, 0))
    body.addRelTorque((0, 0.5, 0))
    body.addForceAtPos((0, 1, 0), (1, 2, 3))
    body.addForceAtRelPos((0, 1, 0), (0.1, 0.2, 0.3))
    body.addRelForceAtPos((0, 1, 0), (1, 2, 3))
    body.addRelForceAtRelPos((0, 1, 0), (0.1, 0.2, 0.3))
    show_body("pushed", body)
    if step % 2:
        world.step(0.01)
    else:
        world.quickStep(0.01)
bodies[5].setDynamic()
bodies[6].enable()
bodies[7].setForce((1, 1, 1))
bodies[7].setTorque((1, 1, 1))
world.step(0.01)
for body in bodies:
    show_body("after", body)
    show("points", [body.getRelPointPos((1, 2, 3)), body.getRelPointVel((1, 2, 3)), body.getPointVel((1, 2, 3)),
                    body.getPosRelPoint((1, 2, 3)), body.vectorToWorld((1, 2, 3)), body.vectorFromWorld((1, 2, 3))])
show("moved", len(moved) and all(moved))

# Programs keep their own attributes on bodies, and drop objects in any order.
bodies[0].colour = "red"
show("attribute", bodies[0].colour == "red")
moved.clear()
bodies.clear()
del body, world
ode.CloseODE()
