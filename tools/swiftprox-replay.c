/* swiftprox-replay: plays a scene back, step by step: what queries list, or what they cost. It is a user of the C interface
 * like any other, and knows nothing that its headers do not say. */
#include <fenv.h>
#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "input.h"
#include "output_file.h"
#include "page_data.h"
#include "page_file.h"
#include "player.h"
#include "program.h"
#include "progress.h"
#include "text.h"
#include <swiftprox/scene.h>
#include <swiftprox/verify.h>

static const char USAGE[] = "usage: swiftprox-replay FILE [--query intersection|distance|contact|approximate] [--max-distance D]\n"
                            "                        [--error E] [--budget B] [--input POLICY] [--workers K] [--verify]\n"
                            "                        [--bench PASSES | --html OUT]\n";

static const char HELP[] =
    "\n"
    "Plays back a scene: in each step objects are moved, then one query lists pairs.\n"
    "\n"
    "  FILE                  what swiftprox_scene_record has written, or a scene as text, - is the standard input:\n"
    "                          # swiftprox scene 1      the first line\n"
    "                          shape NAME FILE          a mesh file, relative to the folder of the scene\n"
    "                          object NAME [fixed]      objects are numbered from 0 and stand at the identity\n"
    "                          step                     a step; then a line for each object that moves in it:\n"
    "                          NUMBER and 12 numbers    the object and the row-major 3x4 [R|T]\n"
    "                        blank lines and others that start with # are skipped\n"
    "  --query intersection  list the pairs that intersect\n"
    "  --query distance      list the pairs within max-distance (the default of text), with their distances\n"
    "  --query contact       the same with depths and contact manifolds, too\n"
    "  --query approximate   the same as distance, with intervals as wide as --error or --budget let them be\n"
    "                        (default of a recording: the queries that were made)\n"
    "  --max-distance D      how far apart listed pairs may be (default: 0 for contact, infinite for distance; for a\n"
    "                        recording: as recorded)\n"
    "  --error E             how wide the interval of an approximate distance or of a depth may be (default: as narrow\n"
    "                        as possible); queries approximate and contact\n"
    "  --budget B            how wide the intervals of all pairs of a step together may be, whatever --error is;\n"
    "                        query approximate (default: infinite)\n"
    "  --input strict        refuse a mesh that is not closed and convex with an interior (the default)\n"
    "  --input flat          admit bodies without interior as well, such as a two-sided polygon\n"
    "  --input hull          take the convex hull of all vertices, with or without a face\n"
    "  --input patch         take the convex hull of the faces\n"
    "                        (nearly-convex: as flat, up to the precision of the coordinates)\n"
    "  --workers K           let K threads share poses and queries (default: 1); it changes no bit of any answer\n"
    "  --verify              check each answer against the shapes alone, and the answers to recorded queries against the\n"
    "                        recorded ones; the first that does not hold ends the program\n"
    "  --bench PASSES        print times instead of answers, see below\n"
    "  --html OUT            write a page that shows the scene and its answers in a browser, see below\n"
    "  --help, --version     print this text, the version\n"
    "\n"
    "Each listed pair is a line of 8 fields, numbers with 17 significant digits:\n"
    "  step object1 object2 outcome distance lower upper depth\n"
    "  step, objects   numbered from 0; object1 is the one that stands earlier in FILE; object2 is - where a recorded\n"
    "                  query was about a shape that was in no scene\n"
    "  outcome         separated, intersecting or undecided\n"
    "  distance        best estimate; 0 when the objects touch or intersect\n"
    "  lower, upper    the true distance lies between them, rounding included, as printed\n"
    "  depth           penetration depth; 0 when they touch (query contact)\n"
    "Unset numbers are nan.\n"
    "\n"
    "With --bench the output is one line: the mean, the median and the worst milliseconds per step (poses set,\n"
    "query answered), the pairs that a pass lists, and the sum of their distances. Each pass plays the scene from\n"
    "its beginning; its first step, which builds everything, is not timed.\n"
    "\n"
    "With --html nothing is printed but a line about the page, which is one file and loads nothing: the scene in 3-D, its pairs\n"
    "step by step with the numbers above, witness points, normals, manifolds, and intervals over time. It holds the deepest\n"
    "and nearest pairs of each step, as many as fit into 56 MB, and reports how many were listed. OUT is replaced at the end.\n"
    "\n"
    "On a terminal the standard error shows a progress bar.\n"
    "\n"
    "Exit status: 0, or 2 when the command line, a scene or a mesh file is bad (the message names the line), or 1 for\n"
    "anything else.\n";

static const struct program PROGRAM = {"swiftprox-replay", USAGE, HELP};

