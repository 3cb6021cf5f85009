/* Where an object stands. */
#ifndef SWIFTPROX_POSE_HPP
#define SWIFTPROX_POSE_HPP

#include "result.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace swiftprox
{

/** 12 doubles, the row-major 3x4 matrix [R|T]: an object is R*v + T. Whether it is a pose is checked by what it is given to. */
class Pose
{
  public:
    /** The identity. */
    constexpr Pose() noexcept = default;
    constexpr explicit Pose(const std::array<double, 12> &rows) noexcept : rows_(rows) {}
    /** From a row-major rotation and a translation. */
    constexpr Pose(const std::array<double, 9> &r, const std::array<double, 3> &t) noexcept
        : rows_{r[0], r[1], r[2], t[0], r[3], r[4], r[5], t[1], r[6], r[7], r[8], t[2]}
    {
    }
    static constexpr Pose at(double x, double y, double z) noexcept { return Pose({1, 0, 0, 0, 1, 0, 0, 0, 1}, {x, y, z}); }
    /** From a quaternion w + xi + yj + zk of any length except 0, which gives a pose that is refused. */
    static Pose from_quaternion(double w, double x, double y, double z, const std::array<double, 3> &translation = {}) noexcept
    {
        // Two steps keep the squares of tiny and huge components in range.
        const double largest = std::fmax(std::fmax(std::fabs(w), std::fabs(x)), std::fmax(std::fabs(y), std::fabs(z)));
        w /= largest, x /= largest, y /= largest, z /= largest;
        const double length = std::sqrt(w * w + x * x + y * y + z * z);
        w /= length, x /= length, y /= length, z /= length;
        return Pose({1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
                     2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),  //
                     2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}, //
                    translation);
    }
    /** From a column-major 4x4 matrix, as OpenGL and glm have it; the last row is not looked at. */
    static constexpr Pose from_column_major(const double *m) noexcept
    {
        return Pose({m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]}, {m[12], m[13], m[14]});
    }
    /** From x, y, z, w and a translation; refuses a quaternion whose length is not 1. */
    static Result<Pose> try_from_unit_quaternion(const std::array<double, 4> &quaternion,
                                                 const std::array<double, 3> &translation = {}) noexcept
    {
        Result<Pose> result;
        result.status = swiftprox_pose_from_quaternion(quaternion.data(), translation.data(), result.value.rows_.data());
        return result;
    }
    /** From the 16 numbers of a column-major 4x4 matrix; refuses what is no pose. */
    static Result<Pose> try_from_column_major(const double *matrix) noexcept
    {
        Result<Pose> result;
        result.status = swiftprox_pose_from_column_major(matrix, result.value.rows_.data());
        return result;
    }
    /** From anything whose matrix() has entries (row, column), such as Eigen::Isometry3d and Affine3d. */
    template <class Transform, class = decltype(std::declval<const Transform &>().matrix()(0, 0))>
    explicit Pose(const Transform &transform)
    {
        const auto &matrix = transform.matrix();
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 4; ++column) {
                rows_[static_cast<std::size_t>(4 * row + column)] = static_cast<double>(matrix(row, column));
            }
        }
    }
    constexpr const double *data() const noexcept { return rows_.data(); }
    constexpr const std::array<double, 12> &rows() const noexcept { return rows_; }

  private:
    std::array<double, 12> rows_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

} // namespace swiftprox

#endif
