/* Spaces of all kinds: members, pairs and their order, locks, nested spaces, and a pile that falls in one. */
#include "check.h"

enum { N = 24 };
static dGeomID geoms[N];
static dSpaceID spaces[4];
static int pairs;

static int number(dGeomID g) {
    for (int i = 0; i < N; i++)
        if (geoms[i] == g) return i;
    for (int i = 0; i < 4; i++)
        if ((dGeomID)spaces[i] == g) return 100 + i;
    return -1;
}

static void near(void *data, dGeomID a, dGeomID b) {
    /* libode pairs a member with itself when it is the single geom; there is nothing to collide. */
    if (a == b) return;
    if (data) printf("%s %d %d\n", (const char *)data, number(a), number(b));
    pairs++;
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
        dSpaceCollide2(a, b, data, near);
        if (dGeomIsSpace(a)) dSpaceCollide((dSpaceID)a, data, near);
        if (dGeomIsSpace(b)) dSpaceCollide((dSpaceID)b, data, near);
    }
}

static dReal noise(void) { return dRandReal() * 2 - 1; }

static void place(dGeomID g) {
    dMatrix3 r;
    dGeomSetPosition(g, 2 * noise(), 2 * noise(), 2 * noise());
    dRFromAxisAndAngle(r, noise(), noise(), noise(), 3 * noise());
    dGeomSetRotation(g, r);
}

static dSpaceID create(int kind, dSpaceID parent) {
    dVector3 center = {0, 0, 0, 0}, half = {4, 4, 4, 0};
    switch (kind) {
    case 0: return dSimpleSpaceCreate(parent);
    case 1: return dHashSpaceCreate(parent);
    case 2: return dQuadTreeSpaceCreate(parent, center, half, 4);
    default: return dSweepAndPruneSpaceCreate(parent, dSAP_AXES_XZY);
    }
}

static dWorldID world;
static dJointGroupID group;
static void touch(void *data, dGeomID a, dGeomID b) {
    dContact c[8];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 8, &c[0].geom, sizeof *c);
    for (int i = 0; i < n; i++) {
        c[i].surface.mode = dContactApprox1 | dContactBounce;
        c[i].surface.mu = 0.6;
        c[i].surface.bounce = 0.1;
        c[i].surface.bounce_vel = 0.05;
        dJointAttach(dJointCreateContact(world, group, &c[i]), dGeomGetBody(a), dGeomGetBody(b));
        pairs++;
    }
}

static jmp_buf back;
static void caught(int n, const char *text, va_list arguments) {
    (void)text, (void)arguments;
    printf("caught %d\n", n);
    longjmp(back, 1);
}
static void meddle(void *data, dGeomID a, dGeomID b) {
    (void)b;
    if (data) dSpaceRemove(dGeomGetSpace(a), a);
    else dGeomSetPosition(a, 0, 0, 0);
}

