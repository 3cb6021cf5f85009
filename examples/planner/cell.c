#include "cell.h"
#include <swiftprox/verify.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cell_demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "%s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

const swiftprox_shape *cell_box(const double sides[3], const double centre[3])
{
    double corners[24];
    for (int i = 0; i < 24; i++) {
        const int corner = i / 3, axis = i % 3;
        corners[i] = centre[axis] + (corner >> axis & 1 ? 0.5 : -0.5) * sides[axis];
    }
    const swiftprox_shape *box;
    cell_demand(swiftprox_shape_create_from_points(corners, 8, NULL, &box));
    return box;
}

static void add_pair(struct cell *cell, size_t first, size_t second, bool is_obstacle)
{
    struct cell_pair *const pair = &cell->pairs[cell->pair_count++];
    memset(pair, 0, sizeof *pair);
    pair->first = first;
    pair->second = second;
    pair->is_obstacle = is_obstacle;
}

void cell_add_body(struct cell *cell, const swiftprox_shape *shape)
{
    cell->bodies[cell->body_count] = shape;
    for (size_t i = 0; i < cell->obstacle_count; i++) {
        add_pair(cell, cell->body_count, i, true);
    }
    cell->body_count++;
}

void cell_add_obstacle(struct cell *cell, const swiftprox_shape *shape, double x, double y, double z)
{
    const double pose[12] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z};
    swiftprox_motion *const place = &cell->places[cell->obstacle_count];
    memset(place, 0, sizeof *place);
    place->kind = SWIFTPROX_MOTION_KIND_FIXED;
    memcpy(place->start, pose, sizeof pose);
    cell->obstacles[cell->obstacle_count] = shape;
    for (size_t i = 0; i < cell->body_count; i++) {
        add_pair(cell, i, cell->obstacle_count, true);
    }
    cell->obstacle_count++;
}

void cell_add_pair(struct cell *cell, size_t first, size_t second)
{
    add_pair(cell, first, second, false);
}

static const swiftprox_shape *second_shape(const struct cell *cell, const struct cell_pair *pair)
{
    return pair->is_obstacle ? cell->obstacles[pair->second] : cell->bodies[pair->second];
}

/* A lower bound of the distance of a pair; beyond `enough` it is no more than that. */
static double distance(struct cell *cell, struct cell_pair *pair, const double *poses, double enough)
{
    const double *const second = pair->is_obstacle ? cell->places[pair->second].start : poses + 12 * pair->second;
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    config.max_distance = enough;
    swiftprox_pair_answer answer;
    cell_demand(swiftprox_pair_distance((swiftprox_placed){cell->bodies[pair->first], poses + 12 * pair->first},
                                        (swiftprox_placed){second_shape(cell, pair), second}, &pair->cache, &config, &answer));
    return answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING ? 0 : answer.lower;
}

bool cell_is_free(struct cell *cell, const double *poses)
{
    for (size_t i = 0; i < cell->pair_count; i++) {
        if (!(distance(cell, &cell->pairs[i], poses, cell->max_distance) > cell->max_distance)) {
            return false;
        }
    }
    return true;
}

double cell_clearance(struct cell *cell, const double *poses)
{
    double least = INFINITY;
    for (size_t i = 0; i < cell->pair_count; i++) {
        least = fmin(least, distance(cell, &cell->pairs[i], poses, least));
    }
    return least;
}

static swiftprox_cast_config cast_config(const struct cell *cell)
{
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    config.max_distance = cell->max_distance;
    config.time_tolerance = 1e-6;
    return config;
}

static swiftprox_cast_answer cast(struct cell *cell, struct cell_pair *pair, const swiftprox_motion *motions,
                                  const swiftprox_cast_config *config)
{
    const swiftprox_motion *const second = pair->is_obstacle ? &cell->places[pair->second] : &motions[pair->second];
    swiftprox_cast_answer answer;
    cell_demand(swiftprox_pair_cast((swiftprox_moving){cell->bodies[pair->first], &motions[pair->first]},
                                    (swiftprox_moving){second_shape(cell, pair), second}, &pair->cache, config, &answer));
    return answer;
}

/* A pair that was not free is asked first of the next edge: it often is not free there, either. */
static void put_first(struct cell *cell, size_t index)
{
    const struct cell_pair pair = cell->pairs[index];
    cell->pairs[index] = cell->pairs[0];
    cell->pairs[0] = pair;
}

struct cell_edge cell_cast(struct cell *cell, const swiftprox_motion *motions)
{
    swiftprox_cast_config config = cast_config(cell);
    struct cell_edge edge = {true, INFINITY, 1, NAN};
    for (size_t i = 0; i < cell->pair_count; i++) {
        const swiftprox_cast_answer answer = cast(cell, &cell->pairs[i], motions, &config);
        if (answer.outcome == SWIFTPROX_CAST_OUTCOME_FREE) {
            edge.clearance = fmin(edge.clearance, answer.clearance);
            continue;
        }
        /* A hit, a near miss or a budget that ran out; of the others only what comes before counts. */
        edge.is_free = false;
        edge.clearance = NAN;
        edge.time_lower = answer.time_lower;
        edge.time_upper = answer.time_upper;
        config.time_end = answer.time_lower;
        put_first(cell, i);
        if (config.time_end <= config.time_begin) {
            break;
        }
    }
    return edge;
}

bool cell_is_edge_free(struct cell *cell, const swiftprox_motion *motions)
{
    const swiftprox_cast_config config = cast_config(cell);
    for (size_t i = 0; i < cell->pair_count; i++) {
        if (cast(cell, &cell->pairs[i], motions, &config).outcome != SWIFTPROX_CAST_OUTCOME_FREE) {
            put_first(cell, i);
            return false;
        }
    }
    return true;
}

bool cell_prove_free(struct cell *cell, const swiftprox_motion *motions)
{
    const swiftprox_cast_config config = cast_config(cell);
    for (size_t i = 0; i < cell->pair_count; i++) {
        struct cell_pair *const pair = &cell->pairs[i];
        const swiftprox_motion *const second = pair->is_obstacle ? &cell->places[pair->second] : &motions[pair->second];
        const swiftprox_cast_answer answer = cast(cell, pair, motions, &config);
        if (answer.outcome != SWIFTPROX_CAST_OUTCOME_FREE
            || swiftprox_pair_cast_verify((swiftprox_moving){cell->bodies[pair->first], &motions[pair->first]},
                                          (swiftprox_moving){second_shape(cell, pair), second}, &config, &answer)
                   != SWIFTPROX_OK) {
            return false;
        }
    }
    return true;
}

void cell_release(struct cell *cell)
{
    for (size_t i = 0; i < cell->body_count; i++) {
        swiftprox_shape_release(cell->bodies[i]);
    }
    for (size_t i = 0; i < cell->obstacle_count; i++) {
        swiftprox_shape_release(cell->obstacles[i]);
    }
}
