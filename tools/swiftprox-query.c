/* swiftprox-query: two meshes and a file of poses in, one certified answer a line out. It is a user of the C interface like
 * any other, and knows nothing that its headers do not say. */
#include <fenv.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <swiftprox.h>
#include <swiftprox/motion.h>
#include <swiftprox/tuning.h>

#include "input.h"
#include "poses.h"
#include "program.h"
#include "progress.h"

static const char USAGE[] = "usage: swiftprox-query A B POSES [--query contact|distance|intersection|approximate|depth|cast]\n"
                            "                       [--max-distance D] [--time-tolerance T]\n"
                            "                       [--error E] [--start auto|cache|table|cold] [--levels auto|none|quadric|dk|outer]\n"
                            "                       [--input POLICY] [--count N] [--bench PASSES]\n";

static const char HELP[] =
    "\n"
    "Answers proximity queries between the convex polyhedra A and B, one for each line of POSES.\n"
    "\n"
    "  A, B    mesh files: TRI, POLY, OFF, OBJ or STL, recognised by extension, else by content\n"
    "  POSES   one query per line, 24 numbers: the row-major 3x4 [R|T] of A, then of B; blank lines and lines\n"
    "          that start with # are skipped; - is the standard input. What one query learned starts the next.\n"
    "\n"
    "  --query contact       distance, witness points and normal; for objects that touch or intersect the depth, its\n"
    "                        witness points and normal (the default)\n"
    "  --query distance      the same for disjoint objects; the verdict alone for intersecting ones\n"
    "  --query intersection  the verdict alone; lower and upper are not tight\n"
    "  --query approximate   an interval at most --error wide, from levels of detail where they suffice; these give\n"
    "                        no witness points\n"
    "  --query depth         penetration depth; lower and upper bound the depth\n"
    "  --query cast          whether the objects meet between two poses of each, and when: see below\n"
    "  --max-distance D      objects farther apart get a lower bound only; upper is then inf (default: infinite; not\n"
    "                        for depth). For casts: free means farther apart than that (default: 0)\n"
    "  --time-tolerance T    for casts: how wide the interval of a first contact may be (default: 1e-9 of the motion)\n"
    "  --error E             how wide the interval of an approximate answer or of a depth may be (default: as narrow\n"
    "                        as possible); queries contact, approximate and depth\n"
    "  --levels auto         levels of detail where models are so large that they save time, built by the first query\n"
    "                        that they may answer (the default)\n"
    "  --levels none         no levels of detail\n"
    "  --levels quadric      build levels by quadric error simplification, and send all queries through them\n"
    "  --levels dk           the same with levels after Dobkin and Kirkpatrick\n"
    "  --levels outer        the same with levels cut from outside\n"
    "  --start auto          start at the features of the last query while the poses change little, else at the\n"
    "                        entry of the look-up tables (the default)\n"
    "  --start cache         start at the features of the last query, however far the objects moved\n"
    "  --start table         always start at the look-up tables (a model of few vertices has none)\n"
    "  --start cold          always start afresh, without tables\n"
    "                        (--levels and --start: not for the query depth)\n"
    "  --input strict        refuse a mesh that is not closed and convex with an interior (the default)\n"
    "  --input flat          admit bodies without interior as well, such as a two-sided polygon\n"
    "  --input hull          take the convex hull of all vertices, with or without a face\n"
    "  --input patch         take the convex hull of the faces\n"
    "                        (nearly-convex: as flat, up to the precision of the coordinates)\n"
    "  --count N             answer the first N queries only\n"
    "  --bench PASSES        print times instead of answers, see below\n"
    "  --help, --version     print this text, the version\n"
    "\n"
    "Each answer is a line of 15 fields, numbers with 17 significant digits:\n"
    "  distance depth  ax ay az  bx by bz  nx ny nz  lower upper  status steps\n"
    "  distance       best estimate; 0 when the objects touch or intersect\n"
    "  depth          how far A has to move along n, or B against it, to come free (queries contact and depth)\n"
    "  a, b           witness points on A and on B in the world frame; b - a is depth n where the objects intersect\n"
    "  n              unit normal in the world frame, from B to A\n"
    "  lower, upper   the true distance lies between them, rounding included (lower is printed rounded down\n"
    "                 and upper rounded up, so this holds for the printed decimals); both 0 when intersecting\n"
    "  status         how the query was decided: marched, coherent, fallback, exact, spheres: by bounding\n"
    "                 spheres, or tolerance: by levels of detail; a depth: narrow, apart, exact, or stalled, where the\n"
    "                 interval is wider than it could be\n"
    "  steps          number of steps\n"
    "Unset numbers are nan.\n"
    "\n"
    "For casts a line of POSES is 48 numbers: the poses of A and B at time 0, then at time 1. In between each\n"
    "turns about its local origin by the shortest turn, and that moves on a line. Each answer is a line of 6 fields:\n"
    "  outcome time_lower time_upper clearance upper queries\n"
    "  outcome        free: farther apart than max-distance at all times; hit: no farther at time_upper; near: they\n"
    "                 graze, and rounding hides whether they meet; budget: given up\n"
    "  time_lower, time_upper  farther apart than max-distance up to time_lower; the first contact is between the two\n"
    "  clearance      a free pair is at least that far apart at all times\n"
    "  upper          bounds the distance at time_upper for a hit, at time_lower for a near miss\n"
    "  queries        number of queries\n"
    "\n"
    "With --bench the output is one line of two numbers: the best and the median nanoseconds a query over the\n"
    "passes, everything from the 24 numbers to the answer. The poses are read beforehand, one pass runs untimed\n"
    "first, and each pass starts cold.\n"
    "\n"
    "On a terminal the standard error shows a bar while models are built or queries answered for long.\n"
    "\n"
    "Exit status: 0, or 2 when the command line, a mesh or the pose file is bad (the message names the line), or 1 for\n"
    "anything else.\n";

