/* A sweep over ranks: rank 0 hands out shares of consecutive items, and works, too, so that one slow rank holds nobody up. */
#ifndef SWIFTPROX_TOOLS_SWEEP_SHARES_H
#define SWIFTPROX_TOOLS_SWEEP_SHARES_H

#include <stdbool.h>
#include <stddef.h>

#include "sweep_output.h"
#include "sweep_scene.h"

struct sweep {
    struct sweep_scene *scene;
    enum sweep_kind kind;
    size_t share;  /* items of a share; the last one may have fewer */
    double max_distance; /* of motions */
};

/* Hands out and answers all shares that `output` has not. Each takes the same bits wherever it is answered, as it begins with
 * caches that are forgotten. `times`, null or a file, is written a line for each share: seconds. False after a message. */
bool sweep_lead(const struct sweep *sweep, const struct sweep_items *items, struct sweep_output *output, FILE *times,
                struct sweep_tally *tally);

/* Answers shares until rank 0 has no more. */
void sweep_follow(const struct sweep *sweep, struct sweep_tally *tally);

#endif
