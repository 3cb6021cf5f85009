/*
 * swiftprox. Compounds: bodies of several convex pieces, with a tree over them. The conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_COMPOUND_H
#define SWIFTPROX_COMPOUND_H

#include "geometry.h"
#include "motion.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_compound Compounds
 * @{
 */

/**
 * A body of several convex pieces: their union. Immutable, shared by any number of owners.
 *
 * A piece at the identity is exactly where the pose of the compound takes it. Any other is at the product of both poses, each
 * number rounded, as pieces of an object in a scene are.
 */
typedef struct swiftprox_compound swiftprox_compound;

/**
 * Creates a compound: the union of convex pieces, which may overlap. The caller owns it and gives it back with
 * swiftprox_compound_release. It takes its own share of each shape, so the caller may release its shares at once.
 *
 * `poses` holds 12 numbers for each piece, row by row: its pose in the compound. Null means that all are at the identity. Such a
 * piece is exactly where the pose of the compound takes it. Others are at the product of both poses, each number rounded.
 *
 * On failure `*compound` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: no pieces. SWIFTPROX_ERROR_LIMIT: more than 2^20.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_create(const struct swiftprox_shape *const *shapes,
                                           const double *poses,
                                           size_t count,
                                           const struct swiftprox_compound **compound);

/**
 * Creates a compound from a mesh that need not be convex or connected. The caller owns it and gives it back with
 * swiftprox_compound_release. `tolerance` is relative to the bounding-box diagonal, and decides what the pieces are:
 *
 * 0: those that swiftprox_mesh_decompose cuts the surface into. They keep the surface exactly, and the mesh's numbers as features.
 * They leave hollows: a body that is wholly inside may touch no piece.
 *
 * 1e-4 to 1: solid pieces. Together they hold the body, up to 1e-8 of the diagonal. No point of a piece is farther from the body
 * than the tolerance. Features are the pieces' own. Edges may have more than two faces, and faces turned the wrong way are turned,
 * as long as inside and outside can be told. Time grows as the surface over the square of the tolerance.
 *
 * swiftprox_compound_get_piece gives the pieces, as for a scene. `progress` may be null. On failure `*compound` is null.
 *
 * Same errors as swiftprox_mesh_decompose. With a tolerance above 0 also SWIFTPROX_ERROR_MESH: an edge has an odd number of faces,
 * or inside and outside cannot be told at it; and SWIFTPROX_ERROR_LIMIT: more than 2,048 cells are needed. Messages say the cure.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_create_from_mesh(struct swiftprox_mesh mesh,
                                                     double tolerance,
                                                     swiftprox_progress_callback progress,
                                                     void *progress_user,
                                                     const struct swiftprox_compound **compound);

/**
 * Adds a share of a compound, and returns the compound. Give each share back with swiftprox_compound_release. Safe from any
 * thread. For null it returns null.
 *
 * Experimental.
 */
const struct swiftprox_compound *swiftprox_compound_retain(const struct swiftprox_compound *compound);

/**
 * Gives back one share of a compound; the last one frees it and its shares of shapes. Safe from any thread. Null is ignored.
 *
 * Experimental.
 */
void swiftprox_compound_release(const struct swiftprox_compound *compound);

/** Properties of a compound. */
typedef struct swiftprox_compound_info {
  /** Number of pieces. */
  size_t piece_count;
  /** Its memory in bytes, without its shapes. */
  size_t bytes;
} swiftprox_compound_info;

/**
 * Writes the properties of a compound. On failure all are 0.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_get_info(const struct swiftprox_compound *compound,
                                             struct swiftprox_compound_info *info);

/**
 * Writes a piece of a compound: its shape, which lives as long as the compound (retain it to keep it longer), and 12 numbers for
 * its pose there. On failure the shape is null and the pose NaN.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such piece.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_get_piece(const struct swiftprox_compound *compound,
                                              uint32_t piece,
                                              const struct swiftprox_shape **shape,
                                              double *pose);

/** @} */

/**
 * @defgroup swiftprox_compound_query Pairs of compounds
 * @{
 */

/** A compound at a pose, an argument of queries by value. Both pointers are only read during the call. */
typedef struct swiftprox_placed_compound {
  /** The compound. */
  const struct swiftprox_compound *compound;
  /** 12 doubles, the row-major 3x4 matrix [R|T]. */
  const double *pose;
} swiftprox_placed_compound;

