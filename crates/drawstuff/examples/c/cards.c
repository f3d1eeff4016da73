/* A house of cards: thin boxes, each storey in a space of its own. Key space: a ball is thrown at it.
   (compared: 12 frames, for a house of cards makes much of the last bit) */
#include "demo.h"

enum { STOREYS = 3, MOST = 40 };
static dGeomID cards[MOST], ball;
static int count;
static const dReal LENGTH = 0.6, WIDTH = 0.4, THICK = 0.02;

static void card(dSpaceID storey, dReal x, dReal z, dReal lean) {
    dMatrix3 turn;
    cards[count] = dCreateBox(storey, LENGTH, WIDTH, THICK);
    dRFromAxisAndAngle(turn, 0, 1, 0, lean);
    dBodySetRotation(give_body(cards[count++], 300, x, 0, z), turn);
}

static void start(void) {
    const dReal lean = 75 * M_PI / 180, half = 0.5 * LENGTH * cos(lean), tall = LENGTH * sin(lean);
    int i, k;
    make_world();
    surface.mu = 5;
    for (i = 0; i < STOREYS; i++) {
        dSpaceID storey = dSimpleSpaceCreate(space);
        dReal z = i * (tall + 2 * THICK) + 0.5 * tall + 0.5 * THICK;
        for (k = 0; k < STOREYS - i; k++) {
            dReal x = 2.4 * half * (2 * k - (STOREYS - 1 - i)) * 0.5 * 2;
            card(storey, x - half - 0.005, z, -lean);
            card(storey, x + half + 0.005, z, lean);
            if (k) card(storey, x - 2.4 * half, z + 0.5 * tall + 0.75 * THICK, 0);
        }
    }
    view(1.2f, -3.4f, 1.5f, 108, -14);
}

static void command(int key) {
    if (key != ' ') return;
    if (!ball) {
        ball = dCreateSphere(space, 0.1);
        give_body(ball, 2000, 0, 0, 0);
    }
    dBodySetPosition(dGeomGetBody(ball), -3, 0, 0.6);
    dBodySetLinearVel(dGeomGetBody(ball), 6, 0, 1.5);
}

static void step(int pause) {
    int i;
    if (!pause) advance(8, 0.002);
    dsSetTexture(DS_CHECKERED);
    for (i = 0; i < count; i++) {
        dsSetColor(0.95f, i % 2 ? 0.3f : 0.9f, i % 2 ? 0.3f : 0.85f);
        draw(cards[i]);
    }
    dsSetTexture(DS_NONE);
    dsSetColor(0.25f, 0.3f, 0.35f);
    if (ball) draw(ball);
}

int main(int argc, char **argv) { return show(argc, argv, start, step, command); }
