// Two equal bodies of many pieces in the managers of FCL, and of coal that came of it: an object a piece. The second body stays, so
// that the first alone is moved, to where it is seen from the second.
#ifndef COMPARE_COMPOUND_MANAGERS_H
#define COMPARE_COMPOUND_MANAGERS_H

#include <algorithm>
#include <memory>
#include <vector>

#include "peer.h"

// How the first body is placed, seen from the second, of each pose.
template <typename Library> std::vector<typename Library::Transform> relative_poses(const compound_scene &scene)
{
    std::vector<typename Library::Transform> poses;
    for (size_t k = 0; k < scene.pose_count; ++k) {
        poses.push_back(Library::relative(scene.poses + 24 * k));
    }
    return poses;
}

template <typename Library> class Managers {
    struct Body {
        std::vector<std::unique_ptr<typename Library::Object>> objects;
        typename Library::Manager manager;
    };

    Body bodies[2];
    std::vector<typename Library::Transform> poses;
    bool asks_distance;

public:
    explicit Managers(const compound_scene &scene)
        : poses(relative_poses<Library>(scene)), asks_distance(scene.asks_distance)
    {
        for (size_t k = 0; k < scene.piece_count; ++k) {
            const auto piece = Library::convex(scene.pieces[k]);
            for (Body &body : bodies) {
                body.objects.emplace_back(new typename Library::Object(piece));
            }
        }
        for (Body &body : bodies) {
            std::vector<typename Library::Object *> objects;
            for (const auto &object : body.objects) {
                objects.push_back(object.get());
            }
            body.manager.registerObjects(objects);
            body.manager.setup();
        }
    }

    double ask(size_t k)
    {
        for (const auto &object : bodies[0].objects) {
            object->setTransform(poses[k]);
            object->computeAABB();
        }
        bodies[0].manager.update();
        if (asks_distance) {
            return std::max(0.0, Library::distance(bodies[0].manager, bodies[1].manager));
        }
        return Library::meet(bodies[0].manager, bodies[1].manager) ? 0 : 1;
    }
};

#endif
