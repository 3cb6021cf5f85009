/* What the runners of benches/stability share: two meshes and a file of poses in, a line a pose out, written at once, so that
 * a crash or a hang costs one pose. The driver, stability.py, has the protocol. */
#ifndef STABILITY_RUNNER_H
#define STABILITY_RUNNER_H

#include <stdbool.h>

#include "poses.h"
#include "scene.h"

/* Exit statuses. */
enum { RUN_GOOD = 0, RUN_REFUSED = 2, RUN_MISUSED = 3 };

struct run {
    struct body bodies[2]; /* exact convex hulls of the vertices of the files */
    struct pose_list poses;
};

/* Loads two meshes and the poses. On failure it prints a message and returns false; run_free in either case. */
bool run_load(char *const files[3], struct run *run);

void run_free(struct run *run);

/* The same for one body. */
bool run_load_body(const char *path, struct body *body);

void run_free_body(struct body *body);

#endif
