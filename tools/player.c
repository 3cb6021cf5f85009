#include "player.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "program.h"
#include "progress.h"
#include "text.h"

int player_failed(void)
{
    fprintf(stderr, "%s: ", program_name());
    program_print_library_message();
    return FAILED;
}

static int status_of(swiftprox_status status)
{
    return status == SWIFTPROX_ERROR_FILE || status == SWIFTPROX_ERROR_MESH || status == SWIFTPROX_ERROR_POSE ? BAD_INPUT : FAILED;
}

/* A call about a line of text that failed. */
static int failed_in_line(const struct player *player, size_t line, swiftprox_status status)
{
    fflush(stdout);
    fprintf(stderr, "%s:%zu: ", player->options->path, line);
    program_print_library_message();
    return status_of(status);
}

/* A call about a step of a recording, numbered from 0, that failed. */
static int failed_in_step(const struct player *player, size_t step, swiftprox_status status)
{
    fflush(stdout);
    const bool is_named = strstr(swiftprox_library_last_error_message(), player->options->path) != NULL;
    fprintf(stderr, "%s%sstep %zu: ", is_named ? "" : player->options->path, is_named ? "" : ": ", step);
    program_print_library_message();
    return status_of(status);
}

/* ---- the file ---- */

bool player_finds_recording(const char *path)
{
    static const char HEAD[8] = {'S', 'W', 'F', 'T', 'R', 'E', 'C', '\x1a'};
    char head[sizeof HEAD] = {0};
    /* What is read from a pipe would be missing later. */
    FILE *const file = text_is_regular(path) ? fopen(path, "rb") : NULL;
    if (!file) {
        return false;
    }
    const size_t count = fread(head, 1, sizeof head, file);
    fclose(file);
    return count == sizeof head && memcmp(head, HEAD, sizeof head) == 0;
}

static int load_shapes(struct player *player)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    options.input = player->options->input;
    options.tuning = player->options->shape_tuning;
    struct progress progress = progress_start();
    int result = GOOD;
    for (size_t i = 0; i < player->file.shape_count && result == GOOD; i++) {
        const struct scene_shape *const shape = &player->file.shapes[i];
        const swiftprox_status status = swiftprox_shape_create_from_file(shape->path, &options, &player->shapes[i]);
        if (status != SWIFTPROX_OK) {
            progress_erase(&progress);
            result = failed_in_line(player, shape->line, status);
        }
        progress_look(&progress, i + 1, player->file.shape_count);
    }
    progress_erase(&progress);
    return result;
}

int player_open(struct player *player, const struct player_options *options)
{
    *player = (struct player){.options = options, .is_recording = player_finds_recording(options->path)};
    player->query = (swiftprox_scene_query)SWIFTPROX_SCENE_QUERY_DEFAULT;
    player->query.max_distance = options->max_distance;
    player->query.absolute_error = options->error;
    player->query.error_budget = options->budget;
    player->query.tuning = options->tuning;
    if (player->is_recording) {
        return GOOD;
    }
    if (!scene_file_read(options->path, &player->file)) {
        return BAD_INPUT;
    }
    player->shapes = calloc(player->file.shape_count + 1, sizeof *player->shapes);
    player->ids = calloc(player->file.object_count + 1, sizeof *player->ids);
    if (!player->shapes || !player->ids) {
        fprintf(stderr, "%s: no memory for so many objects\n", program_name());
        return FAILED;
    }
    return load_shapes(player);
}

void player_free(struct player *player)
{
    for (size_t i = 0; player->shapes && i < player->file.shape_count; i++) {
        swiftprox_shape_release(player->shapes[i]);
    }
    free(player->shapes);
    free(player->ids);
    scene_file_free(&player->file);
}

/* ---- a pass ---- */

/* The objects of text before their first step. */
static int set_up(struct player *player)
{
    for (size_t i = 0; i < player->file.object_count; i++) {
        const struct scene_object *const object = &player->file.objects[i];
        swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        options.user_data = i;
        options.fixed = object->fixed;
        if (swiftprox_scene_add_object(player->scene, &player->shapes[object->shape], 1, &options, &player->ids[i]) !=
            SWIFTPROX_OK) {
            return player_failed();
        }
    }
    return GOOD;
}

int player_begin(struct player *player)
{
    swiftprox_scene_options options = SWIFTPROX_SCENE_OPTIONS_DEFAULT;
    options.worker_count = player->options->workers;
    player->step = 0;
    player->fraction = 0;
    if (!player->is_recording) {
        return swiftprox_scene_create(&options, &player->scene) == SWIFTPROX_OK ? set_up(player) : player_failed();
    }
    const swiftprox_status status = swiftprox_replay_open(player->options->path, &options, &player->replay);
    player->scene = swiftprox_replay_scene(player->replay);
    if (status != SWIFTPROX_OK) {
        player_failed();
        return status == SWIFTPROX_ERROR_FILE ? BAD_INPUT : FAILED;
    }
    return GOOD;
}

