/*
 * swiftprox: certified proximity queries between convex polyhedra.
 *
 * Conventions, which hold for every function below:
 *
 * Names. swiftprox_<noun>_<verb>; the noun comes first in the arguments. What is asked has one name over all layers: intersection,
 * distance, contact, approximate, in swiftprox_pair_..., swiftprox_scene_query_... and swiftprox_query_kind. Flags are an
 * int32_t: given, any number but 0 is yes; returned, yes is 1.
 *
 * Failure. What can fail returns a swiftprox_status: SWIFTPROX_OK is 0, and compilers warn where one is ignored.
 * swiftprox_library_last_error_message says what was wrong and where, for each thread. A call that fails
 * changes nothing but the outputs it names. What initialises, shares and releases returns none: a mistake there, such as a null
 * pointer, is ignored and told by that message and the log. Nothing is printed, nothing unwinds into the caller. A bug of the
 * library, when it is caught, comes back as SWIFTPROX_ERROR_BUG; a scene that was being changed answers
 * SWIFTPROX_ERROR_POISONED from then on and can only be destroyed. What a shape holds never changes once made, so no bug can
 * spoil it. What a failed call does not say is NaN where it is a real number, else 0 or null.
 *
 * Memory. Arrays in proportion to what the caller gives, to a file or to a scene may be refused, and so may integers of the exact
 * tier, small as they are: the call then ends in SWIFTPROX_ERROR_MEMORY, as each that allocates may. Nothing has changed but what a
 * cache remembers of a search, and a scene lives on. What else is allocated is small, in blocks of less than 128 kB that do not
 * grow with the input: a handle's own record, messages with the path of a file, and a few blocks of less than 256 bytes by which a
 * lack of memory is told. Where that is refused the program ends with a message.
 *
 * Pointers. They are aligned and live as their types say. A null options, config, query or tuning means the defaults; another null
 * pointer is SWIFTPROX_ERROR_NULL_POINTER unless the function says otherwise. Arrays are copied or only read during the call;
 * nothing keeps a pointer of the caller except swiftprox_library_set_log, swiftprox_library_set_allocator and
 * swiftprox_library_register_mesh_reader.
 *
 * Threads. A function that takes an object by a const pointer may run concurrently with any other such call on it; a pointer that
 * is not const needs exclusive use during the call; different objects need no care. All that a process has one of: the log, the
 * allocator, the mesh readers that are registered, a count of scenes, by which their ids differ, and which vector units the
 * processor has; and a last message for each thread. Every call on a scene that another call uses answers SWIFTPROX_ERROR_BUSY and
 * does nothing, where the rules are broken and where a callback calls the scene that it was called from.
 *
 * Strings. They end in a zero byte. Messages and all other strings that the library gives are UTF-8. Paths are UTF-8 on Windows
 * (others are SWIFTPROX_ERROR_INVALID_ARGUMENT), elsewhere bytes that go to the system as they are, UTF-8 as a rule; what of a
 * path, of a file's content or of a callback's message is not UTF-8 stands in messages as U+FFFD.
 *
 * Structs. Options, configs, queries, tunings and infos begin with struct_size and may grow at their end. The program's compiler
 * says it: begin the first four with their SWIFTPROX_..._DEFAULT and change members, set an info's struct_size to its sizeof. Then
 * header and library may differ within an interface. A smaller struct of an older header is read and written as far as it goes, what it lacks
 * is the default. Of a larger struct of a newer header this library leaves 0 what it does not know, and refuses by
 * SWIFTPROX_ERROR_STRUCT_SIZE one that sets it: a member that is added later means by 0 what was done before. All others (answers,
 * results, features, statistics, meshes, caches, ids) have a fixed size.
 *
 * Stability. Nothing has been released, and until the first release anything may change. From then on a function that ends in
 * "Stable." keeps its arguments, its meaning and the structs of fixed size that it takes: within a major version, while that is 0
 * within a minor one. One that ends in "Experimental." may change or go in any version, and so may what it alone takes or fills.
 *
 * Enums. Each is a type of its own, as large as an int32_t, so that compilers warn where two are mixed up. Any number is safe to
 * hand over: those that are no enumerators are refused, and get words that say so.
 *
 * Determinism. The same library on the same machine answers the same calls with the same bits, whatever other threads and
 * scenes do. Verdicts and the order of results are the same on every machine. Between processors with other vector units (none,
 * AVX2, AVX-512) the last bits of distances, points and normals may differ, always within the intervals, and so may the levels
 * of detail that are made there. Where nearest points are not unique, points, normals and features may differ as a whole; a
 * query with a step budget may stop elsewhere. A pair's cache is plain bytes: it may be copied, put back and set to zero at any
 * time. A simulation that goes back to an earlier step gets the same bits again if it puts the caches back, and the same
 * verdicts in any case. A scene keeps its caches to itself: going back gives the same verdicts, not always the same last bits.
 *
 * Units and frames. Lengths are in the unit of the caller's vertices. A pose is 12 doubles, the row-major 3x4 matrix [R|T]: an
 * object is R*v + T over its vertices v, exactly as the doubles give it. R is accepted when every entry of R^T R - I is at most
 * 1e-2 and det R > 0; nothing assumes that it is perfectly orthonormal. Right-handed, faces counter-clockwise from outside.
 *
 * Floating-point environment. It may be any: another rounding, subnormal numbers flushed to zero, exceptions trapped. On x86-64 and
 * AArch64 the answers are bit for bit those in the default one. A function sets that where the program's differs, and puts the
 * program's back before it returns. Functions of the program's that it calls find the program's own; what they change of it ends
 * with them. A call clears no flag of an exception and may raise any. On other processors the environment must be the default one.
 *
 * Closed sets. Touching is intersecting. An interval [lower, upper] holds the true distance, rounding included.
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

/** Major version of this header: programs compiled with another one do not go with this library. */
#define SWIFTPROX_VERSION_MAJOR 0

/** Minor version of this header. While the major version is 0, another minor version is another interface. */
#define SWIFTPROX_VERSION_MINOR 2

/** Patch version of this header. */
#define SWIFTPROX_VERSION_PATCH 0

/**
 * The version of the library that runs, as "major.minor.patch". Never null, valid for ever.
 *
 * Stable.
 */
const char *swiftprox_library_version(void);

/** What a call returns. The numbers are never reused. */
typedef enum swiftprox_status SWIFTPROX_INT32 {
  /** The call did what it says. */
  SWIFTPROX_OK = 0,
  /** A pointer that must not be null is null: the message names the argument. */
  SWIFTPROX_ERROR_NULL_POINTER = 1,
  /** An argument is out of range, not finite or unknown: the message names it. */
  SWIFTPROX_ERROR_INVALID_ARGUMENT = 2,
  /**
   * A struct_size is unknown: the struct was not begun with its SWIFTPROX_..._DEFAULT. Or the struct comes from a newer header and
   * sets what this library does not know.
   */
  SWIFTPROX_ERROR_STRUCT_SIZE = 3,
  /** A pose is refused: an entry is not finite, an entry of R^T R - I is beyond the limit, or det R is not positive. */
  SWIFTPROX_ERROR_POSE = 4,
  /** A mesh breaks the contract: the message names the face, edge or vertex in the caller's numbering. */
  SWIFTPROX_ERROR_MESH = 5,
  /** A file cannot be read or written, or does not parse: the message names the file and the line. */
  SWIFTPROX_ERROR_FILE = 6,
  /** An object id is null, stale or of another scene. */
  SWIFTPROX_ERROR_HANDLE = 7,
  /** A limit of the library is reached: a count that does not fit. */
  SWIFTPROX_ERROR_LIMIT = 8,
  /** A callback asked to stop. */
  SWIFTPROX_ERROR_CANCELLED = 9,
  /** A bug of the library, caught: please report the message. */
  SWIFTPROX_ERROR_BUG = 10,
  /** The handle met a bug in an earlier call; all that can be done with it is to destroy it. */
  SWIFTPROX_ERROR_POISONED = 11,
  /** The program was compiled with a header that does not go with this library. */
  SWIFTPROX_ERROR_VERSION = 12,
  /** The answer given to swiftprox_pair_verify does not hold for these shapes and poses: the message says what does not. */
  SWIFTPROX_ERROR_UNVERIFIED = 13,
  /** The library was built without what the call is about. */
  SWIFTPROX_ERROR_UNSUPPORTED = 14,
  /**
   * There is no memory for an array in proportion to what the caller gave or to a scene, of which the message says how much was
   * asked for, or for an integer of the exact tier. Nothing has changed but what a cache remembers of a search, and the same
   * call may succeed when there is more.
   */
  SWIFTPROX_ERROR_MEMORY = 15,
  /**
   * The scene is in use: by another thread, which the rules for threads forbid, or by a call that this one was made in. Nothing
   * has changed.
   */
  SWIFTPROX_ERROR_BUSY = 16
} swiftprox_status;

