/* Stopwatches, and a report of how long the parts of a program take. */
#ifndef FERRODE_ODE_TIMER_H
#define FERRODE_ODE_TIMER_H

#include <ode/odeconfig.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A stopwatch: time so far in ticks, and when it was started. */
typedef struct dStopwatch {
    double time;
    unsigned long cc[2];
} dStopwatch;

/* Stopwatches; the time is in seconds. */
ODE_API void dStopwatchReset(dStopwatch *stopwatch);
ODE_API void dStopwatchStart(dStopwatch *stopwatch);
ODE_API void dStopwatchStop(dStopwatch *stopwatch);
ODE_API double dStopwatchTime(dStopwatch *stopwatch);

/* dTimerNow ends one part and begins the next; the report goes to a file. */
ODE_API void dTimerEnd(void);
ODE_API void dTimerNow(const char *description);
ODE_API void dTimerReport(FILE *file, int average);
ODE_API void dTimerStart(const char *description);

/* The clock: ticks a second, and seconds that it can tell apart. */
ODE_API double dTimerResolution(void);
ODE_API double dTimerTicksPerSecond(void);

#ifdef __cplusplus
}
#endif

#endif
