/*
 * What OMPL asks of a collision checker, answered with proofs: whether a state is free and how clear it is, and whether an edge is
 * free at all times, or else up to when.
 *
 *   const auto cell = std::make_shared<swiftprox::adapters::ompl::SE3Cell>();   // or a class of yours
 *   cell->add_body(shape);
 *   cell->add_obstacle(wall, pose);
 *   information->setStateValidityChecker(std::make_shared<swiftprox::adapters::ompl::StateChecker>(information, cell));
 *   information->setMotionValidator(std::make_shared<swiftprox::adapters::ompl::MotionChecker>(information, cell));
 *
 * What swiftprox refuses, such as a state that is NaN, is not free; OMPL's console says why. Nothing of ours throws.
 */
#ifndef SWIFTPROX_ADAPTERS_OMPL_HPP
#define SWIFTPROX_ADAPTERS_OMPL_HPP

#include "../motion.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/util/Console.h>

namespace swiftprox::adapters::ompl
{

/** How far the bodies get on an edge, which lasts from time 0 to 1. */
struct Edge {
    bool is_free = true;
    /** Free: all pairs are at least that far apart at all times. */
    double clearance = infinity;
    /** Not free: all pairs are farther apart than max_distance before this time. */
    double time_lower = 1;
    /** And at this time a pair is not; NaN where that is not known. */
    double time_upper = std::numeric_limits<double>::quiet_NaN();
};

/**
 * The bodies that a state places, the obstacles that stay, and which of them may meet. Threads take turns: caches are one caller's
 * at a time.
 */
class Cell
{
  public:
    virtual ~Cell() = default;
    Cell() = default;
    Cell(const Cell &) = delete;
    Cell &operator=(const Cell &) = delete;

    /** Pairs the body with all obstacles that are there and come. Returns its number, from 0. */
    std::size_t add_body(const Shape &shape)
    {
        bodies_.push_back(shape);
        for (std::size_t i = 0; i < obstacles_.size(); ++i) {
            pairs_.push_back({bodies_.size() - 1, i, true, {}});
        }
        return bodies_.size() - 1;
    }
    void add_obstacle(const Shape &shape, const Pose &pose)
    {
        obstacles_.push_back({shape, pose});
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            pairs_.push_back({i, obstacles_.size() - 1, true, {}});
        }
    }
    /** Two bodies that may meet. */
    void add_pair(std::size_t first, std::size_t second) { pairs_.push_back({first, second, false, {}}); }
    std::size_t body_count() const { return bodies_.size(); }

    /** Whether all pairs are farther apart than max_distance. */
    bool is_free(const ::ompl::base::State *state) const
    {
        const std::lock_guard<std::mutex> alone(mutex_);
        place(state);
        return std::all_of(pairs_.begin(), pairs_.end(), [&](Pair &pair) { return distance(pair, max_distance) > max_distance; });
    }
    /** A lower bound of the least distance of all pairs; 0 where two meet. */
    double clearance(const ::ompl::base::State *state) const
    {
        const std::lock_guard<std::mutex> alone(mutex_);
        place(state);
        double least = infinity;
        for (Pair &pair : pairs_) {
            least = std::min(least, distance(pair, least));
        }
        return least;
    }
    /** How far the bodies get. Without `all` it ends at the first pair that is not free, and the times are that pair's. */
    Edge cast(const ::ompl::base::State *from, const ::ompl::base::State *to, bool all = true) const
    {
        const std::lock_guard<std::mutex> alone(mutex_);
        move(from, to);
        CastConfig config = cast_config();
        Edge edge;
        for (Pair &pair : pairs_) {
            const Result<swiftprox_cast_answer> answer = cast(pair, config);
            if (is_good(answer) && answer.value.outcome == SWIFTPROX_CAST_OUTCOME_FREE) {
                edge.clearance = std::min(edge.clearance, answer.value.clearance);
                continue;
            }
            // A hit, a near miss or a budget that ran out; of the others only what comes before counts.
            const double nothing = std::numeric_limits<double>::quiet_NaN();
            edge = {false, nothing, answer ? answer.value.time_lower : 0, answer ? answer.value.time_upper : nothing};
            config.time_end = edge.time_lower;
            // It is asked first of the next edge: it often is not free there, either.
            std::swap(pair, pairs_.front());
            if (!all || config.time_end <= config.time_begin) {
                break;
            }
        }
        return edge;
    }
    /** Casts anew, and proves each pair's answer from the motions alone. Whether all of it is free. */
    bool is_proved_free(const ::ompl::base::State *from, const ::ompl::base::State *to) const
    {
        const std::lock_guard<std::mutex> alone(mutex_);
        move(from, to);
        const CastConfig config = cast_config();
        return std::all_of(pairs_.begin(), pairs_.end(), [&](Pair &pair) {
            const Result<swiftprox_cast_answer> answer = cast(pair, config);
            return is_good(answer) && answer.value.outcome == SWIFTPROX_CAST_OUTCOME_FREE &&
                   try_cast_verify({bodies_[pair.first], motions_[pair.first]}, second_moving(pair), answer.value, config);
        });
    }

    /** Nearer than that is not free. */
    double max_distance = 0;

  protected:
    /** Where a state places the bodies: as many poses as there are bodies, to be written. */
    virtual void poses_of(const ::ompl::base::State *state, std::vector<Pose> &poses) const = 0;
    /** The bodies' motions along the edge that OMPL interpolates, to be written. They are asked for once at a time. */
    virtual void motions_of(const ::ompl::base::State *from, const ::ompl::base::State *to,
                            std::vector<swiftprox_motion> &motions) const = 0;

