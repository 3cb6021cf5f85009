// OMPL with edges that are proved free: plans for an L of two plates through a window and for an arm around a post, by RRTConnect
// and PRM*, and proves each edge of each path anew. Then the same piece with OMPL's own sampled validator at a resolution of 1 %:
// it shows a path that passes there and collides. The status is 1 where a path is missing, not proved, or where no sampled path
// collides.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <ompl/base/DiscreteMotionValidator.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "problems.hpp"

namespace ob = ompl::base;
namespace og = ompl::geometric;
namespace certified = swiftprox::adapters::ompl;

namespace {

enum class Validator { certified, sampled };

// How many iterations a planner may make.
const unsigned MOST_ITERATIONS = 20000;
const unsigned PIECE_ROADMAP = 1000, ARM_ROADMAP = 300;

// What OMPL's sampled validator is set to: 1 % of the space's extent.
const double RESOLUTION = 0.01;

const unsigned FIRST_SEED = 1, MOST_SEEDS = 40;

struct Setting {
    Setting(Problem made, Validator validator)
        : problem(std::move(made)), information(std::make_shared<ob::SpaceInformation>(problem.space)),
          definition(std::make_shared<ob::ProblemDefinition>(information))
    {
        information->setStateValidityChecker(std::make_shared<certified::StateChecker>(information, problem.cell));
        if (validator == Validator::certified) {
            information->setMotionValidator(std::make_shared<certified::MotionChecker>(information, problem.cell));
        } else {
            information->setStateValidityCheckingResolution(RESOLUTION);
            information->setMotionValidator(std::make_shared<ob::DiscreteMotionValidator>(information));
        }
        information->setup();
        definition->setStartAndGoalStates(*problem.start, *problem.goal);
        auto shortest = std::make_shared<ob::PathLengthOptimizationObjective>(information);
        shortest->setCostThreshold(shortest->infiniteCost()); // any path will do
        definition->setOptimizationObjective(shortest);
    }

    Problem problem;
    ob::SpaceInformationPtr information;
    ob::ProblemDefinitionPtr definition;
};

og::PathGeometric *solution(const Setting &setting)
{
    const ob::PathPtr path = setting.definition->getSolutionPath();
    return path && setting.definition->hasExactSolution() ? path->as<og::PathGeometric>() : nullptr;
}

// Edges that are not proved free, and when the first of them is hit.
struct Recheck {
    size_t edges, refuted;
    double time_lower, time_upper;
};

// From the motions alone, edge by edge and pair by pair.
Recheck recheck(const Setting &setting, const og::PathGeometric &path)
{
    Recheck found = {path.getStateCount() - 1, 0, 0, 0};
    for (size_t i = 0; i < found.edges; ++i) {
        const ob::State *const from = path.getState(i), *const to = path.getState(i + 1);
        if (setting.problem.cell->is_proved_free(from, to)) {
            continue;
        }
        const certified::Edge edge = setting.problem.cell->cast(from, to);
        if (found.refuted++ == 0) {
            found.time_lower = edge.time_lower;
            found.time_upper = edge.time_upper;
        }
    }
    return found;
}

double least_clearance(const Setting &setting, og::PathGeometric &path)
{
    double least = INFINITY;
    for (const ob::State *state : path.getStates()) {
        least = std::fmin(least, setting.information->getStateValidityChecker()->clearance(state));
    }
    return least;
}

bool report(const Setting &setting, const char *problem, const char *planner)
{
    og::PathGeometric *const path = solution(setting);
    if (!path) {
        std::printf("%s, %s: no path\n", problem, planner);
        return false;
    }
    const Recheck proved = recheck(setting, *path);
    std::printf("%s, %s: a path of %zu edges, length %.2f, least clearance of its states %.4f, %zu edges proved anew\n", problem,
                planner, proved.edges, path->length(), least_clearance(setting, *path), proved.edges - proved.refuted);
    return proved.refuted == 0;
}

bool plan_by_rrt_connect(Problem problem, const char *name)
{
    Setting setting(std::move(problem), Validator::certified);
    og::RRTConnect planner(setting.information);
    planner.setProblemDefinition(setting.definition);
    planner.setup();
    ob::IterationTerminationCondition enough(MOST_ITERATIONS);
    planner.solve(enough);
    return report(setting, name, "RRTConnect");
}

// The roadmap grows for so many iterations, in this thread; the search of it is OMPL's, in another.
bool plan_by_prm_star(Problem problem, const char *name, unsigned iterations)
{
    Setting setting(std::move(problem), Validator::certified);
    og::PRMstar planner(setting.information);
    planner.setProblemDefinition(setting.definition);
    planner.setup();
    ob::IterationTerminationCondition roadmap(iterations), enough(MOST_ITERATIONS);
    planner.constructRoadmap(roadmap);
    planner.solve(enough);
    return report(setting, name, "PRM*");
}

// A path that passes OMPL's own sampled validator, and collides.
bool show_sampled()
{
    for (unsigned seed = FIRST_SEED; seed < FIRST_SEED + MOST_SEEDS; ++seed) {
        Setting setting(make_piece(), Validator::sampled);
        og::RRTConnect planner(setting.information);
        planner.setProblemDefinition(setting.definition);
        planner.setup();
        ob::IterationTerminationCondition enough(MOST_ITERATIONS);
        planner.solve(enough);
        const og::PathGeometric *const path = solution(setting);
        if (!path || !path->check()) {
            continue;
        }
        const Recheck found = recheck(setting, *path);
        if (found.refuted > 0) {
            std::printf("piece, RRTConnect, sampled at %g %%: path %u passes OMPL's check, and %zu of its %zu edges collide; the first "
                        "one is hit between %.7f and %.7f of the way\n",
                        100 * RESOLUTION, seed, found.refuted, found.edges, found.time_lower, found.time_upper);
            return true;
        }
    }
    std::printf("piece, RRTConnect, sampled at %g %%: none of %u paths collides\n", 100 * RESOLUTION, MOST_SEEDS);
    return false;
}

} // namespace

int main()
{
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    ompl::RNG::setSeed(FIRST_SEED);
    bool is_good = plan_by_rrt_connect(make_piece(), "piece");
    is_good &= plan_by_prm_star(make_piece(), "piece", PIECE_ROADMAP);
    is_good &= plan_by_rrt_connect(make_arm(), "arm");
    is_good &= plan_by_prm_star(make_arm(), "arm", ARM_ROADMAP);
    is_good &= show_sampled();
    return is_good ? EXIT_SUCCESS : EXIT_FAILURE;
}
