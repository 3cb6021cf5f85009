/* Verdicts against libccd 2: ccdGJKIntersect and ccdMPRIntersect. */

#include <ccd/ccd.h>
#include <ccd/vec3.h>
#include <math.h>
#include <stdio.h>

#include "comparison.h"

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

/* A point inside: the bodies of the scenes are centred on their origins. */
static void centre(const void *object, ccd_vec3_t *point)
{
    const struct placed *placed = object;
    ccdVec3Set(point, placed->pose[3], placed->pose[7], placed->pose[11]);
}

static void query(int (*intersect)(const void *, const void *, const ccd_t *), const struct placed *first,
                  const struct placed *second, struct peer_answer *answer)
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = centre;
    ccd.max_iterations = 1000; /* the default is no bound */
    answer->outcome = intersect(first, second, &ccd) ? PEER_INTERSECTING : PEER_SEPARATED;
    answer->distance = answer->point_distance = NAN;
}

static void query_gjk(const struct body *body1, const double pose1[12], const struct body *body2, const double pose2[12],
                      struct peer_answer *answer)
{
    const struct placed first = {body1, pose1}, second = {body2, pose2};
    query(ccdGJKIntersect, &first, &second, answer);
}

static void query_mpr(const struct body *body1, const double pose1[12], const struct body *body2, const double pose2[12],
                      struct peer_answer *answer)
{
    const struct placed first = {body1, pose1}, second = {body2, pose2};
    query(ccdMPRIntersect, &first, &second, answer);
}

int main(int argc, char **argv)
{
    static const struct peer peers[] = {
        {"ccdGJKIntersect", NULL, NULL, query_gjk},
        {"ccdMPRIntersect", NULL, NULL, query_mpr},
    };
    if (argc != 2) {
        fprintf(stderr, "usage: %s EXACT_ORACLE\n", argv[0]);
        return 2;
    }
    return compare("against_libccd", argv[1], peers, sizeof peers / sizeof *peers);
}
