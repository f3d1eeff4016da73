/* What a mesh's callbacks are asked, and what their answers lead to. tolerance: 2e-6 since libode's meshes are single
   precision. */
#include "check.h"

static int asked[512], asked_count, all[512], all_count, merges, ray_asks;
static int by_number(const void *a, const void *b) { return *(const int *)a - *(const int *)b; }
static int answer(int t) { return t % 3 != 0; }
static int keep_all;
static int one(dGeomID mesh, dGeomID other, int t) {
    (void)mesh, (void)other;
    asked[asked_count++] = t;
    return keep_all || answer(t);
}
static void every(dGeomID mesh, dGeomID other, const int *t, int n) {
    (void)mesh, (void)other;
    for (all_count = 0; all_count < n; all_count++) all[all_count] = t[all_count];
}
static int hit(dGeomID mesh, dGeomID ray, int t, dReal u, dReal v) {
    (void)mesh, (void)ray;
    ray_asks++;
    return t >= 0 && u >= -1e-4 && v >= -1e-4 && u + v <= 1.0001;
}
static int merged(dGeomID mesh, int first, int second) {
    (void)mesh, (void)first, (void)second;
    merges++;
    return 77;
}

static int by_place(const void *a, const void *b) {
    const dContactGeom *x = a, *y = b;
    int s = 0;
    for (int i = 0; i < 3 && !s; i++) {
        double d = x->pos[i] - y->pos[i];
        s = d > 1e-5 ? 1 : d < -1e-5 ? -1 : 0;
    }
    return s ? s : x->side1 - y->side1;
}

static float v[17 * 17][3];
static unsigned indices[512][3];

static void numbers(const char *name, int *x, int n) {
    qsort(x, n, sizeof *x, by_number);
    printf("%s", name);
    for (int i = 0; i < n; i++) printf(" %d", x[i]);
    printf("\n");
}

int main(void) {
    dInitODE2(0);
    unsigned seed = 3;
    int k = 0;
    for (int i = 0; i < 17; i++)
        for (int j = 0; j < 17; j++) {
            seed = seed * 1664525 + 1013904223;
            float *p = v[i * 17 + j];
            p[0] = 0.25f * (i - 8), p[1] = 0.25f * (j - 8), p[2] = 0.3f * (seed >> 16) / 65536;
        }
    for (int i = 0; i < 16; i++)
        for (int j = 0; j < 16; j++) {
            unsigned a = i * 17 + j, b = a + 17, c = a + 1, d = b + 1;
            indices[k][0] = a, indices[k][1] = b, indices[k++][2] = d;
            indices[k][0] = a, indices[k][1] = d, indices[k++][2] = c;
        }
    dTriMeshDataID data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(data, v, sizeof v[0], 17 * 17, indices, 3 * k, sizeof indices[0]);
    dGeomID mesh = dCreateTriMesh(0, data, one, every, hit);
    dGeomTriMeshSetTriMergeCallback(mesh, merged);
    for (int t = 0; t < 60; t++) {
        dGeomID g;
        if (t % 5 == 0) g = dCreateSphere(0, 0.4);
        else if (t % 5 == 1) g = dCreateBox(0, 0.5, 0.3, 0.7);
        else if (t % 5 == 2) g = dCreateCapsule(0, 0.2, 0.6);
        else if (t % 5 == 3) g = dCreateCylinder(0, 0.3, 0.5);
        else g = dCreateRay(0, 5);
        double r[8];
        for (int i = 0; i < 8; i++) {
            seed = seed * 1664525 + 1013904223;
            r[i] = (seed >> 16) / 65536.0;
        }
        double x = 3 * r[0] - 1.5, y = 3 * r[1] - 1.5, z = 0.2 + 0.4 * r[2];
        if (t % 5 == 4) dGeomRaySet(g, x, y, 1, 0.6 * r[3], 0.2, -1);
        else {
            dMatrix3 m;
            dRFromAxisAndAngle(m, r[3], r[4], 0.2, 6 * r[5]);
            dGeomSetRotation(g, m);
            dGeomSetPosition(g, x, y, z);
        }
        keep_all = t % 2;
        asked_count = all_count = merges = ray_asks = 0;
        dContactGeom c[128];
        int n = dCollide(mesh, g, 128, c, sizeof *c);
        /* About a ball libode asks for some triangles whose neighbours it may touch, too. */
        if (t % 5) {
            numbers("all", all, all_count);
            numbers("asked", asked, asked_count);
        } else {
            showi("alike", all_count == asked_count);
        }
        showi("hits", ray_asks);
        if (t % 5 == 0 || t % 5 == 4) {
            qsort(c, n, sizeof *c, by_place);
            for (int i = 0; i < n; i++) {
                show("position", c[i].pos, 3);
                show("normal", c[i].normal, 3);
                show1("depth", c[i].depth);
                showi("triangle", c[i].side1);
            }
        }
        if (t % 5 == 0)
            for (int mode = 1; mode <= 3; mode++) {
                int size = sizeof mode;
                dGeomLowLevelControl(mesh, dGeomColliderControlClass, dGeomColliderSetMergeSphereContactsControlCode,
                    &mode, &size);
                merges = 0;
                n = dCollide(mesh, g, 128, c, sizeof *c);
                showi("merged to", n);
                showi("asked to merge", merges);
                qsort(c, n, sizeof *c, by_place);
                for (int i = 0; i < n; i++) {
                    show("position", c[i].pos, 3);
                    show("normal", c[i].normal, 3);
                    show1("depth", c[i].depth);
                    showi("triangle", c[i].side1);
                }
                if (mode == 3) {
                    mode = 0;
                    dGeomLowLevelControl(mesh, dGeomColliderControlClass,
                        dGeomColliderSetMergeSphereContactsControlCode, &mode, &size);
                    mode = 3;
                }
            }
        dGeomDestroy(g);
    }
    dGeomDestroy(mesh);
    dGeomTriMeshDataDestroy(data);
    dCloseODE();
    return 0;
}
