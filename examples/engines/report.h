/* A scene played for 10 simulated seconds with an engine's own collider and with swiftprox: a table, and whether what stood still
 * stands. */
#ifndef SWIFTPROX_EXAMPLES_ENGINES_REPORT_H
#define SWIFTPROX_EXAMPLES_ENGINES_REPORT_H

#include "scenes.h"

#ifdef __cplusplus
extern "C" {
#endif

struct run {
    double motion;       /* how far the body that moved most is from where it began, in metres */
    double energy;       /* kinetic, in the end, in joules */
    double microseconds; /* a step, the median of the last fifth, when what falls has settled */
    int contacts;        /* in the end */
};

void report_head(const char *engine);

/* Prints a row; false if a scene that stands with the engine's collider does not with swiftprox. */
bool report_scene(const struct scene *scene, const struct run *theirs, const struct run *ours);

/* Whether all bodies have stayed about where they began. */
bool report_stands(const struct run *run);

/* Microseconds since some moment. */
double report_now(void);

/* The median of `count` numbers, which it sorts. */
double report_median(double *numbers, int count);

#ifdef __cplusplus
}
#endif

#endif
