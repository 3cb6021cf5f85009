/* Poses from quaternions and from column-major matrices, and what is refused. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "swiftprox.h"

int main(void)
{
    /* A third of a turn about (1, 1, 1): x to y, y to z, z to x. */
    const double turn[4] = {0.5, 0.5, 0.5, 0.5}, shift[3] = {1, 2, 3};
    const double expected[12] = {0, 0, 1, 1, 1, 0, 0, 2, 0, 1, 0, 3};
    /* The same as OpenGL has it: column by column. */
    const double columns[16] = {0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 2, 3, 1};
    double pose[12], bad[16];
    int i;
    CHECK_OK(swiftprox_pose_from_quaternion(turn, shift, pose));
    CHECK(memcmp(pose, expected, sizeof pose) == 0);
    CHECK_OK(swiftprox_pose_from_column_major(columns, pose));
    CHECK(memcmp(pose, expected, sizeof pose) == 0);

    memcpy(bad, turn, sizeof turn);
    for (i = 0; i < 4; ++i) {
        bad[i] = 1;
    }
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "divide it by its length", swiftprox_pose_from_quaternion(bad, shift, pose));
    CHECK(isnan(pose[0]) && isnan(pose[11]));
    bad[0] = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "length", swiftprox_pose_from_quaternion(bad, shift, pose));
    bad[0] = INFINITY;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "finite", swiftprox_pose_from_quaternion(turn, bad, pose));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "quaternion", swiftprox_pose_from_quaternion(NULL, shift, pose));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "translation", swiftprox_pose_from_quaternion(turn, NULL, pose));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pose", swiftprox_pose_from_quaternion(turn, shift, NULL));

    /* Transposed: the translation is in the last row. */
    for (i = 0; i < 16; ++i) {
        bad[i] = columns[4 * (i % 4) + i / 4];
    }
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "row-major", swiftprox_pose_from_column_major(bad, pose));
    CHECK(isnan(pose[0]) && isnan(pose[11]));
    memcpy(bad, columns, sizeof bad);
    bad[1] = -1;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "reflection", swiftprox_pose_from_column_major(bad, pose));
    bad[1] = 2;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal", swiftprox_pose_from_column_major(bad, pose));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "matrix", swiftprox_pose_from_column_major(NULL, pose));
    return check_report("pose");
}
