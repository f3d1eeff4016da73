/* Calls every function but those that end the program, and prints what the callbacks get. */
#include <drawstuff/drawstuff.h>
#include <stdio.h>

static const float at[3] = {0, 0, 1}, turn[12] = {1, 0, 0, 9, 0, 1, 0, 9, 0, 0, 1, 9}, sides[3] = {0.1f, 0.2f, 0.3f};
static const double atD[3] = {0, 0, 1}, turnD[12] = {1, 0, 0, 9, 0, 1, 0, 9, 0, 0, 1, 9}, sidesD[3] = {0.1, 0.2, 0.3};
static const float corners[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1}, planes[4] = {0, 0, 1, 0};
static const double cornersD[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1}, planesD[4] = {0, 0, 1, 0};
static const unsigned polygon[4] = {3, 0, 1, 2};

static void print_view(const char *name) {
    float xyz[3], hpr[3];
    dsGetViewpoint(xyz, hpr);
    dsPrint("%s %g %g %g %g %g %g\n", name, xyz[0], xyz[1], xyz[2], hpr[0], hpr[1], hpr[2]);
}

static void start(void) {
    float xyz[3] = {1, 2, 3}, hpr[3] = {40, -5, 0};
    print_view("start");
    dsSetViewpoint(xyz, hpr);
    dsSetSphereQuality(2);
    dsSetCapsuleQuality(2);
}

static void step(int pause) {
    dsPrint("step %d %g\n", pause, dsElapsedTime());
    dsDrawBox(at, turn, sides);
    dsSetColor(1, 0.5f, 0.25f);
    dsSetTexture(DS_WOOD);
    dsDrawSphere(at, turn, 0.5f);
    dsSetColorAlpha(1, 0.5f, 0.25f, 0.5f);
    dsSetTexture(DS_CHECKERED);
    dsDrawCylinder(at, turn, 2, 0.5f);
    dsSetDrawMode(DS_WIREFRAME);
    dsDrawCapsule(at, turn, 2, 0.5f);
    dsSetDrawMode(DS_POLYFILL);
    dsSetTexture(DS_GROUND);
    dsDrawTriangle(at, turn, corners, corners + 3, corners + 6, 0);
    dsSetTexture(DS_SKY);
    dsDrawLine(at, corners + 3);
    dsSetTexture(DS_NONE);
    if (pause) return;
    dsDrawTriangles(at, turn, corners, 2, 1);
    dsDrawConvex(at, turn, planes, 1, corners, 3, polygon);
    dsDrawBoxD(atD, turnD, sidesD);
    dsDrawSphereD(atD, turnD, 0.5f);
    dsDrawCylinderD(atD, turnD, 2, 0.5f);
    dsDrawCapsuleD(atD, turnD, 2, 0.5f);
    dsDrawTriangleD(atD, turnD, cornersD, cornersD + 3, cornersD + 6, 1);
    dsDrawTrianglesD(atD, turnD, cornersD, 2, 1);
    dsDrawLineD(atD, cornersD + 3);
    dsDrawConvexD(atD, turnD, planesD, 1, cornersD, 3, polygon);
    /* By their old names. */
    dsDrawCappedCylinder(at, turn, 2, 0.5f);
    dsDrawCappedCylinderD(atD, turnD, 2, 0.5f);
}

static void command(int key) {
    dsPrint("command %c\n", key);
    if (key == 'q') dsStop();
}

static void stop(void) { dsPrint("stop\n"); }

int main(int argc, char **argv) {
    dsFunctions functions = {DS_VERSION, start, step, command, stop, "textures"}, second = {DS_VERSION, 0, 0, 0, 0, 0};
    float xyz[3];
    dsInitializeConsole(argc, argv);
    dsStop();
    dsSimulationLoop(argc, argv, 320, 200, &functions);
    /* A second loop begins where the first ended. */
    print_view("again");
    dsSimulationLoop(argc, argv, DS_SIMULATION_DEFAULT_WIDTH, DS_SIMULATION_DEFAULT_HEIGHT, &second);
    dsGetViewpoint(xyz, 0);
    printf("end %g %g %g\n", xyz[0], xyz[1], xyz[2]);
    dsFinalizeConsole();
    return 0;
}
