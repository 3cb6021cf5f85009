/*
 * Motions from C: casts and clearances that are known, their check, and what a program may do wrong.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/motion.h"
#include "swiftprox/verify.h"

static void fixed(swiftprox_motion *motion, double x, double y, double z)
{
    memset(motion, 0, sizeof *motion);
    motion->kind = SWIFTPROX_MOTION_KIND_FIXED;
    place(motion->start, x, y, z);
}

/* What a callback is asked, and how often. */
struct fall {
    int calls;
    int is_careless;
};

static void fall_pose(void *user, double time, double *pose)
{
    struct fall *const fall = user;
    ++fall->calls;
    if (!fall->is_careless) {
        place(pose, 0.25, 0, 3 - 4 * time);
    }
}

static void known_casts(const swiftprox_shape *cube)
{
    swiftprox_motion still, falling;
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    swiftprox_cast_answer answer;
    swiftprox_pair_cache cache = {{0}};
    double start[12], end[12], error = -1;
    fixed(&still, 0, 0, 0);
    place(start, 0.25, 0, 3);
    place(end, 0.25, 0, -1);
    CHECK_OK(swiftprox_motion_between(start, end, NULL, 1, &falling, &error));
    CHECK(falling.kind == SWIFTPROX_MOTION_KIND_SCREW && falling.velocity[2] == -4 && error >= 0 && error < 1e-13);
    CHECK_OK(swiftprox_pair_cast((swiftprox_moving){cube, &falling}, (swiftprox_moving){cube, &still}, &cache, NULL, &answer));
    CHECK(answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT && answer.time_lower < 0.5 && 0.5 <= answer.time_upper);
    CHECK(answer.time_upper - answer.time_lower <= 1e-9 && answer.upper == 0 && isnan(answer.clearance));
    /* Told where they are still apart, shown where they meet. */
    CHECK(answer.contact.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.contact.distance < 5e-9 && answer.proof_count > 0);
    CHECK(fabs(answer.contact.normal[2] - 1) < 1e-12 && answer.queries > 0);
    CHECK_OK(swiftprox_pair_cast_verify((swiftprox_moving){cube, &falling}, (swiftprox_moving){cube, &still}, NULL, &answer));
    answer.time_lower = answer.time_upper;
    CHECK_FAILS(SWIFTPROX_ERROR_UNVERIFIED, "time", swiftprox_pair_cast_verify((swiftprox_moving){cube, &falling},
                                                                               (swiftprox_moving){cube, &still}, NULL, &answer));
    CHECK(strcmp(swiftprox_library_cast_outcome_string(answer.outcome), "hit") == 0);

    /* Free before it comes there; and max_distance. */
    CHECK(config.time_begin == 0 && config.time_end == 1 && config.time_tolerance == 1e-9 && config.max_distance == 0);
    config.time_end = 0.25;
    config.max_distance = 0.75;
    CHECK_OK(swiftprox_pair_cast((swiftprox_moving){cube, &falling}, (swiftprox_moving){cube, &still}, &cache, &config, &answer));
    CHECK(answer.outcome == SWIFTPROX_CAST_OUTCOME_FREE && answer.time_lower == 0.25 && isnan(answer.time_upper));
    CHECK(answer.clearance > config.max_distance && answer.clearance <= 1);
    CHECK_OK(swiftprox_pair_cast_verify((swiftprox_moving){cube, &falling}, (swiftprox_moving){cube, &still}, &config, &answer));
    answer.clearance = 1.5;
    CHECK_FAILS(SWIFTPROX_ERROR_UNVERIFIED, "apart", swiftprox_pair_cast_verify((swiftprox_moving){cube, &falling},
                                                                                (swiftprox_moving){cube, &still}, &config,
                                                                                &answer));
    config.max_distance = 1.5;
    CHECK_OK(swiftprox_pair_cast((swiftprox_moving){cube, &falling}, (swiftprox_moving){cube, &still}, &cache, &config, &answer));
    CHECK(answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT && answer.time_lower < 0.125 && answer.time_upper >= 0.125);
    CHECK(answer.upper <= 1.5);
}

