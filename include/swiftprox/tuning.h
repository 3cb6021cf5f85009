/*
 * swiftprox. Levels of detail and look-up tables, for whoever measures. What is here changes how long making a shape and answering
 * a query take, and what they take of memory. It never changes a verdict. The conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_TUNING_H
#define SWIFTPROX_TUNING_H

#include "../swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_shape_tuning Levels of detail and look-up tables of a shape
 * @{
 */

/** How the levels of a body are made. */
typedef enum swiftprox_hierarchy SWIFTPROX_INT32 {
  /** There are none. */
  SWIFTPROX_HIERARCHY_NONE = 0,
  /** Simplified by quadric error (Garland & Heckbert 1997), then translated and scaled until they contain the body. */
  SWIFTPROX_HIERARCHY_QUADRIC = 1,
  /** Dobkin and Kirkpatrick's, without sharp vertices, scaled about the centre of mass and drawn back vertex by vertex. */
  SWIFTPROX_HIERARCHY_DOBKIN_KIRKPATRICK = 2,
  /** Cut out of a box by planes that touch the body: tight on thin bodies, too. */
  SWIFTPROX_HIERARCHY_OUTER_CUTS = 3,
  /**
   * The caller's, translated and scaled until they contain the body: those of a shape made from levels
   * (swiftprox_shape_create_from_levels). No shape can build them.
   */
  SWIFTPROX_HIERARCHY_GIVEN = 4,
  /**
   * Quadric ones by the default options for bodies of 30,000 vertices and more, made by the first query that goes through them;
   * none for smaller bodies.
   */
  SWIFTPROX_HIERARCHY_AUTOMATIC = 5
} swiftprox_hierarchy;

/** The look-up table of a body. */
typedef enum swiftprox_lookup SWIFTPROX_INT32 {
  /** Shells if the body has enough vertices for them to pay, else none: beside a body with shells all vertices are looked at. */
  SWIFTPROX_LOOKUP_AUTOMATIC = 0,
  /** None. */
  SWIFTPROX_LOOKUP_NONE = 1,
  /** Vertices near points on several spheres, looked up on both bodies for the vertex found on the other. */
  SWIFTPROX_LOOKUP_SHELLS = 2,
  /** That of Ehmann & Lin (2000, section 4.6), looked up in the direction of the other body's centre of mass. */
  SWIFTPROX_LOOKUP_SPHERICAL = 3
} swiftprox_lookup;

/**
 * Levels of detail and look-up table of a new shape, for swiftprox_shape_options.tuning. Initialise with
 * SWIFTPROX_SHAPE_TUNING_DEFAULT.
 */
typedef struct swiftprox_shape_tuning {
  /** Set by SWIFTPROX_SHAPE_TUNING_DEFAULT. */
  size_t struct_size;
  /** How to make levels of detail. Default: automatic. */
  swiftprox_hierarchy hierarchy;
  /**
   * The table of starting points for queries with a cold cache. The first query that needs it makes it, in less than a quarter
   * of the time of making the shape. Bodies smaller than 2^-200 or larger than 2^200 have none. Default: automatic.
   */
  swiftprox_lookup lookup;
  /**
   * Fraction of triangles that each level keeps from the next finer one, strictly between 0 and 1. Faces with many corners may
   * lower it. Default: 0.25. Automatic levels ignore this and the two members below.
   */
  double decimation;
  /** The least number of triangles in a level. Default: 50. */
  size_t minimum_triangles;
  /** The largest number of levels. Default: 32. */
  size_t most_levels;
  /** For a spherical table: radius of the sphere of sample points as a multiple of the body's radius, at least 1. Default: 2. */
  double lookup_radius_factor;
  /**
   * Resolution of the table. Shells: cells along a side of the square of directions, a power of two from 4 to 512. Spherical:
   * increments from pole to pole, 2 to 512 (32 means 5.625 degrees). Default: 0, chosen by the number of vertices, or 32.
   */
  uint32_t lookup_resolution;
} swiftprox_shape_tuning;

