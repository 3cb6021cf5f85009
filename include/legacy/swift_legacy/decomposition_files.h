/* Convex decompositions (Convex_Decomposition) of SWIFT++'s decomposer: a surface in convex pieces. */
#ifndef SWIFT_LEGACY_DECOMPOSITION_FILES_H
#define SWIFT_LEGACY_DECOMPOSITION_FILES_H

#include "sub_mesh.h"

namespace swift_legacy {

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

} // namespace swift_legacy

#endif
