/* Callbacks of every kind that don't come back: by longjmp, by exceptions, and by ending the thread's work. After each the
   library works on. (Some of these leave libode in a state that it does not survive, so it is no measure here.) */
#include <ode/ode.h>
#include <csetjmp>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

static jmp_buf place;
static bool by_exception, leave;
static int calls;
static void out() {
    calls++;
    if (!leave) return;
    if (by_exception) throw std::runtime_error("away");
    longjmp(place, 1);
}

template <typename Work> static void attempt(const char *name, Work work) {
    for (int way = 0; way < 2; way++) {
        by_exception = way;
        leave = true;
        calls = 0;
        volatile bool left = false;
        if (way) {
            try { work(); } catch (std::exception &) { left = true; }
        } else if (setjmp(place) == 0) {
            work();
        } else {
            left = true;
        }
        leave = false;
        printf("%s %d %d %d\n", name, way, (int)left, calls > 0);
    }
}

static int collider(dGeomID a, dGeomID b, int, dContactGeom *c, int) {
    out();
    memset(c, 0, sizeof *c);
    c->g1 = a;
    c->g2 = b;
    c->side1 = c->side2 = -1;
    c->normal[2] = 1;
    return 1;
}
static dColliderFn *choose(int) { return collider; }
static void box_of(dGeomID g, dReal box[6]) {
    out();
    const dReal *p = dGeomGetPosition(g);
    for (int i = 0; i < 6; i++) box[i] = p[i / 2] + (i % 2 ? 1 : -1);
}
static int box_test(dGeomID, dGeomID, dReal[6]) { out(); return 1; }
static void destroyed(dGeomID) { out(); }
static void near(void *, dGeomID, dGeomID) { out(); }
static void moved(dBodyID) { out(); }
static dReal height(void *, int, int) { out(); return 0; }
static int triangle(dGeomID, dGeomID, int) { out(); return 1; }
static void triangles(dGeomID, dGeomID, const int *, int) { out(); }
static int ray_triangle(dGeomID, dGeomID, int, dReal, dReal) { out(); return 1; }
static void *block(dsizeint n) { out(); return malloc(n); }
static void *shrink(void *p, dsizeint, dsizeint n) { return realloc(p, n); }
static void unblock(void *p, dsizeint) { free(p); }
static void handler(int, const char *, va_list) { out(); abort(); }

