/* Threading implementations: steps of a world in a pool's threads and in the program's own, restarted in between. */
#include "check.h"
#include <pthread.h>
#include <unistd.h>

static dThreadingImplementationID threads;
static volatile int ready;
static void served(void *context) { *(volatile int *)context = 1; }
static void *serve(void *unused) {
    dExternalThreadingServeMultiThreadedImplementation(threads, served, (void *)&ready);
    return unused;
}
static int calls;
static int count(void *context, dcallindex_t index, dCallReleaseeID self) {
    (void)context, (void)self;
    calls += 1 + (int)index;
    return 1;
}
/* A call that lasts a second, or until the program no longer waits for it. */
static int begun, waited, ended;
static int get(const int *flag) { return __atomic_load_n(flag, __ATOMIC_SEQ_CST); }
static void set(int *flag, int to) { __atomic_store_n(flag, to, __ATOMIC_SEQ_CST); }
static int last(void *context, dcallindex_t index, dCallReleaseeID self) {
    (void)context, (void)index, (void)self;
    set(&begun, 1);
    for (int i = 0; i < 100 && !get(&waited); i++) usleep(10000);
    set(&ended, !get(&waited));
    return 1;
}
static void post(void) {
    const dThreadingFunctionsInfo *f = dThreadingImplementationGetFunctions(threads);
    dCallWaitID wait = f->alloc_call_wait(threads);
    f->preallocate_resources_for_calls(threads, 4);
    f->post_call(threads, 0, 0, 0, 0, wait, count, 0, 2, "count");
    f->wait_call(threads, 0, wait, 0, "count");
    f->free_call_wait(threads, wait);
}

int main(void) {
    dInitODE2(0);
    threads = dThreadingAllocateSelfThreadedImplementation();
    CHECKI(dThreadingAllocateSelfThreadedImplementation, dThreadingImplementationGetFunctions(threads)->retrieve_thread_count(threads));
    post();
    CHECKI(dThreadingImplementationGetFunctions, calls);
    dThreadingFreeImplementation(threads);

    threads = dThreadingAllocateMultiThreadedImplementation();
    const dThreadingFunctionsInfo *f = dThreadingImplementationGetFunctions(threads);
    CHECKI(dThreadingAllocateMultiThreadedImplementation, f->retrieve_thread_count(threads));
    dThreadingThreadPoolID pool = dThreadingAllocateThreadPool(3, 0, dAllocateFlagBasicData, 0);
    CHECKI(dThreadingAllocateThreadPool, pool != 0);
    dThreadingThreadPoolServeMultiThreadedImplementation(pool, threads);
    CHECKI(dThreadingThreadPoolServeMultiThreadedImplementation, f->retrieve_thread_count(threads));
    post();
    showi("calls", calls);
    dWorldID w = dWorldCreate();
    dBodyID a, b;
    two_bodies(w, &a, &b);
    dJointAttach(dJointCreateBall(w, 0), a, b);
    dWorldSetStepThreadingImplementation(w, f, threads);
    for (int i = 0; i < 5; i++) dWorldStep(w, 0.01), dWorldQuickStep(w, 0.01);
    MOVES(dWorldSetStepThreadingImplementation, a);
    f->post_call(threads, 0, 0, 0, 0, 0, last, 0, 0, "last");
    while (!get(&begun)) ;
    dThreadingImplementationShutdownProcessing(threads);
    dThreadingThreadPoolWaitIdleState(pool);
    set(&waited, 1);
    CHECKI(dThreadingThreadPoolWaitIdleState, get(&ended));
    CHECKI(dThreadingImplementationShutdownProcessing, f->retrieve_thread_count(threads));
    dThreadingImplementationCleanupForRestart(threads);
    pthread_t thread;
    pthread_create(&thread, 0, serve, 0);
    while (!ready) ;
    CHECKI(dExternalThreadingServeMultiThreadedImplementation, ready);
    while (f->retrieve_thread_count(threads) == 0) ;
    calls = 0;
    post();
    CHECKI(dThreadingImplementationCleanupForRestart, calls);
    dThreadingImplementationShutdownProcessing(threads);
    pthread_join(thread, 0);
    dThreadingFreeThreadPool(pool);
    dWorldSetStepThreadingImplementation(w, 0, 0);
    dThreadingFreeImplementation(threads);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
