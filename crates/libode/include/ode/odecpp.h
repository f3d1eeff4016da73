/* C++ classes around the handles of worlds, bodies and joints. All is inline; nothing of it is in the library. */
#ifndef FERRODE_ODE_ODECPP_H
#define FERRODE_ODE_ODECPP_H

#include <ode/common.h>
#include <ode/mass.h>
#include <ode/objects.h>

#ifdef __cplusplus

/* Members, by what they pass on. They are undefined again at the end. */
#define FERRODE_DO(method, Function) \
    void method() { Function(get_id()); }
#define FERRODE_GET(Type, method, Function) \
    Type method() const { return Function(get_id()); }
#define FERRODE_IS(method, Function) \
    bool method() const { return Function(get_id()) != 0; }
#define FERRODE_SET(Type, method, Function) \
    void method(Type value) { Function(get_id(), value); }
#define FERRODE_BOTH(Type, Property, Prefix) \
    FERRODE_SET(Type, set##Property, Prefix##Set##Property) \
    FERRODE_GET(Type, get##Property, Prefix##Get##Property)
#define FERRODE_SWITCH(Property, Prefix) \
    FERRODE_SET(bool, set##Property, Prefix##Set##Property) \
    FERRODE_IS(get##Property, Prefix##Get##Property)
#define FERRODE_SET3(method, Function) \
    void method(dReal x, dReal y, dReal z) { Function(get_id(), x, y, z); } \
    void method(const dVector3 v) { Function(get_id(), v[0], v[1], v[2]); }
#define FERRODE_GET3(method, Function) \
    void method(dVector3 result) const { Function(get_id(), result); }
#define FERRODE_MAP3(method, Function) \
    void method(dReal x, dReal y, dReal z, dVector3 result) const { Function(get_id(), x, y, z, result); } \
    void method(const dVector3 v, dVector3 result) const { Function(get_id(), v[0], v[1], v[2], result); }

/* Owns a world: destroys it along with itself. The second kind can be destroyed through a pointer to it. */
class dWorldSimpleIDContainer {
protected:
    dWorldID _id;

    dWorldSimpleIDContainer() : _id(0) {}
    ~dWorldSimpleIDContainer() { destroy(); }

    void destroy() {
        if (_id != 0) {
            dWorldDestroy(_id);
            _id = 0;
        }
    }
};

class dWorldDynamicIDContainer : public dWorldSimpleIDContainer {
protected:
    virtual ~dWorldDynamicIDContainer() {}
};

template <class dWorldTemplateBase>
class dWorldTemplate : public dWorldTemplateBase {
    dWorldTemplate(const dWorldTemplate &);
    void operator=(const dWorldTemplate &);

protected:
    dWorldID get_id() const { return dWorldTemplateBase::_id; }
    void set_id(dWorldID value) { dWorldTemplateBase::_id = value; }

public:
    dWorldTemplate() { set_id(dWorldCreate()); }

    dWorldID id() const { return get_id(); }
    operator dWorldID() const { return get_id(); }

    FERRODE_SET3(setGravity, dWorldSetGravity)
    FERRODE_GET3(getGravity, dWorldGetGravity)
    FERRODE_BOTH(dReal, ERP, dWorld)
    FERRODE_BOTH(dReal, CFM, dWorld)

    void step(dReal stepsize) { dWorldStep(get_id(), stepsize); }
    void quickStep(dReal stepsize) { dWorldQuickStep(get_id(), stepsize); }
    FERRODE_BOTH(int, QuickStepNumIterations, dWorld)
    FERRODE_BOTH(dReal, QuickStepW, dWorld)
    void impulseToForce(dReal stepsize, dReal ix, dReal iy, dReal iz, dVector3 force) {
        dWorldImpulseToForce(get_id(), stepsize, ix, iy, iz, force);
    }

    FERRODE_BOTH(int, AutoDisableFlag, dWorld)
    FERRODE_BOTH(int, AutoDisableSteps, dWorld)
    FERRODE_BOTH(dReal, AutoDisableTime, dWorld)
    FERRODE_BOTH(dReal, AutoDisableLinearThreshold, dWorld)
    FERRODE_BOTH(dReal, AutoDisableAngularThreshold, dWorld)

    FERRODE_BOTH(dReal, LinearDamping, dWorld)
    FERRODE_BOTH(dReal, AngularDamping, dWorld)
    FERRODE_BOTH(dReal, LinearDampingThreshold, dWorld)
    FERRODE_BOTH(dReal, AngularDampingThreshold, dWorld)
    void setDamping(dReal linear_scale, dReal angular_scale) { dWorldSetDamping(get_id(), linear_scale, angular_scale); }
    FERRODE_BOTH(dReal, MaxAngularSpeed, dWorld)
    FERRODE_BOTH(dReal, ContactSurfaceLayer, dWorld)
};

/* Owns a body: destroys it along with itself. The second kind can be destroyed through a pointer to it. */
class dBodySimpleIDContainer {
protected:
    dBodyID _id;

    dBodySimpleIDContainer() : _id(0) {}
    ~dBodySimpleIDContainer() { destroy(); }

    void destroy() {
        if (_id != 0) {
            dBodyDestroy(_id);
            _id = 0;
        }
    }
};

class dBodyDynamicIDContainer : public dBodySimpleIDContainer {
protected:
    virtual ~dBodyDynamicIDContainer() {}
};

template <class dBodyTemplateBase, class dWorldTemplateBase>
class dBodyTemplate : public dBodyTemplateBase {
    dBodyTemplate(const dBodyTemplate &);
    void operator=(const dBodyTemplate &);

protected:
    dBodyID get_id() const { return dBodyTemplateBase::_id; }
    void set_id(dBodyID value) { dBodyTemplateBase::_id = value; }
    void destroy() { dBodyTemplateBase::destroy(); }

public:
    dBodyTemplate() {}
    dBodyTemplate(dWorldID world) { set_id(dBodyCreate(world)); }
    dBodyTemplate(dWorldTemplate<dWorldTemplateBase> &world) { set_id(dBodyCreate(world.id())); }

    void create(dWorldID world) {
        destroy();
        set_id(dBodyCreate(world));
    }
    void create(dWorldTemplate<dWorldTemplateBase> &world) { create(world.id()); }

    dBodyID id() const { return get_id(); }
    operator dBodyID() const { return get_id(); }

    FERRODE_BOTH(void *, Data, dBody)
    FERRODE_SET3(setPosition, dBodySetPosition)
    FERRODE_SET3(setLinearVel, dBodySetLinearVel)
    FERRODE_SET3(setAngularVel, dBodySetAngularVel)
    void setRotation(const dMatrix3 R) { dBodySetRotation(get_id(), R); }
    void setQuaternion(const dQuaternion q) { dBodySetQuaternion(get_id(), q); }
    FERRODE_GET(const dReal *, getPosition, dBodyGetPosition)
    FERRODE_GET(const dReal *, getRotation, dBodyGetRotation)
    FERRODE_GET(const dReal *, getQuaternion, dBodyGetQuaternion)
    FERRODE_GET(const dReal *, getLinearVel, dBodyGetLinearVel)
    FERRODE_GET(const dReal *, getAngularVel, dBodyGetAngularVel)
    FERRODE_GET(const dReal *, getForce, dBodyGetForce)
    FERRODE_GET(const dReal *, getTorque, dBodyGetTorque)

    void setMass(const dMass *mass) { dBodySetMass(get_id(), mass); }
    void setMass(const dMass &mass) { dBodySetMass(get_id(), &mass); }
    dMass getMass() const {
        dMass mass;
        dBodyGetMass(get_id(), &mass);
        return mass;
    }

    FERRODE_SET3(addForce, dBodyAddForce)
    FERRODE_SET3(addTorque, dBodyAddTorque)
    FERRODE_SET3(addRelForce, dBodyAddRelForce)
    FERRODE_SET3(addRelTorque, dBodyAddRelTorque)
    FERRODE_SET3(setForce, dBodySetForce)
    FERRODE_SET3(setTorque, dBodySetTorque)
    void addForceAtPos(dReal fx, dReal fy, dReal fz, dReal px, dReal py, dReal pz) {
        dBodyAddForceAtPos(get_id(), fx, fy, fz, px, py, pz);
    }
    void addForceAtPos(const dVector3 f, const dVector3 p) { addForceAtPos(f[0], f[1], f[2], p[0], p[1], p[2]); }
    void addForceAtRelPos(dReal fx, dReal fy, dReal fz, dReal px, dReal py, dReal pz) {
        dBodyAddForceAtRelPos(get_id(), fx, fy, fz, px, py, pz);
    }
    void addForceAtRelPos(const dVector3 f, const dVector3 p) { addForceAtRelPos(f[0], f[1], f[2], p[0], p[1], p[2]); }
    void addRelForceAtPos(dReal fx, dReal fy, dReal fz, dReal px, dReal py, dReal pz) {
        dBodyAddRelForceAtPos(get_id(), fx, fy, fz, px, py, pz);
    }
    void addRelForceAtPos(const dVector3 f, const dVector3 p) { addRelForceAtPos(f[0], f[1], f[2], p[0], p[1], p[2]); }
    void addRelForceAtRelPos(dReal fx, dReal fy, dReal fz, dReal px, dReal py, dReal pz) {
        dBodyAddRelForceAtRelPos(get_id(), fx, fy, fz, px, py, pz);
    }
    void addRelForceAtRelPos(const dVector3 f, const dVector3 p) { addRelForceAtRelPos(f[0], f[1], f[2], p[0], p[1], p[2]); }

    FERRODE_DO(setDynamic, dBodySetDynamic)
    FERRODE_DO(setKinematic, dBodySetKinematic)
    FERRODE_IS(isKinematic, dBodyIsKinematic)
    FERRODE_DO(enable, dBodyEnable)
    FERRODE_DO(disable, dBodyDisable)
    FERRODE_IS(isEnabled, dBodyIsEnabled)

    FERRODE_MAP3(getRelPointPos, dBodyGetRelPointPos)
    FERRODE_MAP3(getRelPointVel, dBodyGetRelPointVel)
    FERRODE_MAP3(getPointVel, dBodyGetPointVel)
    FERRODE_MAP3(getPosRelPoint, dBodyGetPosRelPoint)
    FERRODE_MAP3(vectorToWorld, dBodyVectorToWorld)
    FERRODE_MAP3(vectorFromWorld, dBodyVectorFromWorld)

    FERRODE_SWITCH(FiniteRotationMode, dBody)
    FERRODE_SET3(setFiniteRotationAxis, dBodySetFiniteRotationAxis)
    FERRODE_GET3(getFiniteRotationAxis, dBodyGetFiniteRotationAxis)
    FERRODE_SWITCH(GravityMode, dBody)
    FERRODE_SWITCH(GyroscopicMode, dBody)

    FERRODE_GET(int, getNumJoints, dBodyGetNumJoints)
    dJointID getJoint(int index) const { return dBodyGetJoint(get_id(), index); }
    bool isConnectedTo(dBodyID body) const { return dAreConnected(get_id(), body) != 0; }

    FERRODE_SWITCH(AutoDisableFlag, dBody)
    FERRODE_BOTH(int, AutoDisableSteps, dBody)
    FERRODE_BOTH(dReal, AutoDisableTime, dBody)
    FERRODE_BOTH(dReal, AutoDisableLinearThreshold, dBody)
    FERRODE_BOTH(dReal, AutoDisableAngularThreshold, dBody)

    FERRODE_BOTH(dReal, LinearDamping, dBody)
    FERRODE_BOTH(dReal, AngularDamping, dBody)
    void setLinearDampingThreshold(dReal threshold) const { dBodySetLinearDampingThreshold(get_id(), threshold); }
    FERRODE_GET(dReal, getLinearDampingThreshold, dBodyGetLinearDampingThreshold)
    FERRODE_BOTH(dReal, AngularDampingThreshold, dBody)
    void setDamping(dReal linear_scale, dReal angular_scale) { dBodySetDamping(get_id(), linear_scale, angular_scale); }
    FERRODE_DO(setDampingDefaults, dBodySetDampingDefaults)
    FERRODE_BOTH(dReal, MaxAngularSpeed, dBody)
};

/* Owns a group of joints: destroys it along with itself. The second kind can be destroyed through a pointer to it. */
class dJointGroupSimpleIDContainer {
protected:
    dJointGroupID _id;

    dJointGroupSimpleIDContainer() : _id(0) {}
    ~dJointGroupSimpleIDContainer() { destroy(); }

    void destroy() {
        if (_id != 0) {
            dJointGroupDestroy(_id);
            _id = 0;
        }
    }
};

class dJointGroupDynamicIDContainer : public dJointGroupSimpleIDContainer {
protected:
    virtual ~dJointGroupDynamicIDContainer() {}
};

template <class dJointGroupTemplateBase>
class dJointGroupTemplate : public dJointGroupTemplateBase {
    dJointGroupTemplate(const dJointGroupTemplate &);
    void operator=(const dJointGroupTemplate &);

protected:
    dJointGroupID get_id() const { return dJointGroupTemplateBase::_id; }
    void set_id(dJointGroupID value) { dJointGroupTemplateBase::_id = value; }
    void destroy() { dJointGroupTemplateBase::destroy(); }

public:
    dJointGroupTemplate() { set_id(dJointGroupCreate(0)); }
    void create() {
        destroy();
        set_id(dJointGroupCreate(0));
    }

    dJointGroupID id() const { return get_id(); }
    operator dJointGroupID() const { return get_id(); }

    FERRODE_DO(empty, dJointGroupEmpty)
    FERRODE_DO(clear, dJointGroupEmpty)
};

/* Owns a joint: destroys it along with itself. The second kind can be destroyed through a pointer to it. */
class dJointSimpleIDContainer {
protected:
    dJointID _id;

    dJointSimpleIDContainer() : _id(0) {}
    ~dJointSimpleIDContainer() { destroy(); }

    void destroy() {
        if (_id != 0) {
            dJointDestroy(_id);
            _id = 0;
        }
    }
};

class dJointDynamicIDContainer : public dJointSimpleIDContainer {
protected:
    virtual ~dJointDynamicIDContainer() {}
};

/* What all joints have. Parameters are those of the kind of joint; a joint without any ignores them. */
template <class dJointTemplateBase, class dWorldTemplateBase, class dBodyTemplateBase>
class dJointTemplate : public dJointTemplateBase {
    dJointTemplate(const dJointTemplate &);
    void operator=(const dJointTemplate &);

protected:
    dJointID get_id() const { return dJointTemplateBase::_id; }
    void set_id(dJointID value) { dJointTemplateBase::_id = value; }
    void destroy() { dJointTemplateBase::destroy(); }
    dJointTemplate() {}

public:
    dJointID id() const { return get_id(); }
    operator dJointID() const { return get_id(); }

    void attach(dBodyID body1, dBodyID body2) { dJointAttach(get_id(), body1, body2); }
    void attach(dBodyTemplate<dBodyTemplateBase, dWorldTemplateBase> &body1,
            dBodyTemplate<dBodyTemplateBase, dWorldTemplateBase> &body2) {
        attach(body1.id(), body2.id());
    }
    FERRODE_GET(int, getNumBodies, dJointGetNumBodies)
    dBodyID getBody(int index) const { return dJointGetBody(get_id(), index); }
    FERRODE_GET(dJointType, getType, dJointGetType)
    FERRODE_DO(enable, dJointEnable)
    FERRODE_DO(disable, dJointDisable)
    FERRODE_IS(isEnabled, dJointIsEnabled)
    FERRODE_BOTH(void *, Data, dJoint)
    FERRODE_BOTH(dJointFeedback *, Feedback, dJoint)

    virtual void setParam(int, dReal) {}
    virtual dReal getParam(int) const { return 0; }
};

/* The head of each kind of joint. */
#define FERRODE_JOINT(Kind) \
    template <class dJointTemplateBase, class dWorldTemplateBase, class dBodyTemplateBase> \
    class d##Kind##JointTemplate : public dJointTemplate<dJointTemplateBase, dWorldTemplateBase, dBodyTemplateBase> { \
        d##Kind##JointTemplate(const d##Kind##JointTemplate &); \
        void operator=(const d##Kind##JointTemplate &); \
\
    protected: \
        typedef dJointTemplate<dJointTemplateBase, dWorldTemplateBase, dBodyTemplateBase> dBaseTemplate; \
        dJointID get_id() const { return dBaseTemplate::get_id(); } \
        void set_id(dJointID value) { dBaseTemplate::set_id(value); } \
        void destroy() { dBaseTemplate::destroy(); } \
\
    public: \
        d##Kind##JointTemplate() {}

#define FERRODE_CREATE(Kind) \
    d##Kind##JointTemplate(dWorldID world, dJointGroupID group = 0) { set_id(dJointCreate##Kind(world, group)); } \
    d##Kind##JointTemplate(dWorldTemplate<dWorldTemplateBase> &world, dJointGroupID group = 0) { \
        set_id(dJointCreate##Kind(world.id(), group)); \
    } \
    void create(dWorldID world, dJointGroupID group = 0) { \
        destroy(); \
        set_id(dJointCreate##Kind(world, group)); \
    } \
    void create(dWorldTemplate<dWorldTemplateBase> &world, dJointGroupID group = 0) { create(world.id(), group); }

#define FERRODE_PARAMS(Kind) \
    virtual void setParam(int parameter, dReal value) { dJointSet##Kind##Param(get_id(), parameter, value); } \
    virtual dReal getParam(int parameter) const { return dJointGet##Kind##Param(get_id(), parameter); }

FERRODE_JOINT(Ball)
    FERRODE_CREATE(Ball)
    FERRODE_PARAMS(Ball)
    FERRODE_SET3(setAnchor, dJointSetBallAnchor)
    FERRODE_GET3(getAnchor, dJointGetBallAnchor)
    FERRODE_GET3(getAnchor2, dJointGetBallAnchor2)
};

FERRODE_JOINT(Hinge)
    FERRODE_CREATE(Hinge)
    FERRODE_PARAMS(Hinge)
    FERRODE_SET3(setAnchor, dJointSetHingeAnchor)
    FERRODE_SET3(setAxis, dJointSetHingeAxis)
    FERRODE_GET3(getAnchor, dJointGetHingeAnchor)
    FERRODE_GET3(getAnchor2, dJointGetHingeAnchor2)
    FERRODE_GET3(getAxis, dJointGetHingeAxis)
    FERRODE_GET(dReal, getAngle, dJointGetHingeAngle)
    FERRODE_GET(dReal, getAngleRate, dJointGetHingeAngleRate)
    void addTorque(dReal torque) { dJointAddHingeTorque(get_id(), torque); }
};

FERRODE_JOINT(Slider)
    FERRODE_CREATE(Slider)
    FERRODE_PARAMS(Slider)
    FERRODE_SET3(setAxis, dJointSetSliderAxis)
    FERRODE_GET3(getAxis, dJointGetSliderAxis)
    FERRODE_GET(dReal, getPosition, dJointGetSliderPosition)
    FERRODE_GET(dReal, getPositionRate, dJointGetSliderPositionRate)
    void addForce(dReal force) { dJointAddSliderForce(get_id(), force); }
};

FERRODE_JOINT(Universal)
    FERRODE_CREATE(Universal)
    FERRODE_PARAMS(Universal)
    FERRODE_SET3(setAnchor, dJointSetUniversalAnchor)
    FERRODE_SET3(setAxis1, dJointSetUniversalAxis1)
    FERRODE_SET3(setAxis2, dJointSetUniversalAxis2)
    FERRODE_GET3(getAnchor, dJointGetUniversalAnchor)
    FERRODE_GET3(getAnchor2, dJointGetUniversalAnchor2)
    FERRODE_GET3(getAxis1, dJointGetUniversalAxis1)
    FERRODE_GET3(getAxis2, dJointGetUniversalAxis2)
    void getAngles(dReal *angle1, dReal *angle2) const { dJointGetUniversalAngles(get_id(), angle1, angle2); }
    FERRODE_GET(dReal, getAngle1, dJointGetUniversalAngle1)
    FERRODE_GET(dReal, getAngle1Rate, dJointGetUniversalAngle1Rate)
    FERRODE_GET(dReal, getAngle2, dJointGetUniversalAngle2)
    FERRODE_GET(dReal, getAngle2Rate, dJointGetUniversalAngle2Rate)
    void addTorques(dReal torque1, dReal torque2) { dJointAddUniversalTorques(get_id(), torque1, torque2); }
};

FERRODE_JOINT(Hinge2)
    FERRODE_CREATE(Hinge2)
    FERRODE_PARAMS(Hinge2)
    FERRODE_SET3(setAnchor, dJointSetHinge2Anchor)
    void setAxes(const dReal *axis1, const dReal *axis2) { dJointSetHinge2Axes(get_id(), axis1, axis2); }
    ODE_API_DEPRECATED void setAxis1(dReal x, dReal y, dReal z) {
        const dVector3 axis = {x, y, z, 0};
        dJointSetHinge2Axes(get_id(), axis, 0);
    }
    ODE_API_DEPRECATED void setAxis1(const dVector3 axis) { dJointSetHinge2Axes(get_id(), axis, 0); }
    ODE_API_DEPRECATED void setAxis2(dReal x, dReal y, dReal z) {
        const dVector3 axis = {x, y, z, 0};
        dJointSetHinge2Axes(get_id(), 0, axis);
    }
    ODE_API_DEPRECATED void setAxis2(const dVector3 axis) { dJointSetHinge2Axes(get_id(), 0, axis); }
    FERRODE_GET3(getAnchor, dJointGetHinge2Anchor)
    FERRODE_GET3(getAnchor2, dJointGetHinge2Anchor2)
    FERRODE_GET3(getAxis1, dJointGetHinge2Axis1)
    FERRODE_GET3(getAxis2, dJointGetHinge2Axis2)
    FERRODE_GET(dReal, getAngle1, dJointGetHinge2Angle1)
    FERRODE_GET(dReal, getAngle1Rate, dJointGetHinge2Angle1Rate)
    FERRODE_GET(dReal, getAngle2, dJointGetHinge2Angle2)
    FERRODE_GET(dReal, getAngle2Rate, dJointGetHinge2Angle2Rate)
    void addTorques(dReal torque1, dReal torque2) { dJointAddHinge2Torques(get_id(), torque1, torque2); }
};

FERRODE_JOINT(PR)
    FERRODE_CREATE(PR)
    FERRODE_PARAMS(PR)
    FERRODE_SET3(setAnchor, dJointSetPRAnchor)
    FERRODE_SET3(setAxis1, dJointSetPRAxis1)
    FERRODE_SET3(setAxis2, dJointSetPRAxis2)
    FERRODE_GET3(getAnchor, dJointGetPRAnchor)
    FERRODE_GET3(getAxis1, dJointGetPRAxis1)
    FERRODE_GET3(getAxis2, dJointGetPRAxis2)
    FERRODE_GET(dReal, getPosition, dJointGetPRPosition)
    FERRODE_GET(dReal, getPositionRate, dJointGetPRPositionRate)
    FERRODE_GET(dReal, getAngle, dJointGetPRAngle)
    FERRODE_GET(dReal, getAngleRate, dJointGetPRAngleRate)
    void addTorque(dReal torque) { dJointAddPRTorque(get_id(), torque); }
};

FERRODE_JOINT(PU)
    FERRODE_CREATE(PU)
    FERRODE_PARAMS(PU)
    FERRODE_SET3(setAnchor, dJointSetPUAnchor)
    FERRODE_SET3(setAxis1, dJointSetPUAxis1)
    FERRODE_SET3(setAxis2, dJointSetPUAxis2)
    FERRODE_SET3(setAxis3, dJointSetPUAxis3)
    FERRODE_SET3(setAxisP, dJointSetPUAxisP)
    virtual void getAnchor(dVector3 result) const { dJointGetPUAnchor(get_id(), result); }
    FERRODE_GET3(getAxis1, dJointGetPUAxis1)
    FERRODE_GET3(getAxis2, dJointGetPUAxis2)
    FERRODE_GET3(getAxis3, dJointGetPUAxis3)
    FERRODE_GET3(getAxisP, dJointGetPUAxisP)
    FERRODE_GET(dReal, getAngle1, dJointGetPUAngle1)
    FERRODE_GET(dReal, getAngle1Rate, dJointGetPUAngle1Rate)
    FERRODE_GET(dReal, getAngle2, dJointGetPUAngle2)
    FERRODE_GET(dReal, getAngle2Rate, dJointGetPUAngle2Rate)
    FERRODE_GET(dReal, getPosition, dJointGetPUPosition)
    FERRODE_GET(dReal, getPositionRate, dJointGetPUPositionRate)
};

FERRODE_JOINT(Piston)
    FERRODE_CREATE(Piston)
    FERRODE_PARAMS(Piston)
    FERRODE_SET3(setAnchor, dJointSetPistonAnchor)
    FERRODE_SET3(setAxis, dJointSetPistonAxis)
    FERRODE_GET3(getAnchor, dJointGetPistonAnchor)
    FERRODE_GET3(getAnchor2, dJointGetPistonAnchor2)
    FERRODE_GET3(getAxis, dJointGetPistonAxis)
    FERRODE_GET(dReal, getPosition, dJointGetPistonPosition)
    FERRODE_GET(dReal, getPositionRate, dJointGetPistonPositionRate)
    FERRODE_GET(dReal, getAngle, dJointGetPistonAngle)
    FERRODE_GET(dReal, getAngleRate, dJointGetPistonAngleRate)
    void addForce(dReal force) { dJointAddPistonForce(get_id(), force); }
};

