/* Shapes: shares of geometry. */
#ifndef SWIFTPROX_SHAPE_HPP
#define SWIFTPROX_SHAPE_HPP

#include "configs.hpp"
#include "curved.h"
#include "geometry.h"
#include "result.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace swiftprox
{

namespace detail
{
// A Pose is its 12 doubles, so that an array of poses is what C takes.
static_assert(std::is_standard_layout_v<Pose> && sizeof(Pose) == 12 * sizeof(double), "poses are 12 doubles each");
inline const double *rows_of(Range<const Pose> poses) noexcept
{
    return poses.data() ? poses.data()->data() : nullptr;
}
} // namespace detail

/** A face of a shape's hull. */
struct Face {
    swiftprox_face plane;
    /** Places in vertices(), counter-clockwise seen from outside. */
    std::vector<std::uint32_t> corners;
    /** The caller's polygons that are merged in it. */
    std::vector<std::uint32_t> labels;
};

/** A share of a shape, or none. */
class Shape
{
  public:
    Shape() noexcept = default;
    Shape(const Shape &other) noexcept : shape_(other.shape_ ? swiftprox_shape_retain(other.shape_) : nullptr) {}
    Shape(Shape &&other) noexcept : shape_(std::exchange(other.shape_, nullptr)) {}
    Shape &operator=(Shape other) noexcept
    {
        std::swap(shape_, other.shape_);
        return *this;
    }
    ~Shape() { swiftprox_shape_release(shape_); }
    /** Takes over a share that the caller owns. */
    static Shape adopt(const swiftprox_shape *shape) noexcept
    {
        Shape result;
        result.shape_ = shape;
        return result;
    }
    const swiftprox_shape *get() const & noexcept { return shape_; }
    /** The shape would be gone before its pointer. */
    const swiftprox_shape *get() const && = delete;
    explicit operator bool() const noexcept { return shape_ != nullptr; }

    /** 3 coordinates a vertex; the faces' vertex numbers, one face after the other; their sides, empty if all are triangles. */
    static Result<Shape> try_from_mesh(Range<const double> vertices, Range<const std::uint32_t> indices,
                                       Range<const std::uint32_t> valences = {}, const ShapeOptions &options = {})
    {
        if (const char *fault = detail::mesh_fault(vertices, indices, valences)) {
            return detail::refused<Shape>(fault);
        }
        return made(options, [&](const swiftprox_shape_options *c, const swiftprox_shape **shape) {
            return swiftprox_shape_create_from_mesh(detail::mesh_of(vertices, indices, valences), c, shape);
        });
    }
    /** The convex hull of points, 3 coordinates each. */
    static Result<Shape> try_from_points(Range<const double> points, const ShapeOptions &options = {})
    {
        if (points.size() % 3 != 0) {
            return detail::refused<Shape>("points: the number of coordinates is not a multiple of 3");
        }
        return made(options, [&](const swiftprox_shape_options *c, const swiftprox_shape **shape) {
            return swiftprox_shape_create_from_points(points.data(), points.size() / 3, c, shape);
        });
    }
    /** [-x, x] x [-y, y] x [-z, z]; a radius rounds edges and corners, and makes the box larger by as much. */
    static Result<Shape> try_box(double x, double y, double z, double radius = 0)
    {
        const double half_extents[3] = {x, y, z};
        return made(ShapeOptions{}, [&](const swiftprox_shape_options *, const swiftprox_shape **shape) {
            return swiftprox_shape_create_box(half_extents, radius, shape);
        });
    }
    static Result<Shape> try_sphere(double radius)
    {
        return made(ShapeOptions{}, [&](const swiftprox_shape_options *, const swiftprox_shape **shape) {
            return swiftprox_shape_create_sphere(radius, shape);
        });
    }
    /** About the segment from (0, 0, -half_length) to (0, 0, half_length). */
    static Result<Shape> try_capsule(double half_length, double radius)
    {
        return made(ShapeOptions{}, [&](const swiftprox_shape_options *, const swiftprox_shape **shape) {
            return swiftprox_shape_create_capsule(half_length, radius, shape);
        });
    }
    /** From z = -half_height to half_height. It reaches at most the deviation beyond its prism; 0: 1e-4 of the radius. */
    static Result<Shape> try_cylinder(double radius, double half_height, double deviation = 0)
    {
        return made(ShapeOptions{}, [&](const swiftprox_shape_options *, const swiftprox_shape **shape) {
            return swiftprox_shape_create_cylinder(radius, half_height, deviation, shape);
        });
    }
    /** The base at z = -half_height, the tip at half_height; the deviation as of a cylinder. */
    static Result<Shape> try_cone(double radius, double half_height, double deviation = 0)
    {
        return made(ShapeOptions{}, [&](const swiftprox_shape_options *, const swiftprox_shape **shape) {
            return swiftprox_shape_create_cone(radius, half_height, deviation, shape);
        });
    }
    /** With semi-axes along x, y and z. The deviation as of a cylinder; 0: 1e-3 of the largest semi-axis. */
    static Result<Shape> try_ellipsoid(double x, double y, double z, double deviation = 0)
    {
        const double semi_axes[3] = {x, y, z};
        return made(ShapeOptions{}, [&](const swiftprox_shape_options *, const swiftprox_shape **shape) {
            return swiftprox_shape_create_ellipsoid(semi_axes, deviation, shape);
        });
    }
    static Result<Shape> try_from_file(const std::string &path, const ShapeOptions &options = {})
    {
        return made(options, [&](const swiftprox_shape_options *c, const swiftprox_shape **shape) {
            return swiftprox_shape_create_from_file(path.c_str(), c, shape);
        });
    }
    static Result<Shape> try_from_levels(Range<const swiftprox_mesh> levels, const ShapeOptions &options = {})
    {
        return made(options, [&](const swiftprox_shape_options *c, const swiftprox_shape **shape) {
            return swiftprox_shape_create_from_levels(levels.data(), levels.size(), c, shape);
        });
    }
    static Result<Shape> try_load(const std::string &path, const Progress &progress = {})
    {
        return made(ShapeOptions{}, [&](const swiftprox_shape_options *, const swiftprox_shape **shape) {
            return swiftprox_shape_load(path.c_str(), detail::callback_of(progress), detail::user_of(progress), shape);
        });
    }
    Result<Shape> try_scaled(double scale, const Progress &progress = {}) const
    {
        return made(ShapeOptions{}, [&](const swiftprox_shape_options *, const swiftprox_shape **shape) {
            return swiftprox_shape_create_scaled(shape_, scale, detail::callback_of(progress), detail::user_of(progress), shape);
        });
    }
    Result<void> try_save(const std::string &path) const { return detail::status(swiftprox_shape_save(shape_, path.c_str())); }
    Result<void> try_prepare(const Progress &progress = {}) const
    {
        return detail::status(swiftprox_shape_prepare(shape_, detail::callback_of(progress), detail::user_of(progress)));
    }
    Result<swiftprox_shape_info> try_info() const
    {
        return detail::asked<swiftprox_shape_info>([&](swiftprox_shape_info *info) {
            info->struct_size = sizeof *info;
            return swiftprox_shape_get_info(shape_, info);
        });
    }
    Result<swiftprox_shape_tuning_info> try_tuning_info() const
    {
        return detail::asked<swiftprox_shape_tuning_info>([&](swiftprox_shape_tuning_info *info) {
            info->struct_size = sizeof *info;
            return swiftprox_shape_get_tuning_info(shape_, info);
        });
    }
    Result<swiftprox_level_info> try_level_info(std::size_t level) const
    {
        return detail::asked<swiftprox_level_info>([&](swiftprox_level_info *info) {
            info->struct_size = sizeof *info;
            return swiftprox_shape_get_level_info(shape_, level, info);
        });
    }
    /** The hull's vertices in the local frame, 3 coordinates each. `labels`, if not null: the caller's number of each. */
    Result<std::vector<double>> try_vertices(std::vector<std::uint32_t> *labels = nullptr) const
    {
        const Result<swiftprox_shape_info> info = try_info();
        return filled<double>(info, info.value.vertex_count, [&](double *vertices, std::size_t count) {
            if (labels) {
                labels->resize(count);
            }
            return swiftprox_shape_copy_vertices(shape_, vertices, labels ? labels->data() : nullptr, count);
        });
    }
    /** The hull's triangles, 3 places in vertices() each. */
    Result<std::vector<std::uint32_t>> try_triangles() const
    {
        const Result<swiftprox_shape_info> info = try_info();
        return filled<std::uint32_t>(info, info.value.triangle_count, [&](std::uint32_t *corners, std::size_t count) {
            return swiftprox_shape_copy_triangles(shape_, corners, count);
        });
    }
    /** A face by its place, from 0 to below info().face_count. */
    Result<Face> try_face(std::size_t index) const
    {
        Result<Face> result;
        swiftprox_face &plane = result.value.plane;
        result.status = swiftprox_shape_get_face(shape_, index, swiftprox_face_room{nullptr, 0, nullptr, 0}, &plane);
        if (result.status == SWIFTPROX_OK) {
            result.value.corners.resize(plane.corner_count);
            result.value.labels.resize(plane.label_count);
            result.status = swiftprox_shape_get_face(shape_, index,
                                                     swiftprox_face_room{result.value.corners.data(), plane.corner_count, result.value.labels.data(), plane.label_count},
                                                     &plane);
        }
        return result;
    }
    /** The place of the face that an answer calls `label`. */
    Result<std::size_t> try_find_face(std::uint32_t label) const
    {
        Result<std::size_t> result;
        result.status = swiftprox_shape_find_face(shape_, label, &result.value);
        return result;
    }
    Result<std::vector<double>> try_level_vertices(std::size_t level) const
    {
        const Result<swiftprox_level_info> info = try_level_info(level);
        return filled<double>(info, info.value.vertex_count, [&](double *vertices, std::size_t count) {
            return swiftprox_shape_copy_level_vertices(shape_, level, vertices, count);
        });
    }
    Result<std::vector<std::uint32_t>> try_level_triangles(std::size_t level) const
    {
        const Result<swiftprox_level_info> info = try_level_info(level);
        return filled<std::uint32_t>(info, info.value.triangle_count, [&](std::uint32_t *corners, std::size_t count) {
            return swiftprox_shape_copy_level_triangles(shape_, level, corners, count);
        });
    }

#if SWIFTPROX_HAS_EXCEPTIONS
    static Shape from_mesh(Range<const double> vertices, Range<const std::uint32_t> indices,
                           Range<const std::uint32_t> valences = {}, const ShapeOptions &options = {})
    {
        return take(try_from_mesh(vertices, indices, valences, options));
    }
    static Shape from_points(Range<const double> points, const ShapeOptions &options = {})
    {
        return take(try_from_points(points, options));
    }
    static Shape box(double x, double y, double z, double radius = 0) { return take(try_box(x, y, z, radius)); }
    static Shape sphere(double radius) { return take(try_sphere(radius)); }
    static Shape capsule(double half_length, double radius) { return take(try_capsule(half_length, radius)); }
    static Shape cylinder(double radius, double half_height, double deviation = 0)
    {
        return take(try_cylinder(radius, half_height, deviation));
    }
    static Shape cone(double radius, double half_height, double deviation = 0)
    {
        return take(try_cone(radius, half_height, deviation));
    }
    static Shape ellipsoid(double x, double y, double z, double deviation = 0)
    {
        return take(try_ellipsoid(x, y, z, deviation));
    }
    static Shape from_file(const std::string &path, const ShapeOptions &options = {})
    {
        return take(try_from_file(path, options));
    }
    static Shape from_levels(Range<const swiftprox_mesh> levels, const ShapeOptions &options = {})
    {
        return take(try_from_levels(levels, options));
    }
    static Shape load(const std::string &path, const Progress &progress = {}) { return take(try_load(path, progress)); }
    Shape scaled(double scale, const Progress &progress = {}) const { return take(try_scaled(scale, progress)); }
    void save(const std::string &path) const { take(try_save(path)); }
    void prepare(const Progress &progress = {}) const { take(try_prepare(progress)); }
    swiftprox_shape_info info() const { return take(try_info()); }
    swiftprox_shape_tuning_info tuning_info() const { return take(try_tuning_info()); }
    swiftprox_level_info level_info(std::size_t level) const { return take(try_level_info(level)); }
    std::vector<double> vertices(std::vector<std::uint32_t> *labels = nullptr) const { return take(try_vertices(labels)); }
    std::vector<std::uint32_t> triangles() const { return take(try_triangles()); }
    Face face(std::size_t index) const { return take(try_face(index)); }
    std::size_t find_face(std::uint32_t label) const { return take(try_find_face(label)); }
    std::vector<double> level_vertices(std::size_t level) const { return take(try_level_vertices(level)); }
    std::vector<std::uint32_t> level_triangles(std::size_t level) const { return take(try_level_triangles(level)); }
#endif

  private:
    template <class Call> static Result<Shape> made(const ShapeOptions &options, Call &&call)
    {
        swiftprox_shape_tuning tuning;
        const swiftprox_shape_options c = options.to_c(tuning);
        Result<Shape> result;
        result.status = call(&c, &result.value.shape_);
        return result;
    }
    /** Triples of numbers, as many as an info says. */
    template <class T, class Info, class Call>
    static Result<std::vector<T>> filled(const Result<Info> &info, std::size_t count, Call &&call)
    {
        Result<std::vector<T>> result;
        result.status = info.status;
        if (result) {
            result.value.resize(3 * count);
            result.status = call(result.value.data(), count);
        }
        return result;
    }

    const swiftprox_shape *shape_ = nullptr;
};

/** How far a vertex may lie outside a face by the precision of the coordinates, relative to the bounding box's diagonal. */
inline Result<double> try_estimate_tolerance(Range<const double> vertices) noexcept
{
    if (const char *fault = detail::mesh_fault(vertices, {}, {})) {
        return detail::refused<double>(fault);
    }
    return detail::asked<double>([&](double *tolerance) {
        return swiftprox_mesh_estimate_tolerance(vertices.data(), vertices.size() / 3, tolerance);
    });
}
/** The triangles of a surface, piece by piece. */
struct Decomposition {
    /** 3 vertices of each triangle. */
    std::vector<std::uint32_t> corners;
    /** The face of the mesh that each triangle is a part of. */
    std::vector<std::uint32_t> faces;
    /** The piece of each triangle, ascending from 0. */
    std::vector<std::uint32_t> pieces;
    std::size_t piece_count = 0;
};
/** A mesh that need not be convex as convex pieces; see swiftprox_mesh_decompose. */
inline Result<Decomposition> try_decompose(Range<const double> vertices, Range<const std::uint32_t> indices,
                                           Range<const std::uint32_t> valences = {}, double convexity_tolerance = 0,
                                           const Progress &progress = {})
{
    if (const char *fault = detail::mesh_fault(vertices, indices, valences)) {
        return detail::refused<Decomposition>(fault);
    }
    Result<Decomposition> result;
    Decomposition &found = result.value;
    // No face has more triangles than corners.
    found.corners.resize(3 * indices.size() + 1);
    found.faces.resize(indices.size() + 1);
    found.pieces.resize(indices.size() + 1);
    swiftprox_decomposition c{found.corners.data(), found.faces.data(), found.pieces.data(), indices.size(), 0, 0};
    result.status = swiftprox_mesh_decompose(detail::mesh_of(vertices, indices, valences), convexity_tolerance,
                                             detail::callback_of(progress), detail::user_of(progress), &c);
    found.corners.resize(3 * c.triangle_count);
    found.faces.resize(c.triangle_count);
    found.pieces.resize(c.triangle_count);
    found.piece_count = c.piece_count;
    return result;
}
#if SWIFTPROX_HAS_EXCEPTIONS
inline double estimate_tolerance(Range<const double> vertices)
{
    return take(try_estimate_tolerance(vertices));
}
inline Decomposition decompose(Range<const double> vertices, Range<const std::uint32_t> indices,
                               Range<const std::uint32_t> valences = {}, double convexity_tolerance = 0,
                               const Progress &progress = {})
{
    return take(try_decompose(vertices, indices, valences, convexity_tolerance, progress));
}
#endif

} // namespace swiftprox

#endif
