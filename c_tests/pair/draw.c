/*
 * Debug drawing: what is drawn of shapes, pairs and scenes is compared with what the queries say.
 */
#include <fenv.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/curved.h"
#include "swiftprox/draw.h"
#include "swiftprox/ground.h"
#include "swiftprox/scene.h"
#include "swiftprox/tuning.h"

enum { ROOM = 4096, POINTS = 40, MANY = 300 };

struct line {
    swiftprox_draw_kind kind;
    double start[3], end[3];
};

struct text {
    swiftprox_draw_kind kind;
    double place[3];
    char words[96];
};

/* What was drawn, and of what kinds. */
static struct {
    struct line lines[ROOM], points[ROOM];
    struct text texts[ROOM];
    size_t line_count, point_count, text_count;
    double third;
    swiftprox_scene *scene;
    swiftprox_object_id object;
} drawn;

/* As the processor rounds it: fegetround() looks at the unit of the x87 alone. */
static double one_third(void)
{
    volatile double one = 1, three = 3;
    return one / three;
}

static void take_line(void *user, swiftprox_draw_kind kind, const double *start, const double *end)
{
    CHECK(user == &drawn && drawn.line_count < ROOM);
    if (drawn.line_count < ROOM) {
        struct line *line = &drawn.lines[drawn.line_count++];
        line->kind = kind;
        memcpy(line->start, start, sizeof line->start);
        memcpy(line->end, end, sizeof line->end);
    }
    drawn.third = one_third();
    if (drawn.scene) {
        double pose[12];
        swiftprox_object_info info;
        info.struct_size = sizeof info;
        place(pose, 1, 2, 3);
        CHECK(swiftprox_scene_set_pose(drawn.scene, drawn.object, pose) == SWIFTPROX_ERROR_BUSY);
        CHECK_OK(swiftprox_scene_get_object_info(drawn.scene, drawn.object, &info));
    }
}

static void take_point(void *user, swiftprox_draw_kind kind, const double *where)
{
    CHECK(user == &drawn && drawn.point_count < ROOM);
    if (drawn.point_count < ROOM) {
        struct line *point = &drawn.points[drawn.point_count++];
        point->kind = kind;
        memcpy(point->start, where, sizeof point->start);
    }
}

static void take_text(void *user, swiftprox_draw_kind kind, const double *where, const char *words)
{
    CHECK(user == &drawn && drawn.text_count < ROOM);
    if (drawn.text_count < ROOM) {
        struct text *text = &drawn.texts[drawn.text_count++];
        text->kind = kind;
        memcpy(text->place, where, sizeof text->place);
        CHECK(strlen(words) < sizeof text->words);
        strncat(strcpy(text->words, ""), words, sizeof text->words - 1);
    }
}

/* Draws into `drawn`, which is empty before. */
static swiftprox_draw recorder(uint32_t kinds)
{
    swiftprox_draw draw = SWIFTPROX_DRAW_DEFAULT;
    drawn.line_count = drawn.point_count = drawn.text_count = 0;
    draw.kinds = kinds;
    draw.user = &drawn;
    draw.line = take_line;
    draw.point = take_point;
    draw.text = take_text;
    return draw;
}

static const uint32_t ALL = UINT32_MAX;

static uint32_t only(swiftprox_draw_kind kind)
{
    return (uint32_t)1 << kind;
}

static swiftprox_placed placed(const swiftprox_shape *shape, const double *pose)
{
    swiftprox_placed object;
    object.shape = shape;
    object.pose = pose;
    return object;
}

/* The lines of a kind, in their order. */
static struct line picked[ROOM];

static size_t pick(swiftprox_draw_kind kind)
{
    size_t count = 0, i;
    for (i = 0; i < drawn.line_count; ++i) {
        if (drawn.lines[i].kind == kind) {
            picked[count++] = drawn.lines[i];
        }
    }
    return count;
}

static const struct text *last_text(swiftprox_draw_kind kind)
{
    size_t i = drawn.text_count;
    while (i > 0 && drawn.texts[i - 1].kind != kind) {
        --i;
    }
    return i > 0 ? &drawn.texts[i - 1] : NULL;
}

