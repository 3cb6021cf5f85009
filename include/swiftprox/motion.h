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

/** How an object moves. */
typedef enum swiftprox_motion_kind SWIFTPROX_INT32 {
  /** It stays at start. */
  SWIFTPROX_MOTION_KIND_FIXED = 0,
  /**
   * A point p is at T + R c + t velocity + exp(t [rotation]) R (p - c) at time t, where start is [R|T] and c the centre: it
   * turns at a constant rate about a centre that moves on a line.
   */
  SWIFTPROX_MOTION_KIND_SCREW = 1,
  /** Its pose is (1 - t) start + t end, entry by entry. For turns of up to 0.2 radians: poses in between are refused beyond. */
  SWIFTPROX_MOTION_KIND_AFFINE = 2,
  /** Where `pose` says. */
  SWIFTPROX_MOTION_KIND_CALLBACK = 3
} swiftprox_motion_kind;

/**
 * Writes the pose at a time, 12 doubles, row by row; they are NaN before, which is refused. The same time gives the same pose. It
 * runs in the thread that asks, and must return; a C++ exception that leaves it ends the program.
 */
typedef void (*swiftprox_motion_callback)(void *user, double time, double *pose);

/** A motion. Of its members only those of its kind are looked at. */
typedef struct swiftprox_motion {
  /** Which of the following it is. */
  swiftprox_motion_kind kind;
  /** The pose at time 0. Not of SWIFTPROX_MOTION_KIND_CALLBACK. */
  double start[12];
  /** The pose at time 1, of SWIFTPROX_MOTION_KIND_AFFINE. */
  double end[12];
  /** Of SWIFTPROX_MOTION_KIND_SCREW: what it turns about, in the object's frame, */
  double centre[3];
  /** how fast that moves, in the world, */
  double velocity[3];
  /** and its angular velocity, in the world: along the axis, in radians per unit of time. All turned by may be 2^20 radians. */
  double rotation[3];
  /** Of SWIFTPROX_MOTION_KIND_CALLBACK: where it is at a time, */
  swiftprox_motion_callback pose;
  /** what is handed to that, */
  void *user;
  /** a bound of the acceleration of all points of the object at all times that are asked about, */
  double bend;
  /** and how far from the motion that is meant the poses may have a point. Answers are as right as these two. */
  double rounding;
} swiftprox_motion;

/**
 * The motion about a centre, in the object's frame (null: its origin), that starts at pose1 at time 0 and by the shortest turn
 * comes to pose2 at time 1. `end_error` (may be null): no point within `reach` of the centre ends farther than that from where
 * pose2 has it, which is rounding and what one rotation is more distorted than the other.
 *
 * SWIFTPROX_ERROR_POSE: a pose is refused. SWIFTPROX_ERROR_INVALID_ARGUMENT: the centre is not finite, or the reach is not from 0
 * on. SWIFTPROX_ERROR_NULL_POINTER. Then nothing is written.
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
  /** Farther apart than the margin at every time of the range. */
  SWIFTPROX_CAST_OUTCOME_FREE = 1,
  /**
   * Farther apart than the margin at every time before `t_lo` and at it, no farther than the margin at `t_hi`. Both are the
   * beginning where that is no farther. `t_hi` - `t_lo` is at most the time tolerance wherever contact can be proved so soon.
   */
  SWIFTPROX_CAST_OUTCOME_HIT = 2,
  /**
   * Farther apart than the margin up to `t_lo`, and hardly farther there: the objects graze, and rounding hides whether they
   * meet.
   */
  SWIFTPROX_CAST_OUTCOME_NEAR = 3,
  /** The step budget ran out: farther apart than the margin up to `t_lo`, and nothing is said of what follows. */
  SWIFTPROX_CAST_OUTCOME_BUDGET = 4
} swiftprox_cast_outcome;

/** The answer to a cast. Numbers that it does not say are NaN. */
typedef struct swiftprox_cast_answer {
  /** How it came out. */
  swiftprox_cast_outcome outcome;
  /** Certified queries made. */
  uint32_t queries;
  /** The objects are farther apart than the margin from the beginning up to here; the end of the range if they are free. */
  double t_lo;
  /** Where they are no farther apart than the margin. Only of a hit. */
  double t_hi;
  /** Their distance is at least this at every time of the range. Only of objects that are free. */
  double clearance;
  /** Of a hit their distance at `t_hi` is at most this, 0 where they intersect; of a near miss that at `t_lo`. */
  double upper;
  /**
   * Of a hit the contact at `t_hi`, of a near miss the distance at `t_lo`, with witness points, normal and features: for the
   * poses there as rounded.
   */
  struct swiftprox_pair_answer contact;
} swiftprox_cast_answer;

/** What a cast is asked for. Begin with SWIFTPROX_CAST_CONFIG_DEFAULT, then change what should differ. */
typedef struct swiftprox_cast_config {
  /** Set by SWIFTPROX_CAST_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Where the range of times begins. Default: 0. */
  double t_begin;
  /** Where it ends, not before it begins. Default: 1. */
  double t_end;
  /** How wide the interval of a hit may be, and the shortest step; from 2^-50 of the larger end on. Default: 1e-9. */
  double time_tolerance;
  /** Objects are free where they are farther apart than this, from 0 on. Default: 0. */
  double margin;
  /** Certified queries after which it stops with what is proved, 1 or more. Default: 100,000. */
  uint32_t step_budget;
} swiftprox_cast_config;

