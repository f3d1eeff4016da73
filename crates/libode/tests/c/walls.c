/* A wall of bricks, balls and capsules that a ball breaks: both steppers, several kinds of spaces, every surface mode, some bricks
   asleep until they are touched. */
#include "check.h"
static dWorldID w; static dJointGroupID group; static int n_contacts;
static void near(void *data, dGeomID a, dGeomID b) {
    dBodyID b1 = dGeomGetBody(a), b2 = dGeomGetBody(b);
    if (b1 && b2 && dAreConnected(b1, b2)) return;
    dContact c[10];
    for (int i = 0; i < 10; i++) {
        memset(&c[i], 0, sizeof c[i]);
        c[i].surface.mode = *(int *)data;
        c[i].surface.mu = 0.8; c[i].surface.mu2 = 0.3; c[i].surface.rho = 0.02; c[i].surface.rho2 = 0.01; c[i].surface.rhoN = 0.05;
        c[i].surface.bounce = 0.3; c[i].surface.bounce_vel = 0.1; c[i].surface.soft_cfm = 1e-4; c[i].surface.soft_erp = 0.6;
        c[i].surface.motion1 = 0.2; c[i].surface.slip1 = 0.01;
        c[i].fdir1[0] = 1;
    }
    int n = dCollide(a, b, 10, &c[0].geom, sizeof(dContact));
    for (int i = 0; i < n; i++) {
        if (c[i].surface.mode & dContactFDir1) { dVector3 t, slant = {0.3, 0.8, 0.5}; dCalcVectorCross3(t, c[i].geom.normal, slant); dSafeNormalize3(t); memcpy(c[i].fdir1, t, sizeof t); }
        dJointID j = dJointCreateContact(w, group, &c[i]);
        dJointAttach(j, b1, b2);
        n_contacts++;
    }
}
int main(void) {
    dInitODE2(0);
    int modes[] = {dContactApprox1, dContactBounce | dContactSoftCFM, dContactMu2 | dContactFDir1 | dContactApprox1_1, dContactApprox1 | dContactRolling | dContactAxisDep, dContactMotion1 | dContactFDir1 | dContactSlip1 | dContactSoftERP | dContactApprox1};
    for (int kind = 0; kind < 5; kind++)
        for (int stepper = 0; stepper < 2; stepper++) {
            dRandSetSeed(11);
            w = dWorldCreate();
            dVector3 middle = {0, 0, 0}, sides = {20, 20, 20};
            dSpaceID s = kind % 3 == 0 ? dSimpleSpaceCreate(0) : kind % 3 == 1 ? dSweepAndPruneSpaceCreate(0, dSAP_AXES_XZY) : dQuadTreeSpaceCreate(0, middle, sides, 4);
            group = dJointGroupCreate(1000);
            dWorldSetGravity(w, 0, 0, -5);
            dWorldSetCFM(w, 1e-5); dWorldSetERP(w, 0.3);
            dCreatePlane(s, 0, 0, 1, 0);
            dBodyID bricks[20];
            for (int i = 0; i < 20; i++) {
                dMass m; dGeomID g;
                bricks[i] = dBodyCreate(w);
                if (i % 7 == 6) { dMassSetSphere(&m, 1, 0.25); g = dCreateSphere(s, 0.25); }
                else if (i % 7 == 5) { dMassSetCapsule(&m, 1, 1, 0.2, 0.5); g = dCreateCapsule(s, 0.2, 0.5); }
                else { dMassSetBox(&m, 1, 1, 0.4, 0.5); g = dCreateBox(s, 1, 0.4, 0.5); }
                dBodySetMass(bricks[i], &m);
                dGeomSetBody(g, bricks[i]);
                dBodySetPosition(bricks[i], 1.02 * (i % 5) + (i / 5 % 2) * 0.5, 0.03 * (i % 3), 0.26 + 0.51 * (i / 5));
                if (i > 14) dBodyDisable(bricks[i]);
            }
            dMass m;
            dBodyID ball = dBodyCreate(w);
            dMassSetSphereTotal(&m, 2, 0.4);
            dBodySetMass(ball, &m);
            dGeomSetBody(dCreateSphere(s, 0.4), ball);
            dBodySetPosition(ball, 2.3, -3, 0.8);
            dBodySetLinearVel(ball, 0, 9, 0.5);
            n_contacts = 0;
            for (int step = 0; step < 90; step++) {
                dSpaceCollide(s, &modes[kind], near);
                if (stepper) dWorldStep(w, 0.01); else dWorldQuickStep(w, 0.01);
                dJointGroupEmpty(group);
                if (step % 30 == 29) {
                    showi("contacts", n_contacts);
                    show_body("ball", ball);
                    for (int i = 0; i < 20; i += 3) { show("brick", dBodyGetPosition(bricks[i]), 3); showi("awake", dBodyIsEnabled(bricks[i])); }
                }
            }
            dJointGroupDestroy(group); dSpaceDestroy(s); dWorldDestroy(w);
        }
    dCloseODE();
    return 0;
}
