/* Flies one polyhedron around another, as in the benchmark of the SWIFT paper (Ehmann and Lin, "Accelerated Proximity Queries
 * between Convex Polyhedra by Multi-Level Voronoi Marching", 2000): an elliptic orbit, and a spin of its own.

 * The second model (or a copy of the first) flies around the first one; without models, the shipped samples fly. Of a model that
 * is not convex the convex hull flies. */
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <swiftprox.h>
#include <swiftprox/replay.h>
#include <swiftprox/verify.h>

#include "demo_chart.h"
#include "program.h"

/* The folder of the shipped samples; the build sets it. */
#ifndef DEMO_MODELS
#define DEMO_MODELS "examples/models"
#endif

enum {
    POSES = 3600, /* one orbit in steps of 0.1 degrees */
    ROWS = 12, /* of the table */
    POSES_A_ROW = POSES / ROWS,
    PASSES = 5, /* the best time of each row counts */
    FLIGHTS = 3,
};

/* A little more turn than orbit, so that no relative pose recurs. */
static const double SPIN = 1.118;
static const double PI = 3.14159265358979323846;

struct flight {
    const char *names[2];
    const swiftprox_shape *shapes[2];
    double poses[POSES][2][12];
    swiftprox_pair_answer answers[POSES];
    double distances[POSES];
    double nanoseconds[ROWS]; /* per query */
    char title[512];
    char subtitle[160];
};

/* ---- motion ---- */

/* Rodrigues' formula: the row-major rotation by `angle` about a unit axis. */
static void rotation_about(const double axis[3], double angle, double rotation[9])
{
    const double c = cos(angle);
    const double s = sin(angle);
    const double x = axis[0];
    const double y = axis[1];
    const double z = axis[2];
    const double rows[9] = {
        c + x * x * (1.0 - c),     x * y * (1.0 - c) - z * s, x * z * (1.0 - c) + y * s,
        y * x * (1.0 - c) + z * s, c + y * y * (1.0 - c),     y * z * (1.0 - c) - x * s,
        z * x * (1.0 - c) - y * s, z * y * (1.0 - c) + x * s, c + z * z * (1.0 - c),
    };
    memcpy(rotation, rows, sizeof rows);
}

/* The pose that turns a body about its centre of mass and puts that centre at `place`. */
static void pose_at(const double rotation[9], const double centre[3], const double place[3], double pose[12])
{
    for (int i = 0; i < 3; i++) {
        const double *row = &rotation[3 * i];
        memcpy(&pose[4 * i], row, 3 * sizeof *row);
        pose[4 * i + 3] = place[i] - (row[0] * centre[0] + row[1] * centre[1] + row[2] * centre[2]);
    }
}

static void plan_orbit(struct flight *flight, const swiftprox_shape_info infos[2], double orbit)
{
    static const double ORIGIN[3] = {0.0, 0.0, 0.0};
    static const double TILT_AXIS[3] = {0.6, 0.0, 0.8};
    static const double SPIN_AXIS[3] = {0.48, 0.8, 0.36};
    const double smallest = orbit * (infos[0].radius + infos[1].radius);
    double tilt[9];
    rotation_about(TILT_AXIS, 0.7, tilt);
    for (int i = 0; i < POSES; i++) {
        const double time = 2.0 * PI * i / POSES;
        const double x = smallest * cos(time);
        const double y = 1.5 * smallest * sin(time);
        const double place[3] = {tilt[0] * x + tilt[1] * y, tilt[3] * x + tilt[4] * y, tilt[6] * x + tilt[7] * y};
        double spin[9];
        rotation_about(SPIN_AXIS, SPIN * time, spin);
        pose_at(tilt, infos[0].centre_of_mass, ORIGIN, flight->poses[i][0]);
        pose_at(spin, infos[1].centre_of_mass, place, flight->poses[i][1]);
    }
}

/* ---- queries ---- */

