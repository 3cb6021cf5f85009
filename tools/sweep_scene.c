#include "sweep_scene.h"
#include <swiftprox/geometry.h>
#include <swiftprox/motion.h>
#include <swiftprox/scene.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "program.h"

const char *const SWEEP_WORDS[SWEEP_OUTCOMES] = {"separated", "intersecting", "free", "hit", "near", "budget"};

static int refuse(const char *why)
{
    fprintf(stderr, "swiftprox-sweep: %s\n", why);
    return BAD_INPUT;
}

static int no_memory(void)
{
    fputs("swiftprox-sweep: no memory for so many objects\n", stderr);
    return FAILED;
}

/* Plays all steps. Verdicts are the cheapest question, and nobody looks at them. */
static int play(struct player *player)
{
    enum next_step next = player_next(player);
    while (next == STEP || next == NO_QUERY) {
        swiftprox_scene_answer answer;
        const int status = next == STEP ? player_play(player, &answer) : GOOD;
        if (status != GOOD) {
            return status;
        }
        next = player_next(player);
    }
    return next == NO_MORE ? GOOD : BAD_INPUT;
}

/* Adds a shape to the digest: its vertices in their order. */
static bool note_shape(struct sweep_scene *scene, const swiftprox_shape *shape)
{
    swiftprox_shape_info info = {.struct_size = sizeof info};
    if (swiftprox_shape_get_info(shape, &info) != SWIFTPROX_OK) {
        return false;
    }
    double *const vertices = malloc(3 * info.vertex_count * sizeof *vertices);
    const bool is_good = vertices && swiftprox_shape_copy_vertices(shape, vertices, NULL, info.vertex_count) == SWIFTPROX_OK;
    if (is_good) {
        scene->digest = sweep_digest(scene->digest, vertices, 3 * info.vertex_count * sizeof *vertices);
    }
    free(vertices);
    return is_good;
}

/* A piece of an object, and where it is in the world. */
static int piece_of(struct sweep_scene *scene, swiftprox_object_id id, size_t piece, const swiftprox_shape **shape, double pose[12])
{
    const bool is_good = swiftprox_scene_get_piece(scene->player.scene, id, piece, shape) == SWIFTPROX_OK
                         && swiftprox_scene_get_piece_pose(scene->player.scene, id, (uint32_t)piece, pose) == SWIFTPROX_OK
                         && note_shape(scene, *shape);
    return is_good ? GOOD : player_failed();
}

static bool is_same_pose(const double *left, const double *right)
{
    bool is_same = true;
    for (int i = 0; i < 12; i++) {
        is_same = is_same && left[i] == right[i];
    }
    return is_same;
}

/* The object that moves: how far a piece reaches from its origin, twice over, so that rounding does not matter. */
static int add_moving(struct sweep_scene *scene, swiftprox_object_id id, const swiftprox_object_info *object)
{
    scene->pieces = calloc(object->piece_count, sizeof *scene->pieces);
    if (!scene->pieces) {
        return no_memory();
    }
    for (size_t i = 0; i < object->piece_count; i++) {
        double pose[12];
        swiftprox_shape_info info = {.struct_size = sizeof info};
        const int status = piece_of(scene, id, i, &scene->pieces[i], pose);
        if (status != GOOD || swiftprox_shape_get_info(scene->pieces[i], &info) != SWIFTPROX_OK) {
            return status != GOOD ? status : player_failed();
        }
        if (!is_same_pose(pose, object->pose)) {
            return refuse("a piece of the object that moves has a pose of its own in it");
        }
        const double *const c = info.centre_of_mass;
        scene->reach = fmax(scene->reach, 2 * (sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) + info.radius));
    }
    scene->piece_count = object->piece_count;
    return GOOD;
}

