/* Convex pieces, shared by the objects that are copies of each other. */
#ifndef SWIFT_LEGACY_GEOMETRY_H
#define SWIFT_LEGACY_GEOMETRY_H

#include "native.h"

namespace swift_legacy {

struct Geometry {
    int shares;
    const swiftprox_shape* shape;
    std::vector<Mesh> levels; /* the body and, where the caller gave them, its levels of detail; after the input transform */
    bool knows_faces;         /* faces in answers are the caller's, else those of a hull */
    bool is_patch;            /* a piece of a decomposition: some faces of its hull are none of the caller's */
#if defined(SWIFT_ONLY_TRIS) && defined(SWIFT_REPORT_EDGE_IDS)
    typedef std::map<std::pair<uint32_t, uint32_t>, int> EdgeIds;
    EdgeIds edge_ids; /* of the edges from corner to corner of the caller's triangles, of equal vertices the first */
#endif

    const Mesh& body() const
    {
        return levels[0];
    }

    int vertex_label(uint32_t vertex) const
    {
        return body().vertex_labels.empty() ? static_cast<int>(vertex) : body().vertex_labels[vertex];
    }

    int face_label(uint32_t face) const
    {
        if (!knows_faces || face == SWIFTPROX_NO_FACE) {
            return -1;
        }
        return body().face_labels.empty() ? static_cast<int>(face) : body().face_labels[face];
    }

#if defined(SWIFT_ONLY_TRIS) && defined(SWIFT_REPORT_EDGE_IDS)
    void number_edges()
    {
        const std::vector<uint32_t> first = body().first_of_equal_vertices();
        for (std::size_t i = 0; i < body().indices.size() && body().valences.empty(); ++i) {
            const std::size_t face = i / 3, corner = i % 3;
            const int label = face_label(static_cast<uint32_t>(face));
            const uint32_t tail = first[body().indices[i]], head = first[body().indices[3 * face + (corner + 1) % 3]];
            edge_ids[std::make_pair(tail, head)] = label < 0 ? -1 : 3 * label + static_cast<int>(corner);
        }
    }

    /*
     * 3 * face + k for the edge from corner k to the next. An edge of the hull may be several of the caller's in one line: then it
     * is the first one of these. -1: there is none.
     */
    int edge_id(uint32_t tail, uint32_t head) const
    {
        for (int way = 0; way < 2; ++way) {
            const EdgeIds::const_iterator found = edge_ids.find(std::make_pair(tail, head));
            if (found != edge_ids.end()) {
                return found->second;
            }
            std::swap(tail, head);
        }
        int best = -1;
        double most = -2;
        for (EdgeIds::const_iterator edge = edge_ids.lower_bound(std::make_pair(tail, 0u));
             edge != edge_ids.end() && edge->first.first == tail; ++edge) {
            const double along = cosine(tail, edge->first.second, head);
            if (along > most) {
                most = along;
                best = edge->second;
            }
        }
        return best;
    }

    /* Of the angle at a vertex between two others. */
    double cosine(uint32_t at, uint32_t to, uint32_t other) const
    {
        const double* p = &body().vertices[3 * static_cast<std::size_t>(at)];
        const double* q = &body().vertices[3 * static_cast<std::size_t>(to)];
        const double* r = &body().vertices[3 * static_cast<std::size_t>(other)];
        double dot = 0;
        for (int axis = 0; axis < 3; ++axis) {
            dot += (q[axis] - p[axis]) * (r[axis] - p[axis]);
        }
        return dot / std::sqrt(square_distance(to, p) * square_distance(other, p));
    }
#endif

    /* The corner of a face that is nearest to a point. */
    uint32_t nearest_corner(uint32_t face, const double* point) const
    {
        const Mesh& mesh = body();
        std::size_t begin = 0, end = mesh.indices.size();
        if (knows_faces && face != SWIFTPROX_NO_FACE) {
            begin = 3 * static_cast<std::size_t>(face);
            if (!mesh.valences.empty()) {
                begin = 0;
                for (uint32_t before = 0; before < face; ++before) {
                    begin += mesh.valences[before];
                }
            }
            end = begin + mesh.valence(face);
        }
        uint32_t nearest = mesh.indices[begin];
        for (std::size_t i = begin; i < end; ++i) {
            if (square_distance(mesh.indices[i], point) < square_distance(nearest, point)) {
                nearest = mesh.indices[i];
            }
        }
        return nearest;
    }

    double square_distance(uint32_t vertex, const double* point) const
    {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = body().vertices[3 * static_cast<std::size_t>(vertex) + static_cast<std::size_t>(axis)] - point[axis];
            sum += d * d;
        }
        return sum;
    }
};

/* A share of a geometry, as a value. */
class Piece {
public:
    Piece() : geometry_(NULL) {}

    Piece(const Piece& other) : geometry_(other.geometry_)
    {
        if (geometry_ != NULL) {
            ++geometry_->shares;
        }
    }

    Piece& operator=(const Piece& other)
    {
        Piece copy(other);
        std::swap(geometry_, copy.geometry_);
        return *this;
    }

    ~Piece()
    {
        if (geometry_ != NULL && --geometry_->shares == 0) {
            swiftprox_shape_release(geometry_->shape);
            delete geometry_;
        }
    }

    /* Takes the meshes, which are empty then. False after a failure, which swiftprox_library_last_error_message explains. */
    bool make(std::vector<Mesh>& levels, Convexity convexity, const LevelOptions& options)
    {
        const bool is_patch = convexity == CONVEXITY_OF_PATCH;
        const swiftprox_shape* shape = is_patch ? make_hull_of_patch(levels[0]) : make_shape(levels, options);
        const bool knows_faces = shape != NULL;
        if (shape == NULL && convexity == CONVEXITY_BY_HULL) {
            shape = make_hull(levels[0]);
        }
        if (shape == NULL) {
            return false;
        }
        *this = Piece();
        geometry_ = new Geometry();
        geometry_->shares = 1;
        geometry_->shape = shape;
        geometry_->levels.swap(levels);
        geometry_->knows_faces = knows_faces;
        geometry_->is_patch = is_patch;
#if defined(SWIFT_ONLY_TRIS) && defined(SWIFT_REPORT_EDGE_IDS)
        geometry_->number_edges();
#endif
        return true;
    }

    const Geometry& operator*() const
    {
        return *geometry_;
    }

    const Geometry* operator->() const
    {
        return geometry_;
    }

private:
    Geometry* geometry_;
};

} // namespace swift_legacy

#endif
