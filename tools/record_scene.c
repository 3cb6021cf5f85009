/* Records a short scene for test_replay.py, or one for test_page.py:  record_scene FILE [ground|compound] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <swiftprox.h>
#include <swiftprox/compound.h>
#include <swiftprox/ground.h>
#include <swiftprox/replay.h>
#include <swiftprox/scene.h>

static void demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "record_scene: %s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

static void move(swiftprox_scene *scene, swiftprox_object_id id, double x)
{
    const double pose[12] = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0};
    demand(swiftprox_scene_set_pose(scene, id, pose));
}

/* Of side 1. */
static const double CUBE[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};

/* A ground of six cells, of which one is a hole, is moved to where a cube sinks into it by a quarter. */
static void record_ground(const char *path)
{
    static const double AWAY[12] = {1, 0, 0, 20, 0, 1, 0, 0, 0, 0, 1, 0};
    static const double THERE[12] = {1, 0, 0, -4.25, 0, 1, 0, -6.5, 0, 0, 1, 0.25};
    const double heights[12] = {0, 0, 0, 0, 0, 0, 0, 0, NAN, 0, 0, 0.5};
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    const swiftprox_ground *ground;
    const swiftprox_shape *cube;
    swiftprox_object_id ids[2];
    swiftprox_scene *scene;
    swiftprox_scene_answer answer;
    demand(swiftprox_ground_create_from_heights(3, 4, 4, 4, heights, &ground));
    demand(swiftprox_shape_create_from_points(CUBE, 8, NULL, &cube));
    demand(swiftprox_scene_create(NULL, &scene));
    demand(swiftprox_scene_record(scene, path));
    options.ground = ground;
    memcpy(options.pose, AWAY, sizeof options.pose);
    demand(swiftprox_scene_add_object(scene, NULL, 0, &options, &ids[0]));
    demand(swiftprox_scene_add_object(scene, &cube, 1, NULL, &ids[1]));
    query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    demand(swiftprox_scene_query_contact(scene, &query, &answer));
    demand(swiftprox_scene_set_pose(scene, ids[0], THERE));
    demand(swiftprox_scene_query_contact(scene, &query, &answer));
    demand(swiftprox_scene_record(scene, NULL));
    demand(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(cube);
    swiftprox_ground_release(ground);
}

/* Two cubes with a gap of 1, the second turned, are one object. It stands, turned too, where another cube sinks into the second by
 * a quarter; then it moves away, and then it is gone. */
static void record_compound(const char *path)
{
    static const double PIECES[24] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 3, 1, 0, 0, 0, 0, 0, 1, 0};
    static const double THERE[12] = {0, -1, 0, 10, 1, 0, 0, 0, 0, 0, 1, 0};
    static const double BESIDE[12] = {1, 0, 0, 8.25, 0, 1, 0, 2.5, 0, 0, 1, 0.25};
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    const swiftprox_compound *compound;
    const swiftprox_shape *cube;
    swiftprox_object_id ids[2];
    swiftprox_scene *scene;
    swiftprox_scene_answer answer;
    demand(swiftprox_shape_create_from_points(CUBE, 8, NULL, &cube));
    demand(swiftprox_compound_create((const swiftprox_shape *[]){cube, cube}, PIECES, 2, &compound));
    demand(swiftprox_scene_create(NULL, &scene));
    demand(swiftprox_scene_record(scene, path));
    options.compound = compound;
    memcpy(options.pose, THERE, sizeof options.pose);
    demand(swiftprox_scene_add_object(scene, NULL, 0, &options, &ids[0]));
    options = (swiftprox_object_options)SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    memcpy(options.pose, BESIDE, sizeof options.pose);
    demand(swiftprox_scene_add_object(scene, &cube, 1, &options, &ids[1]));
    query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    demand(swiftprox_scene_query_contact(scene, &query, &answer));
    move(scene, ids[0], 0);
    demand(swiftprox_scene_query_contact(scene, &query, &answer));
    demand(swiftprox_scene_remove_object(scene, ids[0]));
    demand(swiftprox_scene_query_contact(scene, &query, &answer));
    demand(swiftprox_scene_record(scene, NULL));
    demand(swiftprox_scene_destroy(scene));
    swiftprox_compound_release(compound);
    swiftprox_shape_release(cube);
}

int main(int argc, char **argv)
{
    const double there[12] = {1, 0, 0, 3.5, 0, 1, 0, 0.25, 0, 0, 1, 0};
    const swiftprox_shape *cube;
    swiftprox_object_id ids[4];
    swiftprox_scene *scene;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    if (argc < 2) {
        return EXIT_FAILURE;
    }
    if (argc > 2) {
        (strcmp(argv[2], "ground") == 0 ? record_ground : record_compound)(argv[1]);
        return EXIT_SUCCESS;
    }
    demand(swiftprox_shape_create_from_points(CUBE, 8, NULL, &cube));
    demand(swiftprox_scene_create(NULL, &scene));
    demand(swiftprox_scene_record(scene, argv[1]));
    for (int i = 0; i < 3; i++) {
        demand(swiftprox_scene_add_object(scene, &cube, 1, NULL, &ids[i]));
    }

    /* Two overlap by a quarter, the third is far from them. */
    move(scene, ids[1], 0.75);
    move(scene, ids[2], 3);
    query.detail = SWIFTPROX_CONTACT_DETAIL_DEPTH;
    demand(swiftprox_scene_query_contact(scene, &query, &answer));
    query.detail = SWIFTPROX_CONTACT_DETAIL_NONE;
    query.max_distance = 2;
    demand(swiftprox_scene_query_distance(scene, &query, &answer));

    /* A shape that is in no scene, beside the third; what is asked in vain is not played. */
    query.max_distance = -3;
    if (swiftprox_scene_query_distance(scene, &query, &answer) == SWIFTPROX_OK) {
        return EXIT_FAILURE;
    }
    demand(
        swiftprox_scene_query_placed(scene, &(swiftprox_placed){cube, there}, 1, SWIFTPROX_QUERY_KIND_CONTACT, NULL, &answer));

    /* A copy of the first, far away, and the second is gone. */
    demand(swiftprox_scene_copy_object(scene, ids[0], &ids[3]));
    move(scene, ids[3], -2);
    move(scene, ids[2], 30);
    demand(swiftprox_scene_remove_object(scene, ids[1]));
    query.max_distance = 1.5;
    demand(swiftprox_scene_query_distance(scene, &query, &answer));

    demand(swiftprox_scene_record(scene, NULL));
    demand(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(cube);
    return EXIT_SUCCESS;
}
