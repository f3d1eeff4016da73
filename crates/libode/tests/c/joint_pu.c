/* Prismatic-universal joints: anchor and its offsets, the axes, position, angles and rates, motors. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static dJointID j;
static void begin(void) {
    w = dWorldCreate();
    two_bodies(w, &a, &b);
    j = dJointCreatePU(w, 0);
    dJointAttach(j, a, b);
    dJointSetPUAnchor(j, 0.7, 0.1, 1.2);
    dJointSetPUAxis1(j, 0, 1, 0.1);
    dJointSetPUAxis2(j, 0, -0.1, 1);
    dJointSetPUAxis3(j, 1, 0.1, 0);
}
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    begin();
    CHECKI(dJointCreatePU, dJointGetType(j));
    dVector3 p;
    dJointGetPUAnchor(j, p);
    CHECK(dJointSetPUAnchor, p, 3);
    V3(dJointGetPUAnchor, j);
    dJointGetPUAxis1(j, p);
    CHECK(dJointSetPUAxis1, p, 3);
    V3(dJointGetPUAxis1, j);
    dJointGetPUAxis2(j, p);
    CHECK(dJointSetPUAxis2, p, 3);
    V3(dJointGetPUAxis2, j);
    dJointGetPUAxis3(j, p);
    CHECK(dJointSetPUAxis3, p, 3);
    V3(dJointGetPUAxis3, j);
    dJointSetPUAxisP(j, 1, 0.2, 0.1);
    dJointGetPUAxisP(j, p);
    CHECK(dJointSetPUAxisP, p, 3);
    V3(dJointGetPUAxisP, j);
    run();
    R1(dJointGetPUPosition, j);
    R1(dJointGetPUPositionRate, j);
    R1(dJointGetPUAngle1, j);
    R1(dJointGetPUAngle2, j);
    R1(dJointGetPUAngle1Rate, j);
    R1(dJointGetPUAngle2Rate, j);
    dReal angles[2] = {9, 9};
    dJointGetPUAngles(j, angles, angles + 1);
    CHECK(dJointGetPUAngles, angles, 2);
    MOVES(dJointSetPUAnchor, a);
    dWorldDestroy(w);
    begin();
    dJointSetPUAnchorDelta(j, 0.7, 0.1, 1.2, 0.2, 0.1, 0);
    CHECK1(dJointSetPUAnchorDelta, dJointGetPUPosition(j));
    dWorldDestroy(w);
    begin();
    dJointSetPUAnchorOffset(j, 0.7, 0.1, 1.2, 0.2, 0.1, 0);
    CHECK1(dJointSetPUAnchorOffset, dJointGetPUPosition(j));
    dWorldDestroy(w);
    begin();
    for (int group = 0; group < 3; group++) {
        dJointSetPUParam(j, dParamVel + dParamGroup * group, 0.5);
        dJointSetPUParam(j, dParamFMax + dParamGroup * group, 10);
    }
    R1(dJointGetPUParam, j, dParamFMax3);
    run();
    MOVES(dJointSetPUParam, a);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