/** Begins a swiftprox_shape_tuning: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_SHAPE_TUNING_DEFAULT \
  {sizeof(swiftprox_shape_tuning), SWIFTPROX_HIERARCHY_AUTOMATIC, SWIFTPROX_LOOKUP_AUTOMATIC, 0.25, 50, 32, 2, 0}

/** Levels of detail and look-up table of a shape. Set struct_size to sizeof(swiftprox_shape_tuning_info) before the call. */
typedef struct swiftprox_shape_tuning_info {
  /** Set by the caller. */
  size_t struct_size;
  /** How the levels of detail are made. */
  swiftprox_hierarchy hierarchy;
  /** The look-up table, never SWIFTPROX_LOOKUP_AUTOMATIC. */
  swiftprox_lookup lookup;
  /**
   * Number of levels of detail without the body, which is level 0. Level 1 is the finest. Automatic levels count after the first
   * query that uses them.
   */
  size_t level_count;
  /** The part of swiftprox_shape_info.bytes for levels, including their look-up tables once made. */
  size_t level_bytes;
  /**
   * The part of swiftprox_shape_info.bytes for the shape's table and support maps. The table is made when a query or the making
   * of levels needs it; maps when an approximate distance does. Those of levels are in level_bytes.
   */
  size_t lookup_bytes;
  /** The table's resolution as in swiftprox_shape_tuning; 0 without a table. */
  uint32_t lookup_resolution;
} swiftprox_shape_tuning_info;

/**
 * Writes which levels of detail and look-up table a shape has. Set info->struct_size to sizeof(swiftprox_shape_tuning_info) first.
 * On failure all members are 0.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_tuning_info(const struct swiftprox_shape *shape,
                                                 struct swiftprox_shape_tuning_info *info);

/**
 * Creates a shape with the caller's levels of detail, finest first. Release it with swiftprox_shape_release. The arrays are
 * copied. `levels[0]` is the body, as for swiftprox_shape_create_from_mesh. Each other level is the convex hull of its vertices;
 * its faces are ignored. It is moved to the centre of mass of the next finer level and scaled until it bounds the body.
 *
 * options->tuning->hierarchy must be SWIFTPROX_HIERARCHY_NONE or automatic. The input transform applies to all levels.
 *
 * On failure `*shape` is null. SWIFTPROX_ERROR_MESH: the body breaks the rules of swiftprox_shape_create_from_mesh, or a level has
 * no interior; the message names it.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_levels(const struct swiftprox_mesh *levels,
                                                    size_t level_count,
                                                    const struct swiftprox_shape_options *options,
                                                    const struct swiftprox_shape **shape);

/** Properties of a level of detail. Set struct_size to sizeof(swiftprox_level_info) before the call. */
typedef struct swiftprox_level_info {
  /** Set by the caller. */
  size_t struct_size;
  /** Vertices of the level's hull. */
  size_t vertex_count;
  /** Edges between faces that are not coplanar. */
  size_t edge_count;
  /** Faces; coplanar triangles count as one. */
  size_t face_count;
  /** Triangles of the level's hull. */
  size_t triangle_count;
  /** Upper bound of the largest distance of the level's points from the body, rounding included; 0 for level 0, the body. */
  double deviation;
  /** Memory of the level in bytes. */
  size_t bytes;
} swiftprox_level_info;

/**
 * Writes the properties of a level of detail. `level` is from 0, the body, to swiftprox_shape_tuning_info.level_count, the
 * coarsest. Set info->struct_size to sizeof(swiftprox_level_info) first. On failure the deviation is NaN, all else 0.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_level_info(const struct swiftprox_shape *shape,
                                                size_t level,
                                                struct swiftprox_level_info *info);

/**
 * Copies the vertices of a level of detail in the local frame, 3 coordinates each. `level` is from 0, the body, to
 * swiftprox_shape_tuning_info.level_count. `capacity` is the room in vertices, at least swiftprox_level_info.vertex_count. Bodies
 * far from their origin have coordinates rounded by one unit in the last place.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level, or capacity is too small; nothing is written.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_level_vertices(const struct swiftprox_shape *shape,
                                                     size_t level,
                                                     double *vertices,
                                                     size_t capacity);

/**
 * Copies the triangles of a level of detail: 3 corners each, counter-clockwise seen from outside, as indices into the vertices of
 * swiftprox_shape_copy_level_vertices. `capacity` is the room in triangles, at least swiftprox_level_info.triangle_count.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level, or capacity is too small; nothing is written.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_level_triangles(const struct swiftprox_shape *shape,
                                                      size_t level,
                                                      uint32_t *corners,
                                                      size_t capacity);

/** @} */

