/* Many pairs at once. */
#ifndef SWIFTPROX_BATCH_HPP
#define SWIFTPROX_BATCH_HPP

#include "batch.h"
#include "pair.hpp"
#include "scene.hpp"

namespace swiftprox
{

/** A pair to be asked. The poses are its own; shares of the shapes, and the cache, must live on. */
class Question
{
  public:
    Question(Placed a, Placed b, PairCache &cache) noexcept : a_(a), b_(b), cache_(&cache) {}
    /** Good while this question is. */
    swiftprox_pair_question to_c() const & noexcept { return {a_.shape(), a_.pose(), b_.shape(), b_.pose(), cache_}; }
    swiftprox_pair_question to_c() const && = delete;

  private:
    Placed a_;
    Placed b_;
    PairCache *cache_;
};

/** An answer for each pair, in order: bit for bit those of single calls. The scene's workers share the work, if there is one. */
inline Result<void> try_batch(swiftprox_query_kind kind, Range<const Question> questions,
                              std::vector<swiftprox_pair_answer> &answers, const PairConfig &config = {},
                              const SceneView *scene = nullptr)
{
    const swiftprox_pair_config c = config.to_c();
    std::vector<swiftprox_pair_question> pairs;
    pairs.reserve(questions.size());
    for (const Question &question : questions) {
        pairs.push_back(question.to_c());
    }
    answers.resize(pairs.size());
    return detail::status(
        swiftprox_pair_batch(kind, pairs.data(), pairs.size(), &c, scene ? scene->get() : nullptr, answers.data()));
}

/** One pair at many poses: bit for bit what try_distance says with the one cache. Either has as many poses as the other, or
 * one. */
inline Result<void> try_distances(const Shape &a, Range<const Pose> poses_of_a, const Shape &b, Range<const Pose> poses_of_b,
                                  PairCache &cache, std::vector<swiftprox_pair_answer> &answers, const PairConfig &config = {})
{
    const swiftprox_pair_config c = config.to_c();
    answers.resize(poses_of_a.size() == 1 ? poses_of_b.size() : poses_of_a.size());
    return detail::status(swiftprox_pair_distances({a.get(), detail::rows_of(poses_of_a), poses_of_a.size()},
                                                   {b.get(), detail::rows_of(poses_of_b), poses_of_b.size()}, &cache, &c,
                                                   answers.data()));
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline std::vector<swiftprox_pair_answer> distances(const Shape &a, Range<const Pose> poses_of_a, const Shape &b,
                                                    Range<const Pose> poses_of_b, PairCache &cache,
                                                    const PairConfig &config = {})
{
    std::vector<swiftprox_pair_answer> answers;
    take(try_distances(a, poses_of_a, b, poses_of_b, cache, answers, config));
    return answers;
}
inline std::vector<swiftprox_pair_answer> batch(swiftprox_query_kind kind, Range<const Question> questions,
                                                const PairConfig &config = {}, const SceneView *scene = nullptr)
{
    std::vector<swiftprox_pair_answer> answers;
    take(try_batch(kind, questions, answers, config, scene));
    return answers;
}
#endif

} // namespace swiftprox

#endif
