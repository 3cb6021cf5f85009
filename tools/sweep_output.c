#include "sweep_output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "program.h"

static bool refuse(const char *path, const char *why)
{
    fprintf(stderr, "%s: it cannot be written: %s\n", path, why);
    return false;
}

/* Notes the outcome that a line begins with. */
static void note(struct sweep_tally *tally, const char *line)
{
    for (int i = 0; i < SWEEP_OUTCOMES; i++) {
        const size_t length = strlen(SWEEP_WORDS[i]);
        if (strncmp(line, SWEEP_WORDS[i], length) == 0 && line[length] == ' ') {
            tally->outcomes[i]++;
        }
    }
}

/* Reads what an earlier run has written: whole shares of `share` lines behind the head, and where they end. A line without its end
 * was being written when that run was killed. */
static bool read_shares(struct sweep_output *output, const char *head, size_t count, size_t share, long *end)
{
    char line[4 * SWEEP_LINE];
    if (!fgets(line, sizeof line, output->file)) {
        *end = 0;
        return true; /* killed before anything was written */
    }
    if (strcmp(line, head) != 0) {
        /* A head without its end is of a run that was killed as it wrote it. */
        *end = 0;
        return !strchr(line, '\n') && strncmp(line, head, strlen(line)) == 0;
    }
    *end = ftell(output->file);
    struct sweep_tally tally = {{0}, 0, 0, 0};
    for (size_t lines = 0; fgets(line, sizeof line, output->file) && strchr(line, '\n') && lines < count;) {
        note(&tally, line);
        lines++;
        if (lines % share == 0 || lines == count) {
            *end = ftell(output->file);
            output->written++;
            output->found = tally;
        }
    }
    return true;
}

/* The file for writing behind what stays of it. */
static int go_on(struct sweep_output *output, const char *head, size_t count, size_t share)
{
    long end = 0;
    if (!read_shares(output, head, count, share, &end)) {
        fprintf(stderr, "%s: it is of another sweep: remove it, or give --out another name\n", output->part_path);
        return BAD_INPUT;
    }
    if (ferror(output->file) || fseek(output->file, end, SEEK_SET) != 0 || ftruncate(fileno(output->file), end) != 0
        || (end == 0 && (fputs(head, output->file) < 0 || fflush(output->file) != 0))) {
        refuse(output->part_path, strerror(errno));
        return FAILED;
    }
    return GOOD;
}

static void forget(struct sweep_output *output)
{
    for (size_t i = 0; output->waiting && i < output->share_count; i++) {
        free(output->waiting[i]);
    }
    free(output->waiting);
    free(output->part_path);
}

int sweep_output_open(struct sweep_output *output, const char *path, const char *head, size_t count, size_t share)
{
    const size_t shares = (count + share - 1) / share, room = strlen(path) + sizeof ".part";
    *output = (struct sweep_output){.path = path, .share_count = shares};
    output->part_path = malloc(room);
    output->waiting = calloc(shares + 1, sizeof *output->waiting);
    if (!output->part_path || !output->waiting) {
        fputs("swiftprox-sweep: no memory for so many results\n", stderr);
        forget(output);
        return FAILED;
    }
    snprintf(output->part_path, room, "%s.part", path);
    /* A device or a folder would be replaced in the end. */
    const char *const paths[] = {path, output->part_path};
    for (int i = 0; i < 2; i++) {
        struct stat about;
        if (stat(paths[i], &about) == 0 && !S_ISREG(about.st_mode)) {
            refuse(paths[i], "it is no regular file");
            forget(output);
            return BAD_INPUT;
        }
    }
    output->file = fopen(output->part_path, "r+b");
    output->file = output->file ? output->file : fopen(output->part_path, "w+b");
    if (!output->file) {
        refuse(output->part_path, strerror(errno));
        forget(output);
        return BAD_INPUT;
    }
    const int status = go_on(output, head, count, share);
    if (status != GOOD) {
        fclose(output->file);
        forget(output);
    }
    return status;
}

bool sweep_output_take(struct sweep_output *output, size_t share, char *lines)
{
    output->waiting[share] = lines;
    bool is_good = true;
    while (is_good && output->written < output->share_count && output->waiting[output->written]) {
        char **const next = &output->waiting[output->written];
        is_good = fputs(*next, output->file) >= 0;
        free(*next);
        *next = NULL;
        output->written++;
    }
    /* A run that is killed from here on has left these to the next. */
    is_good = is_good && fflush(output->file) == 0;
    return is_good || refuse(output->part_path, strerror(errno));
}

bool sweep_output_close(struct sweep_output *output)
{
    const bool is_whole = output->written == output->share_count;
    bool is_good = fflush(output->file) == 0 && fsync(fileno(output->file)) == 0;
    is_good = fclose(output->file) == 0 && is_good;
    if (is_good && is_whole) {
        is_good = rename(output->part_path, output->path) == 0;
    }
    if (!is_good && is_whole) {
        refuse(output->path, strerror(errno));
    }
    forget(output);
    return is_good;
}
