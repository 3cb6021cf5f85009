/*
 * What several threads may do at once by the header's rules: pair queries on shapes that all share, each with a cache of its
 * own; shares taken and given back; const calls on one scene, questions about sets with a scratch of each thread's own among them;
 * scenes of their own over the same shapes; failures, whose messages are each thread's own. Run under helgrind it shows that
 * nothing is shared behind the caller's back.
 *
 *     threads [rounds]
 */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/geometry.h"
#include "swiftprox/motion.h"
#include "swiftprox/scene.h"
#include "swiftprox/sets.h"
#include "swiftprox/verify.h"

enum { THREADS = 4, SHAPES = 3, STEPS = 16, SAID = 8, ROUND = 200 };

static const double CORNERS[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};

static const swiftprox_shape *shapes[SHAPES];
static swiftprox_scene *scene;
static swiftprox_object_id ids[SHAPES];
static int rounds = 50;

/* Of one thread; the first failed line, or 0. */
typedef struct worker {
    pthread_t thread;
    int number;
    int failed_line;
    double distances[STEPS];
    double said[SAID]; /* about sets */
} worker;

#define REQUIRE(condition)                                                                                                     \
    do {                                                                                                                       \
        if (!(condition) && worker->failed_line == 0)                                                                          \
            worker->failed_line = __LINE__;                                                                                    \
    } while (0)

/* Two boxes, and a round body whose look-up table the first thread makes that looks into it. */
static int make_shape(int i)
{
    double points[3 * ROUND];
    for (int k = 0; k < 24; ++k)
        points[k] = CORNERS[k] * (1 + i % (1 + k % 3));
    if (i < SHAPES - 1)
        return swiftprox_shape_create_from_points(points, 8, NULL, &shapes[i]) == SWIFTPROX_OK;
    for (int k = 0; k < ROUND; ++k) { /* a spiral around a ball in the unit cube */
        const double z = 1 - (2 * k + 1.0) / ROUND, r = sqrt(1 - z * z);
        points[3 * k] = 0.5 + 0.5 * r * cos(2.4 * k);
        points[3 * k + 1] = 0.5 + 0.5 * r * sin(2.4 * k);
        points[3 * k + 2] = 0.5 + 0.5 * z;
    }
    return swiftprox_shape_create_from_points(points, ROUND, NULL, &shapes[i]) == SWIFTPROX_OK;
}

/* Pair queries from touching to far apart and back; the last of them in `distances`. */
static void query_pairs(worker *worker)
{
    swiftprox_pair_cache cache = {{0}};
    for (int i = 0; i < STEPS; ++i) {
        swiftprox_pair_answer answer;
        double pose1[12], pose2[12];
        const swiftprox_shape *a = shapes[i % SHAPES], *b = shapes[(i + 1) % SHAPES];
        place(pose1, 0, 0, 0);
        place(pose2, 0.375 * i, 0.25 * i, 0);
        if (i % 4 == 3)
            memset(&cache, 0, sizeof cache);
        REQUIRE(swiftprox_shape_retain(a) == a);
        REQUIRE(swiftprox_pair_contact((swiftprox_placed){a, pose1}, (swiftprox_placed){b, pose2}, &cache, NULL, &answer) ==
                SWIFTPROX_OK);
        REQUIRE(swiftprox_pair_verify((swiftprox_placed){a, pose1}, (swiftprox_placed){b, pose2}, &answer) == SWIFTPROX_OK);
        swiftprox_shape_release(a);
        worker->distances[i] = answer.distance;
    }
}

/* What the scene that all share can be asked for. */
static void look_at_scene(worker *worker)
{
    swiftprox_scene_statistics statistics;
    REQUIRE(swiftprox_scene_get_statistics(scene, &statistics) == SWIFTPROX_OK && statistics.queries == 1);
    for (int i = 0; i < SHAPES; ++i) {
        swiftprox_object_info info;
        const swiftprox_shape *piece;
        int32_t active;
        info.struct_size = sizeof info;
        REQUIRE(swiftprox_scene_get_object_info(scene, ids[i], &info) == SWIFTPROX_OK && info.user_data == (uint64_t)i);
        REQUIRE(swiftprox_scene_get_piece(scene, ids[i], 0, &piece) == SWIFTPROX_OK && piece == shapes[i]);
        REQUIRE(swiftprox_scene_get_pair_active(scene, ids[i], ids[(i + 1) % SHAPES], &active) == SWIFTPROX_OK && active == 1);
    }
}

