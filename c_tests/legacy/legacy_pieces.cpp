/*
 * Objects of several pieces: those of SWIFT 1.x, whose pairs of pieces are listed one by one, and decompositions of SWIFT++,
 * which are one object with one contact; copies of pieces, levels of detail, and decomposition files in all forms, damaged
 * ones as well.
 */
#include "legacy_rod.h"

namespace {

const SWIFT_Translation left = {-2, 0, 0}, right = {2, 0, 0};

void pieces(bool has_broad_phase, const Folder& folder)
{
    Messages messages;
    const BoxMesh box(0.5, 0.5, 0.5);
    const SWIFT_Real* vertices[2] = {box.vertices, box.vertices};
    const int* faces[2] = {box.triangles, box.quads};
    const int vertex_counts[2] = {8, 8}, face_counts[2] = {12, 6};
    const int* valences[2] = {NULL, box.valences};
    const SWIFT_Translation places[2] = {{-2, 0, 0}, {2, 0, 0}};
    SWIFT_Scene scene(has_broad_phase);
    int first = -1, second = -1, id = 33;
    CHECK(scene.Add_Pieced_Object(vertices, faces, vertex_counts, face_counts, 2, first, false, DEFAULT_ORIENTATIONS, places,
                                  DEFAULT_SCALES, DEFAULT_BOX_SETTINGS, DEFAULT_BOX_ENLARGE_RELS, DEFAULT_BOX_ENLARGE_ABSS, valences));
    const std::string file = folder.write("piece.tri", box_file(box, false));
    const char* names[2] = {file.c_str(), file.c_str()};
    CHECK(scene.Add_Pieced_Object(names, 2, second, false, NULL, places));
    CHECK(first == 0 && second == 1);
    move_to(scene, second, 0, 3, 0);
    int pairs, *ids, *pids;
    SWIFT_Real *distances, *points, *normals;
    CHECK(!scene.Query_Contact_Determination(false, 100, pairs, &ids, &distances, &points, &normals, &pids));
    CHECK(pairs == 4);
    for (int k = 0; k < 4; ++k) {
        CHECK(ids[2 * k] == 0 && ids[2 * k + 1] == 1 && pids[2 * k] == k / 2 && pids[2 * k + 1] == k % 2);
        const bool is_opposite = k == 0 || k == 3;
        CHECK(is_near(distances[k], is_opposite ? 2 : std::sqrt(13.0)));
    }
    move_to(scene, second, 4, 0.75, 0);
    CHECK(scene.Query_Intersection(false, pairs, &ids) && pairs == 1 && ids[0] == 0 && ids[1] == 1);
    CHECK(scene.Query_Exact_Distance(false, 5, pairs, &ids, &distances) && pairs == 3);
    CHECK(is_near(distances[0], 3) && is_near(distances[1], -1) && is_near(distances[2], 3));
    int* counts;
    CHECK(scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances));
    CHECK(pairs == (has_broad_phase ? 1 : 4) && counts[has_broad_phase ? 0 : 2] == -1);
    SWIFT_Real x, y, z;
    scene.Get_Center_Of_Mass(first, x, y, z);
    CHECK(is_near(x, 0) && is_near(y, 0) && is_near(z, 0));

    /* The second piece alone, and a new object of copies: a piece that is there, and a mesh beside it. */
    int copy = -1, both = -1;
    CHECK(scene.Add_Object(NULL, NULL, 0, 0, copy, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, 1, 0, 0, 0, NULL, first, 1));
    scene.Get_Center_Of_Mass(copy, x, y, z);
    CHECK(copy == 2 && is_near(x, 2));
    const int oids[2] = {first, -1}, piece_ids[2] = {-1, -1};
    CHECK(scene.Add_Pieced_Object(vertices, faces, vertex_counts, face_counts, 2, both, false, NULL, NULL, NULL, NULL, NULL, NULL,
                                  valences, oids, piece_ids));
    scene.Get_Center_Of_Mass(both, x, y, z);
    CHECK(both == 3 && is_near(x, -1));
    CHECK(scene.Add_Pieced_Object(names, 2, both, true, NULL, NULL, NULL, NULL, NULL, NULL, oids) && both == 4);
    CHECK(messages.take().empty());

