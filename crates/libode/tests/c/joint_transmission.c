/* Transmissions between two wheels on parallel axes: by gear teeth and by a chain. What is set, and how the second wheel
   turns. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static dJointID j;
static void begin(int mode) {
    w = dWorldCreate();
    a = dBodyCreate(w);
    b = dBodyCreate(w);
    dBodySetPosition(a, 0, 0, 1);
    dBodySetPosition(b, 2, 0, 1);
    for (int i = 0; i < 2; i++) {
        dJointID axle = dJointCreateHinge(w, 0);
        dJointAttach(axle, i ? b : a, 0);
        dJointSetHingeAnchor(axle, 2 * i, 0, 1);
        dJointSetHingeAxis(axle, 0, 0, 1);
    }
    j = dJointCreateTransmission(w, 0);
    dJointAttach(j, a, b);
    dJointSetTransmissionMode(j, mode);
    if (mode != dTransmissionIntersectingAxes) dJointSetTransmissionAxis(j, 0, 0, 1);
}
static void run(void) {
    for (int i = 0; i < 10; i++) {
        dBodySetAngularVel(a, 0, 0, 1);
        dWorldStep(w, 0.02);
    }
}

int main(void) {
    dInitODE2(0);
    dVector3 p;
    begin(dTransmissionParallelAxes);
    CHECKI(dJointCreateTransmission, dJointGetType(j));
    I1(dJointGetTransmissionMode, j);
    dJointSetTransmissionRatio(j, 1.5);
    CHECK1(dJointSetTransmissionRatio, dJointGetTransmissionRatio(j));
    R1(dJointGetTransmissionRatio, j);
    dJointGetTransmissionAxis(j, p);
    CHECK(dJointSetTransmissionAxis, p, 3);
    V3(dJointGetTransmissionAxis, j);
    V3(dJointGetTransmissionAxis1, j);
    V3(dJointGetTransmissionAxis2, j);
    run();
    V3(dJointGetTransmissionContactPoint1, j);
    V3(dJointGetTransmissionContactPoint2, j);
    R1(dJointGetTransmissionAngle1, j);
    R1(dJointGetTransmissionAngle2, j);
    MOVES(dJointSetTransmissionRatio, b);
    dWorldDestroy(w);

    begin(dTransmissionParallelAxes);
    dJointSetTransmissionBacklash(j, 0.05);
    CHECK1(dJointSetTransmissionBacklash, dJointGetTransmissionBacklash(j));
    R1(dJointGetTransmissionBacklash, j);
    dJointSetTransmissionParam(j, dParamCFM, 0.1);
    R1(dJointGetTransmissionParam, j, dParamCFM);
    run();
    MOVES(dJointSetTransmissionParam, b);
    dWorldDestroy(w);

    begin(dTransmissionChainDrive);
    CHECKI(dJointSetTransmissionMode, dJointGetTransmissionMode(j));
    dJointSetTransmissionRadius1(j, 0.4);
    CHECK1(dJointSetTransmissionRadius1, dJointGetTransmissionRadius1(j));
    R1(dJointGetTransmissionRadius1, j);
    dJointSetTransmissionRadius2(j, 0.6);
    CHECK1(dJointSetTransmissionRadius2, dJointGetTransmissionRadius2(j));
    R1(dJointGetTransmissionRadius2, j);
    dWorldDestroy(w);

    begin(dTransmissionIntersectingAxes);
    dJointSetTransmissionAxis1(j, 0, 0.6, 0.8);
    dJointGetTransmissionAxis1(j, p);
    CHECK(dJointSetTransmissionAxis1, p, 3);
    dJointSetTransmissionAxis2(j, 0.8, 0, 0.6);
    dJointGetTransmissionAxis2(j, p);
    CHECK(dJointSetTransmissionAxis2, p, 3);
    dJointSetTransmissionAnchor1(j, 0.1, 0.2, 1.3);
    dJointGetTransmissionAnchor1(j, p);
    CHECK(dJointSetTransmissionAnchor1, p, 3);
    V3(dJointGetTransmissionAnchor1, j);
    dJointSetTransmissionAnchor2(j, 2.1, 0.2, 1.3);
    dJointGetTransmissionAnchor2(j, p);
    CHECK(dJointSetTransmissionAnchor2, p, 3);
    V3(dJointGetTransmissionAnchor2, j);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
