/* A world as text. */
#ifndef FERRODE_ODE_EXPORT_DIF_H
#define FERRODE_ODE_EXPORT_DIF_H

#include <ode/common.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Writes a world to a file, in the interchange format that ODE's scripts read. */
ODE_API void dWorldExportDIF(dWorldID world, FILE *file, const char *world_name);

#ifdef __cplusplus
}
#endif

#endif
