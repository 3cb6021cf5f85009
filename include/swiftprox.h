/*
 * swiftprox: certified proximity queries between convex polyhedra.
 *
 * Conventions, which hold for every function below:
 *
 * Names. swiftprox_<noun>_<verb>; the noun comes first in the arguments.
 *
 * Failure. What can fail returns a swiftprox_status: SWIFTPROX_OK is 0, the numbers are never reused.
 * swiftprox_library_last_error_message says what was wrong and where, for each thread. A call that fails changes nothing but the
 * outputs it names. Nothing is printed, nothing unwinds into the caller. A bug of the library, when it is caught, comes back as
 * SWIFTPROX_ERROR_BUG; a scene that was being changed answers SWIFTPROX_ERROR_POISONED from then on and can only be destroyed. What
 * a shape holds never changes once made, so no bug can spoil it. What a failed call does not say is NaN where it is a real number,
 * else 0 or null.
 *
 * Memory. Arrays in proportion to what the caller gives, to a file or to a scene may be refused: the call then ends in
 * SWIFTPROX_ERROR_MEMORY, as each that allocates may, and nothing has changed. What else is allocated is small, in blocks of less
 * than 128 kB that do not grow with the input: a handle's own record, integers of the exact tier, messages with the path of a file.
 * Where that is refused the program ends with a message.
 *
 * Pointers. They are aligned and live as their types say. A null options, config or query means the defaults; another null
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
 * Structs. Options, configs, queries and infos begin with struct_size and may grow at their end: fill the first three with their
 * _init function and change members, set an info's struct_size to its size. A struct of an older header is accepted, one of a newer
 * header as long as what this library does not know is zero. All others (answers, results, features, statistics, meshes, caches)
 * stay as they are within a major version, while that is 0 within a minor one. Enumerators travel as int32_t; unknown ones are
 * refused.
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

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Major version of this header: programs compiled with another one do not go with this library. */
#define SWIFTPROX_VERSION_MAJOR 0

/** Minor version of this header. While the major version is 0, another minor version is another interface. */
#define SWIFTPROX_VERSION_MINOR 1

/** Patch version of this header. */
#define SWIFTPROX_VERSION_PATCH 0

/** What a call returns. The numbers are never reused. */
enum {
  /** The call did what it says. */
  SWIFTPROX_OK = 0,
  /** A pointer that must not be null is null: the message names the argument. */
  SWIFTPROX_ERROR_NULL_POINTER = 1,
  /** An argument is out of range, not finite or unknown: the message names it. */
  SWIFTPROX_ERROR_INVALID_ARGUMENT = 2,
  /**
   * A struct_size is not one that this library knows: the struct was not initialised by its _init function, or it comes
   * from a newer header and sets what this library does not know.
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
   * There is no memory for an array in proportion to what the caller gave or to a scene: the message says how much was asked
   * for. Nothing has changed, and the same call may succeed when there is more.
   */
  SWIFTPROX_ERROR_MEMORY = 15,
  /**
   * The scene is in use: by another thread, which the rules for threads forbid, or by a call that this one was made in. Nothing
   * has changed.
   */
  SWIFTPROX_ERROR_BUSY = 16
};
typedef int32_t swiftprox_status;

/** Which interval a query computes. */
enum {
  /** As tight as double precision allows. */
  SWIFTPROX_BOUNDS_TIGHT = 0,
  /** The cheapest that still prove the verdict. */
  SWIFTPROX_BOUNDS_VERDICT = 1
};
typedef int32_t swiftprox_bounds;

/** Where marching starts. It changes how fast an answer comes, never the verdict. */
enum {
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
};
typedef int32_t swiftprox_start;

/** Which levels of detail a query goes through, of those that the shapes have. */
enum {
  /**
   * Those that save time: of large bodies, for approximate queries that they may answer (60,000 vertices, both together) and
   * for intersection (200,000). Smaller bodies themselves answer about as quickly, from their look-up tables. The first such
   * query of a shape with automatic levels makes them, which takes about twice as long as making the shape did.
   */
  SWIFTPROX_LEVELS_AUTOMATIC = 0,
  /** None. */
  SWIFTPROX_LEVELS_NONE = 1,
  /** All, whatever is asked (Ehmann & Lin 2000). */
  SWIFTPROX_LEVELS_ALL = 2
};
typedef int32_t swiftprox_levels;

/** Which object goes to a finer level, and by how many, when a pair of levels is too coarse. */
enum {
  /** The object whose level has the larger deviation, by one. */
  SWIFTPROX_REFINEMENT_ADAPTIVE = 0,
  /** One object by one: that at the coarser level, object 1 where both are at the same. */
  SWIFTPROX_REFINEMENT_SINGLE = 1,
  /** Both by one. */
  SWIFTPROX_REFINEMENT_SINGLE_SINGLE = 2,
  /** Both by two. */
  SWIFTPROX_REFINEMENT_DOUBLE_DOUBLE = 3
};
typedef int32_t swiftprox_refinement;

/** The outcome of a pair query. */
enum {
  /** Nothing is said yet: the value of a fresh answer. */
  SWIFTPROX_OUTCOME_NONE = 0,
  /** The objects are disjoint, `0 < lower <= distance <= upper`; `lower` is 0 only for a distance below the smallest double. */
  SWIFTPROX_OUTCOME_SEPARATED = 1,
  /** The objects are disjoint and farther apart than the distance tolerance: only `lower` is said, which is at least that. */
  SWIFTPROX_OUTCOME_BEYOND = 2,
  /** The closed objects have a common point (touching included). */
  SWIFTPROX_OUTCOME_INTERSECTING = 3,
  /** The step budget of an approximate query ran out before the verdict: `0 = lower <= distance <= upper`. */
  SWIFTPROX_OUTCOME_UNDECIDED = 4
};
typedef int32_t swiftprox_outcome;

/** How a pair query ended. Values are never reused. */
enum {
  /** Nothing was asked yet. */
  SWIFTPROX_PAIR_STATUS_NONE = 0,
  /** Voronoi marching ended and its certificate holds. */
  SWIFTPROX_PAIR_STATUS_MARCHED = 1,
  /** What proved the last verdict proves this one, or nearly did: vertex pairs that enclose the origin, or a separating axis. */
  SWIFTPROX_PAIR_STATUS_COHERENT = 2,
  /** Gilbert-Johnson-Keerthi decided. */
  SWIFTPROX_PAIR_STATUS_FALLBACK = 3,
  /** Integer arithmetic decided. */
  SWIFTPROX_PAIR_STATUS_EXACT = 4,
  /** An approximate query stopped because its interval was narrow enough. */
  SWIFTPROX_PAIR_STATUS_WITHIN_TOLERANCE = 5,
  /**
   * The step budget of an approximate query ran out: the interval holds, and the next query with the same cache goes on from
   * there.
   */
  SWIFTPROX_PAIR_STATUS_BUDGET_SPENT = 6,
  /** The bounding spheres are apart, and farther than the distance tolerance if there is one: no more was asked. */
  SWIFTPROX_PAIR_STATUS_BOUNDING_SPHERES = 7,
  /** In a scene: balls inside the objects overlap. Such an answer carries no vertex pairs as its proof. */
  SWIFTPROX_PAIR_STATUS_INSCRIBED_SPHERES = 8
};
typedef int32_t swiftprox_pair_status;

