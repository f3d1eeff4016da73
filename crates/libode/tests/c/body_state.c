/* A body's state: each setter seen by its getter, and what a step makes of it. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    CHECKI(dWorldCreate, w != 0);
    dBodyID b = dBodyCreate(w);
    CHECKI(dBodyCreate, b != 0 && dBodyGetWorld(b) == w);
    CHECKI(dBodyGetWorld, dBodyGetWorld(b) == w);
    dBodySetPosition(b, 1, 2, 3);
    CHECK(dBodySetPosition, dBodyGetPosition(b), 3);
    CHECK(dBodyGetPosition, dBodyGetPosition(b), 3);
    dMatrix3 r;
    dRFromAxisAndAngle(r, 1, -1, 0.5, 0.8);
    dBodySetRotation(b, r);
    CHECK(dBodySetRotation, dBodyGetQuaternion(b), 4);
    CHECK(dBodyGetRotation, dBodyGetRotation(b), 12);
    dQuaternion q = {0.6, 0, 0.8, 0};
    dBodySetQuaternion(b, q);
    CHECK(dBodySetQuaternion, dBodyGetRotation(b), 12);
    CHECK(dBodyGetQuaternion, dBodyGetQuaternion(b), 4);
    dBodySetLinearVel(b, 0.1, 0.2, 0.3);
    CHECK(dBodySetLinearVel, dBodyGetLinearVel(b), 3);
    CHECK(dBodyGetLinearVel, dBodyGetLinearVel(b), 3);
    dBodySetAngularVel(b, -0.1, 0.4, 0.3);
    CHECK(dBodySetAngularVel, dBodyGetAngularVel(b), 3);
    CHECK(dBodyGetAngularVel, dBodyGetAngularVel(b), 3);
    dVector3 position = {7, 7, 7};
    dBodyCopyPosition(b, position);
    CHECK(dBodyCopyPosition, position, 3);
    dMatrix3 rotation = {7, 7, 7};
    dBodyCopyRotation(b, rotation);
    CHECK(dBodyCopyRotation, rotation, 12);
    dQuaternion quaternion = {7, 7, 7, 7};
    dBodyCopyQuaternion(b, quaternion);
    CHECK(dBodyCopyQuaternion, quaternion, 4);
    dBodySetData(b, &q);
    CHECKI(dBodySetData, dBodyGetData(b) == (void *)&q);
    CHECKI(dBodyGetData, dBodyGetData(b) == (void *)&q);
    for (int i = 0; i < 10; i++) dWorldStep(w, 0.05);
    MOVES(dWorldStep, b);
    for (int i = 0; i < 10; i++) dWorldQuickStep(w, 0.05);
    MOVES(dWorldQuickStep, b);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
