/* A red box that stays where it is; the argument -still-wire draws its edges. */
#include <drawstuff/drawstuff.h>
#include <string.h>

static int wire;

static void start(void) {
    float xyz[3] = {0, -4, 1}, hpr[3] = {90, 0, 0};
    dsSetViewpoint(xyz, hpr);
}

static void step(int pause) {
    static const float at[3] = {0, 0, 1}, turn[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, sides[3] = {1, 1, 1};
    (void)pause;
    dsSetColor(0.9f, 0.1f, 0.1f);
    dsSetDrawMode(wire ? DS_WIREFRAME : DS_POLYFILL);
    dsDrawBox(at, turn, sides);
}

int main(int argc, char **argv) {
    dsFunctions functions = {DS_VERSION, start, step, 0, 0, 0};
    int i;
    for (i = 1; i < argc; i++) wire |= !strcmp(argv[i], "-still-wire");
    dsSimulationLoop(argc, argv, 640, 480, &functions);
    return 0;
}
