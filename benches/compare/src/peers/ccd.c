/* libccd, with a support function that climbs: libccd leaves it to its user. It has verdicts and depths, by GJK with EPA and by MPR
 * (minkowski portal refinement), and no distances. */

#include <ccd/ccd.h>
#include <ccd/vec3.h>
#include <math.h>

#include "hull.h"
#include "peer.h"

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

enum { MOST_ITERATIONS = 500 }; /* libccd has no limit of its own, and at a tight tolerance it may go on for ever */

static void prepare(ccd_t *ccd, double tolerance)
{
    CCD_INIT(ccd);
    ccd->support1 = ccd->support2 = support;
    ccd->center1 = ccd->center2 = centre;
    ccd->max_iterations = MOST_ITERATIONS;
    ccd->epa_tolerance = ccd->mpr_tolerance = tolerance;
}

struct peer {
    struct hull *hulls[2];
    const double *poses;
    unsigned last[2];
    double tolerance;
};

void ccd_peer_free(struct peer *peer)
{
    hull_free(peer->hulls[0]);
    hull_free(peer->hulls[1]);
    free(peer);
}

struct peer *ccd_peer_create(const struct peer_mesh meshes[2], double tolerance)
{
    struct peer *peer = calloc(1, sizeof *peer);
    if (!peer)
        return NULL;
    for (int k = 0; k < 2; ++k)
        peer->hulls[k] = hull_create(meshes[k].vertices, meshes[k].vertex_count, meshes[k].corners, meshes[k].triangle_count);
    if (!peer->hulls[0] || !peer->hulls[1]) {
        ccd_peer_free(peer);
        return NULL;
    }
    peer->tolerance = tolerance;
    return peer;
}

void ccd_peer_load(struct peer *peer, const double *poses, size_t count)
{
    (void)count;
    peer->poses = poses;
}

void ccd_peer_forget(struct peer *peer)
{
    peer->last[0] = peer->last[1] = 0;
}

typedef int intersects(const void *, const void *, const ccd_t *);
typedef int penetrates(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *, ccd_vec3_t *);

static double verdict(struct peer *peer, size_t i, intersects *ask)
{
    const double *poses = peer->poses + 24 * i;
    const struct placed first = {peer->hulls[0], poses, &peer->last[0]}, second = {peer->hulls[1], poses + 12, &peer->last[1]};
    ccd_t ccd;
    prepare(&ccd, peer->tolerance);
    return ask(&first, &second, &ccd) ? 0.0 : INFINITY;
}

static double depth(struct peer *peer, size_t i, penetrates *ask, double normal[3])
{
    const double *poses = peer->poses + 24 * i;
    const struct placed first = {peer->hulls[0], poses, &peer->last[0]}, second = {peer->hulls[1], poses + 12, &peer->last[1]};
    ccd_t ccd;
    prepare(&ccd, peer->tolerance);
    ccd_real_t found;
    ccd_vec3_t direction, position;
    const int status = ask(&first, &second, &ccd, &found, &direction, &position);
    if (status == 0)
        memcpy(normal, direction.v, sizeof direction.v);
    return status == 0 ? found : status == -1 ? 0.0 : NAN;
}

double ccd_gjk_verdict(struct peer *peer, size_t i, double normal[3])
{
    (void)normal;
    return verdict(peer, i, ccdGJKIntersect);
}

double ccd_mpr_verdict(struct peer *peer, size_t i, double normal[3])
{
    (void)normal;
    return verdict(peer, i, ccdMPRIntersect);
}

double ccd_epa_depth(struct peer *peer, size_t i, double normal[3])
{
    return depth(peer, i, ccdGJKPenetration, normal);
}

double ccd_mpr_depth(struct peer *peer, size_t i, double normal[3])
{
    return depth(peer, i, ccdMPRPenetration, normal);
}
