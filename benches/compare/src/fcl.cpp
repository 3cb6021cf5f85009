// FCL's convex-convex distance (libccd solver) for fcl.rs. No exception leaves this file.

#include <limits>
#include <memory>
#include <vector>

#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>

using Convex = fcl::Convex<double>;
using Vector = fcl::Vector3<double>;

namespace {

fcl::Transform3<double> transform(const double *m)
{
    fcl::Transform3<double> t = fcl::Transform3<double>::Identity();
    t.linear() << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    t.translation() << m[3], m[7], m[11];
    return t;
}

} // namespace

extern "C" {

// Triangles over vertices; null when FCL refuses them.
Convex *fcl_shim_convex(const double *coordinates, size_t vertex_count, const unsigned *corners, size_t triangle_count)
{
    try {
        auto vertices = std::make_shared<std::vector<Vector>>();
        for (size_t i = 0; i < vertex_count; ++i) {
            vertices->emplace_back(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
        }
        auto faces = std::make_shared<std::vector<int>>();
        for (size_t i = 0; i < triangle_count; ++i) {
            faces->push_back(3);
            for (size_t k = 0; k < 3; ++k) {
                faces->push_back(static_cast<int>(corners[3 * i + k]));
            }
        }
        return new Convex(vertices, static_cast<int>(triangle_count), faces, true);
    } catch (...) {
        return nullptr;
    }
}

void fcl_shim_free(Convex *convex)
{
    delete convex;
}

// The distance with witness points in the world frame; 0 when intersecting, NaN after an exception.
double fcl_shim_distance(const Convex *convex, const double *poses, double tolerance, double *points)
{
    try {
        fcl::detail::GJKSolver_libccd<double> solver;
        solver.distance_tolerance = tolerance;
        double distance = 0;
        Vector p1, p2;
        const bool separated =
            solver.shapeDistance(*convex, transform(poses), *convex, transform(poses + 12), &distance, &p1, &p2);
        if (!separated) {
            return 0;
        }
        for (int k = 0; k < 3; ++k) {
            points[k] = p1[k];
            points[3 + k] = p2[k];
        }
        return distance;
    } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}
}
