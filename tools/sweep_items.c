#include "sweep_items.h"

#include <stdlib.h>

#include "text.h"

uint64_t sweep_digest(uint64_t digest, const void *bytes, size_t count)
{
    const unsigned char *const at = bytes;
    for (size_t i = 0; i < count; i++) {
        digest = (digest ^ at[i]) * UINT64_C(0x100000001b3);
    }
    return digest;
}

/* By the words of the first line; what is neither is taken for a pose, whose message then says how many numbers there should be. */
static enum sweep_kind kind_of(const struct text_line *line)
{
    size_t words = 0;
    for (char *at = line->text; at < line->end; at = text_skip_blanks(text_word_end(at))) {
        words++;
    }
    return words > SWEEP_POSES ? SWEEP_MOTIONS : SWEEP_POSES;
}

/* Makes room for one more. */
static bool grow(struct sweep_items *items, size_t *capacity)
{
    if (items->count < *capacity) {
        return true;
    }
    const size_t larger = *capacity ? *capacity * 2 : 1024;
    double *const numbers =
        larger > SIZE_MAX / SWEEP_MOTIONS / sizeof *numbers ? NULL : realloc(items->numbers, larger * items->kind * sizeof *numbers);
    if (numbers) {
        items->numbers = numbers;
        *capacity = larger;
    }
    return numbers != NULL;
}

bool sweep_items_read(const char *path, struct sweep_items *items)
{
    *items = (struct sweep_items){.kind = SWEEP_POSES, .digest = SWEEP_DIGEST_START};
    struct text_file file;
    if (!text_open(path, &file)) {
        return false;
    }
    bool good = true;
    size_t capacity = 0;
    struct text_line line;
    while (good && text_next(&file, &line)) {
        if (*line.text == '#') {
            continue;
        }
        if (items->count == 0) {
            items->kind = kind_of(&line);
        }
        if (!grow(items, &capacity)) {
            good = text_refuse(&line, "no memory for more lines");
            break;
        }
        double *const numbers = items->numbers + items->kind * items->count;
        good = text_numbers(&line, line.text, numbers, items->kind, items->kind == SWEEP_POSES ? "a pose" : "a motion");
        items->digest = sweep_digest(items->digest, numbers, items->kind * sizeof *numbers);
        items->count += good;
    }
    good = good && !file.is_refused;
    text_close(&file);
    return good;
}

void sweep_items_free(struct sweep_items *items)
{
    free(items->numbers);
    *items = (struct sweep_items){.kind = items->kind};
}
