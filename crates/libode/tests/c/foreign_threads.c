/* A threading table of the program's own, that passes everything on: the steps of a world of four islands come through it. */
#include "check.h"

static const dThreadingFunctionsInfo *inner;
static int posted, waited;
static void post(dThreadingImplementationID impl, int *fault, dCallReleaseeID *releasee, ddependencycount_t dependencies,
    dCallReleaseeID dependent, dCallWaitID wait, dThreadedCallFunction *call, void *context, dcallindex_t index, const char *name) {
    posted++;
    inner->post_call(impl, fault, releasee, dependencies, dependent, wait, call, context, index, name);
}
static void wait(dThreadingImplementationID impl, int *status, dCallWaitID w, const dThreadedWaitTime *timeout, const char *name) {
    waited++;
    inner->wait_call(impl, status, w, timeout, name);
}

int main(void) {
    dInitODE2(0);
    dThreadingImplementationID threads = dThreadingAllocateSelfThreadedImplementation();
    inner = dThreadingImplementationGetFunctions(threads);
    dThreadingFunctionsInfo own = *inner;
    own.post_call = post;
    own.wait_call = wait;
    dWorldID w = dWorldCreate();
    dBodyID a, b;
    for (int i = 0; i < 4; i++) {
        two_bodies(w, &a, &b);
        dJointAttach(dJointCreateBall(w, 0), a, b);
    }
    dWorldSetStepThreadingImplementation(w, &own, threads);
    for (int i = 0; i < 5; i++) dWorldStep(w, 0.01), dWorldQuickStep(w, 0.01);
    CHECKI(dWorldSetStepThreadingImplementation, posted > 0 && waited > 0);
    MOVES(dWorldSetStepThreadingImplementation, a);
    dWorldSetStepThreadingImplementation(w, 0, 0);
    int before = posted;
    dWorldStep(w, 0.01);
    showi("taken away", posted == before);
    dWorldDestroy(w);
    dThreadingFreeImplementation(threads);
    dCloseODE();
    return 0;
}
