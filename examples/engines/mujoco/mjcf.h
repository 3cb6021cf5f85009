/* A scene as MuJoCo's XML. */
#ifndef SWIFTPROX_EXAMPLES_MUJOCO_MJCF_H
#define SWIFTPROX_EXAMPLES_MUJOCO_MJCF_H

#include "../scenes.h"

/* Writes a whole model; false where the file cannot be written. */
bool mjcf_write(const struct scene *scene, const char *path);

#endif
