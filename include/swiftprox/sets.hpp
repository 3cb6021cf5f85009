/* Questions about sets of objects, which threads may ask one scene at once. */
#ifndef SWIFTPROX_SETS_HPP
#define SWIFTPROX_SETS_HPP

#include "ground.hpp"
#include "motion.hpp"
#include "ray.hpp"
#include "scene.hpp"

#include <limits>

namespace swiftprox
{

/** Objects that a question is about; what it refers to lives as long as the call. */
struct ObjectSet {
    Range<const swiftprox_object_id> ids;
    /** One for each, or none: where the scene has them. */
    Range<const Pose> poses = {};
    /** Pairs of two of them are asked about, too. */
    bool among = false;

    swiftprox_object_set to_c() const noexcept
    {
        swiftprox_object_set c{};
        c.ids = ids.data();
        c.count = ids.size();
        c.poses = poses.empty() ? nullptr : detail::rows_of(poses);
        c.among = among ? 1 : 0;
        return c;
    }
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
    /** None yet: each question makes its own. */
    SetScratch() noexcept = default;
    swiftprox_scratch *get() const noexcept { return owned_.get(); }

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

/** Makes the questions below fast after changes. */
inline Result<void> try_prepare(SceneView &scene)
{
    return detail::status(swiftprox_scene_prepare(scene.get()));
}
/** Without a second set: against all others. */
inline Result<swiftprox_least_distance> try_least_distance(const SceneView &scene, const ObjectSet &set, SetScratch &scratch,
                                                           const ObjectSet *against = nullptr,
                                                           double cut_off = std::numeric_limits<double>::infinity())
{
    if (set.is_uneven() || (against && against->is_uneven())) {
        return detail::uneven<swiftprox_least_distance>();
    }
    const swiftprox_object_set c = set.to_c();
    const swiftprox_object_set second = against ? against->to_c() : swiftprox_object_set{};
    return detail::asked<swiftprox_least_distance>([&](swiftprox_least_distance *answer) {
        return swiftprox_scene_least_distance(scene.get(), &c, against ? &second : nullptr, cut_off, scratch.get(), answer);
    });
}
/** `poses`: those of all objects at the first time, then at the second, and so on. */
inline Result<swiftprox_first_hit> try_first_hit(const SceneView &scene, const ObjectSet &set, Range<const Pose> poses,
                                                 SetScratch &scratch,
                                                 swiftprox_pose_order order = SWIFTPROX_POSE_ORDER_BISECTION, double margin = 0)
{
    if (set.ids.empty() || poses.size() % set.ids.size() != 0) {
        return detail::refused<swiftprox_first_hit>("poses: there is not one for each object at each time");
    }
    const swiftprox_object_set c = set.to_c();
    const std::size_t times = poses.size() / set.ids.size();
    return detail::asked<swiftprox_first_hit>([&](swiftprox_first_hit *answer) {
        return swiftprox_scene_first_hit(scene.get(), &c, detail::rows_of(poses), times, order, margin, scratch.get(), answer);
    });
}
/** The scratch owns the hits, until its next use. */
inline Result<swiftprox_scene_ray_answer> try_cast_ray(const SceneView &scene, const swiftprox_ray &ray, SetScratch &scratch,
                                                       swiftprox_ray_hits hits = SWIFTPROX_RAY_HITS_FIRST,
                                                       std::uint32_t mask = UINT32_MAX)
{
    return detail::asked<swiftprox_scene_ray_answer>([&](swiftprox_scene_ray_answer *answer) {
        return swiftprox_scene_cast_ray(scene.get(), &ray, hits, mask, scratch.get(), answer);
    });
}
/** One motion for all objects together, or one for each. */
inline Result<swiftprox_scene_cast_answer> try_cast(const SceneView &scene, const ObjectSet &set,
                                                    Range<const swiftprox_motion> motions, SetScratch &scratch,
                                                    const CastConfig &config = {})
{
    const swiftprox_object_set c = set.to_c();
    const swiftprox_cast_config of_cast = config.to_c();
    return detail::asked<swiftprox_scene_cast_answer>([&](swiftprox_scene_cast_answer *answer) {
        return swiftprox_scene_cast(scene.get(), &c, motions.data(), motions.size(), &of_cast, scratch.get(), answer);
    });
}
/** One motion for each edge, or one for each object at each edge. */
inline Result<std::vector<swiftprox_scene_cast_answer>> try_cast_batch(const SceneView &scene, const ObjectSet &set,
                                                                       Range<const swiftprox_motion> motions,
                                                                       std::size_t edge_count, SetScratch &scratch,
                                                                       const CastConfig &config = {})
{
    const swiftprox_object_set c = set.to_c();
    const swiftprox_cast_config of_cast = config.to_c();
    Result<std::vector<swiftprox_scene_cast_answer>> result;
    result.value.resize(edge_count);
    result.status = swiftprox_scene_cast_batch(scene.get(), &c, motions.data(), motions.size(), &of_cast, scratch.get(),
                                               result.value.data(), edge_count);
    return result;
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
Result<swiftprox_scene_ground_answer> floor_contacts(const ObjectSet *set, const ManifoldConfig &config, Ask ask)
{
    if (set && set->is_uneven()) {
        return uneven<swiftprox_scene_ground_answer>();
    }
    const swiftprox_manifold_config c = config.to_c();
    const swiftprox_object_set of = set ? set->to_c() : swiftprox_object_set{};
    return asked<swiftprox_scene_ground_answer>(
        [&](swiftprox_scene_ground_answer *answer) { return ask(set ? &of : nullptr, &c, answer); });
}
} // namespace detail

/** Without a set: of all objects. The scratch owns contacts and points, until its next use. */
inline Result<swiftprox_scene_ground_answer> try_ground_contacts(const SceneView &scene, PlacedGround ground, SetScratch &scratch,
                                                                 const ManifoldConfig &config = {},
                                                                 const ObjectSet *set = nullptr,
                                                                 const swiftprox_group_filter *filter = nullptr)
{
    return detail::floor_contacts(set, config, [&](const swiftprox_object_set *of, const swiftprox_manifold_config *c,
                                                   swiftprox_scene_ground_answer *answer) {
        return swiftprox_scene_ground_contacts(scene.get(), of, ground.ground.get(), ground.pose.data(), c, filter,
                                               scratch.get(), answer);
    });
}
/** A contact for each piece. */
inline Result<swiftprox_scene_ground_answer> try_half_space_contacts(const SceneView &scene, const swiftprox_half_space &half_space,
                                                                     SetScratch &scratch, const ManifoldConfig &config = {},
                                                                     const ObjectSet *set = nullptr,
                                                                     const swiftprox_group_filter *filter = nullptr)
{
    return detail::floor_contacts(set, config, [&](const swiftprox_object_set *of, const swiftprox_manifold_config *c,
                                                   swiftprox_scene_ground_answer *answer) {
        return swiftprox_scene_half_space_contacts(scene.get(), of, &half_space, c, filter, scratch.get(), answer);
    });
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline void prepare(SceneView &scene)
{
    take(try_prepare(scene));
}
inline swiftprox_least_distance least_distance(const SceneView &scene, const ObjectSet &set, SetScratch &scratch,
                                               const ObjectSet *against = nullptr,
                                               double cut_off = std::numeric_limits<double>::infinity())
{
    return take(try_least_distance(scene, set, scratch, against, cut_off));
}
inline swiftprox_first_hit first_hit(const SceneView &scene, const ObjectSet &set, Range<const Pose> poses, SetScratch &scratch,
                                     swiftprox_pose_order order = SWIFTPROX_POSE_ORDER_BISECTION, double margin = 0)
{
    return take(try_first_hit(scene, set, poses, scratch, order, margin));
}
inline swiftprox_scene_ray_answer cast_ray(const SceneView &scene, const swiftprox_ray &ray, SetScratch &scratch,
                                           swiftprox_ray_hits hits = SWIFTPROX_RAY_HITS_FIRST, std::uint32_t mask = UINT32_MAX)
{
    return take(try_cast_ray(scene, ray, scratch, hits, mask));
}
inline swiftprox_scene_cast_answer cast(const SceneView &scene, const ObjectSet &set, Range<const swiftprox_motion> motions,
                                        SetScratch &scratch, const CastConfig &config = {})
{
    return take(try_cast(scene, set, motions, scratch, config));
}
inline std::vector<swiftprox_scene_cast_answer> cast_batch(const SceneView &scene, const ObjectSet &set,
                                                           Range<const swiftprox_motion> motions, std::size_t edge_count,
                                                           SetScratch &scratch, const CastConfig &config = {})
{
    return take(try_cast_batch(scene, set, motions, edge_count, scratch, config));
}
inline swiftprox_scene_ground_answer ground_contacts(const SceneView &scene, PlacedGround ground, SetScratch &scratch,
                                                     const ManifoldConfig &config = {}, const ObjectSet *set = nullptr,
                                                     const swiftprox_group_filter *filter = nullptr)
{
    return take(try_ground_contacts(scene, ground, scratch, config, set, filter));
}
inline swiftprox_scene_ground_answer half_space_contacts(const SceneView &scene, const swiftprox_half_space &half_space,
                                                         SetScratch &scratch, const ManifoldConfig &config = {},
                                                         const ObjectSet *set = nullptr,
                                                         const swiftprox_group_filter *filter = nullptr)
{
    return take(try_half_space_contacts(scene, half_space, scratch, config, set, filter));
}
#endif

} // namespace swiftprox

#endif