/* Cubes that touch, from which one rises: a hit, or with the option free from where they have parted. */
static void parting(const swiftprox_shape *cube)
{
    swiftprox_motion still, rising;
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    swiftprox_cast_answer answer;
    swiftprox_pair_cache cache = {{0}};
    double start[12], end[12];
    fixed(&still, 0, 0, 0);
    place(start, 0.25, 0, 1);
    place(end, 0.25, 0, 3);
    CHECK_OK(swiftprox_motion_between(start, end, NULL, 1, &rising, NULL));
    CHECK(config.ignores_parting == 0);
    CHECK_OK(swiftprox_pair_cast((swiftprox_moving){cube, &rising}, (swiftprox_moving){cube, &still}, &cache, &config, &answer));
    CHECK(answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT && answer.time_upper == 0 && isnan(answer.time_parted));
    CHECK(answer.proof_count > 0);
    config.ignores_parting = 1;
    CHECK_OK(swiftprox_pair_cast((swiftprox_moving){cube, &rising}, (swiftprox_moving){cube, &still}, &cache, &config, &answer));
    CHECK(answer.outcome == SWIFTPROX_CAST_OUTCOME_FREE && answer.proof_count == 0);
    CHECK(answer.time_parted > 0 && answer.time_parted <= 1024 * config.time_tolerance);
    CHECK_OK(swiftprox_pair_cast_verify((swiftprox_moving){cube, &rising}, (swiftprox_moving){cube, &still}, &config, &answer));
}

static void known_clearances(const swiftprox_shape *cube)
{
    swiftprox_motion still, passing;
    swiftprox_clearance_config config = SWIFTPROX_CLEARANCE_CONFIG_DEFAULT;
    swiftprox_clearance clearance;
    swiftprox_pair_cache cache = {{0}};
    double start[12], end[12];
    fixed(&still, 0, 0, 0);
    place(start, -4, 0, 1.25);
    place(end, 4, 0, 1.25);
    CHECK_OK(swiftprox_motion_between(start, end, NULL, 1, &passing, NULL));
    CHECK_OK(swiftprox_pair_clearance((swiftprox_moving){cube, &passing}, (swiftprox_moving){cube, &still}, &cache, NULL,
                                      &clearance));
    CHECK(clearance.lower <= 0.25 && 0.25 <= clearance.upper && clearance.upper <= 1.01 * clearance.lower + 1e-15);
    config.relative_error = 0;
    config.absolute_error = 1e-9;
    CHECK_OK(swiftprox_pair_clearance((swiftprox_moving){cube, &passing}, (swiftprox_moving){cube, &still}, &cache, &config,
                                      &clearance));
    CHECK(clearance.lower <= 0.25 && 0.25 <= clearance.upper && clearance.upper - clearance.lower <= 1e-9);
    config.step_budget = 0;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "step_budget",
                swiftprox_pair_clearance((swiftprox_moving){cube, &passing}, (swiftprox_moving){cube, &still}, &cache, &config,
                                         &clearance));
    CHECK(isnan(clearance.lower) && isnan(clearance.upper));
}

static void callbacks(const swiftprox_shape *cube)
{
    struct fall fall = {0, 0};
    swiftprox_motion still, falling;
    swiftprox_cast_answer answer;
    swiftprox_pair_cache cache = {{0}};
    fixed(&still, 0, 0, 0);
    memset(&falling, 0, sizeof falling);
    falling.kind = SWIFTPROX_MOTION_KIND_CALLBACK;
    falling.pose = fall_pose;
    falling.user = &fall;
    falling.rounding = 1e-14;
    CHECK_OK(swiftprox_pair_cast((swiftprox_moving){cube, &falling}, (swiftprox_moving){cube, &still}, &cache, NULL, &answer));
    CHECK(answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT && answer.time_lower < 0.5 + 1e-13 && answer.time_upper > 0.5 - 1e-13);
    CHECK(fall.calls > 0);
    CHECK_OK(swiftprox_pair_cast_verify((swiftprox_moving){cube, &falling}, (swiftprox_moving){cube, &still}, NULL, &answer));
    /* Who writes no pose is found out. */
    fall.is_careless = 1;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "time", swiftprox_pair_cast((swiftprox_moving){cube, &falling},
                                                                  (swiftprox_moving){cube, &still}, &cache, NULL, &answer));
    CHECK(answer.outcome == SWIFTPROX_CAST_OUTCOME_NONE && isnan(answer.time_lower));
    falling.pose = NULL;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object1.motion->pose",
                swiftprox_pair_cast((swiftprox_moving){cube, &falling}, (swiftprox_moving){cube, &still}, &cache, NULL, &answer));
    falling.pose = fall_pose;
    falling.bend = -1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "bend",
                swiftprox_pair_cast((swiftprox_moving){cube, &falling}, (swiftprox_moving){cube, &still}, &cache, NULL, &answer));
}

