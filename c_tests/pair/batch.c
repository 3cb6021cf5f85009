/*
 * Many pairs at once from C: the bits of single calls, alone and by a scene's workers, and what a program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/batch.h"

enum { COUNT = 3000 };

static double poses[2][COUNT][12];
static swiftprox_pair_cache single[COUNT], caches[COUNT];
static swiftprox_pair_answer expected[COUNT], answers[COUNT];
static swiftprox_pair_question pairs[COUNT];

/* One pair at many poses: the bits of single calls with one cache, which is left as they leave it. */
static void distances(const swiftprox_shape *const shapes[2])
{
    swiftprox_pair_cache one, other;
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    const swiftprox_poses still = {shapes[0], poses[0][0], 1}, moving = {shapes[0], poses[0][0], COUNT},
                          second = {shapes[1], poses[1][0], COUNT}, short_path = {shapes[1], poses[1][0], 3};
    int i, k;
    for (k = 0; k < 2; ++k) {
        memset(&one, 0, sizeof one);
        memset(&other, 0, sizeof other);
        for (i = 0; i < COUNT; ++i) {
            CHECK_OK(swiftprox_pair_distance((swiftprox_placed){shapes[0], poses[0][k ? i : 0]},
                                             (swiftprox_placed){shapes[1], poses[1][i]}, &one, NULL, &expected[i]));
        }
        CHECK_OK(swiftprox_pair_distances(k ? moving : still, second, &other, NULL, answers));
        CHECK(memcmp(&one, &other, sizeof one) == 0);
        for (i = 0; i < COUNT; ++i) {
            CHECK(answers[i].outcome == expected[i].outcome && answers[i].decided_by == expected[i].decided_by);
            CHECK(memcmp(&answers[i].distance, &expected[i].distance, 3 * sizeof(double)) == 0);
            CHECK(memcmp(answers[i].world1, expected[i].world1, sizeof answers[i].world1) == 0);
            CHECK(memcmp(answers[i].normal, expected[i].normal, sizeof answers[i].normal) == 0);
        }
    }
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "object1.count is 3000 and object2.count 3",
                swiftprox_pair_distances(moving, short_path, &other, NULL, answers));
    CHECK(answers[2].outcome == SWIFTPROX_OUTCOME_NONE);
    CHECK_OK(swiftprox_pair_distances(still, (swiftprox_poses){shapes[1], NULL, 0}, &other, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object2.shape",
                swiftprox_pair_distances(still, (swiftprox_poses){NULL, poses[1][0], 2}, &other, NULL, answers));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object2.poses",
                swiftprox_pair_distances(still, (swiftprox_poses){shapes[1], NULL, 2}, &other, NULL, answers));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "cache", swiftprox_pair_distances(still, second, NULL, NULL, answers));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answers", swiftprox_pair_distances(still, second, &other, NULL, NULL));
    config.max_distance = -1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
                swiftprox_pair_distances(still, short_path, &other, &config, answers));
    poses[1][1][3] = HUGE_VAL;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "pose 1", swiftprox_pair_distances(still, short_path, &other, NULL, answers));
    CHECK(answers[0].outcome != SWIFTPROX_OUTCOME_NONE && answers[1].outcome == SWIFTPROX_OUTCOME_NONE);
    CHECK(isnan(answers[1].distance) && answers[2].outcome != SWIFTPROX_OUTCOME_NONE);
    poses[1][1][3] = 1e-3;
}

int main(void)
{
    const swiftprox_shape *shapes[2];
    swiftprox_scene_options options = SWIFTPROX_SCENE_OPTIONS_DEFAULT;
    swiftprox_scene *scene = NULL;
    int i, k, round;
    shapes[0] = box(1, 0.5, 0.25);
    shapes[1] = box(0.5, 0.5, 2);
    options.worker_count = 3;
    CHECK_OK(swiftprox_scene_create(&options, &scene));
    for (round = 0; round < 4; ++round) {
        for (i = 0; i < COUNT; ++i) {
            for (k = 0; k < 2; ++k) {
                const double angle = 0.01 * i + 0.1 * round + k;
                double *pose = poses[k][i];
                memset(pose, 0, 12 * sizeof *pose);
                pose[0] = pose[5] = cos(angle);
                pose[4] = sin(angle);
                pose[1] = -pose[4];
                pose[10] = 1;
                pose[3] = 1e-3 * k * i;
            }
            pairs[i].shape1 = shapes[0];
            pairs[i].pose1 = poses[0][i];
            pairs[i].shape2 = shapes[1];
            pairs[i].pose2 = poses[1][i];
            pairs[i].cache = &caches[i];
            CHECK_OK(swiftprox_pair_distance((swiftprox_placed){shapes[0], poses[0][i]},
                                             (swiftprox_placed){shapes[1], poses[1][i]}, &single[i], NULL, &expected[i]));
        }
        CHECK_OK(swiftprox_pair_batch(SWIFTPROX_QUERY_KIND_DISTANCE, pairs, COUNT, NULL, round % 2 ? scene : NULL, answers));
        CHECK(memcmp(caches, single, sizeof caches) == 0);
        for (i = 0; i < COUNT; ++i) {
            CHECK(answers[i].outcome == expected[i].outcome && answers[i].lower == expected[i].lower);
            CHECK(memcmp(answers[i].world1, expected[i].world1, sizeof answers[i].world1) == 0);
        }
    }
    distances(shapes);
    poses[1][7][3] = HUGE_VAL;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "pair 7", swiftprox_pair_batch(SWIFTPROX_QUERY_KIND_CONTACT, pairs, COUNT, NULL, scene, answers));
    CHECK(answers[7].outcome == SWIFTPROX_OUTCOME_NONE && isnan(answers[7].distance) && answers[8].outcome != SWIFTPROX_OUTCOME_NONE);
    pairs[1].cache = NULL;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pairs[1]: the pointer `cache`",
                swiftprox_pair_batch(SWIFTPROX_QUERY_KIND_CONTACT, pairs, COUNT, NULL, NULL, answers));
    CHECK(answers[8].outcome == SWIFTPROX_OUTCOME_NONE);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "swiftprox_query_kind",
                swiftprox_pair_batch((swiftprox_query_kind)9, pairs, 1, NULL, NULL, answers));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answers", swiftprox_pair_batch(SWIFTPROX_QUERY_KIND_CONTACT, pairs, 1, NULL, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pairs", swiftprox_pair_batch(SWIFTPROX_QUERY_KIND_CONTACT, NULL, 1, NULL, NULL, answers));
    CHECK_OK(swiftprox_pair_batch(SWIFTPROX_QUERY_KIND_CONTACT, NULL, 0, NULL, NULL, answers));
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(shapes[0]);
    swiftprox_shape_release(shapes[1]);
    return check_report("batch");
}
