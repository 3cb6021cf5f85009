/*
 * Grounds from C: answers that are known, and what a program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/ground.h"
#include "swiftprox/sets.h"

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/* A cube 0.25 over a level grid, and 0.125 in it: it stands on four corners. */
static void a_cube_on_a_level_grid(void)
{
    double heights[25] = {0};
    const double over[12] = {1, 0, 0, 2.1, 0, 1, 0, 1.9, 0, 0, 1, 0.75}, in[12] = {1, 0, 0, 2.1, 0, 1, 0, 1.9, 0, 0, 1, 0.375};
    const swiftprox_shape *body = box(0.5, 0.5, 0.5);
    const swiftprox_ground *ground = NULL;
    swiftprox_ground_info info;
    swiftprox_ground_distance answer;
    swiftprox_ground_contact contacts[4];
    swiftprox_ground_count count;
    swiftprox_manifold_point points[16];
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    CHECK_OK(swiftprox_ground_create_from_heights(5, 5, 1, 1, heights, &ground));
    CHECK_OK(swiftprox_ground_get_info(ground, &info));
    CHECK(info.vertex_count == 25 && info.triangle_count == 32 && info.bytes < 8192 + 12 * 32);
    CHECK(swiftprox_ground_retain(ground) == ground);
    swiftprox_ground_release(ground);
    CHECK_OK(swiftprox_pair_ground_distance(SWIFTPROX_QUERY_KIND_DISTANCE, (swiftprox_placed){body, over},
                                            (swiftprox_placed_ground){ground, identity}, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.triangle < 32);
    CHECK(answer.answer.lower <= 0.25 && 0.25 <= answer.answer.upper && answer.answer.normal[2] == 1);
    CHECK_OK(swiftprox_pair_ground_distance(SWIFTPROX_QUERY_KIND_INTERSECTION, (swiftprox_placed){body, in},
                                            (swiftprox_placed_ground){ground, identity}, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING);
    config.reduces = 1;
    CHECK_OK(swiftprox_pair_ground_contacts((swiftprox_placed){body, in}, (swiftprox_placed_ground){ground, identity}, &config,
                                            (swiftprox_ground_room){contacts, 4, points, 16}, &count));
    CHECK(count.contact_count == 1 && count.point_count == 4 && contacts[0].manifold.point_count == 4);
    CHECK(contacts[0].manifold.normal[2] == 1 && contacts[0].first_point == 0);
    CHECK(points[3].gap_lower <= -0.125 && -0.125 <= points[3].gap_upper);
    CHECK_OK(swiftprox_pair_ground_contacts((swiftprox_placed){body, in}, (swiftprox_placed_ground){ground, identity}, &config,
                                            (swiftprox_ground_room){NULL, 0, NULL, 0}, &count));
    CHECK(count.contact_count == 1 && count.point_count == 4);
    CHECK_OK(swiftprox_pair_ground_contacts((swiftprox_placed){body, over}, (swiftprox_placed_ground){ground, identity}, NULL,
                                            (swiftprox_ground_room){contacts, 4, points, 16}, &count));
    CHECK(count.contact_count == 0 && count.point_count == 0);
    swiftprox_ground_release(ground);
    swiftprox_shape_release(body);
}

/* From above and from below, past the rim, and what is refused. */
static void rays(void)
{
    double heights[25] = {0};
    const swiftprox_ground *ground = NULL;
    const swiftprox_placed_ground placed = {NULL, identity};
    swiftprox_ray ray = {{2.1, 1.9, 4}, {0, 0, -2}, INFINITY};
    swiftprox_ground_ray_answer answer;
    CHECK_OK(swiftprox_ground_create_from_heights(5, 5, 1, 1, heights, &ground));
    const swiftprox_placed_ground here = {ground, identity};
    CHECK_OK(swiftprox_ground_cast_ray(here, &ray, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_RAY_OUTCOME_HIT && answer.triangle < 32 && answer.answer.normal[2] == 1);
    CHECK(answer.answer.entry[0] <= 2 && 2 <= answer.answer.entry[1]);
    ray.t_max = 1.5;
    CHECK_OK(swiftprox_ground_cast_ray(here, &ray, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_RAY_OUTCOME_MISS && answer.triangle == 32);
    ray.direction[2] = 0;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "direction", swiftprox_ground_cast_ray(here, &ray, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_RAY_OUTCOME_NONE);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ground", swiftprox_ground_cast_ray(placed, &ray, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ray", swiftprox_ground_cast_ray(here, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_ground_cast_ray(here, &ray, NULL));
    swiftprox_ground_release(ground);
}

/* A cube that falls on it, one that flies past, and what is refused. */
static void casts(void)
{
    double heights[25] = {0};
    const swiftprox_shape *body = box(0.5, 0.5, 0.5);
    const swiftprox_ground *ground = NULL;
    swiftprox_motion motion = {SWIFTPROX_MOTION_KIND_SCREW, {1, 0, 0, 2.1, 0, 1, 0, 1.9, 0, 0, 1, 3}};
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    swiftprox_ground_cast_answer answer;
    CHECK_OK(swiftprox_ground_create_from_heights(5, 5, 1, 1, heights, &ground));
    const swiftprox_placed_ground here = {ground, identity};
    const swiftprox_moving falling = {body, &motion};
    motion.velocity[2] = -4;
    CHECK_OK(swiftprox_pair_ground_cast(falling, here, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT && answer.triangle < 32);
    CHECK(answer.answer.time_lower <= 0.625 && 0.625 <= answer.answer.time_upper);
    CHECK(answer.answer.time_upper - answer.answer.time_lower <= 1e-9 && fabs(answer.answer.contact.normal[2] - 1) < 1e-12);
    motion.velocity[2] = -2;
    CHECK_OK(swiftprox_pair_ground_cast(falling, here, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_CAST_OUTCOME_FREE && answer.triangle == 32);
    CHECK(0 < answer.answer.clearance && answer.answer.clearance <= 0.5);
    config.ignores_parting = 1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "ignores_parting", swiftprox_pair_ground_cast(falling, here, &config, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_CAST_OUTCOME_NONE);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_pair_ground_cast(falling, here, NULL, NULL));
    swiftprox_ground_release(ground);
    swiftprox_shape_release(body);
}

/* Triangles of a grid in two parts, one of them skipped; and what may be wrong with a part. */
static void triangles_are_read(void)
{
    const double heights[6] = {0, 0.5, NAN, 2, 1, 3};
    const double wanted[18] = {0, 0, 0, 1, 0, 0.5, 1, 2, 1, 0, 0, 0, 1, 2, 1, 0, 2, 2};
    const uint32_t wanted_corners[12] = {0, 1, 4, 0, 4, 3, 1, 1, 1, 1, 1, 1};
    const swiftprox_ground *ground = NULL;
    double points[36];
    uint32_t corners[12];
    CHECK_OK(swiftprox_ground_create_from_heights(2, 3, 2, 1, heights, &ground));
    CHECK_OK(swiftprox_ground_copy_triangles(ground, 0, 1, points, corners));
    CHECK_OK(swiftprox_ground_copy_triangles(ground, 1, 3, points + 9, corners + 3));
    CHECK(memcmp(points, wanted, sizeof wanted) == 0 && memcmp(corners, wanted_corners, sizeof corners) == 0);
    CHECK(points[18] == 1 && points[20] == 0.5 && points[35] == 0.5);
    corners[0] = 77;
    CHECK_OK(swiftprox_ground_copy_triangles(ground, 0, 4, points, NULL));
    CHECK_OK(swiftprox_ground_copy_triangles(ground, 4, 0, points, corners));
    CHECK(corners[0] == 77);
    points[0] = 77;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "2 triangles from number 3 on",
                swiftprox_ground_copy_triangles(ground, 3, 2, points, corners));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "of a ground that has 4",
                swiftprox_ground_copy_triangles(ground, SIZE_MAX, SIZE_MAX, points, corners));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ground", swiftprox_ground_copy_triangles(NULL, 0, 1, points, corners));
    CHECK(points[0] == 77 && corners[0] == 77);
    CHECK_OK(swiftprox_ground_copy_triangles(ground, 3, 1, NULL, corners));
    CHECK(corners[0] == 1);
    swiftprox_ground_release(ground);
}

/* Two tiles as one ground, and that as a solid: it pushes out a cube that is wholly below. */
static void tiles_and_solids(void)
{
    double heights[25] = {0}, poses[24] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 4, 0, 1, 0, 0, 0, 0, 1, 0};
    const double on_seam[12] = {1, 0, 0, 4.1, 0, 1, 0, 1.9, 0, 0, 1, 0.375};
    const double below[12] = {1, 0, 0, 4.1, 0, 1, 0, 1.9, 0, 0, 1, -0.75};
    const swiftprox_shape *body = box(0.5, 0.5, 0.5);
    const swiftprox_ground *tiles[2] = {NULL, NULL}, *ground = NULL, *solid = NULL, *none = NULL;
    swiftprox_ground_info info;
    swiftprox_ground_contact contacts[4];
    swiftprox_ground_count count;
    swiftprox_manifold_point points[16];
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    config.reduces = 1;
    CHECK_OK(swiftprox_ground_create_from_heights(5, 5, 1, 1, heights, &tiles[0]));
    tiles[1] = swiftprox_ground_retain(tiles[0]);
    CHECK_OK(swiftprox_ground_create_from_grounds(tiles, poses, 2, &ground));
    CHECK_OK(swiftprox_ground_get_info(ground, &info));
    CHECK(info.vertex_count == 50 && info.triangle_count == 64);
    CHECK_OK(swiftprox_pair_ground_contacts((swiftprox_placed){body, on_seam}, (swiftprox_placed_ground){ground, identity},
                                            &config, (swiftprox_ground_room){contacts, 4, points, 16}, &count));
    CHECK(count.contact_count == 1 && count.point_count == 4 && contacts[0].manifold.normal[2] == 1);
    CHECK_OK(swiftprox_pair_ground_contacts((swiftprox_placed){body, below}, (swiftprox_placed_ground){ground, identity},
                                            &config, (swiftprox_ground_room){contacts, 4, points, 16}, &count));
    CHECK(count.contact_count == 0);
    CHECK_OK(swiftprox_ground_create_solid(ground, 1, &solid));
    CHECK_OK(swiftprox_pair_ground_contacts((swiftprox_placed){body, below}, (swiftprox_placed_ground){solid, identity}, &config,
                                            (swiftprox_ground_room){contacts, 4, points, 16}, &count));
    CHECK(count.contact_count == 1 && contacts[0].manifold.lower <= -1.25 && -1.25 <= contacts[0].manifold.upper);
    CHECK(swiftprox_ground_create_solid(ground, -1, &none) == SWIFTPROX_ERROR_INVALID_ARGUMENT && none == NULL);
    CHECK(swiftprox_ground_create_solid(ground, NAN, &none) == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(swiftprox_ground_create_solid(NULL, 1, &none) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_ground_create_from_grounds(tiles, poses, 0, &none) == SWIFTPROX_ERROR_INVALID_ARGUMENT && none == NULL);
    CHECK(swiftprox_ground_create_from_grounds(NULL, poses, 2, &none) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_ground_create_from_grounds(tiles, NULL, 2, &none) == SWIFTPROX_ERROR_NULL_POINTER);
    poses[12] = -1;
    CHECK(swiftprox_ground_create_from_grounds(tiles, poses, 2, &none) == SWIFTPROX_ERROR_POSE);
    swiftprox_ground_release(tiles[0]);
    tiles[0] = NULL;
    CHECK(swiftprox_ground_create_from_grounds(tiles, poses, 2, &none) == SWIFTPROX_ERROR_NULL_POINTER);
    swiftprox_ground_release(tiles[1]);
    swiftprox_ground_release(ground);
    swiftprox_ground_release(solid);
    swiftprox_shape_release(body);
}

static void what_a_program_may_do_wrong(void)
{
    const double corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, mirror[12] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const double far[9] = {0, 0, 0, HUGE_VAL, 0, 0, 0, 1, 0};
    const uint32_t one[3] = {0, 1, 2}, absent[3] = {0, 1, 3}, thin[3] = {0, 1, 1};
    const swiftprox_shape *body = box(0.5, 0.5, 0.5);
    const swiftprox_ground *ground = NULL, *none = NULL;
    swiftprox_ground_distance answer;
    swiftprox_ground_count count;
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    CHECK_OK(swiftprox_ground_create_from_triangles(corners, 3, one, 1, &ground));
    CHECK(swiftprox_ground_create_from_triangles(corners, 3, absent, 1, &none) == SWIFTPROX_ERROR_MESH && none == NULL);
    CHECK(swiftprox_ground_create_from_triangles(corners, 3, thin, 1, &none) == SWIFTPROX_ERROR_MESH);
    CHECK(swiftprox_ground_create_from_triangles(far, 3, one, 1, &none) == SWIFTPROX_ERROR_MESH);
    CHECK(swiftprox_ground_create_from_triangles(NULL, 3, one, 1, &none) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_ground_create_from_triangles(corners, 3, one, 1, NULL) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_ground_create_from_heights(1, 4, 1, 1, corners, &none) == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(swiftprox_ground_create_from_heights(SIZE_MAX, 4, 1, 1, corners, &none) == SWIFTPROX_ERROR_LIMIT);
    CHECK(swiftprox_pair_ground_distance(SWIFTPROX_QUERY_KIND_CONTACT, (swiftprox_placed){body, identity},
                                         (swiftprox_placed_ground){ground, identity}, NULL, &answer) ==
          SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(swiftprox_pair_ground_distance(SWIFTPROX_QUERY_KIND_DISTANCE, (swiftprox_placed){body, mirror},
                                         (swiftprox_placed_ground){ground, identity}, NULL, &answer) ==
          SWIFTPROX_ERROR_POSE);
    CHECK(isnan(answer.answer.distance));
    CHECK(swiftprox_pair_ground_contacts((swiftprox_placed){body, identity}, (swiftprox_placed_ground){ground, mirror}, NULL,
                                         (swiftprox_ground_room){NULL, 0, NULL, 0}, &count) == SWIFTPROX_ERROR_POSE);
    CHECK(swiftprox_pair_ground_contacts((swiftprox_placed){body, identity}, (swiftprox_placed_ground){ground, identity}, NULL,
                                         (swiftprox_ground_room){NULL, 1, NULL, 0}, &count) ==
          SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_pair_ground_contacts((swiftprox_placed){body, identity}, (swiftprox_placed_ground){NULL, identity}, NULL,
                                         (swiftprox_ground_room){NULL, 0, NULL, 0}, &count) ==
          SWIFTPROX_ERROR_NULL_POINTER);
    config.max_distance = -1;
    CHECK(swiftprox_pair_ground_contacts((swiftprox_placed){body, identity}, (swiftprox_placed_ground){ground, identity},
                                         &config, (swiftprox_ground_room){NULL, 0, NULL, 0}, &count) ==
          SWIFTPROX_ERROR_INVALID_ARGUMENT);
    swiftprox_ground_release(ground);
    swiftprox_ground_release(NULL);
    swiftprox_shape_release(body);
}

/* An object asked about below the box of the heights: only in a solid it has a contact. */
static void down_and_solid(swiftprox_scene *scene, swiftprox_object_id id, const swiftprox_ground *ground,
                           swiftprox_scratch *scratch)
{
    const double below[12] = {1, 0, 0, 2, 0, 1, 0, 2, 0, 0, 1, -0.75};
    const swiftprox_ground *solid = NULL;
    swiftprox_object_set set = {0};
    swiftprox_scene_ground_answer answer;
    set.ids = &id;
    set.count = 1;
    set.poses = below;
    CHECK_OK(swiftprox_scene_ground_contacts(scene, &set, (swiftprox_placed_ground){ground, identity}, NULL, scratch, &answer));
    CHECK(answer.contact_count == 0);
    CHECK_OK(swiftprox_ground_create_solid(ground, 1, &solid));
    CHECK_OK(swiftprox_scene_ground_contacts(scene, &set, (swiftprox_placed_ground){solid, identity}, NULL, scratch, &answer));
    CHECK(answer.contact_count == 1 && answer.contacts[0].contact.manifold.normal[2] == 1);
    swiftprox_ground_release(solid);
}

/* Cubes of a scene over a level grid and a half-space: two are 0.125 in, one of these in another group, one is fixed, one above. */
static void objects_of_a_scene(void)
{
    double heights[25] = {0};
    const double down[12] = {1, 0, 0, 2, 0, 1, 0, 2, 0, 0, 1, 0.375}, mirror[12] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const swiftprox_half_space floor = {{0, 0, 2}, 0}, none = {{0, 0, 0}, 0};
    swiftprox_scene_ground_config second = SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT;
    const swiftprox_shape *body = box(0.5, 0.5, 0.5);
    const swiftprox_ground *ground = NULL;
    swiftprox_scene *scene = NULL;
    swiftprox_scratch *scratch = NULL;
    swiftprox_object_id ids[4], stale = SWIFTPROX_OBJECT_ID_NULL;
    swiftprox_object_set set = {0};
    swiftprox_object_options options;
    swiftprox_scene_ground_config config = SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT;
    swiftprox_scene_ground_answer answer;
    int i;
    CHECK_OK(swiftprox_ground_create_from_heights(5, 5, 1, 1, heights, &ground));
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    CHECK_OK(swiftprox_scratch_create(&scratch));
    for (i = 0; i < 4; ++i) {
        options = (swiftprox_object_options)SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        memcpy(options.pose, down, sizeof down);
        options.pose[3] = 0.75 + 0.75 * i;
        options.pose[11] = i == 3 ? 2 : 0.375;
        options.groups = i == 1 ? 2 : 1;
        options.fixed = i == 2;
        options.user_data = 10 + (uint64_t)i;
        CHECK_OK(swiftprox_scene_add_object(scene, &body, 1, &options, &ids[i]));
    }
    config.reduces = 1;
    second.mask = 2;
    CHECK_OK(swiftprox_scene_ground_contacts(scene, NULL, (swiftprox_placed_ground){ground, identity}, &config, scratch, &answer));
    CHECK(answer.contact_count == 2 && answer.point_count == 8 && answer.contacts[1].contact.first_point == 4);
    CHECK(answer.contacts[0].object.bits == ids[0].bits && answer.contacts[0].user_data == 10 && answer.contacts[0].piece == 0);
    CHECK(answer.contacts[1].contact.manifold.normal[2] == 1 && answer.contacts[1].contact.triangle < 32);
    CHECK(answer.points[7].gap_lower <= -0.125 && -0.125 <= answer.points[7].gap_upper);
    CHECK_OK(swiftprox_scene_half_space_contacts(scene, NULL, &floor, &config, scratch, &answer));
    CHECK(answer.contact_count == 2 && answer.point_count == 8 && answer.contacts[0].contact.triangle == UINT32_MAX);
    CHECK(answer.points[0].gap_lower <= -0.125 && -0.125 <= answer.points[0].gap_upper);
    down_and_solid(scene, ids[0], ground, scratch);
    CHECK_OK(swiftprox_scene_ground_contacts(scene, NULL, (swiftprox_placed_ground){ground, identity}, &second, scratch,
                                             &answer));
    CHECK(answer.contact_count == 1 && answer.contacts[0].object.bits == ids[1].bits);
    set.ids = ids + 2;
    set.count = 1;
    CHECK_OK(swiftprox_scene_ground_contacts(scene, &set, (swiftprox_placed_ground){ground, identity}, NULL, scratch, &answer));
    CHECK(answer.contact_count == 0 && answer.contacts == NULL && answer.points == NULL);
    set.poses = down;
    CHECK_OK(swiftprox_scene_ground_contacts(scene, &set, (swiftprox_placed_ground){ground, identity}, NULL, scratch, &answer));
    CHECK(answer.contact_count == 1 && answer.contacts[0].user_data == 12);

    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene",
                swiftprox_scene_ground_contacts(NULL, NULL, (swiftprox_placed_ground){ground, identity}, NULL, scratch, &answer));
    CHECK(answer.contact_count == 0 && answer.point_count == 0 && answer.contacts == NULL);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ground",
                swiftprox_scene_ground_contacts(scene, NULL, (swiftprox_placed_ground){NULL, identity}, NULL, scratch, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ground.pose",
                swiftprox_scene_ground_contacts(scene, NULL, (swiftprox_placed_ground){ground, NULL}, NULL, scratch, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scratch",
                swiftprox_scene_ground_contacts(scene, NULL, (swiftprox_placed_ground){ground, identity}, NULL, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer",
                swiftprox_scene_ground_contacts(scene, NULL, (swiftprox_placed_ground){ground, identity}, NULL, scratch, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "",
                swiftprox_scene_ground_contacts(scene, NULL, (swiftprox_placed_ground){ground, mirror}, NULL, scratch, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "half_space",
                swiftprox_scene_half_space_contacts(scene, NULL, NULL, NULL, scratch, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "normal",
                swiftprox_scene_half_space_contacts(scene, NULL, &none, NULL, scratch, &answer));
    set.poses = mirror;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "object 0 of 1",
                swiftprox_scene_ground_contacts(scene, &set, (swiftprox_placed_ground){ground, identity}, NULL, scratch, &answer));
    set.ids = &stale;
    CHECK_FAILS(SWIFTPROX_ERROR_HANDLE, "null",
                swiftprox_scene_half_space_contacts(scene, &set, &floor, NULL, scratch, &answer));
    config.max_distance = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
                swiftprox_scene_ground_contacts(scene, NULL, (swiftprox_placed_ground){ground, identity}, &config, scratch,
                                                &answer));
    swiftprox_scratch_destroy(scratch);
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_ground_release(ground);
    swiftprox_shape_release(body);
}

int main(void)
{
    a_cube_on_a_level_grid();
    objects_of_a_scene();
    rays();
    casts();
    triangles_are_read();
    tiles_and_solids();
    what_a_program_may_do_wrong();
    return check_report("ground");
}
