/* A long life of a scene through C: mixed calls drawn from a seeded generator, what each query lists compared with all pairs of the
 * pair functions. Under valgrind nothing leaks, and nothing is read before it is written.
 *
 *   soak [CALLS [FOLDER FOR FILES]] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { MOST = 14, SHAPES = 3, PIECES = 2 };

struct object {
    swiftprox_object_id id;
    int pieces;
    int fixed;
    uint32_t groups, mask;
    int inactive[MOST]; /* by the place of the later one */
};

/* The scene as a plain list, and what it is made of. */
static struct object objects[MOST];
static int count;
static const swiftprox_shape *shapes[SHAPES];
static swiftprox_scene *scene;
static int filtered;
static swiftprox_object_id given[8];
static int given_count = -1;
static swiftprox_object_id near[MOST * MOST][2]; /* at the last query about events */
static size_t near_count;
static char path[1024];
static int recorded;

static uint32_t draw(uint32_t below)
{
    static uint64_t state = 20;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((state >> 33) % below);
}

/* From -1 to 1. */
static double number(void)
{
    return draw(20001) / 10000.0 - 1;
}

static void any_pose(double pose[12], double reach)
{
    const double angle = 3 * number(), c = cos(angle), s = sin(angle);
    const double rows[12] = {c, -s, 0, reach * number(), s, c, 0, reach * number(), 0, 0, 1, 0.5 * reach * number()};
    memcpy(pose, rows, sizeof rows);
}

static int32_t likes(swiftprox_object_id a, swiftprox_object_id b, void *user)
{
    (void)user;
    return (a.bits + b.bits) % 5 != 0;
}

static int is_given(swiftprox_object_id a, swiftprox_object_id b)
{
    for (int k = 0; k < given_count; k += 2)
        if ((given[k].bits == a.bits && given[k + 1].bits == b.bits) || (given[k].bits == b.bits && given[k + 1].bits == a.bits))
            return 1;
    return given_count < 0;
}

static int is_tested(int i, int j)
{
    const struct object *a = &objects[i], *b = &objects[j];
    return !(a->fixed && b->fixed) && (a->groups & b->mask) && (b->groups & a->mask) && !a->inactive[j] &&
           (!filtered || likes(a->id, b->id, NULL)) && is_given(a->id, b->id);
}

/* ---- queries ---- */

struct listed {
    swiftprox_object_id id1, id2;
    int piece1, piece2;
    swiftprox_pair_answer answer;
};

static struct listed expected[MOST * MOST * PIECES * PIECES];
static size_t expected_count;

/* Asks one pair without a past, and lists it if it is near. */
static void ask_pair(swiftprox_object_id id1, int piece1, swiftprox_object_id id2, int piece2, const swiftprox_shape *shape2,
                     const double pose2[12], double tolerance)
{
    double pose1[12];
    const swiftprox_shape *shape1;
    swiftprox_pair_cache cache;
    swiftprox_pair_config config;
    struct listed *next = &expected[expected_count];
    memset(&cache, 0, sizeof cache);
    swiftprox_pair_config_init(&config);
    config.distance_tolerance = tolerance;
    CHECK_OK(swiftprox_scene_get_piece(scene, id1, (size_t)piece1, &shape1));
    CHECK_OK(swiftprox_scene_get_piece_pose(scene, id1, (uint32_t)piece1, pose1));
    CHECK_OK(swiftprox_pair_distance(shape1, pose1, shape2, pose2, &cache, &config, &next->answer));
    next->id1 = id1, next->id2 = id2, next->piece1 = piece1, next->piece2 = piece2;
    expected_count += next->answer.outcome != SWIFTPROX_OUTCOME_BEYOND;
}

/* All tested pairs up to the tolerance, those of one object if it is not null. */
static void ask_all(double tolerance, swiftprox_object_id of)
{
    expected_count = 0;
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j)
            for (int k = 0; is_tested(i, j) && k < objects[i].pieces; ++k)
                for (int l = 0; l < objects[j].pieces; ++l) {
                    double pose[12];
                    const swiftprox_shape *shape;
                    if (of.bits && of.bits != objects[i].id.bits && of.bits != objects[j].id.bits)
                        continue;
                    CHECK_OK(swiftprox_scene_get_piece(scene, objects[j].id, (size_t)l, &shape));
                    CHECK_OK(swiftprox_scene_get_piece_pose(scene, objects[j].id, (uint32_t)l, pose));
                    ask_pair(objects[i].id, k, objects[j].id, l, shape, pose, tolerance);
                }
}