/**
 * The cache of a pair of compounds, owned by the caller; 13 kB. Zero it before the first query; any bytes are safe. It affects
 * speed, which of several equally near pieces is named, and how tight a verdict's `lower` is; never the verdict.
 */
typedef struct swiftprox_compound_cache {
  /** Opaque. */
  uint32_t words[3328];
} swiftprox_compound_cache;

/** The answer to a query of two compounds. */
typedef struct swiftprox_compound_answer {
  /**
   * Outcome and interval are those of the compounds. The rest is about two of their pieces: the nearest, or some that intersect.
   * Local points are in the frames of these pieces, features in their numbering. Points, normal and features stay unset where no
   * two pieces are named.
   */
  struct swiftprox_pair_answer answer;
  /** The piece of compound 1; its number of pieces where none is named. */
  uint32_t piece1;
  /** The piece of compound 2, likewise. */
  uint32_t piece2;
} swiftprox_compound_answer;

/**
 * Computes the distance of two compounds: the least of any two pieces, with an interval that holds it. Witness points, normal and
 * features are those of the nearest two pieces, which are named. Intersecting compounds have distance 0 and name two pieces that
 * intersect, with the proof.
 *
 * `cache` and `config` are as for swiftprox_pair_distance. Beyond config->max_distance no pieces are named. On failure the
 * answer is reset and its outcome is SWIFTPROX_OUTCOME_NONE; SWIFTPROX_ERROR_BUG also resets the cache.
 *
 * SWIFTPROX_ERROR_POSE: also where the product of a compound's and a piece's pose is refused. SWIFTPROX_ERROR_INVALID_ARGUMENT: a
 * member of config is out of range.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_distance(struct swiftprox_placed_compound object1,
                                             struct swiftprox_placed_compound object2,
                                             struct swiftprox_compound_cache *cache,
                                             const struct swiftprox_pair_config *config,
                                             struct swiftprox_compound_answer *answer);

/**
 * Decides only whether two compounds intersect, and names two pieces that do. Compounds that are apart get lower > 0, an infinite
 * upper and no pieces; with a finite config->max_distance those within it get two pieces, and others
 * SWIFTPROX_OUTCOME_BEYOND. Same arguments and errors as swiftprox_compound_distance.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_intersection(struct swiftprox_placed_compound object1,
                                                 struct swiftprox_placed_compound object2,
                                                 struct swiftprox_compound_cache *cache,
                                                 const struct swiftprox_pair_config *config,
                                                 struct swiftprox_compound_answer *answer);

/** The signed distance of two compounds. */
typedef struct swiftprox_compound_signed_distance_answer {
  /** Outcome and interval are those of the compounds, the rest is about two of their pieces, with the least signed distance. */
  struct swiftprox_signed_distance distance;
  /** The piece of compound 1; its number of pieces where none is named. */
  uint32_t piece1;
  /** The piece of compound 2, likewise. */
  uint32_t piece2;
} swiftprox_compound_signed_distance_answer;

/**
 * Computes the least signed distance of any two pieces: how far compounds are apart, or minus how deep the deepest two pieces are
 * in each other. The translation that parts intersecting compounds is at least as long as that depth, and may be longer: to free
 * two pieces may push others into each other. Same arguments and errors as swiftprox_compound_distance.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_signed_distance(struct swiftprox_placed_compound object1,
                                                    struct swiftprox_placed_compound object2,
                                                    struct swiftprox_compound_cache *cache,
                                                    const struct swiftprox_pair_config *config,
                                                    struct swiftprox_compound_signed_distance_answer *answer);

/**
 * How deep two compounds are in each other: the length of the least translation of compound 1 at which no two pieces overlap, so
 * that a plane has one on either side. Touching is allowed.
 */
typedef struct swiftprox_compound_depth_answer {
  /** The signed distance of the compounds: whether they meet, which two pieces are the deepest in each other, and where. */
  struct swiftprox_compound_signed_distance_answer deepest;
  /** Lower end of the rigorous interval: the depth of the deepest two pieces. 0 where the compounds are apart or touch. */
  double lower;
  /**
   * Upper end: the translation is no longer. 0 only where the compounds are apart or touch; infinite where none was found:
   * of poses at the limit of what is accepted, and of bodies near the largest doubles.
   */
  double upper;
  /**
   * A translation in the world that frees: added to the pose of compound 1, each number rounded, it leaves no two pieces that
   * overlap. NaN where none was found.
   */
  double translation[3];
} swiftprox_compound_depth_answer;

