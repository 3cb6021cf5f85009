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
   * (swiftprox_shape_create_from_levels). No shape can be asked to build them.
   */
  SWIFTPROX_HIERARCHY_GIVEN = 4,
  /**
   * Quadric ones by the default options for bodies of 30,000 vertices and more, made by the first query that goes through them;
   * none for smaller bodies.
   */
  SWIFTPROX_HIERARCHY_AUTOMATIC = 5
} swiftprox_hierarchy;

/** Which look-up table a body has. */
typedef enum swiftprox_lookup SWIFTPROX_INT32 {
  /** Shells if the body has enough vertices for them to pay, else none: beside a body with shells all vertices are looked at. */
  SWIFTPROX_LOOKUP_AUTOMATIC = 0,
  /** None. */
  SWIFTPROX_LOOKUP_NONE = 1,
  /** Vertices near points on several spheres, looked up on both bodies for what was found on the other. */
  SWIFTPROX_LOOKUP_SHELLS = 2,
  /** That of Ehmann & Lin (2000, section 4.6), looked up in the direction of the other body's centre of mass. */
  SWIFTPROX_LOOKUP_SPHERICAL = 3
} swiftprox_lookup;

/**
 * Which levels of detail and which look-up table a shape is made with, for swiftprox_shape_options.tuning. Begin with
 * SWIFTPROX_SHAPE_TUNING_DEFAULT, then change what should differ.
 */
typedef struct swiftprox_shape_tuning {
  /** Set by SWIFTPROX_SHAPE_TUNING_DEFAULT. */
  size_t struct_size;
  /** How levels of detail are made. Default: automatic. */
  swiftprox_hierarchy hierarchy;
  /**
   * Which table says where a query starts when the last one of the pair tells nothing. It is made by the first query that looks
   * into it: less than a quarter of the time that making the shape took. A body smaller than 2^-200 or larger than 2^200 has
   * none. Default: automatic.
   */
  swiftprox_lookup lookup;
  /**
   * The fraction of the triangles that a level has left of those of the next finer one, between 0 and 1, both exclusive; less
   * where that many would have more features than faces of many corners have. Default: 0.25. This and the two that follow
   * do not count for automatic levels.
   */
  double decimation;
  /** No level has fewer triangles. Default: 50. */
  size_t minimum_triangles;
  /** No more levels than these. Default: 32. */
  size_t most_levels;
  /** Radius of the sphere of a spherical table's sample points as a multiple of the body's radius, at least 1. Default: 2. */
  double lookup_radius_factor;
  /**
   * Resolution of the table: of shells, cells along a side of the square that all directions are mapped to, a power of two
   * from 4 to 512; of a spherical table, increments from pole to pole, 2 to 512 (32, 16, 8: 5.625, 11.25, 22.5 degrees).
   * Default: 0, which means what the number of vertices asks for, or 32.
   */
  uint32_t lookup_resolution;
} swiftprox_shape_tuning;
/** What the header calls its default. */

/** Begins a swiftprox_shape_tuning: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_SHAPE_TUNING_DEFAULT \
  {sizeof(swiftprox_shape_tuning), SWIFTPROX_HIERARCHY_AUTOMATIC, SWIFTPROX_LOOKUP_AUTOMATIC, 0.25, 50, 32, 2, 0}

/**
 * Which levels of detail and which look-up table a shape has. Set struct_size to sizeof(swiftprox_shape_tuning_info) before asking
 * for it.
 */
typedef struct swiftprox_shape_tuning_info {
  /** Set by the caller. */
  size_t struct_size;
  /** How the levels of detail are made. */
  swiftprox_hierarchy hierarchy;
  /** The look-up table that the shape has, never SWIFTPROX_LOOKUP_AUTOMATIC. */
  swiftprox_lookup lookup;
  /**
   * The number of levels of detail, the body itself not counted; they are numbered from 1, the finest, on, and the body is
   * level 0. Automatic ones are made by the first query that goes through them: 0 until then.
   */
  size_t level_count;
  /** Of swiftprox_shape_info.bytes, what the levels take, with their look-up tables once queries have made these. */
  size_t level_bytes;
  /**
   * Of swiftprox_shape_info.bytes, what the table takes, and maps of the support function: 0 until a query, or the making of
   * levels, looks into the table, which makes it; of maps until an approximate distance does. Those of levels are the levels'.
   */
  size_t lookup_bytes;
  /** The table's resolution, as in swiftprox_shape_tuning; 0 without one. */
  uint32_t lookup_resolution;
} swiftprox_shape_tuning_info;