    /* What is wrong with a piece names it. */
    const int bad_oids[2] = {-1, 9}, bad_pids[2] = {0, 2}, good_oids[2] = {-1, first}, settings[2] = {0, BOX_SETTING_COPY};
    CHECK(!scene.Add_Pieced_Object(names, 2, id, false, NULL, NULL, NULL, NULL, NULL, NULL, bad_oids));
    CHECK(messages.take() == "Error (Add_Object obj 5 piece 1): Invalid object id given to copy a piece: 9\n");
    CHECK(!scene.Add_Pieced_Object(names, 2, id, false, NULL, NULL, NULL, NULL, NULL, NULL, good_oids, bad_pids));
    CHECK(messages.take() == "Error (Add_Object obj 5 piece 1): Invalid piece id given to copy a piece: 2\n");
    CHECK(!scene.Add_Pieced_Object(names, 2, id, false, NULL, NULL, NULL, settings));
    CHECK(messages.take() == "Error (Add_Object obj 5 piece 1): Cannot set box type to COPY when copy is not done\n");
    CHECK(!scene.Add_Pieced_Object(names, 0, id) && messages.has("the number of pieces is not positive"));
    const int open_counts[2] = {12, 5};
    CHECK(!scene.Add_Pieced_Object(vertices, faces, vertex_counts, open_counts, 2, id, false, NULL, NULL, NULL, NULL, NULL, NULL,
                                   valences));
    const std::string said = messages.take();
    CHECK(said.find("Error: The mesh is not closed --\n") == 0);
    CHECK(said.find("Error (Add_Object obj 5 piece 1): Mesh creation failed\n") != std::string::npos);
    CHECK(!scene.Add_Pieced_Object(static_cast<const char* const*>(NULL), 1, id) && messages.has("Invalid filename given"));
    CHECK(!scene.Add_Pieced_Object(NULL, NULL, NULL, NULL, 1, id) && messages.has("no vertices or no faces are given"));
    CHECK(id == 33);
}

void levels(const Folder& folder)
{
    Messages messages;
    const BoxMesh box(0.5, 0.5, 0.5);
    const SWIFT_Real* vertices[2] = {box.vertices, box.vertices};
    const int* faces[2] = {box.triangles, box.triangles};
    const int vertex_counts[33] = {8, 8}, face_counts[33] = {12, 12};
    const SWIFT_Real scales[2] = {2, 3};
    const SWIFT_Translation places[2] = {{1, 0, 0}, {5, 5, 5}};
    SWIFT_Scene scene(false);
    int first = -1, second = -1, third = -1, fourth = -1, id = 33;
    /* The coarser level is moved onto the finer one; distances are those of the finest, each level's transform its own. */
    CHECK(scene.Add_Hierarchical_Object(vertices, faces, vertex_counts, face_counts, 2, first, false, DEFAULT_ORIENTATIONS, places,
                                        scales));
    const std::string tri = folder.write("level.tri", box_file(box, false)), poly = folder.write("level.poly", box_file(box, true));
    const char* names[2] = {tri.c_str(), poly.c_str()};
    CHECK(scene.Add_Hierarchical_Object(names, 2, second));
    move_to(scene, second, 4, 0, 0);
    int pairs, *ids, *pids;
    SWIFT_Real* distances;
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1 && is_near(distances[0], 1.5));
    SWIFT_Real x, y, z;
    scene.Get_Center_Of_Mass(first, x, y, z);
    CHECK(is_near(x, 1));

    /* With pieces: the first comes with two levels, the second without. */
    const SWIFT_Real* const* piece_vertices[2] = {vertices, vertices};
    const int* const* piece_faces[2] = {faces, faces};
    const int* const piece_vertex_counts[2] = {vertex_counts, vertex_counts};
    const int* const piece_face_counts[2] = {face_counts, face_counts};
    const int level_counts[2] = {2, 0};
    const SWIFT_Translation left_places[2] = {{-2, 0, 0}, {-2, 0, 0}}, right_places[2] = {{2, 0, 0}, {2, 0, 0}};
    const SWIFT_Translation* const piece_places[2] = {left_places, right_places};
    CHECK(scene.Add_Hierarchical_Pieced_Object(piece_vertices, piece_faces, piece_vertex_counts, piece_face_counts, level_counts, 2,
                                               third, false, DEFAULT_ORIENTATIONSS, piece_places));
    const char* const* piece_names[2] = {names, names};
    CHECK(scene.Add_Hierarchical_Pieced_Object(piece_names, level_counts, 2, fourth, false, NULL, piece_places));
    CHECK(third == 2 && fourth == 3);
    scene.Deactivate();
    scene.Activate(third, fourth);
    move_to(scene, fourth, 0, 2, 0);
    CHECK(!scene.Query_Contact_Determination(false, 2, pairs, &ids, &distances, NULL, NULL, &pids));
    CHECK(pairs == 2 && is_near(distances[0], 1) && is_near(distances[1], 1) && pids[0] == 0 && pids[1] == 0 && pids[3] == 1);
    SWIFT_Real* errors;
    CHECK(!scene.Query_Approximate_Distance(false, 2, 1, pairs, &ids, &distances, &errors) && pairs == 2);
    CHECK(distances[0] <= 1 && distances[0] + errors[0] >= 1);

    /* Copies of a piece with levels, with a transform as well. */
    const Rotation quarter(2, 2 * std::atan(1.0));
    CHECK(scene.Add_Object(NULL, NULL, 0, 0, id, false, quarter.m, DEFAULT_TRANSLATION, 1, 0, 0, 0, NULL, third, 0) && id == 4);
    scene.Get_Center_Of_Mass(id, x, y, z);
    CHECK(is_near(x, 0) && is_near(y, -2));
    CHECK(messages.take().empty());
    CHECK(!scene.Add_Hierarchical_Object(vertices, faces, vertex_counts, face_counts, 0, id));
    CHECK(messages.has("Invalid number of levels given (must be positive): 0"));
    CHECK(!scene.Add_Hierarchical_Object(names, -1, id) && messages.has("Invalid number of levels given (must be positive): -1"));
    CHECK(!scene.Add_Hierarchical_Object(vertices, faces, vertex_counts, face_counts, 33, id));
    CHECK(messages.has("Invalid number of levels given (must be less than or equal to 32): 33"));
    const int bad_counts[2] = {1, -1};
    CHECK(!scene.Add_Hierarchical_Pieced_Object(piece_names, bad_counts, 2, id));
    CHECK(messages.has("Error (Add_Object obj 5 piece 1): Invalid number of levels given (must be positive): -1"));
    CHECK(!scene.Add_Hierarchical_Pieced_Object(static_cast<const char* const* const*>(NULL), bad_counts, 1, id));
    CHECK(messages.has("Invalid filename given to read file") && id == 4);
}

