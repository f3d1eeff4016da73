/* Ball, hinge, slider, universal, hinge-2, fixed: every function, with two bodies, with one, and reversed; then steps. */
#include "check.h"

enum { TWO, ONE, REVERSED };
static dWorldID w;
static dBodyID a, b;
static dJointFeedback feedback;

static void begin(const char *name, int how) {
    printf("== %s %d\n", name, how);
    w = dWorldCreate();
    dWorldSetGravity(w, 0.1, -0.2, -9.81);
    two_bodies(w, &a, &b);
}
static void join(dJointID j, int how) {
    memset(&feedback, 0, sizeof feedback);
    dJointAttach(j, how == REVERSED ? 0 : a, how == TWO ? b : how == REVERSED ? a : 0);
    dJointSetFeedback(j, &feedback);
}
static void steps(void) {
    for (int i = 0; i < 5; i++) {
        if (i < 3) dWorldStep(w, 0.01); else dWorldQuickStep(w, 0.01);
        show("f1", feedback.f1, 3);
        show("t1", feedback.t1, 3);
        show("f2", feedback.f2, 3);
        show("t2", feedback.t2, 3);
    }
    show_body("a", a);
    show_body("b", b);
}
static void end(void) { dWorldDestroy(w); }

/* Sets and gets parameters of a group; the joint's own getters and setters. */
typedef void setter(dJointID, int, dReal);
typedef dReal getter(dJointID, int);
static void params(dJointID j, setter *set, getter *get, int groups) {
    for (int g = 0; g < groups; g++) {
        for (int n = 0; n <= 14; n++) show1("param", get(j, n + 256 * g));
        set(j, dParamLoStop + 256 * g, -0.8);
        set(j, dParamHiStop + 256 * g, 0.9);
        set(j, dParamVel + 256 * g, 0.3);
        set(j, dParamFMax + 256 * g, 0.7);
        set(j, dParamFMax + 256 * g, -5);
        set(j, dParamFudgeFactor + 256 * g, 0.5);
        set(j, dParamFudgeFactor + 256 * g, 7);
        set(j, dParamBounce + 256 * g, 0.1);
        set(j, dParamCFM + 256 * g, 1e-5);
        set(j, dParamStopERP + 256 * g, 0.3);
        set(j, dParamStopCFM + 256 * g, 1e-6);
        set(j, dParamSuspensionERP + 256 * g, 0.25);
        set(j, dParamSuspensionCFM + 256 * g, 1e-3);
        set(j, dParamERP + 256 * g, 0.35);
        set(j, 77, 5);
        for (int n = 0; n <= 14; n++) show1("param", get(j, n + 256 * g));
    }
}

