/*
 * swiftprox. Objects that move, one by one and in a scene. The conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_MOTION_H
#define SWIFTPROX_MOTION_H

#include "sets.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_motion Objects that move
 * @{
 */

/** Kinds of motion. */
typedef enum swiftprox_motion_kind SWIFTPROX_INT32 {
  /** The object stays at start. */
  SWIFTPROX_MOTION_KIND_FIXED = 0,
  /**
   * The object turns at a constant rate about a centre c that moves on a line. At time t, with start [R|T], a point p is at
   * `T + R c + t velocity + exp(t [rotation]) R (p - c)`.
   */
  SWIFTPROX_MOTION_KIND_SCREW = 1,
  /**
   * The pose is (1 - t) start + t end, entry by entry. For turns of up to 0.2 radians; larger turns give refused poses in
   * between.
   */
  SWIFTPROX_MOTION_KIND_AFFINE = 2,
  /** The callback `pose` gives the pose. */
  SWIFTPROX_MOTION_KIND_CALLBACK = 3
} swiftprox_motion_kind;

/**
 * Writes the pose at a time: 12 doubles, row by row. They are NaN before the call, and refused if left so. Equal times must give
 * equal poses. It runs in the calling thread and must return; a C++ exception that leaves it ends the program.
 */
typedef void (*swiftprox_motion_callback)(void *user, double time, double *pose);

/** A motion. Only the members of its kind are read. */
typedef struct swiftprox_motion {
  /** The kind of motion. */
  swiftprox_motion_kind kind;
  /** The pose at time 0. Not for SWIFTPROX_MOTION_KIND_CALLBACK. */
  double start[12];
  /** For SWIFTPROX_MOTION_KIND_AFFINE: the pose at time 1. */
  double end[12];
  /** For SWIFTPROX_MOTION_KIND_SCREW: the centre of rotation, in the object's frame. */
  double centre[3];
  /** For SWIFTPROX_MOTION_KIND_SCREW: the velocity of the centre, in the world. */
  double velocity[3];
  /**
   * For SWIFTPROX_MOTION_KIND_SCREW: the angular velocity in the world, along the axis, in radians per unit of time. The total
   * turn may be 2^20 radians.
   */
  double rotation[3];
  /** For SWIFTPROX_MOTION_KIND_CALLBACK: gives the pose at a time. */
  swiftprox_motion_callback pose;
  /** For SWIFTPROX_MOTION_KIND_CALLBACK: passed to `pose`. */
  void *user;
  /**
   * For SWIFTPROX_MOTION_KIND_CALLBACK: an upper bound of the acceleration of all points of the object over the range of times.
   * Answers are only as right as bend and rounding.
   */
  double bend;
  /**
   * For SWIFTPROX_MOTION_KIND_CALLBACK: the largest distance of a point at the callback's pose from its place in the intended
   * motion.
   */
  double rounding;
} swiftprox_motion;

/**
 * Makes the screw motion from pose1 at time 0 to pose2 at time 1 by the shortest turn. `centre` is in the object's frame; null
 * means its origin. `end_error` may be null. It receives a bound, from rounding and distortion of the rotations: points within
 * `reach` of the centre end at most that far from pose2.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the centre is not finite, or the reach is negative or NaN. Nothing is written then.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_motion_between(const double *pose1,
                                          const double *pose2,
                                          const double *centre,
                                          double reach,
                                          struct swiftprox_motion *motion,
                                          double *end_error);

/** How a cast came out. */
typedef enum swiftprox_cast_outcome SWIFTPROX_INT32 {
  /** Nothing is said yet: the value of a fresh answer. */
  SWIFTPROX_CAST_OUTCOME_NONE = 0,
  /** Farther apart than `max_distance` at every time of the range. */
  SWIFTPROX_CAST_OUTCOME_FREE = 1,
  /**
   * Farther apart than `max_distance` at every time before `time_lower` and at it, no farther than `max_distance` at
   * `time_upper`. Both are the beginning where that is no farther. `time_upper` - `time_lower` is at most the time tolerance
   * wherever contact can be proved so soon.
   */
  SWIFTPROX_CAST_OUTCOME_HIT = 2,
  /**
   * Farther apart than `max_distance` up to `time_lower`, and hardly farther there: the objects graze, and rounding hides
   * whether they meet.
   */
  SWIFTPROX_CAST_OUTCOME_NEAR = 3,
  /** The step budget ran out: farther apart than `max_distance` up to `time_lower`, and nothing is said of what follows. */
  SWIFTPROX_CAST_OUTCOME_BUDGET = 4
} swiftprox_cast_outcome;