/** Does not compile where enums are not as large as an int32_t, as with -fshort-enums. */
typedef char swiftprox_enums_are_32_bits[sizeof(swiftprox_status) == 4 ? 1 : -1];

/**
 * Whether a program compiled with the header of the given version can run with this library. Call it once with
 * SWIFTPROX_VERSION_MAJOR, SWIFTPROX_VERSION_MINOR and SWIFTPROX_VERSION_PATCH, which are then those of the program.
 *
 * SWIFTPROX_ERROR_VERSION: the library is too old or has another interface; the message names both versions.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_library_check_version(int32_t major,
                                                 int32_t minor,
                                                 int32_t patch);

/**
 * What went wrong in the last call of this thread that did not return SWIFTPROX_OK; the empty string before the first. Never
 * null; valid until the next such call of the same thread, or its end.
 *
 * Stable.
 */
const char *swiftprox_library_last_error_message(void);

/**
 * A status in words. Never null, valid for ever; a number that is no status gets a string that says so.
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
 * Geometry for queries: immutable, shared by any number of owners. What is made when a query first needs it is all that is ever
 * added: look-up tables of the body and of its levels, maps of its support function, automatic levels.
 */
typedef struct swiftprox_shape swiftprox_shape;

/** What to do with input that is not a closed convex mesh with interior. */
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
   * As flat, for a mesh that is convex up to the precision of its coordinates: the convex hull counts. A mesh whose faces all
   * run clockwise seen from outside is turned. Vertices and faces keep the caller's indices. What the hull swallows is never
   * the feature of an answer where it is a vertex; a face shares the hull's face over it, and is named where it is the nearest
   * of those that share. Without a convexity tolerance the coordinates say it, before the input transform: four units of the
   * last place in which they are written (decimals, significant digits, floats), at most 0.005 of the bounding box's diagonal.
   */
  SWIFTPROX_INPUT_NEARLY_CONVEX = 3,
  /**
   * The faces are a part of the surface of their vertices' hull, or all of it: that hull counts, of any dimension. Vertices of
   * no face, which some mesh files have, are left out. A face of the hull on which no face of the mesh lies is called
   * SWIFTPROX_NO_FACE. Whether the faces do lie on the hull is not checked: no verdict and no distance depends on it.
   */
  SWIFTPROX_INPUT_PATCH = 4
} swiftprox_input;

/** What a face of the hull of a patch is called on which none of the caller's lies: UINT32_MAX. */
#define SWIFTPROX_NO_FACE UINT32_MAX

/**
 * Learns how far the building, loading or preparing of a shape is: a fraction from 0 to 1 that never falls, and the pointer given
 * with the callback. Returns 0 to go on; anything else ends the call with SWIFTPROX_ERROR_CANCELLED. It runs in the thread that
 * builds, must return, and must not use what the call is working on; a C++ exception that leaves it ends the program.
 */
typedef int32_t (*swiftprox_progress_callback)(void *user, double fraction);

/** How a shape is made. Begin with SWIFTPROX_SHAPE_OPTIONS_DEFAULT, then change what should differ. */
typedef struct swiftprox_shape_options {
  /** Set by SWIFTPROX_SHAPE_OPTIONS_DEFAULT. */
  size_t struct_size;
  /** What to do with input that is not a closed convex mesh with interior. Default: refuse it. */
  swiftprox_input input;
  /**
   * Row-major rotation; with translation and scale the input transform, applied once when the shape is made: stored vertex =
   * scale * (rotation * v) + translation, rounded to doubles. "Local frame" means the frame after it. Default: identity.
   */
  double rotation[9];
  /** See rotation. Default: 0. */
  double translation[3];
  /** See rotation; positive. Default: 1. */
  double scale;
  /**
   * How far a vertex may lie outside a face of accepted input, relative to the bounding-box diagonal. Default: negative,
   * which means 1e-9, and 1e-6 for meshes that went through single precision (STL); with SWIFTPROX_INPUT_NEARLY_CONVEX, if that
   * is more, what swiftprox_mesh_estimate_tolerance says.
   */
  double convexity_tolerance;
  /** Learns how far the building of the shape is, and can cancel it. Default: null. */
  swiftprox_progress_callback progress;
  /** Handed to progress. Default: null. */
  void *progress_user;
  /** Levels of detail and look-up table (swiftprox/tuning.h). Default: null, the automatic ones. */
  const struct swiftprox_shape_tuning *tuning;
  /**
   * By how much a coordinate may be off, in the units of the input, before scale: vertices that could lie in one plane up to
   * this are one face to manifolds. Distance and depth do not change; the intervals of gaps contain what is joined. Less than 0
   * (the default): found from the coordinates and polygons, at least 1e-6 of half the box's diagonal. 0: rounding of doubles
   * only. A number that is not finite is SWIFTPROX_ERROR_INVALID_ARGUMENT.
   */
  double face_noise;
  /**
   * The radius of a ball that is swept over the body, in the units of the input, before scale: a point with one is a sphere, a
   * segment a capsule, any other body has its edges and corners rounded. Distances, depths, manifolds, rays and scenes are of
   * the swept body: witness points are on it, features are those of the body without the ball; swept_radius of
   * swiftprox_shape_info tells it. From 0 (the default) to 2^1000; another number is SWIFTPROX_ERROR_INVALID_ARGUMENT.
   */
  double swept_radius;
} swiftprox_shape_options;

