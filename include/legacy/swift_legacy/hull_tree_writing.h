/* Hierarchies of hulls (Convex_Hierarchy), written. hull_tree_files.h says how they are laid out. */
#ifndef SWIFT_LEGACY_HULL_TREE_WRITING_H
#define SWIFT_LEGACY_HULL_TREE_WRITING_H

#include "binary_numbers.h"
#include "hull_tree.h"

namespace swift_legacy {

class HullTreeWriter {
public:
    HullTreeWriter(const Decomposition& decomposition, const HullTree& tree)
        : decomposition_(decomposition), tree_(tree), twins_(tree.faces.size())
    {
    }

    /* Appends the file's bytes. Empty, or why there are none. */
    std::string write(std::string& bytes)
    {
        /* Edge after edge of a face, on all levels on which it is. */
        for (std::size_t i = 0; i < twins_.size(); ++i) {
            twins_[i].assign(3 * level_count(tree_.faces[i]), -1);
        }
        std::string node_bytes;
        int shared_count = 0, own_end = static_cast<int>(decomposition_.face_count());
        for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
            const HullTreeNode& node = tree_.nodes[i];
            HalfEdges edges;
            if (!find_edges(HullTree::hull_of(node), edges) || !find_twins(node, edges)) {
                return "the hull of node " + text(i) + " is not closed";
            }
            append_node(node_bytes, node, shared_count, own_end, edges);
            shared_count += static_cast<int>(node.shared.size());
            own_end += static_cast<int>(node.own.size());
        }
        append_head(bytes, static_cast<std::size_t>(shared_count));
        append_arrays(bytes);
        bytes += node_bytes;
        return "";
    }

private:
    const Decomposition& decomposition_;
    const HullTree& tree_;
    std::vector<std::vector<int> > twins_;

    static std::size_t level_count(const HullFace& face)
    {
        return static_cast<std::size_t>(face.last_level - face.first_level + 1);
    }

    /* In files an edge is four times its face, and which of the face's it is. */
    static int half_edge(int face, int edge)
    {
        return 4 * face + edge;
    }

