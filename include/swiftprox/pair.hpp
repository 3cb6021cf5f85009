/* Queries of two shapes, two poses and a cache. */
#ifndef SWIFTPROX_PAIR_HPP
#define SWIFTPROX_PAIR_HPP

#include "ground.h"
#include "shape.hpp"
#include "verify.h"

namespace swiftprox
{

/** What a pair remembers: keep one for each pair. Cold when made. */
struct PairCache : swiftprox_pair_cache {
    PairCache() noexcept : swiftprox_pair_cache{} {}
};
struct DepthCache : swiftprox_depth_cache {
    DepthCache() noexcept : swiftprox_depth_cache{} {}
};
struct ManifoldCache : swiftprox_manifold_cache {
    ManifoldCache() noexcept : swiftprox_manifold_cache{} {}
};

/** A shape where it is. The pose is its own; a share of the shape must live on, so that a temporary Shape is refused. */
class Placed
{
  public:
    Placed(const Shape &shape, const Pose &pose) noexcept : shape_(shape.get()), pose_(pose) {}
    /** A temporary shape would be gone when the query looks at it: name the shape first. */
    Placed(const Shape &&, const Pose &) = delete;
    const swiftprox_shape *shape() const noexcept { return shape_; }
    const double *pose() const & noexcept { return pose_.data(); }
    const double *pose() const && = delete;
    /** Good while this is. */
    swiftprox_placed to_c() const & noexcept { return {shape_, pose_.data()}; }
    swiftprox_placed to_c() const && = delete;

