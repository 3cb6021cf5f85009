/*
 * swiftprox. Curved shapes: cylinders, cones and ellipsoids. Queries run on a polyhedron inside the shape, which reaches farther by
 * at most `deviation`. Intervals hold for the shape: they are wider by the deviation. Where it hides whether objects intersect, the
 * outcome is SWIFTPROX_OUTCOME_UNDECIDED. Points and features are the polyhedron's. Grounds, gradients and compounds refuse these
 * shapes. The conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_CURVED_H
#define SWIFTPROX_CURVED_H

#include "../swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_curved Curved shapes
 * @{
 */

/**
 * Creates a cylinder about the z axis, from z = -half_height to half_height. Release it with swiftprox_shape_release. On
 * failure `*shape` is null.
 *
 * Its polyhedron is a prism. Vertex k of n is at the bottom, at the angle 2 pi k / n from x; vertex n + k is above it. A
 * deviation of 0 means 1e-4 of the radius.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a length is not from 2^-960 to 2^1000, or the deviation is negative, above 2^1000, NaN, or
 * so small that the prism had more than 2048 sides; the message tells the least.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_cylinder(double radius,
                                                 double half_height,
                                                 double deviation,
                                                 const struct swiftprox_shape **shape);

/**
 * Creates a cone about the z axis, with its base at z = -half_height and its tip at z = half_height. Release it with
 * swiftprox_shape_release. On failure `*shape` is null.
 *
 * Deviation and vertices of the base are as in swiftprox_shape_create_cylinder; vertex n is the tip. Same errors as there.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_cone(double radius,
                                             double half_height,
                                             double deviation,
                                             const struct swiftprox_shape **shape);

/**
 * Creates an ellipsoid about the local origin with three semi-axes along x, y and z. Release it with swiftprox_shape_release.
 * On failure `*shape` is null. A deviation of 0 means 1e-3 of the largest semi-axis. For a sphere
 * swiftprox_shape_create_sphere is exact.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a semi-axis is not from 2^-960 to 2^1000, or the deviation is negative, above 2^1000, NaN,
 * or so small that the polyhedron had more than 4002 vertices; the message tells the least.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_ellipsoid(const double *semi_axes,
                                                  double deviation,
                                                  const struct swiftprox_shape **shape);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
