/* Classes of the program's own, overridden colliders, geom transforms, heightfields. */
#include "check.h"

static int destroyed, tested;
static int collide(dGeomID a, dGeomID b, int flags, dContactGeom *c, int skip) {
    (void)flags; (void)skip;
    c->pos[0] = *(dReal *)dGeomGetClassData(a);
    c->pos[1] = c->pos[2] = 0;
    c->normal[0] = 1;
    c->normal[1] = c->normal[2] = 0;
    c->depth = 0.25;
    c->g1 = a;
    c->g2 = b;
    c->side1 = 3;
    c->side2 = 4;
    return 1;
}
static dColliderFn *choose(int other) { return other == dSphereClass ? collide : 0; }
static void aabb_of(dGeomID g, dReal aabb[6]) {
    const dReal *p = dGeomGetPosition(g);
    for (int i = 0; i < 3; i++) aabb[2 * i] = p[i] - 1, aabb[2 * i + 1] = p[i] + 1;
}
static void end(dGeomID g) { (void)g; destroyed++; }
static int replaced(dGeomID a, dGeomID b, int flags, dContactGeom *c, int skip) {
    (void)flags; (void)skip;
    memset(c, 0, sizeof *c);
    c->normal[2] = 1;
    c->depth = 7;
    c->g1 = a;
    c->g2 = b;
    return 1;
}
static void contacts(const char *name, dGeomID a, dGeomID b) {
    dContactGeom c[10];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 10, c, sizeof c[0]);
    showi(name, n);
    for (int i = 0; i < n; i++) {
        show("pos", c[i].pos, 3);
        show("normal", c[i].normal, 3);
        show("depth", &c[i].depth, 1);
        printf("%d %d %d %d\n", c[i].g1 == a, c[i].g2 == b, c[i].side1, c[i].side2);
    }
}
static void near(void *data, dGeomID a, dGeomID b) { (void)data; contacts("near", a, b); }
static dReal height(void *user, int x, int z) { (void)user; return 0.1 * x + 0.05 * z; }

int main(void) {
    dInitODE2(0);
    dGeomClass description = {sizeof(dReal), choose, aabb_of, 0, end};
    int number = dCreateGeomClass(&description);
    showi("class", number);
    dGeomID own = dCreateGeom(number), ball = dCreateSphere(0, 1), cube = dCreateBox(0, 1, 1, 1);
    I1(dGeomGetClass, own);
    showi("zero", *(dReal *)dGeomGetClassData(own) == 0);
    *(dReal *)dGeomGetClassData(own) = 0.75;
    dGeomSetPosition(own, 0.5, 0, 0);
    dReal aabb[6];
    dGeomGetAABB(own, aabb);
    show("aabb", aabb, 6);
    contacts("own ball", own, ball);
    contacts("ball own", ball, own);
    contacts("own cube", own, cube);
    dSpaceID s = dHashSpaceCreate(0);
    dSpaceAdd(s, own);
    dSpaceAdd(s, ball);
    dSpaceCollide(s, 0, near);
    dGeomDestroy(own);
    showi("destroyed", destroyed);
    dSetColliderOverride(dSphereClass, dBoxClass, replaced);
    contacts("ball cube", ball, cube);
    contacts("cube ball", cube, ball);

    dGeomID wrapper = dCreateGeomTransform(0), inner = dCreateSphere(0, 0.5), ground = dCreatePlane(0, 0, 0, 1, 0);
    dGeomSetPosition(inner, 0, 0, 1);
    dGeomTransformSetGeom(wrapper, inner);
    showi("inner", dGeomTransformGetGeom(wrapper) == inner);
    dGeomSetPosition(wrapper, 1, 0, -0.7);
    dGeomGetAABB(wrapper, aabb);
    show("aabb", aabb, 6);
    I1(dGeomTransformGetInfo, wrapper);
    I1(dGeomTransformGetCleanup, wrapper);
    contacts("wrapper", wrapper, ground);
    contacts("wrapper", ground, wrapper);
    dGeomTransformSetInfo(wrapper, 1);
    I1(dGeomTransformGetInfo, wrapper);
    contacts("wrapper", wrapper, ground);
    dGeomTransformSetCleanup(wrapper, 1);
    I1(dGeomTransformGetCleanup, wrapper);
    dGeomDestroy(wrapper);

    unsigned char bytes[25];
    short shorts[25];
    float floats[25];
    double doubles[25];
    for (int i = 0; i < 25; i++) bytes[i] = shorts[i] = floats[i] = doubles[i] = (i * 7) % 5;
    dGeomID ray = dCreateRay(0, 10);
    dGeomRaySet(ray, 0.3, 5, 0.2, 0.01, -1, 0.02);
    dHeightfieldDataID data = dGeomHeightfieldDataCreate();
    for (int kind = 0; kind < 5; kind++) {
        if (kind == 0) dGeomHeightfieldDataBuildByte(data, bytes, 1, 4, 4, 5, 5, 0.5, 0.1, 0.3, 0);
        if (kind == 1) dGeomHeightfieldDataBuildShort(data, shorts, 1, 4, 4, 5, 5, 0.5, 0.1, 0.3, 0);
        if (kind == 2) dGeomHeightfieldDataBuildSingle(data, floats, 1, 4, 4, 5, 5, 0.5, 0.1, 0.3, 0);
        if (kind == 3) dGeomHeightfieldDataBuildDouble(data, doubles, 1, 4, 4, 5, 5, 0.5, 0.1, 0.3, 0);
        if (kind == 4) {
            dGeomHeightfieldDataBuildCallback(data, 0, height, 4, 4, 5, 5, 0.5, 0.1, 0.3, 0);
            dGeomHeightfieldDataSetBounds(data, 0, 1);
        }
        dGeomID field = dCreateHeightfield(0, data, kind & 1);
        I1(dGeomGetClass, field);
        showi("data", dGeomHeightfieldGetHeightfieldData(field) == data);
        dGeomHeightfieldSetHeightfieldData(field, data);
        if (kind < 4) {
            dGeomGetAABB(field, aabb);
            show("aabb", aabb, 6);
        }
        contacts("ray", ray, field);
        dGeomDestroy(field);
    }
    dGeomHeightfieldDataDestroy(data);
    dGeomDestroy(ray);
    dCloseODE();
    return 0;
}
