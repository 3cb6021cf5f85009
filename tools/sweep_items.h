/* What a sweep asks about: poses or edges, one a line of a file. */
#ifndef SWIFTPROX_TOOLS_SWEEP_ITEMS_H
#define SWIFTPROX_TOOLS_SWEEP_ITEMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum sweep_kind {
    SWEEP_POSES = 12,   /* the numbers of a line: a row-major 3x4 [R|T] */
    SWEEP_MOTIONS = 24, /* that at time 0, and that at time 1 */
};

struct sweep_items {
    enum sweep_kind kind;
    double *numbers; /* `kind` for each */
    size_t count;
    uint64_t digest; /* of all numbers */
};

/* Reads a file, or the standard input when `path` is "-". Blank lines and lines that start with # are skipped; the first other one
 * says the kind. On failure it prints a message with the line on the standard error and returns false; release the items with
 * sweep_items_free in either case. */
bool sweep_items_read(const char *path, struct sweep_items *items);

void sweep_items_free(struct sweep_items *items);

/* FNV-1a over bytes, going on from a digest; from SWEEP_DIGEST_START at first. */
#define SWEEP_DIGEST_START UINT64_C(0xcbf29ce484222325)
uint64_t sweep_digest(uint64_t digest, const void *bytes, size_t count);

#endif
