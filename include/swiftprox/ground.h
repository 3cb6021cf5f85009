/*
 * swiftprox. Grounds: half-spaces, triangles and heights, and where bodies stand on them. The conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_GROUND_H
#define SWIFTPROX_GROUND_H

#include "motion.h"
#include "geometry.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_half_space Half-spaces
 * @{
 */

/** The points x of the world with `normal` * x <= `offset`. */
typedef struct swiftprox_half_space {
  /** Out of the half-space; of any length but 0. */
  double normal[3];
  /** Place of its plane: the product of the normal with any of its points. */
  double offset;
} swiftprox_half_space;

/**
 * Computes the signed distance of a shape (object 1) from a half-space (object 2), as swiftprox_pair_signed_distance does. The
 * interval is guaranteed for the exact shape and plane; integers decide touching. The normal is the half-space's, of unit length.
 * The half-space's witness point is on the plane, in world coordinates in both members; its feature is
 * SWIFTPROX_FEATURE_KIND_NONE.
 *
 * On failure the answer is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: the normal is 0, or a number of half_space is not finite.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_half_space_distance(struct swiftprox_placed object,
                                                    const struct swiftprox_half_space *half_space,
                                                    struct swiftprox_signed_distance *answer);

/**
 * Computes where a shape (object 1) meets a half-space or is at most config->max_distance apart. The points are the corners of the
 * face that points most towards the plane, with a gap of at most max_distance. The lowest point is always included. Output is as
 * in swiftprox_pair_manifold. There is no cache, so each call chooses the four points of a reduced manifold anew.
 *
 * Same errors as swiftprox_pair_half_space_distance and swiftprox_pair_manifold. On failure the manifold is reset and points are
 * unchanged.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_half_space_manifold(struct swiftprox_placed object,
                                                    const struct swiftprox_half_space *half_space,
                                                    const struct swiftprox_manifold_config *config,
                                                    struct swiftprox_manifold_room room,
                                                    struct swiftprox_manifold *manifold);

/** @} */

/**
 * @defgroup swiftprox_ground Grounds
 * @{
 */

/**
 * A surface of triangles, immutable, shared by any number of owners. The front of a triangle is where its corners go around
 * counter-clockwise.
 */
typedef struct swiftprox_ground swiftprox_ground;

/**
 * Creates a ground from triangles. The caller owns it and gives it back with swiftprox_ground_release. The arrays are copied.
 *
 * `vertices` holds 3 * vertex_count coordinates, `corners` 3 * triangle_count vertex numbers from 0. Triangles push bodies out of
 * their front, where corners run counter-clockwise. They may form any surface, or none. Two triangles share an edge if its ends
 * are equal and its directions opposite; bodies slide over it. Triangles without area, or smaller than 2^-200, are skipped, but
 * keep their numbers.
 *
 * On failure `*ground` is null. SWIFTPROX_ERROR_MESH: a coordinate is not finite or beyond 2^200, a vertex number is too large, or
 * no triangle has an area. SWIFTPROX_ERROR_LIMIT: more than 2^30 triangles.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_ground_create_from_triangles(const double *vertices,
                                                        size_t vertex_count,
                                                        const uint32_t *corners,
                                                        size_t triangle_count,
                                                        const struct swiftprox_ground **ground);

/**
 * Creates a ground from heights over a grid in the xy plane. The caller owns it and gives it back with swiftprox_ground_release.
 * The heights are copied.
 *
 * `heights` holds rows * columns numbers, row by row, each row along x. NaN is a hole; cells with one at a corner are holes.
 * Vertex i * columns + j is at (j * column_spacing, i * row_spacing, height). The diagonal of each cell runs from its least to its
 * greatest corner; both triangles face up. Let c = i * (columns - 1) + j for the least corner. Triangle 2 * c has the corner along
 * x, triangle 2 * c + 1 the other.
 *
 * On failure `*ground` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: fewer than two rows or columns, or a spacing that is not
 * finite and at least 2^-199. SWIFTPROX_ERROR_MESH: a coordinate is infinite or beyond 2^200, or all cells are holes.
 * SWIFTPROX_ERROR_LIMIT: more than 2^29 heights.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_ground_create_from_heights(size_t rows,
                                                      size_t columns,
                                                      double row_spacing,
                                                      double column_spacing,
                                                      const double *heights,
                                                      const struct swiftprox_ground **ground);

/**
 * Creates one ground from several, such as the tiles of a terrain: bodies slide over the seams. The caller owns it and gives it
 * back with swiftprox_ground_release. Shares of the others are not kept.
 *
 * `grounds` holds `count` grounds, `poses` 12 numbers for each of them, row by row. Vertices and triangles keep their order: those
 * of the first ground, then those of the second. The new ground is as thick as the thickest of them.
 *
 * On failure `*ground` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: count is 0. SWIFTPROX_ERROR_POSE: a pose is not a rotation.
 * SWIFTPROX_ERROR_LIMIT: more than 2^30 triangles or 2^32 vertices in all.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_ground_create_from_grounds(const struct swiftprox_ground *const *grounds,
                                                      const double *poses,
                                                      size_t count,
                                                      const struct swiftprox_ground **ground);

/**
 * Creates a solid ground from another. It pushes out bodies whose centres of mass are behind a triangle by up to `thickness`, even
 * if they touch no triangle. Use infinity for closed surfaces. A thickness of 0 is that of other grounds. The caller owns it and
 * gives it back with swiftprox_ground_release.
 *
 * On failure `*solid` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: thickness is negative or NaN.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_ground_create_solid(const struct swiftprox_ground *ground,
                                               double thickness,
                                               const struct swiftprox_ground **solid);

/**
 * Adds a share of a ground, and returns the ground. Give each share back with swiftprox_ground_release. Safe from any thread. For
 * null it returns null.
 *
 * Experimental.
 */