static double apart(const double *a, const double *b)
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static int same(const double *a, const double *b)
{
    return memcmp(a, b, 3 * sizeof *a) == 0;
}

/* From 0 to 1. */
static double random_number(void)
{
    static uint64_t state = 7;
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(state >> 11) / 9007199254740992.0;
}

/* Points about the origin, no farther than 1, and their hull. */
static const swiftprox_shape *random_body(double (*points)[3], size_t count)
{
    const swiftprox_shape *shape = NULL;
    size_t i;
    for (i = 0; i < count; ++i) {
        double length;
        do {
            points[i][0] = 2 * random_number() - 1;
            points[i][1] = 2 * random_number() - 1;
            points[i][2] = 2 * random_number() - 1;
            length = sqrt(points[i][0] * points[i][0] + points[i][1] * points[i][1] + points[i][2] * points[i][2]);
        } while (length > 1 || length < 0.1);
        points[i][0] /= length;
        points[i][1] /= length;
        points[i][2] /= length;
    }
    CHECK_OK(swiftprox_shape_create_from_points(points[0], count, NULL, &shape));
    return shape;
}

/* Turned anyhow, and so far away. */
static void random_pose(double pose[12], double distance)
{
    double turn[4], where[3] = {0, 0, 0};
    int i;
    for (i = 0; i < 4; ++i) {
        turn[i] = random_number() - 0.5;
    }
    where[0] = distance * (0.5 + random_number());
    where[1] = distance * (random_number() - 0.5);
    where[2] = distance * (random_number() - 0.5);
    {
        double length = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
        for (i = 0; i < 4; ++i) {
            turn[i] /= length;
        }
    }
    CHECK_OK(swiftprox_pose_from_quaternion(turn, where, pose));
}

static void apply(const double pose[12], const double local[3], double world[3])
{
    int row;
    for (row = 0; row < 3; ++row) {
        const double *r = pose + 4 * row;
        world[row] = r[0] * local[0] + r[1] * local[1] + r[2] * local[2] + r[3];
    }
}

/* Each edge of a box once; of other bodies what there is of them. */
static void shapes(void)
{
    const double apex[3] = {1, 2, 3};
    const swiftprox_shape *cube = box(0.5, 0.5, 0.5), *made = NULL;
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_draw draw = recorder(ALL);
    double pose[12], turned[12];
    size_t i, k;
    place(pose, 10, 20, 30);
    CHECK_OK(swiftprox_shape_draw(placed(cube, pose), &draw));
    CHECK(drawn.line_count == 12 && drawn.point_count == 0 && drawn.text_count == 0);
    for (i = 0; i < drawn.line_count; ++i) {
        const struct line *line = &drawn.lines[i];
        const double *s = line->start, *e = line->end;
        CHECK(line->kind == SWIFTPROX_DRAW_KIND_EDGE && apart(s, e) == 1);
        CHECK(fabs(s[0] - 10) == 0.5 && fabs(s[1] - 20) == 0.5 && fabs(s[2] - 30) == 0.5);
        for (k = 0; k < i; ++k) {
            const struct line *other = &drawn.lines[k];
            CHECK(!(same(s, other->start) && same(e, other->end)) && !(same(s, other->end) && same(e, other->start)));
        }
    }
    swiftprox_shape_release(cube);
    /* A quarter turn about z. */
    place(turned, 0, 0, 0);
    turned[0] = turned[5] = 0;
    turned[1] = -1;
    turned[4] = 1;
    options.input = SWIFTPROX_INPUT_HULL;
    CHECK_OK(swiftprox_shape_create_from_points(apex, 1, &options, &made));
    draw = recorder(ALL);
    CHECK_OK(swiftprox_shape_draw(placed(made, turned), &draw));
    CHECK(drawn.line_count == 0 && drawn.point_count == 1 && drawn.points[0].kind == SWIFTPROX_DRAW_KIND_EDGE);
    CHECK(drawn.points[0].start[0] == -2 && drawn.points[0].start[1] == 1 && drawn.points[0].start[2] == 3);
    swiftprox_shape_release(made);
    /* Circles of a sphere. */
    CHECK_OK(swiftprox_shape_create_sphere(0.25, &made));
    draw = recorder(ALL);
    CHECK_OK(swiftprox_shape_draw(placed(made, pose), &draw));
    CHECK(drawn.line_count == 72 && drawn.point_count == 0);
    for (i = 0; i < drawn.line_count; ++i) {
        const double centre[3] = {10, 20, 30};
        CHECK(fabs(apart(drawn.lines[i].start, centre) - 0.25) < 1e-14);
        CHECK(same(drawn.lines[i].end, drawn.lines[i % 24 == 23 ? i - 23 : i + 1].start));
    }
    swiftprox_shape_release(made);
    /* Faces of a rounded box, each with its four sides. */
    options.swept_radius = 0.125;
    {
        double corners[24];
        for (i = 0; i < 24; ++i) {
            corners[i] = (i / 3) >> (i % 3) & 1 ? 0.5 : -0.5;
        }
        CHECK_OK(swiftprox_shape_create_from_points(corners, 8, &options, &made));
    }
    place(pose, 0, 0, 0);
    draw = recorder(ALL);
    CHECK_OK(swiftprox_shape_draw(placed(made, pose), &draw));
    CHECK(drawn.line_count == 24);
    for (i = 0; i < drawn.line_count; ++i) {
        int at_face = 0, along = 0;
        for (k = 0; k < 3; ++k) {
            const double s = drawn.lines[i].start[k], e = drawn.lines[i].end[k];
            at_face += fabs(s) == 0.625 && s == e;
            along += fabs(s) == 0.5 && s == -e;
        }
        CHECK(at_face == 1 && along == 1);
    }
    swiftprox_shape_release(made);
}

