// coal's verdicts and distances of two equal bodies of many pieces, by a manager for each with an object a piece. The second body
// stays, so that the first alone is moved, to where it is seen from the second.

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/broadphase/default_broadphase_callbacks.h>
#include <coal/collision_object.h>
#include <coal/shape/convex.h>

using Convex = coal::Convex<coal::Triangle>;

namespace {

struct Body {
    std::vector<std::unique_ptr<coal::CollisionObject>> objects;
    coal::DynamicAABBTreeCollisionManager manager;
};

}

struct coal_compound {
    std::vector<std::shared_ptr<Convex>> pieces;
    Body bodies[2];
    std::vector<coal::Transform3s> poses;
};

static coal::Transform3s transform(const double *m)
{
    coal::Matrix3s rotation;
    rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    return coal::Transform3s(rotation, coal::Vec3s(m[3], m[7], m[11]));
}

static double ask(coal_compound &compound, const coal::Transform3s &pose, bool asks_distance)
{
    Body *bodies = compound.bodies;
    for (auto &object : bodies[0].objects) {
        object->setTransform(pose);
        object->computeAABB();
    }
    bodies[0].manager.update();
    if (asks_distance) {
        coal::DistanceCallBackDefault callback;
        callback.data.request.enable_signed_distance = false;
        bodies[0].manager.distance(&bodies[1].manager, &callback);
        return std::max(0.0, callback.data.result.min_distance);
    }
    coal::CollisionCallBackDefault callback;
    bodies[0].manager.collide(&bodies[1].manager, &callback);
    return callback.data.result.isCollision() ? 0 : 1;
}

extern "C" {

coal_compound *coal_compound_create(const double *coordinates, const size_t *vertex_counts, const unsigned *corners,
                                    const size_t *triangle_counts, size_t piece_count)
{
    try {
        std::unique_ptr<coal_compound> made(new coal_compound);
        for (size_t k = 0; k < piece_count; ++k) {
            auto points = std::make_shared<std::vector<coal::Vec3s>>();
            for (size_t i = 0; i < vertex_counts[k]; ++i, coordinates += 3) {
                points->emplace_back(coordinates[0], coordinates[1], coordinates[2]);
            }
            auto triangles = std::make_shared<std::vector<coal::Triangle>>();
            for (size_t i = 0; i < triangle_counts[k]; ++i, corners += 3) {
                triangles->emplace_back(corners[0], corners[1], corners[2]);
            }
            made->pieces.push_back(std::make_shared<Convex>(points, static_cast<unsigned>(vertex_counts[k]), triangles,
                                                            static_cast<unsigned>(triangle_counts[k])));
        }
        for (Body &body : made->bodies) {
            for (auto &piece : made->pieces) {
                body.objects.emplace_back(new coal::CollisionObject(piece));
                body.manager.registerObject(body.objects.back().get());
            }
            body.manager.setup();
        }
        return made.release();
    } catch (...) {
        return nullptr;
    }
}

void coal_compound_load(coal_compound *compound, const double *poses, size_t count)
{
    compound->poses.clear();
    for (size_t k = 0; k < count; ++k, poses += 24) {
        compound->poses.push_back(transform(poses + 12).inverseTimes(transform(poses)));
    }
}

double coal_compound_ask(coal_compound *compound, size_t k, int asks_distance)
{
    try {
        return ask(*compound, compound->poses[k], asks_distance);
    } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}

void coal_compound_free(coal_compound *compound)
{
    delete compound;
}
}
