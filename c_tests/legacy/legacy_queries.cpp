/* Every query with its defaults: tolerances, early exit, intervals, arrays that the program may write into, boxes. */
#include "legacy_test.h"

namespace {

/* Boxes of side 1 in a row: 0 and 1 overlap, 2 is 1 from 1, 3 is 3 from 2. */
void row(SWIFT_Scene& scene)
{
    const BoxMesh box(0.5, 0.5, 0.5);
    const double xs[4] = {0, 0.5, 2.5, 6.5};
    for (int i = 0; i < 4; ++i) {
        int id;
        CHECK(box.add(scene, id));
        move_to(scene, id, xs[i], 0, 0);
    }
}

void tolerances()
{
    SWIFT_Scene scene(false);
    row(scene);
    int pairs, *ids, *counts;
    SWIFT_Real *distances, *errors;
    /* SWIFT 1.x and the query of both: pairs at the tolerance are listed; a negative one is 0, intersecting pairs always. */
    CHECK(scene.Query_Exact_Distance(false, 1, pairs, &ids, &distances) && pairs == 2 && is_same(distances[0], -1));
    CHECK(ids[2] == 1 && ids[3] == 2 && is_near(distances[1], 1));
    CHECK(scene.Query_Exact_Distance(false, -3, pairs, &ids, &distances) && pairs == 1);
    CHECK(scene.Query_Contact_Determination(false, 1, pairs, &ids, &distances) && pairs == 2);
    CHECK(scene.Query_Contact_Determination(false, 1, pairs, &ids) && pairs == 2);
    CHECK(scene.Query_Approximate_Distance(false, 1, 0, pairs, &ids, &distances, &errors) && pairs == 2);
    CHECK(is_same(distances[0], -1) && is_same(errors[0], 0) && distances[1] <= 1 && distances[1] + errors[1] >= 1);
    /* SWIFT++: they are not. */
    CHECK(scene.Query_Contact_Determination(false, 1, pairs, &ids, &counts, &distances) && pairs == 1 && counts[0] == -1);
    CHECK(scene.Query_Approximate_Distance(false, 1, 0, 0, pairs, &ids, &distances) && pairs == 1);
    CHECK(scene.Query_Tolerance_Verification(false, 1, pairs, &ids) && pairs == 1);
    CHECK(scene.Query_Tolerance_Verification(false, static_cast<SWIFT_Real>(1.001), pairs, &ids) && pairs == 2);
    CHECK(scene.Query_Tolerance_Verification(false, 0, pairs, &ids) && pairs == 1 && ids[0] == 0 && ids[1] == 1);
    CHECK(scene.Query_Tolerance_Verification(false, -1, pairs, &ids) && pairs == 1);
    CHECK(scene.Query_Tolerance_Verification(false, SWIFT_INFINITY, pairs, &ids) && pairs == 6);
    /* True for pairs that are near, also where none intersects. */
    scene.Deactivate(0, 1);
    CHECK(scene.Query_Tolerance_Verification(false, 2, pairs, &ids) && pairs == 2);
    CHECK(scene.Query_Tolerance_Verification(true, 2, pairs, &ids) && pairs == 0);
    CHECK(!scene.Query_Tolerance_Verification(true, static_cast<SWIFT_Real>(0.5), pairs, &ids) && pairs == 0);
    CHECK(!scene.Query_Exact_Distance(false, 2, pairs, &ids, &distances) && pairs == 2);
    /* Early exit where nothing intersects: all that there is. */
    CHECK(!scene.Query_Exact_Distance(true, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 5);
    CHECK(!scene.Query_Intersection(true, pairs, &ids) && pairs == 0);
    scene.Activate();
    CHECK(scene.Query_Exact_Distance(true, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 0);
    CHECK(scene.Query_Approximate_Distance(true, 9, 0, pairs, &ids, &distances, &errors) && pairs == 0);
    CHECK(scene.Query_Approximate_Distance(true, 9, 0, 0, pairs, &ids, &distances) && pairs == 0);
    /* No number is refused, and nothing is listed. */
    Messages messages;
    const SWIFT_Real nan = std::numeric_limits<SWIFT_Real>::quiet_NaN();
    CHECK(!scene.Query_Exact_Distance(false, nan, pairs, &ids, &distances) && pairs == 0 && messages.has("Error (Query): "));
    CHECK(!scene.Query_Approximate_Distance(false, 1, nan, pairs, &ids, &distances, &errors) && pairs == 0 && !messages.take().empty());
    /* Pointers that are NULL ask for nothing. */
    CHECK(scene.Query_Intersection(false, pairs, NULL) && pairs == 1);
    CHECK(scene.Query_Exact_Distance(false, 1, pairs, &ids, NULL) && scene.Query_Tolerance_Verification(false, 1, pairs, NULL));
    CHECK(scene.Query_Approximate_Distance(false, 1, 0, pairs, &ids, NULL, NULL));
    int** const no_counts = NULL;
    CHECK(scene.Query_Contact_Determination(false, 1, pairs, &ids, no_counts) && pairs == 1);
    CHECK(messages.take().empty());
}

void intervals()
{
    SWIFT_Scene scene(false);
    row(scene);
    int pairs, *ids;
    SWIFT_Real *distances, *errors;
    const SWIFT_Real error = static_cast<SWIFT_Real>(0.125);
    scene.Query_Approximate_Distance(false, SWIFT_INFINITY, error, pairs, &ids, &distances, &errors);
    const double truth[6] = {-1, 1.5, 1, 5.5, 5, 3};
    CHECK(pairs == 6);
    for (int k = 0; k < 6; ++k) {
        CHECK(distances[k] <= truth[k] && truth[k] <= static_cast<double>(distances[k]) + errors[k] && errors[k] <= error);
    }
    /* The errors are what the intervals are wide, and no more: ten times as much would still be below what was asked for. */
    for (int k = 1; k < 6; ++k) {
        const double width = scene.Get_Answer(k)->upper - distances[k];
        CHECK(errors[k] >= width && errors[k] <= width * (1 + 1e-6));
    }
    scene.Query_Approximate_Distance(false, SWIFT_INFINITY, 0, error, pairs, &ids, &distances);
    for (int k = 1; k < 6; ++k) {
        CHECK(std::fabs(distances[k] - truth[k]) <= error * truth[k]);
    }
    /* What swiftprox says of each. */
    scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances);
    for (int k = 0; k < 6; ++k) {
        const swiftprox_pair_answer* answer = scene.Get_Answer(k);
        CHECK(answer != NULL && (answer->outcome == SWIFTPROX_OUTCOME_INTERSECTING) == (k == 0));
        CHECK(k == 0 || (answer->lower <= truth[k] && truth[k] <= answer->upper && is_near(answer->distance, distances[k])));
    }
    /* How deep they are: the boxes of side 1 are half a side off. */
    swiftprox_depth_answer depth;
    CHECK(scene.Get_Depth(0, depth) && depth.lower <= 0.5 && depth.upper >= 0.5 && is_near(depth.depth, 0.5));
    CHECK(is_near(depth.normal[0], -1) && is_near(depth.normal[1], 0));
    CHECK(scene.Get_Depth(1, depth) && depth.outcome == SWIFTPROX_OUTCOME_SEPARATED);
    Messages messages;
    CHECK(!scene.Get_Depth(6, depth) && messages.has("Error (Get_Depth): the last query has no entry 6"));
    scene.Delete_Object(0);
    CHECK(!scene.Get_Depth(0, depth) && messages.has("Error (Get_Depth): "));
    CHECK(scene.Get_Answer(6) == NULL && scene.Get_Answer(-1) == NULL);
    CHECK(scene.Get_Native_Scene() != NULL);
    int32_t is_valid = 0;
    CHECK_OK(swiftprox_scene_is_object_valid(scene.Get_Native_Scene(), scene.Get_Native_Object(3), &is_valid));
    CHECK(is_valid == 1);
    CHECK_OK(swiftprox_scene_is_object_valid(scene.Get_Native_Scene(), scene.Get_Native_Object(4), &is_valid));
    CHECK(is_valid == 0);
}

/* Of a pair the lower id comes first, and what is said of it. The object created later may have taken over the lower one. */
void an_id_used_again()
{
    SWIFT_Scene scene(false);
    const BoxMesh large(1, 1, 1), small(0.5, 0.5, 0.5);
    int id, pairs, *ids, *types, *features;
    SWIFT_Real *distances, *points, *normals;
    CHECK(large.add(scene, id) && small.add(scene, id) && scene.Delete_Object(0) && large.add(scene, id) && id == 0);
    move_to(scene, 0, 10, 0, 0);
    move_to(scene, 1, 13, 0, 0);
    CHECK(!scene.Query_Contact_Determination(false, 2, pairs, &ids, &distances, &points, &normals, &types, &features) && pairs == 1);
    CHECK(ids[0] == 0 && ids[1] == 1 && is_near(distances[0], 1.5));
    CHECK(is_near3(normals, -1, 0, 0) && is_near(points[0], 1) && is_near(points[3], -0.5));
}

void arrays()
{
    SWIFT_Scene scene(false);
    row(scene);
    int pairs, *ids, *pids, *types, *feature_ids;
    SWIFT_Real *distances, *points, *normals;
    scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &distances, &points, &normals, &pids, &types, &feature_ids);
    CHECK(pairs == 6);
    /* The program may write into all of them, and they stay when objects come and go. */
    int id;
    const BoxMesh box(0.5, 0.5, 0.5);
    CHECK(box.add(scene, id) && scene.Delete_Object(id) && scene.Delete_Object(3));
    int total = 0;
    for (int k = 0; k < pairs; ++k) {
        CHECK(pids[2 * k] == 0 && pids[2 * k + 1] == 0);
        for (int side = 0; side < 2; ++side) {
            total += types[2 * k + side] == SWIFT_EDGE ? 2 : 1;
            ids[2 * k + side] = pids[2 * k + side] = types[2 * k + side] = -9;
        }
        distances[k] = -9;
        std::fill(points + 6 * k, points + 6 * k + 6, static_cast<SWIFT_Real>(-9));
        std::fill(normals + 3 * k, normals + 3 * k + 3, static_cast<SWIFT_Real>(-9));
    }
    std::fill(feature_ids, feature_ids + total, -9);
    CHECK(scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &distances, &points, &normals, &pids));
    CHECK(pairs == 3 && ids[0] == 0 && ids[1] == 1 && is_same(distances[0], -1) && is_near(distances[1], 1.5));
    CHECK(is_near(points[6], 0.5) && is_near(points[9], -0.5) && is_near3(normals + 3, -1, 0, 0) && pids[5] == 0);
}

