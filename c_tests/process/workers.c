/*
 * A scene whose poses and queries several threads share: a pool of the scene's own, and the program's threads by callbacks. The
 * answers are those of one thread bit for bit, in the child of a fork, too, which has no pool.
 *
 *     workers [callbacks]        the callbacks alone: what helgrind can judge, as it does not know the pool's locks
 */
#include <pthread.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"
#include "swiftprox.h"

/* So many bodies are shared when they are moved, too. */
enum { SIDE = 13, BODIES = SIDE * SIDE * SIDE, WORKERS = 4, STEPS = 3 };

/* The bytes of an answer that say something: behind them it is padded. */
static const size_t SAID = offsetof(swiftprox_pair_answer, statistics) + sizeof(swiftprox_statistics);

static const double CORNERS[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};

/* A task of the library, shared out among threads that are started for it. */
typedef struct task {
    pthread_t threads[WORKERS];
    uint32_t bounds[WORKERS + 1];
    swiftprox_task_callback run;
    void *context;
    int next;
} task;

static int enqueued, finished;

static void *run_range(void *argument)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    task *const task = argument;
    pthread_mutex_lock(&lock);
    const int mine = task->next++;
    pthread_mutex_unlock(&lock);
    task->run(task->bounds[mine], task->bounds[mine + 1], task->context);
    return NULL;
}

static void *enqueue(swiftprox_task_callback run, uint32_t item_count, void *context, void *user)
{
    task *const task = user;
    *task = (struct task){.run = run, .context = context};
    enqueued++;
    for (uint32_t k = 0; k <= WORKERS; k++)
        task->bounds[k] = (uint32_t)((uint64_t)item_count * k / WORKERS);
    for (int k = 0; k < WORKERS; k++)
        CHECK(pthread_create(&task->threads[k], NULL, run_range, task) == 0);
    return task;
}

static void finish(void *handed_back, void *user)
{
    task *const task = handed_back;
    CHECK(task == user);
    finished++;
    for (int k = 0; k < WORKERS; k++)
        CHECK(pthread_join(task->threads[k], NULL) == 0);
}

static swiftprox_scene *make_scene(const swiftprox_shape *shape, const swiftprox_scene_options *options)
{
    swiftprox_scene *scene;
    CHECK(swiftprox_scene_create(options, &scene) == SWIFTPROX_OK);
    for (uint64_t k = 0; k < BODIES; k++) {
        swiftprox_object_id id;
        swiftprox_object_options object = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        object.user_data = k;
        CHECK(swiftprox_scene_add_object(scene, &shape, 1, &object, &id) == SWIFTPROX_OK);
    }
    return scene;
}

/* Moves all bodies of a lattice a little, each its own way. */
static void move(swiftprox_scene *scene, int step)
{
    static double poses[BODIES][12];
    for (int k = 0; k < BODIES; k++) {
        const int place[3] = {k % SIDE, k / SIDE % SIDE, k / (SIDE * SIDE)};
        for (int i = 0; i < 12; i++)
            poses[k][i] = i % 5 == 0;
        for (int i = 0; i < 3; i++)
            poses[k][4 * i + 3] = 1.1 * place[i] + 0.01 * step * ((7 * k + 3 * i) % 11 - 5);
    }
    CHECK(swiftprox_scene_set_poses(scene, NULL, &poses[0][0], BODIES) == SWIFTPROX_OK);
}

static swiftprox_scene_answer ask(swiftprox_scene *scene)
{
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.max_distance = 0.15;
    swiftprox_scene_answer answer;
    CHECK(swiftprox_scene_query_distance(scene, &query, &answer) == SWIFTPROX_OK);
    return answer;
}

/* Two scenes say the same, apart from the ids. */
static void compare(swiftprox_scene *scene, swiftprox_scene *single)
{
    const swiftprox_scene_answer answer = ask(scene), expected = ask(single);
    CHECK(answer.count == expected.count && answer.count > BODIES);
    for (size_t k = 0; k < answer.count; k++) {
        const swiftprox_pair_result *const one = &answer.pairs[k], *const other = &expected.pairs[k];
        CHECK(one->user_data1 == other->user_data1 && one->user_data2 == other->user_data2);
        CHECK(memcmp(&one->answer, &other->answer, SAID) == 0);
    }
}

/* In the child the threads of the pool do not go on; the scenes do. */
static void go_on_in_child(swiftprox_scene *scene, swiftprox_scene *single)
{
    fflush(stdout);
    const pid_t child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        move(scene, STEPS);
        move(single, STEPS);
        compare(scene, single);
        CHECK(swiftprox_scene_destroy(scene) == SWIFTPROX_OK);
        _exit(check_failures != 0);
    }
    int status;
    CHECK(waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

int main(int argument_count, char **arguments)
{
    const int with_pool = argument_count < 2 || strcmp(arguments[1], "callbacks") != 0;
    const swiftprox_shape *shape;
    swiftprox_scene_options options = SWIFTPROX_SCENE_OPTIONS_DEFAULT;
    task shared;
    CHECK(swiftprox_shape_create_from_points(CORNERS, 8, NULL, &shape) == SWIFTPROX_OK);
    swiftprox_scene *const single = make_scene(shape, NULL);
    /* The first query finds out which vector units there are. Helgrind does not know its way: here are no threads yet. */
    move(single, 0);
    ask(single);
    options.worker_count = WORKERS;
    swiftprox_scene *const pool = with_pool ? make_scene(shape, &options) : NULL;
    options.enqueue_task = enqueue;
    options.finish_task = finish;
    options.task_user = &shared;
    swiftprox_scene *const callbacks = make_scene(shape, &options);
    for (int step = 0; step < STEPS; step++) {
        swiftprox_scene *const scenes[3] = {single, callbacks, pool};
        for (int k = 0; k < 2 + with_pool; k++)
            move(scenes[k], step);
        for (int k = 1; k < 2 + with_pool; k++)
            compare(scenes[k], single);
        /* Poses are looked at, then set; near pairs are tested, then their results put together. */
        CHECK(enqueued >= 4 * (step + 1) && finished == enqueued);
    }
    /* Boxes are fitted and the grid is searched, too. */
    CHECK(enqueued > 4 * STEPS + 1);
    if (with_pool) {
        go_on_in_child(pool, single);
        CHECK(swiftprox_scene_destroy(pool) == SWIFTPROX_OK);
        /* More than there will be threads. */
        options = (swiftprox_scene_options){0};
        options = (swiftprox_scene_options)SWIFTPROX_SCENE_OPTIONS_DEFAULT;
        options.worker_count = UINT32_MAX;
        swiftprox_scene *many;
        CHECK(swiftprox_scene_create(&options, &many) == SWIFTPROX_OK && swiftprox_scene_destroy(many) == SWIFTPROX_OK);
    }
    CHECK(swiftprox_scene_destroy(callbacks) == SWIFTPROX_OK && swiftprox_scene_destroy(single) == SWIFTPROX_OK);
    swiftprox_shape_release(shape);
    return check_report("workers");
}
