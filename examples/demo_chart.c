#include "demo_chart.h"

#include <math.h>
#include <stdio.h>

/* All lengths in the pixels of the picture. */
enum {
    WIDTH = 960,
    PANEL = 320, /* height of a panel with its title and axes */
    LEFT = 76,
    RIGHT = 28,
    TOP = 64,
    BOTTOM = 52,
    PLOT_WIDTH = WIDTH - LEFT - RIGHT,
    PLOT_HEIGHT = PANEL - TOP - BOTTOM,
};

static const char CURVE[] = "#1b5e9e";
static const char SHADE[] = "#e4572e";
static const char GRID[] = "#e3e6ea";
static const char INK[] = "#2b2f36";
static const char FAINT_INK[] = "#6b7280";

/* Where the values of one panel lie in the picture. */
struct frame {
    double top; /* of the plot */
    double largest; /* distance at the upper end of the axis */
    double step; /* between two ticks of the distance axis */
    size_t count;
};

static double x_at(const struct frame *frame, double index)
{
    return LEFT + PLOT_WIDTH * index / (double)frame->count;
}

static double y_at(const struct frame *frame, double distance)
{
    return frame->top + PLOT_HEIGHT * (1.0 - distance / frame->largest);
}

/* The smallest of 1, 2, 5 times a power of ten that is at least `value`. */
static double round_step(double value)
{
    const double power = pow(10.0, floor(log10(value)));
    const double digit = value / power;
    return power * (digit <= 1.0 ? 1.0 : digit <= 2.0 ? 2.0 : digit <= 5.0 ? 5.0 : 10.0);
}

static struct frame frame_of(const struct chart_panel *panel, double top)
{
    double largest = 0.0;
    for (size_t i = 0; i < panel->count; i++) {
        largest = fmax(largest, panel->distances[i]);
    }
    if (largest == 0.0) { /* intersecting all the way */
        largest = 1.0;
    }
    const double step = round_step(largest / 5.0);
    return (struct frame){.top = top, .largest = step * ceil(largest / step * 1.02), .step = step, .count = panel->count};
}

static void write_escaped(FILE *out, const char *text)
{
    for (; *text; text++) {
        switch (*text) {
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '&':
            fputs("&amp;", out);
            break;
        default:
            fputc((unsigned char)*text < ' ' ? ' ' : *text, out); /* XML has no control characters */
        }
    }
}

static void write_text(FILE *out, double x, double y, int size, const char *anchor, const char *colour, const char *text)
{
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" font-size=\"%d\" text-anchor=\"%s\" fill=\"%s\">", x, y, size, anchor, colour);
    write_escaped(out, text);
    fputs("</text>\n", out);
}

static void write_grid(FILE *out, const struct frame *frame)
{
    char label[32];
    const double bottom = frame->top + PLOT_HEIGHT;
    for (int tick = 0; tick * frame->step < frame->largest * (1.0 + 1e-9); tick++) {
        const double value = tick * frame->step;
        const double y = y_at(frame, value);
        fprintf(out, "<path d=\"M%d %.1fH%d\" stroke=\"%s\"/>\n", LEFT, y, LEFT + PLOT_WIDTH, GRID);
        snprintf(label, sizeof label, "%.6g", value);
        write_text(out, LEFT - 8, y + 4, 12, "end", FAINT_INK, label);
    }
    for (int degrees = 0; degrees <= 360; degrees += 30) {
        const double x = LEFT + PLOT_WIDTH * degrees / 360.0;
        fprintf(out, "<path d=\"M%.1f %.1fV%.1f\" stroke=\"%s\"/>\n", x, frame->top, bottom, GRID);
        snprintf(label, sizeof label, "%d\302\260", degrees); /* the degree sign in UTF-8 */
        write_text(out, x, bottom + 18, 12, "middle", FAINT_INK, label);
    }
    write_text(out, LEFT + PLOT_WIDTH / 2.0, bottom + 40, 13, "middle", INK, "time, in degrees of the orbit");
    fprintf(out, "<text transform=\"translate(22 %.1f) rotate(-90)\" font-size=\"13\" text-anchor=\"middle\" fill=\"%s\">",
            frame->top + PLOT_HEIGHT / 2.0, INK);
    fputs("distance</text>\n", out);
}

static void write_intersecting_spans(FILE *out, const struct frame *frame, const double *distances)
{
    for (size_t begin = 0; begin < frame->count; begin++) {
        size_t end = begin;
        while (end < frame->count && distances[end] == 0.0) {
            end++;
        }
        if (end > begin) {
            const double x = x_at(frame, (double)begin);
            const double width = x_at(frame, (double)end) - x;
            fprintf(out, "<rect x=\"%.2f\" y=\"%.1f\" width=\"%.2f\" height=\"%d\" fill=\"%s\" fill-opacity=\"0.16\"/>\n", x,
                    frame->top, width, PLOT_HEIGHT, SHADE);
            begin = end;
        }
    }
}

static void write_curve(FILE *out, const struct frame *frame, const double *distances)
{
    fputs("<path fill=\"none\" stroke-width=\"1.8\" stroke-linejoin=\"round\" d=\"", out);
    for (size_t i = 0; i < frame->count; i++) {
        fprintf(out, "%c%.2f %.2f", i ? 'L' : 'M', x_at(frame, (double)i), y_at(frame, distances[i]));
    }
    fprintf(out, "\" stroke=\"%s\"/>\n", CURVE);
}

static void write_legend(FILE *out, double y)
{
    const int right = LEFT + PLOT_WIDTH;
    fprintf(out, "<path d=\"M%d %.1fh24\" stroke=\"%s\" stroke-width=\"1.8\"/>\n", right - 194, y - 4, CURVE);
    write_text(out, right - 164, y, 12, "start", INK, "distance");
    fprintf(out, "<rect x=\"%d\" y=\"%.1f\" width=\"18\" height=\"12\" fill=\"%s\" fill-opacity=\"0.16\"/>\n", right - 98,
            y - 10, SHADE);
    write_text(out, right - 74, y, 12, "start", INK, "intersecting");
}

bool chart_write(const char *path, const struct chart_panel *panels, size_t count)
{
    FILE *out = fopen(path, "w");
    if (!out) {
        return false;
    }
    const int height = PANEL * (int)count;
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" "
            "font-family=\"DejaVu Sans, Verdana, sans-serif\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            WIDTH, height, WIDTH, height);
    for (size_t i = 0; i < count; i++) {
        const double top = PANEL * (double)i;
        const struct frame frame = frame_of(&panels[i], top + TOP);
        write_text(out, LEFT, top + 30, 17, "start", INK, panels[i].title);
        write_text(out, LEFT, top + 51, 12, "start", FAINT_INK, panels[i].subtitle);
        write_legend(out, top + 51);
        write_intersecting_spans(out, &frame, panels[i].distances);
        write_grid(out, &frame);
        write_curve(out, &frame, panels[i].distances);
        fprintf(out, "<rect x=\"%d\" y=\"%.1f\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"%s\"/>\n", LEFT, frame.top,
                PLOT_WIDTH, PLOT_HEIGHT, FAINT_INK);
    }
    fputs("</svg>\n", out);
    const bool good = !ferror(out);
    return fclose(out) == 0 && good;
}
