/* A fan of rays sweeps over bodies; hits and normals are lines, drawn in single precision. */
#include "demo.h"
#undef dsDrawLine

enum { RAYS = 25 };
static dGeomID rays[RAYS];
static dSpaceID beams;
static double angle;

static void start(void) {
    int i;
    make_world();
    beams = dSimpleSpaceCreate(0);
    give_body(dCreateSphere(space, 0.4), 200, -1, 0.2, 0.5);
    give_body(dCreateBox(space, 0.7, 0.5, 0.6), 200, 0.1, -0.2, 0.4);
    give_body(dCreateCapsule(space, 0.2, 0.6), 200, 1.2, 0.1, 0.6);
    for (i = 0; i < RAYS; i++) rays[i] = dCreateRay(beams, 4);
    view(0.4f, -4.2f, 2.3f, 92, -20);
}

static void line(const dReal *a, const dReal *b, double more) {
    float from[3], to[3];
    int k;
    for (k = 0; k < 3; k++) from[k] = (float)a[k], to[k] = (float)(a[k] + more * b[k]);
    dsDrawLine(from, to);
}

static void step(int pause) {
    int i, k;
    if (!pause) advance(4, 0.004), angle += 0.01;
    dsSetColor(0.7f, 0.75f, 0.8f);
    draw_all();
    for (i = 0; i < RAYS; i++) {
        double tilt = 0.12 * (i - RAYS / 2), sweep = 0.5 * sin(angle);
        dVector3 from = {0, 0, 2.6}, along;
        dContactGeom nearest = {.depth = dInfinity}, hits[4];
        dGeomRaySet(rays[i], from[0], from[1], from[2], sin(tilt), cos(tilt) * sin(sweep), -cos(tilt) * cos(sweep));
        dGeomRayGet(rays[i], from, along);
        for (k = 0; k < dSpaceGetNumGeoms(space); k++) {
            int n = dCollide(rays[i], dSpaceGetGeom(space, k), 4, hits, sizeof hits[0]);
            while (n-- > 0)
                if (hits[n].depth < nearest.depth) nearest = hits[n];
        }
        dsSetColor(0.95f, 0.6f, 0.1f);
        line(from, along, nearest.depth < 4 ? nearest.depth : 4);
        dsSetColor(0.1f, 0.3f, 0.9f);
        if (nearest.depth < 4) line(nearest.pos, nearest.normal, 0.25);
    }
}

int main(int argc, char **argv) { return show(argc, argv, start, step, 0); }
