/* Geoms: shapes, where they are, and where they touch. */
#ifndef FERRODE_ODE_COLLISION_H
#define FERRODE_ODE_COLLISION_H

#include <ode/common.h>
#include <ode/collision_space.h>
#include <ode/collision_trimesh.h>
#include <ode/contact.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Classes of geoms. A program can add dMaxUserClasses of its own. */
enum { dMaxUserClasses = 4 };
enum {
    dSphereClass = 0,
    dBoxClass = 1,
    dCapsuleClass = 2,
    dCylinderClass = 3,
    dPlaneClass = 4,
    dRayClass = 5,
    dConvexClass = 6,
    dGeomTransformClass = 7,
    dTriMeshClass = 8,
    dHeightfieldClass = 9,
    dFirstSpaceClass = 10,
    dSimpleSpaceClass = 10,
    dHashSpaceClass = 11,
    dSweepAndPruneSpaceClass = 12,
    dQuadTreeSpaceClass = 13,
    dLastSpaceClass = 13,
    dFirstUserClass = 14,
    dLastUserClass = 17,
    dGeomNumClasses = 18
};

/* Controls of dGeomLowLevelControl. */
enum {
    dGeomCommonControlClass = 0,
    dGeomColliderControlClass = 1
};
enum {
    dGeomCommonAnyControlCode = 0,
    dGeomColliderSetMergeSphereContactsControlCode = 1,
    dGeomColliderGetMergeSphereContactsControlCode = 2
};
enum {
    dGeomColliderMergeContactsValue__Default = 0,
    dGeomColliderMergeContactsValue_None = 1,
    dGeomColliderMergeContactsValue_Normals = 2,
    dGeomColliderMergeContactsValue_Full = 3
};

/* A flag of dCollide beside the greatest number of contacts (the low 16 bits): any contacts will do. */
#define CONTACTS_UNIMPORTANT 0x80000000

/* All geoms. */
ODE_API void dGeomDestroy(dGeomID geom);
ODE_API void dGeomDisable(dGeomID geom);
ODE_API void dGeomEnable(dGeomID geom);
ODE_API void dGeomGetAABB(dGeomID geom, dReal aabb[6]);
ODE_API dBodyID dGeomGetBody(dGeomID geom);
ODE_API unsigned long dGeomGetCategoryBits(dGeomID geom);
ODE_API int dGeomGetClass(dGeomID geom);
ODE_API unsigned long dGeomGetCollideBits(dGeomID geom);
ODE_API void *dGeomGetData(dGeomID geom);
ODE_API dSpaceID dGeomGetSpace(dGeomID geom);
ODE_API int dGeomIsEnabled(dGeomID geom);
ODE_API int dGeomIsSpace(dGeomID geom);
ODE_API int dGeomLowLevelControl(dGeomID geom, int control_class, int control_code, void *value, int *size);
ODE_API void dGeomSetBody(dGeomID geom, dBodyID body);
ODE_API void dGeomSetCategoryBits(dGeomID geom, unsigned long bits);
ODE_API void dGeomSetCollideBits(dGeomID geom, unsigned long bits);
ODE_API void dGeomSetData(dGeomID geom, void *data);
ODE_API void dInfiniteAABB(dGeomID geom, dReal aabb[6]);

/* Poses. A geom on a body is where the body is: setting one moves the body. Getters that return pointers return
   storage that stays, of 4 or 12 numbers. */
ODE_API void dGeomCopyPosition(dGeomID geom, dVector3 pos);
ODE_API void dGeomCopyRotation(dGeomID geom, dMatrix3 R);
ODE_API const dReal *dGeomGetPosition(dGeomID geom);
ODE_API void dGeomGetQuaternion(dGeomID geom, dQuaternion result);
ODE_API const dReal *dGeomGetRotation(dGeomID geom);
ODE_API void dGeomSetPosition(dGeomID geom, dReal x, dReal y, dReal z);
ODE_API void dGeomSetQuaternion(dGeomID geom, const dQuaternion Q);
ODE_API void dGeomSetRotation(dGeomID geom, const dMatrix3 R);

