/* What each build says of itself and does by default; `expect` is the precision, 1 for meshes, 1 for checked arguments. */
#include <ode/ode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int heard;
static void handler(int number, const char *format, va_list arguments) {
    (void)number;
    (void)format;
    (void)arguments;
    heard++;
    /* The library would end the process now: leave by exit, with what was seen so far. */
    printf("heard %d\n", heard);
    exit(0);
}

int main(void) {
    dWorldID world;
    dBodyID body;
    dTriMeshDataID data;
    dMass mass;
    printf("%s\n", dGetConfiguration());
    printf("trimesh %d no_debug %d\n", dCheckConfiguration("ODE_EXT_trimesh"), dCheckConfiguration("ODE_EXT_no_debug"));
    printf("sizeof(dReal) %d single %d double %d\n", (int)sizeof(dReal), dCheckConfiguration("ODE_single_precision"),
           dCheckConfiguration("ODE_double_precision"));
    dInitODE2(0);
    world = dWorldCreate();
    printf("cfm %g erp %g\n", (double)dWorldGetCFM(world), (double)dWorldGetERP(world));
    data = dGeomTriMeshDataCreate();
    printf("mesh data %d\n", data != 0);
    body = dBodyCreate(world);
    dMassSetBoxTotal(&mass, 2, 1, 2, 3);
    dBodySetMass(body, &mass);
    printf("mass %g %g\n", (double)mass.mass, (double)mass.I[0]);
    dWorldSetGravity(world, 0, 0, -10);
    dWorldStep(world, REAL(0.01));
    printf("z %.6f\n", (double)dBodyGetPosition(body)[2]);
    dSetDebugHandler(handler);
    /* A stale handle, a null, and a mistake in an argument. */
    dBodyDestroy(body);
    dBodySetPosition(body, 1, 2, 3);
    printf("stale %d\n", dBodyGetPosition(body) == 0);
    dBodySetPosition(0, 1, 2, 3);
    printf("step %d\n", dWorldStep(world, -1));
    printf("geom %d\n", dGeomGetClass(0));
    dWorldDestroy(world);
    dCloseODE();
    printf("end\n");
    return 0;
}
