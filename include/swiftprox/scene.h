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
 * Adds an object like `original`: with its pieces (shared) and their poses, its pose, fixedness, groups and mask, and all user
 * data, as they are now. All its pairs are active, whatever those of its original are; what pairs remember is not copied. On
 * failure nothing is added and `*id` is null.
 *
 * SWIFTPROX_ERROR_HANDLE: original names no object of this scene. SWIFTPROX_ERROR_LIMIT: more objects than a scene holds.
 * SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_NULL_POINTER: the message names the argument. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_copy_object(struct swiftprox_scene *scene,
                                             struct swiftprox_object_id original,
                                             struct swiftprox_object_id *id);

/**
 * Gives a piece of an object, by its number from 0: a size_t as info's piece_count is, where results and other calls have a
 * uint32_t, so that programs of before run on. The scene owns the share: take one more with swiftprox_shape_retain to keep
 * the shape longer than the object. On failure `*shape` is null.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
 * SWIFTPROX_ERROR_NULL_POINTER: scene or shape is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_piece(const struct swiftprox_scene *scene,
                                           struct swiftprox_object_id id,
                                           size_t piece,
                                           const struct swiftprox_shape **shape);

/**
 * Moves one piece within its object, by its number from 0: `pose` is 12 doubles, row-major [R|T]. The piece is in the world where
 * the object's pose times this one puts it, each of the twelve numbers rounded; its exact body is what these give. Points and
 * features of results are in the piece's own frame. On failure it stays where it is.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
 * SWIFTPROX_ERROR_POSE: the pose is refused, alone or with the object's. SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_NULL_POINTER: scene or pose is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_piece_pose(struct swiftprox_scene *scene,
                                                struct swiftprox_object_id id,
                                                uint32_t piece,
                                                const double *pose);

/**
 * Writes where a piece of an object is in the world, 12 doubles, row-major [R|T]: the pose for which queries answer, as
 * swiftprox_pair_verify takes it. On failure they are NaN.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
 * SWIFTPROX_ERROR_NULL_POINTER: scene or pose is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_piece_pose(const struct swiftprox_scene *scene,
                                                struct swiftprox_object_id id,
                                                uint32_t piece,
                                                double *pose);

/**
 * Sets the number of a piece, which swiftprox_scene_get_piece_user_data gives, and the events of listeners; 0 before. Results name
 * the object and the piece.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
 * SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_piece_user_data(struct swiftprox_scene *scene,
                                                     struct swiftprox_object_id id,
                                                     uint32_t piece,
                                                     uint64_t user_data);

/**
 * Writes the caller's number of a piece, in a time that does not grow with the scene. On failure it is 0.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
 * SWIFTPROX_ERROR_NULL_POINTER: scene or user_data is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_piece_user_data(const struct swiftprox_scene *scene,
                                                     struct swiftprox_object_id id,
                                                     uint32_t piece,
                                                     uint64_t *user_data);

/**
 * A box along the world's axes that contains an object, swept radii included: the corners where all coordinates are least and
 * greatest, three numbers each. It is wider than the object by less than 1e-5 of the radius and the place of each piece; around a
 * piece of more than 512 vertices it is the box of that piece's own turned box. On failure all numbers are NaN.
 *
 * SWIFTPROX_ERROR_HANDLE: the id is null, stale or another scene's. SWIFTPROX_ERROR_NULL_POINTER.
 * SWIFTPROX_ERROR_POISONED.
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
 * From now on queries test these pairs of objects and no others, however near: for a program with a broad phase of its own.
 * `pairs` holds 2 ids for each of the `count`, in any order; what is there twice is tested once. Activation, filters and fixed
 * objects are heeded as ever; objects removed later are in no pair. Pairs that stay keep what they remember. On failure the pairs
 * of before stay.
 *
 * SWIFTPROX_ERROR_HANDLE: an id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: one object twice in a pair. The
 * message says which. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: scene or pairs is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pairs(struct swiftprox_scene *scene,
                                           const struct swiftprox_object_id *pairs,
                                           size_t count);

/**
 * Takes back what swiftprox_scene_set_pairs has set: from now on the scene finds the pairs that are near by itself, as it did
 * before.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
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
 * The distance of a pair of the last query of contacts, or minus how deep it is: one interval through zero, normal and witness
 * points, as of swiftprox_pair_signed_distance. They come from swiftprox_pair_result.answer or swiftprox_contact.depth, at no
 * further search. `number` is the pair's among swiftprox_scene_contacts.contacts. On failure the answer's numbers are NaN.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there are not so many contacts, or the last query was none of contacts with a
 * swiftprox_scene_query.detail. SWIFTPROX_ERROR_NULL_POINTER: scene or answer is null. SWIFTPROX_ERROR_POISONED.
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

/** What has changed since the last query about events. */
typedef struct swiftprox_scene_events {
  /**
   * Pairs of objects that are near and were not, in order of creation. Owned by the scene, valid until its next query about
   * events. Null when began_count is 0.
   */
  const struct swiftprox_object_pair *began;
  /** How many. */
  size_t began_count;
  /**
   * Pairs of objects that were near and are not, those of removed objects and of deactivated pairs among them. Owned and valid
   * as began are. Null when ended_count is 0.
   */
  const struct swiftprox_object_pair *ended;
  /** How many. */
  size_t ended_count;
} swiftprox_scene_events;

/**
 * Which pairs of objects began or ended touching (`distance` 0), or being within a distance, since the last call; the first call
 * lists all that are. Objects are near if any of their pieces are. It is a query as others are: results of queries before end. The
 * scene has one such memory; swiftprox_scene_listen has one for each listener, and tells of contact points. On failure `*events`
 * is empty, and what was near stays remembered.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the distance is negative or NaN. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: scene
 * or events is null. SWIFTPROX_ERROR_POISONED.
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

/** What the queries of a scene did since it was made or swiftprox_scene_reset_statistics was called. */
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
  /** Of the pairs, those that an approximate query stopped at because their interval was narrow enough. */
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
  /** Of the pairs, those whose bounding spheres decided. */
  uint64_t bounding_spheres;
  /** ... of which balls inside the pieces decided. */
  uint64_t inscribed_spheres;
  /** ... of which neither piece had moved since the same query before: its answer was given again. */
  uint64_t unmoved;
  /** ... of which the pieces had not moved far enough since their last test to be listed. */
  uint64_t out_of_reach;
} swiftprox_scene_statistics;

/**
 * What the queries of a scene did since it was made or swiftprox_scene_reset_statistics was called. On failure error_spent is NaN,
 * all else 0.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene or statistics is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_statistics(const struct swiftprox_scene *scene,
                                                struct swiftprox_scene_statistics *statistics);

/**
 * Sets the statistics of a scene to zero.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_reset_statistics(struct swiftprox_scene *scene);

/**
 * Queries without a tolerance are about all pairs of pieces. While these are no more than `limit`, each remembers its last answer,
 * which makes the next one several times faster and takes about 150 bytes, if there is memory for that. Of more than `limit` only
 * near pairs remember theirs. Results and their order are the same. Default: 1048576 pairs, about 150 MB, which 1448
 * single pieces make. 0: none but near pairs.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_kept_pair_limit(struct swiftprox_scene *scene,
                                                     uint64_t limit);

/**
 * Gives back the memory that a scene keeps for later: that of the last query's results, which end, and that of pairs that are no
 * more. What the others remember stays. The next query takes anew what it needs.
 *
 * SWIFTPROX_ERROR_MEMORY: there is not enough for a smaller list of pairs; nothing has changed.
 * SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
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
