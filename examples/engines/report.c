#include "report.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* The smallest body is 0.1 high: what has moved by half of that has left its place. */
static const double FALLEN = 0.05;

void report_head(const char *engine)
{
    printf("| scene | moved, m: %s | swiftprox | energy, J: %s | swiftprox | contacts: %s | swiftprox | step, us: %s | swiftprox |\n"
           "|---|--:|--:|--:|--:|--:|--:|--:|--:|\n", engine, engine, engine, engine);
}

bool report_scene(const struct scene *scene, const struct run *theirs, const struct run *ours)
{
    printf("| %s | %.2g | %.2g | %.1e | %.1e | %d | %d | %.0f | %.0f |\n", scene->name, theirs->motion, ours->motion, theirs->energy,
           ours->energy, theirs->contacts, ours->contacts, theirs->microseconds, ours->microseconds);
    fflush(stdout);
    return !scene->stands || !report_stands(theirs) || report_stands(ours);
}

bool report_stands(const struct run *run)
{
    return run->motion < FALLEN;
}

double report_now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e6 * (double)time.tv_sec + 1e-3 * (double)time.tv_nsec;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double report_median(double *numbers, int count)
{
    qsort(numbers, (size_t)count, sizeof *numbers, by_size);
    return numbers[count / 2];
}
