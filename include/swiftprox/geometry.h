/*
 * swiftprox. Geometry: what a shape is made of, convex pieces of a mesh, rays, points and support vertices. The conventions are
 * those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_GEOMETRY_H
#define SWIFTPROX_GEOMETRY_H

#include "sets.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_geometry What a shape is made of, and files of shapes
 * @{
 */

/**
 * Copies the vertices of the hull, in the local frame: `capacity` is how many `vertices` has room for (3 coordinates each),
 * at least swiftprox_shape_info.vertex_count. `labels` receives the caller's number of each vertex, or is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is too small; nothing is written. SWIFTPROX_ERROR_NULL_POINTER: shape or vertices is
 * null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_vertices(const struct swiftprox_shape *shape,
                                               double *vertices,
                                               uint32_t *labels,
                                               size_t capacity);

/**
 * Copies the triangles of the hull, 3 corners each, counter-clockwise seen from outside, as places in what
 * swiftprox_shape_copy_vertices gives: `capacity` is how many triangles `corners` has room for, at least
 * swiftprox_shape_info.triangle_count. Faces of more than three sides come as several triangles; a body of dimension 1 or 0 has
 * none.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is too small; nothing is written. SWIFTPROX_ERROR_NULL_POINTER: shape or corners is
 * null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_triangles(const struct swiftprox_shape *shape,
                                                uint32_t *corners,
                                                size_t capacity);

/** A face of a shape's hull: all coplanar triangles, a convex polygon. */
typedef struct swiftprox_face {
  /** Outward, a unit vector up to rounding, in the local frame. */
  double normal[3];
  /** The product of the normal with a corner, rounded: normal * x = offset in the face's plane. */
  double offset;
  /** How many corners the face has. */
  size_t corner_count;
  /** How many of the caller's polygons are merged in it, 1 at least. */
  size_t label_count;
} swiftprox_face;

/**
 * Says what a face of a shape is, by its place from 0 to below swiftprox_shape_info.face_count. `corners` receives its corners,
 * counter-clockwise seen from outside, as places in what swiftprox_shape_copy_vertices gives; `labels` the caller's polygons that
 * are merged in it, ascending, or the face's own number where the hull was made without polygons. Each gets as many as there is
 * room for, and may be null with no room. swiftprox_shape_find_face tells the place of a face of an answer.
 *
 * On failure `*face` is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: the shape has no such face. SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_face(const struct swiftprox_shape *shape,
                                          size_t index,
                                          struct swiftprox_face *face,
                                          uint32_t *corners,
                                          size_t corner_capacity,
                                          uint32_t *labels,
                                          size_t label_capacity);

/**
 * The place of a face, for swiftprox_shape_get_face: of the one that the caller's polygon `label` is a part of, which is the id
 * of a face in an answer. Of several the first. Takes time in proportion to the faces. On failure `*index` is SIZE_MAX.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: no face has the label. SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_find_face(const struct swiftprox_shape *shape,
                                           uint32_t label,
                                           size_t *index);

/**
 * Makes a copy of a shape with every length multiplied by `scale`, a power of two; the caller owns it and gives it back with
 * swiftprox_shape_release. Vertices, levels of detail and distances are exactly those multiplied, and labels are the same. Levels
 * are not built anew, automatic ones are taken over if they are made; what answers rely on is proved and measured again, which
 * takes up to half as long as making the shape did. `progress` learns how far it is and can cancel it, or is null; `progress_user`
 * is handed to it.
 *
 * A shape that is turned or moved needs no copy: objects share it, each with a pose, and so do pieces of one object. At any other
 * scale vertices would be rounded, so such a shape is made anew with swiftprox_shape_options.scale; one that is stretched or
 * mirrored is made from other vertices. On failure `*shape` is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: scale is no positive power of two, or lengths would leave the range of doubles.
 * SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_CANCELLED: progress said so. SWIFTPROX_ERROR_NULL_POINTER: source or shape is null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_scaled(const struct swiftprox_shape *source,
                                               double scale,
                                               swiftprox_progress_callback progress,
                                               void *progress_user,
                                               const struct swiftprox_shape **shape);

/**
 * Saves a shape in a file, replacing what was there: with its levels of detail, except automatic ones, which are made again
 * when they are needed, as the look-up table is. Any machine can load it, with the levels that are saved: built anew, those of a
 * machine with other vector units may be slightly different ones. A version of this library that does not know the version of the
 * file refuses it.
 *
 * SWIFTPROX_ERROR_FILE: the file cannot be written or is no regular one (nothing waits for the reader of a pipe); the message
 * names it and says why. SWIFTPROX_ERROR_MEMORY: the file is as it was. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the message names the argument.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_save(const struct swiftprox_shape *shape,
                                      const char *path);

/**
 * Loads a shape that swiftprox_shape_save has saved; the caller owns it and gives it back with swiftprox_shape_release. It has the
 * same hull, labels, levels and table, for the same answers. What answers
 * rely on is not believed but proved and measured again, so loading takes up to about half as long as making the shape did,
 * levels included; a damaged file is refused. `progress` learns how far it is and can cancel it, or is null; `progress_user` is
 * handed to it.
 *
 * On failure `*shape` is null.
 *
 * SWIFTPROX_ERROR_FILE: the file cannot be read, is no regular file, is larger than 4 GiB (4,294,967,296 bytes), is no shape file,
 * of another version or damaged; the message names it and says what is wrong. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_CANCELLED:
 * progress said so. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_INVALID_ARGUMENT: the message names the argument.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_load(const char *path,
                                      swiftprox_progress_callback progress,
                                      void *progress_user,
                                      const struct swiftprox_shape **shape);

/** @} */

