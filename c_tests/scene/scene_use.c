/* What a scene is for, through C: objects by every way of adding, moved in every form, pairs switched on and off in every form,
 * and each query's list. Unit cubes in a row along x, so that every distance is known; that answers are right in general is
 * tested elsewhere, this is about arguments and results arriving where they belong. */
#include <math.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/scene.h"
#include "swiftprox/tuning.h"

static const double CORNERS[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
static const uint32_t FACES[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
static const uint32_t VALENCES[6] = {4, 4, 4, 4, 4, 4};
/* A quarter turn about z: x to y. It and its transpose differ, so a transposed or shifted matrix is seen. */
static const double QUARTER[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};

/* Whether two ids are one. */
static int is(swiftprox_object_id id, swiftprox_object_id other)
{
    return id.bits == other.bits;
}

/* Adds a cube whose lower corner is at x, its user data ten times x. */
static swiftprox_object_id add_cube(swiftprox_scene *scene, double x)
{
    const swiftprox_shape *cube;
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_id id;
    options.user_data = (uint64_t)(10 * x);
    place(options.pose, x, 0, 0);
    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 8, FACES, VALENCES, 6}, NULL, &cube));
    CHECK_OK(swiftprox_scene_add_object(scene, &cube, 1, &options, &id));
    swiftprox_shape_release(cube);
    return id;
}

/* Whether the exact query lists these distances in this order; 0 stands for an intersecting pair. */
static int lists(swiftprox_scene *scene, size_t count, const double *distances)
{
    swiftprox_scene_answer answer;
    int right = CHECK_OK(swiftprox_scene_query_distance(scene, NULL, &answer)) && answer.count == count;
    for (size_t i = 0; right && i < count; ++i)
        right = fabs(answer.pairs[i].answer.distance - distances[i]) < 1e-13 &&
                (answer.pairs[i].answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING) == (distances[i] == 0);
    return right;
}

