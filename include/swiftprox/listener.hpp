/* What has begun, goes on and has ended since a listener last asked. */
#ifndef SWIFTPROX_LISTENER_HPP
#define SWIFTPROX_LISTENER_HPP

#include "scene.hpp"

namespace swiftprox
{

namespace detail
{
struct DestroyListener {
    void operator()(swiftprox_listener *listener) const noexcept { swiftprox_listener_destroy(listener); }
};
} // namespace detail

/** Remembers what was listed when it last asked, for itself. It owns the events that it heard. */
class Listener
{
  public:
    static Result<Listener> try_create()
    {
        swiftprox_listener *made = nullptr;
        Result<Listener> result;
        result.status = swiftprox_listener_create(&made);
        result.value.owned_.reset(made);
        return result;
    }
    /** None yet: a question by it is refused. */
    Listener() noexcept = default;
    swiftprox_listener *get() const noexcept { return owned_.get(); }

  private:
    std::unique_ptr<swiftprox_listener, detail::DestroyListener> owned_;
};

/** What a query lists, and what of that has changed. */
struct Heard {
    swiftprox_scene_answer answer{};
    swiftprox_listener_events events{};
};

inline Range<const swiftprox_pair_event> pairs(const swiftprox_listener_events &events) noexcept
{
    return {events.pairs, events.count};
}
/** The points of one of the pairs. */
inline Range<const swiftprox_point_event> points(const swiftprox_listener_events &events, const swiftprox_pair_event &pair) noexcept
{
    return {events.points + pair.first_point, pair.point_count};
}

inline Result<Heard> try_listen(SceneView &scene, Listener &listener, swiftprox_query_kind kind, const SceneQuery &query = {})
{
    const swiftprox_scene_query c = query.to_c();
    Result<Heard> result;
    result.status =
        swiftprox_scene_listen(scene.get(), listener.get(), kind, &c, &result.value.answer, &result.value.events);
    return result;
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline Heard listen(SceneView &scene, Listener &listener, swiftprox_query_kind kind, const SceneQuery &query = {})
{
    return take(try_listen(scene, listener, kind, query));
}
#endif

} // namespace swiftprox

#endif
