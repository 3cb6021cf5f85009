/* Debug drawing: lines, points and texts. */
#ifndef SWIFTPROX_DRAW_HPP
#define SWIFTPROX_DRAW_HPP

#include "draw.h"
#include "scene.hpp"

namespace swiftprox
{

/** Who receives what is drawn. Its functions must not throw: the program would end. Places have 3 numbers. */
struct Draw {
    std::uint32_t kinds = UINT32_MAX;
    double normal_length = 1;
    std::function<void(swiftprox_draw_kind kind, const double *start, const double *end)> line{};
    std::function<void(swiftprox_draw_kind kind, const double *place)> point{};
    std::function<void(swiftprox_draw_kind kind, const double *place, const char *text)> text{};

    /** Good while this is. */
    swiftprox_draw to_c() const & noexcept
    {
        swiftprox_draw c{};
        c.struct_size = sizeof c;
        c.kinds = kinds;
        c.normal_length = normal_length;
        // C asks for a pointer that is not const; the callbacks make it one again.
        c.user = const_cast<Draw *>(this);
        c.line = line ? take_line : nullptr;
        c.point = point ? take_point : nullptr;
        c.text = text ? take_text : nullptr;
        return c;
    }
    swiftprox_draw to_c() const && = delete;

  private:
    static void take_line(void *user, swiftprox_draw_kind kind, const double *start, const double *end)
    {
        static_cast<const Draw *>(user)->line(kind, start, end);
    }
    static void take_point(void *user, swiftprox_draw_kind kind, const double *place)
    {
        static_cast<const Draw *>(user)->point(kind, place);
    }
    static void take_text(void *user, swiftprox_draw_kind kind, const double *place, const char *text)
    {
        static_cast<const Draw *>(user)->text(kind, place, text);
    }
};

/** A mask for Draw::kinds. */
template <class... Kinds> constexpr std::uint32_t draw_kinds(Kinds... kinds) noexcept
{
    return (0u | ... | (std::uint32_t{1} << kinds));
}

inline Result<void> try_draw(Placed object, const Draw &draw)
{
    const swiftprox_draw c = draw.to_c();
    return detail::status(swiftprox_shape_draw(object.to_c(), &c));
}
inline Result<void> try_draw(Placed a, Placed b, const Draw &draw, const ManifoldConfig &config = {})
{
    const swiftprox_draw c = draw.to_c();
    const swiftprox_manifold_config manifold = config.to_c();
    return detail::status(swiftprox_pair_draw(a.to_c(), b.to_c(), &manifold, &c));
}
inline Result<void> try_draw(const SceneView &scene, const Draw &draw)
{
    const swiftprox_draw c = draw.to_c();
    return detail::status(swiftprox_scene_draw(scene.get(), &c));
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline void draw(Placed object, const Draw &draw)
{
    take(try_draw(object, draw));
}
inline void draw(Placed a, Placed b, const Draw &draw, const ManifoldConfig &config = {})
{
    take(try_draw(a, b, draw, config));
}
inline void draw(const SceneView &scene, const Draw &draw)
{
    take(try_draw(scene, draw));
}
#endif

} // namespace swiftprox

#endif