static int agrees(const swiftprox_pair_result *pair, const struct listed *truth)
{
    return pair->object1.bits == truth->id1.bits && pair->object2.bits == truth->id2.bits &&
           pair->piece1 == (uint32_t)truth->piece1 && pair->piece2 == (uint32_t)truth->piece2 &&
           pair->answer.outcome == truth->answer.outcome && pair->answer.lower <= truth->answer.upper &&
           truth->answer.lower <= pair->answer.upper;
}

/* Holds an answer against what is expected, of a verdict against what intersects of that. */
static void compare(const swiftprox_scene_answer *answer, int verdict_only)
{
    size_t at = 0;
    for (size_t i = 0; i < expected_count; ++i) {
        if (verdict_only && expected[i].answer.outcome != SWIFTPROX_OUTCOME_INTERSECTING)
            continue;
        if (!CHECK(at < answer->count && agrees(&answer->pairs[at], &expected[i])))
            return;
        ++at;
    }
    CHECK(at == answer->count);
}

static void query(void)
{
    static const double tolerances[] = {0, 0.1, 0.5, 3, INFINITY};
    const swiftprox_object_id none = {0};
    const int any = count > 0 ? (int)draw((uint32_t)count) : 0;
    swiftprox_scene_query asked;
    swiftprox_scene_answer answer;
    swiftprox_scene_contacts contacts;
    double pose[12];
    swiftprox_scene_query_init(&asked);
    asked.distance_tolerance = tolerances[draw(5)];
    switch (draw(7)) {
    case 0:
        ask_all(0, none);
        CHECK_OK(swiftprox_scene_query_intersection(scene, &asked, &answer));
        compare(&answer, 1);
        break;
    case 1:
        ask_all(asked.distance_tolerance, none);
        asked.detail = (swiftprox_contact_detail)draw(4);
        CHECK_OK(swiftprox_scene_query_contact(scene, &asked, &answer));
        compare(&answer, 0);
        CHECK_OK(swiftprox_scene_get_contacts(scene, &contacts));
        CHECK(contacts.count == (asked.detail != SWIFTPROX_CONTACT_DETAIL_NONE ? answer.count : 0));
        break;
    case 2:
        ask_all(asked.distance_tolerance, none);
        asked.error_budget = 0.5;
        CHECK_OK(swiftprox_scene_query_approximate(scene, &asked, &answer));
        compare(&answer, 0);
        break;
    case 3:
        if (count > 0) {
            ask_all(asked.distance_tolerance, objects[any].id);
            CHECK_OK(swiftprox_scene_query_object(scene, objects[any].id, SWIFTPROX_QUERY_KIND_DISTANCE, &asked, &answer));
            compare(&answer, 0);
        }
        break;
    case 4:
        any_pose(pose, 2);
        expected_count = 0;
        for (int i = 0; i < count; ++i)
            for (int k = 0; k < objects[i].pieces; ++k)
                ask_pair(objects[i].id, k, none, 0, shapes[any % SHAPES], pose, asked.distance_tolerance);
        CHECK_OK(swiftprox_scene_query_placed(scene, shapes[any % SHAPES], pose, SWIFTPROX_QUERY_KIND_DISTANCE, &asked, &answer));
        compare(&answer, 0);
        break;
    default:
        ask_all(asked.distance_tolerance, none);
        CHECK_OK(swiftprox_scene_query_distance(scene, &asked, &answer));
        compare(&answer, 0);
    }
}

static int is_in(swiftprox_object_id list[][2], size_t size, const swiftprox_object_pair *pair)
{
    for (size_t i = 0; i < size; ++i)
        if (list[i][0].bits == pair->object1.bits && list[i][1].bits == pair->object2.bits)
            return 1;
    return 0;
}

