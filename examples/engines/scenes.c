#include "scenes.h"

#include <math.h>
#include <stdint.h>

static const double PI = 3.14159265358979323846;

/* Numbers from 0 to 1, the same every time (Steele, Lea & Flood 2014, SplitMix64). */
static double next(uint64_t *state)
{
    uint64_t bits = *state += 0x9e3779b97f4a7c15u;
    bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ bits >> 27) * 0x94d049bb133111ebu;
    return (double)((bits ^ bits >> 31) >> 11) * 0x1p-53;
}

/* The points of a body, in axes that the scene likes. */
struct body {
    int count;
    double points[SCENE_MOST_POINTS][3];
};

/* Adds a body at a place, `angle` about the y axis. Its points are turned by a random quaternion before they are rounded, and the
 * body turned back: it stands as it was meant to, up to that rounding. */
static void add(struct scene *scene, const struct body *body, const double place[3], double angle, bool fixed)
{
    struct scene_body *const added = &scene->bodies[scene->count++];
    uint64_t state = (uint64_t)scene->count;
    double q[4], length = 0;
    for (int k = 0; k < 4; k++) {
        q[k] = next(&state) - 0.5;
        length += q[k] * q[k];
    }
    for (int k = 0; k < 4; k++) {
        q[k] /= sqrt(length);
    }
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                               {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                               {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    added->count = body->count;
    added->fixed = fixed;
    for (int i = 0; i < body->count; i++) {
        const double *const p = body->points[i];
        for (int row = 0; row < 3; row++) {
            added->points[i][row] = (float)(turn[row][0] * p[0] + turn[row][1] * p[1] + turn[row][2] * p[2]);
        }
    }
    /* (c + s j) (w - xi - yj - zk) */
    const double c = cos(0.5 * angle), s = sin(0.5 * angle);
    const double back[4] = {c * w + s * y, -c * x - s * z, -c * y + s * w, -c * z + s * x};
    for (int k = 0; k < 4; k++) {
        added->quaternion[k] = back[k];
    }
    for (int k = 0; k < 3; k++) {
        added->place[k] = place[k];
    }
}

static struct body box(double x, double y, double z)
{
    struct body body = {.count = 8};
    const double half[3] = {0.5 * x, 0.5 * y, 0.5 * z};
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) {
            body.points[i][k] = i >> k & 1 ? half[k] : -half[k];
        }
    }
    return body;
}

static struct body drum(int sides, double radius, double height)
{
    struct body body = {.count = 2 * sides};
    for (int i = 0; i < body.count; i++) {
        const double angle = 2 * PI * (i / 2) / sides;
        body.points[i][0] = radius * cos(angle);
        body.points[i][1] = radius * sin(angle);
        body.points[i][2] = i % 2 ? 0.5 * height : -0.5 * height;
    }
    return body;
}

static void ten_boxes(struct scene *scene)
{
    const struct body body = box(0.2, 0.2, 0.2);
    for (int i = 0; i < 10; i++) {
        add(scene, &body, (const double[3]){0, 0, 0.1 + 0.2 * i}, 0, false);
    }
}

static void eight_drums(struct scene *scene)
{
    const struct body body = drum(48, 0.15, 0.1);
    for (int i = 0; i < 8; i++) {
        add(scene, &body, (const double[3]){0, 0, 0.05 + 0.1 * i}, 0, false);
    }
}

/* Six courses, each second one shifted by half a brick. */
static void wall(struct scene *scene)
{
    const struct body brick = box(0.2, 0.1, 0.1), half = box(0.1, 0.1, 0.1);
    for (int course = 0; course < 6; course++) {
        const double height = 0.05 + 0.1 * course;
        for (int i = 0; i < 5 - course % 2; i++) {
            add(scene, &brick, (const double[3]){0.2 * i + 0.1 * (course % 2), 0, height}, 0, false);
        }
        for (int end = 0; end < 2 && course % 2; end++) {
            add(scene, &half, (const double[3]){end ? 0.85 : -0.05, 0, height}, 0, false);
        }
    }
}

