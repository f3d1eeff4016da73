/* Geoms on bodies: which belongs to which, offsets in the body's and the world's frame, and where the geom goes. */
#include "check.h"

static dReal pose[7];
static const dReal *placed(dGeomID g) {
    memcpy(pose, dGeomGetPosition(g), 3 * sizeof *pose);
    dQuaternion q;
    dGeomGetQuaternion(g, q);
    memcpy(pose + 3, q, sizeof q);
    return pose;
}

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    dBodyID body, other;
    two_bodies(w, &body, &other);
    dGeomID g = dCreateBox(0, 1, 2, 3), second = dCreateSphere(0, 1);
    dGeomSetBody(g, body);
    dGeomSetBody(second, body);
    CHECK(dGeomSetBody, placed(g), 7);
    CHECKI(dGeomGetBody, dGeomGetBody(g) == body);
    CHECKI(dBodyGetFirstGeom, dBodyGetFirstGeom(body) == second);
    CHECKI(dBodyGetNextGeom, dBodyGetNextGeom(second) == g);
    CHECKI(dGeomGetBodyNext, dGeomGetBodyNext(second) == g);
    I1(dGeomIsOffset, g);
    dGeomSetOffsetPosition(g, 0.1, 0.2, 0.3);
    CHECK(dGeomSetOffsetPosition, placed(g), 7);
    CHECK(dGeomGetOffsetPosition, dGeomGetOffsetPosition(g), 3);
    dMatrix3 r, copy;
    dQuaternion q;
    dVector3 p;
    memset(copy, 0, sizeof copy);
    dRFromAxisAndAngle(r, 1, 1, 0, 0.5);
    dGeomSetOffsetRotation(g, r);
    CHECK(dGeomSetOffsetRotation, placed(g), 7);
    CHECK(dGeomGetOffsetRotation, dGeomGetOffsetRotation(g), 12);
    dGeomGetOffsetQuaternion(g, q);
    CHECK(dGeomGetOffsetQuaternion, q, 4);
    dGeomCopyOffsetPosition(g, p);
    CHECK(dGeomCopyOffsetPosition, p, 3);
    dGeomCopyOffsetRotation(g, copy);
    for (int i = 0; i < 3; i++) CHECK(dGeomCopyOffsetRotation, copy + 4 * i, 3);
    CHECKI(dGeomIsOffset, dGeomIsOffset(g));
    dQFromAxisAndAngle(q, 0, 1, 0, 0.7);
    dGeomSetOffsetQuaternion(g, q);
    CHECK(dGeomSetOffsetQuaternion, placed(g), 7);
    dGeomSetOffsetWorldPosition(g, 1, 1, 1);
    CHECK(dGeomSetOffsetWorldPosition, dGeomGetOffsetPosition(g), 3);
    dGeomSetOffsetWorldRotation(g, r);
    CHECK(dGeomSetOffsetWorldRotation, dGeomGetOffsetRotation(g), 12);
    dGeomSetOffsetWorldQuaternion(g, q);
    CHECK(dGeomSetOffsetWorldQuaternion, dGeomGetOffsetRotation(g), 12);
    for (int i = 0; i < 5; i++) dWorldStep(w, 0.05);
    CHECK(dWorldStep, placed(g), 7);
    dGeomClearOffset(g);
    CHECK(dGeomClearOffset, placed(g), 7);
    dGeomSetBody(g, other);
    CHECK(dGeomSetBody, placed(g), 7);
    dBodyDestroy(other);
    CHECKI(dBodyDestroy, dGeomGetBody(g) == 0);
    dGeomDestroy(g);
    dGeomDestroy(second);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
