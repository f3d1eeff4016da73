/* How the library has work done by threads: a table of functions that a program can also bring itself. */
#ifndef FERRODE_ODE_THREADING_H
#define FERRODE_ODE_THREADING_H

#include <time.h>
#include <ode/odeconfig.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dxThreadingImplementation *dThreadingImplementationID;
typedef struct dxMutexGroup *dMutexGroupID;
typedef struct dxCallReleasee *dCallReleaseeID;
typedef struct dxCallWait *dCallWaitID;

typedef unsigned int dmutexindex_t;
typedef dsizeint ddependencycount_t;
typedef ddiffint ddependencychange_t;
typedef dsizeint dcallindex_t;

#define dTHREADING_THREAD_COUNT_UNLIMITED 0U

typedef struct dxThreadedWaitTime {
    time_t wait_sec;
    unsigned long wait_nsec;
} dThreadedWaitTime;

/* Groups of mutexes. */
typedef dMutexGroupID dMutexGroupAllocFunction(dThreadingImplementationID implementation, dmutexindex_t count,
        const char *const *names);
typedef void dMutexGroupFreeFunction(dThreadingImplementationID implementation, dMutexGroupID group);
typedef void dMutexGroupMutexLockFunction(dThreadingImplementationID implementation, dMutexGroupID group,
        dmutexindex_t index);
typedef void dMutexGroupMutexUnlockFunction(dThreadingImplementationID implementation, dMutexGroupID group,
        dmutexindex_t index);

/* A call that a thread makes; 0 for failure. */
typedef int dThreadedCallFunction(void *context, dcallindex_t instance, dCallReleaseeID releasee);

/* Calls: something to wait on, a call posted, dependencies of a posted call changed, a wait. Outputs, the timeout and names
   may be null; so may the dependent call and what to wait on. */
typedef dCallWaitID dThreadedCallWaitAllocFunction(dThreadingImplementationID implementation);
typedef void dThreadedCallWaitResetFunction(dThreadingImplementationID implementation, dCallWaitID wait);
typedef void dThreadedCallWaitFreeFunction(dThreadingImplementationID implementation, dCallWaitID wait);
typedef void dThreadedCallPostFunction(dThreadingImplementationID implementation, int *fault, dCallReleaseeID *posted,
        ddependencycount_t dependencies, dCallReleaseeID dependent, dCallWaitID wait, dThreadedCallFunction *call,
        void *context, dcallindex_t instance, const char *name);
typedef void dThreadedCallDependenciesCountAlterFunction(dThreadingImplementationID implementation,
        dCallReleaseeID target, ddependencychange_t change);
typedef void dThreadedCallWaitFunction(dThreadingImplementationID implementation, int *status, dCallWaitID wait,
        const dThreadedWaitTime *timeout, const char *name);

typedef unsigned int dThreadingImplThreadCountRetrieveFunction(dThreadingImplementationID implementation);
typedef int dThreadingImplResourcesForCallsPreallocateFunction(dThreadingImplementationID implementation,
        ddependencycount_t calls);

/* The table. struct_size is its size in bytes. */
typedef struct dxThreadingFunctionsInfo {
    unsigned int struct_size;
    dMutexGroupAllocFunction *alloc_mutex_group;
    dMutexGroupFreeFunction *free_mutex_group;
    dMutexGroupMutexLockFunction *lock_group_mutex;
    dMutexGroupMutexUnlockFunction *unlock_group_mutex;
    dThreadedCallWaitAllocFunction *alloc_call_wait;
    dThreadedCallWaitResetFunction *reset_call_wait;
    dThreadedCallWaitFreeFunction *free_call_wait;
    dThreadedCallPostFunction *post_call;
    dThreadedCallDependenciesCountAlterFunction *alter_call_dependencies_count;
    dThreadedCallWaitFunction *wait_call;
    dThreadingImplThreadCountRetrieveFunction *retrieve_thread_count;
    dThreadingImplResourcesForCallsPreallocateFunction *preallocate_resources_for_calls;
} dThreadingFunctionsInfo;

#ifdef __cplusplus
}
#endif

#endif