const struct swiftprox_ground *swiftprox_ground_retain(const struct swiftprox_ground *ground);

/**
 * Gives back one share of a ground; the last one frees it. Safe from any thread. Null is ignored.
 *
 * Experimental.
 */
void swiftprox_ground_release(const struct swiftprox_ground *ground);

/** Properties of a ground. */
typedef struct swiftprox_ground_info {
  /** Number of vertices given. */
  size_t vertex_count;
  /** Number of triangles, including skipped ones. */
  size_t triangle_count;
  /** Its memory in bytes. */
  size_t bytes;
} swiftprox_ground_info;

/**
 * Writes the properties of a ground. On failure all are 0.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_ground_get_info(const struct swiftprox_ground *ground,
                                           struct swiftprox_ground_info *info);

/**
 * Copies `count` triangles of a ground, beginning with number `first`, in the ground's frame. A large ground is read in parts.
 *
 * `points` receives 9 coordinates of each triangle, corner by corner, and `corners` its 3 vertex numbers. Either may be null. The
 * corners of a skipped triangle are one vertex; at a hole of a grid its height is 0.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the ground has no such triangles; nothing is written.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_ground_copy_triangles(const struct swiftprox_ground *ground,
                                                 size_t first,
                                                 size_t count,
                                                 double *points,
                                                 uint32_t *corners);

/** A ground at a pose, an argument by value. Both pointers are only read during the call. */
typedef struct swiftprox_placed_ground {
  /** The ground. */
  const struct swiftprox_ground *ground;
  /** 12 doubles, the row-major 3x4 matrix [R|T]. */
  const double *pose;
} swiftprox_placed_ground;

/** The answer for a body, which is object 1, and a ground. */
typedef struct swiftprox_ground_distance {
  /**
   * Same as for a body and the surface as a set of points. Features of object 2 are in the ground's numbering: vertices, edges
   * by their vertices, a face is a triangle. For a pair beyond `max_distance` only `lower` is reported.
   */
  struct swiftprox_pair_answer answer;
  /**
   * The triangle that the answer is about: the nearest, or the first that was found to intersect. It is the number of triangles
   * where the answer is about none.
   */
  uint32_t triangle;
} swiftprox_ground_distance;

