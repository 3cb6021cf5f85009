/* A polygon mesh from the caller's arrays, in the local frame: after the input transform. */
#ifndef SWIFT_LEGACY_MESH_H
#define SWIFT_LEGACY_MESH_H

#include <cmath>
#include <map>
#include <stdint.h>
#include <string>
#include <utility>
#include <vector>

#include "../SWIFT_common.h"
#include "messages.h"

namespace swift_legacy {

/* vertex' = scale * (rotation * vertex) + translation. */
struct Transform {
    double rotation[9];
    double translation[3];
    double scale;

    Transform(const SWIFT_Orientation& orient, const SWIFT_Translation& trans, SWIFT_Real factor) : scale(factor)
    {
        for (int i = 0; i < 9; ++i) {
            rotation[i] = orient[i];
        }
        for (int i = 0; i < 3; ++i) {
            translation[i] = trans[i];
        }
    }

    bool is_identity() const
    {
        bool is = !(scale < 1) && !(scale > 1);
        for (int i = 0; i < 9; ++i) {
            const double entry = i % 4 == 0 ? 1 : 0;
            is = is && !(rotation[i] < entry) && !(rotation[i] > entry);
        }
        for (int i = 0; i < 3; ++i) {
            is = is && !(translation[i] < 0) && !(translation[i] > 0);
        }
        return is;
    }

    void apply(double* v) const
    {
        double image[3];
        for (int i = 0; i < 3; ++i) {
            const double* row = rotation + 3 * i;
            image[i] = scale * (row[0] * v[0] + row[1] * v[1] + row[2] * v[2]) + translation[i];
        }
        v[0] = image[0], v[1] = image[1], v[2] = image[2];
    }
};

struct Mesh {
    std::vector<double> vertices;       /* 3 each */
    std::vector<uint32_t> indices;      /* the corners of all faces, one face after the other */
    std::vector<uint32_t> valences;     /* of each face; empty when all are triangles */
    std::size_t face_count;
    std::vector<int> vertex_labels;     /* the caller's number of each vertex; empty when that is its place */
    std::vector<int> face_labels;       /* the caller's number of each face; empty when that is its place */
    double tolerance;                   /* how far from convex its text excuses, as a part of the diagonal, once that is found out */

    Mesh() : face_count(0), tolerance(0) {}

    std::size_t vertex_count() const
    {
        return vertices.size() / 3;
    }

    std::size_t valence(std::size_t face) const
    {
        return valences.empty() ? 3 : valences[face];
    }

    void transform(const Transform& by)
    {
        if (!by.is_identity()) {
            for (std::size_t v = 0; v < vertex_count(); ++v) {
                by.apply(&vertices[3 * v]);
            }
        }
    }

    /* For each vertex the first one with equal coordinates; 0 and -0 are equal. */
    std::vector<uint32_t> first_of_equal_vertices() const
    {
        typedef std::pair<double, std::pair<double, double> > Point;
        std::map<Point, uint32_t> first;
        std::vector<uint32_t> firsts(vertex_count());
        for (std::size_t v = 0; v < firsts.size(); ++v) {
            const double* p = &vertices[3 * v];
            const Point point(p[0] + 0.0, std::make_pair(p[1] + 0.0, p[2] + 0.0));
            firsts[v] = first.insert(std::make_pair(point, static_cast<uint32_t>(v))).first->second;
        }
        return firsts;
    }

    /* Leaves out the vertices that no face names: the old libraries took them, and they are no part of the surface. */
    void drop_unused_vertices()
    {
        const uint32_t unused = 0xffffffffu;
        std::vector<uint32_t> place(vertex_count(), unused);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            place[indices[i]] = 0;
        }
        uint32_t count = 0;
        for (std::size_t v = 0; v < place.size(); ++v) {
            if (place[v] != unused) {
                place[v] = count++;
            }
        }
        if (count == vertex_count()) {
            return;
        }
        std::vector<double> used(3 * static_cast<std::size_t>(count));
        std::vector<int> labels(count);
        const std::vector<uint32_t> first = first_of_equal_vertices();
        for (std::size_t v = 0; v < place.size(); ++v) {
            if (place[v] != unused) {
                labels[place[v]] = static_cast<int>(first[v]);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    used[3 * static_cast<std::size_t>(place[v]) + axis] = vertices[3 * v + axis];
                }
            }
        }
        for (std::size_t i = 0; i < indices.size(); ++i) {
            indices[i] = place[indices[i]];
        }
        vertices.swap(used);
        vertex_labels.swap(labels);
    }
};

