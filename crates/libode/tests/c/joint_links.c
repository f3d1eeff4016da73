/* Which joints link which bodies: attaching, asking, data, switching off, groups, destruction. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    dBodyID a, b, c = dBodyCreate(w);
    two_bodies(w, &a, &b);
    dJointID ball = dJointCreateBall(w, 0), slider = dJointCreateSlider(w, 0), list[4] = {0};
    I1(dBodyGetNumJoints, a);
    dJointAttach(ball, a, b);
    dJointAttach(slider, b, c);
    CHECKI(dJointAttach, dBodyGetNumJoints(b));
    CHECKI(dBodyGetNumJoints, dBodyGetNumJoints(a) + 10 * dBodyGetNumJoints(b));
    CHECKI(dBodyGetJoint, dBodyGetJoint(b, 0) == slider && dBodyGetJoint(b, 1) == ball);
    CHECKI(dJointGetBody, dJointGetBody(ball, 0) == a && dJointGetBody(slider, 1) == c);
    I1(dJointGetNumBodies, ball);
    printf("dAreConnected: %d %d\n", dAreConnected(a, b), dAreConnected(a, c));
    printf("dAreConnectedExcluding: %d %d\n", dAreConnectedExcluding(a, b, dJointTypeBall),
        dAreConnectedExcluding(a, b, dJointTypeHinge));
    CHECKI(dConnectingJoint, dConnectingJoint(b, c) == slider && !dConnectingJoint(a, c));
    CHECKI(dConnectingJointList, dConnectingJointList(a, b, list) == 1 && list[0] == ball);
    dJointSetData(ball, &w);
    CHECKI(dJointSetData, dJointGetData(ball) == (void *)&w);
    CHECKI(dJointGetData, dJointGetData(ball) == (void *)&w);
    dJointDisable(ball);
    CHECKI(dJointDisable, dJointIsEnabled(ball));
    dWorldStep(w, 0.05);
    MOVES(dJointDisable, a);
    dJointEnable(ball);
    CHECKI(dJointEnable, dJointIsEnabled(ball));
    I1(dJointIsEnabled, ball);
    dWorldStep(w, 0.05);
    MOVES(dJointEnable, a);
    dJointDestroy(ball);
    CHECKI(dJointDestroy, dBodyGetNumJoints(a));
    dJointGroupID group = dJointGroupCreate(0);
    CHECKI(dJointGroupCreate, group != 0);
    for (int i = 0; i < 5; i++) dJointAttach(dJointCreateHinge(w, group), a, c);
    showi("in the group", dBodyGetNumJoints(a));
    dJointGroupEmpty(group);
    CHECKI(dJointGroupEmpty, dBodyGetNumJoints(a));
    for (int i = 0; i < 3; i++) dJointAttach(dJointCreateBall(w, group), a, c);
    dJointGroupDestroy(group);
    CHECKI(dJointGroupDestroy, dBodyGetNumJoints(a));
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