static void mistakes(const swiftprox_shape *cube)
{
    swiftprox_motion still, other;
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    swiftprox_cast_answer answer;
    swiftprox_pair_cache cache = {{0}}, before = {{0}};
    double pose[12], nowhere[12] = {0};
    fixed(&still, 0, 0, 0);
    fixed(&other, 3, 0, 0);
    place(pose, 0, 0, 0);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object1.shape", swiftprox_pair_cast((swiftprox_moving){NULL, &other},
                                                                            (swiftprox_moving){cube, &still}, &cache, NULL,
                                                                            &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object2.motion", swiftprox_pair_cast((swiftprox_moving){cube, &other},
                                                                             (swiftprox_moving){cube, NULL}, &cache, NULL,
                                                                             &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "cache", swiftprox_pair_cast((swiftprox_moving){cube, &other},
                                                                           (swiftprox_moving){cube, &still}, NULL, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_pair_cast((swiftprox_moving){cube, &other},
                                                                            (swiftprox_moving){cube, &still}, &cache, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_pair_cast_verify((swiftprox_moving){cube, &other},
                                                                                   (swiftprox_moving){cube, &still}, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "motion", swiftprox_motion_between(pose, pose, NULL, 1, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "rotation", swiftprox_motion_between(pose, nowhere, NULL, 1, &other, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "reach", swiftprox_motion_between(pose, pose, NULL, -1, &other, NULL));
    config.max_distance = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
                swiftprox_pair_cast((swiftprox_moving){cube, &other}, (swiftprox_moving){cube, &still}, &cache, &config, &answer));
    config.struct_size = 3;
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "swiftprox_cast_config",
                swiftprox_pair_cast((swiftprox_moving){cube, &other}, (swiftprox_moving){cube, &still}, &cache, &config, &answer));
    memset(&other.kind, 0x7f, sizeof other.kind);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "object1.motion->kind",
                swiftprox_pair_cast((swiftprox_moving){cube, &other}, (swiftprox_moving){cube, &still}, &cache, NULL, &answer));
    fixed(&other, NAN, 0, 0);
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "object 1", swiftprox_pair_cast((swiftprox_moving){cube, &other},
                                                                      (swiftprox_moving){cube, &still}, &cache, NULL, &answer));
    CHECK(memcmp(&cache, &before, sizeof cache) == 0 && answer.outcome == SWIFTPROX_CAST_OUTCOME_NONE);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "no outcome", swiftprox_pair_cast_verify((swiftprox_moving){cube, &still},
                                                                                           (swiftprox_moving){cube, &still},
                                                                                           NULL, &answer));
    memset(&answer.contact.decided_by, 0x7f, sizeof answer.contact.decided_by);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "decided_by",
                swiftprox_pair_cast_verify((swiftprox_moving){cube, &still}, (swiftprox_moving){cube, &still}, NULL, &answer));
}

int main(void)
{
    const swiftprox_shape *cube = box(0.5, 0.5, 0.5);
    known_casts(cube);
    parting(cube);
    known_clearances(cube);
    callbacks(cube);
    mistakes(cube);
    swiftprox_shape_release(cube);
    return check_report("cast");
}