/* A half circle of 11 wedges whose faces look at the centre, on two abutments that stay where they are. */
static void arch(struct scene *scene)
{
    enum { WEDGES = 11 };
    const double inner = 0.5, outer = 0.7, width = 0.2, step = PI / WEDGES;
    for (int i = 0; i < WEDGES; i++) {
        const double middle = PI - (i + 0.5) * step, radius = 0.5 * (inner + outer);
        const double place[3] = {radius * cos(middle), 0, 0.2 + radius * sin(middle)};
        struct body wedge = {.count = 8};
        for (int k = 0; k < 8; k++) {
            const double angle = middle + (k & 1 ? 0.5 : -0.5) * step, r = k & 2 ? outer : inner;
            wedge.points[k][0] = r * cos(angle) - place[0];
            wedge.points[k][1] = k & 4 ? 0.5 * width : -0.5 * width;
            wedge.points[k][2] = 0.2 + r * sin(angle) - place[2];
        }
        add(scene, &wedge, place, 0, false);
    }
    const struct body abutment = box(0.2, 0.3, 0.2);
    for (int end = 0; end < 2; end++) {
        add(scene, &abutment, (const double[3]){end ? 0.6 : -0.6, 0, 0.1}, 0, true);
    }
}

/* Three pairs of leaning cards, two cards across, two pairs on these, one card across, and a pair on top. */
static void card_house(struct scene *scene)
{
    const double length = 0.5, thickness = 0.02, lean = 0.3;
    const double rise = length * cos(lean) + thickness * sin(lean), reach = length * sin(lean) + thickness * cos(lean);
    const struct body card = box(thickness, 0.4, length), across = box(2 * reach, 0.4, thickness);
    for (int level = 0; level < 3; level++) {
        const double base = level * (rise + thickness);
        for (int pair = 0; pair < 3 - level; pair++) {
            const double centre = 2 * reach * (pair + 0.5 * level);
            for (int side = -1; side <= 1; side += 2) {
                add(scene, &card, (const double[3]){centre + 0.5 * side * reach, 0, base + 0.5 * rise}, -side * lean, false);
            }
        }
        for (int i = 0; i < 2 - level; i++) {
            const double centre = 2 * reach * (i + 0.5 + 0.5 * level);
            add(scene, &across, (const double[3]){centre, 0, base + rise + 0.5 * thickness}, 0, false);
        }
    }
}

/* 36 hulls of 30 points each that fall into a tray of five boxes. */
static void tray(struct scene *scene)
{
    const struct body wall_x = box(0.1, 1.3, 0.6), wall_y = box(1.3, 0.1, 0.6);
    for (int side = -1; side <= 1; side += 2) {
        add(scene, &wall_x, (const double[3]){0.6 * side, 0, 0.3}, 0, true);
        add(scene, &wall_y, (const double[3]){0, 0.6 * side, 0.3}, 0, true);
    }
    for (int i = 0; i < 36; i++) {
        uint64_t state = 1000 + (uint64_t)i;
        const double radii[3] = {0.07 + 0.07 * next(&state), 0.07 + 0.07 * next(&state), 0.07 + 0.07 * next(&state)};
        struct body hull = {.count = 30};
        for (int k = 0; k < hull.count; k++) {
            const double height = 2 * next(&state) - 1, angle = 2 * PI * next(&state), r = sqrt(1 - height * height);
            hull.points[k][0] = radii[0] * r * cos(angle);
            hull.points[k][1] = radii[1] * r * sin(angle);
            hull.points[k][2] = radii[2] * height;
        }
        add(scene, &hull, (const double[3]){0.3 * (i % 3 - 1), 0.3 * (i / 3 % 3 - 1), 0.3 + 0.3 * (i / 9)}, 0.5 * i, false);
    }
}

void scene_make(int number, struct scene *scene)
{
    static const struct {
        const char *name;
        bool stands;
        void (*fill)(struct scene *scene);
    } SCENES[SCENE_COUNT] = {{"ten boxes", true, ten_boxes},   {"eight drums", true, eight_drums},
                             {"wall of 33 bricks", true, wall}, {"arch of 11 wedges", true, arch},
                             {"card house", true, card_house},  {"36 hulls in a tray", false, tray}};
    scene->name = SCENES[number].name;
    scene->stands = SCENES[number].stands;
    scene->count = 0;
    SCENES[number].fill(scene);
}
