/*
 * swiftprox. Proofs: answers are re-checked, trusting nothing of the search that found them. The conventions are those of
 * swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_VERIFY_H
#define SWIFTPROX_VERIFY_H

#include "motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_verify Answers re-checked
 * @{
 */

/**
 * Re-checks an answer, trusting nothing of the search that found it. SWIFTPROX_OK: it holds for these shapes and poses.
 *
 * Verdict and interval are proved for the exact objects R*v + T, with no tolerance. Separated and beyond: the distance is not 0,
 * and it is in [lower, upper]; a lower of 0 is said only of a distance below all doubles, or beyond a tolerance. Intersecting: the
 * differences of the proof's vertex pairs hold the origin in their hull. Undecided: the distance is at most upper. `distance` is
 * in the interval.
 *
 * The other members are rounded, so they hold up to an allowance of 2^-47 (radius 1 + radius 2 + distance of the centres in the
 * world and of each from its local origin). The normal is of unit length; along it separated objects are at least lower apart.
 * The witness points are in their objects, and the same in both frames. Those of separated objects are on their features, at a
 * distance in [lower, upper]; those of a contact are one point. What an answer does not say is NaN. decided_by and statistics are
 * not checked, nor is more of a contact's normal than its length.
 *
 * Takes time linear in the number of vertices: double-double arithmetic proves most intervals, integers the others.
 *
 * SWIFTPROX_ERROR_UNVERIFIED: it does not hold; the message says what. SWIFTPROX_ERROR_INVALID_ARGUMENT: an enumerator in the
 * answer is unknown, it holds no outcome, its proof has no such vertex, or a normal or points are said of objects so large or far
 * apart that doubles cannot tell. SWIFTPROX_ERROR_POSE, SWIFTPROX_ERROR_NULL_POINTER: as of swiftprox_pair_distance.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_verify(const struct swiftprox_shape *shape1,
                                       const double *pose1,
                                       const struct swiftprox_shape *shape2,
                                       const double *pose2,
                                       const struct swiftprox_pair_answer *answer);

/**
 * Re-checks a depth, trusting nothing of the search that found it; `cache` is that of the query, which holds the proof, or any
 * other: then a proof is searched for. SWIFTPROX_OK: it holds for these shapes and poses.
 *
 * Verdict and interval are proved for the exact objects R*v + T, with no tolerance: that they overlap, touch or are separated, and
 * that the depth is in [lower, upper]. The other members are rounded, and hold up to the allowance of swiftprox_pair_verify:
 * points and features, and world2 - world1 is depth * normal up to that and upper - lower. How it ended and the statistics are not
 * checked.
 *
 * Takes time linear in the number of vertices and in the size of the cache.
 *
 * Errors as of swiftprox_pair_verify.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_depth_verify(const struct swiftprox_shape *shape1,
                                             const double *pose1,
                                             const struct swiftprox_shape *shape2,
                                             const double *pose2,
                                             const struct swiftprox_depth_cache *cache,
                                             const struct swiftprox_depth_answer *answer);

/**
 * Re-checks a manifold, trusting nothing of the search that found it; config is that of the query, and `cache` too, or any other:
 * then a proof of the depth is searched for. `points` holds `count` points, those of the manifold first. SWIFTPROX_OK: it holds
 * for these shapes and poses.
 *
 * Verdict and interval are proved for the exact objects R*v + T, with no tolerance, as by swiftprox_pair_verify and
 * swiftprox_pair_depth_verify. The other members are rounded. The normal is of unit length; along it objects that are apart are at
 * least lower apart, others overlap by at most -lower. Each point has a place on either object: no farther than b out of
 * it, no farther than b and the width of the gap behind a face that looks towards the other object, and the same in both frames.
 * The object has its feature; the place is no farther than b from that if it is a vertex or an edge. The gap is that of the two
 * places along the normal, up to the allowance of swiftprox_pair_verify; sideways they are no more than b off. One of the points
 * is as deep as the objects are, if none was left out.
 *
 * b is that allowance, 2^-25 of the pair's size (both radii and the distance of the centres) and eight times what contact faces
 * are thick at most. That a face is complete is not checked.
 *
 * SWIFTPROX_ERROR_UNVERIFIED: it does not hold; the message says what. SWIFTPROX_ERROR_INVALID_ARGUMENT also for fewer points than
 * the manifold has. Others as of swiftprox_pair_verify and swiftprox_pair_manifold.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_manifold_verify(const struct swiftprox_shape *shape1,
                                                const double *pose1,
                                                const struct swiftprox_shape *shape2,
                                                const double *pose2,
                                                const struct swiftprox_manifold_cache *cache,
                                                const struct swiftprox_manifold_config *config,
                                                const struct swiftprox_manifold_point *points,
                                                size_t count,
                                                const struct swiftprox_manifold *manifold);

/** @} */

/**
 * @defgroup swiftprox_cast_verify Casts re-checked
 * @{
 */

/**
 * Re-checks the answer of swiftprox_pair_cast for the same motions and configuration, trusting nothing of the search that found
 * it. SWIFTPROX_OK: it holds.
 *
 * Proved are, at every time and without tolerance: of a free pair that it is farther apart than the margin and at least
 * clearance; of all others that it is farther apart than the margin up to t_lo, if that is not the beginning; of a hit that it is
 * no farther apart than the margin and upper at t_hi; of a near miss that it is no farther apart than upper at t_lo. `contact` is
 * checked by swiftprox_pair_verify for the poses there. `queries` is not checked.
 *
 * Steps and directions come from a sweep without a cache. Each is proved over all vertices, so it takes time in proportion to
 * both.
 *
 * SWIFTPROX_ERROR_UNVERIFIED: something does not hold, or is not proved; the message says what. SWIFTPROX_ERROR_INVALID_ARGUMENT:
 * an enumerator in the answer is unknown, or it holds no outcome. Others as of swiftprox_pair_cast and swiftprox_pair_verify.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_cast_verify(const struct swiftprox_shape *shape1,
                                       const struct swiftprox_motion *motion1,
                                       const struct swiftprox_shape *shape2,
                                       const struct swiftprox_motion *motion2,
                                       const struct swiftprox_cast_config *config,
                                       const struct swiftprox_cast_answer *answer);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
