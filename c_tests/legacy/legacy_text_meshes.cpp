/*
 * Convex meshes as old programs have them: written with a few decimals, computed in floats far from the origin, or inside out. The
 * old libraries took all of these unseen and answered rightly; a mesh with a dent is refused and told what can be done.
 */
#include "legacy_solids.h"

namespace {

/* All are taken; distances are those of the solids before rounding, up to what rounding moves a vertex, of either body. */
void prisms(const Folder& folder)
{
    Messages messages;
    for (int decimals = 3; decimals <= 5; ++decimals) {
        const double moved = 2 * 0.5 * std::pow(10.0, -decimals) * std::sqrt(3.0) + 100 * ROUNDING;
        Numbers numbers(7u + static_cast<unsigned int>(decimals));
        for (int sides = 3; sides < 23; ++sides) {
            SWIFT_Scene ideal(false), text(false);
            int ids[2];
            for (int i = 0; i < 2; ++i) {
                const Solid solid = prism(sides, numbers);
                CHECK(text.Add_Object(folder.write("prism.poly", solid.file(decimals)).c_str(), ids[i]));
                CHECK(solid.add(ideal, ids[i]));
            }
            for (int round = 0; round < 5; ++round) {
                double m[9];
                numbers.rotation(m);
                SWIFT_Real R[9];
                const SWIFT_Real T[3] = {static_cast<SWIFT_Real>(2.2 + numbers.next()), static_cast<SWIFT_Real>(numbers.next()), 0};
                std::copy(m, m + 9, R);
                ideal.Set_Object_Transformation(ids[1], R, T);
                text.Set_Object_Transformation(ids[1], R, T);
                int pairs, *oids, *types, *features;
                SWIFT_Real *distances, *points, *normals;
                CHECK(!ideal.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &oids, &distances) && pairs == 1);
                const double expected = distances[0];
                int* counts;
                CHECK(!text.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &oids, &counts, &distances, &points, &normals,
                                                        &types, &features));
                CHECK(pairs == 1 && counts[0] == 1 && std::fabs(distances[0] - expected) <= moved);
                for (int side = 0, at = 0; side < 2; ++side) {
                    const int count = types[side] == SWIFT_EDGE ? 2 : 1;
                    for (int k = 0; k < count; ++k, ++at) {
                        CHECK(features[at] >= 0 && features[at] < (types[side] == SWIFT_FACE ? sides + 2 : 2 * sides));
                    }
                }
            }
        }
    }
    CHECK(messages.take().empty());
}

void spheres(const Folder& folder)
{
    Messages messages;
    SWIFT_Scene scene(false);
    int first = -1, second = -1, pairs, *ids;
    SWIFT_Real* distances;
    const std::string file = folder.write("sphere.poly", sphere(24, 40).file(5));
    CHECK(scene.Add_Object(file.c_str(), first) && scene.Add_General_Object(file.c_str(), second));
    move_to(scene, second, 0, 0, 3);
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1);
    CHECK(std::fabs(distances[0] - 1) <= 1e-6);
    CHECK(messages.take().empty());
}

/* Coordinates of a float build at an offset of 1000: their last place is 6e-5. The input transform brings them back. */
void floats()
{
    Messages messages;
    Numbers numbers(3);
    SWIFT_Scene scene(false);
    const SWIFT_Translation back = {-1000, -1000, -1000};
    for (int sides = 3; sides < 13; ++sides) {
        Solid solid = prism(sides, numbers);
        for (std::size_t i = 0; i < solid.vertices.size(); ++i) {
            solid.vertices[i] = static_cast<float>(solid.vertices[i]) + 1000.0f;
        }
        int id;
        const std::vector<SWIFT_Real> vertices = solid.as_real();
        CHECK(scene.Add_Convex_Object(&vertices[0], &solid.faces[0], solid.vertex_count(), solid.face_count(), id, false,
                                      DEFAULT_ORIENTATION, back, 1, BOX_SETTING_DEFAULT, 0, 0, &solid.valences[0]));
    }
    CHECK(messages.take().empty());
}

