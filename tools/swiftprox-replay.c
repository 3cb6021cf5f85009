/* swiftprox-replay: plays a scene back, step by step: what queries list, or what they cost. It is a user of the C interface
 * like any other, and knows nothing that its headers do not say. */
#include <errno.h>
#include <fenv.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "player.h"
#include "program.h"
#include "progress.h"

static const char USAGE[] = "usage: swiftprox-replay FILE [--query intersection|distance|contact] [--tolerance T]\n"
                            "                        [--input strict|flat|hull] [--workers K] [--verify] [--bench PASSES]\n";

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
    "  --query distance      list the pairs within the tolerance (the default of text), with their distances\n"
    "  --query contact       the same with depths and contact manifolds, too\n"
    "                        (default of a recording: the queries that were made)\n"
    "  --tolerance T         how far apart listed pairs may be (default: 0 for contact, infinite for distance; of a\n"
    "                        recording: as it was)\n"
    "  --input strict        refuse a mesh that is not closed and convex with an interior (the default)\n"
    "  --input flat          admit bodies without interior as well, such as a two-sided polygon\n"
    "  --input hull          take the convex hull of the vertices\n"
    "  --workers K           let K threads share poses and queries (default: 1); it changes no bit of any answer\n"
    "  --verify              check each answer against the shapes alone, and the answers to recorded queries against the\n"
    "                        recorded ones; the first that does not hold ends the program\n"
    "  --bench PASSES        print times instead of answers, see below\n"
    "  --help, --version     print this text, the version\n"
    "\n"
    "Each listed pair is a line of 8 fields, numbers with 17 significant digits:\n"
    "  step object1 object2 outcome distance lower upper depth\n"
    "  step, objects   numbered from 0; object1 is the one that stands earlier in FILE; object2 is - where a recorded\n"
    "                  query was about a shape that was in no scene\n"
    "  outcome         separated, intersecting or undecided\n"
    "  distance        best estimate; 0 when the objects touch or intersect\n"
    "  lower, upper    the true distance lies between them, rounding included, as printed\n"
    "  depth           how deep the objects are in each other; 0 when they touch (query contact)\n"
    "What a query does not say is nan.\n"
    "\n"
    "With --bench the output is one line: the mean, the median and the worst milliseconds a step (poses set,\n"
    "query answered), the pairs that a pass lists, and the sum of their distances. Each pass plays the scene from\n"
    "its beginning; its first step, which builds everything, is not timed.\n"
    "\n"
    "On a terminal the standard error shows a bar while it takes long.\n"
    "\n"
    "Exit status: 0, or 2 when a scene or mesh file is bad (the message names the line), or 1 for anything else.\n";

static const struct program PROGRAM = {"swiftprox-replay", USAGE, HELP};

/* ---- the command line ---- */

struct arguments {
    struct player_options player;
    size_t passes; /* 0: answers, not times */
};

static bool wrong_usage(const char *problem, const char *what)
{
    fprintf(stderr, "swiftprox-replay: %s%s\n%sswiftprox-replay --help tells more\n", problem, what, USAGE);
    return false;
}

static bool parse_option(const char *name, const char *value, struct arguments *arguments)
{
    char *end;
    errno = 0;
    if (strcmp(name, "--query") == 0) {
        arguments->player.query = strcmp(value, "intersection") == 0 ? swiftprox_scene_query_intersection
                                  : strcmp(value, "distance") == 0   ? swiftprox_scene_query_exact_distance
                                  : strcmp(value, "contact") == 0    ? swiftprox_scene_query_contacts
                                                                     : NULL;
        return arguments->player.query || wrong_usage("--query does not know ", value);
    }
    if (strcmp(name, "--input") == 0) {
        arguments->player.input = strcmp(value, "flat") == 0 ? SWIFTPROX_INPUT_FLAT : SWIFTPROX_INPUT_STRICT;
        if (strcmp(value, "hull") == 0) {
            arguments->player.input = SWIFTPROX_INPUT_HULL;
        }
        return arguments->player.input != SWIFTPROX_INPUT_STRICT || strcmp(value, "strict") == 0 ||
               wrong_usage("--input does not know ", value);
    }
    if (strcmp(name, "--tolerance") == 0) {
        arguments->player.tolerance = strtod(value, &end);
        return (end != value && *end == '\0' && arguments->player.tolerance >= 0) ||
               wrong_usage("--tolerance wants a number from 0 on, not ", value);
    }
    const bool is_bench = strcmp(name, "--bench") == 0;
    if (is_bench || strcmp(name, "--workers") == 0) {
        const unsigned long long number = strtoull(value, &end, 10);
        const unsigned long long most = is_bench ? 999999 : 1024;
        if (value[strspn(value, "0123456789")] != '\0' || end == value || errno != 0 || number == 0 || number > most) {
            return is_bench ? wrong_usage("--bench wants a number from 1 to 999999, not ", value)
                            : wrong_usage("--workers wants a number from 1 to 1024, not ", value);
        }
        if (is_bench) {
            arguments->passes = (size_t)number;
        } else {
            arguments->player.workers = (uint32_t)number;
        }
        return true;
    }
    return wrong_usage("unknown option ", name);
}

