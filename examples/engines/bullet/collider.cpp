#include "collider.h"

#include <cstdint>

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

namespace
{

swiftprox::Pose pose_of(const btTransform &transform)
{
    const btMatrix3x3 &r = transform.getBasis();
    const btVector3 &t = transform.getOrigin();
    return swiftprox::Pose({r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2]},
                           {t[0], t[1], t[2]});
}

const swiftprox::Shape &shape_of(const btCollisionObjectWrapper *object)
{
    return *static_cast<const swiftprox::Shape *>(object->getCollisionShape()->getUserPointer());
}

// One pair, as long as Bullet's broad phase holds it: what the pair remembers lives here.
class Algorithm final : public btCollisionAlgorithm
{
  public:
    Algorithm(const btCollisionAlgorithmConstructionInfo &info, const btCollisionObject *a, const btCollisionObject *b)
        : btCollisionAlgorithm(info), manifold_(m_dispatcher->getNewManifold(a, b))
    {
    }
    ~Algorithm() override { m_dispatcher->releaseManifold(manifold_); }

    void processCollision(const btCollisionObjectWrapper *a, const btCollisionObjectWrapper *b, const btDispatcherInfo &,
                          btManifoldResult *result) override
    {
        result->setPersistentManifold(manifold_);
        const btTransform &a_from = a->getWorldTransform(), &b_from = b->getWorldTransform();
        swiftprox::ManifoldConfig config;
        config.reduces = true;
        config.max_distance = manifold_->getContactBreakingThreshold();
        swiftprox_manifold_point points[MANIFOLD_CACHE_SIZE];
        const auto found = swiftprox::try_manifold({shape_of(a), pose_of(a_from)}, {shape_of(b), pose_of(b_from)}, cache_,
                                                   {points, MANIFOLD_CACHE_SIZE}, config);
        // A pose is refused where the simulation has gone to infinity: no contact then, as with Bullet's own.
        const std::uint32_t count = found ? found.value.point_count : 0;
        btManifoldPoint before[MANIFOLD_CACHE_SIZE];
        const int before_count = manifold_->getNumContacts();
        for (int i = 0; i < before_count; ++i) {
            before[i] = manifold_->getContactPoint(i);
        }
        manifold_->clearManifold();
        const double *const n = found.value.normal;
        for (std::uint32_t i = 0; i < count; ++i) {
            const swiftprox_manifold_point &from = points[i];
            const auto vector = [](const double *v) {
                return btVector3(static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2]));
            };
            // Both normals go from b to a.
            btManifoldPoint point(vector(from.local1), vector(from.local2), vector(n),
                                  static_cast<btScalar>(0.5 * (from.gap_lower + from.gap_upper)));
            point.m_positionWorldOnA = vector(from.world1);
            point.m_positionWorldOnB = vector(from.world2);
            point.m_combinedFriction = btManifoldResult::calculateCombinedFriction(a->getCollisionObject(), b->getCollisionObject());
            point.m_combinedRestitution =
                btManifoldResult::calculateCombinedRestitution(a->getCollisionObject(), b->getCollisionObject());
            btPlaneSpace1(point.m_normalWorldOnB, point.m_lateralFrictionDir1, point.m_lateralFrictionDir2);
            // A point keeps its impulse while its id stays: Bullet's solver begins with that.
            point.m_index0 = static_cast<int>(static_cast<std::uint32_t>(from.id));
            point.m_index1 = static_cast<int>(static_cast<std::uint32_t>(from.id >> 32));
            for (int k = 0; k < before_count; ++k) {
                if (before[k].m_index0 == point.m_index0 && before[k].m_index1 == point.m_index1) {
                    point.m_appliedImpulse = before[k].m_appliedImpulse;
                    point.m_lifeTime = before[k].m_lifeTime + 1;
                }
            }
            manifold_->addManifoldPoint(point);
        }
    }

    // Bullet's continuous collision steps bodies back by it: 1 lets them go all the way.
    btScalar calculateTimeOfImpact(btCollisionObject *, btCollisionObject *, const btDispatcherInfo &, btManifoldResult *) override
    {
        return 1;
    }

    void getAllContactManifolds(btManifoldArray &manifolds) override { manifolds.push_back(manifold_); }

  private:
    btPersistentManifold *manifold_;
    swiftprox::ManifoldCache cache_;
};

class CreateFunction final : public btCollisionAlgorithmCreateFunc
{
  public:
    btCollisionAlgorithm *CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo &info, const btCollisionObjectWrapper *a,
                                                   const btCollisionObjectWrapper *b) override
    {
        void *const memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm));
        return new (memory) Algorithm(info, a->getCollisionObject(), b->getCollisionObject());
    }
};

} // namespace

void collider_attach(btCollisionShape &bullet_shape, const swiftprox::Shape &shape)
{
    bullet_shape.setUserPointer(const_cast<swiftprox::Shape *>(&shape));
}

int collider_size()
{
    return sizeof(Algorithm);
}

void collider_install(btCollisionDispatcher &dispatcher)
{
    static CreateFunction function;
    dispatcher.registerCollisionCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, &function);
}