/**
 * Says which levels of detail and which look-up table a shape has: set info->struct_size to sizeof(swiftprox_shape_tuning_info)
 * first. On failure all is 0.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: shape or info is null. SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is unknown.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_tuning_info(const struct swiftprox_shape *shape,
                                                 struct swiftprox_shape_tuning_info *info);

/** A polygon mesh in the caller's arrays, as swiftprox_shape_create_from_mesh takes it. */
typedef struct swiftprox_mesh {
  /** 3 * vertex_count coordinates. */
  const double *vertices;
  /** The number of vertices. */
  size_t vertex_count;
  /** The 0-based vertex numbers of all faces, one face after the other. */
  const uint32_t *indices;
  /** The number of vertices of each face, or null when all are triangles. */
  const uint32_t *valences;
  /** The number of faces. */
  size_t face_count;
} swiftprox_mesh;

/**
 * Makes a shape with levels of detail that the caller gives; the caller owns it and gives it back with swiftprox_shape_release.
 * The finest level comes first: `levels[0]` is the body itself, as
 * swiftprox_shape_create_from_mesh takes it; of each further one the convex hull of its vertices counts (faces are not looked at
 * and may be left out), moved so that its centre of mass falls on that of the next finer level and scaled so that it barely
 * bounds the body. The arrays are copied. options->tuning->hierarchy is to be SWIFTPROX_HIERARCHY_NONE or automatic; the input
 * transform goes for all levels.
 *
 * On failure `*shape` is null. `options` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_MESH: the body breaks the contract of swiftprox_shape_create_from_mesh, or a level has no interior; the message
 * names it. SWIFTPROX_ERROR_CANCELLED: options->progress said so. SWIFTPROX_ERROR_LIMIT: a count does not fit 32 bits.
 * SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_INVALID_ARGUMENT, SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_levels(const struct swiftprox_mesh *levels,
                                                    size_t level_count,
                                                    const struct swiftprox_shape_options *options,
                                                    const struct swiftprox_shape **shape);

/** What a level of detail is. Set struct_size to sizeof(swiftprox_level_info) before asking for it. */
typedef struct swiftprox_level_info {
  /** Set by the caller. */
  size_t struct_size;
  /** Vertices of the level's hull. */
  size_t vertex_count;
  /** Edges between faces that are not coplanar. */
  size_t edge_count;
  /** Faces, coplanar triangles counted as one. */
  size_t face_count;
  /** Triangles of the level's hull. */
  size_t triangle_count;
  /**
   * An upper bound, rounding included, of the largest distance of a point of the level from the body; 0 for level 0, the
   * body.
   */
  double deviation;
  /** Memory that the level holds, in bytes. */
  size_t bytes;
} swiftprox_level_info;

/**
 * Says what a level of detail is: `level` is from 0, the body itself, to swiftprox_shape_tuning_info.level_count, the coarsest.
 * Set info->struct_size to sizeof(swiftprox_level_info) first. On failure the deviation is NaN, all else 0.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level. SWIFTPROX_ERROR_NULL_POINTER: shape or info is null.
 * SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is unknown.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_level_info(const struct swiftprox_shape *shape,
                                                size_t level,
                                                struct swiftprox_level_info *info);

/**
 * Copies the vertices of a level of detail, in the local frame: `level` is from 0, the body itself, to
 * swiftprox_shape_tuning_info.level_count; `capacity` is how many `vertices` has room for (3 coordinates each), at least
 * swiftprox_level_info.vertex_count. For bodies far from their own origin the coordinates are rounded by a unit in the last place.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level, or capacity is too small; nothing is written.
 * SWIFTPROX_ERROR_NULL_POINTER: shape or vertices is null.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_level_vertices(const struct swiftprox_shape *shape,
                                                     size_t level,
                                                     double *vertices,
                                                     size_t capacity);

/**
 * Copies the triangles of a level of detail, 3 corners each, counter-clockwise seen from outside, as places in what
 * swiftprox_shape_copy_level_vertices gives; `capacity` is how many triangles `corners` has room for, at least
 * swiftprox_level_info.triangle_count.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level, or capacity is too small; nothing is written.
 * SWIFTPROX_ERROR_NULL_POINTER: shape or corners is null.
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
 * Where queries start and which levels of detail they go through, for swiftprox_pair_config.tuning and
 * swiftprox_scene_query.tuning. It changes how fast an answer comes, never the verdict. Begin with SWIFTPROX_PAIR_TUNING_DEFAULT,
 * then change what should differ.
 */
typedef struct swiftprox_pair_tuning {
  /** Set by SWIFTPROX_PAIR_TUNING_DEFAULT. */
  size_t struct_size;
  /** Where marching starts. Default: the automatic choice. */
  swiftprox_start start;
  /** Which levels of detail queries go through. Default: the automatic choice. */
  swiftprox_levels levels;
  /** How they go from level to level. Default: the adaptive way. */
  swiftprox_refinement refinement;
} swiftprox_pair_tuning;
/** What the header calls its default. */

/** Begins a swiftprox_pair_tuning: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_PAIR_TUNING_DEFAULT \
  {sizeof(swiftprox_pair_tuning), SWIFTPROX_START_AUTOMATIC, SWIFTPROX_LEVELS_AUTOMATIC, SWIFTPROX_REFINEMENT_ADAPTIVE}

/** @} */

#ifdef __cplusplus
}
#endif

#endif
