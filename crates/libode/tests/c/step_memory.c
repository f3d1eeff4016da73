/* Step memory: a manager of the program's own is called in balance, worlds share, and the reserve grows on request. */
#include "check.h"

static long taken, given, largest;
static void *take(dsizeint size) { taken++; if ((long)size > largest) largest = (long)size; return malloc(size); }
static void *shrink(void *p, dsizeint old, dsizeint size) { (void)old, (void)size; return p; }
static void give(void *p, dsizeint size) { (void)size; given++; free(p); }
static dWorldID chain(int links) {
    dWorldID w = dWorldCreate();
    dBodyID last = 0;
    dWorldSetGravity(w, 0, 0, -9.81);
    for (int i = 0; i < links; i++) {
        dBodyID b = dBodyCreate(w);
        dBodySetPosition(b, i, 0, 0);
        dJointID j = dJointCreateBall(w, 0);
        dJointAttach(j, b, last);
        dJointSetBallAnchor(j, i - 0.5, 0, 0);
        last = b;
    }
    return w;
}

int main(void) {
    dInitODE2(0);
    dWorldID w = chain(4), bare = chain(4), other = chain(6);
    dWorldStepMemoryFunctionsInfo manager = {sizeof manager, take, shrink, give};
    I1(dWorldSetStepMemoryManager, w, &manager);
    dWorldStepReserveInfo reserve = {sizeof reserve, 1.5f, 1u << 20};
    I1(dWorldSetStepMemoryReservationPolicy, w, &reserve);
    for (int i = 0; i < 5; i++) {
        showi("steps", dWorldStep(w, 0.01) && dWorldQuickStep(w, 0.01));
        dWorldStep(bare, 0.01);
        dWorldQuickStep(bare, 0.01);
    }
    CHECKI(dWorldSetStepMemoryManager, taken > 0);
    CHECKI(dWorldSetStepMemoryReservationPolicy, largest >= 1 << 20);
    dWorldCleanupWorkingMemory(w);
    CHECKI(dWorldCleanupWorkingMemory, taken == given && given > 0);
    I1(dWorldUseSharedWorkingMemory, other, w);
    long before = taken;
    dWorldStep(other, 0.01);
    CHECKI(dWorldUseSharedWorkingMemory, taken > before);
    dWorldStep(w, 0.01);
    dWorldDestroy(w);
    dWorldStep(other, 0.01);
    dWorldDestroy(other);
    showi("balance", taken == given);
    dWorldDestroy(bare);
    dCloseODE();
    return 0;
}
