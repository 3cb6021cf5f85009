/* An arm: joints in a chain, and the motions of its links along an edge of a planner, with bounds that make them provable. */
#ifndef EXAMPLES_PLANNER_ARM_H
#define EXAMPLES_PLANNER_ARM_H

#include "cell.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { MOST_JOINTS = 7 };

/* Of a link's frame in that of the link before it, at angle 0: where it is, and how it is turned, by quarter turns, so that
 * products with it are exact. The joint turns about the z axis of the frame. */
struct joint {
    double offset[3];
    double frame[9]; /* row by row */
};

struct arm {
    size_t joint_count;
    struct joint joints[MOST_JOINTS];
    double reach[MOST_JOINTS]; /* how far a link reaches from the origin of its frame */
    double lowest[MOST_JOINTS], highest[MOST_JOINTS]; /* angles */
    double start[MOST_JOINTS], goal[MOST_JOINTS];     /* of the problem: from one side of a post to the other */
};

enum { KEPT_TIMES = 16 };

/* An edge: each joint's angle runs from the first to the second at a constant rate. */
struct arm_edge {
    const struct arm *arm;
    double from[MOST_JOINTS], to[MOST_JOINTS];
    /* Where all links are at some times: many pairs ask about the same times, the ends first of all, and each about one link. */
    struct arm_moment {
        double time; /* NaN: none yet */
        double poses[12 * MOST_JOINTS];
    } kept[KEPT_TIMES];
    struct arm_link {
        struct arm_edge *edge;
        size_t index;
    } links[MOST_JOINTS];
};

/* Poses of all links, 12 numbers each. */
void arm_poses(const struct arm *arm, const double *angles, double *poses);

/* The motions of all links along an edge; they look at it and keep poses in it, so it has to stay where it is, for one thread. */
void arm_motions(const struct arm *arm, const double *from, const double *to, struct arm_edge *edge, swiftprox_motion *motions);

/* The shipped arm with six axes, of boxes and prisms, in a cell with a table, two posts and a shelf. Bodies of the cell are its
 * links in order; its base is an obstacle. */
void arm_build_cell(struct arm *arm, struct cell *cell);

/* Franka's arm, with its links of a folder, FOLDER/fer_link0.off to fer_link7.off, beside a post and below a shelf. */
void arm_build_franka(struct arm *arm, struct cell *cell, const char *folder);

#ifdef __cplusplus
}
#endif

#endif
