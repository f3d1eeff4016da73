/* Numbers, vectors and matrices, handles, and the constants of joints. */
#ifndef FERRODE_ODE_COMMON_H
#define FERRODE_ODE_COMMON_H

#include <ode/odeconfig.h>
#include <ode/error.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(dSINGLE)
typedef float dReal;
#define REAL(x) (x##f)
#else
typedef double dReal;
#define REAL(x) (x)
#endif

/* Corner indices of triangle meshes. */
#if defined(dTRIMESH_16BIT_INDICES) && dTRIMESH_16BIT_INDICES
typedef duint16 dTriIndex;
#else
typedef duint32 dTriIndex;
#endif

#ifndef M_PI
#define M_PI REAL(3.1415926535897932384626433832795029)
#endif
#ifndef M_PI_2
#define M_PI_2 REAL(1.5707963267948966192313216916397514)
#endif
#ifndef M_SQRT1_2
#define M_SQRT1_2 REAL(0.7071067811865475244008443621048490)
#endif

/* The length of a matrix row of `a` numbers in memory: padded to a multiple of four, but for one number. */
#define dPAD(a) ((a) > 1 ? (((a) + 3) / 4) * 4 : (a))

/* Where the components of vectors, matrices and quaternions are. Names with two underscores bound ranges. */
typedef enum {
    dSA__MIN = 0,
    dSA_X = 0,
    dSA_Y = 1,
    dSA_Z = 2,
    dSA__MAX = 3
} dSpaceAxis;

typedef enum {
    dMD__MIN = 0,
    dMD_LINEAR = 0,
    dMD_ANGULAR = 1,
    dMD__MAX = 2
} dMotionDynamics;

typedef enum {
    dDA__MIN = 0,
    dDA__L_MIN = 0,
    dDA_LX = 0,
    dDA_LY = 1,
    dDA_LZ = 2,
    dDA__L_MAX = 3,
    dDA__A_MIN = 3,
    dDA_AX = 3,
    dDA_AY = 4,
    dDA_AZ = 5,
    dDA__A_MAX = 6,
    dDA__MAX = 6
} dDynamicsAxis;

typedef enum {
    dV3E__MIN = 0,
    dV3E__AXES_MIN = 0,
    dV3E_X = 0,
    dV3E_Y = 1,
    dV3E_Z = 2,
    dV3E__AXES_MAX = 3,
    dV3E__AXES_COUNT = 3,
    dV3E_PAD = 3,
    dV3E__MAX = 4
} dVec3Element;

typedef enum {
    dV4E__MIN = 0,
    dV4E_X = 0,
    dV4E_Y = 1,
    dV4E_Z = 2,
    dV4E_O = 3,
    dV4E__MAX = 4
} dVec4Element;

typedef enum {
    dM3E__MIN = 0,
    dM3E__X_MIN = 0,
    dM3E__X_AXES_MIN = 0,
    dM3E_XX = 0,
    dM3E_XY = 1,
    dM3E_XZ = 2,
    dM3E__X_AXES_MAX = 3,
    dM3E_XPAD = 3,
    dM3E__X_MAX = 4,
    dM3E__Y_MIN = 4,
    dM3E__Y_AXES_MIN = 4,
    dM3E_YX = 4,
    dM3E_YY = 5,
    dM3E_YZ = 6,
    dM3E__Y_AXES_MAX = 7,
    dM3E_YPAD = 7,
    dM3E__Y_MAX = 8,
    dM3E__Z_MIN = 8,
    dM3E__Z_AXES_MIN = 8,
    dM3E_ZX = 8,
    dM3E_ZY = 9,
    dM3E_ZZ = 10,
    dM3E__Z_AXES_MAX = 11,
    dM3E_ZPAD = 11,
    dM3E__Z_MAX = 12,
    dM3E__MAX = 12
} dMat3Element;

