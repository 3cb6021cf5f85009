/* A pile of boxes, hulls and drums that falls on hills, a ground of 20,000 triangles, and comes to rest there.
 *
 * Prints how fast the fastest body is in the end, and how deep any pair is. It fails where a body has fallen through the hills. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "program.h"
#include "rigid_bodies.h"
#include "vectors.h"

static const struct program PROGRAM = {
    "pile",
    "usage: pile [--record FILE]\n",
    "\n"
    "Lets a pile of boxes, hulls and drums fall on hills. Fails if a body falls through them.\n"
    "\n"
    "  --record FILE      what swiftprox-replay plays back, and shows by --html\n"
    "  --help, --version  print this text, the version\n",
};

enum { BODIES = 48, SECONDS = 4, STEPS_A_SECOND = 120, SIDE = 101, SIDES = 20, MOST_POINTS = 2 * SIDES };

static const double CELL = 0.3, TURN = 6.283185307179586;

/* From 0 to 1, the same on every run (Lehmer 1951, with the constants of Park & Miller 1988). */
static double next_random(void)
{
    static uint64_t state = 1;
    state = state * 48271 % 2147483647;
    return (double)state / 2147483647;
}

/* Hills around a hollow in which the pile comes to rest. */
static double height_at(double x, double y)
{
    const double far = sqrt(x * x + y * y);
    return 1.1 * sin(0.5 * x + 0.6) * cos(0.45 * y - 0.4) + 0.35 * sin(1.1 * x + 0.8 * y) + 0.02 * far * far;
}

static const swiftprox_ground *make_hills(void)
{
    static double heights[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        heights[i] = height_at(CELL * (i % SIDE - SIDE / 2), CELL * (i / SIDE - SIDE / 2));
    }
    const swiftprox_ground *corner, *hills;
    demand(swiftprox_ground_create_from_heights(SIDE, SIDE, CELL, CELL, heights, &corner));
    const double pose[12] = {1, 0, 0, -CELL * (SIDE / 2), 0, 1, 0, -CELL * (SIDE / 2), 0, 0, 1, 0};
    demand(swiftprox_ground_create_from_grounds(&corner, pose, 1, &hills));
    swiftprox_ground_release(corner);
    return hills;
}

/* The hull of points about its centre of mass. */
static const swiftprox_shape *hull(const double *points, size_t count)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_shape_info info = {.struct_size = sizeof info};
    const swiftprox_shape *there, *centred;
    options.input = SWIFTPROX_INPUT_HULL;
    demand(swiftprox_shape_create_from_points(points, count, &options, &there));
    demand(swiftprox_shape_get_info(there, &info));
    for (int k = 0; k < 3; k++) {
        options.translation[k] = -info.centre_of_mass[k];
    }
    demand(swiftprox_shape_create_from_points(points, count, &options, &centred));
    swiftprox_shape_release(there);
    return centred;
}

/* A box, a drum, or the hull of points on an ellipsoid. */
static const swiftprox_shape *make_shape(int kind)
{
    const double half[3] = {0.3 + 0.3 * next_random(), 0.3 + 0.2 * next_random(), 0.25 + 0.2 * next_random()};
    double points[MOST_POINTS][3];
    const int counts[3] = {8, 2 * SIDES, 22};
    for (int i = 0; i < counts[kind]; i++) {
        const double angle = TURN * (i / 2) / SIDES, z = 2 * next_random() - 1, around = TURN * next_random();
        const double of_kind[3][3] = {{i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1},
                                      {1.2 * cos(angle), 1.2 * half[0] / half[1] * sin(angle), i & 1 ? 1.2 : -1.2},
                                      {sqrt(1 - z * z) * cos(around), sqrt(1 - z * z) * sin(around), z}};
        for (int k = 0; k < 3; k++) {
            points[i][k] = (kind == 2 ? 1.3 : 1) * half[k] * of_kind[kind][k];
        }
    }
    return hull(points[0], (size_t)counts[kind]);
}

static void build(struct world *world)
{
    world_add_ground(world, make_hills());
    for (int i = 0; i < BODIES; i++) {
        const double place[3] = {1.7 * (i % 4 - 1.5) + 0.4 * next_random(), 1.7 * (i / 4 % 4 - 1.5) + 0.4 * next_random(),
                                 3 + 1.7 * (i / 16)};
        world_add(world, make_shape(i % 3), place, false);
    }
}

int main(int argc, char **argv)
{
    const char *record = NULL;
    struct program_option options[] = {{.name = "--record", .kind = OPTION_OUTPUT, .value = &record}};
    struct command_line line = {.program = &PROGRAM, .options = options, .option_count = 1};
    int status;
    if (!command_line_read(&line, argc, argv, &status)) {
        return status;
    }
    struct world *const world = world_create();
    if (!world) {
        fputs("pile: no memory\n", stderr);
        return EXIT_FAILURE;
    }
    if (record) {
        world_record(world, record);
    }
    build(world);
    for (int step = 0; step < SECONDS * STEPS_A_SECOND; step++) {
        world_step(world, 1.0 / STEPS_A_SECOND);
    }
    double fastest = 0;
    bool is_above = true;
    for (size_t i = 0; i < world_body_count(world); i++) {
        const struct body *const body = world_body(world, i);
        fastest = fmax(fastest, sqrt(dot(body->velocity, body->velocity)));
        is_above = is_above && body->place[2] > height_at(body->place[0], body->place[1]);
    }
    printf("after %d s the fastest body moves by %.2f a second; no pair is deeper than %.3f\n", SECONDS, fastest, world_depth(world));
    world_destroy(world);
    return program_end(&PROGRAM, is_above ? GOOD : FAILED);
}
