/* Convex polyhedra (octahedra) drop among balls.
   (compared: 27 frames: until two meet, whose depth libode gives as a bound, and Ferrode exactly) */
#include "demo.h"

enum { BODIES = 6 };
static dReal planes[8 * 4], points[6 * 3];
static unsigned polygons[8 * 4];
static dGeomID solids[BODIES], balls[BODIES];

static void make_octahedron(dReal r) {
    int i, k;
    for (i = 0; i < 6; i++) points[3 * i + i / 2] = i % 2 ? -r : r;
    for (i = 0; i < 8; i++) {
        /* One corner on each axis; an odd number of minus signs turns the order round. */
        unsigned corner[3];
        for (k = 0; k < 3; k++) {
            corner[k] = 2 * k + (i >> k & 1);
            planes[4 * i + k] = (i >> k & 1 ? -1 : 1) / sqrt(3.0);
        }
        planes[4 * i + 3] = r / sqrt(3.0);
        polygons[4 * i] = 3;
        k = (i & 1) + (i >> 1 & 1) + (i >> 2 & 1);
        polygons[4 * i + 1] = corner[0];
        polygons[4 * i + 2] = corner[k % 2 ? 2 : 1];
        polygons[4 * i + 3] = corner[k % 2 ? 1 : 2];
    }
}

static void start(void) {
    int i;
    make_world();
    make_octahedron(0.35);
    for (i = 0; i < BODIES; i++) {
        dMatrix3 turn;
        solids[i] = dCreateConvex(space, planes, 8, points, 6, polygons);
        dRFromAxisAndAngle(turn, 1, 1, 0, 0.3 + 0.5 * i);
        dBodySetRotation(give_body(solids[i], 300, 0.8 * (i % 3) - 0.8, 0.4 * (i / 3), 0.8 + 0.9 * (i / 3)), turn);
        balls[i] = dCreateSphere(space, 0.15);
        give_body(balls[i], 300, 0.7 * (i % 3) - 0.75, 0.3 * (i / 3), 2.6 + 0.4 * (i / 3));
    }
    view(2.2f, -3, 1.9f, 125, -22);
}

static void step(int pause) {
    int i;
    if (!pause) advance(4, 0.004);
    for (i = 0; i < BODIES; i++) {
        dsSetColor(0.55f, 0.35f + 0.08f * i, 0.75f);
        dsDrawConvex(dGeomGetPosition(solids[i]), dGeomGetRotation(solids[i]), planes, 8, points, 6, polygons);
        dsSetColor(0.9f, 0.9f, 0.85f);
        draw(balls[i]);
    }
}

int main(int argc, char **argv) { return show(argc, argv, start, step, 0); }
