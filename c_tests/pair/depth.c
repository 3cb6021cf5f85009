/*
 * Depths and manifolds from C: known ones, their check, what a program may do wrong, and the same bits in every rounding.
 */
#include <fenv.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/process.h"
#include "swiftprox/scene.h"
#include "swiftprox/verify.h"

/* One box sinks into another from above, touches it, and is lifted off. */
static void known_depths(const swiftprox_shape *a, const swiftprox_shape *b)
{
    double here[12], there[12];
    int step;
    swiftprox_depth_cache cache = {{0}};
    place(there, 0, 0, 0);
    for (step = -4; step <= 4; ++step) {
        swiftprox_depth_answer answer;
        const double depth = step < 0 ? -0.0625 * step : 0;
        place(here, 0.125, 0.25, 1 + 0.0625 * step);
        CHECK_OK(swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, NULL, &answer));
        CHECK_OK(swiftprox_pair_depth_verify((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &answer));
        CHECK(answer.outcome == (step > 0 ? SWIFTPROX_OUTCOME_SEPARATED : SWIFTPROX_OUTCOME_INTERSECTING));
        CHECK(answer.lower <= depth && depth <= answer.upper && answer.upper - answer.lower <= 1e-13);
        CHECK((answer.upper == 0) == (step >= 0));
        CHECK(fabs(answer.normal[2] - 1) < 1e-14);
        if (step <= 0) {
            CHECK(fabs(answer.world2[2] - answer.world1[2] - depth) < 1e-14);
            CHECK(answer.feature1.kind != SWIFTPROX_FEATURE_KIND_NONE && answer.feature2.kind != SWIFTPROX_FEATURE_KIND_NONE);
        } else {
            CHECK(isnan(answer.world1[0]) && answer.feature1.kind == SWIFTPROX_FEATURE_KIND_NONE);
        }
        if (step < 0) {
            answer.upper = 0.5 * answer.lower;
            answer.lower = answer.depth = answer.upper;
            CHECK_FAILS(
                SWIFTPROX_ERROR_UNVERIFIED, "overlap",
                swiftprox_pair_depth_verify((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &answer));
        }
    }
}

static void manifolds(const swiftprox_shape *a, const swiftprox_shape *b)
{
    double here[12], there[12];
    int i, j;
    swiftprox_manifold_cache cache = {{0}};
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    swiftprox_manifold_point points[8];
    swiftprox_manifold manifold;
    swiftprox_signed_distance distance;
    config.max_distance = 0.01;
    place(there, 0, 0, 0);
    place(here, 0.125, 0.25, 0.995);
    CHECK_OK(swiftprox_pair_manifold((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &config,
                                     (swiftprox_manifold_room){points, 8, NULL}, &manifold));
    CHECK(manifold.outcome == SWIFTPROX_OUTCOME_INTERSECTING && manifold.point_count == 4 && manifold.found_count == 4);
    CHECK_OK(swiftprox_pair_manifold_verify((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &config, points,
                                            &manifold));
    manifold.lower = manifold.upper = -0.004;
    CHECK_FAILS(SWIFTPROX_ERROR_UNVERIFIED, "overlap",
                swiftprox_pair_manifold_verify((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &config,
                                               points, &manifold));
    CHECK_OK(swiftprox_pair_manifold((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &config,
                                     (swiftprox_manifold_room){points, 8, &distance}, &manifold));
    CHECK(distance.outcome == SWIFTPROX_OUTCOME_INTERSECTING && fabs(distance.distance + 0.005) < 1e-12);
    CHECK(distance.lower == manifold.lower && distance.upper == manifold.upper && manifold.point_count == 4);
    CHECK(fabs(distance.world2[2] - distance.world1[2] - 0.005) < 1e-12);
    points[2].gap_lower = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_UNVERIFIED, "point 2",
                swiftprox_pair_manifold_verify((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &config,
                                               points, &manifold));
    CHECK_OK(swiftprox_pair_manifold((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &config,
                                     (swiftprox_manifold_room){points, 8, NULL}, &manifold));
    for (i = 0; i < 4; ++i) {
        CHECK(points[i].gap_lower <= -0.005 + 1e-12 && points[i].gap_upper >= -0.005 - 1e-12);
        CHECK(fabs((points[i].gap_lower + points[i].gap_upper) / 2 + 0.005) < 1e-12);
        for (j = 0; j < i; ++j) {
            CHECK(points[i].id != points[j].id);
        }
    }
    place(here, 0.125, 0.25, 1.005);
    CHECK_OK(swiftprox_pair_manifold((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &config,
                                     (swiftprox_manifold_room){points, 2, NULL}, &manifold));
    CHECK(manifold.outcome == SWIFTPROX_OUTCOME_SEPARATED && manifold.point_count == 2 && manifold.found_count == 4);
    place(here, 0.125, 0.25, 1.02);
    CHECK_OK(swiftprox_pair_manifold((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &config,
                                     (swiftprox_manifold_room){NULL, 0, NULL}, &manifold));
    CHECK(manifold.outcome == SWIFTPROX_OUTCOME_BEYOND && manifold.point_count == 0);
}

static void mistakes(const swiftprox_shape *a)
{
    double here[12], bent[12];
    swiftprox_depth_cache cache = {{0}};
    swiftprox_manifold_cache manifold_cache = {{0}};
    swiftprox_depth_config config = SWIFTPROX_DEPTH_CONFIG_DEFAULT;
    swiftprox_manifold_config manifold_config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    swiftprox_depth_answer answer;
    swiftprox_manifold manifold;
    swiftprox_manifold_point point;
    const int32_t unknown = 77;
    place(here, 0, 0, 0);
    place(bent, 0, 0, NAN);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object1.shape",
                swiftprox_pair_depth((swiftprox_placed){NULL, here}, (swiftprox_placed){a, here}, &cache, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object2.pose",
                swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){a, NULL}, &cache, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "cache",
                swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, NULL, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer",
                swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &cache, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "finite",
                swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){a, bent}, &cache, NULL, &answer));
    CHECK(answer.outcome == SWIFTPROX_OUTCOME_NONE && isnan(answer.depth));
    config.step_budget = 0;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "step_budget",
                swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &cache, &config, &answer));
    config.step_budget = 1;
    config.absolute_error = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "absolute_error",
                swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &cache, &config, &answer));
    config.struct_size = 3;
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "swiftprox_depth_config",
                swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &cache, &config, &answer));
    CHECK_OK(swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &cache, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "cache",
                swiftprox_pair_depth_verify((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, NULL, &answer));
    memcpy(&answer.ending, &unknown, sizeof unknown);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "ending",
                swiftprox_pair_depth_verify((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &cache, &answer));
    manifold_config.max_distance = -1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
                swiftprox_pair_manifold((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &manifold_cache,
                                        &manifold_config, (swiftprox_manifold_room){NULL, 0, NULL}, &manifold));
    CHECK(manifold.outcome == SWIFTPROX_OUTCOME_NONE && isnan(manifold.lower));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "points",
                swiftprox_pair_manifold((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &manifold_cache, NULL,
                                        (swiftprox_manifold_room){NULL, 4, NULL}, &manifold));
    CHECK_OK(swiftprox_pair_manifold((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &manifold_cache, NULL,
                                     (swiftprox_manifold_room){&point, 1, NULL}, &manifold));
    CHECK_OK(swiftprox_pair_manifold_verify((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &manifold_cache, NULL,
                                            &point, &manifold));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "points",
                swiftprox_pair_manifold_verify((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &manifold_cache, NULL,
                                               NULL, &manifold));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "cache",
                swiftprox_pair_manifold_verify((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, NULL, NULL, &point,
                                               &manifold));
    memcpy(&point.feature2.kind, &unknown, sizeof unknown);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "points[0].feature2.kind",
                swiftprox_pair_manifold_verify((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &manifold_cache, NULL,
                                               &point, &manifold));
    memcpy(&manifold.outcome, &unknown, sizeof unknown);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "outcome",
                swiftprox_pair_manifold_verify((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &manifold_cache, NULL,
                                               &point, &manifold));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "manifold",
                swiftprox_pair_manifold((swiftprox_placed){a, here}, (swiftprox_placed){a, here}, &manifold_cache, NULL,
                                        (swiftprox_manifold_room){NULL, 0, NULL}, NULL));
    CHECK(strcmp(swiftprox_library_depth_ending_string(SWIFTPROX_DEPTH_ENDING_NARROW), "narrow") == 0);
    CHECK(swiftprox_library_depth_ending_string((swiftprox_depth_ending)unknown) != NULL);
}

/* Any bytes are a cache, and in every rounding the answer has the same bits. */
static void caches_and_roundings(const swiftprox_shape *a, const swiftprox_shape *b)
{
    static const int roundings[] = {FE_TONEAREST, FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO};
    double here[12], there[12];
    swiftprox_depth_answer first;
    swiftprox_depth_answer answer;
    size_t i;
    unsigned k;
    place(here, 0.1, 0.2, 0.3);
    place(there, 0, 0, 0);
    for (i = 0; i < sizeof roundings / sizeof roundings[0]; ++i) {
        swiftprox_depth_cache cache = {{0}};
        memset(&answer, 0, sizeof answer);
        fesetround(roundings[i]);
        CHECK_OK(swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, NULL, &answer));
        CHECK_OK(swiftprox_pair_depth_verify((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, &answer));
        CHECK(fegetround() == roundings[i]);
        fesetround(FE_TONEAREST);
        if (i == 0) {
            first = answer;
        }
        CHECK(memcmp(&first.depth, &answer.depth, sizeof(double) * 18) == 0);
    }
    for (k = 0; k < 256; ++k) {
        swiftprox_depth_cache cache;
        memset(&cache, (int)k, sizeof cache);
        CHECK_OK(swiftprox_pair_depth((swiftprox_placed){a, here}, (swiftprox_placed){b, there}, &cache, NULL, &answer));
        CHECK(answer.lower <= first.upper && first.lower <= answer.upper);
    }
}

static swiftprox_object_id put(swiftprox_scene *scene, const swiftprox_shape *shape, double x, double z)
{
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_id id = {0};
    place(options.pose, x, 0, z);
    CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, &options, &id));
    return id;
}

