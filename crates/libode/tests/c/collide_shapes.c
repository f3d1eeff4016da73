/* dCollide of all pairs of plain shapes in many poses, the flags and strides it takes, and the functions without geoms. */
#include "check.h"

enum { MAX = 16 };

static void show_contacts(int n, const dContact *c, dGeomID a, dGeomID b) {
    showi("n", n);
    for (int i = 0; i < n; i++) {
        const dContactGeom *g = &c[i].geom;
        printf("%d %d %d %d", g->g1 == a, g->g2 == b, g->side1, g->side2);
        for (int k = 0; k < 3; k++) printf(" %.13g", g->pos[k] + 0.0);
        for (int k = 0; k < 3; k++) printf(" %.13g", g->normal[k] + 0.0);
        printf(" %.13g\n", g->depth + 0.0);
    }
}

static int by_place(const void *a, const void *b) {
    const dReal *p = ((const dContact *)a)->geom.pos, *q = ((const dContact *)b)->geom.pos;
    dReal d = p[0] + 0.3 * p[1] - q[0] - 0.3 * q[1];
    return d < 0 ? -1 : d > 0;
}

static dReal noise(void) { return dRandReal() * 2 - 1; }

static void scatter(dGeomID g, dReal reach) {
    dMatrix3 r;
    if (dGeomGetClass(g) == dPlaneClass) return;
    dGeomSetPosition(g, reach * noise(), reach * noise(), reach * noise());
    dRFromAxisAndAngle(r, noise(), noise(), noise(), 3 * noise());
    dGeomSetRotation(g, r);
}

int main(void) {
    dInitODE2(0);
    dGeomID shapes[] = {
        dCreateSphere(0, 0.7), dCreateBox(0, 1, 1.5, 0.8), dCreateCapsule(0, 0.3, 1.1),
        dCreatePlane(0, 0.3, -0.2, 1, 0.1), dCreateRay(0, 3), dCreateCylinder(0, 0.4, 1.2),
        dCreateSphere(0, 0.4), dCreateBox(0, 0.6, 0.9, 1.4), dCreateCapsule(0, 0.5, 0.6),
        dCreatePlane(0, 0, 0, 1, 0), dCreateRay(0, 2),
    };
    int count = sizeof shapes / sizeof *shapes;
    dContact c[MAX];
    memset(c, 0, sizeof c);
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            /* Capsules against cylinders are an iteration of libccd's there, and exact here. */
            int ci = dGeomGetClass(shapes[i]), cj = dGeomGetClass(shapes[j]);
            if ((ci == dCapsuleClass && cj == dCylinderClass) || (ci == dCylinderClass && cj == dCapsuleClass)) continue;
            if (ci == dCylinderClass && cj == dCylinderClass) continue;
            for (int k = 0; k < 6; k++) {
                scatter(shapes[i], 0.4);
                scatter(shapes[j], 0.4);
                printf("%d %d %d\n", i, j, k);
                int n = dCollide(shapes[i], shapes[j], MAX, &c[0].geom, sizeof *c);
                /* The corners of a cylinder's cap on a box come in either turn, by rounding. */
                if (ci + cj == dBoxClass + dCylinderClass && ci != cj) qsort(c, n, sizeof *c, by_place);
                show_contacts(n, c, shapes[i], shapes[j]);
            }
            int few = dCollide(shapes[i], shapes[j], 1, &c[0].geom, sizeof *c);
            show_contacts(few, c, shapes[i], shapes[j]);
        }
    /* the stride, and nothing written beyond the count */
    dContactGeom tight[3];
    memset(tight, 0, sizeof tight);
    tight[2].depth = 77;
    dMatrix3 r;
    dRSetIdentity(r);
    dGeomSetRotation(shapes[1], r);
    dGeomSetPosition(shapes[1], 0, 0, 0.3);
    showi("two", dCollide(shapes[1], shapes[9], 2, tight, sizeof *tight));
    show1("kept", tight[2].depth);
    showi("g1", tight[1].g1 == shapes[1] && tight[1].g2 == shapes[9]);
    showi("swapped", dCollide(shapes[9], shapes[1], 2, tight, sizeof *tight));
    show("normal", tight[0].normal, 3);
    showi("itself", dCollide(shapes[1], shapes[1], 2, tight, sizeof *tight));
    dGeomDisable(shapes[1]);
    showi("disabled", dCollide(shapes[1], shapes[9], 2, tight, sizeof *tight));

    /* one body, and a body against the ground */
    dWorldID w = dWorldCreate();
    dBodyID b = dBodyCreate(w);
    dGeomSetBody(shapes[0], b);
    dGeomSetBody(shapes[6], b);
    showi("same body", dCollide(shapes[0], shapes[6], 4, tight, sizeof *tight));
    dBodySetPosition(b, 0.1, 0.2, 0.6);
    dGeomSetOffsetPosition(shapes[6], 0.5, 0, -0.5);
    showi("ground", dCollide(shapes[0], shapes[9], 4, tight, sizeof *tight));
    show("pos", tight[0].pos, 3);
    showi("ground", dCollide(shapes[6], shapes[9], 4, tight, sizeof *tight));
    show("pos", tight[0].pos, 3);
    show1("depth", tight[0].depth);

    /* without geoms */
    for (int k = 0; k < 40; k++) {
        dVector3 p1 = {noise(), noise(), noise()}, p2 = {noise(), noise(), noise()};
        dVector3 s1 = {1 + noise(), 1.5 + noise(), 0.9}, s2 = {1 + noise() * 0.5, 0.4, 1.1};
        dVector3 q1 = {noise(), noise(), noise()}, q2 = {noise(), noise(), noise()}, n = {0}, x, y;
        dMatrix3 r1, r2;
        dReal depth = -1;
        int code = -1;
        dRFromAxisAndAngle(r1, noise(), noise(), noise(), noise());
        dRFromAxisAndAngle(r2, noise(), noise(), noise(), noise());
        for (int i = 0; i < 3; i++) p2[i] *= 1.5;
        showi("touch", dBoxTouchesBox(p1, r1, s1, p2, r2, s2));
        int got = dBoxBox(p1, r1, s1, p2, r2, s2, n, &depth, &code, 8, &c[0].geom, sizeof *c);
        showi("boxes", got);
        showi("code", code);
        show("normal", n, 3);
        show1("depth", depth);
        for (int i = 0; i < got; i++) {
            show("pos", c[i].geom.pos, 3);
            show1("depth", c[i].geom.depth);
        }
        dClosestLineSegmentPoints(p1, p2, q1, q2, x, y);
        show("closest", x, 3);
        show("closest", y, 3);
    }
    for (int i = 0; i < count; i++) dGeomDestroy(shapes[i]);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
