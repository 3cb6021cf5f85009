/* The triangles between a patch, which lies on its convex hull, and the whole surface of that hull. */
#ifndef SWIFT_LEGACY_HULL_CLOSING_H
#define SWIFT_LEGACY_HULL_CLOSING_H

#include <algorithm>
#include <cmath>
#include <cstddef>
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

    /* Whether the hull is no thicker than the margin, as is seen from the triangle of the patch with the largest altitude. */
    bool is_flat(const std::vector<int>& patch) const
    {
        Plane plane, best;
        for (std::size_t i = 0; i < patch.size(); i += 3) {
            if (plane_through(patch[i], patch[i + 1], patch[i + 2], plane) && plane.altitude > best.altitude) {
                best = plane;
            }
        }
        bool is = true;
        for (std::size_t i = 0; best.altitude > 0 && is && i < extremes_.size(); ++i) {
            is = is_in(best, at(extremes_[i]));
        }
        return is;
    }

    /* Appends the triangles to `closing`, or nothing; false where triangles between the patch's own vertices do not close it. */
    bool close(const std::vector<int>& patch, std::vector<int>& closing) const
    {
        HalfEdges edges;
        for (std::size_t i = 0; i < patch.size(); i += 3) {
            if (!add_edges(edges, &patch[i])) {
                return false;
            }
        }
        const std::vector<std::pair<int, int> > missing = edges.missing_twins();
        OpenEdges open(missing.begin(), missing.end());
        std::vector<int> found;
        /* A hull of n vertices has fewer than 2 n triangles. */
        for (std::size_t left = 2 * vertices_.size() / 3; !open.empty(); --left) {
            int corners[3] = {open.begin()->first, open.begin()->second, NONE};
            corners[2] = apex_on(open, corners[0], corners[1]);
            if (corners[2] == NONE || left == 0 || !add_edges(edges, corners)) {
                return false;
            }
            for (int k = 0; k < 3; ++k) {
                const std::pair<int, int> edge(corners[k], corners[(k + 1) % 3]);
                if (open.erase(edge) == 0) {
                    open.insert(std::make_pair(edge.second, edge.first));
                }
            }
            found.insert(found.end(), corners, corners + 3);
        }
        closing.insert(closing.end(), found.begin(), found.end());
        return true;
    }

private:
    enum { NONE = -1 };
    const std::vector<double>& vertices_;
    const std::vector<int>& extremes_;
    double margin_;

    /* What a triangle is still to be on, from tail to head. */
    typedef std::set<std::pair<int, int> > OpenEdges;

    static bool add_edges(HalfEdges& edges, const int* corners)
    {
        bool are_new = true;
        for (int k = 0; k < 3; ++k) {
            are_new = edges.add(corners[k], corners[(k + 1) % 3], 0) && are_new;
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
    int apex_on(const OpenEdges& open, int tail, int head) const
    {
        int best = NONE;
        double least_cosine = 2;
        for (OpenEdges::const_iterator edge = open.begin(); edge != open.end(); ++edge) {
            const int vertex = edge->first;
            const double cosine = cosine_at(vertex, tail, head);
            if (open.count(std::make_pair(head, vertex)) != 0 && open.count(std::make_pair(vertex, tail)) != 0) {
                return vertex; /* what is left has three sides */
            }
            if (vertex != tail && vertex != head && cosine < least_cosine && is_admitted(open, tail, head, vertex)) {
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
    bool is_admitted(const OpenEdges& open, int a, int b, int c) const
    {
        Plane plane;
        if (!plane_through(a, b, c, plane)) {
            return false;
        }
        for (std::size_t i = 0; i < extremes_.size(); ++i) {
            if (plane.height(at(extremes_[i])) > margin_at(plane, at(extremes_[i]))) {
                return false;
            }
        }
        for (OpenEdges::const_iterator edge = open.begin(); edge != open.end(); ++edge) {
            const double *tail = at(edge->first), *head = at(edge->second);
            if (is_in(plane, tail) && is_in(plane, head) &&
                (plane.cross(tail, head, at(a), at(c)) || plane.cross(tail, head, at(b), at(c)))) {
                return false;
            }
        }
        return true;
    }

    struct Plane {
        const double* origin;
        double normal[3]; /* a unit vector */
        double altitude;  /* the least of the triangle that spans it; 0: none does */

        Plane() : origin(NULL), altitude(0)
        {
            std::fill(normal, normal + 3, 0.0);
        }

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

    bool is_in(const Plane& plane, const double* point) const
    {
        return std::fabs(plane.height(point)) <= margin_at(plane, point);
    }

    /* Corners that are off by the margin tilt the plane: by so many times that, farther away, as there are altitudes to there. */
    double margin_at(const Plane& plane, const double* point) const
    {
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            square += (point[axis] - plane.origin[axis]) * (point[axis] - plane.origin[axis]);
        }
        return margin_ * (1 + std::sqrt(square) / plane.altitude);
    }

    /* False where a corner is no farther than the margin from the line of the others. */
    bool plane_through(int a, int b, int c, Plane& plane) const
    {
        double u[3], v[3], first = 0, second = 0, third = 0, square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            u[axis] = at(b)[axis] - at(a)[axis];
            v[axis] = at(c)[axis] - at(a)[axis];
            first += u[axis] * u[axis];
            second += v[axis] * v[axis];
            third += (u[axis] - v[axis]) * (u[axis] - v[axis]);
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
        plane.altitude = std::sqrt(square / std::max(first, std::max(second, third)));
        return plane.altitude > margin_;
    }
};

} // namespace swift_legacy

#endif
