/* Geom transforms, as old programs offset geoms: the inner geom's place, contact records, clean-up. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dGeomID wrapper = dCreateGeomTransform(0), inner = dCreateSphere(0, 0.5), ground = dCreatePlane(0, 0, 0, 1, 0);
    CHECKI(dCreateGeomTransform, dGeomGetClass(wrapper));
    dGeomSetPosition(inner, 0.5, 0, 1);
    dGeomTransformSetGeom(wrapper, inner);
    CHECKI(dGeomTransformSetGeom, dGeomTransformGetGeom(wrapper) == inner);
    CHECKI(dGeomTransformGetGeom, dGeomTransformGetGeom(wrapper) == inner);
    dMatrix3 r;
    dRFromAxisAndAngle(r, 0, 1, 0, 0.5);
    dGeomSetPosition(wrapper, 1, 0, -0.7);
    dGeomSetRotation(wrapper, r);
    dReal aabb[6];
    dGeomGetAABB(wrapper, aabb);
    CHECK(dGeomTransformSetGeom, aabb, 6);
    for (int info = 0; info < 2; info++) {
        dGeomTransformSetInfo(wrapper, info);
        I1(dGeomTransformGetInfo, wrapper);
        dContactGeom c;
        showi("contacts", dCollide(wrapper, ground, 1, &c, sizeof c));
        show("at", c.pos, 3);
        show1("depth", c.depth);
        CHECKI(dGeomTransformSetInfo, c.g1 == wrapper);
    }
    dGeomTransformSetCleanup(wrapper, 1);
    CHECKI(dGeomTransformSetCleanup, dGeomTransformGetCleanup(wrapper));
    I1(dGeomTransformGetCleanup, wrapper);
    dGeomDestroy(wrapper);
    dGeomDestroy(ground);
    dCloseODE();
    return 0;
}
