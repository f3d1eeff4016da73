/* Spaces within spaces, as programs group parts of a machine: pairs between spaces, a geom against a space, what is moved
   by hand. */
#include "check.h"

static int pairs, spaces;
static dGeomID parts[2][3];
static int name(dGeomID g) {
    for (int i = 0; i < 6; i++) if (parts[i / 3][i % 3] == g) return i;
    return 9;
}
static void near(void *data, dGeomID a, dGeomID b) {
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
        spaces++;
        dSpaceCollide2(a, b, data, near);
        return;
    }
    pairs++;
    int i = name(a), j = name(b);
    printf("%d%d ", i < j ? i : j, i < j ? j : i);
}

int main(void) {
    dInitODE2(0);
    dSpaceID world = dSimpleSpaceCreate(0), groups[2];
    for (int k = 0; k < 2; k++) {
        groups[k] = dSimpleSpaceCreate(world);
        for (int i = 0; i < 3; i++) {
            parts[k][i] = dCreateSphere(groups[k], 0.6);
            dGeomSetPosition(parts[k][i], i + 0.3 * k, 0.4 * k, 0);
        }
    }
    CHECKI(dGeomGetSpace, dGeomGetSpace((dGeomID)groups[1]) == world);
    dSpaceCollide(world, 0, near);
    printf("\n");
    CHECKI(dSpaceCollide, 100 * spaces + pairs);
    pairs = spaces = 0;
    dSpaceCollide2((dGeomID)groups[0], parts[1][1], 0, near);
    printf("\n");
    CHECKI(dSpaceCollide2, 100 * spaces + pairs);
    dReal aabb[6];
    dGeomGetAABB((dGeomID)world, aabb);
    CHECK(dGeomGetAABB, aabb, 6);
    dGeomSetPosition(parts[0][2], 40, 0, 0);
    dGeomMoved(parts[0][2]);
    dSpaceClean(world);
    dGeomGetAABB((dGeomID)world, aabb);
    CHECK(dSpaceClean, aabb, 6);
    CHECK(dGeomMoved, aabb, 6);
    pairs = spaces = 0;
    dSpaceCollide(world, 0, near);
    printf("\n");
    showi("after", 100 * spaces + pairs);
    dSpaceDestroy(world);
    dCloseODE();
    return 0;
}