static void queries(void)
{
    swiftprox_scene *scene;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    const swiftprox_object_id a = add_cube(scene, 0), b = add_cube(scene, 0.5), c = add_cube(scene, 3);
    CHECK(lists(scene, 3, (const double[]){0, 2, 1.5}));

    CHECK_OK(swiftprox_scene_query_intersection(scene, NULL, &answer));
    CHECK(answer.intersecting == 1 && answer.count == 1);
    CHECK(is(answer.pairs[0].object1, a) && is(answer.pairs[0].object2, b));
    CHECK(answer.pairs[0].user_data1 == 0 && answer.pairs[0].user_data2 == 5);

    query.max_distance = 1.75;
    CHECK_OK(swiftprox_scene_query_distance(scene, &query, &answer));
    CHECK(answer.count == 2 && is(answer.pairs[1].object1, b) && is(answer.pairs[1].object2, c));
    CHECK(answer.pairs[0].answer.proof_count > 0 && isnan(answer.pairs[0].answer.world1[0]));
    CHECK(fabs(answer.pairs[1].answer.world1[0] - 1.5) < 1e-13 && answer.pairs[1].answer.normal[0] == -1);

    CHECK_OK(swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK(answer.count == 2);
    /* Points on both, in both frames, and the normal from object 2 to object 1. */
    const swiftprox_pair_answer *apart = &answer.pairs[1].answer;
    CHECK(fabs(apart->world1[0] - 1.5) < 1e-13 && fabs(apart->world2[0] - 3) < 1e-13 && apart->normal[0] == -1);
    CHECK(fabs(apart->local1[0] - 1) < 1e-13 && fabs(apart->local2[0]) < 1e-13);
    CHECK(isfinite(answer.pairs[0].answer.world1[0]) && isfinite(answer.pairs[0].answer.normal[0]));

    CHECK(answer.found == NULL);
    query.early_exit = 1;
    CHECK_OK(swiftprox_scene_query_distance(scene, &query, &answer));
    CHECK(answer.intersecting == 1 && answer.count == 0 && answer.pairs == NULL);
    CHECK(answer.found != NULL && is(answer.found->object1, a) && is(answer.found->object2, b));
    CHECK(answer.found->answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING && answer.found->user_data2 == 5);

    swiftprox_scene_statistics statistics;
    CHECK_OK(swiftprox_scene_get_statistics(scene, &statistics));
    CHECK(statistics.queries == 5 && statistics.pairs > 0);
    CHECK(statistics.marched + statistics.coherent + statistics.fallback + statistics.exact +
              statistics.bounding_spheres + statistics.inscribed_spheres + statistics.unmoved +
                  statistics.out_of_reach ==
              statistics.pairs);
    CHECK_OK(swiftprox_scene_reset_statistics(scene));
    CHECK_OK(swiftprox_scene_get_statistics(scene, &statistics));
    CHECK(statistics.queries == 0 && statistics.pairs == 0);
    CHECK_OK(swiftprox_scene_destroy(scene));
}

static void motion(void)
{
    swiftprox_scene *scene;
    swiftprox_object_info info;
    double pose[12], poses[24];
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    const swiftprox_object_id a = add_cube(scene, 0), b = add_cube(scene, 0.5);

    place(pose, 3, 0, 0);
    CHECK_OK(swiftprox_scene_set_pose(scene, b, pose));
    CHECK(lists(scene, 1, (const double[]){2}));

    /* Turned about its own corner, the cube at 4 reaches down to 3. */
    const double at_4[3] = {4, 0, 0};
    CHECK_OK(swiftprox_scene_set_transform(scene, b, QUARTER, at_4));
    CHECK(lists(scene, 1, (const double[]){2}));
    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_scene_get_object_info(scene, b, &info));
    CHECK(info.pose[1] == -1 && info.pose[3] == 4 && info.pose[4] == 1 && info.user_data == 5 && info.piece_count == 1);

    place(poses, 1, 0, 0);
    place(poses + 12, 6, 0, 0);
    CHECK_OK(swiftprox_scene_set_poses(scene, NULL, poses, 2));
    CHECK(lists(scene, 1, (const double[]){4}));

    const double identity_and_quarter[18] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 1, 0, 0, 0, 0, 1};
    const double translations[6] = {-1, 0, 0, 4, 0, 0};
    CHECK_OK(swiftprox_scene_set_transforms(scene, NULL, identity_and_quarter, translations, 2));
    CHECK(lists(scene, 1, (const double[]){3}));

    /* A copy stands where its original does. */
    swiftprox_object_id copy;
    CHECK_OK(swiftprox_scene_copy_object(scene, a, &copy));
    CHECK(lists(scene, 3, (const double[]){3, 0, 3}));
    CHECK_OK(swiftprox_scene_remove_object(scene, a));
    CHECK(lists(scene, 1, (const double[]){3}));
    CHECK_OK(swiftprox_scene_destroy(scene));
}

static void activation(void)
{
    swiftprox_scene *scene;
    int32_t active;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    const swiftprox_object_id a = add_cube(scene, 0), b = add_cube(scene, 2), c = add_cube(scene, 5);
    CHECK(lists(scene, 3, (const double[]){1, 4, 2}));

    CHECK_OK(swiftprox_scene_set_pair_active(scene, &c, &a, 0));
    CHECK_OK(swiftprox_scene_get_pair_active(scene, a, c, &active));
    CHECK(active == 0 && lists(scene, 2, (const double[]){1, 2}));
    CHECK_OK(swiftprox_scene_set_pair_active(scene, &a, &c, 1));
    CHECK_OK(swiftprox_scene_get_pair_active(scene, a, c, &active));
    CHECK(active == 1 && lists(scene, 3, (const double[]){1, 4, 2}));

    CHECK_OK(swiftprox_scene_set_pair_active(scene, &b, NULL, 0));
    CHECK(lists(scene, 1, (const double[]){4}));
    CHECK_OK(swiftprox_scene_set_pair_active(scene, NULL, NULL, 0));
    CHECK(lists(scene, 0, NULL));
    CHECK_OK(swiftprox_scene_set_pair_active(scene, &b, NULL, 1));
    CHECK(lists(scene, 2, (const double[]){1, 2}));
    CHECK_OK(swiftprox_scene_set_pair_active(scene, NULL, NULL, 1));
    CHECK(lists(scene, 3, (const double[]){1, 4, 2}));
    CHECK_OK(swiftprox_scene_destroy(scene));
}

/* Round bodies with levels of detail, four radii apart: what was built and what it takes, which levels answered, and how much of
 * the error was spent. */
