/*
 * swiftprox. Questions about sets of objects, which threads may ask one scene at once. The conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_SETS_H
#define SWIFTPROX_SETS_H

#include "../swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_set Questions about sets of objects, which threads may ask one scene at once
 * @{
 */

/** A set of objects for a query. */
typedef struct swiftprox_object_set {
  /** Their ids, in any order. */
  const struct swiftprox_object_id *ids;
  /** Number of objects. */
  size_t count;
  /** 12 doubles per object: its pose for this query. Null: the scene's poses. */
  const double *poses;
  /** Not 0: pairs within the set are tested, too. */
  int32_t among;
} swiftprox_object_set;

/**
 * Scratch memory for questions that threads ask a scene at once: about sets of objects, and about rays, grounds and half-spaces.
 * One thread at a time uses it, for any scenes.
 *
 * For sets it keeps the caches of pairs of objects. These change how fast an answer comes, which of several nearest points it
 * gives, and which of several pairs that hit a first hit names; never a verdict. For rays, grounds and half-spaces it keeps
 * nothing but the room and the last answer. Whatever it has seen, they are answered bit for bit as with a new one.
 */
typedef struct swiftprox_scratch swiftprox_scratch;

/**
 * Creates working memory for concurrent queries of object sets, rays, grounds and half-spaces. The caller owns it and frees it
 * with swiftprox_scratch_destroy. It serves one thread at a time, and any scenes. On failure `*scratch` is null.
 *
 * For sets it keeps caches of pairs, which affect speed and the choice among several nearest points, or among several pairs that
 * hit at one time, never a verdict. Where bits matter, use a new scratch. Rays, grounds and half-spaces use no cache; a used
 * scratch gives the same bits as a new one.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scratch_create(struct swiftprox_scratch **scratch);

/**
 * Frees a scratch and the results it owns. Null is ignored.
 *
 * Experimental.
 */
void swiftprox_scratch_destroy(struct swiftprox_scratch *scratch);

/**
 * Updates the broad phase after objects were moved, added or removed, so that queries of sets are fast. It changes no answer.
 * Without it, such queries test changed pieces one by one, or all pieces if many have changed.
 *
 * SWIFTPROX_ERROR_MEMORY: such queries take longer.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_prepare(struct swiftprox_scene *scene);

/** The least distance between two sets of objects. Unset numbers are NaN. */
typedef struct swiftprox_least_distance {
  /** The least distance is at least this. For sets farther apart than `max_distance`, it is no less than that. */
  double lower;
  /** The least distance is at most this. It is infinite beyond `max_distance`, and if no pair is tested. */
  double upper;
  /**
   * A pair with that distance: object 1 is of the first set, `nearest.answer` the answer. Its ids are null if no pair is within
   * `max_distance`. Among pairs equally near in doubles, any may be returned.
   */
  struct swiftprox_pair_result nearest;
} swiftprox_least_distance;

/**
 * Returns the least distance between two sets, with its interval and a nearest pair. Null `against` means all other objects. For
 * sets farther apart than max_distance the answer says only that; infinity means no limit. Only pairs that queries test count:
 * activation, groups and the filter are respected. Two fixed objects are skipped, unless one of the sets has poses.
 *
 * Any number of threads may query a scene that no call changes, each with its own scratch. A null scratch means a temporary one.
 * On failure the answer's numbers are NaN. SWIFTPROX_ERROR_INVALID_ARGUMENT: max_distance is negative or NaN.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_least_distance(const struct swiftprox_scene *scene,
                                                const struct swiftprox_object_set *set,
                                                const struct swiftprox_object_set *against,
                                                double max_distance,
                                                struct swiftprox_scratch *scratch,
                                                struct swiftprox_least_distance *answer);

/** In which order times are tried. */
typedef enum swiftprox_pose_order SWIFTPROX_INT32 {
  /** The first, the middle, the quarters, and so on: what is found is any of those that hit, and found soonest. */
  SWIFTPROX_POSE_ORDER_BISECTION = 0,
  /** One after the other: what is found is the first that hits. */
  SWIFTPROX_POSE_ORDER_IN_ORDER = 1
} swiftprox_pose_order;

/** At which of many times a set of objects meets something. */
typedef struct swiftprox_first_hit {
  /** The number of the time that was found to hit; how many times there are if none does. */
  size_t time;
  /** How many times were tried. */
  size_t tried;
  /**
   * A pair that is no farther apart than `max_distance`, object 1 of the set; the scratch may decide which of several. Of an
   * answer the verdict and its proof, or an interval of the distance. Null ids if nothing hits.
   */
  struct swiftprox_pair_result pair;
} swiftprox_first_hit;

/** Poses of a set of objects at many times, an argument by value. Only read during the call. */
typedef struct swiftprox_path {
  /** 12 doubles per object for the first time, then for the second, and so on. */
  const double *poses;
  /** Number of times. */
  size_t time_count;
  /** The order in which times are tried. */
  swiftprox_pose_order order;
} swiftprox_path;

/**
 * Finds a time at which a set of objects is within max_distance of any other object, or of one another if set->among is not 0.
 * A pair that a deviation leaves undecided is one, too. set->poses and poses of untried times are not read. Only pairs that
 * queries test count, but both objects may be fixed. Threads and scratch: as for swiftprox_scene_least_distance.
 *
 * On failure time and tried are 0, the pair's ids null. SWIFTPROX_ERROR_INVALID_ARGUMENT: an empty set, an unknown order, or
 * max_distance is negative, infinite or NaN.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_first_hit(const struct swiftprox_scene *scene,
                                           const struct swiftprox_object_set *set,
                                           struct swiftprox_path path,
                                           double max_distance,
                                           struct swiftprox_scratch *scratch,
                                           struct swiftprox_first_hit *answer);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
