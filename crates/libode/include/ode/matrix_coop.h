/* The factorisation and its solutions by several threads at once. */
#ifndef FERRODE_ODE_MATRIX_COOP_H
#define FERRODE_ODE_MATRIX_COOP_H

#include <ode/common.h>
#include <ode/cooperative.h>
#include <ode/threading.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a call will need, to be added to requirements beforehand. */
ODE_API void dEstimateCooperativelyFactorLDLTResourceRequirements(dResourceRequirementsID requirements, unsigned int
        max_threads, unsigned int max_rows);
ODE_API void dEstimateCooperativelyScaleVectorResourceRequirements(dResourceRequirementsID requirements, unsigned
        int max_threads, unsigned int max_elements);
ODE_API void dEstimateCooperativelySolveL1StraightResourceRequirements(dResourceRequirementsID requirements,
        unsigned int max_threads, unsigned int max_rows);
ODE_API void dEstimateCooperativelySolveL1TransposedResourceRequirements(dResourceRequirementsID requirements,
        unsigned int max_threads, unsigned int max_rows);
ODE_API void dEstimateCooperativelySolveLDLTResourceRequirements(dResourceRequirementsID requirements, unsigned int
        max_threads, unsigned int max_rows);

/* The calls. */
ODE_API void dCooperativelyFactorLDLT(dResourceContainerID resources, unsigned int threads, dReal *A, dReal *d,
        unsigned int rows, unsigned int row_skip);
ODE_API void dCooperativelyScaleVector(dResourceContainerID resources, unsigned int threads, dReal *vector, const
        dReal *scale, unsigned int elements);
ODE_API void dCooperativelySolveL1Straight(dResourceContainerID resources, unsigned int threads, const dReal *L,
        dReal *b, unsigned int rows, unsigned int row_skip);
ODE_API void dCooperativelySolveL1Transposed(dResourceContainerID resources, unsigned int threads, const dReal *L,
        dReal *b, unsigned int rows, unsigned int row_skip);
ODE_API void dCooperativelySolveLDLT(dResourceContainerID resources, unsigned int threads, const dReal *L, const
        dReal *d, dReal *b, unsigned int rows, unsigned int row_skip);

#ifdef __cplusplus
}
#endif

#endif
