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
 * Receives each failure when it happens, in the thread where it happens. It gets the status, the message (valid during the call)
 * and the pointer given to swiftprox_library_set_log. It must return; a C++ exception that leaves it ends the program.
 */
typedef void (*swiftprox_log_callback)(swiftprox_status status, const char *message, void *user);

/**
 * Sets the log of the process. It receives the message of every call that does not return SWIFTPROX_OK. Null (the default) means
 * none. The callback may run in several threads at once. Calls already under way may still use the old one for a moment.
 *
 * Stable.
 */
void swiftprox_library_set_log(swiftprox_log_callback callback,
                               void *user);

/**
 * Allocates `size` bytes at an address that is a multiple of `alignment`. `size` is not 0 and a multiple of it, too. The alignment
 * is a power of two, at least that of a pointer, and may exceed malloc's (64, for example). `user` is the pointer given to
 * swiftprox_library_set_allocator.
 *
 * Return null if there is no memory. Calls then end in SWIFTPROX_ERROR_MEMORY where memory grows with the input or a scene, or is
 * for integers. For other, small blocks the program ends with a message (see the head of this file).
 */
typedef void *(*swiftprox_allocate_callback)(void *user, size_t size, size_t alignment);

/**
 * Frees memory that the swiftprox_allocate_callback set with it returned for the same size and alignment. `user` is the pointer
 * given with both.
 */
typedef void (*swiftprox_deallocate_callback)(void *user, void *memory, size_t size, size_t alignment);

/**
 * Sets the functions that allocate all memory of the library, for the whole process. Null for both (the default) means the
 * system's malloc. You may call this at any time: memory goes back to the functions it came from. So functions once set, and
 * `user`, must stay valid until the process ends. They are called at the end of threads and after main, too.
 *
 * Several threads may call the functions at once. They must return and must not call the library; a C++ exception that leaves them
 * ends the program.
 *
 * On failure nothing has changed. SWIFTPROX_ERROR_INVALID_ARGUMENT: only one function is null. SWIFTPROX_ERROR_UNSUPPORTED: the
 * library was built neither by CMake nor with Cargo's feature `allocator`; a Rust program's own allocator is used.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_library_set_allocator(swiftprox_allocate_callback allocate,
                                                 swiftprox_deallocate_callback deallocate,
                                                 void *user);

/** Receives the mesh that a swiftprox_mesh_reader_callback reads. It is valid only during the callback, in its thread. */
typedef struct swiftprox_mesh_sink swiftprox_mesh_sink;

/**
 * Reads a mesh file. It calls swiftprox_mesh_sink_add_vertices and swiftprox_mesh_sink_add_faces any number of times and
 * returns 0. To refuse the file, it calls swiftprox_mesh_sink_fail or returns another number. A failed call to the sink refuses
 * the file, too, even if the callback ignores it.
 *
 * `user` is the pointer given with the callback. `data` holds the `size` bytes of the file, without a UTF-8 byte order mark. It
 * starts with any white space and the magic, which the callback must skip. A zero byte follows, where strtod stops. (strtod uses
 * the decimal point of the program's locale, LC_NUMERIC; the built-in readers use a point in every locale.)
 *
 * Data and sink are valid until the callback returns; the sink copies what it is given. The callback may call the library, to read
 * files or to register readers. It must return; a C++ exception that leaves it ends the program.
 */
typedef int32_t (*swiftprox_mesh_reader_callback)(void *user,
                                                  const char *data,
                                                  size_t size,
                                                  struct swiftprox_mesh_sink *sink);

/**
 * Registers a reader of mesh files, for the process. swiftprox_shape_create_from_file calls it for each file that begins with
 * `magic`, whatever its extension. White space and a UTF-8 byte order mark before the magic are skipped. "PLY" also matches
 * PLYMOUTH. Registered readers precede the built-in ones: "OFF" replaces one.
 *
 * Any thread, and any callback, may call this at any time. A reader replaces one with the same magic; a null callback removes
 * it. Several threads may call the callback at once. `user` must stay valid until the reader is replaced or removed, and no
 * thread still reads a file with it.
 *
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: magic is empty, or begins with white space, a byte order mark or another reader's magic,
 * or that one begins with it.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_library_register_mesh_reader(const char *magic,
                                                        swiftprox_mesh_reader_callback callback,
                                                        void *user);

/**
 * Adds `vertex_count` vertices, 3 coordinates each, to the mesh. They are numbered from 0 in order of addition. The array is
 * copied.
 *
 * On failure nothing is added, and the file is refused. SWIFTPROX_ERROR_MESH: a coordinate is not finite; the message names the
 * vertex. SWIFTPROX_ERROR_LIMIT: too many vertices. After SWIFTPROX_ERROR_MEMORY reading the file fails with the same status.
 *
 * Stable.
 */
swiftprox_status swiftprox_mesh_sink_add_vertices(struct swiftprox_mesh_sink *sink,
                                                  const double *vertices,
                                                  size_t vertex_count);

/**
 * Adds `face_count` faces to the mesh, numbered from 0 in order of addition. `indices` holds their vertex numbers, face after
 * face, counter-clockwise from outside. `valences` holds the number of vertices per face; null means triangles. Faces may name
 * vertices that are added later; this is checked when the callback returns. The arrays are copied.
 *
 * On failure nothing is added, and the file is refused. SWIFTPROX_ERROR_LIMIT: too many faces or indices. SWIFTPROX_ERROR_MEMORY:
 * as for swiftprox_mesh_sink_add_vertices.
 *
 * Stable.
 */
swiftprox_status swiftprox_mesh_sink_add_faces(struct swiftprox_mesh_sink *sink,
                                               const uint32_t *indices,
                                               const uint32_t *valences,
                                               size_t face_count);

/**
 * Marks the coordinates as single precision, like those of STL files. A vertex may then lie outside a face by 1e-6 of the
 * bounding-box diagonal, not 1e-9. A swiftprox_shape_options.convexity_tolerance overrides this.
 *
 * Stable.
 */
swiftprox_status swiftprox_mesh_sink_set_single_precision(struct swiftprox_mesh_sink *sink);

/**
 * Refuses the file, whatever the callback returns. `message` says what is wrong, best with the line; up to 4,096 bytes are copied.
 * The library adds the names of file and reader. The first message is kept. It replaces that of a failed call to the sink, except
 * for SWIFTPROX_ERROR_MEMORY.
 *
 * SWIFTPROX_ERROR_NULL_POINTER: sink or message is null. A null message still refuses the file.
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
 * Returns the text for an outcome of a pair query. Never null, valid forever, also for unknown numbers.
 *
 * Stable.
 */
const char *swiftprox_library_outcome_string(swiftprox_outcome outcome);

/**
 * Returns the text for the method that decided a pair query. Never null, valid forever, also for unknown numbers.
 *
 * Stable.
 */
const char *swiftprox_library_decided_by_string(swiftprox_decided_by decided_by);

/**
 * Returns the text for a feature kind: "none", "vertex", "edge" or "face". Never null, valid forever, also for unknown numbers.
 *
 * Stable.
 */
const char *swiftprox_library_feature_kind_string(swiftprox_feature_kind kind);

/**
 * Returns the text for a depth ending. Never null, valid forever, also for unknown numbers.
 *
 * Stable.
 */
const char *swiftprox_library_depth_ending_string(swiftprox_depth_ending ending);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