static void levels(void)
{
    enum { COUNT = 500 };
    double points[3 * COUNT], pose[12];
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    const swiftprox_shape *shape;
    swiftprox_shape_info info = {sizeof info};
    swiftprox_shape_tuning_info has = {sizeof has};
    swiftprox_shape_tuning making = SWIFTPROX_SHAPE_TUNING_DEFAULT;
    swiftprox_pair_tuning asking = SWIFTPROX_PAIR_TUNING_DEFAULT;
    making.hierarchy = SWIFTPROX_HIERARCHY_QUADRIC;
    options.tuning = &making;
    for (int i = 0; i < COUNT; ++i) { /* a spiral around the sphere */
        const double z = 1 - (2 * i + 1.0) / COUNT, r = sqrt(1 - z * z);
        points[3 * i] = r * cos(2.4 * i);
        points[3 * i + 1] = r * sin(2.4 * i);
        points[3 * i + 2] = z;
    }
    if (!CHECK_OK(swiftprox_shape_create_from_points(points, COUNT, &options, &shape)))
        return;
    CHECK_OK(swiftprox_shape_get_info(shape, &info));
    CHECK_OK(swiftprox_shape_get_tuning_info(shape, &has));
    CHECK(has.hierarchy == SWIFTPROX_HIERARCHY_QUADRIC && has.level_count > 0 && has.lookup == SWIFTPROX_LOOKUP_SHELLS);
    CHECK(has.level_bytes > 0 && has.level_bytes + has.lookup_bytes < info.bytes);
    const size_t level_bytes = has.level_bytes, without_tables = info.bytes - has.lookup_bytes - level_bytes;

    const swiftprox_shape *prepared;
    CHECK_OK(swiftprox_shape_create_from_points(points, COUNT, &options, &prepared));
    CHECK_OK(swiftprox_shape_prepare(prepared, NULL, NULL));
    CHECK_OK(swiftprox_shape_get_info(prepared, &info));
    CHECK_OK(swiftprox_shape_get_tuning_info(prepared, &has));
    CHECK(has.lookup_bytes > 0 && has.level_bytes > level_bytes); /* levels have tables, too */
    CHECK(info.bytes == without_tables + has.lookup_bytes + has.level_bytes);
    swiftprox_shape_release(prepared);

    swiftprox_scene *scene;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    swiftprox_scene_statistics statistics;
    swiftprox_object_options where = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_id id;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (int i = 0; i < 3; ++i) {
        place(pose, 4.0 * i, 0, 0);
        memcpy(where.pose, pose, sizeof pose);
        CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, &where, &id));
    }
    asking.levels = SWIFTPROX_LEVELS_ALL;
    query.tuning = &asking;
    query.error_budget = 3;
    CHECK_OK(swiftprox_scene_query_approximate(scene, &query, &answer));
    CHECK(answer.count == 3);
    CHECK_OK(swiftprox_shape_get_info(shape, &info));
    CHECK_OK(swiftprox_shape_get_tuning_info(shape, &has));
    CHECK(has.level_bytes > level_bytes); /* the levels' own tables said where to start, and levels answered */
    CHECK(info.bytes == without_tables + has.lookup_bytes + has.level_bytes);
    swiftprox_shape_release(shape);
    for (size_t i = 0; i < answer.count; ++i) {
        const swiftprox_pair_answer *pair = &answer.pairs[i].answer;
        CHECK(pair->decided_by == SWIFTPROX_DECIDED_BY_TOLERANCE && pair->upper - pair->lower <= 1);
        CHECK(pair->statistics.levels[0] > 0 && pair->statistics.levels[1] > 0);
    }
    CHECK_OK(swiftprox_scene_get_statistics(scene, &statistics));
    CHECK(statistics.pairs == 3 && statistics.within_tolerance == 3 && statistics.by_level[0] == 0);
    CHECK(statistics.error_spent > 0 && statistics.error_spent <= 3);
    CHECK_OK(swiftprox_scene_reset_statistics(scene));
    CHECK_OK(swiftprox_scene_query_intersection(scene, NULL, &answer));
    CHECK_OK(swiftprox_scene_get_statistics(scene, &statistics));
    CHECK(statistics.pairs == 3 && statistics.error_spent == 0);
    query.error_budget = 0;
    CHECK_OK(swiftprox_scene_reset_statistics(scene));
    CHECK_OK(swiftprox_scene_query_approximate(scene, &query, &answer));
    CHECK_OK(swiftprox_scene_get_statistics(scene, &statistics));
    CHECK(statistics.within_tolerance == 0 && statistics.by_level[0] == 3 && statistics.error_spent < 1e-12);
    CHECK_OK(swiftprox_scene_destroy(scene));
}

