/* Vectors of three and matrices of three rows of four numbers, computed in the program itself. */
#ifndef FERRODE_ODE_ODEMATH_H
#define FERRODE_ODE_ODEMATH_H

#include <ode/common.h>

#define dACCESS33(A, i, j) ((A)[(i) * 4 + (j)])

/* Whether no number is a NaN. */
#define dVALIDVEC3(v) (!(dIsNan((v)[0]) || dIsNan((v)[1]) || dIsNan((v)[2])))
#define dVALIDVEC4(v) (dVALIDVEC3(v) && !dIsNan((v)[3]))
#define dVALIDMAT3(m) (dVALIDVEC4(m) && dVALIDVEC4((m) + 4) && dVALIDVEC4((m) + 8))
#define dVALIDMAT4(m) (dVALIDMAT3(m) && dVALIDVEC4((m) + 12))

/* Vectors. A result may be one of the arguments; padding is left alone. */
ODE_PURE_INLINE void dAssignVector3(dVector3 res, dReal x, dReal y, dReal z) {
    res[0] = x;
    res[1] = y;
    res[2] = z;
}
ODE_PURE_INLINE void dZeroVector3(dVector3 res) { dAssignVector3(res, 0, 0, 0); }
ODE_PURE_INLINE void dCopyVector3(dReal *res, const dReal *a) { dAssignVector3(res, a[0], a[1], a[2]); }
ODE_PURE_INLINE void dCopyVector4(dReal *res, const dReal *a) {
    const dReal last = a[3];
    dCopyVector3(res, a);
    res[3] = last;
}
ODE_PURE_INLINE void dCopyScaledVector3(dReal *res, const dReal *a, dReal scale) {
    dAssignVector3(res, a[0] * scale, a[1] * scale, a[2] * scale);
}
ODE_PURE_INLINE void dCopyNegatedVector3(dReal *res, const dReal *a) { dAssignVector3(res, -a[0], -a[1], -a[2]); }
ODE_PURE_INLINE void dScaleVector3(dReal *res, dReal scale) { dCopyScaledVector3(res, res, scale); }
ODE_PURE_INLINE void dNegateVector3(dReal *res) { dCopyNegatedVector3(res, res); }
ODE_PURE_INLINE void dAddVectors3(dReal *res, const dReal *a, const dReal *b) {
    dAssignVector3(res, a[0] + b[0], a[1] + b[1], a[2] + b[2]);
}
ODE_PURE_INLINE void dSubtractVectors3(dReal *res, const dReal *a, const dReal *b) {
    dAssignVector3(res, a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
ODE_PURE_INLINE void dAddVectorScaledVector3(dReal *res, const dReal *a, const dReal *b, dReal b_scale) {
    dAssignVector3(res, a[0] + b_scale * b[0], a[1] + b_scale * b[1], a[2] + b_scale * b[2]);
}
ODE_PURE_INLINE void dAddScaledVectors3(dReal *res, const dReal *a, const dReal *b, dReal a_scale, dReal b_scale) {
    dAssignVector3(res, a_scale * a[0] + b_scale * b[0], a_scale * a[1] + b_scale * b[1],
            a_scale * a[2] + b_scale * b[2]);
}
ODE_PURE_INLINE void dAddThreeScaledVectors3(dReal *res, const dReal *a, const dReal *b, const dReal *c, dReal
        a_scale, dReal b_scale, dReal c_scale) {
    dReal sum[3];
    dAddScaledVectors3(sum, a, b, a_scale, b_scale);
    dAddVectorScaledVector3(res, sum, c, c_scale);
}

/* Products and lengths. Names with two digits take strides: 14 is a vector by a column of a matrix. */
ODE_PURE_INLINE dReal _dCalcVectorDot3(const dReal *a, const dReal *b, unsigned int p, unsigned int q) {
    return a[0] * b[0] + a[p] * b[q] + a[2 * p] * b[2 * q];
}
ODE_PURE_INLINE dReal dCalcVectorDot3(const dReal *a, const dReal *b) { return _dCalcVectorDot3(a, b, 1, 1); }
ODE_PURE_INLINE dReal dCalcVectorDot3_13(const dReal *a, const dReal *b) { return _dCalcVectorDot3(a, b, 1, 3); }
ODE_PURE_INLINE dReal dCalcVectorDot3_31(const dReal *a, const dReal *b) { return _dCalcVectorDot3(a, b, 3, 1); }
ODE_PURE_INLINE dReal dCalcVectorDot3_33(const dReal *a, const dReal *b) { return _dCalcVectorDot3(a, b, 3, 3); }
ODE_PURE_INLINE dReal dCalcVectorDot3_14(const dReal *a, const dReal *b) { return _dCalcVectorDot3(a, b, 1, 4); }
ODE_PURE_INLINE dReal dCalcVectorDot3_41(const dReal *a, const dReal *b) { return _dCalcVectorDot3(a, b, 4, 1); }
ODE_PURE_INLINE dReal dCalcVectorDot3_44(const dReal *a, const dReal *b) { return _dCalcVectorDot3(a, b, 4, 4); }
ODE_PURE_INLINE dReal dCalcVectorLengthSquare3(const dReal *a) { return dCalcVectorDot3(a, a); }
ODE_PURE_INLINE dReal dCalcVectorLength3(const dReal *a) { return dSqrt(dCalcVectorLengthSquare3(a)); }
ODE_PURE_INLINE dReal dCalcPointsDistance3(const dReal *a, const dReal *b) {
    dReal between[3];
    dSubtractVectors3(between, a, b);
    return dCalcVectorLength3(between);
}
ODE_PURE_INLINE dReal dCalcPointDepth3(const dReal *point, const dReal *plane_point, const dReal *plane_normal) {
    dReal down[3];
    dSubtractVectors3(down, plane_point, point);
    return dCalcVectorDot3(down, plane_normal);
}
ODE_PURE_INLINE void _dCalcVectorCross3(dReal *res, const dReal *a, const dReal *b, unsigned int o, unsigned int p,
        unsigned int q) {
    const dReal x = a[p] * b[2 * q] - a[2 * p] * b[q];
    const dReal y = a[2 * p] * b[0] - a[0] * b[2 * q];
    const dReal z = a[0] * b[q] - a[p] * b[0];
    res[0] = x;
    res[o] = y;
    res[2 * o] = z;
}
ODE_PURE_INLINE void dCalcVectorCross3(dReal *res, const dReal *a, const dReal *b) {
    _dCalcVectorCross3(res, a, b, 1, 1, 1);
}
ODE_PURE_INLINE void dCalcVectorCross3_114(dReal *res, const dReal *a, const dReal *b) {
    _dCalcVectorCross3(res, a, b, 1, 1, 4);
}
ODE_PURE_INLINE void dCalcVectorCross3_141(dReal *res, const dReal *a, const dReal *b) {
    _dCalcVectorCross3(res, a, b, 1, 4, 1);
}
ODE_PURE_INLINE void dCalcVectorCross3_144(dReal *res, const dReal *a, const dReal *b) {
    _dCalcVectorCross3(res, a, b, 1, 4, 4);
}
ODE_PURE_INLINE void dCalcVectorCross3_411(dReal *res, const dReal *a, const dReal *b) {
    _dCalcVectorCross3(res, a, b, 4, 1, 1);
}
ODE_PURE_INLINE void dCalcVectorCross3_414(dReal *res, const dReal *a, const dReal *b) {
    _dCalcVectorCross3(res, a, b, 4, 1, 4);
}
ODE_PURE_INLINE void dCalcVectorCross3_441(dReal *res, const dReal *a, const dReal *b) {
    _dCalcVectorCross3(res, a, b, 4, 4, 1);
}
ODE_PURE_INLINE void dCalcVectorCross3_444(dReal *res, const dReal *a, const dReal *b) {
    _dCalcVectorCross3(res, a, b, 4, 4, 4);
}
ODE_PURE_INLINE void dAddVectorCross3(dReal *res, const dReal *a, const dReal *b) {
    dReal cross[3];
    dCalcVectorCross3(cross, a, b);
    dAddVectors3(res, res, cross);
}
ODE_PURE_INLINE void dSubtractVectorCross3(dReal *res, const dReal *a, const dReal *b) {
    dReal cross[3];
    dCalcVectorCross3(cross, a, b);
    dSubtractVectors3(res, res, cross);
}

/* Matrices of three rows of four. The 4x4 copy is of three whole rows, the 4x3 copy leaves the padding alone. */
ODE_PURE_INLINE void dZeroMatrix3(dMatrix3 res) {
    dZeroVector3(res);
    dZeroVector3(res + 4);
    dZeroVector3(res + 8);
}
ODE_PURE_INLINE void dZeroMatrix4(dMatrix4 res) {
    int i;
    for (i = 0; i < 16; i++) res[i] = 0;
}
ODE_PURE_INLINE void dCopyMatrix4x4(dReal *res, const dReal *a) {
    dCopyVector4(res, a);
    dCopyVector4(res + 4, a + 4);
    dCopyVector4(res + 8, a + 8);
}
ODE_PURE_INLINE void dCopyMatrix4x3(dReal *res, const dReal *a) {
    dCopyVector3(res, a);
    dCopyVector3(res + 4, a + 4);
    dCopyVector3(res + 8, a + 8);
}
ODE_PURE_INLINE void dGetMatrixColumn3(dReal *res, const dReal *a, unsigned int n) {
    dAssignVector3(res, a[n], a[n + 4], a[n + 8]);
}

/* The matrix of the cross product by a vector, or its negative; the diagonal is left alone. */
ODE_PURE_INLINE void dSetCrossMatrixPlus(dReal *res, const dReal *a, unsigned int skip) {
    const dReal x = a[0], y = a[1], z = a[2];
    res[1] = -z;
    res[2] = y;
    res[skip] = z;
    res[skip + 2] = -x;
    res[2 * skip] = -y;
    res[2 * skip + 1] = x;
}
ODE_PURE_INLINE void dSetCrossMatrixMinus(dReal *res, const dReal *a, unsigned int skip) {
    dReal negative[3];
    dCopyNegatedVector3(negative, a);
    dSetCrossMatrixPlus(res, negative, skip);
}

/* Products: a 0 is A B, a 1 is A' B, a 2 is A B'; 331 is a matrix by a vector, 133 a vector by a matrix. Matrix products may
   not write on their own arguments. */
ODE_PURE_INLINE void dMultiplyHelper0_331(dReal *res, const dReal *a, const dReal *b) {
    dAssignVector3(res, dCalcVectorDot3(a, b), dCalcVectorDot3(a + 4, b), dCalcVectorDot3(a + 8, b));
}
ODE_PURE_INLINE void dMultiplyHelper1_331(dReal *res, const dReal *a, const dReal *b) {
    dAssignVector3(res, dCalcVectorDot3_41(a, b), dCalcVectorDot3_41(a + 1, b), dCalcVectorDot3_41(a + 2, b));
}
ODE_PURE_INLINE void dMultiplyHelper0_133(dReal *res, const dReal *a, const dReal *b) {
    dMultiplyHelper1_331(res, b, a);
}
ODE_PURE_INLINE void dMultiplyHelper1_133(dReal *res, const dReal *a, const dReal *b) {
    dAssignVector3(res, dCalcVectorDot3_44(a, b), dCalcVectorDot3_44(a + 1, b), dCalcVectorDot3_44(a + 2, b));
}
ODE_PURE_INLINE void dMultiply0_331(dReal *res, const dReal *a, const dReal *b) { dMultiplyHelper0_331(res, a, b); }
ODE_PURE_INLINE void dMultiply1_331(dReal *res, const dReal *a, const dReal *b) { dMultiplyHelper1_331(res, a, b); }
ODE_PURE_INLINE void dMultiply0_133(dReal *res, const dReal *a, const dReal *b) { dMultiplyHelper0_133(res, a, b); }
ODE_PURE_INLINE void dMultiply0_333(dReal *res, const dReal *a, const dReal *b) {
    dMultiplyHelper0_133(res, a, b);
    dMultiplyHelper0_133(res + 4, a + 4, b);
    dMultiplyHelper0_133(res + 8, a + 8, b);
}
ODE_PURE_INLINE void dMultiply1_333(dReal *res, const dReal *a, const dReal *b) {
    dMultiplyHelper1_133(res, b, a);
    dMultiplyHelper1_133(res + 4, b, a + 1);
    dMultiplyHelper1_133(res + 8, b, a + 2);
}
ODE_PURE_INLINE void dMultiply2_333(dReal *res, const dReal *a, const dReal *b) {
    dMultiplyHelper0_331(res, b, a);
    dMultiplyHelper0_331(res + 4, b, a + 4);
    dMultiplyHelper0_331(res + 8, b, a + 8);
}
ODE_PURE_INLINE void dMultiplyAdd0_331(dReal *res, const dReal *a, const dReal *b) {
    dReal product[3];
    dMultiplyHelper0_331(product, a, b);
    dAddVectors3(res, res, product);
}
ODE_PURE_INLINE void dMultiplyAdd1_331(dReal *res, const dReal *a, const dReal *b) {
    dReal product[3];
    dMultiplyHelper1_331(product, a, b);
    dAddVectors3(res, res, product);
}
ODE_PURE_INLINE void dMultiplyAdd0_133(dReal *res, const dReal *a, const dReal *b) {
    dReal product[3];
    dMultiplyHelper0_133(product, a, b);
    dAddVectors3(res, res, product);
}
ODE_PURE_INLINE void dMultiplyAdd0_333(dReal *res, const dReal *a, const dReal *b) {
    dReal product[12];
    dMultiply0_333(product, a, b);
    dAddVectors3(res, res, product);
    dAddVectors3(res + 4, res + 4, product + 4);
    dAddVectors3(res + 8, res + 8, product + 8);
}
ODE_PURE_INLINE void dMultiplyAdd1_333(dReal *res, const dReal *a, const dReal *b) {
    dReal product[12];
    dMultiply1_333(product, a, b);
    dAddVectors3(res, res, product);
    dAddVectors3(res + 4, res + 4, product + 4);
    dAddVectors3(res + 8, res + 8, product + 8);
}
ODE_PURE_INLINE void dMultiplyAdd2_333(dReal *res, const dReal *a, const dReal *b) {
    dReal product[12];
    dMultiply2_333(product, a, b);
    dAddVectors3(res, res, product);
    dAddVectors3(res + 4, res + 4, product + 4);
    dAddVectors3(res + 8, res + 8, product + 8);
}

/* The determinant; the inverse, by cofactors. A matrix without one gives 0, and nothing is written. */
ODE_PURE_INLINE dReal dCalcMatrix3Det(const dReal *m) {
    return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[1] * (m[4] * m[10] - m[8] * m[6]) +
            m[2] * (m[4] * m[9] - m[8] * m[5]);
}
ODE_PURE_INLINE dReal dInvertMatrix3(dReal *res, const dReal *m) {
    const dReal det = dCalcMatrix3Det(m);
    dReal scale;
    int i, j;
    if (det == 0) return 0;
    scale = dRecip(det);
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 3; j++) {
            /* The cofactor of row j, column i: indices cyclic, so that no sign is needed. */
            const dReal *p = m + 4 * ((j + 1) % 3), *q = m + 4 * ((j + 2) % 3);
            const int c = (i + 1) % 3, d = (i + 2) % 3;
            res[4 * i + j] = (p[c] * q[d] - q[c] * p[d]) * scale;
        }
    }
    return det;
}

#include <ode/odemath_legacy.h>

#ifdef __cplusplus
extern "C" {
#endif

/* To length 1. The safe ones tell whether that could be done; the others take it for granted. */
ODE_API void dNormalize3(dVector3 a);
ODE_API void dNormalize4(dVector4 a);
ODE_API int dSafeNormalize3(dVector3 a);
ODE_API int dSafeNormalize4(dVector4 a);

/* Two unit vectors at right angles to a unit vector n; a matrix made a rotation again. */
ODE_API void dPlaneSpace(const dVector3 n, dVector3 p, dVector3 q);
ODE_API int dOrthogonalizeR(dMatrix3 m);

#ifdef __cplusplus
}
#endif

#endif