/** The answer to a cast. Unset numbers are NaN. */
typedef struct swiftprox_cast_answer {
  /** How it came out. */
  swiftprox_cast_outcome outcome;
  /** Certified queries made. */
  uint32_t queries;
  /**
   * The objects are farther apart than `max_distance` from the beginning, or from `time_parted`, up to here; the end of the
   * range if they are free.
   */
  double time_lower;
  /** For a hit: a time at which they are no farther apart than `max_distance`. */
  double time_upper;
  /** For free objects: their distance is at least this at every time of the range. */
  double clearance;
  /** For a hit: their distance at `time_upper` is at most this, 0 if they intersect. For a near miss: the same at `time_lower`. */
  double upper;
  /**
   * For a start in contact that was ignored because the bodies part: they are farther apart than `max_distance` from this time
   * on. Nothing is said of earlier times.
   */
  double time_parted;
  /**
   * For a hit or a near miss: the distance at `time_lower`, with witness points, normal and features, for the poses there as
   * rounded. Next to a hit the distance is next to nothing; if one of the features is a face, the normal is that face's. For a
   * hit that begins in contact: that contact.
   */
  struct swiftprox_pair_answer contact;
  /**
   * For a hit with a `max_distance` of 0: vertex pairs, in the caller's numbering. The hull of their differences at `time_upper`
   * holds the origin.
   */
  uint32_t proof[4][2];
  /**
   * How many entries of `proof` are used: 1 to 4; 0 if there is no such proof, as for objects that meet by their swept radii
   * alone.
   */
  uint32_t proof_count;
} swiftprox_cast_answer;

/** Options of a cast. Initialise with SWIFTPROX_CAST_CONFIG_DEFAULT. */
typedef struct swiftprox_cast_config {
  /** Set by SWIFTPROX_CAST_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Start of the time range. Default: 0. */
  double time_begin;
  /** End of the time range, at least time_begin. Default: 1. */
  double time_end;
  /** Allowed width of a hit's time interval, and the shortest step. At least 2^-50 of the larger end. Default: 1e-9. */
  double time_tolerance;
  /** Objects farther apart than this are free; at least 0. Default: 0. */
  double max_distance;
  /** The largest number of queries, 1 or more. Then the cast stops with the bounds so far. Default: 100,000. */
  uint32_t step_budget;
  /**
   * Not 0: objects that are in contact at the beginning, and part within 1,024 time tolerances, are cast from there on; see
   * swiftprox_cast_answer.time_parted. Default: 0, such a start is a hit.
   */
  int32_t ignores_parting;
} swiftprox_cast_config;

/** Begins a swiftprox_cast_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_CAST_CONFIG_DEFAULT {sizeof(swiftprox_cast_config), 0, 1, 1e-9, 0, 100000, 0}

/** A shape and how it moves, an argument by value. Both pointers are only read during the call. */
typedef struct swiftprox_moving {
  /** The shape. */
  const struct swiftprox_shape *shape;
  /** Its motion. */
  const struct swiftprox_motion *motion;
} swiftprox_moving;

/**
 * Decides whether two moving objects stay farther apart than config->max_distance, or when they first do not. The answer is
 * guaranteed for the motions as described at all times of the range, with poses' rounding included.
 *
 * `cache` may be shared with swiftprox_pair_distance. It affects speed and the choice of times within the guaranteed bounds. On
 * failure the answer is reset and its outcome is SWIFTPROX_CAST_OUTCOME_NONE; SWIFTPROX_ERROR_BUG also resets the cache.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of config or a motion is out of range, or a callback contradicts its bend.
 * SWIFTPROX_ERROR_POSE: a motion's pose is refused; the message gives the time.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_cast(struct swiftprox_moving object1,
                                     struct swiftprox_moving object2,
                                     struct swiftprox_pair_cache *cache,
                                     const struct swiftprox_cast_config *config,
                                     struct swiftprox_cast_answer *answer);

/** The smallest distance of two objects over a motion. */
typedef struct swiftprox_clearance {
  /** They are at least this far apart at every time. */
  double lower;
  /** They are at most this far apart at `time`; 0 where they intersect. */
  double upper;
  /** A time of the range. */
  double time;
  /** Certified queries made. */
  uint32_t queries;
} swiftprox_clearance;

