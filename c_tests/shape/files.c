/*
 * Files that are none: a pipe nobody writes to, devices, a folder, one that is larger than any that is read. Each is refused, none
 * is waited for, and the message says what it is and what would help.
 *
 *     files [folder for the files that it makes]
 */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include "check.h"
#include "swiftprox/geometry.h"

/* A megabyte beyond what is read of a file. */
static const long long TOO_LARGE = (1LL << 32) + (1 << 20);

static void check_refused(const char *path, const char *said)
{
    const swiftprox_shape *shape = NULL;
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, said, swiftprox_shape_create_from_file(path, NULL, &shape));
    CHECK(shape == NULL && strstr(swiftprox_library_last_error_message(), path) != NULL);
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, said, swiftprox_shape_load(path, NULL, NULL, &shape));
    CHECK(shape == NULL && strstr(swiftprox_library_last_error_message(), path) != NULL);
}

int main(int argc, char **argv)
{
    static const char MESH[] = "TRI 4 4 0 0 0 1 0 0 0 1 0 0 0 1 0 2 1 0 1 3 1 2 3 0 3 2";
    static char long_path[40000];
    const char *folder = argc > 1 ? argv[1] : ".";
    char path[4096], link_path[4096];
    const swiftprox_shape *shape = NULL;
    FILE *file;
    int pipe_ends[2];

    snprintf(path, sizeof path, "%s/pipe.off", folder);
    unlink(path);
    CHECK(mkfifo(path, 0600) == 0);
    check_refused(path, "FIFO");
    check_refused(path, "regular file");
    unlink(path);

    check_refused("/dev/zero", "device");
    check_refused("/dev/null", "device");
    check_refused(folder, "directory");

    /* Standard input from a pipe that stays open. */
    CHECK(pipe(pipe_ends) == 0);
    CHECK(dup2(pipe_ends[0], 0) == 0);
    check_refused("/dev/stdin", "FIFO");

    /* It takes no room on the disk. */
    snprintf(path, sizeof path, "%s/sparse.obj", folder);
    file = fopen(path, "wb");
    if (CHECK(file != NULL)) {
        CHECK(ftruncate(fileno(file), (off_t)TOO_LARGE) == 0);
        fclose(file);
        check_refused(path, "4294967296 bytes");
        remove(path);
    }

    /* A link to a regular file is as good as the file, also as standard input. */
    snprintf(path, sizeof path, "%s/linked.tri", folder);
    snprintf(link_path, sizeof link_path, "%s/link.tri", folder);
    unlink(link_path);
    file = fopen(path, "wb");
    if (CHECK(file != NULL)) {
        CHECK(fputs(MESH, file) >= 0 && fclose(file) == 0);
        CHECK(symlink("linked.tri", link_path) == 0);
        CHECK_OK(swiftprox_shape_create_from_file(link_path, NULL, &shape));
        swiftprox_shape_release(shape);
        CHECK(freopen(path, "rb", stdin) != NULL);
        CHECK_OK(swiftprox_shape_create_from_file("/dev/stdin", NULL, &shape));
        swiftprox_shape_release(shape);
        unlink(link_path);
        remove(path);
    }

    memset(long_path, 'a', sizeof long_path - 1);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "39999 bytes", swiftprox_shape_create_from_file(long_path, NULL, &shape));
    CHECK(shape == NULL);
    return check_report("files");
}