FERRODE_JOINT(Fixed)
    FERRODE_CREATE(Fixed)
    FERRODE_PARAMS(Fixed)
    FERRODE_DO(set, dJointSetFixed)
};

FERRODE_JOINT(Null)
    FERRODE_CREATE(Null)
};

FERRODE_JOINT(Contact)
    dContactJointTemplate(dWorldID world, dJointGroupID group, dContact *contact) {
        set_id(dJointCreateContact(world, group, contact));
    }
    dContactJointTemplate(dWorldTemplate<dWorldTemplateBase> &world, dJointGroupID group, dContact *contact) {
        set_id(dJointCreateContact(world.id(), group, contact));
    }
    void create(dWorldID world, dJointGroupID group, dContact *contact) {
        destroy();
        set_id(dJointCreateContact(world, group, contact));
    }
    void create(dWorldTemplate<dWorldTemplateBase> &world, dJointGroupID group, dContact *contact) {
        create(world.id(), group, contact);
    }
};

FERRODE_JOINT(AMotor)
    FERRODE_CREATE(AMotor)
    FERRODE_PARAMS(AMotor)
    FERRODE_SET(int, setNumAxes, dJointSetAMotorNumAxes)
    FERRODE_GET(int, getNumAxes, dJointGetAMotorNumAxes)
    void setAxis(int number, int frame, dReal x, dReal y, dReal z) {
        dJointSetAMotorAxis(get_id(), number, frame, x, y, z);
    }
    void setAxis(int number, int frame, const dVector3 axis) { setAxis(number, frame, axis[0], axis[1], axis[2]); }
    void getAxis(int number, dVector3 result) const { dJointGetAMotorAxis(get_id(), number, result); }
    FERRODE_SET(int, setMode, dJointSetAMotorMode)
    FERRODE_GET(int, getMode, dJointGetAMotorMode)
    int getAxisRel(int number) const { return dJointGetAMotorAxisRel(get_id(), number); }
    void setAngle(int number, dReal angle) { dJointSetAMotorAngle(get_id(), number, angle); }
    dReal getAngle(int number) const { return dJointGetAMotorAngle(get_id(), number); }
    dReal getAngleRate(int number) const { return dJointGetAMotorAngleRate(get_id(), number); }
    void addTorques(dReal torque1, dReal torque2, dReal torque3) { dJointAddAMotorTorques(get_id(), torque1, torque2, torque3); }
};

