/* Worlds: parameters and their defaults, what bodies inherit, step settings. */
#include "check.h"

static int blocks;
static void *get_block(dsizeint size) { blocks++; return malloc(size); }
static void *shrink_block(void *p, dsizeint old, dsizeint size) { (void)old; (void)size; return p; }
static void free_block(void *p, dsizeint size) { (void)size; blocks--; free(p); }

int main(void) {
    dInitODE();
    dWorldID w = dWorldCreate();
    int data;
    showi("data", dWorldGetData(w) == 0);
    dWorldSetData(w, &data);
    showi("data", dWorldGetData(w) == &data);
    V3(dWorldGetGravity, w);
    dWorldSetGravity(w, 1, 2, -3);
    V3(dWorldGetGravity, w);
#define REAL(name, value) do { R1(dWorldGet##name, w); dWorldSet##name(w, value); R1(dWorldGet##name, w); } while (0)
#define INT(name, value) do { I1(dWorldGet##name, w); dWorldSet##name(w, value); I1(dWorldGet##name, w); } while (0)
    REAL(ERP, 0.4);
    REAL(CFM, 1e-4);
    REAL(AutoDisableLinearThreshold, -0.5);
    REAL(AutoDisableAngularThreshold, 0.6);
    INT(AutoDisableSteps, 3);
    REAL(AutoDisableTime, 0.25);
    INT(AutoDisableAverageSamplesCount, 2);
    INT(AutoDisableFlag, 1);
    REAL(LinearDamping, 0.01);
    REAL(AngularDamping, 0.02);
    REAL(LinearDampingThreshold, 0.03);
    REAL(AngularDampingThreshold, 0.04);
    REAL(MaxAngularSpeed, 100);
    REAL(ContactMaxCorrectingVel, 10);
    REAL(ContactSurfaceLayer, 0.001);
    INT(QuickStepNumIterations, 30);
    REAL(QuickStepW, 1.2);
    INT(StepIslandsProcessingMaxThreadCount, 2);
    dWorldSetDamping(w, 0.05, 0.06);
    R1(dWorldGetLinearDamping, w);
    R1(dWorldGetAngularDamping, w);
    V3(dWorldImpulseToForce, w, 0.02, 1, 2, 3);
    dBodyID b = dBodyCreate(w);
    I1(dBodyGetAutoDisableFlag, b);
    R1(dBodyGetAutoDisableLinearThreshold, b);
    I1(dBodyGetAutoDisableSteps, b);
    R1(dBodyGetLinearDamping, b);
    R1(dBodyGetMaxAngularSpeed, b);

    dWorldID other = dWorldCreate();
    I1(dWorldUseSharedWorkingMemory, w, other);
    I1(dWorldUseSharedWorkingMemory, w, 0);
    dWorldStepReserveInfo reserve;
    reserve.struct_size = sizeof reserve;
    reserve.reserve_factor = 1.5f;
    reserve.reserve_minimum = 1000;
    I1(dWorldSetStepMemoryReservationPolicy, w, &reserve);
    I1(dWorldSetStepMemoryReservationPolicy, w, 0);
    dWorldStepMemoryFunctionsInfo functions = {sizeof functions, get_block, shrink_block, free_block};
    I1(dWorldSetStepMemoryManager, w, &functions);
    dWorldSetGravity(w, 0, 0, -9.81);
    for (int i = 0; i < 10; i++) I1(dWorldStep, w, 0.01);
    showi("block", blocks > 0);
    for (int i = 0; i < 10; i++) I1(dWorldQuickStep, w, 0.01);
    show_body("b", b);
    dWorldCleanupWorkingMemory(w);
    showi("blocks", blocks);
    dWorldStep(w, 0.01);
    dWorldDestroy(w);
    showi("blocks", blocks);
    dWorldDestroy(other);
    dCloseODE();
    return 0;
}
