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
    CHECK(pairs == 1 && counts[0] == 1 && is_near(distances[0], 0.25) && is_near(points[0], 1) && is_near3(normals, -1, 0, 0));
    CHECK(types[0] == SWIFT_FACE ? features[0] == 5 : types[0] == SWIFT_EDGE || types[0] == SWIFT_VERTEX);
    /* The features have numbers of the file, and are there. */
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

/* The pieces of a general object, each as the arrays of a closed mesh. */
class PieceMeshes {
public:
    PieceMeshes(const SWIFT_Scene& scene, int id)
    {
        swiftprox_object_info object;
        object.struct_size = sizeof object;
        CHECK(swiftprox_scene_get_object_info(scene.Get_Native_Scene(), scene.Get_Native_Object(id), &object) == SWIFTPROX_OK);
        swiftprox_compound_info info;
        CHECK(swiftprox_compound_get_info(object.compound, &info) == SWIFTPROX_OK);
        vertices_.resize(info.piece_count);
        faces_.resize(info.piece_count);
        for (std::size_t piece = 0; piece < info.piece_count; ++piece) {
            const swiftprox_shape* shape;
            double pose[12];
            CHECK(swiftprox_compound_get_piece(object.compound, static_cast<uint32_t>(piece), &shape, pose) == SWIFTPROX_OK);
            swiftprox_shape_info of;
            of.struct_size = sizeof of;
            CHECK(swiftprox_shape_get_info(shape, &of) == SWIFTPROX_OK);
            std::vector<double> vertices(3 * of.vertex_count);
            std::vector<uint32_t> corners(3 * of.triangle_count);
            CHECK(swiftprox_shape_copy_vertices(shape, &vertices[0], NULL, of.vertex_count) == SWIFTPROX_OK);
            CHECK(swiftprox_shape_copy_triangles(shape, &corners[0], of.triangle_count) == SWIFTPROX_OK);
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                vertices_[piece].push_back(static_cast<SWIFT_Real>(vertices[i]));
            }
            for (std::size_t i = 0; i < corners.size(); ++i) {
                faces_[piece].push_back(static_cast<int>(corners[i]));
            }
        }
    }

    int count() const
    {
        return static_cast<int>(vertices_.size());
    }

    bool add(SWIFT_Scene& scene, int& id) const
    {
        std::vector<const SWIFT_Real*> vertices;
        std::vector<const int*> faces;
        std::vector<int> vertex_counts, face_counts;
        for (std::size_t piece = 0; piece < vertices_.size(); ++piece) {
            vertices.push_back(&vertices_[piece][0]);
            faces.push_back(&faces_[piece][0]);
            vertex_counts.push_back(static_cast<int>(vertices_[piece].size() / 3));
            face_counts.push_back(static_cast<int>(faces_[piece].size() / 3));
        }
        return scene.Add_Pieced_Object(&vertices[0], &faces[0], &vertex_counts[0], &face_counts[0], count(), id);
    }

private:
    std::vector<std::vector<SWIFT_Real> > vertices_;
    std::vector<std::vector<int> > faces_;
};

/* A star of so many arms; its coordinates are floats and have eight decimals. */
Solid star(int arms)
{
    const double pi = PI;
    double polygon[32][2];
    for (int i = 0; i < 2 * arms; ++i) {
        const double radius = i % 2 == 0 ? 1.25 : 0.5;
        polygon[i][0] = std::floor(256 * radius * std::cos(pi * i / arms)) / 256;
        polygon[i][1] = std::floor(256 * radius * std::sin(pi * i / arms)) / 256;
    }
    return extruded(polygon, 2 * arms);
}

/* Of each two of three objects the least distance that is listed, -1 where they intersect, and `none` where they are not. */
void least(int pairs, const int* ids, const SWIFT_Real* distances, double none, double* found)
{
    std::fill(found, found + 3, none);
    for (int k = 0; k < pairs; ++k) {
        double& own = found[ids[2 * k] + ids[2 * k + 1] - 1];
        own = std::min(own, static_cast<double>(distances[k]));
    }
}

/* Where three objects are at a step. */
struct Places {
    std::vector<Rotation> turns;
    SWIFT_Real T[3][3];

    explicit Places(int step)
    {
        for (int i = 0; i < 3; ++i) {
            T[i][0] = static_cast<SWIFT_Real>(1.5 * std::sin(1.1 * step + 2 * i));
            T[i][1] = static_cast<SWIFT_Real>(1.5 * std::cos(0.7 * step + i));
            T[i][2] = static_cast<SWIFT_Real>(std::sin(0.3 * step + 3 * i));
            turns.push_back(Rotation((step + i) % 3, 0.37 * step * (i + 1)));
        }
    }

    void set(SWIFT_Scene& scene) const
    {
        for (int i = 0; i < 3; ++i) {
            scene.Set_Object_Transformation(i, turns[static_cast<std::size_t>(i)].m, T[i]);
        }
    }

    /* From a point of the one object to one of the other, each in its local frame. */
    double distance(int first, const SWIFT_Real* point1, int second, const SWIFT_Real* point2) const
    {
        double p[3], q[3], sum = 0;
        place_point(turns[static_cast<std::size_t>(first)].m, T[first], point1, p);
        place_point(turns[static_cast<std::size_t>(second)].m, T[second], point2, q);
        for (int i = 0; i < 3; ++i) {
            sum += (p[i] - q[i]) * (p[i] - q[i]);
        }
        return std::sqrt(sum);
    }
};

