/*
 * Grounds from C: answers that are known, and what a program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "check.h"

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/* A cube of side 1. */
static const swiftprox_shape *cube(void)
{
    const double corners[24] = {-0.5, -0.5, -0.5, 0.5, -0.5, -0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5,
                                -0.5, -0.5, 0.5,  0.5, -0.5, 0.5,  -0.5, 0.5, 0.5,  0.5, 0.5, 0.5};
    const swiftprox_shape *shape = NULL;
    CHECK_OK(swiftprox_shape_create_from_points(corners, 8, NULL, &shape));
    return shape;
}

/* A cube 0.25 over a level grid, and 0.125 in it: it stands on four corners. */
static void a_cube_on_a_level_grid(void)
{
    double heights[25] = {0};
    const double over[12] = {1, 0, 0, 2.1, 0, 1, 0, 1.9, 0, 0, 1, 0.75}, in[12] = {1, 0, 0, 2.1, 0, 1, 0, 1.9, 0, 0, 1, 0.375};
    const swiftprox_shape *body = cube();
    const swiftprox_ground *ground = NULL;
    swiftprox_ground_info info;
    swiftprox_ground_distance answer;
    swiftprox_ground_contact contacts[4];
    swiftprox_ground_count count;
    swiftprox_manifold_point points[16];
    swiftprox_manifold_config config;
    CHECK_OK(swiftprox_ground_create_from_heights(5, 5, 1, 1, heights, &ground));
    CHECK_OK(swiftprox_ground_get_info(ground, &info));
    CHECK(info.vertex_count == 25 && info.triangle_count == 32 && info.bytes < 200 * 32);
    CHECK(swiftprox_ground_retain(ground) == ground);
    swiftprox_ground_release(ground);
    CHECK_OK(swiftprox_pair_ground_distance(SWIFTPROX_QUERY_KIND_DISTANCE, body, over, ground, identity, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.triangle < 32);
    CHECK(answer.answer.lower <= 0.25 && 0.25 <= answer.answer.upper && answer.answer.normal[2] == 1);
    CHECK_OK(swiftprox_pair_ground_distance(SWIFTPROX_QUERY_KIND_INTERSECTION, body, in, ground, identity, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING);
    swiftprox_manifold_config_init(&config);
    config.reduces = 1;
    CHECK_OK(swiftprox_pair_ground_contacts(body, in, ground, identity, &config, contacts, 4, points, 16, &count));
    CHECK(count.contact_count == 1 && count.point_count == 4 && contacts[0].manifold.point_count == 4);
    CHECK(contacts[0].manifold.normal[2] == 1 && contacts[0].first_point == 0);
    CHECK(points[3].gap_lower <= -0.125 && -0.125 <= points[3].gap_upper);
    CHECK_OK(swiftprox_pair_ground_contacts(body, in, ground, identity, &config, NULL, 0, NULL, 0, &count));
    CHECK(count.contact_count == 1 && count.point_count == 4);
    CHECK_OK(swiftprox_pair_ground_contacts(body, over, ground, identity, NULL, contacts, 4, points, 16, &count));
    CHECK(count.contact_count == 0 && count.point_count == 0);
    swiftprox_ground_release(ground);
    swiftprox_shape_release(body);
}

static void what_a_program_may_do_wrong(void)
{
    const double corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, mirror[12] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const double far[9] = {0, 0, 0, HUGE_VAL, 0, 0, 0, 1, 0};
    const uint32_t one[3] = {0, 1, 2}, absent[3] = {0, 1, 3}, thin[3] = {0, 1, 1};
    const swiftprox_shape *body = cube();
    const swiftprox_ground *ground = NULL, *none = NULL;
    swiftprox_ground_distance answer;
    swiftprox_ground_count count;
    swiftprox_manifold_config config;
    CHECK_OK(swiftprox_ground_create_from_triangles(corners, 3, one, 1, &ground));
    CHECK(swiftprox_ground_create_from_triangles(corners, 3, absent, 1, &none) == SWIFTPROX_ERROR_MESH && none == NULL);
    CHECK(swiftprox_ground_create_from_triangles(corners, 3, thin, 1, &none) == SWIFTPROX_ERROR_MESH);
    CHECK(swiftprox_ground_create_from_triangles(far, 3, one, 1, &none) == SWIFTPROX_ERROR_MESH);
    CHECK(swiftprox_ground_create_from_triangles(NULL, 3, one, 1, &none) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_ground_create_from_triangles(corners, 3, one, 1, NULL) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_ground_create_from_heights(1, 4, 1, 1, corners, &none) == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(swiftprox_ground_create_from_heights(SIZE_MAX, 4, 1, 1, corners, &none) == SWIFTPROX_ERROR_LIMIT);
    CHECK(swiftprox_pair_ground_distance(SWIFTPROX_QUERY_KIND_CONTACT, body, identity, ground, identity, NULL, &answer) ==
          SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(swiftprox_pair_ground_distance(SWIFTPROX_QUERY_KIND_DISTANCE, body, mirror, ground, identity, NULL, &answer) ==
          SWIFTPROX_ERROR_POSE);
    CHECK(isnan(answer.answer.distance));
    CHECK(swiftprox_pair_ground_contacts(body, identity, ground, mirror, NULL, NULL, 0, NULL, 0, &count) == SWIFTPROX_ERROR_POSE);
    CHECK(swiftprox_pair_ground_contacts(body, identity, ground, identity, NULL, NULL, 1, NULL, 0, &count) ==
          SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_pair_ground_contacts(body, identity, NULL, identity, NULL, NULL, 0, NULL, 0, &count) ==
          SWIFTPROX_ERROR_NULL_POINTER);
    swiftprox_manifold_config_init(&config);
    config.margin = -1;
    CHECK(swiftprox_pair_ground_contacts(body, identity, ground, identity, &config, NULL, 0, NULL, 0, &count) ==
          SWIFTPROX_ERROR_INVALID_ARGUMENT);
    swiftprox_ground_release(ground);
    swiftprox_ground_release(NULL);
    swiftprox_shape_release(body);
}

int main(void)
{
    a_cube_on_a_level_grid();
    what_a_program_may_do_wrong();
    return check_report("ground");
}
