/*
 * Rays from C: answers that are known, and what a program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "bodies.h"

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static void answers_that_are_known(void)
{
    const swiftprox_shape *shape = box(1, 1, 1);
    swiftprox_ray ray = {{-5, 0.25, 0.5}, {2, 0, 0}, 10};
    swiftprox_ray_answer answer;
    CHECK_OK(swiftprox_shape_cast_ray(shape, identity, &ray, &answer));
    CHECK(answer.outcome == SWIFTPROX_RAY_OUTCOME_HIT);
    CHECK(answer.entry[0] <= 2 && 2 <= answer.entry[1] && answer.entry[1] - answer.entry[0] < 1e-12);
    CHECK(answer.exit[0] <= 3 && 3 <= answer.exit[1] && answer.exit[1] - answer.exit[0] < 1e-12);
    CHECK(answer.normal[0] == -1 && answer.feature.kind == SWIFTPROX_FEATURE_KIND_FACE);
    ray.t_max = 1;
    CHECK_OK(swiftprox_shape_cast_ray(shape, identity, &ray, &answer));
    CHECK(answer.outcome == SWIFTPROX_RAY_OUTCOME_MISS && isnan(answer.entry[0]) && isnan(answer.exit[1]));
    ray.origin[0] = 0;
    CHECK_OK(swiftprox_shape_cast_ray(shape, identity, &ray, &answer));
    CHECK(answer.outcome == SWIFTPROX_RAY_OUTCOME_INSIDE && answer.entry[1] == 0);
    CHECK(answer.feature.kind == SWIFTPROX_FEATURE_KIND_NONE && isnan(answer.normal[2]));
    CHECK(strcmp(swiftprox_library_ray_outcome_string(answer.outcome), "inside") == 0);
    swiftprox_shape_release(shape);
}

static void mistakes(void)
{
    const swiftprox_shape *shape = box(1, 1, 1);
    double pose[12];
    const swiftprox_ray good = {{-5, 0, 0}, {1, 0, 0}, 1};
    swiftprox_ray ray = good;
    swiftprox_ray_answer answer;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "shape", swiftprox_shape_cast_ray(NULL, identity, &ray, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pose", swiftprox_shape_cast_ray(shape, NULL, &ray, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ray", swiftprox_shape_cast_ray(shape, identity, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_shape_cast_ray(shape, identity, &ray, NULL));
    ray.direction[0] = 0;
    memset(&answer, 7, sizeof answer);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "direction", swiftprox_shape_cast_ray(shape, identity, &ray, &answer));
    CHECK(answer.outcome == SWIFTPROX_RAY_OUTCOME_NONE && isnan(answer.entry[0]));
    ray = good;
    ray.t_max = -1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "t_max", swiftprox_shape_cast_ray(shape, identity, &ray, &answer));
    memcpy(pose, identity, sizeof pose);
    pose[0] = 2;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal", swiftprox_shape_cast_ray(shape, pose, &good, &answer));
    swiftprox_shape_release(shape);
}

int main(void)
{
    answers_that_are_known();
    mistakes();
    return check_report("ray");
}