/* Empty when the arrays could be read, else what is wrong with them. */
inline std::string mesh_from_arrays(const SWIFT_Real* vertices, const int* faces, int vertex_count, int face_count,
                                    const int* face_valences, Mesh& mesh)
{
    if (vertices == NULL || faces == NULL) {
        return "no vertices or no faces are given";
    }
    if (vertex_count <= 0 || face_count <= 0) {
        return "there are " + text(vertex_count) + " vertices and " + text(face_count) + " faces";
    }
    mesh = Mesh();
    mesh.vertices.assign(vertices, vertices + 3 * static_cast<std::size_t>(vertex_count));
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (!(mesh.vertices[i] - mesh.vertices[i] <= 0)) {
            return "vertex " + text(i / 3) + " is not finite";
        }
    }
    mesh.face_count = static_cast<std::size_t>(face_count);
    if (face_valences != NULL) {
        mesh.valences.reserve(mesh.face_count);
    }
    for (int face = 0; face < face_count; ++face) {
        const int valence = face_valences == NULL ? 3 : face_valences[face];
        if (valence < 3) {
            return "face " + text(face) + " has " + text(valence) + " corners";
        }
        if (face_valences != NULL) {
            mesh.valences.push_back(static_cast<uint32_t>(valence));
        }
        for (int corner = 0; corner < valence; ++corner) {
            const int vertex = *faces++;
            if (vertex < 0 || vertex >= vertex_count) {
                return "face " + text(face) + " has vertex " + text(vertex) + " of " + text(vertex_count);
            }
            mesh.indices.push_back(static_cast<uint32_t>(vertex));
        }
    }
    mesh.drop_unused_vertices();
    return "";
}

/* In the words of old, why a mesh that was refused is no surface; empty where that is not the reason. */
inline std::string surface_fault(const Mesh& mesh)
{
    typedef std::map<std::pair<uint32_t, uint32_t>, int> Edges;
    const std::vector<uint32_t> first = mesh.first_of_equal_vertices();
    Edges edges;
    std::size_t at = 0;
    for (std::size_t face = 0; face < mesh.face_count; ++face) {
        const std::size_t valence = mesh.valence(face);
        for (std::size_t corner = 0; corner < valence; ++corner) {
            const uint32_t tail = first[mesh.indices[at + corner]];
            const uint32_t head = first[mesh.indices[at + (corner + 1) % valence]];
            ++edges[tail < head ? std::make_pair(tail, head) : std::make_pair(head, tail)];
        }
        at += valence;
    }
    bool is_open = false;
    for (Edges::const_iterator edge = edges.begin(); edge != edges.end(); ++edge) {
        if (edge->second > 2) {
            return "Error: The mesh is not a 2-manifold --\n       all edges must belong to exactly two triangles";
        }
        is_open = is_open || edge->second < 2;
    }
    return is_open ? "Error: The mesh is not closed --\n       all edges must belong to exactly two triangles" : "";
}

/*
 * The centroid of the surface, each triangle weighing its area: what the old libraries call the centre of mass. Faces that are not
 * the caller's do not count. Sums in long double, whose exponents do not end where those of areas do.
 */
class SurfaceCentroid {
public:
    SurfaceCentroid() : area(0)
    {
        sum[0] = sum[1] = sum[2] = 0;
    }

    void add(const Mesh& mesh)
    {
        std::size_t at = 0;
        for (std::size_t face = 0; face < mesh.face_count; ++face) {
            const std::size_t valence = mesh.valence(face);
            const bool counts = mesh.face_labels.empty() || mesh.face_labels[face] >= 0;
            for (std::size_t corner = 1; counts && corner + 1 < valence; ++corner) {
                add_triangle(&mesh.vertices[3 * static_cast<std::size_t>(mesh.indices[at])],
                             &mesh.vertices[3 * static_cast<std::size_t>(mesh.indices[at + corner])],
                             &mesh.vertices[3 * static_cast<std::size_t>(mesh.indices[at + corner + 1])]);
            }
            at += valence;
        }
    }

    double operator[](int axis) const
    {
        return static_cast<double>(sum[axis] / area);
    }

private:
    long double area;
    long double sum[3];

    void add_triangle(const double* a, const double* b, const double* c)
    {
        long double u[3], v[3];
        for (int i = 0; i < 3; ++i) {
            u[i] = static_cast<long double>(b[i]) - a[i];
            v[i] = static_cast<long double>(c[i]) - a[i];
        }
        const long double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
        const long double weight = std::sqrt(x * x + y * y + z * z);
        area += weight;
        for (int i = 0; i < 3; ++i) {
            sum[i] += weight * (a[i] + (u[i] + v[i]) / 3);
        }
    }
};

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
