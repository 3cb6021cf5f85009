#include "tune_front.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_beaten_by(const struct tune_point *point, const struct tune_point *other)
{
    const bool no_worse = other->time <= point->time && other->width <= point->width;
    return no_worse && (other->time < point->time || other->width < point->width);
}

void tune_find_front(struct tune_point *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        points[i].on_front = true;
        for (size_t k = 0; k < count; k++) {
            points[i].on_front = points[i].on_front && !is_beaten_by(&points[i], &points[k]);
        }
    }
}

/* ---- the drawing ---- */

enum { COLUMNS = 60, LINES = 14 };

/* Points have no logarithm: they stand at what rounding leaves of 1. */
static const double LEAST_WIDTH = 1e-16;

struct axis {
    double low, high; /* logarithms */
};

static struct axis axis_of(double low, double high)
{
    /* Of one value there is an axis all the same, half a decade to either side. */
    const double middle = 0.5 * (log10(low) + log10(high)), half = 0.5 * (log10(high) - log10(low));
    const double least = 0.5;
    return (struct axis){middle - fmax(half, least), middle + fmax(half, least)};
}

static int place(const struct axis *axis, double value, int places)
{
    return (int)((log10(value) - axis->low) / (axis->high - axis->low) * (places - 1) + 0.5);
}

static double width_of(const struct tune_point *point)
{
    return fmax(point->width, LEAST_WIDTH);
}

void tune_draw_front(const struct tune_point *points, size_t count)
{
    char canvas[LINES][COLUMNS + 1];
    double low[2] = {INFINITY, INFINITY}, high[2] = {0, 0};
    for (size_t i = 0; i < count; i++) {
        low[0] = fmin(low[0], points[i].time);
        high[0] = fmax(high[0], points[i].time);
        low[1] = fmin(low[1], width_of(&points[i]));
        high[1] = fmax(high[1], width_of(&points[i]));
    }
    const struct axis times = axis_of(low[0], high[0]), widths = axis_of(low[1], high[1]);
    for (int line = 0; line < LINES; line++) {
        memset(canvas[line], ' ', COLUMNS);
        canvas[line][COLUMNS] = '\0';
    }
    for (size_t i = 0; i < count; i++) {
        char *const cell = &canvas[LINES - 1 - place(&times, points[i].time, LINES)][place(&widths, width_of(&points[i]), COLUMNS)];
        *cell = points[i].on_front ? '*' : *cell == ' ' ? 'o' : *cell;
    }
    puts("  ms a step");
    for (int line = 0; line < LINES; line++) {
        if (line == 0 || line == LINES - 1) {
            printf("%10.3g |%s\n", pow(10, line == 0 ? times.high : times.low), canvas[line]);
        } else {
            printf("           |%s\n", canvas[line]);
        }
    }
    printf("           +");
    for (int column = 0; column < COLUMNS; column++) {
        putchar('-');
    }
    printf("\n            %-10.3g%*s%.3g  width of the widest interval\n", pow(10, widths.low), COLUMNS - 20, "",
           pow(10, widths.high));
}
