/* A scene: a prism falls past a ball onto a box that stands still, and each step lists the near pairs. */
#include <stdio.h>
#include <stdlib.h>

#include <swiftprox.h>

#include "program.h"

static const struct program PROGRAM = {
    "scene",
    "usage: scene [FOLDER]\n",
    "\n"
    "Lets a prism fall past a ball onto a box, and prints which of them are near each other in each step.\n"
    "\n"
    "  FOLDER             where the shipped models are (default: examples/models)\n"
    "  --help, --version  print this text, the version\n",
};

enum { STEPS = 5 };

static const char *const NAMES[] = {"box", "ball", "prism"}; /* by user data */

/* Ends the program where a call failed. */
static void demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "scene: %s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

static swiftprox_object_id add(swiftprox_scene *scene, const char *folder, const char *model, uint64_t name, int fixed)
{
    char path[1024];
    const swiftprox_shape *shape;
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_id id;
    snprintf(path, sizeof path, "%s/%s", folder, model);
    options.user_data = name;
    options.fixed = fixed;
    demand(swiftprox_shape_create_from_file(path, NULL, &shape));
    demand(swiftprox_scene_add_object(scene, &shape, 1, &options, &id));
    swiftprox_shape_release(shape); /* the scene has a share of its own */
    return id;
}

static void print_pair(const swiftprox_pair_result *pair)
{
    const swiftprox_pair_answer *answer = &pair->answer;
    printf("  %s and %s: ", NAMES[pair->user_data1], NAMES[pair->user_data2]);
    if (answer->outcome == SWIFTPROX_OUTCOME_INTERSECTING) {
        printf("intersecting\n");
    } else {
        printf("%.3f, normal (%.2f %.2f %.2f)\n", answer->distance, answer->normal[0], answer->normal[1],
               answer->normal[2]);
    }
}

int main(int argc, char **argv)
{
    const char *folder = "examples/models";
    struct command_line line = {.program = &PROGRAM, .operands = &folder, .most_operands = 1};
    int status;
    if (!command_line_read(&line, argc, argv, &status)) {
        return status;
    }
    swiftprox_scene *scene;
    demand(swiftprox_scene_create(NULL, &scene));
    add(scene, folder, "box.off", 0, 1);
    const swiftprox_object_id ball = add(scene, folder, "sphere.stl", 1, 0);
    const swiftprox_object_id prism = add(scene, folder, "prism.obj", 2, 0);

    const double at_the_side[12] = {1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 1}; /* rows of [R|T] */
    demand(swiftprox_scene_set_pose(scene, ball, at_the_side));

    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.max_distance = 1.0; /* pairs farther apart are not reported */

    for (int step = 0; step < STEPS; step++) {
        const double upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        const double place[3] = {0, 0, 3.0 - 0.5 * step};
        demand(swiftprox_scene_set_transform(scene, prism, upright, place));

        swiftprox_scene_answer answer; /* its list is the scene's, valid until its next query */
        demand(swiftprox_scene_query_distance(scene, &query, &answer));
        printf("prism at height %g: %zu near\n", place[2], answer.count);
        for (size_t i = 0; i < answer.count; i++) {
            print_pair(&answer.pairs[i]);
        }
    }
    demand(swiftprox_scene_destroy(scene));
    return program_end(&PROGRAM, GOOD);
}
