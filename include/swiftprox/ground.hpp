/* Grounds: surfaces of triangles for bodies to rest on. */
#ifndef SWIFTPROX_GROUND_HPP
#define SWIFTPROX_GROUND_HPP

#include "motion.hpp"

namespace swiftprox
{

/** A share of a ground, or none. */
class Ground
{
  public:
    Ground() noexcept = default;
    Ground(const Ground &other) noexcept : ground_(other.ground_ ? swiftprox_ground_retain(other.ground_) : nullptr) {}
    Ground(Ground &&other) noexcept : ground_(std::exchange(other.ground_, nullptr)) {}
    Ground &operator=(Ground other) noexcept
    {
        std::swap(ground_, other.ground_);
        return *this;
    }
    ~Ground() { swiftprox_ground_release(ground_); }
    const swiftprox_ground *get() const & noexcept { return ground_; }
    /** The ground would be gone before its pointer. */
    const swiftprox_ground *get() const && = delete;
    explicit operator bool() const noexcept { return ground_ != nullptr; }

    /** 3 coordinates a vertex, 3 vertex numbers a triangle. */
    static Result<Ground> try_from_triangles(Range<const double> vertices, Range<const std::uint32_t> corners) noexcept
    {
        if (vertices.size() % 3 != 0 || corners.size() % 3 != 0) {
            return detail::refused<Ground>("vertices and corners of a ground come in threes");
        }
        Result<Ground> result;
        result.status = swiftprox_ground_create_from_triangles(vertices.data(), vertices.size() / 3, corners.data(),
                                                               corners.size() / 3, &result.value.ground_);
        return result;
    }
    /** As many heights in a row as there are columns. */
    static Result<Ground> try_from_heights(Range<const double> heights, std::size_t columns, double row_spacing,
                                           double column_spacing) noexcept
    {
        if (columns == 0 || heights.size() % columns != 0) {
            return detail::refused<Ground>("the heights of a ground come in rows");
        }
        Result<Ground> result;
        result.status = swiftprox_ground_create_from_heights(heights.size() / columns, columns, row_spacing, column_spacing,
                                                             heights.data(), &result.value.ground_);
        return result;
    }
    /** One ground of several, with a pose for each. */
    static Result<Ground> try_from_grounds(Range<const swiftprox_ground *const> grounds, Range<const Pose> poses) noexcept
    {
        if (grounds.size() != poses.size()) {
            return detail::refused<Ground>("each ground needs one pose");
        }
        Result<Ground> result;
        result.status = swiftprox_ground_create_from_grounds(grounds.data(), detail::rows_of(poses), grounds.size(),
                                                             &result.value.ground_);
        return result;
    }
    /** A ground that pushes out what is behind its triangles by up to a thickness. */
    Result<Ground> try_solid(double thickness) const noexcept
    {
        Result<Ground> result;
        result.status = swiftprox_ground_create_solid(ground_, thickness, &result.value.ground_);
        return result;
    }
    Result<swiftprox_ground_info> try_info() const noexcept
    {
        Result<swiftprox_ground_info> result;
        result.status = swiftprox_ground_get_info(ground_, &result.value);
        return result;
    }
    /** Triangles from number `first` on: 9 coordinates each to `points`, and 3 vertex numbers each to `corners` unless it is empty. */
    Result<void> try_copy_triangles(std::size_t first, Range<double> points, Range<std::uint32_t> corners = {}) const noexcept
    {
        const std::size_t count = points.size() / 9;
        if (points.size() % 9 != 0 || (!corners.empty() && corners.size() != 3 * count)) {
            return detail::refused<void>("each triangle needs room for 9 coordinates and 3 corners");
        }
        return detail::status(swiftprox_ground_copy_triangles(ground_, first, count, points.data(), corners.data()));
    }

#if SWIFTPROX_HAS_EXCEPTIONS
    static Ground from_triangles(Range<const double> vertices, Range<const std::uint32_t> corners)
    {
        return take(try_from_triangles(vertices, corners));
    }
    static Ground from_heights(Range<const double> heights, std::size_t columns, double row_spacing, double column_spacing)
    {
        return take(try_from_heights(heights, columns, row_spacing, column_spacing));
    }
    static Ground from_grounds(Range<const swiftprox_ground *const> grounds, Range<const Pose> poses)
    {
        return take(try_from_grounds(grounds, poses));
    }
    Ground solid(double thickness) const { return take(try_solid(thickness)); }
    swiftprox_ground_info info() const { return take(try_info()); }
    void copy_triangles(std::size_t first, Range<double> points, Range<std::uint32_t> corners = {}) const
    {
        take(try_copy_triangles(first, points, corners));
    }
#endif

