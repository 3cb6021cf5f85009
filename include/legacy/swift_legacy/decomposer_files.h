/*
 * The files of SWIFT++'s decomposer, which hold an object in several convex pieces: decompositions (Convex_Decomposition), and
 * hierarchies of hulls (Convex_Hierarchy). The leaves of a hierarchy are the pieces of a decomposition; the hulls of several pieces
 * above them, and what else the file keeps to save time, are read over.
 */
#ifndef SWIFT_LEGACY_DECOMPOSER_FILES_H
#define SWIFT_LEGACY_DECOMPOSER_FILES_H

#include "../SWIFT_fileio.h"
#include "binary_numbers.h"
#include "mesh.h"

namespace swift_legacy {

/* --- Decompositions ------------------------------------------------------------------------------------------------------ */

/* The counts of a convex decomposition. */
struct DecompositionCounts {
    int vertices, faces, vertex_map, face_map, pieces;
};

/* Empty when the counts could be read, else what is wrong with them. The stream stands behind the header. */
inline std::string read_decomposition_counts(std::ifstream& stream, DecompositionCounts& header)
{
    const char* const names[] = {"vertices", "faces", "map_vids", "map_fids", "pieces"};
    int* const counts[] = {&header.vertices, &header.faces, &header.vertex_map, &header.face_map, &header.pieces};
    const std::string fault = read_named_counts(stream, names, counts, 5);
    if (!fault.empty()) {
        return fault;
    }
    if (header.vertices == 0 || header.faces == 0 || header.pieces == 0) {
        return "it has no vertices, faces or pieces";
    }
    if ((header.vertex_map != 0 && header.vertex_map != header.vertices) ||
        (header.face_map != 0 && header.face_map != header.faces)) {
        return "its maps have other lengths than its vertices and faces";
    }
    return "";
}

/* The sum of counts that are not negative; -1 where it is more than an array can have. */
inline int sum_of(const std::vector<int>& counts)
{
    const int most = 0x2aaaaaaa; /* three of each are still an int */
    int sum = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] > most - sum) {
            return -1;
        }
        sum += counts[i];
    }
    return sum;
}

/*
 * Behind the header: the coordinates; 3 vertices of each face; the number of each vertex and of each face in the mesh that was
 * decomposed, where the maps are there; the piece of each face; for each piece how many faces and how many further ones, which
 * close its hull, it has; the faces of all pieces; the 3 vertices of all further ones.
 */
inline std::string read_decomposition_pieces(BinaryNumbers& numbers, const DecompositionCounts& header, std::vector<Mesh>& pieces)
{
    const int any = 0x7fffffff;
    Mesh whole;
    const std::string fault = read_vertices(numbers, header.vertices, whole.vertices);
    if (!fault.empty()) {
        return fault;
    }
    std::vector<int> corners, face_map, piece_of_face, face_counts, hull_counts, faces, hull_corners;
    if (header.faces > any / 3) {
        return "it is cut off among its faces";
    }
    if (!read_integers(numbers, 3 * header.faces, header.vertices, corners)) {
        return "it is cut off among its faces, or a face has a vertex that there is not";
    }
    if (!read_integers(numbers, header.vertex_map, any, whole.vertex_labels) ||
        !read_integers(numbers, header.face_map, any, face_map)) {
        return "it is cut off among its maps, or a number in them is negative";
    }
    if (!read_integers(numbers, header.faces, header.pieces, piece_of_face)) {
        return "it is cut off among the pieces of faces, or a face is in a piece that there is not";
    }
    if (!read_integers(numbers, header.pieces, any, face_counts) || !read_integers(numbers, header.pieces, any, hull_counts)) {
        return "it is cut off among the sizes of its pieces, or one is negative";
    }
    const int face_total = sum_of(face_counts), hull_total = sum_of(hull_counts);
    if (face_total < 0 || hull_total < 0 || !read_integers(numbers, face_total, header.faces, faces) ||
        !read_integers(numbers, 3 * hull_total, header.vertices, hull_corners)) {
        return "it is cut off among the faces of its pieces, or a piece has a face or vertex that there is not";
    }
    if (!numbers.is_at_end()) {
        return "there are more bytes than its header says";
    }
    SubMesh part(whole);
    std::size_t next_face = 0, next_corner = 0;
    for (int p = 0; p < header.pieces; ++p) {
        part.begin();
        for (int i = 0; i < face_counts[static_cast<std::size_t>(p)]; ++i) {
            const int face = faces[next_face++];
            const std::size_t place = static_cast<std::size_t>(face);
            if (piece_of_face[place] != p) {
                return "face " + text(face) + " is in piece " + text(piece_of_face[place]) + " and listed in piece " + text(p);
            }
            part.add_triangle(&corners[3 * place], face_map.empty() ? face : face_map[place]);
        }
        for (int i = 0; i < hull_counts[static_cast<std::size_t>(p)]; ++i, next_corner += 3) {
            part.add_triangle(&hull_corners[next_corner], -1);
        }
        if (part.mesh().face_count == 0) {
            return "piece " + text(p) + " has no faces";
        }
        pieces.push_back(part.mesh());
    }
    return "";
}

