/*
 * Rays from C: answers that are known, and what a program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/geometry.h"
#include "swiftprox/sets.h"

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

/* A ball of radius 1/2 is met at its side, and by a scene beside a cube, whichever was added first. */
static void round_bodies(void)
{
    const double centre[3] = {0, 0, 0};
    const swiftprox_shape *shapes[2] = {box(1, 1, 1), NULL};
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_ray ray = {{-5, 0.3, 0}, {1, 0, 0}, HUGE_VAL};
    swiftprox_ray_answer answer;
    int i, k, hits;
    options.input = SWIFTPROX_INPUT_HULL;
    options.swept_radius = 0.5;
    CHECK_OK(swiftprox_shape_create_from_points(centre, 1, &options, &shapes[1]));
    CHECK_OK(swiftprox_shape_cast_ray(shapes[1], identity, &ray, &answer));
    CHECK(answer.outcome == SWIFTPROX_RAY_OUTCOME_HIT && answer.feature.kind == SWIFTPROX_FEATURE_KIND_VERTEX);
    CHECK(fabs(answer.entry[0] - 4.6) < 1e-12 && answer.entry[1] - answer.entry[0] < 1e-12);
    CHECK(fabs(answer.exit[0] - 5.4) < 1e-12 && fabs(answer.normal[0] + 0.8) < 1e-12 && fabs(answer.normal[1] - 0.6) < 1e-12);
    for (i = 0; i < 2; ++i) {
        swiftprox_scene *scene;
        swiftprox_scratch *scratch;
        swiftprox_scene_ray_answer met;
        CHECK_OK(swiftprox_scene_create(NULL, &scene));
        CHECK_OK(swiftprox_scratch_create(&scratch));
        for (k = 0; k < 2; ++k) {
            swiftprox_object_options placed = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
            swiftprox_object_id id;
            placed.pose[7] = (k ^ i) == 1 ? 100 : 0;
            CHECK_OK(swiftprox_scene_add_object(scene, &shapes[k ^ i], 1, &placed, &id));
        }
        for (hits = 0; hits < 3; ++hits) {
            CHECK_OK(swiftprox_scene_cast_ray(scene, &ray, (swiftprox_ray_hits)hits, UINT32_MAX, scratch, &met));
            CHECK(met.count == 1 && met.hits[0].row == (uint32_t)i && met.hits[0].answer.entry[0] <= 4);
        }
        swiftprox_scratch_destroy(scratch);
        CHECK_OK(swiftprox_scene_destroy(scene));
    }
    swiftprox_shape_release(shapes[0]);
    swiftprox_shape_release(shapes[1]);
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
    round_bodies();
    mistakes();
    return check_report("ray");
}
