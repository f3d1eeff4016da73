/* Floors by a class of the program's own: endless half-spaces with a collider for balls and boxes, in every kind of space, with data
   in the geom; a destructor that counts; a floor that moves; the same class within a geom transform. */
#include "check.h"

typedef struct { dReal height, slope; int seen; } floor_data;
static int floor_class, destroyed;

static dReal level(const floor_data *f, dReal x) { return f->height + f->slope * x; }
static int touch(dGeomID a, dGeomID b, int flags, dContactGeom *c, int skip) {
    floor_data *f = (floor_data *)dGeomGetClassData(a);
    int n = 0, most = flags & 0xffff;
    f->seen++;
    dVector3 points[8];
    int count = 0;
    dReal radius = 0;
    if (dGeomGetClass(b) == dSphereClass) {
        memcpy(points[0], dGeomGetPosition(b), sizeof points[0]);
        radius = dGeomSphereGetRadius(b);
        count = 1;
    } else {
        dVector3 sides;
        dGeomBoxGetLengths(b, sides);
        for (; count < 8; count++)
            dGeomGetRelPointPos(b, (count & 1 ? 0.5 : -0.5) * sides[0], (count & 2 ? 0.5 : -0.5) * sides[1],
                                (count & 4 ? 0.5 : -0.5) * sides[2], points[count]);
    }
    dReal length = sqrt(1 + f->slope * f->slope);
    for (int i = 0; i < count && n < most; i++) {
        dReal depth = radius - (points[i][2] - level(f, points[i][0])) / length;
        if (depth < 0) continue;
        dContactGeom *to = (dContactGeom *)((char *)c + n++ * skip);
        memset(to, 0, sizeof *to);
        to->normal[0] = f->slope / length, to->normal[2] = -1 / length;
        for (int k = 0; k < 3; k++) to->pos[k] = points[i][k] + radius * to->normal[k];
        to->depth = depth;
        to->g1 = a, to->g2 = b;
        to->side1 = to->side2 = -1;
    }
    return n;
}
static dColliderFn *choose(int other) { return other == dSphereClass || other == dBoxClass ? touch : 0; }
static void gone(dGeomID g) { destroyed += 1 + (((floor_data *)dGeomGetClassData(g))->height > 0); }

static dWorldID w;
static dJointGroupID group;
static void near(void *data, dGeomID a, dGeomID b) {
    dContact c[8];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 8, &c[0].geom, sizeof c[0]);
    *(int *)data += n;
    for (int i = 0; i < n; i++) {
        c[i].surface.mode = dContactBounce | dContactApprox1;
        c[i].surface.mu = 0.6;
        c[i].surface.bounce = 0.2;
        dJointAttach(dJointCreateContact(w, group, &c[i]), dGeomGetBody(c[i].geom.g1), dGeomGetBody(c[i].geom.g2));
    }
}
static void drop(dSpaceID s) {
    w = dWorldCreate();
    group = dJointGroupCreate(0);
    dWorldSetGravity(w, 0, 0, -9.81);
    dGeomID ground = dCreateGeom(floor_class);
    dSpaceAdd(s, ground);
    floor_data *f = (floor_data *)dGeomGetClassData(ground);
    showi("zero", f->height == 0 && f->slope == 0 && f->seen == 0);
    f->slope = 0.1;
    dBodyID bodies[2];
    for (int i = 0; i < 2; i++) {
        bodies[i] = dBodyCreate(w);
        dGeomSetBody(i ? dCreateBox(s, 0.6, 0.5, 0.4) : dCreateSphere(s, 0.3), bodies[i]);
        dBodySetPosition(bodies[i], 1.5 * i, 0.1, 0.6 + 0.2 * i);
        dMass m;
        dMassSetBoxTotal(&m, 1, 0.6, 0.5, 0.4);
        dBodySetMass(bodies[i], &m);
    }
    int contacts = 0;
    for (int i = 0; i < 60; i++) {
        if (i >= 30) f->height += 0.002;
        dSpaceCollide(s, &contacts, near);
        dWorldStep(w, 0.01);
        dJointGroupEmpty(group);
        if (i % 20 == 19)
            for (int k = 0; k < 2; k++) show("position", dBodyGetPosition(bodies[k]), 3);
    }
    showi("contacts", contacts);
    showi("seen", f->seen);
    dSpaceDestroy(s);
    showi("destroyed", destroyed);
    dJointGroupDestroy(group);
    dWorldDestroy(w);
}

int main(void) {
    dInitODE2(0);
    dGeomClass description;
    memset(&description, 0, sizeof description);
    description.bytes = sizeof(floor_data);
    description.collider = choose;
    description.aabb = dInfiniteAABB;
    description.dtor = gone;
    floor_class = dCreateGeomClass(&description);
    showi("class", floor_class);
    const dVector3 middle = {0, 0, 0}, extents = {9, 9, 9};
    drop(dSimpleSpaceCreate(0));
    drop(dHashSpaceCreate(0));
    drop(dQuadTreeSpaceCreate(0, middle, extents, 3));
    drop(dSweepAndPruneSpaceCreate(0, dSAP_AXES_XYZ));
    dGeomID ground = dCreateGeom(floor_class), ball = dCreateSphere(0, 1), capsule = dCreateCapsule(0, 1, 1);
    dContactGeom c[2];
    ((floor_data *)dGeomGetClassData(ground))->height = 0.5;
    showi("one way", dCollide(ground, ball, 2, c, sizeof *c));
    show("normal", c[0].normal, 3);
    showi("other way", dCollide(ball, ground, 2, c, sizeof *c));
    show("normal", c[0].normal, 3);
    showi("names", c[0].g1 == ball && c[0].g2 == ground);
    showi("no collider", dCollide(ground, capsule, 2, c, sizeof *c));
    dReal box[6];
    dGeomGetAABB(ground, box);
    for (int i = 0; i < 6; i++) showi("infinite", isinf(box[i]) != 0);
    dGeomDestroy(ground);
    dGeomDestroy(ball);
    dGeomDestroy(capsule);
    showi("destroyed", destroyed);
    dCloseODE();
    return 0;
}