/**
 * Returns the distance of a shape (object 1) to a ground, or only whether they intersect. `kind` is SWIFTPROX_QUERY_KIND_DISTANCE
 * or SWIFTPROX_QUERY_KIND_INTERSECTION. The ground counts as a set of points. Guarantees and `config` are as for
 * swiftprox_pair_distance and swiftprox_pair_intersection. There is no cache.
 *
 * On failure the answer is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: another kind, or a member of config is out of range. The call
 * allocates about 4 kB.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_ground_distance(swiftprox_query_kind kind,
                                                struct swiftprox_placed object,
                                                struct swiftprox_placed_ground ground,
                                                const struct swiftprox_pair_config *config,
                                                struct swiftprox_ground_distance *answer);

/** The answer of a ray cast at a ground. */
typedef struct swiftprox_ground_ray_answer {
  /**
   * That of the triangle. The normal is that of its plane, against the ray, and the feature is in the ground's numbering: a face
   * is a triangle.
   */
  struct swiftprox_ray_answer answer;
  /** The triangle that is hit first; the number of triangles if none is. */
  uint32_t triangle;
} swiftprox_ground_ray_answer;

/**
 * Casts a ray at a ground and finds where it first meets the surface, from either side. Guarantees are as for
 * swiftprox_shape_cast_ray; the triangle is named, and the normal is its plane's, against the ray.
 *
 * On failure the answer is reset. Same errors as swiftprox_shape_cast_ray. The call allocates about 4 kB.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_ground_cast_ray(struct swiftprox_placed_ground ground,
                                           const struct swiftprox_ray *ray,
                                           struct swiftprox_ground_ray_answer *answer);

/** The answer of a cast of a body at a ground. */
typedef struct swiftprox_ground_cast_answer {
  /**
   * That of a cast of the body, object 1, at the surface as a set of points. Of several triangles that are hit
   * within the time tolerance, contact and proof are those of one, at times of its own.
   */
  struct swiftprox_cast_answer answer;
  /** The triangle that is hit, or nearly; the number of triangles if none is. */
  uint32_t triangle;
} swiftprox_ground_cast_answer;

/**
 * Decides whether a moving object stays farther from a ground at rest than config->max_distance, or when it first does not.
 * Guarantees and members are as for swiftprox_pair_cast; the ground is object 2, as a set of points, and its triangle is named.
 * There is no cache.
 *
 * On failure the answer is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: also if config->ignores_parting is set. Else same errors as
 * swiftprox_pair_cast. The call allocates about 4 kB.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_ground_cast(struct swiftprox_moving object,
                                            struct swiftprox_placed_ground ground,
                                            const struct swiftprox_cast_config *config,
                                            struct swiftprox_ground_cast_answer *answer);

/** One contact of a body, which is object 1, with a ground: points with one normal. */
typedef struct swiftprox_ground_contact {
  /**
   * Its normal is out of the ground. Its outcome is that of the body and the triangles that it meets with this normal; `lower`
   * and `upper` are the least gap of its points.
   */
  struct swiftprox_manifold manifold;
  /** The triangle that has the least. */
  uint32_t triangle;
  /** Start of the contact's points among all points. */
  size_t first_point;
} swiftprox_ground_contact;

/** Room for what swiftprox_pair_ground_contacts finds, by value. What does not fit is left out. */
typedef struct swiftprox_ground_room {
  /** Receives contacts, sorted by triangle. */
  struct swiftprox_ground_contact *contacts;
  /** Room of `contacts`; 0 allows null. */
  size_t contact_capacity;
  /** Receives points. Those of contact c begin at its first_point; there are manifold.point_count. */
  struct swiftprox_manifold_point *points;
  /** Room of `points`; 0 allows null. */
  size_t point_capacity;
} swiftprox_ground_room;

/** Numbers of contacts with a ground and of their points. */
typedef struct swiftprox_ground_count {
  /** Contacts found. */
  size_t contact_count;
  /** Points found. */
  size_t point_count;
} swiftprox_ground_count;

/**
 * Finds the contacts of a shape (object 1) with a ground, up to config->max_distance apart. Each contact has points and one normal
 * out of the ground. `room` receives what fits, `count` all numbers found.
 *
 * A triangle acts only on bodies whose centre of mass is not behind its plane by more than the ground's thickness. The normal is
 * the direction of least distance or overlap among those that are normal to the surface at the touched point. So bodies slide
 * freely over flat and concave edges, and no contact is much deeper than the body is in.
 *
 * If config->reduces is set, at most four points stay on each side of the body. Contacts with normals within 45 degrees of the
 * deepest are on one side.
 *
 * On failure the counts are 0; contacts and points are unchanged. Same errors as swiftprox_pair_manifold. SWIFTPROX_ERROR_LIMIT: a
 * capacity is larger than memory.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_ground_contacts(struct swiftprox_placed object,
                                                struct swiftprox_placed_ground ground,
                                                const struct swiftprox_manifold_config *config,
                                                struct swiftprox_ground_room room,
                                                struct swiftprox_ground_count *count);

/** @} */

