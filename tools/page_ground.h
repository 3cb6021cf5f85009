/* Grounds in a page (tools/page_data.h): their triangles, read part by part, and where bodies touch them. */
#ifndef SWIFTPROX_TOOLS_PAGE_GROUND_H
#define SWIFTPROX_TOOLS_PAGE_GROUND_H

#include <swiftprox.h>
#include <swiftprox/ground.h>

#include "base64.h"

/* A larger ground is not drawn: its pairs are shown alone. */
enum { PAGE_MOST_GROUND_TRIANGLES = 1000 * 1000 };

/* What a page says of a shape: counts, radius and centre, that of the box around the triangles. Skipped triangles do not count. */
swiftprox_status page_ground_measure(const swiftprox_ground *ground, swiftprox_shape_info *info);

/* All vertices as seen from the centre, and the vertices of each triangle. */
swiftprox_status page_ground_write_vertices(const swiftprox_ground *ground, const swiftprox_shape_info *info, struct base64 *block);
swiftprox_status page_ground_write_triangles(const swiftprox_ground *ground, struct base64 *block);

enum { PAGE_GROUND_POINTS = 64 };

/* Points up to a gap of `max_distance` where a body, object 1, meets a ground; of many the first. */
swiftprox_status page_ground_find_points(swiftprox_placed body, swiftprox_placed_ground ground, double max_distance,
                                         swiftprox_manifold_point points[PAGE_GROUND_POINTS], size_t *count);

#endif
