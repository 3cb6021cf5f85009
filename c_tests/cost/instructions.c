/*
 * Fixed warm queries through C, for instructions.py to count under callgrind: a function call `measured` for each case.
 * Bodies as CAD systems have them and a hull of points on a sphere, each beside another like it, on an orbit; and round bodies.
 * Distances are of bodies apart, verdicts of bodies that are in and out of each other, contacts of bodies deep in each other.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "swiftprox/tuning.h"

enum { POSES = 180, MOST_POINTS = 2048, MOST_TRIANGLES = 2 * MOST_POINTS };

static const double full_turn = 6.283185307179586;

/* Numerical Recipes' generator: the same numbers everywhere. */
static uint32_t state;

static double signed_unit(void)
{
    state = state * 1664525u + 1013904223u;
    return state / 2147483648.0 - 1;
}

/* A row-major rotation of a quaternion of any length. */
static void turn(double w, double x, double y, double z, double pose[12])
{
    const double s = 2 / (w * w + x * x + y * y + z * z);
    pose[0] = 1 - s * (y * y + z * z);
    pose[1] = s * (x * y - w * z);
    pose[2] = s * (x * z + w * y);
    pose[4] = s * (x * y + w * z);
    pose[5] = 1 - s * (x * x + z * z);
    pose[6] = s * (y * z - w * x);
    pose[8] = s * (x * z - w * y);
    pose[9] = s * (y * z + w * x);
    pose[10] = 1 - s * (x * x + y * y);
}

/* --- Bodies
 * ------------------------------------------------------------------------------------------------------------------- */

/* A body of revolution: a half circle of rings from pole to pole, `flatness` high, or else two rings; or points on a sphere. */
typedef struct {
    const char *name;
    int sides;
    /* Radius and height; a ring of radius 0 is a point. */
    double rings[2][2];
    int arc_steps;
    double flatness;
    /* The ball swept over a point, or over a segment of a half length; 0 of all others. */
    double half, radius;
} body;

typedef struct {
    double points[3 * MOST_POINTS];
    size_t count;
    /* The polygons of bodies of revolution, triangles all. */
    uint32_t indices[3 * MOST_TRIANGLES];
    size_t triangle_count;
} mesh;

static void add_triangle(mesh *m, size_t a, size_t b, size_t c)
{
    uint32_t *corners = m->indices + 3 * m->triangle_count++;
    corners[0] = (uint32_t)a;
    corners[1] = (uint32_t)b;
    corners[2] = (uint32_t)c;
}

/* Adds a ring and what lies between it and the last one, which begins at `below` and has `below_count` points. */
static size_t add_ring(mesh *m, size_t sides, double radius, double z, size_t below, size_t below_count)
{
    const size_t first = m->count, count = radius == 0 ? 1 : sides;
    size_t i;
    for (i = 0; i < count; ++i) {
        double *point = m->points + 3 * m->count++;
        point[0] = radius * cos(full_turn * (double)i / (double)sides);
        point[1] = radius * sin(full_turn * (double)i / (double)sides);
        point[2] = z;
    }
    for (i = 0; i < sides && below_count > 0; ++i) {
        const size_t next = (i + 1) % sides;
        if (below_count > 1) {
            add_triangle(m, below + i, below + next, first + (count > 1 ? next : 0));
        }
        if (count > 1) {
            add_triangle(m, below_count > 1 ? below + i : below, first + next, first + i);
        }
    }
    return count;
}

/* A fan of triangles over a ring that is more than a point. */
static void add_cap(mesh *m, size_t first, size_t count, int is_upper)
{
    size_t i;
    for (i = 1; i + 1 < count; ++i) {
        add_triangle(m, first, first + i + (is_upper ? 0 : 1), first + i + (is_upper ? 1 : 0));
    }
}

static void add_revolved(mesh *m, const body *made)
{
    const int ring_count = made->arc_steps > 0 ? made->arc_steps + 1 : 2;
    size_t count = 0;
    int i;
    for (i = 0; i < ring_count; ++i) {
        const double latitude = full_turn * (0.5 * i / (ring_count - 1) - 0.25);
        const int is_pole = i == 0 || i == ring_count - 1;
        const double radius = made->arc_steps == 0 ? made->rings[i][0] : is_pole ? 0 : cos(latitude);
        const double z = made->arc_steps == 0 ? made->rings[i][1] : made->flatness * sin(latitude);
        const size_t first = m->count;
        count = add_ring(m, (size_t)made->sides, radius, z, first - count, count);
        if (is_pole) {
            add_cap(m, first, count, i > 0);
        }
    }
}

