// FCL's broad phase and its convex-convex queries for crowd/fcl.rs. No exception leaves this file.

#include <memory>
#include <vector>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

namespace {

using Object = fcl::CollisionObject<double>;

struct Crowd {
    std::vector<std::shared_ptr<fcl::CollisionGeometry<double>>> meshes;
    std::vector<std::unique_ptr<Object>> bodies;
    fcl::DynamicAABBTreeCollisionManager<double> manager;
    bool is_set_up = false;
};

struct Found {
    double tolerance;
    size_t pairs;
    double sum;
};

bool collide(Object *a, Object *b, void *data)
{
    fcl::CollisionRequest<double> request;
    fcl::CollisionResult<double> result;
    fcl::collide(a, b, request, result);
    static_cast<Found *>(data)->pairs += result.isCollision();
    return false;
}

bool contact(Object *a, Object *b, void *data)
{
    Found *found = static_cast<Found *>(data);
    fcl::CollisionRequest<double> request(1, true);
    fcl::CollisionResult<double> result;
    try {
        fcl::collide(a, b, request, result);
    } catch (const std::exception &) {
        return false; // its expanding polytope gave up: the pair is missing in the count
    }
    if (result.isCollision()) {
        ++found->pairs;
        found->sum += result.getContact(0).penetration_depth;
    }
    return false;
}

bool distance(Object *a, Object *b, void *data, double &nearest)
{
    Found *found = static_cast<Found *>(data);
    fcl::DistanceRequest<double> request;
    fcl::DistanceResult<double> result;
    fcl::distance(a, b, request, result);
    if (result.min_distance <= found->tolerance) {
        ++found->pairs;
        found->sum += result.min_distance > 0 ? result.min_distance : 0;
    }
    nearest = found->tolerance;
    return false;
}

} // namespace

extern "C" {

Crowd *fcl_crowd_create()
{
    try {
        return new Crowd;
    } catch (...) {
        return nullptr;
    }
}

void fcl_crowd_add_mesh(Crowd *crowd, const double *coordinates, size_t vertex_count, const unsigned *corners,
                        size_t triangle_count)
{
    auto vertices = std::make_shared<std::vector<fcl::Vector3<double>>>();
    for (size_t i = 0; i < vertex_count; ++i)
        vertices->emplace_back(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
    auto faces = std::make_shared<std::vector<int>>();
    for (size_t i = 0; i < triangle_count; ++i) {
        faces->push_back(3);
        for (size_t k = 0; k < 3; ++k)
            faces->push_back(static_cast<int>(corners[3 * i + k]));
    }
    crowd->meshes.push_back(
        std::make_shared<fcl::Convex<double>>(vertices, static_cast<int>(triangle_count), faces, true));
}

void fcl_crowd_add_body(Crowd *crowd, size_t mesh)
{
    crowd->bodies.push_back(std::unique_ptr<Object>(new Object(crowd->meshes[mesh])));
}

void fcl_crowd_move(Crowd *crowd, size_t body, const double *m)
{
    fcl::Transform3<double> t = fcl::Transform3<double>::Identity();
    t.linear() << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    t.translation() << m[3], m[7], m[11];
    crowd->bodies[body]->setTransform(t);
    crowd->bodies[body]->computeAABB();
}

// Pairs that intersect (question 0), are at most the tolerance apart (1), or intersect, and how deep (2). Not 0 after an exception.
int fcl_crowd_ask(Crowd *crowd, int question, double tolerance, size_t *pairs, double *sum)
{
    try {
        if (!crowd->is_set_up) {
            // All at once, where they are: one by one at one place they make a list, not a tree.
            std::vector<Object *> bodies;
            for (const auto &body : crowd->bodies)
                bodies.push_back(body.get());
            crowd->manager.registerObjects(bodies);
            crowd->manager.setup();
        }
        crowd->is_set_up = true;
        crowd->manager.update();
        Found found = {tolerance, 0, 0};
        if (question == 1) {
            crowd->manager.distance(&found, distance);
        } else {
            crowd->manager.collide(&found, question == 0 ? collide : contact);
        }
        *pairs = found.pairs;
        *sum = found.sum;
        return 0;
    } catch (...) {
        return 1;
    }
}

void fcl_crowd_destroy(Crowd *crowd)
{
    delete crowd;
}
}
