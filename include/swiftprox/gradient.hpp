/* How a pair's signed distance changes as its objects move. */
#ifndef SWIFTPROX_GRADIENT_HPP
#define SWIFTPROX_GRADIENT_HPP

#include "geometry.h"
#include "pair.hpp"

namespace swiftprox
{

namespace detail
{
/** The members that a gradient is made of. */
template <class Answer> swiftprox_signed_distance signed_of(const Answer &answer, double lower, double upper) noexcept
{
    swiftprox_signed_distance made{};
    made.outcome = answer.outcome;
    made.lower = lower;
    made.upper = upper;
    for (int k = 0; k < 3; ++k) {
        made.normal[k] = answer.normal[k];
        made.world1[k] = answer.world1[k];
        made.world2[k] = answer.world2[k];
    }
    return made;
}
} // namespace detail

/** Where each object is turned about, in the world: a point of three numbers, or null for the translation of its pose. */
struct References {
    const double *object1 = nullptr;
    const double *object2 = nullptr;
};

inline Result<swiftprox_gradient> try_gradient(Placed a, Placed b, const swiftprox_signed_distance &answer,
                                               References about = {}) noexcept
{
    Result<swiftprox_gradient> result;
    result.status = swiftprox_pair_gradient(a.to_c(), b.to_c(), &answer, about.object1, about.object2, &result.value);
    return result;
}
/** Of objects that are apart. */
inline Result<swiftprox_gradient> try_gradient(Placed a, Placed b, const swiftprox_pair_answer &answer,
                                               References about = {}) noexcept
{
    return try_gradient(a, b, detail::signed_of(answer, answer.lower, answer.upper), about);
}
/** Of objects that overlap: of minus the depth. */
inline Result<swiftprox_gradient> try_gradient(Placed a, Placed b, const swiftprox_depth_answer &answer,
                                               References about = {}) noexcept
{
    return try_gradient(a, b, detail::signed_of(answer, -answer.upper, -answer.lower), about);
}

#if SWIFTPROX_HAS_EXCEPTIONS
/** Of a swiftprox_signed_distance, swiftprox_pair_answer or swiftprox_depth_answer. */
template <class Answer> swiftprox_gradient gradient(Placed a, Placed b, const Answer &answer, References about = {})
{
    return take(try_gradient(a, b, answer, about));
}
#endif

} // namespace swiftprox

#endif
