/* tolerance: 2e-6 since libode's meshes are single precision.
   Meshes that move: a mesh on a body with its last transform kept up by the program, vertices that wave with the data updated
   each step, rays and balls as probes, a mesh shared by geoms at several places, data exchanged while geoms live. */
#include "check.h"

enum { SIDE = 10 };
static float vertices[SIDE * SIDE][3], others[5][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1.5f}};
static unsigned indices[2 * (SIDE - 1) * (SIDE - 1)][3], roof[4][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};

static void wave(double t) {
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) {
            float *v = vertices[i * SIDE + j];
            v[0] = 0.4f * i - 1.8f, v[1] = 0.4f * j - 1.8f;
            v[2] = (float)(0.15 * sin(1.3 * i + 2 * t) + 0.1 * sin(0.9 * j - t));
        }
}
static void probe(dGeomID mesh, dGeomID ray, dGeomID ball) {
    for (int i = 0; i < 5; i++) {
        dContactGeom c[32];
        double x = 0.61 * i - 1.27, y = 0.47 * i - 0.93;
        dGeomRaySet(ray, x, y, 4, 0.02, 0.03, -1);
        int n = dCollide(ray, mesh, 1, c, sizeof *c);
        printf("ray %d", n);
        if (n) printf(" %.9g %.9g %.9g  %.9g  %d", (double)c[0].pos[0], (double)c[0].pos[1], (double)c[0].pos[2], (double)c[0].depth, c[0].side2);
        printf("\n");
        dGeomSetPosition(ball, x, y, 0.5);
        dReal deepest = 0;
        n = dCollide(ball, mesh, 32, c, sizeof *c);
        for (int k = 0; k < n; k++)
            if (c[k].depth > deepest) deepest = c[k].depth;
        show1("ball", deepest);
    }
}

int main(void) {
    dInitODE2(0);
    int t = 0;
    for (int i = 0; i + 1 < SIDE; i++)
        for (int j = 0; j + 1 < SIDE; j++) {
            unsigned a = i * SIDE + j, b = a + SIDE;
            indices[t][0] = a, indices[t][1] = b, indices[t++][2] = b + 1;
            indices[t][0] = a, indices[t][1] = b + 1, indices[t++][2] = a + 1;
        }
    wave(0);
    dTriMeshDataID sea = dGeomTriMeshDataCreate(), house = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(sea, vertices, sizeof vertices[0], SIDE * SIDE, indices, 3 * t, sizeof indices[0]);
    dGeomTriMeshDataBuildSingle(house, others, sizeof others[0], 5, roof, 12, sizeof roof[0]);
    dSpaceID space = dHashSpaceCreate(0);
    dGeomID mesh = dCreateTriMesh(space, sea, 0, 0, 0), ray = dCreateRay(0, 10), ball = dCreateSphere(0, 0.45);
    dWorldID w = dWorldCreate();
    dBodyID body = dBodyCreate(w);
    dBodySetLinearVel(body, 0.1, 0, 0.2);
    dBodySetAngularVel(body, 0, 0.1, 0.4);
    dGeomSetBody(mesh, body);
    for (int step = 0; step < 6; step++) {
        /* As the manual asks of programs that move meshes. */
        const dReal *p = dGeomGetPosition(mesh), *r = dGeomGetRotation(mesh);
        dReal last[16] = {r[0], r[4], r[8], 0, r[1], r[5], r[9], 0, r[2], r[6], r[10], 0, p[0], p[1], p[2], 1};
        dGeomTriMeshSetLastTransform(mesh, last);
        dWorldStep(w, 0.05);
        wave(0.3 * step);
        dGeomTriMeshDataUpdate(sea);
        show("last", dGeomTriMeshGetLastTransform(mesh), 12);
        /* libode goes on with the box of the mesh as it was built. */
        dReal aabb[6];
        dGeomGetAABB(mesh, aabb);
        if (!step) show("box", aabb, 6);
        dVector3 v0, v1, v2;
        dGeomTriMeshGetTriangle(mesh, 17 * step, &v0, &v1, &v2);
        show("corner", v1, 3);
        probe(mesh, ray, ball);
    }
    /* The same data at other places. */
    dGeomID copies[3];
    for (int i = 0; i < 3; i++) {
        dMatrix3 r;
        copies[i] = dCreateTriMesh(space, i == 2 ? house : sea, 0, 0, 0);
        dRFromAxisAndAngle(r, 0, 0, 1, 0.5 * i);
        dGeomSetRotation(copies[i], r);
        dGeomSetPosition(copies[i], 0.2 * i, 0, 0.1 * i);
        probe(copies[i], ray, ball);
    }
    dGeomTriMeshSetData(copies[0], house);
    probe(copies[0], ray, ball);
    others[4][2] = 0.8f;
    dGeomTriMeshDataUpdate(house);
    probe(copies[0], ray, ball);
    probe(copies[2], ray, ball);
    showi("triangles", dGeomTriMeshGetTriangleCount(copies[0]));
    /* Built anew, with fewer triangles. */
    dGeomTriMeshDataBuildSingle(house, others, sizeof others[0], 5, roof, 6, sizeof roof[0]);
    dGeomTriMeshSetData(copies[0], house);
    probe(copies[0], ray, ball);
    showi("triangles", dGeomTriMeshGetTriangleCount(copies[0]));
    dSpaceDestroy(space);
    dGeomDestroy(ray);
    dGeomDestroy(ball);
    dGeomTriMeshDataDestroy(sea);
    dGeomTriMeshDataDestroy(house);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}
