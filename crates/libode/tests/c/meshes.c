/* Trimesh data and geoms: builders, preprocessing, buffers, callbacks, rays and balls against a mesh, masses.
   tolerance: 2e-6 (libode computes rays and balls against meshes in single precision) */
#include "check.h"

static float floats[] = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
static unsigned indices[] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                             1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
static int tri_calls, ray_calls, array_calls, veto = -1;
static int on_triangle(dGeomID m, dGeomID o, int t) { (void)m; (void)o; tri_calls++; return t != veto; }
static void on_triangles(dGeomID m, dGeomID o, const int *t, int n) { (void)m; (void)o; (void)t; array_calls += n > 0; }
static int on_ray(dGeomID m, dGeomID o, int t, dReal u, dReal v) {
    (void)m; (void)o; (void)t;
    ray_calls++;
    show1("u", u);
    show1("v", v);
    return 1;
}
static int on_merge(dGeomID m, int a, int b) { (void)m; (void)a; (void)b; return 5; }
static int by_depth(const void *a, const void *b) {
    dReal x = ((dContactGeom *)a)->depth, y = ((dContactGeom *)b)->depth;
    return x < y ? -1 : x > y;
}
static void hits(dGeomID a, dGeomID b, int most) {
    dContactGeom c[32];
    int n = dCollide(a, b, most, c, sizeof c[0]);
    qsort(c, n, sizeof c[0], by_depth);
    showi("hits", n);
    for (int i = 0; i < n; i++) {
        show("pos", c[i].pos, 3);
        show("normal", c[i].normal, 3);
        show("depth", &c[i].depth, 1);
        printf("%d %d\n", c[i].side1, c[i].side2);
    }
}