/* The pieces of a convex decomposition, before any transform; empty, or what is wrong with it. */
inline std::string read_decomposition(std::ifstream& stream, std::vector<Mesh>& pieces)
{
    BinaryForm form;
    DecompositionCounts counts;
    std::string fault = read_binary_form(stream, form);
    if (fault.empty()) {
        fault = read_decomposition_counts(stream, counts);
    }
    if (fault.empty()) {
        BinaryNumbers numbers(stream, form);
        fault = read_decomposition_pieces(numbers, counts, pieces);
    }
    return fault;
}

/* --- Hierarchies of hulls ------------------------------------------------------------------------------------------------ */

/* The counts of a hierarchy of hulls. */
struct HullTreeCounts {
    int vertices, vertex_map, face_map, surface_faces, twice_held, faces, shared_faces, twins, nodes;
};

/* Empty when the counts could be read, else what is wrong with them. The stream stands behind the header. */
inline std::string read_hull_tree_counts(std::ifstream& stream, HullTreeCounts& header)
{
    const char* const names[] = {"vertices",    "map_vids",     "map_fids",   "orig_faces", "orig_hier_faces",
                                 "total_faces", "copied_faces", "edge_twins", "nodes"};
    int* const counts[] = {&header.vertices, &header.vertex_map,   &header.face_map, &header.surface_faces, &header.twice_held,
                           &header.faces,    &header.shared_faces, &header.twins,    &header.nodes};
    const std::string fault = read_named_counts(stream, names, counts, 9);
    if (!fault.empty()) {
        return fault;
    }
    if (header.vertices == 0 || header.surface_faces == 0 || header.nodes == 0) {
        return "it has no vertices, faces or nodes";
    }
    if ((header.vertex_map != 0 && header.vertex_map != header.vertices) ||
        (header.face_map != 0 && header.face_map != header.surface_faces)) {
        return "its maps have other lengths than its vertices and faces";
    }
    if (header.faces < header.surface_faces || header.faces > 0x7fffffff / 4 || header.twice_held > 0x7fffffff / 4) {
        return "its numbers of faces do not fit each other";
    }
    return "";
}

/* The arrays of a hierarchy that all its nodes share. */
struct HullTreeArrays {
    Mesh whole;
    /* Three vertices and some bits of each face: first those of the surface, then those of the nodes. */
    std::vector<int> corners;
    /* Faces that a node shares with another or with the surface. */
    std::vector<int> shared;
    std::vector<int> face_map;
};

/*
 * Reads over so many half-edges, which say what is across an edge: four times a face and which of its edges it is, or -1. What is
 * across is plain from the vertices, too. False where one is of a face that there is not, or is missing.
 */
inline bool skip_half_edges(BinaryNumbers& numbers, int count, int face_count)
{
    for (int i = 0; i < count && numbers.is_whole(); ++i) {
        const int half_edge = numbers.integer();
        if (half_edge < -1 || half_edge / 4 >= face_count) {
            return false;
        }
    }
    return numbers.is_whole();
}

/*
 * Behind the header: the height of the tree; centre of mass, centre and radius; the coordinates; the number of each vertex and of
 * each face in the mesh that was decomposed, where the maps are there; 3 vertices and some bits of each face; the shared faces;
 * what is across each edge of the surface, of its faces that nodes hold again, and of all faces at each level.
 */
