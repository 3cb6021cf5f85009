/* A crowd: 2,000 bodies walk about a square, and two that begin to touch turn away from each other. Who begins and who ends
 * touching in a step is asked of the scene: nobody goes through lists of pairs.
 *
 * Prints the events of each step; the picture shows the last one from above, those in colour that touch somebody. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <swiftprox.h>
#include <swiftprox/scene.h>

#include "program.h"

static const struct program PROGRAM = {
    "crowd",
    "usage: crowd [--svg FILE]\n",
    "\n"
    "Lets 2,000 bodies walk about a square, and prints who begins and who ends touching in each step.\n"
    "\n"
    "  --svg FILE         a picture of the last step, from above\n"
    "  --help, --version  print this text, the version\n",
};

enum { BODIES = 2000, STEPS = 60, KINDS = 4 };

static const double SIDE = 80;   /* of the square */
static const double STRIDE = 0.1; /* a step */

/* Seen from above a body is a polygon with so many corners, half a unit from its middle. */
static const int CORNERS[KINDS] = {3, 4, 5, 8};

struct body {
    double place[2];
    double heading; /* where it goes and what it faces, as an angle */
    int touching;   /* how many others */
};

/* Ends the program where a call failed. */
static void demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "crowd: %s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

/* From 0 to 1, the same every time. */
static double draw(void)
{
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return state / 4294967296.0;
}

/* A corner of a polygon, as seen from above. */
static void find_corner(int corners, int corner, double point[2])
{
    const double angle = 6.283185307179586 * corner / corners;
    point[0] = 0.5 * cos(angle);
    point[1] = 0.5 * sin(angle);
}

/* A column of height 1 over the polygon. */
static const swiftprox_shape *make_shape(int corners)
{
    double points[16][3];
    for (int i = 0; i < 2 * corners; i++) {
        find_corner(corners, i / 2, points[i]);
        points[i][2] = i % 2;
    }
    const swiftprox_shape *shape;
    demand(swiftprox_shape_create_from_points(points[0], (size_t)(2 * corners), NULL, &shape));
    return shape;
}

static void find_pose(const struct body *body, double pose[12])
{
    const double c = cos(body->heading), s = sin(body->heading);
    const double rows[12] = {c, -s, 0, body->place[0], s, c, 0, body->place[1], 0, 0, 1, 0}; /* of [R|T] */
    memcpy(pose, rows, sizeof rows);
}

/* A scene with a body of each kind in turn. The user data of an object is the number of its body. */
static swiftprox_scene *build(struct body *bodies)
{
    const swiftprox_shape *shapes[KINDS];
    swiftprox_scene *scene;
    demand(swiftprox_scene_create(NULL, &scene));
    for (int kind = 0; kind < KINDS; kind++) {
        shapes[kind] = make_shape(CORNERS[kind]);
    }
    for (int i = 0; i < BODIES; i++) {
        bodies[i] = (struct body){{SIDE * draw(), SIDE * draw()}, 6.283185307179586 * draw(), 0};
        swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        swiftprox_object_id id;
        options.user_data = (uint64_t)i;
        find_pose(&bodies[i], options.pose);
        demand(swiftprox_scene_add_object(scene, &shapes[i % KINDS], 1, &options, &id));
    }
    for (int kind = 0; kind < KINDS; kind++) {
        swiftprox_shape_release(shapes[kind]); /* the scene has shares of its own */
    }
    return scene;
}

/* One stride ahead, and back from the edge of the square. */
static void walk(struct body *body)
{
    body->place[0] += STRIDE * cos(body->heading);
    body->place[1] += STRIDE * sin(body->heading);
    const int leaves = body->place[0] < 0 || body->place[0] > SIDE || body->place[1] < 0 || body->place[1] > SIDE;
    if (leaves) {
        body->heading = atan2(0.5 * SIDE - body->place[1], 0.5 * SIDE - body->place[0]);
    }
}

