#define _POSIX_C_SOURCE 200809L

#include "oracle.h"

#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void write_question(FILE *file, const struct scene *scene, const size_t *poses, size_t count)
{
    for (int k = 0; k < 2; ++k) {
        const struct body *body = &scene->bodies[k];
        fprintf(file, "%zu\n", body->point_count);
        for (size_t i = 0; i < 3 * body->point_count; ++i)
            fprintf(file, "%.17g\n", body->points[i]);
    }
    for (size_t i = 0; i < count; ++i)
        for (int j = 0; j < 24; ++j)
            fprintf(file, "%.17g\n", scene->poses[poses[i]][j]);
}

/* Runs a program with files as its standard input and output; 0 when it fails. */
static int run(const char *program, FILE *input, FILE *output)
{
    fflush(NULL);
    rewind(input);
    pid_t child = fork();
    if (child == 0) {
        if (lseek(fileno(input), 0, SEEK_SET) == 0 && dup2(fileno(input), STDIN_FILENO) >= 0 &&
            dup2(fileno(output), STDOUT_FILENO) >= 0)
            execl(program, program, (char *)NULL);
        _exit(127);
    }
    int status = 1;
    return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

int oracle_judge(const char *program, const struct scene *scene, const size_t *poses, size_t count,
                 struct truth *truths)
{
    if (count == 0)
        return 1;
    FILE *question = tmpfile(), *answer = tmpfile();
    int answered = 0;
    if (question != NULL && answer != NULL) {
        write_question(question, scene, poses, count);
        answered = run(program, question, answer);
        rewind(answer);
    }
    for (size_t i = 0; answered && i < count; ++i) {
        char verdict[16];
        answered = fscanf(answer, "%15s %lf %lf", verdict, &truths[i].lower, &truths[i].upper) == 3;
        truths[i].intersecting = strcmp(verdict, "intersecting") == 0;
    }
    if (question != NULL)
        fclose(question);
    if (answer != NULL)
        fclose(answer);
    return answered;
}
