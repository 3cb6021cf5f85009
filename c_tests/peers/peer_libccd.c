/* Verdicts of libccd 2: ccdGJKIntersect and ccdMPRIntersect. It says no distance of disjoint bodies. */

#include <ccd/ccd.h>
#include <ccd/vec3.h>
#include <math.h>
#include <stdlib.h>

#include "peers.h"

struct placed {
    const struct body *body;
    const double *pose;
};

/* The point of the placed body that lies farthest in a direction. */
static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *farthest)
{
    const struct placed *placed = object;
    const double *m = placed->pose, *d = direction->v, *best = placed->body->points;
    double local[3], most = -INFINITY;
    for (int k = 0; k < 3; ++k)
        local[k] = m[k] * d[0] + m[4 + k] * d[1] + m[8 + k] * d[2];
    for (size_t i = 0; i < placed->body->point_count; ++i) {
        const double *p = placed->body->points + 3 * i;
        double height = p[0] * local[0] + p[1] * local[1] + p[2] * local[2];
        if (height > most) {
            most = height;
            best = p;
        }
    }
    for (int k = 0; k < 3; ++k)
        farthest->v[k] = m[4 * k] * best[0] + m[4 * k + 1] * best[1] + m[4 * k + 2] * best[2] + m[4 * k + 3];
}

/* A point inside, in the local frame: the mean of the points. */
static void *create(const struct body *body)
{
    double *inside = scene_allocate(3, sizeof *inside);
    for (size_t i = 0; i < 3 * body->point_count; ++i)
        inside[i % 3] += body->points[i] / (double)body->point_count;
    return inside;
}

static void destroy(void *inside)
{
    free(inside);
}

static void centre(const void *object, ccd_vec3_t *point)
{
    const struct placed *placed = object;
    const double *m = placed->pose, *p = placed->body->of_peer;
    for (int k = 0; k < 3; ++k)
        point->v[k] = m[4 * k] * p[0] + m[4 * k + 1] * p[1] + m[4 * k + 2] * p[2] + m[4 * k + 3];
}

static void query(int (*intersect)(const void *, const void *, const ccd_t *), const struct peer *peer,
                  const struct placed *first, const struct placed *second, struct peer_answer *answer)
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = centre;
    ccd.max_iterations = 1000; /* the default is no bound */
    ccd.mpr_tolerance = peer->tolerance;
    answer->outcome = intersect(first, second, &ccd) ? PEER_INTERSECTING : PEER_SEPARATED;
    answer->distance = answer->point_distance = NAN;
}

static void query_gjk(const struct peer *peer, const struct body *body1, const double pose1[12], const struct body *body2,
                      const double pose2[12], struct peer_answer *answer)
{
    const struct placed first = {body1, pose1}, second = {body2, pose2};
    query(ccdGJKIntersect, peer, &first, &second, answer);
}

static void query_mpr(const struct peer *peer, const struct body *body1, const double pose1[12], const struct body *body2,
                      const double pose2[12], struct peer_answer *answer)
{
    const struct placed first = {body1, pose1}, second = {body2, pose2};
    query(ccdMPRIntersect, peer, &first, &second, answer);
}

const struct peer all_peers[] = {
    {"ccdGJKIntersect", "libccd-gjk", 0, 0, create, destroy, query_gjk},
    {"ccdMPRIntersect", "libccd-mpr", 1e-4, 0, create, destroy, query_mpr},
};
const size_t all_peer_count = sizeof all_peers / sizeof *all_peers;
