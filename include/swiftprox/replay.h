/*
 * swiftprox. Recordings: what is done to a scene, written down and done again. The conventions are those of swiftprox.h.
 */

/* Generated from the Rust source by `BLESS=1 cargo test --test header`; do not edit. */

#ifndef SWIFTPROX_REPLAY_H
#define SWIFTPROX_REPLAY_H

#include "../swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * @defgroup swiftprox_record What is done to a scene, written down and done again
 * @{
 */

/**
 * Writes down what is done to a scene from now on, in a file, replacing what was there: a bug report and a benchmark in one. First
 * comes what the scene holds. `path` null: ends the recording, if there is one, as swiftprox_scene_destroy does. A recording that
 * is going on ends before another one begins. swiftprox-replay plays recordings back, and swiftprox_replay_open does.
 *
 * All that changes what queries answer is written down, and each query with a digest of its answer; workers and statistics are
 * not. Of the callback of swiftprox_scene_set_pair_filter the decisions are. Each shape is written down once. The file is brought
 * up to date before each query: one that ends the program is its last record. Record from the scene's beginning, before its first
 * object, for a replay that answers with the same bits; later on what pairs remember is not written down.
 *
 * Where the file cannot be written any more the recording ends, and the scene goes on. The log is told, and so is the call that
 * ends the recording.
 *
 * SWIFTPROX_ERROR_FILE: the file cannot be written, or is no regular file; or the recording before could not be written to its
 * end, and then no other is begun. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_INVALID_ARGUMENT: it is no path.
 * SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED. The scene is not recorded then.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_record(struct swiftprox_scene *scene,
                                        const char *path);

/**
 * Plays back what swiftprox_scene_record has written. Make one with swiftprox_replay_open.
 *
 * A step is what was done up to a query, and the query. For each step call swiftprox_replay_read, which reads it,
 * swiftprox_replay_change, which does what was done in it, and swiftprox_replay_ask, which makes its query; or make queries of
 * your own of the scene instead. A file of any content is safe: it is an error, or does to the scene what a program could.
 */
typedef struct swiftprox_replay swiftprox_replay;

/** A step of a recording. Set struct_size to sizeof(swiftprox_replay_step_info) before asking for it. */
typedef struct swiftprox_replay_step_info {
  /** Set by the caller. */
  size_t struct_size;
  /** 1 if there is a step, 0 at the end of the recording. */
  int32_t has_step;
  /** 1 if the step ends in a query, else 0: at the end of the recording, and of a query that was refused. */
  int32_t has_query;
  /** The kind of the query. */
  swiftprox_query_kind kind;
  /** 1 at the end of a recording that was not ended, as when the program was, else 0. */
  int32_t cut_off;
  /** How much of the file is read, from 0 to 1. */
  double fraction;
} swiftprox_replay_step_info;

/**
 * Opens a recording and makes a scene to play it back in, with the workers of `options`, which may be null for the defaults, and
 * the rotation limit of the recorded scene. The caller gives both back with swiftprox_replay_close. On failure `*replay` is null.
 *
 * SWIFTPROX_ERROR_FILE: the file cannot be read, is no regular file, no recording, of another version, or damaged at its
 * beginning. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_INVALID_ARGUMENT: it is no path, or of enqueue_task and finish_task one is
 * null and the other is not. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_open(const char *path,
                                       const struct swiftprox_scene_options *options,
                                       struct swiftprox_replay **replay);

/**
 * Ends a replay and its scene, which the caller owns. Null is ignored.
 *
 * SWIFTPROX_ERROR_BUSY: another call uses the scene, and both live on. Other errors as of swiftprox_scene_destroy.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_close(struct swiftprox_replay *replay);

/**
 * Gives the scene of a replay, which owns it: ask it what you like between the steps, change nothing, and do not destroy it. Null
 * for null.
 *
 * Stable.
 */
struct swiftprox_scene *swiftprox_replay_scene(struct swiftprox_replay *replay);

/**
 * Reads the next step. Set step->struct_size first. A recording that is cut off ends with its last whole record. On failure
 * `*step` says that there is no step.
 *
 * SWIFTPROX_ERROR_FILE: the recording is damaged here, the message says where; the steps before are good.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: the step before has not been done. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER,
 * SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_read(struct swiftprox_replay *replay,
                                       struct swiftprox_replay_step_info *step);

/**
 * Does what was done in the step that was read, without its query.
 *
 * SWIFTPROX_ERROR_FILE: the scene refuses it, as the program has changed it or the recording is damaged; it cannot be gone on
 * with. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: replay is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_change(struct swiftprox_replay *replay);

/**
 * Makes the query of the step that was read and done, and holds its answer against the recorded one: the same pairs are to be
 * listed with the same outcomes, and the sums of their lower and of their upper ends are to be those of intervals that have a
 * number in common. That holds on every machine, except with a step budget: such answers are not checked. The answer is
 * as of the query itself; of a query about events it lists the pairs of pieces that are near. `*identical` is 1 if its distances,
 * intervals, points, normals and depths are bit for bit the recorded ones, else 0; `identical` may be null.
 *
 * With another `distance_tolerance` than SWIFTPROX_DEFAULT_TOLERANCE that is taken in place of the recorded one, and the answer is
 * not checked.
 *
 * SWIFTPROX_ERROR_UNVERIFIED: it is not the recorded answer; the message says what of it is not. The answer is there all the same;
 * on other failures it is empty. SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such query, or the step has not been done; or the
 * query is out of range, as the last of a recording that is cut off may be. SWIFTPROX_ERROR_FILE: the recording is damaged, its
 * query is about an object or a shape that it has not told of. SWIFTPROX_ERROR_HANDLE: the query is about an object that has been
 * removed. SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: replay or answer is null. SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_ask(struct swiftprox_replay *replay,
                                      double distance_tolerance,
                                      struct swiftprox_scene_answer *answer,
                                      int32_t *identical);

/**
 * Writes the number of an object of the replay's scene: how many there were before it in the recording. On failure it is 0.
 *
 * SWIFTPROX_ERROR_HANDLE: id names no object of the scene. SWIFTPROX_ERROR_NULL_POINTER: replay or number is null.
 * SWIFTPROX_ERROR_POISONED.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_get_number(const struct swiftprox_replay *replay,
                                             struct swiftprox_object_id id,
                                             uint32_t *number);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
