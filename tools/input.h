/* Which meshes a tool admits: the words behind --input, and what they stand for. */
#ifndef SWIFTPROX_TOOLS_INPUT_H
#define SWIFTPROX_TOOLS_INPUT_H

#include <stddef.h>

#include <swiftprox.h>

static const char *const INPUT_WORDS[] = {"strict", "flat", "hull", "nearly-convex", "patch", NULL};
static const swiftprox_input INPUT_VALUES[] = {SWIFTPROX_INPUT_STRICT, SWIFTPROX_INPUT_FLAT, SWIFTPROX_INPUT_HULL,
                                               SWIFTPROX_INPUT_NEARLY_CONVEX, SWIFTPROX_INPUT_PATCH};

#endif
