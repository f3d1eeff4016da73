/* Each cooperative function in a room of its own, acquired by its own estimate, by a clone's and by a merged one. */
#include "check.h"

enum { N = 12, SKIP = 12 };
static dReal a[N * SKIP], l[N * SKIP], d[N], x[N];
static void begin(void) { for (int i = 0; i < N; i++) x[i] = i - 4; }

int main(void) {
    dInitODE2(0);
    for (int i = 0; i < N; i++) for (int k = 0; k < N; k++) a[i * SKIP + k] = (i == k ? 3 : 0) + 1 / (dReal)(1 + abs(i - k));
    dThreadingImplementationID threads = dThreadingAllocateSelfThreadedImplementation();
    dCooperativeID cooperative = dCooperativeCreate(dThreadingImplementationGetFunctions(threads), threads);
    for (int kind = 0; kind < 7; kind++) {
        dResourceRequirementsID need = dResourceRequirementsCreate(cooperative), other = need;
        if (kind == 0) dEstimateCooperativelyFactorLDLTResourceRequirements(need, 1, N);
        if (kind == 1) dEstimateCooperativelySolveLDLTResourceRequirements(need, 1, N);
        if (kind == 2) dEstimateCooperativelySolveL1StraightResourceRequirements(need, 1, N);
        if (kind == 3) dEstimateCooperativelySolveL1TransposedResourceRequirements(need, 1, N);
        if (kind >= 4) dEstimateCooperativelyScaleVectorResourceRequirements(need, 1, N);
        if (kind == 5) other = dResourceRequirementsClone(need);
        if (kind == 6) {
            other = dResourceRequirementsCreate(cooperative);
            dResourceRequirementsMergeIn(other, need);
        }
        dResourceContainerID room = dResourceContainerAcquire(other);
        begin();
        if (kind == 0) {
            memcpy(l, a, sizeof a);
            dCooperativelyFactorLDLT(room, 1, l, d, N, SKIP);
            CHECK(dEstimateCooperativelyFactorLDLTResourceRequirements, d, N);
        }
        if (kind == 1) {
            dCooperativelySolveLDLT(room, 1, l, d, x, N, SKIP);
            CHECK(dEstimateCooperativelySolveLDLTResourceRequirements, x, N);
        }
        if (kind == 2) {
            dCooperativelySolveL1Straight(room, 1, l, x, N, SKIP);
            CHECK(dEstimateCooperativelySolveL1StraightResourceRequirements, x, N);
        }
        if (kind == 3) {
            dCooperativelySolveL1Transposed(room, 1, l, x, N, SKIP);
            CHECK(dEstimateCooperativelySolveL1TransposedResourceRequirements, x, N);
        }
        if (kind >= 4) dCooperativelyScaleVector(room, 1, x, d, N);
        if (kind == 4) CHECK(dEstimateCooperativelyScaleVectorResourceRequirements, x, N);
        if (kind == 5) CHECK(dResourceRequirementsClone, x, N);
        if (kind == 6) CHECK(dResourceRequirementsMergeIn, x, N);
        dResourceContainerDestroy(room);
        if (other != need) dResourceRequirementsDestroy(other);
        dResourceRequirementsDestroy(need);
    }
    dCooperativeDestroy(cooperative);
    dThreadingFreeImplementation(threads);
    dCloseODE();
    return 0;
}
