/* Boxes and poses for test programs. */
#ifndef BODIES_H
#define BODIES_H

#include "check.h"

/* A pose that turns nothing. */
static inline void place(double pose[12], double x, double y, double z)
{
    static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    memcpy(pose, identity, sizeof identity);
    pose[3] = x;
    pose[7] = y;
    pose[11] = z;
}

/* A box about the origin, by half its sides: its vertex i has coordinate k positive if bit k of i is set. */
static inline const swiftprox_shape *box(double x, double y, double z)
{
    const double half[3] = {x, y, z};
    const swiftprox_shape *shape = NULL;
    double corners[24];
    int i;
    for (i = 0; i < 24; ++i) {
        corners[i] = (i / 3) >> (i % 3) & 1 ? half[i % 3] : -half[i % 3];
    }
    CHECK_OK(swiftprox_shape_create_from_points(corners, 8, NULL, &shape));
    return shape;
}

#endif
