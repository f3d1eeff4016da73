/* Rotations, quaternions, normalisation. */
#include "check.h"

static void message(int number, const char *format, va_list ap) {
    (void)format; (void)ap;
    printf("message %d\n", number);
}

int main(void) {
    dMatrix3 r, s;
    dQuaternion q, p = {0.5, 0.5, 0.5, 0.5}, c = {0.8, 0.6, 0, 0};
    dSetMessageHandler(message);
    memset(r, 0, sizeof r);
#define M(call) do { call; show(#call, r, 12); } while (0)
#define Q(call) do { call; show(#call, q, 4); } while (0)
    M(dRSetIdentity(r));
    M(dRFromAxisAndAngle(r, 1, 2, 3, 0.7));
    M(dRFromAxisAndAngle(r, 0, 0, 0, 0.7));
    M(dRFromEulerAngles(r, 0.1, 0.2, 0.3));
    M(dRFrom2Axes(r, 1, 2, 3, 0, 1, 0));
    M(dRFrom2Axes(r, 1, 2, 3, 0, 0, 0));
    M(dRFromZAxis(r, 1, 2, 3));
    M(dRFromZAxis(r, 0, 0.1, 5));
    Q(dQSetIdentity(q));
    Q(dQFromAxisAndAngle(q, 1, 2, 3, 0.7));
    Q(dQFromAxisAndAngle(q, 0, 0, 0, 0.7));
    Q(dQMultiply0(q, p, c));
    Q(dQMultiply1(q, p, c));
    Q(dQMultiply2(q, p, c));
    Q(dQMultiply3(q, p, c));
    M(dRfromQ(r, p));
    for (int i = 0; i < 8; i++) {
        dRFromAxisAndAngle(s, 1 - i, i * 0.5, 0.3 * i * i - 1, 0.9 * i);
        Q(dQfromR(q, s));
    }
    dVector3 w = {0.3, 0.2, 0.1};
    Q(dDQfromW(q, w, p));

    dVector3 v = {3, 4, 12}, zero = {0, 0, 0}, tiny = {1e-200, 2e-200, -1e-200}, a, b;
    I1(dSafeNormalize3, v);
    show("v", v, 3);
    I1(dSafeNormalize3, zero);
    I1(dSafeNormalize3, tiny);
    show("tiny", tiny, 3);
    v[0] = 7;
    dNormalize3(v);
    show("v", v, 3);
    dVector4 u = {1, 2, 3, 4}, none = {0, 0, 0, 0};
    I1(dSafeNormalize4, u);
    show("u", u, 4);
    I1(dSafeNormalize4, none);
    u[0] = 9;
    dNormalize4(u);
    show("u", u, 4);
    dPlaneSpace(v, a, b);
    show("a", a, 3);
    show("b", b, 3);
    dVector3 up = {0, 0, 1};
    dPlaneSpace(up, a, b);
    show("a", a, 3);
    show("b", b, 3);
    dMatrix3 skew = {2, 0, 0, 0, 1, 1, 0, 0, 0, 0, 5, 0}, flat = {0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 5, 0};
    I1(dOrthogonalizeR, skew);
    show("skew", skew, 12);
    I1(dOrthogonalizeR, flat);
    return 0;
}
