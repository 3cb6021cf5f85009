/*
 * A program compiled with former headers and linked to today's library. Its structs that begin with struct_size are as large as
 * they were: nothing behind their end is written, and what they lack is the default. Those of fixed size hold what they held.
 */

#include "swiftprox_tuning.h"

#include "../check.h"

#include <math.h>

/* Behind a struct; whoever writes a larger one changes it. */
typedef struct guard {
    unsigned char bytes[256];
} guard;

enum { UNTOUCHED = 0xa5 };

#define GUARDED(type) struct { type value; guard behind; }
#define GUARD(guarded) memset(&(guarded).behind, UNTOUCHED, sizeof (guarded).behind)
#define CHECK_GUARD(guarded) CHECK(is_untouched(&(guarded).behind))

static int is_untouched(const guard *behind)
{
    size_t i;
    for (i = 0; i < sizeof behind->bytes; ++i) {
        if (behind->bytes[i] != UNTOUCHED) {
            return 0;
        }
    }
    return 1;
}

/* A cube of side 2 about the origin, faces counter-clockwise seen from outside. */
static const double corners[] = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
static const uint32_t faces[] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
static const uint32_t valences[] = {4, 4, 4, 4, 4, 4};

static const double here[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
static const double apart[12] = {1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0};
static const double inside[12] = {1, 0, 0, 1.75, 0, 1, 0, 0, 0, 0, 1, 0};

static const swiftprox_shape *cube(void)
{
    GUARDED(swiftprox_shape_options) options;
    GUARDED(swiftprox_shape_tuning) tuning;
    GUARDED(swiftprox_shape_info) info;
    const swiftprox_shape *shape;
    GUARD(options);
    GUARD(tuning);
    GUARD(info);
    swiftprox_shape_options_init(&options.value);
    swiftprox_shape_tuning_init(&tuning.value);
    CHECK(options.value.struct_size == sizeof options.value);
    options.value.tuning = &tuning.value;
    CHECK_OK(swiftprox_shape_create_from_mesh(corners, 8, faces, valences, 6, &options.value, &shape));
    info.value.struct_size = sizeof info.value;
    CHECK_OK(swiftprox_shape_get_info(shape, &info.value));
    CHECK(info.value.vertex_count == 8 && info.value.face_count == 6);
    CHECK(fabs(info.value.volume - 8) < 1e-12);
    CHECK_GUARD(options);
    CHECK_GUARD(tuning);
    CHECK_GUARD(info);
    return shape;
}

static void pairs(const swiftprox_shape *shape)
{
    GUARDED(swiftprox_pair_config) config;
    GUARDED(swiftprox_pair_cache) cache = {{{0}}, {{0}}};
    GUARDED(swiftprox_pair_answer) answer;
    GUARDED(swiftprox_depth_config) depth_config;
    GUARDED(swiftprox_depth_cache) depth_cache = {{{0}}, {{0}}};
    GUARDED(swiftprox_depth_answer) depth;
    GUARDED(swiftprox_manifold_config) manifold_config;
    swiftprox_manifold_cache manifold_cache = {{0}};
    GUARDED(swiftprox_manifold) manifold;
    struct { swiftprox_manifold_point value[4]; guard behind; } points;
    GUARD(config);
    GUARD(cache);
    GUARD(answer);
    GUARD(depth_config);
    GUARD(depth_cache);
    GUARD(depth);
    GUARD(manifold_config);
    GUARD(manifold);
    GUARD(points);

    swiftprox_pair_config_init(&config.value);
    CHECK_OK(swiftprox_pair_distance(shape, here, shape, apart, &cache.value, &config.value, &answer.value));
    CHECK(answer.value.outcome == SWIFTPROX_OUTCOME_SEPARATED);
    CHECK(answer.value.lower <= 1 && 1 <= answer.value.upper && fabs(answer.value.distance - 1) < 1e-12);
    CHECK(answer.value.world1[0] == 1 && answer.value.world2[0] == 2 && fabs(fabs(answer.value.normal[0]) - 1) < 1e-12);
    CHECK_OK(swiftprox_pair_verify(shape, here, shape, apart, &answer.value));

    swiftprox_depth_config_init(&depth_config.value);
    CHECK_OK(swiftprox_pair_depth(shape, here, shape, inside, &depth_cache.value, &depth_config.value, &depth.value));
    CHECK(depth.value.outcome == SWIFTPROX_OUTCOME_INTERSECTING);
    CHECK(depth.value.lower <= 0.25 && 0.25 <= depth.value.upper && fabs(depth.value.depth - 0.25) < 1e-6);
    CHECK_OK(swiftprox_pair_depth_verify(shape, here, shape, inside, &depth_cache.value, &depth.value));

    swiftprox_manifold_config_init(&manifold_config.value);
    CHECK_OK(swiftprox_pair_manifold(shape, here, shape, inside, &manifold_cache, &manifold_config.value, points.value, 4,
                                     &manifold.value));
    CHECK(manifold.value.point_count == 4 && fabs(fabs(manifold.value.normal[0]) - 1) < 1e-12);
    CHECK(points.value[3].gap_lower <= -0.25 && -0.25 <= points.value[3].gap_upper);

    CHECK_GUARD(config);
    CHECK_GUARD(cache);
    CHECK_GUARD(answer);
    CHECK_GUARD(depth_config);
    CHECK_GUARD(depth_cache);
    CHECK_GUARD(depth);
    CHECK_GUARD(manifold_config);
    CHECK_GUARD(manifold);
    CHECK_GUARD(points);
}

static void scenes(const swiftprox_shape *shape)
{
    GUARDED(swiftprox_scene_options) options;
    GUARDED(swiftprox_object_options) object_options;
    GUARDED(swiftprox_scene_query) query;
    GUARDED(swiftprox_scene_answer) answer;
    GUARDED(swiftprox_scene_contacts) contacts;
    GUARDED(swiftprox_scene_statistics) statistics;
    GUARDED(swiftprox_object_info) info;
    swiftprox_scene *scene;
    swiftprox_object_id first, second;
    GUARD(options);
    GUARD(object_options);
    GUARD(query);
    GUARD(answer);
    GUARD(contacts);
    GUARD(statistics);
    GUARD(info);

    swiftprox_scene_options_init(&options.value);
    CHECK_OK(swiftprox_scene_create(&options.value, &scene));
    swiftprox_object_options_init(&object_options.value);
    object_options.value.user_data = 41;
    CHECK_OK(swiftprox_scene_add_shape(scene, shape, &object_options.value, &first));
    CHECK_OK(swiftprox_scene_add_shape(scene, shape, NULL, &second));
    CHECK_OK(swiftprox_scene_set_pose(scene, second, inside));
    info.value.struct_size = sizeof info.value;
    CHECK_OK(swiftprox_scene_get_object_info(scene, first, &info.value));
    CHECK(info.value.user_data == 41 && info.value.piece_count == 1);

    swiftprox_scene_query_init(&query.value);
    query.value.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    CHECK_OK(swiftprox_scene_query_contacts(scene, &query.value, &answer.value));
    CHECK(answer.value.count == 1 && answer.value.intersecting);
    if (answer.value.count == 1) {
        CHECK(answer.value.pairs[0].user_data1 == 41 && answer.value.pairs[0].object2.bits == second.bits);
        CHECK(answer.value.pairs[0].answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING);
    }
    CHECK_OK(swiftprox_scene_get_contacts(scene, &contacts.value));
    CHECK(contacts.value.count == 1 && contacts.value.point_count >= 4);
    if (contacts.value.count == 1) {
        CHECK(fabs(contacts.value.contacts[0].depth.depth - 0.25) < 1e-6);
    }
    CHECK_OK(swiftprox_scene_get_statistics(scene, &statistics.value));
    CHECK(statistics.value.queries == 1);
    CHECK_OK(swiftprox_scene_destroy(scene));

    CHECK_GUARD(options);
    CHECK_GUARD(object_options);
    CHECK_GUARD(query);
    CHECK_GUARD(answer);
    CHECK_GUARD(contacts);
    CHECK_GUARD(statistics);
    CHECK_GUARD(info);
}

int main(void)
{
    const swiftprox_shape *shape;
    CHECK_OK(swiftprox_library_check_version(SWIFTPROX_VERSION_MAJOR, SWIFTPROX_VERSION_MINOR, SWIFTPROX_VERSION_PATCH));
    shape = cube();
    pairs(shape);
    scenes(shape);
    swiftprox_shape_release(shape);
    return check_report("former_client");
}
