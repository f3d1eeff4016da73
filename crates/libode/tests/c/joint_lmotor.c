/* Linear motors along one, two and three axes. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    for (int axes = 1; axes <= 3; axes++) {
        dWorldID w = dWorldCreate();
        dBodyID a, b;
        two_bodies(w, &a, &b);
        dJointID j = dJointCreateLMotor(w, 0);
        CHECKI(dJointCreateLMotor, dJointGetType(j));
        dJointAttach(j, a, b);
        dJointSetLMotorNumAxes(j, axes);
        CHECKI(dJointSetLMotorNumAxes, dJointGetLMotorNumAxes(j));
        I1(dJointGetLMotorNumAxes, j);
        for (int i = 0; i < axes; i++) {
            dVector3 p;
            dJointSetLMotorAxis(j, i, i, i == 0, i == 1, i == 2);
            dJointGetLMotorAxis(j, i, p);
            CHECK(dJointSetLMotorAxis, p, 3);
            V3(dJointGetLMotorAxis, j, i);
            dJointSetLMotorParam(j, dParamVel + dParamGroup * i, 0.5 + i);
            dJointSetLMotorParam(j, dParamFMax + dParamGroup * i, 4);
            R1(dJointGetLMotorParam, j, dParamVel + dParamGroup * i);
        }
        for (int i = 0; i < 10; i++) dWorldStep(w, 0.02);
        MOVES(dJointSetLMotorParam, a);
        dWorldDestroy(w);
    }
    dCloseODE();
    return 0;
}