static const struct program PROGRAM = {"swiftprox-query", USAGE, HELP};

/* ---- the command line ---- */

typedef swiftprox_status pair_query(swiftprox_placed, swiftprox_placed, swiftprox_pair_cache *, const swiftprox_pair_config *,
                                    swiftprox_pair_answer *);

struct arguments {
    const char *files[3]; /* A, B, POSES */
    pair_query *query; /* NULL: the depth, or a cast */
    swiftprox_input input;
    swiftprox_start start;
    swiftprox_hierarchy hierarchy;
    swiftprox_levels levels;
    bool cast;
    double max_distance;
    double time_tolerance;
    double error;
    size_t count;
    size_t passes; /* 0: answers, not times */
};

/* Whether each option has a meaning for the query of a name; false after a message. */
static bool fits_the_query(const struct command_line *line, const char *query)
{
    static const struct {
        const char *option;
        const char *queries; /* that it has a meaning for */
    } MEANINGS[] = {{"--error", "contact approximate depth"},
                    {"--levels", "contact distance intersection approximate"},
                    {"--start", "contact distance intersection approximate"},
                    {"--max-distance", "contact distance intersection approximate cast"},
                    {"--time-tolerance", "cast"}};
    for (size_t i = 0; i < sizeof MEANINGS / sizeof *MEANINGS; i++) {
        if (command_line_has(line, MEANINGS[i].option) && !strstr(MEANINGS[i].queries, query)) {
            program_refuse(&PROGRAM, "%s has no meaning for --query %s; it has one for %s", MEANINGS[i].option, query,
                           MEANINGS[i].queries);
            return false;
        }
    }
    return true;
}

