/*
 * Bodies over which balls are swept, half-spaces, faces of shapes and boxes of objects, from C: answers that are known, and what a
 * program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "check.h"
#include "swiftprox/curved.h"
#include "swiftprox/geometry.h"
#include "swiftprox/ground.h"
#include "swiftprox/scene.h"
#include "swiftprox/verify.h"

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/* The points, with a ball of a radius swept over their hull. */
static const swiftprox_shape *round_shape(const double *points, size_t count, double radius)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    const swiftprox_shape *shape = NULL;
    options.input = SWIFTPROX_INPUT_HULL;
    options.swept_radius = radius;
    CHECK_OK(swiftprox_shape_create_from_points(points, count, &options, &shape));
    return shape;
}

/* Spheres 5 apart, of radii that together are 5, and less. */
static void spheres(void)
{
    const double origin[3] = {0, 0, 0};
    const double there[12] = {1, 0, 0, 3, 0, 1, 0, 4, 0, 0, 1, 0};
    const swiftprox_shape *two = round_shape(origin, 1, 2), *three = round_shape(origin, 1, 3), *one = round_shape(origin, 1, 1);
    swiftprox_pair_cache cache = {0};
    swiftprox_pair_answer answer;
    swiftprox_depth_cache depths = {0};
    swiftprox_depth_answer depth;
    swiftprox_shape_info info;
    CHECK_OK(
        swiftprox_pair_distance((swiftprox_placed){two, identity}, (swiftprox_placed){three, there}, &cache, NULL, &answer));
    CHECK(answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING && answer.proof_count == 0);
    CHECK_OK(swiftprox_pair_verify((swiftprox_placed){two, identity}, (swiftprox_placed){three, there}, &answer));
    CHECK_OK(swiftprox_pair_depth((swiftprox_placed){two, identity}, (swiftprox_placed){three, there}, &depths, NULL, &depth));
    CHECK(depth.outcome == SWIFTPROX_OUTCOME_INTERSECTING && depth.lower == 0 && depth.upper == 0);
    CHECK_OK(swiftprox_pair_depth_verify((swiftprox_placed){two, identity}, (swiftprox_placed){three, there}, &depths, &depth));
    CHECK_OK(swiftprox_pair_distance((swiftprox_placed){two, identity}, (swiftprox_placed){one, there}, &cache, NULL, &answer));
    CHECK(answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.lower <= 2 && 2 <= answer.upper);
    CHECK_OK(swiftprox_pair_verify((swiftprox_placed){two, identity}, (swiftprox_placed){one, there}, &answer));
    answer.lower = answer.upper = answer.distance = 2.5;
    CHECK(swiftprox_pair_verify((swiftprox_placed){two, identity}, (swiftprox_placed){one, there}, &answer) ==
          SWIFTPROX_ERROR_UNVERIFIED);
    memset(&info, 0, sizeof info);
    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_shape_get_info(three, &info));
    CHECK(info.dimension == 0 && info.swept_radius == 3 && info.radius == 0);
    swiftprox_shape_release(one);
    swiftprox_shape_release(two);
    swiftprox_shape_release(three);
}

/* A capsule that lies on the ground z <= 1 with 0.25 below it. */
static void a_capsule_on_the_ground(void)
{
    const double ends[6] = {-1, 0, 0, 1, 0, 0};
    const double lying[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1.25};
    const swiftprox_shape *capsule = round_shape(ends, 2, 0.5);
    const swiftprox_half_space ground = {{0, 0, 4}, 4};
    swiftprox_signed_distance answer;
    swiftprox_manifold manifold;
    swiftprox_manifold_point points[4];
    size_t i;
    CHECK_OK(swiftprox_pair_half_space_distance((swiftprox_placed){capsule, lying}, &ground, &answer));
    CHECK(answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING && answer.lower <= -0.25 && -0.25 <= answer.upper);
    CHECK(answer.normal[2] == 1 && answer.world1[2] == 0.75 && answer.world2[2] == 1);
    CHECK_OK(swiftprox_pair_half_space_manifold((swiftprox_placed){capsule, lying}, &ground, NULL,
                                                (swiftprox_manifold_room){points, 4, NULL}, &manifold));
    CHECK(manifold.point_count == 2 && manifold.found_count == 2 && manifold.reference == 1);
    for (i = 0; i < 2; ++i) {
        CHECK(points[i].gap_lower <= -0.25 && -0.25 <= points[i].gap_upper && points[i].world1[2] == 0.75);
        CHECK(fabs(points[i].world1[0]) == 1 && points[i].feature2.kind == SWIFTPROX_FEATURE_KIND_NONE);
    }
    CHECK(points[0].id != points[1].id);
    swiftprox_shape_release(capsule);
}

