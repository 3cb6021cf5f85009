/* How long results last, and what memory a scene gives back: the list of a query stays as it is while objects are moved, added,
 * removed, activated and renamed, until the next query. Contacts are of pairs that touch unless the query says otherwise. Run under
 * valgrind it shows that nothing is read that was given back. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "bodies.h"
#include "swiftprox/process.h"
#include "swiftprox/scene.h"

enum { OBJECTS = 60, PAIRS = OBJECTS * (OBJECTS - 1) / 2 };

static const double CORNERS[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

static size_t held; /* bytes of the library's */

static void *take(void *user, size_t size, size_t alignment)
{
    void *const block = aligned_alloc(alignment, size);
    (void)user;
    held += block != NULL ? size : 0;
    return block;
}

static void give_back(void *user, void *memory, size_t size, size_t alignment)
{
    (void)user;
    (void)alignment;
    held -= size;
    free(memory);
}

static swiftprox_object_id add(swiftprox_scene *scene, const swiftprox_shape *shape, double x)
{
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_id id;
    int32_t valid = 0;
    place(options.pose, x, 0, 0);
    CHECK_OK(swiftprox_scene_add_object(scene, &shape, 1, &options, &id));
    CHECK_OK(swiftprox_scene_is_object_valid(scene, id, &valid));
    CHECK(valid == 1);
    return id;
}

/* The objects of a row stand 2 apart, corner to corner, so that each pair's distance is known. */
static void make_row(swiftprox_scene *scene, const swiftprox_shape *shape, swiftprox_object_id *ids)
{
    for (int i = 0; i < OBJECTS; ++i) {
        ids[i] = add(scene, shape, 2.0 * i);
    }
}

/* Whether two results say the same. Behind the last member stand bytes that nobody writes. */
static int same(const swiftprox_pair_result *result, const swiftprox_pair_result *other)
{
    const size_t size = offsetof(swiftprox_pair_result, answer.statistics) + sizeof result->answer.statistics;
    return memcmp(result, other, size) == 0;
}

