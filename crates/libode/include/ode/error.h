/* Errors, debug messages and messages, and the functions that get to hear of them. */
#ifndef FERRODE_ODE_ERROR_H
#define FERRODE_ODE_ERROR_H

#include <ode/odeconfig.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A handler gets a number, and a format with its arguments as for vprintf. */
typedef void dMessageFunction(int number, const char *format, va_list arguments);

/* Handlers of the program's; null stands for the library's own, which print to stderr. */
ODE_API dMessageFunction *dGetDebugHandler(void);
ODE_API dMessageFunction *dGetErrorHandler(void);
ODE_API dMessageFunction *dGetMessageHandler(void);
ODE_API void dSetDebugHandler(dMessageFunction *fn);
ODE_API void dSetErrorHandler(dMessageFunction *fn);
ODE_API void dSetMessageHandler(dMessageFunction *fn);

/* dError ends in exit(1) and dDebug in abort() once the handler has returned; a handler escapes that by longjmp, by
   an exception or by exit. dMessage returns. */
ODE_API ODE_NORETURN void dDebug(int number, const char *format, ...);
ODE_API ODE_NORETURN void dError(int number, const char *format, ...);
ODE_API void dMessage(int number, const char *format, ...);

#ifdef __cplusplus
}
#endif

#endif
