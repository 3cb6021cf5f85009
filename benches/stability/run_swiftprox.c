/* Runs this library:  run_swiftprox A B POSES
 *
 * Behind the distance a line has the interval, what the query did, and its time: of a few repetitions from the same state of
 * the cache the shortest. */
#include <stdint.h>
#include <stdio.h>
#include <time.h>

#include "runner.h"

enum { REPETITIONS = 7 };

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Answers one pose from what the cache holds, and leaves in it what the query learned. */
static swiftprox_status answer_pose(const struct run *run, size_t i, swiftprox_pair_cache *cache, swiftprox_pair_answer *answer,
                                double *shortest)
{
    const struct pose_pair *pose = &run->poses.pairs[i];
    const swiftprox_pair_cache before = *cache;
    *shortest = 1e300;
    for (int k = 0; k < REPETITIONS; ++k) {
        *cache = before;
        const double start = seconds();
        const swiftprox_status status =
            swiftprox_pair_distance((swiftprox_placed){run->bodies[0].shape, pose->first},
                                    (swiftprox_placed){run->bodies[1].shape, pose->second}, cache, NULL, answer);
        const double time = seconds() - start;
        if (status != SWIFTPROX_OK)
            return status;
        if (time < *shortest)
            *shortest = time;
    }
    return SWIFTPROX_OK;
}

static void answer_all(const struct run *run)
{
    swiftprox_pair_cache cache = {{0}};
    for (size_t i = 0; i < run->poses.count; ++i) {
        swiftprox_pair_answer answer;
        double time;
        if (answer_pose(run, i, &cache, &answer, &time) != SWIFTPROX_OK) {
            puts("failed");
            fprintf(stderr, "%s\n", swiftprox_library_last_error_message());
        } else {
            const swiftprox_statistics *did = &answer.statistics;
            printf("%s %.17g %.17g %.17g %u %u %u %.0f\n",
                   answer.outcome == SWIFTPROX_OUTCOME_SEPARATED ? "separated" : "intersecting", answer.distance, answer.lower,
                   answer.upper, (unsigned)did->marching_steps, (unsigned)did->fallback_iterations,
                   (unsigned)did->exact_iterations, 1e9 * time);
        }
        fflush(stdout);
    }
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: %s A B POSES\n", argv[0]);
        return RUN_MISUSED;
    }
    struct run run;
    const bool loaded = run_load(argv + 1, &run);
    if (loaded) {
        puts("ready swiftprox_pair_distance, defaults");
        fflush(stdout);
        answer_all(&run);
    }
    run_free(&run);
    return loaded ? RUN_GOOD : RUN_REFUSED;
}
