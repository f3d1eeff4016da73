/* C++ classes around the handles of geoms and spaces. All is inline; nothing of it is in the library. */
#ifndef FERRODE_ODE_ODECPP_COLLISION_H
#define FERRODE_ODE_ODECPP_COLLISION_H

#include <ode/common.h>
#include <ode/collision.h>
#include <ode/collision_space.h>

#ifdef __cplusplus

/* Owns a geom: destroys it along with itself. */
class dGeom {
    dGeom(dGeom &);
    void operator=(dGeom &);

protected:
    dGeomID _id;

    dGeom() : _id(0) {}

public:
    ~dGeom() { destroy(); }
    void destroy() {
        if (_id != 0) dGeomDestroy(_id);
        _id = 0;
    }

    dGeomID id() const { return _id; }
    operator dGeomID() const { return _id; }

    int getClass() const { return dGeomGetClass(_id); }
    int isSpace() const { return dGeomIsSpace(_id); }
    dSpaceID getSpace() const { return dGeomGetSpace(_id); }
    void setData(void *data) { dGeomSetData(_id, data); }
    void *getData() const { return dGeomGetData(_id); }
    void setBody(dBodyID body) { dGeomSetBody(_id, body); }
    dBodyID getBody() const { return dGeomGetBody(_id); }

    void setPosition(dReal x, dReal y, dReal z) { dGeomSetPosition(_id, x, y, z); }
    const dReal *getPosition() const { return dGeomGetPosition(_id); }
    void setRotation(const dMatrix3 R) { dGeomSetRotation(_id, R); }
    const dReal *getRotation() const { return dGeomGetRotation(_id); }
    void setQuaternion(const dQuaternion q) { dGeomSetQuaternion(_id, q); }
    void getQuaternion(dQuaternion q) const { dGeomGetQuaternion(_id, q); }
    void getAABB(dReal aabb[6]) const { dGeomGetAABB(_id, aabb); }

    void setCategoryBits(unsigned long bits) { dGeomSetCategoryBits(_id, bits); }
    unsigned long getCategoryBits() const { return dGeomGetCategoryBits(_id); }
    void setCollideBits(unsigned long bits) { dGeomSetCollideBits(_id, bits); }
    unsigned long getCollideBits() const { return dGeomGetCollideBits(_id); }
    void enable() { dGeomEnable(_id); }
    void disable() { dGeomDisable(_id); }
    int isEnabled() const { return dGeomIsEnabled(_id); }

    void getRelPointPos(dReal x, dReal y, dReal z, dVector3 result) const { dGeomGetRelPointPos(_id, x, y, z, result); }
    void getRelPointPos(const dVector3 v, dVector3 result) const { getRelPointPos(v[0], v[1], v[2], result); }
    void getPosRelPoint(dReal x, dReal y, dReal z, dVector3 result) const { dGeomGetPosRelPoint(_id, x, y, z, result); }
    void getPosRelPoint(const dVector3 v, dVector3 result) const { getPosRelPoint(v[0], v[1], v[2], result); }
    void vectorToWorld(dReal x, dReal y, dReal z, dVector3 result) const { dGeomVectorToWorld(_id, x, y, z, result); }
    void vectorToWorld(const dVector3 v, dVector3 result) const { vectorToWorld(v[0], v[1], v[2], result); }
    void vectorFromWorld(dReal x, dReal y, dReal z, dVector3 result) const { dGeomVectorFromWorld(_id, x, y, z, result); }
    void vectorFromWorld(const dVector3 v, dVector3 result) const { vectorFromWorld(v[0], v[1], v[2], result); }

    void collide2(dGeomID other, void *data, dNearCallback *callback) { dSpaceCollide2((dGeomID)_id, other, data, callback); }
};

/* What all spaces have. */
class dSpace : public dGeom {
    dSpace(dSpace &);
    void operator=(dSpace &);

protected:
    dSpace() {}

public:
    dSpaceID id() const { return (dSpaceID)_id; }
    operator dSpaceID() const { return id(); }

    void setCleanup(int mode) { dSpaceSetCleanup(id(), mode); }
    int getCleanup() const { return dSpaceGetCleanup(id()); }
    void add(dGeomID geom) { dSpaceAdd(id(), geom); }
    void remove(dGeomID geom) { dSpaceRemove(id(), geom); }
    int query(dGeomID geom) const { return dSpaceQuery(id(), geom); }
    int getNumGeoms() const { return dSpaceGetNumGeoms(id()); }
    dGeomID getGeom(int index) { return dSpaceGetGeom(id(), index); }
    void collide(void *data, dNearCallback *callback) { dSpaceCollide(id(), data, callback); }
};