static bool failed(const char *what)
{
    fprintf(stderr, "demo: %s: %s\n", what, swiftprox_library_last_error_message());
    return false;
}

static double nanoseconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

static bool fly(struct flight *flight)
{
    for (int pass = 0; pass < PASSES; pass++) {
        swiftprox_pair_cache cache = {{0}};
        for (int row = 0; row < ROWS; row++) {
            const double start = nanoseconds_now();
            for (int i = row * POSES_A_ROW; i < (row + 1) * POSES_A_ROW; i++) {
                if (swiftprox_pair_distance((swiftprox_placed){flight->shapes[0], flight->poses[i][0]},
                                            (swiftprox_placed){flight->shapes[1], flight->poses[i][1]}, &cache, NULL,
                                            &flight->answers[i]) != SWIFTPROX_OK) {
                    return failed("a query failed");
                }
            }
            const double time = (nanoseconds_now() - start) / POSES_A_ROW;
            if (pass == 0 || time < flight->nanoseconds[row]) {
                flight->nanoseconds[row] = time;
            }
        }
    }
    return true;
}

/* Every answer once more, by a check that shares nothing with the solver. */
static bool verify(const struct flight *flight)
{
    for (int i = 0; i < POSES; i++) {
        if (swiftprox_pair_verify((swiftprox_placed){flight->shapes[0], flight->poses[i][0]},
                                  (swiftprox_placed){flight->shapes[1], flight->poses[i][1]},
                                  &flight->answers[i]) != SWIFTPROX_OK) {
            return failed("an answer does not hold");
        }
    }
    return true;
}

/* Writes down the flight as a scene with a query each degree, for swiftprox-replay. */
static bool record(const struct flight *flight, const char *path)
{
    swiftprox_scene *scene;
    if (swiftprox_scene_create(NULL, &scene) != SWIFTPROX_OK) {
        return failed("no scene");
    }
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.max_distance = INFINITY;
    swiftprox_object_id ids[2];
    bool good = swiftprox_scene_record(scene, path) == SWIFTPROX_OK;
    for (int k = 0; k < 2 && good; k++) {
        good = swiftprox_scene_add_object(scene, &flight->shapes[k], 1, NULL, &ids[k]) == SWIFTPROX_OK;
    }
    for (int i = 0; i < POSES && good; i += POSES / 360) {
        swiftprox_scene_answer answer;
        good = swiftprox_scene_set_pose(scene, ids[0], flight->poses[i][0]) == SWIFTPROX_OK &&
               swiftprox_scene_set_pose(scene, ids[1], flight->poses[i][1]) == SWIFTPROX_OK &&
               swiftprox_scene_query_contact(scene, &query, &answer) == SWIFTPROX_OK;
    }
    good = good && swiftprox_scene_record(scene, NULL) == SWIFTPROX_OK; /* what could not be written comes up here */
    good = good || failed(path);
    return swiftprox_scene_destroy(scene) == SWIFTPROX_OK && good;
}

/* ---- the table ---- */

static unsigned steps_of(const swiftprox_pair_answer *answer)
{
    const swiftprox_statistics *statistics = &answer->statistics;
    return statistics->marching_steps + statistics->fallback_iterations + statistics->exact_iterations;
}

static void describe_feature(const swiftprox_feature *feature, char *text, size_t size)
{
    switch (feature->kind) {
    case SWIFTPROX_FEATURE_KIND_VERTEX:
        snprintf(text, size, "vertex %u", feature->ids[0]);
        break;
    case SWIFTPROX_FEATURE_KIND_EDGE:
        snprintf(text, size, "edge %u-%u", feature->ids[0], feature->ids[1]);
        break;
    case SWIFTPROX_FEATURE_KIND_FACE:
        snprintf(text, size, "face %u", feature->ids[0]);
        break;
    default:
        snprintf(text, size, "-");
    }
}

