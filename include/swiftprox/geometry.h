/*
 * swiftprox. Geometry: what a shape is made of, convex pieces of a mesh, rays, points, support vertices and gradients. The
 * conventions are those of swiftprox.h.
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
 * Copies the vertices of the hull in the local frame, 3 coordinates each. `capacity` is the room in vertices, at least
 * swiftprox_shape_info.vertex_count. `labels`, if not null, receives the caller's number of each vertex.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is too small; nothing is written.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_vertices(const struct swiftprox_shape *shape,
                                               double *vertices,
                                               uint32_t *labels,
                                               size_t capacity);

/**
 * Copies the triangles of the hull: 3 corners each, counter-clockwise seen from outside, as indices into the vertices of
 * swiftprox_shape_copy_vertices. `capacity` is the room in triangles, at least swiftprox_shape_info.triangle_count. Larger faces
 * are split into triangles; bodies of dimension 1 or 0 have none.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is too small; nothing is written.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_triangles(const struct swiftprox_shape *shape,
                                                uint32_t *corners,
                                                size_t capacity);

/** A face of a shape's hull: a convex polygon of all coplanar triangles. */
typedef struct swiftprox_face {
  /** Outward unit normal, rounded, in the local frame. */
  double normal[3];
  /** The face's plane is normal * x = offset, rounded. */
  double offset;
  /** Number of corners. */
  size_t corner_count;
  /** Number of the caller's polygons merged in the face, at least 1. */
  size_t label_count;
} swiftprox_face;

/**
 * Room for what swiftprox_shape_get_face finds, by value; `{NULL, 0, NULL, 0}` requests only the plane and the numbers. What does
 * not fit is left out.
 */
typedef struct swiftprox_face_room {
  /** Receives the corners counter-clockwise seen from outside, as indices into the vertices of swiftprox_shape_copy_vertices. */
  uint32_t *corners;
  /** Room of `corners`; 0 allows null. */
  size_t corner_capacity;
  /** Receives the caller's polygons of the face, ascending, or the face's own number if the hull was made without polygons. */
  uint32_t *labels;
  /** Room of `labels`; 0 allows null. */
  size_t label_capacity;
} swiftprox_face_room;

/**
 * Writes a face of a shape; `index` is from 0 to below swiftprox_shape_info.face_count. For a face of an answer use
 * swiftprox_shape_find_face.
 *
 * On failure `*face` is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such face.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_face(const struct swiftprox_shape *shape,
                                          size_t index,
                                          struct swiftprox_face_room room,
                                          struct swiftprox_face *face);

/**
 * Finds the index, for swiftprox_shape_get_face, of the first face that contains the caller's polygon `label`. Face ids of answers
 * are such labels. Time is linear in the number of faces. On failure `*index` is SIZE_MAX.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: no face has the label.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_find_face(const struct swiftprox_shape *shape,
                                           uint32_t label,
                                           size_t *index);

/**
 * Creates a copy of a shape with every length multiplied by `scale`, a power of two. Release it with swiftprox_shape_release.
 * Vertices, levels of detail and distances scale exactly; labels stay. It takes up to half the time of making the shape.
 * `progress` (may be null, gets `progress_user`) reports progress and can cancel.
 *
 * For other scales make the shape anew with swiftprox_shape_options.scale. To turn or move a shape, use poses.
 *
 * On failure `*shape` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: scale is not a positive power of two, or lengths leave the range
 * of doubles.
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
 * Saves a shape in a file and replaces its content. Levels of detail are saved, except automatic ones; these and the look-up table
 * are made again when needed. Any machine can load the file; older libraries may refuse it.
 *
 * SWIFTPROX_ERROR_FILE: the file cannot be written or is not a regular file; the message names it and the cause.
 * SWIFTPROX_ERROR_MEMORY leaves the file as it was.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_save(const struct swiftprox_shape *shape,
                                      const char *path);

/**
 * Loads a shape saved by swiftprox_shape_save. Release it with swiftprox_shape_release. Hull, labels, levels, table and answers
 * are the same. Data is checked again, so loading takes up to half the time of making the shape. `progress` (may be null, gets
 * `progress_user`) reports progress and can cancel.
 *
 * On failure `*shape` is null. SWIFTPROX_ERROR_FILE: the file is unreadable, not a regular file, above 4 GiB, not a shape file, of
 * another version or damaged; the message says which.
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
 * Estimates how far from convex a mesh may be through the precision of its coordinates, relative to its bounding-box diagonal. The
 * result is four units in the last written place (decimals, significant digits or floats), from 1e-9 to 0.005. `vertices` holds
 * 3 * vertex_count coordinates as written, before any transform. On failure the tolerance is NaN.
 *
 * SWIFTPROX_ERROR_MESH: a coordinate is not finite. SWIFTPROX_ERROR_INVALID_ARGUMENT: there are no vertices.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_mesh_estimate_tolerance(const double *vertices,
                                                   size_t vertex_count,
                                                   double *tolerance);

/** Output of swiftprox_mesh_decompose: the triangles of a surface, piece by piece. The caller owns the arrays. */
typedef struct swiftprox_decomposition {
  /**
   * Receives 3 vertex numbers per triangle, counter-clockwise seen from outside, piece by piece. Equal vertices get the number
   * of the first. Room: 3 * capacity numbers.
   */
  uint32_t *corners;
  /** Receives the mesh face of each triangle; may be null. */
  uint32_t *faces;
  /** Receives the piece number of each triangle, ascending from 0; may be null. */
  uint32_t *pieces;
  /** Room of the arrays in triangles. The sum of (corners - 2) over all faces of three or more corners is always enough. */
  size_t capacity;
  /** Receives the number of triangles; 0 on failure. */
  size_t triangle_count;
  /** Receives the number of pieces; 0 on failure. */
  size_t piece_count;
} swiftprox_decomposition;

