/* Starting up and closing down. */
#ifndef FERRODE_ODE_ODEINIT_H
#define FERRODE_ODE_ODEINIT_H

#include <ode/common.h>

#ifdef __cplusplus
extern "C" {
#endif

enum dInitODEFlags {
    dInitFlagManualThreadCleanup = 1
};

enum dAllocateODEDataFlags {
    dAllocateFlagBasicData = 0,
    dAllocateFlagCollisionData = 1,
    dAllocateMaskAll = ~0
};

/* Starts nest: each asks for a dCloseODE. 1 if it worked. */
ODE_API void dInitODE(void);
ODE_API int dInitODE2(unsigned int flags);
ODE_API void dCloseODE(void);

/* A thread's own data, which a thread that collides geoms should have; 1 if there is memory. */
ODE_API int dAllocateODEDataForThread(unsigned int flags);
ODE_API void dCleanupODEAllDataForThread(void);

#ifdef __cplusplus
}
#endif

#endif
