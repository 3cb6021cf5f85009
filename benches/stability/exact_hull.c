/* Writes the exact convex hull of a mesh's vertices as triangles in OFF:  exact_hull MESH > HULL.off
 *
 * Bodies without interior: a polygon has both sides, a segment or a point no triangles. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "runner.h"
#include <swiftprox/geometry.h>

static bool write_hull(const struct body *body)
{
    swiftprox_shape_info info;
    info.struct_size = sizeof info;
    if (swiftprox_shape_get_info(body->shape, &info) != SWIFTPROX_OK)
        return false;
    uint32_t *corners = scene_allocate(3 * info.triangle_count + 1, sizeof *corners);
    const bool copied = swiftprox_shape_copy_triangles(body->shape, corners, info.triangle_count) == SWIFTPROX_OK;
    if (copied) {
        printf("OFF\n%zu %zu 0\n", body->point_count, info.triangle_count);
        for (size_t i = 0; i < body->point_count; ++i)
            printf("%.17g %.17g %.17g\n", body->points[3 * i], body->points[3 * i + 1], body->points[3 * i + 2]);
        for (size_t t = 0; t < info.triangle_count; ++t)
            printf("3 %u %u %u\n", (unsigned)corners[3 * t], (unsigned)corners[3 * t + 1], (unsigned)corners[3 * t + 2]);
    }
    free(corners);
    return copied;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: %s MESH\n", argv[0]);
        return RUN_MISUSED;
    }
    struct body body = {0};
    const bool good = run_load_body(argv[1], &body) && write_hull(&body);
    run_free_body(&body);
    return good && fflush(stdout) == 0 ? RUN_GOOD : RUN_REFUSED;
}
