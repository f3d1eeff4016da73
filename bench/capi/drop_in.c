/* Typical ODE programs, run interleaved on two libraries in one process: the installed libode and this project's. Each
   library is loaded by itself, so that the same machine code of the program calls both.

   usage: drop_in THEIR-LIBRARY OUR-LIBRARY [REPETITIONS]

   Prints a Markdown table: processor time of the whole program and of its collision and stepping calls, medians over the
   repetitions, the mean number of contact joints of a step, and where the bodies' mean height ends. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <ode/ode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define FUNCTIONS(X) \
    X(dInitODE2) X(dCloseODE) X(dRandSetSeed) X(dWorldCreate) X(dWorldDestroy) X(dWorldSetGravity) X(dWorldSetERP) \
    X(dWorldSetCFM) X(dWorldStep) X(dWorldQuickStep) X(dWorldSetAutoDisableFlag) X(dHashSpaceCreate) X(dSpaceDestroy) \
    X(dSpaceCollide) X(dCollide) X(dCreatePlane) X(dCreateBox) X(dCreateSphere) X(dCreateCapsule) X(dCreateCylinder) \
    X(dCreateTriMesh) X(dGeomTriMeshDataCreate) X(dGeomTriMeshDataBuildSingle) X(dGeomTriMeshDataDestroy) \
    X(dGeomTriMeshDataPreprocess2) X(dBodyCreate) X(dBodySetMass) X(dBodySetPosition) X(dBodySetRotation) \
    X(dBodyGetPosition) X(dBodyGetRotation) X(dGeomSetBody) X(dGeomGetBody) X(dJointGroupCreate) X(dJointGroupEmpty) \
    X(dJointGroupDestroy) X(dJointCreateContact) X(dJointAttach) X(dJointCreateBall) X(dJointCreateHinge) \
    X(dJointCreateUniversal) X(dJointSetBallAnchor) X(dJointSetHingeAnchor) X(dJointSetHingeAxis) \
    X(dJointSetHingeParam) X(dJointSetUniversalAnchor) X(dJointSetUniversalAxis1) X(dJointSetUniversalAxis2) \
    X(dMassSetBox) X(dMassSetSphere) X(dMassSetCapsule) X(dMassSetCylinder) X(dRFromAxisAndAngle) X(dAreConnectedExcluding)

typedef struct {
#define X(name) __typeof__(&name) name;
    FUNCTIONS(X)
#undef X
} Library;

static Library load(const char *path) {
    Library l;
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
    if (!handle) { fprintf(stderr, "%s\n", dlerror()); exit(2); }
#define X(name) \
    if (!(*(void **)&l.name = dlsym(handle, #name))) { fprintf(stderr, "%s lacks %s\n", path, #name); exit(2); }
    FUNCTIONS(X)
#undef X
    return l;
}

static double processor_time(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

/* What one run of a program gives. */
typedef struct { double collision, stepping, rest, contacts, height; } Run;

enum { MAX_BODIES = 512, MAX_CONTACTS = 8 };

/* A running program. */
typedef struct {
    const Library *l;
    dWorldID world;
    dSpaceID space;
    dJointGroupID contacts;
    dBodyID bodies[MAX_BODIES];
    int count;
    long made;
} Scene;

static void near(void *data, dGeomID a, dGeomID b) {
    Scene *s = data;
    const Library *l = s->l;
    dBodyID b1 = l->dGeomGetBody(a), b2 = l->dGeomGetBody(b);
    if (b1 && b2 && l->dAreConnectedExcluding(b1, b2, dJointTypeContact)) return;
    dContact contact[MAX_CONTACTS];
    int n = l->dCollide(a, b, MAX_CONTACTS, &contact[0].geom, sizeof(dContact));
    for (int i = 0; i < n; i++) {
        contact[i].surface.mode = dContactBounce | dContactSoftCFM | dContactApprox1;
        contact[i].surface.mu = 0.7;
        contact[i].surface.bounce = 0.1;
        contact[i].surface.bounce_vel = 0.1;
        contact[i].surface.soft_cfm = 1e-5;
        l->dJointAttach(l->dJointCreateContact(s->world, s->contacts, &contact[i]), b1, b2);
    }
    s->made += n;
}