/** Begins a swiftprox_shape_options: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_SHAPE_OPTIONS_DEFAULT \
  {sizeof(swiftprox_shape_options), SWIFTPROX_INPUT_STRICT, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}, 1, -1, 0, 0, 0, -1, 0}

/**
 * Makes a shape from a polygon mesh; the caller owns it and gives it back with swiftprox_shape_release. The arrays are copied.
 *
 * `vertices` holds 3 * vertex_count coordinates. `indices` holds the 0-based vertex numbers of all faces, one face after the
 * other, each counter-clockwise seen from outside; `valences` the number of vertices of each face, or null when all are
 * triangles. The mesh must be closed, a 2-manifold, consistently oriented, connected, convex and without unused vertices,
 * unless the options say otherwise. Answers name features by these numbers.
 *
 * On failure `*shape` is null. `options` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_MESH: the mesh breaks the contract, or a coordinate is not finite. SWIFTPROX_ERROR_LIMIT: a count does not fit
 * 32 bits. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_CANCELLED: options->progress said so. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_INVALID_ARGUMENT, SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_mesh(const double *vertices,
                                                  size_t vertex_count,
                                                  const uint32_t *indices,
                                                  const uint32_t *valences,
                                                  size_t face_count,
                                                  const struct swiftprox_shape_options *options,
                                                  const struct swiftprox_shape **shape);

/**
 * Makes a shape from the convex hull of `point_count` points, 3 coordinates each; the caller owns it and gives it back with
 * swiftprox_shape_release. The array is copied. Features of answers name vertices by their place in `points` (the first of equal
 * ones), faces by numbers of the hull's own, from 0 and below swiftprox_shape_info.face_count.
 *
 * On failure `*shape` is null. `options` may be null for the defaults, which refuse a hull without interior.
 *
 * SWIFTPROX_ERROR_MESH: a coordinate is not finite, or the options do not admit a hull of that dimension.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: no points, or an option out of range. SWIFTPROX_ERROR_LIMIT: too many points.
 * SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_CANCELLED: options->progress said so. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE: the message
 * names the argument.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_points(const double *points,
                                                    size_t point_count,
                                                    const struct swiftprox_shape_options *options,
                                                    const struct swiftprox_shape **shape);

/**
 * Makes a shape from a mesh file; the caller owns it and gives it back with swiftprox_shape_release.
 *
 * The file is read by the reader that swiftprox_library_register_mesh_reader has registered for its first bytes if there is one,
 * else as TRI, POLY, OFF, OBJ or STL, by its extension, else by its content. Features of answers count vertices and faces from 0
 * in the order of the file, or in which the reader adds them; of STL vertices in the order in which they are first mentioned, and
 * no triangles with two equal corners.
 *
 * On failure `*shape` is null. `options` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_FILE: the file cannot be read, is no regular file (a pipe and a device are refused, not waited for), is larger
 * than 4 GiB (4,294,967,296 bytes) or does not parse; the message names the line, or the registered reader and what it says.
 * SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_MESH: its mesh breaks the contract (see swiftprox_shape_create_from_mesh). Both messages
 * name the file.
 * SWIFTPROX_ERROR_CANCELLED: options->progress said so. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_INVALID_ARGUMENT,
 * SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_file(const char *path,
                                                  const struct swiftprox_shape_options *options,
                                                  const struct swiftprox_shape **shape);

/**
 * Makes the box [-x, x] x [-y, y] x [-z, z] from its half extents, 3 numbers. A ball of `radius` is swept over it: 0 leaves edges
 * and corners sharp, more rounds them and makes the box larger by as much. Vertex i has bit 0 of i set where x is positive, bit 1
 * for y, bit 2 for z. The caller owns the shape and gives it back with swiftprox_shape_release. On failure `*shape` is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a half extent is not positive, or a number is negative, larger than 2^1000 or NaN.
 * SWIFTPROX_ERROR_NULL_POINTER. SWIFTPROX_ERROR_MEMORY.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_box(const double *half_extents,
                                            double radius,
                                            const struct swiftprox_shape **shape);

/**
 * Makes the sphere of a radius about the local origin. Owned and given back as any shape. On failure `*shape` is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the radius is negative, larger than 2^1000 or NaN. SWIFTPROX_ERROR_NULL_POINTER.
 * SWIFTPROX_ERROR_MEMORY.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_sphere(double radius,
                                               const struct swiftprox_shape **shape);

/**
 * Makes the capsule of a radius about the segment from (0, 0, -half_length), vertex 0, to (0, 0, half_length), vertex 1: a
 * cylinder along z with half a sphere at either end. Owned and given back as any shape. On failure `*shape` is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a number is negative, larger than 2^1000 or NaN. SWIFTPROX_ERROR_NULL_POINTER.
 * SWIFTPROX_ERROR_MEMORY.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_capsule(double half_length,
                                                double radius,
                                                const struct swiftprox_shape **shape);

/**
 * Gives the caller one more share of a shape, to be given back with a swiftprox_shape_release of its own; returns the shape. Safe
 * from any thread. Of null it returns null.
 *
 * Stable.
 */
const struct swiftprox_shape *swiftprox_shape_retain(const struct swiftprox_shape *shape);

/**
 * Gives back one share of a shape that the caller owns, from a function that made the shape or from swiftprox_shape_retain. The
 * last share frees the shape; scenes hold shares of their own. Safe from any thread. Null is ignored.
 *
 * Stable.
 */
void swiftprox_shape_release(const struct swiftprox_shape *shape);

/** What a shape is. Set struct_size to sizeof(swiftprox_shape_info) before asking for it. */
typedef struct swiftprox_shape_info {
  /** Set by the caller. */
  size_t struct_size;
  /** Dimension of the hull: 3; 2 (a two-sided polygon), 1 (a segment) or 0 (a point) only where the input policy admits it. */
  int32_t dimension;
  /** Vertices of the hull. */
  size_t vertex_count;
  /** Edges between faces that are not coplanar. */
  size_t edge_count;
  /** Faces, coplanar triangles counted as one. */
  size_t face_count;
  /** Triangles of the hull, as swiftprox_shape_copy_triangles gives them. */
  size_t triangle_count;
  /** Volume; 0 without interior. */
  double volume;
  /** Centre of mass of the volume, in the local frame; of a body without interior that of its area or length. */
  double centre_of_mass[3];
  /** Largest distance of a vertex from the centre of mass. */
  double radius;
  /** The corner of the bounding box where all coordinates are least, in the local frame. */
  double lower_corner[3];
  /** The corner where they are greatest. */
  double upper_corner[3];
  /** Memory that the shape holds, in bytes, levels included, however many share it. */
  size_t bytes;
  /**
   * Inertia tensor of a body of mass 1 and of uniform density about the centre of mass, in the axes of the local frame:
   * row-major, symmetric, in units of length squared. Times a body's mass, density times volume, it is the inertia of that body.
   * Of a body without interior the mass is spread over its area or length.
   */
  double inertia[9];
  /**
   * The radius of the ball that is swept over the body (swiftprox_shape_options), in the local frame; all other members are of
   * the body without it.
   */
  double swept_radius;
} swiftprox_shape_info;

/**
 * Says what a shape is: set info->struct_size to sizeof(swiftprox_shape_info) first. On failure real numbers are NaN, all else 0.
 * The inertia takes time in proportion to the triangles.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: shape or info is null. SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is unknown.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_info(const struct swiftprox_shape *shape,
                                          struct swiftprox_shape_info *info);

/**
 * Makes now what a query of a shape would make when it first needs it: the look-up table, maps of the support function, and
 * automatic levels of detail, which take about twice as long as making the shape did. After that no query of this shape allocates
 * or waits for that.
 *
 * `progress` learns how far it is and can cancel it, or is null; `progress_user` is handed to it. Nothing is reported while
 * the table is made, a small part of the time, of needles up to a third. Safe from any thread: a query that needs the levels
 * meanwhile, or another swiftprox_shape_prepare, does not wait but makes them, too, and what comes second is dropped.
 *
 * SWIFTPROX_ERROR_CANCELLED: progress said so; SWIFTPROX_ERROR_MEMORY: in both cases no levels are made, a table that was made
 * stays, and the shape can be used as before. SWIFTPROX_ERROR_NULL_POINTER: shape is null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_prepare(const struct swiftprox_shape *shape,
                                         swiftprox_progress_callback progress,
                                         void *progress_user);

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
   * The objects are disjoint and farther apart than the distance tolerance. `lower` is at least that, `distance` is `lower`,
   * `upper` is infinity, and along the unit normal the objects are at least `lower` apart. Points and features stay unset.
   */
  SWIFTPROX_OUTCOME_BEYOND = 2,
  /** The closed objects have a common point (touching included). */
  SWIFTPROX_OUTCOME_INTERSECTING = 3,
  /** The step budget of an approximate query ran out before the verdict: `0 = lower <= distance <= upper`. */
  SWIFTPROX_OUTCOME_UNDECIDED = 4
} swiftprox_outcome;

