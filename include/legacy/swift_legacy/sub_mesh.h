/* A part of a mesh. */
#ifndef SWIFT_LEGACY_SUB_MESH_H
#define SWIFT_LEGACY_SUB_MESH_H

#include "binary_numbers.h"
#include "mesh.h"

namespace swift_legacy {

/* So many vertices; empty, or what is wrong with them. */
inline std::string read_vertices(BinaryNumbers& numbers, int count, std::vector<double>& vertices)
{
    for (int i = 0; i < count && numbers.is_whole(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            vertices.push_back(numbers.real());
            if (numbers.is_whole() && !(vertices.back() - vertices.back() <= 0)) {
                return "vertex " + text(i) + " is not finite";
            }
        }
    }
    return numbers.is_whole() ? "" : "it is cut off among its vertices";
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

} // namespace swift_legacy

#endif
