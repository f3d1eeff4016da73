/* A world's defaults of falling asleep, inherited by bodies made later: when they stop. */
#include "check.h"

static dWorldID w;
static int sleeps(dReal speed, dReal turn) {
    dBodyID b = dBodyCreate(w);
    /* A body without joints never sleeps. */
    dJointAttach(dJointCreateNull(w, 0), b, 0);
    dBodySetLinearVel(b, speed, 0, 0);
    dBodySetAngularVel(b, turn, 0, 0);
    int steps = 0;
    while (dBodyIsEnabled(b) && steps < 100) {
        /* Steps and times are sums of powers of two: they come out the same in float. */
        dWorldStep(w, 0.015625);
        if (++steps == 20) dBodySetLinearVel(b, 0, 0, 0);
    }
    dBodyDestroy(b);
    return steps;
}

int main(void) {
    dInitODE2(0);
    w = dWorldCreate();
    showi("off", sleeps(0.001, 0));
    dWorldSetAutoDisableFlag(w, 1);
    I1(dWorldGetAutoDisableFlag, w);
    CHECKI(dWorldSetAutoDisableFlag, sleeps(0.001, 0));
    dWorldSetAutoDisableSteps(w, 4);
    I1(dWorldGetAutoDisableSteps, w);
    CHECKI(dWorldSetAutoDisableSteps, sleeps(0.001, 0));
    dWorldSetAutoDisableTime(w, 0.28125);
    R1(dWorldGetAutoDisableTime, w);
    CHECKI(dWorldSetAutoDisableTime, sleeps(0.001, 0));
    dWorldSetAutoDisableLinearThreshold(w, 0.5);
    R1(dWorldGetAutoDisableLinearThreshold, w);
    CHECKI(dWorldSetAutoDisableLinearThreshold, sleeps(0.3, 0));
    dWorldSetAutoDisableAngularThreshold(w, 0.6);
    R1(dWorldGetAutoDisableAngularThreshold, w);
    CHECKI(dWorldSetAutoDisableAngularThreshold, sleeps(0, 0.4));
    dWorldSetAutoDisableAverageSamplesCount(w, 12);
    I1(dWorldGetAutoDisableAverageSamplesCount, w);
    CHECKI(dWorldSetAutoDisableAverageSamplesCount, sleeps(2, 0));
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
