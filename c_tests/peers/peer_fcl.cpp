// Verdicts, distances and nearest points of FCL 0.7, with both of its solvers.

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "peers.h"
#include "swiftprox/geometry.h"

namespace {

using Convex = fcl::Convex<double>;

// FCL walks over edges to find supports, so it gets the hull's triangles.
void *create(const body *body)
{
    swiftprox_shape_info info;
    info.struct_size = sizeof info;
    if (swiftprox_shape_get_info(body->shape, &info) != SWIFTPROX_OK)
        return nullptr;
    std::vector<double> coordinates(3 * info.vertex_count);
    std::vector<uint32_t> corners(3 * info.triangle_count);
    if (swiftprox_shape_copy_vertices(body->shape, coordinates.data(), nullptr, info.vertex_count) != SWIFTPROX_OK ||
        (info.triangle_count > 0 &&
         swiftprox_shape_copy_triangles(body->shape, corners.data(), info.triangle_count) != SWIFTPROX_OK))
        return nullptr;
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (std::size_t i = 0; i < info.vertex_count; ++i)
        vertices->emplace_back(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
    auto faces = std::make_shared<std::vector<int>>();
    for (std::size_t t = 0; t < info.triangle_count; ++t) {
        faces->push_back(3);
        for (int k = 0; k < 3; ++k)
            faces->push_back(static_cast<int>(corners[3 * t + k]));
    }
    return new Convex(vertices, static_cast<int>(info.triangle_count), faces);
}

void destroy(void *of_peer)
{
    delete static_cast<Convex *>(of_peer);
}

fcl::Transform3d transform(const double pose[12])
{
    fcl::Transform3d result = fcl::Transform3d::Identity();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            result.linear()(i, j) = pose[4 * i + j];
        result.translation()(i) = pose[4 * i + 3];
    }
    return result;
}

template <fcl::GJKSolverType solver>
void query(const peer *peer, const body *body1, const double *pose1, const body *body2, const double *pose2,
           peer_answer *answer)
{
    const double unsaid = std::numeric_limits<double>::quiet_NaN();
    *answer = {PEER_THREW, unsaid, unsaid};
    try {
        const auto *first = static_cast<const Convex *>(body1->of_peer);
        const auto *second = static_cast<const Convex *>(body2->of_peer);
        const fcl::Transform3d at1 = transform(pose1), at2 = transform(pose2);

        fcl::CollisionRequestd collision_request;
        collision_request.gjk_solver_type = solver;
        collision_request.gjk_tolerance = peer->tolerance;
        fcl::CollisionResultd collision;
        fcl::collide(first, at1, second, at2, collision_request, collision);
        if (collision.isCollision()) {
            answer->outcome = PEER_INTERSECTING;
            return;
        }

        fcl::DistanceRequestd distance_request;
        distance_request.enable_nearest_points = true;
        distance_request.gjk_solver_type = solver;
        distance_request.distance_tolerance = peer->tolerance;
        fcl::DistanceResultd distance;
        fcl::distance(first, at1, second, at2, distance_request, distance);
        answer->outcome = PEER_SEPARATED;
        // A negative distance means penetration, contrary to what collide said: distance 0, and no nearest points.
        answer->distance = std::max(distance.min_distance, 0.0);
        if (distance.min_distance >= 0)
            answer->point_distance = (distance.nearest_points[0] - distance.nearest_points[1]).norm();
    } catch (...) {
        answer->outcome = PEER_THREW;
    }
}

} // namespace

const peer all_peers[] = {
    {"FCL, GST_LIBCCD", "fcl-libccd", 1e-6, 1, create, destroy, query<fcl::GST_LIBCCD>},
    {"FCL, GST_INDEP", "fcl-indep", 1e-6, 1, create, destroy, query<fcl::GST_INDEP>},
};
const std::size_t all_peer_count = sizeof all_peers / sizeof *all_peers;
