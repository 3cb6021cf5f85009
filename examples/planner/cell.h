/* A cell: bodies that a planner moves, and obstacles that stay. Edges of the planner are proved free at all times. */
#ifndef EXAMPLES_PLANNER_CELL_H
#define EXAMPLES_PLANNER_CELL_H

#include <stdbool.h>
#include <stddef.h>

#include <swiftprox.h>
#include <swiftprox/motion.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { MOST_BODIES = 12, MOST_OBSTACLES = 16, MOST_CELL_PAIRS = MOST_BODIES * (MOST_OBSTACLES + MOST_BODIES) };

/* A pair of bodies that may meet: the second one of the moving ones, or of the obstacles. */
struct cell_pair {
    size_t first, second;
    bool is_obstacle;
    swiftprox_pair_cache cache; /* all zero at first */
};

struct cell {
    size_t body_count, obstacle_count, pair_count;
    const swiftprox_shape *bodies[MOST_BODIES];
    const swiftprox_shape *obstacles[MOST_OBSTACLES];
    swiftprox_motion places[MOST_OBSTACLES]; /* of the obstacles: they stay */
    struct cell_pair pairs[MOST_CELL_PAIRS];
    double max_distance; /* nearer than that is not free */
};

/* How far the bodies get on an edge, which lasts from time 0 to 1. */
struct cell_edge {
    bool is_free;
    double clearance; /* free: all pairs are at least that far apart at all times */
    double time_lower;      /* not free: all pairs are farther apart than max_distance up to this time */
    double time_upper;      /* and at this time a pair is not; NaN where rounding hides it */
};

/* A box of these sides about a point of the body's frame. */
const swiftprox_shape *cell_box(const double sides[3], const double centre[3]);

/* Ends the program with the library's message where a call failed. */
void cell_demand(swiftprox_status status);

/* Takes over the shape, and pairs the body with all obstacles that are there and come. */
void cell_add_body(struct cell *cell, const swiftprox_shape *shape);
void cell_add_obstacle(struct cell *cell, const swiftprox_shape *shape, double x, double y, double z);

/* Two moving bodies that may meet. */
void cell_add_pair(struct cell *cell, size_t first, size_t second);

/* Whether all pairs are farther apart than max_distance; the poses are those of the bodies, 12 numbers each. */
bool cell_is_free(struct cell *cell, const double *poses);

/* A lower bound of the least distance of all pairs; 0 where two meet. */
double cell_clearance(struct cell *cell, const double *poses);

/* How far the bodies get, each along its motion. */
struct cell_edge cell_cast(struct cell *cell, const swiftprox_motion *motions);

/* Whether they are free all along; it stops at the first pair that is not. */
bool cell_is_edge_free(struct cell *cell, const swiftprox_motion *motions);

/* Casts anew, and proves each pair's answer from the motions alone. Whether all of it is free. */
bool cell_prove_free(struct cell *cell, const swiftprox_motion *motions);

void cell_release(struct cell *cell);

#ifdef __cplusplus
}
#endif

#endif
