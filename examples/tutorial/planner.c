/* A small planner: a plank finds its way through a gap between walls. Every edge of its path is proved free at all times.
 * docs/tutorial-planner.md explains it part by part. It ends with an error where there is no path, or an edge is refused. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <swiftprox.h>
#include <swiftprox/motion.h>
#include <swiftprox/verify.h>

enum { OBSTACLES = 5, MOST_STATES = 2000 };

static const double MARGIN = 0.02; /* nearer than that is not free */

/* Ends the program with the library's message where a call failed. */
static void demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "%s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

/* A box around the origin. */
static const swiftprox_shape *make_box(double x, double y, double z)
{
    double corners[8][3];
    for (int i = 0; i < 8; i++) {
        corners[i][0] = i & 1 ? x / 2 : -x / 2;
        corners[i][1] = i & 2 ? y / 2 : -y / 2;
        corners[i][2] = i & 4 ? z / 2 : -z / 2;
    }
    const swiftprox_shape *box;
    demand(swiftprox_shape_create_from_points(&corners[0][0], 8, NULL, &box));
    return box;
}

struct obstacle {
    const swiftprox_shape *shape;
    swiftprox_motion motion;    /* none: it rests */
    swiftprox_pair_cache cache; /* the pair's cache: all zero at first */
};

struct world {
    const swiftprox_shape *plank;
    struct obstacle obstacles[OBSTACLES];
    swiftprox_scene *scene; /* of the obstacles */
    int verifies;           /* whether each cast is proved anew */
};

static void add_obstacle(struct world *world, size_t index, double width, double depth, double x, double y)
{
    struct obstacle *const obstacle = &world->obstacles[index];
    const double pose[12] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, 0};
    obstacle->shape = make_box(width, depth, 2);
    obstacle->motion = (swiftprox_motion){.kind = SWIFTPROX_MOTION_KIND_FIXED};
    memcpy(obstacle->motion.start, pose, sizeof pose);

    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    memcpy(options.pose, pose, sizeof pose);
    swiftprox_object_id id;
    demand(swiftprox_scene_add_object(world->scene, &obstacle->shape, 1, &options, &id));
}

/* A wall from y = -4 to 4 with a gap of 0.6, and three pillars about it. */
static void build(struct world *world)
{
    demand(swiftprox_scene_create(NULL, &world->scene));
    world->plank = make_box(2, 0.3, 1);
    add_obstacle(world, 0, 0.4, 3.7, 0, 2.15);
    add_obstacle(world, 1, 0.4, 3.7, 0, -2.15);
    add_obstacle(world, 2, 0.5, 0.5, -1.8, 0.9);
    add_obstacle(world, 3, 0.5, 0.5, -2.2, -1.2);
    add_obstacle(world, 4, 0.5, 0.5, 1.9, -0.9);
}

struct state {
    double x, y, angle;
};

static void pose_of(struct state state, double pose[12])
{
    const double c = cos(state.angle), s = sin(state.angle);
    const double rows[12] = {c, -s, 0, state.x, s, c, 0, state.y, 0, 0, 1, 0};
    memcpy(pose, rows, sizeof rows);
}

/* Returns whether the plank, at that state, is farther than the margin from all obstacles. */
static int is_free(struct world *world, struct state state)
{
    double pose[12];
    pose_of(state, pose);
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.max_distance = MARGIN; /* pairs farther apart are not reported */
    swiftprox_scene_answer answer;
    demand(swiftprox_scene_query_placed(world->scene, &(swiftprox_placed){world->plank, pose}, 1, SWIFTPROX_QUERY_KIND_DISTANCE,
                                        &query, &answer));
    return answer.count == 0;
}

/* The motion from one state to another: by the shortest turn, the centre on a line. It ends within 1e-12 of the second. */
static swiftprox_motion motion_between(struct state from, struct state to)
{
    double pose1[12], pose2[12], end_error;
    pose_of(from, pose1);
    pose_of(to, pose2);
    swiftprox_motion motion;
    demand(swiftprox_motion_between(pose1, pose2, NULL, 1.2, &motion, &end_error)); /* corners are within 1.2 of the centre */
    if (end_error > 1e-12) {
        fputs("the motion does not end where it should\n", stderr);
        exit(EXIT_FAILURE);
    }
    return motion;
}

/* How far the plank gets on an edge. */
struct edge {
    int is_free;
    double clearance; /* free: distance from all obstacles at all times, at least */
    double time_lower; /* not free: farther than the margin from all up to this time ... */
    double time_upper; /* ... and at this time within it of one; NaN if rounding hides that */
};

static struct edge cast_edge(struct world *world, struct state from, struct state to)
{
    const swiftprox_motion motion = motion_between(from, to);
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    config.max_distance = MARGIN;
    config.time_tolerance = 1e-6;

