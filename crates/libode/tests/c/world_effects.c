/* A world's settings, each seen by its getter and by what steps make of it. */
#include "check.h"

/* A body that hangs off a ball joint, pulled apart at the start, for ten steps. */
static dWorldID w;
static dBodyID b;
static void begin(void) {
    w = dWorldCreate();
    b = dBodyCreate(w);
    dJointID j = dJointCreateBall(w, 0);
    dJointAttach(j, b, 0);
    dJointSetBallAnchor(j, 0, 0, 1);
    dBodySetPosition(b, 0.3, 0.1, -0.1);
    dBodySetAngularVel(b, 0, 2, 1);
}
static void run(int quick) {
    for (int i = 0; i < 10; i++) if (quick) dWorldQuickStep(w, 0.02); else dWorldStep(w, 0.02);
}
#define EFFECT(f, get, value, quick) do { \
        begin(); f(w, value); run(quick); MOVES(f, b); show1(#get ":", (dReal)get(w)); (void)&get; dWorldDestroy(w); } while (0)

int main(void) {
    dInitODE2(0);
    begin();
    dWorldSetGravity(w, 1, 2, 3);
    V3(dWorldGetGravity, w);
    run(0);
    MOVES(dWorldSetGravity, b);
    dWorldSetData(w, &b);
    CHECKI(dWorldSetData, dWorldGetData(w) == (void *)&b);
    CHECKI(dWorldGetData, dWorldGetData(w) == (void *)&b);
    dWorldDestroy(w);
    EFFECT(dWorldSetERP, dWorldGetERP, 0.7, 0);
    EFFECT(dWorldSetCFM, dWorldGetCFM, 0.1, 0);
    EFFECT(dWorldSetQuickStepNumIterations, dWorldGetQuickStepNumIterations, 2, 1);
    EFFECT(dWorldSetQuickStepW, dWorldGetQuickStepW, 0.7, 1);

    /* A box deep in the ground, with a contact's limits. */
    for (int kind = 0; kind < 3; kind++) {
        w = dWorldCreate();
        b = dBodyCreate(w);
        if (kind == 0) dWorldSetContactMaxCorrectingVel(w, 0.2);
        if (kind == 1) dWorldSetContactSurfaceLayer(w, 0.15);
        dContact c;
        memset(&c, 0, sizeof c);
        c.surface.mu = 1;
        c.geom.normal[2] = 1;
        c.geom.depth = 0.2;
        dJointAttach(dJointCreateContact(w, 0, &c), b, 0);
        run(0);
        if (kind == 0) MOVES(dWorldSetContactMaxCorrectingVel, b);
        if (kind == 0) R1(dWorldGetContactMaxCorrectingVel, w);
        if (kind == 1) MOVES(dWorldSetContactSurfaceLayer, b);
        if (kind == 1) R1(dWorldGetContactSurfaceLayer, w);
        if (kind == 2) show("plain", dBodyGetPosition(b), 3);
        dWorldDestroy(w);
    }
    w = dWorldCreate();
    dWorldSetMaxAngularSpeed(w, 0.5);
    R1(dWorldGetMaxAngularSpeed, w);
    b = dBodyCreate(w);
    dBodySetAngularVel(b, 0, 0, 3);
    run(0);
    MOVES(dWorldSetMaxAngularSpeed, b);
    dWorldSetStepIslandsProcessingMaxThreadCount(w, 3);
    CHECKI(dWorldSetStepIslandsProcessingMaxThreadCount, dWorldGetStepIslandsProcessingMaxThreadCount(w));
    I1(dWorldGetStepIslandsProcessingMaxThreadCount, w);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
