/* Angular motors: axes in three frames, angles given and measured, speeds, torques. */
#include "check.h"

static dWorldID w;
static dBodyID a, b;
static dJointID j;
static void begin(void) {
    w = dWorldCreate();
    two_bodies(w, &a, &b);
    j = dJointCreateAMotor(w, 0);
    dJointAttach(j, a, b);
}
static void run(void) { for (int i = 0; i < 10; i++) dWorldStep(w, 0.02); }

int main(void) {
    dInitODE2(0);
    begin();
    CHECKI(dJointCreateAMotor, dJointGetType(j));
    dJointSetAMotorNumAxes(j, 3);
    CHECKI(dJointSetAMotorNumAxes, dJointGetAMotorNumAxes(j));
    I1(dJointGetAMotorNumAxes, j);
    for (int i = 0; i < 3; i++) {
        dVector3 p;
        dJointSetAMotorAxis(j, i, i, i == 0, i == 1, i == 2);
        dJointGetAMotorAxis(j, i, p);
        CHECK(dJointSetAMotorAxis, p, 3);
        V3(dJointGetAMotorAxis, j, i);
        I1(dJointGetAMotorAxisRel, j, i);
        dJointSetAMotorAngle(j, i, 0.1 * i + 0.2);
        CHECK1(dJointSetAMotorAngle, dJointGetAMotorAngle(j, i));
        R1(dJointGetAMotorAngle, j, i);
        dJointSetAMotorParam(j, dParamVel + dParamGroup * i, 0.3 * i - 0.4);
        dJointSetAMotorParam(j, dParamFMax + dParamGroup * i, 5);
        R1(dJointGetAMotorParam, j, dParamVel + dParamGroup * i);
    }
    run();
    MOVES(dJointSetAMotorParam, a);
    dWorldDestroy(w);
    begin();
    dJointSetAMotorMode(j, dAMotorEuler);
    CHECKI(dJointSetAMotorMode, dJointGetAMotorMode(j));
    I1(dJointGetAMotorMode, j);
    dJointSetAMotorAxis(j, 0, 1, 1, 0, 0);
    dJointSetAMotorAxis(j, 2, 2, 0, 0, 1);
    dJointSetAMotorParam(j, dParamHiStop3, 0.05);
    dJointSetAMotorParam(j, dParamLoStop3, -0.05);
    run();
    for (int i = 0; i < 3; i++) CHECK1(dJointGetAMotorAngle, dJointGetAMotorAngle(j, i));
    for (int i = 0; i < 3; i++) R1(dJointGetAMotorAngleRate, j, i);
    MOVES(dJointSetAMotorMode, a);
    dWorldDestroy(w);
    begin();
    dJointSetAMotorNumAxes(j, 1);
    dJointSetAMotorAxis(j, 0, 0, 1, 2, 3);
    dJointAddAMotorTorques(j, 0.7, 0, 0);
    CHECK(dJointAddAMotorTorques, dBodyGetTorque(a), 3);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
