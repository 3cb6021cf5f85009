/* Checks for test programs: a failed one prints where and lets the program go on; check_report ends it. */
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>
#include <string.h>

#include "swiftprox.h"

static int check_count, check_failures;

/* Says no more than this many times what failed: one cause often fails a million checks. */
enum { CHECK_MOST_MESSAGES = 20 };

/* Checks that a condition holds. */
#define CHECK(condition) check_that((condition) ? 1 : 0, #condition, "", __FILE__, __LINE__)

/* Checks that a call to the library succeeds; says its message if not. */
#define CHECK_OK(call)                                                                             \
    check_that((call) == SWIFTPROX_OK, #call, swiftprox_library_last_error_message(), __FILE__, __LINE__)

static int check_that(int holds, const char *what, const char *why, const char *file, int line)
{
    ++check_count;
    if (!holds && ++check_failures <= CHECK_MOST_MESSAGES) {
        fflush(stdout);
        fprintf(stderr, "%s:%d: failed: %s %s\n", file, line, what, why);
    }
    return holds;
}

/* Checks that a call fails with a status and that the message names something. */
#define CHECK_FAILS(expected, name, call) check_fails(expected, name, call, #call, __FILE__, __LINE__)

static inline void check_fails(swiftprox_status expected, const char *name, swiftprox_status status, const char *what,
                               const char *file, int line)
{
    const char *message = swiftprox_library_last_error_message();
    if (!check_that(status == expected && strstr(message, name) != NULL, what, message, file, line)) {
        fprintf(stderr, "    %s, not %s naming \"%s\"\n", swiftprox_library_status_string(status),
                swiftprox_library_status_string(expected), name);
    }
}

/* Prints the outcome; the exit status of the program. */
static int check_report(const char *program)
{
    printf("%s: %d checks, %d failed\n", program, check_count, check_failures);
    return check_failures == 0 ? 0 : 1;
}

#endif