int main(void) {
    dInitODE2(0);
    dTriMeshDataID d = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(d, floats, 12, 8, indices, 36, 12);
    dsizeint size = 7;
    unsigned char *buffer = 0;
    int length = 7;
    dGeomTriMeshDataGetBuffer(d, &buffer, &length);
    showi("buffer", buffer == 0);
    I1(dGeomTriMeshDataPreprocess, d);
    dGeomTriMeshDataGetBuffer(d, &buffer, &length);
    showi("length", length);
    /* Which triangle of an edge or vertex gets the flag is open. */
    int edges = 0, corners = 0;
    for (int i = 0; i < 12; i++) {
        edges += __builtin_popcount(buffer[i] & 7);
        corners += __builtin_popcount(buffer[i] & 56);
    }
    printf("edges %d corners %d\n", edges, corners);
    showi("flags", dGeomTriMeshDataGet2(d, dTRIMESHDATA_USE_FLAGS, &size) == buffer);
    showi("size", size);
    dGeomID g = dCreateTriMesh(0, d, 0, 0, 0);
    I1(dGeomGetClass, g);
    I1(dGeomTriMeshGetTriangleCount, g);
    showi("data", dGeomTriMeshGetData(g) == d && dGeomTriMeshGetTriMeshDataID(g) == d);
    dMatrix3 r;
    dRFromAxisAndAngle(r, 0, 0, 1, 0.3);
    dGeomSetPosition(g, 0.5, 0, 0);
    dGeomSetRotation(g, r);
    dReal aabb[6];
    dGeomGetAABB(g, aabb);
    show("aabb", aabb, 6);
    dVector3 a, b, c;
    dGeomTriMeshGetTriangle(g, 3, &a, &b, &c);
    show("a", a, 3);
    show("b", b, 3);
    show("c", c, 3);
    dGeomTriMeshGetPoint(g, 3, 0.2, 0.3, a);
    show("point", a, 3);
    dGeomID ray = dCreateRay(0, 10), ball = dCreateSphere(0, 0.5);
    dGeomRaySet(ray, 0.6, 0.1, 5, 0.05, 0.02, -1);
    hits(ray, g, 16);
    dGeomRaySetBackfaceCull(ray, 1);
    hits(ray, g, 16);
    dGeomRaySetBackfaceCull(ray, 0);
    dGeomRaySetClosestHit(ray, 1);
    hits(ray, g, 16);
    dGeomSetPosition(ball, 1.066, -0.139, 1.3);
    hits(ball, g, 1);
    hits(g, ball, 1);
    showi("callbacks", !dGeomTriMeshGetCallback(g) && !dGeomTriMeshGetArrayCallback(g) && !dGeomTriMeshGetRayCallback(g)
                           && !dGeomTriMeshGetTriMergeCallback(g));
    dGeomTriMeshSetCallback(g, on_triangle);
    dGeomTriMeshSetArrayCallback(g, on_triangles);
    dGeomTriMeshSetRayCallback(g, on_ray);
    dGeomTriMeshSetTriMergeCallback(g, on_merge);
    showi("callbacks", dGeomTriMeshGetCallback(g) == on_triangle && dGeomTriMeshGetArrayCallback(g) == on_triangles
                           && dGeomTriMeshGetRayCallback(g) == on_ray && dGeomTriMeshGetTriMergeCallback(g) == on_merge);
    hits(ray, g, 1);
    showi("called", tri_calls > 0 && ray_calls > 0);
    hits(ball, g, 1);
    showi("called", array_calls > 0);
    dGeomTriMeshSetCallback(g, 0);
    dGeomTriMeshSetArrayCallback(g, 0);
    dGeomTriMeshSetRayCallback(g, 0);

    I1(dGeomTriMeshIsTCEnabled, g, dSphereClass);
    dGeomTriMeshEnableTC(g, dSphereClass, 1);
    I1(dGeomTriMeshIsTCEnabled, g, dSphereClass);
    I1(dGeomTriMeshIsTCEnabled, g, dBoxClass);
    dGeomTriMeshEnableTC(g, dSphereClass, 0);
    dGeomTriMeshClearTCCache(g);
    dMatrix4 t;
    for (int i = 0; i < 16; i++) t[i] = i;
    dGeomTriMeshSetLastTransform(g, t);
    show("last", dGeomTriMeshGetLastTransform(g), 12);
    int mode = 3, bytes = sizeof mode;
    showi("control", dGeomLowLevelControl(g, dGeomColliderControlClass, dGeomColliderSetMergeSphereContactsControlCode, &mode, &bytes));
    mode = 0;
    showi("control", dGeomLowLevelControl(g, dGeomColliderControlClass, dGeomColliderGetMergeSphereContactsControlCode, &mode, &bytes));
    showi("mode", mode);

    dMass m;
    dGeomSetPosition(g, 0, 0, 0);
    dMassSetTrimesh(&m, 2, g);
    show("mass", &m.mass, 1);
    show("c", m.c, 3);
    show("I", m.I, 12);
    dMassSetTrimeshTotal(&m, 2, g);
    show("mass", &m.mass, 1);
    show("I", m.I, 12);

    static double doubles[24];
    static dReal padded[32];
    for (int i = 0; i < 24; i++) doubles[i] = floats[i], padded[i / 3 * 4 + i % 3] = floats[i];
    static dReal normals[36];
    dGeomTriMeshDataDestroy(d);
    d = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle1(d, floats, 12, 8, indices, 36, 12, normals);
    showi("normals", dGeomTriMeshDataGet2(d, dTRIMESHDATA_FACE_NORMALS, 0) == normals);
    dGeomTriMeshSetData(g, d);
    hits(ray, g, 1);
    dGeomTriMeshDataBuildDouble(d, doubles, 24, 8, indices, 36, 12);
    dGeomTriMeshSetData(g, d);
    hits(ray, g, 1);
    for (int i = 2; i < 24; i += 3) doubles[i] *= 0.5;
    dGeomTriMeshDataUpdate(d);
    hits(ray, g, 1);
    dGeomTriMeshDataBuildDouble1(d, doubles, 24, 8, indices, 36, 12, normals);
    dGeomTriMeshSetData(g, d);
    hits(ray, g, 1);
    dGeomTriMeshDataBuildSimple(d, padded, 8, indices, 36);
    dGeomTriMeshSetData(g, d);
    hits(ray, g, 1);
    dGeomTriMeshDataBuildSimple1(d, padded, 8, indices, 36, (int *)normals);
    dGeomTriMeshSetData(g, d);
    hits(ray, g, 1);
    unsigned char own[12] = {0};
    dGeomTriMeshDataSetBuffer(d, own);
    dGeomTriMeshDataGetBuffer(d, &buffer, &length);
    showi("own", buffer == own);
    dGeomTriMeshDataSet(d, dTRIMESHDATA_FACE_NORMALS, normals);
    showi("normals", dGeomTriMeshDataGet2(d, dTRIMESHDATA_FACE_NORMALS, 0) == normals);
    dTriMeshDataID e = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(e, floats, 12, 8, indices, 36, 12);
    dintptr extra[dTRIDATAPREPROCESS_BUILD__MAX] = {0, 0};
    showi("preprocess", dGeomTriMeshDataPreprocess2(e, (1u << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES) | 1, extra));
    dGeomDestroy(g);
    dGeomDestroy(ray);
    dGeomDestroy(ball);
    dGeomTriMeshDataDestroy(d);
    dGeomTriMeshDataDestroy(e);
    dCloseODE();
    return 0;
}
