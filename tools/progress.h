/* A progress bar on the standard error, for a person at a terminal and for nobody else. */
#ifndef SWIFTPROX_TOOLS_PROGRESS_H
#define SWIFTPROX_TOOLS_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

struct progress {
    bool shown;           /* only to a person at a terminal */
    bool shares_terminal; /* with the answers */
    double next;          /* when to draw again */
};

/* Seconds of a clock that only goes forward. */
double seconds(void);

/* Nothing is drawn in the first half second. */
struct progress progress_start(void);

/* Draws the bar if it is time to; what stands behind it is for the caller to print. */
bool progress_draw(struct progress *progress, double fraction);

/* Draws the bar, and how many of how many are done, if it is time to. */
void progress_look(struct progress *progress, size_t done, size_t total);

void progress_erase(const struct progress *progress);

#endif
