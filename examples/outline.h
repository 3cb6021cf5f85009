/* The outline of a convex body, for pictures. */
#ifndef SWIFTPROX_EXAMPLES_OUTLINE_H
#define SWIFTPROX_EXAMPLES_OUTLINE_H

#include <stddef.h>

/* A point of the picture's plane. */
struct spot {
    double x, z;
};

/* The hull of spots, which are sorted: its corners in order, and how many (Andrew 1979). `hull` has room for twice as many as there
 * are spots. */
size_t outline_of(struct spot *spots, size_t count, struct spot *hull);

#endif