static void print_row(const struct flight *flight, int row)
{
    const swiftprox_pair_answer *answer = &flight->answers[row * POSES_A_ROW];
    double steps = 0.0;
    for (int i = row * POSES_A_ROW; i < (row + 1) * POSES_A_ROW; i++) {
        steps += steps_of(&flight->answers[i]);
    }
    printf("  %4d", row * 360 / ROWS);
    if (answer->outcome == SWIFTPROX_OUTCOME_INTERSECTING) {
        printf("  %18s  %8s", "intersecting", "");
    } else {
        printf("  %18.15f  %8.1e", answer->distance, answer->upper - answer->lower);
    }
    char features[2][32];
    describe_feature(&answer->feature1, features[0], sizeof features[0]);
    describe_feature(&answer->feature2, features[1], sizeof features[1]);
    printf("  %5.2f  %6.0f  %-14s %s\n", steps / POSES_A_ROW, flight->nanoseconds[row], features[0], features[1]);
}

static void report(struct flight *flight)
{
    double widest = 0.0;
    double nanoseconds = 0.0;
    int intersecting = 0;
    for (int i = 0; i < POSES; i++) {
        const swiftprox_pair_answer *answer = &flight->answers[i];
        flight->distances[i] = answer->distance;
        widest = fmax(widest, answer->upper - answer->lower);
        intersecting += answer->outcome == SWIFTPROX_OUTCOME_INTERSECTING;
    }
    printf("\n%s\n  time           distance     error  steps      ns  features\n", flight->title);
    for (int row = 0; row < ROWS; row++) {
        print_row(flight, row);
        nanoseconds += flight->nanoseconds[row] / ROWS;
    }
    snprintf(flight->subtitle, sizeof flight->subtitle, "%d poses, %d intersecting; widest interval %.1e; %.0f ns a query",
             POSES, intersecting, widest, nanoseconds);
    printf("  %s\n", flight->subtitle);
}

/* ---- the program ---- */

struct arguments {
    const char *models[2];
    const char *svg;
    const char *record; /* null: nothing is recorded */
    double orbit;
};

static const struct program PROGRAM = {
    "demo",
    "usage: demo [--orbit F] [--svg FILE] [--record FILE] [MODEL [MODEL]]\n",
    "\n"
    "The second model (or a copy of the first) flies around the first one; without models, samples fly. Of a model that is not\n"
    "convex its hull flies.\n"
    "\n"
    "  --orbit F          the smallest distance of the two centres, from above 0 to 1e6 (default: 0.8), as a multiple of the\n"
    "                     sum of the two radii\n"
    "  --svg FILE         where the chart of distances over time goes (default: demo.svg)\n"
    "  --record FILE      the first flight, for swiftprox-replay, which shows it by --html\n"
    "  --help, --version  print this text, the version\n",
};

/* False if the program is to end with `*status`. */
static bool read_arguments(int argc, char **argv, struct arguments *arguments, int *status)
{
    *arguments = (struct arguments){.svg = "demo.svg", .orbit = 0.8};
    struct program_option options[] = {
        {.name = "--orbit", .kind = OPTION_AMOUNT, .value = &arguments->orbit},
        {.name = "--svg", .kind = OPTION_OUTPUT, .value = &arguments->svg},
        {.name = "--record", .kind = OPTION_OUTPUT, .value = &arguments->record},
    };
    struct command_line line = {.program = &PROGRAM,
                                .options = options,
                                .option_count = sizeof options / sizeof *options,
                                .operands = arguments->models,
                                .most_operands = 2};
    if (!command_line_read(&line, argc, argv, status)) {
        return false;
    }
    if (!(arguments->orbit > 0.0 && arguments->orbit < 1e6)) {
        *status = program_refuse(&PROGRAM, "--orbit wants a number above 0 and below 1e6");
        return false;
    }
    if (line.operand_count == 1) {
        arguments->models[1] = arguments->models[0];
    }
    return true;
}

