/* Hinges: anchor, axis, offsets, angle and rate; stops, a motor, and a torque. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static dJointID j;
static void begin(void) {
    w = dWorldCreate();
    two_bodies(w, &a, &b);
    j = dJointCreateHinge(w, 0);
    dJointAttach(j, a, b);
    dJointSetHingeAnchor(j, 0.7, 0.1, 1.2);
    dJointSetHingeAxis(j, 0.1, 0.2, 1);
}
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    begin();
    CHECKI(dJointCreateHinge, dJointGetType(j));
    dVector3 p;
    dJointGetHingeAnchor(j, p);
    CHECK(dJointSetHingeAnchor, p, 3);
    V3(dJointGetHingeAnchor, j);
    V3(dJointGetHingeAnchor2, j);
    dJointGetHingeAxis(j, p);
    CHECK(dJointSetHingeAxis, p, 3);
    V3(dJointGetHingeAxis, j);
    run();
    R1(dJointGetHingeAngle, j);
    R1(dJointGetHingeAngleRate, j);
    MOVES(dJointSetHingeAxis, a);
    dWorldDestroy(w);
    begin();
    dJointSetHingeAxisOffset(j, 0, 0, 1, 0.4);
    CHECK1(dJointSetHingeAxisOffset, dJointGetHingeAngle(j));
    dJointSetHingeAnchorDelta(j, 0.6, 0.1, 1.2, 0.02, 0.03, 0.04);
    dJointGetHingeAnchor2(j, p);
    CHECK(dJointSetHingeAnchorDelta, p, 3);
    run();
    MOVES(dJointSetHingeAnchorDelta, a);
    dWorldDestroy(w);
    begin();
    dJointSetHingeParam(j, dParamHiStop, 0.1);
    dJointSetHingeParam(j, dParamLoStop, -0.1);
    dJointSetHingeParam(j, dParamBounce, 0.5);
    R1(dJointGetHingeParam, j, dParamHiStop);
    dBodySetAngularVel(a, 0, 0, 6);
    run();
    MOVES(dJointSetHingeParam, a);
    CHECK1(dJointGetHingeAngle, dJointGetHingeAngle(j));
    dWorldDestroy(w);
    begin();
    dJointSetHingeParam(j, dParamVel, 2);
    dJointSetHingeParam(j, dParamFMax, 50);
    run();
    CHECK1(dJointGetHingeAngleRate, dJointGetHingeAngleRate(j));
    dWorldDestroy(w);
    begin();
    dJointAddHingeTorque(j, 2.5);
    CHECK(dJointAddHingeTorque, dBodyGetTorque(b), 3);
    run();
    MOVES(dJointAddHingeTorque, b);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
