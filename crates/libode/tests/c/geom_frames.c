/* A free geom's pose by matrix and quaternion, its copies, and points and directions in its frame. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dGeomID g = dCreateBox(0, 1, 2, 3);
    dMatrix3 r, copy;
    dQuaternion q;
    dVector3 p;
    dReal aabb[6];
    memset(copy, 0, sizeof copy);
    dGeomSetPosition(g, 1, 2, 3);
    CHECK(dGeomSetPosition, dGeomGetPosition(g), 3);
    CHECK(dGeomGetPosition, dGeomGetPosition(g), 3);
    dRFromAxisAndAngle(r, 1, 2, -1, 0.9);
    dGeomSetRotation(g, r);
    CHECK(dGeomSetRotation, dGeomGetRotation(g), 12);
    CHECK(dGeomGetRotation, dGeomGetRotation(g), 12);
    dGeomGetAABB(g, aabb);
    CHECK(dGeomGetAABB, aabb, 6);
    dGeomGetQuaternion(g, q);
    CHECK(dGeomGetQuaternion, q, 4);
    dGeomCopyPosition(g, p);
    CHECK(dGeomCopyPosition, p, 3);
    dGeomCopyRotation(g, copy);
    for (int i = 0; i < 3; i++) CHECK(dGeomCopyRotation, copy + 4 * i, 3);
    dQFromAxisAndAngle(q, 0, 1, 1, -0.4);
    dGeomSetQuaternion(g, q);
    CHECK(dGeomSetQuaternion, dGeomGetRotation(g), 12);
    V3(dGeomGetRelPointPos, g, 0.1, 0.2, 0.3);
    V3(dGeomGetPosRelPoint, g, 0.1, 0.2, 0.3);
    V3(dGeomVectorToWorld, g, 0.1, 0.2, 0.3);
    V3(dGeomVectorFromWorld, g, 0.1, 0.2, 0.3);
    dGeomSetData(g, &q);
    CHECKI(dGeomSetData, dGeomGetData(g) == (void *)&q);
    CHECKI(dGeomGetData, dGeomGetData(g) == (void *)&q);
    I1(dGeomIsSpace, g);
    dSpaceID s = dSimpleSpaceCreate(0);
    CHECKI(dGeomIsSpace, dGeomIsSpace((dGeomID)s));
    dSpaceAdd(s, g);
    CHECKI(dGeomGetSpace, dGeomGetSpace(g) == s);
    dGeomDestroy(g);
    CHECKI(dGeomDestroy, dSpaceGetNumGeoms(s));
    dSpaceDestroy(s);
    dCloseODE();
    return 0;
}