static unsigned long seed, first_seed = 7;
static double random_number(void) {
    seed = (1664525 * seed + 1013904223) & 0xffffffff;
    return seed / 4294967296.0;
}

static void open_scene(Scene *s, const Library *l) {
    memset(s, 0, sizeof *s);
    s->l = l;
    l->dInitODE2(0);
    l->dRandSetSeed(1);
    seed = first_seed;
    s->world = l->dWorldCreate();
    s->space = l->dHashSpaceCreate(0);
    s->contacts = l->dJointGroupCreate(0);
    l->dWorldSetGravity(s->world, 0, 0, -9.81);
    l->dWorldSetERP(s->world, 0.2);
    l->dWorldSetCFM(s->world, 1e-5);
}

static dBodyID add(Scene *s, int kind, double x, double y, double z) {
    const Library *l = s->l;
    dMass m;
    dGeomID g;
    double a = 0.3 + 0.3 * random_number(), b = 0.3 + 0.3 * random_number(), c = 0.3 + 0.3 * random_number();
    if (kind == 0) { l->dMassSetBox(&m, 1, a, b, c); g = l->dCreateBox(s->space, a, b, c); }
    else if (kind == 1) { l->dMassSetSphere(&m, 1, a / 2); g = l->dCreateSphere(s->space, a / 2); }
    else if (kind == 2) { l->dMassSetCapsule(&m, 1, 3, a / 3, b); g = l->dCreateCapsule(s->space, a / 3, b); }
    else { l->dMassSetCylinder(&m, 1, 3, a / 2, b); g = l->dCreateCylinder(s->space, a / 2, b); }
    dBodyID body = s->bodies[s->count++] = l->dBodyCreate(s->world);
    l->dBodySetMass(body, &m);
    l->dBodySetPosition(body, x, y, z);
    dMatrix3 r;
    double u = random_number(), v = random_number(), w = random_number();
    l->dRFromAxisAndAngle(r, u - 0.5, v - 0.5, w + 0.1, 6 * random_number());
    l->dBodySetRotation(body, r);
    l->dGeomSetBody(g, body);
    return body;
}

static Run go(Scene *s, int steps, double h, int quick) {
    const Library *l = s->l;
    Run run = {0};
    double start = processor_time();
    for (int i = 0; i < steps; i++) {
        double t0 = processor_time();
        l->dSpaceCollide(s->space, s, near);
        double t1 = processor_time();
        if (quick) l->dWorldQuickStep(s->world, h); else l->dWorldStep(s->world, h);
        double t2 = processor_time();
        l->dJointGroupEmpty(s->contacts);
        /* What a program draws. */
        for (int b = 0; b < s->count; b++)
            run.height += l->dBodyGetPosition(s->bodies[b])[2] + 0 * l->dBodyGetRotation(s->bodies[b])[0];
        if (i < steps - 1) run.height = 0;
        run.collision += t1 - t0;
        run.stepping += t2 - t1;
    }
    run.rest = processor_time() - start - run.collision - run.stepping;
    run.contacts = (double)s->made / steps;
    run.height /= s->count;
    return run;
}

static void close_scene(Scene *s) {
    s->l->dJointGroupDestroy(s->contacts);
    s->l->dSpaceDestroy(s->space);
    s->l->dWorldDestroy(s->world);
    s->l->dCloseODE();
}

/* Boxes fall into a pile on the ground. */
static Run pile(const Library *l) {
    Scene s;
    open_scene(&s, l);
    l->dCreatePlane(s.space, 0, 0, 1, 0);
    for (int i = 0; i < 120; i++)
        add(&s, 0, 0.7 * (i % 4) + 0.1 * random_number(), 0.7 * (i / 4 % 4) + 0.1 * random_number(), 0.5 + 0.7 * (i / 16));
    Run run = go(&s, 300, 0.01, 1);
    close_scene(&s);
    return run;
}