/** Options of a clearance. Initialise with SWIFTPROX_CLEARANCE_CONFIG_DEFAULT. */
typedef struct swiftprox_clearance_config {
  /** Set by SWIFTPROX_CLEARANCE_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Start of the time range. Default: 0. */
  double time_begin;
  /** End of the time range, at least time_begin. Default: 1. */
  double time_end;
  /** Allowed upper - lower, from 0 to infinity. Default: 0. */
  double absolute_error;
  /** Allowed (upper - lower) / lower. Default: 0.01. It is enough to meet one of the two errors. Both 0: as narrow as possible. */
  double relative_error;
  /** The largest number of queries, 1 or more. Then the search stops with the bounds so far. Default: 100,000. */
  uint32_t step_budget;
} swiftprox_clearance_config;

/** Begins a swiftprox_clearance_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_CLEARANCE_CONFIG_DEFAULT {sizeof(swiftprox_clearance_config), 0, 1, 0, 0.01, 100000}

/**
 * Computes the least distance of two moving objects over the range of times, as a guaranteed interval [lower, upper]. It is as
 * narrow as requested or possible: an exhausted step budget and rounded poses widen it. Same arguments and errors as
 * swiftprox_pair_cast. On failure the numbers are NaN.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_clearance(struct swiftprox_moving object1,
                                          struct swiftprox_moving object2,
                                          struct swiftprox_pair_cache *cache,
                                          const struct swiftprox_clearance_config *config,
                                          struct swiftprox_clearance *answer);

/**
 * Returns the text for a cast outcome. Never null, valid forever, also for unknown numbers.
 *
 * Experimental.
 */
const char *swiftprox_library_cast_outcome_string(swiftprox_cast_outcome outcome);

/** @} */

/**
 * @defgroup swiftprox_scene_motion Motions through a scene
 * @{
 */

/** How a cast of moving objects through a scene came out. Unset numbers are NaN. */
typedef struct swiftprox_scene_cast_answer {
  /** The answer for the pair that ends the motion; free if all pairs are. */
  swiftprox_cast_outcome outcome;
  /** Certified queries made. */
  uint32_t queries;
  /** All pairs are farther apart than `max_distance` from the beginning up to here: the last valid time. */
  double time_lower;
  /** For a hit: a time at which its pair is no farther apart than `max_distance`, the earliest that is known. */
  double time_upper;
  /** For a hit: its pair's distance at `time_upper` is at most this. For a near miss: the same at its `time_lower`. */
  double upper;
  /** The pair that ends it, object 1 moving, with what swiftprox_cast_answer_contact says; null ids if all are free. */
  struct swiftprox_pair_result pair;
} swiftprox_scene_cast_answer;

/** Motions of a set of objects over one or many edges, an argument by value. Only read during the call. */
typedef struct swiftprox_motions {
  /** Edge after edge, either one motion, which moves the whole set as one body, or one for each object of the set. */
  const struct swiftprox_motion *motions;
  /** Number of motions. */
  size_t count;
  /** Number of edges, and of answers; 1 for one cast. */
  size_t edge_count;
} swiftprox_motions;

/**
 * Tests whether moving objects stay farther than config->max_distance from all others, which rest. If not, it finds the first
 * time. The answer is guaranteed for all times of the range, as in swiftprox_pair_cast. Each edge has an answer and is free up to
 * its time_lower. set->among not 0 adds pairs within the set; set->poses is not read.
 *
 * Only pairs that queries test count, but both objects may be fixed. config->step_budget applies per pair. Threads and scratch: as
 * for swiftprox_scene_least_distance.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the number of motions is neither edge_count nor edge_count times set->count; the set has a
 * ground, or config->ignores_parting is set and a body comes near one. Else same errors as swiftprox_pair_cast. The message names
 * the edge; its answer and all later ones are SWIFTPROX_CAST_OUTCOME_NONE.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_cast(const struct swiftprox_scene *scene,
                                      const struct swiftprox_object_set *set,
                                      struct swiftprox_motions motions,
                                      const struct swiftprox_cast_config *config,
                                      struct swiftprox_scratch *scratch,
                                      struct swiftprox_scene_cast_answer *answers);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