/** What decided a pair query. Values are never reused. */
typedef enum swiftprox_decided_by SWIFTPROX_INT32 {
  /** Nothing: the value of a fresh answer. */
  SWIFTPROX_DECIDED_BY_NONE = 0,
  /** Voronoi marching: it ended, and its certificate holds. */
  SWIFTPROX_DECIDED_BY_MARCHING = 1,
  /** What proved the last verdict, or nearly that: vertex pairs that enclose the origin, or a separating axis. */
  SWIFTPROX_DECIDED_BY_COHERENCE = 2,
  /** Gilbert-Johnson-Keerthi in floating point. */
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
  /** The bounding spheres: they are apart, and farther than the distance tolerance if there is one. */
  SWIFTPROX_DECIDED_BY_BOUNDING_SPHERES = 7,
  /** In a scene: balls inside the objects overlap. Such an answer carries no vertex pairs as its proof. */
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

/** What a query did. */
typedef struct swiftprox_statistics {
  /** Voronoi marching: feature pairs visited. */
  uint32_t marching_steps;
  /** Gilbert-Johnson-Keerthi iterations in floating point: of the fallback, and of approximate queries. */
  uint32_t fallback_iterations;
  /** Iterations in integer arithmetic. It allocates, and so does a query that makes a table or levels. */
  uint32_t exact_iterations;
  /** The levels of detail of object 1 and object 2 that the answer comes from; 0 is the object itself. */
  uint16_t levels[2];
} swiftprox_statistics;

/**
 * The answer to a pair query. Numbers that it does not say are NaN, features SWIFTPROX_FEATURE_KIND_NONE; a separated answer always
 * has a normal.
 */
typedef struct swiftprox_pair_answer {
  /** Disjoint, beyond the tolerance, or intersecting. */
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
  /** What the query did. */
  struct swiftprox_statistics statistics;
} swiftprox_pair_answer;

/**
 * What a pair remembers from its last query, for the caller to keep: all zero is cold, any bytes are safe. It changes how fast
 * an answer comes, never the verdict. What the words mean is the library's own.
 */
typedef struct swiftprox_pair_cache {
  /** Not to be looked at. */
  uint32_t words[24];
} swiftprox_pair_cache;

/** What a pair query is asked for. Begin with SWIFTPROX_PAIR_CONFIG_DEFAULT, then change what should differ. */
typedef struct swiftprox_pair_config {
  /** Set by SWIFTPROX_PAIR_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Pairs farther apart than this are SWIFTPROX_OUTCOME_BEYOND; from 0 to infinity (the default: none is). */
  double distance_tolerance;
  /** Largest accepted |R^T R - I| entry of a pose, from 0 to 1e-2 (the default). */
  double rotation_limit;
  /**
   * Of swiftprox_pair_approximate: upper - lower may be as large as this ... Other queries do not look at this and the two that
   * follow, not even whether they are in range: from 0 to infinity, and 1 or more for the budget.
   */
  double absolute_error;
  /** ... or as this times lower. Both 0 (the default): as narrow as exact answers. */
  double relative_error;
  /**
   * Of swiftprox_pair_approximate: steps of marching after which it stops with what it has, 1 or more; UINT32_MAX (the default):
   * no limit. What marching leaves open is decided all the same, however long it takes; of bodies that intersect it may leave it
   * open only after as many steps as a query without a budget may make. The next query with the same cache goes on where this
   * one stopped, unless tuning->start says that it begin anew, at the tables or afresh: it may then stop there for ever.
   */
  uint32_t step_budget;
  /** Where it starts and which levels of detail it goes through (swiftprox/tuning.h). Default: null, the automatic choice. */
  const struct swiftprox_pair_tuning *tuning;
} swiftprox_pair_config;

/** Begins a swiftprox_pair_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_PAIR_CONFIG_DEFAULT {sizeof(swiftprox_pair_config), HUGE_VAL, 1e-2, 0, 0, UINT32_MAX, 0}

/**
 * The distance of two objects with a rigorous interval, witness points, normal and features. Of an intersecting pair the
 * distance is 0 and the proof is given; points, normal and features stay unset (see swiftprox_pair_contact). Of a pair farther
 * apart than config->distance_tolerance less is said, see SWIFTPROX_OUTCOME_BEYOND. What an answer leaves out is NaN, or
 * SWIFTPROX_FEATURE_KIND_NONE.
 *
 * A pose is 12 doubles, the row-major 3x4 matrix [R|T]: the object is R*v + T, exactly as the doubles give it. `cache` is what
 * the pair remembers: all zero is cold, hand the same one back for the same pair in the same order, one for each pair.
 * `config` may be null for the defaults. On failure the answer is reset: its outcome is SWIFTPROX_OUTCOME_NONE.
 *
 * SWIFTPROX_ERROR_POSE: a pose is refused; the message says why. SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of config is out of
 * range; those that are for swiftprox_pair_approximate alone only there. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument. SWIFTPROX_ERROR_BUG: the cache is reset, too.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_distance(const struct swiftprox_shape *shape1,
                                         const double *pose1,
                                         const struct swiftprox_shape *shape2,
                                         const double *pose2,
                                         struct swiftprox_pair_cache *cache,
                                         const struct swiftprox_pair_config *config,
                                         struct swiftprox_pair_answer *answer);

/**
 * As swiftprox_pair_distance, and of an intersecting pair a common point (as witness point of both objects), the unit normal along
 * which the objects overlap least and the features that meet there: those of swiftprox_pair_depth, which says how deep they are in
 * each other, and where. Arguments and errors as of swiftprox_pair_distance.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_contact(const struct swiftprox_shape *shape1,
                                        const double *pose1,
                                        const struct swiftprox_shape *shape2,
                                        const double *pose2,
                                        struct swiftprox_pair_cache *cache,
                                        const struct swiftprox_pair_config *config,
                                        struct swiftprox_pair_answer *answer);

/**
 * The verdict alone: SWIFTPROX_OUTCOME_INTERSECTING, or SWIFTPROX_OUTCOME_SEPARATED with lower > 0 and an upper that holds but
 * need not be tight; and SWIFTPROX_OUTCOME_BEYOND with a finite config->distance_tolerance. Faster than the distance where bodies
 * intersect or nearly do. Arguments and errors as of swiftprox_pair_distance.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_intersection(const struct swiftprox_shape *shape1,
                                             const double *pose1,
                                             const struct swiftprox_shape *shape2,
                                             const double *pose2,
                                             struct swiftprox_pair_cache *cache,
                                             const struct swiftprox_pair_config *config,
                                             struct swiftprox_pair_answer *answer);

/**
 * The distance as narrow as asked for, or as exact answers are: the query stops as soon as upper - lower is at most
 * config->absolute_error or config->relative_error * lower; both 0 ask for the exact distance. [lower, upper] holds the
 * distance, `distance` is the lower end unless the answer is exact. The verdict is as certain as that of swiftprox_pair_distance,
 * unless config->step_budget ran out: then decided_by is SWIFTPROX_DECIDED_BY_BUDGET, and the next call with the same cache
 * goes on from there, unless config->tuning->start says that it begin anew. Points and features stay unset in an answer that
 * comes from maps of support functions or from levels of detail. Arguments and errors as of swiftprox_pair_distance.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_approximate(const struct swiftprox_shape *shape1,
                                            const double *pose1,
                                            const struct swiftprox_shape *shape2,
                                            const double *pose2,
                                            struct swiftprox_pair_cache *cache,
                                            const struct swiftprox_pair_config *config,
                                            struct swiftprox_pair_answer *answer);

/** @} */

/**
 * @defgroup swiftprox_depth How deep objects are in each other
 * @{
 */

/** How a depth query ended. Values are never reused. */
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

/** What a depth query did. */
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
 * How deep two objects are in each other. Numbers that it does not say are NaN, features of no kind.
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
  /** What the query did. */
  struct swiftprox_depth_statistics statistics;
} swiftprox_depth_answer;

/**
 * What a pair remembers of its depth, for the caller to keep: all zero is cold, any bytes are safe. It changes how fast an answer
 * comes, and which of several directions of least overlap is said; never the verdict, and no depth beyond its interval.
 */
typedef struct swiftprox_depth_cache {
  /** Not to be looked at. */
  uint32_t words[352];
} swiftprox_depth_cache;

/** What a depth query is asked for. Begin with SWIFTPROX_DEPTH_CONFIG_DEFAULT, then change what should differ. */
typedef struct swiftprox_depth_config {
  /** Set by SWIFTPROX_DEPTH_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Largest accepted |R^T R - I| entry of a pose, from 0 to 1e-2 (the default). */
  double rotation_limit;
  /** upper - lower may be as large as this ... from 0 to infinity. */
  double absolute_error;
  /** ... or as this times lower. Both 0 (the default): as narrow as double precision can prove. */
  double relative_error;
  /**
   * Expansions after which the query stops with what it has, 1 or more; UINT32_MAX (the default): no limit but the library's
   * own, 400. What is then left of the verdict is decided all the same, in integers.
   */
  uint32_t step_budget;
} swiftprox_depth_config;
/** What the header calls its default. */

/** Begins a swiftprox_depth_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_DEPTH_CONFIG_DEFAULT {sizeof(swiftprox_depth_config), 1e-2, 0, 0, UINT32_MAX}

/**
 * How deep two objects are in each other: the least translation that parts them, with a rigorous interval, unit normal, witness
 * points and features. Touching is a depth of 0, decided in integers. Of separated objects only that is said, and a normal that
 * separates them: swiftprox_pair_distance tells how far.
 *
 * Arguments and errors as of swiftprox_pair_distance; the cache is one for depths alone, and config may be null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_depth(const struct swiftprox_shape *shape1,
                                      const double *pose1,
                                      const struct swiftprox_shape *shape2,
                                      const double *pose2,
                                      struct swiftprox_depth_cache *cache,
                                      const struct swiftprox_depth_config *config,
                                      struct swiftprox_depth_answer *answer);

/** @} */

