/* Objects that outlive everything: destroyed by static destructors and exit handlers, after dCloseODE, in any order, in
   threads that end. */
#include <ode/ode.h>
#include <cstdio>
#include <cstdlib>
#include <thread>

struct Guard {
    dGeomID a, b;
    dSpaceID space;
    ~Guard() {
        if (!a) return;
        dContactGeom c[4];
        dInitODE2(0);
        printf("late contacts %d\n", dCollide(a, b, 4, c, sizeof *c));
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
