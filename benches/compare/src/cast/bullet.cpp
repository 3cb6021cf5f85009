// Bullet's btContinuousConvexCollision of convex hulls without a margin, in double precision (Debian's bullet-float64): translation
// on a line, rotation by the shorter way between the ends.

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <limits>
#include <memory>
#include <vector>

#include "../peers/bullet.h"

extern "C" {
#include "peer.h"
}

namespace {

struct caster {
    std::unique_ptr<btConvexHullShape> hulls[2];
    std::vector<btTransform> poses;
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver depth;
};

} // namespace

extern "C" {

void *bullet_cast_create(const peer_mesh *meshes, const double *poses, size_t count)
{
    std::unique_ptr<caster> made(new caster);
    for (int k = 0; k < 2; ++k) {
        made->hulls[k].reset(new btConvexHullShape);
        for (size_t i = 0; i < meshes[k].vertex_count; ++i) {
            const double *v = meshes[k].vertices + 3 * i;
            made->hulls[k]->addPoint(btVector3(v[0], v[1], v[2]), false);
        }
        made->hulls[k]->setMargin(0);
        made->hulls[k]->recalcLocalAabb();
    }
    made->poses = bullet_transforms(poses, 4 * count);
    return made.release();
}

void bullet_cast_free(void *peer)
{
    delete static_cast<caster *>(peer);
}

double bullet_cast_ask(void *peer, size_t i)
{
    caster &asked = *static_cast<caster *>(peer);
    const btTransform *poses = &asked.poses[4 * i];
    btContinuousConvexCollision cast(asked.hulls[0].get(), asked.hulls[1].get(), &asked.simplex, &asked.depth);
    btConvexCast::CastResult result;
    const bool hits = cast.calcTimeOfImpact(poses[0], poses[2], poses[1], poses[3], result);
    return hits ? result.m_fraction : FREE;
}
}
