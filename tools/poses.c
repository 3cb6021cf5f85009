#include "poses.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

enum { NUMBERS = 24, MOST_MOMENTS = 2 };

static bool parse_line(const struct text_line *line, size_t moments, struct pose_pair *pairs)
{
    double numbers[NUMBERS * MOST_MOMENTS];
    if (!text_numbers(line, line->text, numbers, NUMBERS * moments, "a query")) {
        return false;
    }
    for (size_t i = 0; i < moments; i++) {
        memcpy(pairs[i].first, numbers + NUMBERS * i, sizeof pairs[i].first);
        memcpy(pairs[i].second, numbers + NUMBERS * i + 12, sizeof pairs[i].second);
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
    if (larger > SIZE_MAX / MOST_MOMENTS / sizeof *list->pairs) {
        return false;
    }
    struct pose_pair *pairs = realloc(list->pairs, larger * list->moments * sizeof *pairs);
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

bool pose_list_read(const char *path, size_t moments, size_t limit, struct pose_list *list)
{
    *list = (struct pose_list){.moments = moments};
    struct text_file file;
    if (!text_open(path, &file)) {
        return false;
    }
    bool good = true;
    size_t capacity = 0;
    struct text_line line;
    while (good && list->count < limit && text_next(&file, &line)) {
        if (*line.text == '#') {
            continue;
        }
        if (!grow(list, &capacity)) {
            text_refuse(&line, "no memory for more queries");
            good = false;
        } else if ((good = parse_line(&line, moments, &list->pairs[moments * list->count]))) {
            list->lines[list->count++] = line.number;
        }
    }
    good = good && !file.is_refused;
    text_close(&file);
    return good;
}

void pose_list_free(struct pose_list *list)
{
    free(list->pairs);
    free(list->lines);
    *list = (struct pose_list){0};
}
