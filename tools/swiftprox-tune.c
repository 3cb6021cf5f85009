/* swiftprox-tune: plays a scene under all settings that are worth it, and says which are quickest at which accuracy. It is a user
 * of the C interface like any other. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "input.h"
#include "player.h"
#include "program.h"
#include "progress.h"
#include "tune_front.h"
#include "tune_settings.h"
#include <swiftprox/scene.h>

static const char USAGE[] = "usage: swiftprox-tune FILE [--query intersection|distance|contact] [--max-distance D] [--error E]\n"
                            "                      [--input POLICY] [--workers K] [--passes N]\n";

static const char HELP[] =
    "\n"
    "Plays a scene under many settings, and reports the fastest for each accuracy.\n"
    "\n"
    "  FILE                  what swiftprox_scene_record has written, or a scene as text as swiftprox-replay takes it\n"
    "  --query intersection  time verdicts\n"
    "  --query distance      time distances (the default of text), exact ones and approximate ones\n"
    "  --query contact       time contacts with depths and manifolds (default of a recording: its first query)\n"
    "  --max-distance D      how far apart listed pairs may be (default: for a recording, the farthest pair that it lists;\n"
    "                        for text infinite, for contacts 0)\n"
    "  --error E             how wide intervals of the recommended setting may be (default: exact\n"
    "                        answers, and the least error that saves a fifth of their time)\n"
    "  --input POLICY        which meshes are accepted, as for swiftprox-replay (default: strict)\n"
    "  --workers K           also try two and more threads, at most K (default: 1)\n"
    "  --passes N            play the scene so often under each setting; the best pass counts (default: 5)\n"
    "  --help, --version     print this text, the version\n"
    "\n"
    "Settings are exact answers and errors up to a tenth of the largest body, where pairs start, levels of detail where bodies\n"
    "have them, and threads; for text also how its shapes are made. They are interleaved. A step is poses set and query\n"
    "answered; the first, which builds everything, is not timed.\n"
    "\n"
    "Printed are a line for each setting, the fastest first, with milliseconds per step and the width of the widest interval; a\n"
    "drawing; and the recommendation, as code in C and C++. A * stands before a setting that no other beats in both. Widths\n"
    "are guaranteed: the true distance lies in the interval.\n"
    "\n"
    "On a terminal the standard error shows a bar.\n"
    "\n"
    "Exit status: 0, or 2 when the command line, a scene or a mesh file is bad (the message names the line), or 1 for\n"
    "anything else.\n";

static const struct program PROGRAM = {"swiftprox-tune", USAGE, HELP};

struct arguments {
    struct player_options player;
    bool has_error;
    size_t passes;
};

/* False if the program is to end with `*status`. */
static bool read_arguments(int argc, char **argv, struct arguments *arguments, int *status)
{
    static const char *const QUERIES[] = {"intersection", "distance", "contact", NULL};
    static scene_query *const QUERY_FUNCTIONS[] = {swiftprox_scene_query_intersection, swiftprox_scene_query_distance,
                                                   swiftprox_scene_query_contact};
    int query = -1, input = 0;
    size_t workers = 1;
    *arguments = (struct arguments){.player = {.max_distance = SWIFTPROX_DEFAULT_MAX_DISTANCE, .budget = INFINITY}, .passes = 5};
    struct program_option options[] = {
        {.name = "--query", .kind = OPTION_CHOICE, .choices = QUERIES, .value = &query},
        {.name = "--max-distance", .kind = OPTION_AMOUNT, .value = &arguments->player.max_distance},
        {.name = "--error", .kind = OPTION_AMOUNT, .value = &arguments->player.error},
        {.name = "--input", .kind = OPTION_CHOICE, .choices = INPUT_WORDS, .value = &input},
        {.name = "--workers", .kind = OPTION_COUNT, .most = 1024, .value = &workers},
        {.name = "--passes", .kind = OPTION_COUNT, .most = 999999, .value = &arguments->passes},
    };
    struct command_line line = {.program = &PROGRAM,
                                .options = options,
                                .option_count = sizeof options / sizeof *options,
                                .operands = &arguments->player.path,
                                .least_operands = 1,
                                .most_operands = 1,
                                .operands_wanted = "a scene is needed"};
    if (!command_line_read(&line, argc, argv, status)) {
        return false;
    }
    arguments->player.query = query < 0 ? NULL : QUERY_FUNCTIONS[query];
    arguments->player.input = INPUT_VALUES[input];
    arguments->player.workers = (uint32_t)workers;
    arguments->has_error = command_line_has(&line, "--error");
    const char *problem = NULL;
    if (query == 0 && (command_line_has(&line, "--max-distance") || arguments->has_error)) {
        problem = "--max-distance and --error have no meaning for --query intersection";
    } else if (command_line_has(&line, "--input") && player_finds_recording(arguments->player.path)) {
        problem = "--input has no meaning for a recording, which holds its shapes";
    }
    if (problem) {
        *status = program_refuse(&PROGRAM, "%s", problem);
    }
    return !problem;
}