/* ---- the command line ---- */

struct arguments {
    struct player_options player;
    size_t passes;    /* 0: answers, not times */
    const char *page; /* null: answers are printed */
};

/* Whether each option has a meaning beside the others and for the scene; false after a message. */
static bool fits(const struct command_line *line, const struct arguments *arguments)
{
    const struct player_options *const player = &arguments->player;
    const char *problem = NULL;
    if (command_line_has(line, "--max-distance") && player->query == swiftprox_scene_query_intersection) {
        problem = "--max-distance has no meaning for --query intersection";
    } else if (command_line_has(line, "--error") && player->query != swiftprox_scene_query_approximate &&
               player->query != swiftprox_scene_query_contact) {
        problem = "--error has a meaning for --query approximate and --query contact alone";
    } else if (command_line_has(line, "--budget") && player->query != swiftprox_scene_query_approximate) {
        problem = "--budget has a meaning for --query approximate alone";
    } else if (player->verify && arguments->passes) {
        problem = "--verify has no meaning beside --bench, which times the queries alone";
    } else if (arguments->page && arguments->passes) {
        problem = "--html has no meaning beside --bench, which keeps no answers";
    } else if (arguments->page && text_is_same(player->path, arguments->page)) {
        problem = "--html would replace the scene";
    } else if (command_line_has(line, "--input") && player_finds_recording(player->path)) {
        problem = "--input has no meaning for a recording, which holds its shapes";
    }
    if (problem) {
        program_refuse(&PROGRAM, "%s", problem);
    }
    return !problem && (!arguments->page || output_file_try(arguments->page));
}

