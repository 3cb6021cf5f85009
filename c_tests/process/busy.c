/*
 * A scene used by two threads at once, or from within one of its own calls, which the header forbids: each call is done or answers
 * SWIFTPROX_ERROR_BUSY, and the scene stays sound.
 *
 *     busy [rounds]
 */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "swiftprox/process.h"
#include "swiftprox/scene.h"

enum { THREADS = 4, OBJECTS = 6 };

static const double CORNERS[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const uint32_t FACES[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

static const double HERE[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static const swiftprox_shape *shape;
static swiftprox_scene *scene;
static swiftprox_object_id ids[OBJECTS];
static int rounds = 2000;

typedef struct worker {
    pthread_t thread;
    int number;
    long done, busy, other;
} worker;

/* One of the calls that a scene takes. */
static swiftprox_status call(int which, int round)
{
    double pose[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    swiftprox_scene_answer answer;
    swiftprox_scene_statistics statistics;
    swiftprox_object_info info;
    swiftprox_object_id id;
    swiftprox_status status;
    int32_t active;
    const swiftprox_shape *piece = shape;
    switch (which) {
    case 0:
        pose[3] = round % 7;
        return swiftprox_scene_set_pose(scene, ids[round % OBJECTS], pose);
    case 1:
        return swiftprox_scene_query_contact(scene, NULL, &answer);
    case 2:
        status = swiftprox_scene_add_object(scene, &piece, 1, NULL, &id);
        if (status == SWIFTPROX_OK) {
            while ((status = swiftprox_scene_remove_object(scene, id)) == SWIFTPROX_ERROR_BUSY) {
            }
        }
        return status;
    case 3:
        return swiftprox_scene_set_pair_active(scene, &ids[0], &ids[1 + round % (OBJECTS - 1)], 0);
    case 4:
        return swiftprox_scene_set_pair_active(scene, NULL, NULL, 1);
    case 5:
        return swiftprox_scene_get_statistics(scene, &statistics);
    case 6:
        memset(&info, 0, sizeof info);
        info.struct_size = sizeof info;
        return swiftprox_scene_get_object_info(scene, ids[round % OBJECTS], &info);
    case 7:
        return swiftprox_scene_get_pair_active(scene, ids[0], ids[1], &active);
    default:
        return swiftprox_scene_query_approximate(scene, NULL, &answer);
    }
}

static void *work(void *argument)
{
    worker *worker = (struct worker *)argument;
    int round;
    for (round = 0; round < rounds; ++round) {
        const swiftprox_status status = call((round + 2 * worker->number) % 9, round);
        worker->done += status == SWIFTPROX_OK;
        worker->busy += status == SWIFTPROX_ERROR_BUSY;
        worker->other += status != SWIFTPROX_OK && status != SWIFTPROX_ERROR_BUSY;
    }
    return NULL;
}

static void test_threads(void)
{
    static worker workers[THREADS];
    swiftprox_scene_answer answer;
    long done = 0;
    int i;
    for (i = 0; i < THREADS; ++i) {
        workers[i].number = i;
        CHECK(pthread_create(&workers[i].thread, NULL, work, &workers[i]) == 0);
    }
    for (i = 0; i < THREADS; ++i) {
        CHECK(pthread_join(workers[i].thread, NULL) == 0);
        CHECK(workers[i].other == 0 && workers[i].done + workers[i].busy == rounds);
        done += workers[i].done;
    }
    CHECK(done > 0);
    CHECK_OK(swiftprox_scene_set_pair_active(scene, NULL, NULL, 1));
    CHECK_OK(swiftprox_scene_query_distance(scene, NULL, &answer));
    CHECK(answer.count == OBJECTS * (OBJECTS - 1) / 2);
}

static int inside; /* calls to the allocator left before it calls the scene */
static swiftprox_status said[3];

/* Forbidden, and refused. */
static void *take(void *user, size_t size, size_t alignment)
{
    (void)user;
    if (inside > 0 && --inside == 0) {
        said[0] = call(0, 0);
        said[1] = call(5, 0);
        said[2] = swiftprox_scene_destroy(scene);
    }
    return aligned_alloc(alignment, size);
}

static void give_back(void *user, void *memory, size_t size, size_t alignment)
{
    (void)user;
    (void)size;
    (void)alignment;
    free(memory);
}

static void test_calls_inside_calls(void)
{
    swiftprox_scene_answer answer;
    int i;
    CHECK_OK(swiftprox_library_set_allocator(take, give_back, NULL));
    CHECK_OK(swiftprox_scene_shrink(scene)); /* so that the query needs memory */
    inside = 1;
    CHECK_OK(swiftprox_scene_query_intersection(scene, NULL, &answer));
    for (i = 0; i < 3; ++i) {
        CHECK(said[i] == SWIFTPROX_ERROR_BUSY);
    }
    CHECK(answer.count == OBJECTS * (OBJECTS - 1) / 2);
    CHECK_OK(swiftprox_library_set_allocator(NULL, NULL, NULL));
    CHECK(strcmp(swiftprox_library_status_string(SWIFTPROX_ERROR_BUSY), "the scene is in use") == 0);
}

/* The callback of a shape that is being made may use the scene that it is for: nothing is in use yet. */
static int32_t on_progress(void *user, double fraction)
{
    (void)user;
    (void)fraction;
    CHECK_OK(call(0, 1));
    return 0;
}

static void test_progress(void)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    const swiftprox_shape *made;
    swiftprox_object_id id;
    options.progress = on_progress;
    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 4, FACES, NULL, 4}, &options, &made));
    CHECK_OK(swiftprox_scene_add_object(scene, &made, 1, NULL, &id));
    swiftprox_shape_release(made);
}

int main(int argc, char **argv)
{
    int i;
    if (argc > 1) {
        rounds = atoi(argv[1]);
    }
    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 4, FACES, NULL, 4}, NULL, &shape));
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (i = 0; i < OBJECTS; ++i) {
        const swiftprox_shape *piece = shape;
        CHECK_OK(swiftprox_scene_add_object(scene, &piece, 1, NULL, &ids[i]));
    }
    test_threads();
    for (i = 0; i < OBJECTS; ++i) {
        CHECK_OK(swiftprox_scene_set_pose(scene, ids[i], HERE));
    }
    test_calls_inside_calls();
    test_progress();
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(shape);
    return check_report("busy");
}