typedef enum {
    dM4E__MIN = 0,
    dM4E__X_MIN = 0,
    dM4E_XX = 0,
    dM4E_XY = 1,
    dM4E_XZ = 2,
    dM4E_XO = 3,
    dM4E__X_MAX = 4,
    dM4E__Y_MIN = 4,
    dM4E_YX = 4,
    dM4E_YY = 5,
    dM4E_YZ = 6,
    dM4E_YO = 7,
    dM4E__Y_MAX = 8,
    dM4E__Z_MIN = 8,
    dM4E_ZX = 8,
    dM4E_ZY = 9,
    dM4E_ZZ = 10,
    dM4E_ZO = 11,
    dM4E__Z_MAX = 12,
    dM4E__O_MIN = 12,
    dM4E_OX = 12,
    dM4E_OY = 13,
    dM4E_OZ = 14,
    dM4E_OO = 15,
    dM4E__O_MAX = 16,
    dM4E__MAX = 16
} dMat4Element;

typedef enum {
    dQUE__MIN = 0,
    dQUE_R = 0,
    dQUE__AXIS_MIN = 1,
    dQUE_I = 1,
    dQUE_J = 2,
    dQUE_K = 3,
    dQUE__AXIS_MAX = 4,
    dQUE__MAX = 4
} dQuatElement;

/* Vectors are three numbers and one of padding; rotation matrices are three such rows; quaternions are (w, x, y, z). */
typedef dReal dVector3[4];
typedef dReal dVector4[4];
typedef dReal dMatrix3[3 * 4];
typedef dReal dMatrix4[4 * 4];
typedef dReal dMatrix6[6 * 8];
typedef dReal dQuaternion[4];

/* The C library's functions for dReal. */
#if defined(dSINGLE)
#define dSqrt(x) sqrtf(x)
#define dSin(x) sinf(x)
#define dCos(x) cosf(x)
#define dFabs(x) fabsf(x)
#define dAtan2(y, x) atan2f((y), (x))
#define dAsin(x) asinf(x)
#define dAcos(x) acosf(x)
#define dFMod(a, b) fmodf((a), (b))
#define dFloor(x) floorf(x)
#define dCeil(x) ceilf(x)
#define dCopySign(a, b) _ode_copysignf(a, b)
#define dNextAfter(x, y) _ode_nextafterf(x, y)
#else
#define dSqrt(x) sqrt(x)
#define dSin(x) sin(x)
#define dCos(x) cos(x)
#define dFabs(x) fabs(x)
#define dAtan2(y, x) atan2((y), (x))
#define dAsin(x) asin(x)
#define dAcos(x) acos(x)
#define dFMod(a, b) fmod((a), (b))
#define dFloor(x) floor(x)
#define dCeil(x) ceil(x)
#define dCopySign(a, b) _ode_copysign(a, b)
#define dNextAfter(x, y) _ode_nextafter(x, y)
#endif
#define dRecip(x) (REAL(1.0) / (x))
#define dRecipSqrt(x) (REAL(1.0) / dSqrt(x))

ODE_PURE_INLINE int _dIsNan(dReal x) { return x != x; }
#define dIsNan(x) _dIsNan(x)

ODE_PURE_INLINE dReal dMin(dReal x, dReal y) { return y < x ? y : x; }
ODE_PURE_INLINE dReal dMax(dReal x, dReal y) { return x > y ? x : y; }

/* Handles. Null stands for none. A dSpaceID is also the dGeomID of the same address. */
typedef struct dxWorld *dWorldID;
typedef struct dxBody *dBodyID;
typedef struct dxGeom *dGeomID;
typedef struct dxSpace *dSpaceID;
typedef struct dxJoint *dJointID;
typedef struct dxJointGroup *dJointGroupID;

/* What the library's error, debug and message calls are about. */
enum {
    d_ERR_UNKNOWN = 0,
    d_ERR_IASSERT = 1,
    d_ERR_UASSERT = 2,
    d_ERR_LCP = 3
};

/* Joint types, as dJointGetType tells. */
typedef enum {
    dJointTypeNone = 0,
    dJointTypeBall = 1,
    dJointTypeHinge = 2,
    dJointTypeSlider = 3,
    dJointTypeContact = 4,
    dJointTypeUniversal = 5,
    dJointTypeHinge2 = 6,
    dJointTypeFixed = 7,
    dJointTypeNull = 8,
    dJointTypeAMotor = 9,
    dJointTypeLMotor = 10,
    dJointTypePlane2D = 11,
    dJointTypePR = 12,
    dJointTypePU = 13,
    dJointTypePiston = 14,
    dJointTypeDBall = 15,
    dJointTypeDHinge = 16,
    dJointTypeTransmission = 17
} dJointType;

