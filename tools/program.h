/* What the tools share as programs: how they end, and what they tell of themselves. */
#ifndef SWIFTPROX_TOOLS_PROGRAM_H
#define SWIFTPROX_TOOLS_PROGRAM_H

#include <stdbool.h>

enum exit_status { GOOD = 0, FAILED = 1, BAD_FILE = 2 };

/* A program's name, and what --help prints. */
struct program {
    const char *name;
    const char *usage;
    const char *help;
};

/* Answers --help and --version, wherever they stand; false if neither was asked for. */
bool program_tells(const struct program *program, int argc, char **argv);

/* Writes out what was printed. The program's exit status: `status`, or FAILED with a message if the output cannot be written. */
int program_end(const struct program *program, int status);

#endif
