/* A house of cards: thin boxes that lean on each other in a hash space, first at rest, then pushed; contacts with friction by both
   steppers, few enough steps that rounding does not decide. tolerance: 1e-7 since a leaning card amplifies what the last bit is. */
#include "check.h"

static dWorldID w;
static dJointGroupID group;
static int touching;
static void near(void *data, dGeomID a, dGeomID b) {
    (void)data;
    dBodyID first = dGeomGetBody(a), second = dGeomGetBody(b);
    if (first && second && dAreConnectedExcluding(first, second, dJointTypeContact)) return;
    dContact c[8];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 8, &c[0].geom, sizeof c[0]);
    touching += n;
    for (int i = 0; i < n; i++) {
        c[i].surface.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM;
        c[i].surface.mu = 5;
        c[i].surface.soft_erp = 0.5;
        c[i].surface.soft_cfm = 1e-4;
        dJointAttach(dJointCreateContact(w, group, &c[i]), first, second);
    }
}
static dBodyID card(dSpaceID s, double x, double z, double angle) {
    dBodyID b = dBodyCreate(w);
    dMass m;
    dMatrix3 r;
    dMassSetBoxTotal(&m, 0.1, 0.04, 1, 1.2);
    dBodySetMass(b, &m);
    dRFromAxisAndAngle(r, 0, 1, 0, angle);
    dBodySetRotation(b, r);
    dBodySetPosition(b, x, 0, z);
    dGeomSetBody(dCreateBox(s, 0.04, 1, 1.2), b);
    return b;
}
static void house(int quick) {
    w = dWorldCreate();
    group = dJointGroupCreate(0);
    dWorldSetGravity(w, 0, 0, -5);
    dWorldSetContactSurfaceLayer(w, 0.001);
    dWorldSetQuickStepNumIterations(w, 30);
    dSpaceID s = dHashSpaceCreate(0);
    dCreatePlane(s, 0, 0, 1, 0);
    dBodyID cards[7];
    for (int i = 0; i < 2; i++) {
        cards[2 * i] = card(s, 1.4 * i - 0.2, 0.595, 0.3);
        cards[2 * i + 1] = card(s, 1.4 * i + 0.2, 0.595, -0.3);
    }
    cards[4] = card(s, 0.7, 1.2, M_PI / 2);
    cards[5] = card(s, 0.5, 1.81, 0.3);
    cards[6] = card(s, 0.9, 1.81, -0.3);
    dRandSetSeed(1);
    for (int i = 0; i < 16; i++) {
        touching = 0;
        dSpaceCollide(s, 0, near);
        if (i == 8) dBodyAddForceAtRelPos(cards[6], -3, 0, 0, 0, 0, 0.4);
        if (quick) dWorldQuickStep(w, 0.01);
        else dWorldStep(w, 0.01);
        dJointGroupEmpty(group);
        showi("touching", touching);
        if (i % 4 == 3)
            for (int k = 0; k < 7; k++) show("card", dBodyGetPosition(cards[k]), 3);
    }
    dSpaceDestroy(s);
    dJointGroupDestroy(group);
    dWorldDestroy(w);
}

int main(void) {
    dInitODE2(0);
    house(0);
    house(1);
    dCloseODE();
    return 0;
}
