/* Members of every kind of space: adding, asking, removing, clean-up, levels. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dVector3 center = {0, 0, 0}, extents = {9, 9, 9};
    for (int kind = 0; kind < 4; kind++) {
        dSpaceID s = 0;
        if (kind == 0) { s = dSimpleSpaceCreate(0); CHECKI(dSimpleSpaceCreate, dSpaceGetClass(s)); }
        if (kind == 1) { s = dHashSpaceCreate(0); CHECKI(dHashSpaceCreate, dSpaceGetClass(s)); }
        if (kind == 2) { s = dSweepAndPruneSpaceCreate(0, dSAP_AXES_XZY); CHECKI(dSweepAndPruneSpaceCreate, dSpaceGetClass(s)); }
        if (kind == 3) { s = dQuadTreeSpaceCreate(0, center, extents, 3); CHECKI(dQuadTreeSpaceCreate, dSpaceGetClass(s)); }
        I1(dSpaceGetClass, s);
        dGeomID a = dCreateSphere(0, 1), b = dCreateBox(s, 1, 1, 1), c = dCreateCapsule(s, 1, 1);
        dSpaceAdd(s, a);
        CHECKI(dSpaceAdd, dGeomGetSpace(a) == s);
        I1(dSpaceGetNumGeoms, s);
        I1(dSpaceQuery, s, a);
        if (kind < 3) CHECKI(dSpaceGetGeom, dSpaceGetGeom(s, 0) == a || dSpaceGetGeom(s, 1) == a || dSpaceGetGeom(s, 2) == a);
        dSpaceRemove(s, b);
        CHECKI(dSpaceRemove, dSpaceQuery(s, b) * 10 + dSpaceGetNumGeoms(s));
        dSpaceSetSublevel(s, 3);
        CHECKI(dSpaceSetSublevel, dSpaceGetSublevel(s));
        I1(dSpaceGetSublevel, s);
        dSpaceSetManualCleanup(s, 0);
        CHECKI(dSpaceSetManualCleanup, dSpaceGetManualCleanup(s));
        I1(dSpaceGetManualCleanup, s);
        dSpaceSetCleanup(s, 0);
        CHECKI(dSpaceSetCleanup, dSpaceGetCleanup(s));
        dSpaceDestroy(s);
        showi("free", dGeomGetSpace(a) == 0 && dGeomGetSpace(c) == 0);
        dGeomDestroy(a);
        dGeomDestroy(b);
        dGeomDestroy(c);
    }
    dSpaceID s = dHashSpaceCreate(0);
    I1(dSpaceGetCleanup, s);
    int levels[2] = {99, 99};
    dHashSpaceGetLevels(s, levels, levels + 1);
    CHECKI(dHashSpaceGetLevels, levels[0] * 100 + levels[1]);
    dHashSpaceSetLevels(s, -1, 6);
    dHashSpaceGetLevels(s, levels, levels + 1);
    CHECKI(dHashSpaceSetLevels, levels[0] * 100 + levels[1]);
    dSpaceDestroy(s);
    dCloseODE();
    return 0;
}
