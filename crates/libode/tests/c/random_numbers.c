/* The random stream: seeds, numbers, vectors and matrices, one stream for the steps of all worlds. */
#include "check.h"

int main(void) {
    dReal x[40];
    dRandSetSeed(2024);
    CHECKI(dRandSetSeed, dRandGetSeed());
    I1(dRand);
    CHECKI(dRandGetSeed, dRandGetSeed());
    for (int n = 1; n < 2000000; n = 5 * n + 2) I1(dRandInt, n);
    R1(dRandReal);
    dMakeRandomVector(x, 7, 2);
    CHECK(dMakeRandomVector, x, 7);
    memset(x, 0, sizeof x);
    dMakeRandomMatrix(x, 3, 5, 0.5);
    CHECK(dMakeRandomMatrix, x, 24);
    I1(dTestRand);
    dInitODE2(0);
    dWorldID w[2];
    for (int k = 0; k < 2; k++) {
        w[k] = dWorldCreate();
        dBodyID a, b;
        two_bodies(w[k], &a, &b);
        for (int i = 0; i < 3; i++) dJointAttach(dJointCreateBall(w[k], 0), a, b);
    }
    for (int i = 0; i < 6; i++) {
        dWorldQuickStep(w[i % 2], 0.01);
        CHECKI(dWorldQuickStep, dRandGetSeed());
    }
    dWorldDestroy(w[0]);
    dWorldDestroy(w[1]);
    dCloseODE();
    return 0;
}
