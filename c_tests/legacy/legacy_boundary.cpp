/* Open surfaces, which SWIFT_ALLOW_BOUNDARY lets in: defined here as an old SWIFT_config.h would. A tub has room in it. */
#define SWIFT_ALLOW_BOUNDARY

#include "legacy_test.h"

int main(int argc, char** argv)
{
    const Folder folder(argc, argv);
    const BoxMesh tub(1, 1, 1), probe(0.25, 0.25, 0.25);
    std::string text = box_file(tub, true);
    /* Without the last face, x = 1, and one less in the counts. */
    text = text.substr(0, text.rfind("\n4 ") + 1);
    text.replace(text.find("8 6"), 3, "8 5");
    SWIFT_Scene scene(false);
    int open = -1, cube = -1, pairs, *ids;
    SWIFT_Real* distances;
    CHECK(scene.Add_General_Object(folder.write("tub.poly", text).c_str(), open));
    CHECK(probe.add(scene, cube));
    move_to(scene, cube, 0.5, 0.25, 0);
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1 && is_near(distances[0], 0.5));
    move_to(scene, cube, 1.5, 0, 0);
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1);
    CHECK(is_near(distances[0], std::sqrt(0.75 * 0.75 + 0.25 * 0.25)));
    move_to(scene, cube, -1, 0, 0);
    CHECK(scene.Query_Intersection(false, pairs, &ids) && pairs == 1);
    return check_report("legacy_boundary");
}
