/* Cleaning a space asks the moved members of a program's own class for their boxes once, and nobody else. */
#include "check.h"

static int asked;
static dColliderFn *none(int other) { (void)other; return 0; }
static void around(dGeomID g, dReal aabb[6]) {
    asked++;
    for (int i = 0; i < 6; i++) aabb[i] = dGeomGetPosition(g)[i / 2] + (i % 2 ? 1 : -1);
}

int main(void) {
    dInitODE2(0);
    dGeomClass description = {0, none, around, 0, 0};
    int number = dCreateGeomClass(&description);
    dSpaceID s = dSimpleSpaceCreate(0);
    dGeomID g[3];
    for (int i = 0; i < 3; i++) {
        g[i] = dCreateGeom(number);
        dSpaceAdd(s, g[i]);
    }
    dSpaceClean(s);
    CHECKI(dSpaceClean, asked);
    asked = 0;
    dSpaceClean(s);
    CHECKI(dSpaceClean, asked);
    dGeomSetPosition(g[1], 3, 0, 0);
    dSpaceClean(s);
    CHECKI(dSpaceClean, asked);
    asked = 0;
    dGeomMoved(g[2]);
    dSpaceClean(s);
    CHECKI(dGeomMoved, asked);
    dSpaceDestroy(s);
    dCloseODE();
    return 0;
}