/* One contact for each pair, of these distances, with features of the file; how many pairs intersect. */
int contacts(SWIFT_Scene& scene, const Places& places, SWIFT_Real tolerance, const double* expected, int vertex_count)
{
    int pairs, *ids, *counts, *types, *features, intersecting = 0;
    SWIFT_Real *distances, *points, *normals;
    scene.Query_Contact_Determination(false, tolerance, pairs, &ids, &counts, &distances, &points, &normals, &types, &features);
    for (int k = 0, begin = 0, end = 0; k < pairs; ++k, begin = end) {
        const int first = ids[2 * k], second = ids[2 * k + 1];
        const bool meets = distances[k] < 0;
        CHECK(is_near(distances[k], expected[first + second - 1]) && counts[k] == (meets ? -1 : 1));
        const double apart = places.distance(first, points + 6 * k, second, points + 6 * k + 3);
        CHECK(std::fabs(apart - (meets ? 0 : distances[k])) < 100 * ROUNDING);
        end = begin + 4;
        if (!meets) {
            end = begin + (types[2 * k] == SWIFT_EDGE ? 2 : 1) + (types[2 * k + 1] == SWIFT_EDGE ? 2 : 1);
        }
        for (int i = begin; i < end; ++i) {
            CHECK(features[i] >= -1 && features[i] < vertex_count);
        }
        swiftprox_depth_answer depth;
        CHECK(!meets || (scene.Get_Depth(k, depth) && depth.outcome == SWIFTPROX_OUTCOME_INTERSECTING));
        intersecting += meets ? 1 : 0;
    }
    return intersecting;
}

/* Verdicts and distances of two stars and a box are those of all the pieces, added as an object of pieces. */
void as_pieces(const Folder& folder, int arms)
{
    Messages messages;
    SWIFT_Scene whole(false), pieced(false);
    const BoxMesh box(0.25, 0.25, 0.25);
    int id = -1;
    CHECK(whole.Add_General_Object(folder.write("star.poly", star(arms).file(8)).c_str(), id) && whole.Copy_Object(0, id));
    CHECK(box.add(whole, id) && id == 2);
    const PieceMeshes pieces(whole, 1);
    /* Some pieces are flat, of several triangles. */
    pieced.Set_Take_Hull(true);
    CHECK(pieces.count() > 2 && pieces.add(pieced, id) && pieces.add(pieced, id) && box.add(pieced, id) && id == 2);
    CHECK(messages.take().empty());
    int meeting = 0;
    for (int step = 0; step < 300; ++step) {
        const Places places(step);
        places.set(whole);
        places.set(pieced);
        const SWIFT_Real tolerance = step % 2 == 0 ? SWIFT_INFINITY : static_cast<SWIFT_Real>(0.5);
        int pairs, *ids;
        SWIFT_Real* distances;
        double found[3], expected[3];
        const bool meets = pieced.Query_Exact_Distance(false, tolerance, pairs, &ids, &distances);
        least(pairs, ids, distances, tolerance, expected);
        CHECK(whole.Query_Exact_Distance(false, tolerance, pairs, &ids, &distances) == meets && pairs <= 3);
        least(pairs, ids, distances, tolerance, found);
        CHECK(is_near(found[0], expected[0]) && is_near(found[1], expected[1]) && is_near(found[2], expected[2]));
        const int intersecting = contacts(whole, places, tolerance, expected, 4 * arms);
        CHECK(whole.Query_Intersection(false, pairs, &ids) == meets && pairs == intersecting);
        CHECK(whole.Query_Intersection(true, pairs, &ids) == meets && pairs == 0);
        meeting += intersecting;
    }
    CHECK(meeting > 50 && meeting < 450 && messages.take().empty());
}

/* Fixed, deactivated and deleted ones, and ids that are given out again. */
void life(const Folder& folder)
{
    const std::string file = folder.write("general.poly", extruded(L_POLYGON, 6).file(3));
    const SWIFT_Real R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, T[3] = {0, 0, 3};
    for (int has_broad_phase = 0; has_broad_phase < 2; ++has_broad_phase) {
        SWIFT_Scene scene(has_broad_phase != 0);
        int moving = -1, fixed = -1, other = -1, pairs, *ids;
        SWIFT_Real* distances;
        CHECK(scene.Add_General_Object(file.c_str(), moving) && scene.Add_General_Object(file.c_str(), fixed, true));
        CHECK(scene.Copy_Object(fixed, other));
        scene.Set_All_Object_Transformations(R, T);
        CHECK(scene.Query_Intersection(false, pairs, &ids) == false && pairs == 0);
        CHECK(!scene.Query_Exact_Distance(false, 10, pairs, &ids, &distances) && pairs == 2);
        CHECK(is_near(distances[0], 2) && is_near(distances[1], 2));
        scene.Deactivate(moving, other);
        CHECK(!scene.Query_Exact_Distance(false, 10, pairs, &ids, &distances) && pairs == 1 && ids[1] == fixed);
        scene.Activate(moving, other);
        CHECK(scene.Delete_Object(fixed));
        CHECK(!scene.Query_Exact_Distance(false, 10, pairs, &ids, &distances) && pairs == 1 && ids[1] == other);
        CHECK(scene.Add_General_Object(file.c_str(), fixed) && fixed == 1);
        CHECK(scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances));
        CHECK(is_same(distances[pairs - 1], -1) && ids[2 * pairs - 2] == fixed && ids[2 * pairs - 1] == other);
        Messages messages;
        swiftprox_depth_answer depth;
        CHECK(scene.Get_Depth(pairs - 1, depth) && scene.Delete_Object(fixed) && !scene.Get_Depth(pairs - 1, depth));
        CHECK(messages.has("Error (Get_Depth): "));
    }
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
    as_pieces(folder, 5);
    as_pieces(folder, 9);
    life(folder);
    refused(folder);
    return check_report("legacy_general");
}
