/* Many pairs at once. */
#ifndef SWIFTPROX_BATCH_HPP
#define SWIFTPROX_BATCH_HPP

#include "pair.hpp"
#include "scene.hpp"

namespace swiftprox
{

/** A pair to be asked; what it refers to lives as long as the call. */
inline swiftprox_pair_question question(Placed a, Placed b, PairCache &cache) noexcept
{
    return {a.shape.get(), a.pose.data(), b.shape.get(), b.pose.data(), &cache};
}

/** An answer for each pair, in order: bit for bit those of single calls. The scene's workers share the work, if there is one. */
inline Result<void> try_batch(swiftprox_query_kind kind, Range<const swiftprox_pair_question> pairs,
                              std::vector<swiftprox_pair_answer> &answers, const PairConfig &config = {},
                              const SceneView *scene = nullptr)
{
    const swiftprox_pair_config c = config.to_c();
    answers.resize(pairs.size());
    return detail::status(
        swiftprox_pair_batch(kind, pairs.data(), pairs.size(), &c, scene ? scene->get() : nullptr, answers.data()));
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline std::vector<swiftprox_pair_answer> batch(swiftprox_query_kind kind, Range<const swiftprox_pair_question> pairs,
                                                const PairConfig &config = {}, const SceneView *scene = nullptr)
{
    std::vector<swiftprox_pair_answer> answers;
    take(try_batch(kind, pairs, answers, config, scene));
    return answers;
}
#endif

} // namespace swiftprox

#endif
