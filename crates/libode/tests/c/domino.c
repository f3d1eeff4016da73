/* A row of dominoes: the first is pushed, collisions by a hash space, contacts in a group, until the third leans. */
#include "check.h"

static dWorldID w;
static dJointGroupID group;
static int contacts;
static void near(void *data, dGeomID a, dGeomID b) {
    dContact c[6];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 6, &c[0].geom, sizeof *c);
    for (int i = 0; i < n; i++) {
        c[i].surface.mode = dContactApprox1 | dContactSoftCFM;
        c[i].surface.mu = *(dReal *)data;
        c[i].surface.soft_cfm = 1e-4;
        dJointAttach(dJointCreateContact(w, group, &c[i]), dGeomGetBody(a), dGeomGetBody(b));
    }
    contacts += n;
}

int main(void) {
    dInitODE2(0);
    w = dWorldCreate();
    dWorldSetGravity(w, 0, 0, -9.81);
    group = dJointGroupCreate(0);
    dSpaceID space = dHashSpaceCreate(0);
    dCreatePlane(space, 0, 0, 1, 0);
    dBodyID stones[5];
    dReal mu = 0.4;
    for (int i = 0; i < 5; i++) {
        dMass m;
        dMassSetBoxTotal(&m, 0.5, 0.1, 0.4, 0.8);
        stones[i] = dBodyCreate(w);
        dBodySetMass(stones[i], &m);
        dBodySetPosition(stones[i], 0.3 * i, 0.01 * i, 0.4);
        dGeomSetBody(dCreateBox(space, 0.1, 0.4, 0.8), stones[i]);
    }
    dBodyAddForceAtRelPos(stones[0], 60, 0, 0, 0, 0, 0.3);
    dRandSetSeed(7);
    for (int i = 0; i < 25; i++) {
        dSpaceCollide(space, &mu, near);
        CHECKI(dCollide, contacts);
        dWorldQuickStep(w, 0.01);
        dJointGroupEmpty(group);
    }
    for (int i = 0; i < 5; i++) MOVES(dWorldQuickStep, stones[i]);
    dJointGroupDestroy(group);
    dSpaceDestroy(space);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
