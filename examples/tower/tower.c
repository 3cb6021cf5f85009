/* A tower of ten boxes and a pile of hulls from files, under gravity: what contact manifolds are for.
 *
 * Prints how far the tower's boxes have moved after some simulated seconds, and how many contact points were known again from step
 * to step. It fails if a box has moved by a twentieth of its side, or if one point of 500 was not known again. With a noise
 * the coordinates of the tower's corners are off by up to that, and their sides no longer flat. The picture shows
 * both from the side, at four times. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "program.h"
#include "rigid_bodies.h"
#include "strip.h"
#include "vectors.h"

static const struct program PROGRAM = {
    "tower",
    "usage: tower [--svg FILE] [--record FILE] [--seconds COUNT] [--noise LENGTH] [FOLDER]\n",
    "\n"
    "Lets a tower of ten boxes stand and a pile come to rest. Fails if the tower does not stand.\n"
    "\n"
    "  FOLDER             where the shipped models are (default: examples/models)\n"
    "  --svg FILE         pictures from the side, at four times\n"
    "  --record FILE      what swiftprox-replay plays back, and shows by --html\n"
    "  --seconds COUNT    simulated, from 3 on (default: 10)\n"
    "  --noise LENGTH     by how much coordinates of the tower's corners are off, up to (default: 0)\n"
    "  --help, --version  print this text, the version\n",
};

enum { BOXES = 10, STEPS_A_SECOND = 240, REST = 2 };

/* From −1 to 1, the same on every run (Lehmer 1951, with the constants of Park & Miller 1988). */
static double next_random(void)
{
    static uint64_t state = 1;
    state = state * 48271 % 2147483647;
    return 2 * (double)state / 2147483647 - 1;
}

/* A box about its centre, its corners off by up to a noise. */
static const swiftprox_shape *box(double x, double y, double z, double noise)
{
    const double half[3] = {0.5 * x, 0.5 * y, 0.5 * z};
    double corners[8][3];
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) {
            corners[i][k] = (i >> k & 1 ? half[k] : -half[k]) + noise * next_random();
        }
    }
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    if (noise > 1e-6) {
        options.face_noise = noise; /* less is found by default */
    }
    const swiftprox_shape *shape;
    demand(swiftprox_shape_create_from_points(corners[0], 8, &options, &shape));
    return shape;
}

/* A mesh file's body, moved so that its centre of mass is the origin. */
static const swiftprox_shape *model(const char *folder, const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    const swiftprox_shape *there, *centred;
    demand(swiftprox_shape_create_from_file(path, NULL, &there));
    swiftprox_shape_info info;
    info.struct_size = sizeof info;
    demand(swiftprox_shape_get_info(there, &info));
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    for (int k = 0; k < 3; k++) {
        options.translation[k] = -info.centre_of_mass[k];
    }
    demand(swiftprox_shape_create_from_file(path, &options, &centred));
    swiftprox_shape_release(there);
    return centred;
}

static void build(struct world *world, const char *folder, double noise)
{
    const double below[3] = {0, 0, -0.5};
    world_add(world, box(40, 40, 1, 0), below, true);
    for (int i = 0; i < BOXES; i++) {
        const double place[3] = {-5, 0, 0.5 + i};
        world_add(world, box(1, 1, 1, noise), place, false);
    }
    static const char *const MODELS[] = {"prism.obj", "ellipsoid.off", "box.off", "sphere.stl"};
    for (int i = 0; i < 20; i++) {
        const double place[3] = {3 + 2.1 * (i % 2) + 0.23 * (i % 3), 2.1 * (i / 2 % 2) + 0.17 * (i % 5), 1 + 2.1 * (i / 4)};
        world_add(world, model(folder, MODELS[i % 4]), place, false);
    }
}

/* How far the highest of the tower's boxes, or any other, has moved sideways or sunk. */
static double displacement(const struct world *world)
{
    double most = 0;
    for (size_t i = 1; i <= BOXES; i++) {
        const double *const place = world_body(world, i)->place;
        const double off[3] = {place[0] + 5, place[1], place[2] - ((double)i - 0.5)};
        most = fmax(most, sqrt(dot(off, off)));
    }
    return most;
}

int main(int argc, char **argv)
{
    const char *svg = NULL, *record = NULL, *folder = "examples/models";
    double noise = 0;
    size_t seconds = 10;
    struct program_option options[] = {{.name = "--svg", .kind = OPTION_OUTPUT, .value = &svg},
                                       {.name = "--record", .kind = OPTION_OUTPUT, .value = &record},
                                       {.name = "--seconds", .kind = OPTION_COUNT, .most = 3600, .value = &seconds},
                                       {.name = "--noise", .kind = OPTION_AMOUNT, .value = &noise}};
    struct command_line line = {
        .program = &PROGRAM, .options = options, .option_count = 4, .operands = &folder, .most_operands = 1};
    int status;
    if (!command_line_read(&line, argc, argv, &status)) {
        return status;
    }
    if (seconds <= REST) {
        return program_refuse(&PROGRAM, "--seconds wants 3 or more: it takes 2 until all is at rest");
    }
    const int steps = (int)seconds * STEPS_A_SECOND;
    struct world *const world = world_create();
    if (!world) {
        fputs("tower: no memory\n", stderr);
        return EXIT_FAILURE;
    }
    if (record) {
        world_record(world, record);
    }
    build(world, folder, noise);
    struct strip *const strip = strip_create();
    double deepest = 0;
    size_t known = 0, points = 0;
    for (int step = 0; step <= steps; step++) {
        if (step == 0 || step == STEPS_A_SECOND || step == 3 * STEPS_A_SECOND || step == steps) {
            strip_add(strip, world, (double)step / STEPS_A_SECOND);
        }
        if (step < steps) {
            world_step(world, 1.0 / STEPS_A_SECOND);
        }
        const bool is_at_rest = step > REST * STEPS_A_SECOND;
        deepest = is_at_rest ? fmax(deepest, world_depth(world)) : 0;
        if (is_at_rest && step < steps) {
            world_count_points(world, BOXES, &known, &points);
        }
    }
    const double moved = displacement(world);
    printf("after %zu s no box of the tower is farther than %.4f from where it began; no pair is deeper than %.4f\n", seconds,
           moved, deepest);
    printf("of %zu contact points of the tower at rest %zu were known from the step before\n", points, known);
    const bool written = !svg || strip_write(strip, svg);
    if (!written) {
        perror(svg);
    }
    strip_destroy(strip);
    world_destroy(world);
    const bool stands = moved < 0.05 && 500 * (points - known) <= points && points > 0;
    return program_end(&PROGRAM, stands && written ? GOOD : FAILED);
}
