// What OMPL asks of a collision checker, answered with proofs: whether a state is free and how clear it is, and whether an edge is
// free at all times, or else up to when.
#ifndef EXAMPLES_PLANNER_CERTIFIED_HPP
#define EXAMPLES_PLANNER_CERTIFIED_HPP

#include <mutex>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>

#include "problems.hpp"

// The cell's caches and the motions are one caller's at a time; PRM asks from two threads.
struct Shared {
    Problem &problem;
    std::mutex mutex;
};

class CertifiedStates : public ompl::base::StateValidityChecker {
public:
    CertifiedStates(const ompl::base::SpaceInformationPtr &information, Shared &shared)
        : StateValidityChecker(information), shared_(shared)
    {
        // A lower bound, off by rounding alone.
        specs_.clearanceComputationType = ompl::base::StateValidityCheckerSpecs::EXACT;
    }

    bool isValid(const ompl::base::State *state) const override
    {
        const std::lock_guard<std::mutex> alone(shared_.mutex);
        return si_->satisfiesBounds(state) && cell_is_free(&shared_.problem.cell, shared_.problem.poses(state).data());
    }

    double clearance(const ompl::base::State *state) const override
    {
        const std::lock_guard<std::mutex> alone(shared_.mutex);
        return cell_clearance(&shared_.problem.cell, shared_.problem.poses(state).data());
    }

private:
    Shared &shared_;
};

class CertifiedMotions : public ompl::base::MotionValidator {
public:
    CertifiedMotions(const ompl::base::SpaceInformationPtr &information, Shared &shared)
        : MotionValidator(information), shared_(shared)
    {
    }

    bool checkMotion(const ompl::base::State *from, const ompl::base::State *to) const override
    {
        const std::lock_guard<std::mutex> alone(shared_.mutex);
        return count(cell_is_edge_free(&shared_.problem.cell, shared_.problem.motions(from, to)));
    }

    // The last valid state is at time_lower: what comes before is proved free.
    bool checkMotion(const ompl::base::State *from, const ompl::base::State *to,
                     std::pair<ompl::base::State *, double> &last_valid) const override
    {
        const std::lock_guard<std::mutex> alone(shared_.mutex);
        const cell_edge edge = cell_cast(&shared_.problem.cell, shared_.problem.motions(from, to));
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
        ++(is_free ? valid_ : invalid_);
        return is_free;
    }

    Shared &shared_;
};

#endif
