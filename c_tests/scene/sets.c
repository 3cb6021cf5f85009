/*
 * Questions about sets of objects from C: answers that are known, and what a program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/geometry.h"
#include "swiftprox/motion.h"
#include "swiftprox/sets.h"

static swiftprox_scene *scene;
static swiftprox_object_id arm[2], posts[20];

/* An arm of two cubes of side 1, and twenty cubes in a row, 3 apart, which begins 10 away. */
static void make(void)
{
    int i;
    const swiftprox_shape *const shape = box(0.5, 0.5, 0.5);
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (i = 0; i < 2; ++i) {
        place(options.pose, 0, 2.0 * i, 0);
        CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, &options, &arm[i]));
    }
    options.fixed = 1;
    for (i = 0; i < 20; ++i) {
        place(options.pose, 10 + 3.0 * i, 0, 0);
        CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, &options, &posts[i]));
    }
    swiftprox_shape_release(shape);
}

static void answers_that_are_known(swiftprox_scratch *scratch)
{
    swiftprox_object_set set = {0}, wall = {0};
    swiftprox_least_distance least;
    swiftprox_first_hit hit;
    swiftprox_ray ray = {{0, 5, 0}, {0, -1, 0}, HUGE_VAL};
    swiftprox_scene_ray_answer met;
    swiftprox_scene_cast_answer cast, edges[3];
    swiftprox_motion motions[3];
    double poses[2 * 4 * 12], start[12], end[12];
    int i;
    set.ids = arm;
    set.count = 2;
    CHECK_OK(swiftprox_scene_least_distance(scene, &set, NULL, HUGE_VAL, scratch, &least));
    CHECK(least.lower <= 9 && 9 <= least.upper && least.upper - least.lower < 1e-12);
    CHECK(least.nearest.object1.bits == arm[0].bits && least.nearest.object2.bits == posts[0].bits);
    wall.ids = posts + 5;
    wall.count = 3;
    CHECK_OK(swiftprox_scene_least_distance(scene, &set, &wall, HUGE_VAL, NULL, &least));
    CHECK(least.lower <= 24 && 24 <= least.upper && least.nearest.object2.bits == posts[5].bits);
    set.among = 1;
    CHECK_OK(swiftprox_scene_least_distance(scene, &set, NULL, 2, scratch, &least));
    CHECK(least.lower <= 1 && 1 <= least.upper && least.upper < 1 + 1e-12 && least.nearest.object2.bits == arm[1].bits);
    set.among = 0;
    CHECK_OK(swiftprox_scene_least_distance(scene, &set, NULL, 2, scratch, &least));
    CHECK(least.lower == 2 && least.upper == HUGE_VAL && least.nearest.object1.bits == 0);
    /* Only the third time hits. */
    for (i = 0; i < 4; ++i) {
        place(poses + 24 * i, i == 2 ? 10.25 : -5, 0, 0);
        place(poses + 24 * i + 12, -5, 2, 0);
    }
    CHECK_OK(swiftprox_scene_first_hit(scene, &set, (swiftprox_path){poses, 4, SWIFTPROX_POSE_ORDER_IN_ORDER}, 0, scratch, &hit));
    CHECK(hit.time == 2 && hit.tried == 3 && hit.pair.object2.bits == posts[0].bits);
    CHECK_OK(swiftprox_scene_first_hit(scene, &set, (swiftprox_path){poses, 2, SWIFTPROX_POSE_ORDER_BISECTION}, 0, scratch, &hit));
    CHECK(hit.time == 2 && hit.tried == 2 && hit.pair.object1.bits == 0);
    CHECK_OK(swiftprox_scene_cast_ray(scene, &ray, SWIFTPROX_RAY_HITS_ALL, UINT32_MAX, scratch, &met));
    CHECK(met.count == 2 && met.hits[0].object.bits == arm[1].bits && met.hits[1].object.bits == arm[0].bits);
    CHECK(met.hits[1].answer.entry[0] <= 4.5 && 4.5 <= met.hits[1].answer.entry[1]);
    CHECK_OK(swiftprox_scene_cast_ray(scene, &ray, SWIFTPROX_RAY_HITS_FIRST, UINT32_MAX, scratch, &met));
    CHECK(met.count == 1 && met.hits[0].object.bits == arm[1].bits && met.hits[0].answer.exit[1] >= 3.5);
    place(start, 0, 0, 0);
    place(end, 10, 0, 0);
    CHECK_OK(swiftprox_motion_between(start, end, NULL, 3, &motions[0], NULL));
    end[3] = -10;
    CHECK_OK(swiftprox_motion_between(start, end, NULL, 3, &motions[1], NULL));
    motions[2] = motions[0];
    set.count = 1;
    CHECK_OK(swiftprox_scene_cast(scene, &set, (swiftprox_motions){motions, 1, 1}, NULL, scratch, &cast));
    CHECK(cast.outcome == SWIFTPROX_CAST_OUTCOME_HIT && cast.pair.object2.bits == posts[0].bits);
    CHECK(cast.time_lower <= 0.9 && 0.9 <= cast.time_upper && cast.time_upper - cast.time_lower < 2e-9);
    CHECK_OK(swiftprox_scene_cast(scene, &set, (swiftprox_motions){motions, 3, 3}, NULL, scratch, edges));
    CHECK(edges[0].outcome == SWIFTPROX_CAST_OUTCOME_HIT && edges[2].outcome == SWIFTPROX_CAST_OUTCOME_HIT);
    CHECK(edges[1].outcome == SWIFTPROX_CAST_OUTCOME_FREE && edges[1].time_lower == 1 && isnan(edges[1].time_upper));
}