static void events(void)
{
    static swiftprox_object_id now[MOST * MOST][2];
    size_t now_count = 0, stayed = 0;
    swiftprox_scene_events changed;
    ask_all(0.25, (swiftprox_object_id){0});
    for (size_t i = 0; i < expected_count; ++i) {
        const swiftprox_object_pair pair = {expected[i].id1, expected[i].id2, 0, 0};
        if (!is_in(now, now_count, &pair)) {
            now[now_count][0] = pair.object1;
            now[now_count++][1] = pair.object2;
            stayed += (size_t)is_in(near, near_count, &pair);
        }
    }
    CHECK_OK(swiftprox_scene_query_events(scene, 0.25, &changed));
    CHECK(changed.began_count == now_count - stayed && changed.ended_count == near_count - stayed);
    for (size_t i = 0; i < changed.began_count; ++i)
        CHECK(is_in(now, now_count, &changed.began[i]) && !is_in(near, near_count, &changed.began[i]));
    for (size_t i = 0; i < changed.ended_count; ++i)
        CHECK(is_in(near, near_count, &changed.ended[i]) && !is_in(now, now_count, &changed.ended[i]));
    memcpy(near, now, sizeof near);
    near_count = now_count;
}

/* ---- changes ---- */

static void add(void)
{
    const swiftprox_shape *pieces[PIECES];
    swiftprox_object_options options;
    if (count == MOST)
        return;
    struct object *object = &objects[count];
    memset(object, 0, sizeof *object);
    object->pieces = 1 + (int)draw(PIECES);
    object->fixed = draw(4) == 0;
    object->groups = 1u << draw(2);
    object->mask = draw(3) == 0 ? 2 : UINT32_MAX;
    swiftprox_object_options_init(&options);
    any_pose(options.pose, 2);
    options.fixed = object->fixed;
    options.groups = object->groups;
    options.mask = object->mask;
    for (int k = 0; k < object->pieces; ++k)
        pieces[k] = shapes[draw(SHAPES)];
    CHECK_OK(swiftprox_scene_add_object(scene, pieces, (size_t)object->pieces, &options, &object->id));
    ++count;
}

static void copy(int any)
{
    if (count == MOST)
        return;
    objects[count] = objects[any];
    memset(objects[count].inactive, 0, sizeof objects[count].inactive);
    CHECK_OK(swiftprox_scene_copy_object(scene, objects[any].id, &objects[count].id));
    ++count;
}

static void remove_one(int any)
{
    CHECK_OK(swiftprox_scene_remove_object(scene, objects[any].id));
    CHECK(swiftprox_scene_remove_object(scene, objects[any].id) == SWIFTPROX_ERROR_HANDLE);
    for (int i = any; i + 1 < count; ++i)
        objects[i] = objects[i + 1];
    --count;
    for (int i = 0; i < count; ++i) {
        for (int j = any; j + 1 < MOST; ++j)
            objects[i].inactive[j] = objects[i].inactive[j + 1];
        objects[i].inactive[count] = 0;
    }
}

static void activate(int any)
{
    const int active = (int)draw(2), all = draw(8) == 0, other = (int)draw((uint32_t)count), whole = draw(2) == 0;
    if (all)
        CHECK_OK((active ? swiftprox_scene_activate_all : swiftprox_scene_deactivate_all)(scene));
    else if (whole)
        CHECK_OK((active ? swiftprox_scene_activate_object : swiftprox_scene_deactivate_object)(scene, objects[any].id));
    else if (other != any)
        CHECK_OK((active ? swiftprox_scene_activate_pair : swiftprox_scene_deactivate_pair)(scene, objects[any].id,
                                                                                           objects[other].id));
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j)
            if (all || (whole ? i == any || j == any : (i == any && j == other) || (i == other && j == any)))
                objects[i].inactive[j] = !active;
}

static void move(int any)
{
    static double poses[12 * MOST];
    swiftprox_object_id ids[MOST];
    size_t moving = 0;
    for (int i = 0; i < MOST; ++i)
        any_pose(poses + 12 * i, 2);
    for (int i = 0; i < count; ++i) {
        ids[i] = objects[i].id;
        moving += !objects[i].fixed;
    }
    switch (draw(4)) {
    case 0:
        CHECK_OK(swiftprox_scene_set_pose(scene, objects[any].id, poses));
        break;
    case 1:
        CHECK_OK(swiftprox_scene_set_poses(scene, ids, poses, (size_t)any));
        break;
    case 2:
        CHECK_OK(swiftprox_scene_set_all_poses(scene, poses, moving));
        break;
    default:
        any_pose(poses, 0.3);
        CHECK_OK(swiftprox_scene_set_piece_pose(scene, objects[any].id, draw((uint32_t)objects[any].pieces), poses));
    }
}

