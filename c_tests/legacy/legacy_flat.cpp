/*
 * A program that passes a flat triangle with two faces, and one that has a POLY file beside it; and flat polygons of any
 * position. Also a fixed object with an input transform and face valences.
 */
#include "legacy_test.h"

namespace {

void flat_triangle(const Folder& folder)
{
    const std::string box = folder.write("flat_box.poly", box_file(BoxMesh(0.5, 0.5, 0.5), true));
    SWIFT_Real corners[] = {0, 0, 0, 2, 0, 0, 0, 2, 0};
    int sides[] = {0, 2, 1, 0, 1, 2};
    SWIFT_Scene scene(true, false);
    int triangle = -1, solid = -1;
    CHECK(scene.Add_Convex_Object(corners, sides, 3, 2, triangle));
    CHECK(scene.Add_General_Object(box.c_str(), solid));
    CHECK(triangle == 0 && solid == 1);
    scene.Deactivate();
    scene.Activate(triangle);

    move_to(scene, solid, 0.5, 0.5, 1);
    int pairs, *ids, *counts, *types, *feature_ids;
    SWIFT_Real *distances, *points, *normals;
    CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals, &types,
                                             &feature_ids));
    CHECK(pairs == 1 && counts[0] == 1 && is_near(distances[0], 0.5));
    CHECK(is_near3(normals, 0, 0, -1) && is_near(points[2], 0) && is_near(points[5], -0.5));
    /* From the other side: the other face, or the same edges. */
    move_to(scene, solid, 0.5, 0.5, -1);
    CHECK(!scene.Query_Contact_Determination(false, 1, pairs, &ids, &counts, &distances, &points, &normals));
    CHECK(pairs == 1 && is_near(distances[0], 0.5) && is_near3(normals, 0, 0, 1));
    move_to(scene, solid, 0.5, 0.5, 0.25);
    CHECK(scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals));
    CHECK(pairs == 1 && counts[0] == -1);
    /* In its plane, beside it. */
    move_to(scene, solid, -1.5, 0.5, 0);
    CHECK(!scene.Query_Exact_Distance(false, 2, pairs, &ids, &distances));
    CHECK(pairs == 1 && is_near(distances[0], 1));
}

/* Polygons along each axis and askew: planar in one coordinate, or not exactly planar any more. */
void flat_polygons()
{
    const SWIFT_Real corners[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    const int sides[] = {0, 1, 2, 3, 3, 2, 1, 0}, valences[] = {4, 4};
    const BoxMesh box(0.5, 0.5, 0.5);
    SWIFT_Scene scene(false, true);
    int solid;
    CHECK(box.add(scene, solid));
    for (int i = 0; i < 3; ++i) {
        const Rotation turn(i == 2 ? 2 : i, i == 2 ? 0.7 : 2 * std::atan(1.0));
        int polygon = -1;
        CHECK(scene.Add_Convex_Object(corners, sides, 4, 2, polygon, DEFAULT_FIXED, turn.m, DEFAULT_TRANSLATION, DEFAULT_SCALE,
                                      DEFAULT_BOX_SETTING, DEFAULT_BOX_ENLARGE_REL, DEFAULT_BOX_ENLARGE_ABS, valences));
        scene.Deactivate();
        scene.Activate(solid, polygon);
        /* Its normal was z; it is turned into y, x and z. */
        const double normal[3] = {i == 1 ? 1.0 : 0, i == 0 ? 1.0 : 0, i == 2 ? 1.0 : 0};
        move_to(scene, solid, 2 * normal[0], 2 * normal[1], 2 * normal[2]);
        int pairs, *ids;
        SWIFT_Real* distances;
        CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances));
        CHECK(pairs == 1 && is_near(distances[0], 1.5));
    }
    /* And about two axes, with a scale. */
    const Rotation turn(0, 0.3);
    int askew = -1;
    CHECK(scene.Add_Object(corners, sides, 4, 2, askew, false, turn.m, DEFAULT_TRANSLATION, static_cast<SWIFT_Real>(0.7), 0, 0, 0,
                           valences));
    SWIFT_Real x, y, z;
    scene.Get_Center_Of_Mass(askew, x, y, z);
    CHECK(is_near(x, 0) && is_near(y, 0) && is_near(z, 0));
}

void fixed_object()
{
    const BoxMesh box(0.5, 0.5, 0.5);
    SWIFT_Scene scene(true, true);
    const Rotation turn(2, std::atan(1.0));
    const SWIFT_Real away[3] = {10, 0, 0};
    int still = -1, moving = -1, other = -1;
    CHECK(scene.Add_Convex_Object(box.vertices, box.quads, 8, 6, still, true, turn.m, away, 2, BOX_SETTING_DYNAMIC,
                                  static_cast<SWIFT_Real>(0.1), static_cast<SWIFT_Real>(0.1), box.valences));
    CHECK(box.add(scene, moving));
    CHECK(scene.Add_Convex_Object(box.vertices, box.triangles, 8, 12, other, true));
    /* Twice as large, turned by an eighth, 10 away: from 10 - sqrt(2) on. Points are in the frame after that. */
    int pairs, *ids;
    SWIFT_Real *distances, *points, *normals;
    CHECK(scene.Query_Contact_Determination(false, 20, pairs, &ids, &distances, &points, &normals));
    CHECK(pairs == 2); /* the two fixed ones make no pair */
    CHECK(ids[0] == still && ids[1] == moving && ids[2] == moving && ids[3] == other);
    CHECK(is_near(distances[0], 9.5 - std::sqrt(2.0)) && is_same(distances[1], -1));
    CHECK(is_near(points[0], 10 - std::sqrt(2.0)) && is_near(points[3], 0.5) && is_near3(normals, 1, 0, 0));
    /* A fixed object moves if it is told to, one by one. */
    move_to(scene, still, 0, 0, 5);
    const SWIFT_Real one[12] = {1, 0, 0, -3, 0, 1, 0, 0, 0, 0, 1, 0};
    scene.Set_All_Object_Transformations(one);
    CHECK(!scene.Query_Exact_Distance(false, 20, pairs, &ids, &distances));
    CHECK(pairs == 2 && is_near(distances[1], 2) && distances[0] > 11);
}

} // namespace

int main(int argc, char** argv)
{
    flat_triangle(Folder(argc, argv));
    flat_polygons();
    fixed_object();
    return check_report("legacy_flat");
}
