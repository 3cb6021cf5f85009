#include "progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

struct progress progress_start(void)
{
    return (struct progress){.shown = isatty(STDERR_FILENO), .shares_terminal = isatty(STDOUT_FILENO), .next = seconds() + 0.5};
}

void progress_erase(const struct progress *progress)
{
    if (progress->shown) {
        fputs("\r\033[K", stderr);
    }
}

bool progress_draw(struct progress *progress, double fraction)
{
    enum { WIDTH = 40 };
    if (!progress->shown) {
        return false;
    }
    const double now = seconds();
    const bool due = now >= progress->next;
    if (progress->shares_terminal) { /* the answers so far go above the bar, never into it */
        progress_erase(progress);
        fflush(stdout);
    }
    if (due) {
        const int filled = (int)((double)WIDTH * fraction);
        fprintf(stderr, "\r[%.*s%*s] ", filled, "########################################", WIDTH - filled, "");
        progress->next = progress->shares_terminal ? now : now + 0.1;
    }
    return due;
}

void progress_look(struct progress *progress, size_t done, size_t total)
{
    if (progress_draw(progress, (double)done / (double)total)) {
        fprintf(stderr, "%zu of %zu", done, total);
        fflush(stderr);
    }
}
