/* Recordings of scenes, played back. */
#ifndef SWIFTPROX_REPLAY_HPP
#define SWIFTPROX_REPLAY_HPP

#include "scene.hpp"

#include <cstdint>
#include <string>
#include <utility>

namespace swiftprox {

/** A recording played back. */
class Replay
{
  public:
    static Result<Replay> try_open(const std::string &path, const SceneOptions &options = {})
    {
        const swiftprox_scene_options c = options.to_c();
        Result<Replay> result;
        result.status = swiftprox_replay_open(path.c_str(), &c, &result.value.replay_);
        return result;
    }
    Replay() noexcept = default;
    Replay(Replay &&other) noexcept : replay_(std::exchange(other.replay_, nullptr)) {}
    Replay &operator=(Replay &&other) noexcept
    {
        std::swap(replay_, other.replay_);
        return *this;
    }
    ~Replay() { static_cast<void>(swiftprox_replay_close(replay_)); }
    SceneView scene() const & noexcept { return SceneView(swiftprox_replay_scene(replay_)); }
    /** The scene would be gone with its replay. */
    SceneView scene() const && = delete;
    Result<swiftprox_replay_step_info> try_read()
    {
        return detail::asked<swiftprox_replay_step_info>([&](swiftprox_replay_step_info *step) {
            step->struct_size = sizeof *step;
            return swiftprox_replay_read(replay_, step);
        });
    }
    Result<void> try_change() { return detail::status(swiftprox_replay_change(replay_)); }
    /** `identical`, if not null: whether the answer is bit for bit the recorded one. */
    Result<swiftprox_scene_answer> try_ask(double max_distance = SWIFTPROX_DEFAULT_MAX_DISTANCE, bool *identical = nullptr)
    {
        std::int32_t same = 0;
        Result<swiftprox_scene_answer> result;
        result.status = swiftprox_replay_ask(replay_, max_distance, &result.value, &same);
        if (identical) {
            *identical = same != 0;
        }
        return result;
    }
    Result<std::uint32_t> try_number(swiftprox_object_id id) const
    {
        return detail::asked<std::uint32_t>(
            [&](std::uint32_t *number) { return swiftprox_replay_get_number(replay_, id, number); });
    }
#if SWIFTPROX_HAS_EXCEPTIONS
    static Replay open(const std::string &path, const SceneOptions &options = {}) { return take(try_open(path, options)); }
    swiftprox_replay_step_info read() { return take(try_read()); }
    void change() { take(try_change()); }
    swiftprox_scene_answer ask(double max_distance = SWIFTPROX_DEFAULT_MAX_DISTANCE, bool *identical = nullptr)
    {
        return take(try_ask(max_distance, identical));
    }
    std::uint32_t number(swiftprox_object_id id) const { return take(try_number(id)); }
#endif

  private:
    swiftprox_replay *replay_ = nullptr;
};

} // namespace swiftprox

#endif
