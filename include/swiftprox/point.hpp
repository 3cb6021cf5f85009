/* Points and support vertices of shapes. */
#ifndef SWIFTPROX_POINT_HPP
#define SWIFTPROX_POINT_HPP

#include <array>

#include "pair.hpp"

namespace swiftprox
{

inline Result<swiftprox_point_answer> try_locate_point(Placed body, const std::array<double, 3> &point) noexcept
{
    Result<swiftprox_point_answer> result;
    result.status = swiftprox_shape_locate_point(body.shape(), body.pose(), point.data(), &result.value);
    return result;
}

inline Result<swiftprox_support_vertex> try_support(Placed body, const std::array<double, 3> &direction) noexcept
{
    Result<swiftprox_support_vertex> result;
    result.status = swiftprox_shape_support(body.shape(), body.pose(), direction.data(), &result.value);
    return result;
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline swiftprox_point_answer locate_point(Placed body, const std::array<double, 3> &point)
{
    return take(try_locate_point(body, point));
}

inline swiftprox_support_vertex support(Placed body, const std::array<double, 3> &direction)
{
    return take(try_support(body, direction));
}
#endif

} // namespace swiftprox

#endif