FERRODE_JOINT(LMotor)
    FERRODE_CREATE(LMotor)
    FERRODE_PARAMS(LMotor)
    FERRODE_SET(int, setNumAxes, dJointSetLMotorNumAxes)
    FERRODE_GET(int, getNumAxes, dJointGetLMotorNumAxes)
    void setAxis(int number, int frame, dReal x, dReal y, dReal z) {
        dJointSetLMotorAxis(get_id(), number, frame, x, y, z);
    }
    void setAxis(int number, int frame, const dVector3 axis) { setAxis(number, frame, axis[0], axis[1], axis[2]); }
    void getAxis(int number, dVector3 result) const { dJointGetLMotorAxis(get_id(), number, result); }
};

/* Which containers the plain names use. A program that defines one of these has to define all four. */
#if !defined(dODECPP_WORLD_TEMPLATE_BASE) && !defined(dODECPP_BODY_TEMPLATE_BASE) && \
        !defined(dODECPP_JOINTGROUP_TEMPLATE_BASE) && !defined(dODECPP_JOINT_TEMPLATE_BASE)
#define dODECPP_WORLD_TEMPLATE_BASE dWorldDynamicIDContainer
#define dODECPP_BODY_TEMPLATE_BASE dBodyDynamicIDContainer
#define dODECPP_JOINTGROUP_TEMPLATE_BASE dJointGroupDynamicIDContainer
#define dODECPP_JOINT_TEMPLATE_BASE dJointDynamicIDContainer
#elif !defined(dODECPP_WORLD_TEMPLATE_BASE) || !defined(dODECPP_BODY_TEMPLATE_BASE) || \
        !defined(dODECPP_JOINTGROUP_TEMPLATE_BASE) || !defined(dODECPP_JOINT_TEMPLATE_BASE)
