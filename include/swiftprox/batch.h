/*
 * swiftprox. Many pairs, or many poses of one pair, in one call. The conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_BATCH_H
#define SWIFTPROX_BATCH_H

#include "../swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_batch Many pairs, or many poses, at once
 * @{
 */

/** A shape at one or many poses, an argument of swiftprox_pair_distances by value. Pointers are only read during the call. */
typedef struct swiftprox_poses {
  /** The shape. */
  const struct swiftprox_shape *shape;
  /** 12 doubles per pose, the row-major 3x4 matrix [R|T]. */
  const double *poses;
  /** Number of poses; 1 for an object that does not move. */
  size_t count;
} swiftprox_poses;

/**
 * Computes the distances of one pair at many poses in turn. Answers and cache are bit for bit those of repeated calls of
 * swiftprox_pair_distance. Both objects have the same number of poses, or one has one. `answers` has room for the larger count.
 *
 * A refused pose gets a reset answer, and all others are answered; the message names the first. SWIFTPROX_ERROR_INVALID_ARGUMENT:
 * the counts differ, and neither is 1. Other errors as in swiftprox_pair_distance.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_distances(struct swiftprox_poses object1,
                                          struct swiftprox_poses object2,
                                          struct swiftprox_pair_cache *cache,
                                          const struct swiftprox_pair_config *config,
                                          struct swiftprox_pair_answer *answers);

/** One pair of a batch. */
typedef struct swiftprox_pair_question {
  /** Shape 1. */
  const struct swiftprox_shape *shape1;
  /** Pose of shape 1, 12 doubles. */
  const double *pose1;
  /** Shape 2. */
  const struct swiftprox_shape *shape2;
  /** Pose of shape 2, 12 doubles. */
  const double *pose2;
  /** The pair's own cache; pairs must not share one. */
  struct swiftprox_pair_cache *cache;
} swiftprox_pair_question;

/**
 * Runs the query `kind` for `count` pairs; `answers[k]` belongs to `pairs[k]`. Answers and caches are bit for bit those of
 * swiftprox_pair_intersection, swiftprox_pair_distance, swiftprox_pair_contact or swiftprox_pair_approximate. With a `scene`, its
 * workers share batches of 2,048 pairs or more; null uses only the caller's thread. The scene does not change, but no other call
 * may use it meanwhile.
 *
 * A refused pair gets a reset answer, and all others are answered; the message names the first. Null pointers and lack of memory
 * leave all unanswered. SWIFTPROX_ERROR_BUG resets all answers and caches. SWIFTPROX_ERROR_INVALID_ARGUMENT: kind is unknown, or a
 * member of config is out of range.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_batch(swiftprox_query_kind kind,
                                      const struct swiftprox_pair_question *pairs,
                                      size_t count,
                                      const struct swiftprox_pair_config *config,
                                      struct swiftprox_scene *scene,
                                      struct swiftprox_pair_answer *answers);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
