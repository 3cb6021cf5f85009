/* Scenes: objects with ids and poses, queries over all pairs. */
#ifndef SWIFTPROX_SCENE_HPP
#define SWIFTPROX_SCENE_HPP

#include "compound.hpp"
#include "ground.hpp"
#include "listener.hpp"
#include "replay.h"
#include "scene.h"
#include "sets.hpp"
#include "shape.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/** Two ids name the same object if their bits are equal. */
inline bool operator==(swiftprox_object_id a, swiftprox_object_id b) noexcept
{
    return a.bits == b.bits;
}
inline bool operator!=(swiftprox_object_id a, swiftprox_object_id b) noexcept
{
    return a.bits != b.bits;
}

namespace swiftprox
{

namespace detail
{
/** Ids to point at, where there are none, too: a null pointer means all. */
inline const swiftprox_object_id *ids_of(Range<const swiftprox_object_id> ids) noexcept
{
    static const swiftprox_object_id none{};
    return ids.data() ? ids.data() : &none;
}

template <class Call> Result<bool> flag(Call &&call)
{
    std::int32_t value = 0;
    Result<bool> result;
    result.status = call(&value);
    result.value = value != 0;
    return result;
}
} // namespace detail

/** The pairs that an answer lists. */
inline Range<const swiftprox_pair_result> pairs(const swiftprox_scene_answer &answer) noexcept
{
    return {answer.pairs, answer.count};
}
/** The contacts of an answer: one for each of its pairs, if the query asked for a detail. */
inline Range<const swiftprox_contact> contacts(const swiftprox_scene_answer &answer) noexcept
{
    return {answer.contacts, answer.contact_count};
}
/** The points where the pair of a contact meets. */
inline Range<const swiftprox_manifold_point> points(const swiftprox_scene_answer &answer, const swiftprox_contact &contact) noexcept
{
    return {answer.points + contact.first_point, contact.manifold.point_count};
}
inline Range<const swiftprox_object_pair> began(const swiftprox_scene_events &events) noexcept
{
    return {events.began, events.began_count};
}
inline Range<const swiftprox_object_pair> ended(const swiftprox_scene_events &events) noexcept
{
    return {events.ended, events.ended_count};
}

/** Corners where all coordinates are least, and greatest. */
struct Box {
    std::array<double, 3> lower{};
    std::array<double, 3> upper{};
};

/** The calls of a scene that somebody else owns. */
class SceneView
{
  public:
    explicit SceneView(swiftprox_scene *scene) noexcept : scene_(scene) {}
    swiftprox_scene *get() const noexcept { return scene_; }

