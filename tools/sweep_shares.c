#include "sweep_shares.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <mpi.h>

#include "progress.h"

/* From a rank to rank 0: the lines of a share, or none and so a first question for one. */
enum { TAG_RESULT = 1, TAG_SHARE = 2 };

/* What stands before the lines of a result, and before the numbers of a share. */
struct result_head {
    uint64_t share;
    double seconds;
    int32_t length;    /* of the lines that follow, without their last zero byte */
    int32_t is_answer; /* 0: a first question */
    int32_t failed;
};

struct share_head {
    uint64_t share;
    uint64_t count; /* 0: there are no more */
};

/* Seconds of the processor's that this rank has taken: other programs on the machine do not count. */
static double work_time(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* The lines of a share, in memory of their own; null after a message. `look` is called between items. */
static char *answer(const struct sweep *sweep, const double *numbers, size_t count, struct sweep_tally *tally, void (*look)(void *),
                    void *user)
{
    char *const lines = malloc(count * SWEEP_LINE + 1);
    size_t length = 0;
    if (!lines) {
        fputs("swiftprox-sweep: no memory for the results of a share\n", stderr);
        return NULL;
    }
    sweep_scene_forget(sweep->scene);
    for (size_t i = 0; i < count; i++) {
        const size_t more =
            sweep_scene_ask(sweep->scene, sweep->kind, numbers + sweep->kind * i, sweep->max_distance, lines + length, tally);
        if (more == 0) {
            free(lines);
            return NULL;
        }
        length += more;
        look(user);
    }
    return lines;
}

/* ---- rank 0 ---- */

struct leader {
    const struct sweep *sweep;
    const struct sweep_items *items;
    struct sweep_output *output;
    FILE *times;
    struct progress progress;
    double looked; /* when it last looked for what ranks say */
    size_t next;   /* the share that is handed out next */
    int following; /* ranks that have not been told that there are no more */
    bool failed;
};

static size_t count_of(const struct leader *leader, size_t share)
{
    const size_t first = share * leader->sweep->share, left = leader->items->count - first;
    return left < leader->sweep->share ? left : leader->sweep->share;
}

static bool has_more(const struct leader *leader)
{
    return !leader->failed && leader->next < leader->output->share_count;
}

static void take(struct leader *leader, size_t share, char *lines, double seconds)
{
    leader->failed = !sweep_output_take(leader->output, share, lines) || leader->failed;
    if (leader->times) {
        fprintf(leader->times, "%.9f\n", seconds);
    }
    progress_look(&leader->progress, leader->output->written, leader->output->share_count);
}

/* Receives what a rank says, and tells it what is next. */
static void serve(struct leader *leader, int rank)
{
    struct result_head said;
    MPI_Recv(&said, sizeof said, MPI_BYTE, rank, TAG_RESULT, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (said.is_answer && !said.failed) {
        char *const lines = malloc((size_t)said.length + 1);
        if (!lines) {
            fputs("swiftprox-sweep: no memory for the results of a share\n", stderr);
            MPI_Abort(MPI_COMM_WORLD, 1);
            return;
        }
        MPI_Recv(lines, said.length, MPI_BYTE, rank, TAG_RESULT, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        lines[said.length] = '\0';
        take(leader, said.share, lines, said.seconds);
    }
    leader->failed = leader->failed || said.failed;
    struct share_head next = {0, 0};
    if (has_more(leader)) {
        next = (struct share_head){leader->next, count_of(leader, leader->next)};
        leader->next++;
    }
    MPI_Send(&next, sizeof next, MPI_BYTE, rank, TAG_SHARE, MPI_COMM_WORLD);
    if (next.count == 0) {
        leader->following--;
        return;
    }
    const enum sweep_kind kind = leader->sweep->kind;
    const double *const numbers = leader->items->numbers + kind * leader->sweep->share * next.share;
    MPI_Send(numbers, (int)(kind * next.count), MPI_DOUBLE, rank, TAG_SHARE, MPI_COMM_WORLD);
}

/* Serves all ranks that have said something; not after each item, as some take less time than a look. */
static void look_around(void *user)
{
    const double often = 1e-4;
    struct leader *const leader = user;
    const double now = MPI_Wtime();
    int is_there = leader->following > 0 && now - leader->looked >= often;
    leader->looked = is_there ? now : leader->looked;
    while (is_there) {
        MPI_Status from;
        MPI_Iprobe(MPI_ANY_SOURCE, TAG_RESULT, MPI_COMM_WORLD, &is_there, &from);
        if (is_there) {
            serve(leader, from.MPI_SOURCE);
            is_there = leader->following > 0;
        }
    }
}

bool sweep_lead(const struct sweep *sweep, const struct sweep_items *items, struct sweep_output *output, FILE *times,
                struct sweep_tally *tally)
{
    struct leader leader = {.sweep = sweep, .items = items, .output = output, .times = times, .progress = progress_start()};
    leader.next = output->written;
    MPI_Comm_size(MPI_COMM_WORLD, &leader.following);
    leader.following--;
    while (has_more(&leader)) {
        const size_t share = leader.next++;
        const double begun = work_time();
        char *const lines = answer(sweep, items->numbers + sweep->kind * sweep->share * share, count_of(&leader, share), tally,
                                   look_around, &leader);
        const double took = work_time() - begun;
        tally->seconds += took;
        if (lines) {
            take(&leader, share, lines, took);
        } else {
            leader.failed = true;
        }
    }
    while (leader.following > 0) {
        MPI_Status from;
        MPI_Probe(MPI_ANY_SOURCE, TAG_RESULT, MPI_COMM_WORLD, &from);
        serve(&leader, from.MPI_SOURCE);
    }
    progress_erase(&leader.progress);
    return !leader.failed;
}

/* ---- all others ---- */

static void look_at_nothing(void *user)
{
    (void)user;
}

void sweep_follow(const struct sweep *sweep, struct sweep_tally *tally)
{
    double *const numbers = malloc(sweep->kind * sweep->share * sizeof *numbers);
    struct result_head said = {.failed = !numbers};
    if (!numbers) {
        fputs("swiftprox-sweep: no memory for a share\n", stderr);
    }
    char *lines = NULL;
    for (;;) {
        MPI_Send(&said, sizeof said, MPI_BYTE, 0, TAG_RESULT, MPI_COMM_WORLD);
        if (lines) {
            MPI_Send(lines, said.length, MPI_BYTE, 0, TAG_RESULT, MPI_COMM_WORLD);
        }
        free(lines);
        lines = NULL;
        struct share_head next;
        MPI_Recv(&next, sizeof next, MPI_BYTE, 0, TAG_SHARE, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        if (next.count == 0) {
            break;
        }
        MPI_Recv(numbers, (int)(sweep->kind * next.count), MPI_DOUBLE, 0, TAG_SHARE, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        const double begun = work_time();
        lines = answer(sweep, numbers, next.count, tally, look_at_nothing, NULL);
        const double took = work_time() - begun;
        tally->seconds += took;
        said = (struct result_head){next.share, took, lines ? (int32_t)strlen(lines) : 0, lines != NULL, lines == NULL};
    }
    free(numbers);
}