/**
 * Computes how deep two compounds are in each other: the length of the least translation of object 1 at which no two pieces
 * overlap. The answer is an interval, from the depth of the deepest two pieces to the length of a translation that is proved to
 * free, and that translation. It need not be the least. No cache: equal arguments give equal answers.
 *
 * `config` may be null. The search ends early where upper - lower is within one of its errors, or after step_budget
 * translations; the library's own limit is 2,000. Same errors as swiftprox_compound_signed_distance. On failure the answer is
 * reset, and its deepest.distance.outcome is SWIFTPROX_OUTCOME_NONE.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_depth(struct swiftprox_placed_compound object1,
                                          struct swiftprox_placed_compound object2,
                                          const struct swiftprox_depth_config *config,
                                          struct swiftprox_compound_depth_answer *answer);

/**
 * Checks an answer of swiftprox_compound_depth independently of the search that found it. SWIFTPROX_OK: it is right for these
 * compounds and poses.
 *
 * The named pieces are checked as by swiftprox_pair_depth_verify, compounds that are apart as by swiftprox_compound_verify. No two
 * pieces are deeper. The translation, which is no longer than upper, is proved to leave each two pieces apart or touching, by
 * their boxes or one by one. Errors are those of these two.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_depth_verify(struct swiftprox_placed_compound object1,
                                                 struct swiftprox_placed_compound object2,
                                                 const struct swiftprox_compound_depth_answer *answer);

/** A contact of two compounds: the manifold of two of their pieces. */
typedef struct swiftprox_compound_contact {
  /** The manifold of the two pieces. */
  struct swiftprox_manifold manifold;
  /** The first of its points among all of the answer. */
  uint32_t first_point;
  /** The piece of compound 1. */
  uint32_t piece1;
  /** The piece of compound 2. */
  uint32_t piece2;
} swiftprox_compound_contact;

/** Room for the contacts of two compounds. The caller owns the arrays, which may be null if their capacity is 0. */
typedef struct swiftprox_compound_contacts {
  /** Receives as many contacts as fit. */
  struct swiftprox_compound_contact *contacts;
  /** Room for contacts. */
  size_t contact_capacity;
  /** Receives as many points as fit. */
  struct swiftprox_manifold_point *points;
  /** Room for points. */
  size_t point_capacity;
  /** Receives the number of contacts found; 0 on failure. */
  size_t contact_count;
  /** Receives the number of points found; 0 on failure. */
  size_t point_count;
} swiftprox_compound_contacts;

/**
 * Finds the contacts of two compounds: the manifold of each two pieces up to config->max_distance apart, sorted by pieces, each as
 * swiftprox_pair_manifold finds it. Points of contact c begin at its first_point; there are manifold.point_count. A body on a seam
 * of two pieces has contacts with both.
 *
 * On failure the counts are 0; contacts and points are unchanged. Same errors as swiftprox_pair_manifold. SWIFTPROX_ERROR_LIMIT: a
 * capacity is larger than memory.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_get_contacts(struct swiftprox_placed_compound object1,
                                                 struct swiftprox_placed_compound object2,
                                                 const struct swiftprox_manifold_config *config,
                                                 struct swiftprox_compound_contacts *contacts);

/**
 * Checks an answer of swiftprox_compound_distance or swiftprox_compound_intersection independently of the search that found it.
 * SWIFTPROX_OK: it is right for these compounds and poses.
 *
 * The pieces that are named are checked as by swiftprox_pair_verify. Unless they intersect, every two pieces are proved to be at
 * least lower apart, by their boxes or one by one. That boxes contain their pieces is not checked again. Same errors as
 * swiftprox_pair_verify; SWIFTPROX_ERROR_INVALID_ARGUMENT also for numbers of pieces that the compounds do not have.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_verify(struct swiftprox_placed_compound object1,
                                           struct swiftprox_placed_compound object2,
                                           const struct swiftprox_compound_answer *answer);

/** @} */

/**
 * @defgroup swiftprox_compound_cast Casts of compounds
 * @{
 */

