/* What programs do: boxes, balls and capsules fall on a plane, with contacts made in the near callback. */
#include "check.h"

static dWorldID w;
static dJointGroupID group;
static int contacts;
static void near(void *data, dGeomID a, dGeomID b) {
    (void)data;
    dBodyID b1 = dGeomGetBody(a), b2 = dGeomGetBody(b);
    if (b1 && b2 && dAreConnectedExcluding(b1, b2, dJointTypeContact)) return;
    dContact c[8];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 8, &c[0].geom, sizeof(dContact));
    for (int i = 0; i < n; i++) {
        c[i].surface.mode = dContactBounce | dContactApprox1;
        c[i].surface.mu = 0.5;
        c[i].surface.bounce = 0.1;
        c[i].surface.bounce_vel = 0.1;
        dJointAttach(dJointCreateContact(w, group, &c[i]), b1, b2);
        contacts++;
    }
}

int main(void) {
    dInitODE2(0);
    for (int kind = 0; kind < 2; kind++) {
        w = dWorldCreate();
        group = dJointGroupCreate(0);
        dSpaceID s = kind ? dSimpleSpaceCreate(0) : dHashSpaceCreate(0);
        dCreatePlane(s, 0, 0, 1, 0);
        dWorldSetGravity(w, 0, 0, -9.81);
        dRandSetSeed(1);
        dBodyID bodies[8];
        for (int i = 0; i < 8; i++) {
            dMass m;
            bodies[i] = dBodyCreate(w);
            dGeomID g;
            if (i % 3 == 0) { dMassSetBox(&m, 1, 1, 1, 1); g = dCreateBox(s, 1, 1, 1); }
            else if (i % 3 == 1) { dMassSetSphere(&m, 1, 0.5); g = dCreateSphere(s, 0.5); }
            else { dMassSetCapsule(&m, 1, 3, 0.3, 0.8); g = dCreateCapsule(s, 0.3, 0.8); }
            dBodySetMass(bodies[i], &m);
            dGeomSetBody(g, bodies[i]);
            dBodySetPosition(bodies[i], 0.1 * i, 0.05 * i, 0.55 + 1.1 * i);
            dBodySetAutoDisableFlag(bodies[i], 1);
        }
        contacts = 0;
        for (int step = 0; step < 60; step++) {
            dSpaceCollide(s, 0, near);
            if (kind) dWorldStep(w, 0.01); else dWorldQuickStep(w, 0.01);
            dJointGroupEmpty(group);
            if (step % 20 == 19) for (int i = 0; i < 8; i++) show_body("body", bodies[i]);
        }
        showi("contacts", contacts);
        showi("seed", (long)dRandGetSeed());
        dJointGroupDestroy(group);
        dSpaceDestroy(s);
        dWorldDestroy(w);
    }
    dCloseODE();
    return 0;
}
