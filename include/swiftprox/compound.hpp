/* Compounds: bodies of several convex pieces. */
#ifndef SWIFTPROX_COMPOUND_HPP
#define SWIFTPROX_COMPOUND_HPP

#include "compound.h"
#include "motion.hpp"

namespace swiftprox
{

/** A share of a compound, or none. */
class Compound
{
  public:
    Compound() noexcept = default;
    Compound(const Compound &other) noexcept
        : compound_(other.compound_ ? swiftprox_compound_retain(other.compound_) : nullptr)
    {
    }
    Compound(Compound &&other) noexcept : compound_(std::exchange(other.compound_, nullptr)) {}
    Compound &operator=(Compound other) noexcept
    {
        std::swap(compound_, other.compound_);
        return *this;
    }
    ~Compound() { swiftprox_compound_release(compound_); }
    const swiftprox_compound *get() const & noexcept { return compound_; }
    /** The compound would be gone before its pointer. */
    const swiftprox_compound *get() const && = delete;
    explicit operator bool() const noexcept { return compound_ != nullptr; }

    /** Shapes with a pose for each; without poses all are at the identity. */
    static Result<Compound> try_from_shapes(Range<const swiftprox_shape *const> shapes, Range<const Pose> poses = {}) noexcept
    {
        if (!poses.empty() && shapes.size() != poses.size()) {
            return detail::refused<Compound>("each piece of a compound needs one pose, or none has one");
        }
        Result<Compound> result;
        result.status = swiftprox_compound_create(shapes.data(), poses.empty() ? nullptr : detail::rows_of(poses),
                                                  shapes.size(), &result.value.compound_);
        return result;
    }
    /** The convex pieces of a mesh, as in Shape::try_from_mesh: of its surface, or solid ones for a tolerance from 1e-4 to 1. */
    static Result<Compound> try_from_mesh(Range<const double> vertices, Range<const std::uint32_t> indices,
                                          Range<const std::uint32_t> valences = {}, double tolerance = 0) noexcept
    {
        if (const char *fault = detail::mesh_fault(vertices, indices, valences)) {
            return detail::refused<Compound>(fault);
        }
        Result<Compound> result;
        result.status = swiftprox_compound_create_from_mesh(detail::mesh_of(vertices, indices, valences), tolerance,
                                                            nullptr, nullptr, &result.value.compound_);
        return result;
    }
    Result<swiftprox_compound_info> try_info() const noexcept
    {
        Result<swiftprox_compound_info> result;
        result.status = swiftprox_compound_get_info(compound_, &result.value);
        return result;
    }
    /** A share of a piece's shape. */
    Result<Shape> try_piece(std::uint32_t piece) const noexcept
    {
        const swiftprox_shape *shape = nullptr;
        std::array<double, 12> rows{};
        Result<Shape> result;
        result.status = swiftprox_compound_get_piece(compound_, piece, &shape, rows.data());
        result.value = Shape::adopt(shape ? swiftprox_shape_retain(shape) : nullptr);
        return result;
    }
    /** Its pose in the compound. */
    Result<Pose> try_piece_pose(std::uint32_t piece) const noexcept
    {
        const swiftprox_shape *shape = nullptr;
        std::array<double, 12> rows{};
        Result<Pose> result;
        result.status = swiftprox_compound_get_piece(compound_, piece, &shape, rows.data());
        result.value = Pose(rows);
        return result;
    }

#if SWIFTPROX_HAS_EXCEPTIONS
    static Compound from_shapes(Range<const swiftprox_shape *const> shapes, Range<const Pose> poses = {})
    {
        return take(try_from_shapes(shapes, poses));
    }
    static Compound from_mesh(Range<const double> vertices, Range<const std::uint32_t> indices,
                              Range<const std::uint32_t> valences = {}, double tolerance = 0)
    {
        return take(try_from_mesh(vertices, indices, valences, tolerance));
    }
    swiftprox_compound_info info() const { return take(try_info()); }
    Shape piece(std::uint32_t piece) const { return take(try_piece(piece)); }
    Pose piece_pose(std::uint32_t piece) const { return take(try_piece_pose(piece)); }
#endif

