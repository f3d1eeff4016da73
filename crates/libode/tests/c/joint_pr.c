/* Prismatic-rotoide joints: anchor, both axes, position, angle and rates, stops, a torque. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static dJointID j;
static void begin(void) {
    w = dWorldCreate();
    two_bodies(w, &a, &b);
    j = dJointCreatePR(w, 0);
    dJointAttach(j, a, b);
    dJointSetPRAnchor(j, 0.7, 0.1, 1.2);
    dJointSetPRAxis1(j, 1, 0.1, 0);
    dJointSetPRAxis2(j, 0, 0.1, 1);
}
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    begin();
    CHECKI(dJointCreatePR, dJointGetType(j));
    dVector3 p;
    dJointGetPRAnchor(j, p);
    CHECK(dJointSetPRAnchor, p, 3);
    V3(dJointGetPRAnchor, j);
    dJointGetPRAxis1(j, p);
    CHECK(dJointSetPRAxis1, p, 3);
    V3(dJointGetPRAxis1, j);
    dJointGetPRAxis2(j, p);
    CHECK(dJointSetPRAxis2, p, 3);
    V3(dJointGetPRAxis2, j);
    run();
    R1(dJointGetPRPosition, j);
    R1(dJointGetPRPositionRate, j);
    R1(dJointGetPRAngle, j);
    R1(dJointGetPRAngleRate, j);
    MOVES(dJointSetPRAnchor, a);
    dWorldDestroy(w);
    begin();
    dJointSetPRParam(j, dParamVel1, 0.5);
    dJointSetPRParam(j, dParamFMax1, 10);
    dJointSetPRParam(j, dParamVel2, 0.7);
    dJointSetPRParam(j, dParamFMax2, 10);
    R1(dJointGetPRParam, j, dParamVel2);
    run();
    MOVES(dJointSetPRParam, a);
    dWorldDestroy(w);
    begin();
    dJointAddPRTorque(j, 0.4);
    CHECK(dJointAddPRTorque, dBodyGetTorque(b), 3);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