/* Six figures of ten bodies, on ball joints, hinges with limits and motors, and universal joints. */
static Run joints(const Library *l) {
    Scene s;
    open_scene(&s, l);
    l->dCreatePlane(s.space, 0, 0, 1, 0);
    for (int figure = 0; figure < 6; figure++) {
        double x = 3 * figure, z = 3;
        dBodyID part[10];
        /* A trunk of two, and four limbs of two. */
        double place[10][3] = {{0, 0, 0}, {0, 0, 0.7}, {-0.6, 0, 0.9}, {-1.2, 0, 0.9}, {0.6, 0, 0.9}, {1.2, 0, 0.9},
            {-0.3, 0, -0.7}, {-0.3, 0, -1.4}, {0.3, 0, -0.7}, {0.3, 0, -1.4}};
        int parent[10] = {-1, 0, 1, 2, 1, 4, 0, 6, 0, 8};
        for (int i = 0; i < 10; i++) {
            part[i] = add(&s, 0, x + place[i][0], place[i][1], z + place[i][2]);
            if (parent[i] < 0) continue;
            double *p = place[i], *q = place[parent[i]];
            double ax = x + (p[0] + q[0]) / 2, ay = (p[1] + q[1]) / 2, az = z + (p[2] + q[2]) / 2;
            if (i % 3 == 0) {
                dJointID j = l->dJointCreateBall(s.world, 0);
                l->dJointAttach(j, part[parent[i]], part[i]);
                l->dJointSetBallAnchor(j, ax, ay, az);
            } else if (i % 3 == 1) {
                dJointID j = l->dJointCreateHinge(s.world, 0);
                l->dJointAttach(j, part[parent[i]], part[i]);
                l->dJointSetHingeAnchor(j, ax, ay, az);
                l->dJointSetHingeAxis(j, 0, 1, 0);
                l->dJointSetHingeParam(j, dParamLoStop, -1);
                l->dJointSetHingeParam(j, dParamHiStop, 1);
                l->dJointSetHingeParam(j, dParamVel, figure - 2.5);
                l->dJointSetHingeParam(j, dParamFMax, 0.2);
            } else {
                dJointID j = l->dJointCreateUniversal(s.world, 0);
                l->dJointAttach(j, part[parent[i]], part[i]);
                l->dJointSetUniversalAnchor(j, ax, ay, az);
                l->dJointSetUniversalAxis1(j, 0, 1, 0);
                l->dJointSetUniversalAxis2(j, 1, 0, 0);
            }
        }
    }
    Run run = go(&s, 200, 0.01, 0);
    close_scene(&s);
    return run;
}

/* A chain of sixty bodies, on ball joints and hinges by turns, swings from horizontal. */
static Run chain(const Library *l) {
    Scene s;
    open_scene(&s, l);
    dBodyID above = 0;
    for (int i = 0; i < 60; i++) {
        dBodyID body = add(&s, 1, i + 0.5, 0, 70);
        if (i % 2) {
            dJointID j = l->dJointCreateHinge(s.world, 0);
            l->dJointAttach(j, above, body);
            l->dJointSetHingeAnchor(j, i, 0, 70);
            l->dJointSetHingeAxis(j, 0, 1, 0);
        } else {
            dJointID j = l->dJointCreateBall(s.world, 0);
            l->dJointAttach(j, above, body);
            l->dJointSetBallAnchor(j, i, 0, 70);
        }
        above = body;
    }
    Run run = go(&s, 100, 0.01, 0);
    close_scene(&s);
    return run;
}

