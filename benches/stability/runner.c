#include "runner.h"
#include <swiftprox/geometry.h>

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

bool run_load_body(const char *path, struct body *body)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_shape_info info;
    options.input = SWIFTPROX_INPUT_HULL;
    info.struct_size = sizeof info;
    if (swiftprox_shape_create_from_file(path, &options, &body->shape) != SWIFTPROX_OK ||
        swiftprox_shape_get_info(body->shape, &info) != SWIFTPROX_OK) {
        fprintf(stderr, "%s: %s\n", path, swiftprox_library_last_error_message());
        return false;
    }
    body->point_count = info.vertex_count;
    body->points = scene_allocate(3 * body->point_count, sizeof *body->points);
    return swiftprox_shape_copy_vertices(body->shape, body->points, NULL, body->point_count) == SWIFTPROX_OK;
}

bool run_load(char *const files[3], struct run *run)
{
    *run = (struct run){0};
    return run_load_body(files[0], &run->bodies[0]) && run_load_body(files[1], &run->bodies[1]) &&
           pose_list_read(files[2], 1, SIZE_MAX, &run->poses);
}

void run_free(struct run *run)
{
    pose_list_free(&run->poses);
    run_free_body(&run->bodies[0]);
    run_free_body(&run->bodies[1]);
}

void run_free_body(struct body *body)
{
    swiftprox_shape_release(body->shape);
    free(body->points);
}