static void mistakes(swiftprox_scratch *scratch)
{
    swiftprox_object_set set = {0}, none = {0};
    swiftprox_least_distance least;
    swiftprox_first_hit hit;
    swiftprox_ray ray = {{0, 5, 0}, {0, -1, 0}, 1};
    swiftprox_scene_ray_answer met;
    swiftprox_scene_cast_answer cast;
    swiftprox_motion motion;
    swiftprox_object_id null_id = {0};
    double pose[12];
    place(pose, 0, 0, 0);
    set.ids = arm;
    set.count = 1;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_least_distance(NULL, &set, NULL, 1, scratch, &least));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "set", swiftprox_scene_least_distance(scene, NULL, NULL, 1, scratch, &least));
    CHECK(isnan(least.lower) && isnan(least.upper));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_scene_least_distance(scene, &set, NULL, 1, scratch, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance", swiftprox_scene_least_distance(scene, &set, NULL, -1, scratch, &least));
    none.count = 1;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "set->ids", swiftprox_scene_least_distance(scene, &none, NULL, 1, scratch, &least));
    none.ids = &null_id;
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "null", swiftprox_scene_least_distance(scene, &none, NULL, 1, scratch, &least));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "poses",
                swiftprox_scene_first_hit(scene, &set, (swiftprox_path){NULL, 1, SWIFTPROX_POSE_ORDER_IN_ORDER}, 0, scratch, &hit));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "swiftprox_pose_order",
                swiftprox_scene_first_hit(scene, &set, (swiftprox_path){pose, 1, (swiftprox_pose_order)7}, 0, scratch, &hit));
    CHECK(hit.time == 0 && hit.tried == 0);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scratch",
                swiftprox_scene_cast_ray(scene, &ray, SWIFTPROX_RAY_HITS_ALL, 1, NULL, &met));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "swiftprox_ray_hits",
                swiftprox_scene_cast_ray(scene, &ray, (swiftprox_ray_hits)9, 1, scratch, &met));
    CHECK(met.count == 0 && met.hits == NULL);
    memset(&motion, 0, sizeof motion);
    motion.kind = (swiftprox_motion_kind)9;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "motions[0]", swiftprox_scene_cast(scene, &set,
                                                                                     (swiftprox_motions){&motion, 1, 1}, NULL,
                                                                                     scratch, &cast));
    CHECK(cast.outcome == SWIFTPROX_CAST_OUTCOME_NONE && isnan(cast.time_lower));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "motions", swiftprox_scene_cast(scene, &set, (swiftprox_motions){NULL, 1, 1}, NULL,
                                                                              scratch, &cast));
    motion.kind = SWIFTPROX_MOTION_KIND_FIXED;
    memcpy(motion.start, pose, sizeof pose);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answers",
                swiftprox_scene_cast(scene, &set, (swiftprox_motions){&motion, 1, 1}, NULL, scratch, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_prepare(NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scratch", swiftprox_scratch_create(NULL));
    swiftprox_scratch_destroy(NULL);
}

int main(void)
{
    swiftprox_scratch *scratch = NULL;
    make();
    CHECK_OK(swiftprox_scratch_create(&scratch));
    answers_that_are_known(scratch);
    CHECK_OK(swiftprox_scene_prepare(scene));
    answers_that_are_known(scratch);
    mistakes(scratch);
    swiftprox_scratch_destroy(scratch);
    CHECK_OK(swiftprox_scene_destroy(scene));
    return check_report("sets");
}
