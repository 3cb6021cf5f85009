#include "picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <swiftprox.h>
#include <swiftprox/geometry.h>

#include "../outline.h"
#include "report.h"

enum { WIDTH = 150, HEIGHT = 190, GAP = 10, HEAD = 22, LABELS = 70 };
enum { SHADES = 8, UNITS = 4 /* a pixel: coordinates are whole numbers of them */ };

/* The picture's axes in the world: to the right, up, and to the viewer, who looks from ahead, somewhat from above and the right. */
static const double RIGHT[3] = {0.906, 0.423, 0}, UP[3] = {-0.224, 0.480, 0.848}, NEARER[3] = {0.359, -0.768, 0.530};
static const double LIGHT[3] = {-0.3, -0.45, 0.84};
static const unsigned char COLOURS[][3] = {{0, 114, 178}, {86, 180, 233}, {0, 158, 115}, {230, 159, 0}, {213, 94, 0}, {204, 121, 167}};
static const unsigned char FIXED[3] = {200, 200, 200};

/* What is seen of a scene: a rectangle of the plane of RIGHT and UP. */
struct view {
    double left, bottom, scale;
};

/* A body as it is to be drawn. */
struct drawn {
    const swiftprox_shape *shape;
    const double *pose;
    const unsigned char *colour;
    size_t vertex_count, face_count;
    struct spot spots[SCENE_MOST_POINTS]; /* of the vertices, along RIGHT and UP */
    struct spot low, high;                /* what holds them all */
    double nearness;                      /* of the origin */
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "%s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

/* ---- bodies ---- */

static struct drawn made(const struct scene_body *body, const double pose[12], int number)
{
    struct drawn drawn = {.pose = pose, .colour = body->fixed ? FIXED : COLOURS[number % 6]};
    double points[SCENE_MOST_POINTS][3];
    for (int i = 0; i < 3 * body->count; i++) {
        points[i / 3][i % 3] = (double)body->points[i / 3][i % 3];
    }
    demand(swiftprox_shape_create_from_points(points[0], (size_t)body->count, NULL, &drawn.shape));
    swiftprox_shape_info info;
    info.struct_size = sizeof info;
    demand(swiftprox_shape_get_info(drawn.shape, &info));
    drawn.vertex_count = info.vertex_count;
    drawn.face_count = info.face_count;
    demand(swiftprox_shape_copy_vertices(drawn.shape, points[0], NULL, SCENE_MOST_POINTS));
    drawn.low = (struct spot){INFINITY, INFINITY};
    drawn.high = (struct spot){-INFINITY, -INFINITY};
    for (size_t i = 0; i < drawn.vertex_count; i++) {
        double at[3];
        for (int row = 0; row < 3; row++) {
            at[row] = dot(&pose[4 * row], points[i]) + pose[4 * row + 3];
        }
        const struct spot spot = {dot(RIGHT, at), dot(UP, at)};
        drawn.spots[i] = spot;
        drawn.low = (struct spot){fmin(drawn.low.x, spot.x), fmin(drawn.low.z, spot.z)};
        drawn.high = (struct spot){fmax(drawn.high.x, spot.x), fmax(drawn.high.z, spot.z)};
    }
    const double origin[3] = {pose[3], pose[7], pose[11]};
    drawn.nearness = dot(NEARER, origin);
    return drawn;
}

/* Whether a body is to be drawn after another: it hides some of it, for it is on the viewer's side of a plane between the two. */
static bool is_before(const struct drawn *a, const struct drawn *b)
{
    if (a->low.x > b->high.x || b->low.x > a->high.x || a->low.z > b->high.z || b->low.z > a->high.z) {
        return false;
    }
    static swiftprox_manifold_cache cache;
    swiftprox_signed_distance between;
    demand(swiftprox_pair_signed_distance((swiftprox_placed){a->shape, a->pose}, (swiftprox_placed){b->shape, b->pose}, &cache,
                                          NULL, &between));
    return dot(NEARER, between.normal) > 0;
}

/* Adds a polygon to a path. */
static void draw_polygon(FILE *file, const struct view *view, const struct spot *corners, size_t count)
{
    int x = 0, y = 0;
    for (size_t i = 0; i < count; i++) {
        const int next_x = (int)lround((corners[i].x - view->left) * view->scale * UNITS);
        const int next_y = (int)lround((HEIGHT - (corners[i].z - view->bottom) * view->scale) * UNITS);
        fprintf(file, "%s%d %d", i == 0 ? "M" : i == 1 ? "l" : " ", next_x - x, next_y - y);
        x = next_x;
        y = next_y;
    }
    fputs("Z", file);
}

static void draw_outline(FILE *file, const struct view *view, const struct drawn *body)
{
    struct spot spots[SCENE_MOST_POINTS], corners[2 * SCENE_MOST_POINTS];
    memcpy(spots, body->spots, sizeof spots);
    const size_t count = outline_of(spots, body->vertex_count, corners);
    fputs("<path fill=\"none\" color=\"#222\" stroke-width=\"2\" d=\"", file);
    draw_polygon(file, view, corners, count);
    fputs("\"/>\n", file);
}

/* How light a side is, from 0 to SHADES - 1; below 0 it is not seen. */
static int shade_of(const struct drawn *body, const swiftprox_face *face)
{
    double normal[3];
    for (int row = 0; row < 3; row++) {
        normal[row] = dot(&body->pose[4 * row], face->normal);
    }
    const double light = 0.5 + 0.5 * dot(normal, LIGHT);
    return dot(normal, NEARER) <= 0 ? -1 : (int)fmin(fmax(0, light) * SHADES, SHADES - 1);
}

/* Draws the sides of a body that are seen, those of one shade as one path. */
static void draw_body(FILE *file, const struct view *view, const struct drawn *body)
{
    for (int shade = 0; shade < SHADES; shade++) {
        const double light = 0.55 + 0.45 * (shade + 1) / SHADES;
        bool is_begun = false;
        for (size_t i = 0; i < body->face_count; i++) {
            swiftprox_face face;
            uint32_t corners[SCENE_MOST_POINTS];
            demand(swiftprox_shape_get_face(body->shape, i, (swiftprox_face_room){corners, SCENE_MOST_POINTS, NULL, 0}, &face));
            if (shade_of(body, &face) != shade) {
                continue;
            }
            if (!is_begun) {
                fprintf(file, "<path color=\"rgb(%.0f %.0f %.0f)\" d=\"", light * body->colour[0], light * body->colour[1],
                        light * body->colour[2]);
                is_begun = true;
            }
            struct spot spots[SCENE_MOST_POINTS];
            for (size_t k = 0; k < face.corner_count; k++) {
                spots[k] = body->spots[corners[k]];
            }
            draw_polygon(file, view, spots, face.corner_count);
        }
        if (is_begun) {
            fputs("\"/>\n", file);
        }
    }
    draw_outline(file, view, body);
}

/* ---- scenes ---- */

/* Draws the bodies, the farther ones first: next is always one that is before none of those left. Where each is before another,
 * as in a ring, it is the farthest. */
static void draw_bodies(FILE *file, const struct view *view, const struct drawn *bodies, int count)
{
    static bool before[SCENE_MOST_BODIES][SCENE_MOST_BODIES];
    bool is_drawn[SCENE_MOST_BODIES] = {false};
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < count; k++) {
            before[i][k] = i != k && is_before(&bodies[i], &bodies[k]);
        }
    }
    for (int done = 0; done < count; done++) {
        int next = -1;
        bool next_is_free = false;
        for (int i = 0; i < count; i++) {
            bool is_free = !is_drawn[i];
            for (int k = 0; k < count && is_free; k++) {
                is_free = is_drawn[k] || !before[i][k];
            }
            const bool is_better = is_free != next_is_free ? is_free : next < 0 || bodies[i].nearness < bodies[next].nearness;
            if (!is_drawn[i] && is_better) {
                next = i;
                next_is_free = is_free;
            }
        }
        is_drawn[next] = true;
        draw_body(file, view, &bodies[next]);
    }
}

