// FCL's signed distance of convex bodies: GJK and its own EPA, climbing from vertex 0 each time.

#include <limits>
#include <memory>
#include <vector>

#include <fcl/geometry/shape/convex.h>
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

extern "C" {

peer *fcl_depth_create(const peer_mesh *meshes, double tolerance)
{
    try {
        std::unique_ptr<peer> made(new peer);
        for (int k = 0; k < 2; ++k) {
            made->convex[k].reset(convex(meshes[k]));
        }
        made->solver.distance_tolerance = tolerance;
        return made.release();
    } catch (...) {
        return nullptr;
    }
}

void fcl_depth_free(peer *peer)
{
    delete peer;
}

void fcl_depth_load(peer *peer, const double *poses, size_t)
{
    peer->poses = poses;
}

void fcl_depth_forget(peer *) {}

double fcl_depth_ask(peer *peer, size_t i, double *normal)
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
