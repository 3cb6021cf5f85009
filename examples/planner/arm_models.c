#include "arm.h"

#include <math.h>
#include <stdio.h>

/* Frames whose z axis is the former z, the former y, and the former -y axis. */
#define ABOUT_Z {1, 0, 0, 0, 1, 0, 0, 0, 1}
#define ABOUT_Y {1, 0, 0, 0, 0, 1, 0, -1, 0}
#define ABOUT_MINUS_Y {1, 0, 0, 0, 0, -1, 0, 1, 0}

/* A prism with six sides along z, from `low` to `high`. */
static const swiftprox_shape *prism(double radius, double low, double high)
{
    double points[36];
    for (int i = 0; i < 12; i++) {
        const double angle = 1.0471975511965976 * (i % 6);
        points[3 * i] = radius * cos(angle);
        points[3 * i + 1] = radius * sin(angle);
        points[3 * i + 2] = i < 6 ? low : high;
    }
    const swiftprox_shape *shape;
    cell_demand(swiftprox_shape_create_from_points(points, 12, NULL, &shape));
    return shape;
}

static const swiftprox_shape *box(double x, double y, double z, double at_x, double at_y, double at_z)
{
    return cell_box((double[3]){x, y, z}, (double[3]){at_x, at_y, at_z});
}

/* How far a shape reaches from its origin. */
static double reach_of(const swiftprox_shape *shape)
{
    swiftprox_shape_info info = {.struct_size = sizeof info};
    cell_demand(swiftprox_shape_get_info(shape, &info));
    const double *const c = info.centre_of_mass;
    return (sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) + info.radius) * 1.000001;
}

static void add_link(struct arm *arm, struct cell *cell, const swiftprox_shape *shape)
{
    arm->reach[cell->body_count] = reach_of(shape);
    cell_add_body(cell, shape);
}

/* Links that are so many apart in the chain, or more, may meet. */
static void add_pairs_of_links(struct cell *cell, size_t apart)
{
    for (size_t i = 0; i < cell->body_count; i++) {
        for (size_t j = i + apart; j < cell->body_count; j++) {
            cell_add_pair(cell, i, j);
        }
    }
}

void arm_build_cell(struct arm *arm, struct cell *cell)
{
    *cell = (struct cell){.max_distance = 0.005};
    *arm = (struct arm){
        .joint_count = 6,
        .joints = {{{0, 0, 0.25}, ABOUT_Z}, {{0, 0, 0.15}, ABOUT_MINUS_Y}, {{0, 0.55, 0}, ABOUT_Z},
                   {{0, 0.1, 0}, ABOUT_Y}, {{0, 0, 0.4}, ABOUT_MINUS_Y}, {{0, 0.12, 0}, ABOUT_Y}},
        .lowest = {-3, -2, -2.4, -3, -2, -3},
        .highest = {3, 2, 2.4, 3, 2, 3},
        .start = {-0.7, -1.0, -0.7, 0.3, 0.4, 0},
        .goal = {0.7, -1.0, -0.7, -0.3, 0.4, 1},
    };
    add_link(arm, cell, prism(0.11, 0.01, 0.1));
    add_link(arm, cell, box(0.14, 0.5, 0.16, 0, 0.26, 0));
    add_link(arm, cell, box(0.12, 0.12, 0.14, 0, 0.03, 0));
    add_link(arm, cell, prism(0.06, 0.01, 0.32));
    add_link(arm, cell, box(0.09, 0.12, 0.1, 0, 0.03, 0));
    add_link(arm, cell, prism(0.04, 0.02, 0.14));
    add_pairs_of_links(cell, 2);
    cell_add_obstacle(cell, box(3, 3, 0.1, 0, 0, 0), 0, 0, -0.06);
    cell_add_obstacle(cell, box(0.1, 0.1, 0.8, 0, 0, 0), 0.62, 0, 0.4);
    cell_add_obstacle(cell, box(0.1, 0.1, 1.1, 0, 0, 0), -0.5, 0.5, 0.55);
    cell_add_obstacle(cell, box(0.4, 0.5, 0.03, 0, 0, 0), 0.8, 0.65, 1.1);
}

void arm_build_franka(struct arm *arm, struct cell *cell, const char *folder)
{
    /* Denavit and Hartenberg's parameters as Craig has them, of Franka's manual: turn about x, then along x and z. */
    *cell = (struct cell){.max_distance = 0.001};
    *arm = (struct arm){
        .joint_count = 7,
        .joints = {{{0, 0, 0.333}, ABOUT_Z}, {{0, 0, 0}, ABOUT_Y}, {{0, -0.316, 0}, ABOUT_MINUS_Y},
                   {{0.0825, 0, 0}, ABOUT_MINUS_Y}, {{-0.0825, 0.384, 0}, ABOUT_Y}, {{0, 0, 0}, ABOUT_MINUS_Y},
                   {{0.088, 0, 0}, ABOUT_MINUS_Y}},
        .lowest = {-2.7, -1.7, -2.7, -3, -2.7, 0.5, -2.9},
        .highest = {2.7, 1.7, 2.7, -0.1, 2.7, 3.7, 2.9},
        .start = {-0.8, 0.3, 0, -2, 0, 2.2, 0.8},
        .goal = {0.8, 0.3, 0, -2, 0, 2.2, 0.8},
    };
    for (int i = 0; i <= 7; i++) {
        char path[4096];
        const swiftprox_shape *shape;
        snprintf(path, sizeof path, "%s/fer_link%d.off", folder, i);
        cell_demand(swiftprox_shape_create_from_file(path, NULL, &shape));
        if (i == 0) {
            cell_add_obstacle(cell, shape, 0, 0, 0);
        } else {
            add_link(arm, cell, shape);
        }
    }
    /* The first link turns in the base. */
    cell->pair_count = 0;
    for (size_t i = 1; i < cell->body_count; i++) {
        cell->pairs[cell->pair_count++] = (struct cell_pair){.first = i, .second = 0, .is_obstacle = true};
    }
    add_pairs_of_links(cell, 3);
    cell_add_obstacle(cell, box(0.1, 0.1, 0.9, 0, 0, 0), 0.5, 0, 0.45);
    cell_add_obstacle(cell, box(0.5, 0.7, 0.03, 0, 0, 0), 0.6, 0.65, 0.9);
}
