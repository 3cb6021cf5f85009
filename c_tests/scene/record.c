/* Recordings through C: what is done to a scene is played back with the same answers; a disk that is full ends the recording and
 * nothing else. tests/scene/record.rs cuts and damages files.
 *
 *   record [FOLDER FOR FILES] */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "bodies.h"
#include "swiftprox/process.h"
#include "swiftprox/replay.h"
#include "swiftprox/scene.h"

enum { CUBES = 12, STEPS = 30 };

static const double CORNERS[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};

static char path[1024];

static uint32_t state = 7;

/* From 0 to 1, the same every time. */
static double draw(void)
{
    state = state * 1664525u + 1013904223u;
    return state / 4294967296.0;
}

static void set_pose(double pose[12])
{
    const double x = 4 * draw(), y = 4 * draw(), z = 4 * draw();
    place(pose, x, y, z);
}

static int32_t likes(swiftprox_object_id object1, swiftprox_object_id object2, void *user)
{
    (void)user;
    return (object1.bits + object2.bits) % 4 != 0;
}

/* A scene that does something of everything; writes the distances that it found. */
static size_t session(swiftprox_scene *scene, double *sums)
{
    const swiftprox_shape *shape;
    swiftprox_object_id ids[CUBES];
    double pose[12];
    size_t asked = 0;
    CHECK_OK(swiftprox_shape_create_from_points(CORNERS, 8, NULL, &shape));
    for (int i = 0; i < CUBES; ++i) {
        swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        set_pose(options.pose);
        options.user_data = (uint64_t)i;
        options.fixed = i < 2;
        CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, &options, &ids[i]));
    }
    for (int step = 0; step < STEPS; ++step) {
        swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
        swiftprox_scene_answer answer;
        swiftprox_scene_events events;
        query.max_distance = 0.5;
        set_pose(pose);
        CHECK_OK(swiftprox_scene_set_pose(scene, ids[step % CUBES], pose));
        CHECK_OK(swiftprox_scene_set_piece_pose(scene, ids[(step + 1) % CUBES], 0, pose));
        if (step == 4)
            CHECK_OK(swiftprox_scene_set_pair_filter(scene, likes, NULL));
        if (step == 8)
            CHECK_OK(swiftprox_scene_set_pair_active(scene, &ids[3], NULL, 0));
        if (step == 12)
            CHECK_OK(swiftprox_scene_set_pairs(scene, ids, CUBES / 2));
        if (step == 16)
            CHECK_OK(swiftprox_scene_reset_pairs(scene));
        if (step % 7 == 6)
            CHECK_OK(swiftprox_scene_shrink(scene));
        if (step % 3 == 0)
            CHECK_OK(swiftprox_scene_query_distance(scene, &query, &answer));
        else if (step % 3 == 1)
            CHECK_OK(swiftprox_scene_query_placed(scene, &(swiftprox_placed){shape, pose}, 1, SWIFTPROX_QUERY_KIND_CONTACT,
                                                  NULL, &answer));
        else
            CHECK_OK(swiftprox_scene_query_object(scene, ids[5], SWIFTPROX_QUERY_KIND_DISTANCE, &query, &answer));
        sums[asked] = 0;
        for (size_t i = 0; i < answer.count; ++i)
            sums[asked] += answer.pairs[i].answer.distance;
        ++asked;
        CHECK_OK(swiftprox_scene_query_events(scene, 0.25, &events));
        sums[asked++] = -1;
        /* Refused, and of no effect. */
        CHECK(swiftprox_scene_set_pose(scene, (swiftprox_object_id){0}, pose) == SWIFTPROX_ERROR_HANDLE);
    }
    swiftprox_shape_release(shape);
    return asked;
}

/* A scene that is recorded from its beginning. */
static swiftprox_scene *recorded_scene(void)
{
    swiftprox_scene *scene;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    CHECK_OK(swiftprox_scene_record(scene, path));
    return scene;
}

/* Plays the file to its end; how many queries it asked, all with the recorded bits if `exact`. */
static size_t play(int exact, const double *sums, swiftprox_status *ending, int *cut_off)
{
    swiftprox_replay *replay;
    swiftprox_replay_step_info step = {.struct_size = sizeof step};
    size_t asked = 0;
    *cut_off = 0;
    *ending = swiftprox_replay_open(path, NULL, &replay);
    if (*ending != SWIFTPROX_OK) {
        CHECK(replay == NULL);
        return 0;
    }
    double before = 0;
    while ((*ending = swiftprox_replay_read(replay, &step)) == SWIFTPROX_OK && step.has_step) {
        swiftprox_scene_answer answer;
        int32_t identical = 7;
        CHECK(step.fraction >= before && step.fraction <= 1);
        before = step.fraction;
        CHECK_OK(swiftprox_replay_change(replay));
        if (!step.has_query) {
            CHECK(swiftprox_replay_ask(replay, SWIFTPROX_DEFAULT_MAX_DISTANCE, &answer, &identical) ==
                      SWIFTPROX_ERROR_INVALID_ARGUMENT &&
                  identical == 0);
            continue;
        }
        CHECK_OK(swiftprox_replay_ask(replay, SWIFTPROX_DEFAULT_MAX_DISTANCE, &answer, &identical));
        CHECK(!exact || identical == 1);
        double sum = 0;
        for (size_t i = 0; i < answer.count; ++i) {
            uint32_t number = 77;
            CHECK_OK(swiftprox_replay_get_number(replay, answer.pairs[i].object1, &number));
            CHECK(number == answer.pairs[i].user_data1);
            sum += answer.pairs[i].answer.distance;
        }
        if (sums && sums[asked] >= 0)
            CHECK(sum == sums[asked]);
        ++asked;
    }
    *cut_off = step.cut_off;
    CHECK_OK(swiftprox_replay_close(replay));
    return asked;
}

