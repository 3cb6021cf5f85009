#include "scene_file.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

static const char HEAD[] = "# swiftprox scene 1";

/* An array with room for one more item than `count`, or null: it grows where its length is a power of two. */
static void *grown(void *items, size_t count, size_t size)
{
    if (count != 0 && (count & (count - 1)) != 0) {
        return items;
    }
    const size_t capacity = count == 0 ? 1 : 2 * count;
    return capacity <= SIZE_MAX / 2 / size ? realloc(items, capacity * size) : NULL;
}

/* Appends an item of zeros to an array; evaluates to false when there is no memory. */
#define PUSH(items, count)                                                                                                     \
    (push_items = grown((items), (count), sizeof *(items)),                                                                    \
     push_items ? ((items) = push_items, memset(&(items)[(count)], 0, sizeof *(items)), (count)++, true) : false)

static bool no_memory(const struct text_line *line)
{
    return text_refuse(line, "no memory for the scene");
}

static char *copy_of(const char *begin, const char *end)
{
    const size_t length = (size_t)(end - begin);
    char *copy = malloc(length + 1);
    if (copy) {
        memcpy(copy, begin, length);
        copy[length] = '\0';
    }
    return copy;
}

/* `name` as seen from the folder of the file `from`. */
static char *beside(const char *from, const char *name)
{
    const char *slash = strrchr(from, '/');
    if (*name == '/' || !slash) {
        return copy_of(name, name + strlen(name));
    }
    const size_t folder = (size_t)(slash - from) + 1;
    char *path = malloc(folder + strlen(name) + 1);
    if (path) {
        memcpy(path, from, folder);
        strcpy(path + folder, name);
    }
    return path;
}

/* Where a word of the line begins and ends. */
struct word {
    char *begin;
    char *end;
};

static struct word next_word(char *at)
{
    char *const begin = text_skip_blanks(at);
    return (struct word){begin, text_word_end(begin)};
}

static bool is_word(struct word word, const char *text)
{
    return (size_t)(word.end - word.begin) == strlen(text) && strncmp(word.begin, text, strlen(text)) == 0;
}

static size_t find_shape(const struct scene_file *scene, struct word name)
{
    size_t i = 0;
    while (i < scene->shape_count && !is_word(name, scene->shapes[i].name)) {
        i++;
    }
    return i;
}

/* shape NAME FILE */
static bool read_shape(const struct text_line *line, char *at, struct scene_file *scene)
{
    void *push_items;
    const struct word name = next_word(at);
    char *const file = text_skip_blanks(name.end);
    char *end = line->end;
    while (end > file && strchr(" \t\r\v\f", end[-1])) {
        end--; /* a file's name may hold blanks, but not end in one */
    }
    if (name.begin == name.end || file == end) {
        return text_refuse(line, "a shape is `shape NAME FILE`");
    }
    if (find_shape(scene, name) < scene->shape_count) {
        return text_refuse(line, "this shape has been named before");
    }
    if (!PUSH(scene->shapes, scene->shape_count)) {
        return no_memory(line);
    }
    struct scene_shape *const shape = &scene->shapes[scene->shape_count - 1];
    *end = '\0';
    shape->line = line->number;
    shape->name = copy_of(name.begin, name.end);
    shape->path = beside(line->path, file);
    return (shape->name && shape->path) || no_memory(line);
}

/* object NAME [fixed] */
static bool read_object(const struct text_line *line, char *at, struct scene_file *scene)
{
    void *push_items;
    const struct word name = next_word(at);
    const struct word option = next_word(name.end);
    const bool fixed = is_word(option, "fixed");
    if (name.begin == name.end || (option.begin != option.end && !fixed) || text_skip_blanks(option.end) != line->end) {
        return text_refuse(line, "an object is `object NAME` or `object NAME fixed`");
    }
    const size_t shape = find_shape(scene, name);
    if (shape == scene->shape_count) {
        return text_refuse(line, "no shape of this name is above");
    }
    if (scene->step_count > 0) {
        return text_refuse(line, "all objects stand above the first step");
    }
    if (!PUSH(scene->objects, scene->object_count)) {
        return no_memory(line);
    }
    scene->objects[scene->object_count - 1] = (struct scene_object){shape, fixed};
    return true;
}

/* NUMBER and a pose */
static bool read_move(const struct text_line *line, struct scene_file *scene)
{
    void *push_items;
    char *behind;
    errno = 0;
    const unsigned long long number = strtoull(line->text, &behind, 10);
    if (behind == line->text || behind != text_word_end(line->text) || *line->text == '-') {
        return text_refuse(line, "neither shape, object nor step, nor the number of an object that moves");
    }
    if (errno != 0 || number >= scene->object_count) {
        fprintf(stderr, "%s:%zu: object %.*s, but there are %zu, numbered from 0\n", line->path, line->number,
                (int)(behind - line->text), line->text, scene->object_count);
        return false;
    }
    if (scene->step_count == 0) {
        return text_refuse(line, "a move stands above the first step");
    }
    if (!PUSH(scene->moves, scene->move_count)) {
        return no_memory(line);
    }
    struct scene_move *const move = &scene->moves[scene->move_count - 1];
    move->object = (size_t)number;
    move->line = line->number;
    return text_numbers(line, behind, move->pose, 12, "a pose");
}

static bool read_line(const struct text_line *line, struct scene_file *scene)
{
    void *push_items;
    const struct word first = next_word(line->text);
    if (*line->text == '#') {
        return true;
    }
    if (is_word(first, "shape")) {
        return read_shape(line, first.end, scene);
    }
    if (is_word(first, "object")) {
        return read_object(line, first.end, scene);
    }
    if (!is_word(first, "step")) {
        return read_move(line, scene);
    }
    if (text_skip_blanks(first.end) != line->end) {
        return text_refuse(line, "`step` stands alone on its line");
    }
    if (!PUSH(scene->steps, scene->step_count)) {
        return no_memory(line);
    }
    scene->steps[scene->step_count - 1].first_move = scene->move_count;
    return true;
}

bool scene_file_read(const char *path, struct scene_file *scene)
{
    *scene = (struct scene_file){0};
    struct text_file file;
    if (!text_open(path, &file)) {
        return false;
    }
    struct text_line line;
    bool good = text_next(&file, &line) && line.number == 1 && strncmp(line.text, HEAD, strlen(HEAD)) == 0 &&
                text_skip_blanks(line.text + strlen(HEAD)) == line.end;
    if (!good) {
        fprintf(stderr, "%s:1: a scene begins with the line `%s`\n", path, HEAD);
    }
    while (good && text_next(&file, &line)) {
        good = read_line(&line, scene);
    }
    good = good && !file.is_refused;
    text_close(&file);
    return good;
}

size_t scene_file_moves_end(const struct scene_file *scene, size_t step)
{
    return step + 1 < scene->step_count ? scene->steps[step + 1].first_move : scene->move_count;
}

void scene_file_free(struct scene_file *scene)
{
    for (size_t i = 0; i < scene->shape_count; i++) {
        free(scene->shapes[i].name);
        free(scene->shapes[i].path);
    }
    free(scene->shapes);
    free(scene->objects);
    free(scene->moves);
    free(scene->steps);
    *scene = (struct scene_file){0};
}