    /** An object of one convex piece. */
    Result<swiftprox_object_id> try_add(const Shape &shape, const ObjectOptions &options = {})
    {
        const swiftprox_object_options c = options.to_c();
        return detail::asked<swiftprox_object_id>([&](swiftprox_object_id *id) {
            const swiftprox_shape *piece = shape.get();
            return swiftprox_scene_add_object(scene_, &piece, 1, &c, id);
        });
    }
    /** An object of several convex pieces in one local frame. */
    Result<swiftprox_object_id> try_add(Range<const Shape> pieces, const ObjectOptions &options = {})
    {
        const swiftprox_object_options c = options.to_c();
        std::vector<const swiftprox_shape *> shapes;
        for (const Shape &piece : pieces) {
            shapes.push_back(piece.get());
        }
        return detail::asked<swiftprox_object_id>([&](swiftprox_object_id *id) {
            return swiftprox_scene_add_object(scene_, shapes.data(), shapes.size(), &c, id);
        });
    }
    /** A ground, which is fixed. */
    Result<swiftprox_object_id> try_add(const Ground &ground, const ObjectOptions &options = {})
    {
        swiftprox_object_options c = options.to_c();
        c.ground = ground.get();
        return detail::asked<swiftprox_object_id>([&](swiftprox_object_id *id) {
            return swiftprox_scene_add_object(scene_, nullptr, 0, &c, id);
        });
    }
    /** A compound as one body. */
    Result<swiftprox_object_id> try_add(const Compound &compound, const ObjectOptions &options = {})
    {
        swiftprox_object_options c = options.to_c();
        c.compound = compound.get();
        return detail::asked<swiftprox_object_id>([&](swiftprox_object_id *id) {
            return swiftprox_scene_add_object(scene_, nullptr, 0, &c, id);
        });
    }
    Result<swiftprox_object_id> try_copy_object(swiftprox_object_id original)
    {
        return detail::asked<swiftprox_object_id>([&](swiftprox_object_id *id) {
            return swiftprox_scene_copy_object(scene_, original, id);
        });
    }
    /** An object of one convex piece for each shape: all or none. `options`: as many, or none for the defaults. */
    Result<std::vector<swiftprox_object_id>> try_add_objects(Range<const Shape> shapes, Range<const ObjectOptions> options = {})
    {
        Result<std::vector<swiftprox_object_id>> result;
        if (!options.empty() && options.size() != shapes.size()) {
            return detail::refused<std::vector<swiftprox_object_id>>("options: there are not as many as shapes");
        }
        std::vector<const swiftprox_shape *> pointers;
        std::vector<swiftprox_object_options> c;
        for (const Shape &shape : shapes) {
            pointers.push_back(shape.get());
        }
        for (const ObjectOptions &each : options) {
            c.push_back(each.to_c());
        }
        result.value.resize(shapes.size());
        result.status = swiftprox_scene_add_objects(scene_, pointers.data(), c.empty() ? nullptr : c.data(), shapes.size(),
                                                    result.value.data());
        return result;
    }
    /** All or none. */
    Result<void> try_remove_objects(Range<const swiftprox_object_id> ids)
    {
        return detail::status(swiftprox_scene_remove_objects(scene_, ids.data(), ids.size()));
    }
    Result<void> try_remove_object(swiftprox_object_id id) { return detail::status(swiftprox_scene_remove_object(scene_, id)); }
    Result<bool> try_is_object_valid(swiftprox_object_id id) const
    {
        return detail::flag([&](std::int32_t *flag) {
            return swiftprox_scene_is_object_valid(scene_, id, flag);
        });
    }
    /** In order of creation. */
    Result<std::vector<swiftprox_object_id>> try_object_ids() const
    {
        Result<std::vector<swiftprox_object_id>> result;
        std::size_t count = 0;
        result.status = swiftprox_scene_copy_object_ids(scene_, nullptr, 0, &count);
        if (result && count > 0) {
            result.value.resize(count);
            result.status = swiftprox_scene_copy_object_ids(scene_, result.value.data(), count, &count);
        }
        return result;
    }
    Result<void> try_set_pose(swiftprox_object_id id, const Pose &pose)
    {
        return detail::status(swiftprox_scene_set_pose(scene_, id, pose.data()));
    }
    Result<void> try_set_transform(swiftprox_object_id id, const std::array<double, 9> &rotation,
                                   const std::array<double, 3> &translation)
    {
        return detail::status(swiftprox_scene_set_transform(scene_, id, rotation.data(), translation.data()));
    }
    /** A pose for each of the ids. */
    Result<void> try_set_poses(Range<const swiftprox_object_id> ids, Range<const Pose> poses)
    {
        if (ids.size() != poses.size()) {
            return detail::refused<void>("poses: there are not as many as ids");
        }
        return detail::status(swiftprox_scene_set_poses(scene_, detail::ids_of(ids), detail::rows_of(poses), poses.size()));
    }
    /** Of all objects that are not fixed, in order of creation. */
    Result<void> try_set_poses(Range<const Pose> poses)
    {
        return detail::status(swiftprox_scene_set_poses(scene_, nullptr, detail::rows_of(poses), poses.size()));
    }
    /** 9 numbers of rotations and 3 of translations for each of the ids. */
    Result<void> try_set_transforms(Range<const swiftprox_object_id> ids, Range<const double> rotations,
                                    Range<const double> translations)
    {
        if (rotations.size() != 9 * ids.size() || translations.size() != 3 * ids.size()) {
            return detail::refused<void>("rotations, translations: they are not 9 and 3 numbers an id");
        }
        return detail::status(
            swiftprox_scene_set_transforms(scene_, detail::ids_of(ids), rotations.data(), translations.data(), ids.size()));
    }
    /** Of all objects that are not fixed, in order of creation. */
    Result<void> try_set_transforms(Range<const double> rotations, Range<const double> translations)
    {
        if (rotations.size() % 9 != 0 || translations.size() % 3 != 0 || rotations.size() / 9 != translations.size() / 3) {
            return detail::refused<void>("rotations, translations: they are not 9 and 3 numbers an object");
        }
        const std::size_t count = translations.size() / 3;
        return detail::status(swiftprox_scene_set_transforms(scene_, nullptr, rotations.data(), translations.data(), count));
    }
    Result<void> try_set_piece_pose(swiftprox_object_id id, std::uint32_t piece, const Pose &pose)
    {
        return detail::status(swiftprox_scene_set_piece_pose(scene_, id, piece, pose.data()));
    }
    Result<Pose> try_piece_pose(swiftprox_object_id id, std::uint32_t piece = 0) const
    {
        std::array<double, 12> rows{};
        Result<Pose> result;
        result.status = swiftprox_scene_get_piece_pose(scene_, id, piece, rows.data());
        result.value = Pose(rows);
        return result;
    }
    Result<void> try_set_piece_user_data(swiftprox_object_id id, std::uint32_t piece, std::uint64_t user_data)
    {
        return detail::status(swiftprox_scene_set_piece_user_data(scene_, id, piece, user_data));
    }
    Result<std::uint64_t> try_piece_user_data(swiftprox_object_id id, std::uint32_t piece = 0) const
    {
        return detail::asked<std::uint64_t>([&](std::uint64_t *user_data) {
            return swiftprox_scene_get_piece_user_data(scene_, id, piece, user_data);
        });
    }
    Result<swiftprox_object_info> try_object_info(swiftprox_object_id id) const
    {
        return detail::asked<swiftprox_object_info>([&](swiftprox_object_info *info) {
            info->struct_size = sizeof *info;
            return swiftprox_scene_get_object_info(scene_, id, info);
        });
    }
    /** Makes an object what an info says, which object_info() gave and the program has changed. */
    Result<void> try_set_object_info(swiftprox_object_id id, const swiftprox_object_info &info)
    {
        return detail::status(swiftprox_scene_set_object_info(scene_, id, &info));
    }
    /** A box along the world's axes that contains the object. */
    Result<Box> try_object_box(swiftprox_object_id id) const
    {
        Result<Box> result;
        result.status = swiftprox_scene_get_object_box(scene_, id, result.value.lower.data(), result.value.upper.data());
        return result;
    }
    /** A share of its own. */
    Result<Shape> try_piece(swiftprox_object_id id, std::size_t piece = 0) const
    {
        const swiftprox_shape *shape = nullptr;
        Result<Shape> result;
        result.status = swiftprox_scene_get_piece(scene_, id, piece, &shape);
        result.value = Shape::adopt(shape ? swiftprox_shape_retain(shape) : nullptr);
        return result;
    }
    Result<swiftprox_scene_answer> try_query_intersection(const SceneQuery &query = {})
    {
        const swiftprox_scene_query c = query.to_c();
        return detail::asked<swiftprox_scene_answer>([&](swiftprox_scene_answer *answer) {
            return swiftprox_scene_query_intersection(scene_, &c, answer);
        });
    }
    Result<swiftprox_scene_answer> try_query_distance(const SceneQuery &query = {})
    {
        const swiftprox_scene_query c = query.to_c();
        return detail::asked<swiftprox_scene_answer>([&](swiftprox_scene_answer *answer) {
            return swiftprox_scene_query_distance(scene_, &c, answer);
        });
    }
    Result<swiftprox_scene_answer> try_query_approximate(const SceneQuery &query = {})
    {
        const swiftprox_scene_query c = query.to_c();
        return detail::asked<swiftprox_scene_answer>([&](swiftprox_scene_answer *answer) {
            return swiftprox_scene_query_approximate(scene_, &c, answer);
        });
    }
    Result<swiftprox_scene_answer> try_query_contact(const SceneQuery &query = {})
    {
        const swiftprox_scene_query c = query.to_c();
        return detail::asked<swiftprox_scene_answer>([&](swiftprox_scene_answer *answer) {
            return swiftprox_scene_query_contact(scene_, &c, answer);
        });
    }
    /** How far one of the pairs of the last query of contacts is apart, or how deep, as one interval through zero. */
    Result<swiftprox_signed_distance> try_get_signed_distance(std::size_t number) const
    {
        return detail::asked<swiftprox_signed_distance>([&](swiftprox_signed_distance *answer) {
            return swiftprox_scene_get_signed_distance(scene_, number, answer);
        });
    }
    Result<swiftprox_scene_answer> try_query_object(swiftprox_object_id id, swiftprox_query_kind kind, const SceneQuery &query = {})
    {
        const swiftprox_scene_query c = query.to_c();
        return detail::asked<swiftprox_scene_answer>([&](swiftprox_scene_answer *answer) {
            return swiftprox_scene_query_object(scene_, id, kind, &c, answer);
        });
    }
    Result<swiftprox_scene_answer> try_query_placed(const Shape &shape, const Pose &pose, swiftprox_query_kind kind,
                                                    const SceneQuery &query = {})
    {
        const swiftprox_scene_query c = query.to_c();
        const swiftprox_placed piece{shape.get(), pose.data()};
        return detail::asked<swiftprox_scene_answer>(
            [&](swiftprox_scene_answer *answer) { return swiftprox_scene_query_placed(scene_, &piece, 1, kind, &c, answer); });
    }
    /** A body of several convex pieces. */
    Result<swiftprox_scene_answer> try_query_placed(Range<const Shape> pieces, Range<const Pose> poses,
                                                    swiftprox_query_kind kind, const SceneQuery &query = {})
    {
        if (poses.size() != pieces.size()) {
            return detail::refused<swiftprox_scene_answer>("poses: there are not as many as pieces");
        }
        std::vector<swiftprox_placed> placed;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            placed.push_back({pieces[i].get(), poses[i].data()});
        }
        const swiftprox_scene_query c = query.to_c();
        return detail::asked<swiftprox_scene_answer>([&](swiftprox_scene_answer *answer) {
            return swiftprox_scene_query_placed(scene_, placed.data(), placed.size(), kind, &c, answer);
        });
    }
    Result<swiftprox_scene_events> try_query_events(double distance = 0)
    {
        return detail::asked<swiftprox_scene_events>([&](swiftprox_scene_events *events) {
            return swiftprox_scene_query_events(scene_, distance, events);
        });
    }
    Result<swiftprox_scene_statistics> try_statistics() const
    {
        return detail::asked<swiftprox_scene_statistics>([&](swiftprox_scene_statistics *statistics) {
            return swiftprox_scene_get_statistics(scene_, statistics);
        });
    }
    Result<void> try_reset_statistics() { return detail::status(swiftprox_scene_reset_statistics(scene_)); }
    Result<void> try_set_kept_pair_limit(std::uint64_t limit)
    {
        return detail::status(swiftprox_scene_set_kept_pair_limit(scene_, limit));
    }
    Result<void> try_shrink() { return detail::status(swiftprox_scene_shrink(scene_)); }
    Result<void> try_set_pair_active(swiftprox_object_id id1, swiftprox_object_id id2, bool active)
    {
        return detail::status(swiftprox_scene_set_pair_active(scene_, &id1, &id2, active ? 1 : 0));
    }
    /** All pairs that an object is in now. */
    Result<void> try_set_pairs_active(swiftprox_object_id id, bool active)
    {
        return detail::status(swiftprox_scene_set_pair_active(scene_, &id, nullptr, active ? 1 : 0));
    }
    /** All pairs that there are now. */
    Result<void> try_set_pairs_active(bool active)
    {
        return detail::status(swiftprox_scene_set_pair_active(scene_, nullptr, nullptr, active ? 1 : 0));
    }
    Result<bool> try_pair_active(swiftprox_object_id id1, swiftprox_object_id id2) const
    {
        return detail::flag([&](std::int32_t *flag) { return swiftprox_scene_get_pair_active(scene_, id1, id2, flag); });
    }
    Result<void> try_set_pairs(Range<const std::array<swiftprox_object_id, 2>> pairs)
    {
        const swiftprox_object_id *first = pairs.empty() ? nullptr : pairs.data()->data();
        const swiftprox_object_id *ids = detail::ids_of({first, pairs.size()});
        return detail::status(swiftprox_scene_set_pairs(scene_, ids, pairs.size()));
    }
    Result<void> try_reset_pairs() { return detail::status(swiftprox_scene_reset_pairs(scene_)); }
    /** What began, goes on and has ended since the listener last asked. */
    Result<Heard> try_listen(Listener &listener, swiftprox_query_kind kind, const SceneQuery &query = {})
    {
        const swiftprox_scene_query c = query.to_c();
        Result<Heard> result;
        result.status = swiftprox_scene_listen(scene_, listener.get(), kind, &c, &result.value.answer, &result.value.events);
        return result;
    }
    /** Makes the questions below fast after changes. */
    Result<void> try_prepare() { return detail::status(swiftprox_scene_prepare(scene_)); }
    /** Without a second set: against all others. */
    Result<swiftprox_least_distance> try_least_distance(const ObjectSet &set, SetScratch &scratch,
                                                        const ObjectSet *against = nullptr,
                                                        double max_distance = std::numeric_limits<double>::infinity()) const
    {
        if (set.is_uneven() || (against && against->is_uneven())) {
            return detail::uneven<swiftprox_least_distance>();
        }
        const swiftprox_object_set c = set.to_c();
        const swiftprox_object_set second = against ? against->to_c() : swiftprox_object_set{};
        return detail::asked<swiftprox_least_distance>([&](swiftprox_least_distance *answer) {
            return swiftprox_scene_least_distance(scene_, &c, against ? &second : nullptr, max_distance, scratch.get(), answer);
        });
    }
    /** `poses`: those of all objects at the first time, then at the second, and so on. */
    Result<swiftprox_first_hit> try_first_hit(const ObjectSet &set, Range<const Pose> poses, SetScratch &scratch,
                                              swiftprox_pose_order order = SWIFTPROX_POSE_ORDER_BISECTION,
                                              double max_distance = 0) const
    {
        if (set.ids.empty() || poses.size() % set.ids.size() != 0) {
            return detail::refused<swiftprox_first_hit>("poses: there is not one for each object at each time");
        }
        const swiftprox_object_set c = set.to_c();
        const std::size_t times = poses.size() / set.ids.size();
        return detail::asked<swiftprox_first_hit>([&](swiftprox_first_hit *answer) {
            return swiftprox_scene_first_hit(scene_, &c, swiftprox_path{detail::rows_of(poses), times, order}, max_distance,
                                             scratch.get(), answer);
        });
    }
    /** The scratch owns the hits, until its next use. */
    Result<swiftprox_scene_ray_answer> try_cast_ray(const swiftprox_ray &ray, SetScratch &scratch,
                                                    swiftprox_ray_hits hits = SWIFTPROX_RAY_HITS_FIRST,
                                                    std::uint32_t mask = UINT32_MAX) const
    {
        return detail::asked<swiftprox_scene_ray_answer>([&](swiftprox_scene_ray_answer *answer) {
            return swiftprox_scene_cast_ray(scene_, &ray, hits, mask, scratch.get(), answer);
        });
    }
    /** One motion for all objects together, or one for each. */
    Result<swiftprox_scene_cast_answer> try_cast(const ObjectSet &set, Range<const swiftprox_motion> motions,
                                                 SetScratch &scratch, const CastConfig &config = {}) const
    {
        const swiftprox_object_set c = set.to_c();
        const swiftprox_cast_config of_cast = config.to_c();
        return detail::asked<swiftprox_scene_cast_answer>([&](swiftprox_scene_cast_answer *answer) {
            return swiftprox_scene_cast(scene_, &c, swiftprox_motions{motions.data(), motions.size(), 1}, &of_cast,
                                        scratch.get(), answer);
        });
    }
    /** One motion for each edge, or one for each object at each edge. */
    Result<std::vector<swiftprox_scene_cast_answer>> try_cast_batch(const ObjectSet &set, Range<const swiftprox_motion> motions,
                                                                    std::size_t edge_count, SetScratch &scratch,
                                                                    const CastConfig &config = {}) const
    {
        const swiftprox_object_set c = set.to_c();
        const swiftprox_cast_config of_cast = config.to_c();
        Result<std::vector<swiftprox_scene_cast_answer>> result;
        result.value.resize(edge_count);
        result.status = swiftprox_scene_cast(scene_, &c, swiftprox_motions{motions.data(), motions.size(), edge_count}, &of_cast,
                                             scratch.get(), result.value.data());
        return result;
    }
    /** Without a set: of all objects. The scratch owns contacts and points, until its next use. */
    Result<swiftprox_scene_ground_answer> try_ground_contacts(PlacedGround ground, SetScratch &scratch,
                                                              const SceneGroundConfig &config = {},
                                                              const ObjectSet *set = nullptr) const
    {
        return detail::floor_contacts(
            set, config,
            [&](const swiftprox_object_set *of, const swiftprox_scene_ground_config *c, swiftprox_scene_ground_answer *answer) {
                return swiftprox_scene_ground_contacts(scene_, of, swiftprox_placed_ground{ground.ground(), ground.pose()},
                                                       c, scratch.get(), answer);
            });
    }
    /** With the grounds that are objects of the scene. */
    Result<swiftprox_scene_ground_answer> try_ground_contacts(SetScratch &scratch, const SceneGroundConfig &config = {},
                                                              const ObjectSet *set = nullptr) const
    {
        return detail::floor_contacts(
            set, config,
            [&](const swiftprox_object_set *of, const swiftprox_scene_ground_config *c, swiftprox_scene_ground_answer *answer) {
                return swiftprox_scene_ground_contacts(scene_, of, swiftprox_placed_ground{nullptr, nullptr}, c,
                                                       scratch.get(), answer);
            });
    }
    /** A contact for each piece. */
    Result<swiftprox_scene_ground_answer> try_half_space_contacts(const swiftprox_half_space &half_space, SetScratch &scratch,
                                                                  const SceneGroundConfig &config = {},
                                                                  const ObjectSet *set = nullptr) const
    {
        return detail::floor_contacts(
            set, config,
            [&](const swiftprox_object_set *of, const swiftprox_scene_ground_config *c, swiftprox_scene_ground_answer *answer) {
                return swiftprox_scene_half_space_contacts(scene_, of, &half_space, c, scratch.get(), answer);
            });
    }
    Result<void> try_record(const std::string &path) { return detail::status(swiftprox_scene_record(scene_, path.c_str())); }
    Result<void> try_end_recording() { return detail::status(swiftprox_scene_record(scene_, nullptr)); }

#if SWIFTPROX_HAS_EXCEPTIONS
    swiftprox_object_id add(const Shape &shape, const ObjectOptions &options = {}) { return take(try_add(shape, options)); }
    swiftprox_object_id add(Range<const Shape> pieces, const ObjectOptions &options = {})
    {
        return take(try_add(pieces, options));
    }
    swiftprox_object_id add(const Ground &ground, const ObjectOptions &options = {}) { return take(try_add(ground, options)); }
    swiftprox_object_id add(const Compound &compound, const ObjectOptions &options = {})
    {
        return take(try_add(compound, options));
    }
    swiftprox_object_id copy_object(swiftprox_object_id original) { return take(try_copy_object(original)); }
    std::vector<swiftprox_object_id> add_objects(Range<const Shape> shapes, Range<const ObjectOptions> options = {})
    {
        return take(try_add_objects(shapes, options));
    }
    void remove_objects(Range<const swiftprox_object_id> ids) { take(try_remove_objects(ids)); }
    void remove_object(swiftprox_object_id id) { take(try_remove_object(id)); }
    bool is_object_valid(swiftprox_object_id id) const { return take(try_is_object_valid(id)); }
    std::vector<swiftprox_object_id> object_ids() const { return take(try_object_ids()); }
    void set_pose(swiftprox_object_id id, const Pose &pose) { take(try_set_pose(id, pose)); }
    void set_transform(swiftprox_object_id id, const std::array<double, 9> &rotation, const std::array<double, 3> &translation)
    {
        take(try_set_transform(id, rotation, translation));
    }
    void set_poses(Range<const swiftprox_object_id> ids, Range<const Pose> poses) { take(try_set_poses(ids, poses)); }
    void set_poses(Range<const Pose> poses) { take(try_set_poses(poses)); }
    void set_transforms(Range<const swiftprox_object_id> ids, Range<const double> rotations, Range<const double> translations)
    {
        take(try_set_transforms(ids, rotations, translations));
    }
    void set_transforms(Range<const double> rotations, Range<const double> translations)
    {
        take(try_set_transforms(rotations, translations));
    }
    void set_piece_pose(swiftprox_object_id id, std::uint32_t piece, const Pose &pose)
    {
        take(try_set_piece_pose(id, piece, pose));
    }
    Pose piece_pose(swiftprox_object_id id, std::uint32_t piece = 0) const { return take(try_piece_pose(id, piece)); }
    void set_piece_user_data(swiftprox_object_id id, std::uint32_t piece, std::uint64_t user_data)
    {
        take(try_set_piece_user_data(id, piece, user_data));
    }
    std::uint64_t piece_user_data(swiftprox_object_id id, std::uint32_t piece = 0) const
    {
        return take(try_piece_user_data(id, piece));
    }
    swiftprox_object_info object_info(swiftprox_object_id id) const { return take(try_object_info(id)); }
    void set_object_info(swiftprox_object_id id, const swiftprox_object_info &info) { take(try_set_object_info(id, info)); }
    Box object_box(swiftprox_object_id id) const { return take(try_object_box(id)); }
    Shape piece(swiftprox_object_id id, std::size_t piece = 0) const { return take(try_piece(id, piece)); }
    swiftprox_scene_answer query_intersection(const SceneQuery &query = {}) { return take(try_query_intersection(query)); }
    swiftprox_scene_answer query_distance(const SceneQuery &query = {}) { return take(try_query_distance(query)); }
    swiftprox_scene_answer query_approximate(const SceneQuery &query = {})
    {
        return take(try_query_approximate(query));
    }
    swiftprox_scene_answer query_contact(const SceneQuery &query = {}) { return take(try_query_contact(query)); }
    swiftprox_signed_distance get_signed_distance(std::size_t number) const { return take(try_get_signed_distance(number)); }
    swiftprox_scene_answer query_object(swiftprox_object_id id, swiftprox_query_kind kind, const SceneQuery &query = {})
    {
        return take(try_query_object(id, kind, query));
    }
    swiftprox_scene_answer query_placed(const Shape &shape, const Pose &pose, swiftprox_query_kind kind,
                                        const SceneQuery &query = {})
    {
        return take(try_query_placed(shape, pose, kind, query));
    }
    swiftprox_scene_answer query_placed(Range<const Shape> pieces, Range<const Pose> poses, swiftprox_query_kind kind,
                                        const SceneQuery &query = {})
    {
        return take(try_query_placed(pieces, poses, kind, query));
    }
    swiftprox_scene_events query_events(double distance = 0) { return take(try_query_events(distance)); }
    swiftprox_scene_statistics statistics() const { return take(try_statistics()); }
    void reset_statistics() { take(try_reset_statistics()); }
    void set_kept_pair_limit(std::uint64_t limit) { take(try_set_kept_pair_limit(limit)); }
    void shrink() { take(try_shrink()); }
    void set_pair_active(swiftprox_object_id id1, swiftprox_object_id id2, bool active)
    {
        take(try_set_pair_active(id1, id2, active));
    }
    void set_pairs_active(swiftprox_object_id id, bool active) { take(try_set_pairs_active(id, active)); }
    void set_pairs_active(bool active) { take(try_set_pairs_active(active)); }
    bool pair_active(swiftprox_object_id id1, swiftprox_object_id id2) const { return take(try_pair_active(id1, id2)); }
    void set_pairs(Range<const std::array<swiftprox_object_id, 2>> pairs) { take(try_set_pairs(pairs)); }
    void reset_pairs() { take(try_reset_pairs()); }
    Heard listen(Listener &listener, swiftprox_query_kind kind, const SceneQuery &query = {})
    {
        return take(try_listen(listener, kind, query));
    }
    void prepare() { take(try_prepare()); }
    swiftprox_least_distance least_distance(const ObjectSet &set, SetScratch &scratch, const ObjectSet *against = nullptr,
                                            double max_distance = std::numeric_limits<double>::infinity()) const
    {
        return take(try_least_distance(set, scratch, against, max_distance));
    }
    swiftprox_first_hit first_hit(const ObjectSet &set, Range<const Pose> poses, SetScratch &scratch,
                                  swiftprox_pose_order order = SWIFTPROX_POSE_ORDER_BISECTION, double max_distance = 0) const
    {
        return take(try_first_hit(set, poses, scratch, order, max_distance));
    }
    swiftprox_scene_ray_answer cast_ray(const swiftprox_ray &ray, SetScratch &scratch,
                                        swiftprox_ray_hits hits = SWIFTPROX_RAY_HITS_FIRST,
                                        std::uint32_t mask = UINT32_MAX) const
    {
        return take(try_cast_ray(ray, scratch, hits, mask));
    }
    swiftprox_scene_cast_answer cast(const ObjectSet &set, Range<const swiftprox_motion> motions, SetScratch &scratch,
                                     const CastConfig &config = {}) const
    {
        return take(try_cast(set, motions, scratch, config));
    }
    std::vector<swiftprox_scene_cast_answer> cast_batch(const ObjectSet &set, Range<const swiftprox_motion> motions,
                                                        std::size_t edge_count, SetScratch &scratch,
                                                        const CastConfig &config = {}) const
    {
        return take(try_cast_batch(set, motions, edge_count, scratch, config));
    }
    swiftprox_scene_ground_answer ground_contacts(PlacedGround ground, SetScratch &scratch, const SceneGroundConfig &config = {},
                                                  const ObjectSet *set = nullptr) const
    {
        return take(try_ground_contacts(ground, scratch, config, set));
    }
    swiftprox_scene_ground_answer ground_contacts(SetScratch &scratch, const SceneGroundConfig &config = {},
                                                  const ObjectSet *set = nullptr) const
    {
        return take(try_ground_contacts(scratch, config, set));
    }
    swiftprox_scene_ground_answer half_space_contacts(const swiftprox_half_space &half_space, SetScratch &scratch,
                                                      const SceneGroundConfig &config = {}, const ObjectSet *set = nullptr) const
    {
        return take(try_half_space_contacts(half_space, scratch, config, set));
    }
    void record(const std::string &path) { take(try_record(path)); }
    void end_recording() { take(try_end_recording()); }
#endif

