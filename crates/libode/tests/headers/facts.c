/* Sizes, offsets, macro constants, and what the inline functions and macros of vectors and matrices compute. The names of
   enumerators are taken from the installed headers by the test and come by the included file. */
#include <ode/ode.h>
#include <stddef.h>
#include <stdio.h>

#define SIZE(T) printf("sizeof " #T " %zu\n", sizeof(T))
#define AT(T, m) printf("offsetof " #T "." #m " %zu %zu\n", offsetof(T, m), sizeof(((T *)0)->m))
#define INT(x) printf(#x " %ld\n", (long)(x))
#define NUM(x) printf(#x " %.17g\n", (double)(x))

static void show(const char *name, const dReal *x, int n) {
    int i;
    printf("%s", name);
    for (i = 0; i < n; i++) printf(" %.17g", (double)x[i]);
    printf("\n");
}

static dReal A[16], B[16], C[16], R[20];
static void fresh(void) {
    int i;
    for (i = 0; i < 16; i++) {
        A[i] = REAL(0.25) * (dReal)((i * 7) % 11) - 1;
        B[i] = REAL(0.5) * (dReal)((i * 5) % 13) - 2;
        C[i] = (dReal)((i * 3) % 7) - 3;
    }
    for (i = 0; i < 20; i++) R[i] = (dReal)(100 + i);
}
#define DO(call) do { fresh(); call; show(#call, R, 20); } while (0)
#define NUMBER(call) do { fresh(); printf(#call " %.17g\n", (double)(call)); } while (0)

