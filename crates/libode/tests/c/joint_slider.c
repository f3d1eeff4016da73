/* Sliders: axis, position and rate, stops, a motor, and a force. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static dJointID j;
static void begin(void) {
    w = dWorldCreate();
    two_bodies(w, &a, &b);
    j = dJointCreateSlider(w, 0);
    dJointAttach(j, a, b);
    dJointSetSliderAxis(j, 1, 0.2, 0.3);
}
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    begin();
    CHECKI(dJointCreateSlider, dJointGetType(j));
    dVector3 p;
    dJointGetSliderAxis(j, p);
    CHECK(dJointSetSliderAxis, p, 3);
    V3(dJointGetSliderAxis, j);
    run();
    R1(dJointGetSliderPosition, j);
    R1(dJointGetSliderPositionRate, j);
    MOVES(dJointSetSliderAxis, a);
    dWorldDestroy(w);
    begin();
    dJointSetSliderAxisDelta(j, 1, 0.1, 0, 0.1, 0.2, 0.3);
    CHECK1(dJointSetSliderAxisDelta, dJointGetSliderPosition(j));
    run();
    MOVES(dJointSetSliderAxisDelta, a);
    dWorldDestroy(w);
    begin();
    dJointSetSliderParam(j, dParamLoStop, -0.02);
    dJointSetSliderParam(j, dParamHiStop, 0.02);
    R1(dJointGetSliderParam, j, dParamLoStop);
    dBodySetLinearVel(a, 4, 0, 0);
    run();
    CHECK1(dJointSetSliderParam, dJointGetSliderPosition(j));
    dWorldDestroy(w);
    begin();
    dJointAddSliderForce(j, 3);
    CHECK(dJointAddSliderForce, dBodyGetForce(b), 3);
    run();
    MOVES(dJointAddSliderForce, b);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
