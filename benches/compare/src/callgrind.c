/* Valgrind's client requests are instructions that do nothing outside of it, and that a macro in C emits. */

#include <stdbool.h>
#include <valgrind/callgrind.h>

bool callgrind_runs(void)
{
    return RUNNING_ON_VALGRIND != 0;
}

void callgrind_watch(void)
{
    CALLGRIND_START_INSTRUMENTATION;
}

void callgrind_look_away(void)
{
    CALLGRIND_STOP_INSTRUMENTATION;
}

void callgrind_zero(void)
{
    CALLGRIND_ZERO_STATS;
}

void callgrind_dump(void)
{
    CALLGRIND_DUMP_STATS;
}
