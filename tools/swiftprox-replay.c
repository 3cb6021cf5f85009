/* swiftprox-replay: plays a scene back, step by step: what queries list, or what they cost. It is a user of the C interface
 * like any other, and knows nothing that its headers do not say. */
#include <errno.h>
#include <fenv.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <swiftprox.h>

#include "progress.h"
#include "scene_file.h"

enum exit_status { GOOD = 0, FAILED = 1, BAD_FILE = 2 };

static const char USAGE[] = "usage: swiftprox-replay FILE [--query intersection|distance|contact] [--tolerance T]\n"
                            "                        [--input strict|flat|hull] [--verify] [--bench PASSES]\n";

static const char HELP[] =
    "\n"
    "Plays back a scene: in each step the objects that it names are moved, then one query lists pairs.\n"
    "\n"
    "  FILE                  a scene as text, - is the standard input:\n"
    "                          # swiftprox scene 1      the first line\n"
    "                          shape NAME FILE          a mesh file, relative to the folder of the scene\n"
    "                          object NAME [fixed]      objects are numbered from 0 and stand at the identity\n"
    "                          step                     a step; then a line for each object that moves in it:\n"
    "                          NUMBER and 12 numbers    the object and the row-major 3x4 [R|T]\n"
    "                        blank lines and others that start with # are skipped\n"
    "  --query intersection  list the pairs that intersect\n"
    "  --query distance      list the pairs within the tolerance (the default), with their distances\n"
    "  --query contact       the same with depths and contact manifolds, too\n"
    "  --tolerance T         how far apart listed pairs may be (default: 0 for contact, infinite for distance)\n"
    "  --input strict        refuse a mesh that is not closed and convex with an interior (the default)\n"
    "  --input flat          admit bodies without interior as well, such as a two-sided polygon\n"
    "  --input hull          take the convex hull of the vertices\n"
    "  --verify              check each answer against the shapes alone; the first that does not hold ends the program\n"
    "  --bench PASSES        print times instead of answers, see below\n"
    "  --help, --version     print this text, the version\n"
    "\n"
    "Each listed pair is a line of 8 fields, numbers with 17 significant digits:\n"
    "  step object1 object2 outcome distance lower upper depth\n"
    "  step, objects   numbered from 0; object1 is the one that stands earlier in FILE\n"
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

/* ---- the command line ---- */

typedef swiftprox_status scene_query(swiftprox_scene *, const swiftprox_scene_query *, swiftprox_scene_answer *);

struct arguments {
    const char *path;
    scene_query *query;
    double tolerance;
    swiftprox_input input;
    bool verify;
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
        arguments->query = strcmp(value, "intersection") == 0 ? swiftprox_scene_query_intersection
                           : strcmp(value, "distance") == 0   ? swiftprox_scene_query_exact_distance
                           : strcmp(value, "contact") == 0    ? swiftprox_scene_query_contacts
                                                              : NULL;
        return arguments->query || wrong_usage("--query does not know ", value);
    }
    if (strcmp(name, "--input") == 0) {
        arguments->input = strcmp(value, "flat") == 0 ? SWIFTPROX_INPUT_FLAT : SWIFTPROX_INPUT_STRICT;
        if (strcmp(value, "hull") == 0) {
            arguments->input = SWIFTPROX_INPUT_HULL;
        }
        return arguments->input != SWIFTPROX_INPUT_STRICT || strcmp(value, "strict") == 0 ||
               wrong_usage("--input does not know ", value);
    }
    if (strcmp(name, "--tolerance") == 0) {
        arguments->tolerance = strtod(value, &end);
        return (end != value && *end == '\0' && arguments->tolerance >= 0) ||
               wrong_usage("--tolerance wants a number from 0 on, not ", value);
    }
    if (strcmp(name, "--bench") == 0) {
        const unsigned long long passes = strtoull(value, &end, 10);
        arguments->passes = (size_t)passes;
        return (value[strspn(value, "0123456789")] == '\0' && end != value && errno == 0 && passes > 0 && passes < 1000000) ||
               wrong_usage("--bench wants a number from 1 to 999999, not ", value);
    }
    return wrong_usage("unknown option ", name);
}

static bool parse_arguments(int argc, char **argv, struct arguments *arguments)
{
    *arguments = (struct arguments){.query = swiftprox_scene_query_exact_distance, .tolerance = SWIFTPROX_DEFAULT_TOLERANCE};
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--verify") == 0) {
            arguments->verify = true;
        } else if (strncmp(argv[i], "--", 2) == 0) {
            if (i + 1 == argc) {
                return wrong_usage(argv[i], " wants a value");
            }
            if (!parse_option(argv[i], argv[i + 1], arguments)) {
                return false;
            }
            i++;
        } else if (arguments->path) {
            return wrong_usage("one file too many: ", argv[i]);
        } else {
            arguments->path = argv[i];
        }
    }
    return arguments->path || wrong_usage("a scene is needed", "");
}

/* ---- playing ---- */

