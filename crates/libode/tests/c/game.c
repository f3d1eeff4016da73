/* As games do it: a static level in a space of its own, vehicles in spaces within, rays as sensors, triggers, doors on
   motors, ragdolls, a thread pool, auto-disable, feedback, moved callbacks, things that come and go. */
#include "check.h"

enum { WHEELS = 4, CRATES = 10 };
static dWorldID world;
static dSpaceID all, level, cars;
static dJointGroupID contacts;
static int touched, triggered, moves, seen;
static dGeomID trigger, sensor;
static dReal nearest;

static void moved(dBodyID b) { (void)b; moves++; }

static void near(void *data, dGeomID a, dGeomID b) {
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
        dSpaceCollide2(a, b, data, near);
        if (dGeomIsSpace(a)) dSpaceCollide((dSpaceID)a, data, near);
        if (dGeomIsSpace(b)) dSpaceCollide((dSpaceID)b, data, near);
        return;
    }
    dBodyID b1 = dGeomGetBody(a), b2 = dGeomGetBody(b);
    if (!b1 && !b2 && a != sensor && b != sensor) return;
    if (b1 && b2 && dAreConnectedExcluding(b1, b2, dJointTypeContact)) return;
    dContact c[6];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 6, &c[0].geom, sizeof(dContact));
    seen++;
    if (a == sensor || b == sensor) {
        for (int i = 0; i < n; i++)
            if (c[i].geom.depth < nearest) nearest = c[i].geom.depth;
        return;
    }
    if (a == trigger || b == trigger) {
        triggered += n > 0;
        return;
    }
    for (int i = 0; i < n; i++) {
        int wheel = dGeomGetClass(a) == dSphereClass || dGeomGetClass(b) == dSphereClass;
        c[i].surface.mode = dContactSoftERP | dContactSoftCFM | dContactApprox1 | (wheel ? dContactSlip1 | dContactSlip2 : dContactBounce);
        c[i].surface.mu = wheel ? 1.5 : 0.6;
        c[i].surface.slip1 = c[i].surface.slip2 = 0.01;
        c[i].surface.soft_erp = 0.5;
        c[i].surface.soft_cfm = 1e-4;
        c[i].surface.bounce = 0.2;
        c[i].surface.bounce_vel = 0.2;
        dJointAttach(dJointCreateContact(world, contacts, &c[i]), b1, b2);
        touched++;
    }
}

static dBodyID solid(dSpaceID space, int kind, dReal size, dReal density) {
    dMass m;
    dBodyID b = dBodyCreate(world);
    dGeomID g;
    if (kind == 0) { dMassSetBox(&m, density, size, size, size); g = dCreateBox(space, size, size, size); }
    else if (kind == 1) { dMassSetSphere(&m, density, size); g = dCreateSphere(space, size); }
    else { dMassSetCapsule(&m, density, 3, size, 2 * size); g = dCreateCapsule(space, size, 2 * size); }
    dBodySetMass(b, &m);
    dGeomSetBody(g, b);
    return b;
}