/* Poses within the body. The first call gives a geom an offset; "World" ones say where it should be now. */
ODE_API void dGeomClearOffset(dGeomID geom);
ODE_API void dGeomCopyOffsetPosition(dGeomID geom, dVector3 pos);
ODE_API void dGeomCopyOffsetRotation(dGeomID geom, dMatrix3 R);
ODE_API const dReal *dGeomGetOffsetPosition(dGeomID geom);
ODE_API void dGeomGetOffsetQuaternion(dGeomID geom, dQuaternion result);
ODE_API const dReal *dGeomGetOffsetRotation(dGeomID geom);
ODE_API int dGeomIsOffset(dGeomID geom);
ODE_API void dGeomSetOffsetPosition(dGeomID geom, dReal x, dReal y, dReal z);
ODE_API void dGeomSetOffsetQuaternion(dGeomID geom, const dQuaternion Q);
ODE_API void dGeomSetOffsetRotation(dGeomID geom, const dMatrix3 R);
ODE_API void dGeomSetOffsetWorldPosition(dGeomID geom, dReal x, dReal y, dReal z);
ODE_API void dGeomSetOffsetWorldQuaternion(dGeomID geom, const dQuaternion q);
ODE_API void dGeomSetOffsetWorldRotation(dGeomID geom, const dMatrix3 R);

/* Points and vectors between the geom's frame and the world. */
ODE_API void dGeomGetPosRelPoint(dGeomID geom, dReal px, dReal py, dReal pz, dVector3 result);
ODE_API void dGeomGetRelPointPos(dGeomID geom, dReal px, dReal py, dReal pz, dVector3 result);
ODE_API void dGeomVectorFromWorld(dGeomID geom, dReal px, dReal py, dReal pz, dVector3 result);
ODE_API void dGeomVectorToWorld(dGeomID geom, dReal px, dReal py, dReal pz, dVector3 result);

/* Contacts of two geoms, at most as many as the low 16 bits of `flags` say; `skip` is the distance in bytes between
   records. Pairs of a space, or between geoms or spaces, that may touch. */
ODE_API int dCollide(dGeomID o1, dGeomID o2, int flags, dContactGeom *contact, int skip);
ODE_API void dSpaceCollide(dSpaceID space, void *data, dNearCallback *callback);
ODE_API void dSpaceCollide2(dGeomID space1, dGeomID space2, void *data, dNearCallback *callback);

/* Spheres, boxes, capsules, cylinders. Depths are positive inside. Capsules and cylinders lie along z; a capsule's
   length is without its caps. */
ODE_API dGeomID dCreateBox(dSpaceID space, dReal lx, dReal ly, dReal lz);
ODE_API dGeomID dCreateCapsule(dSpaceID space, dReal radius, dReal length);
ODE_API dGeomID dCreateCylinder(dSpaceID space, dReal radius, dReal length);
ODE_API dGeomID dCreateSphere(dSpaceID space, dReal radius);
ODE_API void dGeomBoxGetLengths(dGeomID geom, dVector3 result);
ODE_API dReal dGeomBoxPointDepth(dGeomID geom, dReal x, dReal y, dReal z);
ODE_API void dGeomBoxSetLengths(dGeomID geom, dReal lx, dReal ly, dReal lz);
ODE_API void dGeomCapsuleGetParams(dGeomID geom, dReal *radius, dReal *length);
ODE_API dReal dGeomCapsulePointDepth(dGeomID geom, dReal x, dReal y, dReal z);
ODE_API void dGeomCapsuleSetParams(dGeomID geom, dReal radius, dReal length);
ODE_API void dGeomCylinderGetParams(dGeomID geom, dReal *radius, dReal *length);
ODE_API void dGeomCylinderSetParams(dGeomID geom, dReal radius, dReal length);
ODE_API dReal dGeomSphereGetRadius(dGeomID geom);
ODE_API dReal dGeomSpherePointDepth(dGeomID geom, dReal x, dReal y, dReal z);
ODE_API void dGeomSphereSetRadius(dGeomID geom, dReal radius);

