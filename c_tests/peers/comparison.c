#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */

#include "comparison.h"
#include "swiftprox/verify.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"
#include "oracle.h"

/* What the peers promise of a distance at the scale of the scenes, which is 1: FCL's default distance_tolerance. */
static const double PEER_TOLERANCE = 1e-6;

/* A peer has this many seconds for a pose. */
enum { PEER_SECONDS = 5 };

/* So many poses of a scene are judged although all agree. */
enum { SAMPLES = 40 };

/* What there is to say of a peer. */
struct tally {
    size_t poses, judged;
    size_t outcomes[PEER_INTERSECTING + 1];
    size_t verdicts_differ, distances_differ;
    size_t verdicts_wrong, distances_wrong; /* as the oracle says */
    double worst_error;                     /* of a distance, where the verdicts agree */
};

/* ---- the library --------------------------------------------------------------------------------------------------- */

/* Holds the parts of a separated answer against each other. */
static void check_separated(const swiftprox_pair_answer *answer)
{
    double square = 0, along_normal = 0;
    for (int k = 0; k < 3; ++k) {
        double between = answer->world1[k] - answer->world2[k];
        square += between * between;
        along_normal += between * answer->normal[k];
    }
    /* World points lie within 6 of the origin here: a few roundings of each coordinate, 4 * 6 * 2^-53 * sqrt(3), twice. */
    const double rounding = 1e-14;
    CHECK(sqrt(square) >= answer->lower - rounding && sqrt(square) <= answer->upper + rounding);
    CHECK(along_normal >= answer->lower - rounding && along_normal <= answer->upper + rounding);
}

/* An intersecting pair has a contact: points and a direction. */
static void check_contact(const swiftprox_pair_answer *contact)
{
    double square = 0;
    CHECK(contact->outcome == SWIFTPROX_OUTCOME_INTERSECTING);
    for (int k = 0; k < 3; ++k) {
        CHECK(isfinite(contact->world1[k]) && isfinite(contact->world2[k]));
        square += contact->normal[k] * contact->normal[k];
    }
    CHECK(fabs(square - 1) < 1e-14);
}

/* Answers all poses of a scene by all three queries, every answer verified. */
static void answer_all(const struct scene *scene, swiftprox_pair_answer *answers)
{
    const swiftprox_shape *shape1 = scene->bodies[0].shape, *shape2 = scene->bodies[1].shape;
    swiftprox_pair_cache cache = {{0}}, verdict_cache = {{0}}, contact_cache = {{0}};
    for (size_t i = 0; i < scene->pose_count; ++i) {
        const double *pose1 = scene->poses[i], *pose2 = pose1 + 12;
        swiftprox_pair_answer other, *answer = &answers[i];
        if (!CHECK_OK(swiftprox_pair_distance((swiftprox_placed){shape1, pose1}, (swiftprox_placed){shape2, pose2}, &cache,
                                              NULL, answer)))
            continue;
        CHECK_OK(swiftprox_pair_verify((swiftprox_placed){shape1, pose1}, (swiftprox_placed){shape2, pose2}, answer));
        CHECK_OK(swiftprox_pair_intersection((swiftprox_placed){shape1, pose1}, (swiftprox_placed){shape2, pose2},
                                             &verdict_cache, NULL, &other));
        CHECK(other.outcome == answer->outcome);
        if (answer->outcome == SWIFTPROX_OUTCOME_SEPARATED) {
            check_separated(answer);
        } else {
            CHECK_OK(swiftprox_pair_contact((swiftprox_placed){shape1, pose1}, (swiftprox_placed){shape2, pose2},
                                            &contact_cache, NULL, &other));
            check_contact(&other);
        }
    }
}

/* ---- peers --------------------------------------------------------------------------------------------------------- */

/* Shared with the child process. */
struct progress {
    size_t next; /* the first pose without an answer */
    struct peer_answer answers[];
};

static void query_from(const struct peer *peer, const struct scene *scene, struct progress *progress)
{
    while (progress->next < scene->pose_count) {
        const double *pose = scene->poses[progress->next];
        alarm(PEER_SECONDS);
        peer->query(peer, &scene->bodies[0], pose, &scene->bodies[1], pose + 12, &progress->answers[progress->next]);
        ++progress->next;
    }
}