/* ---- a pass ---- */

/* What a pass is played for: what the scene is, or how long its steps take. */
struct pass {
    struct tune_scene *scene; /* null: not asked */
    double farthest;          /* upper end of a listed pair */
    double width;
    double time; /* milliseconds of all steps but the first */
    size_t steps;
};

/* The size of a listed body, and whether it has levels. */
static int look_at_body(const struct player *player, swiftprox_object_id id, uint32_t piece, struct tune_scene *scene)
{
    const swiftprox_shape *shape;
    swiftprox_object_info object = {.struct_size = sizeof object};
    swiftprox_shape_info info = {.struct_size = sizeof info};
    swiftprox_shape_tuning_info tuning = {.struct_size = sizeof tuning};
    if (id.bits == 0) {
        return GOOD; /* a shape that was in no scene */
    }
    if (swiftprox_scene_get_object_info(player->scene, id, &object) != SWIFTPROX_OK) {
        return player_failed();
    }
    if (object.ground || object.compound) {
        return GOOD; /* it is not tuned */
    }
    if (swiftprox_scene_get_piece(player->scene, id, piece, &shape) != SWIFTPROX_OK ||
        swiftprox_shape_get_info(shape, &info) != SWIFTPROX_OK || swiftprox_shape_get_tuning_info(shape, &tuning) != SWIFTPROX_OK) {
        return player_failed();
    }
    const size_t least_of_automatic = 30000; /* vertices, from which on a shape makes levels when they are asked for */
    scene->size = fmax(scene->size, info.radius);
    scene->has_levels = scene->has_levels || tuning.level_count > 0 ||
                        (tuning.hierarchy == SWIFTPROX_HIERARCHY_AUTOMATIC && info.vertex_count >= least_of_automatic);
    return GOOD;
}

static int look_at_answer(const struct player *player, const swiftprox_scene_answer *answer, struct pass *pass)
{
    int result = GOOD;
    for (size_t i = 0; i < answer->count && result == GOOD; i++) {
        const swiftprox_pair_result *const pair = &answer->pairs[i];
        const bool is_deep = pair->answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING && i < answer->contact_count;
        const double lower = is_deep ? answer->contacts[i].depth.lower : pair->answer.lower;
        const double upper = is_deep ? answer->contacts[i].depth.upper : pair->answer.upper;
        /* fmax takes the other number where nothing is said. */
        pass->width = fmax(pass->width, upper - lower);
        pass->farthest = fmax(pass->farthest, pair->answer.upper);
        if (pass->scene) {
            result = look_at_body(player, pair->object1, pair->piece1, pass->scene);
            result = result == GOOD ? look_at_body(player, pair->object2, pair->piece2, pass->scene) : result;
        }
    }
    return result;
}

