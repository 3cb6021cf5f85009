/* An object of convex pieces as one surface: what SWIFT++'s decomposer writes. */
#ifndef SWIFT_LEGACY_DECOMPOSITION_H
#define SWIFT_LEGACY_DECOMPOSITION_H

#include "hull_closing.h"
#include "objects.h"

namespace swift_legacy {

struct Decomposition {
    struct Piece {
        std::vector<int> faces;   /* of the surface, ascending */
        std::vector<int> closing; /* 3 vertices each: triangles that close its hull and are none of the surface */
    };
    std::vector<double> vertices;
    std::vector<int> vertex_labels; /* as the caller counts them; empty where that is their place */
    std::vector<int> corners;       /* of the surface's triangles, 3 each */
    std::vector<int> face_labels;   /* as vertex_labels */
    std::vector<int> piece_of_face;
    std::vector<Piece> pieces;

    std::size_t vertex_count() const
    {
        return vertices.size() / 3;
    }

    std::size_t face_count() const
    {
        return piece_of_face.size();
    }

    /* The corners of a piece's triangles of the surface. */
    std::vector<int> patch(const Piece& piece) const
    {
        std::vector<int> all;
        for (std::size_t i = 0; i < piece.faces.size(); ++i) {
            const std::vector<int>::const_iterator first = corners.begin() + 3 * piece.faces[i];
            all.insert(all.end(), first, first + 3);
        }
        return all;
    }
};

/* Makes the one surface of the pieces that a part has. */
class DecompositionBuilder {
public:
    explicit DecompositionBuilder(const Part& part) : part_(part), margin_(0) {}

    /* Empty, or why the part cannot be written. */
    std::string build(Decomposition& decomposition)
    {
        for (std::size_t i = 0; i < part_.pieces.size(); ++i) {
            if (!part_.pieces[i]->knows_faces) {
                return "the convex hull of piece " + text(i) + " counts, whose faces have no numbers";
            }
        }
        number_vertices(decomposition);
        decomposition.pieces.resize(part_.pieces.size());
        for (std::size_t i = 0; i < part_.pieces.size(); ++i) {
            add_triangles(static_cast<int>(i), decomposition.pieces[i]);
        }
        if (triangles_.empty()) {
            return "it has no faces";
        }
        number_faces(decomposition);
        close_pieces(decomposition);
        return "";
    }

private:
    typedef std::pair<double, std::pair<double, double> > Point;

    /* A triangle of the surface. They are in the order of their numbers, whatever that of the pieces. */
    struct Triangle {
        int label, piece;
        int corners[3];

        /* The corners from the least on: however they are turned. */
        std::vector<int> key() const
        {
            const int least = static_cast<int>(std::min_element(corners, corners + 3) - corners);
            std::vector<int> turned(1, label);
            for (int k = 0; k < 3; ++k) {
                turned.push_back(corners[(least + k) % 3]);
            }
            return turned;
        }

        bool operator<(const Triangle& other) const
        {
            return label != other.label ? label < other.label : key() < other.key();
        }
    };

    const Part& part_;
    std::map<Point, int> places_;
    std::vector<Triangle> triangles_;
    double margin_; /* how far a vertex may be above a plane and counts as on it */

    /* The margin is 1e-6 of the diagonal at least: this of it is above what planes of doubles are off by. */
    static double rounding_of(double margin)
    {
        return 1e-6 * margin;
    }

    /* 0 and -0 are equal. */
    static Point point_of(const Mesh& mesh, std::size_t vertex)
    {
        const double* p = &mesh.vertices[3 * vertex];
        return Point(p[0] + 0.0, std::make_pair(p[1] + 0.0, p[2] + 0.0));
    }

    /* Labels that are the places of what they label say nothing. */
    static void drop_if_places(std::vector<int>& labels)
    {
        bool are = true;
        for (std::size_t i = 0; are && i < labels.size(); ++i) {
            are = labels[i] == static_cast<int>(i);
        }
        if (are) {
            labels.clear();
        }
    }

