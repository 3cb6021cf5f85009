/* An arm reaches around a post: a tree of states whose edges are proved free at all times, links against obstacles and against each
 * other. The path is proved anew in the end. --bench times edges beside samples instead. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "arm.h"
#include "program.h"

enum { MOST_STATES = 4000, BENCH_EDGES = 300 };

static const struct program PROGRAM = {
    "arm_rrt",
    "usage: arm_rrt [FOLDER] [--bench]\n",
    "\n"
    "Plans for an arm with six axes; every edge is proved free at all times.\n"
    "\n"
    "  FOLDER             has Franka's links, fer_link0.off to fer_link7.off: plans for that arm instead\n"
    "  --bench            time edges beside samples each 0.01 rad\n"
    "  --help, --version  print this text, the version\n",
};

struct world {
    struct arm arm;
    struct cell cell;
};

struct state {
    double angles[MOST_JOINTS];
};

struct tree {
    struct state states[MOST_STATES];
    size_t parents[MOST_STATES];
    size_t count, casts;
};

static double apart(const struct world *world, const struct state *a, const struct state *b)
{
    double sum = 0;
    for (size_t k = 0; k < world->arm.joint_count; k++) {
        const double difference = a->angles[k] - b->angles[k];
        sum += difference * difference;
    }
    return sqrt(sum);
}

static struct state between(const struct world *world, const struct state *from, const struct state *to, double time)
{
    struct state state = *from;
    for (size_t k = 0; k < world->arm.joint_count; k++) {
        state.angles[k] += time * (to->angles[k] - from->angles[k]);
    }
    return state;
}

static bool is_free(struct world *world, const struct state *state)
{
    double poses[12 * MOST_JOINTS];
    arm_poses(&world->arm, state->angles, poses);
    return cell_is_free(&world->cell, poses);
}

static struct cell_edge cast_edge(struct world *world, const struct state *from, const struct state *to)
{
    struct arm_edge edge;
    swiftprox_motion motions[MOST_JOINTS];
    arm_motions(&world->arm, from->angles, to->angles, &edge, motions);
    return cell_cast(&world->cell, motions);
}

static bool prove_edge(struct world *world, const struct state *from, const struct state *to)
{
    struct arm_edge edge;
    swiftprox_motion motions[MOST_JOINTS];
    arm_motions(&world->arm, from->angles, to->angles, &edge, motions);
    return cell_prove_free(&world->cell, motions);
}

/* From 0 to 1; the same numbers on every machine. */
static double random_number(void)
{
    static uint64_t bits = 1;
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    return (double)(bits >> 11) / 9007199254740992.0;
}

static struct state anywhere(const struct world *world)
{
    struct state state = {{0}};
    for (size_t k = 0; k < world->arm.joint_count; k++) {
        const double low = world->arm.lowest[k];
        state.angles[k] = low + random_number() * (world->arm.highest[k] - low);
    }
    return state;
}

/* Grows the tree from its state nearest to a target, as far as the edge is proved free. Returns whether it got there. */
static bool grow(struct world *world, struct tree *tree, const struct state *target)
{
    size_t nearest = 0;
    for (size_t i = 1; i < tree->count; i++) {
        if (apart(world, &tree->states[i], target) < apart(world, &tree->states[nearest], target)) {
            nearest = i;
        }
    }
    const struct state from = tree->states[nearest];
    const struct cell_edge edge = cast_edge(world, &from, target);
    tree->casts++;
    /* A hair before contact, and asked about as it is: its angles are rounded. */
    const struct state reached = edge.is_free ? *target : between(world, &from, target, fmax(0, edge.time_lower - 1e-3));
    if (apart(world, &from, &reached) > 0.02 && tree->count < MOST_STATES && is_free(world, &reached)) {
        tree->states[tree->count] = reached;
        tree->parents[tree->count++] = nearest;
    }
    return edge.is_free;
}

/* A tree that grows towards random states, and every fifth time towards the goal (LaValle 1998). Returns whether it got there. */
static bool search(struct world *world, struct tree *tree, const struct state *start, const struct state *goal)
{
    *tree = (struct tree){.states = {*start}, .count = 1};
    for (int i = 0; i < MOST_STATES; i++) {
        const struct state random = anywhere(world);
        const bool is_goal = i % 5 == 0;
        if (grow(world, tree, is_goal ? goal : &random) && is_goal) {
            return true;
        }
    }
    return false;
}