/** Kind of a feature. */
enum {
  /** Nothing is said. */
  SWIFTPROX_FEATURE_KIND_NONE = 0,
  /** A vertex: `ids[0]` is its index in the caller's array. */
  SWIFTPROX_FEATURE_KIND_VERTEX = 1,
  /** An edge: `ids` are the caller's indices of its two end vertices. */
  SWIFTPROX_FEATURE_KIND_EDGE = 2,
  /**
   * A face: `ids[0]` is the caller's index of a polygon that holds the witness point; of a contact of
   * objects deep in each other one that reaches farthest into the other. Of a hull that was made without polygons it is a
   * number of the hull's own, from 0 and below its number of faces.
   */
  SWIFTPROX_FEATURE_KIND_FACE = 3
};
typedef int32_t swiftprox_feature_kind;

/** Which look-up table a body has. */
enum {
  /** Shells if the body has enough vertices for them to pay, else none: beside a body with shells all vertices are looked at. */
  SWIFTPROX_LOOKUP_AUTOMATIC = 0,
  /** None. */
  SWIFTPROX_LOOKUP_NONE = 1,
  /** Vertices near points on several spheres, looked up on both bodies for what was found on the other. */
  SWIFTPROX_LOOKUP_SHELLS = 2,
  /** That of Ehmann & Lin (2000, section 4.6), looked up in the direction of the other body's centre of mass. */
  SWIFTPROX_LOOKUP_SPHERICAL = 3
};
typedef int32_t swiftprox_lookup;

/** What to do with input that is not a closed convex mesh with interior. */
enum {
  /** Refuse it with a message that says where. */
  SWIFTPROX_INPUT_STRICT = 0,
  /** Admit bodies without interior (a two-sided polygon); otherwise as strict. */
  SWIFTPROX_INPUT_FLAT = 1,
  /**
   * Take the convex hull of the vertices, of any dimension. Faces label the hull if one of the other two would admit the
   * mesh; otherwise they are ignored, and a face's label is its own index.
   */
  SWIFTPROX_INPUT_HULL = 2
};
typedef int32_t swiftprox_input;

/** How the levels of a body are made. */
enum {
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
};
typedef int32_t swiftprox_hierarchy;

/**
 * Receives the mesh that a swiftprox_mesh_reader_callback reads: vertices, faces, or why there is none. It is good during the call
 * of the callback, for its thread.
 */
typedef struct swiftprox_mesh_sink swiftprox_mesh_sink;

/** Objects, their poses and the pairs that queries test. Make one with swiftprox_scene_create. */
typedef struct swiftprox_scene swiftprox_scene;

/**
 * Geometry for queries: immutable, shared by any number of owners. What is made when a query first needs it, look-up
 * tables of the body and of its levels and automatic levels, is all that is ever added.
 */
typedef struct swiftprox_shape swiftprox_shape;

/**
 * Receives every failure as it happens, from the thread where it happens: its status, its message (valid during the call)
 * and the pointer given to swiftprox_library_set_log. It must return; a C++ exception that leaves it ends the program.
 */
typedef void (*swiftprox_log_callback)(int32_t status, const char *message, void *user);

/**
 * Gives memory of `size` bytes, not 0 and a multiple of `alignment`, at an address that is one, too. The alignment is a power of
 * two, at least a pointer's and sometimes more than malloc keeps (64, for one). Null if there is no memory, as where the system's
 * runs out: for what grows with the caller's input or a scene the call then ends in SWIFTPROX_ERROR_MEMORY; for what is small the
 * program ends with a message (the head of this file says what that is). `user` is the pointer given to
 * swiftprox_library_set_allocator.
 */
typedef void *(*swiftprox_allocate_callback)(void *user, size_t size, size_t alignment);

/**
 * Takes back memory that the swiftprox_allocate_callback set with it gave for the same size and alignment. `user` is the pointer
 * given with both.
 */
typedef void (*swiftprox_deallocate_callback)(void *user, void *memory, size_t size, size_t alignment);

/**
 * Reads a mesh file: calls swiftprox_mesh_sink_add_vertices and swiftprox_mesh_sink_add_faces as often as it likes and returns 0;
 * or says what is wrong with the file by swiftprox_mesh_sink_fail. Anything but 0 refuses the file, too, and so does every call to
 * the sink that was refused, whether or not the callback has looked at its status.
 *
 * `user` is the pointer given with the callback. `data` holds the `size` bytes of the whole file but for a UTF-8 byte order mark:
 * it begins with the white space before the magic, if there is any, and the magic itself, which are the callback's to skip. Behind
 * them is one zero byte more, where strtod and its like end. (What strtod takes for the decimal point depends on LC_NUMERIC, the
 * program's locale: where that wants a comma it reads 0.5 as 0. The library's own readers take the point in every locale.) Data
 * and sink are gone when the callback returns; what the sink was given it has copied. The callback may call the library: read
 * other files, and register readers. It must return, and a C++ exception that leaves it ends the program.
 */
typedef int32_t (*swiftprox_mesh_reader_callback)(void *user,
                                                  const char *data,
                                                  size_t size,
                                                  struct swiftprox_mesh_sink *sink);

/**
 * Learns how far the building, loading or preparing of a shape is: a fraction from 0 to 1 that never falls, and the pointer given
 * with the callback. Returns 0 to go on; anything else ends the call with SWIFTPROX_ERROR_CANCELLED. It runs in the thread that
 * builds, must return, and must not use what the call is working on; a C++ exception that leaves it ends the program.
 */
typedef int32_t (*swiftprox_progress_callback)(void *user, double fraction);

