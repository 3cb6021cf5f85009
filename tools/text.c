#include "text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* More is no list of poses, but a pipe that never ends. */
static const size_t MOST_BYTES = (size_t)1 << 30;

bool text_is_regular(const char *path)
{
    struct stat about;
    return strcmp(path, "-") != 0 && stat(path, &about) == 0 && S_ISREG(about.st_mode);
}

bool text_is_same(const char *left, const char *right)
{
    struct stat one, other;
    return stat(left, &one) == 0 && stat(right, &other) == 0 && one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

/* Why the open file is not read, or null: devices may never end. */
static const char *why_not_read(FILE *file)
{
    struct stat about;
    if (fstat(fileno(file), &about) != 0) {
        return strerror(errno);
    }
    if (S_ISDIR(about.st_mode)) {
        return strerror(EISDIR);
    }
    if (S_ISBLK(about.st_mode) || (S_ISCHR(about.st_mode) && !isatty(fileno(file)))) {
        return "it is a device; regular files, pipes and terminals are read";
    }
    return NULL;
}

/* Everything up to the end, with a zero byte behind it; null with a message printed. */
static char *read_to_end(FILE *file, const char *path, size_t *size)
{
    size_t capacity = (size_t)1 << 16;
    char *text = malloc(capacity);
    *size = 0;
    while (text) {
        *size += fread(text + *size, 1, capacity - 1 - *size, file);
        if (*size < capacity - 1) {
            break;
        }
        if (*size >= MOST_BYTES) {
            fprintf(stderr, "%s: it is larger than %zu bytes, the most that is read\n", path, MOST_BYTES);
            free(text);
            return NULL;
        }
        char *const larger = realloc(text, capacity * 2);
        if (!larger) {
            free(text);
        }
        text = larger;
        capacity *= 2;
    }
    if (!text) {
        fprintf(stderr, "%s: no memory for the file\n", path);
        return NULL;
    }
    if (ferror(file)) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        free(text);
        return NULL;
    }
    text[*size] = '\0';
    return text;
}

/* The whole file with a zero byte behind it, or null with a message printed. */
static char *read_all(const char *path, size_t *size)
{
    const bool standard_input = strcmp(path, "-") == 0;
    FILE *const file = standard_input ? stdin : fopen(path, "rb");
    if (!file) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        return NULL;
    }
    const char *const problem = why_not_read(file);
    if (problem) {
        fprintf(stderr, "%s: %s\n", path, problem);
    }
    char *const text = problem ? NULL : read_to_end(file, path, size);
    if (!standard_input) {
        fclose(file);
    }
    return text;
}

bool text_open(const char *path, struct text_file *file)
{
    size_t size = 0;
    char *const text = read_all(path, &size);
    *file = (struct text_file){.path = path, .text = text, .next = text, .end = text ? text + size : NULL};
    return text != NULL;
}

char *text_skip_blanks(char *at)
{
    while (isspace((unsigned char)*at)) {
        at++;
    }
    return at;
}

char *text_word_end(char *at)
{
    while (*at != '\0' && !isspace((unsigned char)*at)) {
        at++;
    }
    return at;
}

bool text_next(struct text_file *file, struct text_line *line)
{
    while (file->next < file->end) {
        char *const start = file->next;
        char *end = memchr(start, '\n', (size_t)(file->end - start));
        if (!end) {
            end = file->end;
        }
        *end = '\0';
        file->next = end + 1;
        file->line++;
        char *const first = text_skip_blanks(start);
        *line = (struct text_line){file->path, file->line, first, end};
        /* Who looks for the end of a word would find one here. */
        if (strlen(first) < (size_t)(end - first)) {
            file->is_refused = true;
            return text_refuse(line, "a zero byte: this is UTF-16 or no text at all; save it as UTF-8 or ASCII");
        }
        if (first != end) {
            return true;
        }
    }
    return false;
}

void text_close(struct text_file *file)
{
    free(file->text);
    *file = (struct text_file){0};
}

bool text_refuse(const struct text_line *line, const char *message)
{
    fprintf(stderr, "%s:%zu: %s\n", line->path, line->number, message);
    return false;
}

bool text_numbers(const struct text_line *line, char *at, double *numbers, size_t count, const char *whose)
{
    size_t found = 0;
    for (at = text_skip_blanks(at); at != line->end; at = text_skip_blanks(at), found++) {
        char *behind;
        const double value = strtod(at, &behind);
        if (behind == at || !(isspace((unsigned char)*behind) || behind == line->end)) {
            const int shown = (int)strcspn(at, " \t\r\v\f");
            fprintf(stderr, "%s:%zu: '%.*s' is not a number\n", line->path, line->number, shown < 40 ? shown : 40, at);
            return false;
        }
        if (!isfinite(value)) {
            fprintf(stderr, "%s:%zu: number %zu is not finite (%.*s)\n", line->path, line->number, found + 1,
                    behind - at < 40 ? (int)(behind - at) : 40, at);
            return false;
        }
        if (found < count) {
            numbers[found] = value;
        }
        at = behind;
    }
    if (found != count) {
        fprintf(stderr, "%s:%zu: %zu numbers where %s has %zu\n", line->path, line->number, found, whose, count);
        return false;
    }
    return true;
}
