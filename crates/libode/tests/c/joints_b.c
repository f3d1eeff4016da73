/* PR, PU, piston, motors, plane-2d, double joints, transmission, null: every function; then steps. */
#include "check.h"

enum { TWO, ONE, REVERSED };
static dWorldID w;
static dBodyID a, b;

static void begin(const char *name, int how) {
    printf("== %s %d\n", name, how);
    w = dWorldCreate();
    dWorldSetGravity(w, 0.1, -0.2, -9.81);
    two_bodies(w, &a, &b);
}
static void join(dJointID j, int how) {
    dJointAttach(j, how == REVERSED ? 0 : a, how == TWO ? b : how == REVERSED ? a : 0);
}
static void steps(void) {
    for (int i = 0; i < 5; i++) if (i < 3) dWorldStep(w, 0.01); else dWorldQuickStep(w, 0.01);
    show_body("a", a);
    show_body("b", b);
    dWorldDestroy(w);
}
typedef void setter(dJointID, int, dReal);
typedef dReal getter(dJointID, int);
static void params(dJointID j, setter *set, getter *get, int groups) {
    for (int g = 0; g < groups; g++) {
        for (int n = 0; n <= 14; n++) show1("param", get(j, n + 256 * g));
        set(j, dParamLoStop + 256 * g, -1.8);
        set(j, dParamHiStop + 256 * g, 1.9);
        set(j, dParamVel + 256 * g, 0.3);
        set(j, dParamFMax + 256 * g, 0.7);
        set(j, dParamERP + 256 * g, 0.35);
        set(j, dParamCFM + 256 * g, 1e-5);
        for (int n = 0; n <= 14; n++) show1("param", get(j, n + 256 * g));
    }
}

