/* Bodies: state, forces, points, mass, modes, and pointers that stay. */
#include "check.h"

static int moved_calls;
static dReal seen[3];
static void moved(dBodyID b) {
    moved_calls++;
    memcpy(seen, dBodyGetLinearVel(b), sizeof seen);
    show("moved.force", dBodyGetForce(b), 3);
    if (moved_calls == 2) dBodySetLinearVel(b, 1, 2, 3);
    if (moved_calls == 3) dBodyAddForce(b, 5, 0, 0);
}

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    dBodyID a, b;
    two_bodies(w, &a, &b);
    showi("world", dBodyGetWorld(a) == w);
    int data;
    dBodySetData(a, &data);
    showi("data", dBodyGetData(a) == &data && dBodyGetData(b) == 0);
    show_body("a", a);

    dBodyAddForce(a, 1, 2, 3);
    dBodyAddTorque(a, -1, 0.5, 2);
    dBodyAddRelForce(a, 0.5, 0.25, -1);
    dBodyAddRelTorque(a, 0.5, 0.25, -1);
    dBodyAddForceAtPos(a, 1, 2, 3, 0.3, 0.2, 0.1);
    dBodyAddForceAtRelPos(a, 1, 2, 3, 0.3, 0.2, 0.1);
    dBodyAddRelForceAtPos(a, 1, 2, 3, 0.3, 0.2, 0.1);
    dBodyAddRelForceAtRelPos(a, 1, 2, 3, 0.3, 0.2, 0.1);
    show_body("pushed", a);
    dBodySetForce(b, 1, 2, 3);
    dBodySetTorque(b, 3, 2, 1);
    show_body("set", b);

    V3(dBodyGetRelPointPos, a, 0.1, 0.2, 0.3);
    V3(dBodyGetRelPointVel, a, 0.1, 0.2, 0.3);
    V3(dBodyGetPointVel, a, 0.1, 0.2, 0.3);
    V3(dBodyGetPosRelPoint, a, 0.1, 0.2, 0.3);
    V3(dBodyVectorToWorld, a, 0.1, 0.2, 0.3);
    V3(dBodyVectorFromWorld, a, 0.1, 0.2, 0.3);
    V3(dBodyCopyPosition, a);
    dMatrix3 r;
    dQuaternion q = {0.5, -0.5, 0.7, 0.1};
    dBodyCopyRotation(a, r);
    show("dBodyCopyRotation", r, 12);
    dBodySetQuaternion(a, q);
    dBodyCopyQuaternion(a, q);
    show("dBodyCopyQuaternion", q, 4);
    show_body("turned", a);
    dMatrix3 skew = {1.1, 0, 0, 0, 0.2, 1, 0, 0, 0, 0, 1, 0};
    dBodySetRotation(a, skew);
    show_body("skew", a);
    dRFromEulerAngles(r, 0.3, 0.2, -0.5);
    dBodySetRotation(a, r);

    dMass m;
    dBodyGetMass(b, &m);
    show("mass", &m.mass, 1);
    show("mass.I", m.I, 12);
    I1(dBodyIsKinematic, b);
    dBodySetKinematic(b);
    I1(dBodyIsKinematic, b);
    dBodyGetMass(b, &m);
    show("mass", &m.mass, 1);
    dBodySetDynamic(b);
    I1(dBodyIsKinematic, b);

    I1(dBodyIsEnabled, a);
    dBodyDisable(a);
    I1(dBodyIsEnabled, a);
    dBodyEnable(a);
    I1(dBodyGetAutoDisableFlag, a);
    dBodySetAutoDisableFlag(a, 1);
    I1(dBodyGetAutoDisableFlag, a);
    dBodySetAutoDisableLinearThreshold(a, -0.3);
    R1(dBodyGetAutoDisableLinearThreshold, a);
    dBodySetAutoDisableAngularThreshold(a, 0.4);
    R1(dBodyGetAutoDisableAngularThreshold, a);
    dBodySetAutoDisableSteps(a, 7);
    I1(dBodyGetAutoDisableSteps, a);
    dBodySetAutoDisableTime(a, 0.7);
    R1(dBodyGetAutoDisableTime, a);
    dBodySetAutoDisableAverageSamplesCount(a, 4);
    I1(dBodyGetAutoDisableAverageSamplesCount, a);
    dBodySetAutoDisableFlag(a, 0);
    I1(dBodyGetAutoDisableSteps, a);
    dWorldSetAutoDisableLinearThreshold(w, 0.77);
    dWorldSetAutoDisableSteps(w, 3);
    dBodySetAutoDisableDefaults(a);
    R1(dBodyGetAutoDisableLinearThreshold, a);
    I1(dBodyGetAutoDisableSteps, a);

    dBodySetLinearDamping(a, 0.1);
    R1(dBodyGetLinearDamping, a);
    dBodySetAngularDamping(a, 0.2);
    R1(dBodyGetAngularDamping, a);
    dBodySetDamping(b, 0.3, 0.4);
    R1(dBodyGetLinearDamping, b);
    R1(dBodyGetAngularDamping, b);
    dBodySetLinearDampingThreshold(a, 0.5);
    R1(dBodyGetLinearDampingThreshold, a);
    dBodySetAngularDampingThreshold(a, 0.6);
    R1(dBodyGetAngularDampingThreshold, a);
    dBodySetDampingDefaults(b);
    R1(dBodyGetLinearDamping, b);
    dBodySetMaxAngularSpeed(a, 12);
    R1(dBodyGetMaxAngularSpeed, a);
    R1(dBodyGetMaxAngularSpeed, b);
    I1(dBodyGetGravityMode, a);
    dBodySetGravityMode(b, 0);
    I1(dBodyGetGravityMode, b);
    I1(dBodyGetGyroscopicMode, a);
    dBodySetGyroscopicMode(b, 0);
    I1(dBodyGetGyroscopicMode, b);
    I1(dBodyGetFiniteRotationMode, a);
    dBodySetFiniteRotationMode(a, 1);
    I1(dBodyGetFiniteRotationMode, a);
    dBodySetFiniteRotationAxis(a, 0, 0, 2);
    V3(dBodyGetFiniteRotationAxis, a);

    const dReal *p = dBodyGetPosition(a), *v = dBodyGetLinearVel(a), *f = dBodyGetForce(a);
    dBodySetMovedCallback(a, moved);
    dWorldSetGravity(w, 0, 0, -9.81);
    for (int i = 0; i < 5; i++) {
        dWorldStep(w, 0.01);
        show("p", p, 3);
        show("v", v, 3);
        show("f", f, 3);
        show("seen", seen, 3);
    }
    showi("moved", moved_calls);
    dBodySetMovedCallback(a, 0);
    /* Programs write through the pointers that getters give. */
    ((dReal *)p)[0] = 5;
    ((dReal *)v)[2] = 4;
    dWorldQuickStep(w, 0.01);
    show_body("a", a);
    show_body("b", b);
    showi("same", p == dBodyGetPosition(a) && v == dBodyGetLinearVel(a));

    I1(dBodyGetNumJoints, a);
    dJointID j1 = dJointCreateBall(w, 0), j2 = dJointCreateHinge(w, 0);
    dJointAttach(j1, a, b);
    dJointAttach(j2, b, a);
    showi("joints", dBodyGetJoint(a, 0) == j2 && dBodyGetJoint(a, 1) == j1 && dBodyGetJoint(a, 2) == 0);
    dBodyDestroy(b);
    I1(dBodyGetNumJoints, a);
    I1(dJointGetNumBodies, j1);
    dWorldStep(w, 0.01);
    show_body("a", a);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
