/* Starting and closing the library: what is returned, threads' data, and the words of the configuration. */
#include "check.h"

static jmp_buf away;
static int number;
static void leave(int n, const char *format, va_list ap) {
    (void)format, (void)ap;
    number = n;
    longjmp(away, 1);
}
static int collides(void) {
    dGeomID a = dCreateSphere(0, 1), b = dCreateSphere(0, 1);
    dContactGeom c;
    int n = -1;
    if (!setjmp(away)) n = dCollide(a, b, 1, &c, sizeof c);
    dGeomDestroy(a);
    dGeomDestroy(b);
    return n;
}

int main(void) {
    dSetDebugHandler(leave);
    showi("before", collides());
    I1(dInitODE2, dInitFlagManualThreadCleanup);
    I1(dAllocateODEDataForThread, dAllocateFlagCollisionData);
    CHECKI(dInitODE2, collides());
    dCleanupODEAllDataForThread();
    CHECKI(dCleanupODEAllDataForThread, collides());
    dCloseODE();
    CHECKI(dCloseODE, collides());
    dInitODE();
    CHECKI(dInitODE, collides());
    dCloseODE();
    number = 0;
    if (!setjmp(away)) dCloseODE();
    showi("once too often", number);
    const char *words = dGetConfiguration();
    CHECKI(dGetConfiguration, strncmp(words, "ODE", 3) == 0 && strstr(words, "ODE_EXT_trimesh") != 0);
    I1(dCheckConfiguration, "ODE_EXT_trimesh");
    I1(dCheckConfiguration, "ODE_EXT_threading");
    I1(dCheckConfiguration, "ODE_EXT_gimpact");
    return 0;
}
