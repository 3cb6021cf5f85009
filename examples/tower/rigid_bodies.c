#include "rigid_bodies.h"
#include <swiftprox/replay.h>
#include <swiftprox/sets.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vectors.h"

enum { MOST_BODIES = 64, MOST_PAIRS = MOST_BODIES * (MOST_BODIES - 1) / 2, MOST_FEET = 4 * MOST_BODIES, ITERATIONS = 30 };

static const double GRAVITY = -9.81, FRICTION = 0.6, MARGIN = 0.02, SLOP = 1e-3, PUSH = 0.2;

/* A point of a manifold, and the impulses that hold it: along the normal and two tangents. */
struct contact {
    uint64_t id;
    double arm1[3], arm2[3];
    double gap;
    double impulse[3];
    bool is_known; /* from the step before */
};

/* What a pair of bodies remembers, and its contacts. */
struct pair {
    struct body *bodies[2];
    swiftprox_manifold_cache cache;
    double axes[3][3]; /* normal, tangents */
    struct contact contacts[4];
    size_t count;
    bool is_near;
};

struct world {
    swiftprox_scene *scene;
    struct body bodies[MOST_BODIES];
    size_t count;
    struct pair pairs[MOST_PAIRS]; /* of bodies a < b at b·(b − 1)/2 + a */
    struct body ground;            /* it never moves */
    struct pair feet[MOST_FEET];   /* of a body and the ground, one for each contact */
    size_t foot_count;
    swiftprox_scratch *scratch; /* null without a ground */
    double depth;
};

void demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "%s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

struct world *world_create(void)
{
    struct world *const world = calloc(1, sizeof *world);
    if (world) {
        demand(swiftprox_scene_create(NULL, &world->scene));
    }
    return world;
}

void world_record(struct world *world, const char *path)
{
    demand(swiftprox_scene_record(world->scene, path));
}

void world_destroy(struct world *world)
{
    demand(swiftprox_scene_destroy(world->scene));
    for (size_t i = 0; i < world->count; i++) {
        swiftprox_shape_release(world->bodies[i].shape);
    }
    swiftprox_scratch_destroy(world->scratch);
    free(world);
}

size_t world_body_count(const struct world *world)
{
    return world->count;
}

const struct body *world_body(const struct world *world, size_t index)
{
    return &world->bodies[index];
}

double world_depth(const struct world *world)
{
    return world->depth;
}

/* ---- a body ---- */