int player_end(struct player *player)
{
    const swiftprox_status status =
        player->is_recording ? swiftprox_replay_close(player->replay) : swiftprox_scene_destroy(player->scene);
    player->scene = NULL;
    player->replay = NULL;
    return status == SWIFTPROX_OK ? GOOD : player_failed();
}

/* ---- steps ---- */

static enum next_step next_of_text(struct player *player)
{
    if (player->step == player->file.step_count) {
        return NO_MORE;
    }
    player->step++;
    player->fraction = (double)player->step / (double)player->file.step_count;
    return STEP;
}

static enum next_step next_of_recording(struct player *player)
{
    player->info.struct_size = sizeof player->info;
    const swiftprox_status status = swiftprox_replay_read(player->replay, &player->info);
    if (status != SWIFTPROX_OK) {
        failed_in_step(player, player->step, status);
        return BAD_STEP;
    }
    player->fraction = player->info.fraction;
    player->cut_off = player->info.cut_off;
    if (!player->info.has_step) {
        return NO_MORE;
    }
    if (player->info.has_query) {
        player->step++;
        return STEP;
    }
    const swiftprox_status changed = swiftprox_replay_change(player->replay);
    if (changed != SWIFTPROX_OK) {
        failed_in_step(player, player->step, changed);
        return BAD_STEP;
    }
    return NO_QUERY;
}

enum next_step player_next(struct player *player)
{
    return player->is_recording ? next_of_recording(player) : next_of_text(player);
}

static int play_text(struct player *player, swiftprox_scene_answer *answer)
{
    const size_t end = scene_file_moves_end(&player->file, player->step - 1);
    for (size_t m = player->file.steps[player->step - 1].first_move; m < end; m++) {
        const struct scene_move *const move = &player->file.moves[m];
        const swiftprox_status status = swiftprox_scene_set_pose(player->scene, player->ids[move->object], move->pose);
        if (status != SWIFTPROX_OK) {
            return failed_in_line(player, move->line, status);
        }
    }
    scene_query *const query = player->options->query ? player->options->query : swiftprox_scene_query_distance;
    return query(player->scene, &player->query, answer) == SWIFTPROX_OK ? GOOD : player_failed();
}

static int play_recording(struct player *player, swiftprox_scene_answer *answer)
{
    const struct player_options *const options = player->options;
    swiftprox_status status = swiftprox_replay_change(player->replay);
    if (status == SWIFTPROX_OK && !options->query) {
        status = swiftprox_replay_ask(player->replay, options->max_distance, answer, NULL);
        if (status == SWIFTPROX_ERROR_UNVERIFIED && !options->verify) {
            status = SWIFTPROX_OK;
        }
    } else if (status == SWIFTPROX_OK) {
        status = options->query(player->scene, &player->query, answer);
    }
    return status == SWIFTPROX_OK ? GOOD : failed_in_step(player, player->step - 1, status);
}

int player_play(struct player *player, swiftprox_scene_answer *answer)
{
    const bool finds_contacts = player_query_kind(player) == SWIFTPROX_QUERY_KIND_CONTACT;
    player->query.detail = finds_contacts ? SWIFTPROX_CONTACT_DETAIL_MANIFOLD : SWIFTPROX_CONTACT_DETAIL_NONE;
    return player->is_recording ? play_recording(player, answer) : play_text(player, answer);
}

bool player_find_number(const struct player *player, swiftprox_object_id id, uint32_t *number)
{
    if (player->is_recording) {
        return swiftprox_replay_get_number(player->replay, id, number) == SWIFTPROX_OK;
    }
    swiftprox_object_info info = {.struct_size = sizeof info};
    const bool is_there = swiftprox_scene_get_object_info(player->scene, id, &info) == SWIFTPROX_OK;
    *number = (uint32_t)info.user_data;
    return is_there;
}

swiftprox_query_kind player_query_kind(const struct player *player)
{
    scene_query *const query = player->options->query;
    if (!query && player->is_recording) {
        return player->info.kind;
    }
    return query == swiftprox_scene_query_intersection           ? SWIFTPROX_QUERY_KIND_INTERSECTION
           : query == swiftprox_scene_query_contact             ? SWIFTPROX_QUERY_KIND_CONTACT
           : query == swiftprox_scene_query_approximate ? SWIFTPROX_QUERY_KIND_APPROXIMATE
                                                                 : SWIFTPROX_QUERY_KIND_DISTANCE;
}
