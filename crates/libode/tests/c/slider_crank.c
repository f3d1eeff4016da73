/* A motor turns a crank, the crank a rod, the rod a piston in a cylinder: hinges, a slider with stops, a motor that is switched,
   and the same loop closed by a ball joint and a universal joint instead of two hinges. */
#include "check.h"

static void run(int ways, int quick) {
    dWorldID w = dWorldCreate();
    dWorldSetGravity(w, 0, -9.81, 0);
    dWorldSetCFM(w, 1e-6);
    dWorldSetERP(w, 0.4);
    dBodyID crank = dBodyCreate(w), rod = dBodyCreate(w), piston = dBodyCreate(w);
    dMass m;
    dMassSetBoxTotal(&m, 3, 1, 0.2, 0.2);
    dBodySetMass(crank, &m);
    dBodySetPosition(crank, 0.5, 0, 0);
    dMassSetCapsuleTotal(&m, 1, 1, 0.1, 2);
    dBodySetMass(rod, &m);
    dBodySetPosition(rod, 2, 0, 0);
    dMassSetBoxTotal(&m, 2, 0.5, 0.5, 0.5);
    dBodySetMass(piston, &m);
    dBodySetPosition(piston, 3, 0, 0);
    dJointID main_bearing = dJointCreateHinge(w, 0);
    dJointAttach(main_bearing, crank, 0);
    dJointSetHingeAnchor(main_bearing, 0, 0, 0);
    dJointSetHingeAxis(main_bearing, 0, 0, 1);
    dJointSetHingeParam(main_bearing, dParamVel, 4);
    dJointSetHingeParam(main_bearing, dParamFMax, 60);
    dJointID pin, wrist;
    if (ways) {
        pin = dJointCreateUniversal(w, 0);
        dJointAttach(pin, crank, rod);
        dJointSetUniversalAnchor(pin, 1, 0, 0);
        dJointSetUniversalAxis1(pin, 0, 0, 1);
        dJointSetUniversalAxis2(pin, 0, 1, 0);
        wrist = dJointCreateBall(w, 0);
        dJointAttach(wrist, rod, piston);
        dJointSetBallAnchor(wrist, 3, 0, 0);
    } else {
        pin = dJointCreateHinge(w, 0);
        dJointAttach(pin, crank, rod);
        dJointSetHingeAnchor(pin, 1, 0, 0);
        dJointSetHingeAxis(pin, 0, 0, 1);
        wrist = dJointCreateHinge(w, 0);
        dJointAttach(wrist, rod, piston);
        dJointSetHingeAnchor(wrist, 3, 0, 0);
        dJointSetHingeAxis(wrist, 0, 0, 1);
    }
    dJointID cylinder = dJointCreateSlider(w, 0);
    dJointAttach(cylinder, piston, 0);
    dJointSetSliderAxis(cylinder, 1, 0, 0);
    dJointSetSliderParam(cylinder, dParamLoStop, -2.5);
    dJointSetSliderParam(cylinder, dParamHiStop, 0.5);
    dJointFeedback felt;
    dJointSetFeedback(main_bearing, &felt);
    dRandSetSeed(3);
    for (int i = 0; i < 150; i++) {
        if (i == 75) dJointSetHingeParam(main_bearing, dParamVel, -3);
        if (i == 110) dJointSetHingeParam(main_bearing, dParamFMax, 0);
        if (quick) dWorldQuickStep(w, 0.01);
        else dWorldStep(w, 0.01);
        if (i % 15 == 14) {
            show1("angle", dJointGetHingeAngle(main_bearing));
            show1("rate", dJointGetHingeAngleRate(main_bearing));
            show1("position", dJointGetSliderPosition(cylinder));
            show1("speed", dJointGetSliderPositionRate(cylinder));
            if (ways) show1("pin", dJointGetUniversalAngle1(pin));
            else show1("pin", dJointGetHingeAngle(pin));
            show("torque", felt.t1, 3);
        }
    }
    show_body("piston", piston);
    dWorldDestroy(w);
}

int main(void) {
    dInitODE2(0);
    run(0, 0);
    run(0, 1);
    run(1, 0);
    dCloseODE();
    return 0;
}
