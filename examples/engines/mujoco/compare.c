/* MuJoCo's scenes with its own collider and with swiftprox, in one run, taking turns.
 *
 *   mujoco_compare [--quick] [FOLDER]    FOLDER: where the scenes are written too, NAME.xml, for MuJoCo's viewer
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mujoco/mujoco.h>

#include "../report.h"
#include "mjcf.h"

enum { QUICK_STEPS = 1000, STEPS = 5000 };

/* Steps a scene, by the collider that is in MuJoCo's table. The time is that of the last fifth, when what falls has settled. */
static void play(const mjModel *model, int steps, struct run *run)
{
    mjData *const data = mj_makeData(model);
    static double times[STEPS / 5];
    if (!data) {
        fputs("mujoco_compare: no memory\n", stderr);
        exit(EXIT_FAILURE);
    }
    mj_forward(model, data);
    const int settled = steps - steps / 5;
    for (int step = 0; step < steps; step++) {
        const double before = report_now();
        mj_step(model, data);
        if (step >= settled) {
            times[step - settled] = report_now() - before;
        }
    }
    /* Body 0 is the world. */
    for (int body = 1; body < model->nbody; body++) {
        for (int i = 0; i < 12; i++) {
            run->poses[body - 1][i] = i % 4 == 3 ? data->xpos[3 * body + i / 4] : data->xmat[9 * body + i / 4 * 3 + i % 4];
        }
    }
    run->is_played = true;
    run->energy = data->energy[1];
    run->microseconds = report_median(times, steps - settled);
    run->contacts = data->ncon;
    mj_deleteData(data);
}

int main(int argc, char **argv)
{
    static struct report report;
    bool good = true;
    int status;
    if (!report_begin(&report, "MuJoCo", argc, argv, &status)) {
        return status;
    }
    /* A program that only switches needs the one line between the copies. */
    mjfCollision own[mjNGEOMTYPES][mjNGEOMTYPES], switched[mjNGEOMTYPES][mjNGEOMTYPES];
    memcpy(own, mjCOLLISIONFUNC, sizeof own);
    mj_loadPluginLibrary(SWIFTPROX_MUJOCO_PLUGIN);
    memcpy(switched, mjCOLLISIONFUNC, sizeof switched);
    const int steps = report.is_quick ? QUICK_STEPS : STEPS;
    for (int i = 0; i < SCENE_COUNT; i++) {
        char path[1024], error[1024];
        struct played *const played = &report.played[i];
        scene_make(i, &played->scene);
        snprintf(path, sizeof path, "%s/%s.xml", report.folder ? report.folder : ".", played->scene.name);
        if (!mjcf_write(&played->scene, path)) {
            perror(path);
            return EXIT_FAILURE;
        }
        mjModel *const model = mj_loadXML(path, NULL, error, sizeof error);
        if (!model) {
            fprintf(stderr, "%s: %s\n", path, error);
            return EXIT_FAILURE;
        }
        memcpy(mjCOLLISIONFUNC, own, sizeof own);
        play(model, steps, &played->theirs);
        memcpy(mjCOLLISIONFUNC, switched, sizeof switched);
        play(model, steps, &played->ours);
        mj_deleteModel(model);
        report_add(&report);
        good = good && report_stands_as_well(played);
    }
    return report_end(&report, good);
}
