/* A strip of pictures of a world from the side, as SVG: outlines of its bodies, the farther ones behind. */
#ifndef SWIFTPROX_EXAMPLES_STRIP_H
#define SWIFTPROX_EXAMPLES_STRIP_H

#include <stdbool.h>

#include "rigid_bodies.h"

struct strip;

/* Ends the program where there is no memory, as all of these do. */
struct strip *strip_create(void);

/* Adds the world as it is now, `seconds` after it began. */
void strip_add(struct strip *strip, const struct world *world, double seconds);

/* False, with errno set, when the file cannot be written. */
bool strip_write(const struct strip *strip, const char *path);

void strip_destroy(struct strip *strip);

#endif
