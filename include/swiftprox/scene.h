/*
 * swiftprox. More of scenes: pieces of objects, boxes around them, pairs of the program's own, events, statistics and memory. The
 * conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_SCENE_H
#define SWIFTPROX_SCENE_H

#include "../swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_piece Objects, their pieces and boxes
 * @{
 */

/**
 * Writes the ids of all objects in order of creation, and their number to `*count`. Results and swiftprox_scene_set_poses use the
 * same order. `ids` has room for `capacity` ids. With capacity 0 it may be null, and only the number is written. On failure
 * `*count` is 0.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is not 0 and less than the number of objects.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_copy_object_ids(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id *ids,
                                                 size_t capacity,
                                                 size_t *count);

/**
 * Adds a copy of `original` as it is now: its pieces (shared) and their poses, its pose, fixed flag, groups, mask and all user
 * data. All pairs of the copy are active. Pair caches are not copied. On failure nothing is added and `*id` is null.
 *
 * SWIFTPROX_ERROR_LIMIT: more objects than a scene holds.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_copy_object(struct swiftprox_scene *scene,
                                             struct swiftprox_object_id original,
                                             struct swiftprox_object_id *id);

/**
 * Returns the shape of a piece of an object. `piece` counts from 0; it is a size_t for compatibility, though results use a
 * uint32_t. The scene owns the share. To keep the shape longer than the object, call swiftprox_shape_retain. On failure `*shape`
 * is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_piece(const struct swiftprox_scene *scene,
                                           struct swiftprox_object_id id,
                                           size_t piece,
                                           const struct swiftprox_shape **shape);

/**
 * Moves a piece, numbered from 0, within its object. `pose` is 12 doubles, row-major [R|T]. The piece's pose in the world is the
 * object's pose times this one, each entry rounded; queries take the rounded pose as exact. Points and features of results are in
 * the piece's own frame. On failure the piece does not move.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such piece. SWIFTPROX_ERROR_POSE: the pose is refused, alone or with the object's.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_piece_pose(struct swiftprox_scene *scene,
                                                struct swiftprox_object_id id,
                                                uint32_t piece,
                                                const double *pose);

/**
 * Writes a piece's pose in the world: 12 doubles, row-major [R|T]. Queries use this pose, and swiftprox_pair_verify takes it. On
 * failure the doubles are NaN.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such piece.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_piece_pose(const struct swiftprox_scene *scene,
                                                struct swiftprox_object_id id,
                                                uint32_t piece,
                                                double *pose);

/**
 * Sets the caller's number of a piece; it is 0 at first. swiftprox_scene_get_piece_user_data and the events of listeners return
 * it; other results name the object and the piece.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_piece_user_data(struct swiftprox_scene *scene,
                                                     struct swiftprox_object_id id,
                                                     uint32_t piece,
                                                     uint64_t user_data);

/**
 * Writes the caller's number of a piece. The time does not grow with the scene. On failure it is 0.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_piece_user_data(const struct swiftprox_scene *scene,
                                                     struct swiftprox_object_id id,
                                                     uint32_t piece,
                                                     uint64_t *user_data);

/**
 * Writes the corners of a box along the world's axes that contains the object, swept radii included. Each corner has three
 * numbers. The box exceeds the object by less than 1e-5 of each piece's radius and position. A piece of more than 512 vertices is
 * represented by its oriented box instead. On failure all numbers are NaN.
 *
 * SWIFTPROX_ERROR_HANDLE: the id is null, stale or of another scene.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_object_box(const struct swiftprox_scene *scene,
                                                struct swiftprox_object_id id,
                                                double *lower_corner,
                                                double *upper_corner);

/** @} */

/**
 * @defgroup swiftprox_scene_pairs Pairs from a broad phase of the program's own
 * @{
 */

/**
 * Restricts queries to the given pairs of objects, however near others are; for programs with their own broad phase. `pairs` holds
 * 2 ids for each of `count` pairs, in any order. Duplicates are tested once. Activation, filters and fixed objects are respected
 * as usual; pairs of objects removed later are dropped. Remaining pairs keep their caches. On failure the former pairs stay.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a pair names one object twice. The message says which.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pairs(struct swiftprox_scene *scene,
                                           const struct swiftprox_object_id *pairs,
                                           size_t count);

/**
 * Undoes swiftprox_scene_set_pairs: the scene finds near pairs by itself again.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_reset_pairs(struct swiftprox_scene *scene);

/** @} */

/**
 * @defgroup swiftprox_scene_event What has changed, and how far contacts are
 * @{
 */

/**
 * Returns the signed distance of a pair of the last query of contacts: its distance, or minus its penetration depth. One interval
 * spans zero; normal and witness points are as from swiftprox_pair_signed_distance. It takes no further search. `number` is an
 * index into swiftprox_scene_answer.contacts. On failure the answer's numbers are NaN.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: number is too large, or the last query was not of contacts with a
 * swiftprox_scene_query.detail.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_signed_distance(const struct swiftprox_scene *scene,
                                                     size_t number,
                                                     struct swiftprox_signed_distance *answer);

/** A pair of objects, the earlier created first. */
typedef struct swiftprox_object_pair {
  /** The earlier created object. */
  struct swiftprox_object_id object1;
  /** The later created object. */
  struct swiftprox_object_id object2;
  /** The caller's own number of object 1. */
  uint64_t user_data1;
  /** The caller's own number of object 2. */
  uint64_t user_data2;
} swiftprox_object_pair;

