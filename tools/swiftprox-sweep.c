/* swiftprox-sweep: a scene against many poses or edges, over the ranks of MPI. It is a user of the C interface like any other. */
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mpi.h>

#include "input.h"
#include "output_file.h"
#include "program.h"
#include "sweep_items.h"
#include "sweep_output.h"
#include "sweep_scene.h"
#include "sweep_shares.h"

/* So that numbers of a share are counted by an int, as MPI does. */
enum { DEFAULT_SHARE = 256, MOST_SHARE = 1 << 20 };

static const char USAGE[] = "usage: swiftprox-sweep SCENE POSES --out FILE [--share N] [--max-distance D] [--input POLICY]\n"
                            "                       [--times FILE]\n";

static const char HELP[] =
    "\n"
    "Computes for many poses or edges of one object how near it comes to all others of a scene, over the ranks of MPI.\n"
    "\n"
    "  SCENE              what swiftprox_scene_record has written, or a scene as text, see swiftprox-replay; its first\n"
    "                     object that is not fixed moves, all others stay where its last step has them; every rank reads it\n"
    "  POSES              poses of that object, 12 numbers per line, the row-major 3x4 [R|T]; or edges, 24 numbers per line,\n"
    "                     the poses at the times 0 and 1, between which it turns by the shortest way about its origin, which\n"
    "                     goes on a line; blank lines and lines that start with # are skipped; rank 0 reads it\n"
    "  --out FILE         where results are written: to FILE.part first, which a later run continues; FILE.part.sums\n"
    "                     has its checksums\n"
    "  --share N          how many items a rank is handed at once (default: 256)\n"
    "  --max-distance D   for edges: free means farther apart than this (default: 0)\n"
    "  --input strict     refuse a mesh that is not closed and convex with an interior (the default)\n"
    "  --input flat       admit bodies without interior as well, such as a two-sided polygon\n"
    "  --input hull       take the convex hull of all vertices, with or without a face\n"
    "  --input patch      take the convex hull of the faces\n"
    "                     (nearly-convex: as flat, up to the precision of the coordinates)\n"
    "  --times FILE       write how many seconds of its rank's processor each share took, a line each\n"
    "                     and in the order in which they came\n"
    "  --help, --version  print this text, the version\n"
    "\n"
    "Each result is a line, in the order of the items, numbers with 17 significant digits. For a pose:\n"
    "  outcome lower upper object\n"
    "  outcome       separated or intersecting\n"
    "  lower, upper  the distance to the nearest object is guaranteed to lie between them\n"
    "  object        the nearest one, or one that intersects, numbered from 0; - where there is none\n"
    "\n"
    "For an edge:\n"
    "  outcome time_lower time_upper clearance object\n"
    "  outcome     free, hit, near (rounding hides whether they meet) or budget\n"
    "  time_lower  farther apart than max-distance up to this time\n"
    "  time_upper  for a hit: no farther apart than max-distance\n"
    "  clearance   for a free edge: at least so far apart at all times\n"
    "  object      the one that is hit or near\n"
    "\n"
    "Results are bit for bit the same for any number of ranks, however often the sweep was killed and begun again.\n"
    "\n"
    "Exit status: 0 if all was answered; 1 on failure, such as a full disk; 2 if the input was refused.\n";

static const struct program PROGRAM = {"swiftprox-sweep", USAGE, HELP};

struct arguments {
    struct player_options player;
    const char *items_path, *out, *times;
    size_t share;
    double max_distance;
};

static bool read_arguments(int argc, char **argv, struct arguments *arguments, int *status)
{
    const char *operands[2] = {NULL, NULL};
    int input = 0;
    *arguments = (struct arguments){.share = DEFAULT_SHARE};
    struct program_option options[] = {
        {.name = "--out", .kind = OPTION_OUTPUT, .value = &arguments->out},
        {.name = "--share", .kind = OPTION_COUNT, .value = &arguments->share, .most = MOST_SHARE},
        {.name = "--max-distance", .kind = OPTION_AMOUNT, .value = &arguments->max_distance},
        {.name = "--input", .kind = OPTION_CHOICE, .value = &input, .choices = INPUT_WORDS},
        {.name = "--times", .kind = OPTION_OUTPUT, .value = &arguments->times},
    };
    struct command_line line = {.program = &PROGRAM,
                                .options = options,
                                .option_count = sizeof options / sizeof *options,
                                .operands = operands,
                                .least_operands = 2,
                                .most_operands = 2,
                                .operands_wanted = "a scene and a file of poses or edges are needed"};
    if (!command_line_read(&line, argc, argv, status)) {
        return false;
    }
    if (!arguments->out) {
        *status = program_refuse(&PROGRAM, "--out is needed: the file for the results");
        return false;
    }
    arguments->items_path = operands[1];
    arguments->player = (struct player_options){.path = operands[0],
                                                .query = swiftprox_scene_query_intersection,
                                                .max_distance = SWIFTPROX_DEFAULT_MAX_DISTANCE,
                                                .budget = INFINITY,
                                                .input = INPUT_VALUES[input],
                                                .workers = 1};
    return true;
}