/* False if the program is to end with `*status`. */
static bool read_arguments(int argc, char **argv, struct arguments *arguments, int *status)
{
    static const char *const QUERIES[] = {"intersection", "distance", "contact", "approximate", NULL};
    static scene_query *const QUERY_FUNCTIONS[] = {swiftprox_scene_query_intersection, swiftprox_scene_query_distance,
                                                   swiftprox_scene_query_contact,
                                                   swiftprox_scene_query_approximate};
    int query = -1, input = 0;
    size_t workers = 0;
    *arguments = (struct arguments){.player = {.max_distance = SWIFTPROX_DEFAULT_MAX_DISTANCE, .budget = INFINITY}};
    struct program_option options[] = {
        {.name = "--query", .kind = OPTION_CHOICE, .choices = QUERIES, .value = &query},
        {.name = "--max-distance", .kind = OPTION_AMOUNT, .value = &arguments->player.max_distance},
        {.name = "--error", .kind = OPTION_AMOUNT, .value = &arguments->player.error},
        {.name = "--budget", .kind = OPTION_AMOUNT, .value = &arguments->player.budget},
        {.name = "--input", .kind = OPTION_CHOICE, .choices = INPUT_WORDS, .value = &input},
        {.name = "--workers", .kind = OPTION_COUNT, .most = 1024, .value = &workers},
        {.name = "--verify", .kind = OPTION_FLAG, .value = &arguments->player.verify},
        {.name = "--bench", .kind = OPTION_COUNT, .most = 999999, .value = &arguments->passes},
        {.name = "--html", .kind = OPTION_OUTPUT, .value = &arguments->page},
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
    *status = BAD_INPUT;
    arguments->player.query = query < 0 ? NULL : QUERY_FUNCTIONS[query];
    arguments->player.input = INPUT_VALUES[input];
    arguments->player.workers = (uint32_t)workers;
    return fits(&line, arguments);
}

/* ---- answers ---- */

/* The sign bit of a NaN says nothing, but printf shows it. */
static void print_number(double value, int direction)
{
    /* 17 digits round a double; printf rounds as the floating-point environment says, so that the printed bounds are bounds. */
    const int before = fegetround();
    fesetround(direction);
    if (isnan(value)) {
        fputs(" nan", stdout);
    } else {
        printf(" %.17g", value);
    }
    fesetround(before);
}

static const char *outcome_word(swiftprox_outcome outcome)
{
    return outcome == SWIFTPROX_OUTCOME_SEPARATED      ? "separated"
           : outcome == SWIFTPROX_OUTCOME_INTERSECTING ? "intersecting"
                                                       : "undecided";
}

/* Prints a blank and the number of an object, or - of a shape that was in no scene. */
static void print_object(const struct player *player, swiftprox_object_id id)
{
    uint32_t number;
    if (player_find_number(player, id, &number)) {
        printf(" %" PRIu32, number);
    } else {
        fputs(" -", stdout);
    }
}

/* `contact` is NULL where none was asked for. */
static void print_pair(const struct player *player, const swiftprox_pair_result *pair, const swiftprox_contact *contact)
{
    printf("%zu", player->step - 1);
    print_object(player, pair->object1);
    print_object(player, pair->object2);
    printf(" %s", outcome_word(pair->answer.outcome));
    print_number(pair->answer.distance, FE_TONEAREST);
    print_number(pair->answer.lower, FE_DOWNWARD);
    print_number(pair->answer.upper, FE_UPWARD);
    print_number(contact ? contact->depth.depth : NAN, FE_TONEAREST);
    putchar('\n');
}

static int verify_pair(const struct player *player, const swiftprox_pair_result *pair, const swiftprox_contact *contact)
{
    const swiftprox_depth_cache cold = {{0}};
    double poses[2][12];
    const swiftprox_shape *shapes[2];
    const swiftprox_object_id ids[2] = {pair->object1, pair->object2};
    const uint32_t pieces[2] = {pair->piece1, pair->piece2};
    if (pair->object2.bits == 0) {
        return GOOD; /* a shape that is not there any more */
    }
    for (int i = 0; i < 2; i++) {
        swiftprox_object_info info = {.struct_size = sizeof info};
        if (swiftprox_scene_get_object_info(player->scene, ids[i], &info) != SWIFTPROX_OK) {
            return player_failed();
        }
        if (info.ground || info.compound) {
            return GOOD; /* the independent check knows pairs of convex pieces alone */
        }
        if (swiftprox_scene_get_piece_pose(player->scene, ids[i], pieces[i], poses[i]) != SWIFTPROX_OK ||
            swiftprox_scene_get_piece(player->scene, ids[i], pieces[i], &shapes[i]) != SWIFTPROX_OK) {
            return player_failed();
        }
    }
    const bool has_depth = contact && pair->answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING;
    if (swiftprox_pair_verify((swiftprox_placed){shapes[0], poses[0]}, (swiftprox_placed){shapes[1], poses[1]},
                              &pair->answer) != SWIFTPROX_OK ||
        (has_depth &&
         swiftprox_pair_depth_verify((swiftprox_placed){shapes[0], poses[0]}, (swiftprox_placed){shapes[1], poses[1]}, &cold,
                                     &contact->depth) != SWIFTPROX_OK)) {
        print_pair(player, pair, contact);
        fflush(stdout);
        fprintf(stderr, "%s: step %zu, the pair above: %s\n", player->options->path, player->step - 1,
                swiftprox_library_last_error_message());
        return FAILED;
    }
    return GOOD;
}

/* What a step lists: of a query that stopped the pair at which it did. It is printed, or goes to the page if there is one. */
static int take_answer(const struct player *player, const swiftprox_scene_answer *answer, struct page_data *page)
{
    const swiftprox_pair_result *const pairs = answer->found ? answer->found : answer->pairs;
    const size_t count = answer->found ? 1 : answer->count;
    int result = GOOD;
    for (size_t i = 0; i < count && result == GOOD; i++) {
        const swiftprox_contact *const contact = i < answer->contact_count ? &answer->contacts[i] : NULL;
        result = player->options->verify ? verify_pair(player, &pairs[i], contact) : GOOD;
        if (result == GOOD && !page) {
            print_pair(player, &pairs[i], contact);
        }
    }
    return result == GOOD && page ? page_data_add(page, player, answer) : result;
}

static int play_answers(struct player *player, struct page_data *page)
{
    int result = player_begin(player);
    struct progress progress = progress_start();
    while (result == GOOD) {
        const enum next_step next = player_next(player);
        if (next == STEP) {
            swiftprox_scene_answer answer;
            result = player_play(player, &answer);
            result = result == GOOD ? take_answer(player, &answer, page) : result;
        } else if (next == BAD_STEP) {
            result = BAD_INPUT;
        } else if (next == NO_MORE) {
            break;
        }
        progress_look(&progress, (size_t)(player->fraction * 1000), 1000);
    }
    progress_erase(&progress);
    if (player->cut_off) {
        fprintf(stderr, "%s: the recording was not ended; this is what there is of it\n", player->options->path);
    }
    const int ended = player_end(player);
    return result != GOOD ? result : ended;
}

/* ---- a page ---- */

static int write_page(const struct player *player, struct page_data *page, const char *path)
{
    const struct page_title title = {player->options->path, player->options->max_distance, player->cut_off};
    struct output_file output;
    page_data_fit(page);
    if (!output_file_open(&output, path)) {
        return FAILED;
    }
    const int result = page_file_write(output.file, page, &title);
    const long bytes = ftell(output.file);
    if (!output_file_close(&output, result == GOOD)) {
        return result == GOOD ? FAILED : result;
    }
    size_t kept = 0, listed = 0;
    for (size_t i = 0; i < page->step_count; i++) {
        kept += page->steps[i].pair_count;
        listed += page->steps[i].listed;
    }
    printf("%s: %.1f MB, %zu steps, %zu bodies, %zu of %zu pairs\n", path, 1e-6 * (double)bytes, page->step_count,
           page->body_count, kept, listed);
    return GOOD;
}

static int make_page(struct player *player, const char *path)
{
    struct page_data page = page_data_start();
    int result = play_answers(player, &page);
    if (result == GOOD && page.step_count == 0) {
        fprintf(stderr, "%s: there is no step to show\n", player->options->path);
        result = BAD_INPUT;
    }
    result = result == GOOD ? write_page(player, &page, path) : result;
    page_data_free(&page);
    return result;
}

/* ---- times ---- */

static int ascending(const void *left, const void *right)
{
    const double a = *(const double *)left;
    const double b = *(const double *)right;
    return (a > b) - (a < b);
}

/* The times of steps, and what a pass lists. */
struct bench {
    double *times; /* milliseconds */
    size_t count;
    size_t capacity;
    size_t pairs;
    double sum;
};

static int add_time(struct bench *bench, double time)
{
    if (bench->count == bench->capacity) {
        const size_t capacity = bench->capacity > 0 ? 2 * bench->capacity : 1024;
        double *const times = capacity <= SIZE_MAX / sizeof(double) ? realloc(bench->times, capacity * sizeof(double)) : NULL;
        if (!times) {
            fputs("swiftprox-replay: no memory for the times of so many steps\n", stderr);
            return FAILED;
        }
        bench->times = times;
        bench->capacity = capacity;
    }
    bench->times[bench->count++] = time;
    return GOOD;
}

/* All steps but the first are timed; reading them is not. */
static int time_pass(struct player *player, struct bench *bench)
{
    int result = player_begin(player);
    bench->pairs = 0;
    bench->sum = 0;
    enum next_step next = NO_QUERY;
    while (result == GOOD && (next = player_next(player)) != NO_MORE) {
        swiftprox_scene_answer answer = {0};
        if (next == NO_QUERY) {
            continue;
        }
        const double start = seconds();
        result = next == STEP ? player_play(player, &answer) : BAD_INPUT;
        const double time = 1e3 * (seconds() - start);
        if (result == GOOD && player->step > 1) {
            result = add_time(bench, time);
        }
        for (size_t i = 0; result == GOOD && i < answer.count; i++) {
            bench->sum += isnan(answer.pairs[i].answer.distance) ? 0 : answer.pairs[i].answer.distance;
        }
        bench->pairs += result == GOOD ? answer.count : 0;
    }
    const int ended = player_end(player);
    return result != GOOD ? result : ended;
}

static int print_times(struct player *player, size_t passes)
{
    struct progress progress = progress_start();
    struct bench bench = {0};
    int result = GOOD;
    for (size_t pass = 0; pass < passes && result == GOOD; pass++) {
        result = time_pass(player, &bench);
        progress_look(&progress, pass + 1, passes);
        if (result == GOOD && bench.count == 0) {
            progress_erase(&progress);
            fprintf(stderr, "%s: there is no step to time: the first is not\n", player->options->path);
            result = BAD_INPUT;
        }
    }
    progress_erase(&progress);
    if (result == GOOD) {
        double sum = 0;
        for (size_t i = 0; i < bench.count; i++) {
            sum += bench.times[i];
        }
        qsort(bench.times, bench.count, sizeof *bench.times, ascending);
        const double median = 0.5 * (bench.times[(bench.count - 1) / 2] + bench.times[bench.count / 2]);
        printf("%.6g %.6g %.6g %zu %.17g\n", sum / (double)bench.count, median, bench.times[bench.count - 1], bench.pairs,
               bench.sum);
    }
    free(bench.times);
    return result;
}

/* ---- the program ---- */

static int run(const struct arguments *arguments)
{
    static char buffer[1 << 16];
    setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
    struct player player;
    int result = player_open(&player, &arguments->player);
    if (result == GOOD) {
        result = arguments->passes ? print_times(&player, arguments->passes)
                 : arguments->page ? make_page(&player, arguments->page)
                                   : play_answers(&player, NULL);
    }
    player_free(&player);
    return program_end(&PROGRAM, result);
}

int main(int argc, char **argv)
{
    struct arguments arguments;
    int status;
    return read_arguments(argc, argv, &arguments, &status) ? run(&arguments) : status;
}
