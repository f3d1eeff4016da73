/* Attaching, groups, questions about connections, hand-made contacts, destruction in odd orders. */
#include "check.h"

static void message(int number, const char *format, va_list ap) {
    printf("message %d: ", number);
    vprintf(format, ap);
    printf("\n");
}

static dContact touch(dReal x, dReal y, int mode) {
    dContact c;
    memset(&c, 0, sizeof c);
    c.surface.mode = mode;
    c.surface.mu = 0.6;
    c.surface.mu2 = 0.3;
    c.surface.rho = c.surface.rho2 = c.surface.rhoN = 0.01;
    c.surface.bounce = 0.3;
    c.surface.bounce_vel = 0.01;
    c.surface.soft_erp = 0.3;
    c.surface.soft_cfm = 1e-4;
    c.surface.motion1 = 0.1;
    c.surface.motion2 = -0.1;
    c.surface.motionN = 0.01;
    c.surface.slip1 = 1e-3;
    c.surface.slip2 = 2e-3;
    c.geom.pos[0] = x;
    c.geom.pos[1] = y;
    c.geom.normal[2] = 1;
    c.geom.depth = 0.01;
    c.fdir1[0] = 0.6;
    c.fdir1[1] = 0.8;
    return c;
}

int main(void) {
    dInitODE2(0);
    dSetMessageHandler(message);
    dWorldID w = dWorldCreate(), other = dWorldCreate();
    dBodyID a, b, c = dBodyCreate(w);
    two_bodies(w, &a, &b);
    dJointID ball = dJointCreateBall(w, 0), hinge = dJointCreateHinge(w, 0), slider = dJointCreateSlider(w, 0);
    int data;
    dJointSetData(ball, &data);
    showi("data", dJointGetData(ball) == &data && !dJointGetData(hinge));
    I1(dJointGetNumBodies, ball);
    dJointAttach(ball, a, b);
    dJointAttach(hinge, b, a);
    dJointAttach(slider, 0, a);
    I1(dJointGetNumBodies, ball);
    I1(dJointGetNumBodies, slider);
    showi("bodies", dJointGetBody(ball, 0) == a && dJointGetBody(ball, 1) == b && !dJointGetBody(ball, 2));
    showi("bodies", dJointGetBody(slider, 0) == 0 && dJointGetBody(slider, 1) == a);
    I1(dAreConnected, a, b);
    I1(dAreConnected, b, c);
    I1(dAreConnected, a, 0);
    I1(dAreConnectedExcluding, a, b, dJointTypeBall);
    I1(dAreConnectedExcluding, a, 0, dJointTypeSlider);
    showi("connecting", dConnectingJoint(a, b) == hinge);
    showi("connecting", dConnectingJoint(a, 0) == slider);
    showi("connecting", dConnectingJoint(a, c) == 0);
    dJointID list[4];
    I1(dConnectingJointList, a, b, list);
    showi("list", list[0] == hinge && list[1] == ball);
    I1(dJointIsEnabled, ball);
    dJointDisable(ball);
    I1(dJointIsEnabled, ball);
    dJointEnable(ball);
    dJointFeedback feedback;
    showi("feedback", dJointGetFeedback(ball) == 0);
    dJointSetFeedback(ball, &feedback);
    showi("feedback", dJointGetFeedback(ball) == &feedback);
    dJointSetFeedback(ball, 0);
    dJointDestroy(slider);
    I1(dBodyGetNumJoints, a);

    dJointGroupID group = dJointGroupCreate(0);
    dBodyID box = dBodyCreate(w);
    dMass m;
    dMassSetBoxTotal(&m, 1, 1, 1, 1);
    dBodySetMass(box, &m);
    dBodySetPosition(box, 0, 0, 0.49);
    dWorldSetGravity(w, 0, 0, -9.81);
    int modes[] = {0, dContactApprox1, dContactMu2 | dContactFDir1 | dContactApprox1, dContactBounce,
                   dContactSoftERP | dContactSoftCFM, dContactMotion1 | dContactMotion2 | dContactMotionN,
                   dContactSlip1 | dContactSlip2 | dContactApprox1, dContactRolling | dContactApprox1,
                   dContactRolling | dContactAxisDep};
    dRandSetSeed(0);
    for (int i = 0; i < 36; i++) {
        for (int k = 0; k < 4; k++) {
            dContact touching = touch(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, modes[i % 9]);
            dJointID contact = dJointCreateContact(w, group, &touching);
            dJointAttach(contact, box, k == 3 && i % 2 ? a : 0);
            dJointDestroy(contact);
        }
        dBodyAddForce(box, 3, 1, 0);
        if (i % 3) dWorldQuickStep(w, 0.01); else dWorldStep(w, 0.01);
        I1(dBodyGetNumJoints, box);
        dJointGroupEmpty(group);
        show_body("box", box);
    }
    showi("seed", (long)dRandGetSeed());
    /* A group over two worlds, one of which dies first. */
    dJointID here = dJointCreateBall(w, group), there = dJointCreateBall(other, group);
    dJointAttach(here, a, 0);
    dWorldDestroy(other);
    I1(dJointGetNumBodies, there);
    dJointGroupEmpty(group);
    I1(dBodyGetNumJoints, a);
    here = dJointCreateBall(w, group);
    dJointAttach(here, a, 0);
    dJointGroupDestroy(group);
    I1(dBodyGetNumJoints, a);
    dBodyDestroy(a);
    I1(dJointGetNumBodies, ball);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
