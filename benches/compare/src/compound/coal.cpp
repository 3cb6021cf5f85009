// coal's verdicts and distances of two equal bodies of many pieces: by managers with an object a piece, and by its hierarchy of
// boxes over the triangles of the surface.

#include <algorithm>
#include <memory>
#include <vector>

#include <coal/BV/OBBRSS.h>
#include <coal/BVH/BVH_model.h>
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/broadphase/default_broadphase_callbacks.h>
#include <coal/collision.h>
#include <coal/collision_object.h>
#include <coal/distance.h>
#include <coal/shape/convex.h>

#include "managers.h"

namespace {

using Points = std::vector<coal::Vec3s>;
using Triangles = std::vector<coal::Triangle>;

Points points_of(const peer_mesh &mesh)
{
    Points points;
    for (const double *v = mesh.vertices; v != mesh.vertices + 3 * mesh.vertex_count; v += 3) {
        points.emplace_back(v[0], v[1], v[2]);
    }
    return points;
}

Triangles triangles_of(const peer_mesh &mesh)
{
    Triangles triangles;
    for (const unsigned *c = mesh.corners; c != mesh.corners + 3 * mesh.triangle_count; c += 3) {
        triangles.emplace_back(c[0], c[1], c[2]);
    }
    return triangles;
}

struct Coal {
    using Object = coal::CollisionObject;
    using Manager = coal::DynamicAABBTreeCollisionManager;
    using Transform = coal::Transform3s;
    using Convex = coal::Convex<coal::Triangle>;

    static std::shared_ptr<Convex> convex(const peer_mesh &mesh)
    {
        return std::make_shared<Convex>(
            std::make_shared<Points>(points_of(mesh)), static_cast<unsigned>(mesh.vertex_count),
            std::make_shared<Triangles>(triangles_of(mesh)), static_cast<unsigned>(mesh.triangle_count));
    }

    static Transform transform(const double *m)
    {
        coal::Matrix3s rotation;
        rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
        return Transform(rotation, coal::Vec3s(m[3], m[7], m[11]));
    }

    static Transform relative(const double *poses)
    {
        return transform(poses + 12).inverseTimes(transform(poses));
    }

    static double distance(const Manager &first, Manager &second)
    {
        coal::DistanceCallBackDefault callback;
        callback.data.request.enable_signed_distance = false;
        first.distance(&second, &callback);
        return callback.data.result.min_distance;
    }

    static bool meet(const Manager &first, Manager &second)
    {
        coal::CollisionCallBackDefault callback;
        callback.data.request = verdict();
        first.collide(&second, &callback);
        return callback.data.result.isCollision();
    }

    // No depth is asked, and no pair of shapes for longer than until it is known to be apart.
    static coal::CollisionRequest verdict()
    {
        coal::CollisionRequest request;
        request.enable_contact = false;
        request.distance_upper_bound = 0;
        return request;
    }
};

// Two such surfaces that enclose the same volume cannot be one inside the other, which triangles would not tell.
class Surfaces {
    coal::BVHModel<coal::OBBRSS> model;
    std::vector<coal::Transform3s> poses;
    bool asks_distance;

public:
    explicit Surfaces(const compound_scene &scene)
        : poses(relative_poses<Coal>(scene)), asks_distance(scene.asks_distance)
    {
        model.beginModel();
        model.addSubModel(points_of(scene.surface), triangles_of(scene.surface));
        model.endModel();
    }

    double ask(size_t k) const
    {
        const coal::Transform3s still;
        if (asks_distance) {
            coal::DistanceRequest request;
            request.enable_signed_distance = false;
            coal::DistanceResult result;
            return std::max(0.0, coal::distance(&model, poses[k], &model, still, request, result));
        }
        coal::CollisionResult result;
        return coal::collide(&model, poses[k], &model, still, Coal::verdict(), result) > 0 ? 0 : 1;
    }
};

} // namespace

COMPOUND_PEER(coal_pieces, Managers<Coal>)
COMPOUND_PEER(coal_bvh, Surfaces)
