/* Scenes played with an engine's own collider and with swiftprox: a table, a file of the same, and a picture. */
#ifndef SWIFTPROX_EXAMPLES_ENGINES_REPORT_H
#define SWIFTPROX_EXAMPLES_ENGINES_REPORT_H

#include "scenes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How a scene ends. */
struct run {
    bool is_played;                      /* else there is nothing */
    double poses[SCENE_MOST_BODIES][12]; /* of each body: row-major [R|T] */
    double energy;                       /* kinetic, in joules */
    double microseconds;                 /* a step, the median of the last fifth, when what falls has settled */
    int contacts;
};

/* A scene, played with both; with the engine's own it may not have been. */
struct played {
    struct scene scene;
    struct run theirs, ours;
};

struct report {
    const char *engine;
    const char *folder; /* where files are written; null: there are none */
    bool is_quick;      /* two simulated seconds, not ten */
    int count;
    struct played played[SCENE_COUNT];
};

/* Reads the command line of a program, and prints the head of the table. False if the program is to end now, with `*status`. */
bool report_begin(struct report *report, const char *engine, int argc, char **argv, int *status);

/* Prints the row of report->played[report->count], and counts it. */
void report_add(struct report *report);

/* Whether with swiftprox a scene stands, if it is to and has not fallen with the engine's collider. */
bool report_stands_as_well(const struct played *played);

/* Writes engines-ENGINE.csv and engines-ENGINE.svg into the folder. Returns the exit status: success if all `is_good`. */
int report_end(const struct report *report, bool is_good);

/* Microseconds since some moment. */
double report_now(void);

/* The median of `count` numbers, which it sorts. */
double report_median(double *numbers, int count);

#ifdef __cplusplus
}
#endif

#endif