/* With the broad phase on, a tolerance lists all pairs within it; without one, those whose enlarged boxes overlap. */
void boxes()
{
    const BoxMesh box(0.5, 0.5, 0.5);
    const double half = std::sqrt(0.75);
    for (int setting = BOX_SETTING_DEFAULT; setting <= BOX_SETTING_CHOOSE; ++setting) {
        SWIFT_Scene scene;
        int first, second, pairs, *ids;
        SWIFT_Real* distances;
        CHECK(scene.Add_Convex_Object(box.vertices, box.triangles, 8, 12, first, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION,
                                      DEFAULT_SCALE, setting, static_cast<SWIFT_Real>(0.5), static_cast<SWIFT_Real>(0.25)));
        CHECK(box.add(scene, second));
        /* A cube is half the box's diagonal wide on each side, the tight one half its side; both are enlarged. */
        const double reach = (setting <= BOX_SETTING_CUBE ? half : 0.5) + 0.5 * half + 0.25 + half;
        for (int beyond = 0; beyond < 2; ++beyond) {
            const double x = reach + (beyond == 0 ? -0.001 : 0.001);
            move_to(scene, second, 0, -x, 0);
            CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1 - beyond);
            CHECK(!scene.Query_Exact_Distance(false, 10, pairs, &ids, &distances) && pairs == 1 && is_near(distances[0], x - 1));
            CHECK(!scene.Query_Tolerance_Verification(false, static_cast<SWIFT_Real>(x - 1.001), pairs, &ids));
            CHECK(scene.Query_Tolerance_Verification(false, static_cast<SWIFT_Real>(x - 0.999), pairs, &ids) && pairs == 1);
        }
        /* Boxes move with their objects, all at once as well, and turn with them. */
        SWIFT_Real RT[24] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0};
        scene.Set_All_Object_Transformations(RT);
        CHECK(scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1);
        RT[19] = 9;
        scene.Set_All_Object_Transformations(RT);
        CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 0);
    }
    /* A tight box turns: a rod along x reaches far only there. */
    const BoxMesh rod(4, 0.5, 0.5);
    SWIFT_Scene scene;
    int first, second, pairs, *ids;
    SWIFT_Real* distances;
    CHECK(scene.Add_Convex_Object(rod.vertices, rod.triangles, 8, 12, first, true));
    CHECK(scene.Add_Convex_Object(box.vertices, box.triangles, 8, 12, second, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, 1,
                                  BOX_SETTING_DYNAMIC));
    move_to(scene, second, 0, 3, 0);
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 0);
    scene.Set_Object_Transformation(first, Rotation(2, std::atan(1.0)).m, DEFAULT_TRANSLATION);
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1);
}

} // namespace

int main()
{
    tolerances();
    intervals();
    an_id_used_again();
    arrays();
    boxes();
    return check_report("legacy_queries");
}
