/* Sizes of shapes: set, asked for, and what boxes and depths make of them. */
#include "check.h"

static dReal aabb[6];
static const dReal *around(dGeomID g) { dGeomGetAABB(g, aabb); return aabb; }

int main(void) {
    dInitODE2(0);
    dReal x[4] = {0};
    dGeomID g = dCreateSphere(0, 0.5);
    CHECK(dCreateSphere, around(g), 6);
    dGeomSphereSetRadius(g, 0.7);
    CHECK1(dGeomSphereSetRadius, dGeomSphereGetRadius(g));
    R1(dGeomSphereGetRadius, g);
    R1(dGeomSpherePointDepth, g, 0.1, 0.2, 0.3);
    CHECK(dGeomGetAABB, around(g), 6);
    dGeomDestroy(g);

    g = dCreateBox(0, 1, 2, 3);
    CHECK(dCreateBox, around(g), 6);
    I1(dGeomGetClass, g);
    dGeomBoxSetLengths(g, 1.5, 1, 0.5);
    dGeomBoxGetLengths(g, x);
    CHECK(dGeomBoxSetLengths, x, 3);
    CHECK(dGeomBoxGetLengths, x, 3);
    R1(dGeomBoxPointDepth, g, 0.1, 0.2, 0.1);
    R1(dGeomBoxPointDepth, g, 1, 2, 3);
    dGeomDestroy(g);

    g = dCreateCapsule(0, 0.3, 1);
    CHECK(dCreateCapsule, around(g), 6);
    dGeomCapsuleSetParams(g, 0.4, 1.2);
    dGeomCapsuleGetParams(g, x, x + 1);
    CHECK(dGeomCapsuleSetParams, x, 2);
    CHECK(dGeomCapsuleGetParams, x, 2);
    R1(dGeomCapsulePointDepth, g, 0.1, 0.2, 0.9);
    dGeomDestroy(g);

    g = dCreateCylinder(0, 0.3, 1);
    CHECK(dCreateCylinder, around(g), 6);
    dGeomCylinderSetParams(g, 0.6, 1.4);
    dGeomCylinderGetParams(g, x, x + 1);
    CHECK(dGeomCylinderSetParams, x, 2);
    CHECK(dGeomCylinderGetParams, x, 2);
    dGeomDestroy(g);

    g = dCreatePlane(0, 0, 3, 4, 10);
    dGeomPlaneGetParams(g, x);
    CHECK(dCreatePlane, x, 4);
    dGeomPlaneSetParams(g, 0, 0, 2, 1);
    dGeomPlaneGetParams(g, x);
    CHECK(dGeomPlaneSetParams, x, 4);
    CHECK(dGeomPlaneGetParams, x, 4);
    R1(dGeomPlanePointDepth, g, 1, 2, -3);
    dGeomDestroy(g);

    dInfiniteAABB(0, aabb);
    CHECK(dInfiniteAABB, aabb, 6);
    dCloseODE();
    return 0;
}