static struct progress *query_all(const struct peer *peer, struct scene *scene)
{
    size_t bytes = sizeof(struct progress) + scene->pose_count * sizeof(struct peer_answer);
    struct progress *progress = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (progress == MAP_FAILED) {
        perror("mmap");
        exit(2);
    }
    for (int k = 0; k < 2; ++k)
        scene->bodies[k].of_peer = peer->create(&scene->bodies[k]);
    while (progress->next < scene->pose_count) {
        fflush(NULL);
        pid_t child = fork();
        if (child == 0) {
            query_from(peer, scene, progress);
            _exit(0);
        }
        int status = 0;
        if (child < 0 || waitpid(child, &status, 0) != child) {
            perror("fork");
            exit(2);
        }
        if (progress->next < scene->pose_count) {
            int is_endless = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
            struct peer_answer *answer = &progress->answers[progress->next++];
            answer->outcome = is_endless ? PEER_ENDLESS : PEER_CRASHED;
            answer->distance = answer->point_distance = NAN;
        }
    }
    for (int k = 0; k < 2 && peer->destroy; ++k)
        peer->destroy(scene->bodies[k].of_peer);
    return progress;
}

static void release(struct progress *progress, const struct scene *scene)
{
    munmap(progress, sizeof *progress + scene->pose_count * sizeof *progress->answers);
}

/* ---- differences --------------------------------------------------------------------------------------------------- */

static int verdicts_differ(const swiftprox_pair_answer *answer, const struct peer_answer *peer)
{
    return (peer->outcome == PEER_SEPARATED && answer->outcome != SWIFTPROX_OUTCOME_SEPARATED) ||
           (peer->outcome == PEER_INTERSECTING && answer->outcome != SWIFTPROX_OUTCOME_INTERSECTING);
}

/* How far a peer's distance, or that of its nearest points, is from an interval; 0 when it says none. */
static double distance_error(double lower, double upper, const struct peer_answer *peer)
{
    double worst = 0;
    const double said[2] = {peer->distance, peer->point_distance};
    for (int k = 0; k < 2; ++k)
        if (!isnan(said[k]))
            worst = fmax(worst, fmax(lower - said[k], said[k] - upper));
    return worst;
}

static int distances_differ(const swiftprox_pair_answer *answer, const struct peer_answer *peer)
{
    return answer->outcome == SWIFTPROX_OUTCOME_SEPARATED && peer->outcome == PEER_SEPARATED &&
           distance_error(answer->lower, answer->upper, peer) > PEER_TOLERANCE;
}

static void count_differences(const struct scene *scene, const swiftprox_pair_answer *answers,
                              const struct peer_answer *peers, struct tally *tally)
{
    for (size_t i = 0; i < scene->pose_count; ++i) {
        const struct peer_answer *peer = &peers[i];
        ++tally->outcomes[peer->outcome];
        tally->verdicts_differ += verdicts_differ(&answers[i], peer);
        tally->distances_differ += distances_differ(&answers[i], peer);
        if (peer->outcome == PEER_SEPARATED && answers[i].outcome == SWIFTPROX_OUTCOME_SEPARATED)
            tally->worst_error =
                fmax(tally->worst_error, distance_error(answers[i].lower, answers[i].upper, peer));
    }
}

/* The numbers of the poses to judge: all where a peer differs, and a sample. */
static size_t choose_poses(const struct scene *scene, const swiftprox_pair_answer *answers, struct progress *const *peers,
                           size_t peer_count, size_t *chosen)
{
    size_t count = 0, stride = scene->pose_count / SAMPLES + 1;
    for (size_t i = 0; i < scene->pose_count; ++i) {
        int is_chosen = i % stride == 0;
        for (size_t p = 0; p < peer_count; ++p) {
            const struct peer_answer *peer = &peers[p]->answers[i];
            is_chosen |= verdicts_differ(&answers[i], peer) || distances_differ(&answers[i], peer);
        }
        if (is_chosen)
            chosen[count++] = i;
    }
    return count;
}

/* Holds the library's answer against the truth: no tolerance. */
static void check_answer(const struct scene *scene, size_t pose, const swiftprox_pair_answer *answer,
                         const struct truth *truth)
{
    const swiftprox_outcome expected = truth->intersecting ? SWIFTPROX_OUTCOME_INTERSECTING : SWIFTPROX_OUTCOME_SEPARATED;
    /* The bounds are doubles: lower <= distance exactly when it is at most the largest double below; upper alike. */
    int holds = answer->outcome == expected &&
                (truth->intersecting || (0 < answer->lower && answer->lower <= truth->lower &&
                                         answer->lower <= answer->distance && answer->distance <= answer->upper &&
                                         truth->upper <= answer->upper));
    if (!CHECK(holds)) {
        fprintf(stderr, "  %s, pose %zu: outcome %d [%.17g, %.17g], truth %s [%.17g, %.17g]\n  poses", scene->name, pose,
                (int)answer->outcome, answer->lower, answer->upper, truth->intersecting ? "intersecting" : "separated",
                truth->lower, truth->upper);
        for (int k = 0; k < 24; ++k)
            fprintf(stderr, " %.17g", scene->poses[pose][k]);
        fputc('\n', stderr);
    }
}

