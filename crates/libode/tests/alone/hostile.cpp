/* Programs at their worst: numbers that are none, handles dead and of another kind, objects destroyed and changed in every callback
   that there is, calls in callbacks that step and collide again, thousands of calls drawn at random. What comes out has no meaning;
   the library must stay sound, so that the well-behaved scene at the end falls as ever. Run it under a checker of memory. */
#include <ode/ode.h>
#include <csetjmp>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

static jmp_buf escape;
static long faults;
static void jump(int, const char *, va_list) { faults++; longjmp(escape, 1); }
#define TRY(...) do { if (!setjmp(escape)) { __VA_ARGS__; } } while (0)

static unsigned seed = 1;
static unsigned draw(unsigned below) {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 10) % below;
}
static dReal odd() {
    static const dReal odds[] = {NAN, INFINITY, -INFINITY, (dReal)1e300, (dReal)-1e300, (dReal)1e-300, 0, (dReal)-0.0, 1, -1, (dReal)1e30, (dReal)0.3};
    return odds[draw(sizeof odds / sizeof *odds)];
}

static dWorldID world;
static dSpaceID space;
static dJointGroupID group;
static std::vector<void *> all;  /* everything that ever was a handle */
static int way, depth;

static void *any() { return all[draw(all.size())]; }
template <typename H> static H keep(H h) { if (h) all.push_back((void *)h); return h; }

static void misbehave() {
    if (depth > 2) return;
    depth++;
    switch (way) {
    case 0: dGeomDestroy((dGeomID)any()); break;
    case 1: dBodyDestroy((dBodyID)any()); break;
    case 2: dJointGroupEmpty(group); break;
    case 3: dWorldStep(world, 0.01); break;
    case 4: dWorldQuickStep(world, 0.01); break;
    case 5: dSpaceCollide(space, 0, [](void *, dGeomID, dGeomID) {}); break;
    case 6: keep(dCreateSphere(space, 0.3)); break;
    case 7: dSpaceRemove(space, (dGeomID)any()); break;
    case 8: dBodySetPosition((dBodyID)any(), odd(), odd(), odd()); break;
    case 9: dGeomSetPosition((dGeomID)any(), odd(), odd(), odd()); break;
    case 10: dJointDestroy((dJointID)any()); break;
    case 11: keep(dBodyCreate(world)); break;
    case 12: dSpaceClean(space); break;
    }
    depth--;
}
static void near(void *, dGeomID a, dGeomID b) {
    misbehave();
    dContact c[8];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 8, &c[0].geom, sizeof c[0]);
    for (int i = 0; i < n; i++) {
        c[i].surface.mu = odd();
        dJointAttach(keep(dJointCreateContact(world, group, &c[i])), dGeomGetBody(a), dGeomGetBody(b));
    }
    misbehave();
}
static void moved(dBodyID) { misbehave(); }
static int triangle(dGeomID, dGeomID, int) { misbehave(); return 1; }
static void triangles(dGeomID, dGeomID, const int *, int) { misbehave(); }
static int hit(dGeomID, dGeomID, int, dReal, dReal) { misbehave(); return 1; }
static dReal height(void *, int x, int z) { if (x == z) misbehave(); return 0.01 * x; }
static int collide(dGeomID, dGeomID, int, dContactGeom *, int) { misbehave(); return 0; }
static dColliderFn *choose(int) { return collide; }
static void box(dGeomID, dReal *six) { misbehave(); for (int i = 0; i < 6; i++) six[i] = i % 2 ? 1 : -1; }
static int passes(dGeomID, dGeomID, dReal *) { misbehave(); return 1; }
static void end(dGeomID) { misbehave(); }

static float vertices[4][3] = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
static unsigned indices[6] = {0, 1, 2, 0, 2, 3};
static int user_class;