/**
 * @defgroup swiftprox_pair_tuning Where queries start, and the levels that they go through
 * @{
 */

/** Where marching starts. It changes how fast an answer comes, never the verdict. */
typedef enum swiftprox_start SWIFTPROX_INT32 {
  /** At the features of the last query while the pair moves little, else where the look-up tables of the shapes say. */
  SWIFTPROX_START_AUTOMATIC = 0,
  /** At the features of the last query whenever there are any. */
  SWIFTPROX_START_CACHE = 1,
  /**
   * Where the look-up tables say (Ehmann & Lin 2000, section 4.6); afresh unless both shapes have tables of one kind, or one
   * has shells and the other so few vertices that it needs none.
   */
  SWIFTPROX_START_TABLE = 2,
  /** Afresh: at the vertices farthest along the line between the bodies. */
  SWIFTPROX_START_COLD = 3
} swiftprox_start;

/** Which levels of detail a query goes through, of those that the shapes have. */
typedef enum swiftprox_levels SWIFTPROX_INT32 {
  /**
   * Those that save time: of large bodies, for approximate queries that they may answer (60,000 vertices, both together) and
   * for intersection (200,000). Smaller bodies themselves answer about as quickly, from their look-up tables. The first such
   * query of a shape with automatic levels makes them, which takes about twice as long as making the shape did.
   * Before that, approximate queries about bodies of 500 vertices and more look up maps of their support functions, where the
   * error is one in a hundred of the radius or more (one in four hundred from 5,000 vertices on).
   */
  SWIFTPROX_LEVELS_AUTOMATIC = 0,
  /** None. */
  SWIFTPROX_LEVELS_NONE = 1,
  /** All, whatever is asked (Ehmann & Lin 2000). */
  SWIFTPROX_LEVELS_ALL = 2
} swiftprox_levels;

/** Which object goes to a finer level, and by how many, when a pair of levels is too coarse. */
typedef enum swiftprox_refinement SWIFTPROX_INT32 {
  /** The object whose level has the larger deviation, by one. */
  SWIFTPROX_REFINEMENT_ADAPTIVE = 0,
  /** One object by one: that at the coarser level, object 1 where both are at the same. */
  SWIFTPROX_REFINEMENT_SINGLE = 1,
  /** Both by one. */
  SWIFTPROX_REFINEMENT_SINGLE_SINGLE = 2,
  /** Both by two. */
  SWIFTPROX_REFINEMENT_DOUBLE_DOUBLE = 3
} swiftprox_refinement;

/**
 * Start and levels of detail of queries, for swiftprox_pair_config.tuning and swiftprox_scene_query.tuning. It affects speed,
 * never the verdict. Initialise with SWIFTPROX_PAIR_TUNING_DEFAULT.
 */
typedef struct swiftprox_pair_tuning {
  /** Set by SWIFTPROX_PAIR_TUNING_DEFAULT. */
  size_t struct_size;
  /** Where marching starts. Default: the automatic choice. */
  swiftprox_start start;
  /** Which levels of detail queries use. Default: the automatic choice. */
  swiftprox_levels levels;
  /** How queries go from level to level. Default: adaptive. */
  swiftprox_refinement refinement;
} swiftprox_pair_tuning;

/** Begins a swiftprox_pair_tuning: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_PAIR_TUNING_DEFAULT \
  {sizeof(swiftprox_pair_tuning), SWIFTPROX_START_AUTOMATIC, SWIFTPROX_LEVELS_AUTOMATIC, SWIFTPROX_REFINEMENT_ADAPTIVE}

/** @} */

#ifdef __cplusplus
}
#endif

#endif
