/* A mesh geom: callbacks, caches, last transform, merging of contacts, its triangles in the world. tolerance: 2e-6 since
   libode's meshes are single precision. */
#include "check.h"

static const float v[] = {-2, -2, 0, 2, -2, 0, 2, 2, 0.5f, -2, 2, 0};
static const unsigned t[] = {0, 1, 2, 0, 2, 3};
static int one, many, rays, refuse;
static int each(dGeomID m, dGeomID o, int i) { (void)m, (void)o; one++; return i != refuse; }
static void all(dGeomID m, dGeomID o, const int *i, int n) { (void)m, (void)o, (void)i; many += n; }
static int struck(dGeomID m, dGeomID o, int i, dReal a, dReal b) { (void)m, (void)o, (void)i; rays += a >= 0 && b >= 0; return 0; }
static int merge(dGeomID m, int a, int b) { (void)m; return a < b ? a : b; }

int main(void) {
    dInitODE2(0);
    refuse = -1;
    dTriMeshDataID d = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(d, v, 12, 4, t, 6, 12);
    dGeomID g = dCreateTriMesh(0, d, 0, 0, 0), ball = dCreateSphere(0, 0.5), ray = dCreateRay(0, 5);
    dMatrix3 r;
    dRFromAxisAndAngle(r, 0, 0, 1, 0.2);
    dGeomSetRotation(g, r);
    dGeomSetPosition(ball, 0.6, -0.5, 0.3);
    dGeomRaySet(ray, 0.3, -0.4, 2, 0, 0, -1);
    dVector3 a, b, c;
    dGeomTriMeshGetTriangle(g, 1, &a, &b, &c);
    CHECK(dGeomTriMeshGetTriangle, a, 3);
    show("b", b, 3);
    show("c", c, 3);
    dGeomTriMeshGetPoint(g, 1, 0.25, 0.5, a);
    CHECK(dGeomTriMeshGetPoint, a, 3);
    dContactGeom k[8];
    dGeomTriMeshSetCallback(g, each);
    dGeomTriMeshSetArrayCallback(g, all);
    dGeomTriMeshSetRayCallback(g, struck);
    dGeomTriMeshSetTriMergeCallback(g, merge);
    CHECKI(dGeomTriMeshGetCallback, dGeomTriMeshGetCallback(g) == each);
    CHECKI(dGeomTriMeshGetArrayCallback, dGeomTriMeshGetArrayCallback(g) == all);
    CHECKI(dGeomTriMeshGetRayCallback, dGeomTriMeshGetRayCallback(g) == struck);
    CHECKI(dGeomTriMeshGetTriMergeCallback, dGeomTriMeshGetTriMergeCallback(g) == merge);
    showi("touched", dCollide(g, ball, 8, k, sizeof *k) > 0);
    CHECKI(dGeomTriMeshSetCallback, one > 0);
    CHECKI(dGeomTriMeshSetArrayCallback, many > 0);
    showi("struck", dCollide(ray, g, 8, k, sizeof *k));
    CHECKI(dGeomTriMeshSetRayCallback, rays > 0);
    CHECKI(dGeomTriMeshSetTriMergeCallback, dGeomTriMeshGetTriMergeCallback(g) == merge);
    dGeomTriMeshEnableTC(g, dBoxClass, 1);
    CHECKI(dGeomTriMeshEnableTC, dGeomTriMeshIsTCEnabled(g, dBoxClass) * 10 + dGeomTriMeshIsTCEnabled(g, dSphereClass));
    I1(dGeomTriMeshIsTCEnabled, g, dBoxClass);
    dGeomTriMeshClearTCCache(g);
    CHECKI(dGeomTriMeshClearTCCache, dCollide(g, ball, 8, k, sizeof *k) > 0);
    dMatrix4 last;
    for (int i = 0; i < 16; i++) last[i] = 0.5f * i;
    dGeomTriMeshSetLastTransform(g, last);
    CHECK(dGeomTriMeshSetLastTransform, dGeomTriMeshGetLastTransform(g), 12);
    CHECK(dGeomTriMeshGetLastTransform, dGeomTriMeshGetLastTransform(g), 12);
    int mode = dGeomColliderMergeContactsValue_Full, size = sizeof mode;
    I1(dGeomLowLevelControl, g, dGeomColliderControlClass, dGeomColliderSetMergeSphereContactsControlCode, &mode, &size);
    mode = 0;
    I1(dGeomLowLevelControl, g, dGeomColliderControlClass, dGeomColliderGetMergeSphereContactsControlCode, &mode, &size);
    CHECKI(dGeomLowLevelControl, mode);
    dGeomDestroy(g);
    dGeomDestroy(ball);
    dGeomDestroy(ray);
    dGeomTriMeshDataDestroy(d);
    dCloseODE();
    return 0;
}