  protected:
    swiftprox_scene *scene_ = nullptr;
};

/** Says whether a pair of objects is to be tested. It must not throw: the program would end. */
using PairFilter = std::function<bool(swiftprox_object_id object1, swiftprox_object_id object2)>;

/** A scene of the program's own. */
class Scene : public SceneView
{
  public:
    static Result<Scene> try_create(const SceneOptions &options = {})
    {
        const swiftprox_scene_options c = options.to_c();
        Result<Scene> result;
        result.status = swiftprox_scene_create(&c, &result.value.scene_);
        return result;
    }
#if SWIFTPROX_HAS_EXCEPTIONS
    Scene() : Scene(SceneOptions{}) {}
    explicit Scene(const SceneOptions &options) : Scene(take(try_create(options))) {}
#endif
    /** No scene, as one that was moved away: calls answer SWIFTPROX_ERROR_NULL_POINTER. */
    static Scene none() noexcept { return Scene(nullptr); }
    Scene(Scene &&other) noexcept : SceneView(std::exchange(other.scene_, nullptr)), filter_(std::move(other.filter_)) {}
    Scene &operator=(Scene &&other) noexcept
    {
        std::swap(scene_, other.scene_);
        std::swap(filter_, other.filter_);
        return *this;
    }
    ~Scene()
    {
        // What cannot be written of a recording the log is told; try_end_recording says it.
        static_cast<void>(try_destroy());
    }
    /** Ends the scene now, and says how that went. */
    Result<void> try_destroy() noexcept { return detail::status(swiftprox_scene_destroy(std::exchange(scene_, nullptr))); }
    /** Asks `filter` of each pair whether it is to be tested; an empty one: none is asked. */
    Result<void> try_set_pair_filter(PairFilter filter)
    {
        std::unique_ptr<PairFilter> kept = filter ? std::make_unique<PairFilter>(std::move(filter)) : nullptr;
        const Result<void> result =
            detail::status(swiftprox_scene_set_pair_filter(scene_, kept ? &Scene::ask_filter : nullptr, kept.get()));
        if (result) {
            filter_ = std::move(kept);
        }
        return result;
    }
#if SWIFTPROX_HAS_EXCEPTIONS
    void set_pair_filter(PairFilter filter) { take(try_set_pair_filter(std::move(filter))); }
#endif

  private:
    explicit Scene(std::nullptr_t) noexcept : SceneView(nullptr) {}

    static std::int32_t ask_filter(swiftprox_object_id object1, swiftprox_object_id object2, void *user)
    {
        return (*static_cast<const PairFilter *>(user))(object1, object2) ? 1 : 0;
    }

    /** At a place of its own: the scene points at it, however this is moved. */
    std::unique_ptr<PairFilter> filter_;
};

} // namespace swiftprox

#endif
