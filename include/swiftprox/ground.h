/*
 * swiftprox. Grounds: half-spaces, triangles and heights, and where bodies stand on them. The conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_GROUND_H
#define SWIFTPROX_GROUND_H

#include "sets.h"

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
  /** Where its plane is: the product of the normal with any of its points. */
  double offset;
} swiftprox_half_space;

/**
 * The distance of a shape, which is object 1, from a half-space, or minus its depth, as of swiftprox_pair_signed_distance: the
 * interval holds for the exact shape and plane, and touching is decided in integers. The normal of the answer is the
 * half-space's, of unit length; its witness point is on the plane, in the world in both members, and its feature is of no kind.
 *
 * On failure the answer is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: the normal is 0, or a number of half_space is not finite.
 * SWIFTPROX_ERROR_POSE: the pose is refused. SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_half_space_distance(const struct swiftprox_shape *shape,
                                                    const double *pose,
                                                    const struct swiftprox_half_space *half_space,
                                                    struct swiftprox_signed_distance *answer);

/**
 * Where a shape, which is object 1, meets a half-space, or is up to config->margin apart: the corners of its face that looks most
 * at the plane, with a gap of at most the margin, and in any case its lowest point. Points and their room as of
 * swiftprox_pair_manifold; there is no cache, so that four points of a reduced manifold are chosen anew each time.
 *
 * Errors as of swiftprox_pair_half_space_distance and swiftprox_pair_manifold. On failure the manifold is reset, and points are as
 * they were.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_half_space_manifold(const struct swiftprox_shape *shape,
                                                    const double *pose,
                                                    const struct swiftprox_half_space *half_space,
                                                    const struct swiftprox_manifold_config *config,
                                                    struct swiftprox_manifold_point *points,
                                                    size_t capacity,
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
 * Makes a ground from triangles; the caller owns it and gives it back with swiftprox_ground_release. The arrays are copied.
 *
 * `vertices` holds 3 * vertex_count coordinates, `corners` the 0-based vertex numbers of 3 * triangle_count corners. The front of
 * a triangle, out of which it pushes, is where its corners go around counter-clockwise. Triangles may make any surface, or none.
 * Sides with equal ends are one, if two triangles have it, the one way round and the other; over it bodies slide. Triangles
 * without area, or smaller than 2^-200, are left out, and keep their numbers.
 *
 * On failure `*ground` is null. SWIFTPROX_ERROR_MESH: a coordinate is not finite or beyond 2^200, a triangle names a vertex that
 * is not there, or none has an area. SWIFTPROX_ERROR_LIMIT: more than 2^30 triangles, or a count that does not fit 32 bits.
 * SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER.
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
 * Makes a ground from heights over a grid in the plane of x and y; the caller owns it and gives it back with
 * swiftprox_ground_release. The heights are copied.
 *
 * `heights` holds rows * columns of them, row by row, each row along x; NaN is a hole. Vertex i * columns + j is at (j *
 * column_spacing, i * row_spacing, height). Each cell is cut from its least corner to its greatest, into two triangles that look
 * up. With c = i * (columns - 1) + j of the least corner, triangle 2 * c has the corner along x, triangle 2 * c + 1 the other. A
 * cell with a hole at a corner is a hole.
 *
 * On failure `*ground` is null. SWIFTPROX_ERROR_INVALID_ARGUMENT: fewer than two rows or columns, or a spacing that is not
 * positive and finite. SWIFTPROX_ERROR_MESH: a coordinate is infinite or beyond 2^200, or all is holes. SWIFTPROX_ERROR_LIMIT:
 * more than 2^29 heights. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER.
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
 * Gives the caller one more share of a ground, to be given back with a swiftprox_ground_release of its own; returns the ground.
 * Safe from any thread. Of null it returns null.
 *
 * Experimental.
 */
const struct swiftprox_ground *swiftprox_ground_retain(const struct swiftprox_ground *ground);

/**
 * Gives back one share of a ground that the caller owns; the last one frees it. Safe from any thread. Null is ignored.
 *
 * Experimental.
 */
