/* Scenes as text: what there is, and what moves step by step.
 *
 *   # swiftprox scene 1            the first line; other lines that start with # are comments, blank ones are skipped
 *   shape NAME FILE                a mesh file, relative to the folder of this one
 *   object NAME [fixed]            an object of that shape, numbered from 0, at the identity until it moves
 *   step                           a step: the lines that follow are the objects that move in it
 *   NUMBER r11 r12 r13 x ...       the object and its pose, the row-major 3x4 [R|T] */
#ifndef SWIFTPROX_TOOLS_SCENE_FILE_H
#define SWIFTPROX_TOOLS_SCENE_FILE_H

#include <stdbool.h>
#include <stddef.h>

struct scene_shape {
    char *name;
    char *path; /* as it is to be opened */
    size_t line;
};

struct scene_object {
    size_t shape;
    bool fixed;
};

struct scene_move {
    size_t object;
    double pose[12];
    size_t line;
};

struct scene_step {
    size_t first_move; /* its moves end where those of the next step begin */
};

struct scene_file {
    struct scene_shape *shapes;
    size_t shape_count;
    struct scene_object *objects;
    size_t object_count;
    struct scene_move *moves;
    size_t move_count;
    struct scene_step *steps;
    size_t step_count;
};

/* Reads a file, or the standard input when `path` is "-". On failure it prints a message with the line on the standard error
 * and returns false; release the scene with scene_file_free in either case. */
bool scene_file_read(const char *path, struct scene_file *scene);

/* The move behind the last one of a step. */
size_t scene_file_moves_end(const struct scene_file *scene, size_t step);

void scene_file_free(struct scene_file *scene);

#endif
