/* Triangle meshes: data that geoms share, geoms, and callbacks for their triangles. */
#ifndef FERRODE_ODE_COLLISION_TRIMESH_H
#define FERRODE_ODE_COLLISION_TRIMESH_H

#include <ode/common.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dxTriMeshData *dTriMeshDataID;

typedef enum {
    dMTV__MIN = 0,
    dMTV_FIRST = 0,
    dMTV_SECOND = 1,
    dMTV_THIRD = 2,
    dMTV__MAX = 3
} dMeshTriangleVertex;

/* What can be set and asked for beside the arrays: normals, and a byte of use flags a triangle. */
enum {
    dTRIMESHDATA__MIN = 0,
    dTRIMESHDATA_FACE_NORMALS = 0,
    dTRIMESHDATA_USE_FLAGS = 1,
    dTRIMESHDATA__MAX = 2
};
#ifndef TRIMESH_FACE_NORMALS
enum { TRIMESH_FACE_NORMALS = 0 };
#endif

/* Use flags: which edges and corners of a triangle take part. */
enum {
    dMESHDATAUSE_EDGE1 = 0x01,
    dMESHDATAUSE_EDGE2 = 0x02,
    dMESHDATAUSE_EDGE3 = 0x04,
    dMESHDATAUSE_VERTEX1 = 0x08,
    dMESHDATAUSE_VERTEX2 = 0x10,
    dMESHDATAUSE_VERTEX3 = 0x20
};

/* What dGeomTriMeshDataPreprocess2 prepares: bit numbers, and how fine the face angles are kept. */
enum {
    dTRIDATAPREPROCESS_BUILD__MIN = 0,
    dTRIDATAPREPROCESS_BUILD_CONCAVE_EDGES = 0,
    dTRIDATAPREPROCESS_BUILD_FACE_ANGLES = 1,
    dTRIDATAPREPROCESS_BUILD__MAX = 2
};
enum {
    dTRIDATAPREPROCESS_FACE_ANGLES_EXTRA__MIN = 0,
    dTRIDATAPREPROCESS_FACE_ANGLES_EXTRA_BYTE_POSITIVE = 0,
    dTRIDATAPREPROCESS_FACE_ANGLES_EXTRA_BYTE_ALL = 1,
    dTRIDATAPREPROCESS_FACE_ANGLES_EXTRA_WORD_ALL = 2,
    dTRIDATAPREPROCESS_FACE_ANGLES_EXTRA__MAX = 3,
    dTRIDATAPREPROCESS_FACE_ANGLES_EXTRA__DEFAULT = 0
};

/* Whether a triangle takes part; which triangles came into question; whether a ray's hit counts, at corner0 * (1 - u - v) +
   corner1 * u + corner2 * v; which triangle a merged contact names. */
typedef int dTriCallback(dGeomID mesh, dGeomID other, int triangle);
typedef void dTriArrayCallback(dGeomID mesh, dGeomID other, const int *triangles, int count);
typedef int dTriRayCallback(dGeomID mesh, dGeomID ray, int triangle, dReal u, dReal v);
typedef int dTriTriMergeCallback(dGeomID mesh, int first_triangle, int second_triangle);

/* Data. The arrays stay the program's and have to last as long as the data; strides are in bytes, index counts are
   three a triangle. dGeomTriMeshDataBuildSimple takes dVector3 and dTriIndex. */
ODE_API void dGeomTriMeshDataBuildDouble(dTriMeshDataID data, const void *vertices, int vertex_stride, int
        vertex_count, const void *indices, int index_count, int triangle_stride);
ODE_API void dGeomTriMeshDataBuildDouble1(dTriMeshDataID data, const void *vertices, int vertex_stride, int
        vertex_count, const void *indices, int index_count, int triangle_stride, const void *normals);
ODE_API void dGeomTriMeshDataBuildSimple(dTriMeshDataID data, const dReal *vertices, int vertex_count, const
        dTriIndex *indices, int index_count);
ODE_API void dGeomTriMeshDataBuildSimple1(dTriMeshDataID data, const dReal *vertices, int vertex_count, const
        dTriIndex *indices, int index_count, const int *normals);