    /* Equal vertices of all pieces are one, with the least of their numbers; they are in the order of these. */
    void number_vertices(Decomposition& decomposition)
    {
        for (std::size_t i = 0; i < part_.pieces.size(); ++i) {
            for (std::size_t v = 0; v < part_.pieces[i]->body().vertex_count(); ++v) {
                const int label = part_.pieces[i]->vertex_label(static_cast<uint32_t>(v));
                int& least = places_.insert(std::make_pair(point_of(part_.pieces[i]->body(), v), label)).first->second;
                least = std::min(least, label);
            }
        }
        std::vector<std::pair<int, Point> > ordered;
        for (std::map<Point, int>::const_iterator place = places_.begin(); place != places_.end(); ++place) {
            ordered.push_back(std::make_pair(place->second, place->first));
        }
        std::sort(ordered.begin(), ordered.end());
        for (std::size_t i = 0; i < ordered.size(); ++i) {
            const Point& point = ordered[i].second;
            places_[point] = static_cast<int>(i);
            decomposition.vertex_labels.push_back(ordered[i].first);
            decomposition.vertices.push_back(point.first);
            decomposition.vertices.push_back(point.second.first);
            decomposition.vertices.push_back(point.second.second);
        }
        drop_if_places(decomposition.vertex_labels);
        find_margin(decomposition.vertices);
    }

    /*
     * A patch may be as far from its hull as the precision of its coordinates excuses, relative to the diagonal of the whole. The
     * corners of a plane may be off by that, and so may what is looked at from it.
     */
    void find_margin(const std::vector<double>& vertices)
    {
        Mesh whole;
        whole.vertices = vertices;
        find_tolerance(whole);
        double square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double least = vertices[axis], greatest = least;
            for (std::size_t i = axis; i < vertices.size(); i += 3) {
                least = std::min(least, vertices[i]);
                greatest = std::max(greatest, vertices[i]);
            }
            square += (greatest - least) * (greatest - least);
        }
        margin_ = 2 * whole.tolerance * std::sqrt(square);
    }