static int add_obstacle(struct sweep_scene *scene, swiftprox_object_id id, uint32_t number, size_t piece_count)
{
    struct sweep_obstacle *const obstacles =
        realloc(scene->obstacles, (scene->obstacle_count + piece_count) * sizeof *scene->obstacles);
    if (!obstacles) {
        return no_memory();
    }
    scene->obstacles = obstacles;
    for (size_t i = 0; i < piece_count; i++) {
        struct sweep_obstacle *const obstacle = &obstacles[scene->obstacle_count];
        *obstacle = (struct sweep_obstacle){.object = number, .place = {.kind = SWIFTPROX_MOTION_KIND_FIXED}};
        const int status = piece_of(scene, id, i, &obstacle->shape, obstacle->place.start);
        if (status != GOOD) {
            return status;
        }
        scene->digest = sweep_digest(scene->digest, obstacle->place.start, sizeof obstacle->place.start);
        scene->obstacle_count++;
    }
    return GOOD;
}

static int add_objects(struct sweep_scene *scene, const swiftprox_object_id *ids, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        swiftprox_object_info info = {.struct_size = sizeof info};
        uint32_t number = 0;
        if (swiftprox_scene_get_object_info(scene->player.scene, ids[i], &info) != SWIFTPROX_OK
            || !player_find_number(&scene->player, ids[i], &number)) {
            return player_failed();
        }
        if (info.ground || info.compound) {
            return refuse("the scene has a ground or a compound, and sweeps are among convex pieces");
        }
        const bool moves = !info.fixed && scene->piece_count == 0;
        const int status = moves ? add_moving(scene, ids[i], &info) : add_obstacle(scene, ids[i], number, info.piece_count);
        if (status != GOOD) {
            return status;
        }
    }
    return scene->piece_count ? GOOD : refuse("all objects of the scene are fixed: one has to move");
}

static int take_objects(struct sweep_scene *scene)
{
    size_t count = 0;
    /* The first call says how many there are. */
    if (swiftprox_scene_copy_object_ids(scene->player.scene, NULL, 0, &count) != SWIFTPROX_OK) {
        return player_failed();
    }
    swiftprox_object_id *const ids = calloc(count + 1, sizeof *ids);
    int status = ids ? GOOD : no_memory();
    if (status == GOOD && swiftprox_scene_copy_object_ids(scene->player.scene, ids, count, &count) != SWIFTPROX_OK) {
        status = player_failed();
    }
    status = status == GOOD ? add_objects(scene, ids, count) : status;
    free(ids);
    if (status == GOOD) {
        scene->caches = calloc(scene->piece_count * scene->obstacle_count + 1, sizeof *scene->caches);
        status = scene->caches ? GOOD : no_memory();
    }
    return status;
}

int sweep_scene_open(struct sweep_scene *scene, const struct player_options *options)
{
    *scene = (struct sweep_scene){.digest = SWEEP_DIGEST_START};
    int status = player_open(&scene->player, options);
    status = status == GOOD ? player_begin(&scene->player) : status;
    status = status == GOOD ? play(&scene->player) : status;
    return status == GOOD ? take_objects(scene) : status;
}

void sweep_scene_close(struct sweep_scene *scene)
{
    free(scene->pieces);
    free(scene->obstacles);
    free(scene->caches);
    if (scene->player.scene) {
        player_end(&scene->player);
    }
    player_free(&scene->player);
}

void sweep_scene_forget(struct sweep_scene *scene)
{
    memset(scene->caches, 0, scene->piece_count * scene->obstacle_count * sizeof *scene->caches);
}

/* ---- answers ---- */

static size_t ask_pose(struct sweep_scene *scene, const double *pose, char *text, struct sweep_tally *tally)
{
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    double lower = INFINITY, upper = INFINITY;
    uint32_t nearest = UINT32_MAX;
    for (size_t pair = 0; pair < scene->piece_count * scene->obstacle_count && upper > 0; pair++) {
        const struct sweep_obstacle *const obstacle = &scene->obstacles[pair % scene->obstacle_count];
        swiftprox_pair_answer answer;
        config.max_distance = upper;
        if (swiftprox_pair_distance((swiftprox_placed){scene->pieces[pair / scene->obstacle_count], pose},
                                    (swiftprox_placed){obstacle->shape, obstacle->place.start}, &scene->caches[pair], &config,
                                    &answer) != SWIFTPROX_OK) {
            player_failed();
            return 0;
        }
        tally->queries++;
        if (answer.outcome != SWIFTPROX_OUTCOME_BEYOND && answer.upper < upper) {
            upper = answer.upper;
            nearest = obstacle->object;
        }
        lower = fmin(lower, answer.lower);
    }
    const enum sweep_outcome outcome = upper > 0 ? SWEEP_SEPARATED : SWEEP_INTERSECTING;
    tally->outcomes[outcome]++;
    const char *const word = SWEEP_WORDS[outcome];
    const int length = nearest == UINT32_MAX ? snprintf(text, SWEEP_LINE, "%s %.17g %.17g -\n", word, lower, upper)
                                             : snprintf(text, SWEEP_LINE, "%s %.17g %.17g %u\n", word, lower, upper, (unsigned)nearest);
    return (size_t)length;
}