void decompositions(const Folder& folder)
{
    const BoxMesh box(0.5, 0.5, 0.5);
    for (int form = 0; form < 16; ++form) {
        const Rod file((form & 1) != 0, (form & 2) != 0, (form & 4) != 0);
        const std::string path = folder.write("rod.bin", (form & 8) != 0 ? file.hulls() : file.decomposition());
        SWIFT_Scene scene(false);
        int rod = -1, other = -1;
        CHECK(scene.Add_General_Object(path.c_str(), rod) && rod == 0);
        CHECK(box.add(scene, other));
        SWIFT_Real x, y, z;
        scene.Get_Center_Of_Mass(rod, x, y, z);
        CHECK(is_near(x, 0) && is_near(y, 0.5) && is_near(z, 0.5));
        /* One object, one pair, one contact: the pieces are 2.5 and 1.5 away. */
        move_to(scene, other, 3, 0.25, 0.75);
        int pairs, *ids, *counts, *types, *feature_ids;
        SWIFT_Real *distances, *points, *normals;
        CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1 && is_near(distances[0], 1.5));
        CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals, &types,
                                                 &feature_ids));
        CHECK(pairs == 1 && counts[0] == 1 && is_near(distances[0], 1.5));
        CHECK(is_near(points[0], 1) && is_near3(normals, -1, 0, 0));
        CHECK(scene.Get_Answer(0) != NULL && scene.Get_Answer(1) == NULL);
        /* Numbers of the mesh that was decomposed. */
        const int offset = file.has_maps ? 10 : 0;
        if (types[0] == SWIFT_FACE) {
            CHECK(feature_ids[0] >= 2 * offset + 18 && feature_ids[0] < 2 * offset + 20);
        } else {
            CHECK(feature_ids[0] >= offset + 8 && feature_ids[0] < offset + 12);
        }
        int* pids;
        CHECK(!scene.Query_Contact_Determination(false, 10, pairs, &ids, &distances, NULL, NULL, &pids) && pairs == 1 && pids[0] == 0);
        CHECK(is_near(distances[0], 1.5));
        move_to(scene, other, 1.25, 0.25, 0.75);
        CHECK(scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals, &types,
                                                &feature_ids));
        CHECK(pairs == 1 && counts[0] == -1 && is_same(distances[0], -1));
        swiftprox_depth_answer depth;
        CHECK(scene.Get_Depth(0, depth) && is_near(depth.depth, 0.25));
        CHECK(scene.Query_Intersection(false, pairs, &ids) && pairs == 1);
        CHECK(scene.Query_Tolerance_Verification(false, 3, pairs, &ids) && pairs == 1);

        /* Beside an object of pieces, and a copy of it; with an input transform. */
        const SWIFT_Real* vertices[2] = {box.vertices, box.vertices};
        const int* faces[2] = {box.triangles, box.triangles};
        const int eight[2] = {8, 8}, twelve[2] = {12, 12};
        const SWIFT_Translation places[2] = {{3, 0.25, 0.75}, {-4, 0.25, 0.75}};
        int several = -1, copy = -1, turned = -1;
        CHECK(scene.Add_Pieced_Object(vertices, faces, eight, twelve, 2, several, false, NULL, places));
        CHECK(scene.Copy_Object(rod, copy) && copy == 3);
        scene.Deactivate();
        scene.Activate(rod, several);
        CHECK(!scene.Query_Contact_Determination(false, 10, pairs, &ids, &distances, NULL, NULL, &pids) && pairs == 2);
        CHECK(is_near(distances[0], 1.5) && is_near(distances[1], 2.5) && pids[1] == 0 && pids[3] == 1 && pids[2] == 0);
        CHECK(!scene.Query_Contact_Determination(false, 10, pairs, &ids, &counts, &distances) && pairs == 2);
        CHECK(counts[0] == 1 && counts[1] == 1);
        const Rotation quarter(2, 2 * std::atan(1.0));
        CHECK(scene.Add_General_Object(path.c_str(), turned, true, quarter.m, right, 2, GAP, BOX_SETTING_CHOOSE, 0, 0));
        scene.Get_Center_Of_Mass(turned, x, y, z);
        CHECK(is_near(x, 1) && is_near(y, 0) && is_near(z, 1));
        CHECK(scene.Add_Object(NULL, NULL, 0, 0, copy, false, quarter.m, left, 1, 0, 0, 0, NULL, turned));
        scene.Get_Center_Of_Mass(copy, x, y, z);
        CHECK(is_near(x, -2) && is_near(y, 1) && is_near(z, 1));

        /* A copy of it is an object of pieces alone, and no piece beside others: pids would name several. */
        Messages messages;
        const int oids[2] = {-1, rod};
        CHECK(scene.Add_Pieced_Object(NULL, NULL, NULL, NULL, 1, copy, false, NULL, NULL, NULL, NULL, NULL, NULL, NULL, &rod));
        CHECK(copy == 6 && messages.take().empty());
        CHECK(!scene.Add_Pieced_Object(vertices, faces, eight, twelve, 2, copy, false, NULL, NULL, NULL, NULL, NULL, NULL, NULL,
                                       oids));
        CHECK(copy == 6 && messages.has("Error (Add_Object obj 7 piece 1): a piece cannot be a copy of a decomposed object"));
        scene.Deactivate();
        scene.Activate(copy, other);
        CHECK(scene.Query_Contact_Determination(false, 10, pairs, &ids, &distances, NULL, NULL, &pids) && pairs == 1);
        CHECK(ids[0] == other && ids[1] == copy && pids[0] == 0 && pids[1] == 0);
    }
}

