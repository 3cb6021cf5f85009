#include "text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
        if (first != end) {
            *line = (struct text_line){file->path, file->line, first, end};
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
