// Bullet's verdict of two btCompoundShapes of convex hulls without margins, in double precision (Debian's bullet-float64), by its
// btCompoundCompoundCollisionAlgorithm.

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include <memory>
#include <vector>

#include "../peers/bullet.h"
#include "peer.h"

namespace {

// Whether a point is said not to be above the other body. No points are kept.
struct Verdict : btManifoldResult {
    bool meets = false;

    using btManifoldResult::btManifoldResult;

    void addContactPoint(const btVector3 &, const btVector3 &, btScalar distance) override
    {
        meets |= distance <= 0;
    }
};

// Bullet asks a function without a context whether two pieces are to be tested: none after two that meet.
const Verdict *asked;

bool is_open(const btCollisionShape *, const btCollisionShape *)
{
    return !asked->meets;
}

class Compounds {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    std::vector<std::unique_ptr<btConvexHullShape>> hulls;
    btCompoundShape body;
    btCollisionObject objects[2];
    btCollisionObjectWrapper first{nullptr, &body, &objects[0], objects[0].getWorldTransform(), -1, -1};
    btCollisionObjectWrapper second{nullptr, &body, &objects[1], objects[1].getWorldTransform(), -1, -1};
    btCollisionAlgorithm *algorithm;
    std::vector<btTransform> poses;

public:
    explicit Compounds(const compound_scene &scene) : poses(bullet_transforms(scene.poses, 2 * scene.pose_count))
    {
        for (size_t k = 0; k < scene.piece_count; ++k) {
            const peer_mesh &mesh = scene.pieces[k];
            hulls.emplace_back(new btConvexHullShape);
            for (const double *v = mesh.vertices; v != mesh.vertices + 3 * mesh.vertex_count; v += 3) {
                hulls[k]->addPoint(btVector3(v[0], v[1], v[2]), false);
            }
            hulls[k]->setMargin(0);
            hulls[k]->recalcLocalAabb();
            body.addChildShape(btTransform::getIdentity(), hulls[k].get());
        }
        body.setMargin(0);
        // Its tree as pieces have come one by one takes up to a thousand times as long.
        body.getDynamicAabbTree()->optimizeTopDown();
        for (btCollisionObject &object : objects) {
            object.setCollisionShape(&body);
        }
        algorithm = dispatcher.findAlgorithm(&first, &second, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    }

    ~Compounds()
    {
        algorithm->~btCollisionAlgorithm();
        dispatcher.freeCollisionAlgorithm(algorithm);
    }

    // The algorithm stays from pose to pose, as in Bullet's world. It walks on after a hit, but tests no more pieces.
    double ask(size_t k)
    {
        for (int i = 0; i < 2; ++i) {
            objects[i].setWorldTransform(poses[2 * k + i]);
        }
        Verdict verdict(&first, &second);
        asked = &verdict;
        gCompoundCompoundChildShapePairCallback = is_open;
        algorithm->processCollision(&first, &second, btDispatcherInfo(), &verdict);
        gCompoundCompoundChildShapePairCallback = nullptr;
        asked = nullptr;
        return verdict.meets ? 0 : 1;
    }
};

} // namespace

COMPOUND_PEER(bullet_pieces, Compounds)