static void played_back(void)
{
    swiftprox_scene *const scene = recorded_scene();
    swiftprox_status ending;
    double sums[2 * STEPS];
    int cut_off;
    const size_t asked = session(scene, sums);
    CHECK_OK(swiftprox_scene_record(scene, NULL));
    CHECK(play(1, sums, &ending, &cut_off) == asked && ending == SWIFTPROX_OK && !cut_off);

    /* From the middle of its life to its end. */
    CHECK_OK(swiftprox_scene_record(scene, path));
    swiftprox_scene_answer answer;
    CHECK_OK(swiftprox_scene_query_contact(scene, NULL, &answer));
    CHECK_OK(swiftprox_scene_destroy(scene));
    CHECK(play(0, NULL, &ending, &cut_off) == 1 && ending == SWIFTPROX_OK && !cut_off);
}

static int lines;

static void count_line(swiftprox_status status, const char *message, void *user)
{
    (void)user;
    lines += status == SWIFTPROX_ERROR_FILE && strstr(message, "the recording ends") != NULL;
}

/* As on a full disk: no file grows beyond 4 kB. */
static void a_full_disk(void)
{
    swiftprox_status ending;
    double sums[2 * STEPS];
    int cut_off;
    struct rlimit limit, before;
    CHECK(getrlimit(RLIMIT_FSIZE, &before) == 0);
    limit = before;
    limit.rlim_cur = 4096;
    signal(SIGXFSZ, SIG_IGN);
    CHECK(setrlimit(RLIMIT_FSIZE, &limit) == 0);
    swiftprox_scene *const scene = recorded_scene();
    swiftprox_library_set_log(count_line, NULL);
    session(scene, sums);
    CHECK(lines == 1);
    CHECK(swiftprox_scene_record(scene, NULL) == SWIFTPROX_ERROR_FILE);
    CHECK(strstr(swiftprox_library_last_error_message(), path) != NULL);
    CHECK_OK(swiftprox_scene_record(scene, NULL));
    swiftprox_library_set_log(NULL, NULL);
    CHECK_OK(swiftprox_scene_destroy(scene));
    CHECK(setrlimit(RLIMIT_FSIZE, &before) == 0);
    play(1, sums, &ending, &cut_off);
    CHECK(ending == SWIFTPROX_OK && cut_off);
}

static void bad_arguments(const char *folder)
{
    swiftprox_scene *scene;
    swiftprox_replay *replay = (swiftprox_replay *)path;
    swiftprox_replay_step_info step = {.struct_size = sizeof step};
    swiftprox_scene_answer answer;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    CHECK_OK(swiftprox_scene_record(scene, NULL)); /* nothing to end */
    CHECK(swiftprox_scene_record(NULL, path) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_scene_record(scene, folder) == SWIFTPROX_ERROR_FILE);
    CHECK(swiftprox_scene_record(scene, "/nowhere/at/all") == SWIFTPROX_ERROR_FILE);
    CHECK(swiftprox_replay_open(NULL, NULL, &replay) == SWIFTPROX_ERROR_NULL_POINTER && replay == NULL);
    CHECK(swiftprox_replay_open(path, NULL, NULL) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_replay_open(folder, NULL, &replay) == SWIFTPROX_ERROR_FILE);
    CHECK(swiftprox_replay_read(NULL, &step) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_replay_change(NULL) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_replay_ask(NULL, 0.5, &answer, NULL) == SWIFTPROX_ERROR_NULL_POINTER && answer.count == 0);
    CHECK(swiftprox_replay_scene(NULL) == NULL);
    CHECK_OK(swiftprox_replay_close(NULL));
    CHECK_OK(swiftprox_scene_record(scene, path));
    CHECK_OK(swiftprox_scene_destroy(scene));
    CHECK_OK(swiftprox_replay_open(path, NULL, &replay));
    step.struct_size = 3;
    CHECK(swiftprox_replay_read(replay, &step) == SWIFTPROX_ERROR_STRUCT_SIZE);
    CHECK(swiftprox_replay_read(replay, NULL) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_replay_ask(replay, 0.5, NULL, NULL) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK_OK(swiftprox_replay_close(replay));
}

int main(int argc, char **argv)
{
    const char *const folder = argc > 1 ? argv[1] : ".";
    snprintf(path, sizeof path, "%s/record.swiftprox", folder);
    played_back();
    a_full_disk();
    bad_arguments(folder);
    remove(path);
    return check_report("record");
}
