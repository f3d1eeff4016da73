/* Arrays stay the program's: samples of a heightfield, a function's heights, corners of a polyhedron and of a mesh change
   in place. tolerance: 2e-6 since libode's meshes are single precision. */
#include "check.h"

static double lift;
static dReal height(void *user, int x, int z) {
    return lift + 0.1 * x - 0.05 * z + (user ? *(double *)user : 0);
}

static void touch(const char *name, dGeomID a, dGeomID b) {
    dContactGeom c[16];
    int n = dCollide(a, b, 16, c, sizeof *c);
    showi(name, n);
    dReal depth = 0;
    for (int i = 0; i < n; i++)
        if (c[i].depth > depth) depth = c[i].depth;
    if (n) show1("deepest", depth);
}

static void fields(void) {
    dGeomID ball = dCreateSphere(0, 0.5);
    dGeomSetPosition(ball, 0.3, 0.4, 0.3);
    dReal box[6];
    double doubles[25] = {0};
    float singles[25] = {0};
    short shorts[25] = {0};
    unsigned char bytes[25] = {0};
    for (int copy = 0; copy < 2; copy++) {
        for (int kind = 0; kind < 4; kind++) {
            dHeightfieldDataID data = dGeomHeightfieldDataCreate();
            for (int i = 0; i < 25; i++) doubles[i] = singles[i] = shorts[i] = bytes[i] = 0;
            if (kind == 0) dGeomHeightfieldDataBuildDouble(data, doubles, copy, 4, 4, 5, 5, 0.1, 0, 1, 0);
            if (kind == 1) dGeomHeightfieldDataBuildSingle(data, singles, copy, 4, 4, 5, 5, 0.1, 0, 1, 0);
            if (kind == 2) dGeomHeightfieldDataBuildShort(data, shorts, copy, 4, 4, 5, 5, 0.1, 0, 1, 0);
            if (kind == 3) dGeomHeightfieldDataBuildByte(data, bytes, copy, 4, 4, 5, 5, 0.1, 0, 1, 0);
            dGeomID field = dCreateHeightfield(0, data, 1);
            touch("flat", field, ball);
            for (int i = 0; i < 25; i++) doubles[i] = singles[i] = shorts[i] = bytes[i] = 2;
            touch("raised", field, ball);
            doubles[12] = singles[12] = shorts[12] = bytes[12] = 3;
            touch("bent", field, ball);
            for (int i = 0; i < 25; i++) doubles[i] = singles[i] = shorts[i] = bytes[i] = 1;
            dGeomGetAABB(field, box);
            show("box", box, 6);
            touch("lowered", field, ball);
            dGeomDestroy(field);
            dGeomHeightfieldDataDestroy(data);
        }
    }
    /* A function's heights: asked for when they are needed, in a field of ten thousand million samples. */
    double more = 0.25;
    dHeightfieldDataID data = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildCallback(data, &more, height, 100000, 100000, 100001, 100001, 1, -7500, 1, 0);
    dGeomID field = dCreateHeightfield(0, data, 1);
    dGeomSetPosition(ball, 20.3, 0.7, -30.2);
    touch("far", field, ball);
    lift = 0.5;
    touch("lifted", field, ball);
    lift = 0;
    dGeomHeightfieldDataBuildCallback(data, 0, height, 8, 8, 9, 9, 1, 0, 1, 1);
    dGeomSetPosition(ball, 0.3, 0.4, 0.3);
    touch("wrapped", field, ball);
    dGeomSetPosition(ball, 800.3, 0.4, -1600.7);
    touch("wrapped far", field, ball);
    dGeomHeightfieldDataBuildCallback(data, 0, height, 8, 8, 9, 9, 1, 0, 1, 0);
    dGeomID other = dCreateHeightfield(0, data, 1);
    for (int k = 0; k < 3; k++) {
        dMatrix3 r;
        dRFromAxisAndAngle(r, 1, 0, 0, k * 0.7);
        dGeomSetRotation(other, r);
        dGeomSetPosition(other, 1, 2, 3);
        dGeomGetAABB(other, box);
        for (int i = 0; i < 6; i++) showi("endless", isinf(box[i]));
        show("finite", box, 2);
    }
    dGeomHeightfieldDataSetBounds(data, -1, 1);
    dGeomSetPosition(other, 0, 0, 0);
    dGeomDestroy(other);
    dGeomDestroy(field);
    dGeomDestroy(ball);
    dGeomHeightfieldDataDestroy(data);
}

