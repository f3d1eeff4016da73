/* Falling asleep: by rest, by time or steps, with thresholds and averages; waking by hand. When each body stops is shown. */
#include "check.h"

static dWorldID w;
static dBodyID drifting(dReal speed, dReal turn) {
    dBodyID b = dBodyCreate(w);
    /* A body without joints never sleeps. */
    dJointAttach(dJointCreateNull(w, 0), b, 0);
    dBodySetLinearVel(b, speed, 0, 0);
    dBodySetAngularVel(b, 0, 0, turn);
    return b;
}

int main(void) {
    dInitODE2(0);
    w = dWorldCreate();
    dBodyID never = drifting(0.1, 0), flag = drifting(0.001, 0), linear = drifting(0.1, 0), angular = drifting(0, 0.1),
            steps = drifting(0.001, 0), timed = drifting(0.001, 0), average = drifting(2, 0),
            defaults = drifting(0.5, 0);
    dBodyID all[] = {never, flag, linear, angular, steps, timed, average, defaults};
    dBodySetAutoDisableFlag(flag, 1);
    I1(dBodyGetAutoDisableFlag, flag);
    dBodySetAutoDisableLinearThreshold(linear, 0.5);
    R1(dBodyGetAutoDisableLinearThreshold, linear);
    dBodySetAutoDisableAngularThreshold(angular, 0.5);
    R1(dBodyGetAutoDisableAngularThreshold, angular);
    dBodySetAutoDisableSteps(steps, 25);
    I1(dBodyGetAutoDisableSteps, steps);
    dBodySetAutoDisableSteps(timed, 0);
    dBodySetAutoDisableTime(timed, 0.33);
    R1(dBodyGetAutoDisableTime, timed);
    dBodySetAutoDisableAverageSamplesCount(average, 8);
    I1(dBodyGetAutoDisableAverageSamplesCount, average);
    dWorldSetAutoDisableLinearThreshold(w, 1);
    dWorldSetAutoDisableFlag(w, 1);
    dBodySetAutoDisableDefaults(defaults);
    for (int i = 0; i < 7; i++) dBodySetAutoDisableFlag(all[i], 1);
    int asleep[8] = {0};
    for (int i = 1; i <= 60; i++) {
        if (i == 5) dBodySetLinearVel(average, 0, 0, 0);
        dWorldStep(w, 0.02);
        for (int k = 0; k < 8; k++) if (!asleep[k] && !dBodyIsEnabled(all[k])) asleep[k] = i;
    }
    CHECKI(dBodyIsEnabled, dBodyIsEnabled(never));
    CHECKI(dBodySetAutoDisableFlag, asleep[1]);
    CHECKI(dBodySetAutoDisableLinearThreshold, asleep[2]);
    CHECKI(dBodySetAutoDisableAngularThreshold, asleep[3]);
    CHECKI(dBodySetAutoDisableSteps, asleep[4]);
    CHECKI(dBodySetAutoDisableTime, asleep[5]);
    CHECKI(dBodySetAutoDisableAverageSamplesCount, asleep[6]);
    CHECKI(dBodySetAutoDisableDefaults, asleep[7]);
    dBodyEnable(flag);
    CHECKI(dBodyEnable, dBodyIsEnabled(flag));
    dBodySetLinearVel(flag, 1, 2, 3);
    dWorldStep(w, 0.1);
    MOVES(dBodyEnable, flag);
    dBodyDisable(flag);
    CHECKI(dBodyDisable, dBodyIsEnabled(flag));
    dWorldStep(w, 0.1);
    MOVES(dBodyDisable, flag);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
