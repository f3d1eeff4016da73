/* Memory for the library's records: the C library's unless the program sets functions of its own, before dInitODE.
   */
#ifndef FERRODE_ODE_MEMORY_H
#define FERRODE_ODE_MEMORY_H

#include <ode/odeconfig.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef void *dAllocFunction(dsizeint size);
typedef void *dReallocFunction(void *block, dsizeint old_size, dsizeint new_size);
typedef void dFreeFunction(void *block, dsizeint size);

/* Null stands for malloc, realloc and free. */
ODE_API dAllocFunction *dGetAllocHandler(void);
ODE_API dFreeFunction *dGetFreeHandler(void);
ODE_API dReallocFunction *dGetReallocHandler(void);
ODE_API void dSetAllocHandler(dAllocFunction *fn);
ODE_API void dSetFreeHandler(dFreeFunction *fn);
ODE_API void dSetReallocHandler(dReallocFunction *fn);

/* By the functions that are set. Sizes are those that a block was got with. */
ODE_API void *dAlloc(dsizeint size);
ODE_API void dFree(void *ptr, dsizeint size);
ODE_API void *dRealloc(void *ptr, dsizeint oldsize, dsizeint newsize);

#ifdef __cplusplus
}
#endif

#endif
