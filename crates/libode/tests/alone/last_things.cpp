/* Objects that outlive everything: destroyed by static destructors and exit handlers, after dCloseODE, in any order, in
   threads that end. */
#include <ode/ode.h>
#include <cstdio>
#include <cstdlib>
#include <thread>

/* A world, and geoms whose collisions need memory of the thread's. */
static dWorldID late_world;
static dGeomID late_geoms[5];

static void touch_all(const char *when) {
    dContactGeom c[8];
    for (int i = 0; i < 5; i++)
        for (int j = i + 1; j < 5; j++)
            if (dCollide(late_geoms[i], late_geoms[j], 8, c, sizeof *c) <= 0) printf("%d and %d miss\n", i, j);
    dWorldStep(late_world, 0.01);
    dWorldQuickStep(late_world, 0.01);
    printf("%s\n", when);
}

struct Guard {
    dGeomID a, b;
    dSpaceID space;
    ~Guard() {
        if (!a) return;
        dContactGeom c[4];
        dInitODE2(0);
        printf("late contacts %d\n", dCollide(a, b, 4, c, sizeof *c));
        touch_all("late all");
        dSpaceCollide(space, 0, [](void *, dGeomID, dGeomID) { puts("late pair"); });
        dCloseODE();
        dGeomDestroy(a);
        dSpaceDestroy(space);
        puts("late end");
    }
};
static Guard guard;
static dWorld *world_wrapper;
static dBody *body_wrapper;
static dJointGroup group_wrapper;

static void at_exit() {
    delete body_wrapper;
    delete world_wrapper;
    puts("exit handler");
}

int main() {
    dInitODE2(0);
    guard.space = dHashSpaceCreate(0);
    guard.a = dCreateSphere(guard.space, 1);
    guard.b = dCreateBox(guard.space, 1, 1, 1);
    atexit(at_exit);
    static float heights[4][4];
    static dReal points[] = {0.5, 0, -0.4, -0.3, 0.5, -0.4, -0.3, -0.5, -0.4, 0, 0, 0.5};
    static unsigned faces[] = {3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 2, 0, 3};
    dHeightfieldDataID field = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildSingle(field, &heights[0][0], 0, 4, 4, 4, 4, 1, 0.1, 1, 0);
    late_geoms[0] = dCreateHeightfield(0, field, 1);
    dMatrix3 up;
    dRFromAxisAndAngle(up, 1, 0, 0, M_PI / 2);
    dGeomSetRotation(late_geoms[0], up);
    late_geoms[1] = dCreateConvex(0, 0, 4, points, 4, faces);
    late_geoms[2] = dCreateCylinder(0, 0.3, 0.5);
    late_geoms[3] = dCreateBox(0, 0.5, 0.6, 0.7);
    late_geoms[4] = dCreateCapsule(0, 0.3, 0.5);
    late_world = dWorldCreate();
    for (int i = 0; i < 200; i++) {
        dBodyID one = dBodyCreate(late_world), other = dBodyCreate(late_world);
        dBodySetPosition(one, i, 0, 0);
        dJointAttach(dJointCreateBall(late_world, 0), one, other);
    }
    touch_all("early all");
    world_wrapper = new dWorld;
    body_wrapper = new dBody(*world_wrapper);
    dJointID joint = dJointCreateBall(*world_wrapper, group_wrapper);
    dJointAttach(joint, *body_wrapper, 0);
    /* A thread's objects are destroyed by another, and the other way round. */
    dWorldID made = 0;
    std::thread([&] {
        dAllocateODEDataForThread(dAllocateMaskAll);
        made = dWorldCreate();
        dBodyCreate(made);
        dContactGeom c[4];
        printf("contacts %d\n", dCollide(guard.a, guard.b, 4, c, sizeof *c));
        dCleanupODEAllDataForThread();
    }).join();
    dWorldStep(made, 0.1);
    dWorldDestroy(made);
    dWorldID here = dWorldCreate();
    dBodyID body = dBodyCreate(here);
    std::thread([&] { dBodyDestroy(body); dWorldDestroy(here); }).join();
    dTriMeshDataID data = dGeomTriMeshDataCreate();
    static float v[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static unsigned i[3] = {0, 1, 2};
    dGeomTriMeshDataBuildSingle(data, v, sizeof v[0], 3, i, 3, sizeof i);
    dGeomID mesh = dCreateTriMesh(guard.space, data, 0, 0, 0);
    /* Data before the geom, the geom after the library was closed. */
    dGeomTriMeshDataDestroy(data);
    dCloseODE();
    dGeomDestroy(mesh);
    puts("main ends");
    return 0;
}
