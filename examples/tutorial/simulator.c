/* A small simulator: cubes fall on a valley's floor and onto each other, and a pile of them stands. docs/tutorial-simulator.md
 * explains it part by part. It ends with an error where the pile does not stand. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <swiftprox.h>
#include <swiftprox/ground.h>
#include <swiftprox/replay.h>

enum { ROWS = 4, BODIES = 1 + ROWS * (ROWS + 1) / 2, MOST_CONTACTS = 400, ITERATIONS = 20, STEPS = 600, SIDE = 41 };

static const double SECONDS = 1.0 / 60, GRAVITY = -9.81, FRICTION = 0.6;
static const double MARGIN = 0.02;            /* points up to this gap are contacts */
static const double SLOP = 0.001, PUSH = 0.2; /* overlaps beyond the slop are pushed out, a fifth a step */

/* Ends the program with the library's message where a call failed. */
static void demand(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        fprintf(stderr, "%s\n", swiftprox_library_last_error_message());
        exit(EXIT_FAILURE);
    }
}

/* A cube of side 1 around the origin. */
static const swiftprox_shape *make_cube(void)
{
    double corners[8][3];
    for (int i = 0; i < 8; i++) {
        for (int axis = 0; axis < 3; axis++) {
            corners[i][axis] = i >> axis & 1 ? 0.5 : -0.5;
        }
    }
    const swiftprox_shape *cube;
    demand(swiftprox_shape_create_from_points(&corners[0][0], 8, NULL, &cube));
    return cube;
}

/* A valley: level where cubes stand, rising to both sides. */
static const swiftprox_ground *make_valley(void)
{
    double heights[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double aside = fabs((double)(i / SIDE) - SIDE / 2);
        heights[i] = fmax(0, aside - 4) * 0.25;
    }
    const swiftprox_ground *valley;
    demand(swiftprox_ground_create_from_heights(SIDE, SIDE, 1, 1, heights, &valley));
    return valley;
}

struct body {
    swiftprox_object_id id;
    double pose[12]; /* rows of [R|T]: rotation and centre of mass */
    double velocity[3], spin[3];
    double inverse_mass, inverse_inertia; /* both 0: it never moves; a cube's inertia is the same about all axes */
};

/* Body 0 is the valley. */
static void add_valley(swiftprox_scene *scene, struct body *body)
{
    const swiftprox_ground *const valley = make_valley();
    *body = (struct body){.pose = {1, 0, 0, -SIDE / 2, 0, 1, 0, -SIDE / 2, 0, 0, 1, 0}};
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    options.ground = valley;
    memcpy(options.pose, body->pose, sizeof options.pose);
    demand(swiftprox_scene_add_object(scene, NULL, 0, &options, &body->id));
    swiftprox_ground_release(valley); /* the scene has its own share */
}

/* The others are cubes of mass 1. */
static void add_cube(swiftprox_scene *scene, struct body *bodies, size_t index, const swiftprox_shape *cube, double x, double z)
{
    struct body *const body = &bodies[index];
    *body = (struct body){.pose = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, z}, .inverse_mass = 1, .inverse_inertia = 6};
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    options.user_data = index; /* comes back in each result */
    memcpy(options.pose, body->pose, sizeof options.pose);
    demand(swiftprox_scene_add_object(scene, &cube, 1, &options, &body->id));
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double product[3])
{
    for (int i = 0; i < 3; i++) {
        product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

static void scale(double v[3], double factor)
{
    for (int i = 0; i < 3; i++) {
        v[i] *= factor;
    }
}

/* Moves a body on for a step: each column of the rotation turns with the spin, and is made orthonormal again. */
static void move(swiftprox_scene *scene, struct body *body)
{
    double columns[3][3], change[3];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            columns[k][i] = body->pose[4 * i + k];
        }
        cross(body->spin, columns[k], change);
        for (int i = 0; i < 3; i++) {
            columns[k][i] += SECONDS * change[i];
        }
    }
    scale(columns[0], 1 / sqrt(dot(columns[0], columns[0])));
    cross(columns[0], columns[1], columns[2]);
    scale(columns[2], 1 / sqrt(dot(columns[2], columns[2])));
    cross(columns[2], columns[0], columns[1]);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            body->pose[4 * i + k] = columns[k][i];
        }
        body->pose[4 * i + 3] += SECONDS * body->velocity[i];
    }
    demand(swiftprox_scene_set_pose(scene, body->id, body->pose));
}

struct contact {
    struct body *bodies[2];
    uint64_t id;        /* identifies the point within its pair */
    double arms[2][3];  /* from the centre of each body to the point */
    double axes[3][3];  /* the normal, from body 2 to body 1, and two tangents */
    double gap;         /* less than 0: they overlap */
    double impulses[3]; /* along the axes, since the step began */
};

