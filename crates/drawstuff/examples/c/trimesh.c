/* Balls run down a spiral slide, a triangle mesh, drawn triangle by triangle.
   (compared: 18 frames, for libode counts in single precision in meshes) */
#include "demo.h"

enum { TURN = 48, CORNERS = 3 * (TURN + 1), TRIANGLES = 4 * TURN, BALLS = 8 };
static double corners[CORNERS][3];
static dTriIndex indices[TRIANGLES][3];
static dGeomID slide, balls[BALLS];

static void start(void) {
    dTriMeshDataID data;
    int i, k;
    make_world();
    for (i = 0; i <= TURN; i++) {
        double angle = 2.5 * M_PI * i / TURN, height = 2.8 - 2.5 * i / TURN;
        for (k = 0; k < 3; k++) {
            double r = 0.8 + 0.45 * k;
            corners[3 * i + k][0] = r * cos(angle);
            corners[3 * i + k][1] = r * sin(angle);
            corners[3 * i + k][2] = height + (k == 1 ? -0.1 : k == 2 ? 0.4 : 0.1);
        }
    }
    for (i = 0; i < TURN; i++)
        for (k = 0; k < 2; k++) {
            dTriIndex a = 3 * i + k, quad[6] = {a, a + 1, a + 3, a + 3, a + 1, a + 4};
            memcpy(indices[4 * i + 2 * k], quad, sizeof quad);
        }
    data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(data, corners, 3 * sizeof(double), CORNERS, indices, 3 * TRIANGLES, 3 * sizeof(dTriIndex));
    slide = dCreateTriMesh(space, data, 0, 0, 0);
    for (i = 0; i < BALLS; i++) {
        balls[i] = dCreateSphere(space, 0.14);
        give_body(balls[i], 500, 1.25, 0.1 + 0.02 * i, 3.1 + 0.35 * i);
    }
    view(3.6f, -3.4f, 3.4f, 136, -26);
}

static void step(int pause) {
    int i;
    if (!pause) advance(4, 0.004);
    dsSetColor(0.95f, 0.75f, 0.25f);
    for (i = 0; i < TRIANGLES; i++) {
        const dTriIndex *t = indices[i];
        dsDrawTriangleD(dGeomGetPosition(slide), dGeomGetRotation(slide), corners[t[0]], corners[t[1]], corners[t[2]], 1);
    }
    dsSetTexture(DS_CHECKERED);
    for (i = 0; i < BALLS; i++) {
        dsSetColor(0.3f, 0.5f, 0.5f + 0.05f * i);
        draw(balls[i]);
    }
}

int main(int argc, char **argv) { return show(argc, argv, start, step, 0); }