struct player {
    const struct arguments *arguments;
    struct scene_file file;
    const swiftprox_shape **shapes; /* as many as the file has */
    swiftprox_object_id *ids;       /* of its objects */
    swiftprox_scene *scene;
    swiftprox_scene_query query;
};

static int failed(void)
{
    fprintf(stderr, "swiftprox-replay: %s\n", swiftprox_library_last_error_message());
    return FAILED;
}

static int load_shapes(struct player *player)
{
    swiftprox_shape_options options;
    swiftprox_shape_options_init(&options);
    options.input = player->arguments->input;
    struct progress progress = progress_start();
    int result = GOOD;
    for (size_t i = 0; i < player->file.shape_count && result == GOOD; i++) {
        const struct scene_shape *const shape = &player->file.shapes[i];
        const swiftprox_status status = swiftprox_shape_create_from_file(shape->path, &options, &player->shapes[i]);
        if (status != SWIFTPROX_OK) {
            progress_erase(&progress);
            fprintf(stderr, "%s:%zu: %s\n", player->arguments->path, shape->line, swiftprox_library_last_error_message());
            result = status == SWIFTPROX_ERROR_FILE || status == SWIFTPROX_ERROR_MESH ? BAD_FILE : FAILED;
        }
        progress_look(&progress, i + 1, player->file.shape_count);
    }
    progress_erase(&progress);
    return result;
}

/* The scene before its first step. */
static int set_up(struct player *player)
{
    if (swiftprox_scene_create(NULL, &player->scene) != SWIFTPROX_OK) {
        return failed();
    }
    for (size_t i = 0; i < player->file.object_count; i++) {
        const struct scene_object *const object = &player->file.objects[i];
        swiftprox_object_options options;
        swiftprox_object_options_init(&options);
        options.user_data = i;
        options.fixed = object->fixed;
        if (swiftprox_scene_add_shape(player->scene, player->shapes[object->shape], &options, &player->ids[i]) !=
            SWIFTPROX_OK) {
            return failed();
        }
    }
    return GOOD;
}

static int tear_down(struct player *player)
{
    const swiftprox_status status = swiftprox_scene_destroy(player->scene);
    player->scene = NULL;
    return status == SWIFTPROX_OK ? GOOD : failed();
}