/**
 * @defgroup swiftprox_manifold Where objects meet
 * @{
 */

/**
 * What a pair remembers of its manifold, its distance and its depth, for the caller to keep: all zero is cold, any bytes are
 * safe.
 */
typedef struct swiftprox_manifold_cache {
  /** Not to be looked at. */
  uint32_t words[384];
} swiftprox_manifold_cache;

/** A distance that is negative where objects overlap. Numbers that it does not say are NaN, features of no kind. */
typedef struct swiftprox_signed_distance {
  /**
   * SWIFTPROX_OUTCOME_INTERSECTING (touching included), SWIFTPROX_OUTCOME_SEPARATED, or SWIFTPROX_OUTCOME_BEYOND the
   * tolerance: then `lower` is all that is known, which `distance` repeats, and `upper` is infinite.
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
  /** What holds the witness point of object 1. */
  struct swiftprox_feature feature1;
  /** What holds the witness point of object 2. */
  struct swiftprox_feature feature2;
} swiftprox_signed_distance;

/**
 * The distance of objects that are apart, minus the depth of those that overlap, with one rigorous interval through zero, unit
 * normal, witness points and features: as certain as swiftprox_pair_distance and swiftprox_pair_depth. Touching is 0.
 *
 * Of a pair farther apart than config->distance_tolerance less is said, see SWIFTPROX_OUTCOME_BEYOND; errors asked for and step
 * budgets are not looked at. Arguments and errors as of swiftprox_pair_distance; the cache is that of the pair's manifolds.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_signed_distance(const struct swiftprox_shape *shape1,
                                                const double *pose1,
                                                const struct swiftprox_shape *shape2,
                                                const double *pose2,
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
  /** How far the first is from the second along the normal, at least; less than 0 where the objects overlap there. */
  double gap_lower;
  /** ... and at most. */
  double gap_upper;
  /** What holds the point on object 1, in the caller's numbering. */
  struct swiftprox_feature feature1;
  /** What holds the point on object 2. */
  struct swiftprox_feature feature2;
  /** A number made of the two features: while they stay it stays. */
  uint64_t id;
} swiftprox_manifold_point;