/** A compound and how it moves, an argument by value. Both pointers are only read during the call. */
typedef struct swiftprox_moving_compound {
  /** The compound. */
  const struct swiftprox_compound *compound;
  /** Its motion. */
  const struct swiftprox_motion *motion;
} swiftprox_moving_compound;

/** The answer to a cast of two compounds. */
typedef struct swiftprox_compound_cast_answer {
  /**
   * Outcome, times and clearance are those of the compounds. Upper, contact and proof are about two of their pieces: those that
   * meet first or, where none do, those that end the cast. Local points are in the frames of these pieces.
   */
  struct swiftprox_cast_answer answer;
  /** The piece of compound 1; its number of pieces where none is named. */
  uint32_t piece1;
  /** The piece of compound 2, likewise. */
  uint32_t piece2;
} swiftprox_compound_cast_answer;

/**
 * Decides whether two moving compounds stay farther apart than config->max_distance, or when they first do not. Guarantees and
 * members are as for swiftprox_pair_cast; the step budget is for each two pieces. A hit names the two pieces that meet first, as
 * far as intervals of time tell.
 *
 * `cache` may be shared with swiftprox_compound_distance. It affects speed and the choice of times within the guaranteed bounds.
 * On failure the answer is reset and its outcome is SWIFTPROX_CAST_OUTCOME_NONE; SWIFTPROX_ERROR_BUG also resets the cache. Same
 * errors as swiftprox_pair_cast. SWIFTPROX_ERROR_INVALID_ARGUMENT: also if config->ignores_parting is set.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_cast(struct swiftprox_moving_compound object1,
                                         struct swiftprox_moving_compound object2,
                                         struct swiftprox_compound_cache *cache,
                                         const struct swiftprox_cast_config *config,
                                         struct swiftprox_compound_cast_answer *answer);

/**
 * Checks an answer of swiftprox_compound_cast for the same motions and config, independently of its search. SWIFTPROX_OK: it is
 * right.
 *
 * The pieces that are named are checked as by swiftprox_pair_cast_verify. All others are proved to be farther apart than
 * max_distance, and at least clearance, up to time_lower, by their boxes or one by one. That boxes contain their pieces is not
 * checked again. Same errors as swiftprox_pair_cast_verify; SWIFTPROX_ERROR_INVALID_ARGUMENT also for numbers of pieces that the
 * compounds do not have.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_cast_verify(struct swiftprox_moving_compound object1,
                                                struct swiftprox_moving_compound object2,
                                                const struct swiftprox_cast_config *config,
                                                const struct swiftprox_compound_cast_answer *answer);

/** @} */

/**
 * @defgroup swiftprox_compound_single Rays and points against compounds
 * @{
 */

/** The part of a ray that is in a compound. The number of pieces stands for none. */
typedef struct swiftprox_compound_ray_answer {
  /**
   * Outcome and entry are those of the compound. Exit, normal and feature are those of the piece that the ray enters first, or
   * that it begins in: it may leave that and be in another.
   */
  struct swiftprox_ray_answer answer;
  /** That piece. */
  uint32_t piece;
} swiftprox_compound_ray_answer;

/**
 * Casts a ray at a compound and finds where it first enters a piece, as swiftprox_shape_cast_ray does for each. Same errors. On
 * failure the answer is reset.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_cast_ray(struct swiftprox_placed_compound object,
                                             const struct swiftprox_ray *ray,
                                             struct swiftprox_compound_ray_answer *answer);

/** Position of a point relative to a compound. The number of pieces stands for none. */
typedef struct swiftprox_compound_point_answer {
  /**
   * Inside: in the interior of a piece. On: on the surface of one and in the interior of none, be it where two pieces join.
   * Distance and all else are those of the piece with the least signed distance. Inside a compound that is how deep the point
   * is in one piece: its surface is at least as far.
   */
  struct swiftprox_point_answer answer;
  /** That piece. */
  uint32_t piece;
} swiftprox_compound_point_answer;

/**
 * Locates a point of the world relative to a compound: by the piece with the least signed distance, as
 * swiftprox_shape_locate_point does for each. Same errors. On failure the answer is reset.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_compound_locate_point(struct swiftprox_placed_compound object,
                                                 const double *point,
                                                 struct swiftprox_compound_point_answer *answer);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
