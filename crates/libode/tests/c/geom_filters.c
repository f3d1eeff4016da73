/* Category and collide bits, and geoms switched off: which pairs a space reports. */
#include "check.h"

static dGeomID geoms[4];
static long pairs(void);
static dSpaceID space;
static long found;
static void near(void *data, dGeomID a, dGeomID b) {
    (void)data;
    int i = 0, j = 0;
    while (geoms[i] != a) i++;
    while (geoms[j] != b) j++;
    found |= 1l << (i < j ? 4 * i + j : 4 * j + i);
}
static long pairs(void) {
    found = 0;
    dSpaceCollide(space, 0, near);
    return found;
}

int main(void) {
    dInitODE2(0);
    space = dHashSpaceCreate(0);
    for (int i = 0; i < 4; i++) {
        geoms[i] = dCreateSphere(space, 1);
        dGeomSetPosition(geoms[i], 0.1 * i, 0, 0);
    }
    CHECKI(dSpaceCollide, pairs());
    dGeomSetCategoryBits(geoms[0], 1);
    dGeomSetCollideBits(geoms[1], 2);
    showi("one side is enough", pairs());
    dGeomSetCollideBits(geoms[0], 4);
    CHECKI(dGeomSetCategoryBits, pairs());
    CHECKI(dGeomGetCategoryBits, dGeomGetCategoryBits(geoms[0]));
    dGeomSetCategoryBits(geoms[2], 1);
    dGeomSetCollideBits(geoms[2], 1);
    CHECKI(dGeomSetCollideBits, pairs());
    CHECKI(dGeomGetCollideBits, dGeomGetCollideBits(geoms[2]));
    dGeomDisable(geoms[3]);
    CHECKI(dGeomDisable, pairs());
    CHECKI(dGeomIsEnabled, dGeomIsEnabled(geoms[3]));
    dGeomEnable(geoms[3]);
    CHECKI(dGeomEnable, pairs());
    I1(dGeomIsEnabled, geoms[3]);
    dSpaceDestroy(space);
    dCloseODE();
    return 0;
}
