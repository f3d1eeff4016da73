/* What modes do to motion: kinematic bodies, gravity, gyroscopic torque, finite rotation, largest angular speed. */
#include "check.h"

static dWorldID w;
static dBodyID spinning(void) {
    dBodyID b = dBodyCreate(w);
    dMass m;
    dMassSetBoxTotal(&m, 2, 0.2, 1, 3);
    dBodySetMass(b, &m);
    dBodySetAngularVel(b, 3, 2, 5);
    return b;
}
static void steps(void) { for (int i = 0; i < 20; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    w = dWorldCreate();
    dWorldSetGravity(w, 0, 0, -10);
    dBodyID b = spinning(), floating = spinning(), plain = spinning(), finite = spinning(), slow = spinning(),
            kinematic = spinning(), again = spinning();
    dBodySetGravityMode(floating, 0);
    I1(dBodyGetGravityMode, floating);
    dBodySetGyroscopicMode(plain, 0);
    I1(dBodyGetGyroscopicMode, plain);
    dBodySetFiniteRotationMode(finite, 1);
    I1(dBodyGetFiniteRotationMode, finite);
    dBodySetFiniteRotationAxis(finite, 0, 3, 4);
    V3(dBodyGetFiniteRotationAxis, finite);
    dBodySetMaxAngularSpeed(slow, 1.5);
    R1(dBodyGetMaxAngularSpeed, slow);
    dBodySetKinematic(kinematic);
    I1(dBodyIsKinematic, kinematic);
    dBodySetKinematic(again);
    dBodySetDynamic(again);
    CHECKI(dBodySetDynamic, dBodyIsKinematic(again));
    dBodyAddForce(kinematic, 100, 0, 0);
    steps();
    MOVES(dBodyCreate, b);
    MOVES(dBodySetGravityMode, floating);
    MOVES(dBodySetGyroscopicMode, plain);
    MOVES(dBodySetFiniteRotationMode, finite);
    MOVES(dBodySetFiniteRotationAxis, finite);
    MOVES(dBodySetMaxAngularSpeed, slow);
    MOVES(dBodySetKinematic, kinematic);
    MOVES(dBodySetDynamic, again);
    dBodyDestroy(b);
    steps();
    MOVES(dBodyDestroy, floating);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