static void choose(int any)
{
    switch (draw(5)) {
    case 0:
        filtered = (int)draw(2);
        CHECK_OK(swiftprox_scene_set_pair_filter(scene, filtered ? likes : NULL, NULL));
        break;
    case 1:
        CHECK_OK(swiftprox_scene_filter_again(scene));
        break;
    case 2:
        if (count >= 4) {
            given_count = 8;
            for (int k = 0; k < 8; ++k)
                given[k] = objects[(any + k * (k % 2 ? 1 : 2)) % count].id;
            for (int k = 0; k < 8; k += 2)
                if (given[k].bits == given[k + 1].bits)
                    given[k + 1] = objects[(any + 1) % count].id.bits == given[k].bits ? objects[any].id
                                                                                       : objects[(any + 1) % count].id;
            CHECK_OK(swiftprox_scene_set_pairs(scene, given, 4));
        }
        break;
    default:
        given_count = -1;
        CHECK_OK(swiftprox_scene_reset_pairs(scene));
    }
}

/* Begins a recording, or ends it and plays it. */
static void record(void)
{
    recorded = !recorded;
    if (recorded) {
        CHECK_OK(swiftprox_scene_record(scene, path));
        return;
    }
    swiftprox_replay *replay;
    swiftprox_replay_step_info step = {.struct_size = sizeof step};
    swiftprox_scene_answer answer;
    CHECK_OK(swiftprox_scene_record(scene, NULL));
    CHECK_OK(swiftprox_replay_open(path, NULL, &replay));
    while (CHECK_OK(swiftprox_replay_read(replay, &step)) && step.has_step) {
        CHECK_OK(swiftprox_replay_change(replay));
        if (step.has_query)
            CHECK_OK(swiftprox_replay_ask(replay, SWIFTPROX_DEFAULT_TOLERANCE, &answer, NULL));
    }
    CHECK(!step.cut_off);
    CHECK_OK(swiftprox_replay_close(replay));
}

static void change(void)
{
    const int any = count > 0 ? (int)draw((uint32_t)count) : 0;
    const uint32_t what = draw(count > 0 ? 24 : 3);
    if (what < 3)
        add();
    else if (what == 3)
        copy(any);
    else if (what == 4)
        remove_one(any);
    else if (what < 12)
        move(any);
    else if (what < 15)
        activate(any);
    else if (what < 18)
        choose(any);
    else if (what == 18) {
        objects[any].fixed = (int)draw(2);
        CHECK_OK(swiftprox_scene_set_fixed(scene, objects[any].id, objects[any].fixed));
    } else if (what == 19) {
        objects[any].groups = 1u << draw(2);
        objects[any].mask = 3;
        CHECK_OK(swiftprox_scene_set_filter(scene, objects[any].id, objects[any].groups, objects[any].mask));
    } else if (what == 20)
        CHECK_OK(swiftprox_scene_set_user_data(scene, objects[any].id, what));
    else if (what == 21)
        CHECK_OK(swiftprox_scene_shrink(scene));
    else if (what == 22)
        record();
    else
        events();
}

int main(int argc, char **argv)
{
    const long calls = argc > 1 ? strtol(argv[1], NULL, 10) : 4000;
    const double halves[SHAPES][3] = {{0.5, 0.3, 0.2}, {0.1, 0.1, 1.5}, {1.2, 1.2, 0.02}};
    snprintf(path, sizeof path, "%s/soak.swiftprox", argc > 2 ? argv[2] : ".");
    for (int i = 0; i < SHAPES; ++i) {
        double corners[24];
        for (int k = 0; k < 24; ++k)
            corners[k] = (k / 3 >> k % 3 & 1 ? 1 : -1) * halves[i][k % 3];
        CHECK_OK(swiftprox_shape_create_from_points(corners, 8, NULL, &shapes[i]));
    }
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (long call = 0; call < calls && check_failures == 0; ++call) {
        change();
        query();
    }
    CHECK_OK(swiftprox_scene_destroy(scene));
    for (int i = 0; i < SHAPES; ++i)
        swiftprox_shape_release(shapes[i]);
    remove(path);
    return check_report("soak");
}
