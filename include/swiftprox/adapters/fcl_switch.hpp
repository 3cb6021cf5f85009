/*
 * Switches a program from FCL to swiftprox: included in the place of <fcl/narrowphase/collision.h> and distance.h, or besides, it
 * makes calls of fcl::collide and fcl::distance, found by whichever name, be those of fcl.hpp. These are no templates, and so come
 * before FCL's, which are; fcl::collide<double>(...) is still FCL's own, and so are the calls inside of FCL's library.
 *
 * Include it in all units of a program or in none: FCL's broad phase has templates that call collide, of which a program has one.
 */
#ifndef SWIFTPROX_ADAPTERS_FCL_SWITCH_HPP
#define SWIFTPROX_ADAPTERS_FCL_SWITCH_HPP

#include "fcl.hpp"

namespace fcl
{

inline std::size_t collide(const CollisionObjectd *, const CollisionObjectd *, const CollisionRequestd &, CollisionResultd &);
inline std::size_t collide(const CollisionObjectf *, const CollisionObjectf *, const CollisionRequestf &, CollisionResultf &);
inline std::size_t collide(const CollisionGeometryd *, const Transform3d &, const CollisionGeometryd *, const Transform3d &,
                           const CollisionRequestd &, CollisionResultd &);
inline std::size_t collide(const CollisionGeometryf *, const Transform3f &, const CollisionGeometryf *, const Transform3f &,
                           const CollisionRequestf &, CollisionResultf &);
inline double distance(const CollisionObjectd *, const CollisionObjectd *, const DistanceRequestd &, DistanceResultd &);
inline float distance(const CollisionObjectf *, const CollisionObjectf *, const DistanceRequestf &, DistanceResultf &);
inline double distance(const CollisionGeometryd *, const Transform3d &, const CollisionGeometryd *, const Transform3d &,
                       const DistanceRequestd &, DistanceResultd &);
inline float distance(const CollisionGeometryf *, const Transform3f &, const CollisionGeometryf *, const Transform3f &,
                      const DistanceRequestf &, DistanceResultf &);

/** The bodies of these, compiled where they are called alone: FCL's templates for float take the better part of a minute. */
template <class S> struct SwiftproxCalls {
    friend std::size_t collide(const CollisionObject<S> *o1, const CollisionObject<S> *o2, const CollisionRequest<S> &request,
                               CollisionResult<S> &result)
    {
        return swiftprox::adapters::fcl::collide(o1, o2, request, result);
    }
    friend std::size_t collide(const CollisionGeometry<S> *o1, const Transform3<S> &tf1, const CollisionGeometry<S> *o2,
                               const Transform3<S> &tf2, const CollisionRequest<S> &request, CollisionResult<S> &result)
    {
        return swiftprox::adapters::fcl::collide(o1, tf1, o2, tf2, request, result);
    }
    friend S distance(const CollisionObject<S> *o1, const CollisionObject<S> *o2, const DistanceRequest<S> &request,
                      DistanceResult<S> &result)
    {
        return swiftprox::adapters::fcl::distance(o1, o2, request, result);
    }
    friend S distance(const CollisionGeometry<S> *o1, const Transform3<S> &tf1, const CollisionGeometry<S> *o2,
                      const Transform3<S> &tf2, const DistanceRequest<S> &request, DistanceResult<S> &result)
    {
        return swiftprox::adapters::fcl::distance(o1, tf1, o2, tf2, request, result);
    }
};
static_assert(sizeof(SwiftproxCalls<double>) > 0 && sizeof(SwiftproxCalls<float>) > 0, "both have their bodies");

} // namespace fcl

#endif
