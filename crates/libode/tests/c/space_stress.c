/* Spaces within spaces under stress: geoms of all plain kinds that move, change bits, are destroyed and come
   again elsewhere; pairs are counted by kind, in three kinds of spaces. */
#include "check.h"

enum { GEOMS = 60, ROOMS = 5 };
static unsigned seed = 12345;
static double number(void) {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) / 16777216.0;
}
static long pairs, contacts, levels;
static double depths;
static void near(void *data, dGeomID a, dGeomID b) {
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
        levels++;
        dSpaceCollide2(a, b, data, near);
        return;
    }
    pairs++;
    dContactGeom c[6];
    int n = dCollide(a, b, 6, c, sizeof *c);
    contacts += n > 0;
    for (int i = 0; i < n; i++)
        if (c[i].depth > depths) depths = c[i].depth;
}
static dGeomID shape(dSpaceID s, int kind) {
    switch (kind) {
    case 0: return dCreateSphere(s, 0.2 + 0.5 * number());
    case 1: return dCreateBox(s, 0.3 + number(), 0.4, 0.3 + number());
    case 2: return dCreateCapsule(s, 0.2 + 0.2 * number(), 0.5 + number());
    default: return dCreateRay(s, 1 + number());
    }
}
static dSpaceID room(int kind, dSpaceID parent) {
    const dVector3 middle = {0, 0, 0}, extents = {8, 8, 8};
    switch (kind) {
    case 0: return dSimpleSpaceCreate(parent);
    case 1: return dQuadTreeSpaceCreate(parent, middle, extents, 4);
    default: return dSweepAndPruneSpaceCreate(parent, dSAP_AXES_XZY);
    }
}
static void stress(int kind) {
    dSpaceID top = room(kind, 0), rooms[ROOMS];
    for (int i = 0; i < ROOMS; i++) {
        rooms[i] = room(i % 2 ? kind : 0, i > 2 ? rooms[i - 2] : top);
        dSpaceSetSublevel(rooms[i], i > 2);
    }
    dGeomID geoms[GEOMS];
    for (int i = 0; i < GEOMS; i++) {
        geoms[i] = shape(i % 3 ? rooms[i % ROOMS] : top, i % 4);
        dGeomSetCategoryBits(geoms[i], 1ul << i % 6);
        dGeomSetCollideBits(geoms[i], i % 5 ? ~0ul : 0x15);
    }
    for (int step = 0; step < 25; step++) {
        for (int i = 0; i < GEOMS; i++) {
            if (!geoms[i]) continue;
            if (number() < 0.7) dGeomSetPosition(geoms[i], 8 * number() - 4, 8 * number() - 4, 4 * number());
            if (number() < 0.1) {
                dQuaternion q = {(dReal)(number() + 0.1), (dReal)number(), (dReal)number(), 0};
                dNormalize4(q);
                dGeomSetQuaternion(geoms[i], q);
            }
            double fate = number();
            if (fate < 0.06) dGeomSetCollideBits(geoms[i], (unsigned long)(64 * number()));
            else if (fate < 0.1) {
                /* libode aborts now and then when geoms change between nested spaces: another one takes its place. */
                dGeomDestroy(geoms[i]);
                geoms[i] = shape(rooms[(int)(ROOMS * number())], i % 4);
            } else if (fate < 0.11) {
                dGeomDestroy(geoms[i]);
                geoms[i] = 0;
            } else if (fate < 0.12) {
                dGeomDestroy(geoms[i]);
                geoms[i] = shape(top, step % 4);
            }
        }
        pairs = contacts = levels = 0;
        depths = 0;
        dSpaceCollide(top, &step, near);
        for (int i = 0; i < ROOMS; i++) dSpaceCollide(rooms[i], &step, near);
        dSpaceCollide2((dGeomID)rooms[0], (dGeomID)rooms[1], &step, near);

        printf("%ld pairs, %ld touch, %ld of spaces, deepest %.9g\n", pairs, contacts, levels, depths);
        dReal box[6];
        dGeomGetAABB((dGeomID)rooms[2], box);
        show("box", box, 6);
    }
    showi("members", dSpaceGetNumGeoms(top));
    for (int i = 0; i < ROOMS; i++) showi("members", dSpaceGetNumGeoms(rooms[i]));
    dSpaceDestroy(top);
}

int main(void) {
    dInitODE2(0);
    for (int kind = 0; kind < 3; kind++) stress(kind);
    dCloseODE();
    return 0;
}
