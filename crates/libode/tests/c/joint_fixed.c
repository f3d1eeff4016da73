/* Fixed joints hold a pose, to a body and to the world; null joints do nothing. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    for (int kind = 0; kind < 4; kind++) {
        w = dWorldCreate();
        dWorldSetGravity(w, 0, 0, -9.81);
        two_bodies(w, &a, &b);
        dJointID j = kind < 3 ? dJointCreateFixed(w, 0) : dJointCreateNull(w, 0);
        dJointAttach(j, a, kind == 1 ? 0 : b);
        if (kind < 3) dJointSetFixed(j);
        if (kind == 2) {
            dJointSetFixedParam(j, dParamCFM, 0.05);
            dJointSetFixedParam(j, dParamERP, 0.1);
            R1(dJointGetFixedParam, j, dParamCFM);
        }
        run();
        if (kind < 2) MOVES(dJointSetFixed, a);
        if (kind == 0) CHECKI(dJointCreateFixed, dJointGetType(j));
        if (kind == 2) MOVES(dJointSetFixedParam, a);
        if (kind == 3) CHECKI(dJointCreateNull, dJointGetType(j));
        if (kind == 3) MOVES(dJointCreateNull, a);
        dWorldDestroy(w);
    }
    dCloseODE();
    return 0;
}