/* A word of a file's header, another in its place, and what is said of the file then. */
struct Change {
    const char* what;
    const char* by;
    const char* message;

    std::string made_in(std::string content) const
    {
        return content.replace(content.find(what), std::strlen(what), by);
    }
};

/* The file is refused, the id is left alone, and the message holds this; all of what was said. */
std::string refuse(SWIFT_Scene& scene, Messages& messages, const std::string& path, const char* message)
{
    int id = 44;
    CHECK(!scene.Add_General_Object(path.c_str(), id) && id == 44);
    const std::string said = messages.take();
    if (!CHECK(said.find(message) != std::string::npos)) {
        std::printf("not \"%s\", but %s", message, said.c_str());
    }
    return said;
}

void refused_decompositions(const Folder& folder)
{
    Messages messages;
    SWIFT_Scene scene(false);
    int id = 44;
    const std::string good = Rod(false, false, true).decomposition();
    const std::size_t header = good.find("pieces 2\n") + 9;
    /* However much is missing, and one byte too much. */
    for (std::size_t length = 0; length < good.size(); length += length < header ? 7 : 61) {
        CHECK(!scene.Add_General_Object(folder.write("cut.dcp", good.substr(0, length)).c_str(), id) && !messages.take().empty());
    }
    refuse(scene, messages, folder.write("more.dcp", good + "x"), "damaged: there are more bytes than its header says");
    const std::string no_order = Rod(true, false, true).decomposition().replace(29, 3, "lit");
    refuse(scene, messages, folder.write("order.dcp", no_order), "damaged: the byte order is missing");
    /* The bytes of the other order: numbers of vertices that there are not. */
    std::string swapped = good;
    swapped.replace(swapped.find("little"), 6, "big");
    refuse(scene, messages, folder.write("swapped.dcp", swapped), "damaged: ");
    const Change changes[] = {
        {"real double", "real half", "the kind of its real numbers is missing"},
        {"vertices 12", "vertices -1", "the number of vertices is missing"},
        {"faces 20", "fences 20", "the number of faces is missing"},
        {"map_vids 12", "map_vids 11", "its maps have other lengths"},
        {"pieces 2", "pieces 0", "it has no vertices, faces or pieces"},
        {"pieces 2\n", "pieces 2 ", "the header does not end in a new line"},
        {"vertices 12", "vertices 2000000000", "its maps have other lengths"},
        {"pieces 2", "pieces 1", "a face is in a piece that there is not"},
        {"faces 20\nmap_vids 12\nmap_fids 20", "faces 19\nmap_vids 12\nmap_fids 19", "damaged: "},
    };
    for (std::size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        refuse(scene, messages, folder.write("changed.dcp", changes[i].made_in(good)), changes[i].message);
    }
    /* A face in another piece than its list says, and a vertex without a value. */
    std::string other = good;
    const std::size_t pieces_at = header + 8 * 36 + 4 * (60 + 12 + 20);
    other[pieces_at] = 1;
    refuse(scene, messages, folder.write("other.dcp", other), "face 0 is in piece 1 and listed in piece 0");
    other = good;
    other.replace(header, 8, 8, static_cast<char>(-1));
    refuse(scene, messages, folder.write("nan.dcp", other), "vertex 0 is not finite");
    CHECK(!scene.Add_General_Object(NULL, id) && messages.has("Error: Invalid filename given to read file"));
    CHECK(id == 44);
    CHECK(scene.Add_General_Object(folder.write("good.dcp", good).c_str(), id) && id == 0);
}