/** How a shape is made. Fill it with swiftprox_shape_options_init, then change what should differ. */
typedef struct swiftprox_shape_options {
  /** Set by swiftprox_shape_options_init. */
  size_t struct_size;
  /** A swiftprox_input: what to do with input that is not a closed convex mesh with interior. Default: refuse it. */
  int32_t input;
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
   * which means 1e-9, and 1e-6 for meshes that went through single precision (STL).
   */
  double convexity_tolerance;
  /** A swiftprox_hierarchy: how levels of detail are made. Default: automatic. */
  int32_t hierarchy;
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
  /** Learns how far the building of the shape is, and can cancel it. Default: null. */
  swiftprox_progress_callback progress;
  /** Handed to progress. Default: null. */
  void *progress_user;
  /**
   * A swiftprox_lookup: which table says where a query starts when the last one of the pair tells nothing. It is made by the
   * first query that looks into it: less than a quarter of the time that making the shape took. A body smaller than 2^-200 or
   * larger than 2^200 has none. Default: automatic.
   */
  int32_t lookup;
  /**
   * Resolution of the table: of shells, cells along a side of the square that all directions are mapped to, a power of two
   * from 4 to 512; of a spherical table, increments from pole to pole, 2 to 512 (32, 16, 8: 5.625, 11.25, 22.5 degrees).
   * Default: 0, which means what the number of vertices asks for, or 32.
   */
  uint32_t lookup_resolution;
  /** Radius of the sphere of a spherical table's sample points as a multiple of the body's radius, at least 1. Default: 2. */
  double lookup_radius_factor;
} swiftprox_shape_options;

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
  /** Lower corner of the bounding box in the local frame. */
  double lower[3];
  /** Upper corner of the bounding box in the local frame. */
  double upper[3];
  /** Memory that the shape holds, in bytes, levels included, however many share it. */
  size_t bytes;
  /** A swiftprox_hierarchy: how the levels of detail are made. */
  int32_t hierarchy;
  /**
   * The number of levels of detail, the body itself not counted; they are numbered from 1, the finest, on, and the body is
   * level 0. Automatic ones are made by the first query that goes through them: 0 until then.
   */
  size_t level_count;
  /** Of bytes, what the levels take, with their look-up tables once queries have made these. */
  size_t level_bytes;
  /** A swiftprox_lookup: the look-up table that the shape has, never SWIFTPROX_LOOKUP_AUTOMATIC. */
  int32_t lookup;
  /** Its resolution, as in swiftprox_shape_options; 0 without one. */
  uint32_t lookup_resolution;
  /**
   * Its share of `bytes`: 0 until a query, or the making of levels, looks into the table, which makes it. Those of levels are
   * the levels'.
   */
  size_t lookup_bytes;
} swiftprox_shape_info;

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

/** What a pair query is asked for. */
typedef struct swiftprox_pair_config {
  /** The size of this struct, so that it can grow; set by swiftprox_pair_config_init. */
  size_t struct_size;
  /** Of pairs farther apart than this only that is said, with a lower bound; +infinity (the default): of none. */
  double distance_tolerance;
  /** Largest accepted |R^T R - I| entry, from 0 to 1e-2 (the default). */
  double rotation_limit;
  /** Which interval. */
  swiftprox_bounds bounds;
  /** Where marching starts. */
  swiftprox_start start;
  /**
   * Of an approximate query: `upper - lower` may be as large as this ... Other queries do not look at this and the two that
   * follow, not even whether they are in range: from 0 to +infinity, and 1 or more for the budget.
   */
  double absolute_error;
  /** ... or as this times `lower`. Both 0 (the default): as narrow as exact answers. */
  double relative_error;
  /**
   * Of an approximate query: steps of marching after which it stops with what it has, 1 or more; UINT32_MAX (the default):
   * no limit. What marching leaves open is decided all the same, however long it takes; of bodies that intersect it may leave it
   * open only after as many steps as a query without a budget may make. The next query with the same cache goes on where this
   * one stopped, unless `start` says that it begin anew, at the tables or afresh: it may then stop there for ever.
   */
  uint32_t step_budget;
  /** Which levels of detail a query goes through. */
  swiftprox_levels levels;
  /** How it goes from level to level. */
  swiftprox_refinement refinement;
} swiftprox_pair_config;

/**
 * What a pair remembers from its last query, for the caller to keep: all zero is cold, any bytes are safe. It changes how fast
 * an answer comes, never the verdict. What the words mean is the library's own.
 */
typedef struct swiftprox_pair_cache {
  /** Not to be looked at. */
  uint32_t words[24];
} swiftprox_pair_cache;

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
  swiftprox_pair_status status;
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
  /** How many entries of `proof` are used: 1 to 4 when intersecting, but for SWIFTPROX_PAIR_STATUS_INSCRIBED_SPHERES, else 0. */
  uint32_t proof_count;
  /** What the query did. */
  struct swiftprox_statistics statistics;
} swiftprox_pair_answer;

/** How a scene is made. Fill it with swiftprox_scene_options_init, then change what should differ. */
typedef struct swiftprox_scene_options {
  /** Set by swiftprox_scene_options_init. */
  size_t struct_size;
  /** Largest accepted |R^T R - I| entry of a pose, from 0 to 1e-2 (the default). */
  double rotation_limit;
} swiftprox_scene_options;

/**
 * Names an object of a scene. Zero (SWIFTPROX_OBJECT_ID_NULL, the default) names none; the id of a removed object is refused
 * for ever, that of another scene unless about a million scenes were made in between.
 */
typedef uint64_t swiftprox_object_id;
/** Names no object. */
#define SWIFTPROX_OBJECT_ID_NULL 0

/** How an object begins. Fill it with swiftprox_object_options_init, then change what should differ. */
typedef struct swiftprox_object_options {
  /** Set by swiftprox_object_options_init. */
  size_t struct_size;
  /** The caller's own; it comes back in every result. Default: 0. */
  uint64_t user_data;
  /** Where it stands, row-major [R|T]. Default: the identity. */
  double pose[12];
  /** Not 0: pairs of two such objects are never tested; it can still be moved. Default: 0. */
  int32_t fixed;
} swiftprox_object_options;

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
} swiftprox_object_info;

