/* What is destroyed gives its memory back: the heap does not grow over many rounds of making and destroying. */
#include "check.h"
#include <malloc.h>

static long in_use(void) {
    struct mallinfo2 m = mallinfo2();
    return (long)(m.uordblks + m.hblkhd);
}
/* Whether the heap stays within a few bytes a round. */
#define STAYS(f, rounds, ...) do { \
        for (int i = 0; i < 40; i++) { __VA_ARGS__; } \
        long before = in_use(); \
        for (int i = 0; i < rounds; i++) { __VA_ARGS__; } \
        CHECKI(f, in_use() - before < 4 * rounds); } while (0)

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate(), v;
    dBodyID b, kept = dBodyCreate(w);
    dJointID j;
    dJointGroupID group = dJointGroupCreate(0), other;
    STAYS(dWorldDestroy, 400, v = dWorldCreate(); dBodyCreate(v); dWorldDestroy(v));
    STAYS(dBodyDestroy, 400, b = dBodyCreate(w); dBodyDestroy(b));
    STAYS(dJointDestroy, 400, j = dJointCreateBall(w, 0); dJointAttach(j, kept, 0); dJointDestroy(j));
    STAYS(dJointGroupEmpty, 400, j = dJointCreateBall(w, group); dJointAttach(j, kept, 0); dJointGroupEmpty(group));
    STAYS(dJointGroupDestroy, 400, other = dJointGroupCreate(0); dJointGroupDestroy(other));
    dGeomID g;
    dSpaceID s;
    STAYS(dGeomDestroy, 400, g = dCreateBox(0, 1, 1, 1); dGeomDestroy(g));
    STAYS(dSpaceDestroy, 400, s = dHashSpaceCreate(0); dCreateSphere(s, 1); dSpaceDestroy(s));
    static const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const unsigned faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    dTriMeshDataID mesh;
    STAYS(dGeomTriMeshDataDestroy, 400, mesh = dGeomTriMeshDataCreate();
          dGeomTriMeshDataBuildSingle(mesh, corners, 12, 4, faces, 12, 12); dGeomTriMeshDataDestroy(mesh));
    static const float heights[9] = {0};
    dHeightfieldDataID field;
    STAYS(dGeomHeightfieldDataDestroy, 400, field = dGeomHeightfieldDataCreate();
          dGeomHeightfieldDataBuildSingle(field, heights, 1, 1, 1, 3, 3, 1, 0, 0, 0); dGeomHeightfieldDataDestroy(field));
    void *block;
    STAYS(dFree, 400, block = dAlloc(100); memset(block, 1, 100); dFree(block, 100));
    dThreadingImplementationID threads;
    STAYS(dThreadingFreeImplementation, 400, threads = dThreadingAllocateSelfThreadedImplementation();
          dThreadingFreeImplementation(threads));
    dThreadingThreadPoolID pool;
    STAYS(dThreadingFreeThreadPool, 40, threads = dThreadingAllocateMultiThreadedImplementation();
          pool = dThreadingAllocateThreadPool(1, 0, dAllocateFlagBasicData, 0);
          dThreadingThreadPoolServeMultiThreadedImplementation(pool, threads);
          dThreadingImplementationShutdownProcessing(threads);
          dThreadingFreeThreadPool(pool); dThreadingFreeImplementation(threads));
    threads = dThreadingAllocateSelfThreadedImplementation();
    const dThreadingFunctionsInfo *functions = dThreadingImplementationGetFunctions(threads);
    dCooperativeID cooperative;
    STAYS(dCooperativeDestroy, 4000, cooperative = dCooperativeCreate(functions, threads); dCooperativeDestroy(cooperative));
    cooperative = dCooperativeCreate(functions, threads);
    dResourceRequirementsID need;
    STAYS(dResourceRequirementsDestroy, 4000, need = dResourceRequirementsCreate(cooperative); dResourceRequirementsDestroy(need));
    need = dResourceRequirementsCreate(cooperative);
    dEstimateCooperativelyFactorLDLTResourceRequirements(need, 1, 40);
    dResourceContainerID room;
    STAYS(dResourceContainerDestroy, 4000, room = dResourceContainerAcquire(need); dResourceContainerDestroy(room));
    dResourceRequirementsDestroy(need);
    dCooperativeDestroy(cooperative);
    dThreadingFreeImplementation(threads);
    dJointGroupDestroy(group);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
