/* Included before the programs when single precision is compared with double: the default CFM, 1e-5 and 1e-10, is the one
   deliberate difference between the two, so all worlds get the same. */
#include <ode/ode.h>

static inline dWorldID world_of_one_cfm(void) {
    dWorldID world = dWorldCreate();
    dWorldSetCFM(world, REAL(1e-5));
    return world;
}
#define dWorldCreate world_of_one_cfm
