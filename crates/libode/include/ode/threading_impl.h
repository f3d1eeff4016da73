/* The library's own threading: work done by the calling thread, or by threads that serve. */
#ifndef FERRODE_ODE_THREADING_IMPL_H
#define FERRODE_ODE_THREADING_IMPL_H

#include <ode/odeconfig.h>
#include <ode/threading.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dxThreadingThreadPool *dThreadingThreadPoolID;

/* Called once a thread is ready to serve. */
typedef void dThreadReadyToServeCallback(void *context);

/* Implementations. Shut one down before the threads that serve it are joined; clean it up to use it again. */
ODE_API dThreadingImplementationID dThreadingAllocateMultiThreadedImplementation(void);
ODE_API dThreadingImplementationID dThreadingAllocateSelfThreadedImplementation(void);
ODE_API void dThreadingImplementationCleanupForRestart(dThreadingImplementationID implementation);
ODE_API const dThreadingFunctionsInfo *dThreadingImplementationGetFunctions(dThreadingImplementationID
        implementation);
ODE_API void dThreadingImplementationShutdownProcessing(dThreadingImplementationID implementation);
ODE_API void dThreadingFreeImplementation(dThreadingImplementationID implementation);

/* Makes the calling thread serve until the implementation is shut down. */
ODE_API void dExternalThreadingServeMultiThreadedImplementation(dThreadingImplementationID implementation,
        dThreadReadyToServeCallback *ready, void *context);

/* Threads of the library's. `reserved` is null. */
ODE_API dThreadingThreadPoolID dThreadingAllocateThreadPool(unsigned int thread_count, dsizeint stack_size, unsigned
        int allocate_flags, void *reserved);
ODE_API void dThreadingFreeThreadPool(dThreadingThreadPoolID pool);
ODE_API void dThreadingThreadPoolServeMultiThreadedImplementation(dThreadingThreadPoolID pool,
        dThreadingImplementationID implementation);
ODE_API void dThreadingThreadPoolWaitIdleState(dThreadingThreadPoolID pool);

#ifdef __cplusplus
}
#endif

#endif
