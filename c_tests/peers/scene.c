#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *scene_allocate(size_t count, size_t size)
{
    void *memory = calloc(count, size);
    if (memory == NULL) {
        fputs("out of memory\n", stderr);
        exit(2);
    }
    return memory;
}

/* ---- random numbers ------------------------------------------------------------------------------------------------ */

/* SplitMix64 (Steele, Lea & Flood 2014). */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* In [0, 1). */
static double uniform(uint64_t *state)
{
    return (double)(next_random(state) >> 11) * 0x1p-53;
}

static double angle(uint64_t *state)
{
    return 6.283185307179586 * uniform(state);
}

/* A point of the unit sphere: z is uniform (Archimedes). */
static void unit_vector(uint64_t *state, double v[3])
{
    double z = 2 * uniform(state) - 1, phi = angle(state), r = sqrt(1 - z * z);
    v[0] = r * cos(phi);
    v[1] = r * sin(phi);
    v[2] = z;
}

/* ---- bodies -------------------------------------------------------------------------------------------------------- */

enum body_kind { ELLIPSOID, BOX, PRISM, RANDOM_HULL };

/* `size`: an ellipsoid's or hull's points, a prism's sides; `axes`: semi-axes, of a prism its radii and half height. */
struct body_spec {
    enum body_kind kind;
    size_t size;
    double axes[3];
};