/**
 * @defgroup swiftprox_mesh Meshes that are not convex
 * @{
 */

/**
 * Writes how far from convex a mesh may be because of the precision of its coordinates, relative to its bounding box's diagonal:
 * four units of the last place in which they are written (decimals, significant digits, floats), at least 1e-9 and at most 0.005.
 * `vertices` holds 3 * vertex_count coordinates as they were written down, before any transform. On failure it is NaN.
 *
 * SWIFTPROX_ERROR_MESH: a coordinate is not finite. SWIFTPROX_ERROR_INVALID_ARGUMENT: there are no vertices.
 * SWIFTPROX_ERROR_LIMIT: the count does not fit 32 bits. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: tolerance is null,
 * or vertices where there are some.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_mesh_estimate_tolerance(const double *vertices,
                                                   size_t vertex_count,
                                                   double *tolerance);

/** Where swiftprox_mesh_decompose writes the triangles of a surface, piece by piece. The arrays are the caller's. */
typedef struct swiftprox_decomposition {
  /**
   * Receives the vertices of each triangle, 3 * capacity numbers, counter-clockwise seen from outside: those of one piece
   * follow each other. Of exactly equal vertices the first is named.
   */
  uint32_t *corners;
  /** Receives for each triangle the face of the mesh that it is a part of, or is null. */
  uint32_t *faces;
  /** Receives for each triangle the number of its piece, ascending from 0, or is null. */
  uint32_t *pieces;
  /**
   * Triangles for which the arrays have room. Two fewer than corners, summed over the faces of three or more, are always
   * enough.
   */
  size_t capacity;
  /** Receives the number of triangles; 0 on failure. */
  size_t triangle_count;
  /** Receives the number of pieces; 0 on failure. */
  size_t piece_count;
} swiftprox_decomposition;