/**
 * @defgroup swiftprox_scene_ground Scenes on a ground
 * @{
 */

/** Options of a scene's contacts with a ground or a half-space. Initialise with SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT. */
typedef struct swiftprox_scene_ground_config {
  /** Set by SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Largest gap of objects that have contacts, and of their points: from 0 (the default) to infinity. */
  double max_distance;
  /** Not 0: at most four points stay on each side of a body (swiftprox_pair_ground_contacts). Default: 0. */
  int32_t reduces;
  /**
   * The ground's groups, one bit each. An object is tested if its mask has a bit of them. Default: 0, which means the first, 1.
   * Grounds of the scene have their own.
   */
  uint32_t groups;
  /** An object is tested if its groups have a bit of this. Default: 0, which means all. */
  uint32_t mask;
} swiftprox_scene_ground_config;

/** Begins a swiftprox_scene_ground_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT {sizeof(swiftprox_scene_ground_config), 0, 0, 0, 0}

/** One contact of a piece, which is object 1, with a ground or a half-space. */
typedef struct swiftprox_scene_ground_contact {
  /** The object. */
  struct swiftprox_object_id object;
  /** The caller's own number of the object. */
  uint64_t user_data;
  /** The ground's object; null for what is in no scene. */
  struct swiftprox_object_id ground;
  /** Which piece. */
  uint32_t piece;
  /** As of the pair; its points are among those of all contacts. Of a half-space all bits of the triangle are set. */
  struct swiftprox_ground_contact contact;
} swiftprox_scene_ground_contact;

/** Contacts of objects of a scene with a ground or a half-space. Owned by the scratch and valid until its next use. */
typedef struct swiftprox_scene_ground_answer {
  /** Sorted by object, piece, ground and triangle. Null if contact_count is 0. */
  const struct swiftprox_scene_ground_contact *contacts;
  /** Number of contacts. */
  size_t contact_count;
  /** Points of contact c begin at its contact.first_point; there are contact.manifold.point_count. Null if point_count is 0. */
  const struct swiftprox_manifold_point *points;
  /** Number of points. */
  size_t point_count;
} swiftprox_scene_ground_answer;

/**
 * Finds the contacts of objects of a scene with grounds, up to config->max_distance apart. Contacts of each piece are as from
 * swiftprox_pair_ground_contacts. Null set: all objects, in order of creation. Fixed objects are skipped, unless set->poses gives
 * their poses; set->among is not read.
 *
 * If ground.ground and ground.pose are null, the grounds are the objects of the scene that are grounds, and the pairs those that
 * queries test. Else it is one that is in no scene: activation and the scene's pair filter do not apply.
 *
 * Threads: as for swiftprox_scene_least_distance. The scratch owns the results and must not be null. Once it is large enough, only
 * integer arithmetic allocates. On failure the answer is empty. Same errors as swiftprox_pair_manifold.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: also for a ground in the set, and for groups or a mask without a ground.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_ground_contacts(const struct swiftprox_scene *scene,
                                                 const struct swiftprox_object_set *set,
                                                 struct swiftprox_placed_ground ground,
                                                 const struct swiftprox_scene_ground_config *config,
                                                 struct swiftprox_scratch *scratch,
                                                 struct swiftprox_scene_ground_answer *answer);

/**
 * Like swiftprox_scene_ground_contacts for a half-space: one contact for each piece within config->max_distance, as from
 * swiftprox_pair_half_space_manifold. Its triangle is UINT32_MAX. Same errors as swiftprox_scene_ground_contacts and
 * swiftprox_pair_half_space_distance.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_half_space_contacts(const struct swiftprox_scene *scene,
                                                     const struct swiftprox_object_set *set,
                                                     const struct swiftprox_half_space *half_space,
                                                     const struct swiftprox_scene_ground_config *config,
                                                     struct swiftprox_scratch *scratch,
                                                     struct swiftprox_scene_ground_answer *answer);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
