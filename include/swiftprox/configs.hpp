/* Configs: the defaults of C as member initialisers. c_tests/cpp/cpp.cpp compares. */
#ifndef SWIFTPROX_CONFIGS_HPP
#define SWIFTPROX_CONFIGS_HPP

#include "../swiftprox.h"
#include "motion.h"
#include "pose.hpp"
#include "tuning.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

namespace swiftprox
{

constexpr double infinity = std::numeric_limits<double>::infinity();

struct ShapeTuning {
    swiftprox_hierarchy hierarchy = SWIFTPROX_HIERARCHY_AUTOMATIC;
    swiftprox_lookup lookup = SWIFTPROX_LOOKUP_AUTOMATIC;
    double decimation = 0.25;
    std::size_t minimum_triangles = 50;
    std::size_t most_levels = 32;
    double lookup_radius_factor = 2;
    std::uint32_t lookup_resolution = 0;

    swiftprox_shape_tuning to_c() const noexcept
    {
        swiftprox_shape_tuning c{};
        c.struct_size = sizeof c;
        c.hierarchy = hierarchy;
        c.lookup = lookup;
        c.decimation = decimation;
        c.minimum_triangles = minimum_triangles;
        c.most_levels = most_levels;
        c.lookup_radius_factor = lookup_radius_factor;
        c.lookup_resolution = lookup_resolution;
        return c;
    }
};

struct PairTuning {
    swiftprox_start start = SWIFTPROX_START_AUTOMATIC;
    swiftprox_levels levels = SWIFTPROX_LEVELS_AUTOMATIC;
    swiftprox_refinement refinement = SWIFTPROX_REFINEMENT_ADAPTIVE;

    swiftprox_pair_tuning to_c() const noexcept
    {
        swiftprox_pair_tuning c{};
        c.struct_size = sizeof c;
        c.start = start;
        c.levels = levels;
        c.refinement = refinement;
        return c;
    }
};

/** Learns how far a build is, from 0 to 1, and says whether to go on. It must not throw: the program would end. */
using Progress = std::function<bool(double fraction)>;

namespace detail
{
inline std::int32_t report(void *user, double fraction)
{
    return (*static_cast<const Progress *>(user))(fraction) ? 0 : 1;
}
inline swiftprox_progress_callback callback_of(const Progress &progress) noexcept
{
    return progress ? report : nullptr;
}
// C asks for a pointer that is not const; report() makes it one again.
inline void *user_of(const Progress &progress) noexcept
{
    return const_cast<Progress *>(&progress);
}
} // namespace detail

struct ShapeOptions {
    swiftprox_input input = SWIFTPROX_INPUT_STRICT;
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::array<double, 3> translation{};
    double scale = 1;
    double convexity_tolerance = -1;
    double face_noise = -1;
    double swept_radius = 0;
    Progress progress{};
    ShapeTuning tuning{};

    /** `tuning_in_c` is to live as long as what is returned, and this. */
    swiftprox_shape_options to_c(swiftprox_shape_tuning &tuning_in_c) const noexcept
    {
        swiftprox_shape_options c{};
        c.struct_size = sizeof c;
        c.input = input;
        for (std::size_t i = 0; i < 9; ++i) {
            c.rotation[i] = rotation[i];
        }
        for (std::size_t i = 0; i < 3; ++i) {
            c.translation[i] = translation[i];
        }
        c.scale = scale;
        c.convexity_tolerance = convexity_tolerance;
        c.face_noise = face_noise;
        c.swept_radius = swept_radius;
        c.progress = detail::callback_of(progress);
        c.progress_user = detail::user_of(progress);
        tuning_in_c = tuning.to_c();
        c.tuning = &tuning_in_c;
        return c;
    }
};

struct PairConfig {
    double max_distance = infinity;
    double absolute_error = 0;
    double relative_error = 0;
    std::uint32_t step_budget = UINT32_MAX;
    /** Null: the automatic choice. */
    const swiftprox_pair_tuning *tuning = nullptr;

    swiftprox_pair_config to_c() const noexcept
    {
        swiftprox_pair_config c{};
        c.struct_size = sizeof c;
        c.max_distance = max_distance;
        c.absolute_error = absolute_error;
        c.relative_error = relative_error;
        c.step_budget = step_budget;
        c.tuning = tuning;
        return c;
    }
};

struct DepthConfig {
    double absolute_error = 0;
    double relative_error = 0;
    std::uint32_t step_budget = UINT32_MAX;

    swiftprox_depth_config to_c() const noexcept
    {
        swiftprox_depth_config c{};
        c.struct_size = sizeof c;
        c.absolute_error = absolute_error;
        c.relative_error = relative_error;
        c.step_budget = step_budget;
        return c;
    }
};

struct ManifoldConfig {
    double max_distance = 0;
    bool reduces = false;