  private:
    const swiftprox_ground *ground_ = nullptr;
};

/** A ground where it is. The pose is its own; a share of the ground must live on, so that a temporary Ground is refused. */
class PlacedGround
{
  public:
    PlacedGround(const Ground &ground, const Pose &pose) noexcept : ground_(ground.get()), pose_(pose) {}
    PlacedGround(const Ground &&, const Pose &) = delete;
    const swiftprox_ground *ground() const noexcept { return ground_; }
    const double *pose() const & noexcept { return pose_.data(); }
    const double *pose() const && = delete;

  private:
    const swiftprox_ground *ground_;
    Pose pose_;
};

/** SWIFTPROX_QUERY_KIND_DISTANCE or SWIFTPROX_QUERY_KIND_INTERSECTION. */
inline Result<swiftprox_ground_distance> try_ground_distance(swiftprox_query_kind kind, Placed body, PlacedGround ground,
                                                             const PairConfig &config = {}) noexcept
{
    const swiftprox_pair_config c = config.to_c();
    Result<swiftprox_ground_distance> result;
    result.status =
        swiftprox_pair_ground_distance(kind, swiftprox_placed{body.shape(), body.pose()},
                                       swiftprox_placed_ground{ground.ground(), ground.pose()}, &c, &result.value);
    return result;
}
/** Where a ray first meets the surface. */
inline Result<swiftprox_ground_ray_answer> try_ground_cast_ray(PlacedGround ground, const swiftprox_ray &ray) noexcept
{
    Result<swiftprox_ground_ray_answer> result;
    result.status = swiftprox_ground_cast_ray(swiftprox_placed_ground{ground.ground(), ground.pose()}, &ray, &result.value);
    return result;
}
/** Whether a moving body stays apart from a ground at rest, or when it first does not. */
inline Result<swiftprox_ground_cast_answer> try_ground_cast(Moving body, PlacedGround ground, const CastConfig &config = {}) noexcept
{
    const swiftprox_cast_config c = config.to_c();
    Result<swiftprox_ground_cast_answer> result;
    result.status =
        swiftprox_pair_ground_cast(swiftprox_moving{body.shape(), body.motion()},
                                   swiftprox_placed_ground{ground.ground(), ground.pose()}, &c, &result.value);
    return result;
}
/** Writes as many contacts and points as there is room for. */
inline Result<swiftprox_ground_count> try_ground_contacts(Placed body, PlacedGround ground,
                                                          Range<swiftprox_ground_contact> contacts,
                                                          Range<swiftprox_manifold_point> points,
                                                          const ManifoldConfig &config = {}) noexcept
{
    const swiftprox_manifold_config c = config.to_c();
    Result<swiftprox_ground_count> result;
    result.status =
        swiftprox_pair_ground_contacts(swiftprox_placed{body.shape(), body.pose()},
                                       swiftprox_placed_ground{ground.ground(), ground.pose()}, &c,
                                       swiftprox_ground_room{contacts.data(), contacts.size(), points.data(), points.size()},
                                       &result.value);
    return result;
}

#if SWIFTPROX_HAS_EXCEPTIONS
inline swiftprox_ground_distance ground_distance(swiftprox_query_kind kind, Placed body, PlacedGround ground,
                                                 const PairConfig &config = {})
{
    return take(try_ground_distance(kind, body, ground, config));
}
inline swiftprox_ground_ray_answer ground_cast_ray(PlacedGround ground, const swiftprox_ray &ray)
{
    return take(try_ground_cast_ray(ground, ray));
}
inline swiftprox_ground_cast_answer ground_cast(Moving body, PlacedGround ground, const CastConfig &config = {})
{
    return take(try_ground_cast(body, ground, config));
}
inline swiftprox_ground_count ground_contacts(Placed body, PlacedGround ground, Range<swiftprox_ground_contact> contacts,
                                              Range<swiftprox_manifold_point> points, const ManifoldConfig &config = {})
{
    return take(try_ground_contacts(body, ground, contacts, points, config));
}
#endif

} // namespace swiftprox

#endif
