/* A file that is written under another name beside its place and takes it when it is whole: nobody finds half of one. */
#ifndef SWIFTPROX_TOOLS_OUTPUT_FILE_H
#define SWIFTPROX_TOOLS_OUTPUT_FILE_H

#include <stdbool.h>
#include <stdio.h>

struct output_file {
    char *path;      /* links of the file itself followed */
    char *part_path; /* what is written */
    FILE *file;
};

/* Whether a file could be written there, which leaves all as it is; a message if not. To be asked before what takes long. */
bool output_file_try(const char *path);

/* Opens it for output_file.file to be written. False after a message; there is nothing to close then. */
bool output_file_open(struct output_file *output, const char *path);

/* Puts what was written in its place. Where a write failed, which has a message, or `is_whole` is false, which has none, what was
 * written is removed, and it returns false. */
bool output_file_close(struct output_file *output, bool is_whole);

#endif