inline std::string read_hull_tree_arrays(BinaryNumbers& numbers, const HullTreeCounts& header, HullTreeArrays& arrays)
{
    const int any = 0x7fffffff;
    numbers.integer();
    for (int i = 0; i < 7; ++i) {
        numbers.real();
    }
    const std::string fault = read_vertices(numbers, header.vertices, arrays.whole.vertices);
    if (!fault.empty()) {
        return fault;
    }
    if (!read_integers(numbers, header.vertex_map, any, arrays.whole.vertex_labels) ||
        !read_integers(numbers, header.face_map, any, arrays.face_map)) {
        return "it is cut off among its maps, or a number in them is negative";
    }
    for (int face = 0; face < header.faces && numbers.is_whole(); ++face) {
        for (int corner = 0; corner < 3; ++corner) {
            arrays.corners.push_back(numbers.integer());
            if (arrays.corners.back() < 0 || arrays.corners.back() >= header.vertices) {
                return "face " + text(face) + " has a vertex that there is not";
            }
        }
        numbers.integer();
    }
    if (!numbers.is_whole()) {
        return "it is cut off among its faces";
    }
    if (!read_integers(numbers, header.shared_faces, header.faces, arrays.shared)) {
        return "it is cut off among its copied faces, or there is no such face";
    }
    if (!skip_half_edges(numbers, header.surface_faces, header.faces) || !skip_half_edges(numbers, header.surface_faces, header.faces) ||
        !skip_half_edges(numbers, header.surface_faces, header.faces)) {
        return "it is cut off among the twins of its edges, or one is of a face that there is not";
    }
    for (int i = 0; i < header.twice_held && numbers.is_whole(); ++i) {
        const int face = numbers.integer();
        if (face < 0 || face >= header.faces || !skip_half_edges(numbers, 3, header.faces)) {
            return "it is cut off among the faces that it holds twice, or there is no such face";
        }
    }
    if (!numbers.is_whole() || !skip_half_edges(numbers, header.twins, header.faces)) {
        return "it is cut off among the twins of its edges, or one is of a face that there is not";
    }
    return "";
}

/* A hull of the tree; the faces are ranges of the shared ones and of all. */
struct HullNode {
    int shared_count, first_shared, own_count, first_own, parent;
    int children[2];
};

/*
 * Of each node: how many shared faces and from where, how many of its own and from where, the parent, two children, the level;
 * centre of mass and radius; the kind of its look-up table and the half-edges in it.
 */
inline std::string read_hull_node(BinaryNumbers& numbers, const HullTreeCounts& header, int index, HullNode& node)
{
    int* const members[] = {&node.shared_count, &node.first_shared, &node.own_count,   &node.first_own,
                            &node.parent,       &node.children[0],  &node.children[1]};
    for (int i = 0; i < 7; ++i) {
        *members[i] = numbers.integer();
    }
    numbers.integer();
    for (int i = 0; i < 4; ++i) {
        numbers.real();
    }
    const int kind = numbers.integer();
    const std::string name = "node " + text(index);
    if (!numbers.is_whole()) {
        return "it is cut off in " + name;
    }
    if (node.shared_count < 0 || node.first_shared < 0 || node.shared_count > header.shared_faces - node.first_shared ||
        node.own_count < 0 || node.first_own < 0 || node.own_count > header.faces - node.first_own) {
        return name + " has faces that there are not";
    }
    const bool is_leaf = node.children[0] == -1;
    for (int i = 0; i < 2; ++i) {
        const int child = node.children[i];
        if (is_leaf ? child != -1 : child <= index || child >= header.nodes) {
            return name + " has a child that there is not";
        }
    }
    /* Steps of 22.5, 11.25 and 5.625 degrees. */
    if (kind < 0 || kind > 2) {
        return name + " has a look-up table of a kind that there is not";
    }
    const int rings = (8 << kind) - 1, around = 16 << kind;
    if (!skip_half_edges(numbers, rings * around + 2, header.faces)) {
        return "it is cut off in the look-up table of " + name + ", or that has a face that there is not";
    }
    return "";
}

