#include <stdio.h>
#include <swiftprox.h>

int main(void)
{
    const double corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}; /* x, y, z of four vertices */
    const uint32_t faces[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}; /* four triangles, counter-clockwise seen from outside */
    const double pose1[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}; /* rows of [R|T] */
    const double pose2[12] = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1};
    const swiftprox_shape *tetrahedron;
    swiftprox_pair_cache cache = {{0}}; /* all zero is cold; keep one per pair */
    swiftprox_pair_answer answer;
    if (swiftprox_shape_create_from_mesh((swiftprox_mesh){corners, 4, faces, NULL, 4}, NULL, &tetrahedron) != SWIFTPROX_OK ||
        swiftprox_pair_distance((swiftprox_placed){tetrahedron, pose1}, (swiftprox_placed){tetrahedron, pose2}, &cache, NULL,
                                &answer) != SWIFTPROX_OK) {
        fprintf(stderr, "%s\n", swiftprox_library_last_error_message());
        return 1;
    }
    printf("distance %.17g, guaranteed within [%.17g, %.17g]\n", answer.distance, answer.lower, answer.upper);
    swiftprox_shape_release(tetrahedron);
    return 0;
}
