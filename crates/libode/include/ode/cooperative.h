/* Threads that work on one problem together, and what they need for it. */
#ifndef FERRODE_ODE_COOPERATIVE_H
#define FERRODE_ODE_COOPERATIVE_H

#include <ode/common.h>
#include <ode/threading.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dxCooperative *dCooperativeID;
typedef struct dxResourceRequirements *dResourceRequirementsID;
typedef struct dxResourceContainer *dResourceContainerID;

/* The threads. */
ODE_API dCooperativeID dCooperativeCreate(const dThreadingFunctionsInfo *functions, dThreadingImplementationID
        implementation);
ODE_API void dCooperativeDestroy(dCooperativeID cooperative);

/* Requirements: estimates of several calls merged; a container has what they ask for. */
ODE_API dResourceContainerID dResourceContainerAcquire(dResourceRequirementsID requirements);
ODE_API void dResourceContainerDestroy(dResourceContainerID resources);
ODE_API dResourceRequirementsID dResourceRequirementsClone(dResourceRequirementsID requirements);
ODE_API dResourceRequirementsID dResourceRequirementsCreate(dCooperativeID cooperative);
ODE_API void dResourceRequirementsDestroy(dResourceRequirementsID requirements);
ODE_API void dResourceRequirementsMergeIn(dResourceRequirementsID summary, dResourceRequirementsID extra);

#ifdef __cplusplus
}
#endif

#endif
