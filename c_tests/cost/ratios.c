/*
 * What scenes cost beside the pairs in them, for ratios.py to count under callgrind: a function call `measured` for each case.
 * Two ellipsoids of 1,002 points, one on an orbit in steps of 0.1 degrees, by the pair layer and in a scene; all pairs of boxes
 * that move, with and without the memory of what each pair answered; and near boxes, by exact and by approximate queries, moving
 * and at rest.
 */
#include <math.h>
#include <string.h>

#include "check.h"
#include "swiftprox/scene.h"

enum { STEPS = 200, POINTS = 1002, BOXES = 40 };

static const double full_turn = 6.283185307179586;
static const double origin[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

static const swiftprox_shape *make(const double *points, size_t count)
{
    const swiftprox_shape *shape = NULL;
    CHECK_OK(swiftprox_shape_create_from_points(points, count, NULL, &shape));
    CHECK_OK(swiftprox_shape_prepare(shape, NULL, NULL));
    return shape;
}

/* Points on a spiral from pole to pole. */
static const swiftprox_shape *make_ellipsoid(void)
{
    static double points[3 * POINTS];
    int i;
    for (i = 0; i < POINTS; ++i) {
        const double z = 1 - 2 * (i + 0.5) / POINTS, around = 2.399963229728653 * i;
        points[3 * i] = sqrt(1 - z * z) * cos(around);
        points[3 * i + 1] = 0.7 * sqrt(1 - z * z) * sin(around);
        points[3 * i + 2] = 0.5 * z;
    }
    return make(points, POINTS);
}

static const swiftprox_shape *make_box(void)
{
    double points[24];
    int i;
    for (i = 0; i < 24; ++i) {
        points[i] = (i / 3 >> i % 3 & 1) != 0 ? 0.5 : -0.5;
    }
    return make(points, 8);
}

static void turn(double angle, double x, double y, double z, double pose[12])
{
    memcpy(pose, origin, sizeof origin);
    pose[0] = pose[5] = cos(angle);
    pose[4] = sin(angle);
    pose[1] = -pose[4];
    pose[3] = x;
    pose[7] = y;
    pose[11] = z;
}

enum work { BY_PAIR, BY_SCENE, BY_ALL_PAIRS, AT_REST };

typedef swiftprox_status (*ask_function)(swiftprox_scene *, const swiftprox_scene_query *, swiftprox_scene_answer *);

static swiftprox_scene *scene;
static swiftprox_object_id ids[BOXES];
static swiftprox_scene_query query;
static ask_function ask = swiftprox_scene_query_distance;

/* Where object i is in a step: the second of two on its orbit, boxes turning in rows. */
static void place(enum work work, int i, int step, double pose[12])
{
    const double angle = full_turn / 3600 * step;
    if (work != BY_PAIR && work != BY_SCENE) {
        turn(angle * (i % 5 + 1), 3.0 * (i % 7), 3.0 * (i / 7), 0, pose);
    } else {
        turn(angle, 2.2 * cos(angle), 2.2 * sin(angle), 0.1, pose);
    }
}

void measured(enum work work, const swiftprox_shape *shape);

/* Called by way of this, so that no compiler makes a copy of it under another name. */
static void (*volatile const call_measured)(enum work, const swiftprox_shape *) = measured;

void measured(enum work work, const swiftprox_shape *shape)
{
    swiftprox_pair_cache cache = {{0}};
    swiftprox_pair_answer answer = {0};
    swiftprox_scene_answer listed = {0};
    double pose[12];
    const int moving = work == AT_REST ? 0 : work == BY_SCENE ? 2 : BOXES;
    int step, i, failed = 0;
    for (step = 0; step < STEPS; ++step) {
        if (work == BY_PAIR) {
            place(work, 1, step, pose);
            failed += swiftprox_pair_distance((swiftprox_placed){shape, origin}, (swiftprox_placed){shape, pose}, &cache, NULL,
                                              &answer) != SWIFTPROX_OK;
            continue;
        }
        for (i = 1; i < moving; ++i) {
            place(work, i, step, pose);
            failed += swiftprox_scene_set_pose(scene, ids[i], pose) != SWIFTPROX_OK;
        }
        failed += ask(scene, &query, &listed) != SWIFTPROX_OK;
    }
    CHECK(failed == 0);
    if (work != BY_PAIR && query.max_distance < 0) {
        CHECK(listed.count == (work == BY_SCENE ? 1 : BOXES * (BOXES - 1) / 2));
    } else if (work != BY_PAIR) {
        CHECK(listed.count > 0);
    }
}

/* The first round makes what is made on first need, and is counted under a name that no ratio is about. */
static void count(const char *name, enum work work, const swiftprox_shape *shape)
{
    call_measured(work, shape);
    puts("first round");
    call_measured(work, shape);
    puts(name);
}

static void make_scene(const swiftprox_shape *shape, int objects)
{
    int i;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (i = 0; i < objects; ++i) {
        CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, NULL, &ids[i]));
    }
}

/* Near boxes, asked in three ways. */
static void count_near_boxes(const swiftprox_shape *box)
{
    static const char *const names[3][2] = {
        {"exact", "exact, at rest"}, {"approximate", "approximate, at rest"}, {"budget", "budget, at rest"}};
    int way;
    for (way = 0; way < 3; ++way) {
        make_scene(box, BOXES);
        query = (swiftprox_scene_query)SWIFTPROX_SCENE_QUERY_DEFAULT;
        query.max_distance = 2.5;
        if (way > 0) {
            ask = swiftprox_scene_query_approximate;
        }
        if (way == 1) {
            query.absolute_error = 0.1;
        } else if (way == 2) {
            query.error_budget = 1;
        }
        count(names[way][0], BY_ALL_PAIRS, box);
        count(names[way][1], AT_REST, box);
        CHECK_OK(swiftprox_scene_destroy(scene));
    }
}

int main(void)
{
    const swiftprox_shape *ellipsoid = make_ellipsoid(), *box = make_box();
    int keeps;
    query = (swiftprox_scene_query)SWIFTPROX_SCENE_QUERY_DEFAULT;
    count("pair", BY_PAIR, ellipsoid);
    make_scene(ellipsoid, 2);
    count("scene", BY_SCENE, ellipsoid);
    query.max_distance = 2.5;
    count("scene, tolerance", BY_SCENE, ellipsoid);
    CHECK_OK(swiftprox_scene_destroy(scene));
    query = (swiftprox_scene_query)SWIFTPROX_SCENE_QUERY_DEFAULT;
    for (keeps = 0; keeps < 2; ++keeps) {
        make_scene(box, BOXES);
        CHECK_OK(swiftprox_scene_set_kept_pair_limit(scene, keeps ? 1000000 : 0));
        count(keeps ? "all pairs, kept" : "all pairs", BY_ALL_PAIRS, box);
        CHECK_OK(swiftprox_scene_destroy(scene));
    }
    count_near_boxes(box);
    swiftprox_shape_release(ellipsoid);
    swiftprox_shape_release(box);
    return check_report("ratios");
}