static int plan(struct world *world)
{
    static struct tree tree;
    struct state start, goal;
    memcpy(start.angles, world->arm.start, sizeof start.angles);
    memcpy(goal.angles, world->arm.goal, sizeof goal.angles);
    if (!is_free(world, &start) || !is_free(world, &goal)) {
        fputs("arm_rrt: the start or the goal is not free\n", stderr);
        return FAILED;
    }
    const struct cell_edge straight = cast_edge(world, &start, &goal);
    printf("straight ahead: %s, free up to %.4f of the way\n", straight.is_free ? "free" : "not free", straight.time_lower);
    if (!search(world, &tree, &start, &goal)) {
        fputs("arm_rrt: no path found\n", stderr);
        return FAILED;
    }
    size_t edges = 0;
    double least = INFINITY;
    for (size_t i = tree.count - 1; i > 0; i = tree.parents[i]) {
        const struct state *const from = &tree.states[tree.parents[i]], *const to = &tree.states[i];
        if (!prove_edge(world, from, to)) {
            fputs("arm_rrt: an edge of the path is not proved\n", stderr);
            return FAILED;
        }
        least = fmin(least, cast_edge(world, from, to).clearance);
        edges++;
    }
    printf("%zu states, %zu edges cast; a path of %zu edges, each proved anew: nothing nearer than %.4f at any time\n", tree.count,
           tree.casts, edges, least);
    return GOOD;
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Verdicts at steps in which no joint turns by more than 0.01. */
static bool sample_edge(struct world *world, const struct state *from, const struct state *to)
{
    double farthest = 0;
    for (size_t k = 0; k < world->arm.joint_count; k++) {
        farthest = fmax(farthest, fabs(to->angles[k] - from->angles[k]));
    }
    const int steps = (int)ceil(farthest / 0.01);
    for (int i = 0; i <= steps; i++) {
        const struct state state = between(world, from, to, (double)i / steps);
        if (!is_free(world, &state)) {
            return false;
        }
    }
    return true;
}

/* Edges whose ends are free and in which each joint turns by up to `most`. */
static void bench(struct world *world, double most)
{
    double of_casts = 0, of_samples = 0;
    int hits = 0, misses = 0;
    for (int i = 0; i < BENCH_EDGES; i++) {
        struct state from, to;
        do {
            from = to = anywhere(world);
            for (size_t k = 0; k < world->arm.joint_count; k++) {
                to.angles[k] += most * (2 * random_number() - 1);
            }
        } while (!is_free(world, &from) || !is_free(world, &to));
        const double begun = now();
        const bool is_free_at_all_times = cast_edge(world, &from, &to).is_free;
        const double asked = now();
        const bool is_free_at_samples = sample_edge(world, &from, &to);
        of_casts += asked - begun;
        of_samples += now() - asked;
        hits += !is_free_at_all_times;
        misses += !is_free_at_all_times && is_free_at_samples;
    }
    printf("up to %.1f rad a joint, %d edges, %d not free: cast %.1f us, samples each 0.01 rad %.1f us, which miss %d\n", most,
           BENCH_EDGES, hits, 1e6 * of_casts / BENCH_EDGES, 1e6 * of_samples / BENCH_EDGES, misses);
}

int main(int argc, char **argv)
{
    static struct world world;
    bool benches = false;
    const char *folder = NULL;
    struct program_option options[] = {{.name = "--bench", .kind = OPTION_FLAG, .value = &benches}};
    struct command_line line = {.program = &PROGRAM,
                                .options = options,
                                .option_count = 1,
                                .operands = &folder,
                                .most_operands = 1,
                                .operands_wanted = "at most one folder of links"};
    int status;
    if (!command_line_read(&line, argc, argv, &status)) {
        return program_end(&PROGRAM, status);
    }
    if (folder) {
        arm_build_franka(&world.arm, &world.cell, folder);
    } else {
        arm_build_cell(&world.arm, &world.cell);
    }
    if (benches) {
        bench(&world, 0.1);
        bench(&world, 0.3);
        bench(&world, 1);
    } else {
        status = plan(&world);
    }
    cell_release(&world.cell);
    return program_end(&PROGRAM, benches ? GOOD : status);
}
