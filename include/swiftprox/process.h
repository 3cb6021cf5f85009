/*
 * swiftprox. The process: its log, its memory, its readers of mesh files, and answers in words. The conventions are those of
 * swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_PROCESS_H
#define SWIFTPROX_PROCESS_H

#include "../swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_process The log, the memory and the mesh readers of a process
 * @{
 */

/**
 * Receives every failure as it happens, from the thread where it happens: its status, its message (valid during the call)
 * and the pointer given to swiftprox_library_set_log. It must return; a C++ exception that leaves it ends the program.
 */
typedef void (*swiftprox_log_callback)(swiftprox_status status, const char *message, void *user);

/**
 * Sets the process-wide log, which receives what the library would say if it printed: the message of every call that does
 * not return SWIFTPROX_OK. Null (the default) for none. The callback may be called from every thread that uses the library,
 * from several at once; calls already under way in other threads may still reach the old one for a moment.
 *
 * Stable.
 */
void swiftprox_library_set_log(swiftprox_log_callback callback,
                               void *user);

/**
 * Gives memory of `size` bytes, not 0 and a multiple of `alignment`, at an address that is one, too. The alignment is a power of
 * two, at least a pointer's and sometimes more than malloc keeps (64, for one). Null if there is no memory, as where the system's
 * runs out: for what grows with the caller's input or a scene, and for integers, the call then ends in SWIFTPROX_ERROR_MEMORY; for
 * what else is small the program ends with a message (the head of this file says what that is). `user` is the pointer given to
 * swiftprox_library_set_allocator.
 */
typedef void *(*swiftprox_allocate_callback)(void *user, size_t size, size_t alignment);

/**
 * Takes back memory that the swiftprox_allocate_callback set with it gave for the same size and alignment. `user` is the pointer
 * given with both.
 */
typedef void (*swiftprox_deallocate_callback)(void *user, void *memory, size_t size, size_t alignment);

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
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_library_set_allocator(swiftprox_allocate_callback allocate,
                                                 swiftprox_deallocate_callback deallocate,
                                                 void *user);

/**
 * Receives the mesh that a swiftprox_mesh_reader_callback reads: vertices, faces, or why it has none. It is good during the call
 * of the callback, for its thread.
 */
typedef struct swiftprox_mesh_sink swiftprox_mesh_sink;

/**
 * Reads a mesh file: calls swiftprox_mesh_sink_add_vertices and swiftprox_mesh_sink_add_faces as often as it likes and returns 0;
 * or says what is wrong with the file by swiftprox_mesh_sink_fail. Anything but 0 refuses the file, too, and so does every call to
 * the sink that was refused, whether or not the callback has looked at its status.
 *
 * `user` is the pointer given with the callback. `data` holds the `size` bytes of the whole file without a UTF-8 byte order mark:
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
 * Registers a reader of mesh files, which swiftprox_shape_create_from_file calls for every file that
 * begins with the bytes of `magic`, a string that is copied, behind white space and a UTF-8 byte order mark: whatever the
 * extension of the file is, and before the built-in readers for TRI, POLY, OFF, OBJ and STL, which a magic such as "OFF" replaces.
 * The first bytes alone count: "PLY" is the magic of a file that begins with PLYMOUTH, too. The callback is handed what was
 * skipped and the magic with the rest of the file, all but the byte order mark.
 *
 * The registry is the process's own; it may be changed at any time from any thread, from a callback as well. A reader registered
 * under a magic that has one replaces it, a null callback takes it back (and may do nothing). The callback may be
 * called from every thread that reads files, from several at once. `user` must be good until the reader is replaced or taken back
 * and no other thread is still reading a file by it.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: magic is empty or begins with white space or a byte order mark, which are skipped in files; or
 * it begins with the magic of another reader, or that one with it: a file could be for both. SWIFTPROX_ERROR_MEMORY.
 * SWIFTPROX_ERROR_NULL_POINTER: magic is null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
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
 *
 * Stable.
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
 *
 * Stable.
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
 *
 * Stable.
 */
swiftprox_status swiftprox_mesh_sink_set_single_precision(struct swiftprox_mesh_sink *sink);

/**
 * Refuses the file that a callback reads, whatever the callback returns. `message`, a string of which up to 4,096 bytes are
 * copied, says what is wrong, best with the line; the library adds which file and which reader. The first message holds, also
 * where a call to the sink was refused before, unless that was for memory.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: sink or message is null; the file is refused all the same if sink is not.
 *
 * Stable.
 */
swiftprox_status swiftprox_mesh_sink_fail(struct swiftprox_mesh_sink *sink,
                                          const char *message);

/** @} */

/**
 * @defgroup swiftprox_words Answers in words
 * @{
 */

/**
 * An outcome of a pair query in words. Never null, valid for ever; a number that is no outcome gets a string
 * that says so.
 *
 * Stable.
 */
const char *swiftprox_library_outcome_string(swiftprox_outcome outcome);

/**
 * What decided a pair query, in words. Never null, valid for ever; an unknown number gets a string that says so.
 *
 * Stable.
 */
const char *swiftprox_library_decided_by_string(swiftprox_decided_by decided_by);

/**
 * A kind of features in a word: "none", "vertex", "edge" or "face". Never null, valid for ever; a
 * number that is no kind gets a string that says so.
 *
 * Stable.
 */
const char *swiftprox_library_feature_kind_string(swiftprox_feature_kind kind);

/**
 * How a depth query ended, in words. Never null, valid for ever; an unknown number gets a string that says so.
 *
 * Stable.
 */
const char *swiftprox_library_depth_ending_string(swiftprox_depth_ending ending);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
