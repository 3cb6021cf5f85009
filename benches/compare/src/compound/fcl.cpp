// FCL's verdicts and distances of two equal bodies of many pieces, by managers with an object a piece.

#include <memory>
#include <vector>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/collision_object.h>

#include "managers.h"

namespace {

struct Fcl {
    using Object = fcl::CollisionObject<double>;
    using Manager = fcl::DynamicAABBTreeCollisionManager<double>;
    using Transform = fcl::Transform3<double>;
    using Convex = fcl::Convex<double>;

    static std::shared_ptr<Convex> convex(const peer_mesh &mesh)
    {
        auto vertices = std::make_shared<std::vector<fcl::Vector3<double>>>();
        for (const double *v = mesh.vertices; v != mesh.vertices + 3 * mesh.vertex_count; v += 3) {
            vertices->emplace_back(v[0], v[1], v[2]);
        }
        auto faces = std::make_shared<std::vector<int>>();
        for (const unsigned *c = mesh.corners; c != mesh.corners + 3 * mesh.triangle_count; c += 3) {
            faces->insert(faces->end(), {3, static_cast<int>(c[0]), static_cast<int>(c[1]), static_cast<int>(c[2])});
        }
        return std::make_shared<Convex>(vertices, static_cast<int>(mesh.triangle_count), faces, true);
    }

    static Transform transform(const double *m)
    {
        Transform t = Transform::Identity();
        t.linear() << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
        t.translation() << m[3], m[7], m[11];
        return t;
    }

    static Transform relative(const double *poses)
    {
        return transform(poses + 12).inverse() * transform(poses);
    }

    static double distance(const Manager &first, Manager &second)
    {
        fcl::DefaultDistanceData<double> data;
        first.distance(&second, &data, fcl::DefaultDistanceFunction);
        return data.result.min_distance;
    }

    static bool meet(const Manager &first, Manager &second)
    {
        fcl::DefaultCollisionData<double> data;
        first.collide(&second, &data, fcl::DefaultCollisionFunction);
        return data.result.isCollision();
    }
};

} // namespace

COMPOUND_PEER(fcl_pieces, Managers<Fcl>)