  private:
    const swiftprox_compound *compound_ = nullptr;
};

/** A compound where it is. The pose is its own; a share of the compound must live on, so that a temporary Compound is refused. */
class PlacedCompound
{
  public:
    PlacedCompound(const Compound &compound, const Pose &pose) noexcept : compound_(compound.get()), pose_(pose) {}
    PlacedCompound(const Compound &&, const Pose &) = delete;
    /** Good while this is. */
    swiftprox_placed_compound to_c() const & noexcept { return {compound_, pose_.data()}; }
    swiftprox_placed_compound to_c() const && = delete;

  private:
    const swiftprox_compound *compound_;
    Pose pose_;
};

/** A compound and how it moves. The motion is its own; a share of the compound must live on, so that a temporary one is refused. */
class MovingCompound
{
  public:
    MovingCompound(const Compound &compound, const swiftprox_motion &motion) noexcept : compound_(compound.get()), motion_(motion) {}
    MovingCompound(const Compound &&, const swiftprox_motion &) = delete;
    /** Good while this is. */
    swiftprox_moving_compound to_c() const & noexcept { return {compound_, &motion_}; }
    swiftprox_moving_compound to_c() const && = delete;

  private:
    const swiftprox_compound *compound_;
    swiftprox_motion motion_;
};

/** What a pair of compounds remembers: keep one for each pair. Cold when made. */
struct CompoundCache : swiftprox_compound_cache {
    CompoundCache() noexcept : swiftprox_compound_cache{} {}
};

namespace detail
{
template <class Answer>
using CompoundCall = swiftprox_status (*)(swiftprox_placed_compound, swiftprox_placed_compound, swiftprox_compound_cache *,
                                          const swiftprox_pair_config *, Answer *);
template <class Answer>
Result<Answer> compounds(CompoundCall<Answer> call, const PlacedCompound &a, const PlacedCompound &b, CompoundCache &cache,
                         const PairConfig &config) noexcept
{
    const swiftprox_pair_config c = config.to_c();
    Result<Answer> result;
    result.status = call(a.to_c(), b.to_c(), &cache, &c, &result.value);
    return result;
}
} // namespace detail

inline Result<swiftprox_compound_answer> try_compound_distance(const PlacedCompound &a, const PlacedCompound &b,
                                                               CompoundCache &cache, const PairConfig &config = {}) noexcept
{
    return detail::compounds(swiftprox_compound_distance, a, b, cache, config);
}
inline Result<swiftprox_compound_answer> try_compound_intersection(const PlacedCompound &a, const PlacedCompound &b,
                                                                   CompoundCache &cache,
                                                                   const PairConfig &config = {}) noexcept
{
    return detail::compounds(swiftprox_compound_intersection, a, b, cache, config);
}
inline Result<swiftprox_compound_signed_distance_answer>
try_compound_signed_distance(const PlacedCompound &a, const PlacedCompound &b, CompoundCache &cache,
                             const PairConfig &config = {}) noexcept
{
    return detail::compounds(swiftprox_compound_signed_distance, a, b, cache, config);
}
/** The depth of compounds, and a translation of the first that frees them. */
inline Result<swiftprox_compound_depth_answer> try_compound_depth(const PlacedCompound &a, const PlacedCompound &b,
                                                                  const DepthConfig &config = {}) noexcept
{
    const swiftprox_depth_config c = config.to_c();
    Result<swiftprox_compound_depth_answer> result;
    result.status = swiftprox_compound_depth(a.to_c(), b.to_c(), &c, &result.value);
    return result;
}
inline Result<void> try_compound_depth_verify(const PlacedCompound &a, const PlacedCompound &b,
                                              const swiftprox_compound_depth_answer &answer) noexcept
{
    return detail::status(swiftprox_compound_depth_verify(a.to_c(), b.to_c(), &answer));
}
inline Result<void> try_compound_verify(const PlacedCompound &a, const PlacedCompound &b,
                                        const swiftprox_compound_answer &answer) noexcept
{
    return detail::status(swiftprox_compound_verify(a.to_c(), b.to_c(), &answer));
}
inline Result<swiftprox_compound_cast_answer> try_compound_cast(const MovingCompound &a, const MovingCompound &b,
                                                                CompoundCache &cache, const CastConfig &config = {}) noexcept
{
    const swiftprox_cast_config c = config.to_c();
    Result<swiftprox_compound_cast_answer> result;
    result.status = swiftprox_compound_cast(a.to_c(), b.to_c(), &cache, &c, &result.value);
    return result;
}
inline Result<void> try_compound_cast_verify(const MovingCompound &a, const MovingCompound &b,
                                             const swiftprox_compound_cast_answer &answer, const CastConfig &config = {}) noexcept
{
    const swiftprox_cast_config c = config.to_c();
    return detail::status(swiftprox_compound_cast_verify(a.to_c(), b.to_c(), &c, &answer));
}
/** Writes as many contacts and points as there is room for. */
inline Result<swiftprox_compound_contacts> try_compound_contacts(const PlacedCompound &a, const PlacedCompound &b,
                                                                 Range<swiftprox_compound_contact> contacts,
                                                                 Range<swiftprox_manifold_point> points,
                                                                 const ManifoldConfig &config = {}) noexcept
{
    const swiftprox_manifold_config c = config.to_c();
    Result<swiftprox_compound_contacts> result;
    result.value = {contacts.data(), contacts.size(), points.data(), points.size(), 0, 0};
    result.status = swiftprox_compound_get_contacts(a.to_c(), b.to_c(), &c, &result.value);
    return result;
}
inline Result<swiftprox_compound_ray_answer> try_compound_cast_ray(const PlacedCompound &body, const swiftprox_ray &ray) noexcept
{
    Result<swiftprox_compound_ray_answer> result;
    result.status = swiftprox_compound_cast_ray(body.to_c(), &ray, &result.value);
    return result;
}
inline Result<swiftprox_compound_point_answer> try_compound_locate_point(const PlacedCompound &body,
                                                                         const std::array<double, 3> &point) noexcept
{
    Result<swiftprox_compound_point_answer> result;
    result.status = swiftprox_compound_locate_point(body.to_c(), point.data(), &result.value);
    return result;
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline swiftprox_compound_answer compound_distance(const PlacedCompound &a, const PlacedCompound &b, CompoundCache &cache,
                                                   const PairConfig &config = {})
{
    return take(try_compound_distance(a, b, cache, config));
}
inline swiftprox_compound_answer compound_intersection(const PlacedCompound &a, const PlacedCompound &b, CompoundCache &cache,
                                                       const PairConfig &config = {})
{
    return take(try_compound_intersection(a, b, cache, config));
}
inline swiftprox_compound_signed_distance_answer compound_signed_distance(const PlacedCompound &a, const PlacedCompound &b,
                                                                          CompoundCache &cache, const PairConfig &config = {})
{
    return take(try_compound_signed_distance(a, b, cache, config));
}
inline swiftprox_compound_depth_answer compound_depth(const PlacedCompound &a, const PlacedCompound &b,
                                                      const DepthConfig &config = {})
{
    return take(try_compound_depth(a, b, config));
}
inline void compound_depth_verify(const PlacedCompound &a, const PlacedCompound &b, const swiftprox_compound_depth_answer &answer)
{
    take(try_compound_depth_verify(a, b, answer));
}
inline void compound_verify(const PlacedCompound &a, const PlacedCompound &b, const swiftprox_compound_answer &answer)
{
    take(try_compound_verify(a, b, answer));
}
inline swiftprox_compound_cast_answer compound_cast(const MovingCompound &a, const MovingCompound &b, CompoundCache &cache,
                                                    const CastConfig &config = {})
{
    return take(try_compound_cast(a, b, cache, config));
}
inline void compound_cast_verify(const MovingCompound &a, const MovingCompound &b, const swiftprox_compound_cast_answer &answer,
                                 const CastConfig &config = {})
{
    take(try_compound_cast_verify(a, b, answer, config));
}
inline swiftprox_compound_contacts compound_contacts(const PlacedCompound &a, const PlacedCompound &b,
                                                     Range<swiftprox_compound_contact> contacts,
                                                     Range<swiftprox_manifold_point> points,
                                                     const ManifoldConfig &config = {})
{
    return take(try_compound_contacts(a, b, contacts, points, config));
}
inline swiftprox_compound_ray_answer compound_cast_ray(const PlacedCompound &body, const swiftprox_ray &ray)
{
    return take(try_compound_cast_ray(body, ray));
}
inline swiftprox_compound_point_answer compound_locate_point(const PlacedCompound &body, const std::array<double, 3> &point)
{
    return take(try_compound_locate_point(body, point));
}
#endif

} // namespace swiftprox

#endif
