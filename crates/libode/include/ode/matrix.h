/* Dense matrices: rows padded (dPAD), or of stride nskip where a function takes that. */
#ifndef FERRODE_ODE_MATRIX_H
#define FERRODE_ODE_MATRIX_H

#include <ode/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Vectors. */
ODE_API void dSetZero(dReal *a, int n);
ODE_API void dSetValue(dReal *a, int n, dReal value);
ODE_API dReal dDot(const dReal *a, const dReal *b, int n);
ODE_API void dScaleVector(dReal *a, const dReal *d, int n);
ODE_API ODE_API_DEPRECATED void dVectorScale(dReal *a, const dReal *d, int n);

/* Products A = B C, A = B' C and A = B C'; A has p rows and r columns. */
ODE_API void dMultiply0(dReal *A, const dReal *B, const dReal *C, int p, int q, int r);
ODE_API void dMultiply1(dReal *A, const dReal *B, const dReal *C, int p, int q, int r);
ODE_API void dMultiply2(dReal *A, const dReal *B, const dReal *C, int p, int q, int r);

/* Cholesky factors of a positive definite matrix, in its lower triangle; 1 if it is positive definite. */
ODE_API int dFactorCholesky(dReal *A, int n);
ODE_API void dSolveCholesky(const dReal *L, dReal *b, int n);
ODE_API int dInvertPDMatrix(const dReal *A, dReal *Ainv, int n);
ODE_API int dIsPositiveDefinite(const dReal *A, int n);

/* Factors L D L'; d holds the inverses of D. */
ODE_API void dFactorLDLT(dReal *A, dReal *d, int n, int nskip);
ODE_API void dSolveL1(const dReal *L, dReal *b, int n, int nskip);
ODE_API void dSolveL1T(const dReal *L, dReal *b, int n, int nskip);
ODE_API void dSolveLDLT(const dReal *L, const dReal *d, dReal *b, int n, int nskip);

/* A row and column changed, taken out of the factors, or taken out of a matrix. */
ODE_API void dLDLTAddTL(dReal *L, dReal *d, const dReal *a, int n, int nskip);
ODE_API void dLDLTRemove(dReal **A, const int *p, dReal *L, dReal *d, int n1, int n2, int r, int nskip);
ODE_API void dRemoveRowCol(dReal *A, int n, int nskip, int r);

#ifdef __cplusplus
}
#endif

#endif
