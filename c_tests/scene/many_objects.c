/*
 * Many objects at once from C: added and removed, all or none; numbers of pieces; placed bodies of several pieces.
 */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/scene.h"

enum { COUNT = 10 };

static swiftprox_scene *scene;
static const swiftprox_shape *cube;
static const swiftprox_shape *shapes[COUNT];
static swiftprox_object_options options[COUNT];
static swiftprox_object_id ids[COUNT];

/* Unit cubes in a row, 2 apart, every second one in the second group. */
static void make(void)
{
    int i;
    cube = box(0.5, 0.5, 0.5);
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (i = 0; i < COUNT; ++i) {
        options[i] = (swiftprox_object_options)SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        options[i].pose[3] = 2 * i;
        options[i].user_data = (uint64_t)i;
        options[i].groups = 1u << i % 2;
        shapes[i] = cube;
    }
}

static size_t object_count(void)
{
    size_t count = 99;
    CHECK_OK(swiftprox_scene_copy_object_ids(scene, NULL, 0, &count));
    return count;
}

static void all_or_none(void)
{
    swiftprox_object_id none[COUNT], twice[2];
    int i;
    memset(none, 1, sizeof none);
    options[7].pose[0] = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "options[7]", swiftprox_scene_add_objects(scene, shapes, options, COUNT, none));
    options[7].pose[0] = 1;
    for (i = 0; i < COUNT; ++i) {
        CHECK(none[i].bits == 0);
    }
    options[3].struct_size = 16;
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "options[3]", swiftprox_scene_add_objects(scene, shapes, options, COUNT, none));
    options[3].struct_size = sizeof options[3];
    options[0].struct_size = 17;
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "options", swiftprox_scene_add_objects(scene, shapes, options, COUNT, none));
    options[0].struct_size = sizeof options[0];
    shapes[5] = NULL;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "shapes[5]", swiftprox_scene_add_objects(scene, shapes, options, COUNT, none));
    shapes[5] = cube;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "shapes", swiftprox_scene_add_objects(scene, NULL, options, COUNT, none));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ids", swiftprox_scene_add_objects(scene, shapes, options, COUNT, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_add_objects(NULL, shapes, options, COUNT, none));
    CHECK(object_count() == 0);

    CHECK_OK(swiftprox_scene_add_objects(scene, shapes, options, COUNT, ids));
    CHECK_OK(swiftprox_scene_add_objects(scene, shapes, NULL, 2, twice));
    CHECK_OK(swiftprox_scene_add_objects(scene, NULL, NULL, 0, NULL));
    CHECK(object_count() == COUNT + 2 && ids[9].bits != 0);
    CHECK_OK(swiftprox_scene_remove_objects(scene, twice, 2));
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "ids[0]", swiftprox_scene_remove_objects(scene, twice, 2));
    twice[0] = twice[1] = ids[4];
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "ids[1]", swiftprox_scene_remove_objects(scene, twice, 2));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ids", swiftprox_scene_remove_objects(scene, NULL, 2));
    CHECK(object_count() == COUNT);
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "null", swiftprox_scene_remove_object(scene, SWIFTPROX_OBJECT_ID_NULL));
    SWIFTPROX_IGNORE(swiftprox_scene_remove_objects(scene, twice, 2));
}

static void numbers_of_pieces(void)
{
    uint64_t number = 7;
    CHECK_OK(swiftprox_scene_get_piece_user_data(scene, ids[2], 0, &number));
    CHECK(number == 0);
    CHECK_OK(swiftprox_scene_set_piece_user_data(scene, ids[2], 0, UINT64_MAX));
    CHECK_OK(swiftprox_scene_get_piece_user_data(scene, ids[2], 0, &number));
    CHECK(number == UINT64_MAX);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "piece 1", swiftprox_scene_set_piece_user_data(scene, ids[2], 1, 1));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "piece 1", swiftprox_scene_get_piece_user_data(scene, ids[2], 1, &number));
    CHECK(number == 0);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "user_data", swiftprox_scene_get_piece_user_data(scene, ids[2], 0, NULL));
}

/* Two cubes, in the places of the third and the fourth one of the scene. */
static void placed(void)
{
    const swiftprox_shape *pieces[2];
    double poses[24];
    swiftprox_scene_answer answer;
    const swiftprox_query_kind kind = SWIFTPROX_QUERY_KIND_INTERSECTION;
    pieces[0] = pieces[1] = cube;
    memcpy(poses, options[2].pose, sizeof options[2].pose);
    memcpy(poses + 12, options[3].pose, sizeof options[3].pose);
    CHECK_OK(swiftprox_scene_query_placed_pieces(scene, pieces, poses, 2, UINT32_MAX, kind, NULL, &answer));
    CHECK(answer.count == 2 && answer.pairs[0].object1.bits == ids[2].bits && answer.pairs[0].piece2 == 0);
    CHECK(answer.pairs[1].object1.bits == ids[3].bits && answer.pairs[1].piece2 == 1 && answer.pairs[1].object2.bits == 0);
    CHECK_OK(swiftprox_scene_query_placed_pieces(scene, pieces, poses, 2, 2, kind, NULL, &answer));
    CHECK(answer.count == 1 && answer.pairs[0].object1.bits == ids[3].bits);
    CHECK_OK(swiftprox_scene_query_placed_pieces(scene, pieces, poses, 2, 0, kind, NULL, &answer));
    CHECK(answer.count == 0);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "piece",
                swiftprox_scene_query_placed_pieces(scene, NULL, NULL, 0, 1, kind, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "poses",
                swiftprox_scene_query_placed_pieces(scene, pieces, NULL, 2, 1, kind, NULL, &answer));
    poses[12] = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "pose 1 of 2",
                swiftprox_scene_query_placed_pieces(scene, pieces, poses, 2, 1, kind, NULL, &answer));
    CHECK(answer.count == 0 && answer.pairs == NULL);
}

int main(void)
{
    make();
    all_or_none();
    numbers_of_pieces();
    placed();
    CHECK_OK(swiftprox_scene_remove_objects(scene, ids, COUNT));
    CHECK(object_count() == 0);
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(cube);
    return check_report("many_objects");
}