  private:
    struct Obstacle {
        Shape shape;
        Pose pose;
    };
    struct Pair {
        std::size_t first, second;
        bool is_obstacle;
        PairCache cache;
    };

    static bool is_good(const Status &status)
    {
        if (!status) {
            ::ompl::msg::log(__FILE__, __LINE__, ::ompl::msg::LOG_ERROR, "swiftprox: %s", status.message());
        }
        return static_cast<bool>(status);
    }
    void place(const ::ompl::base::State *state) const
    {
        poses_.resize(bodies_.size());
        poses_of(state, poses_);
    }
    void move(const ::ompl::base::State *from, const ::ompl::base::State *to) const
    {
        motions_.resize(bodies_.size());
        motions_of(from, to, motions_);
    }
    CastConfig cast_config() const
    {
        CastConfig config;
        config.max_distance = max_distance;
        config.time_tolerance = 1e-6;
        return config;
    }
    /** A lower bound of the distance of a pair; beyond `enough` it is no more than that. */
    double distance(Pair &pair, double enough) const
    {
        PairConfig config;
        config.max_distance = enough;
        const Placed second = pair.is_obstacle ? Placed(obstacles_[pair.second].shape, obstacles_[pair.second].pose)
                                               : Placed(bodies_[pair.second], poses_[pair.second]);
        const auto answer = try_distance({bodies_[pair.first], poses_[pair.first]}, second, pair.cache, config);
        return is_good(answer) && answer.value.outcome != SWIFTPROX_OUTCOME_INTERSECTING ? answer.value.lower : 0;
    }
    Moving second_moving(const Pair &pair) const
    {
        return pair.is_obstacle ? Moving(obstacles_[pair.second].shape, fixed_motion(obstacles_[pair.second].pose))
                                : Moving(bodies_[pair.second], motions_[pair.second]);
    }
    Result<swiftprox_cast_answer> cast(Pair &pair, const CastConfig &config) const
    {
        return try_cast({bodies_[pair.first], motions_[pair.first]}, second_moving(pair), pair.cache, config);
    }

    std::vector<Shape> bodies_;
    std::vector<Obstacle> obstacles_;
    mutable std::mutex mutex_;
    mutable std::vector<Pair> pairs_;
    mutable std::vector<Pose> poses_;
    mutable std::vector<swiftprox_motion> motions_;
};

/** One rigid body of several pieces, placed by an SE3StateSpace. */
class SE3Cell : public Cell
{
  protected:
    void poses_of(const ::ompl::base::State *state, std::vector<Pose> &poses) const override
    {
        std::fill(poses.begin(), poses.end(), pose_of(state));
    }
    /** From place to place OMPL goes on a line, and turns by the shorter way at a constant rate: a screw about the origin. */
    void motions_of(const ::ompl::base::State *from, const ::ompl::base::State *to,
                    std::vector<swiftprox_motion> &motions) const override
    {
        const auto between = try_motion_between(pose_of(from), pose_of(to), {}, 1);
        std::fill(motions.begin(), motions.end(), between.value.motion);
    }

  private:
    static Pose pose_of(const ::ompl::base::State *state)
    {
        const auto &at = *state->as<::ompl::base::SE3StateSpace::StateType>();
        const auto &q = at.rotation();
        return Pose::from_quaternion(q.w, q.x, q.y, q.z, {at.getX(), at.getY(), at.getZ()});
    }
};

/** A state is valid if it is within the bounds of its space and free. */
class StateChecker : public ::ompl::base::StateValidityChecker
{
  public:
    StateChecker(const ::ompl::base::SpaceInformationPtr &information, std::shared_ptr<const Cell> cell)
        : StateValidityChecker(information), cell_(std::move(cell))
    {
        // A lower bound, off by rounding alone.
        specs_.clearanceComputationType = ::ompl::base::StateValidityCheckerSpecs::EXACT;
    }
    bool isValid(const ::ompl::base::State *state) const override { return si_->satisfiesBounds(state) && cell_->is_free(state); }
    double clearance(const ::ompl::base::State *state) const override { return cell_->clearance(state); }

  private:
    std::shared_ptr<const Cell> cell_;
};

/** An edge is valid if it is free at all times. */
class MotionChecker : public ::ompl::base::MotionValidator
{
  public:
    MotionChecker(const ::ompl::base::SpaceInformationPtr &information, std::shared_ptr<const Cell> cell)
        : MotionValidator(information), cell_(std::move(cell))
    {
    }
    bool checkMotion(const ::ompl::base::State *from, const ::ompl::base::State *to) const override
    {
        return count(cell_->cast(from, to, false).is_free);
    }
    /** The last valid state is at time_lower: what comes before is proved free. */
    bool checkMotion(const ::ompl::base::State *from, const ::ompl::base::State *to,
                     std::pair<::ompl::base::State *, double> &last_valid) const override
    {
        const Edge edge = cell_->cast(from, to);
        if (!edge.is_free) {
            last_valid.second = edge.time_lower;
            if (last_valid.first) {
                si_->getStateSpace()->interpolate(from, to, edge.time_lower, last_valid.first);
            }
        }
        return count(edge.is_free);
    }

  private:
    bool count(bool is_free) const
    {
        const std::lock_guard<std::mutex> alone(mutex_);
        ++(is_free ? valid_ : invalid_);
        return is_free;
    }

    std::shared_ptr<const Cell> cell_;
    mutable std::mutex mutex_;
};

} // namespace swiftprox::adapters::ompl

#endif