/* The file name without its folder. */
static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* The model in a file, or its convex hull if it is not convex; prints which. */
static bool load_shape(const char *path, const swiftprox_shape **shape)
{
    const swiftprox_status status = swiftprox_shape_create_from_file(path, NULL, shape);
    if (status == SWIFTPROX_ERROR_MESH) {
        fprintf(stderr, "demo: %s; its convex hull flies instead\n", swiftprox_library_last_error_message());
        swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
        options.input = SWIFTPROX_INPUT_HULL;
        return swiftprox_shape_create_from_file(path, &options, shape) == SWIFTPROX_OK || failed("cannot load");
    }
    return status == SWIFTPROX_OK || failed("cannot load");
}

static bool load(struct flight *flight, double orbit)
{
    swiftprox_shape_info infos[2];
    if (!load_shape(flight->names[0], &flight->shapes[0])) {
        return false;
    }
    if (strcmp(flight->names[0], flight->names[1]) == 0) { /* any number of bodies may share a shape */
        flight->shapes[1] = swiftprox_shape_retain(flight->shapes[0]);
    } else if (!load_shape(flight->names[1], &flight->shapes[1])) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        infos[i].struct_size = sizeof infos[i];
        if (swiftprox_shape_get_info(flight->shapes[i], &infos[i]) != SWIFTPROX_OK) {
            return failed(flight->names[i]);
        }
    }
    plan_orbit(flight, infos, orbit);
    snprintf(flight->title, sizeof flight->title, "%s (%zu vertices) around %s (%zu vertices)", base_name(flight->names[1]),
             infos[1].vertex_count, base_name(flight->names[0]), infos[0].vertex_count);
    return true;
}

static bool run(struct flight *flights, int count, const struct arguments *arguments)
{
    struct chart_panel panels[FLIGHTS];
    printf("time in degrees of the orbit; error: the true distance lies in an interval of this width;\n"
           "steps and ns: mean over the %d queries of a row, %g degrees apart; features: nearest ones of the body in the\n"
           "middle and of the one that flies\n",
           POSES_A_ROW, 360.0 / POSES);
    for (int i = 0; i < count; i++) {
        struct flight *flight = &flights[i];
        if (!load(flight, arguments->orbit) || !fly(flight) || !verify(flight)) {
            return false;
        }
        report(flight);
        panels[i] = (struct chart_panel){flight->title, flight->subtitle, flight->distances, POSES};
    }
    if (arguments->record && !record(&flights[0], arguments->record)) {
        return false;
    }
    if (!chart_write(arguments->svg, panels, (size_t)count)) {
        fprintf(stderr, "demo: %s: cannot be written: %s\n", arguments->svg, strerror(errno));
        return false;
    }
    printf("\nevery answer was checked again by swiftprox_pair_verify; distances over time: %s\n", arguments->svg);
    return true;
}

int main(int argc, char **argv)
{
    static const char *const SAMPLES[FLIGHTS][2] = {
        {DEMO_MODELS "/ellipsoid.off", DEMO_MODELS "/ellipsoid.off"},
        {DEMO_MODELS "/box.off", DEMO_MODELS "/prism.obj"},
        {DEMO_MODELS "/ellipsoid.off", DEMO_MODELS "/sphere.stl"},
    };
    struct arguments arguments;
    int status;
    if (!read_arguments(argc, argv, &arguments, &status)) {
        return status;
    }
    const int count = arguments.models[0] ? 1 : FLIGHTS;
    struct flight *flights = calloc((size_t)count, sizeof *flights);
    if (!flights) {
        fputs("demo: no memory\n", stderr);
        return FAILED;
    }
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 2; k++) {
            flights[i].names[k] = arguments.models[0] ? arguments.models[k] : SAMPLES[i][k];
        }
    }
    const bool good = run(flights, count, &arguments);
    for (int i = 0; i < count; i++) {
        swiftprox_shape_release(flights[i].shapes[0]);
        swiftprox_shape_release(flights[i].shapes[1]);
    }
    free(flights);
    return program_end(&PROGRAM, good ? GOOD : FAILED);
}
