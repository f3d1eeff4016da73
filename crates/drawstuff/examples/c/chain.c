/* A chain of capsules on ball joints hangs from the air and swings over a post. */
#include "demo.h"

enum { LINKS = 14 };
static dGeomID links[LINKS], post;

static void start(void) {
    int i;
    make_world();
    dWorldSetERP(world, 0.4);
    for (i = 0; i < LINKS; i++) {
        dMatrix3 turn;
        dJointID ball = dJointCreateBall(world, 0);
        links[i] = dCreateCapsule(space, 0.05, 0.18);
        dRFromAxisAndAngle(turn, 0, 1, 0, M_PI / 2);
        dBodySetRotation(give_body(links[i], 800, 0.13 + 0.26 * i, 0, 3.2), turn);
        dJointAttach(ball, dGeomGetBody(links[i]), i ? dGeomGetBody(links[i - 1]) : 0);
        dJointSetBallAnchor(ball, 0.26 * i, 0, 3.2);
    }
    post = dCreateCapsule(space, 0.3, 1);
    dGeomSetPosition(post, 0.6, 0.05, 0.8);
    view(1.5f, -5.5f, 2.2f, 90, -5);
}

static void step(int pause) {
    int i;
    if (!pause) advance(4, 0.004);
    dsSetColor(0.75f, 0.78f, 0.85f);
    for (i = 0; i < LINKS; i++) draw(links[i]);
    dsSetTexture(DS_CHECKERED);
    dsSetColor(0.9f, 0.5f, 0.3f);
    draw(post);
}

int main(int argc, char **argv) { return show(argc, argv, start, step, 0); }