static void judge_peer(const struct peer_answer *peer, const struct truth *truth, struct tally *tally)
{
    if (peer->outcome != PEER_SEPARATED && peer->outcome != PEER_INTERSECTING)
        return;
    if ((peer->outcome == PEER_INTERSECTING) != truth->intersecting)
        ++tally->verdicts_wrong;
    else if (!truth->intersecting && distance_error(truth->lower, truth->upper, peer) > PEER_TOLERANCE)
        ++tally->distances_wrong;
}

/* ---- all scenes ---------------------------------------------------------------------------------------------------- */

static void print_head(void)
{
    printf("Differences are judged in exact arithmetic; peers' distances differ beyond %g.\n", PEER_TOLERANCE);
    static const char *const format = "%-13s %7s %7s  %-17s %7s %7s %7s %9s %9s %9s %9s %9s\n";
    printf(format, "", "", "", "", "", "", "", "verdicts", "peer", "distances", "peer", "worst");
    printf(format, "scene", "poses", "judged", "peer", "crashed", "endless", "threw", "differ", "wrong", "differ",
           "wrong", "error");
}

static void print_tally(const char *scene, const char *peer, const struct tally *tally)
{
    printf("%-13s %7zu %7zu  %-17s %7zu %7zu %7zu %9zu %9zu %9zu %9zu %9.1e\n", scene, tally->poses, tally->judged, peer,
           tally->outcomes[PEER_CRASHED], tally->outcomes[PEER_ENDLESS], tally->outcomes[PEER_THREW],
           tally->verdicts_differ, tally->verdicts_wrong, tally->distances_differ, tally->distances_wrong,
           tally->worst_error);
    fflush(stdout);
}

static void add_tally(struct tally *sum, const struct tally *tally)
{
    sum->poses += tally->poses;
    sum->judged += tally->judged;
    for (int k = 0; k <= PEER_INTERSECTING; ++k)
        sum->outcomes[k] += tally->outcomes[k];
    sum->verdicts_differ += tally->verdicts_differ;
    sum->distances_differ += tally->distances_differ;
    sum->verdicts_wrong += tally->verdicts_wrong;
    sum->distances_wrong += tally->distances_wrong;
    sum->worst_error = fmax(sum->worst_error, tally->worst_error);
}

/* Runs one scene; adds to the sums of the peers. */
static void compare_on_scene(const char *oracle, const struct peer *peers, size_t peer_count, struct scene *scene,
                             struct tally *sums)
{
    swiftprox_pair_answer *answers = scene_allocate(scene->pose_count, sizeof *answers);
    size_t *judged = scene_allocate(scene->pose_count, sizeof *judged);
    struct truth *truths = scene_allocate(scene->pose_count, sizeof *truths);
    struct progress **progress = scene_allocate(peer_count, sizeof *progress);
    answer_all(scene, answers);
    for (size_t p = 0; p < peer_count; ++p)
        progress[p] = query_all(&peers[p], scene);
    size_t judged_count = choose_poses(scene, answers, progress, peer_count, judged);
    if (CHECK(oracle_judge(oracle, scene, judged, judged_count, truths))) {
        for (size_t j = 0; j < judged_count; ++j)
            check_answer(scene, judged[j], &answers[judged[j]], &truths[j]);
        for (size_t p = 0; p < peer_count; ++p) {
            struct tally tally;
            memset(&tally, 0, sizeof tally);
            tally.poses = scene->pose_count;
            tally.judged = judged_count;
            count_differences(scene, answers, progress[p]->answers, &tally);
            for (size_t j = 0; j < judged_count; ++j)
                judge_peer(&progress[p]->answers[judged[j]], &truths[j], &tally);
            print_tally(scene->name, peers[p].name, &tally);
            add_tally(&sums[p], &tally);
        }
    }
    for (size_t p = 0; p < peer_count; ++p)
        release(progress[p], scene);
    free(progress);
    free(truths);
    free(judged);
    free(answers);
}

int compare(const char *program, const char *oracle, const struct peer *peers, size_t peer_count)
{
    struct tally *sums = scene_allocate(peer_count, sizeof *sums);
    print_head();
    for (size_t i = 0; i < scene_count(); ++i) {
        struct scene scene;
        if (CHECK(scene_create(i, &scene)))
            compare_on_scene(oracle, peers, peer_count, &scene, sums);
        else
            fprintf(stderr, "  %s: %s\n", scene.name, swiftprox_library_last_error_message());
        scene_destroy(&scene);
    }
    for (size_t p = 0; p < peer_count; ++p)
        print_tally("all", peers[p].name, &sums[p]);
    free(sums);
    return check_report(program);
}
