/* Spaces of all kinds: members, pairs and their order, spaces in spaces, locks, clean-up. */
#include "check.h"

static dGeomID geoms[40];
static int pairs;
static long hash;
static int number(dGeomID g) { return (int)(long)dGeomGetData(g); }
static void near(void *data, dGeomID a, dGeomID b) {
    pairs++;
    hash = (hash * 31 + number(a) * 100 + number(b)) % 1000003;
    if (data) printf("%d-%d ", number(a), number(b));
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
        dSpaceCollide2(a, b, data, near);
        if (dGeomIsSpace(a)) dSpaceCollide((dSpaceID)a, data, near);
        if (dGeomIsSpace(b)) dSpaceCollide((dSpaceID)b, data, near);
    }
}
static void collide(dSpaceID s, const char *name) {
    pairs = 0;
    hash = 0;
    dSpaceCollide(s, (void *)1, near);
    printf("\n%s pairs %d hash %ld\n", name, pairs, hash);
}
static jmp_buf escape;
static void jump(int n, const char *format, va_list ap) { (void)n; (void)format; (void)ap; longjmp(escape, 1); }
static void meddle(void *data, dGeomID a, dGeomID b) {
    (void)b;
    if (!setjmp(escape)) {
        if (data == (void *)1) dGeomSetPosition(a, 9, 9, 9);
        if (data == (void *)2) dSpaceRemove(dGeomGetSpace(a), a);
        if (data == (void *)3) dGeomDestroy(a);
        if (data == (void *)4) dCreateSphere(dGeomGetSpace(a), 1);
        if (data == (void *)5) dGeomSetCategoryBits(a, 3);
        if (data == (void *)6) dGeomDisable(a), dGeomEnable(a);
        printf("allowed %d\n", (int)(long)data);
    } else
        printf("locked %d\n", (int)(long)data);
}

int main(void) {
    dInitODE2(0);
    for (int kind = 0; kind < 4; kind++) {
        dVector3 center = {0, 0, 0}, extents = {8, 8, 8};
        dSpaceID s = kind == 0 ? dSimpleSpaceCreate(0) : kind == 1 ? dHashSpaceCreate(0)
                   : kind == 2 ? dSweepAndPruneSpaceCreate(0, dSAP_AXES_XZY) : dQuadTreeSpaceCreate(0, center, extents, 4);
        I1(dSpaceGetClass, s);
        I1(dGeomIsSpace, (dGeomID)s);
        I1(dSpaceGetCleanup, s);
        I1(dSpaceGetSublevel, s);
        I1(dSpaceGetManualCleanup, s);
        dSpaceSetManualCleanup(s, 1);
        if (kind == 1) {
            int low = 0, high = 0;
            dHashSpaceGetLevels(s, &low, &high);
            printf("levels %d %d\n", low, high);
            dHashSpaceSetLevels(s, -2, 5);
            dHashSpaceGetLevels(s, &low, &high);
            printf("levels %d %d\n", low, high);
        }
        dRandSetSeed(5);
        for (int i = 0; i < 30; i++) {
            geoms[i] = i % 3 == 0 ? dCreateSphere(s, 0.6) : i % 3 == 1 ? dCreateBox(s, 0.5, 1.5, 0.9) : dCreateCapsule(s, 0.3, 1);
            dGeomSetData(geoms[i], (void *)(long)(i + 1));
            dGeomSetPosition(geoms[i], dRandReal() * 5, dRandReal() * 5, dRandReal() * 2);
        }
        dGeomID plane = dCreatePlane(s, 0, 0, 1, 0.3);
        dGeomSetData(plane, (void *)31l);
        I1(dSpaceGetNumGeoms, s);
        I1(dSpaceQuery, s, geoms[3]);
        if (kind != 3) {
            showi("order", number(dSpaceGetGeom(s, 0)));
            showi("order", number(dSpaceGetGeom(s, 7)));
        }
        collide(s, "first");
        for (int i = 0; i < 30; i += 4) dGeomSetPosition(geoms[i], dRandReal() * 5, dRandReal() * 5, dRandReal() * 2);
        collide(s, "moved");
        dGeomDisable(geoms[5]);
        dGeomSetCategoryBits(geoms[6], 2);
        dGeomSetCollideBits(geoms[6], 4);
        dGeomSetCategoryBits(geoms[7], 4);
        dGeomSetCollideBits(geoms[7], 8);
        dGeomSphereSetRadius(geoms[9], 1.2);
        dSpaceClean(s);
        collide(s, "filtered");
        dSpaceRemove(s, geoms[8]);
        I1(dSpaceQuery, s, geoms[8]);
        pairs = 0;
        dSpaceCollide2(geoms[8], (dGeomID)s, (void *)1, near);
        printf("\ngeom pairs %d\n", pairs);
        dSpaceAdd(s, geoms[8]);
        collide(s, "added");
        dGeomDestroy(geoms[10]);
        collide(s, "destroyed");
        dReal aabb[6];
        dGeomGetAABB((dGeomID)s, aabb);
        show("aabb", aabb, 6);
        dSpaceID other = dSimpleSpaceCreate(0);
        for (int i = 32; i < 38; i++) {
            geoms[i] = dCreateSphere(other, 0.5);
            dGeomSetData(geoms[i], (void *)(long)(i + 1));
            dGeomSetPosition(geoms[i], i - 32, i - 32, 1);
        }
        pairs = 0;
        dSpaceCollide2((dGeomID)s, (dGeomID)other, (void *)1, near);
        printf("\nspaces %d\n", pairs);
        pairs = 0;
        dSpaceCollide2((dGeomID)other, (dGeomID)s, (void *)1, near);
        printf("\nspaces %d\n", pairs);
        dSpaceSetSublevel(other, 1);
        I1(dSpaceGetSublevel, other);
        dSpaceAdd(s, (dGeomID)other);
        dGeomSetData((dGeomID)other, (void *)77l);
        showi("within", dGeomGetSpace((dGeomID)other) == s);
        collide(s, "nested");
        /* A space as a geom of dCollide. */
        dContactGeom c[20];
        int n = dCollide((dGeomID)other, plane, 20, c, sizeof c[0]);
        showi("contacts", n);
        dSpaceSetCleanup(other, 0);
        I1(dSpaceGetCleanup, other);
        dSpaceDestroy(other);
        I1(dSpaceGetNumGeoms, s);
        showi("free", dGeomGetSpace(geoms[33]) == 0);
        for (int i = 32; i < 38; i++) dGeomDestroy(geoms[i]);
        dSpaceDestroy(s);
    }
    dSetDebugHandler(jump);
    for (long what = 1; what <= 6; what++) {
        dSpaceID s = dSimpleSpaceCreate(0);
        dCreateSphere(s, 1);
        dCreateSphere(s, 1);
        dSpaceCollide(s, (void *)what, meddle);
    }
    dCloseODE();
    return 0;
}
