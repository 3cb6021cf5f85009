/* The scene of a sweep: one object that takes each pose or motion, and all others, which stay. */
#ifndef SWIFTPROX_TOOLS_SWEEP_SCENE_H
#define SWIFTPROX_TOOLS_SWEEP_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "player.h"
#include "sweep_items.h"
#include <swiftprox/motion.h>

struct sweep_obstacle {
    const swiftprox_shape *shape; /* the scene's */
    uint32_t object;              /* its object's number */
    swiftprox_motion place;       /* it stays */
};

struct sweep_scene {
    struct player player;
    const swiftprox_shape **pieces; /* of the object that moves */
    size_t piece_count;
    double reach; /* how far they reach from the object's origin */
    struct sweep_obstacle *obstacles;
    size_t obstacle_count;
    swiftprox_pair_cache *caches; /* a piece's with each obstacle, piece by piece */
    uint64_t digest;              /* of the objects, their vertices and places */
};

/* How an item came out: the words of SWEEP_WORDS, which begin its line. */
enum sweep_outcome { SWEEP_SEPARATED, SWEEP_INTERSECTING, SWEEP_FREE, SWEEP_HIT, SWEEP_NEAR, SWEEP_BUDGET, SWEEP_OUTCOMES };
extern const char *const SWEEP_WORDS[SWEEP_OUTCOMES];

/* What was made of items. */
struct sweep_tally {
    uint64_t outcomes[SWEEP_OUTCOMES];
    uint64_t queries;
    double seconds;
    double worst_end; /* how far a motion may end from its second pose */
};

/* The longest line of a result. */
enum { SWEEP_LINE = 160 };

/* Plays the scene to its end. The first object that is not fixed is the one that moves. On failure it prints a message and returns
 * another status than GOOD; call sweep_scene_close in either case. */
int sweep_scene_open(struct sweep_scene *scene, const struct player_options *options);

void sweep_scene_close(struct sweep_scene *scene);

/* Forgets what pairs remember: what follows has the bits of a first question. */
void sweep_scene_forget(struct sweep_scene *scene);

/* Answers an item: its line into `text`, which has room for SWEEP_LINE; how long that is, or 0 after a message. */
size_t sweep_scene_ask(struct sweep_scene *scene, enum sweep_kind kind, const double *numbers, double max_distance, char *text,
                       struct sweep_tally *tally);

#endif
