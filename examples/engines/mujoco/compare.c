/* MuJoCo's scenes with its own collider and with swiftprox, in one run, taking turns.
 *
 *   mujoco_compare [FOLDER]    FOLDER: where the scenes are written, NAME.xml; they can be opened in MuJoCo's viewer
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <swiftprox.h>

#include "../report.h"
#include "collider.h"
#include "mjcf.h"

enum { STEPS = 5000, SETTLED = 4000 };

/* How far the body that moved most is from where it was. */
static double motion(const mjModel *model, const mjData *data, const double *start)
{
    double most = 0;
    for (int body = 1; body < model->nbody; body++) {
        const mjtNum *const now_at = data->xpos + 3 * body;
        const double *const was = start + 3 * body;
        most = fmax(most, sqrt(pow(now_at[0] - was[0], 2) + pow(now_at[1] - was[1], 2) + pow(now_at[2] - was[2], 2)));
    }
    return most;
}

/* Steps a scene, by the collider that is installed. The time is that of the last fifth, when what falls has settled. */
static struct run play(const mjModel *model)
{
    mjData *const data = mj_makeData(model);
    static double times[STEPS - SETTLED];
    double *const start = malloc(3 * (size_t)model->nbody * sizeof *start);
    if (!data || !start) {
        fputs("mujoco_compare: no memory\n", stderr);
        exit(EXIT_FAILURE);
    }
    mj_forward(model, data);
    for (int i = 0; i < 3 * model->nbody; i++) {
        start[i] = data->xpos[i];
    }
    for (int step = 0; step < STEPS; step++) {
        const double before = report_now();
        mj_step(model, data);
        if (step >= SETTLED) {
            times[step - SETTLED] = report_now() - before;
        }
    }
    const struct run run = {motion(model, data, start), data->energy[1], report_median(times, STEPS - SETTLED), data->ncon};
    free(start);
    mj_deleteData(data);
    return run;
}

int main(int argc, char **argv)
{
    const char *const folder = argc > 1 ? argv[1] : ".";
    static struct scene scene;
    bool good = true;
    report_head("MuJoCo");
    for (int i = 0; i < SCENE_COUNT; i++) {
        char path[1024], error[1024];
        scene_make(i, &scene);
        snprintf(path, sizeof path, "%s/%s.xml", folder, scene.name);
        if (!mjcf_write(&scene, path)) {
            perror(path);
            return EXIT_FAILURE;
        }
        mjModel *const model = mj_loadXML(path, NULL, error, sizeof error);
        if (!model) {
            fprintf(stderr, "%s: %s\n", path, error);
            return EXIT_FAILURE;
        }
        const struct run theirs = play(model);
        if (!collider_install(model)) {
            fprintf(stderr, "%s: %s\n", path, swiftprox_library_last_error_message());
            return EXIT_FAILURE;
        }
        const struct run ours = play(model);
        collider_remove();
        mj_deleteModel(model);
        good = report_scene(&scene, &theirs, &ours) && good;
    }
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