/** Where two objects meet, or nearly do. */
typedef struct swiftprox_manifold {
  /** SWIFTPROX_OUTCOME_INTERSECTING, SWIFTPROX_OUTCOME_SEPARATED within the margin, or SWIFTPROX_OUTCOME_BEYOND it. */
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

/** What a manifold query is asked for. Begin with SWIFTPROX_MANIFOLD_CONFIG_DEFAULT, then change what should differ. */
typedef struct swiftprox_manifold_config {
  /** Set by SWIFTPROX_MANIFOLD_CONFIG_DEFAULT. */
  size_t struct_size;
  /** Largest accepted |R^T R - I| entry of a pose, from 0 to 1e-2 (the default). */
  double rotation_limit;
  /**
   * Objects up to this far apart have a manifold, and points with a gap of at most this belong to it; at least 0, and infinity
   * admits all, as in queries of scenes. Default: 0.
   */
  double margin;
  /**
   * Other than 0: of more than four points four are kept, the deepest, the farthest from it and the extremes on either side of
   * the line between; none is moved. The four of the last query with the same cache stay while they are about as deep and
   * cover about as much. 0 (the default): all.
   */
  int32_t reduces;
} swiftprox_manifold_config;
/** What the header calls its default. */

/** Begins a swiftprox_manifold_config: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_MANIFOLD_CONFIG_DEFAULT {sizeof(swiftprox_manifold_config), 1e-2, 0, 0}

/**
 * Where two objects meet, or are up to config->margin apart: pairs of points along the normal of least overlap or of the shortest
 * connection, each with its gap. `points` has room for `capacity` of them; what is beyond is left out, and manifold->found_count
 * says how many there are. Objects farther apart have none, and their outcome is SWIFTPROX_OUTCOME_BEYOND.
 *
 * Manifolds are made over faces as they were meant: what could lie in one plane up to the shape's face_noise
 * (swiftprox_shape_options). Gap intervals hold for the exact objects: they contain by how much such a face is not flat. Points
 * are on their objects up to half of what it is thick, and in line up to twice that and 7.5e-9 of the pair's size. Corners nearer
 * to each other than 3e-8 of it, or four times what such faces are thick, are one. One of the points is as deep as the objects
 * are. It is not certified that a face is complete.
 *
 * Arguments and errors as of swiftprox_pair_distance; the cache is one for manifolds alone. points may be null if capacity is 0.
 * On failure the manifold is reset, and points are as they were.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_manifold(const struct swiftprox_shape *shape1,
                                         const double *pose1,
                                         const struct swiftprox_shape *shape2,
                                         const double *pose2,
                                         struct swiftprox_manifold_cache *cache,
                                         const struct swiftprox_manifold_config *config,
                                         struct swiftprox_manifold_point *points,
                                         size_t capacity,
                                         struct swiftprox_manifold *manifold);

/**
 * As swiftprox_pair_manifold, with what swiftprox_pair_signed_distance says of the pair, at no further search: the distance or
 * minus the depth, and the witness points. `distance` is reset on failure, too.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_manifold_with_distance(const struct swiftprox_shape *shape1,
                                                       const double *pose1,
                                                       const struct swiftprox_shape *shape2,
                                                       const double *pose2,
                                                       struct swiftprox_manifold_cache *cache,
                                                       const struct swiftprox_manifold_config *config,
                                                       struct swiftprox_manifold_point *points,
                                                       size_t capacity,
                                                       struct swiftprox_manifold *manifold,
                                                       struct swiftprox_signed_distance *distance);

/** @} */

/**
 * @defgroup swiftprox_scene Scenes
 * @{
 */

/** Objects, their poses and the pairs that queries test. Make one with swiftprox_scene_create. */
typedef struct swiftprox_scene swiftprox_scene;

/**
 * Does the items from `first` on and before `end` of a task; `context` is what came with it. It may be called from any threads,
 * several at once, each item once.
 */
typedef void (*swiftprox_task_callback)(uint32_t first, uint32_t end, void *context);

/**
 * Is to call `task` for all items below `item_count`, in ranges of its choice, by any threads, with `context`; `user` is the
 * pointer given with the callback. Returns what swiftprox_finish_task_callback is to get, or null if all is done already. It must
 * return; a C++ exception that leaves it ends the program.
 */
typedef void *(*swiftprox_enqueue_task_callback)(swiftprox_task_callback task,
                                                 uint32_t item_count,
                                                 void *context,
                                                 void *user);

/** Is to return when the task that swiftprox_enqueue_task_callback returned is done. It must return, as that. */
typedef void (*swiftprox_finish_task_callback)(void *task, void *user);

/** How a scene is made. Begin with SWIFTPROX_SCENE_OPTIONS_DEFAULT, then change what should differ. */
typedef struct swiftprox_scene_options {
  /** Set by SWIFTPROX_SCENE_OPTIONS_DEFAULT. */
  size_t struct_size;
  /** Largest accepted |R^T R - I| entry of a pose, from 0 to 1e-2 (the default). */
  double rotation_limit;
  /**
   * How many threads may work on a query or on poses that are set together, the caller's among them. It changes no bit of any
   * answer. Queries that stop early, those without a tolerance over many objects, and few pairs or objects stay in the caller's
   * thread. More than 256 count as 256. Default: 0, which means 1.
   */
  uint32_t worker_count;
  /**
   * Shares the work out among the program's own threads. Default: null, together with finish_task: the scene has threads of its
   * own, which wait between calls. swiftprox_scene_create starts them, and does without those that cannot be started;
   * swiftprox_scene_destroy ends them and waits for that. The child of a fork() has none: its calls stay in the caller's
   * thread. exit() does not wait for them. A program that unloads the library destroys its scenes first.
   */
  swiftprox_enqueue_task_callback enqueue_task;
  /** Waits for what enqueue_task has shared out. Default: null. */
  swiftprox_finish_task_callback finish_task;
  /** Handed to both. Default: null. */
  void *task_user;
} swiftprox_scene_options;

/** Begins a swiftprox_scene_options: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_SCENE_OPTIONS_DEFAULT {sizeof(swiftprox_scene_options), 1e-2, 0, 0, 0, 0}

/**
 * Makes an empty scene; the caller owns it and gives it back with swiftprox_scene_destroy. On failure `*scene` is null. `options`
 * may be null for the defaults.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the rotation limit is out of range, or of enqueue_task and finish_task one is null and the
 * other is not. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE:
 * the message names the argument.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_create(const struct swiftprox_scene_options *options,
                                        struct swiftprox_scene **scene);

/**
 * Ends a scene, which the caller owns, a poisoned one too. Its shares of shapes are given back; its ids and results end with it.
 * Null is ignored.
 *
 * SWIFTPROX_ERROR_BUSY: another call uses the scene, which lives on. SWIFTPROX_ERROR_BUG: the scene is gone, but perhaps not all
 * of its memory. SWIFTPROX_ERROR_FILE, SWIFTPROX_ERROR_MEMORY: the scene is gone, and its recording was not written to its end.
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

/** How an object begins. Begin with SWIFTPROX_OBJECT_OPTIONS_DEFAULT, then change what should differ. */
typedef struct swiftprox_object_options {
  /** Set by SWIFTPROX_OBJECT_OPTIONS_DEFAULT. */
  size_t struct_size;
  /** The caller's own; it comes back in every result. Default: 0. */
  uint64_t user_data;
  /** Where it stands, row-major [R|T]. Default: the identity. */
  double pose[12];
  /** Not 0: pairs of two such objects are never tested; it can still be moved. Default: 0. */
  int32_t fixed;
  /**
   * The groups that it is in, one bit each. Two objects are tested if each one's mask has a bit of the other's groups. Default:
   * 0, which stands for the first group alone, 1.
   */
  uint32_t groups;
  /** The groups that it is tested against. Default: 0, which stands for all. */
  uint32_t mask;
} swiftprox_object_options;
/** What the header calls its default. */

/** Begins a swiftprox_object_options: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_OBJECT_OPTIONS_DEFAULT {sizeof(swiftprox_object_options), 0, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 0, 0, 0}

/**
 * Adds an object of one or several convex pieces in one local frame. All its pairs are active. The scene takes a share of each
 * shape: the caller's own may be released at once. On failure nothing is added and `*id` is null.
 * `options` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: no pieces. SWIFTPROX_ERROR_POSE: the pose is refused. SWIFTPROX_ERROR_LIMIT: more objects or
 * pieces than a scene holds. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE: the message names
 * the argument. SWIFTPROX_ERROR_POISONED.
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
 * Adds an object of one convex piece for each of `count` shapes, in their order, as swiftprox_scene_add_object does: all or none.
 * `options` are as many, one behind the other, each begun with SWIFTPROX_OBJECT_OPTIONS_DEFAULT; null for the defaults of all. `ids`
 * receives the ids.
 *
 * On failure nothing is added, and all ids are null. The message names the first place that is refused. Errors as of
 * swiftprox_scene_add_object; SWIFTPROX_ERROR_STRUCT_SIZE also where the options have different sizes.
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
 * Removes an object and its pairs. Its id is refused from now on; all other ids stay as they are.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_remove_object(struct swiftprox_scene *scene,
                                               struct swiftprox_object_id id);

/**
 * Removes `count` objects and their pairs, as swiftprox_scene_remove_object does: all or none.
 *
 * On failure nothing is removed; the message names the first id that is refused. SWIFTPROX_ERROR_HANDLE: it names no object of
 * this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: it is given twice. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: scene or
 * ids is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_remove_objects(struct swiftprox_scene *scene,
                                                const struct swiftprox_object_id *ids,
                                                size_t count);

/**
 * Sets `*valid` to 1 if an id names an object of this scene, else to 0 (also on failure): if it is null, of another scene, or of
 * an object that was removed. Two ids name the same object if their bits are equal.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene or valid is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_is_object_valid(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id,
                                                 int32_t *valid);

/**
 * Writes the ids of all objects in order of creation, which is that of results and of swiftprox_scene_set_poses, and their
 * number to `*count`. `ids` has room for `capacity` of them; with capacity 0 it may be null, and only the number is written. On
 * failure `*count` is 0.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is neither 0 nor as large as the number of objects.
 * SWIFTPROX_ERROR_NULL_POINTER: the message names the argument. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_copy_object_ids(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id *ids,
                                                 size_t capacity,
                                                 size_t *count);

/**
 * Moves an object, a fixed one too: `pose` is 12 doubles, row-major [R|T]. On failure it stays where it is.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_POSE: the pose is refused.
 * SWIFTPROX_ERROR_NULL_POINTER: scene or pose is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pose(struct swiftprox_scene *scene,
                                          struct swiftprox_object_id id,
                                          const double *pose);

/**
 * As swiftprox_scene_set_pose, from a row-major 3x3 `rotation` and a `translation`.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_transform(struct swiftprox_scene *scene,
                                               struct swiftprox_object_id id,
                                               const double *rotation,
                                               const double *translation);

/**
 * Moves the objects of `count` ids, fixed ones too: `poses` holds 12 doubles for each. Of an object that is given twice the later
 * pose counts. Null `ids` are all objects that are not fixed, in order of creation. On failure all stay where they are; the
 * message says which pose or id is refused. Workers share the work where it is in order of creation.
 *
 * SWIFTPROX_ERROR_HANDLE: an id names no object of this scene. SWIFTPROX_ERROR_POSE: a pose is refused.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: ids is null, and count is not the number of objects that are not fixed.
 * SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: scene or poses is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_poses(struct swiftprox_scene *scene,
                                           const struct swiftprox_object_id *ids,
                                           const double *poses,
                                           size_t count);

/**
 * As swiftprox_scene_set_poses, from 9 doubles of `rotations` and 3 of `translations` for each object.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_transforms(struct swiftprox_scene *scene,
                                                const struct swiftprox_object_id *ids,
                                                const double *rotations,
                                                const double *translations,
                                                size_t count);

/** What an object is. Set struct_size to sizeof(swiftprox_object_info) before asking for it. */
typedef struct swiftprox_object_info {
  /** Set by the caller. */
  size_t struct_size;
  /** The caller's own. */
  uint64_t user_data;
  /** Number of convex pieces. */
  size_t piece_count;
  /** Where it stands, row-major [R|T]. */
  double pose[12];
  /** 1 if it is fixed, else 0. */
  int32_t fixed;
  /** The groups that it is in, one bit each. */
  uint32_t groups;
  /** The groups that it is tested against. */
  uint32_t mask;
} swiftprox_object_info;

/**
 * Says what an object is: set info->struct_size to sizeof(swiftprox_object_info) first. On failure the pose is NaN, all else 0.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_NULL_POINTER: scene or info is null.
 * SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is unknown. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_object_info(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id,
                                                 struct swiftprox_object_info *info);

/**
 * Makes an object what `info` says: its user data, pose, fixedness, groups and mask. Fill info by
 * swiftprox_scene_get_object_info and change members; a pose as it was moves nothing. What pairs remember stays.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_POSE: the pose is refused.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: piece_count is another one. SWIFTPROX_ERROR_NULL_POINTER: scene or info is null.
 * SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is unknown. SWIFTPROX_ERROR_POISONED. Nothing has changed then.
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

/** swiftprox_scene_query.distance_tolerance: 0 for swiftprox_scene_query_contact, infinity for all other queries. */
#define SWIFTPROX_DEFAULT_TOLERANCE (-1.0)

/** What a query of contacts says of each pair beside its answer. */
typedef enum swiftprox_contact_detail SWIFTPROX_INT32 {
  /** Nothing. */
  SWIFTPROX_CONTACT_DETAIL_NONE = 0,
  /** How deep intersecting pairs are in each other. */
  SWIFTPROX_CONTACT_DETAIL_DEPTH = 1,
  /** That, and the manifold, of pairs up to the margin apart, too. */
  SWIFTPROX_CONTACT_DETAIL_MANIFOLD = 2,
  /**
   * That, and of more than four points of a manifold four: the deepest, the farthest from it and the extremes on either side of
   * the line between them. None is moved.
   */
  SWIFTPROX_CONTACT_DETAIL_REDUCED_MANIFOLD = 3
} swiftprox_contact_detail;

/** What a query over a scene is asked for. Begin with SWIFTPROX_SCENE_QUERY_DEFAULT, then change what should differ. */
typedef struct swiftprox_scene_query {
  /** Set by SWIFTPROX_SCENE_QUERY_DEFAULT. */
  size_t struct_size;
  /**
   * List pairs whose true distance is at most this, intersecting ones always, and those that a step budget leaves open; from 0
   * to infinity (all pairs, however many). Default: SWIFTPROX_DEFAULT_TOLERANCE, of contacts 0, of all others infinity.
   * swiftprox_scene_query_intersection does without it, but refuses one out of range.
   */
  double distance_tolerance;
  /** swiftprox_scene_query_approximate: upper - lower of a pair may be as large as this ... Default: 0. */
  double absolute_error;
  /** ... or as this times lower. Both 0 (the default): as narrow as exact answers. */
  double relative_error;
  /**
   * swiftprox_scene_query_approximate: finite, it is what upper - lower of all listed pairs together may come to,
   * whatever the two errors say, beside what exact answers take. Pairs that maps of support functions or levels of detail may
   * answer with a share of it take one, all the same; others are answered as by exact queries, and so are all where the scene
   * does not keep all pairs (swiftprox_scene_set_kept_pair_limit). Default: infinity.
   */
  double error_budget;
  /**
   * swiftprox_scene_query_approximate: steps of marching after which a pair stops with what it has, 1 or more. Default:
   * UINT32_MAX, no limit.
   */
  uint32_t step_budget;
  /**
   * Not 0: stop at the first intersecting pair in the order of results, and list no pairs at all then:
   * swiftprox_scene_answer.found is it. Default: 0.
   */
  int32_t early_exit;
  /** Where pairs start and which levels of detail they go through (swiftprox/tuning.h). Default: null, the automatic choice. */
  const struct swiftprox_pair_tuning *tuning;
  /**
   * swiftprox_scene_query_contact: pairs farther apart have no manifold, and points with a larger gap do not belong to one;
   * from 0 to infinity. It is the distance tolerance if that is less. Default: infinity.
   */
  double margin;
  /**
   * swiftprox_scene_query_contact: what is said of each pair beside its answer. absolute_error, relative_error and step_budget
   * are then those of the depths. Queries of other kinds do as with none; all refuse an unknown number. Default:
   * SWIFTPROX_CONTACT_DETAIL_NONE.
   */
  swiftprox_contact_detail detail;
} swiftprox_scene_query;

/** Begins a swiftprox_scene_query: the defaults. In C and C++, as an initialiser. */
#define SWIFTPROX_SCENE_QUERY_DEFAULT \
  {sizeof(swiftprox_scene_query), SWIFTPROX_DEFAULT_TOLERANCE, 0, 0, HUGE_VAL, UINT32_MAX, 0, 0, HUGE_VAL, SWIFTPROX_CONTACT_DETAIL_NONE}

/** One pair of convex pieces in a query's list. */
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

/** What a query over a scene found. */
typedef struct swiftprox_scene_answer {
  /**
   * The pairs that the query lists, by object 1, object 2, piece 1, piece 2, objects in order of creation. Owned by the
   * scene, valid until its next query, swiftprox_scene_shrink, or its end: objects may be moved, added and removed while they
   * are read. Null when count is 0.
   */
  const struct swiftprox_pair_result *pairs;
  /** How many pairs. */
  size_t count;
  /** 1 if any tested pair intersects, else 0. */
  int32_t intersecting;
  /**
   * The intersecting pair at which the query stopped, if it did (swiftprox_scene_query.early_exit), else null: of all that
   * intersect the first in the order of pairs, with what the query says of such pairs. (A step budget may leave an earlier one
   * undecided.) Owned and valid as pairs are.
   */
  const struct swiftprox_pair_result *found;
} swiftprox_scene_answer;

/**
 * Lists the intersecting pairs (touching ones are), each with its verdict alone: of an answer outcome, decided_by, proof,
 * statistics and distance, lower and upper, which are 0, are said. `query` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of query is out of range, also where this query does without it.
 * SWIFTPROX_ERROR_MEMORY: none for a changed list of pairs; the next query tries again. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument. SWIFTPROX_ERROR_POISONED. The answer is empty then. What a scene
 * has accepted it answers: no pair makes a query fail.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_intersection(struct swiftprox_scene *scene,
                                                    const struct swiftprox_scene_query *query,
                                                    struct swiftprox_scene_answer *answer);

/**
 * Lists the pairs whose distance is at most the distance tolerance, intersecting ones included, with what swiftprox_pair_distance
 * says of each: of a separated pair distance, lower, upper, points in all frames, normal and features; of an intersecting one the
 * proof, and distance, lower and upper, which are 0. Errors as of swiftprox_scene_query_intersection.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_distance(struct swiftprox_scene *scene,
                                                const struct swiftprox_scene_query *query,
                                                struct swiftprox_scene_answer *answer);

/**
 * As swiftprox_scene_query_distance, each distance as narrow as query->absolute_error, relative_error or error_budget ask
 * for and no narrower, with what swiftprox_pair_approximate says of each pair. A pair whose step budget ran out before the verdict
 * (SWIFTPROX_OUTCOME_UNDECIDED) is listed and does not count as intersecting. Errors as of swiftprox_scene_query_intersection.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_approximate(struct swiftprox_scene *scene,
                                                   const struct swiftprox_scene_query *query,
                                                   struct swiftprox_scene_answer *answer);

/**
 * As swiftprox_scene_query_distance, with what swiftprox_pair_contact says of each pair; its tolerance is 0 unless query
 * says otherwise, so that only pairs that touch or intersect are listed.
 *
 * With a query->detail the answers say what those of swiftprox_scene_query_distance do. swiftprox_scene_get_contacts then
 * hands over how deep each pair is, and where its objects meet: what swiftprox_pair_depth and swiftprox_pair_manifold say.
 *
 * Errors as of swiftprox_scene_query_intersection; SWIFTPROX_ERROR_MEMORY also when there is too little for depths and points.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_contact(struct swiftprox_scene *scene,
                                               const struct swiftprox_scene_query *query,
                                               struct swiftprox_scene_answer *answer);

/** What a query of contacts says of a pair beside its answer. What was not asked for, or is not there, says nothing. */
typedef struct swiftprox_contact {
  /** How deep the two are in each other; of a pair that does not intersect nothing is said. */
  struct swiftprox_depth_answer depth;
  /** Where they meet, or nearly do. */
  struct swiftprox_manifold manifold;
  /** Where among all points those of the manifold begin, as many as its `point_count`. */
  size_t first_point;
} swiftprox_contact;

/** What a query of contacts said beside its answers. */
typedef struct swiftprox_scene_contacts {
  /**
   * One for each of the pairs that the query listed, in their order; of a query that stopped that of
   * swiftprox_scene_answer.found alone. Owned by the scene and valid as the answer's pairs are. Null when count is 0.
   */
  const struct swiftprox_contact *contacts;
  /** How many. */
  size_t count;
  /**
   * The points of their manifolds: those of a contact begin at its first_point. Owned and valid as contacts are. Null when
   * point_count is 0.
   */
  const struct swiftprox_manifold_point *points;
  /** How many. */
  size_t point_count;
} swiftprox_scene_contacts;

/**
 * Hands over what the last query of a scene said beside its answers: nothing unless it was one of contacts with a
 * swiftprox_scene_query.detail. On failure `*contacts` is empty.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene or contacts is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_contacts(const struct swiftprox_scene *scene,
                                              struct swiftprox_scene_contacts *contacts);

/** What is asked of a pair. */
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
 * As the query of that kind, of the pairs of one object alone: what it touches or comes near. query->error_budget is not heeded;
 * the tolerance of contacts is 0 and of others infinity unless query says otherwise. It takes as long as the pairs that are near,
 * if nothing else has moved.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT also for an unknown kind. Other
 * errors as of swiftprox_scene_query_intersection.
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
 * As swiftprox_scene_query_object, of a shape that is not in the scene, put at `pose`, 12 doubles, for this question. Each object
 * of the scene is object 1 of its results; object 2 has the null id. All objects are asked, whatever activation and filters say.
 *
 * SWIFTPROX_ERROR_POSE: the pose is refused. SWIFTPROX_ERROR_INVALID_ARGUMENT also for an unknown kind. Other errors as of
 * swiftprox_scene_query_intersection.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_placed(struct swiftprox_scene *scene,
                                              const struct swiftprox_shape *shape,
                                              const double *pose,
                                              swiftprox_query_kind kind,
                                              const struct swiftprox_scene_query *query,
                                              struct swiftprox_scene_answer *answer);

/**
 * As swiftprox_scene_query_placed, of a body of `piece_count` convex pieces: `poses` holds 12 doubles for each, where it is in the
 * world. piece2 of a result says which of them it is. Objects are asked whose groups have a bit of `mask` (UINT32_MAX: all in some
 * group), whatever their own masks, activation and filters say.
 *
 * SWIFTPROX_ERROR_POSE: a pose is refused; the message says which. SWIFTPROX_ERROR_INVALID_ARGUMENT also without pieces and for an
 * unknown kind. Other errors as of swiftprox_scene_query_intersection.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_placed_pieces(struct swiftprox_scene *scene,
                                                     const struct swiftprox_shape *const *pieces,
                                                     const double *poses,
                                                     size_t piece_count,
                                                     uint32_t mask,
                                                     swiftprox_query_kind kind,
                                                     const struct swiftprox_scene_query *query,
                                                     struct swiftprox_scene_answer *answer);

/** @} */

/**
 * @defgroup swiftprox_activation Which pairs a scene tests
 * @{
 */

/**
 * Sets whether queries test pairs of objects: `active` other than 0, or 0. With two ids it is their pair, in either order, with all
 * its pairs of pieces; with one null pointer all pairs that the other object is in now; with two all that there are now. Objects
 * added later begin with all their pairs active; two fixed objects are never tested.
 *
 * SWIFTPROX_ERROR_HANDLE: an id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: one object twice.
 * SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pair_active(struct swiftprox_scene *scene,
                                                 const struct swiftprox_object_id *id1,
                                                 const struct swiftprox_object_id *id2,
                                                 int32_t active);

/**
 * Sets `*active` to 1 if queries test the pair of two objects, given in either order, else to 0 (also on failure).
 *
 * Errors as of swiftprox_scene_set_pair_active; SWIFTPROX_ERROR_NULL_POINTER also when active is null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_pair_active(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id1,
                                                 struct swiftprox_object_id id2,
                                                 int32_t *active);

/**
 * Says whether a pair of objects is to be tested (not 0) or not (0), the earlier created object first; `user` is the pointer given
 * with the callback. It should always say the same of a pair. It runs in the thread that queries, must return, and cannot use the
 * scene; a C++ exception that leaves it ends the program.
 */
typedef int32_t (*swiftprox_pair_filter_callback)(struct swiftprox_object_id object1,
                                                  struct swiftprox_object_id object2,
                                                  void *user);

/**
 * Asks `filter` of each pair of objects whether it is to be tested, once for each of its pairs of pieces when that comes near, and
 * of many objects without a tolerance in each query. Null: none is asked, as before the first call. All pairs that are near are
 * asked anew: set the same filter again when it has changed its mind. The callback may be called from every thread that queries the scene.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
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

/** What has become of a pair or of a contact point since the listener's last query. */
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
  /** What has become of the two pieces. */
  swiftprox_event_state state;
  /** What has become of the two objects, which are listed if any of their pieces are. */
  swiftprox_event_state objects_state;
  /** Its place among the pairs of the answer, and among contacts if they were asked for; SIZE_MAX where it has ended. */
  size_t result;
  /** Where among all points of the events its own begin. */
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
  /** What has become of it. */
  swiftprox_event_state state;
} swiftprox_point_event;

