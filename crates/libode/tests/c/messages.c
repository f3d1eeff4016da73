/* Handlers of messages, errors and faults: what reaches them, what is set, and memory through handlers of the program. */
#include "check.h"

static jmp_buf away;
static char text[200];
static int number;
static void note(int n, const char *format, va_list ap) {
    number = n;
    vsnprintf(text, sizeof text, format, ap);
}
static void leave(int n, const char *format, va_list ap) {
    note(n, format, ap);
    longjmp(away, 1);
}
static long taken, moved, given;
static void *take(dsizeint size) { taken += (long)size; return malloc(size); }
static void *move(void *p, dsizeint old, dsizeint size) { moved += (long)(size - old); return realloc(p, size); }
static void give(void *p, dsizeint size) { given += (long)size; free(p); }

int main(void) {
    dSetMessageHandler(note);
    CHECKI(dGetMessageHandler, dGetMessageHandler() == note);
    dMessage(12, "%s %d %.2f", "three", 3, 3.25);
    printf("dMessage: %d %s\n", number, text);
    printf("dSetMessageHandler: %d %s\n", number, text);
    dSetErrorHandler(leave);
    CHECKI(dGetErrorHandler, dGetErrorHandler() == leave);
    if (!setjmp(away)) dError(13, "%s %d", "error", 4);
    printf("dError: %d %s\n", number, text);
    printf("dSetErrorHandler: %d %s\n", number, text);
    dSetDebugHandler(leave);
    CHECKI(dGetDebugHandler, dGetDebugHandler() == leave);
    if (!setjmp(away)) dDebug(14, "%s %d", "fault", 5);
    printf("dDebug: %d %s\n", number, text);
    printf("dSetDebugHandler: %d %s\n", number, text);
    CHECKI(dGetAllocHandler, dGetAllocHandler() == 0);
    dSetAllocHandler(take);
    dSetReallocHandler(move);
    dSetFreeHandler(give);
    CHECKI(dGetAllocHandler, dGetAllocHandler() == take);
    CHECKI(dGetReallocHandler, dGetReallocHandler() == move);
    CHECKI(dGetFreeHandler, dGetFreeHandler() == give);
    char *p = (char *)dAlloc(20);
    strcpy(p, "kept");
    CHECKI(dAlloc, taken);
    p = (char *)dRealloc(p, 20, 50);
    printf("dRealloc: %ld %s\n", moved, p);
    dFree(p, 50);
    CHECKI(dFree, given);
    printf("dSetAllocHandler: %ld\ndSetReallocHandler: %ld\ndSetFreeHandler: %ld\n", taken, moved, given);
    /* Worlds come from them, and go back; the sums differ, and libode's don't come out even. */
    taken = moved = given = 0;
    dInitODE2(0);
    dWorldID w = dWorldCreate(), v = dWorldCreate();
    dBodyCreate(w);
    for (int i = 0; i < 3; i++) dWorldStep(w, 0.01);
    showi("taken", taken > 0);
    dWorldDestroy(v);
    showi("given", given > 0);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