/* Plays the steps of a pass that has begun. */
static int play_steps(struct player *player, struct pass *pass)
{
    int result = GOOD;
    enum next_step next = NO_QUERY;
    while (result == GOOD && (next = player_next(player)) != NO_MORE) {
        swiftprox_scene_answer answer = {0};
        if (next == NO_QUERY) {
            continue;
        }
        if (pass->scene && player->step == 1) {
            pass->scene->kind = player_query_kind(player);
        }
        const double start = seconds();
        result = next == STEP ? player_play(player, &answer) : BAD_INPUT;
        pass->time += player->step > 1 ? 1e3 * (seconds() - start) : 0;
        pass->steps = player->step;
        result = result == GOOD ? look_at_answer(player, &answer, pass) : result;
    }
    return result;
}

static int play(const struct player_options *options, struct pass *pass)
{
    struct player player;
    int result = player_open(&player, options);
    if (result == GOOD) {
        result = player_begin(&player);
        result = result == GOOD ? play_steps(&player, pass) : result;
        const int ended = player_end(&player);
        result = result != GOOD ? result : ended;
    }
    player_free(&player);
    return result;
}

/* ---- all settings ---- */

/* Plays the scene as it was recorded, and keeps what it is. */
static int explore(const struct arguments *arguments, struct tune_scene *scene)
{
    struct player_options options = arguments->player;
    struct pass pass = {.scene = scene};
    options.error = 0;
    options.workers = 1;
    *scene = (struct tune_scene){.workers = arguments->player.workers, .makes_shapes = !player_finds_recording(options.path)};
    const int result = play(&options, &pass);
    if (result != GOOD) {
        return result;
    }
    if (pass.steps < 2) {
        fprintf(stderr, "%s: there is no step to time: the first is not\n", options.path);
        return BAD_INPUT;
    }
    if (scene->kind == SWIFTPROX_QUERY_KIND_APPROXIMATE) {
        scene->kind = SWIFTPROX_QUERY_KIND_DISTANCE;
    }
    const bool is_given = options.max_distance != SWIFTPROX_DEFAULT_MAX_DISTANCE;
    const double by_default = scene->kind == SWIFTPROX_QUERY_KIND_CONTACT ? 0 : INFINITY;
    scene->max_distance = is_given ? options.max_distance : scene->makes_shapes ? by_default : pass.farthest;
    return GOOD;
}

static scene_query *query_of(const struct tune_scene *scene, const struct tune_setting *setting)
{
    return scene->kind == SWIFTPROX_QUERY_KIND_INTERSECTION ? swiftprox_scene_query_intersection
           : scene->kind == SWIFTPROX_QUERY_KIND_CONTACT    ? swiftprox_scene_query_contact
           : setting->error > 0                             ? swiftprox_scene_query_approximate
                                                            : swiftprox_scene_query_distance;
}

/* Plays a pass under a setting; the point becomes the best of the passes so far. */
static int measure(const struct arguments *arguments, const struct tune_scene *scene, const struct tune_setting *setting,
                   struct tune_point *point)
{
    const swiftprox_pair_tuning tuning = tune_pair_tuning(setting);
    const swiftprox_shape_tuning shape_tuning = tune_shape_tuning(setting);
    struct player_options options = arguments->player;
    options.query = query_of(scene, setting);
    options.max_distance = scene->kind == SWIFTPROX_QUERY_KIND_INTERSECTION ? SWIFTPROX_DEFAULT_MAX_DISTANCE : scene->max_distance;
    options.error = setting->error;
    options.workers = setting->workers;
    options.tuning = &tuning;
    options.shape_tuning = &shape_tuning;
    struct pass pass = {0};
    const int result = play(&options, &pass);
    if (result == GOOD) {
        point->time = fmin(point->time, pass.time / (double)(pass.steps - 1));
        point->width = pass.width;
    }
    return result;
}

static int measure_all(const struct arguments *arguments, const struct tune_scene *scene, const struct tune_setting *settings,
                       struct tune_point *points, size_t count)
{
    struct progress progress = progress_start();
    int result = GOOD;
    for (size_t i = 0; i < count; i++) {
        points[i] = (struct tune_point){.time = INFINITY};
    }
    for (size_t turn = 0; turn < count * arguments->passes && result == GOOD; turn++) {
        result = measure(arguments, scene, &settings[turn % count], &points[turn % count]);
        progress_look(&progress, turn + 1, count * arguments->passes);
    }
    progress_erase(&progress);
    return result;
}