/* False if the program is to end with `*status`. */
static bool read_arguments(int argc, char **argv, struct arguments *arguments, int *status)
{
    static const char *const QUERIES[] = {"contact", "distance", "intersection", "approximate", "depth", "cast", NULL};
    static pair_query *const QUERY_FUNCTIONS[] = {swiftprox_pair_contact, swiftprox_pair_distance, swiftprox_pair_intersection,
                                                  swiftprox_pair_approximate, NULL, NULL};
    static const char *const STARTS[] = {"auto", "cache", "table", "cold", NULL};
    static const swiftprox_start START_VALUES[] = {SWIFTPROX_START_AUTOMATIC, SWIFTPROX_START_CACHE, SWIFTPROX_START_TABLE,
                                                   SWIFTPROX_START_COLD};
    static const char *const LEVELS[] = {"auto", "none", "quadric", "dk", "outer", NULL};
    static const swiftprox_hierarchy HIERARCHIES[] = {SWIFTPROX_HIERARCHY_AUTOMATIC, SWIFTPROX_HIERARCHY_NONE,
                                                      SWIFTPROX_HIERARCHY_QUADRIC, SWIFTPROX_HIERARCHY_DOBKIN_KIRKPATRICK,
                                                      SWIFTPROX_HIERARCHY_OUTER_CUTS};
    int query = 0, input = 0, start = 0, levels = 0;
    *arguments = (struct arguments){.count = SIZE_MAX, .max_distance = INFINITY, .time_tolerance = 1e-9};
    struct program_option options[] = {
        {.name = "--query", .kind = OPTION_CHOICE, .choices = QUERIES, .value = &query},
        {.name = "--input", .kind = OPTION_CHOICE, .choices = INPUT_WORDS, .value = &input},
        {.name = "--start", .kind = OPTION_CHOICE, .choices = STARTS, .value = &start},
        {.name = "--levels", .kind = OPTION_CHOICE, .choices = LEVELS, .value = &levels},
        {.name = "--error", .kind = OPTION_AMOUNT, .value = &arguments->error},
        {.name = "--max-distance", .kind = OPTION_AMOUNT, .value = &arguments->max_distance},
        {.name = "--time-tolerance", .kind = OPTION_AMOUNT, .value = &arguments->time_tolerance},
        {.name = "--count", .kind = OPTION_COUNT, .value = &arguments->count},
        {.name = "--bench", .kind = OPTION_COUNT, .value = &arguments->passes},
    };
    struct command_line line = {.program = &PROGRAM,
                                .options = options,
                                .option_count = sizeof options / sizeof *options,
                                .operands = arguments->files,
                                .least_operands = 3,
                                .most_operands = 3,
                                .operands_wanted = "two meshes and a pose file are needed"};
    if (!command_line_read(&line, argc, argv, status)) {
        return false;
    }
    *status = BAD_INPUT;
    arguments->query = QUERY_FUNCTIONS[query];
    arguments->cast = strcmp(QUERIES[query], "cast") == 0;
    if (arguments->cast && !command_line_has(&line, "--max-distance")) {
        arguments->max_distance = 0;
    }
    arguments->input = INPUT_VALUES[input];
    arguments->start = START_VALUES[start];
    arguments->hierarchy = HIERARCHIES[levels];
    arguments->levels = levels < 2 ? SWIFTPROX_LEVELS_AUTOMATIC : SWIFTPROX_LEVELS_ALL;
    return fits_the_query(&line, QUERIES[query]);
}

/* Clock readings are spared, and what is printed between two looks (at most 350 bytes a query) fits the buffer. */
enum { QUERIES_A_LOOK = 64, OUTPUT_BUFFER = 1 << 16 };

/* ---- queries ---- */

struct job {
    const swiftprox_shape *shapes[2];
    struct pose_list poses;
    const char *pose_path;
    pair_query *query; /* NULL: the depth, or a cast */
    swiftprox_pair_config config;
    swiftprox_depth_config depth_config;
    bool cast;
    swiftprox_cast_config cast_config;
};

/* What the pair remembers. */
struct caches {
    swiftprox_pair_cache pair;
    swiftprox_depth_cache depth;
};

struct answer {
    swiftprox_pair_answer pair;
    swiftprox_depth_answer depth;
    swiftprox_cast_answer cast;
};

static swiftprox_status answer_cast(const struct job *job, size_t index, struct caches *caches, struct answer *answer)
{
    const struct pose_pair *begin = &job->poses.pairs[2 * index], *end = begin + 1;
    swiftprox_motion first, second;
    swiftprox_status status = swiftprox_motion_between(begin->first, end->first, NULL, 0, &first, NULL);
    if (status == SWIFTPROX_OK) {
        status = swiftprox_motion_between(begin->second, end->second, NULL, 0, &second, NULL);
    }
    if (status == SWIFTPROX_OK) {
        status = swiftprox_pair_cast((swiftprox_moving){job->shapes[0], &first}, (swiftprox_moving){job->shapes[1], &second},
                                     &caches->pair, &job->cast_config, &answer->cast);
    }
    return status;
}

