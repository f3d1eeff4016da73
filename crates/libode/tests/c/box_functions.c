/* The functions beneath box pairs and capsules, that programs call by themselves. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dVector3 p1 = {0, 0, 0}, p2 = {0.95, 0.2, 0.1}, s1 = {1, 1, 1}, s2 = {1, 2, 1}, normal;
    dMatrix3 r1, r2;
    dRSetIdentity(r1);
    for (int i = 0; i < 4; i++) {
        dRFromAxisAndAngle(r2, 1, 0.4 * i - 1, 0.3, 0.5 * i);
        p2[0] = 0.95 + 0.25 * i;
        I1(dBoxTouchesBox, p1, r1, s1, p2, r2, s2);
        dReal depth = -1;
        int code = 0;
        dContactGeom c[8];
        int n = dBoxBox(p1, r1, s1, p2, r2, s2, normal, &depth, &code, 8, c, sizeof *c);
        CHECKI(dBoxBox, 100 * n + code);
        if (n) show("normal", normal, 3), show1("depth", depth);
    }
    dVector3 a1 = {0, 0, 0}, a2 = {1, 0, 0}, b1 = {0.3, 1, 1}, b2 = {0.4, -1, 1.2}, c1, c2;
    dClosestLineSegmentPoints(a1, a2, b1, b2, c1, c2);
    CHECK(dClosestLineSegmentPoints, c1, 3);
    CHECK(dClosestLineSegmentPoints, c2, 3);
    dCloseODE();
    return 0;
}
