/*
 * The macros that choose, each program with its own: SWIFT_LEGACY_VERSION 1 or 2, with which a fifth argument NULL is no riddle;
 * SWIFT_LEGACY_QUIET; SWIFT_LEGACY_ALL_PAIRS; SWIFT_DEBUG with version 1.
 */
#if SWIFT_LEGACY_VERSION == 1
#define SWIFT_DEBUG
#else
#define SWIFT_LEGACY_QUIET
#define SWIFT_LEGACY_ALL_PAIRS
#endif

#include "legacy_test.h"

int main()
{
    Messages messages;
    const BoxMesh box(0.5, 0.5, 0.5);
    SWIFT_Scene scene;
    int first = -1, second = -1;
    CHECK(box.add(scene, first) && box.add(scene, second));
    move_to(scene, second, 9, 0, 0);
    int pairs = -1, *ids;
    SWIFT_Real *points, *normals, *distances;
#if SWIFT_LEGACY_VERSION == 1
    CHECK(!scene.Query_Contact_Determination(false, 8, pairs, &ids, NULL, &points, &normals, NULL));
    CHECK(pairs == 1 && is_near3(normals, -1, 0, 0));
    CHECK(!scene.Query_Exact_Distance(false, 8, pairs, &ids, &distances) && pairs == 1);
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 0);
    scene.Activate(0, 0);
    CHECK(messages.take() == "Warning: object ids equal given to Activate(id1,id2): No effect\n");
    CHECK(!scene.Delete_Object(4) && !messages.take().empty());
#else
    CHECK(!scene.Query_Contact_Determination(false, 9, pairs, &ids, NULL, &distances, &points, &normals));
    CHECK(pairs == 1 && is_near(distances[0], 8) && is_near3(normals, -1, 0, 0));
    CHECK(!scene.Query_Exact_Distance(false, 8, pairs, &ids, &distances) && pairs == 0);
    /* With the broad phase on, its boxes apart. */
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1);
    scene.Activate(0, 0);
    CHECK(!scene.Delete_Object(4) && !scene.Add_General_Object("there is no such file", first));
    CHECK(messages.take().empty());
#endif
    return check_report("legacy_macros");
}
