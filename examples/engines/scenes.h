/* Scenes for rigid-body engines: stacks, a wall, an arch, a card house and a pile. All bodies are convex meshes given by points,
 * each turned in its own frame and rounded to float, as meshes come from files: their flat faces are flat only to float. */
#ifndef SWIFTPROX_EXAMPLES_ENGINES_SCENES_H
#define SWIFTPROX_EXAMPLES_ENGINES_SCENES_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SCENE_MOST_POINTS = 128, SCENE_MOST_BODIES = 64, SCENE_COUNT = 6 };

struct scene_body {
    int count;
    float points[SCENE_MOST_POINTS][3]; /* in the body's frame, about its centre of mass or near it, in metres */
    double place[3];
    double quaternion[4]; /* w x y z */
    bool fixed;
};

struct scene {
    const char *name;
    bool stands; /* where it begins it stays; else it falls into a pile */
    int count;
    struct scene_body bodies[SCENE_MOST_BODIES];
};

/* Fills in the scene of a number below SCENE_COUNT. A floor is the engine's: the plane z = 0, gravity against z, friction 0.8. */
void scene_make(int number, struct scene *scene);

#ifdef __cplusplus
}
#endif

#endif