class dSimpleSpace : public dSpace {
    dSimpleSpace(dSimpleSpace &);
    void operator=(dSimpleSpace &);

public:
    dSimpleSpace() { _id = (dGeomID)dSimpleSpaceCreate(0); }
    dSimpleSpace(dSpace &space) { _id = (dGeomID)dSimpleSpaceCreate(space.id()); }
    dSimpleSpace(dSpaceID space) { _id = (dGeomID)dSimpleSpaceCreate(space); }
};

class dHashSpace : public dSpace {
    dHashSpace(dHashSpace &);
    void operator=(dHashSpace &);

public:
    dHashSpace() { _id = (dGeomID)dHashSpaceCreate(0); }
    dHashSpace(dSpace &space) { _id = (dGeomID)dHashSpaceCreate(space.id()); }
    dHashSpace(dSpaceID space) { _id = (dGeomID)dHashSpaceCreate(space); }

    void setLevels(int min_level, int max_level) { dHashSpaceSetLevels(id(), min_level, max_level); }
};

class dQuadTreeSpace : public dSpace {
    dQuadTreeSpace(dQuadTreeSpace &);
    void operator=(dQuadTreeSpace &);

public:
    dQuadTreeSpace(const dVector3 center, const dVector3 extents, int depth) { _id = (dGeomID)dQuadTreeSpaceCreate(0, center, extents, depth); }
    dQuadTreeSpace(dSpace &space, const dVector3 center, const dVector3 extents, int depth) { _id = (dGeomID)dQuadTreeSpaceCreate(space.id(), center, extents, depth); }
    dQuadTreeSpace(dSpaceID space, const dVector3 center, const dVector3 extents, int depth) { _id = (dGeomID)dQuadTreeSpaceCreate(space, center, extents, depth); }
};

class dSphere : public dGeom {
    dSphere(dSphere &);
    void operator=(dSphere &);

public:
    dSphere() {}
    dSphere(dReal radius) { _id = dCreateSphere(0, radius); }
    dSphere(dSpace &space, dReal radius) { _id = dCreateSphere(space.id(), radius); }
    dSphere(dSpaceID space, dReal radius) { _id = dCreateSphere(space, radius); }
    void create(dSpaceID space, dReal radius) {
        destroy();
        _id = dCreateSphere(space, radius);
    }

    void setRadius(dReal radius) { dGeomSphereSetRadius(_id, radius); }
    dReal getRadius() const { return dGeomSphereGetRadius(_id); }
};

class dBox : public dGeom {
    dBox(dBox &);
    void operator=(dBox &);

public:
    dBox() {}
    dBox(dReal lx, dReal ly, dReal lz) { _id = dCreateBox(0, lx, ly, lz); }
    dBox(dSpace &space, dReal lx, dReal ly, dReal lz) { _id = dCreateBox(space.id(), lx, ly, lz); }
    dBox(dSpaceID space, dReal lx, dReal ly, dReal lz) { _id = dCreateBox(space, lx, ly, lz); }
    void create(dSpaceID space, dReal lx, dReal ly, dReal lz) {
        destroy();
        _id = dCreateBox(space, lx, ly, lz);
    }

    void setLengths(dReal lx, dReal ly, dReal lz) { dGeomBoxSetLengths(_id, lx, ly, lz); }
    void getLengths(dVector3 result) const { dGeomBoxGetLengths(_id, result); }
};

class dPlane : public dGeom {
    dPlane(dPlane &);
    void operator=(dPlane &);

public:
    dPlane() {}
    dPlane(dReal a, dReal b, dReal c, dReal d) { _id = dCreatePlane(0, a, b, c, d); }
    dPlane(dSpace &space, dReal a, dReal b, dReal c, dReal d) { _id = dCreatePlane(space.id(), a, b, c, d); }
    dPlane(dSpaceID space, dReal a, dReal b, dReal c, dReal d) { _id = dCreatePlane(space, a, b, c, d); }
    void create(dSpaceID space, dReal a, dReal b, dReal c, dReal d) {
        destroy();
        _id = dCreatePlane(space, a, b, c, d);
    }

    void setParams(dReal a, dReal b, dReal c, dReal d) { dGeomPlaneSetParams(_id, a, b, c, d); }
    void getParams(dVector4 result) const { dGeomPlaneGetParams(_id, result); }
};

