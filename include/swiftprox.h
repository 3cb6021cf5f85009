/*
 * swiftprox: proximity queries between convex polyhedra with guaranteed answers.
 *
 * These conventions hold for all functions below.
 *
 * Names. Functions are named swiftprox_<noun>_<verb>; the noun is the first argument. Queries have the same names in all layers
 * (intersection, distance, contact, approximate): in swiftprox_pair_..., swiftprox_scene_query_... and swiftprox_query_kind. Flags
 * are int32_t: any nonzero argument means yes; results are 1 or 0.
 *
 * Failure. Functions that can fail return a swiftprox_status. SWIFTPROX_OK is 0, and compilers warn about ignored statuses.
 * swiftprox_library_last_error_message gives the thread's last message. A failed call changes only the outputs it names: their
 * unset real numbers are NaN, others 0 or null. Nothing is printed, and nothing unwinds into the caller.
 *
 * Functions list only errors that are special to them. General errors are: SWIFTPROX_ERROR_NULL_POINTER, a required pointer is
 * null; SWIFTPROX_ERROR_STRUCT_SIZE, a struct was not initialised with its constant, or an info's size was not set;
 * SWIFTPROX_ERROR_POSE, a pose is refused; SWIFTPROX_ERROR_HANDLE, an id names no object of the scene, or a shape, ground, compound
 * or scene was given back (noticed until other data take its memory); SWIFTPROX_ERROR_LIMIT, a count exceeds 32 bits;
 * SWIFTPROX_ERROR_CANCELLED, a progress callback stopped the call; SWIFTPROX_ERROR_MEMORY;
 * SWIFTPROX_ERROR_BUG, the library caught a bug of its own. For scenes also: SWIFTPROX_ERROR_BUSY, and SWIFTPROX_ERROR_POISONED
 * after a bug during a change: destroy that scene. Shapes never change, so no bug damages them. Functions that initialise, share or
 * release return no status: they ignore mistakes such as null pointers, and report them by message and log.
 *
 * Memory. If memory for arrays or exact integers is lacking, the call returns SWIFTPROX_ERROR_MEMORY. Then only caches may have
 * changed, and scenes stay usable. Other allocations are below 128 kB and do not grow with the input: handles, messages with paths,
 * and a few blocks below 256 bytes to report the lack of memory. If one of these fails, the program ends with a message.
 *
 * Pointers. Pointers must be aligned and valid for their types. Null options, configs, queries and tunings mean the defaults. Any
 * other null pointer is SWIFTPROX_ERROR_NULL_POINTER unless the function allows it. Arrays are copied or read only during the call.
 * Only swiftprox_library_set_log, swiftprox_library_set_allocator and swiftprox_library_register_mesh_reader keep pointers of the
 * caller.
 *
 * Threads. Calls that take an object by a const pointer may run concurrently on it. A non-const pointer needs exclusive use during
 * the call. Different objects are independent. The process shares the log, the allocator, registered mesh readers, a counter of
 * scenes for their ids, and the detected vector units; each thread has its own last message. A call on a scene in use, also from a
 * callback of that scene, returns SWIFTPROX_ERROR_BUSY and does nothing.
 *
 * Strings. They end in a zero byte. The library returns UTF-8. Paths are UTF-8 on Windows (else SWIFTPROX_ERROR_INVALID_ARGUMENT);
 * elsewhere their bytes go to the system unchanged. Messages show invalid UTF-8 of paths, files and callbacks as U+FFFD.
 *
 * Structs. Options, configs, queries, tunings and infos begin with struct_size and may grow at their end. Initialise the first four
 * with SWIFTPROX_..._DEFAULT; set an info's struct_size to its sizeof. Header and library may then differ within one interface.
 * Members that an older header's struct lacks have their defaults. Members that only a newer header knows stay 0 in infos and must
 * be 0 in arguments (else SWIFTPROX_ERROR_STRUCT_SIZE). For members added later, 0 means the earlier behaviour. All other structs
 * (answers, results, features, statistics, meshes, caches, ids) have a fixed size.
 *
 * Stability. Before the first release anything may change. After it, functions marked "Stable." keep their arguments, meaning and
 * fixed-size structs within a major version; within a minor version while the major version is 0. Functions marked "Experimental."
 * and their own types may change or go in any version.
 *
 * Enums. Each enum is a separate type of the size of int32_t, so compilers warn about mixed enums. Any number is safe to pass:
 * unknown numbers are refused, and have a string that says so.
 *
 * Determinism. On one machine, the same library gives the same calls the same bits, whatever other threads and scenes do. Verdicts
 * and the order of results are the same on every machine. Between processors with other vector units (none, AVX2, AVX-512) the last
 * bits of distances, points and normals may differ within the intervals; levels of detail may differ too. Where nearest points are
 * not unique, points, normals and features may differ entirely. A query with a step budget may stop elsewhere.
 *
 * Pair caches are plain bytes: copy, restore or zero them at any time. A simulation that returns to an earlier step gets the same
 * bits if it restores its caches, and the same verdicts in any case. Scenes own their caches: after a return verdicts are the same,
 * the last bits not always.
 *
 * Units and frames. Lengths are in the unit of the caller's vertices. A pose is 12 doubles, the row-major 3x4 matrix [R|T]; an
 * object is exactly R*v + T for its vertices v. R is accepted if every entry of R^T R - I is at most 1e-2 and det R > 0; it need
 * not be exactly orthonormal. The 16 numbers of OpenGL, glm and Eigen are column-major: swiftprox_pose_from_column_major. Frames
 * are right-handed; faces are counter-clockwise seen from outside.
 *
 * Floating-point environment. Any is allowed on x86-64 and AArch64: other rounding modes, flushed subnormals, trapped exceptions.
 * Answers are bit for bit those of the default one. Functions set the default environment and restore the program's before they
 * return. Callbacks run in the program's environment; their changes to it end with them. Calls clear no exception flags and may
 * raise any. Other processors need the default environment.
 *
 * Closed sets. Touching is intersecting. Intervals [lower, upper] contain the true distance, rounding included.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */
#ifndef SWIFTPROX_H
#define SWIFTPROX_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/**
 * Stands before functions whose status is not to be ignored: compilers warn. A cast to void silences the attribute of C23 and
 * C++17, and not that of GCC before: SWIFTPROX_IGNORE does so everywhere. A program that wants no such warnings defines this as
 * nothing.
 */
#ifndef SWIFTPROX_NODISCARD
#if (defined(__cplusplus) && __cplusplus >= 201703L) || (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L)
#define SWIFTPROX_NODISCARD [[nodiscard]]
#elif defined(__GNUC__)
#define SWIFTPROX_NODISCARD __attribute__((warn_unused_result))
#else
#define SWIFTPROX_NODISCARD
#endif
#endif

/** Makes a call and ignores its status on purpose, with no warning in any standard. */
#define SWIFTPROX_IGNORE(call) ((void)!(call))