/**
 * Cuts the surface of a mesh into convex pieces, as the decomposer of SWIFT++ did. The mesh need not be convex, and may be in
 * several parts. Each triangle of the surface is in one piece; the piece's body is the convex hull of its triangles, which lie
 * on that hull.
 *
 * Of a closed surface, outside of which its faces run counter-clockwise, the hulls are inside of the body: bodies that are apart
 * are as far apart as their pieces. Pieces may overlap, and need not fill the body, so that a body wholly inside of another may
 * not meet one of its pieces. Surfaces without inside, which are open, or cavities, become flat pieces. A mesh whose closed
 * parts are all inside out is turned.
 *
 * For an object of a scene make a shape of each piece k with swiftprox_shape_create_from_mesh: the same vertices, the corners of
 * the piece's triangles, no valences, input = SWIFTPROX_INPUT_PATCH; and hand all of them to swiftprox_scene_add_object.
 *
 * `vertices`, `indices` and `valences` are as swiftprox_shape_create_from_mesh takes them; a face need not be convex, and is to
 * be flat about. `tolerance` is relative to the bounding box's diagonal: what is that close to a plane counts as on it, and a
 * piece may be about that far beyond the surface; 0 is exact. swiftprox_mesh_estimate_tolerance says what the coordinates
 * excuse. Without it, plane faces that were turned and rounded come to pieces. It takes time in proportion to the square of the
 * triangles at worst, one to two seconds for 10,000. `progress` learns how far it is and can cancel it, or is null;
 * `progress_user` is handed to it.
 *
 * SWIFTPROX_ERROR_MESH: a coordinate is not finite; an index is out of range; an edge belongs to more than two faces, or to two
 * in the same direction; a face crosses itself; no face has an area: the message names face, edge or vertex.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: tolerance is out of [0, 1], or capacity is too small: nothing is written to the arrays, and
 * the message says how many are needed. SWIFTPROX_ERROR_CANCELLED: progress said so. SWIFTPROX_ERROR_LIMIT: a count does not fit
 * 32 bits. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: decomposition, its corners or an array of the mesh is null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_mesh_decompose(const double *vertices,
                                          size_t vertex_count,
                                          const uint32_t *indices,
                                          const uint32_t *valences,
                                          size_t face_count,
                                          double tolerance,
                                          swiftprox_progress_callback progress,
                                          void *progress_user,
                                          struct swiftprox_decomposition *decomposition);

/** @} */

/**
 * @defgroup swiftprox_ray Rays
 * @{
 */

/** The points `origin + t*direction` with 0 <= t <= `t_max`. */
typedef struct swiftprox_ray {
  /** Where it begins, in the world. */
  double origin[3];
  /** Where it leads, of any length but 0. */
  double direction[3];
  /** Where it ends, from 0 to infinity. */
  double t_max;
} swiftprox_ray;

/** Whether a ray meets a body. */
typedef enum swiftprox_ray_outcome SWIFTPROX_INT32 {
  /** Nothing is said yet: the value of a fresh answer. */
  SWIFTPROX_RAY_OUTCOME_NONE = 0,
  /** No point of the ray is in the body. */
  SWIFTPROX_RAY_OUTCOME_MISS = 1,
  /** The ray enters the body, or touches it, from its origin on. */
  SWIFTPROX_RAY_OUTCOME_HIT = 2,
  /** The ray begins in the body, at a place that is not the first of its line in it. */
  SWIFTPROX_RAY_OUTCOME_INSIDE = 3
} swiftprox_ray_outcome;