class dCapsule : public dGeom {
    dCapsule(dCapsule &);
    void operator=(dCapsule &);

public:
    dCapsule() {}
    dCapsule(dReal radius, dReal length) { _id = dCreateCapsule(0, radius, length); }
    dCapsule(dSpace &space, dReal radius, dReal length) { _id = dCreateCapsule(space.id(), radius, length); }
    dCapsule(dSpaceID space, dReal radius, dReal length) { _id = dCreateCapsule(space, radius, length); }
    void create(dSpaceID space, dReal radius, dReal length) {
        destroy();
        _id = dCreateCapsule(space, radius, length);
    }

    void setParams(dReal radius, dReal length) { dGeomCapsuleSetParams(_id, radius, length); }
    void getParams(dReal *radius, dReal *length) const { dGeomCapsuleGetParams(_id, radius, length); }
};

class dCylinder : public dGeom {
    dCylinder(dCylinder &);
    void operator=(dCylinder &);

public:
    dCylinder() {}
    dCylinder(dReal radius, dReal length) { _id = dCreateCylinder(0, radius, length); }
    dCylinder(dSpace &space, dReal radius, dReal length) { _id = dCreateCylinder(space.id(), radius, length); }
    dCylinder(dSpaceID space, dReal radius, dReal length) { _id = dCreateCylinder(space, radius, length); }
    void create(dSpaceID space, dReal radius, dReal length) {
        destroy();
        _id = dCreateCylinder(space, radius, length);
    }

    void setParams(dReal radius, dReal length) { dGeomCylinderSetParams(_id, radius, length); }
    void getParams(dReal *radius, dReal *length) const { dGeomCylinderGetParams(_id, radius, length); }
};

class dRay : public dGeom {
    dRay(dRay &);
    void operator=(dRay &);

public:
    dRay() {}
    dRay(dReal length) { _id = dCreateRay(0, length); }
    dRay(dSpace &space, dReal length) { _id = dCreateRay(space.id(), length); }
    dRay(dSpaceID space, dReal length) { _id = dCreateRay(space, length); }
    void create(dSpaceID space, dReal length) {
        destroy();
        _id = dCreateRay(space, length);
    }

    void setLength(dReal length) { dGeomRaySetLength(_id, length); }
    dReal getLength() const { return dGeomRayGetLength(_id); }
    void set(dReal px, dReal py, dReal pz, dReal dx, dReal dy, dReal dz) { dGeomRaySet(_id, px, py, pz, dx, dy, dz); }
    void get(dVector3 start, dVector3 direction) const { dGeomRayGet(_id, start, direction); }
    void setFirstContact(int on) { dGeomRaySetFirstContact(_id, on); }
    int getFirstContact() const { return dGeomRayGetFirstContact(_id); }
    void setBackfaceCull(int on) { dGeomRaySetBackfaceCull(_id, on); }
    int getBackfaceCull() const { return dGeomRayGetBackfaceCull(_id); }
    void setClosestHit(int on) { dGeomRaySetClosestHit(_id, on); }
    int getClosestHit() const { return dGeomRayGetClosestHit(_id); }
    ODE_API_DEPRECATED void setParams(int first_contact, int backface_cull) {
        setFirstContact(first_contact);
        setBackfaceCull(backface_cull);
    }
    ODE_API_DEPRECATED void getParams(int *first_contact, int *backface_cull) const {
        *first_contact = getFirstContact();
        *backface_cull = getBackfaceCull();
    }
};

/* The functions that this old class calls are deprecated, like itself. */
#if defined(__GNUC__) || defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#elif defined(_MSC_VER)
#pragma warning(push)
#pragma warning(disable : 4996)
#endif
class ODE_API_DEPRECATED dGeomTransform : public dGeom {
    dGeomTransform(dGeomTransform &);
    void operator=(dGeomTransform &);

public:
    dGeomTransform() {}
    dGeomTransform(dSpace &space) { _id = dCreateGeomTransform(space.id()); }
    dGeomTransform(dSpaceID space) { _id = dCreateGeomTransform(space); }
    void create(dSpaceID space = 0) {
        destroy();
        _id = dCreateGeomTransform(space);
    }

    void setGeom(dGeomID geom) { dGeomTransformSetGeom(_id, geom); }
    dGeomID getGeom() const { return dGeomTransformGetGeom(_id); }
    void setCleanup(int mode) { dGeomTransformSetCleanup(_id, mode); }
    int getCleanup() const { return dGeomTransformGetCleanup(_id); }
    void setInfo(int mode) { dGeomTransformSetInfo(_id, mode); }
    int getInfo() const { return dGeomTransformGetInfo(_id); }
};
#if defined(__GNUC__) || defined(__clang__)
#pragma GCC diagnostic pop
#elif defined(_MSC_VER)
#pragma warning(pop)
#endif

#endif

#endif