/** What enums are made of: an int32_t, where the language lets them say so, else an int. Any number is safe to hand over. */
#ifndef SWIFTPROX_INT32
#if (defined(__cplusplus) && __cplusplus >= 201103L) || (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L)
#define SWIFTPROX_INT32 : int32_t
#else
#define SWIFTPROX_INT32
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_library Version, statuses and messages
 * @{
 */

/** Major version of this header. Programs need a library with the same one. */
#define SWIFTPROX_VERSION_MAJOR 0

/** Minor version of this header. While the major version is 0, each minor version is another interface. */
#define SWIFTPROX_VERSION_MINOR 2

/** Patch version of this header. */
#define SWIFTPROX_VERSION_PATCH 0

/**
 * Version of the running library as "major.minor.patch". Never null, valid forever.
 *
 * Stable.
 */
const char *swiftprox_library_version(void);

/** Status of a call. */
typedef enum swiftprox_status SWIFTPROX_INT32 {
  /** Success. */
  SWIFTPROX_OK = 0,
  /** A required pointer is null; the message names the argument. */
  SWIFTPROX_ERROR_NULL_POINTER = 1,
  /** An argument is out of range, not finite or unknown; the message names it. */
  SWIFTPROX_ERROR_INVALID_ARGUMENT = 2,
  /**
   * A struct was not initialised with its SWIFTPROX_..._DEFAULT, or a newer header's struct sets members unknown to this
   * library.
   */
  SWIFTPROX_ERROR_STRUCT_SIZE = 3,
  /** A pose is refused: an entry is not finite, an entry of R^T R - I exceeds the limit, or det R is not positive. */
  SWIFTPROX_ERROR_POSE = 4,
  /** A mesh breaks the rules; the message names the face, edge or vertex in the caller's numbering. */
  SWIFTPROX_ERROR_MESH = 5,
  /** A file cannot be read, written or parsed; the message names file and line. */
  SWIFTPROX_ERROR_FILE = 6,
  /** An object id is null, stale or from another scene. */
  SWIFTPROX_ERROR_HANDLE = 7,
  /** A limit of the library is exceeded: a count does not fit. */
  SWIFTPROX_ERROR_LIMIT = 8,
  /** A callback asked to stop. */
  SWIFTPROX_ERROR_CANCELLED = 9,
  /** The library caught a bug of its own. Please report the message. */
  SWIFTPROX_ERROR_BUG = 10,
  /** An earlier call on this handle met a bug. It can only be destroyed. */
  SWIFTPROX_ERROR_POISONED = 11,
  /** Header and library do not fit together. */
  SWIFTPROX_ERROR_VERSION = 12,
  /** A verify function found that an answer is wrong for these shapes and poses; the message says where. */
  SWIFTPROX_ERROR_UNVERIFIED = 13,
  /** The library was built without this feature. */
  SWIFTPROX_ERROR_UNSUPPORTED = 14,
  /** Memory is lacking; the message says how much was requested. Only caches may have changed. The same call may succeed later. */
  SWIFTPROX_ERROR_MEMORY = 15,
  /** The scene is in use by another thread or by an enclosing call. Nothing has changed. */
  SWIFTPROX_ERROR_BUSY = 16
} swiftprox_status;

/** Does not compile where enums are not as large as an int32_t, as with -fshort-enums. */
typedef char swiftprox_enums_are_32_bits[sizeof(swiftprox_status) == 4 ? 1 : -1];

/**
 * Checks whether this library fits the program's header. Call it once with SWIFTPROX_VERSION_MAJOR, SWIFTPROX_VERSION_MINOR and
 * SWIFTPROX_VERSION_PATCH.
 *
 * SWIFTPROX_ERROR_VERSION: the library is too old or has another interface; the message gives both versions.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_library_check_version(int32_t major,
                                                 int32_t minor,
                                                 int32_t patch);

/**
 * Message of this thread's last call that did not return SWIFTPROX_OK; empty before the first. Never null; valid until the next
 * such call of the thread, or its end.
 *
 * Stable.
 */
const char *swiftprox_library_last_error_message(void);

/**
 * Returns the text for a status. Never null, valid forever, also for unknown numbers.
 *
 * Stable.
 */
const char *swiftprox_library_status_string(swiftprox_status status);

/** @} */

/**
 * @defgroup swiftprox_shape Shapes
 * @{
 */

/**
 * Geometry for queries: immutable, shared by any number of owners. Only data made when a query first needs them are ever added:
 * look-up tables of the body and of its levels, maps of its support function, automatic levels.
 */
typedef struct swiftprox_shape swiftprox_shape;

/** The policy for input that is not a closed convex mesh with interior. */
typedef enum swiftprox_input SWIFTPROX_INT32 {
  /** Refuse it with a message that says where. */
  SWIFTPROX_INPUT_STRICT = 0,
  /** Admit bodies without interior (a two-sided polygon); otherwise as strict. */
  SWIFTPROX_INPUT_FLAT = 1,
  /**
   * Take the convex hull of the vertices, of any dimension, also of those that belong to no face. Faces label the hull if one of
   * the other two would admit the mesh; otherwise they are ignored, and a face's label is its own index.
   */
  SWIFTPROX_INPUT_HULL = 2,
  /**
   * Same as flat, for a mesh that is convex up to the precision of its coordinates: the convex hull counts. A mesh whose faces
   * all run clockwise seen from outside is turned. Vertices and faces keep the caller's indices. A vertex that the hull
   * swallows is never the feature of an answer; a face that it swallows shares the hull's face over it, and is named where it
   * is the nearest of those that share. Without a convexity tolerance the coordinates tell it, before the input transform:
   * four units of the last place in which they are written (decimals, significant digits, floats), at most 0.005 of the
   * bounding box's diagonal.
   */
  SWIFTPROX_INPUT_NEARLY_CONVEX = 3,
  /**
   * The faces are a part of the surface of their vertices' hull, or all of it: that hull counts, of any dimension. Vertices of
   * no face, which some mesh files have, are left out. A face of the hull on which no face of the mesh lies is called
   * SWIFTPROX_NO_FACE. Whether the faces do lie on the hull is not checked: no verdict and no distance depends on it.
   */
  SWIFTPROX_INPUT_PATCH = 4
} swiftprox_input;

/** The label of a face of a patch's hull on which none of the caller's faces lies: UINT32_MAX. */
#define SWIFTPROX_NO_FACE UINT32_MAX

/**
 * Receives the progress of a long call: a fraction from 0 to 1 that never falls, and the caller's pointer. It returns 0 to
 * continue; other numbers end the call with SWIFTPROX_ERROR_CANCELLED. It runs in the calling thread, must return and must not use
 * the call's objects. A C++ exception that leaves it ends the program.
 */
typedef int32_t (*swiftprox_progress_callback)(void *user, double fraction);

/** Options of a new shape. Initialise with SWIFTPROX_SHAPE_OPTIONS_DEFAULT. */
typedef struct swiftprox_shape_options {
  /** Set by SWIFTPROX_SHAPE_OPTIONS_DEFAULT. */
  size_t struct_size;
  /** How to treat input that is not a closed convex mesh with interior. Default: refuse it. */
  swiftprox_input input;
  /**
   * Row-major rotation. A stored vertex is scale * (rotation * v) + translation, rounded to doubles once. The local frame is the
   * frame after this transform. Default: identity.
   */
  double rotation[9];
  /** See rotation. Default: 0. */
  double translation[3];
  /** See rotation; positive. Default: 1. */
  double scale;
  /**
   * How far a vertex may lie outside a face, relative to the bounding-box diagonal. Default: negative, which means 1e-9, or 1e-6
   * for single-precision meshes (STL). With SWIFTPROX_INPUT_NEARLY_CONVEX it is at least the result of
   * swiftprox_mesh_estimate_tolerance.
   */
  double convexity_tolerance;
  /** Reports progress and can cancel. Default: null. */
  swiftprox_progress_callback progress;
  /** Passed to progress. Default: null. */
  void *progress_user;
  /** Levels of detail and look-up table (swiftprox/tuning.h). Default: null, automatic. */
  const struct swiftprox_shape_tuning *tuning;
  /**
   * Error of input coordinates, before scale. Manifolds treat vertices within it of one plane as one face. Distance and depth do
   * not change; gap intervals include it. Negative (the default): estimated from the input, at least 1e-6 of half the box's
   * diagonal. 0: rounding of doubles only. It must be finite (else SWIFTPROX_ERROR_INVALID_ARGUMENT).
   */
  double face_noise;
  /**
   * Radius of a ball swept over the body, in input units before scale. A point becomes a sphere, a segment a capsule; other
   * bodies get round edges and corners. All queries are of the swept body: witness points are on it, features are those of the
   * body without the ball. From 0 (the default) to 2^1000 (else SWIFTPROX_ERROR_INVALID_ARGUMENT).
   */
  double swept_radius;
} swiftprox_shape_options;

/** Begins a swiftprox_shape_options: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_SHAPE_OPTIONS_DEFAULT \
  {sizeof(swiftprox_shape_options), SWIFTPROX_INPUT_STRICT, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}, 1, -1, 0, 0, 0, -1, 0}

/** A polygon mesh, an argument by value. The caller owns the arrays. */
typedef struct swiftprox_mesh {
  /** 3 * vertex_count coordinates. */
  const double *vertices;
  /** Number of vertices. */
  size_t vertex_count;
  /** 0-based vertex numbers of all faces in turn, counter-clockwise seen from outside. */
  const uint32_t *indices;
  /** Number of vertices of each face; null means triangles. */
  const uint32_t *valences;
  /** Number of faces. */
  size_t face_count;
} swiftprox_mesh;

/**
 * Creates a shape from a polygon mesh. Release it with swiftprox_shape_release. The arrays are copied.
 *
 * Answers name features by the mesh's numbers of vertices and faces. Unless the options allow more, the mesh must be a closed,
 * consistently oriented, connected, convex 2-manifold without unused vertices.
 *
 * On failure `*shape` is null. SWIFTPROX_ERROR_MESH: the mesh breaks these rules, or a coordinate is not finite.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_mesh(struct swiftprox_mesh mesh,
                                                  const struct swiftprox_shape_options *options,
                                                  const struct swiftprox_shape **shape);

/**
 * Creates a shape from the convex hull of `point_count` points, 3 coordinates each. Release it with swiftprox_shape_release. The
 * array is copied. Answers name vertices by their place in `points` (the first of equal points). Faces are numbered from 0 to
 * below swiftprox_shape_info.face_count.
 *
 * On failure `*shape` is null. SWIFTPROX_ERROR_MESH: a coordinate is not finite, or the options refuse the hull's dimension (the
 * defaults require an interior). SWIFTPROX_ERROR_INVALID_ARGUMENT: no points, or an option out of range.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_points(const double *points,
                                                    size_t point_count,
                                                    const struct swiftprox_shape_options *options,
                                                    const struct swiftprox_shape **shape);

/**
 * Creates a shape from a mesh file. Release it with swiftprox_shape_release. The format is that of a registered reader
 * (swiftprox_library_register_mesh_reader) for the first bytes, else TRI, POLY, OFF, OBJ or STL by extension, else by content.
 * Answers count vertices and faces from 0 in file order or reader order. STL vertices count by first mention; STL triangles with
 * two equal corners do not count.
 *
 * On failure `*shape` is null. SWIFTPROX_ERROR_FILE: the file is unreadable, not a regular file, above 4 GiB or malformed; the
 * message names file and line. SWIFTPROX_ERROR_MESH: see swiftprox_shape_create_from_mesh.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_file(const char *path,
                                                  const struct swiftprox_shape_options *options,
                                                  const struct swiftprox_shape **shape);

/**
 * Creates the box [-x, x] x [-y, y] x [-z, z] from its half extents, 3 numbers. A ball of `radius` is swept over it: it rounds
 * edges and corners and enlarges the box; 0 keeps them sharp. In vertex i, bits 0, 1 and 2 of i mean positive x, y and z. Release
 * it with swiftprox_shape_release. On failure `*shape` is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a half extent is not positive, the radius is negative, or a number is above 2^1000 or NaN.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_box(const double *half_extents,
                                            double radius,
                                            const struct swiftprox_shape **shape);

/**
 * Creates the sphere with this radius about the local origin. Release it with swiftprox_shape_release. On failure `*shape` is
 * null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the radius is negative, above 2^1000 or NaN.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_sphere(double radius,
                                               const struct swiftprox_shape **shape);

/**
 * Creates a capsule: all points within `radius` of the segment with vertices 0 at (0, 0, -half_length) and 1 at (0, 0,
 * half_length). Release it with swiftprox_shape_release. On failure `*shape` is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a number is negative, above 2^1000 or NaN.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_capsule(double half_length,
                                                double radius,
                                                const struct swiftprox_shape **shape);

/**
 * Adds one reference to a shape and returns the shape. Each call needs its own swiftprox_shape_release. Safe from any thread. Null
 * returns null.
 *
 * Stable.
 */
const struct swiftprox_shape *swiftprox_shape_retain(const struct swiftprox_shape *shape);

/**
 * Drops one reference to a shape that the caller owns. The last reference frees the shape; scenes hold their own. Safe from any
 * thread. Null is ignored.
 *
 * Stable.
 */
void swiftprox_shape_release(const struct swiftprox_shape *shape);

/** Properties of a shape. Set struct_size to sizeof(swiftprox_shape_info) before the call. */
typedef struct swiftprox_shape_info {
  /** Set by the caller. */
  size_t struct_size;
  /** Dimension of the hull: 3. With some input policies also 2 (a two-sided polygon), 1 (a segment) or 0 (a point). */
  int32_t dimension;
  /** Vertices of the hull. */
  size_t vertex_count;
  /** Edges between faces that are not coplanar. */
  size_t edge_count;
  /** Faces; coplanar triangles count as one. */
  size_t face_count;
  /** Triangles of the hull, as in swiftprox_shape_copy_triangles. */
  size_t triangle_count;
  /** Volume; 0 without interior. */
  double volume;
  /** Centre of mass of the volume, in the local frame. Bodies without interior: centre of their area or length. */
  double centre_of_mass[3];
  /** Largest distance of a vertex from the centre of mass. */
  double radius;
  /** The corner of the bounding box with the least coordinates, in the local frame. */
  double lower_corner[3];
  /** The corner of the bounding box with the greatest coordinates, in the local frame. */
  double upper_corner[3];
  /** Memory of the shape in bytes, levels included; sharing does not change it. */
  size_t bytes;
  /**
   * Inertia tensor for mass 1 and uniform density about the centre of mass, in local axes. Row-major, symmetric, in length
   * squared; multiply it by the mass. Without interior the mass is spread over area or length.
   */
  double inertia[9];
  /** Radius of the swept ball (swiftprox_shape_options), in the local frame. All other members describe the body without it. */
  double swept_radius;
  /**
   * How far a cylinder, cone or ellipsoid reaches beyond its polyhedron at most, at any pose; 0 for other shapes. Volume, box
   * and inertia are the polyhedron's.
   */
  double deviation;
} swiftprox_shape_info;

/**
 * Writes the properties of a shape. Set info->struct_size to sizeof(swiftprox_shape_info) first. The inertia takes time linear in
 * the number of triangles. On failure real numbers are NaN, all else 0.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_info(const struct swiftprox_shape *shape,
                                          struct swiftprox_shape_info *info);

/**
 * Makes in advance the look-up table, support maps and automatic levels of detail, which queries make on first use. The levels
 * take about twice as long as making the shape. After that no query of this shape allocates or waits for them.
 *
 * `progress` (may be null, gets `progress_user`) reports progress, except while the table is made, and can cancel. Safe from any
 * thread; concurrent queries do not wait but may make the levels twice.
 *
 * SWIFTPROX_ERROR_CANCELLED, SWIFTPROX_ERROR_MEMORY: no levels are made, a finished table stays, and the shape stays usable.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_prepare(const struct swiftprox_shape *shape,
                                         swiftprox_progress_callback progress,
                                         void *progress_user);

/** @} */

/**
 * @defgroup swiftprox_pose Poses from what other libraries have
 * @{
 */

/**
 * Makes a pose, 12 doubles, from a quaternion x, y, z, w (the order of Eigen's coefficients and of ROS) and a translation.
 *
 * SWIFTPROX_ERROR_POSE: a number is not finite, or the quaternion's length is not 1 to 1e-2. The pose is then NaN.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pose_from_quaternion(const double *quaternion,
                                                const double *translation,
                                                double *pose);

/**
 * Makes a pose, 12 doubles, from the 16 numbers of a column-major 4x4 matrix, as OpenGL, glm and Eigen have them.
 *
 * SWIFTPROX_ERROR_POSE: the last row is not 0 0 0 1, as in a transposed matrix, or the pose is refused. The pose is then NaN.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pose_from_column_major(const double *matrix,
                                                  double *pose);

/** @} */

/**
 * @defgroup swiftprox_pair Pairs of shapes
 * @{
 */

/** The outcome of a pair query. */
typedef enum swiftprox_outcome SWIFTPROX_INT32 {
  /** Nothing is said yet: the value of a fresh answer. */
  SWIFTPROX_OUTCOME_NONE = 0,
  /** The objects are disjoint, `0 < lower <= distance <= upper`; `lower` is 0 only for a distance below the smallest double. */
  SWIFTPROX_OUTCOME_SEPARATED = 1,
  /**
   * The objects are disjoint and farther apart than `max_distance`. `lower` is at least that, `distance` is `lower`,
   * `upper` is infinity, and along the unit normal the objects are at least `lower` apart. Points and features stay unset.
   */
  SWIFTPROX_OUTCOME_BEYOND = 2,
  /** The closed objects have a common point (touching included). */
  SWIFTPROX_OUTCOME_INTERSECTING = 3,
  /**
   * The objects may be disjoint or not, `0 = lower <= distance <= upper`: the step budget of an approximate query ran out before
   * the verdict (SWIFTPROX_DECIDED_BY_BUDGET), or the deviation of a cylinder, cone or ellipsoid hides it. Then normal, points and
   * features are those of the polyhedra.
   */
  SWIFTPROX_OUTCOME_UNDECIDED = 4
} swiftprox_outcome;

/** The method that decided a pair query. */
typedef enum swiftprox_decided_by SWIFTPROX_INT32 {
  /** Nothing: the value of a fresh answer. */
  SWIFTPROX_DECIDED_BY_NONE = 0,
  /** Voronoi marching: it ended, and its certificate holds. */
  SWIFTPROX_DECIDED_BY_MARCHING = 1,
  /** What proved the last verdict, or nearly that: vertex pairs that enclose the origin, or a separating axis. */
  SWIFTPROX_DECIDED_BY_COHERENCE = 2,
  /** Support vertices of the Minkowski difference, in floating point: a walk for a verdict, else Gilbert-Johnson-Keerthi. */
  SWIFTPROX_DECIDED_BY_FALLBACK = 3,
  /** Integer arithmetic. */
  SWIFTPROX_DECIDED_BY_INTEGERS = 4,
  /** The errors that an approximate query may make: it stopped because its interval was narrow enough. */
  SWIFTPROX_DECIDED_BY_TOLERANCE = 5,
  /**
   * The step budget of an approximate query, which ran out: the interval holds, and the next query with the same cache goes on
   * from there.
   */
  SWIFTPROX_DECIDED_BY_BUDGET = 6,
  /** The bounding spheres: they are apart, and farther than `max_distance` if that is finite. */
  SWIFTPROX_DECIDED_BY_BOUNDING_SPHERES = 7,
  /** Balls inside the objects overlap. Such an answer carries no vertex pairs as its proof. */
  SWIFTPROX_DECIDED_BY_INSCRIBED_SPHERES = 8
} swiftprox_decided_by;

/** Kind of a feature. */
typedef enum swiftprox_feature_kind SWIFTPROX_INT32 {
  /** Nothing is said. */
  SWIFTPROX_FEATURE_KIND_NONE = 0,
  /** A vertex: `ids[0]` is its index in the caller's array. */
  SWIFTPROX_FEATURE_KIND_VERTEX = 1,
  /** An edge: `ids` are the caller's indices of its two end vertices. */
  SWIFTPROX_FEATURE_KIND_EDGE = 2,
  /**
   * A face: `ids[0]` is the caller's index of a polygon that holds the witness point; of a contact of
   * objects deep in each other one along which they overlap least. Of a hull that was made without polygons it is a
   * number of the hull's own, from 0 and below its number of faces.
   */
  SWIFTPROX_FEATURE_KIND_FACE = 3
} swiftprox_feature_kind;

/** A feature in the caller's numbering. */
typedef struct swiftprox_feature {
  /** Vertex, edge or face. */
  swiftprox_feature_kind kind;
  /** See swiftprox_feature_kind; unused entries are 0. */
  uint32_t ids[2];
} swiftprox_feature;

/** Work of a query. */
typedef struct swiftprox_statistics {
  /** Voronoi marching: feature pairs visited. */
  uint32_t marching_steps;
  /** Support vertices of a verdict's walk; else Gilbert-Johnson-Keerthi iterations, of the fallback and of approximate queries. */
  uint32_t fallback_iterations;
  /** Iterations in integer arithmetic. It allocates, and so does a query that makes a table or levels. */
  uint32_t exact_iterations;
  /** The levels of detail of object 1 and object 2 that the answer comes from; 0 is the object itself. */
  uint16_t levels[2];
} swiftprox_statistics;

/**
 * The answer to a pair query. Unset numbers are NaN, features SWIFTPROX_FEATURE_KIND_NONE; a separated answer always
 * has a normal.
 */
typedef struct swiftprox_pair_answer {
  /** Disjoint, beyond `max_distance`, or intersecting. */
  swiftprox_outcome outcome;
  /** Which rung of the search decided. */
  swiftprox_decided_by decided_by;
  /** The best estimate, `lower <= distance <= upper`; 0 when intersecting. */
  double distance;
  /** Lower end of the rigorous interval; 0 when intersecting. */
  double lower;
  /** Upper end of the rigorous interval; 0 when intersecting; +infinity for SWIFTPROX_OUTCOME_BEYOND. */
  double upper;
  /** Witness point on object 1, in its local frame. */
  double local1[3];
  /** Witness point on object 2, in its local frame. */
  double local2[3];
  /** Witness point on object 1, in the world frame. */
  double world1[3];
  /** Witness point on object 2, in the world frame. */
  double world2[3];
  /** Unit normal in the world frame, from object 2 to object 1. */
  double normal[3];
  /** Nearest feature of object 1. */
  struct swiftprox_feature feature1;
  /** Nearest feature of object 2. */
  struct swiftprox_feature feature2;
  /** Intersecting: vertex pairs, in the caller's numbering, whose differences hold the origin in their hull. */
  uint32_t proof[4][2];
  /**
   * How many entries of `proof` are used: 1 to 4 when intersecting, except for SWIFTPROX_DECIDED_BY_INSCRIBED_SPHERES and
   * where objects intersect by their swept radii alone, else 0.
   */
  uint32_t proof_count;
  /** Work of the query. */
  struct swiftprox_statistics statistics;
} swiftprox_pair_answer;

/** A shape at a pose, an argument of pair queries by value. Both pointers are only read during the call. */
typedef struct swiftprox_placed {
  /** The shape. */
  const struct swiftprox_shape *shape;
  /** 12 doubles, the row-major 3x4 matrix [R|T]. */
  const double *pose;
} swiftprox_placed;

/**
 * The cache of a pair, owned by the caller. Zero it before the first query; any bytes are safe. It affects speed, never the
 * verdict.
 */
typedef struct swiftprox_pair_cache {
  /** Opaque. */
  uint32_t words[24];
} swiftprox_pair_cache;

/** Options of a pair query. Initialise with SWIFTPROX_PAIR_CONFIG_DEFAULT. */
typedef struct swiftprox_pair_config {
  /** Set by SWIFTPROX_PAIR_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Pairs farther apart than this get SWIFTPROX_OUTCOME_BEYOND. From 0 to infinity (the default: never). */
  double max_distance;
  /**
   * For swiftprox_pair_approximate: allowed upper - lower, from 0 to infinity. Default: 0. Other queries ignore this and the two
   * members below, even out of range.
   */
  double absolute_error;
  /**
   * For swiftprox_pair_approximate: allowed (upper - lower) / lower, from 0 to infinity. It is enough to meet one of the two
   * errors. Both 0 (the default): as narrow as exact answers.
   */
  double relative_error;
  /**
   * For swiftprox_pair_approximate: the largest number of marching steps, 1 or more. UINT32_MAX (the default): no limit. It does
   * not limit the methods that decide what marching leaves open. The next query with the same cache continues, unless
   * tuning->start makes it begin anew; then it may stop there every time.
   */
  uint32_t step_budget;
  /** Start and levels of detail (swiftprox/tuning.h). Default: null, the automatic choice. */
  const struct swiftprox_pair_tuning *tuning;
} swiftprox_pair_config;

/** Begins a swiftprox_pair_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_PAIR_CONFIG_DEFAULT {sizeof(swiftprox_pair_config), HUGE_VAL, 0, 0, UINT32_MAX, 0}

/**
 * Computes the distance of two objects: a rigorous interval, witness points, normal and features. For intersecting pairs the
 * distance is 0 and the answer holds the proof; points, normal and features are unset (see swiftprox_pair_contact). Pairs beyond
 * config->max_distance get less, see SWIFTPROX_OUTCOME_BEYOND. Unset numbers are NaN, unset features
 * SWIFTPROX_FEATURE_KIND_NONE.
 *
 * Keep one `cache` per pair, zeroed at first, and pass the objects in the same order. On failure the answer is reset and its
 * outcome is SWIFTPROX_OUTCOME_NONE; SWIFTPROX_ERROR_BUG also resets the cache.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of config is out of range.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_distance(struct swiftprox_placed object1,
                                         struct swiftprox_placed object2,
                                         struct swiftprox_pair_cache *cache,
                                         const struct swiftprox_pair_config *config,
                                         struct swiftprox_pair_answer *answer);

/**
 * Like swiftprox_pair_distance, but intersecting pairs also get a common point, the unit normal of least overlap and the features
 * there. The common point is the witness point of both objects. Normal and features are those of swiftprox_pair_depth, which also
 * gives the depth. Same arguments and errors as swiftprox_pair_distance.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_contact(struct swiftprox_placed object1,
                                        struct swiftprox_placed object2,
                                        struct swiftprox_pair_cache *cache,
                                        const struct swiftprox_pair_config *config,
                                        struct swiftprox_pair_answer *answer);

/**
 * Decides only whether two objects intersect. The outcome is SWIFTPROX_OUTCOME_INTERSECTING, SWIFTPROX_OUTCOME_SEPARATED with
 * lower > 0 and an upper that may be loose, or, with a finite config->max_distance, SWIFTPROX_OUTCOME_BEYOND. It is faster
 * than the distance for bodies that intersect or nearly do. Same arguments and errors as swiftprox_pair_distance.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_intersection(struct swiftprox_placed object1,
                                             struct swiftprox_placed object2,
                                             struct swiftprox_pair_cache *cache,
                                             const struct swiftprox_pair_config *config,
                                             struct swiftprox_pair_answer *answer);

/**
 * Computes the distance to a given error: it stops when upper - lower is at most config->absolute_error or
 * config->relative_error * lower. [lower, upper] contains the distance; `distance` is lower unless the answer is exact. Points and
 * features are unset in answers from support maps or levels of detail.
 *
 * The verdict is guaranteed as in swiftprox_pair_distance, unless the step budget ran out (SWIFTPROX_DECIDED_BY_BUDGET). The next
 * call with the same cache then continues, unless config->tuning->start makes it begin anew. Same arguments and errors as
 * swiftprox_pair_distance.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_approximate(struct swiftprox_placed object1,
                                            struct swiftprox_placed object2,
                                            struct swiftprox_pair_cache *cache,
                                            const struct swiftprox_pair_config *config,
                                            struct swiftprox_pair_answer *answer);

/** @} */

/**
 * @defgroup swiftprox_depth How deep objects are in each other
 * @{
 */

/** How a depth query ended. */
typedef enum swiftprox_depth_ending SWIFTPROX_INT32 {
  /** Nothing was asked yet. */
  SWIFTPROX_DEPTH_ENDING_NONE = 0,
  /** The interval is as narrow as was asked for, or as double precision can prove. */
  SWIFTPROX_DEPTH_ENDING_NARROW = 1,
  /** A direction separates the objects. */
  SWIFTPROX_DEPTH_ENDING_SEPARATED = 2,
  /** Integer arithmetic decided what rounding hides: whether the objects are apart, touch or overlap. Touching is depth 0. */
  SWIFTPROX_DEPTH_ENDING_INTEGERS = 3,
  /** The step budget was spent; the interval holds. */
  SWIFTPROX_DEPTH_ENDING_BUDGET = 4,
  /** No further vertex could be added to the proof: it has no room for more, or rounding hides where. The interval holds. */
  SWIFTPROX_DEPTH_ENDING_STALLED = 5
} swiftprox_depth_ending;

/** Work of a depth query. */
typedef struct swiftprox_depth_statistics {
  /** Expansions of the proof. */
  uint32_t steps;
  /** Support vertices asked for. */
  uint32_t supports;
  /** Triangles of the proof. */
  uint32_t triangles;
  /** Iterations in integer arithmetic, which allocates. */
  uint32_t exact_iterations;
} swiftprox_depth_statistics;

/**
 * How deep two objects are in each other. Unset numbers are NaN, features of no kind.
 *
 * The depth is the length of the shortest translation after which a plane has one object on either side: 0 of objects that touch,
 * and of flat ones that lie in one plane. Moving object 1 by `depth * normal`, or object 2 by the opposite, parts them, as far as
 * the interval is wide.
 */
typedef struct swiftprox_depth_answer {
  /**
   * SWIFTPROX_OUTCOME_INTERSECTING (touching included) or SWIFTPROX_OUTCOME_SEPARATED. Of separated objects only a normal that
   * separates them is said, and a depth of 0.
   */
  swiftprox_outcome outcome;
  /** How the query ended. */
  swiftprox_depth_ending ending;
  /** The best estimate, `lower <= depth <= upper`. */
  double depth;
  /** Lower end of the rigorous interval; more than 0 only for objects that overlap. */
  double lower;
  /** Upper end of the rigorous interval; 0 only for objects that touch, or are separated. */
  double upper;
  /** Witness point on object 1, in its local frame: among those that are deepest in object 2 along the normal. */
  double local1[3];
  /** Witness point on object 2, in its local frame. */
  double local2[3];
  /** Witness point on object 1, in the world frame; `world2 - world1` is `depth * normal` up to rounding. */
  double world1[3];
  /** Witness point on object 2, in the world frame. */
  double world2[3];
  /** Unit normal in the world frame, from object 2 to object 1, along which the objects overlap by `upper` at most. */
  double normal[3];
  /** The feature of object 1 that holds its witness point. */
  struct swiftprox_feature feature1;
  /** The feature of object 2 that holds its witness point. */
  struct swiftprox_feature feature2;
  /** Work of the query. */
  struct swiftprox_depth_statistics statistics;
} swiftprox_depth_answer;

/**
 * The depth cache of a pair, owned by the caller. Zero it before the first query; any bytes are safe. It affects speed, and the
 * choice between equal directions of least overlap, but never the verdict or the validity of the interval.
 */
typedef struct swiftprox_depth_cache {
  /** Opaque. */
  uint32_t words[256];
} swiftprox_depth_cache;

/** Options of a depth query. Initialise with SWIFTPROX_DEPTH_CONFIG_DEFAULT. */
typedef struct swiftprox_depth_config {
  /** Set by SWIFTPROX_DEPTH_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Allowed upper - lower, from 0 to infinity. Default: 0. */
  double absolute_error;
  /**
   * Allowed (upper - lower) / lower, from 0 to infinity. It is enough to meet one of the two errors. Both 0 (the default): as
   * narrow as double precision can prove.
   */
  double relative_error;
  /**
   * The largest number of expansions, 1 or more. UINT32_MAX (the default): the library's own limit, 400. After that integers
   * still decide the verdict.
   */
  uint32_t step_budget;
} swiftprox_depth_config;

/** Begins a swiftprox_depth_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_DEPTH_CONFIG_DEFAULT {sizeof(swiftprox_depth_config), 0, 0, UINT32_MAX}

/**
 * Computes the penetration depth: the length of the least translation that separates two objects. The answer has a rigorous
 * interval, unit normal, witness points and features. Touching is depth 0, decided in integers. For separated objects it gives
 * only the verdict and a separating normal; swiftprox_pair_distance gives the distance.
 *
 * Same arguments and errors as swiftprox_pair_distance. The cache is for depths only.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_depth(struct swiftprox_placed object1,
                                      struct swiftprox_placed object2,
                                      struct swiftprox_depth_cache *cache,
                                      const struct swiftprox_depth_config *config,
                                      struct swiftprox_depth_answer *answer);

/** @} */

/**
 * @defgroup swiftprox_manifold Where objects meet
 * @{
 */

/**
 * The cache of a pair for manifold, signed distance and depth, owned by the caller. Zero it before the first query; any bytes are
 * safe.
 */
typedef struct swiftprox_manifold_cache {
  /** Opaque. */
  uint32_t words[384];
} swiftprox_manifold_cache;

/** A distance that is negative where objects overlap. Unset numbers are NaN, features of no kind. */
typedef struct swiftprox_signed_distance {
  /**
   * SWIFTPROX_OUTCOME_INTERSECTING (touching included), SWIFTPROX_OUTCOME_SEPARATED, or SWIFTPROX_OUTCOME_BEYOND
   * `max_distance`: then `lower` is all that is known, which `distance` repeats, and `upper` is infinite.
   */
  swiftprox_outcome outcome;
  /** The best estimate, `lower <= distance <= upper`: how far the objects are apart, or minus how deep they are in each other. */
  double distance;
  /** Lower end of the rigorous interval; more than 0 only of objects that are apart, and of all of those. */
  double lower;
  /** Upper end of the rigorous interval; at most 0 of objects that overlap or touch. */
  double upper;
  /** Witness point on object 1, in its local frame. */
  double local1[3];
  /** Witness point on object 2, in its local frame. */
  double local2[3];
  /** Witness point on object 1, in the world frame; `world1 - world2` is `distance * normal` up to rounding. */
  double world1[3];
  /** Witness point on object 2, in the world frame. */
  double world2[3];
  /** Unit normal in the world frame, from object 2 to object 1: moving object 1 along it makes the distance grow as much. */
  double normal[3];
  /** Feature that holds the witness point of object 1. */
  struct swiftprox_feature feature1;
  /** Feature that holds the witness point of object 2. */
  struct swiftprox_feature feature2;
} swiftprox_signed_distance;

/**
 * Computes the distance of separated objects, or minus the penetration depth of overlapping ones; touching is 0. The answer has
 * one rigorous interval, unit normal, witness points and features. It is as reliable as swiftprox_pair_distance and
 * swiftprox_pair_depth.
 *
 * Pairs beyond config->max_distance get less, see SWIFTPROX_OUTCOME_BEYOND. Allowed errors and step budget are ignored. Same
 * arguments and errors as swiftprox_pair_distance, but with a manifold cache.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_signed_distance(struct swiftprox_placed object1,
                                                struct swiftprox_placed object2,
                                                struct swiftprox_manifold_cache *cache,
                                                const struct swiftprox_pair_config *config,
                                                struct swiftprox_signed_distance *answer);

/**
 * One contact point: a point of each object, in line along the normal.
 *
 * Each is on its object, up to rounding and half of what a contact face is thick. They are in line up to 2^-27 of the pair's size
 * and twice what the contact faces of both are thick: a corner that is no farther outside the other's face has the nearest point
 * of that.
 *
 * The gap is certified: each object has a point, no farther from the one that is said than it may be off, and the gap of these two
 * along the normal is in the interval. That holds in exact arithmetic, for the doubles of shapes, poses and normal. So an interval
 * never lies below, or above, the gaps of all points of the objects.
 */
typedef struct swiftprox_manifold_point {
  /** On object 1, in its local frame. */
  double local1[3];
  /** On object 2, in its local frame. */
  double local2[3];
  /** On object 1, in the world frame. */
  double world1[3];
  /** On object 2, in the world frame. */
  double world2[3];
  /**
   * The gap: how far the point on object 1 is from that on object 2 along the normal. At least this; negative where the objects
   * overlap ...
   */
  double gap_lower;
  /** ... and at most. */
  double gap_upper;
  /** Feature that holds the point on object 1, in the caller's numbering. */
  struct swiftprox_feature feature1;
  /** Feature that holds the point on object 2. */
  struct swiftprox_feature feature2;
  /** Id made of the two features; it stays while they do. */
  uint64_t id;
} swiftprox_manifold_point;

/** Contact points of two objects that meet, or nearly do. */
typedef struct swiftprox_manifold {
  /** SWIFTPROX_OUTCOME_INTERSECTING, SWIFTPROX_OUTCOME_SEPARATED within `max_distance`, or SWIFTPROX_OUTCOME_BEYOND it. */
  swiftprox_outcome outcome;
  /** 1 or 2: the object whose face is the reference; 0 where no face is, and the manifold has but one point. */
  uint32_t reference;
  /** The distance of the objects is at least this; of overlapping ones their depth is at most minus this. */
  double lower;
  /** The distance is at most this; the depth at least minus this. */
  double upper;
  /**
   * Unit normal in the world frame, from object 2 to object 1: along which they are as far apart, or overlap as little, as the
   * interval says.
   */
  double normal[3];
  /** Points written. */
  uint32_t point_count;
  /** Points found, before any were left out. */
  uint32_t found_count;
} swiftprox_manifold;

/** Output of swiftprox_pair_manifold, by value. `{points, capacity, NULL}` requests only points. */
typedef struct swiftprox_manifold_room {
  /** Room for `capacity` points; null if that is 0. */
  struct swiftprox_manifold_point *points;
  /** Room in points. Further points are left out; swiftprox_manifold.found_count counts them too. */
  size_t capacity;
  /** Receives the result of swiftprox_pair_signed_distance without a further search; may be null. */
  struct swiftprox_signed_distance *distance;
} swiftprox_manifold_room;

/** Options of a manifold query. Initialise with SWIFTPROX_MANIFOLD_CONFIG_DEFAULT. */
typedef struct swiftprox_manifold_config {
  /** Set by SWIFTPROX_MANIFOLD_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Largest gap of objects that have a manifold, and of its points: from 0 (the default) to infinity, which admits all. */
  double max_distance;
  /**
   * Nonzero: at most four points are kept, none is moved. They are the deepest, the farthest from it and the extremes on either
   * side of the line through both. The last query's four, from the cache, stay while about as deep and as wide. 0 (the default):
   * all.
   */
  int32_t reduces;
} swiftprox_manifold_config;

/** Begins a swiftprox_manifold_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_MANIFOLD_CONFIG_DEFAULT {sizeof(swiftprox_manifold_config), 0, 0}

/**
 * Computes where two objects meet or are at most config->max_distance apart: pairs of points along the normal, each with its gap.
 * Points are written to room.points up to its capacity; manifold->found_count is the total. room.distance, if not null, receives
 * the signed distance. Objects farther apart get no points and SWIFTPROX_OUTCOME_BEYOND.
 *
 * Vertices within the shape's face_noise (swiftprox_shape_options) of one plane are one face; gap intervals are guaranteed for the
 * exact objects. Points are on their objects up to half a face's thickness, and in line up to twice its thickness plus 7.5e-9 of
 * the pair's size. Corners closer than 3e-8 of that size, or four thicknesses, are merged. One point has the full depth.
 * Completeness of a face is not guaranteed.
 *
 * Same arguments and errors as swiftprox_pair_distance, but with a manifold cache. On failure the manifold is reset and points are
 * unchanged.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_manifold(struct swiftprox_placed object1,
                                         struct swiftprox_placed object2,
                                         struct swiftprox_manifold_cache *cache,
                                         const struct swiftprox_manifold_config *config,
                                         struct swiftprox_manifold_room room,
                                         struct swiftprox_manifold *manifold);

/** @} */

/**
 * @defgroup swiftprox_scene Scenes
 * @{
 */

/** Objects, their poses, and the pairs that queries test. Create one with swiftprox_scene_create. */
typedef struct swiftprox_scene swiftprox_scene;

/**
 * Runs the items of a task from `first` up to, but not including, `end`; `context` is the one passed with the task. Any threads
 * may call it, several at once, each item once.
 */
typedef void (*swiftprox_task_callback)(uint32_t first, uint32_t end, void *context);

/**
 * Must call `task` once for each item below `item_count`, in any ranges, from any threads, with `context`. `user` is the pointer
 * given with the callback. Returns the task for swiftprox_finish_task_callback, or null if all is done already. It must return; a
 * C++ exception that leaves it ends the program.
 */
typedef void *(*swiftprox_enqueue_task_callback)(swiftprox_task_callback task,
                                                 uint32_t item_count,
                                                 void *context,
                                                 void *user);

/**
 * Must return when the task from swiftprox_enqueue_task_callback is done. It must return; a C++ exception that leaves it ends the
 * program.
 */
typedef void (*swiftprox_finish_task_callback)(void *task, void *user);

/** How a scene is made. Initialise with SWIFTPROX_SCENE_OPTIONS_DEFAULT. */
typedef struct swiftprox_scene_options {
  /** Set by SWIFTPROX_SCENE_OPTIONS_DEFAULT. */
  size_t struct_size;
  /**
   * Number of threads for a query, or for poses that are set together, including the caller's. It changes no bit of any
   * answer. Some work uses the caller's thread only: queries that stop early, queries without a max_distance over many objects,
   * and few pairs or objects. Numbers above 256 mean 256. Default: 0, which means 1.
   */
  uint32_t worker_count;
  /**
   * Starts work on the program's own threads. Default: null, and finish_task too: the scene then has threads of its own,
   * which wait between calls. swiftprox_scene_create starts them, and does without threads that cannot start.
   * swiftprox_scene_destroy ends them and waits. After fork() the child has none; its calls use the caller's thread. exit()
   * does not wait for them. Destroy all scenes before the library is unloaded.
   */
  swiftprox_enqueue_task_callback enqueue_task;
  /** Waits for the work that enqueue_task started. Default: null. */
  swiftprox_finish_task_callback finish_task;
  /** Passed to both callbacks. Default: null. */
  void *task_user;
} swiftprox_scene_options;

/** Begins a swiftprox_scene_options: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_SCENE_OPTIONS_DEFAULT {sizeof(swiftprox_scene_options), 0, 0, 0, 0}

/**
 * Creates an empty scene. The caller owns it and frees it with swiftprox_scene_destroy. Null `options` mean the defaults. On
 * failure `*scene` is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: only one of enqueue_task and finish_task is null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_create(const struct swiftprox_scene_options *options,
                                        struct swiftprox_scene **scene);

/**
 * Destroys a scene, even a poisoned one. It releases its shares of shapes; its ids and results become invalid. Null is ignored.
 *
 * SWIFTPROX_ERROR_BUSY: another call uses the scene, which stays alive. After all other errors the scene is gone.
 * SWIFTPROX_ERROR_BUG: some memory may be lost. SWIFTPROX_ERROR_FILE, SWIFTPROX_ERROR_MEMORY: the end of its recording is missing.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_destroy(struct swiftprox_scene *scene);

/** @} */

/**
 * @defgroup swiftprox_object Objects of a scene
 * @{
 */

/**
 * Names an object of a scene. All zero, the default, names none; the id of a removed object is refused
 * for ever, that of another scene unless about a million scenes were made in between.
 */
typedef struct swiftprox_object_id {
  uint64_t bits;
} swiftprox_object_id;

/** Names no object. In C it is a compound literal of C99; swiftprox_object_id id = {0} does in every standard. */
#if defined(__cplusplus)
#define SWIFTPROX_OBJECT_ID_NULL (swiftprox_object_id())
#else
#define SWIFTPROX_OBJECT_ID_NULL ((swiftprox_object_id){0})
#endif

/** How an object is made. Initialise with SWIFTPROX_OBJECT_OPTIONS_DEFAULT. */
typedef struct swiftprox_object_options {
  /** Set by SWIFTPROX_OBJECT_OPTIONS_DEFAULT. */
  size_t struct_size;
  /** The caller's number; every result returns it. Default: 0. */
  uint64_t user_data;
  /** Its pose, row-major [R|T]. Default: the identity. */
  double pose[12];
  /** Not 0: pairs of two fixed objects are never tested. A fixed object can still be moved. Default: 0. */
  int32_t fixed;
  /**
   * Its groups, one bit each. Two objects are tested if each one's mask has a bit of the other's groups. Default: 0, which
   * means the first group only, 1.
   */
  uint32_t groups;
  /** The groups it is tested against. Default: 0, which means all. */
  uint32_t mask;
  /** A ground that the object is, instead of pieces; experimental. It is always fixed. Default: null. */
  const struct swiftprox_ground *ground;
  /** A compound that the object is, instead of pieces; experimental. Default: null. */
  const struct swiftprox_compound *compound;
} swiftprox_object_options;

/** Begins a swiftprox_object_options: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_OBJECT_OPTIONS_DEFAULT \
  {sizeof(swiftprox_object_options), 0, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 0, 0, 0, NULL, NULL}

/**
 * Adds an object of one or more convex pieces in one local frame. All its pairs are active. The scene takes its own share of each
 * shape, so the caller may release its shares at once. Null `options` mean the defaults. On failure `*id` is null.
 *
 * With options->ground and a piece_count of 0 it adds that ground. Results name the ground as piece 0, and the triangle as a
 * feature that is a face. swiftprox_scene_set_pose moves it. Functions about pieces refuse it. Two grounds make no pair.
 *
 * With options->compound and a piece_count of 0 it adds that compound as one body. A pair of objects with it has one result, the
 * first proof or the nearest pieces, named as piece1 or piece2; with a detail one result for each two pieces in reach. Functions
 * about pieces refuse it.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: no pieces, ground or compound, or more than one of them.
 * SWIFTPROX_ERROR_LIMIT: more objects or pieces than a scene holds.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_add_object(struct swiftprox_scene *scene,
                                            const struct swiftprox_shape *const *pieces,
                                            size_t piece_count,
                                            const struct swiftprox_object_options *options,
                                            struct swiftprox_object_id *id);

/**
 * Adds one object of one convex piece for each of `count` shapes, in order, like swiftprox_scene_add_object. `options` is an array
 * of `count` structs, each initialised with SWIFTPROX_OBJECT_OPTIONS_DEFAULT, or null for the defaults. `ids` receives the ids.
 *
 * On failure nothing is added and all ids are null. The message names the first refused place. Same errors as
 * swiftprox_scene_add_object. SWIFTPROX_ERROR_STRUCT_SIZE: also if the options differ in size.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_add_objects(struct swiftprox_scene *scene,
                                             const struct swiftprox_shape *const *shapes,
                                             const struct swiftprox_object_options *options,
                                             size_t count,
                                             struct swiftprox_object_id *ids);

/**
 * Removes an object and its pairs. Its id becomes invalid; all other ids stay valid.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_remove_object(struct swiftprox_scene *scene, struct swiftprox_object_id id);

/**
 * Removes `count` objects and their pairs, like swiftprox_scene_remove_object.
 *
 * On failure nothing is removed; the message names the first refused id. SWIFTPROX_ERROR_HANDLE: it names no object of this scene.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: it is given twice.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_remove_objects(struct swiftprox_scene *scene,
                                                const struct swiftprox_object_id *ids,
                                                size_t count);

/**
 * Sets `*valid` to 1 if the id names an object of this scene, else to 0. It is 0 for a null id, an id of another scene, a removed
 * object, and on failure. Two ids name the same object if their bits are equal.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_is_object_valid(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id,
                                                 int32_t *valid);

/**
 * Moves an object, also a fixed one. `pose` is 12 doubles, row-major [R|T]. On failure the object does not move.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pose(struct swiftprox_scene *scene,
                                          struct swiftprox_object_id id,
                                          const double *pose);

/**
 * Like swiftprox_scene_set_pose, with a row-major 3x3 `rotation` and a `translation`.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_transform(struct swiftprox_scene *scene,
                                               struct swiftprox_object_id id,
                                               const double *rotation,
                                               const double *translation);

/**
 * Moves `count` objects, also fixed ones. `poses` holds 12 doubles per id; the last pose of a repeated id counts. Null `ids` means
 * all objects that are not fixed, in order of creation. Workers share the work if ids are in order of creation. On failure no
 * object moves; the message names the refused pose or id.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: ids is null, and count is not the number of objects that are not fixed.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_poses(struct swiftprox_scene *scene,
                                           const struct swiftprox_object_id *ids,
                                           const double *poses,
                                           size_t count);

/**
 * Like swiftprox_scene_set_poses, with 9 doubles of `rotations` and 3 of `translations` per object.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_transforms(struct swiftprox_scene *scene,
                                                const struct swiftprox_object_id *ids,
                                                const double *rotations,
                                                const double *translations,
                                                size_t count);

/** Properties of an object. Set struct_size to sizeof(swiftprox_object_info) before the call. */
typedef struct swiftprox_object_info {
  /** Set by the caller. */
  size_t struct_size;
  /** The caller's number. */
  uint64_t user_data;
  /** Number of convex pieces; 0 for a ground or a compound. */
  size_t piece_count;
  /** Its pose, row-major [R|T]. */
  double pose[12];
  /** 1 if it is fixed, else 0. */
  int32_t fixed;
  /** Its groups, one bit each. */
  uint32_t groups;
  /** The groups it is tested against. */
  uint32_t mask;
  /** The ground that it is, or null; experimental. The scene owns the share. */
  const struct swiftprox_ground *ground;
  /** The compound that it is, or null; experimental. The scene owns the share. */
  const struct swiftprox_compound *compound;
} swiftprox_object_info;

/**
 * Writes an object's properties. Set info->struct_size to sizeof(swiftprox_object_info) first. On failure the pose is NaN, all
 * else 0.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_object_info(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id,
                                                 struct swiftprox_object_info *info);

/**
 * Sets an object's user data, pose, fixed flag, groups and mask. Fill info with swiftprox_scene_get_object_info, then change
 * members. An unchanged pose moves nothing. Pair caches are kept.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: piece_count, ground or compound differs from the object's, and nothing has changed; or a
 * ground is not to be fixed.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_object_info(struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id,
                                                 const struct swiftprox_object_info *info);

/** @} */

/**
 * @defgroup swiftprox_query Queries over a scene
 * @{
 */

/** Default of swiftprox_scene_query.max_distance: 0 for swiftprox_scene_query_contact, infinity for all other queries. */
#define SWIFTPROX_DEFAULT_MAX_DISTANCE (-1.0)

/** Details that a query of contacts returns for each pair beside its answer. */
typedef enum swiftprox_contact_detail SWIFTPROX_INT32 {
  /** Nothing. */
  SWIFTPROX_CONTACT_DETAIL_NONE = 0,
  /** How deep intersecting pairs are in each other. */
  SWIFTPROX_CONTACT_DETAIL_DEPTH = 1,
  /** That, and the manifold, also of listed pairs that are apart. */
  SWIFTPROX_CONTACT_DETAIL_MANIFOLD = 2,
  /**
   * That, and of more than four points of a manifold four: the deepest, the farthest from it and the extremes on either side of
   * the line between them. None is moved.
   */
  SWIFTPROX_CONTACT_DETAIL_REDUCED_MANIFOLD = 3
} swiftprox_contact_detail;

/**
 * Which pairs of convex pieces a query lists for every two objects, of those within its distance. Pieces of compounds make pairs
 * only for contacts with a detail.
 */
typedef enum swiftprox_piece_pairs SWIFTPROX_INT32 {
  /** Every pair. */
  SWIFTPROX_PIECE_PAIRS_EVERY = 0,
  /** The first pair in the order of results. Later ones are not tested: where it is apart, another may intersect. */
  SWIFTPROX_PIECE_PAIRS_FIRST = 1,
  /**
   * The nearest pair: the first that intersects, else the first with the least upper. Its lower is the least of all, so its
   * interval holds the distance between the two objects. If no pair intersects but one is undecided, the listed outcome is
   * undecided. Earlier queries may decide between pairs whose intervals overlap.
   */
  SWIFTPROX_PIECE_PAIRS_NEAREST = 2
} swiftprox_piece_pairs;

/** Options of a query over a scene. Initialise with SWIFTPROX_SCENE_QUERY_DEFAULT. */
typedef struct swiftprox_scene_query {
  /** Set by SWIFTPROX_SCENE_QUERY_DEFAULT. */
  size_t struct_size;
  /**
   * Pairs whose true distance is at most this are listed, from 0 to infinity (all pairs). Intersecting pairs, and pairs that
   * a step budget leaves undecided, are always listed. Default: SWIFTPROX_DEFAULT_MAX_DISTANCE, which is 0 for contacts, else
   * infinity. swiftprox_scene_query_intersection only checks its range.
   */
  double max_distance;
  /** swiftprox_scene_query_approximate: upper - lower of a pair may be at most the larger of this ... Default: 0. */
  double absolute_error;
  /** ... and this times lower. Default: 0. If both are 0, intervals are as narrow as exact answers. */
  double relative_error;
  /**
   * swiftprox_scene_query_approximate: if finite, the limit of the sum of upper - lower over all listed pairs, beyond what
   * exact answers need. It replaces both errors. Only pairs that support maps or levels of detail can answer with a share of
   * it take one. All other pairs are answered exactly. So are all pairs if the scene does not keep all pairs
   * (swiftprox_scene_set_kept_pair_limit). Default: infinity.
   */
  double error_budget;
  /**
   * swiftprox_scene_query_approximate: the largest number of marching steps per pair, 1 or more. A pair then stops with the
   * interval it has. Default: UINT32_MAX, no limit.
   */
  uint32_t step_budget;
  /**
   * Not 0: stop at the first intersecting pair, in the order of results, of those that piece_pairs selects. It is
   * swiftprox_scene_answer.found; no pairs are listed then. Default: 0.
   */
  int32_t early_exit;
  /** Where pairs start and which levels of detail they use (swiftprox/tuning.h). Default: null, the automatic choice. */
  const struct swiftprox_pair_tuning *tuning;
  /**
   * swiftprox_scene_query_contact: what each pair's contact adds to its answer. absolute_error, relative_error and
   * step_budget then apply to the depths. Other queries refuse it. Default: SWIFTPROX_CONTACT_DETAIL_NONE.
   */
  swiftprox_contact_detail detail;
  /** swiftprox_scene_query_placed: the groups of objects to test, one bit each. Default: 0, which means all. */
  uint32_t mask;
  /** Which pairs of pieces are listed for every two objects. Default: SWIFTPROX_PIECE_PAIRS_EVERY. */
  swiftprox_piece_pairs piece_pairs;
} swiftprox_scene_query;

/** Begins a swiftprox_scene_query: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_SCENE_QUERY_DEFAULT \
  {sizeof(swiftprox_scene_query), SWIFTPROX_DEFAULT_MAX_DISTANCE, 0, 0, HUGE_VAL, UINT32_MAX, 0, 0, SWIFTPROX_CONTACT_DETAIL_NONE, 0, SWIFTPROX_PIECE_PAIRS_EVERY}

/** One pair of convex pieces in a query's list. A compound is named with the piece that the answer is about. */
typedef struct swiftprox_pair_result {
  /** The earlier created object. */
  struct swiftprox_object_id object1;
  /** The later created object. */
  struct swiftprox_object_id object2;
  /** The caller's own number of object 1. */
  uint64_t user_data1;
  /** The caller's own number of object 2. */
  uint64_t user_data2;
  /** Which piece of object 1. */
  uint32_t piece1;
  /** Which piece of object 2. */
  uint32_t piece2;
  /** The answer. */
  struct swiftprox_pair_answer answer;
} swiftprox_pair_result;

/** The results of a query over a scene. */
typedef struct swiftprox_scene_answer {
  /**
   * The listed pairs, sorted by object 1, object 2, piece 1, piece 2, with objects in order of creation. The scene owns
   * them. They are valid until its next query, swiftprox_scene_shrink, or its end. Objects may be moved, added and removed
   * meanwhile. Null if count is 0.
   */
  const struct swiftprox_pair_result *pairs;
  /** Number of pairs. */
  size_t count;
  /** 1 if any tested pair intersects, else 0. With SWIFTPROX_PIECE_PAIRS_FIRST later pairs are not tested. */
  int32_t intersecting;
  /**
   * The intersecting pair at which the query stopped (swiftprox_scene_query.early_exit), else null. Of the pairs
   * that swiftprox_scene_query.piece_pairs selects, it is the first intersecting one in the order of pairs, but a step
   * budget may leave an earlier one undecided. It holds the query's usual answer. Owned and valid as pairs.
   */
  const struct swiftprox_pair_result *found;
  /**
   * With swiftprox_scene_query.detail: one contact per listed pair, in the same order; after an early exit, only that of
   * found. Owned and valid as pairs. Null if contact_count is 0.
   */
  const struct swiftprox_contact *contacts;
  /** Number of contacts: 0 without a detail. */
  size_t contact_count;
  /**
   * The points of all manifolds; those of a contact begin at its first_point. Owned and valid as pairs. Null if point_count
   * is 0.
   */
  const struct swiftprox_manifold_point *points;
  /** Number of points. */
  size_t point_count;
} swiftprox_scene_answer;

/**
 * Lists the intersecting pairs, touching ones included. Each answer has only outcome, decided_by, proof, statistics, and distance,
 * lower and upper, which are 0. Cylinders, cones and ellipsoids that may intersect are listed, too, as undecided; `intersecting`
 * does not count them. A null `query` means the defaults. On failure the answer is empty.
 *
 * No accepted pair makes a query fail. SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of query is out of range, even one this query
 * does not use. SWIFTPROX_ERROR_MEMORY: no memory for a changed list of pairs; the next query tries again.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_intersection(struct swiftprox_scene *scene,
                                                    const struct swiftprox_scene_query *query,
                                                    struct swiftprox_scene_answer *answer);

/**
 * Lists the pairs within query->max_distance, intersecting ones included, with answers as from swiftprox_pair_distance.
 * Separated pairs have distance, lower, upper, points in all frames, normal and features. Intersecting pairs have the proof; for
 * them distance, lower and upper are 0. Same errors as swiftprox_scene_query_intersection.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_distance(struct swiftprox_scene *scene,
                                                const struct swiftprox_scene_query *query,
                                                struct swiftprox_scene_answer *answer);

/**
 * Like swiftprox_scene_query_distance, but each interval is only as narrow as query->absolute_error, relative_error or
 * error_budget require. Answers are as from swiftprox_pair_approximate. A pair whose step budget ran out before the verdict
 * (SWIFTPROX_OUTCOME_UNDECIDED) is listed, but does not count as intersecting. Same errors as swiftprox_scene_query_intersection.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_approximate(struct swiftprox_scene *scene,
                                                   const struct swiftprox_scene_query *query,
                                                   struct swiftprox_scene_answer *answer);

/**
 * Like swiftprox_scene_query_distance, with answers as from swiftprox_pair_contact. max_distance defaults to 0, so only touching
 * or intersecting pairs are listed.
 *
 * With a query->detail the answers are those of swiftprox_scene_query_distance, and answer->contacts holds depths and contact
 * points, as from swiftprox_pair_depth and swiftprox_pair_manifold. Same errors as swiftprox_scene_query_intersection.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_contact(struct swiftprox_scene *scene,
                                               const struct swiftprox_scene_query *query,
                                               struct swiftprox_scene_answer *answer);

/** A query of contacts returns this for a pair beside its answer. Parts not asked for are unset; with a ground all are. */
typedef struct swiftprox_contact {
  /** Depth of the two; unset if they do not intersect. */
  struct swiftprox_depth_answer depth;
  /** Their contact points. */
  struct swiftprox_manifold manifold;
  /** Start of the manifold's points among all points; there are manifold.point_count. */
  size_t first_point;
} swiftprox_contact;

/** A kind of query. */
typedef enum swiftprox_query_kind SWIFTPROX_INT32 {
  /** The verdict alone. */
  SWIFTPROX_QUERY_KIND_INTERSECTION = 0,
  /** The distance. */
  SWIFTPROX_QUERY_KIND_DISTANCE = 1,
  /** The distance, and of intersecting bodies a common point and a normal. */
  SWIFTPROX_QUERY_KIND_CONTACT = 2,
  /** The distance as narrow as asked for. */
  SWIFTPROX_QUERY_KIND_APPROXIMATE = 3
} swiftprox_query_kind;

/**
 * Runs a query of that kind over the pairs of one object. query->error_budget is ignored. max_distance defaults to 0 for
 * contacts, else to infinity. The time depends on the number of near pairs, if nothing else has moved.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: also for an unknown kind. Else same errors as swiftprox_scene_query_intersection.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_object(struct swiftprox_scene *scene,
                                              struct swiftprox_object_id id,
                                              swiftprox_query_kind kind,
                                              const struct swiftprox_scene_query *query,
                                              struct swiftprox_scene_answer *answer);

/**
 * Like swiftprox_scene_query_object, for a body outside the scene: `piece_count` convex pieces, each with its pose in the world.
 * In results object 1 is an object of the scene. Object 2 has the null id, and piece2 is an index into `pieces`. Objects whose
 * groups have a bit of query->mask are tested; their masks, activation and filters do not apply.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: also for no pieces or an unknown kind. Else same errors as swiftprox_scene_query_intersection.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_placed(struct swiftprox_scene *scene,
                                              const struct swiftprox_placed *pieces,
                                              size_t piece_count,
                                              swiftprox_query_kind kind,
                                              const struct swiftprox_scene_query *query,
                                              struct swiftprox_scene_answer *answer);

/** @} */

/**
 * @defgroup swiftprox_activation Which pairs a scene tests
 * @{
 */

/**
 * Sets whether queries test pairs of objects: `active` is not 0, or 0. Two ids select their pair, in either order, with all its
 * pairs of pieces. One null id selects all present pairs of the other object; two null ids select all present pairs. Pairs of
 * objects added later are active. Two fixed objects are never tested.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: both ids are equal.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pair_active(struct swiftprox_scene *scene,
                                                 const struct swiftprox_object_id *id1,
                                                 const struct swiftprox_object_id *id2,
                                                 int32_t active);

/**
 * Sets `*active` to 1 if the pair of two objects is active, else to 0. The order of the ids does not matter. On failure it is 0.
 *
 * Same errors as swiftprox_scene_set_pair_active.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_pair_active(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id1,
                                                 struct swiftprox_object_id id2,
                                                 int32_t *active);

/**
 * Returns whether a pair of objects is tested: not 0, or 0. object1 was created first; `user` is the pointer given with the
 * callback. It must always return the same for a pair. It runs in the thread that queries, must return, and must not use the
 * scene. A C++ exception that leaves it ends the program.
 */
typedef int32_t (*swiftprox_pair_filter_callback)(struct swiftprox_object_id object1,
                                                  struct swiftprox_object_id object2,
                                                  void *user);

/**
 * Sets a filter that decides which pairs of objects are tested. It is called once for each pair of pieces that comes near. Queries
 * of many objects without a max_distance call it each time. Null (the default): no filter. Each call of this function makes the
 * scene ask again about near pairs, so set the same filter again after its decisions change. Any thread that queries the scene may
 * call the filter.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pair_filter(struct swiftprox_scene *scene,
                                                 swiftprox_pair_filter_callback filter,
                                                 void *user);

/** @} */

/**
 * @defgroup swiftprox_listener What has begun, goes on and has ended
 * @{
 */

/** State of a pair or contact point since the listener's last query. */
typedef enum swiftprox_event_state SWIFTPROX_INT32 {
  /** It is listed and was not. */
  SWIFTPROX_EVENT_STATE_BEGAN = 1,
  /** It is listed and was. */
  SWIFTPROX_EVENT_STATE_PERSISTS = 2,
  /** It was listed and is not. */
  SWIFTPROX_EVENT_STATE_ENDED = 3
} swiftprox_event_state;

/** A pair of convex pieces that is listed, or was when the listener last asked. */
typedef struct swiftprox_pair_event {
  /** The earlier created object; it may have been removed since where the pair has ended. */
  struct swiftprox_object_id object1;
  /** The later created object. */
  struct swiftprox_object_id object2;
  /** The caller's own number of object 1; of a pair that has ended the one of then. */
  uint64_t user_data1;
  /** The caller's own number of object 2. */
  uint64_t user_data2;
  /** The caller's own number of the piece of object 1; as those of the objects. */
  uint64_t piece_user_data1;
  /** The caller's own number of the piece of object 2. */
  uint64_t piece_user_data2;
  /** Which piece of object 1. */
  uint32_t piece1;
  /** Which piece of object 2. */
  uint32_t piece2;
  /** State of the two pieces. */
  swiftprox_event_state state;
  /** State of the two objects; they are listed if any of their pieces are. */
  swiftprox_event_state objects_state;
  /** Its place among the pairs of the answer, and among contacts if they were asked for; SIZE_MAX where it has ended. */
  size_t result;
  /** Start of its points among all points of the events. */
  size_t first_point;
  /** How many: those of its contact in their order, and behind them those that are gone. */
  size_t point_count;
} swiftprox_pair_event;

/** A contact point that there is, or was when the listener last asked. */
typedef struct swiftprox_point_event {
  /** The point's id: within a pair points of equal ids are one for events. */
  uint64_t id;
  /** Its place among the points of the contacts; SIZE_MAX where it is gone. */
  size_t point;
  /** Its state. */
  swiftprox_event_state state;
} swiftprox_point_event;

/** The events of a listener. */
typedef struct swiftprox_listener_events {
  /**
   * All listed pairs, and pairs that are no longer listed, in the order of results. Owned by the listener; valid until its
   * next call or its end. Null if count is 0.
   */
  const struct swiftprox_pair_event *pairs;
  /** Number of pairs. */
  size_t count;
  /**
   * Their points, if the query asks for manifolds; those of a pair begin at its first_point. Owned and valid as pairs. Null
   * if point_count is 0.
   */
  const struct swiftprox_point_event *points;
  /** Number of points. */
  size_t point_count;
} swiftprox_listener_events;

/**
 * Remembers what its last query of a scene listed. Other listeners do not affect it. When it queries another scene, all pairs of
 * the former one have ended.
 */
typedef struct swiftprox_listener swiftprox_listener;

/**
 * Creates a listener with no history. The caller owns it and frees it with swiftprox_listener_destroy. On failure `*listener` is
 * null.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_listener_create(struct swiftprox_listener **listener);

/**
 * Frees a listener and the events it owns. Null is ignored.
 *
 * Experimental.
 */
void swiftprox_listener_destroy(struct swiftprox_listener *listener);

/**
 * Runs a query of that kind over all pairs, and reports the changes since the listener's last call. Pairs of pieces and contact
 * points have begun, persist or have ended; in the first call all begin. Contacts with query->detail
 * SWIFTPROX_CONTACT_DETAIL_MANIFOLD have points; answer->points holds their positions.
 *
 * Each listener has its own history, which other queries do not affect. Use one listener per max_distance; it defaults to 0 for
 * contacts, else infinity. Removed objects, deactivated pairs and pairs of another scene have ended. Recordings include the query.
 *
 * On failure answer and events are empty, and the history is unchanged. SWIFTPROX_ERROR_INVALID_ARGUMENT: also for an unknown
 * kind, or if query->early_exit is set. Else same errors as swiftprox_scene_query_contact.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_listen(struct swiftprox_scene *scene,
                                        struct swiftprox_listener *listener,
                                        swiftprox_query_kind kind,
                                        const struct swiftprox_scene_query *query,
                                        struct swiftprox_scene_answer *answer,
                                        struct swiftprox_listener_events *events);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