/** The part of a ray that is in a body, `entry <= t <= exit`. Numbers that it does not say are NaN. */
typedef struct swiftprox_ray_answer {
  /** Whether there is such a part. */
  swiftprox_ray_outcome outcome;
  /** Whether integers decided what rounding hides: 1 or 0. They allocate. */
  int32_t exact;
  /** `entry[0]` <= where it begins <= `entry[1]`; 0 from inside. */
  double entry[2];
  /** `exit[0]` <= where it ends <= `exit[1]`: where the ray leaves the body, or `t_max` if that comes first. */
  double exit[2];
  /**
   * Of a hit the outward unit normal there, in the world frame, rounded: of the feature's face. A segment or a point has no
   * face, and the normal is against the ray. Of a flat body met edge-on it is that of its plane. With a swept radius it is
   * that of the round surface.
   */
  double normal[3];
  /**
   * Of a hit the face that the ray enters through; one of those that meet where it enters. A segment has an edge, a point a
   * vertex. With a swept radius it is the vertex, the edge or the face that is nearest to where the ray enters, of the body
   * without the ball.
   */
  struct swiftprox_feature feature;
  /** Faces that the search visited; with a swept radius vertices. */
  uint32_t steps;
} swiftprox_ray_answer;

/**
 * Where a ray meets a shape at a pose, the part of it that is in the closed body, a swept radius included: certain, whatever the
 * magnitudes. A ray that only touches is a hit. Ends are intervals that hold the true ones; they are at most 2^-40 of the lengths
 * that the ray and the body have wide, over that of the direction.
 *
 * On failure the answer is reset: its outcome is SWIFTPROX_RAY_OUTCOME_NONE. SWIFTPROX_ERROR_INVALID_ARGUMENT: origin or direction
 * is not finite, the direction is 0, or t_max is negative or NaN. SWIFTPROX_ERROR_POSE: the pose is refused.
 * SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_cast_ray(const struct swiftprox_shape *shape,
                                          const double *pose,
                                          const struct swiftprox_ray *ray,
                                          struct swiftprox_ray_answer *answer);

/**
 * How a ray cast came out, in words. Never null, valid for ever; for an unknown number the string says so.
 *
 * Experimental.
 */
const char *swiftprox_library_ray_outcome_string(swiftprox_ray_outcome outcome);

/** @} */

/**
 * @defgroup swiftprox_scene_ray Rays through a scene
 * @{
 */

/** What of a ray is asked. */
typedef enum swiftprox_ray_hits SWIFTPROX_INT32 {
  /** The first that it meets. */
  SWIFTPROX_RAY_HITS_FIRST = 0,
  /** All, in order. */
  SWIFTPROX_RAY_HITS_ALL = 1,
  /** Any, found soonest. */
  SWIFTPROX_RAY_HITS_ANY = 2
} swiftprox_ray_hits;

/** A convex piece that a ray meets. */
typedef struct swiftprox_scene_ray_hit {
  /** Whose piece it is. */
  struct swiftprox_object_id object;
  /** The caller's own number of the object. */
  uint64_t user_data;
  /** Which piece. */
  uint32_t piece;
  /** Its place among all pieces of the scene, in order of creation, while none is removed. */
  uint32_t row;
  /** Where the ray meets it. */
  struct swiftprox_ray_answer answer;
} swiftprox_scene_ray_hit;

/** What a ray met in a scene. */
typedef struct swiftprox_scene_ray_answer {
  /** In order of where the ray comes in. Owned by the scratch and valid until its next use. Null when count is 0. */
  const struct swiftprox_scene_ray_hit *hits;
  /** How many. */
  size_t count;
} swiftprox_scene_ray_answer;

/**
 * What a ray meets of the objects whose groups have a bit of mask (UINT32_MAX: all in some group): the first convex piece, all in
 * order, or any, found soonest. Each as swiftprox_shape_cast_ray has it; pieces that are met at one place, as far as doubles tell,
 * are in order of creation. Threads as of swiftprox_scene_least_distance; the scratch owns the hits and must not be null.
 *
 * On failure the answer is empty. SWIFTPROX_ERROR_INVALID_ARGUMENT: the ray is refused as by swiftprox_shape_cast_ray, or hits is
 * unknown. SWIFTPROX_ERROR_BUSY: the scene is being changed. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_POISONED.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_cast_ray(const struct swiftprox_scene *scene,
                                          const struct swiftprox_ray *ray,
                                          swiftprox_ray_hits hits,
                                          uint32_t mask,
                                          struct swiftprox_scratch *scratch,
                                          struct swiftprox_scene_ray_answer *answer);

/** @} */