static void name(char *words, const swiftprox_feature *feature)
{
    switch (feature->kind) {
    case SWIFTPROX_FEATURE_KIND_VERTEX:
        sprintf(words, "vertex %u", (unsigned)feature->ids[0]);
        break;
    case SWIFTPROX_FEATURE_KIND_EDGE:
        sprintf(words, "edge %u-%u", (unsigned)feature->ids[0], (unsigned)feature->ids[1]);
        break;
    default:
        sprintf(words, "face %u", (unsigned)feature->ids[0]);
    }
}

/* As many steps as a cold query counts; the last one at the features, and between the points, of the answer. */
static void marches(void)
{
    static double points[2][MANY][3];
    swiftprox_pair_tuning tuning = SWIFTPROX_PAIR_TUNING_DEFAULT;
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    size_t most = 0;
    unsigned kinds = 0;
    int overlapping = 0, round;
    tuning.levels = SWIFTPROX_LEVELS_NONE;
    config.tuning = &tuning;
    for (round = 0; round < 300; ++round) {
        static const swiftprox_pair_cache cold;
        swiftprox_pair_cache cache = cold;
        swiftprox_pair_answer answer;
        const swiftprox_shape *shapes[2];
        swiftprox_draw draw = recorder(ALL);
        double poses[2][12];
        size_t steps;
        shapes[0] = round % 3 == 0 ? box(0.3, 0.4, 0.5) : random_body(points[0], 6 + (size_t)(7 * round) % (MANY - 6));
        shapes[1] = round % 3 == 1 ? box(0.6, 0.2, 0.7) : random_body(points[1], 5 + (size_t)(7 * round) % (MANY - 5));
        random_pose(poses[0], 0);
        random_pose(poses[1], round % 4 == 0 ? 1 : 5);
        CHECK_OK(swiftprox_pair_distance(placed(shapes[0], poses[0]), placed(shapes[1], poses[1]), &cache, &config, &answer));
        CHECK_OK(swiftprox_pair_draw(placed(shapes[0], poses[0]), placed(shapes[1], poses[1]), NULL, &draw));
        steps = pick(SWIFTPROX_DRAW_KIND_MARCH);
        /* A start that overlaps is no step. */
        CHECK(steps == answer.statistics.marching_steps || (steps == 1 && answer.statistics.marching_steps == 0));
        overlapping += answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING;
        if (answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.decided_by == SWIFTPROX_DECIDED_BY_MARCHING && steps > 0) {
            const struct text *last = last_text(SWIFTPROX_DRAW_KIND_MARCH);
            char words[96], first[32], second[32];
            CHECK(apart(picked[steps - 1].start, answer.world2) < 1e-13);
            CHECK(apart(picked[steps - 1].end, answer.world1) < 1e-13);
            name(first, &answer.feature1);
            name(second, &answer.feature2);
            sprintf(words, "%u: %s, %s", (unsigned)steps, first, second);
            CHECK(last != NULL && strcmp(last->words, words) == 0);
            CHECK(pick(SWIFTPROX_DRAW_KIND_WITNESS) == 1 && same(picked[0].start, answer.world2) &&
                  same(picked[0].end, answer.world1));
            CHECK(pick(SWIFTPROX_DRAW_KIND_NORMAL) == 1);
            CHECK(fabs(apart(picked[0].start, picked[0].end) - 1) < 1e-14);
            CHECK(fabs((picked[0].end[0] - picked[0].start[0]) - answer.normal[0]) < 1e-14);
            CHECK(pick(SWIFTPROX_DRAW_KIND_POLYTOPE) == 0);
            CHECK(fabs(strtod(last_text(SWIFTPROX_DRAW_KIND_WITNESS)->words, NULL) - answer.distance) < 1e-6);
            most = steps > most ? steps : most;
            kinds |= 1u << (4 * answer.feature1.kind + answer.feature2.kind);
        }
        swiftprox_shape_release(shapes[0]);
        swiftprox_shape_release(shapes[1]);
    }
    CHECK(most > 5 && overlapping > 20);
    CHECK(kinds == 0x26e0); /* all six pairs of vertices, edges and faces at which a march ends */
}

