/* The ground that the other headers stand on: the C library, integer types, function attributes, infinity. */
#ifndef FERRODE_ODE_ODECONFIG_H
#define FERRODE_ODE_ODECONFIG_H

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <ode/precision.h>

/* Attributes of the library's functions. ODE_DLL is for building a library of Windows, not for using one. */
#ifndef ODE_API
#if defined(_WIN32) && defined(ODE_DLL)
#define ODE_API __declspec(dllexport)
#else
#define ODE_API
#endif
#endif

#if defined(__GNUC__) || defined(__clang__)
#define ODE_API_DEPRECATED __attribute__((__deprecated__))
#define ODE_NORETURN __attribute__((__noreturn__))
#elif defined(_MSC_VER)
#define ODE_API_DEPRECATED __declspec(deprecated)
#define ODE_NORETURN __declspec(noreturn)
#else
#define ODE_API_DEPRECATED
#define ODE_NORETURN
#endif

#if defined(__cplusplus)
#define ODE_EXTERN_C extern "C"
#else
#define ODE_EXTERN_C
#endif

/* "inline" also for C89, which has no such word. */
#define ODE_INLINE __inline
#define ODE_PURE_INLINE static __inline

#if defined(__x86_64__) || defined(_M_AMD64)
#define X86_64_SYSTEM 1
#endif

/* Integers by width; as wide as a pointer: dintptr, duintptr, ddiffint, dsizeint. */
typedef int8_t dint8;
typedef uint8_t duint8;
typedef int16_t dint16;
typedef uint16_t duint16;
typedef int32_t dint32;
typedef uint32_t duint32;
typedef int64_t dint64;
typedef uint64_t duint64;
typedef intptr_t dintptr;
typedef uintptr_t duintptr;
typedef ptrdiff_t ddiffint;
typedef size_t dsizeint;

/* No limit, no stop, no friction bound; and not a number. */
#if defined(dSINGLE)
#define dInfinity ((float)INFINITY)
#else
#define dInfinity ((double)INFINITY)
#endif
#define dNaN NAN

#define _ode_copysign(x, y) copysign((x), (y))
#define _ode_copysignf(x, y) copysignf((x), (y))
#define _ode_nextafter(x, y) nextafter((x), (y))
#define _ode_nextafterf(x, y) nextafterf((x), (y))

#endif
