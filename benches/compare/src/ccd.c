/* libccd for ccd.rs and depth/peers.rs, with a support function that climbs: libccd leaves it to its user. */

#include <ccd/ccd.h>
#include <ccd/vec3.h>
#include <math.h>
#include <stdbool.h>

#include "depth/peer.h"
#include "hull.h"

struct placed {
    const struct hull *hull;
    const double *pose;
    unsigned *last;
};

static void place(const double *m, const double *p, ccd_vec3_t *point)
{
    for (int k = 0; k < 3; ++k)
        point->v[k] = hull_dot(m + 4 * k, p) + m[4 * k + 3];
}

static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *farthest)
{
    const struct placed *placed = object;
    const double *m = placed->pose, *d = direction->v;
    const double local[3] = {m[0] * d[0] + m[4] * d[1] + m[8] * d[2], m[1] * d[0] + m[5] * d[1] + m[9] * d[2],
                             m[2] * d[0] + m[6] * d[1] + m[10] * d[2]};
    const unsigned at = hull_climb(placed->hull, local, *placed->last);
    *placed->last = at;
    place(m, placed->hull->vertices + 3 * at, farthest);
}

static void centre(const void *object, ccd_vec3_t *point)
{
    const struct placed *placed = object;
    place(placed->pose, placed->hull->centre, point);
}

static void prepare(ccd_t *ccd)
{
    CCD_INIT(ccd);
    ccd->support1 = ccd->support2 = support;
    ccd->center1 = ccd->center2 = centre;
}

void ccd_shim_free(struct hull *hull)
{
    hull_free(hull);
}

struct hull *ccd_shim_hull(const double *vertices, size_t vertex_count, const unsigned *corners, size_t triangle_count)
{
    return hull_create(vertices, vertex_count, corners, triangle_count);
}

/* Whether a hull at the first pose and itself at the second intersect; `last` holds the last support vertex of each. */
int ccd_shim_mpr(const struct hull *hull, const double poses[24], unsigned last[2])
{
    const struct placed first = {hull, poses, &last[0]}, second = {hull, poses + 12, &last[1]};
    ccd_t ccd;
    prepare(&ccd);
    return ccdMPRIntersect(&first, &second, &ccd);
}

/* ---- depth ---- */

enum { MOST_ITERATIONS = 500 }; /* libccd has no limit of its own, and at a tight tolerance it may go on for ever */

struct peer {
    struct hull *hulls[2];
    const double *poses;
    unsigned last[2];
    double tolerance;
    bool by_mpr;
};

void ccd_depth_free(struct peer *peer)
{
    hull_free(peer->hulls[0]);
    hull_free(peer->hulls[1]);
    free(peer);
}

static struct peer *create(const struct peer_mesh meshes[2], double tolerance, bool by_mpr)
{
    struct peer *peer = calloc(1, sizeof *peer);
    if (!peer)
        return NULL;
    for (int k = 0; k < 2; ++k)
        peer->hulls[k] = hull_create(meshes[k].vertices, meshes[k].vertex_count, meshes[k].corners, meshes[k].triangle_count);
    if (!peer->hulls[0] || !peer->hulls[1]) {
        ccd_depth_free(peer);
        return NULL;
    }
    peer->tolerance = tolerance;
    peer->by_mpr = by_mpr;
    return peer;
}

struct peer *ccd_epa_create(const struct peer_mesh meshes[2], double tolerance)
{
    return create(meshes, tolerance, false);
}

struct peer *ccd_mpr_create(const struct peer_mesh meshes[2], double tolerance)
{
    return create(meshes, tolerance, true);
}

void ccd_depth_load(struct peer *peer, const double *poses, size_t count)
{
    (void)count;
    peer->poses = poses;
}

void ccd_depth_forget(struct peer *peer)
{
    peer->last[0] = peer->last[1] = 0;
}

double ccd_depth_ask(struct peer *peer, size_t i, double normal[3])
{
    const double *poses = peer->poses + 24 * i;
    const struct placed first = {peer->hulls[0], poses, &peer->last[0]}, second = {peer->hulls[1], poses + 12, &peer->last[1]};
    ccd_t ccd;
    prepare(&ccd);
    ccd.max_iterations = MOST_ITERATIONS;
    ccd.epa_tolerance = ccd.mpr_tolerance = peer->tolerance;
    ccd_real_t depth;
    ccd_vec3_t direction, position;
    const int status = peer->by_mpr ? ccdMPRPenetration(&first, &second, &ccd, &depth, &direction, &position)
                                    : ccdGJKPenetration(&first, &second, &ccd, &depth, &direction, &position);
    if (status == 0)
        memcpy(normal, direction.v, sizeof direction.v);
    return status == 0 ? depth : status == -1 ? 0.0 : NAN;
}
