/*
 * Gradients from C: what is known in closed form, and what a program may do wrong.
 */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/geometry.h"

static swiftprox_placed placed(const swiftprox_shape *shape, const double *pose)
{
    swiftprox_placed object;
    object.shape = shape;
    object.pose = pose;
    return object;
}

/* A ball of radius 1/2 about (x, 0, 0) beside the cube [-1, 1]^3, turned about a point 3 above its centre. */
static void a_ball_beside_a_cube(void)
{
    static const double places[3] = {2, 1.25, 0.75};
    const swiftprox_shape *cube = box(1, 1, 1), *ball = NULL;
    double here[12], there[12], above[3] = {0, 0, 3};
    int i;
    CHECK_OK(swiftprox_shape_create_sphere(0.5, &ball));
    place(there, 0, 0, 0);
    for (i = 0; i < 3; ++i) {
        static const swiftprox_manifold_cache cold;
        swiftprox_manifold_cache cache = cold;
        swiftprox_signed_distance answer;
        swiftprox_gradient gradient;
        const swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
        place(here, places[i], 0, 0);
        above[0] = places[i];
        CHECK_OK(swiftprox_pair_signed_distance(placed(ball, here), placed(cube, there), &cache, &config, &answer));
        CHECK(answer.lower <= places[i] - 1.5 && places[i] - 1.5 <= answer.upper);
        CHECK_OK(swiftprox_pair_gradient(placed(ball, here), placed(cube, there), &answer, above, NULL, &gradient));
        CHECK(gradient.is_unique == 1);
        CHECK(gradient.object1[0] == 1 && gradient.object1[1] == 0 && gradient.object1[4] == -3);
        CHECK(gradient.object2[0] == -1 && gradient.object2[5] == 0);
        answer.outcome = (swiftprox_outcome)77;
        CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "normal",
                    swiftprox_pair_gradient(placed(ball, here), placed(cube, there), &answer, NULL, NULL, &gradient));
        CHECK(isnan(gradient.object1[0]) && isnan(gradient.object2[5]) && gradient.is_unique == 0);
    }
    swiftprox_shape_release(ball);
    swiftprox_shape_release(cube);
}

/* A cube face to face with another: the derivative does not exist. */
static void cubes_face_to_face(void)
{
    const swiftprox_shape *cube = box(1, 1, 1);
    static const swiftprox_manifold_cache cold;
    swiftprox_manifold_cache cache = cold;
    swiftprox_signed_distance answer;
    swiftprox_gradient gradient;
    double here[12], there[12], nowhere[3] = {0, 0, 0};
    place(here, 0, 0, 2.5);
    place(there, 0, 0, 0);
    CHECK_OK(swiftprox_pair_signed_distance(placed(cube, here), placed(cube, there), &cache, NULL, &answer));
    CHECK_OK(swiftprox_pair_gradient(placed(cube, here), placed(cube, there), &answer, NULL, NULL, &gradient));
    CHECK(gradient.is_unique == 0 && gradient.object1[2] == 1 && gradient.object2[2] == -1);
    nowhere[1] = HUGE_VAL;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "reference1",
                swiftprox_pair_gradient(placed(cube, here), placed(cube, there), &answer, nowhere, NULL, &gradient));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer",
                swiftprox_pair_gradient(placed(cube, here), placed(cube, there), NULL, NULL, NULL, &gradient));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "gradient",
                swiftprox_pair_gradient(placed(cube, here), placed(cube, there), &answer, NULL, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object1.shape",
                swiftprox_pair_gradient(placed(NULL, here), placed(cube, there), &answer, NULL, NULL, &gradient));
    here[0] = 2;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal",
                swiftprox_pair_gradient(placed(cube, here), placed(cube, there), &answer, NULL, NULL, &gradient));
    swiftprox_shape_release(cube);
}

int main(void)
{
    a_ball_beside_a_cube();
    cubes_face_to_face();
    return check_report("gradient");
}
