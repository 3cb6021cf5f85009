/* A scene that is played step by step, from text or from what swiftprox_scene_record has written. */
#ifndef SWIFTPROX_TOOLS_PLAYER_H
#define SWIFTPROX_TOOLS_PLAYER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <swiftprox.h>
#include <swiftprox/replay.h>
#include <swiftprox/tuning.h>

#include "scene_file.h"

typedef swiftprox_status scene_query(swiftprox_scene *, const swiftprox_scene_query *, swiftprox_scene_answer *);

/* What is to be played, and how. */
struct player_options {
    const char *path;
    scene_query *query; /* null: what the recording asks, of text distances */
    double max_distance;   /* SWIFTPROX_DEFAULT_MAX_DISTANCE: the query's own */
    double error;       /* of each answer or depth */
    double budget;      /* of all answers to a query together */
    swiftprox_input input;
    uint32_t workers;
    const swiftprox_pair_tuning *tuning;        /* null: the automatic choice */
    const swiftprox_shape_tuning *shape_tuning; /* of text alone; null: the automatic choice */
    bool verify; /* an answer that is not the recorded one is a failure */
};

struct player {
    const struct player_options *options;
    bool is_recording;
    swiftprox_scene *scene;
    size_t step;     /* steps with a query that were read in this pass */
    double fraction; /* of the pass that is read */
    bool cut_off;    /* the recording ended with the program that was recorded */
    swiftprox_scene_query query;

    struct scene_file file; /* of text */
    const swiftprox_shape **shapes;
    swiftprox_object_id *ids;

    swiftprox_replay *replay; /* of a recording */
    swiftprox_replay_step_info info;
};

/* What stands between two steps. */
enum next_step { STEP, NO_QUERY, NO_MORE, BAD_STEP };

/* Whether a file begins as recordings do. */
bool player_finds_recording(const char *path);

/* Reads the file, or of a recording its beginning. On failure it prints a message and returns another status than GOOD; call
 * player_free in either case. */
int player_open(struct player *player, const struct player_options *options);

void player_free(struct player *player);

/* A pass begins with a scene of its own and ends with that. They return a status, too. */
int player_begin(struct player *player);
int player_end(struct player *player);

/* Reads the next step, which player_play does; of a step without a query what was done in it is done here. A message is printed of
 * BAD_STEP. */
enum next_step player_next(struct player *player);

/* Does what is done in the step, and makes its query, or the one that the options name. The answer is that of the recording, or a
 * message is printed and the status is another than GOOD. */
int player_play(struct player *player, swiftprox_scene_answer *answer);

/* The number of an object, from 0 in the order in which objects came. False where there is no such object, as of a shape that was
 * in no scene. */
bool player_find_number(const struct player *player, swiftprox_object_id id, uint32_t *number);

/* What the step that is played asks. */
swiftprox_query_kind player_query_kind(const struct player *player);

/* Prints the last message of the library; FAILED. */
int player_failed(void);

#endif