/**
 * @defgroup swiftprox_point Points and support vertices
 * @{
 */

/** Where a point is relative to a closed body. */
typedef enum swiftprox_point_location SWIFTPROX_INT32 {
  /** Nothing is said yet: the value of a fresh answer. */
  SWIFTPROX_POINT_LOCATION_NONE = 0,
  /** In the body's interior. A body without interior has no such point. */
  SWIFTPROX_POINT_LOCATION_INSIDE = 1,
  /** On its surface; of a body without interior any point of it. */
  SWIFTPROX_POINT_LOCATION_ON = 2,
  /** Not in the body. */
  SWIFTPROX_POINT_LOCATION_OUTSIDE = 3
} swiftprox_point_location;

/** Where a point is relative to a body, and what of the surface is nearest. Numbers that it does not say are NaN. */
typedef struct swiftprox_point_answer {
  /** Certain, whatever the magnitudes. */
  swiftprox_point_location location;
  /** What of the body's surface holds the nearest point of it, in the caller's numbering. */
  struct swiftprox_feature feature;
  /** The best estimate of how far the point is from the surface, `lower <= distance <= upper`: negative inside, 0 on it. */
  double distance;
  /** Lower end of the rigorous interval; above 0 only outside. */
  double lower;
  /** Upper end of the rigorous interval; at most 0 unless outside. */
  double upper;
  /** The nearest point of the surface, in the body's local frame. */
  double local[3];
  /** The same in the world. */
  double world[3];
  /** Unit normal in the world: moving the point along it makes the distance grow as much. */
  double normal[3];
} swiftprox_point_answer;

/**
 * Where a point of the world is relative to a shape at a pose: inside, on it or outside, how far from its surface, and what of
 * that is nearest. Certain, whatever the magnitudes: integers decide where doubles cannot tell. It allocates.
 *
 * On failure the answer is reset: its location is SWIFTPROX_POINT_LOCATION_NONE. SWIFTPROX_ERROR_INVALID_ARGUMENT: the point is
 * not finite. SWIFTPROX_ERROR_POSE: the pose is refused. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_locate_point(const struct swiftprox_shape *shape,
                                              const double *pose,
                                              const double *point,
                                              struct swiftprox_point_answer *answer);

/** A vertex farthest along a direction. Numbers that it does not say are NaN. */
typedef struct swiftprox_support_vertex {
  /** The vertex's index in the caller's array: for certain no other is farther. Of several that are as far it is any. */
  uint32_t vertex;
  /** Whether integers decided what rounding hides: 1 or 0. They allocate. */
  int32_t exact;
  /** Where the body reaches farthest, in its local frame: the vertex, or a point of the ball about it. */
  double local[3];
  /** The same in the world, rounded. */
  double world[3];
  /**
   * `height[0]` <= direction * x <= `height[1]` for its exact place x in the world: the largest over the body, the ball that is
   * swept over it included.
   */
  double height[2];
} swiftprox_support_vertex;

/**
 * The vertex of a shape at a pose that is farthest along a direction of the world, of any length but 0: for certain no other is
 * farther, whatever the magnitudes. Of a shape with a swept radius place and height are those of the ball about the vertex.
 *
 * On failure the answer's numbers are NaN and 0. SWIFTPROX_ERROR_INVALID_ARGUMENT: the direction is 0 or not finite.
 * SWIFTPROX_ERROR_POSE: the pose is refused. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_support(const struct swiftprox_shape *shape,
                                         const double *pose,
                                         const double *direction,
                                         struct swiftprox_support_vertex *answer);

/**
 * A location, in words. Never null, valid for ever; a number that is none gets a string that says so.
 *
 * Experimental.
 */
const char *swiftprox_library_point_location_string(swiftprox_point_location location);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