int main(void) {
    dInitODE2(0);
    for (int kind = 0; kind < 4; kind++) {
        printf("kind %d\n", kind);
        dRandSetSeed(7);
        dSpaceID space = create(kind, 0);
        I1(dSpaceGetClass, space);
        I1(dGeomGetClass, (dGeomID)space);
        I1(dGeomIsSpace, (dGeomID)space);
        I1(dSpaceGetCleanup, space);
        I1(dSpaceGetSublevel, space);
        I1(dSpaceGetManualCleanup, space);
        dSpaceSetManualCleanup(space, 1);
        dSpaceSetSublevel(space, 3);
        I1(dSpaceGetSublevel, space);
        dSpaceSetSublevel(space, 0);
        dReal aabb[6];
        dGeomGetAABB((dGeomID)space, aabb);
        show("empty", aabb, 6);
        if (kind == 1) {
            int low, high;
            dHashSpaceGetLevels(space, &low, &high);
            printf("levels %d %d\n", low, high);
            dHashSpaceSetLevels(space, -2, 5);
            dHashSpaceGetLevels(space, &low, &high);
            dHashSpaceGetLevels(space, 0, 0);
            printf("levels %d %d\n", low, high);
        }
        for (int i = 0; i < N; i++) {
            dReal size = 0.2 + 0.8 * dRandReal();
            dSpaceID into = i % 3 ? space : 0;
            geoms[i] = i % 4 == 0 ? dCreateSphere(into, size) : i % 4 == 1 ? dCreateBox(into, size, 1, 0.4)
                : i % 4 == 2 ? dCreateCapsule(into, size / 2, 0.5) : dCreateCylinder(into, size, 0.5);
            if (i == 23) {
                dGeomDestroy(geoms[i]);
                geoms[i] = dCreatePlane(space, 0, 0, 1, -1);
            } else
                place(geoms[i]);
            if (!into && i != 23) dSpaceAdd(space, geoms[i]);
            showi("query", dSpaceQuery(space, geoms[i]));
        }
        I1(dSpaceGetNumGeoms, space);
        if (kind != 2)
            for (int i = 0; i < N; i++) printf("member %d\n", number(dSpaceGetGeom(space, i)));
        dSpaceCollide(space, "pair", near);
        for (int i = 0; i < N; i += 5) place(geoms[i]);
        dGeomDisable(geoms[1]);
        dGeomSetCategoryBits(geoms[2], 0);
        dGeomSetCollideBits(geoms[2], 0);
        dGeomSphereSetRadius(geoms[4], 0);
        dSpaceCollide(space, "again", near);
        dSpaceCollide2((dGeomID)space, geoms[22], "single", near);
        dSpaceRemove(space, geoms[21]);
        showi("query", dSpaceQuery(space, geoms[21]));
        showi("space", dGeomGetSpace(geoms[21]) == 0 && dGeomGetSpace(geoms[20]) == space);
        I1(dSpaceGetNumGeoms, space);
        dSpaceCollide2(geoms[21], (dGeomID)space, "foreign", near);
        dSpaceCollide2(geoms[21], geoms[20], "two", near);
        dSpaceClean(space);
        dGeomGetAABB((dGeomID)space, aabb);
        show("full", aabb, 6);
        dContactGeom c[5];
        int n = dCollide(geoms[21], (dGeomID)space, 5, c, sizeof *c);
        showi("contacts", n);
        for (int i = 0; i < n; i++) {
            printf("between %d %d\n", number(c[i].g1), number(c[i].g2));
            show("pos", c[i].pos, 3);
        }


        dSetDebugHandler(caught);
        if (!setjmp(back)) dSpaceAdd(space, geoms[20]);
        if (!setjmp(back)) dSpaceRemove(space, geoms[21]);
        dSetDebugHandler(0);
        dGeomDestroy(geoms[21]);
        dSpaceSetCleanup(space, 0);
        I1(dSpaceGetCleanup, space);
        dSpaceDestroy(space);
        showi("left", dGeomGetSpace(geoms[0]) == 0);
        for (int i = 0; i < N; i++)
            if (i != 21) dGeomDestroy(geoms[i]);
    }

    /* spaces within spaces */
    for (int kind = 0; kind < 4; kind++) {
        printf("nested %d\n", kind);
        spaces[0] = create(kind, 0);
        spaces[1] = dSimpleSpaceCreate(spaces[0]);
        spaces[2] = dHashSpaceCreate(spaces[0]);
        spaces[3] = create(kind, spaces[2]);
        for (int i = 0; i < N; i++) {
            geoms[i] = dCreateSphere(spaces[i % 4], 0.8);
            place(geoms[i]);
        }
        pairs = 0;
        dSpaceCollide(spaces[0], kind == 0 ? "nested" : 0, near);
        showi("pairs", pairs);
        pairs = 0;
        dSpaceCollide2((dGeomID)spaces[1], (dGeomID)spaces[3], "across", near);
        dSpaceSetSublevel(spaces[1], 2);
        dSpaceCollide2((dGeomID)spaces[1], (dGeomID)spaces[3], "level", near);
        showi("pairs", pairs);
        dSetDebugHandler(caught);
        if (!setjmp(back)) dSpaceCollide(spaces[1], 0, meddle);
        if (!setjmp(back)) dSpaceCollide(spaces[3], "remove", meddle);
        dSetDebugHandler(0);

    }

    /* a pile */
    for (int kind = 0; kind < 4; kind++) {
        world = dWorldCreate();
        group = dJointGroupCreate(0);
        dWorldSetGravity(world, 0, 0, -9.81);
        dWorldSetAutoDisableFlag(world, 1);
        dRandSetSeed(3);
        dSpaceID space = create(kind, 0);
        dCreatePlane(space, 0, 0, 1, 0);
        dBodyID bodies[8];
        for (int i = 0; i < 8; i++) {
            dMass m;
            bodies[i] = dBodyCreate(world);
            dMassSetBox(&m, 1, 0.5, 0.5, 0.5);
            dBodySetMass(bodies[i], &m);
            dGeomSetBody(i % 2 ? dCreateBox(space, 0.5, 0.5, 0.5) : dCreateSphere(space, 0.25), bodies[i]);
            dBodySetPosition(bodies[i], 0.02 * i, 0.01 * i * i, 0.3 + 0.6 * i);
        }
        pairs = 0;
        for (int step = 0; step < 40; step++) {
            dSpaceCollide(space, 0, touch);
            if (step % 2) dWorldQuickStep(world, 0.01);
            else dWorldStep(world, 0.01);
            dJointGroupEmpty(group);
        }
        showi("contacts", pairs);
        for (int i = 0; i < 8; i++) show("at", dBodyGetPosition(bodies[i]), 3);
        dJointGroupDestroy(group);
        dSpaceDestroy(space);
        dWorldDestroy(world);
    }
    dCloseODE();
    return 0;
}
