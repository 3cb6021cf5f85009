#include "page_ground.h"

#include <math.h>
#include <stdlib.h>

/* Some triangles of a ground. */
enum { SLICE = 256 };

struct slice {
    size_t count;
    uint32_t corners[SLICE][3];
    double points[SLICE][3][3];
};

/* The next triangles from number `*first` on; none behind the last. Those that the ground skips are left out. */
static swiftprox_status next_slice(const swiftprox_ground *ground, size_t *first, struct slice *slice)
{
    swiftprox_ground_info info;
    slice->count = 0;
    swiftprox_status status = swiftprox_ground_get_info(ground, &info);
    while (status == SWIFTPROX_OK && slice->count == 0 && *first < info.triangle_count) {
        const size_t left = info.triangle_count - *first, count = left < SLICE ? left : SLICE;
        status = swiftprox_ground_copy_triangles(ground, *first, count, slice->points[0][0], slice->corners[0]);
        for (size_t i = 0; i < count && status == SWIFTPROX_OK; i++) {
            if (slice->corners[i][0] != slice->corners[i][1]) {
                for (int k = 0; k < 3; k++) {
                    slice->corners[slice->count][k] = slice->corners[i][k];
                    for (int axis = 0; axis < 3; axis++) {
                        slice->points[slice->count][k][axis] = slice->points[i][k][axis];
                    }
                }
                slice->count++;
            }
        }
        *first += count;
    }
    return status;
}

swiftprox_status page_ground_measure(const swiftprox_ground *ground, swiftprox_shape_info *info)
{
    swiftprox_ground_info of_ground;
    struct slice slice;
    size_t first = 0;
    double lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY};
    swiftprox_status status = swiftprox_ground_get_info(ground, &of_ground);
    info->vertex_count = of_ground.vertex_count;
    info->triangle_count = 0;
    while (status == SWIFTPROX_OK && (status = next_slice(ground, &first, &slice)) == SWIFTPROX_OK && slice.count > 0) {
        info->triangle_count += slice.count;
        for (size_t i = 0; i < 9 * slice.count; i++) {
            const double x = slice.points[i / 9][i / 3 % 3][i % 3];
            lower[i % 3] = fmin(lower[i % 3], x);
            upper[i % 3] = fmax(upper[i % 3], x);
        }
    }
    double square = 0;
    for (int axis = 0; axis < 3; axis++) {
        info->centre_of_mass[axis] = 0.5 * (lower[axis] + upper[axis]);
        square += 0.25 * (upper[axis] - lower[axis]) * (upper[axis] - lower[axis]);
    }
    info->radius = sqrt(square);
    return status;
}

swiftprox_status page_ground_write_vertices(const swiftprox_ground *ground, const swiftprox_shape_info *info, struct base64 *block)
{
    struct slice slice;
    size_t first = 0;
    float(*const vertices)[3] = calloc(info->vertex_count, sizeof *vertices);
    swiftprox_status status = vertices ? SWIFTPROX_OK : SWIFTPROX_ERROR_MEMORY;
    while (status == SWIFTPROX_OK && (status = next_slice(ground, &first, &slice)) == SWIFTPROX_OK && slice.count > 0) {
        for (size_t i = 0; i < 9 * slice.count; i++) {
            const size_t triangle = i / 9, corner = i / 3 % 3, axis = i % 3;
            vertices[slice.corners[triangle][corner]][axis] =
                (float)(slice.points[triangle][corner][axis] - info->centre_of_mass[axis]);
        }
    }
    for (size_t i = 0; i < 3 * info->vertex_count && status == SWIFTPROX_OK; i++) {
        base64_add_float(block, vertices[i / 3][i % 3]);
    }
    free(vertices);
    return status;
}

swiftprox_status page_ground_write_triangles(const swiftprox_ground *ground, struct base64 *block)
{
    struct slice slice;
    size_t first = 0;
    swiftprox_status status;
    while ((status = next_slice(ground, &first, &slice)) == SWIFTPROX_OK && slice.count > 0) {
        for (size_t i = 0; i < 3 * slice.count; i++) {
            base64_add_32(block, slice.corners[i / 3][i % 3]);
        }
    }
    return status;
}

swiftprox_status page_ground_find_points(swiftprox_placed body, swiftprox_placed_ground ground, double max_distance,
                                         swiftprox_manifold_point points[PAGE_GROUND_POINTS], size_t *count)
{
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    config.max_distance = max_distance;
    swiftprox_ground_count found = {0};
    const swiftprox_ground_room room = {NULL, 0, points, PAGE_GROUND_POINTS};
    const swiftprox_status status = swiftprox_pair_ground_contacts(body, ground, &config, room, &found);
    *count = found.point_count < PAGE_GROUND_POINTS ? found.point_count : PAGE_GROUND_POINTS;
    return status;
}
