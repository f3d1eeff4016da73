/* A car on four hinge-2 wheels drives over a ramp. Keys: a faster, z slower, comma left, dot right, space stop. */
#include "demo.h"

static dGeomID chassis, wheels[4], ramp;
static dJointID axles[4];
static dReal speed = 8, steer;

static void start(void) {
    dMatrix3 slope;
    int i;
    make_world();
    surface.mode = dContactApprox1 | dContactSlip1 | dContactSlip2 | dContactSoftERP | dContactSoftCFM;
    surface.mu = dInfinity;
    surface.slip1 = surface.slip2 = 0.01;
    surface.soft_erp = 0.5;
    surface.soft_cfm = 1e-4;
    chassis = dCreateBox(space, 1.2, 0.6, 0.25);
    give_body(chassis, 120, -2, 0, 0.55);
    for (i = 0; i < 4; i++) {
        dReal x = -2 + (i < 2 ? 0.45 : -0.45), y = i % 2 ? 0.38 : -0.38;
        dMatrix3 turn;
        static const dVector3 up = {0, 0, 1}, aside = {0, 1, 0};
        wheels[i] = dCreateSphere(space, 0.22);
        dRFromAxisAndAngle(turn, 1, 0, 0, M_PI / 2);
        dBodySetRotation(give_body(wheels[i], 80, x, y, 0.4), turn);
        axles[i] = dJointCreateHinge2(world, 0);
        dJointAttach(axles[i], dGeomGetBody(chassis), dGeomGetBody(wheels[i]));
        dJointSetHinge2Anchor(axles[i], x, y, 0.4);
        dJointSetHinge2Axes(axles[i], up, aside);
        dJointSetHinge2Param(axles[i], dParamSuspensionERP, 0.4);
        dJointSetHinge2Param(axles[i], dParamSuspensionCFM, 0.002);
        dJointSetHinge2Param(axles[i], dParamLoStop, 0);
        dJointSetHinge2Param(axles[i], dParamHiStop, 0);
        dJointSetHinge2Param(axles[i], dParamFMax2, i < 2 ? 15 : 0);
    }
    ramp = dCreateBox(space, 2.5, 1.6, 0.2);
    dRFromAxisAndAngle(slope, 0, 1, 0, -0.22);
    dGeomSetPosition(ramp, 1.6, 0, 0.16);
    dGeomSetRotation(ramp, slope);
    view(-0.4f, -5.6f, 2.4f, 88, -19);
}

static void command(int key) {
    if (key == 'a') speed += 2;
    if (key == 'z') speed -= 2;
    if (key == ',') steer += 0.15;
    if (key == '.') steer -= 0.15;
    if (key == ' ') speed = steer = 0;
}

static void step(int pause) {
    int i;
    for (i = 0; i < 4 && !pause; i++) {
        int k;
        for (k = 0; k < 2; k++) {
            dReal turn = steer - dJointGetHinge2Angle1(axles[k]);
            dJointSetHinge2Param(axles[k], dParamVel2, -speed);
            dJointSetHinge2Param(axles[k], dParamVel, 5 * turn);
            dJointSetHinge2Param(axles[k], dParamFMax, 20);
            dJointSetHinge2Param(axles[k], dParamLoStop, -0.7);
            dJointSetHinge2Param(axles[k], dParamHiStop, 0.7);
        }
        advance(1, 0.004);
    }
    dsSetTexture(DS_WOOD);
    dsSetColor(0.9f, 0.75f, 0.5f);
    draw(ramp);
    dsSetTexture(DS_NONE);
    dsSetColor(0.85f, 0.25f, 0.2f);
    draw(chassis);
    dsSetColor(0.2f, 0.2f, 0.22f);
    for (i = 0; i < 4; i++)
        dsDrawCylinder(dGeomGetPosition(wheels[i]), dGeomGetRotation(wheels[i]), 0.14f, 0.22f);
}

int main(int argc, char **argv) { return show(argc, argv, start, step, command); }
