// FCL's queries of convex bodies by both of its solvers: over libccd, which climbs from vertex 0 each time, and its own, which
// looks at all vertices and is handed its last guess.

#include <limits>
#include <memory>
#include <vector>

#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/detail/gjk_solver_indep.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>

extern "C" {
#include "peer.h"
}

using Convex = fcl::Convex<double>;
using Transform = fcl::Transform3<double>;
using Vector = fcl::Vector3<double>;

struct peer {
    std::unique_ptr<Convex> convex[2];
    fcl::detail::GJKSolver_libccd<double> solver;
    fcl::detail::GJKSolver_indep<double> own;
    const double *poses = nullptr;
};

static Transform transform(const double *m)
{
    Transform t = Transform::Identity();
    t.linear() << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    t.translation() << m[3], m[7], m[11];
    return t;
}

static Convex *convex(const peer_mesh &mesh)
{
    auto vertices = std::make_shared<std::vector<Vector>>();
    for (size_t i = 0; i < mesh.vertex_count; ++i) {
        vertices->emplace_back(mesh.vertices[3 * i], mesh.vertices[3 * i + 1], mesh.vertices[3 * i + 2]);
    }
    auto faces = std::make_shared<std::vector<int>>();
    for (size_t i = 0; i < 3 * mesh.triangle_count; ++i) {
        if (i % 3 == 0) {
            faces->push_back(3);
        }
        faces->push_back(static_cast<int>(mesh.corners[i]));
    }
    return new Convex(vertices, static_cast<int>(mesh.triangle_count), faces, true);
}

template <typename Solver> static double distance(const peer &peer, const Solver &solver, size_t i, double *normal)
{
    try {
        const double *poses = peer.poses + 24 * i;
        double distance = 0;
        Vector p1, p2;
        if (!solver.shapeDistance(*peer.convex[0], transform(poses), *peer.convex[1], transform(poses + 12), &distance, &p1, &p2)) {
            return 0;
        }
        Eigen::Map<Vector> said(normal);
        said = p1 - p2;
        return distance;
    } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}

template <typename Solver> static double verdict(const peer &peer, const Solver &solver, size_t i)
{
    try {
        const double *poses = peer.poses + 24 * i;
        const bool intersect = solver.shapeIntersect(*peer.convex[0], transform(poses), *peer.convex[1], transform(poses + 12));
        return intersect ? 0 : std::numeric_limits<double>::infinity();
    } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}

extern "C" {

peer *fcl_peer_create(const peer_mesh *meshes, double tolerance)
{
    try {
        std::unique_ptr<peer> made(new peer);
        for (int k = 0; k < 2; ++k) {
            made->convex[k].reset(convex(meshes[k]));
        }
        made->solver.distance_tolerance = made->solver.collision_tolerance = tolerance;
        made->own.gjk_tolerance = tolerance;
        made->own.enable_cached_guess = true;
        return made.release();
    } catch (...) {
        return nullptr;
    }
}

void fcl_peer_free(peer *peer)
{
    delete peer;
}

void fcl_peer_load(peer *peer, const double *poses, size_t)
{
    peer->poses = poses;
}

void fcl_peer_forget(peer *peer)
{
    peer->own.cached_guess = Vector(1, 0, 0);
}

double fcl_distance(peer *peer, size_t i, double *normal)
{
    return distance(*peer, peer->solver, i, normal);
}

double fcl_indep_distance(peer *peer, size_t i, double *normal)
{
    return distance(*peer, peer->own, i, normal);
}

double fcl_verdict(peer *peer, size_t i, double *)
{
    return verdict(*peer, peer->solver, i);
}

double fcl_indep_verdict(peer *peer, size_t i, double *)
{
    return verdict(*peer, peer->own, i);
}

double fcl_depth(peer *peer, size_t i, double *normal)
{
    try {
        const double *poses = peer->poses + 24 * i;
        double distance = std::numeric_limits<double>::quiet_NaN();
        Vector p1, p2;
        peer->solver.shapeSignedDistance(*peer->convex[0], transform(poses), *peer->convex[1], transform(poses + 12), &distance,
                                         &p1, &p2);
        Eigen::Map<Vector> said(normal);
        said = p1 - p2;
        return distance < 0 ? -distance : distance >= 0 ? 0 : distance;
    } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}
}
