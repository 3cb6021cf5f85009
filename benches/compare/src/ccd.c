/* libccd's MPR for ccd.rs, with a support function that climbs the hull from the last support vertex, its rings of neighbours
 * stored with their coordinates: libccd leaves the support function to its user. */

#include <ccd/ccd.h>
#include <ccd/vec3.h>
#include <stdlib.h>
#include <string.h>

struct neighbour {
    double position[3];
    unsigned vertex;
};

struct body {
    double *vertices, centre[3];
    unsigned *starts; /* vertex v's ring is ring[starts[v]] to ring[starts[v + 1]] */
    struct neighbour *ring;
};

struct placed {
    const struct body *body;
    const double *pose;
    unsigned *last;
};

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void place(const double *m, const double *p, ccd_vec3_t *point)
{
    for (int k = 0; k < 3; ++k)
        point->v[k] = dot(m + 4 * k, p) + m[4 * k + 3];
}

static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *farthest)
{
    const struct placed *placed = object;
    const struct body *body = placed->body;
    const double *m = placed->pose, *d = direction->v;
    const double local[3] = {m[0] * d[0] + m[4] * d[1] + m[8] * d[2], m[1] * d[0] + m[5] * d[1] + m[9] * d[2],
                             m[2] * d[0] + m[6] * d[1] + m[10] * d[2]};
    unsigned at = *placed->last, from;
    double height = dot(body->vertices + 3 * at, local);
    do {
        from = at;
        for (unsigned i = body->starts[from]; i < body->starts[from + 1]; ++i) {
            const double other = dot(body->ring[i].position, local);
            if (other > height) { /* going on at once beats looking for the best of the ring */
                at = body->ring[i].vertex;
                height = other;
                break;
            }
        }
    } while (at != from);
    *placed->last = at;
    place(m, body->vertices + 3 * at, farthest);
}

static void centre(const void *object, ccd_vec3_t *point)
{
    const struct placed *placed = object;
    place(placed->pose, placed->body->centre, point);
}

void ccd_shim_free(struct body *body)
{
    if (body) {
        free(body->vertices);
        free(body->starts);
        free(body->ring);
        free(body);
    }
}

/* A closed triangle mesh whose vertices are all extreme; null without memory. */
struct body *ccd_shim_body(const double *vertices, size_t vertex_count, const unsigned *corners, size_t triangle_count)
{
    struct body *body = calloc(1, sizeof *body);
    unsigned *filled = calloc(vertex_count, sizeof *filled);
    if (body) {
        body->vertices = malloc(3 * vertex_count * sizeof *vertices);
        body->starts = calloc(vertex_count + 1, sizeof *body->starts);
        body->ring = calloc(3 * triangle_count, sizeof *body->ring);
    }
    if (!body || !filled || !body->vertices || !body->starts || !body->ring) {
        ccd_shim_free(body);
        free(filled);
        return NULL;
    }
    memcpy(body->vertices, vertices, 3 * vertex_count * sizeof *vertices);
    for (size_t i = 0; i < 3 * vertex_count; ++i)
        body->centre[i % 3] += vertices[i] / (double)vertex_count;
    /* Around a vertex of a closed surface each neighbour is the next corner of one triangle. */
    for (size_t i = 0; i < 3 * triangle_count; ++i)
        ++body->starts[corners[i] + 1];
    for (size_t v = 0; v < vertex_count; ++v)
        body->starts[v + 1] += body->starts[v];
    for (size_t i = 0; i < 3 * triangle_count; ++i) {
        const unsigned from = corners[i], to = corners[i % 3 == 2 ? i - 2 : i + 1];
        struct neighbour *neighbour = &body->ring[body->starts[from] + filled[from]++];
        memcpy(neighbour->position, vertices + 3 * to, sizeof neighbour->position);
        neighbour->vertex = to;
    }
    free(filled);
    return body;
}

/* Whether a body at the first pose and itself at the second intersect; `last` holds the last support vertex of each. */
int ccd_shim_mpr(const struct body *body, const double poses[24], unsigned last[2])
{
    const struct placed first = {body, poses, &last[0]}, second = {body, poses + 12, &last[1]};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = centre;
    return ccdMPRIntersect(&first, &second, &ccd);
}