static bool parse_arguments(int argc, char **argv, struct arguments *arguments)
{
    *arguments = (struct arguments){.player.tolerance = SWIFTPROX_DEFAULT_TOLERANCE};
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--verify") == 0) {
            arguments->player.verify = true;
        } else if (strncmp(argv[i], "--", 2) == 0) {
            if (i + 1 == argc) {
                return wrong_usage(argv[i], " wants a value");
            }
            if (!parse_option(argv[i], argv[i + 1], arguments)) {
                return false;
            }
            i++;
        } else if (arguments->player.path) {
            return wrong_usage("one file too many: ", argv[i]);
        } else {
            arguments->player.path = argv[i];
        }
    }
    return arguments->player.path || wrong_usage("a scene is needed", "");
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

/* `contact` is NULL where none was asked for. */
static void print_pair(const struct player *player, const swiftprox_pair_result *pair, const swiftprox_contact *contact)
{
    printf("%zu", player->step - 1);
    player_print_object(player, pair->object1, pair->user_data1);
    player_print_object(player, pair->object2, pair->user_data2);
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
        if (swiftprox_scene_get_piece_pose(player->scene, ids[i], pieces[i], poses[i]) != SWIFTPROX_OK ||
            swiftprox_scene_get_piece(player->scene, ids[i], pieces[i], &shapes[i]) != SWIFTPROX_OK) {
            return player_failed();
        }
    }
    const bool has_depth = contact && pair->answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING;
    if (swiftprox_pair_verify(shapes[0], poses[0], shapes[1], poses[1], &pair->answer) != SWIFTPROX_OK ||
        (has_depth && swiftprox_pair_depth_verify(shapes[0], poses[0], shapes[1], poses[1], &cold, &contact->depth) !=
                          SWIFTPROX_OK)) {
        print_pair(player, pair, contact);
        fflush(stdout);
        fprintf(stderr, "%s: step %zu, the pair above: %s\n", player->options->path, player->step - 1,
                swiftprox_library_last_error_message());
        return FAILED;
    }
    return GOOD;
}

/* What a step lists: of a query that stopped the pair at which it did. */
static int print_answer(const struct player *player, const swiftprox_scene_answer *answer)
{
    const swiftprox_pair_result *const pairs = answer->found ? answer->found : answer->pairs;
    const size_t count = answer->found ? 1 : answer->count;
    swiftprox_scene_contacts contacts;
    int result = swiftprox_scene_get_contacts(player->scene, &contacts) == SWIFTPROX_OK ? GOOD : player_failed();
    for (size_t i = 0; i < count && result == GOOD; i++) {
        const swiftprox_contact *const contact = i < contacts.count ? &contacts.contacts[i] : NULL;
        result = player->options->verify ? verify_pair(player, &pairs[i], contact) : GOOD;
        if (result == GOOD) {
            print_pair(player, &pairs[i], contact);
        }
    }
    return result;
}

static int print_answers(struct player *player)
{
    int result = player_begin(player);
    struct progress progress = progress_start();
    while (result == GOOD) {
        const enum next_step next = player_next(player);
        if (next == STEP) {
            swiftprox_scene_answer answer;
            result = player_play(player, &answer);
            result = result == GOOD ? print_answer(player, &answer) : result;
        } else if (next == BAD_STEP) {
            result = BAD_FILE;
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
        result = next == STEP ? player_play(player, &answer) : BAD_FILE;
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
            result = BAD_FILE;
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
        result = arguments->passes ? print_times(&player, arguments->passes) : print_answers(&player);
    }
    player_free(&player);
    return program_end(&PROGRAM, result);
}

int main(int argc, char **argv)
{
    if (program_tells(&PROGRAM, argc, argv)) {
        return program_end(&PROGRAM, GOOD);
    }
    struct arguments arguments;
    return parse_arguments(argc, argv, &arguments) ? run(&arguments) : FAILED;
}
