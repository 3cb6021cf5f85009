/* A body of convex pieces from files, and a ball that falls on it:  pieces FILE ...
 *
 * Each group of an OBJ file is a piece, as CoACD and V-HACD write them. An OBJ file without groups is one, and so is any other
 * mesh: the files of a collision folder of URDF or MJCF are the pieces of one body. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <swiftprox.h>
#include <swiftprox/compound.h>

enum { MOST_PIECES = 1 << 12, MOST_POINTS = 1 << 20, MOST_LETTERS = 1 << 16 };

static const swiftprox_shape *shapes[MOST_PIECES];
static char names[MOST_PIECES][64];
static size_t piece_count;

/* Ends the program where something is not as it should be. */
static void demand(int is_good, const char *what, const char *why)
{
    if (!is_good) {
        fprintf(stderr, "pieces: %s: %s\n", what, why);
        exit(EXIT_FAILURE);
    }
}

static void check(swiftprox_status status, const char *what)
{
    demand(status == SWIFTPROX_OK, what, swiftprox_library_last_error_message());
}

/* The shape that becomes the next piece. */
static const swiftprox_shape **next_piece(const char *name)
{
    demand(piece_count < MOST_PIECES, name, "there are too many pieces");
    snprintf(names[piece_count], sizeof *names, "%.63s", name);
    return &shapes[piece_count++];
}

/* A piece is the hull of the corners of its group's faces: the faces themselves may be off by what the file rounds. */
static void read_groups(const char *path)
{
    static double vertices[MOST_POINTS][3], corners[MOST_POINTS][3];
    static char line[MOST_LETTERS], name[MOST_LETTERS];
    size_t vertex_count = 0, corner_count = 0;
    FILE *const file = fopen(path, "r");
    demand(file != NULL, path, "it cannot be read");
    strncpy(name, path, sizeof name - 1);
    for (int is_open = 1; is_open;) {
        is_open = fgets(line, sizeof line, file) != NULL;
        if (!is_open || strncmp(line, "o ", 2) == 0 || strncmp(line, "g ", 2) == 0) {
            if (corner_count > 0) {
                check(swiftprox_shape_create_from_points(corners[0], corner_count, NULL, next_piece(name)), name);
            }
            corner_count = 0;
            sscanf(line, "%*s %s", name);
        } else if (strncmp(line, "v ", 2) == 0) {
            double *const v = vertices[vertex_count++];
            demand(vertex_count < MOST_POINTS && sscanf(line, "v %lf %lf %lf", &v[0], &v[1], &v[2]) == 3, path, line);
        } else if (strncmp(line, "f ", 2) == 0) {
            for (char *word = strtok(line + 2, " \r\n"); word; word = strtok(NULL, " \r\n")) {
                const long number = strtol(word, NULL, 10); /* from 1 on, or backwards from the last vertex */
                const size_t vertex = number > 0 ? (size_t)number - 1 : vertex_count - (size_t)-number;
                demand(vertex < vertex_count && corner_count < MOST_POINTS, path, "a face is wrong, or there are too many");
                memcpy(corners[corner_count++], vertices[vertex], sizeof *vertices);
            }
        }
    }
    fclose(file);
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        const char *const ending = strrchr(argv[i], '.');
        if (ending && strcmp(ending, ".obj") == 0) {
            read_groups(argv[i]);
        } else {
            swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
            options.input = SWIFTPROX_INPUT_HULL;
            check(swiftprox_shape_create_from_file(argv[i], &options, next_piece(argv[i])), argv[i]);
        }
    }
    const swiftprox_compound *body, *ball;
    const swiftprox_shape *sphere;
    check(swiftprox_compound_create(shapes, NULL, piece_count, &body), "the body");
    check(swiftprox_shape_create_sphere(0.01, &sphere), "the ball");
    check(swiftprox_compound_create(&sphere, NULL, 1, &ball), "the ball");
    for (size_t i = 0; i < piece_count; i++) {
        printf("piece %zu: %s\n", i, names[i]);
        swiftprox_shape_release(shapes[i]); /* the compound has a share of its own */
    }
    swiftprox_shape_release(sphere);

    /* From height 1 down to 0. */
    swiftprox_motion rest = {.kind = SWIFTPROX_MOTION_KIND_FIXED, .start = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}, fall = rest;
    swiftprox_compound_cache cache = {{0}};
    swiftprox_compound_cast_answer hit;
    fall.kind = SWIFTPROX_MOTION_KIND_SCREW;
    fall.start[11] = 1;
    fall.velocity[2] = -1;
    check(swiftprox_compound_cast((swiftprox_moving_compound){body, &rest}, (swiftprox_moving_compound){ball, &fall}, &cache, NULL,
                                  &hit), "the fall");
    if (hit.answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT) {
        printf("the ball meets %s at height %.3f\n", names[hit.piece1], 1 - hit.answer.time_lower);
    } else {
        printf("the ball falls past\n");
    }
    swiftprox_compound_release(ball);
    swiftprox_compound_release(body);
    return EXIT_SUCCESS;
}