/* Refuses pairs of which one has the user's id, and counts its calls. */
struct refusal {
    swiftprox_object_id id;
    int calls;
};

static int32_t refuse(swiftprox_object_id object1, swiftprox_object_id object2, void *user)
{
    struct refusal *refusal = user;
    ++refusal->calls;
    return !is(object1, refusal->id) && !is(object2, refusal->id);
}

static void set_groups(swiftprox_scene *scene, swiftprox_object_id id, uint32_t groups, uint32_t mask)
{
    swiftprox_object_info info;
    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_scene_get_object_info(scene, id, &info));
    info.groups = groups;
    info.mask = mask;
    CHECK_OK(swiftprox_scene_set_object_info(scene, id, &info));
}

static void set_fixed(swiftprox_scene *scene, swiftprox_object_id id, int32_t fixed)
{
    swiftprox_object_info info;
    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_scene_get_object_info(scene, id, &info));
    info.fixed = fixed;
    CHECK_OK(swiftprox_scene_set_object_info(scene, id, &info));
}

/* What decides which pairs are tested, beside activation: groups, fixed objects, a filter and pairs of the program's own. */
static void filters(void)
{
    swiftprox_scene *scene;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    const swiftprox_object_id a = add_cube(scene, 0), b = add_cube(scene, 0.5), c = add_cube(scene, 3);
    swiftprox_object_info info;
    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_scene_get_object_info(scene, a, &info));
    CHECK(info.groups == 1 && info.mask == UINT32_MAX);

    set_groups(scene, a, 2, 1);
    CHECK(lists(scene, 3, (const double[]){0, 2, 1.5}));
    set_groups(scene, b, 1, 4);
    CHECK(lists(scene, 1, (const double[]){2}));
    set_groups(scene, b, 0, 0);
    CHECK(lists(scene, 3, (const double[]){0, 2, 1.5}));

    set_fixed(scene, a, 1);
    set_fixed(scene, b, 1);
    CHECK(lists(scene, 2, (const double[]){2, 1.5}));
    set_fixed(scene, b, 0);
    CHECK(lists(scene, 3, (const double[]){0, 2, 1.5}));

    struct refusal refusal = {b, 0};
    CHECK_OK(swiftprox_scene_set_pair_filter(scene, refuse, &refusal));
    CHECK(lists(scene, 1, (const double[]){2}) && lists(scene, 1, (const double[]){2}) && refusal.calls == 3);
    refusal.id = c;
    CHECK(lists(scene, 1, (const double[]){2}) && refusal.calls == 3);
    CHECK_OK(swiftprox_scene_set_pair_filter(scene, refuse, &refusal));
    CHECK(lists(scene, 1, (const double[]){0}) && refusal.calls == 6);
    CHECK_OK(swiftprox_scene_set_pair_filter(scene, NULL, NULL));

    const swiftprox_object_id pairs[] = {c, a, a, b, b, a}, twice[] = {a, b, c, c};
    CHECK_OK(swiftprox_scene_set_pairs(scene, pairs, 3));
    CHECK(lists(scene, 2, (const double[]){0, 2}));
    CHECK(swiftprox_scene_set_pairs(scene, twice, 2) == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(swiftprox_library_last_error_message(), "pair 1") != NULL);
    CHECK(lists(scene, 2, (const double[]){0, 2}));
    CHECK_OK(swiftprox_scene_set_pairs(scene, NULL, 0));
    CHECK(lists(scene, 0, NULL));
    CHECK_OK(swiftprox_scene_reset_pairs(scene));
    CHECK(lists(scene, 3, (const double[]){0, 2, 1.5}));
    CHECK_OK(swiftprox_scene_destroy(scene));
}

