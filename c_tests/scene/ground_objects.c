/* Grounds as objects of a scene, from C: what finds them, and what is refused. */
#include "check.h"

#include "swiftprox/ground.h"
#include "swiftprox/scene.h"
#include "swiftprox/sets.h"

#include <math.h>

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
static const swiftprox_placed_ground own = {NULL, NULL};

/* A level ground of 32 triangles, and a cube that is 0.125 in it. */
struct level_scene {
    const swiftprox_ground *ground;
    const swiftprox_shape *cube;
    swiftprox_scene *scene;
    swiftprox_scratch *scratch;
    swiftprox_object_id floor, body;
};

static struct level_scene begin(void)
{
    const double half[3] = {0.5, 0.5, 0.5}, down[12] = {1, 0, 0, 2.25, 0, 1, 0, 2.5, 0, 0, 1, 0.375};
    double heights[25] = {0};
    struct level_scene begun = {0};
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    CHECK_OK(swiftprox_ground_create_from_heights(5, 5, 1, 1, heights, &begun.ground));
    CHECK_OK(swiftprox_shape_create_box(half, 0, &begun.cube));
    CHECK_OK(swiftprox_scene_create(NULL, &begun.scene));
    CHECK_OK(swiftprox_scratch_create(&begun.scratch));
    options.ground = begun.ground;
    options.user_data = 7;
    CHECK_OK(swiftprox_scene_add_object(begun.scene, NULL, 0, &options, &begun.floor));
    options.ground = NULL;
    options.user_data = 8;
    memcpy(options.pose, down, sizeof down);
    CHECK_OK(swiftprox_scene_add_object(begun.scene, &begun.cube, 1, &options, &begun.body));
    return begun;
}

static void end(const struct level_scene *ended)
{
    swiftprox_scratch_destroy(ended->scratch);
    CHECK_OK(swiftprox_scene_destroy(ended->scene));
    swiftprox_shape_release(ended->cube);
    swiftprox_ground_release(ended->ground);
}

static int is_face(swiftprox_feature feature)
{
    return feature.kind == SWIFTPROX_FEATURE_KIND_FACE && feature.ids[0] < 32;
}

static void a_cube_and_a_ground(void)
{
    const struct level_scene level = begin();
    const double up[12] = {1, 0, 0, 2.25, 0, 1, 0, 2.5, 0, 0, 1, 1.5};
    const swiftprox_ray ray = {{0.25, 0.5, 3}, {0, 0, -1}, 10};
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_object_set set = {0};
    swiftprox_scene_answer answer;
    swiftprox_scene_ray_answer hits;
    swiftprox_least_distance least;
    swiftprox_scene_ground_answer contacts;
    swiftprox_object_info info = {0};
    CHECK_OK(swiftprox_scene_query_intersection(level.scene, NULL, &answer));
    CHECK(answer.count == 1 && answer.pairs[0].object1.bits == level.floor.bits && answer.pairs[0].object2.bits == level.body.bits);
    CHECK(answer.pairs[0].piece1 == 0 && answer.pairs[0].user_data1 == 7 && is_face(answer.pairs[0].answer.feature1));
    CHECK_OK(swiftprox_scene_ground_contacts(level.scene, NULL, own, NULL, level.scratch, &contacts));
    CHECK(contacts.contact_count == 1 && contacts.contacts[0].ground.bits == level.floor.bits);
    CHECK(contacts.contacts[0].object.bits == level.body.bits && contacts.contacts[0].user_data == 8);
    CHECK(contacts.points[0].gap_lower <= -0.125 && -0.125 <= contacts.points[0].gap_upper);
    CHECK_OK(swiftprox_scene_cast_ray(level.scene, &ray, SWIFTPROX_RAY_HITS_ALL, UINT32_MAX, level.scratch, &hits));
    CHECK(hits.count == 1 && hits.hits[0].object.bits == level.floor.bits && is_face(hits.hits[0].answer.feature));

    CHECK_OK(swiftprox_scene_set_pose(level.scene, level.body, up));
    query.max_distance = 2;
    CHECK_OK(swiftprox_scene_query_distance(level.scene, &query, &answer));
    CHECK(answer.count == 1 && answer.pairs[0].answer.lower <= 1 && 1 <= answer.pairs[0].answer.upper);
    CHECK(answer.pairs[0].answer.normal[2] == -1); /* from object 2, the cube, to the ground */
    set.ids = &level.body;
    set.count = 1;
    CHECK_OK(swiftprox_scene_least_distance(level.scene, &set, NULL, INFINITY, NULL, &least));
    CHECK(least.lower <= 1 && 1 <= least.upper && least.nearest.object2.bits == level.floor.bits);

    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_scene_get_object_info(level.scene, level.floor, &info));
    CHECK(info.ground == level.ground && info.piece_count == 0 && info.fixed == 1 && info.user_data == 7);
    info.pose[11] = 1;
    CHECK_OK(swiftprox_scene_set_object_info(level.scene, level.floor, &info));
    CHECK_OK(swiftprox_scene_query_intersection(level.scene, NULL, &answer));
    CHECK(answer.count == 1 && answer.intersecting);
    CHECK_OK(swiftprox_scene_remove_object(level.scene, level.floor));
    CHECK_OK(swiftprox_scene_query_intersection(level.scene, NULL, &answer));
    CHECK(answer.count == 0);
    end(&level);
}

static void what_a_program_may_do_wrong(void)
{
    const struct level_scene level = begin();
    const swiftprox_shape *shape = NULL;
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_scene_ground_config config = SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT;
    swiftprox_scene_ground_answer contacts;
    swiftprox_object_info info = {0};
    swiftprox_object_id id = level.floor;
    uint64_t user_data;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "piece", swiftprox_scene_add_object(level.scene, NULL, 0, &options, &id));
    CHECK(id.bits == 0);
    options.ground = level.ground;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "ground", swiftprox_scene_add_object(level.scene, &level.cube, 1, &options, &id));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "one by one",
                swiftprox_scene_add_objects(level.scene, &level.cube, &options, 1, &id));
    options.pose[0] = 2;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "", swiftprox_scene_add_object(level.scene, NULL, 0, &options, &id));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "no pieces", swiftprox_scene_get_piece(level.scene, level.floor, 0, &shape));
    CHECK(shape == NULL);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "no pieces",
                swiftprox_scene_set_piece_pose(level.scene, level.floor, 0, identity));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "no pieces",
                swiftprox_scene_get_piece_user_data(level.scene, level.floor, 0, &user_data));
    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_scene_get_object_info(level.scene, level.floor, &info));
    info.fixed = 0;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "grounds are fixed",
                swiftprox_scene_set_object_info(level.scene, level.floor, &info));
    CHECK_OK(swiftprox_scene_get_object_info(level.scene, level.floor, &info));
    info.ground = NULL;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "info->ground",
                swiftprox_scene_set_object_info(level.scene, level.floor, &info));
    config.mask = 1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "mask",
                swiftprox_scene_ground_contacts(level.scene, NULL, own, &config, level.scratch, &contacts));
    CHECK(contacts.contact_count == 0 && contacts.contacts == NULL);
    end(&level);
}

int main(void)
{
    a_cube_and_a_ground();
    what_a_program_may_do_wrong();
    return check_report("ground objects");
}
