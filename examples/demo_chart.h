/* An SVG picture of distances over time, one panel a flight. */
#ifndef SWIFTPROX_EXAMPLES_DEMO_CHART_H
#define SWIFTPROX_EXAMPLES_DEMO_CHART_H

#include <stdbool.h>
#include <stddef.h>

struct chart_panel {
    const char *title;
    const char *subtitle;
    const double *distances; /* over one orbit in equal steps; 0: intersecting */
    size_t count;
};

/* False, with errno set, when the file cannot be written. */
bool chart_write(const char *path, const struct chart_panel *panels, size_t count);

#endif
