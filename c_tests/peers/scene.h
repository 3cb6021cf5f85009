/* Bodies and poses that the comparisons run on: the benchmark of Ehmann & Lin 2000, section 6 (one ellipsoid orbits
 * another), and polyhedra with large faces in touching, nearly touching and arbitrary positions. All of it is random with
 * fixed seeds. */
#ifndef SCENE_H
#define SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A convex polyhedron: the points it is the hull of, and its shape. */
struct body {
    double *points; /* 3 * point_count coordinates */
    size_t point_count;
    const swiftprox_shape *shape;
    void *of_peer; /* what another library makes of it */
};

/* Two bodies and where they go. */
struct scene {
    char name[32];
    struct body bodies[2];
    size_t pose_count;
    double (*poses)[24]; /* [R|T] of the first body, then of the second */
};

/* Zeroed memory for free(); ends the program where memory is lacking. */
void *scene_allocate(size_t count, size_t size);

/* How many scenes there are. */
size_t scene_count(void);

/* Makes scene `index`; 0 when a shape cannot be made (the library's message says why). */
int scene_create(size_t index, struct scene *scene);

void scene_destroy(struct scene *scene);

#ifdef __cplusplus
}
#endif

#endif
