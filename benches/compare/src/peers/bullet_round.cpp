// Bullet's btGjkPairDetector of its own primitives, in double precision (Debian's bullet-float64): the last separating axis is
// kept, and depths come of its penetration solver by EPA.

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <limits>
#include <memory>
#include <vector>

#include "bullet.h"

extern "C" {
#include "peer.h"
}

struct peer {
    std::unique_ptr<btConvexShape> shapes[2];
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver depth;
    std::unique_ptr<btGjkPairDetector> detector;
    std::vector<btTransform> poses;
};

// Of a point a sphere, of a segment along z a capsule, of eight corners along the axes a box, whose margin is in its half extents.
static btConvexShape *shape(const peer_mesh &mesh)
{
    const double *last = mesh.vertices + 3 * (mesh.vertex_count - 1);
    switch (mesh.vertex_count) {
    case 1:
        return new btSphereShape(mesh.radius);
    case 2:
        return new btCapsuleShapeZ(mesh.radius, 2 * last[2]);
    case 8: {
        btBoxShape *box = new btBoxShape(btVector3(last[0] + mesh.radius, last[1] + mesh.radius, last[2] + mesh.radius));
        box->setMargin(mesh.radius);
        return box;
    }
    default: {
        btConvexHullShape *hull = new btConvexHullShape;
        for (size_t i = 0; i < mesh.vertex_count; ++i) {
            const double *v = mesh.vertices + 3 * i;
            hull->addPoint(btVector3(v[0], v[1], v[2]), false);
        }
        hull->setMargin(mesh.radius);
        hull->recalcLocalAabb();
        return hull;
    }
    }
}

// The signed distance and along what; infinity where it says none.
static double ask(peer *peer, size_t i, double *normal)
{
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = peer->poses[2 * i];
    input.m_transformB = peer->poses[2 * i + 1];
    btPointCollector found;
    peer->detector->getClosestPoints(input, found, nullptr);
    for (int k = 0; k < 3; ++k) {
        normal[k] = found.m_normalOnBInWorld[k];
    }
    return found.m_hasResult ? found.m_distance : std::numeric_limits<double>::infinity();
}

extern "C" {

void bullet_round_forget(peer *peer)
{
    peer->detector.reset(new btGjkPairDetector(peer->shapes[0].get(), peer->shapes[1].get(), &peer->simplex, &peer->depth));
}

peer *bullet_round_create(const peer_mesh *meshes, double)
{
    peer *made = new peer;
    for (int k = 0; k < 2; ++k) {
        made->shapes[k].reset(shape(meshes[k]));
    }
    bullet_round_forget(made);
    return made;
}

void bullet_round_free(peer *peer)
{
    delete peer;
}

void bullet_round_load(peer *peer, const double *poses, size_t count)
{
    peer->poses = bullet_transforms(poses, 2 * count);
}

double bullet_round_distance(peer *peer, size_t i, double *normal)
{
    const double distance = ask(peer, i, normal);
    return distance < 0 ? 0 : distance;
}

double bullet_round_verdict(peer *peer, size_t i, double *normal)
{
    return ask(peer, i, normal) > 0 ? std::numeric_limits<double>::infinity() : 0;
}

double bullet_round_depth(peer *peer, size_t i, double *normal)
{
    const double distance = ask(peer, i, normal);
    return distance < 0 ? -distance : 0;
}
}
