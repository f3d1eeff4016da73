/* Balls, boxes and capsules roll into the valleys of a heightfield. Key w: the land as wires.
   (compared: 26 frames: until a box lies on the land, for which libode has a heuristic) */
#include "demo.h"
#include <math.h>

enum { SIDE = 33, BODIES = 15 };
static double heights[SIDE * SIDE];
static const double WIDTH = 8;
static dGeomID land, bodies[BODIES];
static int wires;
static double triangles[(SIDE - 1) * (SIDE - 1) * 2 * 9];

static void corner(double *at, int i, int j) {
    at[0] = WIDTH * ((double)i / (SIDE - 1) - 0.5);
    at[1] = -WIDTH * ((double)j / (SIDE - 1) - 0.5);
    at[2] = heights[j * SIDE + i];
}

static void start(void) {
    dHeightfieldDataID data;
    dMatrix3 upright;
    double *at = triangles;
    int i, j;
    dInitODE2(0);
    data = dGeomHeightfieldDataCreate();
    world = dWorldCreate();
    space = dHashSpaceCreate(0);
    contacts = dJointGroupCreate(0);
    dWorldSetGravity(world, 0, 0, -9.81);
    for (j = 0; j < SIDE; j++)
        for (i = 0; i < SIDE; i++) {
            double x = (i - 16) / 16.0, y = (j - 16) / 16.0;
            heights[j * SIDE + i] = 0.5 + 0.35 * sin(5 * x) * cos(4 * y) + 0.5 * (x * x + y * y);
        }
    dGeomHeightfieldDataBuildDouble(data, heights, 0, WIDTH, WIDTH, SIDE, SIDE, 1, 0, 1, 0);
    land = dCreateHeightfield(space, data, 1);
    /* A heightfield's heights are along its own y. */
    dRFromAxisAndAngle(upright, 1, 0, 0, M_PI / 2);
    dGeomSetRotation(land, upright);
    for (j = 0; j < SIDE - 1; j++)
        for (i = 0; i < SIDE - 1; i++) {
            corner(at, i, j), corner(at + 3, i, j + 1), corner(at + 6, i + 1, j);
            corner(at + 9, i + 1, j), corner(at + 12, i, j + 1), corner(at + 15, i + 1, j + 1);
            at += 18;
        }
    for (i = 0; i < BODIES; i++) {
        bodies[i] = i % 3 == 0   ? dCreateSphere(space, 0.2)
                    : i % 3 == 1 ? dCreateBox(space, 0.35, 0.3, 0.25)
                                 : dCreateCapsule(space, 0.13, 0.3);
        give_body(bodies[i], 400, 1.1 * (i % 5) - 2.2, 1.2 * (i / 5) - 1.2, 1.8);
    }
    view(5.2f, -4.4f, 4.2f, 140, -32);
}

static void command(int key) {
    if (key == 'w') wires = !wires;
}

static void step(int pause) {
    static const double origin[3] = {0, 0, 0}, unit[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    int i;
    if (!pause) advance(4, 0.004);
    dsSetColor(0.45f, 0.62f, 0.35f);
    dsDrawTrianglesD(origin, unit, triangles, (SIDE - 1) * (SIDE - 1) * 2, !wires);
    for (i = 0; i < BODIES; i++) {
        dsSetColor(i % 3 == 0 ? 0.9f : 0.3f, i % 3 == 1 ? 0.8f : 0.4f, i % 3 == 2 ? 0.9f : 0.3f);
        draw(bodies[i]);
    }
}

int main(int argc, char **argv) { return show(argc, argv, start, step, command); }
