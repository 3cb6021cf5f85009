/* A hull whose support is climbed to from the last one, its rings of neighbours stored with their coordinates: for peers that leave
 * the support function to their user. */
#ifndef COMPARE_HULL_H
#define COMPARE_HULL_H

#include <stdlib.h>
#include <string.h>

struct hull_neighbour {
    double position[3];
    unsigned vertex;
};

struct hull {
    double *vertices, centre[3];
    unsigned *starts; /* vertex v's ring is ring[starts[v]] to ring[starts[v + 1]] */
    struct hull_neighbour *ring;
};

static inline double hull_dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The vertex farthest along a direction, from the vertex `at`. */
static inline unsigned hull_climb(const struct hull *hull, const double direction[3], unsigned at)
{
    unsigned from;
    double height = hull_dot(hull->vertices + 3 * at, direction);
    do {
        from = at;
        for (unsigned i = hull->starts[from]; i < hull->starts[from + 1]; ++i) {
            const double other = hull_dot(hull->ring[i].position, direction);
            if (other > height) { /* going on at once beats looking for the best of the ring */
                at = hull->ring[i].vertex;
                height = other;
                break;
            }
        }
    } while (at != from);
    return at;
}

static inline void hull_free(struct hull *hull)
{
    if (hull) {
        free(hull->vertices);
        free(hull->starts);
        free(hull->ring);
        free(hull);
    }
}

/* A closed triangle mesh whose vertices are all extreme; null without memory. */
static inline struct hull *hull_create(const double *vertices, size_t vertex_count, const unsigned *corners, size_t triangle_count)
{
    struct hull *hull = (struct hull *)calloc(1, sizeof *hull);
    unsigned *filled = (unsigned *)calloc(vertex_count, sizeof *filled);
    if (hull) {
        hull->vertices = (double *)malloc(3 * vertex_count * sizeof *vertices);
        hull->starts = (unsigned *)calloc(vertex_count + 1, sizeof *hull->starts);
        hull->ring = (struct hull_neighbour *)calloc(3 * triangle_count, sizeof *hull->ring);
    }
    if (!hull || !filled || !hull->vertices || !hull->starts || !hull->ring) {
        hull_free(hull);
        free(filled);
        return NULL;
    }
    memcpy(hull->vertices, vertices, 3 * vertex_count * sizeof *vertices);
    for (size_t i = 0; i < 3 * vertex_count; ++i)
        hull->centre[i % 3] += vertices[i] / (double)vertex_count;
    /* Around a vertex of a closed surface each neighbour is the next corner of one triangle. */
    for (size_t i = 0; i < 3 * triangle_count; ++i)
        ++hull->starts[corners[i] + 1];
    for (size_t v = 0; v < vertex_count; ++v)
        hull->starts[v + 1] += hull->starts[v];
    for (size_t i = 0; i < 3 * triangle_count; ++i) {
        const unsigned from = corners[i], to = corners[i % 3 == 2 ? i - 2 : i + 1];
        struct hull_neighbour *neighbour = &hull->ring[hull->starts[from] + filled[from]++];
        memcpy(neighbour->position, vertices + 3 * to, sizeof neighbour->position);
        neighbour->vertex = to;
    }
    free(filled);
    return hull;
}

#endif