/* Where hulls() has, from the end of its header on, the first node: behind records of 4 and 8 bytes. */
std::size_t first_node(const std::string& hulls)
{
    return hulls.find("nodes 3\n") + 8 + 4 + 7 * 8 + 12 * 24 + 4 * (12 + 20 + 24 * 4 + 40 + 60 + 4 * 4 + 120);
}

void refused_hulls(const Folder& folder)
{
    Messages messages;
    SWIFT_Scene scene(false);
    int id = 44;
    const std::string good = Rod(false, false, true).hulls();
    const std::size_t header = good.find("nodes 3\n") + 8, node = first_node(good);
    const Change words[] = {
        {"little", "middle", "the byte order is missing"},
        {"real double", "real half", "the kind of its real numbers is missing"},
        {"orig_faces", "orig_fences", "the number of orig_faces is missing"},
        {"edge_twins 120", "edge_twins -1", "the number of edge_twins is missing"},
        {"edge_twins 120", "edge_twins 2147483647", "the twins of its edges"},
        {"edge_twins 120", "edge_twins 99999999999", "the number of edge_twins is missing"},
        {"map_fids 20", "map_fids 24", "its maps have other lengths"},
        {"total_faces 24", "total_faces 19", "its numbers of faces do not fit"},
        {"total_faces 24", "total_faces 2147483647", "its numbers of faces do not fit"},
        {"copied_faces 40", "copied_faces 2147483647", "copied faces"},
        {"nodes 3\n", "nodes 0\n", "it has no vertices, faces or nodes"},
        {"nodes 3\n", "nodes 2\n", "node 0 has a child that there is not"},
        {"nodes 3\n", "nodes 4\n", "it is cut off in node 3"},
        {"nodes 3\n", "nodes 3 ", "the header does not end in a new line"},
    };
    for (std::size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        const std::string said = refuse(scene, messages, folder.write("changed.chr", words[i].made_in(good)), words[i].message);
        CHECK(said.find("the convex hierarchy is damaged: ") != std::string::npos);
    }
    /* One byte of a number: where, its new value, and what is then wrong. */
    const std::size_t faces = header + 4 + 56 + 12 * 24 + 4 * (12 + 20), shared = faces + 24 * 16, twins = shared + 40 * 4;
    const std::size_t second = node + 9 * 4 + 32 + 114 * 4;
    const struct {
        std::size_t at;
        signed char value; // char has no sign on AArch64
        const char* message;
    } bytes[] = {
        {header + 4 + 56 + 7, 127, "vertex 0 is not finite"}, {faces, 12, "face 0 has a vertex that there is not"},
        {faces + 3, -1, "face 0 has a vertex that there is not"}, {shared + 4, 24, "copied faces, or there is no such face"},
        {twins, 96, "twins of its edges, or one is of a face that there is not"}, {twins + 60 * 4, 24, "that it holds twice"},
        {node, 41, "node 0 has faces that there are not"}, {node + 3, -1, "node 0 has faces that there are not"},
        {node + 4, 21, "node 0 has faces that there are not"}, {node + 8, 5, "node 0 has faces that there are not"},
        {node + 20, 0, "node 0 has a child that there is not"}, {node + 20, 3, "node 0 has a child that there is not"},
        {node + 20, 2, "node 2 is a child twice"}, {second + 16, 2, "node 1 is no child of its parent"},
        {node + 64, 3, "node 0 has a look-up table of a kind that there is not"}, {node + 68, 96, "the look-up table of node 0"},
    };
    for (std::size_t i = 0; i < sizeof bytes / sizeof bytes[0]; ++i) {
        std::string bad = good;
        bad[bytes[i].at] = static_cast<char>(bytes[i].value);
        if (bytes[i].at == header + 4 + 56 + 7) {
            bad[bytes[i].at - 1] = static_cast<char>(-16);
        }
        refuse(scene, messages, folder.write("changed.chr", bad), bytes[i].message);
    }
    refuse(scene, messages, folder.write("more.chr", good + "x"), "there are more bytes than its header says");

    /* One hull alone is one piece. */
    CHECK(scene.Add_General_Object(folder.write("one.chr", Rod(true, true, false).hulls(1)).c_str(), id) && id == 0);
    SWIFT_Real x, y, z;
    scene.Get_Center_Of_Mass(id, x, y, z);
    CHECK(is_near(x, 0) && is_near(y, 0.5) && is_near(z, 0.5) && messages.take().empty());
}