void swiftprox_ground_release(const struct swiftprox_ground *ground);

/** What a ground is. */
typedef struct swiftprox_ground_info {
  /** Vertices, as they were given. */
  size_t vertex_count;
  /** Triangles, those included that are left out. */
  size_t triangle_count;
  /** Memory that it holds, in bytes. */
  size_t bytes;
} swiftprox_ground_info;

/**
 * Says what a ground is. On failure all is 0. SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_ground_get_info(const struct swiftprox_ground *ground,
                                           struct swiftprox_ground_info *info);

/** What is said of a body, which is object 1, and a ground. */
typedef struct swiftprox_ground_distance {
  /**
   * As of a body and the surface as a set of points. Features of object 2 are in the ground's numbering: vertices, edges by
   * their vertices, a face is a triangle. Of a pair beyond the tolerance nothing but `lower` is said.
   */
  struct swiftprox_pair_answer answer;
  /**
   * The triangle that the answer is about: the nearest, or the first that was found to intersect. It is the number of triangles
   * where the answer is about none.
   */
  uint32_t triangle;
} swiftprox_ground_distance;

/**
 * How far a shape, which is object 1, is from a ground, or whether they intersect, as `kind` says: SWIFTPROX_QUERY_KIND_DISTANCE
 * or SWIFTPROX_QUERY_KIND_INTERSECTION. The answer is as certain as that of swiftprox_pair_distance or
 * swiftprox_pair_intersection, of the ground as a set of points; `config` is as there. There is no cache.
 *
 * On failure the answer is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: another kind, or a member of config is out of range.
 * SWIFTPROX_ERROR_POSE: a pose is refused. SWIFTPROX_ERROR_MEMORY: some 4 kB are asked for. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_STRUCT_SIZE.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_ground_distance(swiftprox_query_kind kind,
                                                const struct swiftprox_shape *shape,
                                                const double *pose,
                                                const struct swiftprox_ground *ground,
                                                const double *ground_pose,
                                                const struct swiftprox_pair_config *config,
                                                struct swiftprox_ground_distance *answer);

/** One contact of a body, which is object 1, with a ground: points with one normal. */
typedef struct swiftprox_ground_contact {
  /**
   * Its normal is out of the ground. Its outcome is that of the body and the triangles that it meets with this normal; `lower`
   * and `upper` are the least gap of its points.
   */
  struct swiftprox_manifold manifold;
  /** The triangle that has the least. */
  uint32_t triangle;
  /** Where among all points those of the contact begin. */
  size_t first_point;
} swiftprox_ground_contact;

/** How many contacts there are with a ground, and points of all of them. */
typedef struct swiftprox_ground_count {
  /** Contacts found. */
  size_t contact_count;
  /** Points found. */
  size_t point_count;
} swiftprox_ground_count;

/**
 * Where a shape, which is object 1, meets a ground, or is up to config->margin apart: contacts, each of points with one normal out
 * of the ground, sorted by triangle. `contacts` and `points` receive as many as there is room for, and may be null with no room;
 * `count` says how many there are. Points of contact c are those from its first_point on, as many as its manifold.point_count.
 *
 * A triangle acts on bodies whose centre of mass is not behind its plane. The normal is the one along which the body and the
 * triangle are nearest, or overlap least, where that is normal to the surface at the point that is touched; else it is the
 * triangle's. So no flat or concave edge between triangles holds up a body that slides over it.
 *
 * On failure the counts are 0, and contacts and points are as they were. SWIFTPROX_ERROR_INVALID_ARGUMENT,
 * SWIFTPROX_ERROR_STRUCT_SIZE: as of swiftprox_pair_manifold. SWIFTPROX_ERROR_POSE: a pose is refused. SWIFTPROX_ERROR_LIMIT: a
 * capacity is larger than memory. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_ground_contacts(const struct swiftprox_shape *shape,
                                                const double *pose,
                                                const struct swiftprox_ground *ground,
                                                const double *ground_pose,
                                                const struct swiftprox_manifold_config *config,
                                                struct swiftprox_ground_contact *contacts,
                                                size_t contact_capacity,
                                                struct swiftprox_manifold_point *points,
                                                size_t point_capacity,
                                                struct swiftprox_ground_count *count);

/** @} */

