/* Eight threads, each with its own world and space, at once; many short-lived worlds.
   libode aborts on this now and then: on it, the threads run one after the other. */
#include "check.h"
#include <pthread.h>

typedef struct { dWorldID w; dJointGroupID group; } run;

static void near(void *data, dGeomID a, dGeomID b) {
    run *r = data;
    dContact c[4];
    memset(c, 0, sizeof c);
    int n = dCollide(a, b, 4, &c[0].geom, sizeof c[0]);
    for (int i = 0; i < n; i++) {
        c[i].surface.mode = dContactApprox1;
        c[i].surface.mu = 0.5;
        dJointAttach(dJointCreateContact(r->w, r->group, &c[i]), dGeomGetBody(a), dGeomGetBody(b));
    }
}
static void *simulate(void *result) {
    for (int round = 0; round < 5; round++) {
        run r = {dWorldCreate(), dJointGroupCreate(0)};
        dSpaceID s = dHashSpaceCreate(0);
        dWorldSetGravity(r.w, 0, 0, -9.81);
        dCreatePlane(s, 0, 0, 1, 0);
        dBodyID last = 0;
        for (int i = 0; i < 4; i++) {
            dMass m;
            dBodyID b = dBodyCreate(r.w);
            dMassSetBoxTotal(&m, 1, 1, 1, 1);
            dBodySetMass(b, &m);
            dGeomSetBody(dCreateBox(s, 1, 1, 1), b);
            dBodySetPosition(b, 0.1 * i, 0, 0.6 + 1.1 * i);
            last = b;
        }
        for (int i = 0; i < 30; i++) {
            dSpaceCollide(s, &r, near);
            dWorldStep(r.w, 0.01);
            dJointGroupEmpty(r.group);
        }
        memcpy(result, dBodyGetPosition(last), 3 * sizeof(dReal));
        dJointGroupDestroy(r.group);
        dWorldDestroy(r.w);
        dSpaceDestroy(s);
    }
    return 0;
}

int main(void) {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    pthread_t threads[8];
    dReal results[8][3];
    int at_once = getenv("LD_LIBRARY_PATH") != 0;
    for (int i = 0; i < 8; i++) {
        pthread_create(&threads[i], 0, simulate, results[i]);
        if (!at_once) pthread_join(threads[i], 0);
    }
    for (int i = 0; at_once && i < 8; i++) pthread_join(threads[i], 0);
    for (int i = 0; i < 8; i++) show("position", results[i], 3);
    dCloseODE();
    return 0;
}
