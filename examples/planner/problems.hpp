// The two problems: an L of two plates through a window, and an arm around a post. Both say how a state of OMPL's is a place of a
// cell's bodies, and an edge their motion.
#ifndef EXAMPLES_PLANNER_PROBLEMS_HPP
#define EXAMPLES_PLANNER_PROBLEMS_HPP

#include <memory>
#include <string>
#include <vector>

#include <ompl/base/ScopedState.h>
#include <ompl/base/StateSpace.h>

#include "arm.h"

class Problem {
public:
    virtual ~Problem()
    {
        cell_release(&cell);
    }

    Problem() = default;
    Problem(const Problem &) = delete;
    Problem &operator=(const Problem &) = delete;

    // Poses of the cell's bodies, 12 numbers each.
    virtual std::vector<double> poses(const ompl::base::State *state) const = 0;

    // The motions of the cell's bodies along the edge that OMPL interpolates; they are asked for once at a time.
    virtual const swiftprox_motion *motions(const ompl::base::State *from, const ompl::base::State *to) = 0;

    ompl::base::StateSpacePtr space;
    ompl::base::ScopedStatePtr start, goal;
    struct cell cell = {};
};

// Of the piano movers' kind: an L of two thin plates through a window in a thin wall; SE(3).
std::unique_ptr<Problem> make_piece();

// The shipped arm with six axes around a post; its angles.
std::unique_ptr<Problem> make_arm();

#endif
