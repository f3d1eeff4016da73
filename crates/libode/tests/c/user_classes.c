/* A class of the program's own with data of its own, and a collider put in the place of a built-in one. */
#include "check.h"

static int ended;
static int touch(dGeomID a, dGeomID b, int flags, dContactGeom *c, int skip) {
    (void)flags, (void)skip;
    memset(c, 0, sizeof *c);
    c->normal[2] = 1;
    c->depth = *(dReal *)dGeomGetClassData(a);
    c->g1 = a;
    c->g2 = b;
    return 1;
}
static int replaced(dGeomID a, dGeomID b, int flags, dContactGeom *c, int skip) {
    (void)flags, (void)skip;
    memset(c, 0, sizeof *c);
    c->normal[0] = 1;
    c->depth = 42;
    c->g1 = a;
    c->g2 = b;
    return 1;
}
static dColliderFn *choose(int other) { return other == dPlaneClass ? touch : 0; }
static void around(dGeomID g, dReal aabb[6]) {
    for (int i = 0; i < 6; i++) aabb[i] = dGeomGetPosition(g)[i / 2] + (i % 2 ? 0.5 : -0.5);
}
static void end(dGeomID g) { (void)g; ended++; }

int main(void) {
    dInitODE2(0);
    dGeomClass description = {(int)sizeof(dReal), choose, around, 0, end};
    int number = dCreateGeomClass(&description);
    CHECKI(dCreateGeomClass, number);
    dGeomID own = dCreateGeom(number), plane = dCreatePlane(0, 0, 0, 1, 0), ball = dCreateSphere(0, 1), box = dCreateBox(0, 1, 1, 1);
    CHECKI(dCreateGeom, dGeomGetClass(own));
    *(dReal *)dGeomGetClassData(own) = 0.75;
    dGeomSetPosition(own, 1, 2, 3);
    dReal aabb[6];
    dGeomGetAABB(own, aabb);
    show("aabb", aabb, 6);
    dContactGeom c;
    showi("contacts", dCollide(own, plane, 1, &c, sizeof c));
    CHECK1(dGeomGetClassData, c.depth);
    showi("contacts", dCollide(plane, own, 1, &c, sizeof c));
    show("normal", c.normal, 3);
    showi("contacts", dCollide(own, ball, 1, &c, sizeof c));
    dSetColliderOverride(dSphereClass, dBoxClass, replaced);
    showi("contacts", dCollide(ball, box, 1, &c, sizeof c));
    CHECK1(dSetColliderOverride, c.depth);
    dGeomDestroy(own);
    CHECKI(dGeomDestroy, ended);
    dGeomDestroy(ball);
    dGeomDestroy(box);
    dGeomDestroy(plane);
    dCloseODE();
    return 0;
}