/* ---- what is said ---- */

/* The quickest whose intervals are as narrow as asked: of settings with an error at most `error`. The defaults where nothing is
 * quicker by more than what differs from run to run. */
static size_t quickest(const struct tune_setting *settings, const struct tune_point *points, size_t count, double error)
{
    const double noise = 0.05;
    size_t best = 0;
    for (size_t i = 1; i < count; i++) {
        const double least = best == 0 ? (1 - noise) * points[0].time : points[best].time;
        if (settings[i].error <= error && points[i].time < least) {
            best = i;
        }
    }
    return best;
}

/* The setting of the least error that takes four fifths of the time of exact answers; `exact` where there is none. */
static size_t least_error_that_pays(const struct tune_setting *settings, const struct tune_point *points, size_t count, size_t exact)
{
    const double worth_it = 0.8;
    size_t best = exact;
    for (size_t i = 0; i < count; i++) {
        const bool pays = settings[i].error > 0 && points[i].time <= worth_it * points[exact].time;
        if (pays && (best == exact || settings[i].error < settings[best].error)) {
            best = i;
        }
    }
    return best;
}

static void print_point(const struct tune_setting *setting, const struct tune_point *point)
{
    printf("%s %10.4g  %10.3g  ", point->on_front ? "*" : " ", point->time, point->width);
    tune_print_setting(setting);
}

static void recommend(const struct tune_scene *scene, const struct tune_setting *setting, const struct tune_point *point,
                      const char *for_what)
{
    printf("\nRecommended %s: %.4g ms a step, ", for_what, point->time);
    tune_print_setting(setting);
    puts("\nIn C:\n");
    tune_print_c(scene, setting);
    puts("\nIn C++:\n");
    tune_print_cpp(scene, setting);
}

/* The order from the quickest on. */
static void sort(const struct tune_point *points, size_t *order, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        size_t at = i;
        for (; at > 0 && points[i].time < points[order[at - 1]].time; at--) {
            order[at] = order[at - 1];
        }
        order[at] = i;
    }
}

static void print(const struct arguments *arguments, const struct tune_scene *scene, const struct tune_setting *settings,
                  struct tune_point *points, size_t count)
{
    size_t order[TUNE_MOST_SETTINGS];
    tune_find_front(points, count);
    sort(points, order, count);
    puts("   ms a step    interval  setting");
    for (size_t i = 0; i < count; i++) {
        print_point(&settings[order[i]], &points[order[i]]);
    }
    putchar('\n');
    tune_draw_front(points, count);
    if (arguments->has_error) {
        const size_t best = quickest(settings, points, count, arguments->player.error);
        recommend(scene, &settings[best], &points[best], "for that error");
        return;
    }
    const size_t exact = quickest(settings, points, count, 0);
    const size_t rough = least_error_that_pays(settings, points, count, exact);
    recommend(scene, &settings[exact], &points[exact], "for exact answers");
    if (rough != exact) {
        recommend(scene, &settings[rough], &points[rough], "where an error may be");
    } else if (scene->kind != SWIFTPROX_QUERY_KIND_INTERSECTION) {
        puts("\nNo error up to a tenth of the largest body saves a fifth of the time: ask exactly.");
    }
}

static int run(const struct arguments *arguments)
{
    struct tune_scene scene;
    struct tune_setting settings[TUNE_MOST_SETTINGS];
    struct tune_point points[TUNE_MOST_SETTINGS];
    int result = explore(arguments, &scene);
    if (result == GOOD) {
        const size_t count = tune_settings(&scene, settings);
        result = measure_all(arguments, &scene, settings, points, count);
        if (result == GOOD) {
            print(arguments, &scene, settings, points, count);
        }
    }
    return program_end(&PROGRAM, result);
}

int main(int argc, char **argv)
{
    struct arguments arguments;
    int status;
    return read_arguments(argc, argv, &arguments, &status) ? run(&arguments) : status;
}
