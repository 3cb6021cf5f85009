#include "strip.h"
#include <swiftprox/geometry.h>

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../outline.h"

enum { WIDTH = 300, HEIGHT = 260, MARGIN = 24 };

/* What is seen: x from −9 to 9, heights from −1 to 12. */
static const double LEFT = -8.5, SCALE = 17, GROUND = 22;

struct strip {
    char *text;
    size_t length, capacity;
    int pictures;
};

static void *demand_memory(void *memory)
{
    if (!memory) {
        fputs("no memory for the picture\n", stderr);
        exit(EXIT_FAILURE);
    }
    return memory;
}

static void print(struct strip *strip, const char *format, ...)
{
    va_list arguments;
    char line[256];
    va_start(arguments, format);
    const int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    const size_t more = length < 0 ? 0 : (size_t)length < sizeof line ? (size_t)length : sizeof line - 1;
    if (strip->length + more + 1 > strip->capacity) {
        strip->capacity = 2 * strip->capacity + sizeof line;
        strip->text = demand_memory(realloc(strip->text, strip->capacity));
    }
    memcpy(strip->text + strip->length, line, more + 1);
    strip->length += more;
}

struct strip *strip_create(void)
{
    return demand_memory(calloc(1, sizeof(struct strip)));
}

void strip_destroy(struct strip *strip)
{
    free(strip->text);
    free(strip);
}

/* ---- a body ---- */

static void draw_body(struct strip *strip, const struct body *body)
{
    static const char *const COLOURS[] = {"#0072b2", "#56b4e9", "#009e73", "#e69f00", "#d55e00", "#cc79a7"};
    swiftprox_shape_info info;
    info.struct_size = sizeof info;
    demand(swiftprox_shape_get_info(body->shape, &info));
    double *const vertices = demand_memory(malloc(3 * info.vertex_count * sizeof(double)));
    struct spot *const spots = demand_memory(malloc(3 * info.vertex_count * sizeof *spots));
    demand(swiftprox_shape_copy_vertices(body->shape, vertices, NULL, info.vertex_count));
    for (size_t i = 0; i < info.vertex_count; i++) {
        const double *const v = &vertices[3 * i], *const m = body->pose;
        spots[i].x = m[0] * v[0] + m[1] * v[1] + m[2] * v[2] + m[3];
        spots[i].z = m[8] * v[0] + m[9] * v[1] + m[10] * v[2] + m[11];
    }
    const size_t corners = outline_of(spots, info.vertex_count, spots + info.vertex_count);
    const char *const colour = body->inverse_mass > 0 ? COLOURS[body->id.bits % 6] : "#bbbbbb";
    print(strip, "<polygon fill=\"%s\" stroke=\"#222222\" stroke-width=\"0.6\" points=\"", colour);
    for (size_t i = 0; i < corners; i++) {
        const struct spot spot = spots[info.vertex_count + i];
        print(strip, "%.1f,%.1f ", (spot.x - LEFT) * SCALE, HEIGHT - GROUND - SCALE * spot.z);
    }
    print(strip, "\"/>\n");
    free(spots);
    free(vertices);
}

/* ---- a picture ---- */

static int farther_first(const void *one, const void *other)
{
    const struct body *const a = *(const struct body *const *)one, *const b = *(const struct body *const *)other;
    return (a->place[1] < b->place[1]) - (a->place[1] > b->place[1]);
}

void strip_add(struct strip *strip, const struct world *world, double seconds)
{
    const size_t count = world_body_count(world);
    const struct body **const bodies = demand_memory(malloc(count * sizeof *bodies));
    for (size_t i = 0; i < count; i++) {
        bodies[i] = world_body(world, i);
    }
    qsort(bodies, count, sizeof *bodies, farther_first);
    print(strip, "<svg x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\">\n", MARGIN + strip->pictures * (WIDTH + MARGIN), MARGIN,
          WIDTH, HEIGHT);
    print(strip, "<rect width=\"100%%\" height=\"100%%\" fill=\"#f7f7f7\"/>\n");
    for (size_t i = 0; i < count; i++) {
        draw_body(strip, bodies[i]);
    }
    print(strip, "<text x=\"8\" y=\"18\" font-family=\"sans-serif\" font-size=\"13\">%g s</text>\n</svg>\n", seconds);
    free(bodies);
    strip->pictures++;
}

bool strip_write(const struct strip *strip, const char *path)
{
    FILE *const file = fopen(path, "w");
    if (!file) {
        return false;
    }
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\">\n",
            MARGIN + strip->pictures * (WIDTH + MARGIN), HEIGHT + 2 * MARGIN);
    fprintf(file, "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n%s</svg>\n", strip->text ? strip->text : "");
    const bool good = ferror(file) == 0;
    return fclose(file) == 0 && good;
}
