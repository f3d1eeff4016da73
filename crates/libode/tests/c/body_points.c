/* Points and directions between a body's frame and the world's; there and back is where it began. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    dBodyID a, b;
    two_bodies(w, &a, &b);
    dVector3 p, back;
    dBodyGetRelPointPos(a, 0.3, -0.2, 0.7, p);
    CHECK(dBodyGetRelPointPos, p, 3);
    dBodyGetPosRelPoint(a, p[0], p[1], p[2], back);
    CHECK(dBodyGetPosRelPoint, back, 3);
    dBodyVectorToWorld(b, 0.3, -0.2, 0.7, p);
    CHECK(dBodyVectorToWorld, p, 3);
    dBodyVectorFromWorld(b, p[0], p[1], p[2], back);
    CHECK(dBodyVectorFromWorld, back, 3);
    dBodyGetRelPointVel(a, 0.3, -0.2, 0.7, p);
    CHECK(dBodyGetRelPointVel, p, 3);
    dBodyGetPointVel(a, 0.3, -0.2, 0.7, p);
    CHECK(dBodyGetPointVel, p, 3);
    /* The velocity of a point is the change of its place. */
    dVector3 before, after, v;
    dBodyGetRelPointPos(b, 1, 1, 1, before);
    dBodySetFiniteRotationMode(b, 1);
    dWorldStep(w, 1e-3);
    dBodyGetRelPointPos(b, 1, 1, 1, after);
    dBodyGetRelPointVel(b, 1, 1, 1, v);
    for (int i = 0; i < 3; i++) showi("moves so", fabs((after[i] - before[i]) / 1e-3 - v[i]) < 5e-3);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
