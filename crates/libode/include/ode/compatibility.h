/* Old names of rotation functions, with their old order of arguments: input first. */
#ifndef FERRODE_ODE_COMPATIBILITY_H
#define FERRODE_ODE_COMPATIBILITY_H

#define dQtoR(q, R) dRfromQ((R), (q))
#define dRtoQ(R, q) dQfromR((q), (R))
#define dWtoDQ(w, q, dq) dDQfromW((dq), (w), (q))

#endif
