/* Every way to give a mesh its triangles, and what is asked of data and geom. tolerance: 2e-6 since libode's meshes are single
   precision. */
#include "check.h"

static float floats[] = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
static unsigned indices[] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                             1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
static double doubles[24];
static dReal padded[32], normals[36];
static float single_normals[36];
static double double_normals[36];
static dGeomID mesh, ray;
static const dReal *hit(void) {
    static dReal x[4];
    dContactGeom c;
    memset(&c, 0, sizeof c);
    x[3] = dCollide(ray, mesh, 1, &c, sizeof c);
    memcpy(x, c.pos, 3 * sizeof *x);
    return x;
}
static void scale(dReal s) {
    for (int i = 0; i < 24; i++) doubles[i] = floats[i] * s, padded[i / 3 * 4 + i % 3] = floats[i] * s;
}

int main(void) {
    dInitODE2(0);
    dTriMeshDataID d = dGeomTriMeshDataCreate();
    CHECKI(dGeomTriMeshDataCreate, d != 0);
    dGeomTriMeshDataBuildSingle(d, floats, 12, 8, indices, 36, 12);
    mesh = dCreateTriMesh(0, d, 0, 0, 0);
    CHECKI(dCreateTriMesh, dGeomGetClass(mesh));
    CHECKI(dGeomTriMeshGetData, dGeomTriMeshGetData(mesh) == d);
    CHECKI(dGeomTriMeshGetTriMeshDataID, dGeomTriMeshGetTriMeshDataID(mesh) == d);
    I1(dGeomTriMeshGetTriangleCount, mesh);
    ray = dCreateRay(0, 10);
    dGeomRaySet(ray, 0.2, 0.1, 5, 0.05, 0.02, -1);
    CHECK(dGeomTriMeshDataBuildSingle, hit(), 4);
    dTriMeshDataID e = dGeomTriMeshDataCreate();
    scale(0.5);
    dGeomTriMeshDataBuildDouble(e, doubles, 24, 8, indices, 36, 12);
    dGeomTriMeshSetData(mesh, e);
    CHECK(dGeomTriMeshSetData, hit(), 4);
    CHECK(dGeomTriMeshDataBuildDouble, hit(), 4);
    /* Moved from under the ray, which follows. */
    for (int i = 0; i < 24; i += 3) doubles[i] += 5;
    dGeomRaySet(ray, 5.2, 0.1, 5, 0.05, 0.02, -1);
    dGeomTriMeshDataUpdate(e);
    CHECK(dGeomTriMeshDataUpdate, hit(), 4);
    scale(0.75);
    dGeomRaySet(ray, 0.2, 0.1, 5, 0.05, 0.02, -1);
    dTriMeshDataID f = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSimple(f, padded, 8, indices, 36);
    dGeomTriMeshSetData(mesh, f);
    CHECK(dGeomTriMeshDataBuildSimple, hit(), 4);
    dTriMeshDataID g = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle1(g, floats, 12, 8, indices, 36, 12, single_normals);
    CHECKI(dGeomTriMeshDataBuildSingle1, dGeomTriMeshDataGet2(g, dTRIMESHDATA_FACE_NORMALS, 0) == (void *)single_normals);
    dTriMeshDataID h = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble1(h, doubles, 24, 8, indices, 36, 12, double_normals);
    CHECKI(dGeomTriMeshDataBuildDouble1, dGeomTriMeshDataGet2(h, dTRIMESHDATA_FACE_NORMALS, 0) == (void *)double_normals);
    dTriMeshDataID k = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSimple1(k, padded, 8, indices, 36, (const int *)normals);
    CHECKI(dGeomTriMeshDataBuildSimple1, dGeomTriMeshDataGet2(k, dTRIMESHDATA_FACE_NORMALS, 0) == (void *)normals);
    dGeomTriMeshDataSet(d, dTRIMESHDATA_FACE_NORMALS, single_normals);
    CHECKI(dGeomTriMeshDataSet, dGeomTriMeshDataGet2(d, dTRIMESHDATA_FACE_NORMALS, 0) == (void *)single_normals);
    dGeomTriMeshDataSet(d, dTRIMESHDATA_FACE_NORMALS, 0);
    I1(dGeomTriMeshDataPreprocess, d);
    unsigned char *flags = 0, own[12] = {0};
    int length = -1;
    dGeomTriMeshDataGetBuffer(d, &flags, &length);
    CHECKI(dGeomTriMeshDataGetBuffer, flags != 0 && length == 12);
    CHECKI(dGeomTriMeshDataPreprocess, flags != 0);
    dsizeint size = 0;
    CHECKI(dGeomTriMeshDataGet2, dGeomTriMeshDataGet2(d, dTRIMESHDATA_USE_FLAGS, &size) == (void *)flags && size == 12);
    dGeomTriMeshDataSetBuffer(k, own);
    dGeomTriMeshDataGetBuffer(k, &flags, &length);
    CHECKI(dGeomTriMeshDataSetBuffer, flags == own);
    I1(dGeomTriMeshDataPreprocess2, f, (1u << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES) | (1u << dTRIDATAPREPROCESS_BUILD_CONCAVE_EDGES), 0);
    dGeomTriMeshDataGetBuffer(f, &flags, &length);
    CHECKI(dGeomTriMeshDataPreprocess2, flags != 0 && length == 12);
    dGeomDestroy(mesh);
    dGeomDestroy(ray);
    dTriMeshDataID all[] = {d, e, f, g, h, k};
    for (int i = 0; i < 6; i++) dGeomTriMeshDataDestroy(all[i]);
    dCloseODE();
    return 0;
}
