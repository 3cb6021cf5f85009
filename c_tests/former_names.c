/*
 * Former names do what the new ones do. They are called without warnings.
 */
#define SWIFTPROX_NO_DEPRECATION_WARNINGS
#include <string.h>

#include "check.h"

typedef swiftprox_status query(swiftprox_scene *, const swiftprox_scene_query *, swiftprox_scene_answer *);

static swiftprox_scene *scene;
static swiftprox_object_id ids[3];

/* Unit cubes on a line: two that overlap, and one 1.5 from the second. */
static void make(void)
{
    static const double places[3] = {0, 0.5, 3};
    const swiftprox_shape *cube = NULL;
    swiftprox_object_options options;
    double corners[24];
    int i;
    for (i = 0; i < 24; ++i) {
        corners[i] = (i / 3) >> (i % 3) & 1 ? 0.5 : -0.5;
    }
    CHECK_OK(swiftprox_shape_create_from_points(corners, 8, NULL, &cube));
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    swiftprox_object_options_init(&options);
    for (i = 0; i < 3; ++i) {
        options.pose[3] = places[i];
        CHECK_OK(swiftprox_scene_add_shape(scene, cube, &options, &ids[i]));
    }
    swiftprox_shape_release(cube);
}

static void same(query *former, query *now, double tolerance, size_t count)
{
    swiftprox_scene_query asked;
    swiftprox_scene_answer answer;
    double lower[3];
    size_t k;
    swiftprox_scene_query_init(&asked);
    asked.distance_tolerance = tolerance;
    CHECK_OK(former(scene, &asked, &answer));
    CHECK(answer.count == count && answer.intersecting);
    for (k = 0; k < answer.count && k < 3; ++k) {
        lower[k] = answer.pairs[k].answer.lower;
    }
    CHECK_OK(now(scene, &asked, &answer));
    CHECK(answer.count == count);
    for (k = 0; k < answer.count && k < 3; ++k) {
        CHECK(memcmp(&lower[k], &answer.pairs[k].answer.lower, sizeof lower[k]) == 0);
    }
    asked.distance_tolerance = -2;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "tolerance", former(scene, &asked, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", former(NULL, NULL, &answer));
}

int main(void)
{
    swiftprox_scene_answer answer;
    make();
    same(swiftprox_scene_query_tolerance, swiftprox_scene_query_distance, 1.75, 2);
    same(swiftprox_scene_query_exact_distance, swiftprox_scene_query_distance, SWIFTPROX_DEFAULT_TOLERANCE, 3);
    same(swiftprox_scene_query_approximate_distance, swiftprox_scene_query_approximate, 1.75, 2);
    same(swiftprox_scene_query_contacts, swiftprox_scene_query_contact, SWIFTPROX_DEFAULT_TOLERANCE, 1);
    CHECK_OK(swiftprox_scene_set_pairs(scene, NULL, 0));
    CHECK_OK(swiftprox_scene_query_intersection(scene, NULL, &answer));
    CHECK(answer.count == 0);
    CHECK_OK(swiftprox_scene_find_pairs(scene));
    CHECK_OK(swiftprox_scene_query_intersection(scene, NULL, &answer));
    CHECK(answer.count == 1);
    CHECK_OK(swiftprox_scene_destroy(scene));
    return check_report("former_names");
}
