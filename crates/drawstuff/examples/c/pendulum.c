/* A double pendulum on hinges, with the path of its end. */
#include "demo.h"

enum { TRAIL = 400 };
static dBodyID arms[2];
static dReal trail[TRAIL][3];
static int points;

static void start(void) {
    int i;
    make_world();
    for (i = 0; i < 2; i++) {
        dMatrix3 turn;
        dJointID hinge;
        dMass mass;
        arms[i] = dBodyCreate(world);
        dMassSetBox(&mass, 500, 0.08, 0.08, 1);
        dBodySetMass(arms[i], &mass);
        dRFromAxisAndAngle(turn, 0, 1, 0, M_PI / 2);
        dBodySetRotation(arms[i], turn);
        dBodySetPosition(arms[i], 0.5 + i, 0, 2.4);
        hinge = dJointCreateHinge(world, 0);
        dJointAttach(hinge, arms[i], i ? arms[0] : 0);
        dJointSetHingeAnchor(hinge, i, 0, 2.4);
        dJointSetHingeAxis(hinge, 0, 1, 0);
    }
    view(0, -5.5f, 2, 90, -4);
}

static void step(int pause) {
    static const dReal sides[3] = {0.08, 0.08, 1}, post[3] = {0.15, 0.15, 2.4}, at[3] = {0, 0.2, 1.2};
    dMatrix3 upright;
    dVector3 end;
    int i;
    for (i = 0; i < 8 && !pause; i++) dWorldStep(world, 0.002);
    dBodyGetRelPointPos(arms[1], 0, 0, 0.5, end);
    if (!pause) memcpy(trail[points++ % TRAIL], end, sizeof trail[0]);
    dRSetIdentity(upright);
    dsSetColor(0.5f, 0.5f, 0.55f);
    dsDrawBox(at, upright, post);
    for (i = 0; i < 2; i++) {
        dsSetColor(i ? 0.3f : 0.9f, 0.5f, i ? 0.9f : 0.3f);
        dsDrawBox(dBodyGetPosition(arms[i]), dBodyGetRotation(arms[i]), sides);
    }
    dsSetColor(0.1f, 0.1f, 0.1f);
    for (i = points > TRAIL ? points - TRAIL + 1 : 1; i < points; i++)
        dsDrawLine(trail[(i - 1) % TRAIL], trail[i % TRAIL]);
}

int main(int argc, char **argv) { return show(argc, argv, start, step, 0); }
