/* Pose files: one query a line, 24 numbers, the row-major 3x4 [R|T] of the first object and then of the second; of
 * motions 48, those at the beginning and then those at the end. Blank lines and lines that start with # are skipped. */
#ifndef SWIFTPROX_TOOLS_POSES_H
#define SWIFTPROX_TOOLS_POSES_H

#include <stdbool.h>
#include <stddef.h>

/* The poses of one query, each as the pair functions take it. */
struct pose_pair {
    double first[12];
    double second[12];
};

struct pose_list {
    struct pose_pair *pairs; /* `moments` for each query */
    size_t *lines; /* the line of the file that each query stands on, counted from 1 */
    size_t moments;
    size_t count;
};

/* Reads at most `limit` queries of `moments` pairs, 1 or 2, of the file, or of the standard input when `path` is "-". What lies
 * behind them is not looked at. On failure it prints a message with the line number on the standard error and returns false;
 * release the list with pose_list_free in either case. */
bool pose_list_read(const char *path, size_t moments, size_t limit, struct pose_list *list);

void pose_list_free(struct pose_list *list);

#endif
