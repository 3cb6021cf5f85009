// The two problems: an L of two plates through a window, and an arm around a post.
#ifndef EXAMPLES_PLANNER_PROBLEMS_HPP
#define EXAMPLES_PLANNER_PROBLEMS_HPP

#include <memory>

#include <ompl/base/ScopedState.h>
#include <ompl/base/StateSpace.h>
#include <swiftprox/adapters/ompl.hpp>

struct Problem {
    ompl::base::StateSpacePtr space;
    ompl::base::ScopedStatePtr start, goal;
    std::shared_ptr<const swiftprox::adapters::ompl::Cell> cell;
};

// Of the piano movers' kind: an L of two thin plates through a window in a thin wall; SE(3).
Problem make_piece();

// The shipped arm with six axes around a post; its angles.
Problem make_arm();

#endif