#define dCCylinderClass dCapsuleClass
#define dCreateCCylinder dCreateCapsule
#define dGeomCCylinderSetParams dGeomCapsuleSetParams
#define dGeomCCylinderGetParams dGeomCapsuleGetParams
#define dGeomCCylinderPointDepth dGeomCapsulePointDepth

/* Planes a x + b y + c z = d, solid below; rays. */
ODE_API dGeomID dCreatePlane(dSpaceID space, dReal a, dReal b, dReal c, dReal d);
ODE_API dGeomID dCreateRay(dSpaceID space, dReal length);
ODE_API void dGeomPlaneGetParams(dGeomID geom, dVector4 result);
ODE_API dReal dGeomPlanePointDepth(dGeomID geom, dReal x, dReal y, dReal z);
ODE_API void dGeomPlaneSetParams(dGeomID geom, dReal a, dReal b, dReal c, dReal d);
ODE_API void dGeomRayGet(dGeomID geom, dVector3 start, dVector3 dir);
ODE_API int dGeomRayGetBackfaceCull(dGeomID geom);
ODE_API int dGeomRayGetClosestHit(dGeomID geom);
ODE_API int dGeomRayGetFirstContact(dGeomID geom);
ODE_API dReal dGeomRayGetLength(dGeomID geom);
ODE_API ODE_API_DEPRECATED void dGeomRayGetParams(dGeomID geom, int *first_contact, int *backface_cull);
ODE_API void dGeomRaySet(dGeomID geom, dReal px, dReal py, dReal pz, dReal dx, dReal dy, dReal dz);
ODE_API void dGeomRaySetBackfaceCull(dGeomID geom, int backface_cull);
ODE_API void dGeomRaySetClosestHit(dGeomID geom, int closest_hit);
ODE_API void dGeomRaySetFirstContact(dGeomID geom, int first_contact);
ODE_API void dGeomRaySetLength(dGeomID geom, dReal length);
ODE_API ODE_API_DEPRECATED void dGeomRaySetParams(dGeomID geom, int first_contact, int backface_cull);

/* Convex hulls. Planes are four numbers each, points three; polygons are a count and so many point numbers. The
   arrays stay the program's. */
ODE_API dGeomID dCreateConvex(dSpaceID space, const dReal *planes, unsigned int plane_count, const dReal *points,
        unsigned int point_count, const unsigned int *polygons);
ODE_API void dGeomSetConvex(dGeomID geom, const dReal *planes, unsigned int plane_count, const dReal *points,
        unsigned int point_count, const unsigned int *polygons);

/* Heightfields, in the xz plane with heights along y unless turned. */
typedef struct dxHeightfieldData *dHeightfieldDataID;
typedef dReal dHeightfieldGetHeight(void *user, int x, int z);

/* The geom, placeable or fixed, and its data. Samples are scaled, then offset; `thickness` goes down from the
   lowest. */
ODE_API dGeomID dCreateHeightfield(dSpaceID space, dHeightfieldDataID data, int placeable);
ODE_API void dGeomHeightfieldDataBuildByte(dHeightfieldDataID data, const unsigned char *samples, int copy, dReal
        width, dReal depth, int width_samples, int depth_samples, dReal scale, dReal offset, dReal thickness, int
        wrap);
ODE_API void dGeomHeightfieldDataBuildCallback(dHeightfieldDataID data, void *user, dHeightfieldGetHeight *callback,
        dReal width, dReal depth, int width_samples, int depth_samples, dReal scale, dReal offset, dReal thickness,
        int wrap);
ODE_API void dGeomHeightfieldDataBuildDouble(dHeightfieldDataID data, const double *samples, int copy, dReal width,
        dReal depth, int width_samples, int depth_samples, dReal scale, dReal offset, dReal thickness, int wrap);
