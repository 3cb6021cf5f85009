/* An arm in a scene: what a planner asks about a set of objects. How near the arm is to anything, whether any of many states of an
 * edge collides, and whether the edge is free at all times. The answers are held against those of the pairs, one by one. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arm.h"
#include <swiftprox/sets.h>

enum { STATES = 64 };

/* The cell's bodies and obstacles as objects of a scene. */
struct arm_scene {
    struct arm arm;
    struct cell cell;
    swiftprox_scene *scene;
    swiftprox_scratch *scratch; /* one for each thread */
    swiftprox_object_id links[MOST_JOINTS];
};

static swiftprox_object_id add(swiftprox_scene *scene, const swiftprox_shape *shape, const double *pose, int32_t fixed)
{
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_id id;
    memcpy(options.pose, pose, sizeof options.pose);
    options.fixed = fixed;
    cell_demand(swiftprox_scene_add_object(scene, &shape, 1, &options, &id));
    return id;
}

static void build(struct arm_scene *world)
{
    double poses[12 * MOST_JOINTS];
    arm_build_cell(&world->arm, &world->cell);
    cell_demand(swiftprox_scene_create(NULL, &world->scene));
    cell_demand(swiftprox_scratch_create(&world->scratch));
    arm_poses(&world->arm, world->arm.start, poses);
    for (size_t i = 0; i < world->cell.body_count; i++) {
        world->links[i] = add(world->scene, world->cell.bodies[i], poses + 12 * i, 0);
        /* Neighbours in the chain always meet. */
        if (i > 0) {
            cell_demand(swiftprox_scene_set_pair_active(world->scene, &world->links[i - 1], &world->links[i], 0));
        }
    }
    for (size_t i = 0; i < world->cell.obstacle_count; i++) {
        add(world->scene, world->cell.obstacles[i], world->cell.places[i].start, 1);
    }
    cell_demand(swiftprox_scene_prepare(world->scene));
}

static bool agrees(const char *what, double found, double expected, double tolerance)
{
    const bool is_good = fabs(found - expected) <= tolerance;
    printf("%s: %.6f\n", what, found);
    if (!is_good) {
        fprintf(stderr, "arm_scene: pair by pair it is %.17g\n", expected);
    }
    return is_good;
}

/* How near the arm is to anything, itself included, with its joints at these angles. */
static double least_distance(const struct arm_scene *world, const double *angles)
{
    double poses[12 * MOST_JOINTS];
    arm_poses(&world->arm, angles, poses);
    const swiftprox_object_set set = {.ids = world->links, .count = world->arm.joint_count, .poses = poses, .among = 1};
    swiftprox_least_distance least;
    cell_demand(swiftprox_scene_least_distance(world->scene, &set, NULL, INFINITY, world->scratch, &least));
    return least.lower;
}

/* A share of the edge at which the arm is within max_distance of something, of STATES tried in bisection order; 1 if none. */
static double first_hit(const struct arm_scene *world, const double *from, const double *to)
{
    static double poses[12 * MOST_JOINTS * STATES];
    for (int i = 0; i < STATES; i++) {
        double angles[MOST_JOINTS];
        for (size_t k = 0; k < world->arm.joint_count; k++) {
            angles[k] = from[k] + (double)i / STATES * (to[k] - from[k]);
        }
        arm_poses(&world->arm, angles, poses + 12 * world->arm.joint_count * (size_t)i);
    }
    const swiftprox_object_set set = {.ids = world->links, .count = world->arm.joint_count, .among = 1};
    swiftprox_first_hit hit;
    cell_demand(swiftprox_scene_first_hit(world->scene, &set, (swiftprox_path){poses, STATES, SWIFTPROX_POSE_ORDER_BISECTION},
                                          world->cell.max_distance, world->scratch, &hit));
    return (double)hit.time / STATES;
}

/* How much of the edge is free at all times. */
static double free_up_to(const struct arm_scene *world, const double *from, const double *to)
{
    static struct arm_edge edge;
    swiftprox_motion motions[MOST_JOINTS];
    arm_motions(&world->arm, from, to, &edge, motions);
    const swiftprox_object_set set = {.ids = world->links, .count = world->arm.joint_count, .among = 1};
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    config.max_distance = world->cell.max_distance;
    config.time_tolerance = 1e-6;
    swiftprox_scene_cast_answer answer;
    cell_demand(swiftprox_scene_cast(world->scene, &set, (swiftprox_motions){motions, world->arm.joint_count, 1}, &config,
                                     world->scratch, &answer));
    return answer.time_lower;
}

int main(void)
{
    static struct arm_scene world;
    build(&world);
    const double *const start = world.arm.start, *const goal = world.arm.goal;
    double poses[12 * MOST_JOINTS];
    arm_poses(&world.arm, start, poses);
    bool is_good = agrees("nearest at the start", least_distance(&world, start), cell_clearance(&world.cell, poses), 1e-9);
    struct arm_edge edge;
    swiftprox_motion motions[MOST_JOINTS];
    arm_motions(&world.arm, start, goal, &edge, motions);
    const double time_lower = cell_cast(&world.cell, motions).time_lower;
    is_good &= agrees("of the edge to the goal is free", free_up_to(&world, start, goal), time_lower, 1e-5);
    const double hit = first_hit(&world, start, goal);
    printf("found within max_distance at: %.6f\n", hit);
    is_good &= hit >= time_lower && hit < 1;
    swiftprox_scratch_destroy(world.scratch);
    cell_demand(swiftprox_scene_destroy(world.scene));
    cell_release(&world.cell);
    return is_good ? EXIT_SUCCESS : EXIT_FAILURE;
}