/**
 * Cuts the surface of a mesh into convex pieces, as the decomposer of SWIFT++ did. The mesh need not be convex or connected.
 * Each triangle belongs to one piece and lies on that piece's convex hull.
 *
 * For closed surfaces with outward faces the hulls stay inside the body, so separated bodies have the distance of their
 * pieces. Pieces need not fill the body: a body wholly inside another may touch no piece. Open surfaces and cavities become
 * flat pieces. A mesh with all closed parts inside out is turned.
 *
 * Make a shape of each piece with swiftprox_shape_create_from_mesh: same vertices, its triangles, no valences, input =
 * SWIFTPROX_INPUT_PATCH. Pass all shapes to swiftprox_scene_add_object.
 *
 * Faces must be nearly flat. `convexity_tolerance` is relative to the bounding-box diagonal: points that close to a plane
 * count as on it. 0 is exact, but splits flat faces with rounded vertices; swiftprox_mesh_estimate_tolerance suggests a value.
 * For solid pieces use swiftprox_compound_create_from_mesh with a tolerance above 0.
 * Time is at worst quadratic, one to two seconds for 10,000 triangles. `progress` may be null.
 *
 * SWIFTPROX_ERROR_MESH: a coordinate is not finite, an index is out of range, a face crosses itself, no face has an area, or
 * an edge has more than two faces or two in one direction. SWIFTPROX_ERROR_INVALID_ARGUMENT: the tolerance is outside [0, 1],
 * or capacity is too small. Then the arrays are unchanged, and the message gives the room needed.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_mesh_decompose(struct swiftprox_mesh mesh,
                                          double convexity_tolerance,
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
  /** Start of the ray, in the world. */
  double origin[3];
  /** Direction of the ray, of any length but 0. */
  double direction[3];
  /** End of the ray, from 0 to infinity. */
  double t_max;
} swiftprox_ray;

/** Whether a ray meets a body. */
typedef enum swiftprox_ray_outcome SWIFTPROX_INT32 {
  /** No answer yet: the value of a fresh answer. */
  SWIFTPROX_RAY_OUTCOME_NONE = 0,
  /** No point of the ray is in the body. */
  SWIFTPROX_RAY_OUTCOME_MISS = 1,
  /** The ray enters the body, or touches it, from its origin on. */
  SWIFTPROX_RAY_OUTCOME_HIT = 2,
  /** The ray begins in the body, at a place that is not the first of its line in it. */
  SWIFTPROX_RAY_OUTCOME_INSIDE = 3,
  /**
   * The deviation of a cylinder, cone or ellipsoid hides whether the ray meets it, or whether it begins in it. If it meets it,
   * it enters and leaves within the intervals.
   */
  SWIFTPROX_RAY_OUTCOME_UNDECIDED = 4
} swiftprox_ray_outcome;

