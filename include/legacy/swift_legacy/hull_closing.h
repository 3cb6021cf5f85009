/* The triangles between a patch, which lies on its convex hull, and the whole surface of that hull. */
#ifndef SWIFT_LEGACY_HULL_CLOSING_H
#define SWIFT_LEGACY_HULL_CLOSING_H

#include <cmath>
#include <set>

#include "half_edges.h"

namespace swift_legacy {

/* From the open edges of the patch inwards, a triangle of the hull on each, as gift wrapping does. */
class HullClosing {
public:
    /* `extremes` are the vertices of the hull; `margin` is how far a vertex may be above a plane and counts as on it. */
    HullClosing(const std::vector<double>& vertices, const std::vector<int>& extremes, double margin)
        : vertices_(vertices), extremes_(extremes), margin_(margin)
    {
    }

    /* Appends the triangles to `closing`; false where the patch cannot be closed by triangles between its own vertices. */
    bool close(const std::vector<int>& patch, std::vector<int>& closing)
    {
        for (std::size_t i = 0; i < patch.size(); i += 3) {
            if (!add_edges(&patch[i])) {
                return false;
            }
        }
        const std::vector<std::pair<int, int> > missing = edges_.missing_twins();
        open_.insert(missing.begin(), missing.end());
        /* A hull of n vertices has fewer than 2 n triangles. */
        for (std::size_t left = 2 * vertices_.size() / 3; !open_.empty(); --left) {
            int corners[3] = {open_.begin()->first, open_.begin()->second, NONE};
            corners[2] = apex_on(corners[0], corners[1]);
            if (corners[2] == NONE || left == 0 || !add_edges(corners)) {
                return false;
            }
            for (int k = 0; k < 3; ++k) {
                const std::pair<int, int> edge(corners[k], corners[(k + 1) % 3]);
                if (open_.erase(edge) == 0) {
                    open_.insert(std::make_pair(edge.second, edge.first));
                }
            }
            closing.insert(closing.end(), corners, corners + 3);
        }
        return true;
    }

private:
    enum { NONE = -1 };
    const std::vector<double>& vertices_;
    const std::vector<int>& extremes_;
    double margin_;
    HalfEdges edges_;
    std::set<std::pair<int, int> > open_; /* what a triangle is still to be on, from tail to head */

    bool add_edges(const int* corners)
    {
        bool are_new = true;
        for (int k = 0; k < 3; ++k) {
            are_new = edges_.add(corners[k], corners[(k + 1) % 3], 0) && are_new;
        }
        return are_new;
    }

    const double* at(int vertex) const
    {
        return &vertices_[3 * static_cast<std::size_t>(vertex)];
    }

    /*
     * The apex of the hull's triangle on an edge: no vertex is above its plane. Of several, which are in one plane, that which sees
     * the edge widest past all open edges, so that none of the others is in the triangle (constrained Delaunay).
     */
    int apex_on(int tail, int head) const
    {
        int best = NONE;
        double least_cosine = 2;
        for (std::set<std::pair<int, int> >::const_iterator edge = open_.begin(); edge != open_.end(); ++edge) {
            const int vertex = edge->first;
            const double cosine = cosine_at(vertex, tail, head);
            if (vertex != tail && vertex != head && cosine < least_cosine && is_admitted(tail, head, vertex)) {
                best = vertex;
                least_cosine = cosine;
            }
        }
        return best;
    }

    double cosine_at(int vertex, int tail, int head) const
    {
        double dot = 0, first = 0, second = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double u = at(tail)[axis] - at(vertex)[axis], v = at(head)[axis] - at(vertex)[axis];
            dot += u * v, first += u * u, second += v * v;
        }
        return first > 0 && second > 0 ? dot / std::sqrt(first) / std::sqrt(second) : 1;
    }

    /* Whether a triangle has a plane, the hull is below it, and no open edge in that plane comes between. */
    bool is_admitted(int a, int b, int c) const
    {
        Plane plane;
        if (!plane_through(a, b, c, plane)) {
            return false;
        }
        for (std::size_t i = 0; i < extremes_.size(); ++i) {
            if (plane.height(at(extremes_[i])) > margin_) {
                return false;
            }
        }
        for (std::set<std::pair<int, int> >::const_iterator edge = open_.begin(); edge != open_.end(); ++edge) {
            const double *tail = at(edge->first), *head = at(edge->second);
            if (std::fabs(plane.height(tail)) <= margin_ && std::fabs(plane.height(head)) <= margin_ &&
                (plane.cross(tail, head, at(a), at(c)) || plane.cross(tail, head, at(b), at(c)))) {
                return false;
            }
        }
        return true;
    }

    struct Plane {
        const double* origin;
        double normal[3]; /* a unit vector */

        double height(const double* point) const
        {
            double sum = 0;
            for (int axis = 0; axis < 3; ++axis) {
                sum += normal[axis] * (point[axis] - origin[axis]);
            }
            return sum;
        }

        /* Positive where p, q, r run counter-clockwise. */
        double turn(const double* p, const double* q, const double* r) const
        {
            double sum = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                sum += normal[axis] * ((q[u] - p[u]) * (r[v] - p[v]) - (q[v] - p[v]) * (r[u] - p[u]));
            }
            return sum;
        }

        /* Whether two segments of the plane cross, away from their ends. */
        bool cross(const double* p, const double* q, const double* r, const double* s) const
        {
            return turn(p, q, r) * turn(p, q, s) < 0 && turn(r, s, p) * turn(r, s, q) < 0;
        }
    };

    /* False where the third vertex is no farther than the margin from the line of the others. */
    bool plane_through(int a, int b, int c, Plane& plane) const
    {
        double u[3], v[3], base = 0, square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            u[axis] = at(b)[axis] - at(a)[axis];
            v[axis] = at(c)[axis] - at(a)[axis];
            base += u[axis] * u[axis];
        }
        for (int axis = 0; axis < 3; ++axis) {
            const int next = (axis + 1) % 3, last = (axis + 2) % 3;
            plane.normal[axis] = u[next] * v[last] - u[last] * v[next];
            square += plane.normal[axis] * plane.normal[axis];
        }
        for (int axis = 0; axis < 3; ++axis) {
            plane.normal[axis] /= std::sqrt(square);
        }
        plane.origin = at(a);
        return std::sqrt(square) > margin_ * std::sqrt(base);
    }
};

} // namespace swift_legacy

#endif
