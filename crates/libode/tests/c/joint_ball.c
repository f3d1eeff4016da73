/* Ball joints: anchors, parameters, and how two bodies move on one. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    dBodyID a, b;
    two_bodies(w, &a, &b);
    dJointID j = dJointCreateBall(w, 0);
    CHECKI(dJointCreateBall, dJointGetType(j));
    I1(dJointGetType, j);
    dJointAttach(j, a, b);
    dVector3 p;
    dJointSetBallAnchor(j, 0.7, 0.1, 1.2);
    dJointGetBallAnchor(j, p);
    CHECK(dJointSetBallAnchor, p, 3);
    V3(dJointGetBallAnchor, j);
    dJointSetBallAnchor2(j, 0.65, 0.05, 1.25);
    dJointGetBallAnchor2(j, p);
    CHECK(dJointSetBallAnchor2, p, 3);
    V3(dJointGetBallAnchor2, j);
    dJointSetBallParam(j, dParamCFM, 0.01);
    R1(dJointGetBallParam, j, dParamCFM);
    for (int i = 0; i < 10; i++) dWorldStep(w, 0.02);
    MOVES(dJointSetBallParam, a);
    MOVES(dJointAttach, b);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