struct contacts {
    struct contact list[MOST_CONTACTS];
    size_t count;
};

static void set_axes(struct contact *contact, const double normal[3])
{
    const double aside[3] = {fabs(normal[0]) < 0.5, fabs(normal[0]) >= 0.5, 0};
    memcpy(contact->axes[0], normal, sizeof contact->axes[0]);
    cross(normal, aside, contact->axes[1]);
    scale(contact->axes[1], 1 / sqrt(dot(contact->axes[1], contact->axes[1])));
    cross(normal, contact->axes[1], contact->axes[2]);
}

/* Makes a contact of one of the scene's points. */
static struct contact contact_of(struct body *body1, struct body *body2, const double normal[3],
                                 const swiftprox_manifold_point *point)
{
    struct contact contact = {.bodies = {body1, body2}, .id = point->id};
    contact.gap = 0.5 * (point->gap_lower + point->gap_upper);
    for (int i = 0; i < 3; i++) {
        contact.arms[0][i] = point->world1[i] - body1->pose[4 * i + 3];
        contact.arms[1][i] = point->world2[i] - body2->pose[4 * i + 3];
    }
    set_axes(&contact, normal);
    return contact;
}

static void add_points(struct contacts *found, struct body *body1, struct body *body2, const swiftprox_manifold *manifold,
                       const swiftprox_manifold_point *points)
{
    for (size_t k = 0; k < manifold->point_count && found->count < MOST_CONTACTS; k++) {
        found->list[found->count++] = contact_of(body1, body2, manifold->normal, &points[k]);
    }
}

/* Finds where cubes meet, or will soon. */
static void find_contacts(swiftprox_scene *scene, struct body *bodies, struct contacts *found)
{
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.max_distance = MARGIN;
    query.detail = SWIFTPROX_CONTACT_DETAIL_REDUCED_MANIFOLD;

    swiftprox_scene_answer answer;
    demand(swiftprox_scene_query_contact(scene, &query, &answer));

    found->count = 0;
    for (size_t i = 0; i < answer.count; i++) {
        const swiftprox_contact *const contact = &answer.contacts[i]; /* belongs to answer.pairs[i] */
        struct body *const body1 = &bodies[answer.pairs[i].user_data1];
        struct body *const body2 = &bodies[answer.pairs[i].user_data2];
        add_points(found, body1, body2, &contact->manifold, &answer.points[contact->first_point]);
    }
}

/* Finds where cubes meet the valley. */
static void find_ground_contacts(const swiftprox_scene *scene, swiftprox_scratch *scratch, struct body *bodies,
                                 struct contacts *found)
{
    swiftprox_scene_ground_config config = SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT;
    config.max_distance = MARGIN;
    config.reduces = 1;

    const swiftprox_placed_ground own = {NULL, NULL}; /* the scene's grounds */
    swiftprox_scene_ground_answer answer;
    demand(swiftprox_scene_ground_contacts(scene, NULL, own, &config, scratch, &answer));
    for (size_t i = 0; i < answer.contact_count; i++) {
        const swiftprox_scene_ground_contact *const contact = &answer.contacts[i];
        const swiftprox_manifold_point *const points = &answer.points[contact->contact.first_point];
        add_points(found, &bodies[contact->user_data], &bodies[0], &contact->contact.manifold, points);
    }
}

/* Pushes the bodies of a contact apart along one of its axes. */
static void push(const struct contact *contact, int axis, double impulse)
{
    for (int k = 0; k < 2; k++) {
        struct body *const body = contact->bodies[k];
        const double along = k == 0 ? impulse : -impulse;
        double lever[3];
        cross(contact->arms[k], contact->axes[axis], lever);
        for (int i = 0; i < 3; i++) {
            body->velocity[i] += along * body->inverse_mass * contact->axes[axis][i];
            body->spin[i] += along * body->inverse_inertia * lever[i];
        }
    }
}

/* How fast the bodies part along an axis, and how much an impulse of 1 adds to that. */
static double parting(const struct contact *contact, int axis, double *response)
{
    double speed = 0;
    *response = 0;
    for (int k = 0; k < 2; k++) {
        const struct body *const body = contact->bodies[k];
        double lever[3];
        cross(contact->arms[k], contact->axes[axis], lever);
        const double of_body = dot(body->velocity, contact->axes[axis]) + dot(body->spin, lever);
        speed += k == 0 ? of_body : -of_body;
        *response += body->inverse_mass + body->inverse_inertia * dot(lever, lever);
    }
    return speed;
}