    /* Faces without a number close the piece's hull. */
    void add_triangles(int index, Decomposition::Piece& piece)
    {
        const Geometry& geometry = *part_.pieces[static_cast<std::size_t>(index)];
        const Mesh& mesh = geometry.body();
        std::size_t begin = 0;
        for (std::size_t face = 0; face < mesh.face_count; ++face) {
            const std::size_t valence = mesh.valence(face), apex = apex_of_fan(mesh, begin, valence);
            const int label = geometry.face_label(static_cast<uint32_t>(face));
            for (std::size_t k = 1; k + 1 < valence; ++k) {
                Triangle triangle;
                triangle.label = label;
                triangle.piece = index;
                const std::size_t corners[3] = {apex, (apex + k) % valence, (apex + k + 1) % valence};
                for (int i = 0; i < 3; ++i) {
                    triangle.corners[i] = places_[point_of(mesh, mesh.indices[begin + corners[i]])];
                }
                const int* c = triangle.corners;
                if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) {
                    continue; /* equal vertices: no part of the surface */
                }
                if (label < 0) {
                    piece.closing.insert(piece.closing.end(), c, c + 3);
                } else {
                    triangles_.push_back(triangle);
                }
            }
            begin += valence;
        }
    }

    /* The corner from which a convex polygon falls into triangles the least of which is largest: corners may be in one line. */
    static std::size_t apex_of_fan(const Mesh& mesh, std::size_t begin, std::size_t valence)
    {
        std::size_t best = 0;
        double largest = -1;
        for (std::size_t apex = 0; valence > 3 && apex < valence; ++apex) {
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t k = 1; k + 1 < valence; ++k) {
                const std::size_t second = begin + (apex + k) % valence, third = begin + (apex + k + 1) % valence;
                least = std::min(least, double_area(mesh, begin + apex, second, third));
            }
            if (least > largest) {
                largest = least;
                best = apex;
            }
        }
        return best;
    }

    static double double_area(const Mesh& mesh, std::size_t a, std::size_t b, std::size_t c)
    {
        const double* p = &mesh.vertices[3 * static_cast<std::size_t>(mesh.indices[a])];
        const double* q = &mesh.vertices[3 * static_cast<std::size_t>(mesh.indices[b])];
        const double* r = &mesh.vertices[3 * static_cast<std::size_t>(mesh.indices[c])];
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const double entry = (q[u] - p[u]) * (r[v] - p[v]) - (q[v] - p[v]) * (r[u] - p[u]);
            square += entry * entry;
        }
        return std::sqrt(square);
    }

    void number_faces(Decomposition& decomposition)
    {
        std::stable_sort(triangles_.begin(), triangles_.end());
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            const Triangle& triangle = triangles_[i];
            decomposition.corners.insert(decomposition.corners.end(), triangle.corners, triangle.corners + 3);
            decomposition.face_labels.push_back(triangle.label);
            decomposition.piece_of_face.push_back(triangle.piece);
            decomposition.pieces[static_cast<std::size_t>(triangle.piece)].faces.push_back(static_cast<int>(i));
        }
        drop_if_places(decomposition.face_labels);
    }

    /*
     * Closes the hulls of pieces that are patches of the surface. Where a patch is flat, or coarse coordinates bend it so that
     * triangles between its own vertices make no convex body, each of its triangles is a piece: distances are those of the
     * surface, whatever the pieces.
     */
    void close_pieces(Decomposition& decomposition) const
    {
        std::vector<Decomposition::Piece> closed;
        for (std::size_t i = 0; i < part_.pieces.size(); ++i) {
            Decomposition::Piece& piece = decomposition.pieces[i];
            if (!part_.pieces[i]->is_patch || close(*part_.pieces[i], decomposition, piece)) {
                closed.push_back(piece);
                continue;
            }
            for (std::size_t k = 0; k < piece.faces.size(); ++k) {
                const int face = piece.faces[k], *corners = &decomposition.corners[3 * static_cast<std::size_t>(face)];
                const int turned[3] = {corners[0], corners[2], corners[1]};
                Decomposition::Piece flat;
                flat.faces.push_back(face);
                flat.closing.assign(turned, turned + 3);
                closed.push_back(flat);
            }
        }
        decomposition.pieces.swap(closed);
        for (std::size_t i = 0; i < decomposition.pieces.size(); ++i) {
            const std::vector<int>& faces = decomposition.pieces[i].faces;
            for (std::size_t k = 0; k < faces.size(); ++k) {
                decomposition.piece_of_face[static_cast<std::size_t>(faces[k])] = static_cast<int>(i);
            }
        }
    }

    /* Whether a piece is convex up to the precision of its own coordinates, as whoever reads the file asks. */
    static bool is_convex(const Decomposition& decomposition, const std::vector<int>& patch, const std::vector<int>& closing)
    {
        std::vector<Mesh> levels(1);
        levels[0].vertices = decomposition.vertices;
        levels[0].indices.assign(patch.begin(), patch.end());
        levels[0].indices.insert(levels[0].indices.end(), closing.begin(), closing.end());
        levels[0].face_count = levels[0].indices.size() / 3;
        levels[0].drop_unused_vertices();
        find_tolerance(levels[0]);
        const swiftprox_shape* shape = make_shape(levels, LevelOptions(DEFAULT_MIN_TCOUNT, DEFAULT_QSLIM_TRATIO));
        swiftprox_shape_release(shape);
        return shape != NULL;
    }

    /* False where the patch is flat, or triangles between its vertices do not close its hull. */
    bool close(const Geometry& geometry, const Decomposition& decomposition, Decomposition::Piece& piece) const
    {
        const std::vector<int> patch = decomposition.patch(piece);
        swiftprox_shape_info info;
        info.struct_size = sizeof info;
        if (swiftprox_shape_get_info(geometry.shape, &info) != SWIFTPROX_OK) {
            return false;
        }
        std::vector<double> room(3 * info.vertex_count);
        std::vector<uint32_t> labels(info.vertex_count);
        if (swiftprox_shape_copy_vertices(geometry.shape, &room[0], &labels[0], info.vertex_count) != SWIFTPROX_OK) {
            return false;
        }
        std::vector<int> extremes;
        for (std::size_t i = 0; i < labels.size(); ++i) {
            extremes.push_back(places_.find(point_of(geometry.body(), labels[i]))->second);
        }
        const HullClosing by_precision(decomposition.vertices, extremes, margin_);
        if (info.dimension < 3 || by_precision.is_flat(patch)) {
            return false;
        }
        /* The hull of the coordinates as they are; where the patch is bent by their precision, one within that. */
        const HullClosing by_rounding(decomposition.vertices, extremes, rounding_of(margin_));
        std::vector<int> closing;
        if ((!by_rounding.close(patch, closing) && !by_precision.close(patch, closing)) || !is_convex(decomposition, patch, closing)) {
            return false;
        }
        piece.closing.swap(closing);
        return true;
    }
};

} // namespace swift_legacy

#endif