static void add_sphere_points(mesh *m, int count)
{
    state = 1;
    while (count > 0) {
        const double x = signed_unit(), y = signed_unit(), z = signed_unit(), square = x * x + y * y + z * z;
        if (square <= 1 && square > 0.01) {
            double *point = m->points + 3 * m->count++;
            point[0] = x / sqrt(square);
            point[1] = y / sqrt(square);
            point[2] = z / sqrt(square);
            --count;
        }
    }
}

/* Turned, so that what is plane is so up to rounding, and scaled to a bounding radius of 1. */
static void place_points(mesh *m)
{
    double pose[12] = {0}, longest = 0;
    size_t i, k;
    turn(0.9, 0.2, -0.25, 0.27, pose);
    for (i = 0; i < m->count; ++i) {
        const double *p = m->points + 3 * i;
        const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        longest = length > longest ? length : longest;
    }
    for (i = 0; i < m->count; ++i) {
        double *p = m->points + 3 * i, turned[3];
        for (k = 0; k < 3; ++k) {
            turned[k] = (pose[4 * k] * p[0] + pose[4 * k + 1] * p[1] + pose[4 * k + 2] * p[2]) / longest;
        }
        memcpy(p, turned, sizeof turned);
    }
}

static const swiftprox_shape *make(const body *wanted)
{
    static mesh m;
    const swiftprox_shape *shape = NULL;
    m.count = m.triangle_count = 0;
    if (wanted->radius > 0) {
        const double ends[6] = {-wanted->half, 0, 0, wanted->half, 0, 0};
        swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
        options.input = SWIFTPROX_INPUT_HULL;
        options.swept_radius = wanted->radius;
        CHECK_OK(swiftprox_shape_create_from_points(ends, wanted->half > 0 ? 2 : 1, &options, &shape));
    } else if (wanted->sides > 0) {
        add_revolved(&m, wanted);
        place_points(&m);
        CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){m.points, m.count, m.indices, NULL, m.triangle_count}, NULL,
                                                  &shape));
    } else {
        add_sphere_points(&m, 1002);
        CHECK_OK(swiftprox_shape_create_from_points(m.points, m.count, NULL, &shape));
    }
    return shape;
}

static const body box = {"box", 4, {{1, -0.5}, {1, 0.5}}, 0, 0, 0, 0}, wedge = {"wedge", 3, {{1, -0.5}, {1, 0.5}}, 0, 0, 0, 0},
                  nut = {"nut", 6, {{1, -0.4}, {1, 0.4}}, 0, 0, 0, 0},
                  cylinder_16 = {"cylinder-16", 16, {{1, -0.5}, {1, 0.5}}, 0, 0, 0, 0},
                  cylinder_64 = {"cylinder-64", 64, {{1, -0.5}, {1, 0.5}}, 0, 0, 0, 0},
                  cylinder_500 = {"cylinder-500", 500, {{1, -0.5}, {1, 0.5}}, 0, 0, 0, 0},
                  disc_500 = {"disc-500", 500, {{1, -0.025}, {1, 0.025}}, 0, 0, 0, 0},
                  rod_64 = {"rod-64", 64, {{1, -5}, {1, 5}}, 0, 0, 0, 0},
                  cone_200 = {"cone-200", 200, {{1, -0.5}, {0, 1.5}}, 0, 0, 0, 0},
                  egg = {"egg", 24, {{0, 0}, {0, 0}}, 12, 2, 0, 0}, lens = {"lens", 64, {{0, 0}, {0, 0}}, 12, 0.2, 0, 0},
                  sphere = {"sphere", 0, {{0, 0}, {0, 0}}, 0, 0, 0, 0}, ball = {"ball", 0, {{0, 0}, {0, 0}}, 0, 0, 0, 1},
                  capsule = {"capsule", 0, {{0, 0}, {0, 0}}, 0, 0, 0.7, 0.3};

/* --- Motions
 * ------------------------------------------------------------------------------------------------------------------ */

static double poses[POSES][12];

/* Steps of so many degrees along an orbit of so many radii, or "random": anywhere in any orientation; or "parallel": past each
 * other without a turn. */
static void fly(const char *step, double radii)
{
    const double degrees = strtod(step, NULL);
    int i;
    state = 7;
    for (i = 0; i < POSES; ++i) {
        const double part = degrees == 0 ? 0.5 * signed_unit() : degrees * i / 360;
        const double angle = full_turn * (0.1 + part), half = 0.559 * full_turn * part;
        if (strcmp(step, "parallel") == 0) {
            turn(1, 0, 0, 0, poses[i]);
            poses[i][3] = radii;
            poses[i][7] = 0.1 + 1e-3 * i;
            poses[i][11] = 0.2;
            continue;
        }
        if (degrees == 0) {
            const double w = signed_unit(), x = signed_unit(), y = signed_unit(), z = signed_unit();
            turn(w, x, y, z, poses[i]);
        } else {
            turn(cos(half), 0.36 * sin(half), 0.48 * sin(half), 0.8 * sin(half), poses[i]);
        }
        poses[i][3] = radii * cos(angle);
        poses[i][7] = 1.2 * radii * sin(angle);
        poses[i][11] = 0.9 * radii * sin(angle);
    }
}