/** What a query over a scene is asked for. Fill it with swiftprox_scene_query_init, then change what should differ. */
typedef struct swiftprox_scene_query {
  /** Set by swiftprox_scene_query_init. */
  size_t struct_size;
  /**
   * List pairs whose true distance is at most this, intersecting ones always, and those that a step budget leaves open; from 0
   * to infinity (the default: all pairs). swiftprox_scene_query_intersection does without it, but refuses one out of range.
   */
  double distance_tolerance;
  /**
   * Not 0: stop at the first intersecting pair in the order of results, and list no pairs at all then:
   * swiftprox_scene_answer.found is it. Default: 0.
   */
  int32_t early_exit;
  /** A swiftprox_bounds: which interval the answers carry. Default: the tight one. */
  int32_t bounds;
  /** swiftprox_scene_query_approximate_distance: upper - lower of a pair may be as large as this ... Default: 0. */
  double absolute_error;
  /** ... or as this times lower. Both 0 (the default): as narrow as exact answers. */
  double relative_error;
  /**
   * swiftprox_scene_query_approximate_distance: finite, it is what upper - lower of all tested pairs together may come to, in
   * equal shares, whatever the two errors say; a pair whose share is less than that is answered as narrowly as by exact queries.
   * Default: infinity.
   */
  double error_budget;
  /**
   * swiftprox_scene_query_approximate_distance: steps of marching after which a pair stops with what it has, 1 or more. Default:
   * UINT32_MAX, no limit.
   */
  uint32_t step_budget;
  /** A swiftprox_levels: which levels of detail queries go through. Default: the automatic choice. */
  int32_t levels;
  /** A swiftprox_refinement: how they go from level to level. Default: the adaptive one. */
  int32_t refinement;
  /** A swiftprox_start: where marching starts in each pair. Default: the automatic choice. */
  int32_t start;
} swiftprox_scene_query;