int main() {
    dInitODE2(0);
    dGeomClass description = {8, choose, box_of, box_test, destroyed};
    int kind = dCreateGeomClass(&description);
    dContactGeom c[8];

    dGeomID own = dCreateGeom(kind), ball = dCreateSphere(0, 1);
    dReal box[6];
    attempt("aabb", [&] { dGeomGetAABB(own, box); });
    dGeomGetAABB(own, box);
    printf("box %g %g\n", box[0], box[5]);
    attempt("collider", [&] { dCollide(own, ball, 8, c, sizeof *c); });
    attempt("collider turned", [&] { dCollide(ball, own, 8, c, sizeof *c); });
    printf("contacts %d\n", dCollide(own, ball, 8, c, sizeof *c));

    /* Each way has a space of its own: one that was left stays locked. */
    attempt("cleaning", [&] {
        dSpaceID space = dSimpleSpaceCreate(0);
        dSpaceAdd(space, dCreateGeom(kind));
        dSpaceClean(space);
    });
    attempt("near", [&] {
        dSpaceID space = dHashSpaceCreate(0);
        dCreateSphere(space, 1);
        dCreateSphere(space, 1);
        dSpaceCollide(space, 0, near);
    });
    attempt("near2", [&] {
        dSpaceID space = dSweepAndPruneSpaceCreate(0, dSAP_AXES_XYZ);
        dCreateSphere(space, 1);
        dCreateSphere(space, 1);
        dSpaceCollide2((dGeomID)space, ball, 0, near);
    });
    attempt("test", [&] {
        dVector3 middle = {0, 0, 0}, extents = {9, 9, 9};
        dSpaceID space = dQuadTreeSpaceCreate(0, middle, extents, 3);
        dGeomID member = dCreateGeom(kind);
        leave = false;
        dSpaceAdd(space, member);
        dCreateSphere(space, 1);
        dSpaceClean(space);
        leave = true;
        dSpaceCollide(space, 0, near);
    });
    dSpaceID after = dHashSpaceCreate(0);
    dCreateSphere(after, 1);
    dCreateSphere(after, 1);
    calls = 0;
    dSpaceCollide(after, 0, near);
    printf("pairs %d\n", calls);

    dWorldID world = dWorldCreate();
    dBodyID body = dBodyCreate(world);
    dWorldSetGravity(world, 0, 0, -1);
    dBodySetMovedCallback(body, moved);
    attempt("moved", [&] { dWorldStep(world, 0.1); });
    attempt("moved", [&] { dWorldQuickStep(world, 0.1); });
    dBodySetMovedCallback(body, 0);
    dBodySetLinearVel(body, 1, 0, 0);
    dBodySetPosition(body, 0, 0, 5);
    dWorldStep(world, 0.1);
    printf("body %g\n", (double)dBodyGetPosition(body)[0]);
    dWorldStepMemoryFunctionsInfo memory = {sizeof memory, block, shrink, unblock};
    dWorldSetStepMemoryManager(world, &memory);
    /* A step needs memory for what it solves. */
    for (int i = 0; i < 4; i++) {
        dJointID joint = dJointCreateBall(world, 0);
        dJointAttach(joint, body, 0);
    }
    attempt("memory", [&] { dWorldQuickStep(world, 0.1); dWorldCleanupWorkingMemory(world); });
    printf("step %d\n", dWorldQuickStep(world, 0.1));
    dWorldDestroy(world);

    dHeightfieldDataID data = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildCallback(data, 0, height, 4, 4, 5, 5, 1, 0, 1, 0);
    dGeomID field = dCreateHeightfield(0, data, 1);
    dGeomSetPosition(ball, 0.3, 0.5, 0.3);
    attempt("height", [&] { dCollide(field, ball, 8, c, sizeof *c); });
    printf("contacts %d\n", dCollide(field, ball, 1, c, sizeof *c));

    static float vertices[][3] = {{2, 2, 0}, {-2, 2, 0}, {-2, -2, 0}, {2, -2, 0}};
    static unsigned indices[] = {0, 1, 2, 0, 2, 3};
    dTriMeshDataID mesh_data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(mesh_data, vertices, sizeof vertices[0], 4, indices, 6, 3 * sizeof(unsigned));
    dGeomID mesh = dCreateTriMesh(0, mesh_data, triangle, 0, 0), ray = dCreateRay(0, 5);
    dGeomSetPosition(ball, 0.3, -0.4, 0.5);
    dGeomRaySet(ray, 0.3, 0.2, 2, 0, 0, -1);
    attempt("triangle", [&] { dCollide(mesh, ball, 8, c, sizeof *c); });
    dGeomTriMeshSetCallback(mesh, 0);
    dGeomTriMeshSetArrayCallback(mesh, triangles);
    attempt("triangles", [&] { dCollide(ball, mesh, 8, c, sizeof *c); });
    dGeomTriMeshSetArrayCallback(mesh, 0);
    dGeomTriMeshSetRayCallback(mesh, ray_triangle);
    attempt("ray", [&] { dCollide(mesh, ray, 8, c, sizeof *c); });
    printf("hits %d\n", dCollide(mesh, ray, 8, c, sizeof *c));

    dSetDebugHandler(handler);
    attempt("debug", [&] { dBodySetPosition(0, 1, 2, 3); });
    attempt("debug", [&] { dCollide(ball, mesh, 0, c, sizeof *c); });
    dSetDebugHandler(0);
    dSetErrorHandler(handler);
    attempt("error", [&] { dError(1, "no"); });
    dSetMessageHandler([](int, const char *, va_list) { out(); });
    attempt("message", [&] { dMessage(1, "no"); });
    dSetErrorHandler(0);
    dSetMessageHandler(0);

    attempt("destructor", [&] {
        dGeomID dying = dCreateGeom(kind);
        dGeomDestroy(dying);
    });
    dGeomDestroy(mesh);
    dGeomDestroy(ray);
    dGeomDestroy(field);
    dGeomTriMeshDataDestroy(mesh_data);
    dGeomHeightfieldDataDestroy(data);
    dSpaceDestroy(after);
    dGeomDestroy(own);
    dGeomDestroy(ball);
    dCloseODE();
    return 0;
}
