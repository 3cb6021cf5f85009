/*
 * Files of SWIFT++'s decomposer. A convex decomposition (Convex_Decomposition) holds a surface in convex pieces. A hierarchy of
 * hulls (Convex_Hierarchy) is refused: it holds the same pieces, in a layout that its header does not tell.
 */
#ifndef SWIFT_LEGACY_DECOMPOSITION_FILES_H
#define SWIFT_LEGACY_DECOMPOSITION_FILES_H

#include <cstring>
#include <stdint.h>

#include "file_dispatcher.h"

namespace swift_legacy {

enum DecompositionResult { DECOMPOSITION_NONE, DECOMPOSITION_READ, DECOMPOSITION_REFUSED };

/* What lies behind the header: numbers in the byte order of the file. */
class BinaryNumbers {
public:
    BinaryNumbers(std::ifstream& stream, bool is_big_endian, bool is_float) : at_(0), is_whole_(true), is_float_(is_float)
    {
        char block[4096];
        while (stream.read(block, sizeof block), stream.gcount() > 0) {
            bytes_.insert(bytes_.end(), block, block + stream.gcount());
        }
        const uint16_t one = 1;
        unsigned char low;
        std::memcpy(&low, &one, 1);
        swaps_ = is_big_endian == (low == 1);
    }

    double real()
    {
        if (is_float_) {
            return take<float>();
        }
        return take<double>();
    }

    int integer()
    {
        return take<int32_t>();
    }

    /* False once a number was missing. */
    bool is_whole() const
    {
        return is_whole_;
    }

    bool is_at_end() const
    {
        return at_ == bytes_.size();
    }

    std::size_t size() const
    {
        return bytes_.size();
    }

private:
    std::vector<char> bytes_;
    std::size_t at_;
    bool is_whole_;
    bool is_float_;
    bool swaps_;

