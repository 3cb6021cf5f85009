#include "problems.hpp"

#include <cmath>
#include <cstring>

#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>

namespace ob = ompl::base;

namespace {

class Piece : public Problem {
public:
    Piece();
    std::vector<double> poses(const ob::State *state) const override;
    const swiftprox_motion *motions(const ob::State *from, const ob::State *to) override;

private:
    void add_box(const double (&sides)[3], const double (&centre)[3])
    {
        cell_add_body(&cell, cell_box(sides, centre));
    }

    swiftprox_motion motions_[MOST_BODIES];
};

// The row-major [R|T] of a state.
void pose_of(const ob::State *state, double pose[12])
{
    const auto &at = *state->as<ob::SE3StateSpace::StateType>();
    const auto &q = at.rotation();
    const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const double x = q.x / length, y = q.y / length, z = q.z / length, w = q.w / length;
    const double rows[12] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), at.getX(),
                             2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), at.getY(),
                             2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), at.getZ()};
    std::memcpy(pose, rows, sizeof rows);
}

Piece::Piece()
{
    cell.max_distance = 1e-3;
    // Two plates, about the middle.
    add_box({1.0, 0.5, 0.03}, {0, 0, -0.2});
    add_box({0.03, 0.5, 0.43}, {0.485, 0, 0.015});
    // A wall of 0.02 with a window of 0.9 by 0.9: too narrow for the piece across.
    const double wall = 0.02, window = 0.9, side = 1.2;
    const double upright[3] = {wall, side, window + 2 * side}, beam[3] = {wall, window, side}, middle[3] = {0, 0, 0};
    const double off = (window + side) / 2;
    cell_add_obstacle(&cell, cell_box(upright, middle), 0, -off, 0);
    cell_add_obstacle(&cell, cell_box(upright, middle), 0, off, 0);
    cell_add_obstacle(&cell, cell_box(beam, middle), 0, 0, -off);
    cell_add_obstacle(&cell, cell_box(beam, middle), 0, 0, off);

    auto made = std::make_shared<ob::SE3StateSpace>();
    ob::RealVectorBounds bounds(3);
    bounds.setLow(-0.3);
    bounds.setHigh(0.3);
    bounds.setLow(0, -1.0);
    bounds.setHigh(0, 1.0);
    made->setBounds(bounds);
    space = made;
    const auto at = [&](double x, double angle) {
        auto state = std::make_shared<ob::ScopedState<>>(space);
        auto &there = *state->get()->as<ob::SE3StateSpace::StateType>();
        there.setXYZ(x, 0, 0);
        there.rotation().setAxisAngle(0, 0, 1, angle);
        return state;
    };
    const double quarter = 1.5707963267948966;
    start = at(-0.9, quarter);
    goal = at(0.9, -quarter);
}

std::vector<double> Piece::poses(const ob::State *state) const
{
    std::vector<double> poses(12 * cell.body_count);
    for (size_t i = 0; i < cell.body_count; ++i) {
        pose_of(state, &poses[12 * i]);
    }
    return poses;
}

// OMPL goes from place to place on a line, and turns by the shorter way at a constant rate: a screw about the origin.
const swiftprox_motion *Piece::motions(const ob::State *from, const ob::State *to)
{
    double pose1[12], pose2[12];
    pose_of(from, pose1);
    pose_of(to, pose2);
    cell_demand(swiftprox_motion_between(pose1, pose2, nullptr, 1, &motions_[0], nullptr));
    for (size_t i = 1; i < cell.body_count; ++i) {
        motions_[i] = motions_[0];
    }
    return motions_;
}

class Arm : public Problem {
public:
    Arm();
    std::vector<double> poses(const ob::State *state) const override;
    const swiftprox_motion *motions(const ob::State *from, const ob::State *to) override;

private:
    struct arm arm_;
    struct arm_edge edge_;
    swiftprox_motion motions_[MOST_JOINTS];
};

Arm::Arm()
{
    arm_build_cell(&arm_, &cell);
    auto made = std::make_shared<ob::RealVectorStateSpace>(arm_.joint_count);
    ob::RealVectorBounds bounds(arm_.joint_count);
    for (unsigned k = 0; k < arm_.joint_count; ++k) {
        bounds.setLow(k, arm_.lowest[k]);
        bounds.setHigh(k, arm_.highest[k]);
    }
    made->setBounds(bounds);
    space = made;
    const auto at = [&](const double *angles) {
        auto state = std::make_shared<ob::ScopedState<>>(space);
        std::memcpy(state->get()->as<ob::RealVectorStateSpace::StateType>()->values, angles, arm_.joint_count * sizeof *angles);
        return state;
    };
    start = at(arm_.start);
    goal = at(arm_.goal);
}

std::vector<double> Arm::poses(const ob::State *state) const
{
    std::vector<double> poses(12 * cell.body_count);
    arm_poses(&arm_, state->as<ob::RealVectorStateSpace::StateType>()->values, poses.data());
    return poses;
}

const swiftprox_motion *Arm::motions(const ob::State *from, const ob::State *to)
{
    const auto *first = from->as<ob::RealVectorStateSpace::StateType>(), *second = to->as<ob::RealVectorStateSpace::StateType>();
    arm_motions(&arm_, first->values, second->values, &edge_, motions_);
    return motions_;
}

} // namespace

std::unique_ptr<Problem> make_piece()
{
    return std::unique_ptr<Problem>(new Piece);
}

std::unique_ptr<Problem> make_arm()
{
    return std::unique_ptr<Problem>(new Arm);
}
