/* Vectors of three, row-major matrices of nine. */
#ifndef SWIFTPROX_EXAMPLES_VECTORS_H
#define SWIFTPROX_EXAMPLES_VECTORS_H

#include <math.h>

static inline double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cross(const double a[3], const double b[3], double product[3])
{
    const double x = a[1] * b[2] - a[2] * b[1];
    const double y = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
    product[0] = x;
    product[1] = y;
}

/* sum += scale * v */
static inline void add_scaled(double sum[3], double scale, const double v[3])
{
    for (int i = 0; i < 3; i++) {
        sum[i] += scale * v[i];
    }
}

static inline void multiply(const double m[9], const double v[3], double product[3])
{
    const double copy[3] = {v[0], v[1], v[2]};
    for (int i = 0; i < 3; i++) {
        product[i] = dot(&m[3 * i], copy);
    }
}

/* Two unit vectors that are orthogonal to a unit vector and to each other. */
static inline void tangents(const double normal[3], double first[3], double second[3])
{
    const int least = fabs(normal[0]) < fabs(normal[1]) ? (fabs(normal[0]) < fabs(normal[2]) ? 0 : 2)
                                                        : (fabs(normal[1]) < fabs(normal[2]) ? 1 : 2);
    double axis[3] = {0, 0, 0};
    axis[least] = 1;
    cross(normal, axis, first);
    const double length = sqrt(dot(first, first));
    for (int i = 0; i < 3; i++) {
        first[i] /= length;
    }
    cross(normal, first, second);
}

#endif
