#include "report.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "picture.h"
#include "program.h"

/* The smallest body is 0.1 high: what has moved by half of that has left its place. */
static const double FALLEN = 0.05;

/* It has the engine's name. */
static struct program program = {
    "",
    "usage: mujoco_compare|bullet_compare|dart_compare [--quick] [FOLDER]\n",
    "\n"
    "Plays scenes in an engine, with its own collider and with swiftprox in turn. Fails if one falls that is to stand.\n"
    "\n"
    "  FOLDER             where the numbers and a picture of how the scenes end go, engines-NAME.csv and engines-NAME.svg, and of\n"
    "                     MuJoCo the scenes, which its viewer opens\n"
    "  --quick            two simulated seconds, not ten\n"
    "  --help, --version  print this text, the version\n",
};

/* Writes an engine's name in small letters; `room` is at least 1. */
static void write_small(const char *engine, char *small, size_t room)
{
    size_t i = 0;
    for (; engine[i] && i + 1 < room; i++) {
        small[i] = (char)tolower((unsigned char)engine[i]);
    }
    small[i] = '\0';
}

bool report_begin(struct report *report, const char *engine, int argc, char **argv, int *status)
{
    static char small[16], name[32];
    write_small(engine, small, sizeof small);
    snprintf(name, sizeof name, "%s_compare", small);
    program.name = name;
    *report = (struct report){.engine = engine};
    struct program_option options[] = {{.name = "--quick", .kind = OPTION_FLAG, .value = &report->is_quick}};
    struct command_line line = {.program = &program, .options = options, .option_count = 1, .operands = &report->folder, .most_operands = 1};
    if (!command_line_read(&line, argc, argv, status)) {
        return false;
    }
    printf("| scene | moved, m: %s | swiftprox | energy, J: %s | swiftprox | contacts: %s | swiftprox | step, us: %s | swiftprox |\n"
           "|---|--:|--:|--:|--:|--:|--:|--:|--:|\n", engine, engine, engine, engine);
    return true;
}

/* How far the body that moved most is from where it began. */
static double motion(const struct scene *scene, const struct run *run)
{
    double most = 0;
    for (int i = 0; i < scene->count; i++) {
        const double *const was = scene->bodies[i].place, *const pose = run->poses[i];
        most = fmax(most, sqrt(pow(pose[3] - was[0], 2) + pow(pose[7] - was[1], 2) + pow(pose[11] - was[2], 2)));
    }
    return most;
}

/* Whether all bodies have stayed about where they began. */
static bool stands(const struct scene *scene, const struct run *run)
{
    return motion(scene, run) < FALLEN;
}

bool report_stands_as_well(const struct played *played)
{
    const struct scene *const scene = &played->scene;
    const bool falls = played->theirs.is_played && !stands(scene, &played->theirs);
    return !scene->stands || falls || stands(scene, &played->ours);
}

/* Prints two cells of the table. */
static void print_cells(const struct played *played, const char *format, double theirs, double ours)
{
    printf(played->theirs.is_played ? format : " – |", theirs);
    printf(format, ours);
}

void report_add(struct report *report)
{
    const struct played *const played = &report->played[report->count++];
    const struct run *const theirs = &played->theirs, *const ours = &played->ours;
    printf("| %s |", played->scene.name);
    print_cells(played, " %.2g |", motion(&played->scene, theirs), motion(&played->scene, ours));
    print_cells(played, " %.1e |", theirs->energy, ours->energy);
    print_cells(played, " %.0f |", theirs->contacts, ours->contacts);
    print_cells(played, " %.0f |", theirs->microseconds, ours->microseconds);
    printf("\n");
    fflush(stdout);
}

/* ---- files ---- */

static void write_row(FILE *file, const char *engine, const struct scene *scene, const char *collider, const struct run *run)
{
    fprintf(file, "%s,%s,%s,%.3g,%.3g,%d,%.1f\n", engine, scene->name, collider, motion(scene, run), run->energy, run->contacts,
            run->microseconds);
}

static void write_csv(FILE *file, const struct report *report)
{
    fputs("engine,scene,collider,moved_m,energy_j,contacts,step_us\n", file);
    for (int i = 0; i < report->count; i++) {
        const struct played *const played = &report->played[i];
        if (played->theirs.is_played) {
            write_row(file, report->engine, &played->scene, "own", &played->theirs);
        }
        write_row(file, report->engine, &played->scene, "swiftprox", &played->ours);
    }
}

/* Writes FOLDER/engines-ENGINE.KIND; false, with a message, when it cannot. */
static bool write_file(const struct report *report, const char *kind, void (*fill)(FILE *file, const struct report *report))
{
    char path[1024], small[16];
    write_small(report->engine, small, sizeof small);
    const int length = snprintf(path, sizeof path, "%s/engines-%s.%s", report->folder, small, kind);
    if (length < 0 || (size_t)length >= sizeof path) {
        fprintf(stderr, "%s: too long a path\n", report->folder);
        return false;
    }
    FILE *const file = fopen(path, "w");
    if (file) {
        fill(file, report);
    }
    const bool is_written = file && !ferror(file);
    if (!file || fclose(file) != 0 || !is_written) {
        fprintf(stderr, "%s: cannot be written: %s\n", path, strerror(errno));
        return false;
    }
    return true;
}

int report_end(const struct report *report, bool is_good)
{
    if (report->folder) {
        is_good = write_file(report, "csv", write_csv) && is_good;
        is_good = write_file(report, "svg", picture_write) && is_good;
    }
    if (!is_good) {
        fprintf(stderr, "%s: a scene fell with swiftprox, or a file was not written\n", report->engine);
    }
    return is_good ? EXIT_SUCCESS : EXIT_FAILURE;
}

/* ---- times ---- */

double report_now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e6 * (double)time.tv_sec + 1e-3 * (double)time.tv_nsec;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double report_median(double *numbers, int count)
{
    qsort(numbers, (size_t)count, sizeof *numbers, by_size);
    return numbers[count / 2];
}
