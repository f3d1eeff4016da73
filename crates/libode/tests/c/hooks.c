/* The box test of a program's own geom class: it vetoes pairs in every kind of space, and in dCollide of a space. */
#include "check.h"

static dGeomID geoms[12];
static int number(dGeomID g) {
    for (int i = 0; i < 12; i++)
        if (geoms[i] == g) return i;
    return -1;
}
static int calls, colliders;
static int touch(dGeomID a, dGeomID b, int flags, dContactGeom *c, int skip) {
    (void)flags, (void)skip;
    colliders++;
    dReal from[4] = {0.1, 0.2, 0.3, 0}, up[4] = {0, 0, 1, 0};
    memcpy(c->pos, from, sizeof from);
    memcpy(c->normal, up, sizeof up);
    c->depth = 0.5;
    c->g1 = a;
    c->g2 = b;
    c->side1 = c->side2 = -1;
    return 1;
}
static dColliderFn *choose(int other) { return other == dSphereClass || other >= dFirstUserClass ? touch : 0; }
static void aabb(dGeomID g, dReal box[6]) {
    const dReal *p = dGeomGetPosition(g);
    for (int i = 0; i < 6; i++) box[i] = p[i / 2] + (i % 2 ? 1 : -1);
}
static int test(dGeomID a, dGeomID b, dReal box[6]) {
    calls++;
    return (number(a) + number(b)) % 3 != 0 && box[0] > -5;
}
static void near(void *data, dGeomID a, dGeomID b) {
    (void)data;
    int i = number(a), j = number(b);
    printf("pair %d %d\n", i < j ? i : j, i < j ? j : i);
}

int main(void) {
    dInitODE2(0);
    dGeomClass description = {16, choose, aabb, test, 0};
    int number_of_class = dCreateGeomClass(&description);
    showi("class", number_of_class);
    for (int kind = 0; kind < 3; kind++) {
        dSpaceID space = kind == 0 ? dSimpleSpaceCreate(0) : kind == 1 ? dHashSpaceCreate(0)
            : dSweepAndPruneSpaceCreate(0, dSAP_AXES_XYZ);
        for (int i = 0; i < 12; i++) {
            geoms[i] = i % 2 ? dCreateGeom(number_of_class) : dCreateSphere(0, 0.8);
            dSpaceAdd(space, geoms[i]);
            dGeomSetPosition(geoms[i], 0.7 * i, 0.1 * i, 0);
        }
        dSpaceCollide(space, 0, near);
        showi("asked", calls > 0);
        dSpaceCollide2(geoms[3], (dGeomID)space, 0, near);
        dSpaceCollide2(geoms[3], geoms[4], 0, near);
        dSpaceCollide2(geoms[4], geoms[5], 0, near);
        dSpaceRemove(space, geoms[4]);
        dContactGeom c[8];
        int n = dCollide(geoms[4], (dGeomID)space, 8, c, sizeof *c);
        showi("contacts", n);
        showi("straight", dCollide(geoms[4], geoms[5], 8, c, sizeof *c));
        show("normal", c[0].normal, 3);
        showi("named", c[0].g1 == geoms[4] && c[0].g2 == geoms[5]);
        dGeomDestroy(geoms[4]);
        dSpaceDestroy(space);
    }
    showi("colliders", colliders > 0);
    dCloseODE();
    return 0;
}
