/* Which number type dReal is. -DdSINGLE or -DdDOUBLE says it (so do dIDESINGLE and dIDEDOUBLE); it has to be what
   the library was built for. Nothing said means double. */
#ifndef FERRODE_ODE_PRECISION_H
#define FERRODE_ODE_PRECISION_H

#if defined(dIDESINGLE) && !defined(dSINGLE)
#define dSINGLE
#endif
#if defined(dIDEDOUBLE) && !defined(dDOUBLE)
#define dDOUBLE
#endif
#if !defined(dSINGLE) && !defined(dDOUBLE)
#define dDOUBLE
#endif
#if defined(dSINGLE) && defined(dDOUBLE)
#error "dSINGLE and dDOUBLE exclude each other: define the one that the library was built for"
#endif

#endif