#error "define all of dODECPP_{WORLD,BODY,JOINTGROUP,JOINT}_TEMPLATE_BASE, or none"
#endif

typedef dWorldTemplate<dODECPP_WORLD_TEMPLATE_BASE> dWorld;
typedef dBodyTemplate<dODECPP_BODY_TEMPLATE_BASE, dODECPP_WORLD_TEMPLATE_BASE> dBody;
typedef dJointGroupTemplate<dODECPP_JOINTGROUP_TEMPLATE_BASE> dJointGroup;

#define FERRODE_PLAIN(Kind) \
    typedef d##Kind##Template<dODECPP_JOINT_TEMPLATE_BASE, dODECPP_WORLD_TEMPLATE_BASE, dODECPP_BODY_TEMPLATE_BASE> d##Kind;
FERRODE_PLAIN(Joint)
FERRODE_PLAIN(BallJoint)
FERRODE_PLAIN(HingeJoint)
FERRODE_PLAIN(SliderJoint)
FERRODE_PLAIN(UniversalJoint)
FERRODE_PLAIN(Hinge2Joint)
FERRODE_PLAIN(PRJoint)
FERRODE_PLAIN(PUJoint)
FERRODE_PLAIN(PistonJoint)
FERRODE_PLAIN(FixedJoint)
FERRODE_PLAIN(ContactJoint)
FERRODE_PLAIN(NullJoint)
FERRODE_PLAIN(AMotorJoint)
FERRODE_PLAIN(LMotorJoint)

#undef FERRODE_DO
#undef FERRODE_GET
#undef FERRODE_IS
#undef FERRODE_SET
#undef FERRODE_BOTH
#undef FERRODE_SWITCH
#undef FERRODE_SET3
#undef FERRODE_GET3
#undef FERRODE_MAP3
#undef FERRODE_JOINT
#undef FERRODE_CREATE
#undef FERRODE_PARAMS
#undef FERRODE_PLAIN

#endif

#endif
