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

/** Objects that a question is about. */
typedef struct swiftprox_object_set {
  /** Which, in any order. */
  const struct swiftprox_object_id *ids;
  /** How many. */
  size_t count;
  /** 12 doubles for each object: where it is for this question. Null: where the scene has it. */
  const double *poses;
  /** Not 0: pairs of two objects of the set are asked about, too. */
  int32_t among;
} swiftprox_object_set;

/**
 * Room to work in for questions that threads ask a scene at once: about sets of objects, and of rays, grounds and half-spaces. One
 * thread at a time uses it, for any scenes.
 *
 * Of sets it keeps what pairs of objects remember, which changes how fast an answer comes and which of several nearest points it
 * gives, never a verdict. Of rays, grounds and half-spaces it keeps nothing but the room and the last answer: whatever it has
 * seen, they are answered bit for bit as with a new one.
 */
typedef struct swiftprox_scratch swiftprox_scratch;

/**
 * Makes room to work in for questions that threads ask a scene at once: about sets of objects, and of rays, grounds and
 * half-spaces. The caller owns it and gives it back with swiftprox_scratch_destroy. One thread at a time uses it, for any scenes.
 * Of sets it keeps what pairs of objects remember, which changes how fast an answer comes and which of several nearest points it
 * gives, never a verdict: where bits matter, take a new one. Rays, grounds and half-spaces remember nothing: whatever it has seen,
 * they are answered bit for bit as with a new one. On failure `*scratch` is null.
 *
 * SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scratch_create(struct swiftprox_scratch **scratch);

/**
 * Gives back what swiftprox_scratch_create made, and what it owns. Null is ignored.
 *
 * Experimental.
 */
void swiftprox_scratch_destroy(struct swiftprox_scratch *scratch);

/**
 * Makes questions about sets fast after objects were moved, added or removed: they find what is near by the trees of the broad
 * phase, which this brings up to date. It changes no answer. Without it they go through what has changed one by one, and through
 * all pieces if many have.
 *
 * SWIFTPROX_ERROR_MEMORY: questions take longer. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_prepare(struct swiftprox_scene *scene);

/** The least distance between two sets of objects. Numbers that it does not say are NaN. */
typedef struct swiftprox_least_distance {
  /** The least distance is at least this, of sets that are farther apart than the cut-off that ... */
  double lower;
  /** ... and at most this: infinite of sets that are farther apart than the cut-off, and where no pair is tested. */
  double upper;
  /**
   * A pair with that distance, object 1 of the first set; with null ids if there is none within the cut-off. Of several pairs as
   * near, as far as doubles tell, it is any.
   */
  struct swiftprox_pair_result nearest;
} swiftprox_least_distance;

/**
 * The least distance between two sets of objects, or between a set and all other objects (against is null), with its interval and
 * a pair that has it. Of sets farther apart than cut_off (infinity: none are) no more than that is said.
 *
 * Pairs are those that queries test: activation, groups and the filter are heeded. Two fixed objects are left out, unless one of
 * the sets has poses. Any number of threads may ask a scene at once that nobody changes, each with its own scratch; a null scratch
 * is made for the call.
 *
 * On failure the answer's numbers are NaN. SWIFTPROX_ERROR_HANDLE: an id names no object of this scene.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: cut_off is negative or NaN. SWIFTPROX_ERROR_POSE: a pose is refused. SWIFTPROX_ERROR_BUSY: the
 * scene is being changed. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_POISONED.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_least_distance(const struct swiftprox_scene *scene,
                                                const struct swiftprox_object_set *set,
                                                const struct swiftprox_object_set *against,
                                                double cut_off,
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
   * A pair that is no farther apart than the margin, object 1 of the set: of an answer the verdict and its proof, or an interval
   * of the distance. Null ids if nothing hits.
   */
  struct swiftprox_pair_result pair;
} swiftprox_first_hit;

/**
 * At which of many times a set of objects is no farther from something than margin: all other objects, and if set->among is not 0
 * one another. poses are 12 doubles for each object at the first time, then at the second, and so on; set->poses is not looked at,
 * nor are poses of times that are not tried. Pairs are those that queries test; both may be fixed. Threads and scratch as of
 * swiftprox_scene_least_distance.
 *
 * On failure nothing is said: time and tried are 0, the pair's ids null. Errors as of swiftprox_scene_least_distance;
 * SWIFTPROX_ERROR_INVALID_ARGUMENT also for an empty set, an unknown order, and a margin that is negative, infinite or NaN.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_first_hit(const struct swiftprox_scene *scene,
                                           const struct swiftprox_object_set *set,
                                           const double *poses,
                                           size_t time_count,
                                           swiftprox_pose_order order,
                                           double margin,
                                           struct swiftprox_scratch *scratch,
                                           struct swiftprox_first_hit *answer);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
