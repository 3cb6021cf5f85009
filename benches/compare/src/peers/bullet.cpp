// Bullet's GJK and EPA in double precision, from its header alone: Debian's library is of single precision. Its tolerance, 1e-4,
// and its 64 vertices are written into the header. The support climbs, where btConvexHullShape looks at all vertices.

#define BT_USE_DOUBLE_PRECISION
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa3.h>

#include <limits>
#include <vector>

#include "bullet.h"
#include "hull.h"

extern "C" {
#include "peer.h"
}

namespace {

struct Placed {
    const hull *body;
    btTransform at;
    unsigned *last;

    const btTransform &getWorldTransform() const
    {
        return at;
    }
    btVector3 getObjectCenterInWorld() const
    {
        return at.getOrigin();
    }
    btVector3 getLocalSupportWithMargin(const btVector3 &towards) const
    {
        const double direction[3] = {towards.x(), towards.y(), towards.z()};
        *last = hull_climb(body, direction, *last);
        const double *vertex = body->vertices + 3 * *last;
        return btVector3(vertex[0], vertex[1], vertex[2]);
    }
};

} // namespace

struct peer {
    hull *bodies[2];
    std::vector<btTransform> poses;
    btVector3 guess;
    unsigned last[2];
};

namespace {

using Results = btGjkEpaSolver3::sResults;

struct Pair {
    Placed first, second;
};

Pair placed(peer *peer, size_t i)
{
    return {{peer->bodies[0], peer->poses[2 * i], &peer->last[0]}, {peer->bodies[1], peer->poses[2 * i + 1], &peer->last[1]}};
}

// The normal is in the axes of the first body, unlike the points.
void tell(const Pair &pair, const Results &results, double *normal)
{
    const btVector3 turned = pair.first.at.getBasis() * results.normal;
    for (int k = 0; k < 3; ++k) {
        normal[k] = turned[k];
    }
}

} // namespace

extern "C" {

void bullet_peer_forget(peer *peer)
{
    peer->guess = btVector3(1, 0, 0);
    peer->last[0] = peer->last[1] = 0;
}

void bullet_peer_free(peer *peer)
{
    hull_free(peer->bodies[0]);
    hull_free(peer->bodies[1]);
    delete peer;
}

peer *bullet_peer_create(const peer_mesh *meshes, double)
{
    peer *made = new peer{};
    for (int k = 0; k < 2; ++k) {
        const peer_mesh &mesh = meshes[k];
        made->bodies[k] = hull_create(mesh.vertices, mesh.vertex_count, mesh.corners, mesh.triangle_count);
    }
    if (!made->bodies[0] || !made->bodies[1]) {
        bullet_peer_free(made);
        return nullptr;
    }
    bullet_peer_forget(made);
    return made;
}

void bullet_peer_load(peer *peer, const double *poses, size_t count)
{
    peer->poses = bullet_transforms(poses, 2 * count);
}

double bullet_distance(peer *peer, size_t i, double *normal)
{
    const Pair pair = placed(peer, i);
    Results results;
    if (!btGjkEpaSolver3_Distance(pair.first, pair.second, peer->guess, results)) {
        return results.status == Results::GJK_Failed ? std::numeric_limits<double>::quiet_NaN() : 0;
    }
    peer->guess = results.normal;
    tell(pair, results, normal);
    return results.distance;
}

double bullet_depth(peer *peer, size_t i, double *normal)
{
    const Pair pair = placed(peer, i);
    Results results;
    if (btGjkEpaSolver3_Penetration(pair.first, pair.second, peer->guess, results)) {
        peer->guess = results.normal;
        tell(pair, results, normal);
        return -results.distance;
    }
    const bool failed = results.status == Results::EPA_Failed || results.status == Results::GJK_Failed;
    return failed ? std::numeric_limits<double>::quiet_NaN() : 0;
}
}
