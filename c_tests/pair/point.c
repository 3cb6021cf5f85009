/*
 * Points and support vertices from C: answers that are known, and what a program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/geometry.h"

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static void answers_that_are_known(void)
{
    const swiftprox_shape *shape = box(1, 1, 1);
    double point[3] = {3, 0.25, 0.5};
    const double direction[3] = {1, -2, 3};
    swiftprox_point_answer answer;
    swiftprox_support_vertex vertex;
    CHECK_OK(swiftprox_shape_locate_point(shape, identity, point, &answer));
    CHECK(answer.location == SWIFTPROX_POINT_LOCATION_OUTSIDE && answer.feature.kind == SWIFTPROX_FEATURE_KIND_FACE);
    CHECK(answer.lower <= 2 && 2 <= answer.upper && answer.upper - answer.lower < 1e-12 && answer.normal[0] == 1);
    point[0] = 1;
    CHECK_OK(swiftprox_shape_locate_point(shape, identity, point, &answer));
    CHECK(answer.location == SWIFTPROX_POINT_LOCATION_ON && answer.lower == 0 && answer.upper == 0);
    point[0] = nextafter(1, 0);
    CHECK_OK(swiftprox_shape_locate_point(shape, identity, point, &answer));
    CHECK(answer.location == SWIFTPROX_POINT_LOCATION_INSIDE && answer.lower < 0 && answer.upper <= 0);
    CHECK(strcmp(swiftprox_library_point_location_string(answer.location), "inside") == 0);
    CHECK_OK(swiftprox_shape_support(shape, identity, direction, &vertex));
    CHECK(vertex.vertex == 5 && vertex.world[0] == 1 && vertex.world[1] == -1 && vertex.world[2] == 1);
    CHECK(vertex.height[0] <= 6 && 6 <= vertex.height[1] && vertex.height[1] - vertex.height[0] < 1e-12);
    swiftprox_shape_release(shape);
}

static void mistakes(void)
{
    const swiftprox_shape *shape = box(1, 1, 1);
    double pose[12];
    double numbers[3] = {0, 0, 0};
    swiftprox_point_answer answer;
    swiftprox_support_vertex vertex;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "shape", swiftprox_shape_locate_point(NULL, identity, numbers, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pose", swiftprox_shape_locate_point(shape, NULL, numbers, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "point", swiftprox_shape_locate_point(shape, identity, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_shape_locate_point(shape, identity, numbers, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "direction", swiftprox_shape_support(shape, identity, NULL, &vertex));
    memset(&vertex, 7, sizeof vertex);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "direction is 0", swiftprox_shape_support(shape, identity, numbers, &vertex));
    CHECK(isnan(vertex.height[0]) && isnan(vertex.world[2]) && vertex.vertex == 0);
    memcpy(pose, identity, sizeof pose);
    pose[0] = 2;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal", swiftprox_shape_locate_point(shape, pose, numbers, &answer));
    numbers[1] = HUGE_VAL;
    memset(&answer, 7, sizeof answer);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "point[1]", swiftprox_shape_locate_point(shape, identity, numbers, &answer));
    CHECK(answer.location == SWIFTPROX_POINT_LOCATION_NONE && isnan(answer.lower) && isnan(answer.normal[0]));
    swiftprox_shape_release(shape);
}

int main(void)
{
    answers_that_are_known();
    mistakes();
    return check_report("point");
}