/* Several objects moved by their ids, pieces moved in their object, and the objects in order. */
static void pieces(void)
{
    swiftprox_scene *scene;
    const swiftprox_shape *shape;
    swiftprox_object_id id, ids[4];
    size_t count;
    double poses[24], pose[12];
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    const swiftprox_object_id a = add_cube(scene, 0), b = add_cube(scene, 3);
    place(poses, 1, 0, 0);
    place(poses + 12, 5, 0, 0);
    const swiftprox_object_id moved[] = {b, a};
    CHECK_OK(swiftprox_scene_set_poses(scene, moved, poses, 2));
    CHECK(lists(scene, 1, (const double[]){3}));
    poses[12] = NAN;
    CHECK(swiftprox_scene_set_poses(scene, moved, poses, 2) == SWIFTPROX_ERROR_POSE);
    CHECK(strstr(swiftprox_library_last_error_message(), "pose 1") != NULL);

    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 8, FACES, VALENCES, 6}, NULL, &shape));
    const swiftprox_shape *two[] = {shape, shape};
    CHECK_OK(swiftprox_scene_add_object(scene, two, 2, NULL, &id));
    swiftprox_shape_release(shape);
    place(pose, 10, 0, 0);
    CHECK_OK(swiftprox_scene_set_piece_pose(scene, id, 1, pose));
    /* At 1 (b), 5 (a), and the pieces at 0 and 10: a with b, a with both pieces, b with both. */
    CHECK(lists(scene, 5, (const double[]){3, 4, 4, 0, 8}));
    CHECK_OK(swiftprox_scene_get_piece_pose(scene, id, 1, pose));
    CHECK(pose[3] == 10);
    CHECK(swiftprox_scene_set_piece_pose(scene, id, 2, pose) == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(swiftprox_scene_get_piece_pose(scene, id, 2, pose) == SWIFTPROX_ERROR_INVALID_ARGUMENT && isnan(pose[3]));

    CHECK_OK(swiftprox_scene_copy_object_ids(scene, NULL, 0, &count));
    CHECK(count == 3);
    CHECK_OK(swiftprox_scene_copy_object_ids(scene, ids, 4, &count));
    CHECK(count == 3 && is(ids[0], a) && is(ids[1], b) && is(ids[2], id));
    CHECK(swiftprox_scene_copy_object_ids(scene, ids, 2, &count) == SWIFTPROX_ERROR_INVALID_ARGUMENT && count == 0);
    CHECK_OK(swiftprox_scene_destroy(scene));
}

/* What is near one object, or a shape that is in no scene, and what has changed. */
static void near_objects(void)
{
    swiftprox_scene *scene;
    const swiftprox_shape *shape;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    swiftprox_scene_events events;
    double pose[12];
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    const swiftprox_object_id a = add_cube(scene, 0), b = add_cube(scene, 0.5), c = add_cube(scene, 3);
    query.max_distance = 1.75;
    CHECK_OK(swiftprox_scene_query_object(scene, c, SWIFTPROX_QUERY_KIND_DISTANCE, &query, &answer));
    CHECK(answer.count == 1 && is(answer.pairs[0].object1, b) && is(answer.pairs[0].object2, c));
    CHECK(fabs(answer.pairs[0].answer.distance - 1.5) < 1e-13 && !answer.intersecting);
    CHECK_OK(swiftprox_scene_query_object(scene, a, SWIFTPROX_QUERY_KIND_INTERSECTION, NULL, &answer));
    CHECK(answer.count == 1 && is(answer.pairs[0].object2, b) && answer.intersecting);
    CHECK(swiftprox_scene_query_object(scene, a, (swiftprox_query_kind)9, NULL, &answer) == SWIFTPROX_ERROR_INVALID_ARGUMENT);

    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 8, FACES, VALENCES, 6}, NULL, &shape));
    place(pose, 3.5, 0, 0);
    CHECK_OK(
        swiftprox_scene_query_placed(scene, &(swiftprox_placed){shape, pose}, 1, SWIFTPROX_QUERY_KIND_CONTACT, NULL, &answer));
    CHECK(answer.count == 1 && is(answer.pairs[0].object1, c) && answer.pairs[0].object2.bits == 0);
    CHECK_OK(
        swiftprox_scene_query_placed(scene, &(swiftprox_placed){shape, pose}, 1, SWIFTPROX_QUERY_KIND_DISTANCE, NULL, &answer));
    CHECK(answer.count == 3 && answer.pairs[2].user_data1 == 30);
    pose[0] = NAN;
    CHECK(swiftprox_scene_query_placed(scene, &(swiftprox_placed){shape, pose}, 1, SWIFTPROX_QUERY_KIND_CONTACT, NULL,
                                       &answer) == SWIFTPROX_ERROR_POSE);
    swiftprox_shape_release(shape);

    CHECK_OK(swiftprox_scene_query_events(scene, 0, &events));
    CHECK(events.began_count == 1 && events.ended_count == 0 && events.ended == NULL);
    CHECK(is(events.began[0].object1, a) && is(events.began[0].object2, b) && events.began[0].user_data2 == 5);
    place(pose, 2, 0, 0);
    CHECK_OK(swiftprox_scene_set_pose(scene, b, pose));
    CHECK_OK(swiftprox_scene_query_events(scene, 0, &events));
    CHECK(events.began_count == 1 && is(events.began[0].object2, c));
    CHECK(events.ended_count == 1 && is(events.ended[0].object1, a));
    CHECK_OK(swiftprox_scene_remove_object(scene, c));
    CHECK_OK(swiftprox_scene_query_events(scene, 0.5, &events));
    CHECK(events.began_count == 0 && events.ended_count == 1 && is(events.ended[0].object2, c));
    CHECK_OK(swiftprox_scene_query_events(scene, 1, &events));
    CHECK(events.began_count == 1 && events.ended_count == 0);
    CHECK(swiftprox_scene_query_events(scene, -1, &events) == SWIFTPROX_ERROR_INVALID_ARGUMENT && events.began == NULL);
    CHECK_OK(swiftprox_scene_destroy(scene));
}

