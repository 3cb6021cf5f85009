#include "poses.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBERS = 24 };

/* The whole file with a zero byte behind it, or null with a message printed. */
static char *read_all(const char *path, size_t *size)
{
    const bool standard_input = strcmp(path, "-") == 0;
    FILE *file = standard_input ? stdin : fopen(path, "rb");
    if (!file) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        return NULL;
    }
    size_t capacity = (size_t)1 << 16;
    size_t used = 0;
    char *text = malloc(capacity);
    while (text) {
        used += fread(text + used, 1, capacity - 1 - used, file);
        if (used < capacity - 1) {
            break;
        }
        char *larger = capacity <= SIZE_MAX / 2 ? realloc(text, capacity * 2) : NULL;
        if (!larger) {
            free(text);
        }
        text = larger;
        capacity *= 2;
    }
    if (!text) {
        fprintf(stderr, "%s: no memory for the file\n", path);
    } else if (ferror(file)) { /* a directory opens, but does not read */
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        free(text);
        text = NULL;
    } else {
        text[used] = '\0';
        *size = used;
    }
    if (!standard_input) {
        fclose(file);
    }
    return text;
}

static char *skip_blanks(char *at)
{
    while (isspace((unsigned char)*at)) {
        at++;
    }
    return at;
}

/* Reads the 24 numbers of one line, which ends with a zero byte at `end`. */
static bool parse_line(const char *path, size_t line, char *at, const char *end, struct pose_pair *pair)
{
    size_t found = 0;
    for (at = skip_blanks(at); at != end; at = skip_blanks(at), found++) {
        char *behind;
        const double value = strtod(at, &behind);
        if (behind == at || !(isspace((unsigned char)*behind) || behind == end)) {
            const int shown = (int)strcspn(at, " \t\r\v\f");
            fprintf(stderr, "%s:%zu: '%.*s' is not a number\n", path, line, shown < 40 ? shown : 40, at);
            return false;
        }
        if (!isfinite(value)) {
            fprintf(stderr, "%s:%zu: number %zu is not finite (%.*s)\n", path, line, found + 1,
                    behind - at < 40 ? (int)(behind - at) : 40, at);
            return false;
        }
        if (found < NUMBERS) {
            double *pose = found < 12 ? pair->first : pair->second;
            pose[found % 12] = value;
        }
        at = behind;
    }
    if (found != NUMBERS) {
        fprintf(stderr, "%s:%zu: %zu numbers where a query has %d\n", path, line, found, NUMBERS);
        return false;
    }
    return true;
}

/* Makes room for one more query. */
static bool grow(struct pose_list *list, size_t *capacity)
{
    if (list->count < *capacity) {
        return true;
    }
    const size_t larger = *capacity ? *capacity * 2 : 1024;
    if (larger > SIZE_MAX / sizeof *list->pairs) {
        return false;
    }
    struct pose_pair *pairs = realloc(list->pairs, larger * sizeof *pairs);
    if (pairs) {
        list->pairs = pairs;
    }
    size_t *lines = realloc(list->lines, larger * sizeof *lines);
    if (lines) {
        list->lines = lines;
    }
    if (!pairs || !lines) {
        return false;
    }
    *capacity = larger;
    return true;
}

bool pose_list_read(const char *path, size_t limit, struct pose_list *list)
{
    *list = (struct pose_list){0};
    size_t size = 0;
    char *text = read_all(path, &size);
    if (!text) {
        return false;
    }
    bool good = true;
    size_t capacity = 0;
    size_t line = 0;
    char *next = text;
    while (good && list->count < limit && next < text + size) {
        char *start = next;
        char *end = memchr(start, '\n', (size_t)(text + size - start));
        if (!end) {
            end = text + size;
        }
        *end = '\0';
        next = end + 1;
        line++;
        char *first = skip_blanks(start);
        if (first == end || *first == '#') {
            continue;
        }
        if (!grow(list, &capacity)) {
            fprintf(stderr, "%s:%zu: no memory for more queries\n", path, line);
            good = false;
        } else if ((good = parse_line(path, line, first, end, &list->pairs[list->count]))) {
            list->lines[list->count++] = line;
        }
    }
    free(text);
    return good;
}

void pose_list_free(struct pose_list *list)
{
    free(list->pairs);
    free(list->lines);
    *list = (struct pose_list){0};
}