int main(void) {
    dInitODE2(0);
    dRandSetSeed(7);
    world = dWorldCreate();
    /* libode's hash space leaves pairs out now and then. */
    all = dSimpleSpaceCreate(0);
    level = dSimpleSpaceCreate(all);
    cars = dSimpleSpaceCreate(all);
    dSpaceSetSublevel(level, 1);
    dSpaceSetSublevel(cars, 1);
    contacts = dJointGroupCreate(0);
    dWorldSetGravity(world, 0, 0, -9.81);
    dWorldSetERP(world, 0.4);
    dWorldSetCFM(world, 1e-5);
    dWorldSetQuickStepNumIterations(world, 15);
    dWorldSetContactSurfaceLayer(world, 0.001);
    dWorldSetContactMaxCorrectingVel(world, 2);
    dWorldSetAutoDisableFlag(world, 1);
    dWorldSetAutoDisableLinearThreshold(world, 0.05);
    dWorldSetAutoDisableAngularThreshold(world, 0.05);
    dWorldSetAutoDisableSteps(world, 8);
    dWorldSetLinearDamping(world, 0.001);
    dWorldSetAngularDamping(world, 0.01);

    dThreadingImplementationID threading = dThreadingAllocateMultiThreadedImplementation();
    dThreadingThreadPoolID pool = dThreadingAllocateThreadPool(2, 0, dAllocateFlagBasicData, 0);
    dThreadingThreadPoolServeMultiThreadedImplementation(pool, threading);
    dWorldSetStepThreadingImplementation(world, dThreadingImplementationGetFunctions(threading), threading);
    dWorldSetStepIslandsProcessingMaxThreadCount(world, 1);

    dCreatePlane(level, 0, 0, 1, 0);
    for (int i = 0; i < 4; i++) {
        dGeomID wall = dCreateBox(level, i % 2 ? 0.4 : 16, i % 2 ? 16 : 0.4, 2);
        dGeomSetPosition(wall, i == 1 ? 8 : i == 3 ? -8 : 0, i == 0 ? 8 : i == 2 ? -8 : 0, 1);
    }
    dGeomID ramp = dCreateBox(level, 3, 2, 0.2);
    dMatrix3 r;
    dRFromAxisAndAngle(r, 0, 1, 0, -0.2);
    dGeomSetRotation(ramp, r);
    dGeomSetPosition(ramp, 3.5, 0, 0.2);
    trigger = dCreateBox(all, 1, 6, 2);
    dGeomSetPosition(trigger, 1.6, 0, 1);
    sensor = dCreateRay(all, 12);

    /* A car: chassis, wheels on hinge-2 joints, steered and driven. */
    dSpaceID car = dSimpleSpaceCreate(cars);
    dBodyID chassis = dBodyCreate(world), wheels[WHEELS];
    dMass m;
    dMassSetBoxTotal(&m, 20, 1.4, 0.8, 0.3);
    dBodySetMass(chassis, &m);
    dGeomSetBody(dCreateBox(car, 1.4, 0.8, 0.3), chassis);
    dBodySetPosition(chassis, -3, 0, 0.5);
    dBodySetMovedCallback(chassis, moved);
    dBodySetAutoDisableFlag(chassis, 0);
    dJointID axles[WHEELS];
    dJointFeedback feedback[WHEELS];
    memset(feedback, 0, sizeof feedback);
    for (int i = 0; i < WHEELS; i++) {
        wheels[i] = solid(car, 1, 0.25, 30);
        dReal x = -3 + (i < 2 ? 0.5 : -0.5), y = i % 2 ? 0.5 : -0.5;
        dBodySetPosition(wheels[i], x, y, 0.3);
        dBodySetFiniteRotationMode(wheels[i], 1);
        dBodySetAutoDisableFlag(wheels[i], 0);
        axles[i] = dJointCreateHinge2(world, 0);
        dJointAttach(axles[i], chassis, wheels[i]);
        dJointSetHinge2Anchor(axles[i], x, y, 0.3);
        dReal up[4] = {0, 0, 1, 0}, side[4] = {0, 1, 0, 0};
        dJointSetHinge2Axes(axles[i], up, side);
        dJointSetHinge2Param(axles[i], dParamSuspensionERP, 0.4);
        dJointSetHinge2Param(axles[i], dParamSuspensionCFM, 0.002);
        dJointSetHinge2Param(axles[i], dParamLoStop, 0);
        dJointSetHinge2Param(axles[i], dParamHiStop, 0);
        dJointSetFeedback(axles[i], &feedback[i]);
    }
    /* A door on a hinge with a motor, and a ragdoll. */
    dBodyID door = dBodyCreate(world);
    dMassSetBoxTotal(&m, 5, 0.1, 1, 1.6);
    dBodySetMass(door, &m);
    dGeomSetBody(dCreateBox(all, 0.1, 1, 1.6), door);
    dBodySetPosition(door, 5.6, 1.2, 0.95);
    dJointID hinge = dJointCreateHinge(world, 0);
    dJointAttach(hinge, door, 0);
    dJointSetHingeAnchor(hinge, 5.6, 0.7, 0.95);
    dJointSetHingeAxis(hinge, 0, 0, 1);
    dJointSetHingeParam(hinge, dParamLoStop, -1.2);
    dJointSetHingeParam(hinge, dParamHiStop, 1.2);
    dJointSetHingeParam(hinge, dParamFMax, 3);
    dBodyID doll[3];
    for (int i = 0; i < 3; i++) {
        doll[i] = solid(all, 2, 0.15, 100);
        dBodySetPosition(doll[i], -4, 4, 0.8 + 0.65 * i);
        if (i == 0) continue;
        dJointID j = dJointCreateUniversal(world, 0);
        dJointAttach(j, doll[i - 1], doll[i]);
        dJointSetUniversalAnchor(j, -4, 4, 0.8 + 0.65 * i - 0.325);
        dJointSetUniversalAxis1(j, 1, 0, 0);
        dJointSetUniversalAxis2(j, 0, 1, 0);
        dJointSetUniversalParam(j, dParamLoStop, -0.6);
        dJointSetUniversalParam(j, dParamHiStop, 0.6);
    }
    dBodyAddForce(doll[2], 300, 0, 0);
    dBodyID crates[CRATES];
    memset(crates, 0, sizeof crates);

    for (int step = 0; step < 240; step++) {
        dReal speed = 6, steer = 0.1 * sin(0.05 * step);
        for (int i = 0; i < WHEELS; i++) {
            dJointSetHinge2Param(axles[i], dParamVel2, speed);
            dJointSetHinge2Param(axles[i], dParamFMax2, 2);
            if (i < 2) {
                dJointSetHinge2Param(axles[i], dParamLoStop, -0.5);
                dJointSetHinge2Param(axles[i], dParamHiStop, 0.5);
                dJointSetHinge2Param(axles[i], dParamVel, 5 * (steer - dJointGetHinge2Angle1(axles[i])));
                dJointSetHinge2Param(axles[i], dParamFMax, 5);
            }
        }
        dJointSetHingeParam(hinge, dParamVel, step < 120 ? 1 : -1);
        /* Crates drop in and are taken away again. */
        int k = step / 20 % CRATES;
        if (step % 20 == 0) {
            if (crates[k]) {
                dGeomDestroy(dBodyGetFirstGeom(crates[k]));
                dBodyDestroy(crates[k]);
            }
            crates[k] = solid(all, k % 3, 0.3, 50);
            dBodySetPosition(crates[k], -5 + 1.1 * k, -4 + 0.3 * k, 1);
            dBodySetAngularVel(crates[k], 0.3 * k, 0.2, 0.1);
        }
        const dReal *p = dBodyGetPosition(chassis), *R = dBodyGetRotation(chassis);
        dGeomRaySet(sensor, p[0] + R[0], p[1] + R[4], p[2] + R[8] + 0.1, R[0], R[4], R[8]);
        nearest = 1e9;
        dSpaceCollide(all, 0, near);
        dWorldQuickStep(world, 0.01);
        dJointGroupEmpty(contacts);
        if (step % 40 == 39) {
            showi("step", step);
            showi("touched", touched);
            showi("triggered", triggered);
            showi("moves", moves);
            showi("seen", seen);
            show1("sensor", nearest);
            show_body("chassis", chassis);
            for (int i = 0; i < WHEELS; i++) {
                show_body("wheel", wheels[i]);
                show("feedback", feedback[i].f1, 3);
                show("feedback", feedback[i].t2, 3);
            }
            show1("door", dJointGetHingeAngle(hinge));
            show_body("doll", doll[2]);
            for (int i = 0; i < CRATES; i++)
                if (crates[i]) {
                    showi("awake", dBodyIsEnabled(crates[i]));
                    show("crate", dBodyGetPosition(crates[i]), 3);
                }
            showi("seed", (long)dRandGetSeed());
        }
    }
    dThreadingImplementationShutdownProcessing(threading);
    dThreadingFreeThreadPool(pool);
    dWorldSetStepThreadingImplementation(world, 0, 0);
    dThreadingFreeImplementation(threading);
    dJointGroupDestroy(contacts);
    dWorldDestroy(world);
    dSpaceDestroy(all);
    dCloseODE();
    return 0;
}
