/* What has begun, goes on and has ended since a listener last asked. */
#ifndef SWIFTPROX_LISTENER_HPP
#define SWIFTPROX_LISTENER_HPP

#include "result.hpp"

#include <memory>

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
#if SWIFTPROX_HAS_EXCEPTIONS
    static Listener create() { return take(try_create()); }
#endif
    /** None yet: a question by it is refused. */
    Listener() noexcept = default;
    swiftprox_listener *get() const & noexcept { return owned_.get(); }
    swiftprox_listener *get() const && = delete;

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

} // namespace swiftprox

#endif
