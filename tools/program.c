#include "program.h"

#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <swiftprox.h>

/* The program that runs. */
static const char *name_of_program = "";

const char *program_name(void)
{
    return name_of_program;
}

/* ---- messages ---- */

int program_refuse(const struct program *program, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s: ", program->name);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "\n%s%s --help tells more\n", program->usage, program->name);
    va_end(arguments);
    return BAD_INPUT;
}

void program_print_library_message(void)
{
    static const char *const WORDS[][2] = {
        {"the input policy Flat (SWIFTPROX_INPUT_FLAT)", "--input flat"},
        {"the input policy Hull (SWIFTPROX_INPUT_HULL)", "--input hull"},
        {"the input policy Patch (SWIFTPROX_INPUT_PATCH)", "--input patch"},
    };
    const char *message = swiftprox_library_last_error_message();
    for (;;) {
        const char *found = NULL, *const *words = NULL;
        for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS; i++) {
            const char *const at = strstr(message, WORDS[i][0]);
            if (at && (!found || at < found)) {
                found = at;
                words = WORDS[i];
            }
        }
        if (!found) {
            fprintf(stderr, "%s\n", message);
            return;
        }
        fprintf(stderr, "%.*s%s", (int)(found - message), message, words[1]);
        message = found + strlen(words[0]);
    }
}

int program_end(const struct program *program, int status)
{
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == GOOD) {
        fprintf(stderr, "%s: the output cannot be written: %s\n", program->name, strerror(errno));
        return FAILED;
    }
    return status;
}

/* ---- values ---- */

static bool read_choice(const char *word, const char *const *choices, int *value)
{
    for (int i = 0; choices[i]; i++) {
        if (strcmp(word, choices[i]) == 0) {
            *value = i;
            return true;
        }
    }
    return false;
}

static bool read_count(const char *word, size_t most, size_t *value)
{
    errno = 0;
    const unsigned long long number = strtoull(word, NULL, 10);
    /* strtoull takes signs and leading blanks, too. */
    if (*word == '\0' || word[strspn(word, "0123456789")] != '\0' || errno != 0 || number == 0 || number > most) {
        return false;
    }
    *value = (size_t)number;
    return true;
}

static bool read_amount(const char *word, double *value)
{
    char *end;
    const double number = strtod(word, &end);
    if (end == word || *end != '\0' || !(number >= 0)) {
        return false;
    }
    *value = number;
    return true;
}

/* Whether the file can be written, which leaves it as it is. On false errno says why not. Ranks of one job ask at the same time, so
 * another may have removed what this one made. */
static bool can_be_written(const char *path)
{
    FILE *file = fopen(path, "r+b"); /* waits for nobody at the other end of a pipe */
    const bool is_new = !file && errno == ENOENT;
    if (!file) {
        file = fopen(path, "ab");
    }
    if (!file) {
        return false;
    }
    fclose(file);
    return !is_new || remove(path) == 0 || errno == ENOENT;
}

/* Takes the value; false after a message. */
static bool take_value(const struct command_line *line, struct program_option *option, const char *word)
{
    const struct program *const program = line->program;
    const size_t most = option->most ? option->most : SIZE_MAX;
    bool is_good = true;
    option->is_given = true;
    switch (option->kind) {
    case OPTION_FLAG:
        *(bool *)option->value = true;
        break;
    case OPTION_CHOICE:
        is_good = read_choice(word, option->choices, option->value);
        if (!is_good) {
            program_refuse(program, "%s does not know %s", option->name, word);
        }
        break;
    case OPTION_COUNT:
        is_good = read_count(word, most, option->value);
        if (!is_good) {
            program_refuse(program, "%s wants a whole number from 1 to %zu, not %s", option->name, most, word);
        }
        break;
    case OPTION_AMOUNT:
        is_good = read_amount(word, option->value);
        if (!is_good) {
            program_refuse(program, "%s wants a number from 0 on, not %s", option->name, word);
        }
        break;
    case OPTION_OUTPUT:
        is_good = can_be_written(word);
        if (!is_good) {
            program_refuse(program, "%s %s: it cannot be written: %s", option->name, word, strerror(errno));
        }
        *(const char **)option->value = word;
        break;
    }
    return is_good;
}

/* ---- the command line ---- */

/* Answers --help and --version; false if neither was asked for. */
static bool tells(const struct program *program, int argc, char **argv)
{
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            printf("%s%s", program->usage, program->help);
            return true;
        }
        if (strcmp(argv[i], "--version") == 0) {
            printf("%s %s\n", program->name, swiftprox_library_version());
            return true;
        }
    }
    return false;
}

/* The option that the word names, up to its `=`, or null. */
static struct program_option *find_option(const struct command_line *line, const char *word)
{
    const size_t length = strcspn(word, "=");
    for (size_t i = 0; i < line->option_count; i++) {
        const char *const name = line->options[i].name;
        if (strlen(name) == length && strncmp(word, name, length) == 0) {
            return &line->options[i];
        }
    }
    return NULL;
}

/* Takes the option at `argv[*at]` and its value, and leaves `*at` at the last word of them; false after a message. */
static bool take_option(const struct command_line *line, int argc, char **argv, int *at)
{
    const char *const word = argv[*at];
    const char *const equals = strchr(word, '=');
    struct program_option *const option = find_option(line, word);
    if (!option) {
        program_refuse(line->program, "unknown option %.*s", (int)strcspn(word, "="), word);
        return false;
    }
    if (option->kind == OPTION_FLAG) {
        if (equals) {
            program_refuse(line->program, "%s takes no value", option->name);
            return false;
        }
        return take_value(line, option, NULL);
    }
    if (equals) {
        return take_value(line, option, equals + 1);
    }
    if (*at + 1 == argc || strncmp(argv[*at + 1], "--", 2) == 0) {
        program_refuse(line->program, "%s wants a value", option->name);
        return false;
    }
    ++*at;
    return take_value(line, option, argv[*at]);
}

static bool take_operand(struct command_line *line, const char *word)
{
    if (line->operand_count == line->most_operands) {
        program_refuse(line->program, "one argument too many: %s", word);
        return false;
    }
    line->operands[line->operand_count++] = word;
    return true;
}

bool command_line_read(struct command_line *line, int argc, char **argv, int *status)
{
    name_of_program = line->program->name;
    if (tells(line->program, argc, argv)) {
        *status = program_end(line->program, GOOD);
        return false;
    }
    *status = BAD_INPUT;
    bool ended = false; /* the options, by -- */
    for (int i = 1; i < argc; i++) {
        const bool is_operand = ended || argv[i][0] != '-' || argv[i][1] == '\0';
        if (!is_operand && strcmp(argv[i], "--") == 0) {
            ended = true;
        } else if (!(is_operand ? take_operand(line, argv[i]) : take_option(line, argc, argv, &i))) {
            return false;
        }
    }
    if (line->operand_count < line->least_operands) {
        program_refuse(line->program, "%s", line->operands_wanted);
        return false;
    }
    *status = GOOD;
    return true;
}

bool command_line_has(const struct command_line *line, const char *name)
{
    const struct program_option *const option = find_option(line, name);
    return option && option->is_given;
}