/* The outcome of a cast as a word of the sweep. */
static enum sweep_outcome outcome_of(swiftprox_cast_outcome outcome)
{
    switch (outcome) {
    case SWIFTPROX_CAST_OUTCOME_FREE:
        return SWEEP_FREE;
    case SWIFTPROX_CAST_OUTCOME_HIT:
        return SWEEP_HIT;
    case SWIFTPROX_CAST_OUTCOME_NEAR:
        return SWEEP_NEAR;
    default:
        return SWEEP_BUDGET;
    }
}

static size_t ask_motion(struct sweep_scene *scene, const double *poses, double max_distance, char *text, struct sweep_tally *tally)
{
    swiftprox_motion motion;
    double end_error;
    if (swiftprox_motion_between(poses, poses + 12, NULL, scene->reach, &motion, &end_error) != SWIFTPROX_OK) {
        player_failed();
        return 0;
    }
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    config.max_distance = max_distance;
    swiftprox_cast_answer first = {.outcome = SWIFTPROX_CAST_OUTCOME_FREE, .time_lower = 1, .time_upper = NAN, .clearance = INFINITY};
    uint32_t object = UINT32_MAX;
    for (size_t pair = 0; pair < scene->piece_count * scene->obstacle_count && config.time_end >= config.time_begin; pair++) {
        const struct sweep_obstacle *const obstacle = &scene->obstacles[pair % scene->obstacle_count];
        swiftprox_cast_answer answer;
        if (swiftprox_pair_cast((swiftprox_moving){scene->pieces[pair / scene->obstacle_count], &motion},
                                (swiftprox_moving){obstacle->shape, &obstacle->place}, &scene->caches[pair], &config, &answer)
            != SWIFTPROX_OK) {
            player_failed();
            return 0;
        }
        tally->queries += answer.queries;
        if (answer.outcome == SWIFTPROX_CAST_OUTCOME_FREE) {
            first.clearance = fmin(first.clearance, answer.clearance);
            continue;
        }
        /* Of the others only what comes before counts; at the very beginning none does. */
        first = answer;
        object = obstacle->object;
        if (!(answer.time_lower > config.time_begin)) {
            break;
        }
        config.time_end = answer.time_lower;
    }
    const enum sweep_outcome outcome = outcome_of(first.outcome);
    tally->outcomes[outcome]++;
    tally->worst_end = fmax(tally->worst_end, end_error);
    const char *const word = SWEEP_WORDS[outcome];
    const double clearance = outcome == SWEEP_FREE ? first.clearance : NAN;
    const int length = object == UINT32_MAX
                           ? snprintf(text, SWEEP_LINE, "%s %.17g %.17g %.17g -\n", word, first.time_lower, first.time_upper, clearance)
                           : snprintf(text, SWEEP_LINE, "%s %.17g %.17g %.17g %u\n", word, first.time_lower, first.time_upper, clearance,
                                      (unsigned)object);
    return (size_t)length;
}

size_t sweep_scene_ask(struct sweep_scene *scene, enum sweep_kind kind, const double *numbers, double max_distance, char *text,
                       struct sweep_tally *tally)
{
    return kind == SWEEP_POSES ? ask_pose(scene, numbers, text, tally) : ask_motion(scene, numbers, max_distance, text, tally);
}