ODE_API void dGeomHeightfieldDataBuildShort(dHeightfieldDataID data, const short *samples, int copy, dReal width,
        dReal depth, int width_samples, int depth_samples, dReal scale, dReal offset, dReal thickness, int wrap);
ODE_API void dGeomHeightfieldDataBuildSingle(dHeightfieldDataID data, const float *samples, int copy, dReal width,
        dReal depth, int width_samples, int depth_samples, dReal scale, dReal offset, dReal thickness, int wrap);
ODE_API dHeightfieldDataID dGeomHeightfieldDataCreate(void);
ODE_API void dGeomHeightfieldDataDestroy(dHeightfieldDataID data);
ODE_API void dGeomHeightfieldDataSetBounds(dHeightfieldDataID data, dReal min_height, dReal max_height);
ODE_API dHeightfieldDataID dGeomHeightfieldGetHeightfieldData(dGeomID geom);
ODE_API void dGeomHeightfieldSetHeightfieldData(dGeomID geom, dHeightfieldDataID d);

/* Another geom moved within this one; offsets do that better. */
ODE_API ODE_API_DEPRECATED dGeomID dCreateGeomTransform(dSpaceID space);
ODE_API ODE_API_DEPRECATED int dGeomTransformGetCleanup(dGeomID geom);
ODE_API ODE_API_DEPRECATED dGeomID dGeomTransformGetGeom(dGeomID geom);
ODE_API ODE_API_DEPRECATED int dGeomTransformGetInfo(dGeomID geom);
ODE_API ODE_API_DEPRECATED void dGeomTransformSetCleanup(dGeomID geom, int mode);
ODE_API ODE_API_DEPRECATED void dGeomTransformSetGeom(dGeomID geom, dGeomID obj);
ODE_API ODE_API_DEPRECATED void dGeomTransformSetInfo(dGeomID geom, int mode);

/* Helpers: nearest points of two segments; whether two boxes touch, and where, for full side lengths. */
ODE_API void dClosestLineSegmentPoints(const dVector3 a1, const dVector3 a2, const dVector3 b1, const dVector3 b2,
        dVector3 cp1, dVector3 cp2);
ODE_API int dBoxBox(const dVector3 p1, const dMatrix3 R1, const dVector3 side1, const dVector3 p2, const dMatrix3
        R2, const dVector3 side2, dVector3 normal, dReal *depth, int *return_code, int flags, dContactGeom *contact,
        int skip);
ODE_API int dBoxTouchesBox(const dVector3 p1, const dMatrix3 R1, const dVector3 side1, const dVector3 p2, const
        dMatrix3 R2, const dVector3 side2);

/* Classes of the program's own. */
typedef void dGetAABBFn(dGeomID geom, dReal aabb[6]);
typedef int dColliderFn(dGeomID o1, dGeomID o2, int flags, dContactGeom *contact, int skip);
typedef dColliderFn *dGetColliderFnFn(int class_number);
typedef void dGeomDtorFn(dGeomID geom);
typedef int dAABBTestFn(dGeomID o1, dGeomID o2, dReal aabb[6]);

/* Bytes of data a geom, how to collide with another class, the box, and maybe a test of boxes and a destructor. */
typedef struct dGeomClass {
    int bytes;
    dGetColliderFnFn *collider;
    dGetAABBFn *aabb;
    dAABBTestFn *aabb_test;
    dGeomDtorFn *dtor;
} dGeomClass;

/* The number of a new class; a geom of it; its data; a collider in place of the library's. */
ODE_API dGeomID dCreateGeom(int class_number);
ODE_API int dCreateGeomClass(const dGeomClass *geom_class);
ODE_API void *dGeomGetClassData(dGeomID geom);
ODE_API void dSetColliderOverride(int i, int j, dColliderFn *fn);

#ifdef __cplusplus
}
#endif

#endif
