/* Draws an edge that is proved free: a plank that turns past two posts from above, the times at which the proof has asked where it
 * is, and its distance from the nearer post over time as intervals that hold. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cell.h"
#include "program.h"

enum { POSTS = 2, OUTLINES = 11, PIECES = 60, MOST_TIMES = 1000 };

static const struct program PROGRAM = {
    "certified_edge",
    "usage: certified_edge [--svg FILE]\n",
    "\n"
    "Proves that a plank turns past two posts without touching them, and draws what was asked.\n"
    "\n"
    "  --svg FILE         where it is drawn (default: it is not)\n"
    "  --help, --version  print this text, the version\n",
};

/* The plank and the posts, from above; all are as high. */
static const double PLANK[2] = {2.0, 0.3}, POST = 0.3, HEIGHT = 1;
static const double POSTS_AT[POSTS][2] = {{1.0, 1.25}, {-0.5, -0.98}};

/* From the left to the right, by a third of a turn. */
static const double FROM[3] = {-2.2, 0.25, 1.9}, TO[3] = {2.2, 0.1, -0.35};

/* The times at which the plank was asked for. */
struct asked {
    double times[MOST_TIMES];
    size_t count;
};

static void pose_at(double time, double pose[12])
{
    double at[3];
    for (int k = 0; k < 3; k++) {
        at[k] = FROM[k] + time * (TO[k] - FROM[k]);
    }
    const double c = cos(at[2]), s = sin(at[2]);
    const double rows[12] = {c, -s, 0, at[0], s, c, 0, at[1], 0, 0, 1, 0};
    memcpy(pose, rows, sizeof rows);
}

static void answer_pose(void *user, double time, double *pose)
{
    struct asked *const asked = user;
    if (asked->count < MOST_TIMES) {
        asked->times[asked->count++] = time;
    }
    pose_at(time, pose);
}

/* A point of the plank is at most 1.12 from the middle, which moves straight: it accelerates by w^2 r. Poses are off by some
 * rounding of numbers below 3; 1e-14 is a hundred of them. */
static swiftprox_motion plank_motion(struct asked *asked)
{
    const double turn = TO[2] - FROM[2];
    return (swiftprox_motion){.kind = SWIFTPROX_MOTION_KIND_CALLBACK,
                              .pose = answer_pose,
                              .user = asked,
                              .bend = 1.13 * turn * turn,
                              .rounding = 1e-14};
}

static void build(struct cell *cell)
{
    *cell = (struct cell){.max_distance = 0};
    cell_add_body(cell, cell_box((double[3]){PLANK[0], PLANK[1], HEIGHT}, (double[3]){0, 0, 0}));
    for (int i = 0; i < POSTS; i++) {
        cell_add_obstacle(cell, cell_box((double[3]){POST, POST, HEIGHT}, (double[3]){0, 0, 0}), POSTS_AT[i][0], POSTS_AT[i][1], 0);
    }
}

/* The smallest distance over a part of the time. */
static swiftprox_clearance clearance(struct cell *cell, const swiftprox_motion *motion, double begin, double end)
{
    swiftprox_clearance_config config = SWIFTPROX_CLEARANCE_CONFIG_DEFAULT;
    config.time_begin = begin;
    config.time_end = end;
    swiftprox_clearance least = {.lower = INFINITY, .upper = INFINITY};
    for (int i = 0; i < POSTS; i++) {
        swiftprox_clearance here;
        cell_demand(swiftprox_pair_clearance((swiftprox_moving){cell->bodies[0], motion},
                                             (swiftprox_moving){cell->obstacles[i], &cell->places[i]}, &cell->pairs[i].cache,
                                             &config, &here));
        least.lower = fmin(least.lower, here.lower);
        least.upper = fmin(least.upper, here.upper);
    }
    return least;
}

/* ---- the drawing, in units of a pixel ---- */

enum { WIDTH = 760, LEFT = 60, RIGHT = 730, LOW = 540, HIGH = 370 };

static void draw_box(FILE *svg, const double pose[12], const double sides[2], const char *style)
{
    const double scale = 105, middle[2] = {380, 195};
    fputs("<polygon points=\"", svg);
    for (int i = 0; i < 4; i++) {
        const double x = (i == 1 || i == 2 ? 0.5 : -0.5) * sides[0], y = (i > 1 ? 0.5 : -0.5) * sides[1];
        fprintf(svg, "%.1f,%.1f ", middle[0] + scale * (pose[0] * x + pose[1] * y + pose[3]),
                middle[1] - scale * (pose[4] * x + pose[5] * y + pose[7]));
    }
    fprintf(svg, "\" %s/>\n", style);
}

static void draw_scene(FILE *svg, const struct asked *asked)
{
    double pose[12];
    const double post[2] = {POST, POST};
    for (int i = 0; i < OUTLINES; i++) {
        pose_at((double)i / (OUTLINES - 1), pose);
        draw_box(svg, pose, PLANK, "fill=\"#56b4e9\" fill-opacity=\"0.18\"");
    }
    for (size_t i = 0; i < asked->count; i++) {
        pose_at(asked->times[i], pose);
        draw_box(svg, pose, PLANK, "fill=\"none\" stroke=\"#0072b2\" stroke-width=\"0.7\"");
    }
    for (int i = 0; i < POSTS; i++) {
        const double there[12] = {1, 0, 0, POSTS_AT[i][0], 0, 1, 0, POSTS_AT[i][1], 0, 0, 1, 0};
        draw_box(svg, there, post, "fill=\"#777777\"");
    }
}