/* All that the bits of results depend on. */
static void write_head(const struct arguments *arguments, const struct sweep_scene *scene, const struct sweep_items *items,
                       char head[2 * SWEEP_LINE])
{
    snprintf(head, 2 * SWEEP_LINE,
             "# swiftprox-sweep 1 %s %zu share %zu max_distance %.17g scene %016" PRIx64 " items %016" PRIx64 "\n",
             items->kind == SWEEP_POSES ? "poses" : "motions", items->count, arguments->share, arguments->max_distance,
             scene->digest, items->digest);
}

/* What rank 0 opens before anything runs. */
struct rank0 {
    struct sweep_items items;
    struct sweep_output output;
    FILE *times;
    bool has_output;
};

static int open_rank0(const struct arguments *arguments, const struct sweep_scene *scene, struct rank0 *rank0)
{
    if (!sweep_items_read(arguments->items_path, &rank0->items)) {
        return BAD_INPUT;
    }
    if (rank0->items.kind == SWEEP_POSES && arguments->max_distance > 0) {
        return program_refuse(&PROGRAM, "--max-distance has no meaning for poses, whose distances are printed");
    }
    rank0->times = arguments->times ? fopen(arguments->times, "w") : NULL;
    if (arguments->times && !rank0->times) {
        fprintf(stderr, "%s: it cannot be written\n", arguments->times);
        return BAD_INPUT;
    }
    char head[2 * SWEEP_LINE];
    write_head(arguments, scene, &rank0->items, head);
    const int status = sweep_output_open(&rank0->output, arguments->out, head, rank0->items.count, arguments->share);
    rank0->has_output = status == GOOD;
    return status;
}

static int close_rank0(struct rank0 *rank0, int status)
{
    if (rank0->has_output && !sweep_output_close(&rank0->output) && status == GOOD) {
        status = FAILED;
    }
    if (rank0->times && (ferror(rank0->times) || fclose(rank0->times) != 0) && status == GOOD) {
        fputs("swiftprox-sweep: the times cannot be written\n", stderr);
        status = FAILED;
    }
    sweep_items_free(&rank0->items);
    return status;
}

/* Sums over the ranks, on rank 0. */
static struct sweep_tally reduce(const struct sweep_tally *own)
{
    struct sweep_tally all = {{0}, 0, 0, 0};
    MPI_Reduce(own->outcomes, all.outcomes, SWEEP_OUTCOMES, MPI_UINT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
    MPI_Reduce(&own->queries, &all.queries, 1, MPI_UINT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
    MPI_Reduce(&own->seconds, &all.seconds, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    MPI_Reduce(&own->worst_end, &all.worst_end, 1, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
    return all;
}

static void print_tally(const struct rank0 *rank0, const struct sweep_tally *all, double seconds)
{
    int ranks;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    uint64_t before = 0;
    for (int i = 0; i < SWEEP_OUTCOMES; i++) {
        const uint64_t count = all->outcomes[i] + rank0->output.found.outcomes[i];
        before += rank0->output.found.outcomes[i];
        if (count > 0) {
            printf("%s %" PRIu64 "\n", SWEEP_WORDS[i], count);
        }
    }
    printf("from an earlier run %" PRIu64 "\n", before);
    printf("queries %" PRIu64 ", %.3f s of work in %.3f s on %d ranks\n", all->queries, all->seconds, seconds, ranks);
    if (rank0->items.kind == SWEEP_MOTIONS) {
        printf("edges end within %.3g of their second poses\n", all->worst_end);
    }
}

/* The sweep, once every rank has its scene. */
static int run(const struct arguments *arguments, struct sweep_scene *scene, int rank)
{
    struct rank0 rank0 = {.items = {.kind = SWEEP_POSES}};
    const double begun = MPI_Wtime();
    int status = rank == 0 ? open_rank0(arguments, scene, &rank0) : GOOD;
    int told[2] = {status, (int)rank0.items.kind};
    MPI_Bcast(told, 2, MPI_INT, 0, MPI_COMM_WORLD);
    status = told[0];
    if (status == GOOD) {
        const struct sweep sweep = {scene, (enum sweep_kind)told[1], arguments->share, arguments->max_distance};
        struct sweep_tally own = {{0}, 0, 0, 0};
        if (rank == 0) {
            status = sweep_lead(&sweep, &rank0.items, &rank0.output, rank0.times, &own) ? GOOD : FAILED;
        } else {
            sweep_follow(&sweep, &own);
        }
        const struct sweep_tally all = reduce(&own);
        if (rank == 0 && status == GOOD) {
            print_tally(&rank0, &all, MPI_Wtime() - begun);
        }
    }
    status = rank == 0 ? close_rank0(&rank0, status) : status;
    MPI_Bcast(&status, 1, MPI_INT, 0, MPI_COMM_WORLD);
    return status;
}

int main(int argc, char **argv)
{
    struct arguments arguments;
    int status = GOOD, rank, worst;
    if (!read_arguments(argc, argv, &arguments, &status)) {
        return program_end(&PROGRAM, status);
    }
    signal(SIGXFSZ, SIG_IGN); /* a file as large as it may be is a failed write, as is a full disk */
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    struct sweep_scene scene;
    status = sweep_scene_open(&scene, &arguments.player);
    MPI_Allreduce(&status, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    status = worst == GOOD ? run(&arguments, &scene, rank) : worst;
    sweep_scene_close(&scene);
    MPI_Finalize();
    return program_end(&PROGRAM, status);
}
