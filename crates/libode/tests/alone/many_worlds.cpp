/* Ten thousand times: a world, bodies, joints, geoms of every kind, steps, and all of it destroyed. The process does not
   grow. */
#include <ode/ode.h>
#include <cstdio>
#include <cstring>
#include <unistd.h>

/* Memory of the process's own: without the pages of programs and libraries, which are read when they are first needed. */
static long resident() {
    long all = 0, there = 0, of_files = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file) return 0;
    if (fscanf(file, "%ld %ld %ld", &all, &there, &of_files) != 3) there = of_files = 0;
    fclose(file);
    return (there - of_files) * sysconf(_SC_PAGESIZE);
}

struct Run { dWorldID world; dJointGroupID group; };

static void near(void *data, dGeomID a, dGeomID b) {
    Run *run = (Run *)data;
    dContact c[8];
    int n = dCollide(a, b, 8, &c[0].geom, sizeof c[0]);
    for (int i = 0; i < n; i++) {
        c[i].surface.mode = dContactApprox1;
        c[i].surface.mu = 0.5;
        dJointAttach(dJointCreateContact(run->world, run->group, &c[i]), dGeomGetBody(a), dGeomGetBody(b));
    }
}

static float vertices[4][3] = {{5, 5, 0}, {-5, 5, 0}, {-5, -5, 0}, {5, -5, 0}};
static unsigned indices[6] = {0, 1, 2, 0, 2, 3};
static double samples[25];
static dReal corners[24], planes[24] = {1, 0, 0, 0.5, 0, 1, 0, 0.5, 0, 0, 1, 0.5, -1, 0, 0, 0.5, 0, -1, 0, 0.5, 0, 0, -1, 0.5};
static unsigned faces[] = {4, 0, 2, 6, 4, 4, 1, 0, 4, 5, 4, 0, 1, 3, 2, 4, 3, 1, 5, 7, 4, 2, 3, 7, 6, 4, 5, 4, 6, 7};

static void cycle(int number) {
    Run run = {dWorldCreate(), dJointGroupCreate(0)};
    dWorldSetGravity(run.world, 0, 0, -9.81);
    dSpaceID space = number % 3 == 0 ? dHashSpaceCreate(0)
        : number % 3 == 1 ? dSimpleSpaceCreate(0) : dSweepAndPruneSpaceCreate(0, dSAP_AXES_XYZ);
    dTriMeshDataID mesh = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(mesh, vertices, sizeof vertices[0], 4, indices, 6, 3 * sizeof(unsigned));
    dGeomTriMeshDataPreprocess(mesh);
    dHeightfieldDataID field = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildDouble(field, samples, number % 2, 4, 4, 5, 5, 1, -2, 1, 0);
    dCreateTriMesh(space, mesh, 0, 0, 0);
    dCreateHeightfield(space, field, 1);
    dBodyID bodies[6];
    dJointFeedback feedback[6];
    for (int i = 0; i < 6; i++) {
        bodies[i] = dBodyCreate(run.world);
        dGeomID g = i == 0 ? dCreateBox(space, 1, 1, 1) : i == 1 ? dCreateSphere(space, 0.5)
            : i == 2 ? dCreateCapsule(space, 0.3, 0.5) : i == 3 ? dCreateCylinder(space, 0.4, 0.6)
            : i == 4 ? dCreateConvex(space, planes, 6, corners, 8, faces) : dCreateBox(space, 0.4, 0.4, 0.4);
        dGeomSetBody(g, bodies[i]);
        dBodySetPosition(bodies[i], 0.2 * i, 0.1 * i, 0.45 + 0.8 * i);
        dJointID joint = i % 2 ? dJointCreateHinge(run.world, 0) : dJointCreateBall(run.world, run.group);
        dJointAttach(joint, bodies[i], i ? bodies[i - 1] : 0);
        dJointSetFeedback(joint, &feedback[i]);
    }
    for (int i = 0; i < 3; i++) {
        dSpaceCollide(space, &run, near);
        if (number % 2) dWorldStep(run.world, 0.01);
        else dWorldQuickStep(run.world, 0.01);
        if (number % 5) dJointGroupEmpty(run.group);
    }
    /* In varying orders. */
    if (number % 4 < 2) dSpaceDestroy(space);
    dJointGroupDestroy(run.group);
    if (number % 7 == 0) dBodyDestroy(bodies[2]);
    dWorldDestroy(run.world);
    if (number % 4 >= 2) dSpaceDestroy(space);
    dGeomTriMeshDataDestroy(mesh);
    dGeomHeightfieldDataDestroy(field);
}

int main() {
    dSetMessageHandler([](int, const char *, va_list) {});
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++) corners[3 * i + k] = i >> k & 1 ? -0.4 : 0.4;
    long before = 0;
    for (int i = 0; i < 10000; i++) {
        if (i % 1000 == 0) dInitODE2(0);
        cycle(i);
        if (i % 1000 == 999) dCloseODE();
        if (i == 1999) before = resident();
    }
    long grown = resident() - before;
    if (grown > 256 * 1024) printf("grown by %ld bytes\n", grown);
    else puts("steady");
    return 0;
}
