/* Dense products, sums and differences on rows padded to four. */
#include "check.h"

int main(void) {
    static dReal a[64], b[64], c[64], x[8], y[8];
    for (int i = 0; i < 64; i++) b[i] = (i * 7 % 11) * 0.25f - 1, c[i] = (i * 5 % 13) * 0.125f;
    for (int i = 0; i < 8; i++) x[i] = i + 1, y[i] = 0.5f * i - 1;
    dMultiply0(a, b, c, 3, 5, 2);
    CHECK(dMultiply0, a, 12);
    dMultiply1(a, b, c, 3, 5, 2);
    CHECK(dMultiply1, a, 12);
    dMultiply2(a, b, c, 3, 5, 2);
    CHECK(dMultiply2, a, 12);
    R1(dDot, x, y, 8);
    R1(dMaxDifference, b, c, 4, 6);
    R1(dMaxDifferenceLowerTriangle, b, c, 6);
    dSetZero(x, 3);
    CHECK(dSetZero, x, 8);
    dSetValue(x, 5, 2.5);
    CHECK(dSetValue, x, 8);
    dScaleVector(x, y, 8);
    CHECK(dScaleVector, x, 8);
    dSetValue(x, 8, 3);
    dVectorScale(x, y, 8);
    CHECK(dVectorScale, x, 8);
    memcpy(a, b, sizeof a);
    dClearUpperTriangle(a, 5);
    CHECK(dClearUpperTriangle, a, 40);
    memcpy(a, b, sizeof a);
    dRemoveRowCol(a, 5, 8, 2);
    CHECK(dRemoveRowCol, a, 32);
    printf("dPrintMatrix:\n");
    dPrintMatrix(b, 3, 5, "%9.5f ", stdout);
    return 0;
}
