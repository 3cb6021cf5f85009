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
 * Checks an answer independently of the search that found it. SWIFTPROX_OK: it is right for these shapes and poses.
 *
 * Verdict and interval are proved without tolerance for the exact objects R*v + T. `distance` must be in the interval. Other
 * members may be off by 2^-47 * (both radii + distances of the centres from each other and from their local origins). The
 * normal must have unit length, and separate separated objects by at least lower. Witness points must lie in their objects and
 * agree in both frames: on the features if separated, one common point for a contact. decided_by, statistics and the direction
 * of a contact's normal are not checked. Time is linear in the number of vertices.
 *
 * SWIFTPROX_ERROR_UNVERIFIED: the answer is wrong; the message says where. SWIFTPROX_ERROR_INVALID_ARGUMENT: the answer has an
 * unknown enumerator, no outcome or no such vertex, or objects are too large or far apart for doubles.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_verify(struct swiftprox_placed object1,
                                       struct swiftprox_placed object2,
                                       const struct swiftprox_pair_answer *answer);

/**
 * Checks a depth independently of the search that found it. SWIFTPROX_OK: it is right for these shapes and poses. The query's
 * `cache` holds the proof; with another cache the function searches for one.
 *
 * Verdict (overlapping, touching or separated) and interval are proved without tolerance for the exact objects R*v + T. Other
 * members are checked up to the allowance of swiftprox_pair_verify. world2 - world1 must be depth * normal, up to that and
 * upper - lower. Ending and statistics are not checked.
 *
 * Time is linear in the number of vertices and the size of the cache. Same errors as swiftprox_pair_verify.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_depth_verify(struct swiftprox_placed object1,
                                             struct swiftprox_placed object2,
                                             const struct swiftprox_depth_cache *cache,
                                             const struct swiftprox_depth_answer *answer);

/**
 * Checks a manifold independently of the search that found it. SWIFTPROX_OK: it is right for these shapes and poses. `config` is
 * that of the query. With another `cache` than the query's, the function searches for a proof of the depth. `points` holds
 * manifold->point_count points.
 *
 * Verdict and interval are proved as in swiftprox_pair_verify and swiftprox_pair_depth_verify. The normal must have unit length:
 * along it, separated objects are at least lower apart, others overlap by at most -lower. Points must be on their objects,
 * features and line up to b, and agree in both frames. Behind a face they may also be off by the gap's width. Gaps must match the
 * points. One point must have the full depth, unless points were left out.
 *
 * b is the allowance of swiftprox_pair_verify plus 2^-25 of the pair's size (both radii plus the distance of the centres) plus
 * eight times the largest thickness of contact faces. Completeness of faces is not checked.
 *
 * Same errors as swiftprox_pair_verify and swiftprox_pair_manifold.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_manifold_verify(struct swiftprox_placed object1,
                                                struct swiftprox_placed object2,
                                                const struct swiftprox_manifold_cache *cache,
                                                const struct swiftprox_manifold_config *config,
                                                const struct swiftprox_manifold_point *points,
                                                const struct swiftprox_manifold *manifold);

/** @} */

/**
 * @defgroup swiftprox_cast_verify Casts re-checked
 * @{
 */

/**
 * Checks an answer of swiftprox_pair_cast for the same motions and config, independently of its search. SWIFTPROX_OK: it is right.
 *
 * It proves without tolerance, at every time: free pairs stay farther apart than max_distance, and at least clearance. Other pairs
 * stay farther apart than max_distance up to time_lower, unless that is the beginning. Hits are at most max_distance and upper
 * apart at time_upper, as `proof` shows. Near misses are at most upper apart at time_lower. swiftprox_pair_verify checks
 * `contact`, of the poses at time_lower. `queries` is not checked.
 *
 * Time grows with the number of vertices times the number of steps. After some seconds of integer arithmetic the check gives up,
 * and the message says so.
 *
 * SWIFTPROX_ERROR_UNVERIFIED: something is wrong or unproved; the message says what. SWIFTPROX_ERROR_INVALID_ARGUMENT: the answer
 * has an unknown enumerator or no outcome. Other errors as in swiftprox_pair_cast and swiftprox_pair_verify.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_cast_verify(struct swiftprox_moving object1,
                                            struct swiftprox_moving object2,
                                            const struct swiftprox_cast_config *config,
                                            const struct swiftprox_cast_answer *answer);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
