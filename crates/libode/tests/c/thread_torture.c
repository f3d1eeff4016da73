/* Everything of the threading interface from many threads at once: call graphs of one pool posted by six threads, mutexes of
   one group, groups and waits that come and go, calls that wait for calls, worlds that step in it, pools that stop and start.
   Only sums are shown, which don't depend on who comes first. On libode, which mixes up what threads post now and then, the
   posters run one after the other. */
#include "check.h"
#include <pthread.h>

enum { POSTERS = 6, ROUNDS = 12, PARTS = 8, CELLS = 4 };
static dThreadingImplementationID impl;
static const dThreadingFunctionsInfo *f;
static dMutexGroupID mutexes;
static long cells[CELLS];
static int at_once;

typedef struct { long whole, parts, faults, timeouts, nested; dReal z; dMutexGroupID own; } tally;

static int nothing(void *context, dcallindex_t index, dCallReleaseeID self) {
    (void)context, (void)index, (void)self;
    return 1;
}
static int part(void *context, dcallindex_t index, dCallReleaseeID self) {
    tally *t = (tally *)context;
    (void)self;
    unsigned cell = (unsigned)index % CELLS;
    f->lock_group_mutex(impl, mutexes, cell);
    cells[cell]++;
    f->unlock_group_mutex(impl, mutexes, cell);
    f->lock_group_mutex(impl, t->own, 0);
    t->parts += (long)index;
    f->unlock_group_mutex(impl, t->own, 0);
    return 1;
}
static int failing(void *context, dcallindex_t index, dCallReleaseeID self) {
    part(context, index, self);
    return 0;
}
/* Runs once all parts have ended. */
static int last(void *context, dcallindex_t index, dCallReleaseeID self) {
    tally *t = (tally *)context;
    (void)index, (void)self;
    t->whole += t->parts;
    return 1;
}
/* Adds parts to what waits for itself while it runs. */
static int growing(void *context, dcallindex_t index, dCallReleaseeID self) {
    f->alter_call_dependencies_count(impl, self, PARTS);
    for (int i = 0; i < PARTS; i++) f->post_call(impl, 0, 0, 0, self, 0, part, context, i + 1, "grown");
    return index == 0;
}
static void graph(tally *t, int fail) {
    int fault = 0;
    dCallReleaseeID releasee = 0;
    dCallWaitID wait = f->alloc_call_wait(impl);
    f->post_call(impl, &fault, &releasee, PARTS + 1, 0, wait, last, t, 0, "last");
    for (int i = 0; i < PARTS; i++)
        f->post_call(impl, 0, 0, 0, releasee, 0, fail && i == 3 ? failing : part, t, i + 1, "part");
    /* It can't have ended: one thing that it waits for is ours to take away. */
    dThreadedWaitTime none = {0, 1000};
    int status = 7;
    f->wait_call(impl, &status, wait, &none, "last");
    t->timeouts += status == 0;
    f->alter_call_dependencies_count(impl, releasee, -1);
    f->wait_call(impl, &status, wait, 0, "last");
    t->faults += fault != 0;
    f->reset_call_wait(impl, wait);
    f->post_call(impl, 0, 0, 0, 0, wait, growing, t, 0, "growing");
    f->wait_call(impl, 0, wait, 0, "growing");
    t->nested = t->parts;
    f->free_call_wait(impl, wait);
}
static void *post(void *at) {
    tally *t = (tally *)at;
    dWorldID w = dWorldCreate();
    dBodyID a, b;
    two_bodies(w, &a, &b);
    dJointAttach(dJointCreateBall(w, 0), a, b);
    dWorldSetGravity(w, 0, 0, -9.81);
    dWorldSetStepThreadingImplementation(w, f, impl);
    for (int round = 0; round < ROUNDS; round++) {
        t->own = f->alloc_mutex_group(impl, 1 + round % 3, 0);
        f->preallocate_resources_for_calls(impl, 2 * PARTS + 4);
        graph(t, round % 4 == 0);
        f->free_mutex_group(impl, t->own);
        dWorldStep(w, 0.01);
        dWorldQuickStep(w, 0.01);
    }
    t->z = dBodyGetPosition(a)[2];
    dWorldSetStepThreadingImplementation(w, 0, 0);
    dWorldDestroy(w);
    return 0;
}
static void torture(void) {
    pthread_t threads[POSTERS];
    tally tallies[POSTERS];
    memset(tallies, 0, sizeof tallies);
    memset(cells, 0, sizeof cells);
    mutexes = f->alloc_mutex_group(impl, CELLS, 0);
    for (int i = 0; i < POSTERS; i++) {
        pthread_create(&threads[i], 0, post, &tallies[i]);
        if (!at_once) pthread_join(threads[i], 0);
    }
    for (int i = 0; i < POSTERS; i++) {
        if (at_once) pthread_join(threads[i], 0);
        tally *t = &tallies[i];
        printf("tally %ld %ld %ld %ld %ld\n", t->whole, t->parts, t->faults, t->timeouts, t->nested);
        show1("z", t->z);
    }
    f->free_mutex_group(impl, mutexes);
    for (int i = 0; i < CELLS; i++) showi("cell", cells[i]);
}
static void *alone(void *at) {
    /* Each thread its own implementation, which works in the thread that waits. */
    dThreadingImplementationID own = dThreadingAllocateSelfThreadedImplementation();
    const dThreadingFunctionsInfo *g = dThreadingImplementationGetFunctions(own);
    for (int i = 0; i < 50; i++) {
        dCallReleaseeID releasee = 0;
        dCallWaitID wait = g->alloc_call_wait(own);
        g->post_call(own, 0, &releasee, 2, 0, wait, nothing, 0, 0, "end");
        for (int k = 0; k < 2; k++) g->post_call(own, 0, 0, 0, releasee, 0, nothing, 0, 0, "part");
        int status = 0;
        g->wait_call(own, &status, wait, 0, "end");
        *(long *)at += status;
        g->free_call_wait(own, wait);
    }
    dThreadingFreeImplementation(own);
    return 0;
}

int main(void) {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    at_once = getenv("LD_LIBRARY_PATH") != 0;
    impl = dThreadingAllocateMultiThreadedImplementation();
    f = dThreadingImplementationGetFunctions(impl);
    dThreadingThreadPoolID pools[2] = {dThreadingAllocateThreadPool(3, 0, dAllocateFlagBasicData, 0),
                                       dThreadingAllocateThreadPool(2, 1 << 20, dAllocateFlagBasicData, 0)};
    for (int round = 0; round < 3; round++) {
        dThreadingThreadPoolServeMultiThreadedImplementation(pools[0], impl);
        if (round != 1) dThreadingThreadPoolServeMultiThreadedImplementation(pools[1], impl);
        showi("threads", f->retrieve_thread_count(impl));
        torture();
        dThreadingImplementationShutdownProcessing(impl);
        for (int i = 0; i < 2; i++) dThreadingThreadPoolWaitIdleState(pools[i]);
        dThreadingImplementationCleanupForRestart(impl);
    }
    for (int i = 0; i < 2; i++) dThreadingFreeThreadPool(pools[i]);
    dThreadingFreeImplementation(impl);
    pthread_t threads[POSTERS];
    long done[POSTERS] = {0};
    for (int i = 0; i < POSTERS; i++) pthread_create(&threads[i], 0, alone, &done[i]);
    for (int i = 0; i < POSTERS; i++) {
        pthread_join(threads[i], 0);
        showi("done", done[i]);
    }
    dCloseODE();
    return 0;
}