/* The solid angle of a triangle seen from the origin (Van Oosterom & Strackee 1983). */
static double solid_angle(const double *a, const double *b, const double *c)
{
    const double la = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]), lb = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]),
                 lc = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    const double determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                               a[2] * (b[0] * c[1] - b[1] * c[0]);
    const double ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2], bc = b[0] * c[0] + b[1] * c[1] + b[2] * c[2],
                 ca = c[0] * a[0] + c[1] * a[1] + c[2] * a[2];
    return 2 * atan2(determinant, la * lb * lc + ab * lc + bc * la + ca * lb);
}

/* How far the plane of a triangle is from the origin. */
static double plane_distance(const double *a, const double *b, const double *c)
{
    double u[3], v[3], n[3];
    int k;
    for (k = 0; k < 3; ++k) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
    return (n[0] * a[0] + n[1] * a[1] + n[2] * a[2]) / sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

/* Whether a place is a vertex of one body minus one of the other. */
static int is_difference(const double *at, const double (*points)[2][3], const size_t *counts)
{
    size_t i, k;
    for (i = 0; i < counts[0]; ++i) {
        for (k = 0; k < counts[1]; ++k) {
            const double difference[3] = {points[i][0][0] - points[k][1][0], points[i][0][1] - points[k][1][1],
                                          points[i][0][2] - points[k][1][2]};
            if (apart(difference, at) < 1e-13) {
                return 1;
            }
        }
    }
    return 0;
}

/* The polytope closes, has the origin inside, and reaches as far as the depth says. */
static void polytopes(void)
{
    static double points[2][POINTS][3];
    static double world[POINTS][2][3];
    int overlapping = 0, round;
    for (round = 0; round < 60; ++round) {
        static const swiftprox_depth_cache cold;
        swiftprox_depth_cache cache = cold;
        swiftprox_depth_answer answer;
        const size_t counts[2] = {4 + (size_t)round % (POINTS - 4), 6 + (size_t)round % (POINTS - 6)};
        const swiftprox_shape *shapes[2];
        swiftprox_draw draw = recorder(only(SWIFTPROX_DRAW_KIND_POLYTOPE));
        double poses[2][12], angle = 0, nearest = HUGE_VAL;
        size_t i, k;
        int body;
        for (body = 0; body < 2; ++body) {
            shapes[body] = random_body(points[body], counts[body]);
            random_pose(poses[body], 0.3 * body);
            for (i = 0; i < counts[body]; ++i) {
                apply(poses[body], points[body][i], world[i][body]);
            }
        }
        CHECK_OK(swiftprox_pair_depth(placed(shapes[0], poses[0]), placed(shapes[1], poses[1]), &cache, NULL, &answer));
        CHECK_OK(swiftprox_pair_draw(placed(shapes[0], poses[0]), placed(shapes[1], poses[1]), NULL, &draw));
        swiftprox_shape_release(shapes[0]);
        swiftprox_shape_release(shapes[1]);
        if (answer.outcome != SWIFTPROX_OUTCOME_INTERSECTING) {
            CHECK(drawn.line_count == 0 && drawn.point_count == 0);
            continue;
        }
        ++overlapping;
        CHECK(drawn.line_count >= 12 && drawn.line_count % 3 == 0 && drawn.text_count == 0);
        for (i = 0; i < drawn.line_count; ++i) {
            const struct line *line = &drawn.lines[i];
            size_t there = 0, back = 0;
            CHECK(same(line->end, drawn.lines[i % 3 == 2 ? i - 2 : i + 1].start));
            CHECK(is_difference(line->start, (const double(*)[2][3])world, counts));
            for (k = 0; k < drawn.line_count; ++k) {
                there += same(drawn.lines[k].start, line->start) && same(drawn.lines[k].end, line->end);
                back += same(drawn.lines[k].start, line->end) && same(drawn.lines[k].end, line->start);
            }
            CHECK(there == back);
        }
        for (i = 0; i + 2 < drawn.line_count; i += 3) {
            const double *a = drawn.lines[i].start, *b = drawn.lines[i + 1].start, *c = drawn.lines[i + 2].start;
            angle += solid_angle(a, b, c);
            nearest = fmin(nearest, plane_distance(a, b, c));
        }
        CHECK(fabs(angle - 4 * acos(-1.0)) < 1e-9);
        CHECK(nearest > 0.89 * answer.lower && nearest < answer.upper + 1e-13);
        CHECK(drawn.point_count == 2 && drawn.points[0].start[0] == 0 && drawn.points[0].start[1] == 0);
        CHECK(fabs(apart(drawn.points[1].start, drawn.points[0].start) - answer.depth) < 1e-12);
    }
    CHECK(overlapping > 50);
}

/* Pairs of all sorts: what is drawn of them is finite, and the witness points are those of the signed distance. */
static void all_sorts(void)
{
    static double points[12][3];
    const double half[3] = {0.5, 0.6, 0.7}, radii[3] = {1, 2, 0.5}, end[6] = {-1, 0, 0, 1, 0, 0}, flat[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    const swiftprox_shape *sorts[9];
    int i, k, near;
    CHECK_OK(swiftprox_shape_create_sphere(0.5, &sorts[0]));
    CHECK_OK(swiftprox_shape_create_capsule(0.5, 1, &sorts[1]));
    CHECK_OK(swiftprox_shape_create_box(half, 0.125, &sorts[2]));
    CHECK_OK(swiftprox_shape_create_cylinder(1, 1, 0.01, &sorts[3]));
    CHECK_OK(swiftprox_shape_create_ellipsoid(radii, 0.01, &sorts[4]));
    options.input = SWIFTPROX_INPUT_HULL;
    CHECK_OK(swiftprox_shape_create_from_points(end, 1, &options, &sorts[5]));
    CHECK_OK(swiftprox_shape_create_from_points(end, 2, &options, &sorts[6]));
    CHECK_OK(swiftprox_shape_create_from_points(flat, 3, &options, &sorts[7]));
    sorts[8] = random_body(points, 12);
    for (i = 0; i < 9; ++i) {
        for (k = 0; k < 9; ++k) {
            for (near = 0; near < 2; ++near) {
                static const swiftprox_manifold_cache cold;
                swiftprox_manifold_cache cache = cold;
                swiftprox_signed_distance answer;
                swiftprox_draw draw = recorder(ALL);
                double poses[2][12];
                size_t at;
                random_pose(poses[0], 0);
                random_pose(poses[1], near ? 0.2 : 6);
                CHECK_OK(swiftprox_pair_signed_distance(placed(sorts[i], poses[0]), placed(sorts[k], poses[1]), &cache, NULL, &answer));
                CHECK_OK(swiftprox_pair_draw(placed(sorts[i], poses[0]), placed(sorts[k], poses[1]), NULL, &draw));
                CHECK(pick(SWIFTPROX_DRAW_KIND_MARCH) > 0);
                CHECK(pick(SWIFTPROX_DRAW_KIND_WITNESS) == (isnan(answer.world1[0]) ? 0u : 1u));
                CHECK(isnan(answer.world1[0]) || (same(picked[0].end, answer.world1) && same(picked[0].start, answer.world2)));
                for (at = 0; at < drawn.line_count; ++at) {
                    CHECK(isfinite(drawn.lines[at].start[0] + drawn.lines[at].start[1] + drawn.lines[at].start[2]));
                    CHECK(isfinite(drawn.lines[at].end[0] + drawn.lines[at].end[1] + drawn.lines[at].end[2]));
                }
            }
        }
    }
    for (i = 0; i < 9; ++i) {
        swiftprox_shape_release(sorts[i]);
    }
}

/* The points of a manifold. */
static void contacts(void)
{
    static const swiftprox_manifold_cache cold;
    swiftprox_manifold_cache cache = cold;
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    swiftprox_manifold_point points[8];
    swiftprox_manifold_room room = {points, 8, NULL};
    swiftprox_manifold manifold;
    const swiftprox_shape *cube = box(1, 1, 1);
    swiftprox_draw draw = recorder(only(SWIFTPROX_DRAW_KIND_CONTACT));
    double here[12], there[12];
    size_t i;
    place(here, 0, 0, 0);
    place(there, 0.5, 0.25, 2.125);
    CHECK_OK(swiftprox_pair_draw(placed(cube, here), placed(cube, there), NULL, &draw));
    CHECK(drawn.line_count == 0 && drawn.point_count == 0);
    config.max_distance = 0.25;
    CHECK_OK(swiftprox_pair_manifold(placed(cube, here), placed(cube, there), &cache, &config, room, &manifold));
    CHECK_OK(swiftprox_pair_draw(placed(cube, here), placed(cube, there), &config, &draw));
    CHECK(manifold.point_count == 4 && drawn.line_count == 4 && drawn.point_count == 8 && drawn.text_count == 4);
    for (i = 0; i < drawn.line_count && i < 8; ++i) {
        CHECK(same(drawn.lines[i].end, points[i].world1) && same(drawn.lines[i].start, points[i].world2));
        CHECK(strcmp(drawn.texts[i].words, "0.125") == 0);
    }
    /* Cubes that touch have no polytope around the origin. */
    place(there, 0.5, 0.25, 2);
    draw = recorder(ALL);
    CHECK_OK(swiftprox_pair_draw(placed(cube, here), placed(cube, there), NULL, &draw));
    CHECK(pick(SWIFTPROX_DRAW_KIND_CONTACT) == 4 && pick(SWIFTPROX_DRAW_KIND_POLYTOPE) == 0);
    config.max_distance = -1;
    draw = recorder(ALL);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
                swiftprox_pair_draw(placed(cube, here), placed(cube, there), &config, &draw));
    CHECK(drawn.line_count == 0);
    swiftprox_shape_release(cube);
}

/* Objects and boxes; after a query near pairs and results; and callbacks that use the scene. */
static void scenes(void)
{
    const swiftprox_shape *cube = box(0.5, 0.5, 0.5);
    swiftprox_scene *scene = NULL;
    swiftprox_object_id ids[3];
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    double lower[3], upper[3];
    swiftprox_draw draw;
    size_t i;
    int k;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (i = 0; i < 3; ++i) {
        swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        place(options.pose, i == 2 ? 2.5 : 0.75 * (double)i, 0, 0);
        CHECK_OK(swiftprox_scene_add_object(scene, &cube, 1, &options, &ids[i]));
    }
    draw = recorder(ALL);
    CHECK_OK(swiftprox_scene_draw(scene, &draw));
    CHECK(pick(SWIFTPROX_DRAW_KIND_EDGE) == 36 && pick(SWIFTPROX_DRAW_KIND_BOX) == 36 && drawn.line_count == 72);
    CHECK_OK(swiftprox_scene_get_object_box(scene, ids[0], lower, upper));
    for (i = 0; i < 12; ++i) {
        int across = 0;
        for (k = 0; k < 3; ++k) {
            const double s = picked[i].start[k], e = picked[i].end[k];
            CHECK((s == lower[k] || s == upper[k]) && (e == lower[k] || e == upper[k]));
            across += s != e;
        }
        CHECK(across == 1);
    }
    query.max_distance = 1;
    query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    CHECK_OK(swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK(answer.count == 2);
    draw = recorder(ALL);
    CHECK_OK(swiftprox_scene_draw(scene, &draw));
    CHECK(pick(SWIFTPROX_DRAW_KIND_NEAR_PAIR) >= 2);
    CHECK(picked[0].start[0] == 0 && picked[0].end[0] == 0.75);
    CHECK(pick(SWIFTPROX_DRAW_KIND_WITNESS) == 2 && pick(SWIFTPROX_DRAW_KIND_NORMAL) == 2);
    CHECK(pick(SWIFTPROX_DRAW_KIND_CONTACT) == answer.point_count && answer.point_count == 8);
    CHECK(pick(SWIFTPROX_DRAW_KIND_WITNESS) == 2);
    CHECK(same(picked[0].end, answer.contacts[0].depth.world1) && same(picked[1].end, answer.pairs[1].answer.world1));
    /* A query that gives no points. */
    CHECK_OK(swiftprox_scene_query_intersection(scene, NULL, &answer));
    CHECK(answer.count == 1);
    draw = recorder(only(SWIFTPROX_DRAW_KIND_WITNESS) | only(SWIFTPROX_DRAW_KIND_NORMAL) | only(SWIFTPROX_DRAW_KIND_CONTACT));
    CHECK_OK(swiftprox_scene_draw(scene, &draw));
    CHECK(drawn.line_count == 0 && drawn.point_count == 0 && drawn.text_count == 0);
    /* A call that changes the scene is refused within the drawing, one that reads it is not. */
    drawn.scene = scene;
    drawn.object = ids[1];
    draw = recorder(only(SWIFTPROX_DRAW_KIND_NEAR_PAIR));
    CHECK_OK(swiftprox_scene_draw(scene, &draw));
    CHECK(drawn.line_count >= 2);
    drawn.scene = NULL;
    /* What is gone is near nothing. */
    CHECK_OK(swiftprox_scene_remove_object(scene, ids[1]));
    draw = recorder(only(SWIFTPROX_DRAW_KIND_NEAR_PAIR) | only(SWIFTPROX_DRAW_KIND_EDGE));
    CHECK_OK(swiftprox_scene_draw(scene, &draw));
    CHECK(pick(SWIFTPROX_DRAW_KIND_EDGE) == 24);
    CHECK(pick(SWIFTPROX_DRAW_KIND_NEAR_PAIR) + 24 == drawn.line_count && drawn.line_count <= 25);
    CHECK(drawn.line_count == 24 || (picked[0].start[0] == 0 && picked[0].end[0] == 2.5));
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(cube);
}

/* A ground on its side: the edges of its triangles, 7 along the grid and 2 diagonals, where its pose puts them. */
static void grounds(void)
{
    const double heights[6] = {0, 1, 2, 3, 4, 5}, pose[12] = {0, 0, 1, 7, 1, 0, 0, 0, 0, 1, 0, 0};
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    const swiftprox_ground *ground = NULL;
    swiftprox_scene *scene = NULL;
    swiftprox_object_id id;
    swiftprox_draw draw = recorder(ALL);
    size_t i, diagonals = 0;
    CHECK_OK(swiftprox_ground_create_from_heights(2, 3, 1, 1, heights, &ground));
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    options.ground = ground;
    memcpy(options.pose, pose, sizeof pose);
    CHECK_OK(swiftprox_scene_add_object(scene, NULL, 0, &options, &id));
    CHECK_OK(swiftprox_scene_draw(scene, &draw));
    CHECK(pick(SWIFTPROX_DRAW_KIND_BOX) == 12 && pick(SWIFTPROX_DRAW_KIND_EDGE) == 9 && drawn.line_count == 21);
    for (i = 0; i < 9; ++i) {
        const double *const start = picked[i].start, *const end = picked[i].end;
        const double along = fabs(end[1] - start[1]), across = fabs(end[2] - start[2]);
        CHECK(start[0] == 7 + start[1] + 3 * start[2] && end[0] == 7 + end[1] + 3 * end[2]);
        CHECK(along + across == 1 || (along == 1 && across == 1));
        diagonals += along + across == 2;
    }
    CHECK(diagonals == 2);
    draw = recorder(ALL & ~only(SWIFTPROX_DRAW_KIND_EDGE));
    CHECK_OK(swiftprox_scene_draw(scene, &draw));
    CHECK(drawn.line_count == 12);
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_ground_release(ground);
}

/* Callbacks run as the program has set its processor. */
static void callbacks_in_the_environment_of_the_program(void)
{
    const swiftprox_shape *cube = box(1, 1, 1);
    swiftprox_draw draw = recorder(ALL);
    double here[12];
    place(here, 0, 0, 0);
    fesetround(FE_UPWARD);
    const double upward = one_third(); /* valgrind rounds to nearest all the same */
    CHECK_OK(swiftprox_shape_draw(placed(cube, here), &draw));
    fesetround(FE_TONEAREST);
    CHECK(drawn.third == upward && drawn.line_count == 12);
    swiftprox_shape_release(cube);
}

static void bad_input(void)
{
    const swiftprox_shape *cube = box(1, 1, 1);
    swiftprox_scene *scene = NULL;
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    swiftprox_draw draw = recorder(ALL), nobody = SWIFTPROX_DRAW_DEFAULT, unset;
    double here[12], skewed[12];
    memset(&unset, 0, sizeof unset);
    place(here, 0, 0, 0);
    place(skewed, 0, 0, 0);
    skewed[0] = 2;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "draw", swiftprox_shape_draw(placed(cube, here), NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "draw", swiftprox_pair_draw(placed(cube, here), placed(cube, here), NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "draw", swiftprox_scene_draw(scene, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_draw(NULL, &draw));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object.shape", swiftprox_shape_draw(placed(NULL, here), &draw));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object.pose", swiftprox_shape_draw(placed(cube, NULL), &draw));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "object2.shape",
                swiftprox_pair_draw(placed(cube, here), placed(NULL, here), NULL, &draw));
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "SWIFTPROX_DRAW_DEFAULT", swiftprox_shape_draw(placed(cube, here), &unset));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal", swiftprox_shape_draw(placed(cube, skewed), &draw));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal", swiftprox_pair_draw(placed(cube, here), placed(cube, skewed), NULL, &draw));
    draw = recorder(only(SWIFTPROX_DRAW_KIND_MARCH));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal", swiftprox_pair_draw(placed(cube, here), placed(cube, skewed), NULL, &draw));
    config.max_distance = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
                swiftprox_pair_draw(placed(cube, here), placed(cube, here), &config, &draw));
    CHECK(drawn.line_count == 0 && drawn.point_count == 0 && drawn.text_count == 0);
    /* Nobody listens. */
    CHECK_OK(swiftprox_shape_draw(placed(cube, here), &nobody));
    CHECK_OK(swiftprox_pair_draw(placed(cube, here), placed(cube, here), NULL, &nobody));
    CHECK_OK(swiftprox_scene_draw(scene, &nobody));
    /* Nothing is wanted. */
    draw = recorder(0);
    CHECK_OK(swiftprox_pair_draw(placed(cube, here), placed(cube, here), NULL, &draw));
    CHECK_OK(swiftprox_scene_draw(scene, &draw));
    CHECK(drawn.line_count == 0 && drawn.point_count == 0 && drawn.text_count == 0);
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(cube);
}

int main(void)
{
    shapes();
    marches();
    polytopes();
    all_sorts();
    contacts();
    scenes();
    grounds();
    callbacks_in_the_environment_of_the_program();
    bad_input();
    return check_report("draw");
}