static void what_is_wrong_is_said(void)
{
    const double origin[3] = {0, 0, 0}, mirror[12] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const swiftprox_shape *sphere = round_shape(origin, 1, 1), *none = NULL;
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_half_space ground = {{0, 0, 0}, 0};
    swiftprox_signed_distance answer;
    swiftprox_manifold manifold;
    options.input = SWIFTPROX_INPUT_HULL;
    options.swept_radius = -1;
    CHECK(swiftprox_shape_create_from_points(origin, 1, &options, &none) == SWIFTPROX_ERROR_INVALID_ARGUMENT && none == NULL);
    CHECK(strstr(swiftprox_library_last_error_message(), "swept_radius") != NULL);
    CHECK(swiftprox_pair_half_space_distance((swiftprox_placed){sphere, identity}, &ground, &answer) ==
          SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(answer.outcome == SWIFTPROX_OUTCOME_NONE && isnan(answer.distance));
    ground.normal[1] = 1;
    ground.offset = INFINITY;
    CHECK(swiftprox_pair_half_space_distance((swiftprox_placed){sphere, identity}, &ground, &answer) ==
          SWIFTPROX_ERROR_INVALID_ARGUMENT);
    ground.offset = 0;
    CHECK(swiftprox_pair_half_space_distance((swiftprox_placed){sphere, mirror}, &ground, &answer) == SWIFTPROX_ERROR_POSE);
    CHECK(swiftprox_pair_half_space_distance((swiftprox_placed){sphere, identity}, NULL, &answer) ==
          SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_pair_half_space_distance((swiftprox_placed){sphere, identity}, &ground, NULL) ==
          SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_pair_half_space_manifold((swiftprox_placed){sphere, identity}, &ground, NULL,
                                             (swiftprox_manifold_room){NULL, 1, NULL},
                                             &manifold) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(manifold.outcome == SWIFTPROX_OUTCOME_NONE);
    CHECK_OK(swiftprox_pair_half_space_manifold((swiftprox_placed){sphere, identity}, &ground, NULL,
                                                (swiftprox_manifold_room){NULL, 0, NULL}, &manifold));
    CHECK(manifold.point_count == 0 && manifold.found_count == 1);
    swiftprox_shape_release(sphere);
}

/* A cube of six polygons: each face is one of them; of the hull of its corners each is a number of its own. */
static void faces(void)
{
    static const uint32_t sides[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    static const uint32_t valences[6] = {4, 4, 4, 4, 4, 4};
    double corners[24], vertices[24];
    const swiftprox_shape *cube = NULL, *hull;
    swiftprox_face face;
    uint32_t places[4], label, numbers[8], seen = 0;
    size_t i, k, index;
    for (i = 0; i < 24; ++i) {
        corners[i] = (i / 3) >> (i % 3) & 1 ? 1 : -1;
    }
    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){corners, 8, sides, valences, 6}, NULL, &cube));
    CHECK_OK(swiftprox_shape_copy_vertices(cube, vertices, numbers, 8));
    for (i = 0; i < 6; ++i) {
        CHECK_OK(swiftprox_shape_get_face(cube, i, (swiftprox_face_room){places, 4, &label, 1}, &face));
        CHECK(face.corner_count == 4 && face.label_count == 1 && face.offset == 1 && label < 6);
        seen |= 1u << label;
        for (k = 0; k < 4; ++k) {
            const double *vertex = vertices + 3 * places[k];
            size_t corner = 0;
            CHECK(vertex[0] * face.normal[0] + vertex[1] * face.normal[1] + vertex[2] * face.normal[2] == 1);
            while (corner < 4 && sides[4 * label + corner] != numbers[places[k]]) {
                ++corner;
            }
            CHECK(corner < 4 && sides[4 * label + (corner + 1) % 4] == numbers[places[(k + 1) % 4]]);
        }
        CHECK_OK(swiftprox_shape_find_face(cube, label, &index));
        CHECK(index == i);
    }
    CHECK(seen == 63);
    CHECK_OK(swiftprox_shape_get_face(cube, 0, (swiftprox_face_room){NULL, 0, NULL, 0}, &face));
    CHECK(swiftprox_shape_get_face(cube, 0, (swiftprox_face_room){NULL, 1, NULL, 0}, &face) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_shape_get_face(cube, 6, (swiftprox_face_room){NULL, 0, NULL, 0}, &face) == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(isnan(face.offset) && face.corner_count == 0);
    CHECK(swiftprox_shape_find_face(cube, 6, &index) == SWIFTPROX_ERROR_INVALID_ARGUMENT && index == SIZE_MAX);
    hull = round_shape(corners, 8, 0);
    for (label = 0; label < 6; ++label) {
        CHECK_OK(swiftprox_shape_find_face(hull, label, &index));
        CHECK_OK(swiftprox_shape_get_face(hull, index, (swiftprox_face_room){places, 4, NULL, 0}, &face));
        CHECK(face.corner_count == 4);
    }
    swiftprox_shape_release(cube);
    swiftprox_shape_release(hull);
}

/* A capsule along (3, 4, 0)/5, of half length 5 and radius 0.5, at (1, 2, 3). */
static void boxes(void)
{
    static const double least[3] = {1 - 3 - 0.5, 2 - 4 - 0.5, 3 - 0.5}, greatest[3] = {1 + 3 + 0.5, 2 + 4 + 0.5, 3 + 0.5};
    const double ends[6] = {-5, 0, 0, 5, 0, 0};
    const swiftprox_shape *capsule = round_shape(ends, 2, 0.5);
    swiftprox_scene *scene = NULL;
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_id id, none = {0};
    double lower[3], upper[3];
    int k;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    options.pose[0] = options.pose[5] = 0.6;
    options.pose[1] = -0.8;
    options.pose[4] = 0.8;
    options.pose[3] = 1;
    options.pose[7] = 2;
    options.pose[11] = 3;
    CHECK_OK(swiftprox_scene_add_object(scene, &capsule, 1, &options, &id));
    CHECK_OK(swiftprox_scene_get_object_box(scene, id, lower, upper));
    for (k = 0; k < 3; ++k) {
        CHECK(lower[k] <= least[k] && least[k] - lower[k] < 1e-4);
        CHECK(upper[k] >= greatest[k] && upper[k] - greatest[k] < 1e-4);
    }
    CHECK(swiftprox_scene_get_object_box(scene, none, lower, upper) == SWIFTPROX_ERROR_HANDLE && isnan(lower[0]) && isnan(upper[2]));
    CHECK(swiftprox_scene_get_object_box(scene, id, lower, NULL) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(capsule);
}

/* A drum of radius 1 and height 2 beside a ball: 1 apart; within the deviation of each other; and 0.5 in each other. */
static void drums(void)
{
    const swiftprox_shape *drum = NULL, *cone = NULL, *egg = NULL, *ball = NULL, *none = NULL;
    const double semi_axes[3] = {1, 0.5, 0.5}, gaps[3] = {1, 0.004, -0.5};
    const swiftprox_outcome outcomes[3] = {SWIFTPROX_OUTCOME_SEPARATED, SWIFTPROX_OUTCOME_UNDECIDED, SWIFTPROX_OUTCOME_INTERSECTING};
    swiftprox_shape_info info;
    CHECK_OK(swiftprox_shape_create_cylinder(1, 1, 0.01, &drum));
    CHECK_OK(swiftprox_shape_create_cone(1, 1, 0.01, &cone));
    CHECK_OK(swiftprox_shape_create_ellipsoid(semi_axes, 0.01, &egg));
    CHECK_OK(swiftprox_shape_create_sphere(0.5, &ball));
    for (int i = 0; i < 3; ++i) {
        const swiftprox_shape *bodies[3] = {drum, cone, egg};
        /* Beside the drum and the egg, under the cone. */
        info.struct_size = sizeof info;
        CHECK_OK(swiftprox_shape_get_info(bodies[i], &info));
        CHECK(info.deviation > 0.001 && info.deviation <= 0.01);
        for (int k = 0; k < 3; ++k) {
            const double there[12] = {1, 0, 0, (i == 1 ? 0 : 1.5 + gaps[k]), 0, 1, 0, 0, 0, 0, 1, (i == 1 ? -1.5 - gaps[k] : 0)};
            const swiftprox_placed object1 = {bodies[i], identity}, object2 = {ball, there};
            swiftprox_pair_cache cache = {0};
            swiftprox_pair_answer answer;
            CHECK_OK(swiftprox_pair_distance(object1, object2, &cache, NULL, &answer));
            CHECK(answer.outcome == outcomes[k] && answer.lower <= fmax(gaps[k], 0) && fmax(gaps[k], 0) <= answer.upper);
            CHECK_OK(swiftprox_pair_verify(object1, object2, &answer));
        }
    }
    CHECK(swiftprox_shape_create_cylinder(1, 1, 1e-9, &none) == SWIFTPROX_ERROR_INVALID_ARGUMENT && none == NULL);
    CHECK(strstr(swiftprox_library_last_error_message(), "at least 1.") != NULL);
    CHECK(swiftprox_shape_create_cone(0, 1, 0, &none) == SWIFTPROX_ERROR_INVALID_ARGUMENT && none == NULL);
    CHECK(swiftprox_shape_create_ellipsoid(NULL, 0, &none) == SWIFTPROX_ERROR_NULL_POINTER && none == NULL);
    swiftprox_shape_release(drum);
    swiftprox_shape_release(cone);
    swiftprox_shape_release(egg);
    swiftprox_shape_release(ball);
}

int main(void)
{
    spheres();
    drums();
    a_capsule_on_the_ground();
    faces();
    boxes();
    what_is_wrong_is_said();
    return check_report("bodies");
}
