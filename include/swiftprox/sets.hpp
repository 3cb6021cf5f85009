/* What questions about sets of objects take and give: sets, and room to work in. Scenes ask them, see scene.hpp. */
#ifndef SWIFTPROX_SETS_HPP
#define SWIFTPROX_SETS_HPP

#include "geometry.h"
#include "ground.h"
#include "motion.h"
#include "result.hpp"
#include "sets.h"
#include "shape.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace swiftprox
{

/** Objects that a question is about. It owns its ids and poses. */
struct ObjectSet {
    std::vector<swiftprox_object_id> ids;
    /** One for each, or none: where the scene has them. */
    std::vector<Pose> poses;
    /** Pairs of two of them are asked about, too. */
    bool among = false;

    ObjectSet() = default;
    ObjectSet(std::vector<swiftprox_object_id> of, std::vector<Pose> at = {}, bool pairs_among = false) noexcept
        : ids(std::move(of)), poses(std::move(at)), among(pairs_among)
    {
    }
    /** Good while this set is, and unchanged. */
    swiftprox_object_set to_c() const & noexcept
    {
        swiftprox_object_set c{};
        c.ids = ids.data();
        c.count = ids.size();
        c.poses = poses.empty() ? nullptr : detail::rows_of(poses);
        c.among = among ? 1 : 0;
        return c;
    }
    swiftprox_object_set to_c() const && = delete;
    /** What C could not see: fewer poses than ids. */
    bool is_uneven() const noexcept { return !poses.empty() && poses.size() != ids.size(); }
};

namespace detail
{
struct DestroyScratch {
    void operator()(swiftprox_scratch *scratch) const noexcept { swiftprox_scratch_destroy(scratch); }
};
} // namespace detail

/** Room to work in for questions about sets, for one thread at a time. It keeps what pairs remember. */
class SetScratch
{
  public:
    static Result<SetScratch> try_create()
    {
        swiftprox_scratch *made = nullptr;
        Result<SetScratch> result;
        result.status = swiftprox_scratch_create(&made);
        result.value.owned_.reset(made);
        return result;
    }
#if SWIFTPROX_HAS_EXCEPTIONS
    static SetScratch create() { return take(try_create()); }
#endif
    /** None yet: each question makes its own. */
    SetScratch() noexcept = default;
    swiftprox_scratch *get() const & noexcept { return owned_.get(); }
    swiftprox_scratch *get() const && = delete;

  private:
    std::unique_ptr<swiftprox_scratch, detail::DestroyScratch> owned_;
};

namespace detail
{
template <class Answer> Result<Answer> uneven() { return refused<Answer>("poses: there are not as many as ids"); }
} // namespace detail

inline Range<const swiftprox_scene_ray_hit> hits(const swiftprox_scene_ray_answer &answer) noexcept
{
    return {answer.hits, answer.count};
}

inline Range<const swiftprox_scene_ground_contact> contacts(const swiftprox_scene_ground_answer &answer) noexcept
{
    return {answer.contacts, answer.contact_count};
}
/** Those of all contacts. */
inline Range<const swiftprox_manifold_point> points(const swiftprox_scene_ground_answer &answer) noexcept
{
    return {answer.points, answer.point_count};
}
/** Those of one. */
inline Range<const swiftprox_manifold_point> points(const swiftprox_scene_ground_answer &answer,
                                                    const swiftprox_scene_ground_contact &contact) noexcept
{
    return {answer.points + contact.contact.first_point, contact.contact.manifold.point_count};
}

namespace detail
{
/** Of a set, or of all objects: `ask` is given both in C, and where the answer goes. */
template <class Ask>
Result<swiftprox_scene_ground_answer> floor_contacts(const ObjectSet *set, const SceneGroundConfig &config, Ask ask)
{
    if (set && set->is_uneven()) {
        return uneven<swiftprox_scene_ground_answer>();
    }
    const swiftprox_scene_ground_config c = config.to_c();
    const swiftprox_object_set of = set ? set->to_c() : swiftprox_object_set{};
    return asked<swiftprox_scene_ground_answer>(
        [&](swiftprox_scene_ground_answer *answer) { return ask(set ? &of : nullptr, &c, answer); });
}
} // namespace detail

} // namespace swiftprox

#endif