/** The changes since the last query of events. */
typedef struct swiftprox_scene_events {
  /**
   * Pairs of objects that have become near, in order of creation. Owned by the scene, valid until its next query of events.
   * Null if began_count is 0.
   */
  const struct swiftprox_object_pair *began;
  /** Number of pairs. */
  size_t began_count;
  /**
   * Pairs of objects that are no longer near, including those of removed objects and deactivated pairs. Owned and valid as
   * began. Null if ended_count is 0.
   */
  const struct swiftprox_object_pair *ended;
  /** Number of pairs. */
  size_t ended_count;
} swiftprox_scene_events;

/**
 * Lists pairs of objects that became or stopped being near since the last call; the first call lists all near pairs. Near means
 * touching (`distance` 0) or within `distance`, for any of their pieces. Like all queries it ends the results of earlier ones. A
 * scene has one such history. swiftprox_scene_listen has one per listener, and reports contact points. On failure `*events` is
 * empty, and the history is unchanged.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: distance is negative or NaN.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_events(struct swiftprox_scene *scene,
                                              double distance,
                                              struct swiftprox_scene_events *events);

/** @} */

/**
 * @defgroup swiftprox_scene_statistics Statistics and memory
 * @{
 */

/** Work of a scene's queries since it was made or swiftprox_scene_reset_statistics was called. */
typedef struct swiftprox_scene_statistics {
  /** Queries. */
  uint64_t queries;
  /** Active pairs of convex pieces that were near enough to be looked at. How near that is depends on earlier queries. */
  uint64_t pairs;
  /** ... of which Voronoi marching decided. */
  uint64_t marched;
  /** ... of which the vertex pairs or the separating axis of the query before decided. */
  uint64_t coherent;
  /** ... of which Gilbert-Johnson-Keerthi in floating point decided. */
  uint64_t fallback;
  /** ... of which integer arithmetic decided. */
  uint64_t exact;
  /** Feature pairs visited by Voronoi marching. */
  uint64_t marching_steps;
  /** Iterations of Gilbert-Johnson-Keerthi in floating point. */
  uint64_t fallback_iterations;
  /** Iterations in integer arithmetic. */
  uint64_t exact_iterations;
  /** Pairs at which an approximate query stopped because their interval was narrow enough. */
  uint64_t within_tolerance;
  /** ... of which the step budget ran out. */
  uint64_t budget_spent;
  /**
   * Of the pairs, how many were answered by which level of detail: the coarser one of the two objects', 0 for the objects
   * themselves, also where no geometry was asked; the last entry is for all levels beyond, too.
   */
  uint64_t by_level[8];
  /**
   * Sum of `upper - lower` over the pairs that queries about distances answered as SWIFTPROX_OUTCOME_SEPARATED or left
   * SWIFTPROX_OUTCOME_UNDECIDED. Queries of intersection add nothing: their intervals are wide and only prove the verdict.
   */
  double error_spent;
  /** Pairs that bounding spheres decided. */
  uint64_t bounding_spheres;
  /** ... of which balls inside the pieces decided. */
  uint64_t inscribed_spheres;
  /** ... of which neither piece had moved since the same query before: its answer was given again. */
  uint64_t unmoved;
  /** ... of which the pieces had not moved far enough since their last test to be listed. */
  uint64_t out_of_reach;
} swiftprox_scene_statistics;

/**
 * Returns statistics of all queries since the scene was made or swiftprox_scene_reset_statistics was called. On failure
 * error_spent is NaN, all else 0.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_statistics(const struct swiftprox_scene *scene,
                                                struct swiftprox_scene_statistics *statistics);

/**
 * Sets the statistics of a scene to zero.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_reset_statistics(struct swiftprox_scene *scene);

/**
 * Sets for how many pairs of pieces a scene keeps caches. Queries without a max_distance test all pairs. Up to `limit` pairs, each
 * keeps its last answer, in about 150 bytes if there is memory. The next answer is then several times faster. Beyond `limit` only
 * near pairs keep theirs, as with 0. Results and their order stay the same. Default: 1048576 pairs, about 150 MB, from 1448 single
 * pieces.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_kept_pair_limit(struct swiftprox_scene *scene,
                                                     uint64_t limit);

/**
 * Frees memory that a scene keeps for later: the last query's results, which become invalid, and memory of removed pairs. Caches
 * of other pairs stay. The next query allocates what it needs.
 *
 * SWIFTPROX_ERROR_MEMORY: no memory for a smaller list of pairs; nothing has changed.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_shrink(struct swiftprox_scene *scene);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
