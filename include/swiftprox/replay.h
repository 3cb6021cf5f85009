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
 * Records a scene in a file from now on, for bug reports and benchmarks. Its present content comes first. An existing file is
 * replaced, and a running recording ends. Null `path` only ends it, as swiftprox_scene_destroy does. swiftprox-replay and
 * swiftprox_replay_open play recordings back.
 *
 * The file has every change that affects answers, and each query with a digest of its answer. A pair filter is recorded by its
 * decisions. The file is updated before each query, so a query that crashes is its last record. For a replay with the same
 * bits, record before the first object is added: pair caches are not recorded.
 *
 * If writing fails, the recording ends and the scene goes on. The log and the call that ends the recording report it.
 *
 * SWIFTPROX_ERROR_FILE: the file is not writable or not regular; or the former recording could not be completed, and no new
 * one begins. SWIFTPROX_ERROR_INVALID_ARGUMENT: it is no path.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_record(struct swiftprox_scene *scene,
                                        const char *path);

/**
 * Plays back a recording of swiftprox_scene_record. Create one with swiftprox_replay_open.
 *
 * A step is a query and all changes before it. For each step call swiftprox_replay_read, swiftprox_replay_change and
 * swiftprox_replay_ask. You may replace the last by your own queries of the scene. Files of any content are safe: they cause an
 * error, or change the scene as a program could.
 */
typedef struct swiftprox_replay swiftprox_replay;

/** A step of a recording. Set struct_size to sizeof(swiftprox_replay_step_info) before the call. */
typedef struct swiftprox_replay_step_info {
  /** Set by the caller. */
  size_t struct_size;
  /** 1 if there is a step, 0 at the end of the recording. */
  int32_t has_step;
  /** 1 if the step ends in a query. 0 at the end of the recording, and for a query that was refused. */
  int32_t has_query;
  /** The kind of the query. */
  swiftprox_query_kind kind;
  /** 1 at the end of an unfinished recording, such as that of a program that crashed, else 0. */
  int32_t cut_off;
  /** Part of the file read so far, from 0 to 1. */
  double fraction;
} swiftprox_replay_step_info;

/**
 * Opens a recording and creates a scene for it, with the workers of `options`. Null `options` mean
 * the defaults. The caller frees both with swiftprox_replay_close. On failure `*replay` is null.
 *
 * SWIFTPROX_ERROR_FILE: the file is unreadable, not regular, not a recording, of another version, or damaged at its beginning.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: it is no path, or only one of enqueue_task and finish_task is null.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_open(const char *path,
                                       const struct swiftprox_scene_options *options,
                                       struct swiftprox_replay **replay);

/**
 * Ends a replay and destroys its scene. Null is ignored.
 *
 * SWIFTPROX_ERROR_BUSY: another call uses the scene; both stay alive. Else same errors as swiftprox_scene_destroy.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_close(struct swiftprox_replay *replay);

/**
 * Returns the scene of a replay, which the replay owns. You may query it between the steps, but must not change or destroy it. For
 * null it returns null.
 *
 * Stable.
 */
struct swiftprox_scene *swiftprox_replay_scene(struct swiftprox_replay *replay);

/**
 * Reads the next step. Set step->struct_size first. An unfinished recording ends with its last whole record. On failure `*step`
 * has no step.
 *
 * SWIFTPROX_ERROR_FILE: the recording is damaged here; the message says where. Earlier steps are good.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: swiftprox_replay_change was not called for the step before.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_read(struct swiftprox_replay *replay,
                                       struct swiftprox_replay_step_info *step);

/**
 * Applies the changes of the step that was read, without its query.
 *
 * SWIFTPROX_ERROR_FILE: the scene refuses a change, because the program changed the scene or the recording is damaged. The replay
 * cannot go on.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_change(struct swiftprox_replay *replay);

/**
 * Runs the query of the step that was read and applied, and checks its answer against the recording. Pairs and outcomes must be
 * equal. The sums of lower ends and of upper ends must form intervals that overlap. This is guaranteed on every machine, except
 * for queries with a step budget, which are not checked.
 *
 * The answer is as from the query itself; queries of events list near pairs of pieces. `*identical` is 1 if distances, intervals,
 * points, normals and depths have the recorded bits, else 0; `identical` may be null. A `max_distance` other than
 * SWIFTPROX_DEFAULT_MAX_DISTANCE replaces the recorded one, and the answer is not checked.
 *
 * SWIFTPROX_ERROR_UNVERIFIED: the answer differs; the message says where. It is still returned; after other errors it is empty.
 * SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no query, the step was not applied, or the query is out of range. The last query of
 * an unfinished recording may be. SWIFTPROX_ERROR_FILE: the query names an unknown object or shape. SWIFTPROX_ERROR_HANDLE: it
 * names a removed object.
 *
 * Stable.
 */
SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_ask(struct swiftprox_replay *replay,
                                      double max_distance,
                                      struct swiftprox_scene_answer *answer,
                                      int32_t *identical);

/**
 * Writes the number of an object of the replay's scene: how many objects the recording has before it. On failure it is 0.
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
