/*
 * A tower of ten boxes under gravity, on swiftprox_pair_manifold: sequential impulses (Catto 2006) over the points of each manifold, those
 * of the last step to begin with, found again by their ids. It stands for ten seconds, or the program fails.
 *
 *     tower [FILE.svg]     draws where the boxes are every two seconds
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <swiftprox.h>

enum { BOXES = 10, POINTS = 4, ITERATIONS = 30, STEPS_A_SECOND = 120, SECONDS = 10, STRIP = 6 };

static const double GRAVITY = 9.81;
static const double FRICTION = 0.6;
/* How deep resting boxes may be in each other, and how much of what is deeper a step takes back. */
static const double SLOP = 1e-3;
static const double RETURN = 0.2;

struct body {
    double place[3];
    double rotation[9]; /* row by row */
    double velocity[3];
    double spin[3];
    double inverse_mass; /* 0: it does not move */
    double inverse_inertia; /* of a cube it is the same about all axes */
};

/* One point of a manifold, with the impulses along the normal and two directions across it. */
struct contact {
    swiftprox_manifold_point point;
    double axes[3][3];
    double arms[2][3];
    double impulses[3];
};

/* The contacts of a box with the one below. */
struct joint {
    swiftprox_manifold_cache cache;
    struct contact contacts[POINTS];
    int count;
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void add(double a[3], double factor, const double b[3])
{
    for (int k = 0; k < 3; k++) {
        a[k] += factor * b[k];
    }
}

static void normalise(double a[3])
{
    const double length = sqrt(dot(a, a));
    for (int k = 0; k < 3; k++) {
        a[k] /= length;
    }
}

static void pose_of(const struct body *body, double pose[12])
{
    for (int i = 0; i < 3; i++) {
        memcpy(pose + 4 * i, body->rotation + 3 * i, 3 * sizeof(double));
        pose[4 * i + 3] = body->place[i];
    }
}

/* Two directions across the normal. */
static void make_axes(const double normal[3], double axes[3][3])
{
    const double aside[3] = {fabs(normal[0]) < 0.6, fabs(normal[0]) >= 0.6, 0};
    memcpy(axes[0], normal, 3 * sizeof(double));
    cross(normal, aside, axes[1]);
    normalise(axes[1]);
    cross(normal, axes[1], axes[2]);
}

static void push(struct body bodies[2], const struct contact *contact, int axis, double impulse)
{
    for (int i = 0; i < 2; i++) {
        double torque[3];
        const double sense = i == 0 ? impulse : -impulse;
        cross(contact->arms[i], contact->axes[axis], torque);
        add(bodies[i].velocity, sense * bodies[i].inverse_mass, contact->axes[axis]);
        add(bodies[i].spin, sense * bodies[i].inverse_inertia, torque);
    }
}

/* How fast the bodies part along an axis of a contact. */
static double parting(const struct body bodies[2], const struct contact *contact, int axis)
{
    double speed = 0;
    for (int i = 0; i < 2; i++) {
        double turning[3];
        cross(bodies[i].spin, contact->arms[i], turning);
        add(turning, 1, bodies[i].velocity);
        speed += (i == 0 ? 1 : -1) * dot(turning, contact->axes[axis]);
    }
    return speed;
}

static double mass_along(const struct body bodies[2], const struct contact *contact, int axis)
{
    double inverse = 0;
    for (int i = 0; i < 2; i++) {
        double lever[3];
        cross(contact->arms[i], contact->axes[axis], lever);
        inverse += bodies[i].inverse_mass + bodies[i].inverse_inertia * dot(lever, lever);
    }
    return 1 / inverse;
}

/* Finds where a box meets the one below, and begins with the impulses that the same points had. */
static int find_contacts(const swiftprox_shape *shapes[2], struct body bodies[2], struct joint *joint)
{
    struct contact before[POINTS];
    swiftprox_manifold_point points[POINTS];
    swiftprox_manifold_config config;
    swiftprox_manifold manifold;
    double poses[2][12];
    const int count = joint->count;
    memcpy(before, joint->contacts, sizeof before);
    swiftprox_manifold_config_init(&config);
    config.margin = 0.01;
    config.reduces = 1;
    pose_of(&bodies[0], poses[0]);
    pose_of(&bodies[1], poses[1]);
    if (swiftprox_pair_manifold(shapes[0], poses[0], shapes[1], poses[1], &joint->cache, &config, points, POINTS, &manifold) !=
        SWIFTPROX_OK) {
        fprintf(stderr, "tower: %s\n", swiftprox_library_last_error_message());
        return 0;
    }
    joint->count = (int)manifold.point_count;
    for (int i = 0; i < joint->count; i++) {
        struct contact *contact = &joint->contacts[i];
        memset(contact, 0, sizeof *contact);
        contact->point = points[i];
        make_axes(manifold.normal, contact->axes);
        for (int k = 0; k < 3; k++) {
            contact->arms[0][k] = points[i].world1[k] - bodies[0].place[k];
            contact->arms[1][k] = points[i].world2[k] - bodies[1].place[k];
        }
        for (int j = 0; j < count; j++) {
            if (before[j].point.id == points[i].id) {
                memcpy(contact->impulses, before[j].impulses, sizeof contact->impulses);
            }
        }
        for (int axis = 0; axis < 3; axis++) {
            push(bodies, contact, axis, contact->impulses[axis]);
        }
    }
    return 1;
}

static void solve(struct body bodies[2], struct joint *joint, double step)
{
    for (int i = 0; i < joint->count; i++) {
        struct contact *contact = &joint->contacts[i];
        const double gap = 0.5 * (contact->point.gap_lower + contact->point.gap_upper);
        const double most = gap > 0 ? -gap / step : gap < -SLOP ? -RETURN * (gap + SLOP) / step : 0;
        for (int axis = 2; axis >= 0; axis--) {
            const double before = contact->impulses[axis];
            const double wanted = axis == 0 ? most : 0;
            double impulse = before + (wanted - parting(bodies, contact, axis)) * mass_along(bodies, contact, axis);
            if (axis == 0) {
                impulse = fmax(impulse, 0);
            } else {
                const double limit = FRICTION * contact->impulses[0];
                impulse = fmin(fmax(impulse, -limit), limit);
            }
            contact->impulses[axis] = impulse;
            push(bodies, contact, axis, impulse - before);
        }
    }
}

static void move(struct body *body, double step)
{
    double columns[3][3];
    add(body->place, step, body->velocity);
    for (int column = 0; column < 2; column++) {
        double turned[3];
        for (int k = 0; k < 3; k++) {
            columns[column][k] = body->rotation[3 * k + column];
        }
        cross(body->spin, columns[column], turned);
        add(columns[column], step, turned);
    }
    /* A rotation again. */
    normalise(columns[0]);
    add(columns[1], -dot(columns[0], columns[1]), columns[0]);
    normalise(columns[1]);
    cross(columns[0], columns[1], columns[2]);
    for (int i = 0; i < 9; i++) {
        body->rotation[i] = columns[i % 3][i / 3];
    }
}

static const swiftprox_shape *make_box(double x, double y, double z)
{
    double corners[24];
    const swiftprox_shape *shape = NULL;
    for (int i = 0; i < 8; i++) {
        corners[3 * i] = i & 1 ? x : -x;
        corners[3 * i + 1] = i & 2 ? y : -y;
        corners[3 * i + 2] = i & 4 ? z : -z;
    }
    if (swiftprox_shape_create_from_points(corners, 8, NULL, &shape) != SWIFTPROX_OK) {
        fprintf(stderr, "tower: %s\n", swiftprox_library_last_error_message());
    }
    return shape;
}

/* The boxes seen from the side, one tower beside the other. */
static void draw(FILE *out, const struct body bodies[BOXES + 1], int frame)
{
    for (int i = 1; i <= BOXES; i++) {
        fprintf(out, "<polygon points=\"");
        for (int k = 0; k < 4; k++) {
            const double x = (k == 0 || k == 3) ? -0.5 : 0.5;
            const double z = k < 2 ? -0.5 : 0.5;
            const double *r = bodies[i].rotation;
            fprintf(out, "%.2f,%.2f ", 40 + 60 * frame + 20 * (bodies[i].place[0] + r[0] * x + r[2] * z),
                    230 - 20 * (bodies[i].place[2] + r[6] * x + r[8] * z));
        }
        fprintf(out, "\" fill=\"none\" stroke=\"black\"/>\n");
    }
}

int main(int argc, char **argv)
{
    static struct joint joints[BOXES];
    struct body bodies[BOXES + 1] = {{{0, 0, -0.5}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}, {0}, 0, 0}};
    const swiftprox_shape *ground = make_box(20, 20, 0.5);
    const swiftprox_shape *box = make_box(0.5, 0.5, 0.5);
    const double step = 1.0 / STEPS_A_SECOND;
    FILE *out = argc > 1 ? fopen(argv[1], "w") : NULL;
    int good = ground && box && (argc < 2 || out);
    for (int i = 1; i <= BOXES; i++) {
        /* Not quite in line, and dropped from a little above. */
        const struct body start = {{0.03 * ((i * 7) % 5 - 2), 0.02 * ((i * 3) % 7 - 3), i - 0.5 + 0.002 * i},
                                   {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}, {0}, 1, 6};
        bodies[i] = start;
    }
    if (out) {
        fprintf(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"240\">\n", 60 * STRIP + 20);
    }
    for (int s = 0; good && s <= SECONDS * STEPS_A_SECOND; s++) {
        if (out && s % (2 * STEPS_A_SECOND) == 0) {
            draw(out, bodies, s / (2 * STEPS_A_SECOND));
        }
        for (int i = 1; i <= BOXES; i++) {
            bodies[i].velocity[2] -= GRAVITY * step;
        }
        for (int i = 0; good && i < BOXES; i++) {
            const swiftprox_shape *shapes[2] = {box, i == 0 ? ground : box};
            struct body pair[2] = {bodies[i + 1], bodies[i]};
            good = find_contacts(shapes, pair, &joints[i]);
            bodies[i + 1] = pair[0];
            bodies[i] = pair[1];
        }
        for (int iteration = 0; iteration < ITERATIONS; iteration++) {
            for (int i = 0; i < BOXES; i++) {
                struct body pair[2] = {bodies[i + 1], bodies[i]};
                solve(pair, &joints[i], step);
                bodies[i + 1] = pair[0];
                bodies[i] = pair[1];
            }
        }
        for (int i = 1; i <= BOXES; i++) {
            move(&bodies[i], step);
        }
    }
    for (int i = 1; good && i <= BOXES; i++) {
        /* At its height, upright, where it was put. */
        if (!(fabs(bodies[i].place[2] - (i - 0.5)) < 0.03 && bodies[i].rotation[8] > 0.999 && fabs(bodies[i].place[0]) < 0.1 &&
              fabs(bodies[i].place[1]) < 0.1)) {
            fprintf(stderr, "tower: box %d is at %g %g %g\n", i, bodies[i].place[0], bodies[i].place[1], bodies[i].place[2]);
            good = 0;
        }
    }
    if (out) {
        fprintf(out, "</svg>\n");
        good = fclose(out) == 0 && good;
    }
    swiftprox_shape_release(ground);
    swiftprox_shape_release(box);
    printf("the tower %s\n", good ? "stands" : "does not stand");
    return good ? 0 : 1;
}