/* Questions about the first object of the scene that all share. */
static void ask_about_a_set(worker *worker)
{
    const swiftprox_object_set set = {.ids = ids, .count = 1};
    const swiftprox_ray ray = {{-5, 0.5, 0.5}, {1, 0, 0}, 100};
    double poses[3 * 12];
    swiftprox_scratch *scratch;
    swiftprox_least_distance least;
    swiftprox_first_hit hit;
    swiftprox_scene_ray_answer met;
    swiftprox_scene_cast_answer cast;
    swiftprox_motion motion;
    for (int i = 0; i < 3; ++i)
        place(poses + 12 * i, 1.5 * i, 0, 0);
    REQUIRE(swiftprox_motion_between(poses, poses + 24, NULL, 4, &motion, NULL) == SWIFTPROX_OK);
    REQUIRE(swiftprox_scratch_create(&scratch) == SWIFTPROX_OK);
    REQUIRE(swiftprox_scene_least_distance(scene, &set, NULL, 100, scratch, &least) == SWIFTPROX_OK);
    REQUIRE(swiftprox_scene_first_hit(scene, &set, (swiftprox_path){poses, 3, SWIFTPROX_POSE_ORDER_IN_ORDER}, 0, scratch, &hit) ==
            SWIFTPROX_OK);
    REQUIRE(swiftprox_scene_cast(scene, &set, (swiftprox_motions){&motion, 1, 1}, NULL, scratch, &cast) == SWIFTPROX_OK);
    REQUIRE(swiftprox_scene_cast_ray(scene, &ray, SWIFTPROX_RAY_HITS_ALL, UINT32_MAX, scratch, &met) == SWIFTPROX_OK);
    REQUIRE(met.count == SHAPES && hit.time == 2 && cast.outcome == SWIFTPROX_CAST_OUTCOME_HIT);
    const double said[SAID] = {least.lower, least.upper, (double)hit.time, cast.time_lower, cast.time_upper, (double)met.count,
                               met.hits[0].answer.entry[0], met.hits[2].answer.exit[1]};
    memcpy(worker->said, said, sizeof said);
    swiftprox_scratch_destroy(scratch);
}

/* A scene of the thread's own, over shapes that all share. */
static void use_own_scene(worker *worker)
{
    swiftprox_scene *own;
    swiftprox_scene_answer answer;
    swiftprox_object_id id;
    REQUIRE(swiftprox_scene_create(NULL, &own) == SWIFTPROX_OK);
    for (int i = 0; i < SHAPES; ++i) {
        swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        const swiftprox_shape *piece = shapes[i];
        place(options.pose, 3.0 * i, worker->number, 0);
        REQUIRE(swiftprox_scene_add_object(own, &piece, 1, &options, &id) == SWIFTPROX_OK);
    }
    REQUIRE(swiftprox_scene_query_distance(own, NULL, &answer) == SWIFTPROX_OK && answer.count == SHAPES);
    REQUIRE(swiftprox_scene_remove_object(own, id) == SWIFTPROX_OK);
    /* Each thread fails in its own way and reads its own message. */
    REQUIRE(swiftprox_scene_remove_object(own, id) == SWIFTPROX_ERROR_HANDLE);
    REQUIRE(strstr(swiftprox_library_last_error_message(), "stale") != NULL);
    REQUIRE(swiftprox_library_check_version(100 + worker->number, 0, 0) == SWIFTPROX_ERROR_VERSION);
    REQUIRE(strstr(swiftprox_library_last_error_message(), (const char *[]){"100.", "101.", "102.", "103."}[worker->number]) !=
            NULL);
    REQUIRE(swiftprox_scene_destroy(own) == SWIFTPROX_OK);
}

static void *work(void *argument)
{
    worker *const worker = argument;
    for (int round = 0; round < rounds; ++round) {
        query_pairs(worker);
        look_at_scene(worker);
        ask_about_a_set(worker);
        use_own_scene(worker);
    }
    return NULL;
}

int main(int argument_count, char **arguments)
{
    worker workers[THREADS] = {{0}};
    swiftprox_scene_answer answer;
    int failures = 0;
    if (argument_count > 1)
        rounds = atoi(arguments[1]);
    if (swiftprox_scene_create(NULL, &scene) != SWIFTPROX_OK)
        return 1;
    for (int i = 0; i < SHAPES; ++i) {
        swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        const swiftprox_shape *piece;
        if (!make_shape(i))
            return 1;
        piece = shapes[i];
        options.user_data = (uint64_t)i;
        place(options.pose, 3.0 * i, 0, 0);
        if (swiftprox_scene_add_object(scene, &piece, 1, &options, &ids[i]) != SWIFTPROX_OK)
            return 1;
    }
    if (swiftprox_scene_query_distance(scene, NULL, &answer) != SWIFTPROX_OK)
        return 1;
    for (int i = 0; i < THREADS; ++i) {
        workers[i].number = i;
        if (pthread_create(&workers[i].thread, NULL, work, &workers[i]) != 0)
            return 1;
    }
    for (int i = 0; i < THREADS; ++i)
        pthread_join(workers[i].thread, NULL);
    for (int i = 0; i < THREADS; ++i) {
        if (workers[i].failed_line != 0) {
            fprintf(stderr, "threads.c:%d: failed in thread %d\n", workers[i].failed_line, i);
            ++failures;
        }
        if (memcmp(workers[i].distances, workers[0].distances, sizeof workers[0].distances) != 0) {
            fprintf(stderr, "thread %d has other distances than thread 0\n", i);
            ++failures;
        }
        if (memcmp(workers[i].said, workers[0].said, sizeof workers[0].said) != 0) {
            fprintf(stderr, "thread %d has other answers about a set than thread 0\n", i);
            ++failures;
        }
    }
    for (int i = 0; i < SHAPES; ++i)
        swiftprox_shape_release(shapes[i]);
    failures += swiftprox_scene_destroy(scene) != SWIFTPROX_OK;
    printf("threads: %d threads, %d rounds, %d failures\n", THREADS, rounds, failures);
    return failures == 0 ? 0 : 1;
}