/* A box stands in another one, another beside it a little above, a third far away: depths and manifolds of the pairs, and how long
 * they are there. */
static void scenes(const swiftprox_shape *a, const swiftprox_shape *b)
{
    swiftprox_scene *scene = NULL;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    swiftprox_signed_distance apart;
    swiftprox_depth_cache cold = {{0}};
    swiftprox_object_info info1, info2;
    const int32_t unknown = 77;
    size_t i;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    const swiftprox_object_id ground = put(scene, b, 0, 0);
    const swiftprox_object_id sunk = put(scene, a, -1.125, 0.9375);
    put(scene, a, 1, 1.0078125);
    put(scene, a, 50, 0);
    CHECK(query.detail == SWIFTPROX_CONTACT_DETAIL_NONE);

    /* Nothing was asked, nothing is said. */
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "ask for contacts with their depths",
                swiftprox_scene_get_signed_distance(scene, 0, &apart));
    CHECK_OK(swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK(answer.count == 1 && answer.contact_count == 0 && answer.contacts == NULL && answer.points == NULL && answer.point_count == 0);

    query.detail = SWIFTPROX_CONTACT_DETAIL_DEPTH;
    CHECK_OK(swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK(answer.count == 1 && answer.contact_count == 1 && answer.point_count == 0);
    CHECK(answer.pairs[0].object1.bits == ground.bits && answer.pairs[0].object2.bits == sunk.bits);
    const swiftprox_depth_answer depth = answer.contacts[0].depth;
    CHECK(depth.lower <= 0.0625 && 0.0625 <= depth.upper && depth.upper - depth.lower < 1e-13);
    CHECK(fabs(depth.normal[2] + 1) < 1e-14);
    info1.struct_size = sizeof info1;
    info2.struct_size = sizeof info2;
    CHECK_OK(swiftprox_scene_get_object_info(scene, ground, &info1));
    CHECK_OK(swiftprox_scene_get_object_info(scene, sunk, &info2));
    CHECK_OK(swiftprox_pair_depth_verify((swiftprox_placed){b, info1.pose}, (swiftprox_placed){a, info2.pose}, &cold, &depth));

    /* The manifold of the near pair, too. */
    query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    query.max_distance = 0.01;
    CHECK_OK(swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK(answer.count == 2 && answer.contact_count == 2 && answer.point_count == 8);
    for (i = 0; i < answer.contact_count; ++i) {
        const swiftprox_contact *const contact = &answer.contacts[i];
        const double gap = i == 0 ? -0.0625 : 0.0078125;
        uint32_t k;
        CHECK(contact->manifold.outcome == answer.pairs[i].answer.outcome && contact->manifold.point_count == 4);
        CHECK((isnan(contact->depth.depth) != 0) == (i == 1));
        CHECK_OK(swiftprox_scene_get_signed_distance(scene, i, &apart));
        CHECK(apart.outcome == answer.pairs[i].answer.outcome && apart.lower <= gap && gap <= apart.upper);
        CHECK(apart.upper - apart.lower < 1e-13 && fabs(apart.normal[2] + 1) < 1e-14);
        CHECK(fabs(apart.world1[2] - apart.world2[2] + gap) < 1e-13);
        for (k = 0; k < contact->manifold.point_count; ++k) {
            const swiftprox_manifold_point *const point = &answer.points[contact->first_point + k];
            CHECK(fabs(point->gap_lower - gap) < 1e-12 && fabs(point->gap_upper - gap) < 1e-12);
        }
    }
    query.detail = SWIFTPROX_CONTACT_DETAIL_REDUCED_MANIFOLD;
    CHECK_OK(swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK(answer.contact_count == 2 && answer.point_count == 8);

    /* Details that a query does not give are refused. */
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "ask swiftprox_scene_query_contact",
                swiftprox_scene_query_distance(scene, &query, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "ask swiftprox_scene_query_contact",
                swiftprox_scene_query_object(scene, ground, SWIFTPROX_QUERY_KIND_INTERSECTION, &query, &answer));
    CHECK_OK(swiftprox_scene_query_object(scene, ground, SWIFTPROX_QUERY_KIND_CONTACT, &query, &answer));
    CHECK_OK(swiftprox_scene_query_contact(scene, &query, &answer));

    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "there is no contact 2, the last query said 2",
                swiftprox_scene_get_signed_distance(scene, 2, &apart));
    CHECK(isnan(apart.distance) && isnan(apart.lower) && isnan(apart.normal[2]));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_scene_get_signed_distance(scene, 0, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_get_signed_distance(NULL, 0, &apart));

    /* While objects move and go they stay, until the next query. */
    const swiftprox_contact first = answer.contacts[0];
    CHECK_OK(swiftprox_scene_remove_object(scene, sunk));
    CHECK(answer.contacts[0].depth.depth == first.depth.depth && answer.points[3].id != 0);

    query.max_distance = -2;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance", swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK(answer.contact_count == 0 && answer.contacts == NULL);
    query.max_distance = 0;
    memcpy(&query.detail, &unknown, sizeof unknown);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "detail", swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK_OK(swiftprox_scene_destroy(scene));
}

int main(void)
{
    const swiftprox_shape *a = box(1, 1, 0.5);
    const swiftprox_shape *b = box(2, 2, 0.5);
    known_depths(a, b);
    manifolds(a, b);
    mistakes(a);
    caches_and_roundings(a, b);
    scenes(a, b);
    swiftprox_shape_release(a);
    swiftprox_shape_release(b);
    return check_report("depth");
}
