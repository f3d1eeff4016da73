/* Plane joints keep a body in z = 0; motors along x, y and the angle. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    for (int kind = 0; kind < 4; kind++) {
        dWorldID w = dWorldCreate();
        dWorldSetGravity(w, 0, -1, -9.81);
        dBodyID b = dBodyCreate(w);
        dBodySetLinearVel(b, 0.1, 0.2, 0.3);
        dBodySetAngularVel(b, 0.3, 0.2, 0.1);
        dJointID j = dJointCreatePlane2D(w, 0);
        dJointAttach(j, b, 0);
        if (kind == 1) dJointSetPlane2DXParam(j, dParamVel, 2), dJointSetPlane2DXParam(j, dParamFMax, 4);
        if (kind == 2) dJointSetPlane2DYParam(j, dParamVel, 2), dJointSetPlane2DYParam(j, dParamFMax, 4);
        if (kind == 3) dJointSetPlane2DAngleParam(j, dParamVel, 2), dJointSetPlane2DAngleParam(j, dParamFMax, 1);
        for (int i = 0; i < 10; i++) dWorldStep(w, 0.02);
        if (kind == 0) CHECKI(dJointCreatePlane2D, dJointGetType(j));
        if (kind == 0) MOVES(dJointCreatePlane2D, b);
        if (kind == 1) MOVES(dJointSetPlane2DXParam, b);
        if (kind == 2) MOVES(dJointSetPlane2DYParam, b);
        if (kind == 3) MOVES(dJointSetPlane2DAngleParam, b);
        dWorldDestroy(w);
    }
    dCloseODE();
    return 0;
}