static int play_step(struct player *player, size_t step, swiftprox_scene_answer *answer)
{
    const size_t end = scene_file_moves_end(&player->file, step);
    for (size_t m = player->file.steps[step].first_move; m < end; m++) {
        const struct scene_move *const move = &player->file.moves[m];
        if (swiftprox_scene_set_pose(player->scene, player->ids[move->object], move->pose) != SWIFTPROX_OK) {
            fprintf(stderr, "%s:%zu: %s\n", player->arguments->path, move->line, swiftprox_library_last_error_message());
            return BAD_FILE;
        }
    }
    return player->arguments->query(player->scene, &player->query, answer) == SWIFTPROX_OK ? GOOD : failed();
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
static void print_pair(size_t step, const swiftprox_pair_result *pair, const swiftprox_contact *contact)
{
    printf("%zu %llu %llu %s", step, (unsigned long long)pair->user_data1, (unsigned long long)pair->user_data2,
           outcome_word(pair->answer.outcome));
    print_number(pair->answer.distance, FE_TONEAREST);
    print_number(pair->answer.lower, FE_DOWNWARD);
    print_number(pair->answer.upper, FE_UPWARD);
    print_number(contact ? contact->depth.depth : NAN, FE_TONEAREST);
    putchar('\n');
}

static int verify_pair(const struct player *player, size_t step, const swiftprox_pair_result *pair,
                       const swiftprox_contact *contact)
{
    const swiftprox_depth_cache cold = {{0}};
    swiftprox_object_info infos[2] = {{.struct_size = sizeof *infos}, {.struct_size = sizeof *infos}};
    const swiftprox_shape *shapes[2];
    const swiftprox_object_id ids[2] = {pair->object1, pair->object2};
    const uint32_t pieces[2] = {pair->piece1, pair->piece2};
    for (int i = 0; i < 2; i++) {
        if (swiftprox_scene_get_object_info(player->scene, ids[i], &infos[i]) != SWIFTPROX_OK ||
            swiftprox_scene_get_piece(player->scene, ids[i], pieces[i], &shapes[i]) != SWIFTPROX_OK) {
            return failed();
        }
    }
    const bool has_depth = contact && pair->answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING;
    if (swiftprox_pair_verify(shapes[0], infos[0].pose, shapes[1], infos[1].pose, &pair->answer) != SWIFTPROX_OK ||
        (has_depth && swiftprox_pair_depth_verify(shapes[0], infos[0].pose, shapes[1], infos[1].pose, &cold,
                                                  &contact->depth) != SWIFTPROX_OK)) {
        fflush(stdout);
        fprintf(stderr, "%s: step %zu, objects %llu and %llu: %s\n", player->arguments->path, step,
                (unsigned long long)pair->user_data1, (unsigned long long)pair->user_data2,
                swiftprox_library_last_error_message());
        return FAILED;
    }
    return GOOD;
}

static int print_answers(struct player *player)
{
    int result = set_up(player);
    struct progress progress = progress_start();
    for (size_t step = 0; step < player->file.step_count && result == GOOD; step++) {
        swiftprox_scene_answer answer;
        swiftprox_scene_contacts contacts;
        result = play_step(player, step, &answer);
        if (result == GOOD && swiftprox_scene_get_contacts(player->scene, &contacts) != SWIFTPROX_OK) {
            result = failed();
        }
        for (size_t i = 0; result == GOOD && i < answer.count; i++) {
            const swiftprox_contact *const contact = i < contacts.count ? &contacts.contacts[i] : NULL;
            print_pair(step, &answer.pairs[i], contact);
            if (player->arguments->verify) {
                result = verify_pair(player, step, &answer.pairs[i], contact);
            }
        }
        progress_look(&progress, step + 1, player->file.step_count);
    }
    progress_erase(&progress);
    const int ended = tear_down(player);
    return result != GOOD ? result : ended;
}

/* ---- times ---- */

static int ascending(const void *left, const void *right)
{
    const double a = *(const double *)left;
    const double b = *(const double *)right;
    return (a > b) - (a < b);
}

/* What a pass lists. */
struct listed {
    size_t pairs;
    double sum;
};

/* Milliseconds of all steps but the first. */
static int time_pass(struct player *player, double *times, struct listed *listed)
{
    int result = set_up(player);
    *listed = (struct listed){0, 0};
    for (size_t step = 0; step < player->file.step_count && result == GOOD; step++) {
        swiftprox_scene_answer answer;
        const double start = seconds();
        result = play_step(player, step, &answer);
        if (step > 0) {
            times[step - 1] = 1e3 * (seconds() - start);
        }
        for (size_t i = 0; result == GOOD && i < answer.count; i++) {
            listed->sum += isnan(answer.pairs[i].answer.distance) ? 0 : answer.pairs[i].answer.distance;
        }
        listed->pairs += result == GOOD ? answer.count : 0;
    }
    const int ended = tear_down(player);
    return result != GOOD ? result : ended;
}

static int print_times(struct player *player)
{
    const size_t passes = player->arguments->passes;
    if (player->file.step_count < 2) {
        fprintf(stderr, "%s: there is no step to time: the first is not\n", player->arguments->path);
        return BAD_FILE;
    }
    const size_t timed = player->file.step_count - 1;
    double *const times = timed <= SIZE_MAX / sizeof(double) / passes ? malloc(passes * timed * sizeof(double)) : NULL;
    if (!times) {
        fputs("swiftprox-replay: no memory for the times of so many steps\n", stderr);
        return FAILED;
    }
    struct progress progress = progress_start();
    struct listed listed = {0, 0};
    int result = GOOD;
    for (size_t pass = 0; pass < passes && result == GOOD; pass++) {
        result = time_pass(player, times + pass * timed, &listed);
        progress_look(&progress, pass + 1, passes);
    }
    progress_erase(&progress);
    if (result == GOOD) {
        const size_t count = passes * timed;
        double sum = 0;
        for (size_t i = 0; i < count; i++) {
            sum += times[i];
        }
        qsort(times, count, sizeof *times, ascending);
        const double median = 0.5 * (times[(count - 1) / 2] + times[count / 2]);
        printf("%.6g %.6g %.6g %zu %.17g\n", sum / (double)count, median, times[count - 1], listed.pairs, listed.sum);
    }
    free(times);
    return result;
}

/* ---- the program ---- */

static int run(const struct arguments *arguments)
{
    static char buffer[1 << 16];
    setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
    struct player player = {.arguments = arguments};
    swiftprox_scene_query_init(&player.query);
    player.query.distance_tolerance = arguments->tolerance;
    player.query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD; /* of contacts alone */
    int result = BAD_FILE;
    if (scene_file_read(arguments->path, &player.file)) {
        player.shapes = calloc(player.file.shape_count + 1, sizeof *player.shapes);
        player.ids = calloc(player.file.object_count + 1, sizeof *player.ids);
        if (!player.shapes || !player.ids) {
            fputs("swiftprox-replay: no memory for so many objects\n", stderr);
            result = FAILED;
        } else if ((result = load_shapes(&player)) == GOOD) {
            result = arguments->passes ? print_times(&player) : print_answers(&player);
        }
    }
    for (size_t i = 0; player.shapes && i < player.file.shape_count; i++) {
        swiftprox_shape_release(player.shapes[i]);
    }
    free(player.shapes);
    free(player.ids);
    scene_file_free(&player.file);
    if ((fflush(stdout) != 0 || ferror(stdout)) && result == GOOD) {
        fprintf(stderr, "swiftprox-replay: the output cannot be written: %s\n", strerror(errno));
        return FAILED;
    }
    return result;
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            printf("%s%s", USAGE, HELP);
            return GOOD;
        }
        if (strcmp(argv[i], "--version") == 0) {
            printf("swiftprox-replay %s\n", swiftprox_library_version());
            return GOOD;
        }
    }
    struct arguments arguments;
    return parse_arguments(argc, argv, &arguments) ? run(&arguments) : FAILED;
}