/* Whatever was turned or scaled before, and copies of it: the text is what it was. */
void transforms()
{
    Messages messages;
    Numbers numbers(11);
    for (int sides = 4; sides < 12; ++sides) {
        Solid solid = prism(sides, numbers);
        for (std::size_t i = 0; i < solid.vertices.size(); ++i) {
            solid.vertices[i] = std::floor(1000 * solid.vertices[i] + 0.5) / 1000;
        }
        const std::vector<SWIFT_Real> vertices = solid.as_real();
        const Rotation turn(sides % 3, 0.7);
        const SWIFT_Translation away = {3, -5, static_cast<SWIFT_Real>(0.1)};
        SWIFT_Scene scene(false);
        int first = -1, second = -1;
        CHECK(scene.Add_Object(&vertices[0], &solid.faces[0], solid.vertex_count(), solid.face_count(), first, false, turn.m, away,
                               static_cast<SWIFT_Real>(0.3), BOX_SETTING_DEFAULT, 0, 0, &solid.valences[0]));
        CHECK(scene.Add_Object(NULL, NULL, 0, 0, second, false, turn.m, away, 2, BOX_SETTING_DEFAULT, 0, 0, NULL, first));
        /* A copy has the numbers of its faces. */
        int pairs, *ids, *types, *features;
        SWIFT_Real *distances, *points, *normals;
        move_to(scene, second, 0, 0, 20);
        int* counts;
        CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals, &types,
                                                 &features));
        CHECK(pairs == 1 && features[0] >= 0 && features[1] >= 0);
    }
    CHECK(messages.take().empty());
}

void inside_out()
{
    Messages messages;
    Numbers numbers(5);
    const Solid solid = prism(7, numbers);
    Solid turned = solid;
    std::size_t at = 0;
    for (std::size_t face = 0; face < turned.valences.size(); ++face) {
        const std::size_t end = at + static_cast<std::size_t>(turned.valences[face]);
        std::reverse(turned.faces.begin() + static_cast<std::ptrdiff_t>(at), turned.faces.begin() + static_cast<std::ptrdiff_t>(end));
        at = end;
    }
    SWIFT_Real found[2];
    int face[2];
    for (int i = 0; i < 2; ++i) {
        SWIFT_Scene scene(false);
        int first = -1, second = -1, pairs, *ids, *types, *features, *counts;
        SWIFT_Real *distances, *points, *normals;
        const BoxMesh point(0.001, 0.001, 0.001);
        CHECK((i == 0 ? solid : turned).add(scene, first) && point.add(scene, second));
        move_to(scene, second, 0.1, 2, 0.2);
        CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals, &types,
                                                 &features));
        CHECK(pairs == 1);
        found[i] = distances[0];
        face[i] = features[0];
    }
    CHECK(is_same(found[0], found[1]) && face[0] == face[1]);
    CHECK(messages.take().empty());
}

/* A dent far deeper than the text is a dent; the message names face and vertex, and what a program can do. */
void dents(const Folder& folder)
{
    Messages messages;
    Solid solid = sphere(12, 20);
    for (int axis = 0; axis < 3; ++axis) {
        solid.vertices[static_cast<std::size_t>(3 * 77 + axis)] *= 0.95;
    }
    SWIFT_Scene scene(false);
    int id = 9;
    CHECK(!scene.Add_Object(folder.write("dented.poly", solid.file(4)).c_str(), id) && id == 9);
    const std::string said = messages.take();
    CHECK(said.find("Error (Add_Object obj 0 piece 0): face ") == 0 && said.find(": vertex ") != std::string::npos);
    CHECK(said.find("after Set_Take_Hull(true) the convex hull of the vertices is taken\n") != std::string::npos);
    CHECK(said.find("SWIFTPROX") == std::string::npos);
    scene.Set_Take_Hull(true);
    CHECK(scene.Add_Object(folder.write("dented.poly", solid.file(4)).c_str(), id) && id == 0);
}

} // namespace

int main(int argc, char** argv)
{
    const Folder folder(argc, argv);
    prisms(folder);
    spheres(folder);
    floats();
    transforms();
    inside_out();
    dents(folder);
    return check_report("legacy_text_meshes");
}
