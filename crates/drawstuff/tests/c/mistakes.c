/* Makes the mistake that its argument names. */
#include <drawstuff/drawstuff.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

static const float at[3] = {0, 0, 1}, turn[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, points[9];
static const unsigned polygon[4] = {3, 0, 1, 7};
static const char *what;
static jmp_buf out;
static dsFunctions functions;

static void start(void) {
    if (!strcmp(what, "outside")) dsDrawSphere(at, turn, 1), dsDrawSphere(at, turn, 1);
}

static void step(int pause) {
    (void)pause;
    if (!strcmp(what, "null")) dsDrawBox(at, turn, 0);
    if (!strcmp(what, "polygon")) dsDrawConvex(at, turn, 0, 1, points, 3, polygon);
    if (!strcmp(what, "nested")) dsSimulationLoop(0, 0, 100, 100, &functions);
    if (!strcmp(what, "debug")) dsDebug("number %d", 7);
    if (!strcmp(what, "error")) dsError("number %d", 7);
    if (!strcmp(what, "jump")) longjmp(out, 1);
    dsStop();
}

int main(int argc, char **argv) {
    what = argc > 1 ? argv[1] : "nothing";
    functions = (dsFunctions){DS_VERSION, start, step, 0, 0, 0};
    if (!strcmp(what, "version")) functions.version = 1;
    if (setjmp(out)) {
        puts("jumped");
        return 0;
    }
    dsSimulationLoop(argc, argv, 320, 200, &functions);
    return 0;
}
