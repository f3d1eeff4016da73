/* Heightfield data of every kind: the field's box and a ray's hit; bounds, data exchanged between fields. */
#include "check.h"

static dReal height(void *user, int x, int z) { return *(dReal *)user * x + 0.05f * z; }
static dGeomID field, ray;
static const dReal *seen(void) {
    static dReal x[9];
    memset(x, 0, sizeof x);
    dGeomGetAABB(field, x);
    dContactGeom c;
    if (dCollide(ray, field, 1, &c, sizeof c)) memcpy(x + 6, c.pos, 3 * sizeof *x);
    return x;
}

int main(void) {
    dInitODE2(0);
    unsigned char bytes[25];
    short shorts[25];
    float floats[25];
    double doubles[25];
    for (int i = 0; i < 25; i++) bytes[i] = shorts[i] = floats[i] = doubles[i] = (i * 7) % 5;
    ray = dCreateRay(0, 10);
    dGeomRaySet(ray, 0.3, 5, 0.2, 0.01, -1, 0.02);
    dHeightfieldDataID data = dGeomHeightfieldDataCreate(), second = dGeomHeightfieldDataCreate();
    CHECKI(dGeomHeightfieldDataCreate, data != second);
    dGeomHeightfieldDataBuildByte(data, bytes, 1, 4, 4, 5, 5, 0.5, 0.1, 0.3, 0);
    field = dCreateHeightfield(0, data, 1);
    CHECK(dCreateHeightfield, seen(), 9);
    CHECK(dGeomHeightfieldDataBuildByte, seen(), 9);
    CHECKI(dGeomHeightfieldGetHeightfieldData, dGeomHeightfieldGetHeightfieldData(field) == data);
    dGeomHeightfieldDataBuildShort(data, shorts, 1, 4, 4, 5, 5, 0.6, 0.1, 0.3, 0);
    dGeomHeightfieldSetHeightfieldData(field, data);
    CHECK(dGeomHeightfieldDataBuildShort, seen(), 9);
    dGeomHeightfieldDataBuildSingle(data, floats, 1, 4, 4, 5, 5, 0.7, 0.1, 0.3, 0);
    dGeomHeightfieldSetHeightfieldData(field, data);
    CHECK(dGeomHeightfieldDataBuildSingle, seen(), 9);
    dGeomHeightfieldDataBuildDouble(data, doubles, 1, 4, 4, 5, 5, 0.8, 0.1, 0.3, 0);
    dGeomHeightfieldSetHeightfieldData(field, data);
    CHECK(dGeomHeightfieldDataBuildDouble, seen(), 9);
    dReal slope = 0.1;
    dGeomHeightfieldDataBuildCallback(second, &slope, height, 4, 4, 5, 5, 0.5, 0.1, 0.3, 0);
    dGeomHeightfieldDataSetBounds(second, -0.25, 1.75);
    dGeomHeightfieldSetHeightfieldData(field, second);
    CHECK(dGeomHeightfieldSetHeightfieldData, seen(), 9);
    CHECK(dGeomHeightfieldDataBuildCallback, seen() + 6, 3);
    dGeomDestroy(field);
    field = dCreateHeightfield(0, second, 1);
    CHECK(dGeomHeightfieldDataSetBounds, seen(), 6);
    dGeomDestroy(field);
    dGeomHeightfieldDataDestroy(data);
    dGeomHeightfieldDataDestroy(second);
    dGeomDestroy(ray);
    dCloseODE();
    return 0;
}
