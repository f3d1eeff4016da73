/* A box on the ground with four contacts, one of the surface's modes at a time: where it is pushed to. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    static const int modes[] = {0, dContactApprox1, dContactMu2 | dContactFDir1, dContactBounce, dContactSoftERP, dContactSoftCFM,
        dContactMotion1 | dContactFDir1, dContactMotion2 | dContactFDir1, dContactMotionN, dContactSlip1 | dContactFDir1,
        dContactSlip2 | dContactFDir1, dContactRolling | dContactApprox1, dContactApprox1_1, dContactApprox1_2, dContactApprox1_N};
    for (int k = 0; k < 15; k++) {
        dWorldID w = dWorldCreate();
        dWorldSetGravity(w, 0, 0, -9.81);
        dBodyID b = dBodyCreate(w);
        dBodySetPosition(b, 0, 0, 0.49);
        dBodySetLinearVel(b, 0, 0, -0.5);
        dBodySetAngularVel(b, 0, 0, 1);
        dJointGroupID group = dJointGroupCreate(0);
        for (int i = 0; i < 5; i++) {
            for (int corner = 0; corner < 4; corner++) {
                dContact c;
                memset(&c, 0, sizeof c);
                c.surface.mode = modes[k];
                c.surface.mu = 0.3;
                c.surface.mu2 = 0.1;
                c.surface.rho = c.surface.rho2 = c.surface.rhoN = 0.02;
                c.surface.bounce = 0.4;
                c.surface.bounce_vel = 0.1;
                c.surface.soft_erp = 0.5;
                c.surface.soft_cfm = 1e-2;
                c.surface.motion1 = c.surface.motion2 = 0.3;
                c.surface.motionN = 0.2;
                c.surface.slip1 = c.surface.slip2 = 0.1;
                c.geom.pos[0] = corner & 1 ? 0.5 : -0.5;
                c.geom.pos[1] = corner & 2 ? 0.5 : -0.5;
                c.geom.normal[2] = 1;
                c.geom.depth = 0.01;
                c.fdir1[0] = 0.6;
                c.fdir1[1] = 0.8;
                dJointAttach(dJointCreateContact(w, group, &c), b, 0);
            }
            dBodyAddForce(b, 2, 1, 0);
            dWorldQuickStep(w, 0.01);
            dJointGroupEmpty(group);
        }
        printf("mode %d ", k);
        MOVES(dJointCreateContact, b);
        MOVES(dJointCreateContact, b);
        dJointGroupDestroy(group);
        dWorldDestroy(w);
    }
    dCloseODE();
    return 0;
}
