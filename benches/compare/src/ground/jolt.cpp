// Jolt Physics' contacts of a body with its mesh of triangles, in single precision: CollideShape with faces, as its system calls
// it, and the points of both faces. What the system keeps of bodies that hardly moved is not called.

#include <Jolt/Jolt.h>

#include <Jolt/Core/Factory.h>
#include <Jolt/Physics/Collision/CollideShape.h>
#include <Jolt/Physics/Collision/CollisionDispatch.h>
#include <Jolt/Physics/Collision/InternalEdgeRemovingCollector.h>
#include <Jolt/Physics/Collision/ManifoldBetweenTwoFaces.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/RegisterTypes.h>

#include <cmath>
#include <vector>

extern "C" {
#include "../peers/peer.h"
}

namespace {

// PhysicsSettings::mManifoldToleranceSq.
constexpr float manifold_tolerance_square = 1e-6f;

class Counting : public JPH::CollideShapeCollector {
public:
    Counting(float margin, size_t *counted) : margin(margin), counted(counted) {}

    void AddHit(const JPH::CollideShapeResult &hit) override
    {
        JPH::ContactPoints on_body, on_ground;
        JPH::ManifoldBetweenTwoFaces(hit.mContactPointOn1, hit.mContactPointOn2, hit.mPenetrationAxis,
                                     margin * margin + manifold_tolerance_square, hit.mShape1Face, hit.mShape2Face, on_body,
                                     on_ground);
        counted[0] += 1;
        counted[1] += on_body.size();
        // From the body into the ground.
        counted[2] += -hit.mPenetrationAxis.GetZ() < std::sqrt(0.5f) * hit.mPenetrationAxis.Length();
    }

private:
    float margin;
    size_t *counted;
};

JPH::Array<JPH::Vec3> points_of(const peer_mesh &mesh)
{
    JPH::Array<JPH::Vec3> points;
    for (size_t i = 0; i < mesh.vertex_count; ++i) {
        const double *v = mesh.vertices + 3 * i;
        points.push_back(JPH::Vec3(float(v[0]), float(v[1]), float(v[2])));
    }
    return points;
}

} // namespace

extern "C" {

struct jolt_ground {
    JPH::ShapeRefC ground, body;
    std::vector<JPH::Mat44> poses; // of the centres of mass
    JPH::CollideShapeSettings settings;
    bool removes_edges;
};

// The body is a box of these half sides, or, where they are null, the hull of the mesh. Null where Jolt refuses one.
jolt_ground *jolt_ground_create(const peer_mesh *ground, const peer_mesh *body, const double *half, double margin, int removes_edges)
{
    JPH::RegisterDefaultAllocator();
    if (!JPH::VerifyJoltVersionID()) {
        return nullptr;
    }
    if (JPH::Factory::sInstance == nullptr) {
        JPH::Factory::sInstance = new JPH::Factory;
        JPH::RegisterTypes();
    }
    JPH::VertexList vertices;
    for (const JPH::Vec3 &point : points_of(*ground)) {
        vertices.push_back(JPH::Float3(point.GetX(), point.GetY(), point.GetZ()));
    }
    JPH::IndexedTriangleList triangles;
    for (size_t i = 0; i < ground->triangle_count; ++i) {
        const unsigned *corners = ground->corners + 3 * i;
        triangles.push_back(JPH::IndexedTriangle(corners[0], corners[1], corners[2], 0));
    }
    const JPH::ShapeSettings::ShapeResult mesh = JPH::MeshShapeSettings(vertices, triangles).Create();
    JPH::ShapeSettings::ShapeResult hull;
    if (half == nullptr) {
        hull = JPH::ConvexHullShapeSettings(points_of(*body), 0.0f).Create();
    } else {
        hull.Set(new JPH::BoxShape(JPH::Vec3(float(half[0]), float(half[1]), float(half[2])), 0.0f));
    }
    if (!mesh.IsValid() || !hull.IsValid()) {
        return nullptr;
    }
    jolt_ground *made = new jolt_ground{ mesh.Get(), hull.Get(), {}, {}, removes_edges != 0 };
    made->settings.mCollectFacesMode = JPH::ECollectFacesMode::CollectFaces;
    made->settings.mActiveEdgeMode = made->removes_edges ? JPH::EActiveEdgeMode::CollideWithAll
                                                         : JPH::EActiveEdgeMode::CollideOnlyWithActive;
    made->settings.mMaxSeparationDistance = float(margin);
    return made;
}

void jolt_ground_load(jolt_ground *ground, const double *poses, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        const double *m = poses + 12 * i;
        const auto column = [m](int k, float last) { return JPH::Vec4(float(m[k]), float(m[4 + k]), float(m[8 + k]), last); };
        const JPH::Mat44 pose(column(0, 0), column(1, 0), column(2, 0), column(3, 1));
        ground->poses.push_back(pose * JPH::Mat44::sTranslation(ground->body->GetCenterOfMass()));
    }
}

// Normals, points and normals more than 45 degrees off the vertical.
void jolt_ground_ask(jolt_ground *ground, size_t i, size_t *counted)
{
    counted[0] = counted[1] = counted[2] = 0;
    Counting all(ground->settings.mMaxSeparationDistance, counted);
    const JPH::Vec3 one = JPH::Vec3::sReplicate(1);
    const JPH::Mat44 place = JPH::Mat44::sTranslation(ground->ground->GetCenterOfMass());
    const auto collide = [&](JPH::CollideShapeCollector &collector) {
        JPH::CollisionDispatch::sCollideShapeVsShape(ground->body, ground->ground, one, one, ground->poses[i], place,
                                                     JPH::SubShapeIDCreator(), JPH::SubShapeIDCreator(), ground->settings, collector);
    };
    if (ground->removes_edges) {
        JPH::InternalEdgeRemovingCollector removing(all);
        collide(removing);
        removing.Flush();
    } else {
        collide(all);
    }
}

void jolt_ground_free(jolt_ground *ground)
{
    delete ground;
}
}
