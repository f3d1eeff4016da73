/* Random numbers and small matrix tools, as for tests. */
#ifndef FERRODE_ODE_MISC_H
#define FERRODE_ODE_MISC_H

#include <ode/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One stream of random numbers for the process: the seed, 32 bits, an integer from 0 to n - 1, a real from 0 to 1.
   The iterative stepper draws from it. */
ODE_API unsigned long dRand(void);
ODE_API unsigned long dRandGetSeed(void);
ODE_API int dRandInt(int n);
ODE_API dReal dRandReal(void);
ODE_API void dRandSetSeed(unsigned long s);

/* Matrices of n rows and m columns, rows padded (dPAD). */
ODE_API void dClearUpperTriangle(dReal *A, int n);
ODE_API void dMakeRandomMatrix(dReal *A, int n, int m, dReal range);
ODE_API void dMakeRandomVector(dReal *A, int n, dReal range);
ODE_API dReal dMaxDifference(const dReal *A, const dReal *B, int n, int m);
ODE_API dReal dMaxDifferenceLowerTriangle(const dReal *A, const dReal *B, int n);
ODE_API void dPrintMatrix(const dReal *A, int n, int m, const char *format, FILE *file);

/* Self-tests: 1 if the generator, and the solver of boxed complementarity problems, give what they must; the debug handler
   hears of unsound data structures. */
ODE_API int dTestRand(void);
ODE_API int dTestSolveLCP(void);
ODE_API void dTestDataStructures(void);

#ifdef __cplusplus
}

ODE_PURE_INLINE void dPrintMatrix(const dReal *A, int n, int m, const char *format = "%10.4f ") {
    dPrintMatrix(A, n, m, format, stdout);
}

extern "C" {
#endif

#ifdef __cplusplus
}
#endif

#endif