/* Joint parameters. A joint of several axes has a group of them an axis: the first is also meant by the names without a
   number, and each further one counts 0x100 more. */
enum {
    dParamLoStop = 0,
    dParamHiStop = 1,
    dParamVel = 2,
    dParamLoVel = 3,
    dParamHiVel = 4,
    dParamFMax = 5,
    dParamFudgeFactor = 6,
    dParamBounce = 7,
    dParamCFM = 8,
    dParamStopERP = 9,
    dParamStopCFM = 10,
    dParamSuspensionERP = 11,
    dParamSuspensionCFM = 12,
    dParamERP = 13,
    dParamsInGroup = 14,
    dParamGroup = 0x100
};
enum {
    dParamLoStop1 = 0,
    dParamHiStop1 = 1,
    dParamVel1 = 2,
    dParamLoVel1 = 3,
    dParamHiVel1 = 4,
    dParamFMax1 = 5,
    dParamFudgeFactor1 = 6,
    dParamBounce1 = 7,
    dParamCFM1 = 8,
    dParamStopERP1 = 9,
    dParamStopCFM1 = 10,
    dParamSuspensionERP1 = 11,
    dParamSuspensionCFM1 = 12,
    dParamERP1 = 13,
    dParamGroup1 = 0
};
enum {
    dParamLoStop2 = 0x100,
    dParamHiStop2 = 0x101,
    dParamVel2 = 0x102,
    dParamLoVel2 = 0x103,
    dParamHiVel2 = 0x104,
    dParamFMax2 = 0x105,
    dParamFudgeFactor2 = 0x106,
    dParamBounce2 = 0x107,
    dParamCFM2 = 0x108,
    dParamStopERP2 = 0x109,
    dParamStopCFM2 = 0x10a,
    dParamSuspensionERP2 = 0x10b,
    dParamSuspensionCFM2 = 0x10c,
    dParamERP2 = 0x10d,
    dParamGroup2 = 0x100
};
enum {
    dParamLoStop3 = 0x200,
    dParamHiStop3 = 0x201,
    dParamVel3 = 0x202,
    dParamLoVel3 = 0x203,
    dParamHiVel3 = 0x204,
    dParamFMax3 = 0x205,
    dParamFudgeFactor3 = 0x206,
    dParamBounce3 = 0x207,
    dParamCFM3 = 0x208,
    dParamStopERP3 = 0x209,
    dParamStopCFM3 = 0x20a,
    dParamSuspensionERP3 = 0x20b,
    dParamSuspensionCFM3 = 0x20c,
    dParamERP3 = 0x20d,
    dParamGroup3 = 0x200
};

/* Modes of angular motors: axes by the program, or Euler angles. */
enum {
    dAMotorUser = 0,
    dAMotorEuler = 1
};

/* Modes of transmissions. */
enum {
    dTransmissionParallelAxes = 0,
    dTransmissionIntersectingAxes = 1,
    dTransmissionChainDrive = 2
};

/* Forces and torques that a joint exerts on its bodies, in world axes and about their centres of mass; each step writes
   them here for a joint that dJointSetFeedback was called for. */
typedef struct dJointFeedback {
    dVector3 f1;
    dVector3 t1;
    dVector3 f2;
    dVector3 t2;
} dJointFeedback;

/* What the library was built with, as words between blanks; 1 if a word is among them. */
ODE_API const char *dGetConfiguration(void);
ODE_API int dCheckConfiguration(const char *token);

/* Says that a geom has moved; the geom after this one on the same body (dBodyGetNextGeom is the usual name). */
ODE_API void dGeomMoved(dGeomID geom);
ODE_API dGeomID dGeomGetBodyNext(dGeomID geom);

#ifdef __cplusplus
}
#endif

#endif
