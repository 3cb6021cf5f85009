#include "arm.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* The frames of all links in the world, from the angles; the order of sums is that of the bound below. */
void arm_poses(const struct arm *arm, const double *angles, double *poses)
{
    double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, place[3] = {0, 0, 0};
    for (size_t k = 0; k < arm->joint_count; k++) {
        const struct joint *const joint = &arm->joints[k];
        const double c = cos(angles[k]), s = sin(angles[k]);
        double framed[9];
        for (int i = 0; i < 3; i++) {
            const double *const row = rotation + 3 * i;
            place[i] += row[0] * joint->offset[0] + row[1] * joint->offset[1] + row[2] * joint->offset[2];
            for (int j = 0; j < 3; j++) {
                framed[3 * i + j] = row[0] * joint->frame[j] + row[1] * joint->frame[3 + j] + row[2] * joint->frame[6 + j];
            }
        }
        for (int i = 0; i < 3; i++) {
            const double x = framed[3 * i], y = framed[3 * i + 1];
            rotation[3 * i] = x * c + y * s;
            rotation[3 * i + 1] = y * c - x * s;
            rotation[3 * i + 2] = framed[3 * i + 2];
            memcpy(poses + 12 * k + 4 * i, rotation + 3 * i, 3 * sizeof *poses);
            poses[12 * k + 4 * i + 3] = place[i];
        }
    }
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* No point of link `last` accelerates by more along an edge.
 *
 * A point at r_j from joint j has the velocity sum q'_j a_j x r_j over the joints up to its link. Differentiated, the terms of a
 * pair i < j make q'_i q'_j a_i x (a_j x r_j), twice, by Jacobi's identity, and those of i = j once. So
 *
 *   |acceleration| <= sum_j |q'_j| R_j (|q'_j| + 2 sum_{i<j} |q'_i|),
 *
 * where R_j is how far the link's points may be from joint j: the offsets behind it and the link's reach. A thousandth more covers
 * the rounding of these sums. */
static double bend_bound(const struct arm_edge *edge, size_t last)
{
    double farthest = edge->arm->reach[last], bound = 0, rates = 0, far[MOST_JOINTS];
    for (size_t k = last + 1; k-- > 0;) {
        far[k] = farthest;
        farthest += length(edge->arm->joints[k].offset);
    }
    for (size_t k = 0; k <= last; k++) {
        const double rate = fabs(edge->to[k] - edge->from[k]);
        bound += rate * far[k] * (rate + 2 * rates);
        rates += rate;
    }
    return bound * 1.001;
}

/* No point of link `last` is farther from where the edge has it in real arithmetic. u is 2^-53.
 *
 * An angle from + t (to - from) errs by u|to - from| of the difference, as much of the product, and u of the sum: below
 * 3u(|from| + |to|). cos and sin err by an ulp, so by u at most: below 1.5u in the spectral norm. Products with the frame are
 * exact.
 * Of x c + y s each of the three roundings is below u|(x, y)|, of the six entries below 3 sqrt(2) u in the Frobenius norm. So a
 * joint adds at most
 *
 *   e_k = u (3(|from| + |to|) + 6)
 *
 * to the error E of the rotation, whose norm is 1. The offset's product errs by 3u of it in each entry, below 6u|offset| in all,
 * and by E|offset| for the rotation; the sum by u of all offsets before. The last factor covers products of errors. */
static double rounding_bound(const struct arm_edge *edge, size_t last)
{
    const double u = DBL_EPSILON / 2;
    double of_rotation = 0, of_place = 0, path = 0;
    for (size_t k = 0; k <= last; k++) {
        const double offset = length(edge->arm->joints[k].offset);
        path += offset;
        of_place += of_rotation * offset + u * (6 * offset + 2 * path);
        of_rotation += u * (3 * (fabs(edge->from[k]) + fabs(edge->to[k])) + 6);
    }
    return (of_place + of_rotation * edge->arm->reach[last]) * 1.001;
}

/* Where all links are at a time, computed once while few other times are asked about. */
static const double *poses_at(struct arm_edge *edge, double time)
{
    const size_t place = (size_t)fmod(fabs(time) * 1048573.0, KEPT_TIMES);
    struct arm_moment *const kept = &edge->kept[place];
    if (kept->time != time) {
        double angles[MOST_JOINTS];
        for (size_t k = 0; k < edge->arm->joint_count; k++) {
            angles[k] = edge->from[k] + time * (edge->to[k] - edge->from[k]);
        }
        arm_poses(edge->arm, angles, kept->poses);
        kept->time = time;
    }
    return kept->poses;
}

/* The callback of a link's motion. */
static void link_at(void *user, double time, double *pose)
{
    const struct arm_link *const link = user;
    memcpy(pose, poses_at(link->edge, time) + 12 * link->index, 12 * sizeof *pose);
}

void arm_motions(const struct arm *arm, const double *from, const double *to, struct arm_edge *edge, swiftprox_motion *motions)
{
    edge->arm = arm;
    memcpy(edge->from, from, arm->joint_count * sizeof *from);
    memcpy(edge->to, to, arm->joint_count * sizeof *to);
    for (size_t i = 0; i < KEPT_TIMES; i++) {
        edge->kept[i].time = NAN;
    }
    for (size_t k = 0; k < arm->joint_count; k++) {
        edge->links[k] = (struct arm_link){edge, k};
        memset(&motions[k], 0, sizeof motions[k]);
        motions[k].kind = SWIFTPROX_MOTION_KIND_CALLBACK;
        motions[k].pose = link_at;
        motions[k].user = &edge->links[k];
        motions[k].bend = bend_bound(edge, k);
        motions[k].rounding = rounding_bound(edge, k);
    }
}