int main(void) {
    SIZE(dReal); SIZE(dVector3); SIZE(dVector4); SIZE(dMatrix3); SIZE(dMatrix4); SIZE(dMatrix6); SIZE(dQuaternion);
    SIZE(dTriIndex); SIZE(dint64); SIZE(duint64); SIZE(dint32); SIZE(duint32); SIZE(dint16); SIZE(duint16); SIZE(dint8);
    SIZE(duint8); SIZE(dintptr); SIZE(duintptr); SIZE(ddiffint); SIZE(dsizeint); SIZE(dJointType);
    SIZE(dMeshTriangleVertex); SIZE(dSpaceAxis); SIZE(dMotionDynamics); SIZE(dDynamicsAxis); SIZE(dVec3Element);
    SIZE(dVec4Element); SIZE(dMat3Element); SIZE(dMat4Element); SIZE(dQuatElement); SIZE(dmutexindex_t);
    SIZE(ddependencycount_t); SIZE(ddependencychange_t); SIZE(dcallindex_t);
    SIZE(dWorldID); SIZE(dBodyID); SIZE(dGeomID); SIZE(dSpaceID); SIZE(dJointID); SIZE(dJointGroupID); SIZE(dTriMeshDataID);
    SIZE(dHeightfieldDataID); SIZE(dThreadingImplementationID); SIZE(dThreadingThreadPoolID); SIZE(dMutexGroupID);
    SIZE(dCallReleaseeID); SIZE(dCallWaitID); SIZE(dCooperativeID); SIZE(dResourceRequirementsID);
    SIZE(dResourceContainerID);

    SIZE(dMass); AT(dMass, mass); AT(dMass, c); AT(dMass, I);
    SIZE(dSurfaceParameters); AT(dSurfaceParameters, mode); AT(dSurfaceParameters, mu); AT(dSurfaceParameters, mu2);
    AT(dSurfaceParameters, rho); AT(dSurfaceParameters, rho2); AT(dSurfaceParameters, rhoN);
    AT(dSurfaceParameters, bounce); AT(dSurfaceParameters, bounce_vel); AT(dSurfaceParameters, soft_erp);
    AT(dSurfaceParameters, soft_cfm); AT(dSurfaceParameters, motion1); AT(dSurfaceParameters, motion2);
    AT(dSurfaceParameters, motionN); AT(dSurfaceParameters, slip1); AT(dSurfaceParameters, slip2);
    SIZE(dContactGeom); AT(dContactGeom, pos); AT(dContactGeom, normal); AT(dContactGeom, depth); AT(dContactGeom, g1);
    AT(dContactGeom, g2); AT(dContactGeom, side1); AT(dContactGeom, side2);
    SIZE(dContact); AT(dContact, surface); AT(dContact, geom); AT(dContact, fdir1);
    SIZE(dJointFeedback); AT(dJointFeedback, f1); AT(dJointFeedback, t1); AT(dJointFeedback, f2); AT(dJointFeedback, t2);
    SIZE(dGeomClass); AT(dGeomClass, bytes); AT(dGeomClass, collider); AT(dGeomClass, aabb); AT(dGeomClass, aabb_test);
    AT(dGeomClass, dtor);
    SIZE(dStopwatch); AT(dStopwatch, time); AT(dStopwatch, cc);
    SIZE(dWorldStepReserveInfo); AT(dWorldStepReserveInfo, struct_size); AT(dWorldStepReserveInfo, reserve_factor);
    AT(dWorldStepReserveInfo, reserve_minimum);
    SIZE(dWorldStepMemoryFunctionsInfo); AT(dWorldStepMemoryFunctionsInfo, struct_size);
    AT(dWorldStepMemoryFunctionsInfo, alloc_block); AT(dWorldStepMemoryFunctionsInfo, shrink_block);
    AT(dWorldStepMemoryFunctionsInfo, free_block);
    SIZE(dThreadedWaitTime); AT(dThreadedWaitTime, wait_sec); AT(dThreadedWaitTime, wait_nsec);
    SIZE(dThreadingFunctionsInfo); AT(dThreadingFunctionsInfo, struct_size); AT(dThreadingFunctionsInfo, alloc_mutex_group);
    AT(dThreadingFunctionsInfo, free_mutex_group); AT(dThreadingFunctionsInfo, lock_group_mutex);
    AT(dThreadingFunctionsInfo, unlock_group_mutex); AT(dThreadingFunctionsInfo, alloc_call_wait);
    AT(dThreadingFunctionsInfo, reset_call_wait); AT(dThreadingFunctionsInfo, free_call_wait);
    AT(dThreadingFunctionsInfo, post_call); AT(dThreadingFunctionsInfo, alter_call_dependencies_count);
    AT(dThreadingFunctionsInfo, wait_call); AT(dThreadingFunctionsInfo, retrieve_thread_count);
    AT(dThreadingFunctionsInfo, preallocate_resources_for_calls);

#ifdef __cplusplus
    SIZE(dWorld); SIZE(dBody); SIZE(dJointGroup); SIZE(dJoint); SIZE(dBallJoint); SIZE(dHingeJoint); SIZE(dSliderJoint);
    SIZE(dUniversalJoint); SIZE(dHinge2Joint); SIZE(dPRJoint); SIZE(dPUJoint); SIZE(dPistonJoint); SIZE(dFixedJoint);
    SIZE(dContactJoint); SIZE(dNullJoint); SIZE(dAMotorJoint); SIZE(dLMotorJoint); SIZE(dGeom); SIZE(dSpace);
    SIZE(dSimpleSpace); SIZE(dHashSpace); SIZE(dQuadTreeSpace); SIZE(dSphere); SIZE(dBox); SIZE(dPlane); SIZE(dCapsule);
    SIZE(dCylinder); SIZE(dRay); SIZE(dGeomTransform); SIZE(dWorldSimpleIDContainer); SIZE(dBodySimpleIDContainer);
    SIZE(dJointSimpleIDContainer); SIZE(dJointGroupSimpleIDContainer);
#endif

#include "enumerators.inc"

    INT(CONTACTS_UNIMPORTANT); INT(dSAP_AXES_XYZ); INT(dSAP_AXES_XZY); INT(dSAP_AXES_YXZ); INT(dSAP_AXES_YZX);
    INT(dSAP_AXES_ZXY); INT(dSAP_AXES_ZYX); INT(dTHREADING_THREAD_COUNT_UNLIMITED); INT(dWORLDSTEP_THREADCOUNT_UNLIMITED);
    INT(dWORLDSTEP_RESERVESIZE_DEFAULT); NUM(dWORLDSTEP_RESERVEFACTOR_DEFAULT); INT(dCCylinderClass); NUM(dInfinity);
    INT(dNaN != dNaN); NUM(REAL(0.1)); NUM(M_PI); NUM(M_PI_2); NUM(M_SQRT1_2); printf("%s\n", dODE_VERSION);
    INT(dPAD(0)); INT(dPAD(1)); INT(dPAD(2)); INT(dPAD(4)); INT(dPAD(5)); INT(dPAD(8));

    NUMBER(dRecip(A[1])); NUMBER(dSqrt(B[4] + 9)); NUMBER(dRecipSqrt(REAL(3.0))); NUMBER(dSin(A[2])); NUMBER(dCos(A[2]));
    NUMBER(dFabs(A[0])); NUMBER(dAtan2(A[1], A[2])); NUMBER(dAsin(REAL(0.3))); NUMBER(dAcos(REAL(0.3)));
    NUMBER(dFMod(REAL(7.5), REAL(2.0))); NUMBER(dFloor(A[0] - REAL(0.1))); NUMBER(dCeil(A[1] + REAL(0.1)));
    NUMBER(dCopySign(A[1], -B[1])); NUMBER(dNextAfter(A[1], B[1])); NUMBER(dMin(A[1], B[1])); NUMBER(dMax(A[1], B[1]));
    NUMBER(dACCESS33(A, 1, 2)); NUMBER(dCalcVectorLength3(A)); NUMBER(dCalcVectorLengthSquare3(A));
    NUMBER(dCalcPointDepth3(A, B, C)); NUMBER(dCalcVectorDot3(A, B)); NUMBER(dCalcVectorDot3_13(A, B));
    NUMBER(dCalcVectorDot3_31(A, B)); NUMBER(dCalcVectorDot3_33(A, B)); NUMBER(dCalcVectorDot3_14(A, B));
    NUMBER(dCalcVectorDot3_41(A, B)); NUMBER(dCalcVectorDot3_44(A, B)); NUMBER(dCalcPointsDistance3(A, B));
    NUMBER(dCalcMatrix3Det(C)); NUMBER(dLENGTHSQUARED(A)); NUMBER(dLENGTH(A)); NUMBER(dDISTANCE(A, B));
    NUMBER(dDOT(A, B)); NUMBER(dDOT13(A, B)); NUMBER(dDOT31(A, B)); NUMBER(dDOT33(A, B)); NUMBER(dDOT14(A, B));
    NUMBER(dDOT41(A, B)); NUMBER(dDOT44(A, B));

    DO(dZeroVector3(R)); DO(dAssignVector3(R, 1, 2, 3)); DO(dZeroMatrix3(R)); DO(dZeroMatrix4(R)); DO(dAddVectors3(R, A, B));
    DO(dSubtractVectors3(R, A, B)); DO(dAddVectorScaledVector3(R, A, B, 3)); DO(dAddScaledVectors3(R, A, B, 2, 3));
    DO(dAddThreeScaledVectors3(R, A, B, C, 2, 3, 4)); DO(dScaleVector3(R, 3)); DO(dNegateVector3(R)); DO(dCopyVector3(R, A));
    DO(dCopyScaledVector3(R, A, 3)); DO(dCopyNegatedVector3(R, A)); DO(dCopyVector4(R, A)); DO(dCopyMatrix4x4(R, A));
    DO(dCopyMatrix4x3(R, A)); DO(dGetMatrixColumn3(R, A, 2)); DO(dCalcVectorCross3(R, A, B));
    DO(dCalcVectorCross3_114(R, A, B)); DO(dCalcVectorCross3_141(R, A, B)); DO(dCalcVectorCross3_144(R, A, B));
    DO(dCalcVectorCross3_411(R, A, B)); DO(dCalcVectorCross3_414(R, A, B)); DO(dCalcVectorCross3_441(R, A, B));
    DO(dCalcVectorCross3_444(R, A, B)); DO(dAddVectorCross3(R, A, B)); DO(dSubtractVectorCross3(R, A, B));
    DO(dSetCrossMatrixPlus(R, A, 4)); DO(dSetCrossMatrixMinus(R, A, 5)); DO(dMultiplyHelper0_331(R, A, B));
    DO(dMultiplyHelper1_331(R, A, B)); DO(dMultiplyHelper0_133(R, A, B)); DO(dMultiplyHelper1_133(R, A, B));
    DO(dMultiply0_331(R, A, B)); DO(dMultiply1_331(R, A, B)); DO(dMultiply0_133(R, A, B)); DO(dMultiply0_333(R, A, B));
    DO(dMultiply1_333(R, A, B)); DO(dMultiply2_333(R, A, B)); DO(dMultiplyAdd0_331(R, A, B)); DO(dMultiplyAdd1_331(R, A, B));
    DO(dMultiplyAdd0_133(R, A, B)); DO(dMultiplyAdd0_333(R, A, B)); DO(dMultiplyAdd1_333(R, A, B));
    DO(dMultiplyAdd2_333(R, A, B)); DO(NUM(dInvertMatrix3(R, C))); DO((dZeroMatrix3(C), NUM(dInvertMatrix3(R, C))));
    DO(dAddVectors3(R, R, R)); DO(dCalcVectorCross3(R, R, A)); DO(dMultiply0_331(R, A, R)); DO(dMultiply1_331(R, A, R));
    DO(dOP(R, +, A, B)); DO(dOPC(R, *, A, 3)); DO(dOPE(R, +=, A)); DO(dOPEC(R, *=, 3)); DO(dOPE2(R, +=, A, *, B));
    DO(dCROSS(R, =, A, B)); DO(dCROSS(R, +=, A, B)); DO(dCROSSpqr(R, -=, A, B, 1, 2, 3)); DO(dCROSS114(R, =, A, B));
    DO(dCROSS141(R, =, A, B)); DO(dCROSS144(R, =, A, B)); DO(dCROSS411(R, =, A, B)); DO(dCROSS414(R, =, A, B));
    DO(dCROSS441(R, =, A, B)); DO(dCROSS444(R, =, A, B)); DO(dCROSSMAT(R, A, 4, +, -)); DO(dCROSSMAT(R, A, 5, -, +));
    DO(dMULTIPLY0_331(R, A, B)); DO(dMULTIPLY1_331(R, A, B)); DO(dMULTIPLY0_133(R, A, B)); DO(dMULTIPLY0_333(R, A, B));
    DO(dMULTIPLY1_333(R, A, B)); DO(dMULTIPLY2_333(R, A, B)); DO(dMULTIPLYADD0_331(R, A, B));
    DO(dMULTIPLYADD1_331(R, A, B)); DO(dMULTIPLYADD0_133(R, A, B)); DO(dMULTIPLYADD0_333(R, A, B));
    DO(dMULTIPLYADD1_333(R, A, B)); DO(dMULTIPLYADD2_333(R, A, B));
    return 0;
}