/* Points on an ellipsoid, scaled to bounding radius 1. */
static swiftprox_status create_ellipsoid(const struct body_spec *spec, uint64_t *random, struct body *body)
{
    double largest = 0;
    for (size_t i = 0; i < spec->size; ++i) {
        double *p = body->points + 3 * i;
        unit_vector(random, p);
        for (int k = 0; k < 3; ++k)
            p[k] *= spec->axes[k];
        largest = fmax(largest, sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
    }
    for (size_t i = 0; i < 3 * spec->size; ++i)
        body->points[i] /= largest;
    return swiftprox_shape_create_from_points(body->points, body->point_count, NULL, &body->shape);
}

/* Points in a ball: most of them are inside the hull. */
static swiftprox_status create_random_hull(const struct body_spec *spec, uint64_t *random, struct body *body)
{
    for (size_t i = 0; i < spec->size; ++i) {
        double *p = body->points + 3 * i, radius = cbrt(uniform(random));
        unit_vector(random, p);
        for (int k = 0; k < 3; ++k)
            p[k] *= radius * spec->axes[k];
    }
    return swiftprox_shape_create_from_points(body->points, body->point_count, NULL, &body->shape);
}

/* A prism about the z axis over a polygon of `sides` corners, as a mesh of two polygons and a belt of quadrilaterals. */
static swiftprox_status create_prism(size_t sides, struct body *body)
{
    uint32_t *valences = scene_allocate(sides + 2, sizeof *valences);
    uint32_t *indices = scene_allocate(6 * sides, sizeof *indices), *next = indices;
    for (size_t i = 0; i < sides; ++i)
        *next++ = (uint32_t)(sides - 1 - i);
    for (size_t i = 0; i < sides; ++i)
        *next++ = (uint32_t)(sides + i);
    valences[0] = valences[1] = (uint32_t)sides;
    for (size_t i = 0; i < sides; ++i) {
        size_t j = (i + 1) % sides;
        *next++ = (uint32_t)i;
        *next++ = (uint32_t)j;
        *next++ = (uint32_t)(sides + j);
        *next++ = (uint32_t)(sides + i);
        valences[2 + i] = 4;
    }
    const swiftprox_mesh mesh = {body->points, body->point_count, indices, valences, sides + 2};
    swiftprox_status status = swiftprox_shape_create_from_mesh(mesh, NULL, &body->shape);
    free(indices);
    free(valences);
    return status;
}

static swiftprox_status create_body(const struct body_spec *spec, uint64_t *random, struct body *body)
{
    size_t sides = spec->kind == BOX ? 4 : spec->size;
    int is_prism = spec->kind == BOX || spec->kind == PRISM;
    body->point_count = is_prism ? 2 * sides : spec->size;
    body->points = scene_allocate(3 * body->point_count, sizeof *body->points);
    if (spec->kind == ELLIPSOID)
        return create_ellipsoid(spec, random, body);
    if (spec->kind == RANDOM_HULL)
        return create_random_hull(spec, random, body);
    for (size_t i = 0; i < body->point_count; ++i) {
        /* The corners of a box are (+-1, +-1), free of rounding. */
        size_t corner = i % sides;
        double phi = 6.283185307179586 * (double)corner / (double)sides;
        double x = spec->kind == BOX ? (corner == 0 || corner == 3 ? -1 : 1) : cos(phi);
        double y = spec->kind == BOX ? (corner < 2 ? -1 : 1) : sin(phi);
        body->points[3 * i] = x * spec->axes[0];
        body->points[3 * i + 1] = y * spec->axes[1];
        body->points[3 * i + 2] = i < sides ? -spec->axes[2] : spec->axes[2];
    }
    return create_prism(sides, body);
}

/* ---- poses --------------------------------------------------------------------------------------------------------- */

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/* Sets the rotation of a pose: about an axis (Rodrigues). */
static void set_rotation(double pose[12], const double u[3], double phi)
{
    double c = cos(phi), s = sin(phi), d = 1 - c;
    const double r[9] = {
        c + d * u[0] * u[0],        d * u[0] * u[1] - s * u[2], d * u[0] * u[2] + s * u[1],
        d * u[1] * u[0] + s * u[2], c + d * u[1] * u[1],        d * u[1] * u[2] - s * u[0],
        d * u[2] * u[0] - s * u[1], d * u[2] * u[1] + s * u[0], c + d * u[2] * u[2],
    };
    for (int i = 0; i < 9; ++i)
        pose[i / 3 * 4 + i % 3] = r[i];
}

static void set_random_rotation(double pose[12], uint64_t *random)
{
    double axis[3];
    unit_vector(random, axis);
    set_rotation(pose, axis, angle(random));
}

/* The benchmark's motion: the first body rests, the second one goes round it on an ellipse of least radius `radius` and
 * turns a little faster than it goes round, so that no pose recurs. `step` in degrees; 0: no coherence at all. */
static void orbit(double radius, double step, size_t count, uint64_t *random, double (*poses)[24])
{
    double tilt[12], spin_axis[3], rest[12], phase = angle(random);
    memcpy(rest, identity, sizeof rest);
    set_random_rotation(rest, random);
    set_random_rotation(tilt, random);
    unit_vector(random, spin_axis);
    for (size_t i = 0; i < count; ++i) {
        double *pose = poses[i] + 12, theta = phase;
        memcpy(poses[i], rest, sizeof rest);
        if (step == 0) {
            theta = angle(random);
            set_random_rotation(pose, random);
        } else {
            double turned = step * (double)i * 0.017453292519943295;
            theta += turned;
            set_rotation(pose, spin_axis, 1.1180339887 * turned);
        }
        double x = radius * cos(theta), y = 1.5 * radius * sin(theta);
        for (int k = 0; k < 3; ++k)
            pose[4 * k + 3] = tilt[4 * k] * x + tilt[4 * k + 1] * y;
    }
}

/* The second body a hair from touching or from parting: a random pose, then moved along the normal until the gap, as far
 * as rounding lets it, is +-10^-3 to +-10^-16. */
static void near_contact(const struct scene *scene, size_t count, uint64_t *random, double (*poses)[24])
{
    for (size_t i = 0; i < count; ++i) {
        double *pose = poses[i] + 12, direction[3];
        swiftprox_pair_cache cache = {{0}};
        swiftprox_pair_answer answer;
        memcpy(poses[i], identity, sizeof identity);
        set_random_rotation(poses[i], random);
        set_random_rotation(pose, random);
        unit_vector(random, direction);
        for (int k = 0; k < 3; ++k)
            pose[4 * k + 3] = 3 * direction[k];
        double gap = pow(10, -3 - 13 * uniform(random)) * (next_random(random) & 1 ? 1 : -1);
        swiftprox_status status =
            swiftprox_pair_distance((swiftprox_placed){scene->bodies[0].shape, poses[i]},
                                    (swiftprox_placed){scene->bodies[1].shape, pose}, &cache, NULL, &answer);
        if (status == SWIFTPROX_OK && answer.outcome == SWIFTPROX_OUTCOME_SEPARATED)
            for (int k = 0; k < 3; ++k)
                pose[4 * k + 3] += (answer.distance - gap) * answer.normal[k];
    }
}

/* Right angles and multiples of 1/4, without any rounding: boxes touch in faces, edges and vertices, all exactly. */
static void lattice(size_t count, uint64_t *random, double (*poses)[24])
{
    for (size_t i = 0; i < count; ++i) {
        double *pose = poses[i] + 12;
        int first = (int)(next_random(random) % 3), second = (first + 1 + (int)(next_random(random) % 2)) % 3;
        int third = 3 - first - second, even = second == (first + 1) % 3;
        double s = next_random(random) & 1 ? 1 : -1, t = next_random(random) & 1 ? 1 : -1;
        memcpy(poses[i], identity, sizeof identity);
        memset(pose, 0, sizeof identity);
        pose[first] = s;
        pose[4 + second] = t;
        pose[8 + third] = even ? s * t : -s * t; /* determinant 1 */
        for (int k = 0; k < 3; ++k)
            pose[4 * k + 3] = 0.25 * ((double)(next_random(random) % 17) - 8);
    }
}

/* ---- scenes -------------------------------------------------------------------------------------------------------- */

/* Where the second spec is empty, the second body is another one of the first kind. `per_motion`: poses on each of the 24
 * orbits; `near_contact`, `lattice`: poses of these kinds. */
static const struct {
    const char *name;
    struct body_spec bodies[2];
    size_t per_motion;
    size_t near_contact;
    size_t lattice;
} specs[] = {
    {"fat 10", {{ELLIPSOID, 10, {1, 1, 1}}}, 400, 2000, 0},
    {"plate 10", {{ELLIPSOID, 10, {1, 1, .1}}}, 400, 2000, 0},
    {"long 10", {{ELLIPSOID, 10, {1, .1, .1}}}, 400, 2000, 0},
    {"fat 102", {{ELLIPSOID, 102, {1, 1, 1}}}, 400, 2000, 0},
    {"plate 102", {{ELLIPSOID, 102, {1, 1, .1}}}, 400, 2000, 0},
    {"long 102", {{ELLIPSOID, 102, {1, .1, .1}}}, 400, 2000, 0},
    {"fat 1,002", {{ELLIPSOID, 1002, {1, 1, 1}}}, 100, 400, 0},
    {"plate 1,002", {{ELLIPSOID, 1002, {1, 1, .1}}}, 100, 400, 0},
    {"long 1,002", {{ELLIPSOID, 1002, {1, .1, .1}}}, 100, 400, 0},
    {"fat 10,002", {{ELLIPSOID, 10002, {1, 1, 1}}}, 12, 40, 0},
    {"plate 10,002", {{ELLIPSOID, 10002, {1, 1, .1}}}, 12, 40, 0},
    {"long 10,002", {{ELLIPSOID, 10002, {1, .1, .1}}}, 12, 40, 0},
    {"cube, cube", {{BOX, 0, {.5, .5, .5}}, {BOX, 0, {.5, .5, .5}}}, 100, 2000, 4000},
    {"box, plank", {{BOX, 0, {.25, .5, .75}}, {BOX, 0, {1, .25, .0625}}}, 100, 2000, 4000},
    {"prism, box", {{PRISM, 5, {1, 1, .5}}, {BOX, 0, {.5, .5, .5}}}, 100, 2000, 2000},
    {"prism, coin", {{PRISM, 3, {.5, .5, 1}}, {PRISM, 64, {1, 1, .02}}}, 100, 2000, 2000},
    {"hull, hull", {{RANDOM_HULL, 40, {1, 1, 1}}, {RANDOM_HULL, 12, {1, 1, 1}}}, 100, 2000, 0},
    {"hull, prism", {{RANDOM_HULL, 200, {1, .8, .6}}, {PRISM, 7, {.7, .7, .4}}}, 100, 2000, 0},
};

static const double orbit_radii[] = {2.0, 3.0, 1.2};
static const double orbit_steps[] = {.1, 1, 5, 10, 20, 45, 90, 0};

enum {
    ORBITS = sizeof orbit_radii / sizeof *orbit_radii,
    STEPS = sizeof orbit_steps / sizeof *orbit_steps
};

size_t scene_count(void)
{
    return sizeof specs / sizeof *specs;
}

int scene_create(size_t index, struct scene *scene)
{
    uint64_t random = index + 1;
    memset(scene, 0, sizeof *scene);
    snprintf(scene->name, sizeof scene->name, "%s", specs[index].name);
    for (int k = 0; k < 2; ++k) {
        const struct body_spec *spec = &specs[index].bodies[k];
        if (k == 1 && spec->kind == ELLIPSOID)
            spec = &specs[index].bodies[0];
        if (create_body(spec, &random, &scene->bodies[k]) != SWIFTPROX_OK)
            return 0;
    }
    size_t per_motion = specs[index].per_motion, near = specs[index].near_contact, on_lattice = specs[index].lattice;
    scene->pose_count = ORBITS * STEPS * per_motion + near + on_lattice;
    scene->poses = scene_allocate(scene->pose_count, sizeof *scene->poses);
    double (*next)[24] = scene->poses;
    for (int o = 0; o < ORBITS; ++o)
        for (int s = 0; s < STEPS; ++s, next += per_motion)
            orbit(orbit_radii[o], orbit_steps[s], per_motion, &random, next);
    near_contact(scene, near, &random, next);
    lattice(on_lattice, &random, next + near);
    return 1;
}

void scene_destroy(struct scene *scene)
{
    for (int k = 0; k < 2; ++k) {
        swiftprox_shape_release(scene->bodies[k].shape);
        free(scene->bodies[k].points);
    }
    free(scene->poses);
}