  private:
    const swiftprox_shape *shape_;
    Pose pose_;
};

namespace detail
{
using PairCall = swiftprox_status (*)(swiftprox_placed, swiftprox_placed, swiftprox_pair_cache *, const swiftprox_pair_config *,
                                      swiftprox_pair_answer *);
inline Result<swiftprox_pair_answer> pair(PairCall call, Placed a, Placed b, PairCache &cache, const PairConfig &config) noexcept
{
    const swiftprox_pair_config c = config.to_c();
    Result<swiftprox_pair_answer> result;
    result.status = call(a.to_c(), b.to_c(), &cache, &c, &result.value);
    return result;
}
} // namespace detail

inline Result<swiftprox_pair_answer> try_distance(Placed a, Placed b, PairCache &cache, const PairConfig &config = {}) noexcept
{
    return detail::pair(swiftprox_pair_distance, a, b, cache, config);
}
inline Result<swiftprox_pair_answer> try_contact(Placed a, Placed b, PairCache &cache, const PairConfig &config = {}) noexcept
{
    return detail::pair(swiftprox_pair_contact, a, b, cache, config);
}
inline Result<swiftprox_pair_answer> try_intersection(Placed a, Placed b, PairCache &cache, const PairConfig &config = {}) noexcept
{
    return detail::pair(swiftprox_pair_intersection, a, b, cache, config);
}
inline Result<swiftprox_pair_answer> try_approximate(Placed a, Placed b, PairCache &cache, const PairConfig &config) noexcept
{
    return detail::pair(swiftprox_pair_approximate, a, b, cache, config);
}
/** Whether two objects have a common point, touching included. */
inline Result<bool> try_intersect(Placed a, Placed b, PairCache &cache, const PairConfig &config = {}) noexcept
{
    const Result<swiftprox_pair_answer> answer = try_intersection(a, b, cache, config);
    Result<bool> result;
    result.status = answer.status;
    result.value = answer.value.outcome == SWIFTPROX_OUTCOME_INTERSECTING;
    return result;
}
inline Result<swiftprox_depth_answer> try_depth(Placed a, Placed b, DepthCache &cache, const DepthConfig &config = {}) noexcept
{
    const swiftprox_depth_config c = config.to_c();
    Result<swiftprox_depth_answer> result;
    result.status = swiftprox_pair_depth(a.to_c(), b.to_c(), &cache, &c, &result.value);
    return result;
}
/** The distance, or minus the depth; the cache is that of the pair's manifolds. */
inline Result<swiftprox_signed_distance> try_signed_distance(Placed a, Placed b, ManifoldCache &cache,
                                                             const PairConfig &config = {}) noexcept
{
    const swiftprox_pair_config c = config.to_c();
    Result<swiftprox_signed_distance> result;
    result.status = swiftprox_pair_signed_distance(a.to_c(), b.to_c(), &cache, &c, &result.value);
    return result;
}
/** Writes the points into `points`, as many as there is room for. */
inline Result<swiftprox_manifold> try_manifold(Placed a, Placed b, ManifoldCache &cache, Range<swiftprox_manifold_point> points,
                                               const ManifoldConfig &config = {}) noexcept
{
    const swiftprox_manifold_config c = config.to_c();
    Result<swiftprox_manifold> result;
    result.status =
        swiftprox_pair_manifold(a.to_c(), b.to_c(), &cache, &c, {points.data(), points.size(), nullptr}, &result.value);
    return result;
}
/** A manifold with the signed distance that it is made from. */
struct ManifoldWithDistance {
    swiftprox_manifold manifold{};
    swiftprox_signed_distance distance{};
};
inline Result<ManifoldWithDistance> try_manifold_with_distance(Placed a, Placed b, ManifoldCache &cache,
                                                               Range<swiftprox_manifold_point> points,
                                                               const ManifoldConfig &config = {}) noexcept
{
    const swiftprox_manifold_config c = config.to_c();
    Result<ManifoldWithDistance> result;
    result.status = swiftprox_pair_manifold(a.to_c(), b.to_c(), &cache, &c,
                                            {points.data(), points.size(), &result.value.distance}, &result.value.manifold);
    return result;
}
/** The best estimate of a point's gap. */
inline double gap(const swiftprox_manifold_point &point) noexcept
{
    return point.gap_lower + (point.gap_upper - point.gap_lower) / 2;
}
inline Result<swiftprox_signed_distance> try_half_space_distance(Placed body, const swiftprox_half_space &half_space) noexcept
{
    Result<swiftprox_signed_distance> result;
    result.status = swiftprox_pair_half_space_distance(body.to_c(), &half_space, &result.value);
    return result;
}
/** Writes the points into `points`, as many as there is room for. */
inline Result<swiftprox_manifold> try_half_space_manifold(Placed body, const swiftprox_half_space &half_space,
                                                          Range<swiftprox_manifold_point> points,
                                                          const ManifoldConfig &config = {}) noexcept
{
    const swiftprox_manifold_config c = config.to_c();
    Result<swiftprox_manifold> result;
    result.status = swiftprox_pair_half_space_manifold(body.to_c(), &half_space, &c, {points.data(), points.size(), nullptr},
                                                       &result.value);
    return result;
}
/** SWIFTPROX_ERROR_UNVERIFIED where the answer does not hold. */
inline Result<void> try_verify(Placed a, Placed b, const swiftprox_pair_answer &answer) noexcept
{
    return detail::status(swiftprox_pair_verify(a.to_c(), b.to_c(), &answer));
}
inline Result<void> try_depth_verify(Placed a, Placed b, const DepthCache &cache, const swiftprox_depth_answer &answer) noexcept
{
    return detail::status(swiftprox_pair_depth_verify(a.to_c(), b.to_c(), &cache, &answer));
}
inline Result<void> try_manifold_verify(Placed a, Placed b, const ManifoldCache &cache, const swiftprox_manifold &manifold,
                                        Range<const swiftprox_manifold_point> points, const ManifoldConfig &config = {}) noexcept
{
    const swiftprox_manifold_config c = config.to_c();
    return detail::status(swiftprox_pair_manifold_verify(a.to_c(), b.to_c(), &cache, &c, points.data(), &manifold));
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline swiftprox_pair_answer distance(Placed a, Placed b, PairCache &cache, const PairConfig &config = {})
{
    return take(try_distance(a, b, cache, config));
}
inline swiftprox_pair_answer contact(Placed a, Placed b, PairCache &cache, const PairConfig &config = {})
{
    return take(try_contact(a, b, cache, config));
}
inline swiftprox_pair_answer intersection(Placed a, Placed b, PairCache &cache, const PairConfig &config = {})
{
    return take(try_intersection(a, b, cache, config));
}
inline swiftprox_pair_answer approximate(Placed a, Placed b, PairCache &cache, const PairConfig &config)
{
    return take(try_approximate(a, b, cache, config));
}
inline bool intersect(Placed a, Placed b, PairCache &cache, const PairConfig &config = {})
{
    return take(try_intersect(a, b, cache, config));
}
inline swiftprox_depth_answer depth(Placed a, Placed b, DepthCache &cache, const DepthConfig &config = {})
{
    return take(try_depth(a, b, cache, config));
}
inline swiftprox_signed_distance signed_distance(Placed a, Placed b, ManifoldCache &cache, const PairConfig &config = {})
{
    return take(try_signed_distance(a, b, cache, config));
}
inline swiftprox_manifold manifold(Placed a, Placed b, ManifoldCache &cache, Range<swiftprox_manifold_point> points,
                                   const ManifoldConfig &config = {})
{
    return take(try_manifold(a, b, cache, points, config));
}
inline ManifoldWithDistance manifold_with_distance(Placed a, Placed b, ManifoldCache &cache, Range<swiftprox_manifold_point> points,
                                                   const ManifoldConfig &config = {})
{
    return take(try_manifold_with_distance(a, b, cache, points, config));
}
inline swiftprox_signed_distance half_space_distance(Placed body, const swiftprox_half_space &half_space)
{
    return take(try_half_space_distance(body, half_space));
}
inline swiftprox_manifold half_space_manifold(Placed body, const swiftprox_half_space &half_space,
                                              Range<swiftprox_manifold_point> points, const ManifoldConfig &config = {})
{
    return take(try_half_space_manifold(body, half_space, points, config));
}
inline void verify(Placed a, Placed b, const swiftprox_pair_answer &answer)
{
    take(try_verify(a, b, answer));
}
inline void depth_verify(Placed a, Placed b, const DepthCache &cache, const swiftprox_depth_answer &answer)
{
    take(try_depth_verify(a, b, cache, answer));
}
inline void manifold_verify(Placed a, Placed b, const ManifoldCache &cache, const swiftprox_manifold &manifold,
                            Range<const swiftprox_manifold_point> points, const ManifoldConfig &config = {})
{
    take(try_manifold_verify(a, b, cache, manifold, points, config));
}
#endif

} // namespace swiftprox

#endif