int main(void) {
    dInitODE2(0);
    for (int how = 0; how < 3; how++) {
        begin("pr", how);
        dJointID j = dJointCreatePR(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetPRAnchor(j, 0.7, 0.1, 1.2);
        dJointSetPRAxis1(j, 1, 0, 0);
        dJointSetPRAxis2(j, 0, 0, 1);
        V3(dJointGetPRAnchor, j);
        V3(dJointGetPRAxis1, j);
        V3(dJointGetPRAxis2, j);
        R1(dJointGetPRPosition, j);
        R1(dJointGetPRPositionRate, j);
        R1(dJointGetPRAngle, j);
        R1(dJointGetPRAngleRate, j);
        params(j, dJointSetPRParam, dJointGetPRParam, 2);
        dJointAddPRTorque(j, 0.4);
        steps();

        begin("pu", how);
        j = dJointCreatePU(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetPUAnchor(j, 0.7, 0.1, 1.2);
        dJointSetPUAxis1(j, 0, 1, 0);
        dJointSetPUAxis2(j, 0, 0, 1);
        dJointSetPUAxis3(j, 1, 0, 0);
        dJointSetPUAxisP(j, 1, 0.1, 0);
        V3(dJointGetPUAnchor, j);
        V3(dJointGetPUAxis1, j);
        V3(dJointGetPUAxis2, j);
        V3(dJointGetPUAxis3, j);
        V3(dJointGetPUAxisP, j);
        dJointSetPUAnchorDelta(j, 0.7, 0.1, 1.2, 0.1, 0, 0);
        R1(dJointGetPUPosition, j);
        dJointSetPUAnchorOffset(j, 0.7, 0.1, 1.2, 0.1, 0, 0);
        R1(dJointGetPUPosition, j);
        R1(dJointGetPUPositionRate, j);
        dReal u = 0, v = 0;
        dJointGetPUAngles(j, &u, &v);
        show1("u", u);
        show1("v", v);
        R1(dJointGetPUAngle1, j);
        R1(dJointGetPUAngle2, j);
        R1(dJointGetPUAngle1Rate, j);
        R1(dJointGetPUAngle2Rate, j);
        params(j, dJointSetPUParam, dJointGetPUParam, 3);
        steps();

        begin("piston", how);
        j = dJointCreatePiston(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetPistonAnchor(j, 0.7, 0.1, 1.2);
        dJointSetPistonAxis(j, 1, 0.2, 0);
        V3(dJointGetPistonAnchor, j);
        V3(dJointGetPistonAnchor2, j);
        V3(dJointGetPistonAxis, j);
        dJointSetPistonAnchorOffset(j, 0.7, 0.1, 1.2, 0.1, 0.2, 0);
        R1(dJointGetPistonPosition, j);
        R1(dJointGetPistonPositionRate, j);
        R1(dJointGetPistonAngle, j);
        R1(dJointGetPistonAngleRate, j);
        params(j, dJointSetPistonParam, dJointGetPistonParam, 2);
        dJointAddPistonForce(j, 0.6);
        steps();

        if (how == TWO) {
            begin("piston delta", how);
            j = dJointCreatePiston(w, 0);
            join(j, how);
            dJointSetPistonAxisDelta(j, 1, 0, 0, 0.1, 0.2, 0);
            V3(dJointGetPistonAxis, j);
            R1(dJointGetPistonPosition, j);
            dWorldDestroy(w);
        }

        begin("amotor", how);
        j = dJointCreateAMotor(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetAMotorNumAxes(j, 2);
        I1(dJointGetAMotorNumAxes, j);
        I1(dJointGetAMotorMode, j);
        dJointSetAMotorAxis(j, 0, 0, 1, 0, 0);
        dJointSetAMotorAxis(j, 1, how == REVERSED ? 2 : 1, 0, 2, 1);
        for (int i = 0; i < 2; i++) {
            V3(dJointGetAMotorAxis, j, i);
            I1(dJointGetAMotorAxisRel, j, i);
            R1(dJointGetAMotorAngle, j, i);
            R1(dJointGetAMotorAngleRate, j, i);
        }
        dJointSetAMotorAngle(j, 1, 0.3);
        R1(dJointGetAMotorAngle, j, 1);
        params(j, dJointSetAMotorParam, dJointGetAMotorParam, 3);
        dJointAddAMotorTorques(j, 0.1, 0.2, 0.3);
        steps();

        begin("amotor euler", how);
        j = dJointCreateAMotor(w, 0);
        join(j, how);
        dJointSetAMotorMode(j, dAMotorEuler);
        I1(dJointGetAMotorMode, j);
        I1(dJointGetAMotorNumAxes, j);
        dJointSetAMotorAxis(j, 0, 1, 1, 0, 0);
        dJointSetAMotorAxis(j, 2, 2, 0, 0, 1);
        V3(dJointGetAMotorAxis, j, 0);
        V3(dJointGetAMotorAxis, j, 1);
        V3(dJointGetAMotorAxis, j, 2);
        dJointAddAMotorTorques(j, 0.1, 0.2, 0.3);
        dWorldStep(w, 0.01);
        R1(dJointGetAMotorAngle, j, 0);
        R1(dJointGetAMotorAngle, j, 1);
        R1(dJointGetAMotorAngle, j, 2);
        steps();

        begin("lmotor", how);
        j = dJointCreateLMotor(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetLMotorNumAxes(j, 3);
        I1(dJointGetLMotorNumAxes, j);
        dJointSetLMotorAxis(j, 0, 0, 1, 0, 0);
        dJointSetLMotorAxis(j, 1, 1, 0, 1, 0);
        dJointSetLMotorAxis(j, 2, 2, 0, 0, 2);
        V3(dJointGetLMotorAxis, j, 0);
        V3(dJointGetLMotorAxis, j, 1);
        V3(dJointGetLMotorAxis, j, 2);
        params(j, dJointSetLMotorParam, dJointGetLMotorParam, 3);
        steps();

        begin("plane2d", how);
        j = dJointCreatePlane2D(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetPlane2DXParam(j, dParamVel, 0.3);
        dJointSetPlane2DXParam(j, dParamFMax, 1);
        dJointSetPlane2DYParam(j, dParamVel, -0.3);
        dJointSetPlane2DYParam(j, dParamFMax, 1);
        dJointSetPlane2DAngleParam(j, dParamVel, 0.5);
        dJointSetPlane2DAngleParam(j, dParamFMax, 1);
        steps();

        begin("dball", how);
        j = dJointCreateDBall(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetDBallAnchor1(j, 0.2, 0.1, 1.2);
        dJointSetDBallAnchor2(j, 1.2, 0.1, 1.2);
        V3(dJointGetDBallAnchor1, j);
        V3(dJointGetDBallAnchor2, j);
        R1(dJointGetDBallDistance, j);
        dJointSetDBallDistance(j, 1.1);
        R1(dJointGetDBallDistance, j);
        params(j, dJointSetDBallParam, dJointGetDBallParam, 1);
        steps();

        begin("dhinge", how);
        j = dJointCreateDHinge(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetDHingeAxis(j, 0, 0.1, 1);
        dJointSetDHingeAnchor1(j, 0.2, 0.1, 1.2);
        dJointSetDHingeAnchor2(j, 1.2, 0.1, 1.2);
        V3(dJointGetDHingeAxis, j);
        V3(dJointGetDHingeAnchor1, j);
        V3(dJointGetDHingeAnchor2, j);
        R1(dJointGetDHingeDistance, j);
        params(j, dJointSetDHingeParam, dJointGetDHingeParam, 1);
        steps();

        begin("null", how);
        j = dJointCreateNull(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        steps();
    }
    for (int mode = 0; mode < 3; mode++) {
        begin("transmission", mode);
        dMatrix3 r;
        dRSetIdentity(r);
        dBodySetRotation(a, r);
        dBodySetRotation(b, r);
        dBodySetPosition(a, 0, 0, 1);
        dBodySetPosition(b, 2, 0, 1);
        dJointID j = dJointCreateTransmission(w, 0), h1 = dJointCreateHinge(w, 0), h2 = dJointCreateHinge(w, 0);
        I1(dJointGetType, j);
        dJointAttach(j, a, b);
        dJointSetTransmissionMode(j, mode);
        I1(dJointGetTransmissionMode, j);
        dJointAttach(h1, a, 0);
        dJointAttach(h2, b, 0);
        dJointSetHingeAnchor(h1, 0, 0, 1);
        dJointSetHingeAnchor(h2, 2, 0, 1);
        dJointSetHingeAxis(h1, 0, 0, 1);
        if (mode == 1) {
            dJointSetHingeAxis(h2, 1, 0, 0);
            dJointSetTransmissionAxis1(j, 0, 0, 1);
            dJointSetTransmissionAxis2(j, 1, 0, 0);
        } else {
            dJointSetHingeAxis(h2, 0, 0, 1);
            dJointSetTransmissionAxis(j, 0, 0, 1);
        }
        dJointSetTransmissionAnchor1(j, 0, 0, 1);
        dJointSetTransmissionAnchor2(j, 2, 0, 1);
        if (mode == 0) dJointSetTransmissionRatio(j, 1.5);
        if (mode == 2) {
            dJointSetTransmissionRadius1(j, 0.4);
            dJointSetTransmissionRadius2(j, 0.6);
        }
        dJointSetTransmissionBacklash(j, mode == 0 ? 0.01 : 0);
        R1(dJointGetTransmissionBacklash, j);
        params(j, dJointSetTransmissionParam, dJointGetTransmissionParam, 1);
        if (mode != 1) for (int i = 0; i < 3; i++) { dBodySetAngularVel(a, 0, 0, 1); dWorldStep(w, 0.01); }
        if (mode == 0) V3(dJointGetTransmissionAxis, j);
        V3(dJointGetTransmissionAxis1, j);
        V3(dJointGetTransmissionAxis2, j);
        V3(dJointGetTransmissionAnchor1, j);
        V3(dJointGetTransmissionAnchor2, j);
        if (mode != 1) {
            V3(dJointGetTransmissionContactPoint1, j);
            V3(dJointGetTransmissionContactPoint2, j);
            R1(dJointGetTransmissionAngle1, j);
            R1(dJointGetTransmissionAngle2, j);
            R1(dJointGetTransmissionRatio, j);
            R1(dJointGetTransmissionRadius1, j);
            R1(dJointGetTransmissionRadius2, j);
            steps();
        } else
            dWorldDestroy(w);
    }
    dCloseODE();
    return 0;
}
