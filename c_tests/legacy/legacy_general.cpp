/*
 * Bodies that are not convex, from files: Add_General_Object takes them apart itself. Their distances are those of the surfaces,
 * their hollows stay open, and features are numbered as in the file.
 */
#include "legacy_solids.h"

namespace {

Solid turned_round(Solid solid)
{
    std::size_t at = 0;
    for (std::size_t face = 0; face < solid.valences.size(); ++face) {
        const std::size_t end = at + static_cast<std::size_t>(solid.valences[face]);
        std::reverse(solid.faces.begin() + static_cast<std::ptrdiff_t>(at), solid.faces.begin() + static_cast<std::ptrdiff_t>(end));
        at = end;
    }
    return solid;
}

/* A cube in the notch is free, 0.25 from the one wall and 0.35 from the other; where it enters a wall it intersects. */
void notch(const Folder& folder, const Solid& solid, bool has_broad_phase)
{
    Messages messages;
    SWIFT_Scene scene(has_broad_phase);
    const BoxMesh box(0.25, 0.25, 0.25);
    int body = -1, cube = -1, pairs, *ids, *counts, *types, *features;
    SWIFT_Real *distances, *points, *normals;
    CHECK(scene.Add_General_Object(folder.write("general.poly", solid.file(3)).c_str(), body) && body == 0);
    CHECK(box.add(scene, cube));
    move_to(scene, cube, 1.5, 1.6, 0);
    CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals, &types,
                                             &features));
    CHECK(pairs == 1 && counts[0] >= 1 && is_near(distances[0], 0.25) && is_near(points[0], 1) && is_near3(normals, -1, 0, 0));
    for (int k = 1; k < counts[0]; ++k) {
        CHECK(distances[k] > distances[k - 1]);
    }
    CHECK(types[0] == SWIFT_FACE ? features[0] == 5 : types[0] == SWIFT_EDGE || types[0] == SWIFT_VERTEX);
    /* The features of the nearest contact have numbers of the file, and are there. */
    const int used = types[0] == SWIFT_EDGE ? 2 : 1;
    for (int i = 0; i < used; ++i) {
        CHECK(features[i] >= 0 && features[i] < 12);
    }
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1 && is_near(distances[0], 0.25));
    move_to(scene, cube, 1.2, 1.6, 0);
    CHECK(scene.Query_Intersection(false, pairs, &ids) && pairs == 1);
    move_to(scene, cube, 1.25, 1.6, 0);
    CHECK(scene.Query_Intersection(false, pairs, &ids) && pairs == 1);
    CHECK(messages.take().empty());
    /* Of the surface, as of old: 14 long in all, by the areas of its sides. */
    SWIFT_Real x, y, z;
    scene.Get_Center_Of_Mass(body, x, y, z);
    CHECK(is_near(x, 12.0 / 14) && is_near(y, 12.0 / 14) && is_near(z, 0));
}

/* A copy, with an input transform as well, has the pieces and the numbers of the original. */
void copies(const Folder& folder)
{
    Messages messages;
    SWIFT_Scene scene(false);
    const std::string file = folder.write("general.poly", extruded(L_POLYGON, 6).file(0 + 1));
    const BoxMesh box(0.25, 0.25, 0.25);
    const Rotation half(2, 4 * std::atan(1.0));
    const SWIFT_Translation away = {2, 2, 0};
    int body = -1, copy = -1, turned = -1, cube = -1, pairs, *ids, *types, *features, *counts;
    SWIFT_Real *distances, *points, *normals;
    CHECK(scene.Add_General_Object(file.c_str(), body) && scene.Copy_Object(body, copy));
    CHECK(scene.Add_Object(NULL, NULL, 0, 0, turned, false, half.m, away, 1, BOX_SETTING_DEFAULT, 0, 0, NULL, body));
    CHECK(box.add(scene, cube));
    for (int id = copy; id <= turned; ++id) {
        scene.Deactivate();
        scene.Activate(id, cube);
        /* The turned one has its notch where x and y are below 1. */
        move_to(scene, cube, id == copy ? 1.4 : 0.6, id == copy ? 1.5 : 0.5, 0);
        CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals, &types,
                                                 &features));
        CHECK(pairs == 1 && std::fabs(distances[0] - 0.15) < 1e-6);
        CHECK(features[0] >= 0);
    }
    CHECK(messages.take().empty());
    int hull = -1;
    scene.Set_Take_Hull(true);
    CHECK(scene.Add_General_Object(file.c_str(), hull));
    scene.Deactivate();
    scene.Activate(hull, cube);
    move_to(scene, cube, 1.4, 1.5, 0);
    CHECK(scene.Query_Intersection(false, pairs, &ids));
}

/* What is no closed surface is refused in the words of old, and the id stays. */
void refused(const Folder& folder)
{
    Messages messages;
    SWIFT_Scene scene(false);
    int id = 9;
    Solid open = extruded(L_POLYGON, 6);
    open.valences.pop_back();
    CHECK(!scene.Add_General_Object(folder.write("open.poly", open.file(3)).c_str(), id) && id == 9);
    std::string said = messages.take();
    CHECK(said.find("Error: The mesh is not closed --\n       all edges must belong to exactly two triangles\n") == 0);
    CHECK(said.find("Error (Add_General_Object obj 0 piece 0): Mesh creation failed\n") != std::string::npos);
    CHECK(said.find("SWIFTPROX") == std::string::npos);
    Solid third = extruded(L_POLYGON, 6);
    const int flap[3] = {0, 1, 9};
    third.add_face(3, flap);
    CHECK(!scene.Add_General_Object(folder.write("third.poly", third.file(3)).c_str(), id) && id == 9);
    CHECK(messages.has("Error: The mesh is not a 2-manifold --\n"));
    /* One face of a closed mesh the other way round. */
    Solid wrong = extruded(L_POLYGON, 6);
    std::reverse(wrong.faces.end() - 4, wrong.faces.end());
    CHECK(!scene.Add_General_Object(folder.write("wrong.poly", wrong.file(3)).c_str(), id) && id == 9);
    CHECK(messages.has("the faces are not consistently oriented"));
}

} // namespace

int main(int argc, char** argv)
{
    const Folder folder(argc, argv);
    const Solid solid = extruded(L_POLYGON, 6);
    for (int i = 0; i < 2; ++i) {
        notch(folder, solid, i == 1);
        notch(folder, turned_round(solid), i == 1);
    }
    copies(folder);
    refused(folder);
    return check_report("legacy_general");
}
