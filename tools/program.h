/* What the tools and the C examples share as programs: their command line, and how they end. One set of rules for all:
 *
 *   --help, -h and --version answer on the standard output, wherever they stand, and the program ends well.
 *   The value of an option is the next word, or stands behind `=`. A word that begins with -- is a value only there.
 *   What stands behind -- is no option, and neither is a lone -.
 *   An option given twice counts as it was given last.
 *   Whatever else is wrong is refused with a message that names it, and the exit status BAD_INPUT: an option that is not known, a
 *   value that is missing, too much or out of range, an operand too many or too few, an option without a meaning beside the others.
 *   A file that is to be written is tried before anything runs. */
#ifndef SWIFTPROX_TOOLS_PROGRAM_H
#define SWIFTPROX_TOOLS_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>

enum exit_status { GOOD = 0, FAILED = 1, BAD_INPUT = 2 };

/* A program's name, and what --help prints. */
struct program {
    const char *name;
    const char *usage;
    const char *help;
};

/* What an option takes, and the type of what `value` points to. */
enum option_kind {
    OPTION_FLAG,   /* nothing: a bool that becomes true */
    OPTION_CHOICE, /* one of `choices`: an int, its position */
    OPTION_COUNT,  /* a whole number from 1 to `most`: a size_t */
    OPTION_AMOUNT, /* a number from 0 on: a double, which may be infinite */
    OPTION_OUTPUT, /* a file to be written: a const char * */
};

struct program_option {
    const char *name; /* with its -- */
    enum option_kind kind;
    void *value;
    const char *const *choices; /* null behind the last */
    size_t most;                /* 0: as many as a size_t can say */
    bool is_given;
};

/* A command line: what it may say, and where that goes. */
struct command_line {
    const struct program *program;
    struct program_option *options;
    size_t option_count;
    const char **operands; /* room for `most_operands` */
    size_t least_operands;
    size_t most_operands;
    const char *operands_wanted; /* in words */
    size_t operand_count;        /* how many there were */
};

/* Reads the command line. False if the program is to end now, with `*status`, because its question was answered or a message
 * printed. */
bool command_line_read(struct command_line *line, int argc, char **argv, int *status);

/* The name of the program whose command line was read. */
const char *program_name(void);

/* Whether the option of this name was given. */
bool command_line_has(const struct command_line *line, const char *name);

/* Prints why the command line is refused, as printf does, and the usage; BAD_INPUT. */
int program_refuse(const struct program *program, const char *format, ...);

/* Prints the last message of the library on the standard error, with options of the tools where it names constants of C. */
void program_print_library_message(void);

/* Writes out what was printed. The program's exit status: `status`, or FAILED with a message if the output cannot be written. */
int program_end(const struct program *program, int status);

#endif