static dReal planes[] = {1, 0, 0, 0.5, 0, 1, 0, 0.5, 0, 0, 1, 0.5, -1, 0, 0, 0.5, 0, -1, 0, 0.5, 0, 0, -1, 0.5};
static dReal corners[24];
static unsigned faces[] = {4, 0, 2, 6, 4, 4, 1, 0, 4, 5, 4, 0, 1, 3, 2, 4, 3, 1, 5, 7, 4, 2, 3, 7, 6, 4, 5, 4, 6, 7};

static void polyhedron(void) {
    for (int i = 0; i < 8; i++) {
        corners[3 * i] = i & 1 ? -0.5 : 0.5;
        corners[3 * i + 1] = i & 2 ? -0.5 : 0.5;
        corners[3 * i + 2] = i & 4 ? -0.5 : 0.5;
    }
    dGeomID convex = dCreateConvex(0, planes, 6, corners, 8, faces);
    dGeomID ground = dCreatePlane(0, 0, 0, 1, 0);
    dGeomSetPosition(convex, 1, 2, 0.4);
    touch("cube", convex, ground);
    for (int i = 0; i < 8; i++) corners[3 * i + 2] *= 2;
    touch("taller", convex, ground);
    for (int i = 0; i < 8; i++) corners[3 * i + 2] *= 0.5;
    touch("as it was", convex, ground);
    dReal box[6];
    dGeomGetAABB(convex, box);
    show("box", box, 6);
    static dReal others[24];
    for (int i = 0; i < 24; i++) others[i] = 1.5 * corners[i];
    dGeomSetConvex(convex, planes, 6, others, 8, faces);
    touch("another", convex, ground);
    dGeomDestroy(convex);
    dGeomDestroy(ground);
}

static void mesh(void) {
    static float vertices[5][3] = {{2, 2, 0}, {-2, 2, 0}, {-2, -2, 0}, {2, -2, 0}, {0, 0, 0}};
    static unsigned indices[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    dTriMeshDataID data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(data, vertices, sizeof vertices[0], 5, indices, 12, 3 * sizeof(unsigned));
    dGeomID first = dCreateTriMesh(0, data, 0, 0, 0), second = dCreateTriMesh(0, data, 0, 0, 0);
    dGeomID ball = dCreateSphere(0, 0.5);
    dGeomSetPosition(ball, 0.5, 0.1, 0.4);
    touch("flat", first, ball);
    for (int i = 0; i < 5; i++) vertices[i][2] = 0.1f;
    dGeomTriMeshDataUpdate(data);
    touch("raised", first, ball);
    touch("raised", second, ball);
    dVector3 a, b, c;
    dGeomTriMeshGetTriangle(second, 2, &a, &b, &c);
    show("corner", a, 3);
    dGeomDestroy(first);
    dGeomTriMeshDataBuildSingle(data, vertices, sizeof vertices[0], 5, indices, 6, 3 * sizeof(unsigned));
    showi("triangles", dGeomTriMeshGetTriangleCount(second));
    dGeomDestroy(second);
    dGeomDestroy(ball);
    dGeomTriMeshDataDestroy(data);
}

int main(void) {
    dInitODE2(0);
    fields();
    polyhedron();
    mesh();
    dCloseODE();
    return 0;
}
