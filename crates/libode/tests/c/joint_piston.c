/* Pistons: anchor, axis and offsets, position, angle and rates, a motor, a force. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static dJointID j;
static void begin(void) {
    w = dWorldCreate();
    two_bodies(w, &a, &b);
    j = dJointCreatePiston(w, 0);
    dJointAttach(j, a, b);
    dJointSetPistonAnchor(j, 0.7, 0.1, 1.2);
    dJointSetPistonAxis(j, 1, 0.2, 0);
}
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    begin();
    CHECKI(dJointCreatePiston, dJointGetType(j));
    dVector3 p;
    dJointGetPistonAnchor(j, p);
    CHECK(dJointSetPistonAnchor, p, 3);
    V3(dJointGetPistonAnchor, j);
    V3(dJointGetPistonAnchor2, j);
    dJointGetPistonAxis(j, p);
    CHECK(dJointSetPistonAxis, p, 3);
    V3(dJointGetPistonAxis, j);
    run();
    R1(dJointGetPistonPosition, j);
    R1(dJointGetPistonPositionRate, j);
    R1(dJointGetPistonAngle, j);
    R1(dJointGetPistonAngleRate, j);
    MOVES(dJointSetPistonAnchor, a);
    dWorldDestroy(w);
    begin();
    dJointSetPistonAnchorOffset(j, 0.7, 0.1, 1.2, 0.1, 0.2, 0);
    CHECK1(dJointSetPistonAnchorOffset, dJointGetPistonPosition(j));
    run();
    MOVES(dJointSetPistonAnchorOffset, a);
    dWorldDestroy(w);
    begin();
    dJointSetPistonAxisDelta(j, 1, 0, 0, 0.1, 0.2, 0);
    dJointGetPistonAxis(j, p);
    CHECK(dJointSetPistonAxisDelta, p, 3);
    dWorldDestroy(w);
    begin();
    dJointSetPistonParam(j, dParamVel1, 0.5);
    dJointSetPistonParam(j, dParamFMax1, 10);
    R1(dJointGetPistonParam, j, dParamFMax1);
    run();
    MOVES(dJointSetPistonParam, a);
    dWorldDestroy(w);
    begin();
    dJointAddPistonForce(j, 0.6);
    CHECK(dJointAddPistonForce, dBodyGetForce(b), 3);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
