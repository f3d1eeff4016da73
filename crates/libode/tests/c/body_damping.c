/* Damping and its thresholds, of bodies and from a world's defaults: speeds after steps. */
#include "check.h"

static dWorldID w;
static dBodyID moving(void) {
    dBodyID b = dBodyCreate(w);
    dBodySetLinearVel(b, 1, 0, 0);
    dBodySetAngularVel(b, 0, 1, 0);
    return b;
}
static const dReal *speeds(dBodyID b) {
    static dReal s[2];
    s[0] = dBodyGetLinearVel(b)[0];
    s[1] = dBodyGetAngularVel(b)[1];
    return s;
}

int main(void) {
    dInitODE2(0);
    w = dWorldCreate();
    dBodyID linear = moving(), angular = moving(), both = moving(), calm = moving(), still = moving(), given = moving();
    dBodySetLinearDamping(linear, 0.1);
    R1(dBodyGetLinearDamping, linear);
    dBodySetAngularDamping(angular, 0.2);
    R1(dBodyGetAngularDamping, angular);
    dBodySetDamping(both, 0.05, 0.15);
    dBodySetDamping(calm, 0.1, 0.1);
    dBodySetLinearDampingThreshold(calm, 0.8);
    R1(dBodyGetLinearDampingThreshold, calm);
    dBodySetDamping(still, 0.1, 0.1);
    dBodySetAngularDampingThreshold(still, 0.7);
    R1(dBodyGetAngularDampingThreshold, still);
    dWorldSetDamping(w, 0.3, 0.4);
    dBodySetDampingDefaults(given);
    dBodyID born = moving();
    dWorldSetLinearDamping(w, 0.02);
    dWorldSetAngularDamping(w, 0.03);
    dBodyID last = moving();
    dWorldSetLinearDampingThreshold(w, 0.95);
    dWorldSetAngularDampingThreshold(w, 0.9);
    dBodyID held = moving();
    for (int i = 0; i < 10; i++) dWorldStep(w, 0.1);
    CHECK(dBodySetLinearDamping, speeds(linear), 2);
    CHECK(dBodySetAngularDamping, speeds(angular), 2);
    CHECK(dBodySetDamping, speeds(both), 2);
    CHECK(dBodySetLinearDampingThreshold, speeds(calm), 2);
    CHECK(dBodySetAngularDampingThreshold, speeds(still), 2);
    CHECK(dBodySetDampingDefaults, speeds(given), 2);
    CHECK(dWorldSetDamping, speeds(born), 2);
    CHECK(dWorldSetLinearDamping, speeds(last), 2);
    CHECK(dWorldSetAngularDamping, speeds(last), 2);
    CHECK(dWorldSetLinearDampingThreshold, speeds(held), 2);
    CHECK(dWorldSetAngularDampingThreshold, speeds(held), 2);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
