/* What outlives what: geoms without their body's world, members of a space without it, classes after the last close. */
#include "check.h"

static int ended;
static dColliderFn *none(int other) { (void)other; return 0; }
static void nowhere(dGeomID g, dReal aabb[6]) { (void)g; for (int i = 0; i < 6; i++) aabb[i] = 0; }
static void end(dGeomID g) { (void)g; ended++; }

int main(void) {
    I1(dInitODE2, 0);
    dGeomClass description = {8, none, nowhere, 0, end};
    I1(dCreateGeomClass, &description);
    I1(dCreateGeomClass, &description);
    dWorldID w = dWorldCreate();
    dBodyID b = dBodyCreate(w);
    dGeomID ball = dCreateSphere(0, 1);
    dGeomSetBody(ball, b);
    dWorldDestroy(w);
    CHECKI(dWorldDestroy, dGeomGetBody(ball) == 0);
    dGeomDestroy(ball);
    dSpaceID space = dSimpleSpaceCreate(0);
    dGeomID own = dCreateGeom(dFirstUserClass), second = dCreateGeom(dFirstUserClass + 1);
    dSpaceAdd(space, own);
    dSpaceAdd(space, second);
    dGeomDestroy(second);
    CHECKI(dGeomDestroy, ended * 10 + dSpaceGetNumGeoms(space));
    dSpaceDestroy(space);
    CHECKI(dSpaceDestroy, ended);
    dCloseODE();
    dInitODE2(0);
    /* Numbers begin anew. */
    CHECKI(dCloseODE, dCreateGeomClass(&description));
    dCloseODE();
    dInitODE();
    CHECKI(dInitODE, dCreateGeomClass(&description));
    dCloseODE();
    return 0;
}