/** The part of a ray that is in a body, `entry <= t <= exit`. Unset numbers are NaN. */
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
   * For a hit, the outward unit normal of the feature's face there, in the world frame, rounded. A segment or a point has no
   * face, and the normal is against the ray. For a flat body met edge-on it is the normal of its plane. With a swept radius it
   * is that of the round surface.
   */
  double normal[3];
  /**
   * For a hit, the face that the ray enters through; one of those that meet where it enters. A segment has an edge, a point a
   * vertex. With a swept radius it is the vertex, edge or face of the body without the ball that is nearest to where the ray
   * enters.
   */
  struct swiftprox_feature feature;
  /** Faces that the search visited; with a swept radius vertices. */
  uint32_t steps;
} swiftprox_ray_answer;

/**
 * Casts a ray at a shape at a pose and finds the part of the ray inside the closed body, swept radius included. The result is
 * guaranteed; touching is a hit. Ends are intervals that contain the true ones. Their width is at most 2^-40 of the lengths of the
 * ray and the body, divided by that of the direction.
 *
 * On failure the answer is reset and its outcome is SWIFTPROX_RAY_OUTCOME_NONE. SWIFTPROX_ERROR_INVALID_ARGUMENT: origin or
 * direction is not finite, the direction is 0, or t_max is negative or NaN.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_cast_ray(const struct swiftprox_shape *shape,
                                          const double *pose,
                                          const struct swiftprox_ray *ray,
                                          struct swiftprox_ray_answer *answer);

/**
 * Returns the text for a ray outcome. Never null, valid forever, also for unknown numbers.
 *
 * Experimental.
 */
const char *swiftprox_library_ray_outcome_string(swiftprox_ray_outcome outcome);

/** @} */

/**
 * @defgroup swiftprox_scene_ray Rays through a scene
 * @{
 */

/** The result of a ray query. */
typedef enum swiftprox_ray_hits SWIFTPROX_INT32 {
  /** The first that it meets, or may meet where a curved one is undecided. */
  SWIFTPROX_RAY_HITS_FIRST = 0,
  /** All, in order. */
  SWIFTPROX_RAY_HITS_ALL = 1,
  /** Any, found soonest; an undecided one where it certainly meets none. */
  SWIFTPROX_RAY_HITS_ANY = 2
} swiftprox_ray_hits;

/** A convex piece that a ray meets, a compound at the first of its pieces, or a ground at its first triangle, a face. */
typedef struct swiftprox_scene_ray_hit {
  /** The object. */
  struct swiftprox_object_id object;
  /** The caller's own number of the object. */
  uint64_t user_data;
  /** Which piece. */
  uint32_t piece;
  /** Its place among all pieces of the scene, in order of creation, while none is removed. */
  uint32_t row;
  /** The answer for the piece. */
  struct swiftprox_ray_answer answer;
} swiftprox_scene_ray_hit;

/** The hits of a ray in a scene. */
typedef struct swiftprox_scene_ray_answer {
  /** Hits in order of entry along the ray. Owned by the scratch and valid until its next use. Null if count is 0. */
  const struct swiftprox_scene_ray_hit *hits;
  /** Number of hits. */
  size_t count;
} swiftprox_scene_ray_answer;

/**
 * Finds convex pieces and grounds that a ray meets, of objects whose groups have a bit of mask (UINT32_MAX: any group). `hits`
 * selects the first, all in order, or any, found soonest. Each hit is as from swiftprox_shape_cast_ray, or once for each ground as
 * from swiftprox_ground_cast_ray. Hits at the same place are in order of creation. Threads: as for swiftprox_scene_least_distance.
 * The scratch owns the hits and must not be null.
 *
 * On failure the answer is empty. SWIFTPROX_ERROR_INVALID_ARGUMENT: a ray that swiftprox_shape_cast_ray refuses, or unknown hits.
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

/** Position of a point relative to a closed body. */
typedef enum swiftprox_point_location SWIFTPROX_INT32 {
  /** No answer yet: the value of a fresh answer. */
  SWIFTPROX_POINT_LOCATION_NONE = 0,
  /** In the body's interior. A body without interior has no such point. */
  SWIFTPROX_POINT_LOCATION_INSIDE = 1,
  /** On its surface; for a body without interior, any point of it. */
  SWIFTPROX_POINT_LOCATION_ON = 2,
  /** Not in the body. */
  SWIFTPROX_POINT_LOCATION_OUTSIDE = 3,
  /** Inside, on or outside: the deviation of a cylinder, cone or ellipsoid hides it. */
  SWIFTPROX_POINT_LOCATION_UNDECIDED = 4
} swiftprox_point_location;