/** Begins a swiftprox_cast_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_CAST_CONFIG_DEFAULT {sizeof(swiftprox_cast_config), 0, 1, 1e-9, 0, 100000}

/**
 * Whether two moving objects stay farther apart than config->margin, or when they first do not: certain for the motions exactly as
 * they are described, at all times of the range and not only at some of them. Rounding of poses is accounted for.
 *
 * `cache` is what the pair remembers, as of swiftprox_pair_distance, and may be shared with that. It changes how long the cast
 * takes and where within what is proved a time lies, never what holds. `config` may be null for the defaults. On failure the
 * answer is reset: its outcome is SWIFTPROX_CAST_OUTCOME_NONE.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of config or of a motion is out of range or not finite, or a callback's poses show
 * that its bend is wrong. SWIFTPROX_ERROR_POSE: a pose of a motion is refused; the message says when.
 * SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument. SWIFTPROX_ERROR_BUG: the cache is
 * reset, too.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_cast(const struct swiftprox_shape *shape1,
                                     const struct swiftprox_motion *motion1,
                                     const struct swiftprox_shape *shape2,
                                     const struct swiftprox_motion *motion2,
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

/** What a clearance is asked for. Begin with SWIFTPROX_CLEARANCE_CONFIG_DEFAULT, then change what should differ. */
typedef struct swiftprox_clearance_config {
  /** Set by SWIFTPROX_CLEARANCE_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Where the range of times begins. Default: 0. */
  double t_begin;
  /** Where it ends, not before it begins. Default: 1. */
  double t_end;
  /** upper - lower may be as large as this ... from 0 to infinity. Default: 0. */
  double absolute_error;
  /** ... or as this times lower. Default: 0.01. Both 0: as narrow as can be proved. */
  double relative_error;
  /** Certified queries after which it stops with what is proved, 1 or more. Default: 100,000. */
  uint32_t step_budget;
} swiftprox_clearance_config;

/** Begins a swiftprox_clearance_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_CLEARANCE_CONFIG_DEFAULT {sizeof(swiftprox_clearance_config), 0, 1, 0, 0.01, 100000}

/**
 * The smallest distance of two moving objects over the range of times, as an interval [lower, upper]: as narrow as asked for, or
 * as can be proved. It is wider where the step budget runs out, and where rounding of poses hides more. Arguments and errors as of
 * swiftprox_pair_cast; on failure the numbers are NaN.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_clearance(const struct swiftprox_shape *shape1,
                                          const struct swiftprox_motion *motion1,
                                          const struct swiftprox_shape *shape2,
                                          const struct swiftprox_motion *motion2,
                                          struct swiftprox_pair_cache *cache,
                                          const struct swiftprox_clearance_config *config,
                                          struct swiftprox_clearance *answer);

/**
 * How a cast came out, in words. Never null, valid for ever; an unknown number gets a string that says so.
 *
 * Experimental.
 */
const char *swiftprox_library_cast_outcome_string(swiftprox_cast_outcome outcome);

/** @} */

/**
 * @defgroup swiftprox_scene_motion Motions through a scene
 * @{
 */

/** How a cast of moving objects through a scene came out. Numbers that it does not say are NaN. */
typedef struct swiftprox_scene_cast_answer {
  /** Of the pair that ends it; free if all pairs are. */
  swiftprox_cast_outcome outcome;
  /** Certified queries made. */
  uint32_t queries;
  /** All pairs are farther apart than the margin from the beginning up to here: the last valid time. */
  double t_lo;
  /** Of a hit a time at which its pair is no farther apart than the margin, the earliest that is known. */
  double t_hi;
  /** Of a hit the distance of its pair at `t_hi` is at most this, of a near miss that at its own `t_lo`. */
  double upper;
  /** The pair that ends it, object 1 moving, with what swiftprox_cast_answer_contact says; null ids if all are free. */
  struct swiftprox_pair_result pair;
} swiftprox_scene_cast_answer;

/**
 * Whether moving objects stay farther than config->margin from all others, which rest, or when they first do not: certain at all
 * times of the range, as swiftprox_pair_cast is. One motion moves all objects of the set as one body, else each has its own;
 * pieces with poses of their own move with their object. Pairs of two of them are asked about if set->among is not 0; set->poses
 * is not looked at. Pairs are those that queries test; both may be fixed. config->step_budget is that of each pair; config may be
 * null for the defaults. Threads and scratch as of swiftprox_scene_least_distance.
 *
 * On failure the answer is reset: its outcome is SWIFTPROX_CAST_OUTCOME_NONE. SWIFTPROX_ERROR_INVALID_ARGUMENT: motion_count is
 * neither 1 nor set->count, or as of swiftprox_pair_cast. SWIFTPROX_ERROR_HANDLE: an id names no
 * object of this scene. SWIFTPROX_ERROR_BUSY: the scene is being changed. Others as of swiftprox_pair_cast, and
 * SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_POISONED.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_cast(const struct swiftprox_scene *scene,
                                      const struct swiftprox_object_set *set,
                                      const struct swiftprox_motion *motions,
                                      size_t motion_count,
                                      const struct swiftprox_cast_config *config,
                                      struct swiftprox_scratch *scratch,
                                      struct swiftprox_scene_cast_answer *answer);

/**
 * swiftprox_scene_cast of many edges: answers has room for edge_count. The motions of the edges stand one behind the other: one
 * for each edge, or one for each object of the set at each edge. An edge is valid up to its answer's t_lo.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: motion_count is neither edge_count nor that times set->count. Others as of
 * swiftprox_scene_cast; the message names the edge, and that and all edges behind it have answers that are reset.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_cast_batch(const struct swiftprox_scene *scene,
                                            const struct swiftprox_object_set *set,
                                            const struct swiftprox_motion *motions,
                                            size_t motion_count,
                                            const struct swiftprox_cast_config *config,
                                            struct swiftprox_scratch *scratch,
                                            struct swiftprox_scene_cast_answer *answers,
                                            size_t edge_count);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
