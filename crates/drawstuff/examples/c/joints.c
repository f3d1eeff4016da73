/* A row of joints at work: slider, universal, piston, hinge with a motor, fixed. Anchors and axes are lines. */
#include "demo.h"

enum { KINDS = 5 };
static dBodyID bodies[KINDS];
static dJointID joints[KINDS];
static const dReal sides[3] = {0.3, 0.3, 0.7};

static void start(void) {
    int i;
    make_world();
    for (i = 0; i < KINDS; i++) {
        dReal x = 1.1 * (i - 2), z = 1.2;
        dMass mass;
        bodies[i] = dBodyCreate(world);
        dMassSetBox(&mass, 300, sides[0], sides[1], sides[2]);
        dBodySetMass(bodies[i], &mass);
        dBodySetPosition(bodies[i], x, 0, z);
        switch (i) {
        case 0:
            joints[i] = dJointCreateSlider(world, 0);
            dJointAttach(joints[i], bodies[i], 0);
            dJointSetSliderAxis(joints[i], 0, 0, 1);
            dJointSetSliderParam(joints[i], dParamLoStop, -0.6);
            dJointSetSliderParam(joints[i], dParamHiStop, 0.6);
            dJointSetSliderParam(joints[i], dParamBounce, 0.8);
            break;
        case 1:
            joints[i] = dJointCreateUniversal(world, 0);
            dJointAttach(joints[i], bodies[i], 0);
            dJointSetUniversalAnchor(joints[i], x, 0, z + 0.6);
            dJointSetUniversalAxis1(joints[i], 1, 0, 0);
            dJointSetUniversalAxis2(joints[i], 0, 1, 0);
            dBodySetAngularVel(bodies[i], 2, 1, 0);
            break;
        case 2:
            joints[i] = dJointCreatePiston(world, 0);
            dJointAttach(joints[i], bodies[i], 0);
            dJointSetPistonAnchor(joints[i], x, 0, z);
            dJointSetPistonAxis(joints[i], 0, 0, 1);
            dJointSetPistonParam(joints[i], dParamLoStop, -0.5);
            dJointSetPistonParam(joints[i], dParamHiStop, 0.5);
            dBodySetAngularVel(bodies[i], 0, 0, 4);
            break;
        case 3:
            joints[i] = dJointCreateHinge(world, 0);
            dJointAttach(joints[i], bodies[i], 0);
            dJointSetHingeAnchor(joints[i], x, 0, z);
            dJointSetHingeAxis(joints[i], 0, 1, 0);
            dJointSetHingeParam(joints[i], dParamVel, 2);
            dJointSetHingeParam(joints[i], dParamFMax, 30);
            break;
        default:
            joints[i] = dJointCreateFixed(world, 0);
            dJointAttach(joints[i], bodies[i], 0);
            dJointSetFixed(joints[i]);
        }
    }
    view(0, -4.6f, 1.7f, 90, -7);
}

static void axis(const dReal *anchor, const dReal *along) {
    dReal from[3], to[3];
    int k;
    for (k = 0; k < 3; k++) from[k] = anchor[k] - 0.6 * along[k], to[k] = anchor[k] + 0.6 * along[k];
    dsDrawLine(from, to);
}

static void step(int pause) {
    dVector3 anchor, along;
    int i;
    for (i = 0; i < 4 && !pause; i++) dWorldStep(world, 0.004);
    for (i = 0; i < KINDS; i++) {
        dsSetColorAlpha(0.2f + 0.15f * i, 0.5f, 0.8f - 0.12f * i, 0.7f);
        dsDrawBox(dBodyGetPosition(bodies[i]), dBodyGetRotation(bodies[i]), sides);
    }
    dsSetColor(0.8f, 0.1f, 0.1f);
    dJointGetSliderAxis(joints[0], along);
    axis(dBodyGetPosition(bodies[0]), along);
    dJointGetUniversalAnchor(joints[1], anchor);
    dJointGetUniversalAxis1(joints[1], along);
    axis(anchor, along);
    dJointGetUniversalAxis2(joints[1], along);
    axis(anchor, along);
    dJointGetPistonAnchor(joints[2], anchor);
    dJointGetPistonAxis(joints[2], along);
    axis(anchor, along);
    dJointGetHingeAnchor(joints[3], anchor);
    dJointGetHingeAxis(joints[3], along);
    axis(anchor, along);
}

int main(int argc, char **argv) { return show(argc, argv, start, step, 0); }
