/* Moved callbacks: who is told, in which order, what it sees; a callback that moves another body, or takes itself off. */
#include "check.h"

static dBodyID bodies[4];
static void told(dBodyID b) {
    for (int i = 0; i < 4; i++) if (bodies[i] == b) printf("told %d", i);
    show("", dBodyGetPosition(b), 3);
    if (b == bodies[2]) dBodySetMovedCallback(b, 0);
    if (b == bodies[1]) dBodySetLinearVel(bodies[0], 0, 5, 0);
}

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    for (int i = 0; i < 4; i++) {
        bodies[i] = dBodyCreate(w);
        dBodySetLinearVel(bodies[i], i + 1, 0, 0);
        dBodySetMovedCallback(bodies[i], told);
    }
    dBodyDisable(bodies[3]);
    for (int i = 0; i < 3; i++) {
        if (i < 2) dWorldStep(w, 0.1); else dWorldQuickStep(w, 0.1);
        showi("step", i);
    }
    MOVES(dBodySetMovedCallback, bodies[0]);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
