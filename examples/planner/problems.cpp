#include "problems.hpp"

#include <algorithm>
#include <array>

#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>

#include "arm.h"

namespace ob = ompl::base;
using swiftprox::Pose;
using swiftprox::Shape;

namespace {

Shape box(const double (&sides)[3], const double (&centre)[3])
{
    return Shape::adopt(cell_box(sides, centre));
}

// How OMPL's angles place the arm's links, and how these move along an edge.
class ArmCell final : public swiftprox::adapters::ompl::Cell {
public:
    ArmCell()
    {
        struct cell made = {};
        arm_build_cell(&arm_, &made);
        max_distance = made.max_distance;
        for (size_t i = 0; i < made.body_count; ++i) {
            add_body(Shape::adopt(made.bodies[i]));
        }
        for (size_t i = 0; i < made.obstacle_count; ++i) {
            add_obstacle(Shape::adopt(made.obstacles[i]), pose_at(made.places[i].start));
        }
        for (size_t i = 0; i < made.pair_count; ++i) {
            if (!made.pairs[i].is_obstacle) {
                add_pair(made.pairs[i].first, made.pairs[i].second);
            }
        }
    }

    const struct arm &arm() const
    {
        return arm_;
    }

protected:
    void poses_of(const ob::State *state, std::vector<Pose> &poses) const override
    {
        double rows[12 * MOST_JOINTS];
        arm_poses(&arm_, angles(state), rows);
        for (size_t i = 0; i < poses.size(); ++i) {
            poses[i] = pose_at(rows + 12 * i);
        }
    }

    void motions_of(const ob::State *from, const ob::State *to, std::vector<swiftprox_motion> &motions) const override
    {
        arm_motions(&arm_, angles(from), angles(to), &edge_, motions.data());
    }

private:
    static Pose pose_at(const double *rows)
    {
        std::array<double, 12> copy;
        std::copy_n(rows, 12, copy.begin());
        return Pose(copy);
    }

    static const double *angles(const ob::State *state)
    {
        return state->as<ob::RealVectorStateSpace::StateType>()->values;
    }

    struct arm arm_;
    mutable struct arm_edge edge_;
};

} // namespace

Problem make_piece()
{
    const auto cell = std::make_shared<swiftprox::adapters::ompl::SE3Cell>();
    cell->max_distance = 1e-3;
    // Two plates, about the middle.
    cell->add_body(box({1.0, 0.5, 0.03}, {0, 0, -0.2}));
    cell->add_body(box({0.03, 0.5, 0.43}, {0.485, 0, 0.015}));
    // A wall of 0.02 with a window of 0.9 by 0.9: too narrow for the piece across.
    const double wall = 0.02, window = 0.9, side = 1.2, off = (window + side) / 2;
    const Shape upright = box({wall, side, window + 2 * side}, {0, 0, 0}), beam = box({wall, window, side}, {0, 0, 0});
    cell->add_obstacle(upright, Pose::at(0, -off, 0));
    cell->add_obstacle(upright, Pose::at(0, off, 0));
    cell->add_obstacle(beam, Pose::at(0, 0, -off));
    cell->add_obstacle(beam, Pose::at(0, 0, off));

    const auto space = std::make_shared<ob::SE3StateSpace>();
    ob::RealVectorBounds bounds(3);
    bounds.setLow(-0.3);
    bounds.setHigh(0.3);
    bounds.setLow(0, -1.0);
    bounds.setHigh(0, 1.0);
    space->setBounds(bounds);
    const auto at = [&](double x, double angle) {
        auto state = std::make_shared<ob::ScopedState<>>(space);
        auto &there = *state->get()->as<ob::SE3StateSpace::StateType>();
        there.setXYZ(x, 0, 0);
        there.rotation().setAxisAngle(0, 0, 1, angle);
        return state;
    };
    const double quarter = 1.5707963267948966;
    return {space, at(-0.9, quarter), at(0.9, -quarter), cell};
}

Problem make_arm()
{
    const auto cell = std::make_shared<ArmCell>();
    const struct arm &arm = cell->arm();
    const auto space = std::make_shared<ob::RealVectorStateSpace>(arm.joint_count);
    ob::RealVectorBounds bounds(arm.joint_count);
    for (unsigned k = 0; k < arm.joint_count; ++k) {
        bounds.setLow(k, arm.lowest[k]);
        bounds.setHigh(k, arm.highest[k]);
    }
    space->setBounds(bounds);
    const auto at = [&](const double *angles) {
        auto state = std::make_shared<ob::ScopedState<>>(space);
        std::copy_n(angles, arm.joint_count, state->get()->as<ob::RealVectorStateSpace::StateType>()->values);
        return state;
    };
    return {space, at(arm.start), at(arm.goal), cell};
}