/** One pair of convex pieces in a query's list. */
typedef struct swiftprox_pair_result {
  /** The earlier created object. */
  swiftprox_object_id object1;
  /** The later created object. */
  swiftprox_object_id object2;
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
   * scene, valid until its next call that takes it by a pointer that is not const. Null when count is 0.
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



/** The version of the library that runs, as "major.minor.patch". Never null, valid for ever. */
const char *swiftprox_library_version(void);

/**
 * Whether a program compiled with the header of the given version can run with this library. Call it once with
 * SWIFTPROX_VERSION_MAJOR, SWIFTPROX_VERSION_MINOR and SWIFTPROX_VERSION_PATCH, which are then those of the program.
 *
 * SWIFTPROX_ERROR_VERSION: the library is too old or has another interface; the message names both versions.
 */
swiftprox_status swiftprox_library_check_version(int32_t major,
                                                 int32_t minor,
                                                 int32_t patch);

/** A status in words. Never null, valid for ever; a number that is no status gets a string that says so. */
const char *swiftprox_library_status_string(int32_t status);

/**
 * An outcome of a pair query, a swiftprox_outcome, in words. Never null, valid for ever; a number that is no outcome gets a string
 * that says so.
 */
const char *swiftprox_library_outcome_string(int32_t outcome);

/**
 * A kind of features, a swiftprox_feature_kind, in a word: "none", "vertex", "edge" or "face". Never null, valid for ever; a
 * number that is no kind gets a string that says so.
 */
const char *swiftprox_library_feature_kind_string(int32_t kind);

/**
 * What went wrong in the last call of this thread that did not return SWIFTPROX_OK; the empty string before the first. Never
 * null; valid until the next such call of the same thread, or its end.
 */
const char *swiftprox_library_last_error_message(void);

/**
 * Sets the process-wide log, which receives what the library would say if it printed: the message of every call that does
 * not return SWIFTPROX_OK. Null (the default) for none. The callback may be called from every thread that uses the library,
 * from several at once; calls already under way in other threads may still reach the old one for a moment.
 */
void swiftprox_library_set_log(swiftprox_log_callback callback,
                               void *user);

/**
 * Sets where the library takes all its memory from, in the whole process: both functions, or null for both (the default) for the
 * system's malloc. At any time: memory that the library holds goes back to the functions it came from, so that functions once
 * set, and `user`, must stay good until the process ends: they are called at the end of threads and after main, too.
 *
 * The functions may be called from every thread that uses the library, from several at once. They must return, must not call the
 * library, and a C++ exception that leaves them ends the program.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: one of the functions is null and the other one is not. SWIFTPROX_ERROR_UNSUPPORTED: the
 * library was not built by CMake, nor with Cargo's feature `allocator`: inside a Rust program it has that program's allocator.
 * Nothing has changed then.
 */
swiftprox_status swiftprox_library_set_allocator(swiftprox_allocate_callback allocate,
                                                 swiftprox_deallocate_callback deallocate,
                                                 void *user);

/**
 * Registers a reader of mesh files, which swiftprox_shape_create_from_file and swiftprox_scene_add_file call for every file that
 * begins with the bytes of `magic`, a string that is copied, behind white space and a UTF-8 byte order mark: whatever the
 * extension of the file is, and before the built-in readers for TRI, POLY, OFF, OBJ and STL, which a magic such as "OFF" replaces.
 * The first bytes alone count: "PLY" is the magic of a file that begins with PLYMOUTH, too. The callback is handed what was
 * skipped and the magic with the rest of the file, all but the byte order mark.
 *
 * The registry is the process's own; it may be changed at any time from any thread, from a callback as well. A reader registered
 * under a magic that has one replaces it, a null callback takes it back (and does nothing if there is none). The callback may be
 * called from every thread that reads files, from several at once. `user` must be good until the reader is replaced or taken back
 * and no other thread is still reading a file by it.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: magic is empty or begins with white space or a byte order mark, which are skipped in files; or
 * it begins with the magic of another reader, or that one with it: a file could be for both. SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_NULL_POINTER: magic is null.
 */
swiftprox_status swiftprox_library_register_mesh_reader(const char *magic,
                                                        swiftprox_mesh_reader_callback callback,
                                                        void *user);

/**
 * Adds `vertex_count` vertices, 3 coordinates each, to the mesh that a callback reads. They are numbered from 0 in the order in
 * which they are added. The array is copied.
 *
 * SWIFTPROX_ERROR_MESH: a coordinate is not finite; the message names the vertex. SWIFTPROX_ERROR_LIMIT: too many vertices.
 * SWIFTPROX_ERROR_MEMORY, which is then the status of what reads the file, too.
 * SWIFTPROX_ERROR_NULL_POINTER: sink is null, or vertices while vertex_count is not 0. Nothing is added, and the file is refused.
 */
swiftprox_status swiftprox_mesh_sink_add_vertices(struct swiftprox_mesh_sink *sink,
                                                  const double *vertices,
                                                  size_t vertex_count);

/**
 * Adds `face_count` faces to the mesh that a callback reads: `indices` holds the numbers of their vertices, one face after the
 * other, each counter-clockwise seen from outside; `valences` the number of vertices of each face, or null when all are triangles.
 * They are numbered from 0 in the order in which they are added. A face may name vertices that are added later: that they exist is
 * checked when the callback returns. The arrays are copied.
 *
 * SWIFTPROX_ERROR_LIMIT: too many faces or indices. SWIFTPROX_ERROR_MEMORY: as of swiftprox_mesh_sink_add_vertices.
 * SWIFTPROX_ERROR_NULL_POINTER: sink is null, or indices while there are any. Nothing is added, and the file is refused.
 */
swiftprox_status swiftprox_mesh_sink_add_faces(struct swiftprox_mesh_sink *sink,
                                               const uint32_t *indices,
                                               const uint32_t *valences,
                                               size_t face_count);

/**
 * Says that the coordinates of the file went through single precision, as those of STL files have: how far a vertex may lie
 * outside a face is then 1e-6 of the bounding-box diagonal, not 1e-9, unless swiftprox_shape_options.convexity_tolerance says
 * otherwise.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: sink is null.
 */
swiftprox_status swiftprox_mesh_sink_set_single_precision(struct swiftprox_mesh_sink *sink);

/**
 * Refuses the file that a callback reads, whatever the callback returns. `message`, a string of which up to 4,096 bytes are
 * copied, says what is wrong, best with the line; the library adds which file and which reader. The first message holds, also
 * where a call to the sink was refused before, unless that was for memory.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: sink or message is null; the file is refused all the same if sink is not.
 */
swiftprox_status swiftprox_mesh_sink_fail(struct swiftprox_mesh_sink *sink,
                                          const char *message);

/**
 * Fills `options` with the defaults, struct_size included.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: options is null.
 */
swiftprox_status swiftprox_shape_options_init(struct swiftprox_shape_options *options);

/**
 * Makes a shape from a polygon mesh. The arrays are copied.
 *
 * `vertices` holds 3 * vertex_count coordinates. `indices` holds the 0-based vertex numbers of all faces, one face after the
 * other, each counter-clockwise seen from outside; `valences` the number of vertices of each face, or null when all are
 * triangles. The mesh must be closed, a 2-manifold, consistently oriented, connected, convex and without unused vertices,
 * unless the options say otherwise. Answers name features by these numbers.
 *
 * On success `*shape` is a new shape that the caller owns and gives back with swiftprox_shape_release; on failure it is null.
 * `options` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_MESH: the mesh breaks the contract, or a coordinate is not finite. SWIFTPROX_ERROR_LIMIT: a count does not fit
 * 32 bits. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_CANCELLED: options->progress said so. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_INVALID_ARGUMENT, SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument.
 */
swiftprox_status swiftprox_shape_create_from_mesh(const double *vertices,
                                                  size_t vertex_count,
                                                  const uint32_t *indices,
                                                  const uint32_t *valences,
                                                  size_t face_count,
                                                  const struct swiftprox_shape_options *options,
                                                  struct swiftprox_shape **shape);

/**
 * Makes a shape from the convex hull of `point_count` points, 3 coordinates each. The array is copied. Features of answers
 * name vertices by their place in `points` (the first of equal ones), faces by numbers of the hull's own, from 0 and below
 * swiftprox_shape_info.face_count.
 *
 * On success `*shape` is a new shape that the caller owns and gives back with swiftprox_shape_release; on failure it is null.
 * `options` may be null for the defaults, which refuse a hull without interior.
 *
 * SWIFTPROX_ERROR_MESH: a coordinate is not finite, or the options do not admit a hull of that dimension.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: no points, or an option out of range. SWIFTPROX_ERROR_LIMIT: too many points.
 * SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_CANCELLED: options->progress said so. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE: the message
 * names the argument.
 */
swiftprox_status swiftprox_shape_create_from_points(const double *points,
                                                    size_t point_count,
                                                    const struct swiftprox_shape_options *options,
                                                    struct swiftprox_shape **shape);

/**
 * Makes a shape from a mesh file: by the reader that swiftprox_library_register_mesh_reader has registered for its first bytes if
 * there is one, else TRI, POLY, OFF, OBJ or STL, by its extension, else by its content. Features of answers count vertices and
 * faces from 0 in the order of the file, or in which the reader adds them; of STL vertices in the order in which they are first
 * mentioned, and no triangles with two equal corners.
 *
 * On success `*shape` is a new shape that the caller owns and gives back with swiftprox_shape_release; on failure it is null.
 * `options` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_FILE: the file cannot be read, is no regular file (a pipe and a device are refused, not waited for), is larger
 * than 4 GiB (4,294,967,296 bytes) or does not parse; the message names the line, or the registered reader and what it says.
 * SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_MESH: its mesh breaks the contract (see swiftprox_shape_create_from_mesh). Both messages
 * name the file.
 * SWIFTPROX_ERROR_CANCELLED: options->progress said so. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_INVALID_ARGUMENT,
 * SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument.
 */
swiftprox_status swiftprox_shape_create_from_file(const char *path,
                                                  const struct swiftprox_shape_options *options,
                                                  struct swiftprox_shape **shape);

/**
 * Saves a shape in a file, replacing what was there: with its levels of detail but for automatic ones, which are made again
 * when they are needed, as the look-up table is. Any machine can load it, with the levels that are saved: built anew, those of a
 * machine with other vector units may be slightly different ones. A version of this library that does not know the version of the
 * file refuses it.
 *
 * SWIFTPROX_ERROR_FILE: the file cannot be written or is no regular one (nothing waits for the reader of a pipe); the message
 * names it and says why. SWIFTPROX_ERROR_MEMORY: the file is as it was. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the message names the argument.
 */
swiftprox_status swiftprox_shape_save(const struct swiftprox_shape *shape,
                                      const char *path);

/**
 * Loads a shape that swiftprox_shape_save has saved: the same hull, labels, levels and table, for the same answers. What answers
 * rely on is not believed but proved and measured again, so loading takes up to about half as long as making the shape did,
 * levels included; a damaged file is refused. `progress` learns how far it is and can cancel it, or is null; `progress_user` is
 * handed to it.
 *
 * On success `*shape` is a new shape that the caller owns and gives back with swiftprox_shape_release; on failure it is null.
 *
 * SWIFTPROX_ERROR_FILE: the file cannot be read, is no regular file, is larger than 4 GiB (4,294,967,296 bytes), is no shape file,
 * of another version or damaged; the message names it and says what is wrong. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_CANCELLED:
 * progress said so. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_INVALID_ARGUMENT: the message names the argument.
 */
swiftprox_status swiftprox_shape_load(const char *path,
                                      swiftprox_progress_callback progress,
                                      void *progress_user,
                                      struct swiftprox_shape **shape);

/**
 * Takes one more share of a shape; each needs its own swiftprox_shape_release. Safe from any thread. Null is ignored.
 *
 * Always SWIFTPROX_OK.
 */
swiftprox_status swiftprox_shape_retain(const struct swiftprox_shape *shape);

/**
 * Gives back one share of a shape; the last one frees it (scenes hold shares of their own). Safe from any thread. Null is
 * ignored.
 *
 * Always SWIFTPROX_OK.
 */
swiftprox_status swiftprox_shape_release(const struct swiftprox_shape *shape);

/**
 * Makes now what a query of a shape would make when it first needs it: the look-up table, and automatic levels of detail, which
 * take about twice as long as making the shape did. After that no query of this shape allocates or waits for that.
 *
 * `progress` learns how far it is and can cancel it, or is null; `progress_user` is handed to it. Nothing is reported while
 * the table is made, a small part of the time, of needles up to a third. Safe from any thread: a query that needs the levels
 * meanwhile, or another swiftprox_shape_prepare, does not wait but makes them, too, and what comes second is dropped.
 *
 * SWIFTPROX_ERROR_CANCELLED: progress said so; SWIFTPROX_ERROR_MEMORY: in both cases no levels are made, a table that was made
 * stays, and the shape can be used as before. SWIFTPROX_ERROR_NULL_POINTER: shape is null.
 */
swiftprox_status swiftprox_shape_prepare(const struct swiftprox_shape *shape,
                                         swiftprox_progress_callback progress,
                                         void *progress_user);

/**
 * Says what a shape is: set info->struct_size to sizeof(swiftprox_shape_info) first. On failure real numbers are NaN, all else 0.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: shape or info is null. SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is none that is known.
 */
swiftprox_status swiftprox_shape_get_info(const struct swiftprox_shape *shape,
                                          struct swiftprox_shape_info *info);

/**
 * Copies the vertices of the hull, in the local frame: `capacity` is how many `vertices` has room for (3 coordinates each),
 * at least swiftprox_shape_info.vertex_count. `labels` receives the caller's number of each vertex, or is null.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is too small; nothing is written. SWIFTPROX_ERROR_NULL_POINTER: shape or vertices is
 * null.
 */
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
 */
swiftprox_status swiftprox_shape_copy_triangles(const struct swiftprox_shape *shape,
                                                uint32_t *corners,
                                                size_t capacity);

/**
 * Makes a shape with levels of detail that the caller gives, the finest first: `levels[0]` is the body itself, as
 * swiftprox_shape_create_from_mesh takes it; of each further one the convex hull of its vertices counts (faces are not looked at
 * and may be left out), moved so that its centre of mass falls on that of the next finer level and scaled so that it barely
 * bounds the body. The arrays are copied. options->hierarchy is to be SWIFTPROX_HIERARCHY_NONE or automatic; the input transform
 * goes for all levels.
 *
 * On success `*shape` is a new shape that the caller owns and gives back with swiftprox_shape_release; on failure it is null.
 * `options` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_MESH: the body breaks the contract of swiftprox_shape_create_from_mesh, or a level has no interior; the message
 * names it. SWIFTPROX_ERROR_CANCELLED: options->progress said so. SWIFTPROX_ERROR_LIMIT: a count does not fit 32 bits.
 * SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_INVALID_ARGUMENT, SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument.
 */
swiftprox_status swiftprox_shape_create_from_levels(const struct swiftprox_mesh *levels,
                                                    size_t level_count,
                                                    const struct swiftprox_shape_options *options,
                                                    struct swiftprox_shape **shape);

/**
 * Says what a level of detail is: `level` is from 0, the body itself, to swiftprox_shape_info.level_count, the coarsest. Set
 * info->struct_size to sizeof(swiftprox_level_info) first. On failure the deviation is NaN, all else 0.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level. SWIFTPROX_ERROR_NULL_POINTER: shape or info is null.
 * SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is none that is known.
 */
swiftprox_status swiftprox_shape_get_level_info(const struct swiftprox_shape *shape,
                                                size_t level,
                                                struct swiftprox_level_info *info);

/**
 * Copies the vertices of a level of detail, in the local frame: `level` is from 0, the body itself, to
 * swiftprox_shape_info.level_count; `capacity` is how many `vertices` has room for (3 coordinates each), at least
 * swiftprox_level_info.vertex_count. For bodies far from their own origin the coordinates are rounded by a unit in the last place.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such level, or capacity is too small; nothing is written.
 * SWIFTPROX_ERROR_NULL_POINTER: shape or vertices is null.
 */
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
 */
swiftprox_status swiftprox_shape_copy_level_triangles(const struct swiftprox_shape *shape,
                                                      size_t level,
                                                      uint32_t *corners,
                                                      size_t capacity);

/**
 * Fills `config` with the defaults, struct_size included.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: config is null.
 */
swiftprox_status swiftprox_pair_config_init(struct swiftprox_pair_config *config);

/**
 * The distance of two objects with a rigorous interval, witness points, normal and features. Of an intersecting pair the
 * distance is 0 and the proof is given; points, normal and features are not said (see swiftprox_pair_contact). Of a pair beyond
 * config->distance_tolerance only `lower` is said. What is not said is NaN, or SWIFTPROX_FEATURE_KIND_NONE.
 *
 * A pose is 12 doubles, the row-major 3x4 matrix [R|T]: the object is R*v + T, exactly as the doubles give it. `cache` is what
 * the pair remembers: all zero is cold, hand the same one back for the same pair in the same order, one for each pair.
 * `config` may be null for the defaults. On failure the answer is reset: its outcome is SWIFTPROX_OUTCOME_NONE.
 *
 * SWIFTPROX_ERROR_POSE: a pose is refused; the message says why. SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of config is out of
 * range; those that are for swiftprox_pair_approximate alone only there. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument. SWIFTPROX_ERROR_BUG: the cache is reset, too.
 */
swiftprox_status swiftprox_pair_distance(const struct swiftprox_shape *shape1,
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
 */
swiftprox_status swiftprox_pair_intersection(const struct swiftprox_shape *shape1,
                                             const double *pose1,
                                             const struct swiftprox_shape *shape2,
                                             const double *pose2,
                                             struct swiftprox_pair_cache *cache,
                                             const struct swiftprox_pair_config *config,
                                             struct swiftprox_pair_answer *answer);

/**
 * As swiftprox_pair_distance, and of an intersecting pair a common point (as witness point of both objects), a unit normal along
 * which the objects overlap little (where they only touch along a face it separates them) and features. It is no least depth, and
 * where the objects overlap it may depend on the cache. Features of objects that touch are those that hold the point; of objects
 * deeper in each other than a millionth of the smaller one's radius they are the faces that reach farthest: of object 1 against
 * the normal, of object 2 along it. Arguments and errors as of swiftprox_pair_distance.
 */
swiftprox_status swiftprox_pair_contact(const struct swiftprox_shape *shape1,
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
 * unless config->step_budget ran out: then the status is SWIFTPROX_PAIR_STATUS_BUDGET_SPENT, and the next call with the same cache
 * goes on from there, unless config->start says that it begin anew. Points and features are not said of an answer that comes
 * from levels of detail. Arguments and errors as of swiftprox_pair_distance.
 */
swiftprox_status swiftprox_pair_approximate(const struct swiftprox_shape *shape1,
                                            const double *pose1,
                                            const struct swiftprox_shape *shape2,
                                            const double *pose2,
                                            struct swiftprox_pair_cache *cache,
                                            const struct swiftprox_pair_config *config,
                                            struct swiftprox_pair_answer *answer);

/**
 * Re-checks an answer, trusting nothing of the search that found it. SWIFTPROX_OK: it holds for these shapes and poses.
 *
 * Verdict and interval are proved for the exact objects R*v + T, with no tolerance. Separated and beyond: the distance is not 0,
 * and it is in [lower, upper]; a lower of 0 is said only of a distance below all doubles, or beyond a tolerance. Intersecting: the
 * differences of the proof's vertex pairs hold the origin in their hull. Undecided: the distance is at most upper. `distance` is
 * in the interval.
 *
 * The other members are rounded, so they hold up to an allowance of 2^-47 (radius 1 + radius 2 + distance of the centres in the
 * world and of each from its local origin). The normal is of unit length; along it separated objects are at least lower apart.
 * The witness points are in their objects, and the same in both frames. Those of separated objects are on their features, at a
 * distance in [lower, upper]; those of a contact are one point. What an answer does not say is NaN. Status and statistics are
 * not checked, nor is more of a contact's normal than its length.
 *
 * Takes time linear in the number of vertices: double-double arithmetic proves most intervals, integers the others.
 *
 * SWIFTPROX_ERROR_UNVERIFIED: it does not hold; the message says what. SWIFTPROX_ERROR_INVALID_ARGUMENT: an enumerator in the
 * answer is unknown, it holds no outcome, a vertex of its proof is none, or a normal or points are said of objects so large or far
 * apart that doubles cannot tell. SWIFTPROX_ERROR_POSE, SWIFTPROX_ERROR_NULL_POINTER: as of swiftprox_pair_distance.
 */
swiftprox_status swiftprox_pair_verify(const struct swiftprox_shape *shape1,
                                       const double *pose1,
                                       const struct swiftprox_shape *shape2,
                                       const double *pose2,
                                       const struct swiftprox_pair_answer *answer);

/**
 * Fills `options` with the defaults, struct_size included.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: options is null.
 */
swiftprox_status swiftprox_scene_options_init(struct swiftprox_scene_options *options);

/**
 * Makes an empty scene; the caller gives it back with swiftprox_scene_destroy. On failure `*scene` is null. `options` may be null
 * for the defaults.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the rotation limit is out of range. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE:
 * the message names the argument.
 */
swiftprox_status swiftprox_scene_create(const struct swiftprox_scene_options *options,
                                        struct swiftprox_scene **scene);

/**
 * Ends a scene, a poisoned one too; its shares of shapes are given back, its ids and results end with it. Null is ignored.
 *
 * SWIFTPROX_ERROR_BUSY: another call uses the scene, which lives on. SWIFTPROX_ERROR_BUG: the scene is gone, but perhaps not all
 * of its memory.
 */
swiftprox_status swiftprox_scene_destroy(struct swiftprox_scene *scene);

/**
 * Activates the pair of two objects, in either order, with all its pairs of pieces. Two fixed objects are never tested all the
 * same.
 *
 * SWIFTPROX_ERROR_HANDLE: an id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: one object twice.
 * SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_activate_pair(struct swiftprox_scene *scene,
                                               swiftprox_object_id id1,
                                               swiftprox_object_id id2);

/** Deactivates the pair of two objects: queries leave it out. Errors as of swiftprox_scene_activate_pair. */
swiftprox_status swiftprox_scene_deactivate_pair(struct swiftprox_scene *scene,
                                                 swiftprox_object_id id1,
                                                 swiftprox_object_id id2);

/**
 * Activates all pairs that an object is in now.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_activate_object(struct swiftprox_scene *scene,
                                                 swiftprox_object_id id);

/** Deactivates all pairs that an object is in now. Errors as of swiftprox_scene_activate_object. */
swiftprox_status swiftprox_scene_deactivate_object(struct swiftprox_scene *scene, swiftprox_object_id id);

/**
 * Activates all pairs that there are now. Objects added later begin with all their pairs active in any case.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_activate_all(struct swiftprox_scene *scene);

/** Deactivates all pairs that there are now. Errors as of swiftprox_scene_activate_all. */
swiftprox_status swiftprox_scene_deactivate_all(struct swiftprox_scene *scene);

/**
 * Sets `*active` to 1 if queries test the pair of two objects, given in either order, else to 0 (also on failure).
 *
 * Errors as of swiftprox_scene_activate_pair; SWIFTPROX_ERROR_NULL_POINTER also when active is null.
 */
swiftprox_status swiftprox_scene_is_pair_active(const struct swiftprox_scene *scene,
                                                swiftprox_object_id id1,
                                                swiftprox_object_id id2,
                                                int32_t *active);

/**
 * Fills `options` with the defaults, struct_size included.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: options is null.
 */
swiftprox_status swiftprox_object_options_init(struct swiftprox_object_options *options);

/**
 * Adds an object of one or several convex pieces in one local frame. All its pairs are active. The scene takes a share of each
 * shape: the caller's own may be released at once. On failure nothing is added and `*id` is 0, which names no object.
 * `options` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: no pieces. SWIFTPROX_ERROR_POSE: the pose is refused. SWIFTPROX_ERROR_LIMIT: more objects or
 * pieces than a scene holds. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE: the message names
 * the argument. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_add_object(struct swiftprox_scene *scene,
                                            const struct swiftprox_shape *const *pieces,
                                            size_t piece_count,
                                            const struct swiftprox_object_options *options,
                                            swiftprox_object_id *id);

/**
 * Makes a shape as swiftprox_shape_create_from_mesh does and adds an object of that one piece as swiftprox_scene_add_object does,
 * with the arguments and the errors of both. Both options may be null for the defaults.
 */
swiftprox_status swiftprox_scene_add_mesh(struct swiftprox_scene *scene,
                                          const double *vertices,
                                          size_t vertex_count,
                                          const uint32_t *indices,
                                          const uint32_t *valences,
                                          size_t face_count,
                                          const struct swiftprox_shape_options *shape_options,
                                          const struct swiftprox_object_options *object_options,
                                          swiftprox_object_id *id);

/**
 * Makes a shape as swiftprox_shape_create_from_file does and adds an object of that one piece as swiftprox_scene_add_object does,
 * with the arguments and the errors of both. Both options may be null for the defaults.
 */
swiftprox_status swiftprox_scene_add_file(struct swiftprox_scene *scene,
                                          const char *path,
                                          const struct swiftprox_shape_options *shape_options,
                                          const struct swiftprox_object_options *object_options,
                                          swiftprox_object_id *id);

/**
 * Adds an object with the pieces (shared), the pose, the fixedness and the user data of `original`. All its pairs are active,
 * whatever those of its original are. On failure nothing is added and `*id` is 0.
 *
 * SWIFTPROX_ERROR_HANDLE: original names no object of this scene. SWIFTPROX_ERROR_LIMIT: more objects than a scene holds.
 * SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_NULL_POINTER: the message names the argument. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_copy_object(struct swiftprox_scene *scene,
                                             swiftprox_object_id original,
                                             swiftprox_object_id *id);

/**
 * Removes an object and its pairs. Its id is refused from now on; all other ids stay as they are.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_remove_object(struct swiftprox_scene *scene,
                                               swiftprox_object_id id);

/**
 * Sets the number that comes back in every result of this object.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_set_user_data(struct swiftprox_scene *scene,
                                               swiftprox_object_id id,
                                               uint64_t user_data);

/**
 * Says what an object is: set info->struct_size to sizeof(swiftprox_object_info) first. On failure the pose is NaN, all else 0.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_NULL_POINTER: scene or info is null.
 * SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is none that is known. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_get_object_info(const struct swiftprox_scene *scene,
                                                 swiftprox_object_id id,
                                                 struct swiftprox_object_info *info);

/**
 * Gives a piece of an object, by its number from 0. The scene owns the share: take one more with swiftprox_shape_retain to keep
 * the shape longer than the object. On failure `*shape` is null.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
 * SWIFTPROX_ERROR_NULL_POINTER: scene or shape is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_get_piece(const struct swiftprox_scene *scene,
                                           swiftprox_object_id id,
                                           size_t piece,
                                           const struct swiftprox_shape **shape);

/**
 * Moves an object, a fixed one too: `pose` is 12 doubles, row-major [R|T]. On failure it stays where it is.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of this scene. SWIFTPROX_ERROR_POSE: the pose is refused.
 * SWIFTPROX_ERROR_NULL_POINTER: scene or pose is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_set_pose(struct swiftprox_scene *scene,
                                          swiftprox_object_id id,
                                          const double *pose);

/** As swiftprox_scene_set_pose, from a row-major 3x3 `rotation` and a `translation`. */
swiftprox_status swiftprox_scene_set_transform(struct swiftprox_scene *scene,
                                               swiftprox_object_id id,
                                               const double *rotation,
                                               const double *translation);

/**
 * Moves all objects that are not fixed, in order of creation: `poses` holds 12 doubles for each of the `count`. On failure all
 * stay where they are.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: count is not the number of objects that are not fixed. SWIFTPROX_ERROR_POSE: a pose is
 * refused; the message names it. SWIFTPROX_ERROR_NULL_POINTER: scene or poses is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_set_all_poses(struct swiftprox_scene *scene,
                                               const double *poses,
                                               size_t count);

/**
 * As swiftprox_scene_set_all_poses, from 9 doubles of `rotations` and 3 of `translations` for each object; SWIFTPROX_ERROR_MEMORY,
 * too.
 */
swiftprox_status swiftprox_scene_set_all_transforms(struct swiftprox_scene *scene,
                                                    const double *rotations,
                                                    const double *translations,
                                                    size_t count);

/**
 * Fills `query` with the defaults, struct_size included.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: query is null.
 */
swiftprox_status swiftprox_scene_query_init(struct swiftprox_scene_query *query);

/**
 * Lists the intersecting pairs (touching ones are), each with its verdict alone: of an answer outcome, status, proof, statistics
 * and distance, lower and upper, which are 0, are said. `query` may be null for the defaults.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of query is out of range, also where this query does without it.
 * SWIFTPROX_ERROR_MEMORY: none for a changed list of pairs; the next query tries again. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument. SWIFTPROX_ERROR_POISONED. The answer is empty then. What a scene
 * has accepted it answers: no pair makes a query fail.
 */
swiftprox_status swiftprox_scene_query_intersection(struct swiftprox_scene *scene,
                                                    const struct swiftprox_scene_query *query,
                                                    struct swiftprox_scene_answer *answer);

/**
 * Lists the pairs whose distance is at most the distance tolerance, intersecting ones included. Its answers say what those of
 * swiftprox_scene_query_exact_distance do: of a separated pair distance, lower, upper, points in all frames, normal and features;
 * of an intersecting one the proof, and distance, lower and upper, which are 0. Errors as of swiftprox_scene_query_intersection.
 */
swiftprox_status swiftprox_scene_query_tolerance(struct swiftprox_scene *scene,
                                                 const struct swiftprox_scene_query *query,
                                                 struct swiftprox_scene_answer *answer);

/**
 * Lists the pairs whose distance is at most the distance tolerance, intersecting ones included, with what swiftprox_pair_distance
 * says of each. Errors as of swiftprox_scene_query_intersection.
 */
swiftprox_status swiftprox_scene_query_exact_distance(struct swiftprox_scene *scene,
                                                      const struct swiftprox_scene_query *query,
                                                      struct swiftprox_scene_answer *answer);

/**
 * As swiftprox_scene_query_exact_distance, each distance as narrow as query->absolute_error, relative_error or error_budget ask
 * for and no narrower, with what swiftprox_pair_approximate says of each pair. A pair whose step budget ran out before the verdict
 * (SWIFTPROX_OUTCOME_UNDECIDED) is listed and does not count as intersecting. Errors as of swiftprox_scene_query_intersection.
 */
swiftprox_status swiftprox_scene_query_approximate_distance(struct swiftprox_scene *scene,
                                                            const struct swiftprox_scene_query *query,
                                                            struct swiftprox_scene_answer *answer);

/**
 * As swiftprox_scene_query_exact_distance, with what swiftprox_pair_contact says of each pair. Errors as of
 * swiftprox_scene_query_intersection.
 */
swiftprox_status swiftprox_scene_query_contacts(struct swiftprox_scene *scene,
                                                const struct swiftprox_scene_query *query,
                                                struct swiftprox_scene_answer *answer);

/**
 * What the queries of a scene did since it was made or swiftprox_scene_reset_statistics was called. On failure error_spent is NaN,
 * all else 0.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene or statistics is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_get_statistics(const struct swiftprox_scene *scene,
                                                struct swiftprox_scene_statistics *statistics);

/**
 * Sets the statistics of a scene to zero.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
 */
swiftprox_status swiftprox_scene_reset_statistics(struct swiftprox_scene *scene);

#ifdef __cplusplus
}
#endif

#endif
