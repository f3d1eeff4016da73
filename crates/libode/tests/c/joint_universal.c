/* Universal joints: anchors, axes and their offsets, angles and rates, stops, torques. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static dJointID j;
static void begin(void) {
    w = dWorldCreate();
    two_bodies(w, &a, &b);
    j = dJointCreateUniversal(w, 0);
    dJointAttach(j, a, b);
    dJointSetUniversalAnchor(j, 0.7, 0.1, 1.2);
    dJointSetUniversalAxis1(j, 1, 0.1, 0);
    dJointSetUniversalAxis2(j, 0, 0.1, 1);
}
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    begin();
    CHECKI(dJointCreateUniversal, dJointGetType(j));
    dVector3 p;
    dJointGetUniversalAnchor(j, p);
    CHECK(dJointSetUniversalAnchor, p, 3);
    V3(dJointGetUniversalAnchor, j);
    V3(dJointGetUniversalAnchor2, j);
    dJointGetUniversalAxis1(j, p);
    CHECK(dJointSetUniversalAxis1, p, 3);
    V3(dJointGetUniversalAxis1, j);
    dJointGetUniversalAxis2(j, p);
    CHECK(dJointSetUniversalAxis2, p, 3);
    V3(dJointGetUniversalAxis2, j);
    run();
    R1(dJointGetUniversalAngle1, j);
    R1(dJointGetUniversalAngle2, j);
    R1(dJointGetUniversalAngle1Rate, j);
    R1(dJointGetUniversalAngle2Rate, j);
    dReal angles[2] = {9, 9};
    dJointGetUniversalAngles(j, angles, angles + 1);
    CHECK(dJointGetUniversalAngles, angles, 2);
    MOVES(dJointSetUniversalAnchor, a);
    dWorldDestroy(w);
    begin();
    dJointSetUniversalAxis1Offset(j, 1, 0.1, 0, 0.2, 0.1);
    CHECK1(dJointSetUniversalAxis1Offset, dJointGetUniversalAngle1(j));
    run();
    MOVES(dJointSetUniversalAxis1Offset, a);
    dWorldDestroy(w);
    begin();
    dJointSetUniversalAxis2Offset(j, 0, 0.1, 1, 0.1, 0.2);
    CHECK1(dJointSetUniversalAxis2Offset, dJointGetUniversalAngle2(j));
    run();
    MOVES(dJointSetUniversalAxis2Offset, a);
    dWorldDestroy(w);
    begin();
    dJointSetUniversalParam(j, dParamVel2, 2);
    dJointSetUniversalParam(j, dParamFMax2, 20);
    R1(dJointGetUniversalParam, j, dParamFMax2);
    run();
    CHECK1(dJointSetUniversalParam, dJointGetUniversalAngle2(j));
    dWorldDestroy(w);
    begin();
    dJointAddUniversalTorques(j, 0.4, -0.3);
    CHECK(dJointAddUniversalTorques, dBodyGetTorque(b), 3);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