/** What a listener hears. */
typedef struct swiftprox_listener_events {
  /**
   * All pairs that the query lists, and those that were listed and are not, in the order of results. Owned by the listener,
   * valid until it asks again or its end. Null when count is 0.
   */
  const struct swiftprox_pair_event *pairs;
  /** How many. */
  size_t count;
  /**
   * Their points, where the query asks for manifolds: those of a pair begin at its first_point. Owned and valid as pairs are.
   * Null when point_count is 0.
   */
  const struct swiftprox_point_event *points;
  /** How many. */
  size_t point_count;
} swiftprox_listener_events;

/**
 * Remembers what was listed when it last asked a scene, and nothing else: what other listeners ask does not change what it hears.
 * Of another scene it hears that all pairs of the one before have ended.
 */
typedef struct swiftprox_listener swiftprox_listener;

/**
 * Makes a listener that remembers nothing yet; the caller owns it and gives it back with swiftprox_listener_destroy. On failure
 * `*listener` is null.
 *
 * SWIFTPROX_ERROR_NULL_POINTER.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_listener_create(struct swiftprox_listener **listener);

/**
 * Gives back what swiftprox_listener_create made, and the events that it owns. Null is ignored.
 *
 * Experimental.
 */
void swiftprox_listener_destroy(struct swiftprox_listener *listener);

