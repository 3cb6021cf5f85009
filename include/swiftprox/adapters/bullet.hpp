/*
 * swiftprox as a collision algorithm of Bullet, for pairs of convex hulls: up to four contacts, which keep their impulses while
 * their features stay. Nothing throws.
 *
 *   btDefaultCollisionConstructionInfo info;
 *   info.m_customCollisionAlgorithmMaxElementSize = swiftprox::adapters::bullet::algorithm_size();
 *   ...
 *   swiftprox::adapters::bullet::install(dispatcher);
 *   swiftprox::adapters::bullet::attach(hull, shape);   // of each btConvexHullShape; without a shape Bullet's own collider answers
 */
#ifndef SWIFTPROX_ADAPTERS_BULLET_HPP
#define SWIFTPROX_ADAPTERS_BULLET_HPP

#include "../pair.hpp"

#include <cstdint>
#include <new>

#include <btBulletCollisionCommon.h>

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

namespace swiftprox::adapters::bullet
{

namespace detail
{

inline Pose pose_of(const btTransform &transform)
{
    const btMatrix3x3 &r = transform.getBasis();
    const btVector3 &t = transform.getOrigin();
    return Pose({r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2]},
                {t[0], t[1], t[2]});
}

/** Null where none is attached. */
inline const Shape *shape_of(const btCollisionObjectWrapper *object)
{
    return static_cast<const Shape *>(object->getCollisionShape()->getUserPointer());
}

/** One pair, as long as Bullet's broad phase holds it: what the pair remembers lives here. */
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
        ManifoldConfig config;
        config.reduces = true;
        config.max_distance = manifold_->getContactBreakingThreshold();
        swiftprox_manifold_point points[MANIFOLD_CACHE_SIZE];
        const auto found = try_manifold({*shape_of(a), pose_of(a_from)}, {*shape_of(b), pose_of(b_from)}, cache_,
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
            point.m_combinedFriction =
                btManifoldResult::calculateCombinedFriction(a->getCollisionObject(), b->getCollisionObject());
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
    ManifoldCache cache_;
};

class CreateFunction final : public btCollisionAlgorithmCreateFunc
{
  public:
    btCollisionAlgorithm *CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo &info, const btCollisionObjectWrapper *a,
                                                   const btCollisionObjectWrapper *b) override
    {
        auto &dispatcher = *static_cast<btCollisionDispatcher *>(info.m_dispatcher1);
        if (!shape_of(a) || !shape_of(b)) {
            return dispatcher.getCollisionConfiguration()
                ->getCollisionAlgorithmCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE)
                ->CreateCollisionAlgorithm(info, a, b);
        }
        void *const memory = dispatcher.allocateCollisionAlgorithm(sizeof(Algorithm));
        return new (memory) Algorithm(info, a->getCollisionObject(), b->getCollisionObject());
    }
};

} // namespace detail

/**
 * Gives a hull of Bullet's its shape of ours, made from the same points: Bullet's margin is no part of it. It takes the hull's user
 * pointer, of all hulls that a dispatcher with `install` meets; `shape` lives as long as the hull, and stays where it is.
 */
inline void attach(btConvexHullShape &hull, const Shape &shape)
{
    hull.setUserPointer(const_cast<Shape *>(&shape));
}
/** A temporary shape would be gone before the hull. */
void attach(btConvexHullShape &hull, const Shape &&shape) = delete;

/**
 * How large an algorithm is: Bullet takes them from a pool whose elements are to be as large
 * (btDefaultCollisionConstructionInfo::m_customCollisionAlgorithmMaxElementSize).
 */
inline int algorithm_size()
{
    return sizeof(detail::Algorithm);
}

/** From now on a dispatcher asks swiftprox about pairs of convex hulls that have shapes. */
inline void install(btCollisionDispatcher &dispatcher)
{
    static detail::CreateFunction function;
    dispatcher.registerCollisionCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, &function);
}

} // namespace swiftprox::adapters::bullet

#endif