static void results_stay(const swiftprox_shape *shape)
{
    swiftprox_scene *scene;
    swiftprox_object_id ids[OBJECTS];
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer, found, none;
    double pose[12];
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    make_row(scene, shape, ids);
    CHECK_OK(swiftprox_scene_query_distance(scene, NULL, &answer));
    CHECK(answer.count == PAIRS);
    swiftprox_pair_result *const copy = malloc(answer.count * sizeof *copy);
    memcpy(copy, answer.pairs, answer.count * sizeof *copy);

    /* While the list is read: who is near another object goes away from it, the others' twins and the first objects go. */
    for (size_t i = 0; i < answer.count; ++i) {
        const swiftprox_pair_result *const pair = &answer.pairs[i];
        int32_t valid = 0;
        CHECK_OK(swiftprox_scene_is_object_valid(scene, pair->object1, &valid));
        if (valid == 0) {
            continue;
        }
        place(pose, pair->answer.distance, 0, 0);
        CHECK_OK(swiftprox_scene_set_pose(scene, pair->object1, pose));
        swiftprox_object_info info;
        info.struct_size = sizeof info;
        CHECK_OK(swiftprox_scene_get_object_info(scene, pair->object1, &info));
        info.user_data = i;
        CHECK_OK(swiftprox_scene_set_object_info(scene, pair->object1, &info));
        if (i % 8 == 0) {
            swiftprox_object_id twin;
            CHECK_OK(swiftprox_scene_copy_object(scene, pair->object1, &twin));
            add(scene, shape, 0);
            CHECK_OK(swiftprox_scene_set_pair_active(scene, &twin, NULL, 0));
        }
        if (i % 64 == 0) {
            CHECK_OK(swiftprox_scene_remove_object(scene, pair->object1));
            CHECK(swiftprox_scene_remove_object(scene, pair->object1) == SWIFTPROX_ERROR_HANDLE);
        }
    }
    for (size_t i = 0; i < answer.count; ++i) {
        CHECK(same(&copy[i], &answer.pairs[i]));
    }
    free(copy);

    /* So does the pair at which a query stopped. */
    query.early_exit = 1;
    CHECK_OK(swiftprox_scene_query_distance(scene, &query, &found));
    CHECK(found.found != NULL);
    const swiftprox_pair_result stopped_at = *found.found;
    CHECK_OK(swiftprox_scene_remove_object(scene, found.found->object1));
    add(scene, shape, 0);
    CHECK(same(&stopped_at, found.found));

    /* A refused query says nothing. */
    query.error_budget = -1;
    CHECK(swiftprox_scene_query_contact(scene, &query, &none) == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(none.count == 0 && none.pairs == NULL && none.found == NULL);
    CHECK_OK(swiftprox_scene_destroy(scene));
}

static void contacts_touch(const swiftprox_shape *shape)
{
    swiftprox_scene *scene;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    const swiftprox_object_id a = add(scene, shape, 0), b = add(scene, shape, 1);
    add(scene, shape, 1.5);
    for (int i = 0; i < 2; ++i) {
        CHECK_OK(swiftprox_scene_query_contact(scene, i == 0 ? NULL : &query, &answer));
        /* a touches b, b overlaps the third, which a is away from. */
        CHECK(answer.count == 2 && answer.pairs[0].object1.bits == a.bits && answer.pairs[0].object2.bits == b.bits);
        CHECK(answer.pairs[0].answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING);
    }
    CHECK_OK(swiftprox_scene_query_distance(scene, &query, &answer));
    CHECK(answer.count == 3);
    query.max_distance = 1;
    CHECK_OK(swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK(answer.count == 3);
    CHECK_OK(swiftprox_scene_destroy(scene));
}

/* Two rows of three cubes with gaps: the first two are apart in two directions, the nearest two in one, by 0.25. */
static void one_result_for_two_objects(void)
{
    const swiftprox_piece_pairs choices[] = {SWIFTPROX_PIECE_PAIRS_EVERY, SWIFTPROX_PIECE_PAIRS_FIRST, SWIFTPROX_PIECE_PAIRS_NEAREST};
    const size_t counts[] = {9, 1, 1};
    const double half[3] = {0.5, 0.5, 0.5};
    const swiftprox_shape *cube;
    swiftprox_scene *scene;
    swiftprox_object_id ids[2];
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    CHECK_OK(swiftprox_shape_create_box(half, 0, &cube));
    const swiftprox_shape *const row[3] = {cube, cube, cube};
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (int i = 0; i < 2; ++i) {
        CHECK_OK(swiftprox_scene_add_object(scene, row, 3, &options, &ids[i]));
        for (uint32_t piece = 0; piece < 3; ++piece) {
            double pose[12];
            place(pose, 2.0 * piece + 1.5 * i, 1.25 * i, 0);
            CHECK_OK(swiftprox_scene_set_piece_pose(scene, ids[i], piece, pose));
        }
    }
    for (int k = 0; k < 3; ++k) {
        swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
        swiftprox_scene_answer answer;
        CHECK(query.piece_pairs == SWIFTPROX_PIECE_PAIRS_EVERY);
        query.piece_pairs = choices[k];
        CHECK_OK(swiftprox_scene_query_distance(scene, &query, &answer));
        CHECK(answer.count == counts[k] && !answer.intersecting);
        const swiftprox_pair_result nearest = answer.pairs[0];
        if (choices[k] == SWIFTPROX_PIECE_PAIRS_NEAREST) {
            CHECK(nearest.piece1 == 1 && nearest.piece2 == 0 && nearest.answer.lower <= 0.25 && nearest.answer.upper >= 0.25);
        } else {
            CHECK(nearest.piece1 == 0 && nearest.piece2 == 0 && nearest.answer.lower > 0.5);
        }
    }
    CHECK_OK(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(cube);
}

static void memory_comes_back(const swiftprox_shape *shape)
{
    swiftprox_scene *scene;
    swiftprox_object_id ids[OBJECTS];
    swiftprox_scene_answer answer;
    swiftprox_scene_statistics before, after;
    const size_t without = held;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    make_row(scene, shape, ids);
    const size_t objects = held - without;
    CHECK_OK(swiftprox_scene_query_distance(scene, NULL, &answer));
    const size_t most = held - without;
    CHECK(most > objects + PAIRS * sizeof(swiftprox_pair_result));

    /* The results go; what the pairs remember stays, so that the next query makes as few steps. Without results none is given
     * again: each pair is tested. */
    CHECK_OK(swiftprox_scene_query_distance(scene, NULL, &answer));
    CHECK_OK(swiftprox_scene_shrink(scene));
    CHECK_OK(swiftprox_scene_reset_statistics(scene));
    CHECK_OK(swiftprox_scene_query_distance(scene, NULL, &answer));
    CHECK_OK(swiftprox_scene_get_statistics(scene, &before));
    CHECK_OK(swiftprox_scene_shrink(scene));
    CHECK(held - without < most - PAIRS * sizeof(swiftprox_pair_result));
    CHECK_OK(swiftprox_scene_reset_statistics(scene));
    CHECK_OK(swiftprox_scene_query_distance(scene, NULL, &answer));
    CHECK_OK(swiftprox_scene_get_statistics(scene, &after));
    CHECK(answer.count == PAIRS && memcmp(&before, &after, sizeof before) == 0);

    /* And with the objects their pairs. */
    for (int i = 1; i < OBJECTS; ++i) {
        CHECK_OK(swiftprox_scene_remove_object(scene, ids[i]));
    }
    CHECK(held - without > objects + PAIRS * sizeof(swiftprox_pair_cache));
    CHECK_OK(swiftprox_scene_shrink(scene));
    CHECK_OK(swiftprox_scene_shrink(scene));
    CHECK(held - without <= objects);
    CHECK_OK(swiftprox_scene_query_distance(scene, NULL, &answer));
    CHECK(answer.count == 0);
    CHECK_OK(swiftprox_scene_destroy(scene));
    CHECK(held == without);
}

/* A pair's cache is plain bytes: put back, it gives the same bits again. */
static void caches_go_back(const swiftprox_shape *shape)
{
    swiftprox_pair_cache cache = {{0}}, kept;
    swiftprox_pair_answer first[8], second[8];
    double here[12], there[12];
    memset(first, 0, sizeof first);
    memset(second, 0, sizeof second);
    place(here, 0, 0, 0);
    place(there, 2, 0, 0);
    CHECK_OK(
        swiftprox_pair_distance((swiftprox_placed){shape, here}, (swiftprox_placed){shape, there}, &cache, NULL, &first[0]));
    kept = cache;
    for (int round = 0; round < 2; ++round) {
        swiftprox_pair_answer *const answers = round == 0 ? first : second;
        for (int i = 0; i < 8; ++i) {
            place(there, 2 - 0.2 * i, 0, 0);
            there[7] = 0.3 * i;
            CHECK_OK(swiftprox_pair_contact((swiftprox_placed){shape, here}, (swiftprox_placed){shape, there}, &cache, NULL,
                                            &answers[i]));
        }
        cache = kept;
    }
    CHECK(memcmp(first, second, sizeof first) == 0);
}

int main(void)
{
    const swiftprox_shape *shape;
    CHECK_OK(swiftprox_library_set_allocator(take, give_back, NULL));
    if (!CHECK_OK(swiftprox_shape_create_from_points(CORNERS, 4, NULL, &shape)))
        return check_report("results");
    CHECK_OK(swiftprox_shape_prepare(shape, NULL, NULL));
    results_stay(shape);
    contacts_touch(shape);
    one_result_for_two_objects();
    memory_comes_back(shape);
    caches_go_back(shape);
    swiftprox_shape_release(shape);
    return check_report("results");
}