/**
 * @defgroup swiftprox_scene_ground Scenes on a ground
 * @{
 */

/**
 * The groups that something is in which is in no scene, and those that it is tested against, as of an object: it is asked about an
 * object if the mask of each has a bit of the other's groups.
 */
typedef struct swiftprox_group_filter {
  /** One bit for each group; the default is the first. */
  uint32_t groups;
  /** One bit for each group; the default is all. */
  uint32_t mask;
} swiftprox_group_filter;

/** One contact of a piece, which is object 1, with a ground or a half-space. */
typedef struct swiftprox_scene_ground_contact {
  /** Whose piece it is. */
  struct swiftprox_object_id object;
  /** The caller's own number of the object. */
  uint64_t user_data;
  /** Which piece. */
  uint32_t piece;
  /** As of the pair; its points are among those of all contacts. Of a half-space all bits of the triangle are set. */
  struct swiftprox_ground_contact contact;
} swiftprox_scene_ground_contact;

/** Where objects of a scene meet a ground or a half-space. Owned by the scratch and valid until its next use. */
typedef struct swiftprox_scene_ground_answer {
  /** By object, piece and triangle. Null when contact_count is 0. */
  const struct swiftprox_scene_ground_contact *contacts;
  /** How many. */
  size_t contact_count;
  /**
   * Points of contact c are those from its contact.first_point on, as many as its contact.manifold.point_count. Null when
   * point_count is 0.
   */
  const struct swiftprox_manifold_point *points;
  /** How many. */
  size_t point_count;
} swiftprox_scene_ground_answer;

/**
 * Where objects of a scene meet a ground that is in no scene, or are up to config->margin apart from it: piece by piece what
 * swiftprox_pair_ground_contacts says. set is who is asked; null: all objects, in order of creation. An object is asked if its
 * groups have a bit of filter->mask and its mask has a bit of filter->groups; a null filter has group 1 and all bits in its mask.
 * Activation and the scene's filter are about pairs of objects, and do not count. Fixed objects are left out, unless set->poses
 * says where they are; set->among is not looked at. config->rotation_limit is for the ground's pose. Threads as of
 * swiftprox_scene_least_distance; the scratch owns contacts and points and must not be null. Once it is large enough, only
 * integer arithmetic asks for memory.
 *
 * On failure the answer is empty. SWIFTPROX_ERROR_INVALID_ARGUMENT, SWIFTPROX_ERROR_STRUCT_SIZE: as of swiftprox_pair_manifold.
 * SWIFTPROX_ERROR_POSE: a pose is refused. SWIFTPROX_ERROR_HANDLE: an id names no object of this scene. SWIFTPROX_ERROR_BUSY: the
 * scene is being changed. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_POISONED.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_ground_contacts(const struct swiftprox_scene *scene,
                                                 const struct swiftprox_object_set *set,
                                                 const struct swiftprox_ground *ground,
                                                 const double *ground_pose,
                                                 const struct swiftprox_manifold_config *config,
                                                 const struct swiftprox_group_filter *filter,
                                                 struct swiftprox_scratch *scratch,
                                                 struct swiftprox_scene_ground_answer *answer);

/**
 * The same of a half-space: a contact for each piece that is within the margin, as swiftprox_pair_half_space_manifold says; its
 * triangle is UINT32_MAX. Errors as of swiftprox_scene_ground_contacts; SWIFTPROX_ERROR_INVALID_ARGUMENT also as of
 * swiftprox_pair_half_space_distance.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_half_space_contacts(const struct swiftprox_scene *scene,
                                                     const struct swiftprox_object_set *set,
                                                     const struct swiftprox_half_space *half_space,
                                                     const struct swiftprox_manifold_config *config,
                                                     const struct swiftprox_group_filter *filter,
                                                     struct swiftprox_scratch *scratch,
                                                     struct swiftprox_scene_ground_answer *answer);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