static swiftprox_status answer_depth(const struct job *job, size_t index, struct caches *caches, struct answer *answer)
{
    const struct pose_pair *pair = &job->poses.pairs[index];
    return swiftprox_pair_depth((swiftprox_placed){job->shapes[0], pair->first},
                                (swiftprox_placed){job->shapes[1], pair->second}, &caches->depth, &job->depth_config,
                                &answer->depth);
}

static swiftprox_status answer_query(const struct job *job, size_t index, struct caches *caches, struct answer *answer)
{
    const struct pose_pair *pair = &job->poses.pairs[index];
    if (job->cast) {
        return answer_cast(job, index, caches, answer);
    }
    if (!job->query) {
        return answer_depth(job, index, caches, answer);
    }
    return job->query((swiftprox_placed){job->shapes[0], pair->first}, (swiftprox_placed){job->shapes[1], pair->second},
                      &caches->pair, &job->config, &answer->pair);
}

/* What the library refused, with the line of the pose file; the exit status. */
static int refused(const struct job *job, size_t index, swiftprox_status status)
{
    fprintf(stderr, "%s:%zu: ", job->pose_path, job->poses.lines[index]);
    program_print_library_message();
    return status == SWIFTPROX_ERROR_POSE ? BAD_INPUT : FAILED;
}

static const char *status_word(swiftprox_decided_by decided_by)
{
    switch (decided_by) {
    case SWIFTPROX_DECIDED_BY_MARCHING:
        return "marched";
    case SWIFTPROX_DECIDED_BY_COHERENCE:
        return "coherent";
    case SWIFTPROX_DECIDED_BY_FALLBACK:
        return "fallback";
    case SWIFTPROX_DECIDED_BY_INTEGERS:
        return "exact";
    case SWIFTPROX_DECIDED_BY_TOLERANCE:
        return "tolerance";
    case SWIFTPROX_DECIDED_BY_BOUNDING_SPHERES:
        return "spheres";
    case SWIFTPROX_DECIDED_BY_INSCRIBED_SPHERES:
        return "inner spheres";
    default:
        return "none";
    }
}

/* The sign bit of a NaN says nothing, but printf shows it. */
static void print_number(double value)
{
    if (isnan(value)) {
        fputs("nan ", stdout);
    } else {
        printf("%.17g ", value);
    }
}

static void print_vector(const double vector[3])
{
    for (int i = 0; i < 3; i++) {
        print_number(vector[i]);
    }
}

/* 17 digits round a double; printf rounds as the floating-point environment says, so that the printed bounds are bounds. */
static void print_rounded(double value, int direction)
{
    const int before = fegetround();
    fesetround(direction);
    print_number(value);
    fesetround(before);
}

static const char *ending_word(swiftprox_depth_ending ending)
{
    switch (ending) {
    case SWIFTPROX_DEPTH_ENDING_NARROW:
        return "narrow";
    case SWIFTPROX_DEPTH_ENDING_SEPARATED:
        return "apart";
    case SWIFTPROX_DEPTH_ENDING_INTEGERS:
        return "exact";
    case SWIFTPROX_DEPTH_ENDING_STALLED:
        return "stalled";
    default:
        return "none";
    }
}

static void print_depth(const swiftprox_depth_answer *answer)
{
    const bool apart = answer->outcome == SWIFTPROX_OUTCOME_SEPARATED;
    const swiftprox_depth_statistics *statistics = &answer->statistics;
    print_number(apart ? NAN : 0); /* distance */
    print_number(answer->depth);
    print_vector(answer->world1);
    print_vector(answer->world2);
    print_vector(answer->normal);
    print_rounded(answer->lower, FE_DOWNWARD);
    print_rounded(answer->upper, FE_UPWARD);
    printf("%s %llu\n", ending_word(answer->ending), (unsigned long long)statistics->steps + statistics->exact_iterations);
}

