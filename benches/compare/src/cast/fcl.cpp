// FCL's conservative advancement with its libccd solver: translation on a line, rotation by the shorter way between the ends.

#include <limits>
#include <memory>
#include <vector>

#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/continuous_collision.h>

extern "C" {
#include "peer.h"
}

using Convex = fcl::Convex<double>;
using Transform = fcl::Transform3<double>;
using Vector = fcl::Vector3<double>;

namespace {

struct caster {
    std::unique_ptr<Convex> convex[2];
    const double *poses;
    fcl::ContinuousCollisionRequest<double> request;
};

Transform transform(const double *m)
{
    Transform t = Transform::Identity();
    t.linear() << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    t.translation() << m[3], m[7], m[11];
    return t;
}

Convex *convex(const peer_mesh &mesh)
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

} // namespace

extern "C" {

void *fcl_cast_create(const peer_mesh *meshes, const double *poses, size_t)
{
    try {
        std::unique_ptr<caster> made(new caster);
        for (int k = 0; k < 2; ++k) {
            made->convex[k].reset(convex(meshes[k]));
            made->convex[k]->computeLocalAABB();
        }
        made->poses = poses;
        made->request = fcl::ContinuousCollisionRequest<double>(1000, 1e-6, fcl::CCDM_LINEAR, fcl::GST_LIBCCD,
                                                                fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
        return made.release();
    } catch (...) {
        return nullptr;
    }
}

void fcl_cast_free(void *peer)
{
    delete static_cast<caster *>(peer);
}

double fcl_cast_ask(void *peer, size_t i)
{
    try {
        const caster &asked = *static_cast<caster *>(peer);
        const double *poses = asked.poses + 48 * i;
        fcl::ContinuousCollisionResult<double> result;
        const double time = fcl::continuousCollide(asked.convex[0].get(), transform(poses), transform(poses + 24), asked.convex[1].get(),
                                                   transform(poses + 12), transform(poses + 36), asked.request, result);
        return time < 0 ? std::numeric_limits<double>::quiet_NaN() : result.is_collide ? result.time_of_contact : FREE;
    } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}
}
