/* The front of speed against accuracy: which of many measurements no other beats, and a drawing of all in letters. */
#ifndef SWIFTPROX_TOOLS_TUNE_FRONT_H
#define SWIFTPROX_TOOLS_TUNE_FRONT_H

#include <stdbool.h>
#include <stddef.h>

/* What playing under a setting has come to. */
struct tune_point {
    double time;  /* milliseconds a step, the best pass */
    double width; /* of the widest interval that was answered; 0 where all are points */
    bool on_front;
};

/* Marks the points that no other is at once as quick and as narrow as, and better in one. */
void tune_find_front(struct tune_point *points, size_t count);

/* Draws all over logarithmic axes: * on the front, o off it. */
void tune_draw_front(const struct tune_point *points, size_t count);

#endif
