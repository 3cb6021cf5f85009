/* A tree of convex hulls over the pieces of a decomposition, as a hierarchy of SWIFT++'s decomposer holds it. */
#ifndef SWIFT_LEGACY_HULL_TREE_H
#define SWIFT_LEGACY_HULL_TREE_H

#include "decomposition.h"

namespace swift_legacy {

/* How a face of a hull is marked: of the surface, between pieces, or above several of them. */
enum HullFaceKind { HULL_FACE_OF_SURFACE = 0, HULL_FACE_BETWEEN_PIECES = 16, HULL_FACE_ABOVE_PIECES = 32 };

/* A triangle that is on a leaf's hull, or only on one above, and on all hulls from there up to `first_level`. */
struct HullFace {
    int corners[3];
    HullFaceKind kind;
    int first_level, last_level; /* the root's is 0 */
};

struct HullTreeNode {
    int parent, children[2]; /* -1: there is none */
    int level;
    std::vector<int> pieces;
    std::vector<int> shared; /* faces of its hull that are of the surface, or of a child */
    std::vector<int> own;
};

/* Faces are numbered: those of the surface, then each node's own. Nodes are level by level, the root first. */
class HullTree {
public:
    std::vector<HullFace> faces;
    std::vector<HullTreeNode> nodes;

    /* Empty, or why there is no tree. */
    std::string build(const Decomposition& decomposition)
    {
        for (std::size_t i = 0; i < decomposition.face_count(); ++i) {
            add_face(&decomposition.corners[3 * i], HULL_FACE_OF_SURFACE, 0);
        }
        add_nodes(decomposition);
        for (std::size_t i = nodes.size(); i-- > 0;) {
            if (nodes[i].children[0] < 0) {
                add_leaf_faces(decomposition, nodes[i]);
            } else if (!add_hull_faces(decomposition, nodes[i])) {
                return swiftprox_library_last_error_message();
            }
        }
        number_own_faces(static_cast<int>(decomposition.face_count()));
        return "";
    }

    /* All faces of a node's hull. */
    static std::vector<int> hull_of(const HullTreeNode& node)
    {
        std::vector<int> all = node.shared;
        all.insert(all.end(), node.own.begin(), node.own.end());
        return all;
    }

private:
    void add_face(const int* corners, HullFaceKind kind, int level)
    {
        HullFace face;
        std::copy(corners, corners + 3, face.corners);
        face.kind = kind;
        face.first_level = face.last_level = level;
        faces.push_back(face);
    }

    /* A piece where its centre is along an axis; of pieces at one place the one with the least face is first. */
    struct Place {
        double at;
        int face, piece;

        bool operator<(const Place& other) const
        {
            return at < other.at || (!(other.at < at) && face < other.face);
        }
    };

    /* Halves the pieces along the axis on which their centres spread most, down to single ones. */
    void add_nodes(const Decomposition& decomposition)
    {
        std::vector<double> centres;
        for (std::size_t i = 0; i < decomposition.pieces.size(); ++i) {
            const std::vector<int> corners = decomposition.patch(decomposition.pieces[i]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                double sum = 0;
                for (std::size_t k = 0; k < corners.size(); ++k) {
                    sum += decomposition.vertices[3 * static_cast<std::size_t>(corners[k]) + axis];
                }
                centres.push_back(corners.empty() ? 0 : sum / static_cast<double>(corners.size()));
            }
        }
        nodes.resize(1);
        nodes[0].parent = -1;
        nodes[0].level = 0;
        for (std::size_t i = 0; i < decomposition.pieces.size(); ++i) {
            nodes[0].pieces.push_back(static_cast<int>(i));
        }
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            nodes[i].children[0] = nodes[i].children[1] = -1;
            const std::vector<int> pieces = nodes[i].pieces;
            if (pieces.size() < 2) {
                continue;
            }
            std::vector<Place> places;
            const std::size_t axis = widest_axis(centres, pieces);
            for (std::size_t k = 0; k < pieces.size(); ++k) {
                const std::size_t piece = static_cast<std::size_t>(pieces[k]);
                const std::vector<int>& surface = decomposition.pieces[piece].faces;
                const Place place = {centres[3 * piece + axis], surface.empty() ? -1 : surface[0], pieces[k]};
                places.push_back(place);
            }
            std::stable_sort(places.begin(), places.end());
            for (std::size_t half = 0; half < 2; ++half) {
                HullTreeNode child;
                child.parent = static_cast<int>(i);
                child.level = nodes[i].level + 1;
                const std::size_t end = half == 0 ? places.size() / 2 : places.size();
                for (std::size_t k = half == 0 ? 0 : places.size() / 2; k < end; ++k) {
                    child.pieces.push_back(places[k].piece);
                }
                nodes[i].children[half] = static_cast<int>(nodes.size());
                nodes.push_back(child);
            }
        }
    }