/* Whether the nodes are a tree below the first: each other one is a child once, of its parent. */
inline std::string check_hull_tree(const std::vector<HullNode>& nodes)
{
    std::vector<int> parents(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (int k = 0; k < 2 && nodes[i].children[0] != -1; ++k) {
            int& parent = parents[static_cast<std::size_t>(nodes[i].children[k])];
            if (parent != -1) {
                return "node " + text(nodes[i].children[k]) + " is a child twice";
            }
            parent = static_cast<int>(i);
        }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].parent != parents[i] || (i > 0 && parents[i] == -1)) {
            return "node " + text(static_cast<int>(i)) + " is no child of its parent";
        }
    }
    return "";
}

/* The hull of a leaf: faces of the surface, and those of its own that close it, which have no number. */
inline void add_hull(const HullTreeArrays& arrays, const HullTreeCounts& header, const HullNode& node, SubMesh& part)
{
    for (int i = 0; i < node.shared_count; ++i) {
        const int face = arrays.shared[static_cast<std::size_t>(node.first_shared + i)];
        const std::size_t place = static_cast<std::size_t>(face);
        const bool is_of_surface = face < header.surface_faces;
        part.add_triangle(&arrays.corners[3 * place], !is_of_surface ? -1 : arrays.face_map.empty() ? face : arrays.face_map[place]);
    }
    for (int i = 0; i < node.own_count; ++i) {
        part.add_triangle(&arrays.corners[3 * static_cast<std::size_t>(node.first_own + i)], -1);
    }
}

/* The leaves of a hierarchy of hulls, in its order, before any transform; empty, or what is wrong with it. */
inline std::string read_hull_tree(std::ifstream& stream, std::vector<Mesh>& pieces)
{
    BinaryForm form;
    HullTreeCounts counts;
    std::string fault = read_binary_form(stream, form);
    if (fault.empty()) {
        fault = read_hull_tree_counts(stream, counts);
    }
    if (!fault.empty()) {
        return fault;
    }
    BinaryNumbers numbers(stream, form);
    HullTreeArrays arrays;
    fault = read_hull_tree_arrays(numbers, counts, arrays);
    std::vector<HullNode> nodes;
    for (int i = 0; i < counts.nodes && fault.empty(); ++i) {
        nodes.push_back(HullNode());
        fault = read_hull_node(numbers, counts, i, nodes.back());
    }
    if (fault.empty() && !numbers.is_at_end()) {
        fault = "there are more bytes than its header says";
    }
    if (fault.empty()) {
        fault = check_hull_tree(nodes);
    }
    SubMesh part(arrays.whole);
    for (std::size_t i = 0; i < nodes.size() && fault.empty(); ++i) {
        if (nodes[i].children[0] != -1) {
            continue;
        }
        part.begin();
        add_hull(arrays, counts, nodes[i], part);
        if (part.mesh().face_count == 0) {
            fault = "node " + text(static_cast<int>(i)) + " has no faces";
        }
        pieces.push_back(part.mesh());
    }
    return fault;
}

/* --- Both ---------------------------------------------------------------------------------------------------------------- */

enum PieceFileResult { PIECE_FILE_NONE, PIECE_FILE_READ, PIECE_FILE_REFUSED };

/* The pieces of a file, before any transform. PIECE_FILE_NONE: it is of another kind. Refused after a message. */
inline PieceFileResult pieces_from_file(const char* filename, std::vector<Mesh>& pieces)
{
    std::ifstream stream;
    if (!open_file(filename, stream)) {
        return PIECE_FILE_REFUSED;
    }
    const std::string word = first_word(stream);
    const bool is_tree = word == "Convex_Hierarchy";
    if (!is_tree && word != "Convex_Decomposition") {
        return PIECE_FILE_NONE;
    }
    const std::string fault = is_tree ? read_hull_tree(stream, pieces) : read_decomposition(stream, pieces);
    if (!fault.empty()) {
        report("Error (" + std::string(filename) + "): the convex " + (is_tree ? "hierarchy" : "decomposition") + " is damaged: " + fault);
        return PIECE_FILE_REFUSED;
    }
    return PIECE_FILE_READ;
}

} // namespace swift_legacy

#endif