/**
 * As the query of that kind over all pairs, and what has changed since the listener last asked: which pairs of pieces and which
 * contact points have begun, which persist and which have ended. The first time all begin. Contacts with query->detail
 * SWIFTPROX_CONTACT_DETAIL_MANIFOLD have points; swiftprox_scene_get_contacts hands over where they are.
 *
 * A pair counts as long as the query lists it; of another tolerance, another listener. Each listener remembers for itself: what
 * others and other queries ask changes nothing of that. Removed objects, deactivated pairs and all that a former scene listed have
 * ended. A recording notes the query. The tolerance of contacts is 0 and of others infinity unless query says otherwise.
 *
 * On failure answer and events are empty, and the listener remembers what it did. SWIFTPROX_ERROR_INVALID_ARGUMENT also for an
 * unknown kind, and if query->early_exit is set. SWIFTPROX_ERROR_NULL_POINTER also if listener or events is null. Other errors as
 * of swiftprox_scene_query_contact.
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

/**
 * @defgroup swiftprox_batch Many pairs at once
 * @{
 */

/** A pair to be asked. */
typedef struct swiftprox_pair_question {
  /** Shape 1. */
  const struct swiftprox_shape *shape1;
  /** Where it is, 12 doubles. */
  const double *pose1;
  /** Shape 2. */
  const struct swiftprox_shape *shape2;
  /** Where it is, 12 doubles. */
  const double *pose2;
  /** What this pair alone remembers; no two pairs share one. */
  struct swiftprox_pair_cache *cache;
} swiftprox_pair_question;

/**
 * Asks each of `count` pairs what `kind` names, into the answer at the same place. Answers and caches are bit for bit those of
 * swiftprox_pair_intersection, swiftprox_pair_distance, swiftprox_pair_contact or swiftprox_pair_approximate; the memory of pairs
 * that follow is asked for ahead. The workers of `scene` share 2,048 pairs or more; it may be null, and then the caller's thread
 * does all. The scene is not changed, and no other call may use it meanwhile. `config` may be null for the defaults.
 *
 * A pair that is refused gets an answer that says nothing, and all others are answered: the message names the first by its number.
 * SWIFTPROX_ERROR_POSE: a pose is refused. SWIFTPROX_ERROR_INVALID_ARGUMENT: kind is unknown, or a member of config is out of
 * range. SWIFTPROX_ERROR_NULL_POINTER: an array or a member of a pair is null; then, and where memory is lacking, nothing is
 * answered. SWIFTPROX_ERROR_STRUCT_SIZE, SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_BUSY, SWIFTPROX_ERROR_POISONED.
 * SWIFTPROX_ERROR_BUG: all answers and caches are reset.
 *
 * Experimental.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_batch(swiftprox_query_kind kind,
                                      const struct swiftprox_pair_question *pairs,
                                      size_t count,
                                      const struct swiftprox_pair_config *config,
                                      struct swiftprox_scene *scene,
                                      struct swiftprox_pair_answer *answers);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
