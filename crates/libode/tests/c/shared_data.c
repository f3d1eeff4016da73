/* tolerance: 1e-6 since libode's meshes are single precision.
   Eight threads that collide at once: each its own geoms, over one mesh's and one heightfield's data; and with one static
   mesh that they all look at. libode keeps one cache of collisions for all threads: on it they run one after the other. */
#include "check.h"
#include <pthread.h>

enum { SIDE = 12, THREADS = 8 };
static float vertices[SIDE * SIDE][3];
static unsigned indices[2 * (SIDE - 1) * (SIDE - 1)][3];
static float heights[SIDE * SIDE];
static dTriMeshDataID mesh_data;
static dHeightfieldDataID field_data;
static dGeomID ground;

typedef struct { int number, contacts; dReal deepest; } result;

static void *work(void *at) {
    result *r = at;
    dAllocateODEDataForThread(dAllocateMaskAll);
    dGeomID mesh = dCreateTriMesh(0, mesh_data, 0, 0, 0), field = dCreateHeightfield(0, field_data, 1);
    dGeomID ball = dCreateSphere(0, 0.6), box = dCreateBox(0, 0.5, 0.4, 0.6);
    for (int i = 0; i < 40; i++) {
        /* Off the edges of triangles and cells, where the last digit would decide. */
        double x = 0.1 * i - 1.987, y = 0.2 * r->number - 0.783;
        dGeomID others[2] = {ball, box}, grounds[3] = {mesh, ground, field};
        for (int k = 0; k < 2; k++)
            for (int g = 0; g < 3; g++) {
                if (g < 2) dGeomSetPosition(others[k], x, y, 0.37);
                else dGeomSetPosition(others[k], x, 0.37, y);
                dContactGeom c[16];
                int n = dCollide(others[k], grounds[g], 16, c, sizeof *c);
                r->contacts += n > 0;
                for (int j = 0; j < n; j++)
                    if (g == 1 && k == 0 && c[j].depth > r->deepest) r->deepest = c[j].depth;
            }
    }
    dGeomDestroy(mesh);
    dGeomDestroy(field);
    dGeomDestroy(ball);
    dGeomDestroy(box);
    dCleanupODEAllDataForThread();
    return 0;
}

int main(void) {
    dInitODE2(0);
    int t = 0;
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) {
            float *v = vertices[i * SIDE + j];
            v[0] = 0.5f * (i - SIDE / 2), v[1] = 0.5f * (j - SIDE / 2), v[2] = 0.02f * ((i * 7 + j * 5) % 6);
            heights[i + j * SIDE] = v[2];
        }
    for (int i = 0; i + 1 < SIDE; i++)
        for (int j = 0; j + 1 < SIDE; j++) {
            unsigned a = i * SIDE + j, b = a + SIDE;
            indices[t][0] = a, indices[t][1] = b, indices[t++][2] = b + 1;
            indices[t][0] = a, indices[t][1] = b + 1, indices[t++][2] = a + 1;
        }
    mesh_data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(mesh_data, vertices, sizeof vertices[0], SIDE * SIDE, indices, 3 * t, sizeof indices[0]);
    dGeomTriMeshDataPreprocess2(mesh_data, 3, 0);
    field_data = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildSingle(field_data, heights, 0, 5.5, 5.5, SIDE, SIDE, 1, 0, 1, 0);
    ground = dCreateTriMesh(0, mesh_data, 0, 0, 0);
    pthread_t threads[THREADS];
    result results[THREADS];
    memset(results, 0, sizeof results);
    int at_once = getenv("LD_LIBRARY_PATH") != 0;
    for (int i = 0; i < THREADS; i++) {
        results[i].number = i;
        pthread_create(&threads[i], 0, work, &results[i]);
        if (!at_once) pthread_join(threads[i], 0);
    }
    for (int i = 0; i < THREADS; i++) {
        if (at_once) pthread_join(threads[i], 0);
        showi("contacts", results[i].contacts);
        show1("deepest", (float)results[i].deepest);
    }
    dGeomDestroy(ground);
    dGeomTriMeshDataDestroy(mesh_data);
    dGeomHeightfieldDataDestroy(field_data);
    dCloseODE();
    return 0;
}
