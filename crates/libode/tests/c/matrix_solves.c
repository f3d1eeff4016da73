/* Factors, solutions and inverses of a definite matrix, and its factors after a change of a row. */
#include "check.h"

enum { N = 6, SKIP = 8 };
static dReal a[N * SKIP], l[N * SKIP], d[N], x[N], inverse[N * SKIP];

static void lower(dReal *m) {
    for (int i = 0; i < N; i++) for (int k = i; k < SKIP; k++) m[i * SKIP + k] = i == k;
}

int main(void) {
    for (int i = 0; i < N; i++) for (int k = 0; k < N; k++) a[i * SKIP + k] = (i == k ? 4 : 0) + 1 / (dReal)(1 + abs(i - k));
    I1(dIsPositiveDefinite, a, N);
    memcpy(l, a, sizeof a);
    I1(dFactorCholesky, l, N);
    dClearUpperTriangle(l, N);
    CHECK(dFactorCholesky, l, N * SKIP);
    for (int i = 0; i < N; i++) x[i] = i - 2;
    dSolveCholesky(l, x, N);
    CHECK(dSolveCholesky, x, N);
    I1(dInvertPDMatrix, a, inverse, N);
    CHECK(dInvertPDMatrix, inverse, N * SKIP);
    memcpy(l, a, sizeof a);
    dFactorLDLT(l, d, N, SKIP);
    lower(l);
    CHECK(dFactorLDLT, l, N * SKIP);
    CHECK(dFactorLDLT, d, N);
    for (int i = 0; i < N; i++) x[i] = i - 2;
    dSolveL1(l, x, N, SKIP);
    CHECK(dSolveL1, x, N);
    dSolveL1T(l, x, N, SKIP);
    CHECK(dSolveL1T, x, N);
    for (int i = 0; i < N; i++) x[i] = i - 2;
    dSolveLDLT(l, d, x, N, SKIP);
    CHECK(dSolveLDLT, x, N);
    dReal row[N] = {0.3, 0.1, -0.2, 0.05, 0, 0.15}, changed[N * SKIP], e[N];
    memcpy(changed, l, sizeof l);
    memcpy(e, d, sizeof d);
    dLDLTAddTL(changed, e, row, N, SKIP);
    for (int i = 0; i < N; i++) changed[i * SKIP] = 0;
    CHECK(dLDLTAddTL, changed, N * SKIP);
    dReal *rows[N];
    int places[N];
    for (int i = 0; i < N; i++) rows[i] = a + i * SKIP, places[i] = i;
    memcpy(changed, l, sizeof l);
    memcpy(e, d, sizeof d);
    dLDLTRemove(rows, places, changed, e, N, N, 2, SKIP);
    for (int i = 0; i < N - 1; i++) for (int k = 0; k < i; k++) CHECK1(dLDLTRemove, changed[i * SKIP + k]);
    CHECK(dLDLTRemove, e, N - 1);
    a[0] = -1;
    CHECKI(dIsPositiveDefinite, dIsPositiveDefinite(a, N));
    return 0;
}
