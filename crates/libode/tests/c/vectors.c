/* The headers' own vector and matrix helpers, compiled into the program: lengths, products, inverses. */
#include "check.h"

int main(void) {
    dVector3 a = {1, 2, 3}, b = {-2, 0.5, 4}, c;
    dMatrix3 m = {2, 1, 0, 0, 0.5, 3, 1, 0, 1, 0, 4, 0}, n, k;
    dRFromAxisAndAngle(n, 1, 2, 3, 0.5);
    dAddVectors3(c, a, b);
    show("sum", c, 3);
    dSubtractVectors3(c, a, b);
    show("difference", c, 3);
    dAddScaledVectors3(c, a, b, 2, -3);
    show("scaled", c, 3);
    dCalcVectorCross3(c, a, b);
    show("cross", c, 3);
    show1("dot", dCalcVectorDot3(a, b));
    show1("length", dCalcVectorLength3(a));
    show1("squared", dCalcVectorLengthSquare3(a));
    show1("distance", dCalcPointsDistance3(a, b));
    dMultiply0_331(c, m, a);
    show("0_331", c, 3);
    dMultiply1_331(c, m, a);
    show("1_331", c, 3);
    dMultiply0_133(c, a, m);
    show("0_133", c, 3);
    memset(k, 0, sizeof k);
    dMultiply0_333(k, m, n);
    show("0_333", k, 11);
    dMultiply1_333(k, m, n);
    show("1_333", k, 11);
    dMultiply2_333(k, m, n);
    show("2_333", k, 11);
    show1("determinant", dCalcMatrix3Det(m));
    show1("inverted", dInvertMatrix3(k, m));
    show("inverse", k, 11);
    dSetCrossMatrixPlus(k, a, 4);
    show("cross matrix", k, 3);
    dNegateVector3(a);
    show("negative", a, 3);
    dScaleVector3(a, 0.5);
    show("half", a, 3);
    return 0;
}