    static std::size_t widest_axis(const std::vector<double>& centres, const std::vector<int>& pieces)
    {
        std::size_t widest = 0;
        double most = -1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double least = centres[3 * static_cast<std::size_t>(pieces[0]) + axis], greatest = least;
            for (std::size_t k = 1; k < pieces.size(); ++k) {
                const double centre = centres[3 * static_cast<std::size_t>(pieces[k]) + axis];
                least = std::min(least, centre);
                greatest = std::max(greatest, centre);
            }
            if (greatest - least > most) {
                most = greatest - least;
                widest = axis;
            }
        }
        return widest;
    }

    void add_leaf_faces(const Decomposition& decomposition, HullTreeNode& node)
    {
        const Decomposition::Piece& piece = decomposition.pieces[static_cast<std::size_t>(node.pieces[0])];
        node.shared = piece.faces;
        for (std::size_t i = 0; i < node.shared.size(); ++i) {
            HullFace& face = faces[static_cast<std::size_t>(node.shared[i])];
            face.first_level = face.last_level = node.level;
        }
        for (std::size_t i = 0; i < piece.closing.size(); i += 3) {
            node.own.push_back(static_cast<int>(faces.size()));
            add_face(&piece.closing[i], HULL_FACE_BETWEEN_PIECES, node.level);
        }
    }

    /*
     * The hull of all pieces below a node; where it has a face of a child's hull, they share it. False after a failure, which
     * swiftprox_library_last_error_message explains.
     */
    bool add_hull_faces(const Decomposition& decomposition, HullTreeNode& node)
    {
        std::vector<int> corners;
        if (!find_hull(decomposition, node, corners)) {
            return false;
        }
        std::map<std::vector<int>, int> below;
        for (int k = 0; k < 2; ++k) {
            const std::vector<int> hull = hull_of(nodes[static_cast<std::size_t>(node.children[k])]);
            for (std::size_t i = 0; i < hull.size(); ++i) {
                below[turned(faces[static_cast<std::size_t>(hull[i])].corners)] = hull[i];
            }
        }
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const std::map<std::vector<int>, int>::iterator found = below.find(turned(&corners[i]));
            if (found != below.end()) {
                node.shared.push_back(found->second);
                faces[static_cast<std::size_t>(found->second)].first_level = node.level;
            } else {
                node.own.push_back(static_cast<int>(faces.size()));
                add_face(&corners[i], HULL_FACE_ABOVE_PIECES, node.level);
            }
        }
        return true;
    }

    /* Corners from the least one on. */
    static std::vector<int> turned(const int* corners)
    {
        const int least = static_cast<int>(std::min_element(corners, corners + 3) - corners);
        std::vector<int> from_least;
        for (int k = 0; k < 3; ++k) {
            from_least.push_back(corners[(least + k) % 3]);
        }
        return from_least;
    }

    /* Three vertices of each triangle; false as of add_hull_faces. */
    static bool find_hull(const Decomposition& decomposition, const HullTreeNode& node, std::vector<int>& corners)
    {
        std::set<int> vertices;
        for (std::size_t k = 0; k < node.pieces.size(); ++k) {
            const std::vector<int> patch = decomposition.patch(decomposition.pieces[static_cast<std::size_t>(node.pieces[k])]);
            vertices.insert(patch.begin(), patch.end());
        }
        const std::vector<int> numbers(vertices.begin(), vertices.end());
        Mesh points;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const double* point = &decomposition.vertices[3 * static_cast<std::size_t>(numbers[i])];
            points.vertices.insert(points.vertices.end(), point, point + 3);
        }
        const swiftprox_shape* shape = make_hull(points);
        if (shape == NULL) {
            return false;
        }
        swiftprox_shape_info info;
        info.struct_size = sizeof info;
        bool is_known = swiftprox_shape_get_info(shape, &info) == SWIFTPROX_OK;
        std::vector<double> room(3 * info.vertex_count + 3);
        std::vector<uint32_t> labels(info.vertex_count + 1), triangles(3 * info.triangle_count + 3);
        is_known = is_known && swiftprox_shape_copy_vertices(shape, &room[0], &labels[0], info.vertex_count) == SWIFTPROX_OK &&
                   swiftprox_shape_copy_triangles(shape, &triangles[0], info.triangle_count) == SWIFTPROX_OK;
        swiftprox_shape_release(shape);
        for (std::size_t i = 0; i < 3 * info.triangle_count; ++i) {
            corners.push_back(numbers[labels[triangles[i]]]);
        }
        return is_known;
    }

    /* In the order of the nodes, behind those of the surface. */
    void number_own_faces(int surface_count)
    {
        std::vector<int> number_of(faces.size());
        std::vector<HullFace> ordered(faces.begin(), faces.begin() + surface_count);
        for (int face = 0; face < surface_count; ++face) {
            number_of[static_cast<std::size_t>(face)] = face;
        }
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (std::size_t k = 0; k < nodes[i].own.size(); ++k) {
                const std::size_t face = static_cast<std::size_t>(nodes[i].own[k]);
                number_of[face] = static_cast<int>(ordered.size());
                ordered.push_back(faces[face]);
            }
        }
        faces.swap(ordered);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            renumber(nodes[i].own, number_of);
            renumber(nodes[i].shared, number_of);
        }
    }

    static void renumber(std::vector<int>& numbers, const std::vector<int>& number_of)
    {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            numbers[i] = number_of[static_cast<std::size_t>(numbers[i])];
        }
    }
};

} // namespace swift_legacy

#endif