static double across(double time)
{
    return LEFT + time * (RIGHT - LEFT);
}

static double up(double distance)
{
    const double most = 2; /* of the axis */
    return LOW - fmin(distance, most) / most * (LOW - HIGH);
}

static void draw_axes(FILE *svg)
{
    fprintf(svg, "<text x=\"%d\" y=\"%d\">least distance from the posts in each sixtieth of the time: between these bounds, no moment left out</text>\n",
            LEFT, HIGH - 14);
    for (int i = 0; i <= 4; i++) {
        fprintf(svg, "<path d=\"M%d %.1fH%d\" stroke=\"#e4e4e4\"/><text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.1f</text>\n", LEFT,
                up(0.5 * i), RIGHT, LEFT - 8, up(0.5 * i) + 4, 0.5 * i);
        fprintf(svg, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">t = %.2f</text>\n", across(0.25 * i), LOW + 34, 0.25 * i);
    }
}

static void draw_clearance(FILE *svg, struct cell *cell, const swiftprox_motion *motion)
{
    for (int i = 0; i < PIECES; i++) {
        const double begin = (double)i / PIECES, end = (double)(i + 1) / PIECES;
        const swiftprox_clearance here = clearance(cell, motion, begin, end);
        const double height = fmax(up(here.lower) - up(here.upper), 2);
        fprintf(svg, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"#0072b2\"/>\n", across(begin), up(here.upper),
                across(end) - across(begin), height);
    }
}

static void draw_times(FILE *svg, const struct asked *asked)
{
    for (size_t i = 0; i < asked->count; i++) {
        fprintf(svg, "<path d=\"M%.1f %dv10\" stroke=\"#d55e00\" stroke-width=\"1.5\"/>\n", across(asked->times[i]), LOW + 4);
    }
}

static bool draw(const char *path, struct cell *cell, const swiftprox_motion *motion, const struct asked *asked, double least)
{
    FILE *const svg = fopen(path, "w");
    if (!svg) {
        fprintf(stderr, "%s: it cannot be written\n", path);
        return false;
    }
    fprintf(svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"12\">\n"
            "<rect width=\"%d\" height=\"%d\" fill=\"white\"/>\n"
            "<text x=\"%d\" y=\"24\" font-size=\"14\">An edge that is proved free: asked at %zu times, never nearer than %.4f</text>\n",
            WIDTH, LOW + 70, WIDTH, LOW + 70, LEFT, asked->count, least);
    draw_scene(svg, asked);
    draw_axes(svg);
    struct asked ignored = {.count = 0};
    swiftprox_motion same = *motion;
    same.user = &ignored;
    draw_clearance(svg, cell, &same);
    draw_times(svg, asked);
    fprintf(svg, "<text x=\"%d\" y=\"%d\">marks and outlines: where the plank was when the proof asked; filled: where it was in between</text>\n",
            LEFT, LOW + 56);
    fputs("</svg>\n", svg);
    const bool is_good = !ferror(svg);
    return fclose(svg) == 0 && is_good;
}

static int by_time(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Each time once; a difference quotient asks for two that no picture tells apart. */
static void sort_times(struct asked *asked)
{
    qsort(asked->times, asked->count, sizeof *asked->times, by_time);
    size_t kept = 0;
    for (size_t i = 0; i < asked->count; i++) {
        if (kept == 0 || asked->times[i] > asked->times[kept - 1] + 1e-5) {
            asked->times[kept++] = asked->times[i];
        }
    }
    asked->count = kept;
}

int main(int argc, char **argv)
{
    const char *path = NULL;
    struct program_option options[] = {{.name = "--svg", .kind = OPTION_OUTPUT, .value = &path}};
    struct command_line line = {.program = &PROGRAM, .options = options, .option_count = 1, .operands_wanted = "no operands"};
    int status;
    if (!command_line_read(&line, argc, argv, &status)) {
        return program_end(&PROGRAM, status);
    }
    struct cell cell;
    struct asked asked = {.count = 0};
    build(&cell);
    const swiftprox_motion motion = plank_motion(&asked);
    const struct cell_edge edge = cell_cast(&cell, &motion);
    sort_times(&asked);
    struct asked ignored = {.count = 0};
    const swiftprox_motion same = plank_motion(&ignored);
    const double least = clearance(&cell, &same, 0, 1).lower;
    printf("%s, asked at %zu times; never nearer than %.4f\n", edge.is_free ? "free" : "not free", asked.count, least);
    status = edge.is_free && cell_prove_free(&cell, &same) ? GOOD : FAILED;
    if (status == GOOD && path) {
        status = draw(path, &cell, &motion, &asked, least) ? GOOD : FAILED;
    }
    cell_release(&cell);
    return program_end(&PROGRAM, status);
}
