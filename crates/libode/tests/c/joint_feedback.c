/* Feedback of a loaded lever: forces and torques on both bodies after steps of both kinds; none after it is taken away. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    dWorldSetGravity(w, 0, 0, -9.81);
    dBodyID a, b;
    two_bodies(w, &a, &b);
    dJointID hinge = dJointCreateHinge(w, 0), fixed = dJointCreateFixed(w, 0);
    dJointAttach(hinge, a, b);
    dJointSetHingeAnchor(hinge, 0.7, 0, 1.2);
    dJointAttach(fixed, a, 0);
    dJointSetFixed(fixed);
    dJointFeedback f, g;
    memset(&f, 0, sizeof f);
    memset(&g, 0, sizeof g);
    dJointSetFeedback(hinge, &f);
    dJointSetFeedback(fixed, &g);
    CHECKI(dJointGetFeedback, dJointGetFeedback(hinge) == &f);
    for (int i = 0; i < 4; i++) {
        if (i < 2) dWorldStep(w, 0.01); else dWorldQuickStep(w, 0.01);
        CHECK(dJointSetFeedback, f.f1, 3);
        show("t1", f.t1, 3);
        show("f2", f.f2, 3);
        show("t2", f.t2, 3);
        show("fixed", g.f1, 3);
        show("fixed", g.t1, 3);
    }
    dJointSetFeedback(hinge, 0);
    f.f1[0] = 12345;
    dWorldStep(w, 0.01);
    show1("left alone", f.f1[0]);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