int main(void) {
    dInitODE2(0);
    for (int how = 0; how < 3; how++) {
        begin("ball", how);
        dJointID j = dJointCreateBall(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetBallAnchor(j, 0.7, 0.1, 1.2);
        V3(dJointGetBallAnchor, j);
        V3(dJointGetBallAnchor2, j);
        if (how == TWO) dJointSetBallAnchor2(j, 0.2, 0.1, 0.05);
        V3(dJointGetBallAnchor2, j);
        params(j, dJointSetBallParam, dJointGetBallParam, 1);
        steps();
        end();

        begin("hinge", how);
        j = dJointCreateHinge(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetHingeAnchor(j, 0.7, 0.1, 1.2);
        dJointSetHingeAxis(j, 0.1, 0.2, 1);
        V3(dJointGetHingeAnchor, j);
        V3(dJointGetHingeAnchor2, j);
        V3(dJointGetHingeAxis, j);
        R1(dJointGetHingeAngle, j);
        R1(dJointGetHingeAngleRate, j);
        dJointSetHingeAxisOffset(j, 0, 0, 1, 0.3);
        R1(dJointGetHingeAngle, j);
        dJointSetHingeAnchorDelta(j, 0.6, 0.1, 1.2, 0.01, 0.02, 0.03);
        V3(dJointGetHingeAnchor2, j);
        params(j, dJointSetHingeParam, dJointGetHingeParam, 2);
        dJointAddHingeTorque(j, 2.5);
        show_body("a", a);
        steps();
        R1(dJointGetHingeAngle, j);
        end();

        begin("slider", how);
        j = dJointCreateSlider(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetSliderAxis(j, 1, 0.2, 0.3);
        V3(dJointGetSliderAxis, j);
        R1(dJointGetSliderPosition, j);
        R1(dJointGetSliderPositionRate, j);
        dJointSetSliderAxisDelta(j, 1, 0.1, 0, 0.1, 0.2, 0.3);
        R1(dJointGetSliderPosition, j);
        params(j, dJointSetSliderParam, dJointGetSliderParam, 2);
        dJointAddSliderForce(j, 1.5);
        steps();
        R1(dJointGetSliderPosition, j);
        R1(dJointGetSliderPositionRate, j);
        end();

        begin("universal", how);
        j = dJointCreateUniversal(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetUniversalAnchor(j, 0.7, 0.1, 1.2);
        dJointSetUniversalAxis1(j, 1, 0, 0);
        dJointSetUniversalAxis2(j, 0, 0, 1);
        V3(dJointGetUniversalAnchor, j);
        V3(dJointGetUniversalAnchor2, j);
        V3(dJointGetUniversalAxis1, j);
        V3(dJointGetUniversalAxis2, j);
        if (how != REVERSED) dJointSetUniversalAxis1Offset(j, 1, 0, 0, 0.2, 0.1);
        R1(dJointGetUniversalAngle1, j);
        dJointSetUniversalAxis2Offset(j, 0, 0, 1, 0.1, 0.2);
        R1(dJointGetUniversalAngle1, j);
        R1(dJointGetUniversalAngle2, j);
        R1(dJointGetUniversalAngle1Rate, j);
        R1(dJointGetUniversalAngle2Rate, j);
        dReal u = 0, v = 0;
        dJointGetUniversalAngles(j, &u, &v);
        show1("u", u);
        show1("v", v);
        params(j, dJointSetUniversalParam, dJointGetUniversalParam, 2);
        dJointAddUniversalTorques(j, 0.4, -0.3);
        steps();
        R1(dJointGetUniversalAngle1, j);
        R1(dJointGetUniversalAngle2, j);
        end();

        if (how == TWO) {
            begin("hinge2", how);
            j = dJointCreateHinge2(w, 0);
            I1(dJointGetType, j);
            join(j, how);
            dJointSetHinge2Anchor(j, 1.4, -0.3, 1.1);
            dVector3 up = {0, 0, 1}, side = {0, 1, 0.1};
            dJointSetHinge2Axes(j, up, side);
            dJointSetHinge2Axis1(j, 0.05, 0, 1);
            dJointSetHinge2Axis2(j, 0, 1, 0);
            V3(dJointGetHinge2Anchor, j);
            V3(dJointGetHinge2Anchor2, j);
            V3(dJointGetHinge2Axis1, j);
            V3(dJointGetHinge2Axis2, j);
            R1(dJointGetHinge2Angle1, j);
            R1(dJointGetHinge2Angle2, j);
            R1(dJointGetHinge2Angle1Rate, j);
            R1(dJointGetHinge2Angle2Rate, j);
            params(j, dJointSetHinge2Param, dJointGetHinge2Param, 2);
            dJointAddHinge2Torques(j, 0.5, 0.6);
            steps();
            R1(dJointGetHinge2Angle1, j);
            R1(dJointGetHinge2Angle1Rate, j);
            end();
        }

        begin("fixed", how);
        j = dJointCreateFixed(w, 0);
        I1(dJointGetType, j);
        join(j, how);
        dJointSetFixed(j);
        params(j, dJointSetFixedParam, dJointGetFixedParam, 1);
        steps();
        end();
    }
    dCloseODE();
    return 0;
}
