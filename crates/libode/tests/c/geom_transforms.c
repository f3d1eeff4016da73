/* Geom transforms, as old programs offset geoms: the inner geom's place, contact records, clean-up. */
#include "check.h"

/* A class of the program's own: shows what its collider gets to see. */
static dBodyID body;

static int meet(dGeomID a, dGeomID b, int flags, dContactGeom *c, int skip) {
    show("seen at", dGeomGetPosition(a), 3);
    show("turned", dGeomGetRotation(a), 12);
    showi("on the body", body && dGeomGetBody(a) == body);
    dVector3 at = { 1, 2, 3 }, normal = { 1, 0, 0 };
    for (int k = 0; k < 4; k++) c->pos[k] = at[k], c->normal[k] = normal[k];
    c->depth = 0.5;
    c->g1 = a;
    c->g2 = b;
    c->side1 = 3;
    c->side2 = 4;
    return 1;
}

static dColliderFn *choose(int other) {
    showi("asked about class", other);
    return meet;
}

static void cube(dGeomID g, dReal box[6]) {
    const dReal *p = dGeomGetPosition(g);
    for (int k = 0; k < 3; k++) box[2 * k] = p[k] - 1, box[2 * k + 1] = p[k] + 1;
}

static dGeomID known[16];
static int known_count;

static dGeomID know(dGeomID g) { return known[known_count++] = g; }

static int number_of(dGeomID g) {
    for (int i = 0; i < known_count; i++)
        if (known[i] == g) return i;
    return -1;
}

static void meet_both_ways(const char *label, dGeomID a, dGeomID b, int flags) {
    for (int way = 0; way < 2; way++) {
        dContact c[8];
        int n = dCollide(way ? b : a, way ? a : b, flags, &c[0].geom, sizeof c[0]);
        showi(label, n);
        for (int i = 0; i < n; i++) {
            show("at", c[i].geom.pos, 3);
            show("normal", c[i].geom.normal, 3);
            show1("depth", c[i].geom.depth);
            printf("between %d %d sides %d %d\n", number_of(c[i].geom.g1), number_of(c[i].geom.g2), c[i].geom.side1, c[i].geom.side2);
        }
    }
}

static dGeomID wrapped(dGeomID inner, dReal x, dReal y, dReal z, dReal angle) {
    dGeomID wrapper = know(dCreateGeomTransform(0));
    dMatrix3 r;
    dRFromAxisAndAngle(r, 0, 0, 1, angle);
    dGeomTransformSetGeom(wrapper, inner);
    dGeomSetPosition(wrapper, x, y, z);
    dGeomSetRotation(wrapper, r);
    return wrapper;
}

/* Wrappers in either place and within each other, around shapes, and around and against a class of the program's. */
static void pairs(void) {
    dGeomID big = know(dCreateBox(0, 10, 10, 2)), small = know(dCreateBox(0, 1, 1, 1)), ball = know(dCreateSphere(0, 0.7));
    dGeomID inner = know(dCreateBox(0, 1, 1, 1));
    dGeomClass record = { 0, choose, cube, 0, 0 };
    int own = dCreateGeomClass(&record);
    dGeomID mine = know(dCreateGeom(own)), other = know(dCreateGeom(own));
    dGeomSetPosition(inner, 0, 0, 0.1);
    dGeomSetPosition(small, 0.1, 0.2, 1.4);
    dGeomSetPosition(ball, 0.3, 0, 1.5);
    dGeomSetPosition(mine, 0, 0, 0.25);
    dGeomSetPosition(other, 5, 0, 0);
    dGeomID floor = wrapped(big, 0, 0, 0.05, 0), once = wrapped(inner, 0.1, 0, 1.3, 0.3), twice = wrapped(once, 0.4, 0, 0, 0.2);
    dGeomID of_mine = wrapped(mine, 1, 2, 3, 0.5);
    dSpaceID space = dSimpleSpaceCreate(0);
    dSpaceAdd(space, small);
    for (int info = 0; info < 4; info++) {
        dGeomTransformSetInfo(floor, info & 1);
        dGeomTransformSetInfo(once, info & 1);
        dGeomTransformSetInfo(twice, info >> 1);
        dGeomTransformSetInfo(of_mine, info & 1);
        meet_both_ways("floor, small", floor, small, 8);
        meet_both_ways("floor, space", floor, (dGeomID)space, 8);
        meet_both_ways("floor, twice", floor, twice, 8);
        meet_both_ways("three of floor, twice", floor, twice, 3);
        meet_both_ways("floor, other", floor, other, 8);
        meet_both_ways("twice, ball", twice, ball, 8);
        meet_both_ways("twice, other", twice, other, 8);
        meet_both_ways("of mine, ball", of_mine, ball, 8);
        meet_both_ways("of mine, other", of_mine, other, 8);
    }
    meet_both_ways("mine, other", mine, other, 8);
    dReal box[6];
    dGeomGetAABB(of_mine, box);
    show("box of mine", box, 6);
    dGeomGetAABB(twice, box);
    show("box of twice", box, 6);
    dWorldID world = dWorldCreate();
    body = dBodyCreate(world);
    dGeomSetBody(of_mine, body);
    dBodySetPosition(body, 7, 8, 9);
    meet_both_ways("of mine on a body", of_mine, ball, 8);
    dGeomSetOffsetPosition(of_mine, 0, 0, -5);
    meet_both_ways("of mine off a body", of_mine, ball, 8);
    show("mine afterwards", dGeomGetPosition(mine), 3);
    showi("on no body", dGeomGetBody(mine) == 0);
}

int main(void) {
    dInitODE2(0);
    pairs();
    dGeomID wrapper = dCreateGeomTransform(0), inner = dCreateSphere(0, 0.5), ground = dCreatePlane(0, 0, 0, 1, 0);
    CHECKI(dCreateGeomTransform, dGeomGetClass(wrapper));
    dGeomSetPosition(inner, 0.5, 0, 1);
    dGeomTransformSetGeom(wrapper, inner);
    CHECKI(dGeomTransformSetGeom, dGeomTransformGetGeom(wrapper) == inner);
    CHECKI(dGeomTransformGetGeom, dGeomTransformGetGeom(wrapper) == inner);
    dMatrix3 r;
    dRFromAxisAndAngle(r, 0, 1, 0, 0.5);
    dGeomSetPosition(wrapper, 1, 0, -0.7);
    dGeomSetRotation(wrapper, r);
    dReal aabb[6];
    dGeomGetAABB(wrapper, aabb);
    CHECK(dGeomTransformSetGeom, aabb, 6);
    for (int info = 0; info < 2; info++) {
        dGeomTransformSetInfo(wrapper, info);
        I1(dGeomTransformGetInfo, wrapper);
        dContactGeom c;
        showi("contacts", dCollide(wrapper, ground, 1, &c, sizeof c));
        show("at", c.pos, 3);
        show1("depth", c.depth);
        CHECKI(dGeomTransformSetInfo, c.g1 == wrapper);
    }
    dGeomTransformSetCleanup(wrapper, 1);
    CHECKI(dGeomTransformSetCleanup, dGeomTransformGetCleanup(wrapper));
    I1(dGeomTransformGetCleanup, wrapper);
    dGeomDestroy(wrapper);
    dGeomDestroy(ground);
    dCloseODE();
    return 0;
}