/* A view of all bodies. */
static struct view view_of(const struct drawn *bodies, int count)
{
    struct spot low = bodies[0].low, high = bodies[0].high;
    for (int i = 1; i < count; i++) {
        low = (struct spot){fmin(low.x, bodies[i].low.x), fmin(low.z, bodies[i].low.z)};
        high = (struct spot){fmax(high.x, bodies[i].high.x), fmax(high.z, bodies[i].high.z)};
    }
    const double scale = 0.9 * fmin(WIDTH / (high.x - low.x), HEIGHT / (high.z - low.z));
    return (struct view){0.5 * (low.x + high.x - WIDTH / scale), low.z - 0.05 * HEIGHT / scale, scale};
}

/* Draws a scene's ends, to one scale, one below the other. */
static void draw_scene(FILE *file, const struct played *played, int x)
{
    static struct drawn bodies[2 * SCENE_MOST_BODIES];
    const struct run *const runs[2] = {&played->theirs, &played->ours};
    const int each = played->scene.count;
    int count = 0;
    for (int row = 0; row < 2; row++) {
        for (int i = 0; i < each && runs[row]->is_played; i++) {
            bodies[count++] = made(&played->scene.bodies[i], runs[row]->poses[i], i);
        }
    }
    const struct view view = view_of(bodies, count);
    const struct drawn *next = bodies;
    for (int row = 0; row < 2; row++) {
        if (runs[row]->is_played) {
            fprintf(file, "<svg x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" fill=\"currentColor\" "
                    "stroke=\"currentColor\" stroke-linejoin=\"round\">\n", x, HEAD + row * (HEIGHT + GAP), WIDTH, HEIGHT,
                    UNITS * WIDTH, UNITS * HEIGHT);
            fputs("<rect width=\"100%\" height=\"100%\" color=\"#f3f3f3\"/>\n", file);
            draw_bodies(file, &view, next, each);
            fputs("</svg>\n", file);
            next += each;
        }
    }
    for (int i = 0; i < count; i++) {
        swiftprox_shape_release(bodies[i].shape);
    }
}

void picture_write(FILE *file, const struct report *report)
{
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" font-size=\"12\">\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
            LABELS + report->count * (WIDTH + GAP), HEAD + 2 * (HEIGHT + GAP));
    for (int row = 0; row < 2; row++) {
        fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">%s</text>\n", LABELS - 8, HEAD + row * (HEIGHT + GAP) + HEIGHT / 2,
                row ? "swiftprox" : report->engine);
    }
    for (int i = 0; i < report->count; i++) {
        const int x = LABELS + i * (WIDTH + GAP);
        fprintf(file, "<text x=\"%d\" y=\"15\">%s</text>\n", x, report->played[i].scene.name);
        draw_scene(file, &report->played[i], x);
    }
    fputs("</svg>\n", file);
}