static void print_cast(const swiftprox_cast_answer *answer)
{
    static const char *const OUTCOMES[] = {"none ", "free ", "hit ", "near ", "budget "};
    fputs(OUTCOMES[answer->outcome], stdout);
    print_rounded(answer->time_lower, FE_DOWNWARD);
    print_rounded(answer->time_upper, FE_UPWARD);
    print_rounded(answer->clearance, FE_DOWNWARD);
    print_rounded(answer->upper, FE_UPWARD);
    printf("%lu\n", (unsigned long)answer->queries);
}

/* `depth` is NULL where none was asked for. */
static void print_answer(const struct job *job, const swiftprox_pair_answer *answer, const swiftprox_depth_answer *depth)
{
    static const double NOTHING[3] = {NAN, NAN, NAN};
    /* The verdict's query needs some direction and says which, but it is not the normal at nearest points. */
    const bool verdict_only = job->query == swiftprox_pair_intersection && answer->outcome == SWIFTPROX_OUTCOME_SEPARATED;
    const swiftprox_statistics *statistics = &answer->statistics;
    print_number(verdict_only ? NAN : answer->distance);
    print_number(depth ? depth->depth : NAN);
    print_vector(verdict_only ? NOTHING : depth ? depth->world1 : answer->world1);
    print_vector(verdict_only ? NOTHING : depth ? depth->world2 : answer->world2);
    print_vector(verdict_only ? NOTHING : depth ? depth->normal : answer->normal);
    print_rounded(answer->lower, FE_DOWNWARD);
    print_rounded(answer->upper, FE_UPWARD);
    printf("%s %llu\n", status_word(answer->decided_by),
           (unsigned long long)statistics->marching_steps + statistics->fallback_iterations + statistics->exact_iterations);
}

static int print_answers(const struct job *job)
{
    const size_t count = job->poses.count;
    struct progress progress = progress_start();
    struct caches caches = {0};
    for (size_t i = 0; i < count; i++) {
        struct answer answer;
        swiftprox_status status = answer_query(job, i, &caches, &answer);
        const bool contact = status == SWIFTPROX_OK && job->query == swiftprox_pair_contact &&
                             answer.pair.outcome == SWIFTPROX_OUTCOME_INTERSECTING;
        if (contact) {
            status = answer_depth(job, i, &caches, &answer);
        }
        if (status != SWIFTPROX_OK) {
            progress_erase(&progress);
            fflush(stdout);
            return refused(job, i, status);
        }
        if (job->cast) {
            print_cast(&answer.cast);
        } else if (job->query) {
            print_answer(job, &answer.pair, contact ? &answer.depth : NULL);
        } else {
            print_depth(&answer.depth);
        }
        if (i % QUERIES_A_LOOK == QUERIES_A_LOOK - 1) {
            progress_look(&progress, i + 1, count);
        }
    }
    progress_erase(&progress);
    return GOOD;
}

static int run_pass(const struct job *job)
{
    struct caches caches = {0};
    struct answer answer;
    for (size_t i = 0; i < job->poses.count; i++) {
        const swiftprox_status status = answer_query(job, i, &caches, &answer);
        if (status != SWIFTPROX_OK) {
            return refused(job, i, status);
        }
    }
    return GOOD;
}

static int ascending(const void *left, const void *right)
{
    const double a = *(const double *)left;
    const double b = *(const double *)right;
    return (a > b) - (a < b);
}

static int print_times(const struct job *job, size_t passes)
{
    if (job->poses.count == 0) {
        fprintf(stderr, "%s: no queries to time\n", job->pose_path);
        return BAD_INPUT;
    }
    double *times = passes <= SIZE_MAX / sizeof *times ? malloc(passes * sizeof *times) : NULL;
    if (!times) {
        fputs("swiftprox-query: no memory for the times of so many passes\n", stderr);
        return FAILED;
    }
    struct progress progress = progress_start();
    int result = run_pass(job);
    for (size_t pass = 0; pass < passes && result == GOOD; pass++) {
        const double start = seconds();
        result = run_pass(job);
        times[pass] = 1e9 * (seconds() - start) / (double)job->poses.count;
        progress_look(&progress, pass + 1, passes);
    }
    progress_erase(&progress);
    if (result == GOOD) {
        qsort(times, passes, sizeof *times, ascending);
        const double median = 0.5 * (times[(passes - 1) / 2] + times[passes / 2]);
        printf("%.17g %.17g\n", times[0], median);
    }
    free(times);
    return result;
}