    swiftprox_manifold_config to_c() const noexcept
    {
        swiftprox_manifold_config c{};
        c.struct_size = sizeof c;
        c.max_distance = max_distance;
        c.reduces = reduces ? 1 : 0;
        return c;
    }
};

struct SceneGroundConfig {
    double max_distance = 0;
    bool reduces = false;
    /** 0 means the first. */
    std::uint32_t groups = 0;
    /** 0 means all. */
    std::uint32_t mask = 0;

    swiftprox_scene_ground_config to_c() const noexcept
    {
        swiftprox_scene_ground_config c{};
        c.struct_size = sizeof c;
        c.max_distance = max_distance;
        c.reduces = reduces ? 1 : 0;
        c.groups = groups;
        c.mask = mask;
        return c;
    }
};

struct CastConfig {
    double time_begin = 0;
    double time_end = 1;
    double time_tolerance = 1e-9;
    double max_distance = 0;
    std::uint32_t step_budget = 100000;
    bool ignores_parting = false;

    swiftprox_cast_config to_c() const noexcept
    {
        swiftprox_cast_config c{};
        c.struct_size = sizeof c;
        c.time_begin = time_begin;
        c.time_end = time_end;
        c.time_tolerance = time_tolerance;
        c.max_distance = max_distance;
        c.step_budget = step_budget;
        c.ignores_parting = ignores_parting;
        return c;
    }
};

struct ClearanceConfig {
    double time_begin = 0;
    double time_end = 1;
    double absolute_error = 0;
    double relative_error = 0.01;
    std::uint32_t step_budget = 100000;

    swiftprox_clearance_config to_c() const noexcept
    {
        swiftprox_clearance_config c{};
        c.struct_size = sizeof c;
        c.time_begin = time_begin;
        c.time_end = time_end;
        c.absolute_error = absolute_error;
        c.relative_error = relative_error;
        c.step_budget = step_budget;
        return c;
    }
};

struct SceneOptions {
    std::uint32_t worker_count = 0;
    swiftprox_enqueue_task_callback enqueue_task = nullptr;
    swiftprox_finish_task_callback finish_task = nullptr;
    void *task_user = nullptr;

    swiftprox_scene_options to_c() const noexcept
    {
        swiftprox_scene_options c{};
        c.struct_size = sizeof c;
        c.worker_count = worker_count;
        c.enqueue_task = enqueue_task;
        c.finish_task = finish_task;
        c.task_user = task_user;
        return c;
    }
};

struct ObjectOptions {
    std::uint64_t user_data = 0;
    Pose pose{};
    bool fixed = false;
    std::uint32_t groups = 0;
    std::uint32_t mask = 0;

    swiftprox_object_options to_c() const noexcept
    {
        swiftprox_object_options c{};
        c.struct_size = sizeof c;
        c.user_data = user_data;
        for (std::size_t i = 0; i < 12; ++i) {
            c.pose[i] = pose.rows()[i];
        }
        c.fixed = fixed ? 1 : 0;
        c.groups = groups;
        c.mask = mask;
        c.ground = nullptr; // Scene::try_add sets them
        c.compound = nullptr;
        return c;
    }
};

struct SceneQuery {
    double max_distance = SWIFTPROX_DEFAULT_MAX_DISTANCE;
    double absolute_error = 0;
    double relative_error = 0;
    double error_budget = infinity;
    std::uint32_t step_budget = UINT32_MAX;
    bool early_exit = false;
    /** Null: the automatic choice. */
    const swiftprox_pair_tuning *tuning = nullptr;
    swiftprox_contact_detail detail = SWIFTPROX_CONTACT_DETAIL_NONE;
    /** Of placed bodies: the groups of objects that are asked; 0 for all. */
    std::uint32_t mask = 0;
    /** Which pairs of pieces are listed for every two objects. */
    swiftprox_piece_pairs piece_pairs = SWIFTPROX_PIECE_PAIRS_EVERY;

    swiftprox_scene_query to_c() const noexcept
    {
        swiftprox_scene_query c{};
        c.struct_size = sizeof c;
        c.max_distance = max_distance;
        c.absolute_error = absolute_error;
        c.relative_error = relative_error;
        c.error_budget = error_budget;
        c.step_budget = step_budget;
        c.early_exit = early_exit ? 1 : 0;
        c.tuning = tuning;
        c.detail = detail;
        c.mask = mask;
        c.piece_pairs = piece_pairs;
        return c;
    }
};

} // namespace swiftprox

#endif
