/* The exact oracle on pairs whose distance is known on paper. */

#include "check.h"

#include <math.h>
#include <string.h>

#include "oracle.h"

static double cube[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
static double tetrahedron[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static double point[3] = {0, 0, 0};

static const struct body cubes = {cube, 8, NULL, NULL};
static const struct body tetrahedra = {tetrahedron, 4, NULL, NULL};
static const struct body points = {point, 1, NULL, NULL};

/* Two bodies, the second one moved; `lower` and `upper` are the expected bounds, 0 for intersecting. */
struct known {
    const struct body *bodies[2];
    double translation[3];
    double lower, upper;
};

int main(int argc, char **argv)
{
    const double tiny = 0x1p-52, root2 = 1.4142135623730951, root3 = 1.7320508075688772;
    const struct known known[] = {
        /* sqrt 3 lies above its nearest double, sqrt 2 below. */
        {{&points, &points}, {1, 1, 1}, root3, nextafter(root3, 2)},
        {{&points, &points}, {3, 4, 0}, 5, 5},
        {{&points, &points}, {0, 0, 0}, 0, 0},
        {{&cubes, &cubes}, {2, .5, .25}, 1, 1},
        {{&cubes, &cubes}, {2, -2, .25}, nextafter(root2, 1), root2},
        {{&cubes, &cubes}, {-2, 2, 2}, root3, nextafter(root3, 2)},
        {{&cubes, &cubes}, {.5, .5, .5}, 0, 0},
        {{&cubes, &cubes}, {1, .5, 0}, 0, 0},
        {{&cubes, &cubes}, {1, 1, -1}, 0, 0},
        {{&cubes, &cubes}, {1 + tiny, .5, 0}, tiny, tiny},
        {{&cubes, &points}, {.5, .5, .5}, 0, 0},
        {{&cubes, &points}, {.5, .5, 1}, 0, 0},
        {{&tetrahedra, &points}, {.25, .25, .5}, 0, 0},
        /* 2^-53 above the face x + y + z = 1, by the root of 3 away from it. */
        {{&tetrahedra, &points}, {.25, .25, .5 + tiny / 2}, nextafter(tiny / 2 / root3, 0), tiny / 2 / root3},
    };
    if (argc != 2) {
        fprintf(stderr, "usage: %s EXACT_ORACLE\n", argv[0]);
        return 2;
    }
    for (size_t i = 0; i < sizeof known / sizeof *known; ++i) {
        double pose[24] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        struct scene scene;
        struct truth truth;
        size_t first = 0;
        memset(&scene, 0, sizeof scene);
        scene.bodies[0] = *known[i].bodies[0];
        scene.bodies[1] = *known[i].bodies[1];
        scene.poses = &pose;
        scene.pose_count = 1;
        for (int k = 0; k < 3; ++k)
            pose[12 + 4 * k + 3] = known[i].translation[k];
        if (CHECK(oracle_judge(argv[1], &scene, &first, 1, &truth)) &&
            !(CHECK(truth.intersecting == (known[i].upper == 0)) && CHECK(truth.lower == known[i].lower) &&
              CHECK(truth.upper == known[i].upper)))
            fprintf(stderr, "  case %zu: %d [%.17g, %.17g]\n", i, truth.intersecting, truth.lower, truth.upper);
    }
    return check_report("oracle_known");
}
