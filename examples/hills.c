/* Hills in a scene: boxes come down on a ground of 128 triangles, and each step asks once what they rest on. */
#include <stdio.h>
#include <stdlib.h>

#include <swiftprox.h>
#include <swiftprox/ground.h>
#include <swiftprox/sets.h>

#include "program.h"

static const struct program PROGRAM = {
    "hills",
    "usage: hills\n",
    "\n"
    "Lets four boxes come down on hills, a grid of heights, and prints what they rest on in each step.\n"
    "\n"
    "  --help, --version  print this text, the version\n",
};

enum { STEPS = 4, SIDE = 9, BOXES = 4 };

/* Ends the program where a call failed. */
static void demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "hills: %s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

/* Four hills of height 1 on 8 by 8 squares of side 2. */
static void add_hills(swiftprox_scene *scene)
{
    double heights[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double x = (i % SIDE) % 4 / 2.0 - 1, y = (i / SIDE) % 4 / 2.0 - 1; /* -1 to 1 over each hill */
        heights[i] = (1 - x * x) * (1 - y * y);
    }
    const swiftprox_ground *ground;
    demand(swiftprox_ground_create_from_heights(SIDE, SIDE, 2, 2, heights, &ground));

    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    options.ground = ground;
    swiftprox_object_id hills;
    demand(swiftprox_scene_add_object(scene, NULL, 0, &options, &hills)); /* at its origin, until swiftprox_scene_set_pose */
    swiftprox_ground_release(ground);                                     /* the scene has a share of its own */
}

/* Boxes of side 1 in two rows. */
static void add_boxes(swiftprox_scene *scene, swiftprox_object_id *ids)
{
    double corners[24];
    for (int i = 0; i < 24; i++) {
        corners[i] = (i / 3) >> (i % 3) & 1 ? 0.5 : -0.5;
    }
    const swiftprox_shape *box;
    demand(swiftprox_shape_create_from_points(corners, 8, NULL, &box));
    for (int i = 0; i < BOXES; i++) {
        swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        options.user_data = (uint64_t)i;
        demand(swiftprox_scene_add_object(scene, &box, 1, &options, &ids[i]));
    }
    swiftprox_shape_release(box);
}

static void print_contacts(const swiftprox_scene *scene, swiftprox_scratch *scratch)
{
    swiftprox_scene_ground_config config = SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT;
    config.max_distance = 0.05;
    config.reduces = 1; /* four points of a contact are enough */

    const swiftprox_placed_ground own = {NULL, NULL}; /* the scene's grounds */
    swiftprox_scene_ground_answer answer;
    demand(swiftprox_scene_ground_contacts(scene, NULL, own, &config, scratch, &answer));
    for (size_t i = 0; i < answer.contact_count; i++) {
        const swiftprox_scene_ground_contact *found = &answer.contacts[i];
        const swiftprox_manifold *manifold = &found->contact.manifold;
        const swiftprox_manifold_point *points = &answer.points[found->contact.first_point];
        printf("  box %d on triangle %u: %u points, the first at (%.2f %.2f %.2f), normal (%.2f %.2f %.2f)\n",
               (int)found->user_data, (unsigned)found->contact.triangle, (unsigned)manifold->point_count,
               points[0].world1[0], points[0].world1[1], points[0].world1[2], manifold->normal[0], manifold->normal[1],
               manifold->normal[2]);
    }
}

int main(int argc, char **argv)
{
    struct command_line line = {.program = &PROGRAM};
    int status;
    if (!command_line_read(&line, argc, argv, &status)) {
        return status;
    }
    swiftprox_scene *scene;
    swiftprox_scratch *scratch;
    swiftprox_object_id ids[BOXES];
    demand(swiftprox_scene_create(NULL, &scene));
    demand(swiftprox_scratch_create(&scratch));
    add_hills(scene);
    add_boxes(scene, ids);

    for (int step = 0; step < STEPS; step++) {
        const double height = 1.56 - 0.02 * step;
        for (int i = 0; i < BOXES; i++) {
            const double pose[12] = {1, 0, 0, 4.2 + 8 * (i % 2), 0, 1, 0, 3.8 + 8 * (i / 2), 0, 0, 1, height};
            demand(swiftprox_scene_set_pose(scene, ids[i], pose));
        }
        demand(swiftprox_scene_prepare(scene)); /* trees find the near objects */
        printf("height %.2f\n", height);
        print_contacts(scene, scratch);
    }
    swiftprox_scratch_destroy(scratch);
    demand(swiftprox_scene_destroy(scene));
    return EXIT_SUCCESS;
}
