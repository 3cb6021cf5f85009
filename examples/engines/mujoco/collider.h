/* swiftprox as MuJoCo's collider of boxes and convex meshes. MuJoCo calls it by its table mjCOLLISIONFUNC, of which a process has
 * one, and which has no place for a pointer of the program's: so there is one collider, for one model, used by one thread. */
#ifndef SWIFTPROX_EXAMPLES_MUJOCO_COLLIDER_H
#define SWIFTPROX_EXAMPLES_MUJOCO_COLLIDER_H

#include <stdbool.h>

#include <mujoco/mujoco.h>

/* Makes a shape of each box and mesh of a model, and takes MuJoCo's pairs of these over. False, with nothing changed, where memory
 * is lacking or a mesh is refused: swiftprox_library_last_error_message says which of its vertices. */
bool collider_install(const mjModel *model);

/* Gives MuJoCo its own functions back, and frees what collider_install made. */
void collider_remove(void);

#endif
