/* Rigid bodies under gravity, held apart by sequential impulses over contact manifolds (Catto 2006, "Fast and Simple Physics
 * using Sequential Impulses"): as little of it as shows what a simulator asks of a manifold. */
#ifndef SWIFTPROX_EXAMPLES_RIGID_BODIES_H
#define SWIFTPROX_EXAMPLES_RIGID_BODIES_H

#include <stdbool.h>
#include <stddef.h>

#include <swiftprox.h>
#include <swiftprox/ground.h>

struct body {
    const swiftprox_shape *shape; /* its local origin is its centre of mass */
    swiftprox_object_id id;
    double inverse_mass;       /* 0: it never moves */
    double inverse_inertia[9]; /* row-major, in the local frame */
    double place[3];
    double quaternion[4]; /* w x y z */
    double velocity[3];
    double spin[3];
    double pose[12]; /* of place and quaternion */
};

struct world; /* bodies, a scene that knows which are near, and what their pairs remember */

/* No bodies yet. Null where there is no memory. */
struct world *world_create(void);

void world_destroy(struct world *world);

/* Adds a body of density 1, or one that never moves. The world takes the share of the shape. Ends the program where a call of
 * the library fails. */
void world_add(struct world *world, const swiftprox_shape *shape, const double place[3], bool fixed);

/* Puts a ground under all bodies, at the origin. The world takes the share of the ground. */
void world_add_ground(struct world *world, const swiftprox_ground *ground);

/* Writes down what happens from here on, for swiftprox-replay. Ends the program where the file cannot be written. */
void world_record(struct world *world, const char *path);

/* One step of `seconds`. */
void world_step(struct world *world, double seconds);

size_t world_body_count(const struct world *world);

const struct body *world_body(const struct world *world, size_t index);

/* Adds to `points` the contact points that bodies up to the given one had with each other in the last step, and to `known` those
 * that they had in the step before, too. */
void world_count_points(const struct world *world, size_t last, size_t *known, size_t *points);

/* The largest depth of any pair in the last step. */
double world_depth(const struct world *world);

/* Ends the program with the library's message where a call failed. */
void demand(swiftprox_status status);

#endif
