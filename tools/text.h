/* Text files of lines that are words and numbers: read as a whole, every complaint with the file and the line. */
#ifndef SWIFTPROX_TOOLS_TEXT_H
#define SWIFTPROX_TOOLS_TEXT_H

#include <stdbool.h>
#include <stddef.h>

struct text_file {
    const char *path;
    char *text;
    char *next; /* where the next line starts */
    char *end;
    size_t line;
    bool is_refused; /* a line of it, after a message */
};

/* A line that is not blank. It lives as long as its file and ends with a zero byte, the only one in it. */
struct text_line {
    const char *path;
    size_t number; /* counted from 1 */
    char *text;    /* from its first character that is not blank */
    char *end;     /* its zero byte */
};

/* Whether this is a regular file, and neither the standard input nor a pipe or device. */
bool text_is_regular(const char *path);

/* Whether both paths are of one file that is there. */
bool text_is_same(const char *left, const char *right);

/* Reads the file, or the standard input when `path` is "-": a regular file, a pipe or a terminal, up to a limit.
 * On failure it prints a message on the standard error and returns
 * false; there is nothing to close then. */
bool text_open(const char *path, struct text_file *file);

/* The next line that is not blank. False at the end, and after a message where a line has a zero byte: the file is no text. Look at
 * `is_refused` for which it was. */
bool text_next(struct text_file *file, struct text_line *line);

void text_close(struct text_file *file);

/* The end of the word that starts here. */
char *text_word_end(char *at);

/* The first character from here on that is not blank, or the end of the line. */
char *text_skip_blanks(char *at);

/* Reads exactly `count` finite numbers from `at` to the end of the line. `whose` stands in the message if there are others. */
bool text_numbers(const struct text_line *line, char *at, double *numbers, size_t count, const char *whose);

/* Prints file, line and message on the standard error; always false. */
bool text_refuse(const struct text_line *line, const char *message);

#endif
