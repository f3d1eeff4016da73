/* A bridge of planks on hinges whose joints break under a load: feedback is read after each step, a joint that pulls too hard is
   destroyed, its feedback record given to another. */
#include "check.h"

enum { PLANKS = 9 };
static dWorldID w;
static dBodyID planks[PLANKS];
static dJointID joints[PLANKS + 1];
static dJointFeedback records[PLANKS + 1];

static dReal pull(const dJointFeedback *f) {
    return sqrt(f->f1[0] * f->f1[0] + f->f1[1] * f->f1[1] + f->f1[2] * f->f1[2]);
}
static void build(void) {
    for (int i = 0; i < PLANKS; i++) {
        dMass m;
        planks[i] = dBodyCreate(w);
        dMassSetBoxTotal(&m, 2, 1, 0.8, 0.1);
        dBodySetMass(planks[i], &m);
        dBodySetPosition(planks[i], i - PLANKS / 2, 0, 3);
    }
    for (int i = 0; i <= PLANKS; i++) {
        joints[i] = dJointCreateHinge(w, 0);
        dJointAttach(joints[i], i ? planks[i - 1] : 0, i < PLANKS ? planks[i] : 0);
        dJointSetHingeAnchor(joints[i], i - PLANKS / 2 - 0.5, 0, 3);
        dJointSetHingeAxis(joints[i], 0, 1, 0);
        dJointSetFeedback(joints[i], &records[i]);
    }
}
static void load(int quick, dReal limit) {
    w = dWorldCreate();
    dWorldSetGravity(w, 0, 0, -9.81);
    dWorldSetCFM(w, 1e-5);
    build();
    dBodyID truck = dBodyCreate(w);
    dMass m;
    dMassSetSphereTotal(&m, 30, 0.4);
    dBodySetMass(truck, &m);
    dBodySetPosition(truck, 0, 0, 2.5);
    dJointID rope = dJointCreateBall(w, 0);
    dJointAttach(rope, planks[PLANKS / 2], truck);
    dJointSetBallAnchor(rope, 0, 0, 3);
    int broken = 0;
    for (int step = 0; step < 80; step++) {
        if (quick) dWorldQuickStep(w, 0.01);
        else dWorldStep(w, 0.01);
        for (int i = 0; i <= PLANKS; i++)
            if (joints[i] && pull(dJointGetFeedback(joints[i])) > limit) {
                printf("joint %d breaks at step %d\n", i, step);
                dJointDestroy(joints[i]);
                joints[i] = 0;
                broken++;
                /* Its record counts no more; the next joint writes to it from now on. */
                memset(&records[i], 0, sizeof records[i]);
                if (i < PLANKS && joints[i + 1]) dJointSetFeedback(joints[i + 1], &records[i]);
            }
        if (step % 20 == 19) {
            show("middle", dBodyGetPosition(planks[PLANKS / 2]), 3);
            show("truck", dBodyGetPosition(truck), 3);
            for (int i = 0; i <= PLANKS; i += 3)
                if (joints[i]) show1("pull", pull(dJointGetFeedback(joints[i])));
        }
    }
    showi("broken", broken);
    for (int i = 0; i <= PLANKS; i++)
        if (joints[i]) dJointSetFeedback(joints[i], 0);
    dWorldStep(w, 0.01);
    dWorldDestroy(w);
}

int main(void) {
    dInitODE2(0);
    load(0, 1e9);
    load(0, 700);
    dRandSetSeed(5);
    load(1, 1e9);
    dCloseODE();
    return 0;
}