/** Position of a point relative to a body, and the nearest feature of the surface. Unset numbers are NaN. */
typedef struct swiftprox_point_answer {
  /** Guaranteed, whatever the magnitudes. */
  swiftprox_point_location location;
  /** The feature of the body's surface that holds its nearest point, in the caller's numbering. */
  struct swiftprox_feature feature;
  /** The best estimate of how far the point is from the surface, `lower <= distance <= upper`: negative inside, 0 on it. */
  double distance;
  /** Lower end of the rigorous interval; above 0 only outside. */
  double lower;
  /** Upper end of the rigorous interval; at most 0 unless outside or undecided. */
  double upper;
  /** The nearest point of the surface, in the body's local frame. */
  double local[3];
  /** The same in the world. */
  double world[3];
  /** Unit normal in the world: moving the point along it makes the distance grow as much. */
  double normal[3];
} swiftprox_point_answer;

/**
 * Locates a point of the world relative to a shape at a pose: inside, on or outside, distance from the surface and nearest part.
 * The location is guaranteed: integers decide where doubles cannot. The function allocates.
 *
 * On failure the answer is reset and its location is SWIFTPROX_POINT_LOCATION_NONE. SWIFTPROX_ERROR_INVALID_ARGUMENT: the point is
 * not finite.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_locate_point(const struct swiftprox_shape *shape,
                                              const double *pose,
                                              const double *point,
                                              struct swiftprox_point_answer *answer);

/** A vertex farthest along a direction. Unset numbers are NaN. */
typedef struct swiftprox_support_vertex {
  /** The vertex's index in the caller's array: no other is farther, provably. If several are as far, it is any of them. */
  uint32_t vertex;
  /** Whether integers decided what rounding hides: 1 or 0. They allocate. */
  int32_t exact;
  /** The body's support point in its local frame: the vertex, or a point of the ball about it. */
  double local[3];
  /** The same in the world, rounded. */
  double world[3];
  /**
   * `height[0]` <= direction * x <= `height[1]` for its exact place x in the world: the largest over the body, the ball that is
   * swept over it included, or the deviation of a curved body at the upper end.
   */
  double height[2];
} swiftprox_support_vertex;

/**
 * Finds the vertex of a shape at a pose that is farthest along a direction of the world. The result is guaranteed. The direction
 * may have any nonzero length. With a swept radius, place and height are those of the ball about the vertex.
 *
 * On failure numbers are NaN or 0. SWIFTPROX_ERROR_INVALID_ARGUMENT: the direction is 0 or not finite.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_support(const struct swiftprox_shape *shape,
                                         const double *pose,
                                         const double *direction,
                                         struct swiftprox_support_vertex *answer);

/**
 * Returns the text for a location. Never null, valid forever, also for unknown numbers.
 *
 * Experimental.
 */
const char *swiftprox_library_point_location_string(swiftprox_point_location location);

/** @} */

/**
 * @defgroup swiftprox_gradient How distances change as objects move
 * @{
 */

/**
 * The derivative of a signed distance by the motions of both objects. Each has six numbers: by the linear velocity along the
 * world's axes, then by the angular velocity about these axes, in lengths per radian. The object turns about its reference point
 * and moves with it.
 */
typedef struct swiftprox_gradient {
  /** By the motion of object 1. */
  double object1[6];
  /** By the motion of object 2. */
  double object2[6];
  /**
   * 1: no other points of the objects are as near along the normal, and this is the derivative. 0: a face or an edge is parallel
   * to one of the other object, up to rounding and the interval's width. Then the numbers are for the answer's own witness
   * points, and the signed distance grows along no motion faster than they say. Of overlapping objects both are meant along the
   * answer's normal: whether another direction is as deep is not looked for.
   */
  int32_t is_unique;
} swiftprox_gradient;

/**
 * Computes how the signed distance changes as the objects move, from an answer of swiftprox_pair_signed_distance for the same
 * objects, without a further search. A distance's or depth's members serve as well, the depth's with their signs reversed.
 *
 * Reference points have 3 numbers, in the world; null: the translation of the pose. An object moves with its reference point and
 * turns about it. docs/gradients.md says where the derivative does not exist; swiftprox_gradient.is_unique is 0 there.
 *
 * Time is linear in the number of vertices; nothing is allocated. On failure numbers are NaN. SWIFTPROX_ERROR_INVALID_ARGUMENT:
 * the answer has no normal and witness points (outcomes other than separated and intersecting), or a reference point is not
 * finite.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_gradient(struct swiftprox_placed object1,
                                         struct swiftprox_placed object2,
                                         const struct swiftprox_signed_distance *answer,
                                         const double *reference1,
                                         const double *reference2,
                                         struct swiftprox_gradient *gradient);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
