/* A convex pyramid: its box, half-spaces that cut it, then other arrays in its place. */
#include "check.h"

static const dReal points[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 2},
                   low[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 1};
static dReal planes[20], low_planes[20];
static const unsigned faces[] = {4, 3, 2, 1, 0, 3, 0, 1, 4, 3, 1, 2, 4, 3, 2, 3, 4, 3, 3, 0, 4};
static void slopes(dReal *p, dReal height) {
    dReal l = sqrt(height * height + 1);
    static const int side[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    p[0] = p[1] = p[3] = 0;
    p[2] = -1;
    for (int i = 0; i < 4; i++) {
        p += 4;
        p[0] = side[i][0] * height / l;
        p[1] = side[i][1] * height / l;
        p[2] = 1 / l;
        p[3] = height / l;
    }
}

int main(void) {
    dInitODE2(0);
    slopes(planes, 2);
    slopes(low_planes, 1);
    dReal aabb[6];
    dGeomID g = dCreateConvex(0, planes, 5, points, 5, faces);
    dGeomID half[] = {dCreatePlane(0, 0, 0, 1, 0.25), dCreatePlane(0, 0, 0, -1, -0.75), dCreatePlane(0, 0.6, 0, -0.8, -1)};
    dGeomGetAABB(g, aabb);
    CHECK(dCreateConvex, aabb, 6);
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < 3; i++) {
            dContactGeom c[8];
            int n = dCollide(g, half[i], 8, c, sizeof *c);
            dReal deepest = 0;
            for (int k = 0; k < n; k++) if (c[k].depth > deepest) deepest = c[k].depth;
            showi("corners inside", n);
            if (pass) CHECK1(dGeomSetConvex, deepest); else CHECK1(dCreateConvex, deepest);
        }
        if (pass == 0) dGeomSetConvex(g, low_planes, 5, low, 5, faces);
    }
    dGeomSetPosition(g, 0, 0, 0);
    dGeomGetAABB(g, aabb);
    CHECK(dGeomSetConvex, aabb, 6);
    dGeomDestroy(g);
    for (int i = 0; i < 3; i++) dGeomDestroy(half[i]);
    dCloseODE();
    return 0;
}
