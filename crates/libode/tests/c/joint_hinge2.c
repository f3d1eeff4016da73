/* Hinge-2 joints, as wheels hang on a car: axes, steering stops, a driven axle, suspension. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static dJointID j;
static void begin(void) {
    w = dWorldCreate();
    dWorldSetGravity(w, 0, 0, -5);
    two_bodies(w, &a, &b);
    j = dJointCreateHinge2(w, 0);
    dJointAttach(j, a, b);
    dJointSetHinge2Anchor(j, 1.4, -0.3, 1.1);
    dVector3 up = {0, 0.1, 1}, side = {0, 1, 0.1};
    dJointSetHinge2Axes(j, up, side);
}
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    begin();
    CHECKI(dJointCreateHinge2, dJointGetType(j));
    dVector3 p;
    dJointGetHinge2Anchor(j, p);
    CHECK(dJointSetHinge2Anchor, p, 3);
    V3(dJointGetHinge2Anchor, j);
    V3(dJointGetHinge2Anchor2, j);
    dJointGetHinge2Axis1(j, p);
    CHECK(dJointSetHinge2Axes, p, 3);
    dJointSetHinge2Axis1(j, 0.1, 0, 1);
    dJointGetHinge2Axis1(j, p);
    CHECK(dJointSetHinge2Axis1, p, 3);
    V3(dJointGetHinge2Axis1, j);
    dJointSetHinge2Axis2(j, 0.1, 1, 0);
    dJointGetHinge2Axis2(j, p);
    CHECK(dJointSetHinge2Axis2, p, 3);
    V3(dJointGetHinge2Axis2, j);
    run();
    R1(dJointGetHinge2Angle1, j);
    R1(dJointGetHinge2Angle2, j);
    R1(dJointGetHinge2Angle1Rate, j);
    R1(dJointGetHinge2Angle2Rate, j);
    MOVES(dJointSetHinge2Anchor, a);
    dWorldDestroy(w);
    for (int kind = 0; kind < 2; kind++) {
        begin();
        if (kind == 0) {
            dJointSetHinge2Param(j, dParamSuspensionERP, 0.4);
            dJointSetHinge2Param(j, dParamSuspensionCFM, 0.01);
            R1(dJointGetHinge2Param, j, dParamSuspensionERP);
        } else {
            dJointSetHinge2Param(j, dParamVel2, 3);
            dJointSetHinge2Param(j, dParamFMax2, 5);
            dJointSetHinge2Param(j, dParamLoStop, 0);
            dJointSetHinge2Param(j, dParamHiStop, 0);
        }
        run();
        MOVES(dJointSetHinge2Param, b);
        dWorldDestroy(w);
    }
    begin();
    dJointAddHinge2Torques(j, 0.5, 0.6);
    CHECK(dJointAddHinge2Torques, dBodyGetTorque(b), 3);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