/* A program's threads, as a program might have none: tasks wait until they are to be finished, and are then done backwards. */
struct waiting {
    swiftprox_task_callback task;
    void *context;
    uint32_t count;
    int finished;
};

static void *enqueue(swiftprox_task_callback task, uint32_t item_count, void *context, void *user)
{
    struct waiting *waiting = user;
    waiting->task = task;
    waiting->context = context;
    waiting->count = item_count;
    return waiting;
}

static void finish(void *task, void *user)
{
    struct waiting *waiting = user;
    CHECK(task == user && waiting->count > 1);
    for (uint32_t i = waiting->count; i > 0; --i)
        waiting->task(i - 1, i, waiting->context);
    ++waiting->finished;
}

static void workers(void)
{
    struct waiting waiting = {NULL, NULL, 0, 0};
    swiftprox_scene *scenes[3];
    swiftprox_scene_options options = SWIFTPROX_SCENE_OPTIONS_DEFAULT;
    swiftprox_scene_answer answers[3];
    const swiftprox_shape *shape;
    swiftprox_object_options where = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_id id;
    options.worker_count = 2;
    CHECK_OK(swiftprox_scene_create(NULL, &scenes[0]));
    CHECK_OK(swiftprox_scene_create(&options, &scenes[1]));
    options.enqueue_task = enqueue;
    CHECK(swiftprox_scene_create(&options, &scenes[2]) == SWIFTPROX_ERROR_INVALID_ARGUMENT && scenes[2] == NULL);
    options.finish_task = finish;
    options.task_user = &waiting;
    CHECK_OK(swiftprox_scene_create(&options, &scenes[2]));
    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 8, FACES, VALENCES, 6}, NULL, &shape));
    for (int s = 0; s < 3; ++s) {
        for (int i = 0; i < 80; ++i) {
            place(where.pose, 0.25 * i, 0, 0);
            CHECK_OK(swiftprox_scene_add_object(scenes[s], &shape, 1, &where, &id));
        }
        CHECK_OK(swiftprox_scene_query_distance(scenes[s], NULL, &answers[s]));
        CHECK(answers[s].count == 80 * 79 / 2 && answers[s].intersecting);
    }
    swiftprox_shape_release(shape);
    CHECK(waiting.finished > 0);
    for (size_t i = 0; i < answers[0].count; ++i)
        for (int s = 1; s < 3; ++s)
            CHECK(answers[s].pairs[i].answer.lower == answers[0].pairs[i].answer.lower &&
                  answers[s].pairs[i].answer.decided_by == answers[0].pairs[i].answer.decided_by);
    for (int s = 0; s < 3; ++s)
        CHECK_OK(swiftprox_scene_destroy(scenes[s]));
}

int main(void)
{
    queries();
    workers();
    filters();
    pieces();
    near_objects();
    motion();
    activation();
    levels();
    return check_report("scene_use");
}
