/* Rays at shapes. */
#ifndef SWIFTPROX_RAY_HPP
#define SWIFTPROX_RAY_HPP

#include "pair.hpp"

namespace swiftprox
{

inline Result<swiftprox_ray_answer> try_cast_ray(Placed body, const swiftprox_ray &ray) noexcept
{
    Result<swiftprox_ray_answer> result;
    result.status = swiftprox_shape_cast_ray(body.shape(), body.pose(), &ray, &result.value);
    return result;
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline swiftprox_ray_answer cast_ray(Placed body, const swiftprox_ray &ray)
{
    return take(try_cast_ray(body, ray));
}
#endif

} // namespace swiftprox

#endif
