// Bullet's persistent manifold of two convex hulls without a margin, as its step updates it, in double precision (Debian's
// bullet-float64). Faces are given to the hulls, so that one query clips a whole manifold.

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include <algorithm>
#include <vector>

#include "../peers/bullet.h"

extern "C" {
#include "../peers/peer.h"
}

struct peer {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btConvexHullShape hulls[2];
    btCollisionObject objects[2];
    std::vector<btTransform> poses;
    btDispatcherInfo info;
    btPersistentManifold *manifold = nullptr;
    btCollisionAlgorithm *algorithm = nullptr;
};

extern "C" {

void bullet_rest_forget(peer *peer)
{
    if (peer->manifold) {
        peer->manifold->clearManifold();
    }
}

void bullet_rest_free(peer *peer)
{
    if (peer->algorithm) {
        peer->algorithm->~btCollisionAlgorithm();
        peer->dispatcher.freeCollisionAlgorithm(peer->algorithm);
        peer->dispatcher.releaseManifold(peer->manifold);
    }
    delete peer;
}

peer *bullet_rest_create(const peer_mesh *meshes, double)
{
    peer *made = new peer;
    for (int k = 0; k < 2; ++k) {
        for (size_t i = 0; i < meshes[k].vertex_count; ++i) {
            const double *v = meshes[k].vertices + 3 * i;
            made->hulls[k].addPoint(btVector3(v[0], v[1], v[2]), false);
        }
        made->hulls[k].setMargin(0);
        made->hulls[k].recalcLocalAabb();
        made->hulls[k].initializePolyhedralFeatures();
        made->objects[k].setCollisionShape(&made->hulls[k]);
    }
    made->manifold = made->dispatcher.getNewManifold(&made->objects[0], &made->objects[1]);
    btCollisionObjectWrapper first(nullptr, &made->hulls[0], &made->objects[0], made->objects[0].getWorldTransform(), -1, -1);
    btCollisionObjectWrapper second(nullptr, &made->hulls[1], &made->objects[1], made->objects[1].getWorldTransform(), -1, -1);
    made->algorithm = made->dispatcher.findAlgorithm(&first, &second, made->manifold, BT_CONTACT_POINT_ALGORITHMS);
    return made;
}

void bullet_rest_load(peer *peer, const double *poses, size_t count)
{
    peer->poses = bullet_transforms(poses, 2 * count);
}

double bullet_rest_manifold(peer *peer, size_t i, double *normal)
{
    for (int k = 0; k < 2; ++k) {
        peer->objects[k].setWorldTransform(peer->poses[2 * i + k]);
    }
    const btCollisionObject &one = peer->objects[0], &other = peer->objects[1];
    btCollisionObjectWrapper first(nullptr, &peer->hulls[0], &one, one.getWorldTransform(), -1, -1);
    btCollisionObjectWrapper second(nullptr, &peer->hulls[1], &other, other.getWorldTransform(), -1, -1);
    btManifoldResult result(&first, &second);
    peer->algorithm->processCollision(&first, &second, peer->info, &result);
    double deepest = 0;
    for (int k = 0; k < peer->manifold->getNumContacts(); ++k) {
        const btManifoldPoint &point = peer->manifold->getContactPoint(k);
        if (-point.getDistance() > deepest) {
            deepest = -point.getDistance();
            std::copy_n(&point.m_normalWorldOnB[0], 3, normal);
        }
    }
    return deepest;
}
}