/* The impulse along one axis after which the contact behaves: bodies never pull, and friction has a limit. */
static void solve(struct contact *contact, int axis)
{
    double response, wanted = 0;
    const double speed = parting(contact, axis, &response);
    if (axis == 0) { /* an open gap may close within the step */
        wanted = contact->gap > 0 ? -contact->gap / SECONDS : PUSH * fmax(0, -contact->gap - SLOP) / SECONDS;
    }
    const double limit = FRICTION * contact->impulses[0];
    const double sum = contact->impulses[axis] + (wanted - speed) / response;
    const double clamped = axis == 0 ? fmax(0, sum) : fmax(-limit, fmin(limit, sum));
    push(contact, axis, clamped - contact->impulses[axis]);
    contact->impulses[axis] = clamped;
}

/* Starts points that were there before, with the same bodies and id, at their last impulses. Returns how many were. */
static size_t carry_on(struct contacts *contacts, const struct contacts *before)
{
    size_t known = 0;
    for (size_t i = 0; i < contacts->count; i++) {
        struct contact *const now = &contacts->list[i];
        for (size_t j = 0; j < before->count; j++) {
            const struct contact *const then = &before->list[j];
            if (then->id == now->id && then->bodies[0] == now->bodies[0] && then->bodies[1] == now->bodies[1]) {
                memcpy(now->impulses, then->impulses, sizeof now->impulses);
                known++;
            }
        }
        for (int axis = 0; axis < 3; axis++) {
            push(now, axis, now->impulses[axis]);
        }
    }
    return known;
}

/* One step. Returns how many contact points were known from the step before. */
static size_t step(swiftprox_scene *scene, swiftprox_scratch *scratch, struct body *bodies, struct contacts *contacts)
{
    static struct contacts before;
    before = *contacts;
    find_contacts(scene, bodies, contacts);
    find_ground_contacts(scene, scratch, bodies, contacts);
    for (size_t i = 1; i < BODIES; i++) {
        bodies[i].velocity[2] += SECONDS * GRAVITY;
    }
    const size_t known = carry_on(contacts, &before);
    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        for (size_t i = 0; i < contacts->count; i++) {
            for (int axis = 2; axis >= 0; axis--) { /* the normal has the last word */
                solve(&contacts->list[i], axis);
            }
        }
    }
    for (size_t i = 1; i < BODIES; i++) {
        move(scene, &bodies[i]);
    }
    return known;
}

/* A pyramid of cubes a hundredth above where they will rest. */
static void build(swiftprox_scene *scene, struct body *bodies)
{
    const swiftprox_shape *const cube = make_cube();
    add_valley(scene, &bodies[0]);
    size_t index = 1;
    for (int row = 0; row < ROWS; row++) {
        for (int i = 0; i < ROWS - row; i++) {
            add_cube(scene, bodies, index++, cube, 1.05 * (i + 0.5 * row), 0.5 + row + 0.01 * (row + 1));
        }
    }
    swiftprox_shape_release(cube);
}

int main(int argc, char **argv)
{
    swiftprox_scene *scene;
    swiftprox_scratch *scratch;
    demand(swiftprox_scene_create(NULL, &scene));
    demand(swiftprox_scratch_create(&scratch));
    if (argc > 1) {
        demand(swiftprox_scene_record(scene, argv[1])); /* from here on */
    }
    static struct body bodies[BODIES];
    static struct contacts contacts;
    build(scene, bodies);
    struct body at_first[BODIES];
    memcpy(at_first, bodies, sizeof at_first);

    size_t known = 0;
    for (int i = 0; i < STEPS; i++) {
        known = step(scene, scratch, bodies, &contacts);
    }
    double moved = 0, fastest = 0;
    for (size_t i = 1; i < BODIES; i++) {
        double way[3];
        for (int k = 0; k < 3; k++) {
            way[k] = bodies[i].pose[4 * k + 3] - at_first[i].pose[4 * k + 3];
        }
        moved = fmax(moved, sqrt(dot(way, way)));
        fastest = fmax(fastest, sqrt(dot(bodies[i].velocity, bodies[i].velocity)));
    }
    printf("after %d steps no cube is farther than %.2f from where it began\n", STEPS, moved);
    printf("the fastest moves by less than %.3f a second\n", ceil(1000 * fastest) / 1000);
    printf("of %zu contact points %zu were known from the step before\n", contacts.count, known);

    demand(swiftprox_scene_record(scene, NULL)); /* up to here */
    swiftprox_scratch_destroy(scratch);
    demand(swiftprox_scene_destroy(scene));
    return moved < 0.06 && fastest < 0.01 && known == contacts.count ? EXIT_SUCCESS : EXIT_FAILURE;
}