ODE_API void dGeomTriMeshDataBuildSingle(dTriMeshDataID data, const void *vertices, int vertex_stride, int
        vertex_count, const void *indices, int index_count, int triangle_stride);
ODE_API void dGeomTriMeshDataBuildSingle1(dTriMeshDataID data, const void *vertices, int vertex_stride, int
        vertex_count, const void *indices, int index_count, int triangle_stride, const void *normals);
ODE_API dTriMeshDataID dGeomTriMeshDataCreate(void);
ODE_API void dGeomTriMeshDataDestroy(dTriMeshDataID data);

/* Says that the vertices have changed; prepares edges; sets and gets normals and use flags. */
ODE_API void *dGeomTriMeshDataGet2(dTriMeshDataID data, int which, dsizeint *size);
ODE_API ODE_API_DEPRECATED void dGeomTriMeshDataGetBuffer(dTriMeshDataID data, unsigned char **buffer, int *length);
ODE_API int dGeomTriMeshDataPreprocess(dTriMeshDataID data);
ODE_API int dGeomTriMeshDataPreprocess2(dTriMeshDataID data, unsigned int requests, const dintptr *extra);
ODE_API void dGeomTriMeshDataSet(dTriMeshDataID data, int which, void *content);
ODE_API ODE_API_DEPRECATED void dGeomTriMeshDataSetBuffer(dTriMeshDataID data, unsigned char *buffer);
ODE_API void dGeomTriMeshDataUpdate(dTriMeshDataID data);
ODE_API void *dGeomTriMeshDataGet(dTriMeshDataID data, int which);

/* Geoms and their callbacks. */
ODE_API dGeomID dCreateTriMesh(dSpaceID space, dTriMeshDataID data, dTriCallback *callback, dTriArrayCallback
        *array_callback, dTriRayCallback *ray_callback);
ODE_API dTriArrayCallback *dGeomTriMeshGetArrayCallback(dGeomID geom);
ODE_API dTriCallback *dGeomTriMeshGetCallback(dGeomID geom);
ODE_API dTriRayCallback *dGeomTriMeshGetRayCallback(dGeomID geom);
ODE_API dTriTriMergeCallback *dGeomTriMeshGetTriMergeCallback(dGeomID geom);
ODE_API void dGeomTriMeshSetArrayCallback(dGeomID geom, dTriArrayCallback *array_callback);
ODE_API void dGeomTriMeshSetCallback(dGeomID geom, dTriCallback *callback);
ODE_API void dGeomTriMeshSetRayCallback(dGeomID geom, dTriRayCallback *callback);
ODE_API void dGeomTriMeshSetTriMergeCallback(dGeomID geom, dTriTriMergeCallback *callback);
ODE_API dTriMeshDataID dGeomTriMeshGetData(dGeomID geom);
ODE_API dTriMeshDataID dGeomTriMeshGetTriMeshDataID(dGeomID geom);
ODE_API void dGeomTriMeshSetData(dGeomID geom, dTriMeshDataID data);

/* Where the mesh was a step ago (4 x 4, row by row), and remembered contacts. */
ODE_API const dReal *dGeomTriMeshGetLastTransform(dGeomID geom);
ODE_API void dGeomTriMeshSetLastTransform(dGeomID geom, const dMatrix4 transform);
ODE_API void dGeomTriMeshClearTCCache(dGeomID geom);
ODE_API void dGeomTriMeshEnableTC(dGeomID geom, int geom_class, int enable);
ODE_API int dGeomTriMeshIsTCEnabled(dGeomID geom, int geom_class);

/* Triangles in world coordinates. */
ODE_API void dGeomTriMeshGetPoint(dGeomID geom, int index, dReal u, dReal v, dVector3 out);
ODE_API void dGeomTriMeshGetTriangle(dGeomID geom, int index, dVector3 *v0, dVector3 *v1, dVector3 *v2);
ODE_API int dGeomTriMeshGetTriangleCount(dGeomID geom);

#ifdef __cplusplus
}
#endif

#endif
