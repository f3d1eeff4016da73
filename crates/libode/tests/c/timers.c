/* Stopwatches and timers: times that grow and stop, and a report that names its parts. Times themselves differ. */
#include "check.h"

static volatile double sink;
static void work(void) { for (int i = 0; i < 400000; i++) sink += i; }

int main(void) {
    dStopwatch s;
    memset(&s, 7, sizeof s);
    dStopwatchReset(&s);
    CHECKI(dStopwatchReset, dStopwatchTime(&s) == 0);
    dStopwatchStart(&s);
    work();
    dStopwatchStop(&s);
    double first = dStopwatchTime(&s);
    CHECKI(dStopwatchTime, first > 0 && first < 20);
    work();
    CHECKI(dStopwatchStop, dStopwatchTime(&s) == first);
    /* Started anew, it does not count what was before; the least of some, as others may have the processor. */
    double least = 1e9;
    for (int i = 0; i < 20; i++) work();
    for (int i = 0; i < 5; i++) {
        double before = dStopwatchTime(&s);
        dStopwatchStart(&s);
        dStopwatchStop(&s);
        if (dStopwatchTime(&s) - before < least) least = dStopwatchTime(&s) - before;
    }
    CHECKI(dStopwatchStart, least < first);
    CHECKI(dTimerTicksPerSecond, dTimerTicksPerSecond() >= 1000);
    CHECKI(dTimerResolution, dTimerResolution() > 0 && dTimerResolution() < 1);
    char text[4000] = "";
    FILE *file = tmpfile();
    dTimerStart("beginning");
    work();
    dTimerNow("middle");
    work();
    dTimerEnd();
    dTimerReport(file, 0);
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    CHECKI(dTimerReport, text[0] != 0);
    CHECKI(dTimerStart, strstr(text, "beginning") != 0);
    CHECKI(dTimerNow, strstr(text, "middle") != 0);
    CHECKI(dTimerEnd, strstr(text, "total") != 0 || strstr(text, "Total") != 0 || strstr(text, "TOTAL") != 0);
    fclose(file);
    return 0;
}
