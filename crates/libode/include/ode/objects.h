/* Worlds, bodies and joints. Coordinates are the world's unless a name says "Rel". */
#ifndef FERRODE_ODE_OBJECTS_H
#define FERRODE_ODE_OBJECTS_H

#include <ode/common.h>
#include <ode/mass.h>
#include <ode/contact.h>
#include <ode/threading.h>

#ifdef __cplusplus
extern "C" {
#endif

#define dWORLDSTEP_THREADCOUNT_UNLIMITED dTHREADING_THREAD_COUNT_UNLIMITED
#define dWORLDSTEP_RESERVEFACTOR_DEFAULT 1.2f
#define dWORLDSTEP_RESERVESIZE_DEFAULT 65536U

/* How much working memory to have ahead: a factor of what a step needs, and at least so many bytes. struct_size is the
   record's size. */
typedef struct {
    unsigned int struct_size;
    float reserve_factor;
    unsigned int reserve_minimum;
} dWorldStepReserveInfo;

/* Who gives working memory. struct_size is the record's size. */
typedef struct {
    unsigned int struct_size;
    void *(*alloc_block)(dsizeint size);
    void *(*shrink_block)(void *block, dsizeint size, dsizeint smaller_size);
    void (*free_block)(void *block, dsizeint size);
} dWorldStepMemoryFunctionsInfo;

/* Worlds. */
ODE_API dWorldID dWorldCreate(void);
ODE_API void dWorldDestroy(dWorldID world);
ODE_API dReal dWorldGetCFM(dWorldID world);
ODE_API void *dWorldGetData(dWorldID world);
ODE_API dReal dWorldGetERP(dWorldID world);
ODE_API void dWorldGetGravity(dWorldID world, dVector3 gravity);
ODE_API void dWorldSetCFM(dWorldID world, dReal cfm);
ODE_API void dWorldSetData(dWorldID world, void *data);
ODE_API void dWorldSetERP(dWorldID world, dReal erp);
ODE_API void dWorldSetGravity(dWorldID world, dReal x, dReal y, dReal z);

/* Steps: exact, or iterative with so many sweeps and over-relaxation W. 0 if there was no memory. The force that
   gives an impulse in one step. */
ODE_API int dWorldStep(dWorldID world, dReal stepsize);
ODE_API int dWorldQuickStep(dWorldID world, dReal stepsize);
ODE_API int dWorldGetQuickStepNumIterations(dWorldID world);
ODE_API dReal dWorldGetQuickStepW(dWorldID world);
ODE_API void dWorldSetQuickStepNumIterations(dWorldID world, int number);
ODE_API void dWorldSetQuickStepW(dWorldID world, dReal factor);
ODE_API void dWorldImpulseToForce(dWorldID world, dReal stepsize, dReal ix, dReal iy, dReal iz, dVector3 force);

/* The old StepFast: the step cut into substeps, in which joints are solved one by one; bodies that sleep are woken by awake
   ones through so many layers (2), in all worlds. */
ODE_API void dWorldStepFast1(dWorldID world, dReal stepsize, int max_iterations);
ODE_API void dWorldSetAutoEnableDepthSF1(dWorldID world, int depth);
ODE_API int dWorldGetAutoEnableDepthSF1(dWorldID world);

/* Of the newest ODE: sweeps of iterative steps by need. A sweep that changes accelerations by less than the first number ends
   the step; so many more sweeps than set, a factor, may be made, while changes are above the third. Off (0, 0) at first, as
   in 0.16.2; newer ODEs begin with the defaults below. Null leaves a number as it is. */
#define dWORLDQUICKSTEP_ITERATION_COUNT_DEFAULT 20U
#define dWORLDQUICKSTEP_ITERATION_PREMATURE_EXIT_DELTA_DEFAULT 1e-8f
#define dWORLDQUICKSTEP_MAXIMAL_EXTRA_ITERATION_COUNT_FACTOR_DEFAULT 1.0f
#define dWORLDQUICKSTEP_EXTRA_ITERATION_REQUIREMENT_DELTA_DEFAULT 1e-2f
ODE_API void dWorldSetQuickStepDynamicIterationParameters(dWorldID world, const dReal *premature_exit_delta,
        const dReal *max_extra_factor, const dReal *extra_requirement_delta);
ODE_API void dWorldGetQuickStepDynamicIterationParameters(dWorldID world, dReal *premature_exit_delta,
        dReal *max_extra_factor, dReal *extra_requirement_delta);

/* Counts of what that did: islands stepped, ended early, prolonged, prolonged to the last. struct_size is the record's
   size. The record has to last until another is attached, or null. */
typedef struct {
    unsigned int struct_size;
    duint32 iteration_count;
    duint32 premature_exits;
    duint32 prolonged_execs;
    duint32 full_extra_execs;
} dWorldQuickStepIterationCount_DynamicAdjustmentStatistics;
ODE_API int dWorldAttachQuickStepDynamicIterationStatisticsSink(dWorldID world,
        dWorldQuickStepIterationCount_DynamicAdjustmentStatistics *sink);

/* Of the newest ODE: limits for the threads of a step, those that `param_set` names (0 is none). */
enum {
    dWSTP_WorldIslandsIterationMaxThreads = 1,
    dWSTP_IslandSteppingMaxThreads = 2,
    dWSTP_LCPSolvingMaxThreads = 4
};
typedef struct {
    unsigned int param_set;
    unsigned int world_islands_iteration_max_threads;
    unsigned int island_stepping_max_threads;
    unsigned int lcp_solving_max_threads;
} dWorldSteppingThreadingParameters;
ODE_API void dWorldSetSteppingThreadingParameters(dWorldID world, const dWorldSteppingThreadingParameters *limits);
ODE_API void dWorldGetSteppingThreadingParameters(dWorldID world, dWorldSteppingThreadingParameters *limits);

/* Contacts: the greatest velocity at which depth is corrected, and the depth that is left be. */
ODE_API dReal dWorldGetContactMaxCorrectingVel(dWorldID world);
ODE_API dReal dWorldGetContactSurfaceLayer(dWorldID world);
ODE_API void dWorldSetContactMaxCorrectingVel(dWorldID world, dReal vel);
ODE_API void dWorldSetContactSurfaceLayer(dWorldID world, dReal depth);

/* What bodies made from now on have: when they disable themselves, damping, and the greatest angular speed.
   Velocities are averaged over so many samples; a threshold of infinity means none. */
ODE_API dReal dWorldGetAngularDamping(dWorldID world);
ODE_API dReal dWorldGetAngularDampingThreshold(dWorldID world);
ODE_API dReal dWorldGetAutoDisableAngularThreshold(dWorldID world);
ODE_API int dWorldGetAutoDisableAverageSamplesCount(dWorldID world);
ODE_API int dWorldGetAutoDisableFlag(dWorldID world);
ODE_API dReal dWorldGetAutoDisableLinearThreshold(dWorldID world);
ODE_API int dWorldGetAutoDisableSteps(dWorldID world);
ODE_API dReal dWorldGetAutoDisableTime(dWorldID world);
ODE_API dReal dWorldGetLinearDamping(dWorldID world);
ODE_API dReal dWorldGetLinearDampingThreshold(dWorldID world);
ODE_API dReal dWorldGetMaxAngularSpeed(dWorldID world);
ODE_API void dWorldSetAngularDamping(dWorldID world, dReal scale);
ODE_API void dWorldSetAngularDampingThreshold(dWorldID world, dReal threshold);
ODE_API void dWorldSetAutoDisableAngularThreshold(dWorldID world, dReal threshold);
ODE_API void dWorldSetAutoDisableAverageSamplesCount(dWorldID world, unsigned int samples);
ODE_API void dWorldSetAutoDisableFlag(dWorldID world, int on);
ODE_API void dWorldSetAutoDisableLinearThreshold(dWorldID world, dReal threshold);
ODE_API void dWorldSetAutoDisableSteps(dWorldID world, int steps);
ODE_API void dWorldSetAutoDisableTime(dWorldID world, dReal time);
ODE_API void dWorldSetDamping(dWorldID world, dReal linear_scale, dReal angular_scale);
ODE_API void dWorldSetLinearDamping(dWorldID world, dReal scale);
ODE_API void dWorldSetLinearDampingThreshold(dWorldID world, dReal threshold);
ODE_API void dWorldSetMaxAngularSpeed(dWorldID world, dReal max_speed);

/* Working memory and threads of steps. Null takes the library's own again. */
ODE_API void dWorldCleanupWorkingMemory(dWorldID world);
ODE_API unsigned dWorldGetStepIslandsProcessingMaxThreadCount(dWorldID world);
ODE_API void dWorldSetStepIslandsProcessingMaxThreadCount(dWorldID world, unsigned int count);
ODE_API int dWorldSetStepMemoryManager(dWorldID world, const dWorldStepMemoryFunctionsInfo *functions);
ODE_API int dWorldSetStepMemoryReservationPolicy(dWorldID world, const dWorldStepReserveInfo *policy);
ODE_API void dWorldSetStepThreadingImplementation(dWorldID world, const dThreadingFunctionsInfo *functions,
        dThreadingImplementationID implementation);
ODE_API int dWorldUseSharedWorkingMemory(dWorldID world, dWorldID other);

/* Bodies. */
ODE_API dBodyID dBodyCreate(dWorldID world);
ODE_API void dBodyDestroy(dBodyID body);
ODE_API void dBodyDisable(dBodyID body);
ODE_API void dBodyEnable(dBodyID body);
ODE_API void *dBodyGetData(dBodyID body);
ODE_API dWorldID dBodyGetWorld(dBodyID body);
ODE_API int dBodyIsEnabled(dBodyID body);
ODE_API void dBodySetData(dBodyID body, void *data);
ODE_API void dBodySetMovedCallback(dBodyID body, void (*callback)(dBodyID));

/* Poses and velocities. Getters return storage of the body's that stays put and is kept up to date: 4 numbers, 12
   for the rotation. */
ODE_API void dBodyCopyPosition(dBodyID body, dVector3 pos);
ODE_API void dBodyCopyQuaternion(dBodyID body, dQuaternion quat);
ODE_API void dBodyCopyRotation(dBodyID body, dMatrix3 R);
ODE_API const dReal *dBodyGetAngularVel(dBodyID body);
ODE_API const dReal *dBodyGetLinearVel(dBodyID body);
ODE_API const dReal *dBodyGetPosition(dBodyID body);
ODE_API const dReal *dBodyGetQuaternion(dBodyID body);
ODE_API const dReal *dBodyGetRotation(dBodyID body);
ODE_API void dBodySetAngularVel(dBodyID body, dReal x, dReal y, dReal z);
ODE_API void dBodySetLinearVel(dBodyID body, dReal x, dReal y, dReal z);
ODE_API void dBodySetPosition(dBodyID body, dReal x, dReal y, dReal z);
ODE_API void dBodySetQuaternion(dBodyID body, const dQuaternion q);
ODE_API void dBodySetRotation(dBodyID body, const dMatrix3 R);

/* Mass. A kinematic body moves by its velocity alone. */
ODE_API void dBodyGetMass(dBodyID body, dMass *mass);
ODE_API int dBodyIsKinematic(dBodyID body);
ODE_API void dBodySetDynamic(dBodyID body);
ODE_API void dBodySetKinematic(dBodyID body);
ODE_API void dBodySetMass(dBodyID body, const dMass *mass);

/* Forces of the next step, in world axes or the body's ("Rel"), at points of the world or the body's. */
ODE_API void dBodyAddForce(dBodyID body, dReal fx, dReal fy, dReal fz);
ODE_API void dBodyAddForceAtPos(dBodyID body, dReal fx, dReal fy, dReal fz, dReal px, dReal py, dReal pz);
ODE_API void dBodyAddForceAtRelPos(dBodyID body, dReal fx, dReal fy, dReal fz, dReal px, dReal py, dReal pz);
ODE_API void dBodyAddRelForce(dBodyID body, dReal fx, dReal fy, dReal fz);
ODE_API void dBodyAddRelForceAtPos(dBodyID body, dReal fx, dReal fy, dReal fz, dReal px, dReal py, dReal pz);
ODE_API void dBodyAddRelForceAtRelPos(dBodyID body, dReal fx, dReal fy, dReal fz, dReal px, dReal py, dReal pz);
ODE_API void dBodyAddRelTorque(dBodyID body, dReal fx, dReal fy, dReal fz);
ODE_API void dBodyAddTorque(dBodyID body, dReal fx, dReal fy, dReal fz);
ODE_API const dReal *dBodyGetForce(dBodyID body);
ODE_API const dReal *dBodyGetTorque(dBodyID body);
ODE_API void dBodySetForce(dBodyID body, dReal x, dReal y, dReal z);
ODE_API void dBodySetTorque(dBodyID body, dReal x, dReal y, dReal z);

/* Points, vectors and velocities of points between the body's frame and the world. */
ODE_API void dBodyGetPointVel(dBodyID body, dReal px, dReal py, dReal pz, dVector3 result);
ODE_API void dBodyGetRelPointPos(dBodyID body, dReal px, dReal py, dReal pz, dVector3 result);
ODE_API void dBodyGetRelPointVel(dBodyID body, dReal px, dReal py, dReal pz, dVector3 result);
ODE_API void dBodyVectorFromWorld(dBodyID body, dReal px, dReal py, dReal pz, dVector3 result);
ODE_API void dBodyVectorToWorld(dBodyID body, dReal px, dReal py, dReal pz, dVector3 result);

/* How fast bodies are turned in a step: by the infinitesimal formula, or the finite one about an axis. */
ODE_API void dBodyGetFiniteRotationAxis(dBodyID body, dVector3 result);
ODE_API int dBodyGetFiniteRotationMode(dBodyID body);
ODE_API void dBodySetFiniteRotationAxis(dBodyID body, dReal x, dReal y, dReal z);
ODE_API void dBodySetFiniteRotationMode(dBodyID body, int mode);

/* Gravity, gyroscopic torque, damping, the greatest angular speed, disabling. */
ODE_API dReal dBodyGetAngularDamping(dBodyID body);
ODE_API dReal dBodyGetAngularDampingThreshold(dBodyID body);
ODE_API dReal dBodyGetAutoDisableAngularThreshold(dBodyID body);
ODE_API int dBodyGetAutoDisableAverageSamplesCount(dBodyID body);
ODE_API int dBodyGetAutoDisableFlag(dBodyID body);
ODE_API dReal dBodyGetAutoDisableLinearThreshold(dBodyID body);
ODE_API int dBodyGetAutoDisableSteps(dBodyID body);
ODE_API dReal dBodyGetAutoDisableTime(dBodyID body);
ODE_API int dBodyGetGravityMode(dBodyID body);
ODE_API int dBodyGetGyroscopicMode(dBodyID body);
ODE_API dReal dBodyGetLinearDamping(dBodyID body);
ODE_API dReal dBodyGetLinearDampingThreshold(dBodyID body);
ODE_API dReal dBodyGetMaxAngularSpeed(dBodyID body);
ODE_API void dBodySetAngularDamping(dBodyID body, dReal scale);
ODE_API void dBodySetAngularDampingThreshold(dBodyID body, dReal threshold);
ODE_API void dBodySetAutoDisableAngularThreshold(dBodyID body, dReal threshold);
ODE_API void dBodySetAutoDisableAverageSamplesCount(dBodyID body, unsigned int samples);
ODE_API void dBodySetAutoDisableDefaults(dBodyID body);
ODE_API void dBodySetAutoDisableFlag(dBodyID body, int on);
ODE_API void dBodySetAutoDisableLinearThreshold(dBodyID body, dReal threshold);
ODE_API void dBodySetAutoDisableSteps(dBodyID body, int steps);
ODE_API void dBodySetAutoDisableTime(dBodyID body, dReal time);
ODE_API void dBodySetDamping(dBodyID body, dReal linear_scale, dReal angular_scale);
ODE_API void dBodySetDampingDefaults(dBodyID body);
ODE_API void dBodySetGravityMode(dBodyID body, int mode);
ODE_API void dBodySetGyroscopicMode(dBodyID body, int enabled);
ODE_API void dBodySetLinearDamping(dBodyID body, dReal scale);
ODE_API void dBodySetLinearDampingThreshold(dBodyID body, dReal threshold);
ODE_API void dBodySetMaxAngularSpeed(dBodyID body, dReal max_speed);

/* What is attached to a body. */
ODE_API dGeomID dBodyGetFirstGeom(dBodyID body);
ODE_API dJointID dBodyGetJoint(dBodyID body, int index);
ODE_API dGeomID dBodyGetNextGeom(dGeomID geom);
ODE_API int dBodyGetNumJoints(dBodyID body);
ODE_API void dBodyGetPosRelPoint(dBodyID body, dReal px, dReal py, dReal pz, dVector3 result);
ODE_API int dAreConnected(dBodyID body, dBodyID body2);
ODE_API int dAreConnectedExcluding(dBodyID body1, dBodyID body2, int joint_type);
ODE_API dJointID dConnectingJoint(dBodyID body, dBodyID body2);
ODE_API int dConnectingJointList(dBodyID body, dBodyID body2, dJointID *joints);

/* Joints of each kind, in a group or in none (null). */
ODE_API dJointID dJointCreateAMotor(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateBall(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateContact(dWorldID world, dJointGroupID group, const dContact *contact);
ODE_API dJointID dJointCreateDBall(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateDHinge(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateFixed(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateHinge(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateHinge2(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateLMotor(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateNull(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreatePR(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreatePU(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreatePiston(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreatePlane2D(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateSlider(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateTransmission(dWorldID world, dJointGroupID group);
ODE_API dJointID dJointCreateUniversal(dWorldID world, dJointGroupID group);
/* As old manuals spell it. */
#define dJointCreatePlane2d dJointCreatePlane2D

/* Groups: joints that are destroyed together. The size is ignored. */
ODE_API dJointGroupID dJointGroupCreate(int max_size);
ODE_API void dJointGroupDestroy(dJointGroupID group);
ODE_API void dJointGroupEmpty(dJointGroupID group);

/* All joints. Null for a body is the world. */
ODE_API void dJointAttach(dJointID joint, dBodyID body1, dBodyID body2);
ODE_API void dJointDestroy(dJointID joint);
ODE_API void dJointDisable(dJointID joint);
ODE_API void dJointEnable(dJointID joint);
ODE_API dBodyID dJointGetBody(dJointID joint, int index);
ODE_API void *dJointGetData(dJointID joint);
ODE_API dJointFeedback *dJointGetFeedback(dJointID joint);
ODE_API int dJointGetNumBodies(dJointID joint);
ODE_API dJointType dJointGetType(dJointID joint);
ODE_API int dJointIsEnabled(dJointID joint);
ODE_API void dJointSetData(dJointID joint, void *data);
ODE_API void dJointSetFeedback(dJointID joint, dJointFeedback *feedback);

/* Ball and socket. */
ODE_API void dJointGetBallAnchor(dJointID joint, dVector3 result);
ODE_API void dJointGetBallAnchor2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetBallParam(dJointID joint, int parameter);
ODE_API void dJointSetBallAnchor(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetBallAnchor2(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetBallParam(dJointID joint, int parameter, dReal value);

/* Hinges. Anchor2 is the same point as the second body has it; angles are in radians. */
ODE_API void dJointAddHingeTorque(dJointID joint, dReal torque);
ODE_API void dJointGetHingeAnchor(dJointID joint, dVector3 result);
ODE_API void dJointGetHingeAnchor2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetHingeAngle(dJointID joint);
ODE_API dReal dJointGetHingeAngleRate(dJointID joint);
ODE_API void dJointGetHingeAxis(dJointID joint, dVector3 result);
ODE_API dReal dJointGetHingeParam(dJointID joint, int parameter);
ODE_API void dJointSetHingeAnchor(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetHingeAnchorDelta(dJointID joint, dReal x, dReal y, dReal z, dReal ax, dReal ay, dReal az);
ODE_API void dJointSetHingeAxis(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetHingeAxisOffset(dJointID joint, dReal x, dReal y, dReal z, dReal angle);
ODE_API void dJointSetHingeParam(dJointID joint, int parameter, dReal value);

/* Sliders. */
ODE_API void dJointAddSliderForce(dJointID joint, dReal force);
ODE_API void dJointGetSliderAxis(dJointID joint, dVector3 result);
ODE_API dReal dJointGetSliderParam(dJointID joint, int parameter);
ODE_API dReal dJointGetSliderPosition(dJointID joint);
ODE_API dReal dJointGetSliderPositionRate(dJointID joint);
ODE_API void dJointSetSliderAxis(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetSliderAxisDelta(dJointID joint, dReal x, dReal y, dReal z, dReal ax, dReal ay, dReal az);
ODE_API void dJointSetSliderParam(dJointID joint, int parameter, dReal value);

/* Universal joints: axis 1 on the first body, axis 2 on the second. */
ODE_API void dJointAddUniversalTorques(dJointID joint, dReal torque1, dReal torque2);
ODE_API void dJointGetUniversalAnchor(dJointID joint, dVector3 result);
ODE_API void dJointGetUniversalAnchor2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetUniversalAngle1(dJointID joint);
ODE_API dReal dJointGetUniversalAngle1Rate(dJointID joint);
ODE_API dReal dJointGetUniversalAngle2(dJointID joint);
ODE_API dReal dJointGetUniversalAngle2Rate(dJointID joint);
ODE_API void dJointGetUniversalAngles(dJointID joint, dReal *angle1, dReal *angle2);
ODE_API void dJointGetUniversalAxis1(dJointID joint, dVector3 result);
ODE_API void dJointGetUniversalAxis2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetUniversalParam(dJointID joint, int parameter);
ODE_API void dJointSetUniversalAnchor(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetUniversalAxis1(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetUniversalAxis1Offset(dJointID joint, dReal x, dReal y, dReal z, dReal offset1, dReal offset2);
ODE_API void dJointSetUniversalAxis2(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetUniversalAxis2Offset(dJointID joint, dReal x, dReal y, dReal z, dReal offset1, dReal offset2);
ODE_API void dJointSetUniversalParam(dJointID joint, int parameter, dReal value);

/* Wheels: axis 1 steers, axis 2 turns. */
ODE_API void dJointAddHinge2Torques(dJointID joint, dReal torque1, dReal torque2);
ODE_API void dJointGetHinge2Anchor(dJointID joint, dVector3 result);
ODE_API void dJointGetHinge2Anchor2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetHinge2Angle1(dJointID joint);
ODE_API dReal dJointGetHinge2Angle1Rate(dJointID joint);
ODE_API dReal dJointGetHinge2Angle2(dJointID joint);
ODE_API dReal dJointGetHinge2Angle2Rate(dJointID joint);
ODE_API void dJointGetHinge2Axis1(dJointID joint, dVector3 result);
ODE_API void dJointGetHinge2Axis2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetHinge2Param(dJointID joint, int parameter);
ODE_API void dJointSetHinge2Anchor(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetHinge2Axes(dJointID joint, const dReal *axis1, const dReal *axis2);
ODE_API ODE_API_DEPRECATED void dJointSetHinge2Axis1(dJointID joint, dReal x, dReal y, dReal z);
ODE_API ODE_API_DEPRECATED void dJointSetHinge2Axis2(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetHinge2Param(dJointID joint, int parameter, dReal value);

/* A slider along axis 1, then a hinge about axis 2. */
ODE_API void dJointAddPRTorque(dJointID joint, dReal torque);
ODE_API void dJointGetPRAnchor(dJointID joint, dVector3 result);
ODE_API dReal dJointGetPRAngle(dJointID joint);
ODE_API dReal dJointGetPRAngleRate(dJointID joint);
ODE_API void dJointGetPRAxis1(dJointID joint, dVector3 result);
ODE_API void dJointGetPRAxis2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetPRParam(dJointID joint, int parameter);
ODE_API dReal dJointGetPRPosition(dJointID joint);
ODE_API dReal dJointGetPRPositionRate(dJointID joint);
ODE_API void dJointSetPRAnchor(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetPRAxis1(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetPRAxis2(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetPRParam(dJointID joint, int parameter, dReal value);

/* A slider along axis 3 (P), then a universal joint. */
ODE_API void dJointGetPUAnchor(dJointID joint, dVector3 result);
ODE_API dReal dJointGetPUAngle1(dJointID joint);
ODE_API dReal dJointGetPUAngle1Rate(dJointID joint);
ODE_API dReal dJointGetPUAngle2(dJointID joint);
ODE_API dReal dJointGetPUAngle2Rate(dJointID joint);
ODE_API void dJointGetPUAngles(dJointID joint, dReal *angle1, dReal *angle2);
ODE_API void dJointGetPUAxis1(dJointID joint, dVector3 result);
ODE_API void dJointGetPUAxis2(dJointID joint, dVector3 result);
ODE_API void dJointGetPUAxis3(dJointID joint, dVector3 result);
ODE_API void dJointGetPUAxisP(dJointID joint, dVector3 result);
ODE_API dReal dJointGetPUParam(dJointID joint, int parameter);
ODE_API dReal dJointGetPUPosition(dJointID joint);
ODE_API dReal dJointGetPUPositionRate(dJointID joint);
ODE_API void dJointSetPUAnchor(dJointID joint, dReal x, dReal y, dReal z);
ODE_API ODE_API_DEPRECATED void dJointSetPUAnchorDelta(dJointID joint, dReal x, dReal y, dReal z, dReal dx, dReal
        dy, dReal dz);
ODE_API void dJointSetPUAnchorOffset(dJointID joint, dReal x, dReal y, dReal z, dReal dx, dReal dy, dReal dz);
ODE_API void dJointSetPUAxis1(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetPUAxis2(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetPUAxis3(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetPUAxisP(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetPUParam(dJointID joint, int parameter, dReal value);
ODE_API void dJointAddPUTorques(dJointID joint, dReal torque1, dReal torque2);

/* A slider that may turn about its axis. */
ODE_API void dJointAddPistonForce(dJointID joint, dReal force);
ODE_API void dJointGetPistonAnchor(dJointID joint, dVector3 result);
ODE_API void dJointGetPistonAnchor2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetPistonAngle(dJointID joint);
ODE_API dReal dJointGetPistonAngleRate(dJointID joint);
ODE_API void dJointGetPistonAxis(dJointID joint, dVector3 result);
ODE_API dReal dJointGetPistonParam(dJointID joint, int parameter);
ODE_API dReal dJointGetPistonPosition(dJointID joint);
ODE_API dReal dJointGetPistonPositionRate(dJointID joint);
ODE_API void dJointSetPistonAnchor(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetPistonAnchorOffset(dJointID joint, dReal x, dReal y, dReal z, dReal dx, dReal dy, dReal dz);
ODE_API void dJointSetPistonAxis(dJointID joint, dReal x, dReal y, dReal z);
ODE_API ODE_API_DEPRECATED void dJointSetPistonAxisDelta(dJointID joint, dReal x, dReal y, dReal z, dReal ax, dReal
        ay, dReal az);
ODE_API void dJointSetPistonParam(dJointID joint, int parameter, dReal value);

/* Fixed joints. */
ODE_API dReal dJointGetFixedParam(dJointID joint, int parameter);
ODE_API void dJointSetFixed(dJointID joint);
ODE_API void dJointSetFixedParam(dJointID joint, int parameter, dReal value);

/* Angular motors: up to three axes, each fixed to the world (0), the first body (1) or the second (2). */
ODE_API void dJointAddAMotorTorques(dJointID joint, dReal torque1, dReal torque2, dReal torque3);
ODE_API dReal dJointGetAMotorAngle(dJointID joint, int axis);
ODE_API dReal dJointGetAMotorAngleRate(dJointID joint, int axis);
ODE_API void dJointGetAMotorAxis(dJointID joint, int axis, dVector3 result);
ODE_API int dJointGetAMotorAxisRel(dJointID joint, int axis);
ODE_API int dJointGetAMotorMode(dJointID joint);
ODE_API int dJointGetAMotorNumAxes(dJointID joint);
ODE_API dReal dJointGetAMotorParam(dJointID joint, int parameter);
ODE_API void dJointSetAMotorAngle(dJointID joint, int axis, dReal angle);
ODE_API void dJointSetAMotorAxis(dJointID joint, int axis, int frame, dReal x, dReal y, dReal z);
ODE_API void dJointSetAMotorMode(dJointID joint, int mode);
ODE_API void dJointSetAMotorNumAxes(dJointID joint, int number);
ODE_API void dJointSetAMotorParam(dJointID joint, int parameter, dReal value);

/* Linear motors, likewise. */
ODE_API void dJointGetLMotorAxis(dJointID joint, int axis, dVector3 result);
ODE_API int dJointGetLMotorNumAxes(dJointID joint);
ODE_API dReal dJointGetLMotorParam(dJointID joint, int parameter);
ODE_API void dJointSetLMotorAxis(dJointID joint, int axis, int frame, dReal x, dReal y, dReal z);
ODE_API void dJointSetLMotorNumAxes(dJointID joint, int number);
ODE_API void dJointSetLMotorParam(dJointID joint, int parameter, dReal value);

/* Bodies held in the plane z = 0. */
ODE_API void dJointSetPlane2DAngleParam(dJointID joint, int parameter, dReal value);
ODE_API void dJointSetPlane2DXParam(dJointID joint, int parameter, dReal value);
ODE_API void dJointSetPlane2DYParam(dJointID joint, int parameter, dReal value);

/* Two points at a fixed distance. */
ODE_API void dJointGetDBallAnchor1(dJointID joint, dVector3 result);
ODE_API void dJointGetDBallAnchor2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetDBallDistance(dJointID joint);
ODE_API dReal dJointGetDBallParam(dJointID joint, int parameter);
ODE_API void dJointSetDBallAnchor1(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetDBallAnchor2(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetDBallDistance(dJointID joint, dReal dist);
ODE_API void dJointSetDBallParam(dJointID joint, int parameter, dReal value);

/* The same, in a plane. */
ODE_API void dJointGetDHingeAnchor1(dJointID joint, dVector3 result);
ODE_API void dJointGetDHingeAnchor2(dJointID joint, dVector3 result);
ODE_API void dJointGetDHingeAxis(dJointID joint, dVector3 result);
ODE_API dReal dJointGetDHingeDistance(dJointID joint);
ODE_API dReal dJointGetDHingeParam(dJointID joint, int parameter);
ODE_API void dJointSetDHingeAnchor1(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetDHingeAnchor2(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetDHingeAxis(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetDHingeParam(dJointID joint, int parameter, dReal value);

/* Gears and chain drives. */
ODE_API void dJointGetTransmissionAnchor1(dJointID joint, dVector3 result);
ODE_API void dJointGetTransmissionAnchor2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetTransmissionAngle1(dJointID joint);
ODE_API dReal dJointGetTransmissionAngle2(dJointID joint);
ODE_API void dJointGetTransmissionAxis(dJointID joint, dVector3 result);
ODE_API void dJointGetTransmissionAxis1(dJointID joint, dVector3 result);
ODE_API void dJointGetTransmissionAxis2(dJointID joint, dVector3 result);
ODE_API dReal dJointGetTransmissionBacklash(dJointID joint);
ODE_API void dJointGetTransmissionContactPoint1(dJointID joint, dVector3 result);
ODE_API void dJointGetTransmissionContactPoint2(dJointID joint, dVector3 result);
ODE_API int dJointGetTransmissionMode(dJointID joint);
ODE_API dReal dJointGetTransmissionParam(dJointID joint, int parameter);
ODE_API dReal dJointGetTransmissionRadius1(dJointID joint);
ODE_API dReal dJointGetTransmissionRadius2(dJointID joint);
ODE_API dReal dJointGetTransmissionRatio(dJointID joint);
ODE_API void dJointSetTransmissionAnchor1(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetTransmissionAnchor2(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetTransmissionAxis(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetTransmissionAxis1(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetTransmissionAxis2(dJointID joint, dReal x, dReal y, dReal z);
ODE_API void dJointSetTransmissionBacklash(dJointID joint, dReal backlash);
ODE_API void dJointSetTransmissionMode(dJointID joint, int mode);
ODE_API void dJointSetTransmissionParam(dJointID joint, int parameter, dReal value);
ODE_API void dJointSetTransmissionRadius1(dJointID joint, dReal radius);
ODE_API void dJointSetTransmissionRadius2(dJointID joint, dReal radius);
ODE_API void dJointSetTransmissionRatio(dJointID joint, dReal ratio);

#ifdef __cplusplus
}
#endif

#endif
