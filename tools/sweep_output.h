/* The results of a sweep, in order, in FILE.part until they are whole. What an earlier run has written there stays: at whatever
 * moment that was killed, nothing is lost and nothing comes twice. FILE.part.sums has a checksum for each share, a line each: what
 * was changed since is found. */
#ifndef SWIFTPROX_TOOLS_SWEEP_OUTPUT_H
#define SWIFTPROX_TOOLS_SWEEP_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "sweep_scene.h"

struct sweep_output {
    const char *path;
    char *part_path, *sums_path;
    FILE *file, *sums;
    char **waiting;     /* results of each share that came before those of an earlier one */
    size_t share_count;
    size_t written;     /* shares, in order */
    uint64_t digest;    /* of these and the head before them */
    struct sweep_tally found; /* outcomes of what an earlier run has written */
};

/* Opens FILE.part. If it is there, its first line has to be `head`, which says all that results depend on. It is cut off behind
 * the last of the shares of `share` lines that are whole and have their checksums, and `written` says how many these are; a share
 * that is not what was written is told. On failure it prints a message and returns another status than GOOD; there is nothing to
 * close then. */
int sweep_output_open(struct sweep_output *output, const char *path, const char *head, size_t count, size_t share);

/* Takes over the lines of a share, and writes all that are next in order. False after a message. */
bool sweep_output_take(struct sweep_output *output, size_t share, char *lines);

/* Gives the file its name if it is whole. False after a message where a write failed. */
bool sweep_output_close(struct sweep_output *output);

#endif