/* However much of a file is missing it is refused; whatever byte is another it is refused, or an object that can be asked. */
void damaged_files(const Folder& folder)
{
    Messages messages;
    const BoxMesh box(0.5, 0.5, 0.5);
    SWIFT_Scene scene(false);
    int other = -1, id = -1;
    CHECK(box.add(scene, other));
    move_to(scene, other, 3, 0.25, 0.75);
    const std::string whole[2] = {Rod(true, true, false).hulls(1), Rod(false, false, true).decomposition()};
    unsigned int random = 1;
    int refused = 0, taken = 0;
    for (int kind = 0; kind < 2; ++kind) {
        for (std::size_t length = 0; length < whole[kind].size(); ++length) {
            CHECK(!scene.Add_General_Object(folder.write("cut.bin", whole[kind].substr(0, length)).c_str(), id));
            CHECK(!messages.take().empty());
        }
        for (int round = 0; round < 1000; ++round) {
            std::string bad = whole[kind];
            random = random * 1664525u + 1013904223u;
            const std::size_t at = (random >> 8) % bad.size();
            random = random * 1664525u + 1013904223u;
            bad[at] = static_cast<char>(bad[at] ^ static_cast<char>(1 + (random >> 8) % 255));
            if (!scene.Add_General_Object(folder.write("flipped.bin", bad).c_str(), id)) {
                CHECK(!messages.take().empty());
                ++refused;
                continue;
            }
            int pairs, *ids;
            SWIFT_Real* distances;
            scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances);
            CHECK(pairs == 1 && (is_same(distances[0], -1) || distances[0] >= 0));
            scene.Delete_Object(id);
            ++taken;
        }
    }
    CHECK(refused > 200 && taken > 200);
}

} // namespace

int main(int argc, char** argv)
{
    const Folder folder(argc, argv);
    pieces(false, folder);
    pieces(true, folder);
    levels(folder);
    decompositions(folder);
    refused_decompositions(folder);
    refused_hulls(folder);
    damaged_files(folder);
    return check_report("legacy_pieces");
}
