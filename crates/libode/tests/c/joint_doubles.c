/* Double ball and double hinge joints: a rod of given length between two anchors. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    dVector3 p;
    w = dWorldCreate();
    two_bodies(w, &a, &b);
    dJointID j = dJointCreateDBall(w, 0);
    CHECKI(dJointCreateDBall, dJointGetType(j));
    dJointAttach(j, a, b);
    dJointSetDBallAnchor1(j, 0.2, 0.1, 1.2);
    dJointGetDBallAnchor1(j, p);
    CHECK(dJointSetDBallAnchor1, p, 3);
    V3(dJointGetDBallAnchor1, j);
    dJointSetDBallAnchor2(j, 1.2, 0.2, 1.1);
    dJointGetDBallAnchor2(j, p);
    CHECK(dJointSetDBallAnchor2, p, 3);
    V3(dJointGetDBallAnchor2, j);
    R1(dJointGetDBallDistance, j);
    dJointSetDBallDistance(j, 1.05);
    CHECK1(dJointSetDBallDistance, dJointGetDBallDistance(j));
    dJointSetDBallParam(j, dParamERP, 0.5);
    R1(dJointGetDBallParam, j, dParamERP);
    run();
    MOVES(dJointSetDBallParam, a);
    dWorldDestroy(w);

    w = dWorldCreate();
    two_bodies(w, &a, &b);
    j = dJointCreateDHinge(w, 0);
    CHECKI(dJointCreateDHinge, dJointGetType(j));
    dJointAttach(j, a, b);
    dJointSetDHingeAxis(j, 0, 0.1, 1);
    dJointGetDHingeAxis(j, p);
    CHECK(dJointSetDHingeAxis, p, 3);
    V3(dJointGetDHingeAxis, j);
    dJointSetDHingeAnchor1(j, 0.2, 0.1, 1.2);
    dJointGetDHingeAnchor1(j, p);
    CHECK(dJointSetDHingeAnchor1, p, 3);
    V3(dJointGetDHingeAnchor1, j);
    dJointSetDHingeAnchor2(j, 1.2, 0.2, 1.1);
    dJointGetDHingeAnchor2(j, p);
    CHECK(dJointSetDHingeAnchor2, p, 3);
    V3(dJointGetDHingeAnchor2, j);
    R1(dJointGetDHingeDistance, j);
    dJointSetDHingeParam(j, dParamCFM, 0.02);
    R1(dJointGetDHingeParam, j, dParamCFM);
    run();
    MOVES(dJointSetDHingeParam, a);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
