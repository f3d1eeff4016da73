/* Rotation matrices and quaternions, each function by name; products, conversions, normal vectors. */
#include "check.h"

#define R(f, ...) do { dMatrix3 r_; memset(r_, 0, sizeof r_); f(r_, __VA_ARGS__); CHECK(f, r_, 12); } while (0)
#define Q(f, ...) do { dQuaternion q_ = {9, 9, 9, 9}; f(q_, __VA_ARGS__); CHECK(f, q_, 4); } while (0)

int main(void) {
    dMatrix3 r = {9, 9, 9, 0, 9, 9, 9, 0, 9, 9, 9, 0};
    dQuaternion p = {0.5, -0.5, 0.5, 0.5}, c = {0.8, 0, 0.6, 0}, q = {9, 9, 9, 9};
    dRSetIdentity(r);
    CHECK(dRSetIdentity, r, 12);
    R(dRFromAxisAndAngle, 3, 2, 1, -0.7);
    R(dRFromEulerAngles, 0.3, -0.2, 1.1);
    R(dRFrom2Axes, 1, 2, 2, 2, 1, -1);
    R(dRFromZAxis, 0.3, -0.4, 1.2);
    R(dRfromQ, p);
    dQSetIdentity(q);
    CHECK(dQSetIdentity, q, 4);
    Q(dQFromAxisAndAngle, 3, 2, 1, -0.7);
    Q(dQMultiply0, p, c);
    Q(dQMultiply1, p, c);
    Q(dQMultiply2, p, c);
    Q(dQMultiply3, p, c);
    dRFromAxisAndAngle(r, 1, -2, 3, 2.5);
    Q(dQfromR, r);
    dVector3 w = {0.3, -0.2, 0.9}, v = {3, -4, 12}, a, b;
    Q(dDQfromW, w, p);
    dNormalize3(v);
    CHECK(dNormalize3, v, 3);
    dVector4 u = {1, -2, 3, -4};
    dNormalize4(u);
    CHECK(dNormalize4, u, 4);
    dVector3 far = {5, 12, 0}, none = {0, 0, 0};
    CHECKI(dSafeNormalize3, dSafeNormalize3(far) * 10 + dSafeNormalize3(none));
    CHECK(dSafeNormalize3, far, 3);
    dVector4 quad = {2, 2, 2, 2};
    I1(dSafeNormalize4, quad);
    CHECK(dSafeNormalize4, quad, 4);
    dPlaneSpace(v, a, b);
    CHECK(dPlaneSpace, a, 3);
    CHECK(dPlaneSpace, b, 3);
    dMatrix3 skew = {2, 0.1, 0, 0, 1, 1, 0, 0, 0, 0.3, 5, 0};
    I1(dOrthogonalizeR, skew);
    CHECK(dOrthogonalizeR, skew, 12);
    return 0;
}
