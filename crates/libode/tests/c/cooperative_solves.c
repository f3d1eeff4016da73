/* Cooperative matrix functions on a pool of two threads: the same numbers as the plain ones. */
#include "check.h"

enum { N = 50, SKIP = 52 };
static dReal a[N * SKIP], l[N * SKIP], d[N], x[N];

int main(void) {
    dInitODE2(0);
    for (int i = 0; i < N; i++) for (int k = 0; k < N; k++) a[i * SKIP + k] = (i == k ? 4 : 0) + 1 / (dReal)(1 + abs(i - k));
    dThreadingImplementationID threads = dThreadingAllocateMultiThreadedImplementation();
    dThreadingThreadPoolID pool = dThreadingAllocateThreadPool(2, 0, dAllocateFlagBasicData, 0);
    dThreadingThreadPoolServeMultiThreadedImplementation(pool, threads);
    const dThreadingFunctionsInfo *functions = dThreadingImplementationGetFunctions(threads);
    dCooperativeID cooperative = dCooperativeCreate(functions, threads);
    CHECKI(dCooperativeCreate, cooperative != 0);
    dResourceRequirementsID need = dResourceRequirementsCreate(cooperative);
    CHECKI(dResourceRequirementsCreate, need != 0);
    dEstimateCooperativelyFactorLDLTResourceRequirements(need, 2, N);
    dEstimateCooperativelySolveLDLTResourceRequirements(need, 2, N);
    dResourceRequirementsID more = dResourceRequirementsClone(need);
    CHECKI(dResourceRequirementsClone, more != 0 && more != need);
    dEstimateCooperativelySolveL1StraightResourceRequirements(more, 2, N);
    dEstimateCooperativelySolveL1TransposedResourceRequirements(more, 2, N);
    dEstimateCooperativelyScaleVectorResourceRequirements(more, 2, N);
    dResourceRequirementsMergeIn(need, more);
    dResourceContainerID room = dResourceContainerAcquire(need);
    CHECKI(dResourceContainerAcquire, room != 0);
    memcpy(l, a, sizeof a);
    dCooperativelyFactorLDLT(room, 2, l, d, N, SKIP);
    CHECK(dCooperativelyFactorLDLT, d, N);
    for (int i = 0; i < N; i++) x[i] = i - 20;
    dCooperativelySolveLDLT(room, 2, l, d, x, N, SKIP);
    CHECK(dCooperativelySolveLDLT, x, N);
    for (int i = 0; i < N; i++) x[i] = i - 20;
    dCooperativelySolveL1Straight(room, 2, l, x, N, SKIP);
    CHECK(dCooperativelySolveL1Straight, x, N);
    dCooperativelyScaleVector(room, 2, x, d, N);
    CHECK(dCooperativelyScaleVector, x, N);
    dCooperativelySolveL1Transposed(room, 2, l, x, N, SKIP);
    CHECK(dCooperativelySolveL1Transposed, x, N);
    dResourceContainerDestroy(room);
    dResourceRequirementsDestroy(more);
    dResourceRequirementsDestroy(need);
    dCooperativeDestroy(cooperative);
    dThreadingImplementationShutdownProcessing(threads);
    dThreadingFreeThreadPool(pool);
    dThreadingFreeImplementation(threads);
    dCloseODE();
    return 0;
}
