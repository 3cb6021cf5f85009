/* Pairs that move: casts, their check, and clearances. */
#ifndef SWIFTPROX_MOTION_HPP
#define SWIFTPROX_MOTION_HPP

#include <algorithm>

#include "pair.hpp"

namespace swiftprox
{

/** A motion between two poses, and how far its end is from the second. */
struct MotionBetween {
    swiftprox_motion motion{};
    double end_error = 0;
};

/** Rests at a pose. */
inline swiftprox_motion fixed_motion(const Pose &pose) noexcept
{
    swiftprox_motion motion{};
    motion.kind = SWIFTPROX_MOTION_KIND_FIXED;
    std::copy_n(pose.data(), 12, motion.start);
    return motion;
}
/**
 * From a pose at time 0 on with constant velocities, both in the world, the angular one in radians per unit of time. They are those
 * of the centre, which is in the object's frame.
 */
inline swiftprox_motion screw_motion(const Pose &start, const std::array<double, 3> &velocity,
                                     const std::array<double, 3> &rotation, const std::array<double, 3> &centre = {}) noexcept
{
    swiftprox_motion motion = fixed_motion(start);
    motion.kind = SWIFTPROX_MOTION_KIND_SCREW;
    std::copy_n(velocity.data(), 3, motion.velocity);
    std::copy_n(rotation.data(), 3, motion.rotation);
    std::copy_n(centre.data(), 3, motion.centre);
    return motion;
}

/** A shape and how it moves. The motion is its own; a share of the shape must live on, so that a temporary Shape is refused. */
class Moving
{
  public:
    Moving(const Shape &shape, const swiftprox_motion &motion) noexcept : shape_(shape.get()), motion_(motion) {}
    Moving(const Shape &&, const swiftprox_motion &) = delete;
    const swiftprox_shape *shape() const noexcept { return shape_; }
    const swiftprox_motion *motion() const & noexcept { return &motion_; }
    const swiftprox_motion *motion() const && = delete;

  private:
    const swiftprox_shape *shape_;
    swiftprox_motion motion_;
};

/** `centre` is in the object's frame, no point of the object farther from it than `reach`. */
inline Result<MotionBetween> try_motion_between(const Pose &pose1, const Pose &pose2, const std::array<double, 3> &centre,
                                                double reach) noexcept
{
    Result<MotionBetween> result;
    result.status = swiftprox_motion_between(pose1.data(), pose2.data(), centre.data(), reach, &result.value.motion,
                                             &result.value.end_error);
    return result;
}
inline Result<swiftprox_cast_answer> try_cast(Moving a, Moving b, PairCache &cache, const CastConfig &config = {}) noexcept
{
    const swiftprox_cast_config c = config.to_c();
    Result<swiftprox_cast_answer> result;
    result.status = swiftprox_pair_cast(swiftprox_moving{a.shape(), a.motion()}, swiftprox_moving{b.shape(), b.motion()}, &cache,
                                        &c, &result.value);
    return result;
}
/** SWIFTPROX_ERROR_UNVERIFIED where the answer does not hold. */
inline Result<void> try_cast_verify(Moving a, Moving b, const swiftprox_cast_answer &answer, const CastConfig &config = {}) noexcept
{
    const swiftprox_cast_config c = config.to_c();
    return detail::status(swiftprox_pair_cast_verify(swiftprox_moving{a.shape(), a.motion()},
                                                     swiftprox_moving{b.shape(), b.motion()}, &c, &answer));
}
inline Result<swiftprox_clearance> try_clearance(Moving a, Moving b, PairCache &cache, const ClearanceConfig &config = {}) noexcept
{
    const swiftprox_clearance_config c = config.to_c();
    Result<swiftprox_clearance> result;
    result.status = swiftprox_pair_clearance(swiftprox_moving{a.shape(), a.motion()}, swiftprox_moving{b.shape(), b.motion()},
                                             &cache, &c, &result.value);
    return result;
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline MotionBetween motion_between(const Pose &pose1, const Pose &pose2, const std::array<double, 3> &centre, double reach)
{
    return take(try_motion_between(pose1, pose2, centre, reach));
}
inline swiftprox_cast_answer cast(Moving a, Moving b, PairCache &cache, const CastConfig &config = {})
{
    return take(try_cast(a, b, cache, config));
}
inline void cast_verify(Moving a, Moving b, const swiftprox_cast_answer &answer, const CastConfig &config = {})
{
    take(try_cast_verify(a, b, answer, config));
}
inline swiftprox_clearance clearance(Moving a, Moving b, PairCache &cache, const ClearanceConfig &config = {})
{
    return take(try_clearance(a, b, cache, config));
}
#endif

} // namespace swiftprox

#endif
