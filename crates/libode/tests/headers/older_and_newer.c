/* The StepFast functions and those of the newest ODE, which the installed library lacks: each line is a name and 1 if it holds. */
#include <math.h>
#include <ode/ode.h>
#include <stdio.h>

static void holds(const char *name, int what) { printf("%s %d\n", name, what); }

static double apart(dBodyID a, dBodyID b) {
    const dReal *p = dBodyGetPosition(a), *q = dBodyGetPosition(b);
    return dCalcPointsDistance3(p, q);
}

/* Bodies in a row, each joined to the one before, the first to the world. */
static void chain(dWorldID world, dBodyID *bodies, int count) {
    int i;
    for (i = 0; i < count; i++) {
        dJointID joint = dJointCreateBall(world, 0);
        bodies[i] = dBodyCreate(world);
        dBodySetPosition(bodies[i], i + REAL(0.5), 0, 0);
        dBodySetGyroscopicMode(bodies[i], 0);
        dJointAttach(joint, bodies[i], i ? bodies[i - 1] : 0);
        dJointSetBallAnchor(joint, i, 0, 0);
    }
}

static int moves;
static void moved(dBodyID body) {
    (void)body;
    moves++;
}

int main(void) {
    dWorldID exact, fast;
    dBodyID a[6], b[6];
    dJointFeedback feedback;
    dMass mass;
    double worst;
    int i, k;
    dInitODE2(0);

    /* A body in free fall: N substeps of h / N, the velocity first. */
    fast = dWorldCreate();
    dWorldSetGravity(fast, 0, 0, -10);
    a[0] = dBodyCreate(fast);
    dBodySetMovedCallback(a[0], moved);
    dBodyAddForce(a[0], 3, 0, 0);
    dWorldStepFast1(fast, REAL(0.1), 4);
    holds("velocity", fabs(dBodyGetLinearVel(a[0])[2] + 1) < 1e-6 && fabs(dBodyGetLinearVel(a[0])[0] - 0.3) < 1e-6);
    holds("position", fabs(dBodyGetPosition(a[0])[2] + 10 * 0.025 * 0.025 * 10) < 1e-6);
    holds("callbacks", moves == 4);
    holds("force cleared", dBodyGetForce(a[0])[0] == 0);
    dWorldStepFast1(fast, REAL(0.1), 0);
    holds("at least one", moves == 5);
    dWorldDestroy(fast);

    /* With one joint and one substep there is nothing to iterate: the exact step. */
    exact = dWorldCreate();
    fast = dWorldCreate();
    dWorldSetGravity(exact, 0, 0, -10);
    dWorldSetGravity(fast, 0, 0, -10);
    chain(exact, a, 1);
    chain(fast, b, 1);
    worst = 0;
    for (i = 0; i < 200; i++) {
        dWorldStep(exact, REAL(0.01));
        dWorldStepFast1(fast, REAL(0.01), 1);
        if (apart(a[0], b[0]) > worst) worst = apart(a[0], b[0]);
    }
    holds("one joint is exact", worst < 1e-9);
    dWorldDestroy(exact);
    dWorldDestroy(fast);

    /* A chain: more substeps hold it together better. */
    for (k = 1, worst = 1e9; k <= 64; k *= 4) {
        double error = 0;
        fast = dWorldCreate();
        dRandSetSeed(7);
        dWorldSetGravity(fast, 0, 0, -10);
        chain(fast, b, 5);
        for (i = 0; i < 100; i++) {
            dWorldStepFast1(fast, REAL(0.01), k);
            dVector3 end, begin;
            dBodyGetRelPointPos(b[4], REAL(-0.5), 0, 0, end);
            dBodyGetRelPointPos(b[3], REAL(0.5), 0, 0, begin);
            if (dCalcPointsDistance3(end, begin) > error) error = dCalcPointsDistance3(end, begin);
        }
        if (k > 1) holds("more substeps are better", error < worst);
        worst = error;
        dWorldDestroy(fast);
    }
    holds("64 substeps hold a chain", worst < 0.01);

    /* The force of a joint at rest is the weight. */
    fast = dWorldCreate();
    dWorldSetGravity(fast, 0, 0, -10);
    chain(fast, b, 1);
    dMassSetSphereTotal(&mass, 2, 1);
    dBodySetMass(b[0], &mass);
    dBodySetPosition(b[0], 0, 0, REAL(-0.5));
    dJointSetBallAnchor(dBodyGetJoint(b[0], 0), 0, 0, 0);
    dJointSetFeedback(dBodyGetJoint(b[0], 0), &feedback);
    for (i = 0; i < 10; i++) dWorldStepFast1(fast, REAL(0.01), 5);
    holds("feedback", fabs(feedback.f1[2] - 20) < 1e-6);
    dWorldDestroy(fast);

    /* Sleepers: as many layers wake as the depth says; the others are as the static world. */
    for (k = 0; k <= 3; k++) {
        int awake = 0;
        fast = dWorldCreate();
        dWorldSetAutoEnableDepthSF1(fast, k ? k : -3);
        holds("depth", dWorldGetAutoEnableDepthSF1(fast) == k);
        dWorldSetGravity(fast, 0, 0, -10);
        chain(fast, b, 6);
        for (i = 1; i < 6; i++) dBodyDisable(b[i]);
        dWorldStepFast1(fast, REAL(0.01), 3);
        for (i = 0; i < 6; i++) awake += dBodyIsEnabled(b[i]);
        holds("layers", awake == k + 1 && dBodyGetPosition(b[5])[2] == 0 && dBodyGetLinearVel(b[5])[2] == 0);
        dWorldDestroy(fast);
    }
    /* Limits for threads: only those that are named are written and read. */
    {
        dWorldSteppingThreadingParameters set = {7, 3, 4, 5}, got = {7, 9, 9, 9};
        fast = dWorldCreate();
        dWorldGetSteppingThreadingParameters(fast, &got);
        holds("limits at first", got.world_islands_iteration_max_threads == 0 &&
              got.island_stepping_max_threads == 0 && got.lcp_solving_max_threads == 1);
        set.param_set = dWSTP_WorldIslandsIterationMaxThreads | dWSTP_LCPSolvingMaxThreads;
        dWorldSetSteppingThreadingParameters(fast, &set);
        holds("the islands' limit", dWorldGetStepIslandsProcessingMaxThreadCount(fast) == 3);
        dWorldGetSteppingThreadingParameters(fast, &got);
        holds("limits", got.island_stepping_max_threads == 0 && got.lcp_solving_max_threads == 5);
        got.param_set = dWSTP_IslandSteppingMaxThreads;
        got.lcp_solving_max_threads = 99;
        dWorldGetSteppingThreadingParameters(fast, &got);
        holds("only what is named", got.lcp_solving_max_threads == 99);
        dWorldDestroy(fast);
    }
    /* Sweeps by need: with both numbers 0 as many as set; a hanging chain at rest needs fewer, a swinging one more. */
    {
        dWorldQuickStepIterationCount_DynamicAdjustmentStatistics seen = {sizeof seen, 0, 0, 0, 0}, bad = {4, 0, 0, 0, 0};
        dReal early = -1, factor = -1, late = -1;
        fast = dWorldCreate();
        dWorldSetGravity(fast, 0, 0, -10);
        chain(fast, b, 5);
        holds("no small record", dWorldAttachQuickStepDynamicIterationStatisticsSink(fast, &bad) == 0);
        holds("a record", dWorldAttachQuickStepDynamicIterationStatisticsSink(fast, &seen) == 1);
        dWorldGetQuickStepDynamicIterationParameters(fast, &early, &factor, &late);
        holds("off at first", early == 0 && factor == 0 && fabs(late - 0.01) < 1e-6);
        for (i = 0; i < 50; i++) dWorldQuickStep(fast, REAL(0.01));
        holds("as many as set", seen.iteration_count == 50 && seen.premature_exits == 0 && seen.prolonged_execs == 0 &&
              seen.full_extra_execs == 0);
        factor = 3;
        dWorldSetQuickStepDynamicIterationParameters(fast, 0, &factor, 0);
        for (i = 0; i < 50; i++) dWorldQuickStep(fast, REAL(0.01));
        holds("more when swinging", seen.prolonged_execs + seen.full_extra_execs > 40 && seen.premature_exits == 0);
        dWorldDestroy(fast);

        fast = dWorldCreate();
        chain(fast, b, 5);
        seen.premature_exits = 0;
        early = REAL(1e-8);
        dWorldSetQuickStepDynamicIterationParameters(fast, &early, 0, 0);
        dWorldAttachQuickStepDynamicIterationStatisticsSink(fast, &seen);
        for (i = 0; i < 10; i++) dWorldQuickStep(fast, REAL(0.01));
        holds("fewer at rest", seen.premature_exits == 10);
        dWorldAttachQuickStepDynamicIterationStatisticsSink(fast, 0);
        dWorldQuickStep(fast, REAL(0.01));
        holds("detached", seen.premature_exits == 10);
        dWorldDestroy(fast);
    }
    /* PU joints have torques about both axes. */
    {
        dJointID joint;
        dReal torque1, torque2;
        fast = dWorldCreate();
        joint = dJointCreatePU(fast, 0);
        b[0] = dBodyCreate(fast);
        b[1] = dBodyCreate(fast);
        dJointAttach(joint, b[0], b[1]);
        dJointSetPUAxis1(joint, 1, 0, 0);
        dJointSetPUAxis2(joint, 0, 1, 0);
        dJointAddPUTorques(joint, 2, 3);
        torque1 = dBodyGetTorque(b[0])[0];
        torque2 = dBodyGetTorque(b[0])[1];
        holds("PU torques", torque1 == 2 && torque2 == 3 && dBodyGetTorque(b[1])[0] == -2);
        dWorldDestroy(fast);
    }
    holds("the manual's spelling", dJointGetType(dJointCreatePlane2d(fast = dWorldCreate(), 0)) == dJointTypePlane2D);
    dWorldDestroy(fast);
    dCloseODE();
    printf("end\n");
    return 0;
}
