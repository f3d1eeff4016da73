/* Spaces: sets of geoms in which pairs that may touch are found. */
#ifndef FERRODE_ODE_COLLISION_SPACE_H
#define FERRODE_ODE_COLLISION_SPACE_H

#include <ode/common.h>

#ifdef __cplusplus
extern "C" {
#endif

struct dContactGeom;

/* Called for each pair that may touch, or with a space when spaces are nested. */
typedef void dNearCallback(void *data, dGeomID o1, dGeomID o2);

/* The order of axes of a sweep and prune space: the first, four times the second, 16 times the third. */
#define dSAP_AXES_XYZ (0 + 4 * 1 + 16 * 2)
#define dSAP_AXES_XZY (0 + 4 * 2 + 16 * 1)
#define dSAP_AXES_YXZ (1 + 4 * 0 + 16 * 2)
#define dSAP_AXES_YZX (1 + 4 * 2 + 16 * 0)
#define dSAP_AXES_ZXY (2 + 4 * 0 + 16 * 1)
#define dSAP_AXES_ZYX (2 + 4 * 1 + 16 * 0)

/* Kinds of spaces, each in another space or in none (null). */
ODE_API dSpaceID dHashSpaceCreate(dSpaceID space);
ODE_API dSpaceID dQuadTreeSpaceCreate(dSpaceID space, const dVector3 center, const dVector3 extents, int depth);
ODE_API dSpaceID dSimpleSpaceCreate(dSpaceID space);
ODE_API dSpaceID dSweepAndPruneSpaceCreate(dSpaceID space, int axis_order);

/* Cell sizes of a hash space: powers of two from 2^min to 2^max. */
ODE_API void dHashSpaceGetLevels(dSpaceID space, int *min_level, int *max_level);
ODE_API void dHashSpaceSetLevels(dSpaceID space, int min_level, int max_level);

/* Members. */
ODE_API void dSpaceAdd(dSpaceID space, dGeomID geom);
ODE_API void dSpaceClean(dSpaceID space);
ODE_API dGeomID dSpaceGetGeom(dSpaceID space, int i);
ODE_API int dSpaceGetNumGeoms(dSpaceID space);
ODE_API int dSpaceQuery(dSpaceID space, dGeomID geom);
ODE_API void dSpaceRemove(dSpaceID space, dGeomID geom);

/* The space itself. With cleanup on, it destroys its members along with itself. */
ODE_API void dSpaceDestroy(dSpaceID space);
ODE_API int dSpaceGetClass(dSpaceID space);
ODE_API int dSpaceGetCleanup(dSpaceID space);
ODE_API int dSpaceGetManualCleanup(dSpaceID space);
ODE_API int dSpaceGetSublevel(dSpaceID space);
ODE_API void dSpaceSetCleanup(dSpaceID space, int mode);
ODE_API void dSpaceSetManualCleanup(dSpaceID space, int mode);
ODE_API void dSpaceSetSublevel(dSpaceID space, int sublevel);

#ifdef __cplusplus
}
#endif

#endif
