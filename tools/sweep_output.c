#include "sweep_output.h"

#include <errno.h>
#include <inttypes.h>
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

enum share_state { SHARE_WHOLE, SHARE_ENDS, SHARE_CHANGED };

/* Reads a share of so many lines, which go to the digest and the tally. One that ends early was being written when the run was
 * killed. */
static enum share_state read_share(FILE *file, size_t lines, uint64_t *digest, struct sweep_tally *tally)
{
    char line[4 * SWEEP_LINE];
    for (size_t i = 0; i < lines; i++) {
        if (!fgets(line, sizeof line, file) || !strchr(line, '\n')) {
            return feof(file) ? SHARE_ENDS : SHARE_CHANGED;
        }
        *digest = sweep_digest(*digest, line, strlen(line));
        note(tally, line);
    }
    return SHARE_WHOLE;
}

/* A checksum is 16 hexadecimal digits and the end of the line. */
enum { SUM = 17 };

static void write_sum(char text[SUM + 1], uint64_t digest)
{
    snprintf(text, SUM + 1, "%016" PRIx64 "\n", digest);
}

/* Reads the shares of an earlier run behind the head, as far as their checksums go. False if one is not what was written. */
static bool read_shares(struct sweep_output *output, size_t count, size_t share, long *end)
{
    char found[SUM], wanted[SUM + 1];
    while (output->written < output->share_count && fread(found, 1, SUM, output->sums) == SUM) {
        const size_t left = count - share * output->written;
        struct sweep_tally tally = output->found;
        uint64_t digest = output->digest;
        const enum share_state state = read_share(output->file, left < share ? left : share, &digest, &tally);
        write_sum(wanted, digest);
        if (state != SHARE_WHOLE || memcmp(found, wanted, SUM) != 0) {
            return state == SHARE_ENDS;
        }
        *end = ftell(output->file);
        output->written++;
        output->digest = digest;
        output->found = tally;
    }
    return true;
}

/* Reads the head of an earlier run, and where it ends: 0 if that was killed as it wrote it. False if it is of another sweep. */
static bool read_head(struct sweep_output *output, const char *head, long *end)
{
    char line[4 * SWEEP_LINE];
    *end = 0;
    if (!fgets(line, sizeof line, output->file)) {
        return true;
    }
    if (strcmp(line, head) != 0) {
        return !strchr(line, '\n') && strncmp(line, head, strlen(line)) == 0;
    }
    *end = ftell(output->file);
    return true;
}

/* Cuts a file off, for writing behind what stays. */
static bool cut_off(FILE *file, long end)
{
    return !ferror(file) && fseek(file, end, SEEK_SET) == 0 && ftruncate(fileno(file), end) == 0;
}

/* The files for writing behind what stays of them. */
static int go_on(struct sweep_output *output, const char *head, size_t count, size_t share)
{
    long end;
    if (!read_head(output, head, &end)) {
        fprintf(stderr, "%s: it is of another sweep: remove it, or give --out another name\n", output->part_path);
        return BAD_INPUT;
    }
    output->digest = sweep_digest(SWEEP_DIGEST_START, head, strlen(head));
    if (end > 0 && !read_shares(output, count, share, &end)) {
        fprintf(stderr, "%s: it was changed behind result %zu: what follows is answered again\n", output->part_path,
                share * output->written);
    }
    if (!cut_off(output->file, end) || (end == 0 && (fputs(head, output->file) < 0 || fflush(output->file) != 0))) {
        refuse(output->part_path, strerror(errno));
        return FAILED;
    }
    if (!cut_off(output->sums, (long)(SUM * output->written))) {
        refuse(output->sums_path, strerror(errno));
        return FAILED;
    }
    return GOOD;
}

/* False where a write failed. */
static bool close_files(struct sweep_output *output)
{
    const bool is_written = !output->file || fclose(output->file) == 0;
    return (!output->sums || fclose(output->sums) == 0) && is_written;
}

static void forget(struct sweep_output *output)
{
    for (size_t i = 0; output->waiting && i < output->share_count; i++) {
        free(output->waiting[i]);
    }
    free(output->waiting);
    free(output->part_path);
    free(output->sums_path);
}

/* Whether nothing is there but regular files: a device or a folder would be replaced in the end. */
static bool are_files(const char *const *paths, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        struct stat about;
        if (stat(paths[i], &about) == 0 && !S_ISREG(about.st_mode)) {
            return refuse(paths[i], "it is no regular file");
        }
    }
    return true;
}

/* The file as it is, or a new one; null after a message. */
static FILE *open_file(const char *path)
{
    FILE *file = fopen(path, "r+b");
    file = file ? file : fopen(path, "w+b");
    if (!file) {
        refuse(path, strerror(errno));
    }
    return file;
}

int sweep_output_open(struct sweep_output *output, const char *path, const char *head, size_t count, size_t share)
{
    const size_t shares = (count + share - 1) / share, room = strlen(path) + sizeof ".part.sums";
    *output = (struct sweep_output){.path = path, .share_count = shares};
    output->part_path = malloc(room);
    output->sums_path = malloc(room);
    output->waiting = calloc(shares + 1, sizeof *output->waiting);
    if (!output->part_path || !output->sums_path || !output->waiting) {
        fputs("swiftprox-sweep: no memory for so many results\n", stderr);
        forget(output);
        return FAILED;
    }
    snprintf(output->part_path, room, "%s.part", path);
    snprintf(output->sums_path, room, "%s.part.sums", path);
    const char *const paths[] = {path, output->part_path, output->sums_path};
    output->file = are_files(paths, 3) ? open_file(output->part_path) : NULL;
    output->sums = output->file ? open_file(output->sums_path) : NULL;
    const int status = output->sums ? go_on(output, head, count, share) : BAD_INPUT;
    if (status != GOOD) {
        close_files(output);
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
        char sum[SUM + 1];
        output->digest = sweep_digest(output->digest, *next, strlen(*next));
        write_sum(sum, output->digest);
        is_good = fputs(*next, output->file) >= 0 && fputs(sum, output->sums) >= 0;
        free(*next);
        *next = NULL;
        output->written++;
    }
    /* A run that is killed from here on has left these to the next. A checksum without its share is nothing. */
    is_good = is_good && fflush(output->file) == 0 && fflush(output->sums) == 0;
    return is_good || refuse(ferror(output->sums) ? output->sums_path : output->part_path, strerror(errno));
}

bool sweep_output_close(struct sweep_output *output)
{
    const bool is_whole = output->written == output->share_count;
    bool is_good = fflush(output->file) == 0 && fsync(fileno(output->file)) == 0;
    is_good = close_files(output) && is_good;
    if (is_good && is_whole) {
        is_good = rename(output->part_path, output->path) == 0;
        remove(output->sums_path);
    }
    if (!is_good && is_whole) {
        refuse(output->path, strerror(errno));
    }
    forget(output);
    return is_good;
}
