// Jolt Physics' queries of its ConvexHullShape, which are of single precision, without convex radius: distances and verdicts by its
// GJK, depths by its EPA, as its own collision of convex shapes calls them. That begins each time along the line of the centres,
// and so do depths here: begun along the last axis they are no quicker, and those of bodies with parallel faces are off by up to
// 2e-3. Distances and verdicts begin along the last axis. Its hulls have at most 256 vertices, and their support looks at all of
// them.

#include <Jolt/Jolt.h>

#include <Jolt/Geometry/EPAPenetrationDepth.h>
#include <Jolt/Physics/Collision/CollideShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/RegisterTypes.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

extern "C" {
#include "peer.h"
}

using Support = JPH::ConvexShape::Support;
using Placed = JPH::TransformedConvexObject<Support>;

struct peer {
    JPH::ShapeRefC shapes[2];
    JPH::ConvexShape::SupportBuffer buffers[2];
    const Support *supports[2];
    std::vector<JPH::Mat44> poses; // of the centres of mass
    JPH::Vec3 axis;                // from the first body to the second; zero where none is known
    float tolerance;
};

namespace {

// Null where Jolt makes no hull of it; of more vertices than it takes it would leave some out.
JPH::ShapeRefC shape(const peer_mesh &mesh)
{
    if (mesh.vertex_count > JPH::ConvexHullShape::cMaxPointsInHull) {
        return nullptr;
    }
    JPH::Array<JPH::Vec3> points;
    for (size_t i = 0; i < mesh.vertex_count; ++i) {
        const double *v = mesh.vertices + 3 * i;
        points.push_back(JPH::Vec3(float(v[0]), float(v[1]), float(v[2])));
    }
    JPH::ConvexHullShapeSettings settings(points, 0.0f);
    settings.mHullTolerance = std::numeric_limits<float>::epsilon(); // what is farther out by 1e-3 may be left out else
    const JPH::ShapeSettings::ShapeResult result = settings.Create();
    return result.IsValid() ? result.Get() : nullptr;
}

JPH::Mat44 transform(const double *m, JPH::Vec3Arg centre)
{
    const auto column = [m](int k) { return JPH::Vec4(float(m[k]), float(m[4 + k]), float(m[8 + k]), 0); };
    float moved[3];
    for (int k = 0; k < 3; ++k) {
        const double *row = m + 4 * k;
        moved[k] = float(row[0] * centre.GetX() + row[1] * centre.GetY() + row[2] * centre.GetZ() + row[3]);
    }
    return JPH::Mat44(column(0), column(1), column(2), JPH::Vec4(moved[0], moved[1], moved[2], 1));
}

Placed second_in_first(const peer &peer, size_t i)
{
    return Placed(peer.poses[2 * i].InversedRotationTranslation() * peer.poses[2 * i + 1], *peer.supports[1]);
}

JPH::Vec3 line_of_centres(const Placed &second)
{
    const JPH::Vec3 centre = second.mTransform.GetTranslation();
    return centre.IsNearZero() ? JPH::Vec3::sAxisX() : centre;
}

// Where distances and verdicts begin.
JPH::Vec3 guess(const peer &peer, const Placed &second)
{
    return peer.axis.IsNearZero() ? line_of_centres(second) : peer.axis;
}

void tell(const peer &peer, size_t i, JPH::Vec3Arg axis, double *normal)
{
    const JPH::Vec3 turned = peer.poses[2 * i].Multiply3x3(axis);
    for (int k = 0; k < 3; ++k) {
        normal[k] = turned[k];
    }
}

} // namespace

extern "C" {

void jolt_peer_forget(peer *peer)
{
    peer->axis = JPH::Vec3::sZero();
}

void jolt_peer_free(peer *peer)
{
    delete peer;
}

peer *jolt_peer_create(const peer_mesh *meshes, double tolerance)
{
    JPH::RegisterDefaultAllocator();
    if (!JPH::VerifyJoltVersionID()) { // compiled with other definitions than the library
        return nullptr;
    }
    peer *made = new peer{};
    for (int k = 0; k < 2; ++k) {
        made->shapes[k] = shape(meshes[k]);
        if (made->shapes[k] == nullptr) {
            jolt_peer_free(made);
            return nullptr;
        }
        const auto *hull = static_cast<const JPH::ConvexHullShape *>(made->shapes[k].GetPtr());
        made->supports[k] = hull->GetSupportFunction(JPH::ConvexShape::ESupportMode::ExcludeConvexRadius, made->buffers[k],
                                                     JPH::Vec3::sReplicate(1));
    }
    made->tolerance = float(tolerance);
    jolt_peer_forget(made);
    return made;
}

void jolt_peer_load(peer *peer, const double *poses, size_t count)
{
    peer->poses.clear();
    for (size_t i = 0; i < 2 * count; ++i) {
        peer->poses.push_back(transform(poses + 12 * i, peer->shapes[i % 2]->GetCenterOfMass()));
    }
}

double jolt_distance(peer *peer, size_t i, double *normal)
{
    const Placed second = second_in_first(*peer, i);
    peer->axis = guess(*peer, second);
    JPH::GJKClosestPoint gjk;
    JPH::Vec3 first_point, second_point;
    const float square = gjk.GetClosestPoints(*peer->supports[0], second, peer->tolerance, FLT_MAX, peer->axis, first_point,
                                              second_point);
    tell(*peer, i, peer->axis, normal);
    return std::sqrt(double(square));
}

double jolt_verdict(peer *peer, size_t i, double *)
{
    const Placed second = second_in_first(*peer, i);
    peer->axis = guess(*peer, second);
    JPH::GJKClosestPoint gjk;
    const bool intersect = gjk.Intersects(*peer->supports[0], second, peer->tolerance, peer->axis);
    return intersect ? 0 : std::numeric_limits<double>::infinity();
}

double jolt_depth(peer *peer, size_t i, double *normal)
{
    const Placed second = second_in_first(*peer, i);
    const Support &first = *peer->supports[0];
    JPH::EPAPenetrationDepth epa;
    JPH::Vec3 axis = line_of_centres(second), first_point, second_point;
    // A tolerance of depths that is loose makes no bodies touch that are apart.
    const float touching = std::min(peer->tolerance, JPH::cDefaultCollisionTolerance);
    const auto status = epa.GetPenetrationDepthStepGJK(first, 0, second, 0, touching, axis, first_point, second_point);
    if (status == JPH::EPAPenetrationDepth::EStatus::NotColliding ||
        !epa.GetPenetrationDepthStepEPA(first, second, peer->tolerance, axis, first_point, second_point)) {
        return 0;
    }
    tell(*peer, i, axis, normal);
    return (second_point - first_point).Length();
}
}