static void turn_away(struct body *body, const struct body *other)
{
    body->heading = atan2(body->place[1] - other->place[1], body->place[0] - other->place[0]);
}

static void move_all(swiftprox_scene *scene, struct body *bodies)
{
    static double poses[12 * BODIES];
    for (int i = 0; i < BODIES; i++) {
        walk(&bodies[i]);
        find_pose(&bodies[i], poses + 12 * i);
    }
    demand(swiftprox_scene_set_poses(scene, NULL, poses, BODIES));
}

/* Applies what has changed. Returns how many more pairs touch than before. */
static long take_events(swiftprox_scene *scene, struct body *bodies, int step)
{
    swiftprox_scene_events events; /* its lists are the scene's, valid until the next query about events */
    demand(swiftprox_scene_query_events(scene, 0, &events));
    for (size_t i = 0; i < events.began_count; i++) {
        struct body *const one = &bodies[events.began[i].user_data1], *const other = &bodies[events.began[i].user_data2];
        one->touching++;
        other->touching++;
        turn_away(one, other);
        turn_away(other, one);
    }
    for (size_t i = 0; i < events.ended_count; i++) {
        bodies[events.ended[i].user_data1].touching--;
        bodies[events.ended[i].user_data2].touching--;
    }
    printf("step %d: %zu began to touch, %zu ended\n", step, events.began_count, events.ended_count);
    return (long)events.began_count - (long)events.ended_count;
}

static int write_picture(const char *path, const struct body *bodies)
{
    static const char *const COLOURS[KINDS] = {"#e69f00", "#56b4e9", "#009e73", "#cc79a7"};
    FILE *const file = fopen(path, "w");
    if (!file) {
        return 0;
    }
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-1 -1 %g %g\" width=\"820\" height=\"820\">\n", SIDE + 2,
            SIDE + 2);
    fprintf(file, "<rect x=\"-1\" y=\"-1\" width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n");
    fprintf(file, "<g stroke=\"#444444\" stroke-width=\"0.04\">\n");
    for (int i = 0; i < BODIES; i++) {
        double pose[12], corner[2];
        find_pose(&bodies[i], pose);
        fprintf(file, "<polygon fill=\"%s\" points=\"", bodies[i].touching ? COLOURS[i % KINDS] : "#e8e8e8");
        for (int k = 0; k < CORNERS[i % KINDS]; k++) {
            find_corner(CORNERS[i % KINDS], k, corner);
            fprintf(file, "%.2f,%.2f ", pose[0] * corner[0] + pose[1] * corner[1] + pose[3],
                    pose[4] * corner[0] + pose[5] * corner[1] + pose[7]);
        }
        fprintf(file, "\"/>\n");
    }
    fprintf(file, "</g>\n</svg>\n");
    return fclose(file) == 0;
}

int main(int argc, char **argv)
{
    static struct body bodies[BODIES];
    const char *svg = NULL;
    struct program_option options[] = {{.name = "--svg", .kind = OPTION_OUTPUT, .value = &svg}};
    struct command_line line = {.program = &PROGRAM, .options = options, .option_count = 1};
    int status;
    if (!command_line_read(&line, argc, argv, &status)) {
        return status;
    }
    swiftprox_scene *const scene = build(bodies);
    long touching = 0;
    for (int step = 0; step < STEPS; step++) {
        move_all(scene, bodies);
        touching += take_events(scene, bodies, step);
    }
    /* The events add up to the present state. */
    swiftprox_scene_answer answer;
    demand(swiftprox_scene_query_intersection(scene, NULL, &answer));
    printf("%ld pairs touch in the end\n", touching);
    const int right = answer.count == (size_t)touching;
    demand(swiftprox_scene_destroy(scene));
    if (svg && !write_picture(svg, bodies)) {
        fprintf(stderr, "crowd: %s cannot be written\n", svg);
        return FAILED;
    }
    return program_end(&PROGRAM, right ? GOOD : FAILED);
}