/* Boxes, balls, capsules and cylinders fall on hills of 8,192 triangles. */
static Run terrain(const Library *l) {
    enum { SIDE = 65 };
    static float vertices[SIDE * SIDE][3];
    static unsigned indices[2 * (SIDE - 1) * (SIDE - 1)][3];
    Scene s;
    open_scene(&s, l);
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) {
            float *v = vertices[i * SIDE + j], x = 0.25f * (i - SIDE / 2), y = 0.25f * (j - SIDE / 2);
            v[0] = x, v[1] = y, v[2] = 0.02f * (x * x + y * y) + 0.15f * ((i * 7 + j * 13) % 5) / 5;
        }
    int t = 0;
    for (int i = 0; i + 1 < SIDE; i++)
        for (int j = 0; j + 1 < SIDE; j++) {
            unsigned a = i * SIDE + j, b = a + SIDE, c = a + 1, d = b + 1;
            indices[t][0] = a, indices[t][1] = b, indices[t++][2] = d;
            indices[t][0] = a, indices[t][1] = d, indices[t++][2] = c;
        }
    dTriMeshDataID data = l->dGeomTriMeshDataCreate();
    l->dGeomTriMeshDataBuildSingle(data, vertices, sizeof vertices[0], SIDE * SIDE, indices, 3 * t, sizeof indices[0]);
    l->dGeomTriMeshDataPreprocess2(data, 3, 0);
    l->dCreateTriMesh(s.space, data, 0, 0, 0);
    for (int i = 0; i < 80; i++)
        add(&s, i % 4, 1.1 * (i % 8) - 4 + 0.2 * random_number(), 1.1 * (i / 8) - 5 + 0.2 * random_number(), 2.5);
    Run run = go(&s, 200, 0.01, 1);
    close_scene(&s);
    l->dGeomTriMeshDataDestroy(data);
    return run;
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *x, int n) {
    qsort(x, n, sizeof *x, by_size);
    return n % 2 ? x[n / 2] : (x[n / 2 - 1] + x[n / 2]) / 2;
}

int main(int argc, char **argv) {
    if (argc < 3) { fprintf(stderr, "usage: drop_in THEIR-LIBRARY OUR-LIBRARY [REPETITIONS] [PROGRAM] [theirs|ours]\n"); return 2; }
    Library libraries[2] = {load(argv[1]), load(argv[2])};
    enum { MOST = 101 };
    int repetitions = argc > 3 ? atoi(argv[3]) : 5;
    if (repetitions < 1 || repetitions > MOST) { fprintf(stderr, "1 to %d repetitions\n", MOST); return 2; }
    struct { const char *name; Run (*run)(const Library *); } programs[] = {
        {"pile", pile}, {"joints", joints}, {"chain", chain}, {"terrain", terrain}};
    if (argc > 5) {  /* For profilers: one program on one library. */
        for (int p = 0; p < 4; p++)
            if (!strcmp(programs[p].name, argv[4]))
                for (int i = 0; i < repetitions; i++) programs[p].run(&libraries[!strcmp(argv[5], "ours")]);
        return 0;
    }
    printf("| program | library | total ms | collision ms | step ms | rest ms | contacts a step | mean height m |\n");
    printf("|---|---|---:|---:|---:|---:|---:|---:|\n");
    for (int p = 0; p < 4; p++) {
        if (argc > 4 && strcmp(programs[p].name, argv[4])) continue;
        static double part[2][4][MOST];
        double ratio[MOST];
        double contacts[2] = {0, 0}, height[2] = {0, 0};
        for (int i = 0; i < repetitions; i++) {
            double total[2];
            first_seed = 7 + i;  /* Piles are chaotic: the mean over several tells more than one. */
            for (int k = 0; k < 2; k++) {
                int which = (i + k) % 2;  /* Who runs first alternates. */
                Run r = programs[p].run(&libraries[which]);
                contacts[which] += r.contacts / repetitions;
                height[which] += r.height / repetitions;
                total[which] = r.collision + r.stepping + r.rest;
                double numbers[4] = {total[which], r.collision, r.stepping, r.rest};
                for (int n = 0; n < 4; n++) part[which][n][i] = 1000 * numbers[n];
            }
            ratio[i] = total[0] / total[1];
        }
        for (int which = 0; which < 2; which++) {
            printf("| %s | %s |", programs[p].name, which ? "ours" : "libode");
            for (int n = 0; n < 4; n++) printf(" %.1f |", median(part[which][n], repetitions));
            printf(" %.1f | %.4f |\n", contacts[which], height[which]);
        }
        printf("| %s | **%.2f times as fast** (median of ratios) | | | | | | |\n", programs[p].name, median(ratio, repetitions));
    }
    return 0;
}
