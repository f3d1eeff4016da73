/* Every way to push a body, one at a time: the accumulators after the call. */
#include "check.h"

static dBodyID b;
static dReal sums[6];
static const dReal *pushed(void) {
    memcpy(sums, dBodyGetForce(b), 3 * sizeof *sums);
    memcpy(sums + 3, dBodyGetTorque(b), 3 * sizeof *sums);
    dBodySetForce(b, 0, 0, 0);
    dBodySetTorque(b, 0, 0, 0);
    return sums;
}
#define PUSH(f, ...) do { f(b, __VA_ARGS__); CHECK(f, pushed(), 6); } while (0)

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    dBodyID other;
    two_bodies(w, &b, &other);
    PUSH(dBodyAddForce, 1, 2, 3);
    PUSH(dBodyAddTorque, 4, 5, 6);
    PUSH(dBodyAddRelForce, 1, -2, 3);
    PUSH(dBodyAddRelTorque, 4, -5, 6);
    PUSH(dBodyAddForceAtPos, 1, 2, 3, 0.4, 0.5, 0.6);
    PUSH(dBodyAddForceAtRelPos, 1, 2, 3, 0.4, 0.5, 0.6);
    PUSH(dBodyAddRelForceAtPos, 1, 2, 3, 0.4, 0.5, 0.6);
    PUSH(dBodyAddRelForceAtRelPos, 1, 2, 3, 0.4, 0.5, 0.6);
    dBodySetForce(b, 3, 2, 1);
    CHECK(dBodySetForce, dBodyGetForce(b), 3);
    CHECK(dBodyGetForce, dBodyGetForce(b), 3);
    dBodySetTorque(b, 0.3, 0.2, 0.1);
    CHECK(dBodySetTorque, dBodyGetTorque(b), 3);
    CHECK(dBodyGetTorque, dBodyGetTorque(b), 3);
    dWorldStep(w, 0.1);
    MOVES(dBodySetForce, b);
    show("after the step", pushed(), 6);
    dVector3 force;
    dWorldImpulseToForce(w, 0.25, 1, 2, 3, force);
    CHECK(dWorldImpulseToForce, force, 3);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
