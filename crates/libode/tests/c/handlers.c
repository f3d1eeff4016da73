/* Error, debug, message and memory handlers; what ends the process, and what escapes it. */
#include "check.h"
#include <sys/wait.h>
#include <unistd.h>

static jmp_buf escape;
static char last[300];
static int last_number;

static void note(int number, const char *format, va_list ap) {
    last_number = number;
    vsnprintf(last, sizeof last, format, ap);
    char *place = strstr(last, " [");
    if (place) *place = 0;
}
static void jump(int number, const char *format, va_list ap) {
    note(number, format, ap);
    longjmp(escape, 1);
}
#define FAULT(...) do { \
        if (!setjmp(escape)) { __VA_ARGS__; printf("%s: no fault\n", #__VA_ARGS__); } \
        else if (last_number == 2) printf("%s: %d %s\n", #__VA_ARGS__, last_number, last); \
        else printf("%s: %d\n", #__VA_ARGS__, last_number); \
    } while (0)
/* Where ODE names an inner function. */
#define FAULT_NUMBER(...) do { \
        if (!setjmp(escape)) { __VA_ARGS__; printf("%s: no fault\n", #__VA_ARGS__); } \
        else printf("%s: %d\n", #__VA_ARGS__, last_number); \
    } while (0)
#define ENDS(...) do { \
        fflush(stdout); \
        int status; \
        if (!fork()) { freopen("/dev/null", "w", stderr); __VA_ARGS__; _exit(0); } \
        wait(&status); \
        if (WIFSIGNALED(status)) printf("%s: signal %d\n", #__VA_ARGS__, WTERMSIG(status)); \
        else printf("%s: exit %d\n", #__VA_ARGS__, WEXITSTATUS(status)); \
    } while (0)

static size_t balance;
static void *my_alloc(dsizeint size) { balance += size; return malloc(size); }
static void *my_realloc(void *p, dsizeint old, dsizeint size) { balance += size - old; return realloc(p, size); }
static void my_free(void *p, dsizeint size) { balance -= size; free(p); }

int main(void) {
    showi("default", !dGetErrorHandler() && !dGetDebugHandler() && !dGetMessageHandler());
    ENDS(dError(5, "error %d", 3));
    ENDS(dDebug(5, "debug %d", 3));
    ENDS(dMessage(5, "message %d", 3));
    ENDS(dCloseODE());
    ENDS(dSetErrorHandler(note); dError(5, "x"));
    ENDS(dSetDebugHandler(note); dDebug(5, "x"));
    dSetMessageHandler(note);
    showi("set", dGetMessageHandler() == note);
    dMessage(17, "text %s %d %g %g %g", "with", 42, 1.5, 2.5, 3.5);
    printf("%d %s\n", last_number, last);
    dSetDebugHandler(jump);
    dSetErrorHandler(jump);
    showi("set", dGetDebugHandler() == jump && dGetErrorHandler() == jump);
    FAULT(dDebug(9, "%s %d", "debug", 9));
    FAULT(dError(2, "%s %d", "error", 9));

    dInitODE2(0);
    dWorldID w = dWorldCreate(), v = dWorldCreate();
    dBodyID a = dBodyCreate(w), b = dBodyCreate(w), c = dBodyCreate(v);
    dJointID hinge = dJointCreateHinge(w, 0), ball = dJointCreateBall(w, 0), hinge2 = dJointCreateHinge2(w, 0),
             motor = dJointCreateAMotor(w, 0), gear = dJointCreateTransmission(w, 0);
    dMass m;
    dQuaternion q = {0, 0, 0, 0};
    dMatrix3 r = {0};
    dVector3 zero = {0, 0, 0};
    FAULT(dBodyGetPosition(0));
    FAULT(dWorldSetERP(0, 1));
    FAULT(dJointSetHingeAnchor(0, 0, 0, 0));
    FAULT(dJointSetHingeAnchor(ball, 0, 0, 0));
    FAULT(dJointGetHingeAnchor(hinge, 0));
    FAULT(dJointSetFixed(hinge));
    FAULT(dJointSetHingeAxis(hinge, 0, 0, 0));
    FAULT(dJointAttach(hinge, a, a));
    FAULT(dJointAttach(hinge, a, c));
    FAULT(dJointAttach(hinge2, a, 0));
    FAULT(dWorldStep(w, 0));
    FAULT(dWorldQuickStep(w, -1));
    FAULT(dMassSetZero(&m); dBodySetMass(a, &m));
    FAULT(dMassSetSphereTotal(&m, 1, 1); m.c[0] = 1; m.I[5] = 4; m.I[10] = 4; dBodySetMass(a, &m));
    FAULT(dBodySetQuaternion(a, q));
    FAULT(dBodySetRotation(a, r));
    FAULT(dBodySetPosition(a, NAN, 0, 0));
    FAULT(dJointSetAMotorAxis(motor, 5, 0, 1, 0, 0));
    FAULT(dJointSetAMotorNumAxes(motor, 5));
    FAULT(dJointSetAMotorParam(motor, dParamVel + 0x400, 1));
    FAULT(dJointSetTransmissionAxis1(gear, 1, 0, 0));
    FAULT(dJointSetTransmissionRatio(gear, 0));
    FAULT_NUMBER(dJointSetHinge2Axis1(hinge2, 1, 0, 0));
    FAULT(dMassSetCapsule(&m, 1, 4, 1, 1));
    FAULT_NUMBER(dFactorCholesky(r, 0); printf("x"));
    FAULT(dNormalize3(zero));
    FAULT_NUMBER(dSafeNormalize3(0); printf("x"));
    FAULT(dAreConnected(0, a));
    FAULT(dConnectingJoint(0, 0));
    FAULT(dJointDestroy(0));
    FAULT(dJointGroupEmpty(0));
    FAULT(dJointCreateContact(w, 0, 0));
    FAULT(dJointSetFeedback(0, 0));
    FAULT(dJointGetType(0));
    /* Everything still works after all these jumps. */
    dWorldSetGravity(v, 0, 0, -10);
    dWorldStep(v, 0.1);
    show_body("c", c);

    showi("memory", !dGetAllocHandler() && !dGetReallocHandler() && !dGetFreeHandler());
    char *text = dAlloc(10);
    strcpy(text, "kept");
    text = dRealloc(text, 10, 1000);
    printf("%s\n", text);
    dFree(text, 1000);
    dFree(0, 0);
    dSetAllocHandler(my_alloc);
    dSetReallocHandler(my_realloc);
    dSetFreeHandler(my_free);
    showi("memory", dGetAllocHandler() == my_alloc && dGetReallocHandler() == my_realloc && dGetFreeHandler() == my_free);
    text = dAlloc(10);
    showi("balance", balance);
    text = dRealloc(text, 10, 1000);
    showi("balance", balance);
    dFree(text, 1000);
    showi("balance", balance);
    dSetAllocHandler(0);
    dSetReallocHandler(0);
    dSetFreeHandler(0);
    showi("memory", !dGetAllocHandler());
    dWorldDestroy(w);
    dWorldDestroy(v);

    I1(dAllocateODEDataForThread, dAllocateMaskAll);
    dCleanupODEAllDataForThread();
    dInitODE();
    dCloseODE();
    dCloseODE();
    FAULT(dCloseODE());
    printf("%s\n", dGetConfiguration());
    const char *tokens[] = {"ODE", "ODE_double_precision", "ODE_single_precision", "ODE_EXT", "", "a b", "ODE_EXT_trimesh"};
    for (int i = 0; i < 7; i++) I1(dCheckConfiguration, tokens[i]);
    return 0;
}
