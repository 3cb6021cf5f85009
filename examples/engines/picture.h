/* How scenes end, as SVG: above with the engine's own collider, below with swiftprox. */
#ifndef SWIFTPROX_EXAMPLES_ENGINES_PICTURE_H
#define SWIFTPROX_EXAMPLES_ENGINES_PICTURE_H

#include <stdio.h>

struct report;

/* Ends the program when there is no memory. */
void picture_write(FILE *file, const struct report *report);

#endif