static void populate() {
    world = keep(dWorldCreate());
    space = keep(draw(2) ? dHashSpaceCreate(0) : dSimpleSpaceCreate(0));
    group = keep(dJointGroupCreate(0));
    dWorldSetGravity(world, 0, 0, -9.81);
    dTriMeshDataID data = keep(dGeomTriMeshDataCreate());
    dGeomTriMeshDataBuildSingle(data, vertices, sizeof vertices[0], 4, indices, 6, 3 * sizeof indices[0]);
    keep(dCreateTriMesh(space, data, triangle, triangles, hit));
    dHeightfieldDataID field = keep(dGeomHeightfieldDataCreate());
    dGeomHeightfieldDataBuildCallback(field, 0, height, 8, 8, 9, 9, 1, 0, 1, 0);
    dGeomID ground = keep(dCreateHeightfield(space, field, 1));
    dMatrix3 up;
    dRFromAxisAndAngle(up, 1, 0, 0, M_PI / 2);
    dGeomSetRotation(ground, up);
    dSpaceAdd(space, keep(dCreateGeom(user_class)));
    dBodyID last = 0;
    for (int i = 0; i < 8; i++) {
        dBodyID b = keep(dBodyCreate(world));
        dBodySetPosition(b, 0.4 * i - 1.5, 0.1 * i, 0.2);
        dBodySetMovedCallback(b, moved);
        dGeomID g = keep(i % 3 == 0 ? dCreateSphere(space, 0.3) : i % 3 == 1 ? dCreateBox(space, 0.5, 0.5, 0.5) : dCreateCapsule(space, 0.2, 0.4));
        dGeomSetBody(g, b);
        if (last) dJointAttach(keep(i % 2 ? dJointCreateBall(world, 0) : dJointCreateHinge(world, group)), last, b);
        last = b;
    }
    dGeomID ray = keep(dCreateRay(space, 3));
    dGeomRaySet(ray, 0, 0, 2, 0, 0, -1);
}
static void clear() {
    way = -1;
    std::vector<void *> left;
    left.swap(all);
    for (void *h : left) {
        TRY(dGeomDestroy((dGeomID)h));
        TRY(dJointGroupDestroy((dJointGroupID)h));
        TRY(dWorldDestroy((dWorldID)h));
        TRY(dGeomTriMeshDataDestroy((dTriMeshDataID)h));
        TRY(dGeomHeightfieldDataDestroy((dHeightfieldDataID)h));
    }
}
static void call_at_random() {
    void *h = any(), *other = any();
    dVector3 v = {odd(), odd(), odd(), odd()};
    dQuaternion q = {odd(), odd(), odd(), odd()};
    dMatrix3 r = {odd(), odd(), odd(), 0, odd(), odd(), odd(), 0, odd(), odd(), odd(), 0};
    dContactGeom c[4];
    dMass m;
    switch (draw(40)) {
    case 0: dBodySetPosition((dBodyID)h, odd(), odd(), odd()); break;
    case 1: dBodySetLinearVel((dBodyID)h, odd(), odd(), odd()); break;
    case 2: dBodySetAngularVel((dBodyID)h, odd(), odd(), odd()); break;
    case 3: dBodySetQuaternion((dBodyID)h, q); break;
    case 4: dBodySetRotation((dBodyID)h, r); break;
    case 5: dBodyAddForceAtPos((dBodyID)h, odd(), odd(), odd(), odd(), odd(), odd()); break;
    case 6: memset(&m, 0, sizeof m); m.mass = odd(); for (int i = 0; i < 12; i++) m.I[i] = odd(); dBodySetMass((dBodyID)h, &m); break;
    case 7: dGeomSetPosition((dGeomID)h, odd(), odd(), odd()); break;
    case 8: dGeomSetRotation((dGeomID)h, r); break;
    case 9: dGeomSetBody((dGeomID)h, (dBodyID)other); break;
    case 10: dGeomSetOffsetPosition((dGeomID)h, odd(), odd(), odd()); break;
    case 11: dGeomSphereSetRadius((dGeomID)h, odd()); break;
    case 12: dGeomBoxSetLengths((dGeomID)h, odd(), odd(), odd()); break;
    case 13: dGeomCapsuleSetParams((dGeomID)h, odd(), odd()); break;
    case 14: dGeomRaySet((dGeomID)h, odd(), odd(), odd(), odd(), odd(), odd()); break;
    case 15: dCollide((dGeomID)h, (dGeomID)other, 4, c, sizeof *c); break;
    case 16: dSpaceCollide2((dGeomID)h, (dGeomID)other, 0, near); break;
    case 17: dSpaceCollide(space, 0, near); break;
    case 18: dWorldStep(world, 0.01); break;
    case 19: dWorldQuickStep(world, 0.01); break;
    case 20: dJointSetHingeAnchor((dJointID)h, odd(), odd(), odd()); break;
    case 21: dJointSetHingeAxis((dJointID)h, odd(), odd(), odd()); break;
    case 22: dJointSetHingeParam((dJointID)h, dParamLoStop + draw(15), odd()); break;
    case 23: dJointAttach((dJointID)h, (dBodyID)other, (dBodyID)any()); break;
    case 24: dJointSetBallAnchor((dJointID)h, odd(), odd(), odd()); break;
    case 25: dGeomGetAABB((dGeomID)h, (dReal *)r); break;
    case 26: dBodyDestroy((dBodyID)h); break;
    case 27: dGeomDestroy((dGeomID)h); break;
    case 28: dJointDestroy((dJointID)h); break;
    case 29: dJointGroupEmpty(group); break;
    case 30: dSpaceAdd(space, (dGeomID)h); break;
    case 31: dSpaceRemove(space, (dGeomID)h); break;
    case 32: dWorldSetGravity(world, odd(), odd(), odd()); break;
    case 33: dWorldSetERP(world, odd()); dWorldSetCFM(world, odd()); break;
    case 34: keep(dBodyCreate(world)); break;
    case 35: keep(dJointCreateSlider(world, draw(2) ? group : 0)); break;
    case 36: dWorldStep(world, odd()); break;
    case 37: dGeomTriMeshDataUpdate((dTriMeshDataID)h); break;
    case 38: dGeomTriMeshSetData((dGeomID)h, (dTriMeshDataID)other); break;
    case 39: dBodySetAutoDisableAverageSamplesCount((dBodyID)h, draw(100)); break;
    }
}
static long taken, given;
static void *take(dsizeint size) { taken += size; return malloc(size); }
static void give(void *p, dsizeint size) { given += size; free(p); }
static void plain() {
    dSetAllocHandler(take);
    dSetFreeHandler(give);
    dGeomID own = dCreateGeom(user_class);
    dWorldID w = dWorldCreate();
    dWorldSetGravity(w, 0, 0, -10);
    dBodyID b = dBodyCreate(w);
    for (int i = 0; i < 100; i++) dWorldStep(w, 0.01);
    printf("falls to %.6f\n", (double)dBodyGetPosition(b)[2]);
    dWorldDestroy(w);
    way = -1;
    dGeomDestroy(own);
    printf("%s\n", taken > 1000 && taken == given ? "all was given back" : "memory is owed");
}

int main(int count, char **words) {
    int rounds = count > 1 ? atoi(words[1]) : 6;
    dInitODE2(0);
    dSetDebugHandler(jump);
    dSetMessageHandler([](int, const char *, va_list) {});
    dGeomClass description = {16, choose, box, passes, end};
    user_class = dCreateGeomClass(&description);
    for (way = 0; way < 13; way++) {
        int kind = way;
        for (int round = 0; round < 4; round++) {
            TRY(populate());
            way = kind;
            for (int i = 0; i < 6; i++) {
                depth = 0;
                TRY(dSpaceCollide(space, 0, near));
                depth = 0;
                TRY(i % 2 ? dWorldStep(world, 0.01) : dWorldQuickStep(world, 0.01));
                depth = 0;
                TRY(dJointGroupEmpty(group));
            }
            clear();
        }
        way = kind;
    }
    for (int round = 0; round < rounds; round++) {
        way = -1;
        TRY(populate());
        for (int i = 0; i < 1500; i++) {
            way = draw(40);
            depth = 0;
            TRY(call_at_random());
        }
        clear();
    }
    puts(faults > 100 ? "faults were told" : "no faults?");
    plain();
    dCloseODE();
    return 0;
}
