#include "program.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include <swiftprox.h>

bool program_tells(const struct program *program, int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            printf("%s%s", program->usage, program->help);
            return true;
        }
        if (strcmp(argv[i], "--version") == 0) {
            printf("%s %s\n", program->name, swiftprox_library_version());
            return true;
        }
    }
    return false;
}

int program_end(const struct program *program, int status)
{
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == GOOD) {
        fprintf(stderr, "%s: the output cannot be written: %s\n", program->name, strerror(errno));
        return FAILED;
    }
    return status;
}