    struct edge edge = {1, INFINITY, 1, NAN};
    for (int i = 0; i < OBSTACLES; i++) {
        struct obstacle *const obstacle = &world->obstacles[i];
        swiftprox_cast_answer answer;
        demand(swiftprox_pair_cast((swiftprox_moving){world->plank, &motion},
                                   (swiftprox_moving){obstacle->shape, &obstacle->motion}, &obstacle->cache, &config, &answer));
        if (world->verifies) {
            demand(swiftprox_pair_cast_verify((swiftprox_moving){world->plank, &motion},
                                              (swiftprox_moving){obstacle->shape, &obstacle->motion}, &config, &answer));
        }
        if (answer.outcome == SWIFTPROX_CAST_OUTCOME_FREE) {
            edge.clearance = fmin(edge.clearance, answer.clearance);
        } else { /* hit, near or budget: later contacts no longer matter */
            edge.is_free = 0;
            edge.time_lower = answer.time_lower;
            edge.time_upper = answer.time_upper;
            config.time_end = answer.time_lower;
        }
    }
    return edge;
}

/* The last state of an edge that is hit, a hair before time_lower. Its pose is rounded, so the state itself is tested. */
static struct state last_valid(struct world *world, struct state from, struct state to, double time_lower)
{
    const double t = fmax(0, time_lower - 1e-6);
    const struct state state = {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y),
                                from.angle + t * (to.angle - from.angle)};
    return is_free(world, state) ? state : from;
}

/* States, and the tree over them. */
struct tree {
    struct state states[MOST_STATES];
    size_t parents[MOST_STATES];
    size_t count;
};

static double apart(struct state a, struct state b)
{
    return hypot(a.x - b.x, a.y - b.y) + 0.5 * fabs(a.angle - b.angle);
}

/* Grows the tree from its state nearest to a target, as far as the edge is free. Returns whether it reached the target. */
static int grow(struct world *world, struct tree *tree, struct state target)
{
    size_t nearest = 0;
    for (size_t i = 1; i < tree->count; i++) {
        nearest = apart(tree->states[i], target) < apart(tree->states[nearest], target) ? i : nearest;
    }
    const struct state from = tree->states[nearest];
    const struct edge edge = cast_edge(world, from, target);
    const struct state reached = edge.is_free ? target : last_valid(world, from, target, edge.time_lower);
    if (apart(from, reached) > 0.01 && tree->count < MOST_STATES) {
        tree->states[tree->count] = reached;
        tree->parents[tree->count++] = nearest;
    }
    return edge.is_free;
}

/* From 0 to 1; the same numbers on every machine. */
static double random_number(void)
{
    static uint64_t bits = 1;
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    return (double)(bits >> 11) / 9007199254740992.0;
}

/* A tree that grows towards random states, and every fifth time towards the goal (LaValle 1998). Returns whether it got there. */
static int search(struct world *world, struct tree *tree, struct state start, struct state goal)
{
    tree->states[0] = start;
    tree->count = 1;
    for (int i = 0; i < MOST_STATES; i++) {
        const struct state anywhere = {8 * random_number() - 4, 6 * random_number() - 3, 3 * random_number() - 1.5};
        if (grow(world, tree, i % 5 == 0 ? goal : anywhere) && i % 5 == 0) {
            return 1;
        }
    }
    return 0;
}

int main(void)
{
    static struct world world;
    static struct tree tree;
    build(&world);
    const struct state start = {-3.5, 1.5, 1.5}, goal = {3.5, -1.5, 1.5};
    if (!is_free(&world, start) || !is_free(&world, goal)) {
        fputs("start or goal is not free\n", stderr);
        return EXIT_FAILURE;
    }

    const struct edge straight = cast_edge(&world, start, goal);
    if (straight.is_free || !(straight.time_upper - straight.time_lower <= 1e-6)) {
        fputs("the way straight ahead is hit, and the time of that is known to a millionth\n", stderr);
        return EXIT_FAILURE;
    }
    printf("straight ahead: free up to %.3f of the way, and hit a millionth later at the latest\n", straight.time_lower);

    if (!search(&world, &tree, start, goal)) {
        fputs("no path found\n", stderr);
        return EXIT_FAILURE;
    }
    world.verifies = 1;
    for (size_t i = tree.count - 1; i > 0; i = tree.parents[i]) {
        const struct edge edge = cast_edge(&world, tree.states[tree.parents[i]], tree.states[i]);
        if (!(edge.is_free && edge.clearance > MARGIN)) {
            fputs("an edge of the path is not free\n", stderr);
            return EXIT_FAILURE;
        }
    }
    printf("a path, each edge verified: the plank is farther than %g from everything at all times\n", MARGIN);

    demand(swiftprox_scene_destroy(world.scene));
    for (int i = 0; i < OBSTACLES; i++) {
        swiftprox_shape_release(world.obstacles[i].shape);
    }
    swiftprox_shape_release(world.plank);
    return EXIT_SUCCESS;
}