/* ---- the program ---- */

/* A shape that is being built. */
struct building {
    struct progress progress;
    char name; /* A or B */
};

static int32_t building_look(void *user, double fraction)
{
    struct building *const building = user;
    if (progress_draw(&building->progress, fraction)) {
        fprintf(stderr, "%d %% of %c", (int)(100 * fraction), building->name);
        fflush(stderr);
    }
    return 0;
}

static bool load_shape(const char *path, char name, swiftprox_shape_options options, const swiftprox_shape **shape)
{
    struct building building = {progress_start(), name};
    options.progress = building_look;
    options.progress_user = &building;
    const swiftprox_status status = swiftprox_shape_create_from_file(path, &options, shape);
    progress_erase(&building.progress);
    if (status == SWIFTPROX_OK) {
        return true;
    }
    /* The messages about the file as a file and about the mesh in it name it. */
    const bool named = status == SWIFTPROX_ERROR_FILE || status == SWIFTPROX_ERROR_MESH;
    fprintf(stderr, "%s%s", named ? "" : path, named ? "" : ": ");
    program_print_library_message();
    return false;
}

/* One shape for both objects when both are one file. */
static bool load_shapes(const struct arguments *arguments, const swiftprox_shape *shapes[2])
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_shape_tuning tuning = SWIFTPROX_SHAPE_TUNING_DEFAULT;
    options.input = arguments->input;
    options.tuning = &tuning;
    tuning.hierarchy = arguments->hierarchy;
    if (!load_shape(arguments->files[0], 'A', options, &shapes[0])) {
        return false;
    }
    if (strcmp(arguments->files[0], arguments->files[1]) == 0) {
        shapes[1] = swiftprox_shape_retain(shapes[0]);
        return true;
    }
    return load_shape(arguments->files[1], 'B', options, &shapes[1]);
}

static int run(const struct arguments *arguments)
{
    static char buffer[OUTPUT_BUFFER];
    setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
    const swiftprox_shape *shapes[2] = {NULL, NULL};
    struct job job = {.pose_path = arguments->files[2], .query = arguments->query, .cast = arguments->cast};
    swiftprox_pair_tuning tuning = SWIFTPROX_PAIR_TUNING_DEFAULT;
    tuning.start = arguments->start;
    tuning.levels = arguments->levels;
    job.config = (swiftprox_pair_config)SWIFTPROX_PAIR_CONFIG_DEFAULT;
    job.config.tuning = &tuning;
    job.config.absolute_error = arguments->error;
    job.config.max_distance = arguments->max_distance;
    job.depth_config = (swiftprox_depth_config)SWIFTPROX_DEPTH_CONFIG_DEFAULT;
    job.depth_config.absolute_error = arguments->error;
    job.cast_config = (swiftprox_cast_config)SWIFTPROX_CAST_CONFIG_DEFAULT;
    job.cast_config.time_tolerance = arguments->time_tolerance;
    job.cast_config.max_distance = arguments->max_distance;

    int result = BAD_INPUT;
    if (load_shapes(arguments, shapes) && pose_list_read(job.pose_path, job.cast ? 2 : 1, arguments->count, &job.poses)) {
        job.shapes[0] = shapes[0];
        job.shapes[1] = shapes[1];
        result = arguments->passes ? print_times(&job, arguments->passes) : print_answers(&job);
    }
    pose_list_free(&job.poses);
    swiftprox_shape_release(shapes[0]);
    swiftprox_shape_release(shapes[1]);
    return program_end(&PROGRAM, result);
}

int main(int argc, char **argv)
{
    struct arguments arguments;
    int status;
    return read_arguments(argc, argv, &arguments, &status) ? run(&arguments) : status;
}