    template <class Number> Number take()
    {
        Number number = 0;
        if (bytes_.size() - at_ < sizeof number) {
            is_whole_ = false;
            return 0;
        }
        char bytes[sizeof number];
        std::copy(&bytes_[at_], &bytes_[at_] + sizeof number, bytes);
        at_ += sizeof number;
        if (swaps_) {
            std::reverse(bytes, bytes + sizeof number);
        }
        std::memcpy(&number, bytes, sizeof number);
        return number;
    }
};

/* The counts of a convex decomposition. */
struct DecompositionHeader {
    int vertices, faces, vertex_map, face_map, pieces;
    bool is_big_endian, is_float;
};

/* Empty when the header could be read, else what is wrong with it. The stream stands behind it. */
inline std::string read_decomposition_header(std::ifstream& stream, DecompositionHeader& header)
{
    stream.imbue(std::locale::classic());
    std::string magic, binary, endian, real, kind;
    stream >> magic >> binary >> endian >> real >> kind;
    if (binary != "binary" || (endian != "big_endian" && endian != "little_endian")) {
        return "the byte order is missing";
    }
    if (real != "real" || (kind != "float" && kind != "double")) {
        return "the kind of its real numbers is missing";
    }
    header.is_big_endian = endian == "big_endian";
    header.is_float = kind == "float";
    const char* const names[] = {"vertices", "faces", "map_vids", "map_fids", "pieces"};
    int* const counts[] = {&header.vertices, &header.faces, &header.vertex_map, &header.face_map, &header.pieces};
    for (int i = 0; i < 5; ++i) {
        std::string name;
        if (!(stream >> name >> *counts[i]) || name != names[i] || *counts[i] < 0) {
            return std::string("the number of ") + names[i] + " is missing";
        }
    }
    if (header.vertices == 0 || header.faces == 0 || header.pieces == 0) {
        return "it has no vertices, faces or pieces";
    }
    if ((header.vertex_map != 0 && header.vertex_map != header.vertices) ||
        (header.face_map != 0 && header.face_map != header.faces)) {
        return "its maps have other lengths than its vertices and faces";
    }
    const int line_end = stream.get();
    return line_end == '\n' || (line_end == '\r' && stream.get() == '\n') ? "" : "the header does not end in a new line";
}

inline bool read_integers(BinaryNumbers& numbers, int count, int limit, std::vector<int>& values)
{
    values.clear();
    for (int i = 0; i < count && numbers.is_whole(); ++i) {
        values.push_back(numbers.integer());
        if (values.back() < 0 || values.back() >= limit) {
            return false;
        }
    }
    return numbers.is_whole();
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

/* Triangles of a mesh with those vertices alone that they have, in the order in which they come. */
class SubMesh {
public:
    explicit SubMesh(const Mesh& whole) : whole_(whole), place_(whole.vertex_count(), static_cast<int>(NONE)) {}

    void begin()
    {
        for (std::size_t i = 0; i < taken_.size(); ++i) {
            place_[taken_[i]] = NONE;
        }
        taken_.clear();
        mesh_ = Mesh();
    }

    void add_triangle(const int* corners, int label)
    {
        for (int corner = 0; corner < 3; ++corner) {
            const std::size_t vertex = static_cast<std::size_t>(corners[corner]);
            if (place_[vertex] == NONE) {
                place_[vertex] = static_cast<int>(taken_.size());
                taken_.push_back(vertex);
                mesh_.vertices.insert(mesh_.vertices.end(), &whole_.vertices[3 * vertex], &whole_.vertices[3 * vertex] + 3);
                mesh_.vertex_labels.push_back(whole_.vertex_labels.empty() ? corners[corner] : whole_.vertex_labels[vertex]);
            }
            mesh_.indices.push_back(static_cast<uint32_t>(place_[vertex]));
        }
        mesh_.face_labels.push_back(label);
        ++mesh_.face_count;
    }

    const Mesh& mesh() const
    {
        return mesh_;
    }

private:
    enum { NONE = -1 };
    const Mesh& whole_;
    std::vector<int> place_;
    std::vector<std::size_t> taken_;
    Mesh mesh_;
};

/*
 * Behind the header: the coordinates; 3 vertices of each face; the number of each vertex and of each face in the mesh that was
 * decomposed, where the maps are there; the piece of each face; for each piece how many faces and how many further ones, which
 * close its hull, it has; the faces of all pieces; the 3 vertices of all further ones.
 */
inline std::string read_decomposition_pieces(BinaryNumbers& numbers, const DecompositionHeader& header, std::vector<Mesh>& pieces)
{
    const int any = 0x7fffffff;
    Mesh whole;
    for (int i = 0; i < header.vertices && numbers.is_whole(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            whole.vertices.push_back(numbers.real());
            if (numbers.is_whole() && !(whole.vertices.back() - whole.vertices.back() <= 0)) {
                return "vertex " + text(i) + " is not finite";
            }
        }
    }
    std::vector<int> corners, face_map, piece_of_face, face_counts, hull_counts, faces, hull_corners;
    if (!numbers.is_whole() || header.faces > any / 3) {
        return "it is cut off among its vertices";
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

/* The pieces of a decomposition, before any transform. DECOMPOSITION_NONE: the file is none. Refused after a message. */
inline DecompositionResult pieces_from_file(const char* filename, std::vector<Mesh>& pieces)
{
    std::ifstream stream;
    if (!open_file(filename, stream)) {
        return DECOMPOSITION_REFUSED;
    }
    const std::string word = first_word(stream);
    if (word == "Convex_Hierarchy") {
        report("Error (" + std::string(filename) + "): hierarchies of hulls are not read; give the decomposition file "
               "(Convex_Decomposition) that it was made from");
        return DECOMPOSITION_REFUSED;
    }
    if (word != "Convex_Decomposition") {
        return DECOMPOSITION_NONE;
    }
    DecompositionHeader header;
    std::string fault = read_decomposition_header(stream, header);
    if (fault.empty()) {
        BinaryNumbers numbers(stream, header.is_big_endian, header.is_float);
        fault = read_decomposition_pieces(numbers, header, pieces);
    }
    if (!fault.empty()) {
        report("Error (" + std::string(filename) + "): the convex decomposition is damaged: " + fault);
        return DECOMPOSITION_REFUSED;
    }
    return DECOMPOSITION_READ;
}

} // namespace swift_legacy

#endif