/* --- Cases
 * -------------------------------------------------------------------------------------------------------------------- */

typedef enum { DISTANCE, VERDICT, CONTACT } asked;

static const struct {
    const body *of;
    const char *step;
    /* Another body beside it, if not another like it. */
    const body *beside;
    asked query;
} cases[] = {
    {&box, "1", NULL, DISTANCE},
    {&box, "random", NULL, DISTANCE},
    {&wedge, "10", NULL, DISTANCE},
    {&nut, "random", NULL, DISTANCE},
    {&cylinder_16, "random", NULL, DISTANCE},
    {&cylinder_64, "1", NULL, DISTANCE},
    {&cylinder_500, "0.1", NULL, DISTANCE},
    {&cylinder_500, "1", NULL, DISTANCE},
    {&cylinder_500, "10", NULL, DISTANCE},
    {&cylinder_500, "random", NULL, DISTANCE},
    {&disc_500, "1", NULL, DISTANCE},
    {&disc_500, "10", NULL, DISTANCE},
    {&rod_64, "10", NULL, DISTANCE},
    {&cone_200, "0.1", NULL, DISTANCE},
    {&cone_200, "random", NULL, DISTANCE},
    {&egg, "1", NULL, DISTANCE},
    {&lens, "10", NULL, DISTANCE},
    {&sphere, "0.1", NULL, DISTANCE},
    {&sphere, "1", NULL, DISTANCE},
    {&sphere, "10", NULL, DISTANCE},
    {&sphere, "random", NULL, DISTANCE},
    {&ball, "random", NULL, DISTANCE},
    {&capsule, "random", NULL, DISTANCE},
    {&ball, "1", &sphere, DISTANCE},
    {&box, "1", NULL, VERDICT},
    {&box, "random", NULL, VERDICT},
    {&cylinder_64, "0.1", NULL, VERDICT},
    {&lens, "1", NULL, VERDICT},
    {&lens, "random", NULL, VERDICT},
    {&box, "parallel", NULL, DISTANCE},
    {&cylinder_16, "parallel", NULL, DISTANCE},
    {&box, "1", NULL, CONTACT},
    {&lens, "1", NULL, CONTACT},
};

typedef swiftprox_status (*query)(swiftprox_placed, swiftprox_placed, swiftprox_pair_cache *, const swiftprox_pair_config *,
                                  swiftprox_pair_answer *);

#if defined(__GNUC__)
__attribute__((noinline))
#endif
void measured(query ask, const swiftprox_shape *shape, const swiftprox_shape *other, const swiftprox_pair_config *config);

/* One flight, the cache cold at its beginning. */
void measured(query ask, const swiftprox_shape *shape, const swiftprox_shape *other, const swiftprox_pair_config *config)
{
    static const double origin[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    swiftprox_pair_cache cache = {{0}};
    swiftprox_pair_answer answer;
    int i, failed = 0;
    for (i = 0; i < POSES; ++i) {
        failed += ask((swiftprox_placed){shape, origin}, (swiftprox_placed){other, poses[i]}, &cache, config, &answer) !=
                  SWIFTPROX_OK;
        failed += answer.outcome == SWIFTPROX_OUTCOME_NONE;
    }
    CHECK(failed == 0);
}

/* Prints the cases as they are measured. What a query would make on first need is made before. */
int main(void)
{
    static const query queries[] = {swiftprox_pair_distance, swiftprox_pair_intersection, swiftprox_pair_contact};
    static const char *const names[] = {"", " verdict", " contact"};
    static const double radii[] = {2, 1.2, 0.4};
    size_t i;
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    swiftprox_pair_tuning tuning = SWIFTPROX_PAIR_TUNING_DEFAULT;
    config.tuning = &tuning;
    for (i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const swiftprox_shape *shape = make(cases[i].of), *other = make(cases[i].beside ? cases[i].beside : cases[i].of);
        fly(cases[i].step, radii[cases[i].query]);
        CHECK_OK(swiftprox_shape_prepare(shape, NULL, NULL));
        CHECK_OK(swiftprox_shape_prepare(other, NULL, NULL));
        measured(queries[cases[i].query], shape, other, &config);
        printf("%s%s%s%s %s\n", cases[i].of->name, cases[i].beside ? "-" : "", cases[i].beside ? cases[i].beside->name : "",
               names[cases[i].query], cases[i].step);
        swiftprox_shape_release(shape);
        swiftprox_shape_release(other);
    }
    return check_report("instructions");
}
