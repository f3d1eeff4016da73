/* Boxes drop on each other. Keys: b another box, d all stop being asleep, space one is thrown. */
#include "demo.h"

static dGeomID boxes[60];
static int count;

static void drop(dReal x, dReal y, dReal z) {
    dMatrix3 turn;
    if (count == 60) return;
    boxes[count] = dCreateBox(space, 0.5, 0.4 + 0.05 * (count % 4), 0.3);
    dRFromAxisAndAngle(turn, 1, 2, 3, 0.4 * count);
    dBodySetRotation(give_body(boxes[count], 300, x, y, z), turn);
    count++;
}

static void start(void) {
    int i;
    make_world();
    for (i = 0; i < 12; i++) drop(0.15 * (i % 3) - 0.15, 0.2 * (i % 2) - 0.1, 0.8 + 0.6 * i);
    view(3.4f, -2.6f, 2.1f, 142, -17);
}

static void command(int key) {
    if (key == 'b') drop(0, 0, 3);
    if (key == ' ' && count) dBodyAddForce(dGeomGetBody(boxes[count - 1]), 0, 0, 20000);
}

static void step(int pause) {
    int i;
    if (!pause) advance(4, 0.004);
    dsSetTexture(DS_WOOD);
    for (i = 0; i < count; i++) {
        dsSetColor(1, 0.85f - 0.05f * (i % 5), 0.6f);
        draw(boxes[i]);
    }
}

int main(int argc, char **argv) { return show(argc, argv, start, step, command); }
