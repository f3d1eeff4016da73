/* A three-wheeled car by hinge-2 joints drives off and steers on a plane. */
#include "check.h"

static dWorldID w;
static dJointGroupID group;
static void near(void *data, dGeomID a, dGeomID b) {
    (void)data;
    dBodyID x = dGeomGetBody(a), y = dGeomGetBody(b);
    if (dGeomIsSpace(a) || dGeomIsSpace(b) || (x && y && dAreConnected(x, y))) return;
    dContact c[3];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 3, &c[0].geom, sizeof *c);
    for (int i = 0; i < n; i++) {
        c[i].surface.mode = dContactSlip1 | dContactSlip2 | dContactSoftERP | dContactSoftCFM | dContactApprox1;
        c[i].surface.mu = dInfinity;
        c[i].surface.slip1 = c[i].surface.slip2 = 0.1;
        c[i].surface.soft_erp = 0.5;
        c[i].surface.soft_cfm = 0.3;
        dJointAttach(dJointCreateContact(w, group, &c[i]), x, y);
    }
}

int main(void) {
    dInitODE2(0);
    w = dWorldCreate();
    dWorldSetGravity(w, 0, 0, -0.5);
    group = dJointGroupCreate(0);
    dSpaceID space = dHashSpaceCreate(0), car = dSimpleSpaceCreate(space);
    dGeomID ground = dCreatePlane(space, 0, 0, 1, 0);
    dMass m;
    dBodyID chassis = dBodyCreate(w), wheels[3];
    dMassSetBoxTotal(&m, 1, 0.7, 0.5, 0.2);
    dBodySetMass(chassis, &m);
    dBodySetPosition(chassis, 0, 0, 0.5);
    dGeomSetBody(dCreateBox(car, 0.7, 0.5, 0.2), chassis);
    dJointID j[3];
    static const dReal at[3][2] = {{0.35, 0}, {-0.35, 0.25}, {-0.35, -0.25}};
    for (int i = 0; i < 3; i++) {
        wheels[i] = dBodyCreate(w);
        dMassSetSphereTotal(&m, 0.2, 0.18);
        dBodySetMass(wheels[i], &m);
        dBodySetPosition(wheels[i], at[i][0], at[i][1], 0.4);
        dGeomSetBody(dCreateSphere(car, 0.18), wheels[i]);
        j[i] = dJointCreateHinge2(w, 0);
        dJointAttach(j[i], chassis, wheels[i]);
        dJointSetHinge2Anchor(j[i], at[i][0], at[i][1], 0.4);
        dVector3 up = {0, 0, 1}, side = {0, 1, 0};
        dJointSetHinge2Axes(j[i], up, side);
        dJointSetHinge2Param(j[i], dParamSuspensionERP, 0.4);
        dJointSetHinge2Param(j[i], dParamSuspensionCFM, 0.8);
        dJointSetHinge2Param(j[i], dParamLoStop, 0);
        dJointSetHinge2Param(j[i], dParamHiStop, 0);
    }
    for (int i = 0; i < 60; i++) {
        dJointSetHinge2Param(j[0], dParamVel2, -3);
        dJointSetHinge2Param(j[0], dParamFMax2, 0.1);
        dReal v = 0.3 - dJointGetHinge2Angle1(j[0]);
        dJointSetHinge2Param(j[0], dParamVel, 10 * v);
        dJointSetHinge2Param(j[0], dParamFMax, 0.2);
        dJointSetHinge2Param(j[0], dParamLoStop, -0.75);
        dJointSetHinge2Param(j[0], dParamHiStop, 0.75);
        dSpaceCollide(space, 0, near);
        dSpaceCollide2((dGeomID)car, ground, 0, near);
        dWorldStep(w, 0.05);
        dJointGroupEmpty(group);
        if (i % 20 == 19) MOVES(dJointSetHinge2Param, chassis);
    }
    CHECK1(dJointGetHinge2Angle1, dJointGetHinge2Angle1(j[0]));
    CHECK1(dJointGetHinge2Angle2Rate, dJointGetHinge2Angle2Rate(j[0]));
    dJointGroupDestroy(group);
    dSpaceDestroy(space);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