/* The pose of place and quaternion. */
static void place_body(struct body *body)
{
    const double w = body->quaternion[0], x = body->quaternion[1], y = body->quaternion[2], z = body->quaternion[3];
    const double rows[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    for (int i = 0; i < 3; i++) {
        memcpy(&body->pose[4 * i], &rows[3 * i], 3 * sizeof(double));
        body->pose[4 * i + 3] = body->place[i];
    }
}

/* R·I⁻¹·Rᵀ·v */
static void turn_of(const struct body *body, const double v[3], double turn[3])
{
    double local[3];
    for (int i = 0; i < 3; i++) {
        local[i] = body->pose[i] * v[0] + body->pose[4 + i] * v[1] + body->pose[8 + i] * v[2];
    }
    multiply(body->inverse_inertia, local, local);
    for (int i = 0; i < 3; i++) {
        turn[i] = dot(&body->pose[4 * i], local);
    }
}

static void invert(const double m[9], double inverse[9])
{
    double rows[3][3];
    for (int i = 0; i < 3; i++) {
        cross(&m[3 * ((i + 1) % 3)], &m[3 * ((i + 2) % 3)], rows[i]);
    }
    const double determinant = dot(m, rows[0]);
    for (int i = 0; i < 9; i++) {
        inverse[i] = rows[i % 3][i / 3] / determinant;
    }
}

void world_add(struct world *world, const swiftprox_shape *shape, const double place[3], bool fixed)
{
    swiftprox_shape_info info;
    info.struct_size = sizeof info;
    demand(swiftprox_shape_get_info(shape, &info));
    if (world->count == MOST_BODIES) {
        fputs("no more bodies\n", stderr);
        exit(EXIT_FAILURE);
    }
    struct body *const body = &world->bodies[world->count];
    *body = (struct body){.shape = shape, .quaternion = {1, 0, 0, 0}};
    memcpy(body->place, place, sizeof body->place);
    place_body(body);
    if (!fixed) {
        body->inverse_mass = 1 / info.volume;
        /* Of density 1: the volume is the mass. */
        double inertia[9];
        for (int i = 0; i < 9; i++) {
            inertia[i] = info.volume * info.inertia[i];
        }
        invert(inertia, body->inverse_inertia);
    }
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    options.user_data = world->count;
    options.fixed = fixed;
    memcpy(options.pose, body->pose, sizeof options.pose);
    demand(swiftprox_scene_add_object(world->scene, &shape, 1, &options, &body->id));
    world->count++;
}

void world_add_ground(struct world *world, const swiftprox_ground *ground)
{
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    options.ground = ground;
    demand(swiftprox_scratch_create(&world->scratch));
    demand(swiftprox_scene_add_object(world->scene, NULL, 0, &options, &world->ground.id));
    swiftprox_ground_release(ground);
    world->ground.quaternion[0] = 1;
    place_body(&world->ground);
}

/* ---- contacts ---- */

static struct pair *pair_of(struct world *world, size_t a, size_t b)
{
    return &world->pairs[b * (b - 1) / 2 + a];
}

/* Makes the contacts of a manifold; impulses of points that were there before are carried on. */
static void set_contacts(struct pair *pair, const swiftprox_manifold *manifold, const swiftprox_manifold_point *points,
                         const struct pair *before)
{
    struct body *const *const bodies = pair->bodies;
    pair->count = manifold->point_count < 4 ? manifold->point_count : 4;
    memcpy(pair->axes[0], manifold->normal, sizeof pair->axes[0]);
    tangents(pair->axes[0], pair->axes[1], pair->axes[2]);
    for (size_t i = 0; i < pair->count; i++) {
        struct contact *const contact = &pair->contacts[i];
        *contact = (struct contact){.id = points[i].id, .gap = 0.5 * (points[i].gap_lower + points[i].gap_upper)};
        for (int k = 0; k < 3; k++) {
            contact->arm1[k] = points[i].world1[k] - bodies[0]->place[k];
            contact->arm2[k] = points[i].world2[k] - bodies[1]->place[k];
        }
        for (size_t j = 0; before && j < before->count; j++) {
            if (before->contacts[j].id == contact->id) {
                memcpy(contact->impulse, before->contacts[j].impulse, sizeof contact->impulse);
                contact->is_known = true;
            }
        }
    }
}

/* Asks for the pair's manifold. */
static void find_contacts(struct world *world, struct pair *pair)
{
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    config.max_distance = MARGIN;
    config.reduces = 1;
    swiftprox_manifold manifold;
    swiftprox_manifold_point points[4];
    struct body *const *const bodies = pair->bodies;
    demand(swiftprox_pair_manifold((swiftprox_placed){bodies[0]->shape, bodies[0]->pose},
                                   (swiftprox_placed){bodies[1]->shape, bodies[1]->pose}, &pair->cache, &config,
                                   (swiftprox_manifold_room){points, 4, NULL}, &manifold));
    const struct pair before = *pair;
    pair->count = manifold.point_count;
    if (pair->count > 0) {
        world->depth = fmax(world->depth, -manifold.lower);
        set_contacts(pair, &manifold, points, &before);
    }
}

/* Asks once where bodies stand on the scene's ground. A body has a contact for each side that it meets. */
static void find_feet(struct world *world)
{
    static struct pair before[MOST_FEET];
    const size_t count = world->foot_count;
    memcpy(before, world->feet, count * sizeof *before);
    swiftprox_scene_ground_config config = SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT;
    config.max_distance = MARGIN;
    config.reduces = 1;
    const swiftprox_placed_ground own = {NULL, NULL};
    swiftprox_scene_ground_answer answer;
    demand(swiftprox_scene_ground_contacts(world->scene, NULL, own, &config, world->scratch, &answer));
    world->foot_count = answer.contact_count < MOST_FEET ? answer.contact_count : MOST_FEET;
    for (size_t i = 0; i < world->foot_count; i++) {
        const swiftprox_scene_ground_contact *const found = &answer.contacts[i];
        const swiftprox_manifold *const manifold = &found->contact.manifold;
        struct pair *const foot = &world->feet[i];
        const struct pair *known = NULL;
        *foot = (struct pair){.bodies = {&world->bodies[found->user_data], &world->ground}};
        for (size_t j = 0; j < count; j++) {
            if (before[j].bodies[0] == foot->bodies[0] && dot(before[j].axes[0], manifold->normal) > 0.99) {
                known = &before[j];
            }
        }
        world->depth = fmax(world->depth, -manifold->lower);
        set_contacts(foot, manifold, &answer.points[found->contact.first_point], known);
    }
}

void world_count_points(const struct world *world, size_t last, size_t *known, size_t *points)
{
    for (size_t b = 1; b <= last; b++) {
        for (size_t a = 0; a < b; a++) {
            const struct pair *const pair = &world->pairs[b * (b - 1) / 2 + a];
            for (size_t c = 0; c < pair->count; c++) {
                *known += pair->contacts[c].is_known;
                *points += 1;
            }
        }
    }
}

/* Of all pairs that are near. */
static void find_all_contacts(struct world *world)
{
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.max_distance = MARGIN;
    swiftprox_scene_answer answer;
    demand(swiftprox_scene_query_distance(world->scene, &query, &answer));
    world->depth = 0;
    for (size_t i = 0; i < MOST_PAIRS; i++) {
        world->pairs[i].is_near = false;
    }
    for (size_t i = 0; i < answer.count; i++) {
        const size_t a = (size_t)answer.pairs[i].user_data1, b = (size_t)answer.pairs[i].user_data2;
        if (answer.pairs[i].object1.bits == world->ground.id.bits || answer.pairs[i].object2.bits == world->ground.id.bits) {
            continue; /* its contacts are asked for below */
        }
        struct pair *const pair = pair_of(world, a, b);
        pair->bodies[0] = &world->bodies[a];
        pair->bodies[1] = &world->bodies[b];
        pair->is_near = true;
        find_contacts(world, pair);
    }
    for (size_t i = 0; i < MOST_PAIRS; i++) {
        world->pairs[i].count = world->pairs[i].is_near ? world->pairs[i].count : 0;
    }
    if (world->scratch) {
        find_feet(world);
    }
}

/* Pairs of bodies, then those with the ground. */
static struct pair *pair_at(struct world *world, size_t index)
{
    return index < MOST_PAIRS ? &world->pairs[index] : &world->feet[index - MOST_PAIRS];
}

/* Pushes the bodies apart at a contact, along one of the pair's axes. */
static void push(struct pair *pair, const struct contact *contact, int axis, double impulse)
{
    for (int i = 0; i < 2; i++) {
        struct body *const body = pair->bodies[i];
        const double signed_impulse = i == 0 ? impulse : -impulse;
        double lever[3], turn[3];
        cross(i == 0 ? contact->arm1 : contact->arm2, pair->axes[axis], lever);
        turn_of(body, lever, turn);
        add_scaled(body->velocity, signed_impulse * body->inverse_mass, pair->axes[axis]);
        add_scaled(body->spin, signed_impulse, turn);
    }
}

/* How fast the bodies part at a contact along an axis, and how much an impulse of 1 adds to that. */
static double parting(const struct pair *pair, const struct contact *contact, int axis, double *response)
{
    double speed = 0;
    *response = 0;
    for (int i = 0; i < 2; i++) {
        const struct body *const body = pair->bodies[i];
        double lever[3], turn[3];
        cross(i == 0 ? contact->arm1 : contact->arm2, pair->axes[axis], lever);
        turn_of(body, lever, turn);
        *response += body->inverse_mass + dot(lever, turn);
        speed += (i == 0 ? 1 : -1) * (dot(body->velocity, pair->axes[axis]) + dot(body->spin, lever));
    }
    return speed;
}

static void solve_contact(struct pair *pair, struct contact *contact, double seconds)
{
    for (int axis = 2; axis >= 0; axis--) { /* friction first: the normal has the last word */
        double response;
        const double speed = parting(pair, contact, axis, &response);
        /* Open gaps may close within the step, overlaps are pushed out little by little. */
        const double wanted = axis > 0           ? 0
                              : contact->gap > 0 ? -contact->gap / seconds
                                                 : PUSH * fmax(0, -contact->gap - SLOP) / seconds;
        const double limit = FRICTION * contact->impulse[0];
        const double sum = contact->impulse[axis] + (wanted - speed) / response;
        const double clamped = axis == 0 ? fmax(sum, 0) : fmax(-limit, fmin(limit, sum));
        push(pair, contact, axis, clamped - contact->impulse[axis]);
        contact->impulse[axis] = clamped;
    }
}

/* ---- a step ---- */

static void move_body(struct world *world, struct body *body, double seconds)
{
    add_scaled(body->place, seconds, body->velocity);
    const double *const q = body->quaternion, *const s = body->spin;
    double moved[4] = {q[0] - 0.5 * seconds * (s[0] * q[1] + s[1] * q[2] + s[2] * q[3]),
                       q[1] + 0.5 * seconds * (s[0] * q[0] + s[1] * q[3] - s[2] * q[2]),
                       q[2] + 0.5 * seconds * (s[1] * q[0] + s[2] * q[1] - s[0] * q[3]),
                       q[3] + 0.5 * seconds * (s[2] * q[0] + s[0] * q[2] - s[1] * q[1])};
    const double length = sqrt(moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2] + moved[3] * moved[3]);
    for (int i = 0; i < 4; i++) {
        body->quaternion[i] = moved[i] / length;
    }
    place_body(body);
    demand(swiftprox_scene_set_pose(world->scene, body->id, body->pose));
}

void world_step(struct world *world, double seconds)
{
    find_all_contacts(world);
    for (size_t i = 0; i < world->count; i++) {
        world->bodies[i].velocity[2] += world->bodies[i].inverse_mass > 0 ? seconds * GRAVITY : 0;
    }
    const size_t pair_count = MOST_PAIRS + world->foot_count;
    for (size_t i = 0; i < pair_count; i++) {
        struct pair *const pair = pair_at(world, i);
        for (size_t c = 0; c < pair->count; c++) {
            for (int axis = 0; axis < 3; axis++) {
                push(pair, &pair->contacts[c], axis, pair->contacts[c].impulse[axis]);
            }
        }
    }
    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        for (size_t i = 0; i < pair_count; i++) {
            struct pair *const pair = pair_at(world, i);
            for (size_t c = 0; c < pair->count; c++) {
                solve_contact(pair, &pair->contacts[c], seconds);
            }
        }
    }
    for (size_t i = 0; i < world->count; i++) {
        if (world->bodies[i].inverse_mass > 0) {
            move_body(world, &world->bodies[i], seconds);
        }
    }
}