    /* False where two faces have one half-edge. */
    bool find_edges(const std::vector<int>& faces, HalfEdges& edges) const
    {
        bool are_single = true;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const int* corners = tree_.faces[static_cast<std::size_t>(faces[i])].corners;
            for (int k = 0; k < 3; ++k) {
                are_single = edges.add(corners[k], corners[(k + 1) % 3], half_edge(faces[i], k)) && are_single;
            }
        }
        return are_single;
    }

    /* What is across the edges of a node's hull, on its level. False where nothing is. */
    bool find_twins(const HullTreeNode& node, const HalfEdges& edges)
    {
        const std::vector<int> hull = HullTree::hull_of(node);
        for (std::size_t i = 0; i < hull.size(); ++i) {
            const std::size_t number = static_cast<std::size_t>(hull[i]);
            const HullFace& face = tree_.faces[number];
            for (std::size_t k = 0; k < 3; ++k) {
                const int twin = edges.find(face.corners[(k + 1) % 3], face.corners[k]);
                if (twin == HalfEdges::NONE) {
                    return false;
                }
                twins_[number][k * level_count(face) + static_cast<std::size_t>(node.level - face.first_level)] = twin;
            }
        }
        return true;
    }

    void append_head(std::string& bytes, std::size_t shared_count) const
    {
        std::size_t twin_count = 0;
        for (std::size_t i = 0; i < twins_.size(); ++i) {
            twin_count += twins_[i].size();
        }
        bytes += binary_head("Convex_Hierarchy");
        bytes += named_count("vertices", decomposition_.vertex_count());
        bytes += named_count("map_vids", decomposition_.vertex_labels.size());
        bytes += named_count("map_fids", decomposition_.face_labels.size());
        bytes += named_count("orig_faces", decomposition_.face_count()) + named_count("orig_hier_faces", 0);
        bytes += named_count("total_faces", tree_.faces.size()) + named_count("copied_faces", shared_count);
        bytes += named_count("edge_twins", twin_count) + named_count("nodes", tree_.nodes.size());
    }

    void append_arrays(std::string& bytes) const
    {
        std::vector<int> surface;
        for (std::size_t i = 0; i < decomposition_.face_count(); ++i) {
            surface.push_back(static_cast<int>(i));
        }
        double centre[3];
        append_integer(bytes, tree_.nodes.back().level);
        const double radius = measure(surface, centre);
        append_reals(bytes, std::vector<double>(centre, centre + 3));
        append_reals(bytes, std::vector<double>(centre, centre + 3));
        append_real(bytes, radius);
        append_reals(bytes, decomposition_.vertices);
        append_integers(bytes, decomposition_.vertex_labels);
        append_integers(bytes, decomposition_.face_labels);
        for (std::size_t i = 0; i < tree_.faces.size(); ++i) {
            append_integers(bytes, std::vector<int>(tree_.faces[i].corners, tree_.faces[i].corners + 3));
            append_integer(bytes, bits_of(tree_.faces[i]));
        }
        for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
            append_integers(bytes, tree_.nodes[i].shared);
        }
        HalfEdges edges;
        find_edges(surface, edges);
        for (std::size_t i = 0; i < decomposition_.corners.size(); ++i) {
            const std::size_t next = i / 3 * 3 + (i + 1) % 3;
            append_integer(bytes, edges.find(decomposition_.corners[next], decomposition_.corners[i]));
        }
        for (std::size_t i = 0; i < twins_.size(); ++i) {
            append_integers(bytes, twins_[i]);
        }
    }

    /* What a face is, the level of its first hull, and on how many levels it is. A tree that is halved has fewer than 32. */
    static int bits_of(const HullFace& face)
    {
        return face.kind | face.first_level << 16 | static_cast<int>(level_count(face)) << 24;
    }

    void append_node(std::string& bytes, const HullTreeNode& node, int first_shared, int first_own, const HalfEdges& edges) const
    {
        const int shared_count = static_cast<int>(node.shared.size()), own_count = static_cast<int>(node.own.size());
        const int members[8] = {shared_count, first_shared,     own_count,        first_own,
                                node.parent,  node.children[0], node.children[1], node.level};
        append_integers(bytes, std::vector<int>(members, members + 8));
        const std::vector<int> hull = HullTree::hull_of(node);
        double centre[3];
        const double radius = measure(hull, centre);
        append_reals(bytes, std::vector<double>(centre, centre + 3));
        append_real(bytes, radius);
        append_look_up_table(bytes, hull, edges);
    }

    /*
     * Of the coarsest kind, 22.5 degrees: for each direction an edge at the vertex that is farthest along it. Rings from north to
     * south, each from the x axis towards the y axis, then the two poles.
     */
    void append_look_up_table(std::string& bytes, const std::vector<int>& hull, const HalfEdges& edges) const
    {
        const int kind = 0, quarter = 4;
        const double step = PI / (2 * quarter);
        append_integer(bytes, kind);
        for (int ring = quarter - 1; ring > -quarter; --ring) {
            for (int i = 0; i < 4 * quarter; ++i) {
                const double direction[3] = {std::cos(ring * step) * std::cos(i * step), std::cos(ring * step) * std::sin(i * step),
                                             std::sin(ring * step)};
                append_integer(bytes, edges.find_from(farthest(hull, direction)));
            }
        }
        for (int pole = 1; pole >= -1; pole -= 2) {
            const double direction[3] = {0, 0, static_cast<double>(pole)};
            append_integer(bytes, edges.find_from(farthest(hull, direction)));
        }
    }

    const double* corner(int face, int k) const
    {
        return &decomposition_.vertices[3 * static_cast<std::size_t>(tree_.faces[static_cast<std::size_t>(face)].corners[k])];
    }

    int farthest(const std::vector<int>& hull, const double* direction) const
    {
        int best = -1;
        double most = 0;
        for (std::size_t i = 0; i < hull.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                const double* p = corner(hull[i], k);
                const double height = p[0] * direction[0] + p[1] * direction[1] + p[2] * direction[2];
                if (best < 0 || height > most) {
                    best = tree_.faces[static_cast<std::size_t>(hull[i])].corners[k];
                    most = height;
                }
            }
        }
        return best;
    }

    /* The centroid of a surface, and how far it reaches from there. */
    double measure(const std::vector<int>& faces, double* centre) const
    {
        Mesh mesh;
        mesh.vertices = decomposition_.vertices;
        mesh.face_count = faces.size();
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const int* corners = tree_.faces[static_cast<std::size_t>(faces[i])].corners;
            mesh.indices.insert(mesh.indices.end(), corners, corners + 3);
        }
        SurfaceCentroid centroid;
        centroid.add(mesh);
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            centre[axis] = centroid[axis];
        }
        for (std::size_t i = 0; i < faces.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                const double* p = corner(faces[i], k);
                square = std::max(square, (p[0] - centre[0]) * (p[0] - centre[0]) + (p[1] - centre[1]) * (p[1] - centre[1]) +
                                              (p[2] - centre[2]) * (p[2] - centre[2]));
            }
        }
        return std::sqrt(square);
    }
};

} // namespace swift_legacy

#endif
