#include "output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool refuse(const char *path, const char *why)
{
    fprintf(stderr, "%s: it cannot be written: %s\n", path, why);
    return false;
}

static void forget(struct output_file *output)
{
    free(output->path);
    free(output->part_path);
}

bool output_file_open(struct output_file *output, const char *path)
{
    struct stat about;
    const bool is_there = stat(path, &about) == 0;
    if (is_there && !S_ISREG(about.st_mode)) {
        return refuse(path, S_ISDIR(about.st_mode) ? "it is a folder" : "it is a device or a pipe");
    }
    char *const whole_path = is_there ? realpath(path, NULL) : strdup(path);
    const size_t room = whole_path ? strlen(whole_path) + 32 : 0;
    *output = (struct output_file){.path = whole_path, .part_path = whole_path ? malloc(room) : NULL};
    int descriptor = -1;
    if (output->part_path) {
        snprintf(output->part_path, room, "%s.%ld.part", whole_path, (long)getpid());
        descriptor = open(output->part_path, O_WRONLY | O_CREAT | O_EXCL, 0666);
    }
    output->file = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (!output->file) {
        refuse(path, strerror(errno));
        forget(output);
    }
    return output->file != NULL;
}

bool output_file_close(struct output_file *output, bool is_whole)
{
    bool is_good = fflush(output->file) == 0 && !ferror(output->file);
    is_good = fclose(output->file) == 0 && is_good;
    if (is_good && is_whole) {
        is_good = rename(output->part_path, output->path) == 0;
    }
    if (!is_good && is_whole) {
        refuse(output->path, strerror(errno ? errno : EIO)); /* what failed last has left its number */
    }
    is_good = is_good && is_whole;
    if (!is_good) {
        remove(output->part_path);
    }
    forget(output);
    return is_good;
}

bool output_file_try(const char *path)
{
    struct output_file output;
    if (!output_file_open(&output, path)) {
        return false;
    }
    fclose(output.file);
    remove(output.part_path);
    forget(&output);
    return true;
}
