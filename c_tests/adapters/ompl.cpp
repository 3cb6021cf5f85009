/* swiftprox/adapters/ompl.hpp: verdicts, clearances and last valid states of a box before a wall, and of a pair of bodies. */
#include <swiftprox/adapters/ompl.hpp>

#include "check.h"

#include <cmath>
#include <limits>
#include <thread>

#include <ompl/base/ScopedState.h>

namespace ob = ompl::base;
namespace adapter = swiftprox::adapters::ompl;
using swiftprox::Pose;
using swiftprox::Shape;

namespace
{

using State = ob::ScopedState<ob::SE3StateSpace>;

State at(const ob::SpaceInformationPtr &information, double x, double angle = 0)
{
    State state(information);
    state->setXYZ(x, 0, 0);
    state->rotation().setAxisAngle(0, 0, 1, angle);
    return state;
}

/* Its second body goes the other way. */
class Pair final : public adapter::Cell
{
  protected:
    static Pose pose_of(const ob::State *state, double sign)
    {
        return Pose::at(sign * state->as<ob::SE3StateSpace::StateType>()->getX(), 0, 0);
    }
    void poses_of(const ob::State *state, std::vector<Pose> &poses) const override
    {
        poses[0] = pose_of(state, 1);
        poses[1] = pose_of(state, -1);
    }
    void motions_of(const ob::State *from, const ob::State *to, std::vector<swiftprox_motion> &motions) const override
    {
        for (std::size_t i = 0; i < 2; ++i) {
            const double sign = i == 0 ? 1 : -1;
            motions[i] = swiftprox::motion_between(pose_of(from, sign), pose_of(to, sign), {}, 2).motion;
        }
    }
};

} // namespace

int main()
{
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    const auto space = std::make_shared<ob::SE3StateSpace>();
    ob::RealVectorBounds bounds(3);
    bounds.setLow(-8);
    bounds.setHigh(8);
    space->setBounds(bounds);
    const auto information = std::make_shared<ob::SpaceInformation>(space);

    // The wall begins at 4, the box reaches 1 ahead, and an eighth is to stay between them.
    const auto cell = std::make_shared<adapter::SE3Cell>();
    cell->max_distance = 0.125;
    cell->add_obstacle(Shape::box(1, 8, 8), Pose::at(5, 0, 0));
    CHECK(cell->add_body(Shape::box(1, 0.25, 0.25)) == 0 && cell->body_count() == 1);
    cell->add_obstacle(Shape::box(1, 1, 1), Pose::at(-20, 0, 0));
    const adapter::StateChecker states(information, cell);
    const adapter::MotionChecker motions(information, cell);

    const State start = at(information, 0), near = at(information, 2.75), deep = at(information, 4), outside = at(information, 9);
    const State too_near = at(information, 2.9), turned = at(information, 3.5, std::acos(0.0));
    CHECK(states.isValid(start.get()) && states.isValid(near.get()) && states.isValid(turned.get()));
    CHECK(!states.isValid(too_near.get()) && !states.isValid(deep.get()) && !states.isValid(outside.get()));
    CHECK(std::fabs(states.clearance(start.get()) - 3) < 1e-12 && std::fabs(states.clearance(near.get()) - 0.25) < 1e-12);
    CHECK(states.clearance(deep.get()) == 0 && std::fabs(states.clearance(turned.get()) - 0.25) < 1e-12);

    CHECK(motions.checkMotion(start.get(), near.get()) && !motions.checkMotion(start.get(), deep.get()));
    CHECK(cell->is_proved_free(start.get(), near.get()) && !cell->is_proved_free(start.get(), too_near.get()));
    // It reaches 2.875 after 23/32 of the way to 4.
    State last(information);
    std::pair<ob::State *, double> valid{last.get(), -1};
    CHECK(!motions.checkMotion(start.get(), deep.get(), valid));
    CHECK(valid.second <= 0.71875 && valid.second > 0.71874 && std::fabs(last->getX() - 2.875) < 1e-4);
    CHECK(states.isValid(last.get()));
    CHECK(motions.checkMotion(start.get(), turned.get(), valid));
    CHECK(motions.getValidMotionCount() == 2 && motions.getInvalidMotionCount() == 2);
    const adapter::Edge edge = cell->cast(start.get(), near.get());
    CHECK(edge.is_free && edge.clearance > 0.125 && edge.clearance <= 0.25);

    // What is no pose is not free, and throws nothing.
    const State none = at(information, std::numeric_limits<double>::quiet_NaN());
    CHECK(!cell->is_free(none.get()) && cell->clearance(none.get()) == 0 && !cell->is_proved_free(start.get(), none.get()));
    CHECK(!motions.checkMotion(start.get(), none.get(), valid) && valid.second == 0);

    // Bodies that may meet each other, and threads that take turns.
    const auto pair = std::make_shared<Pair>();
    pair->add_body(Shape::sphere(1));
    pair->add_body(Shape::sphere(1));
    CHECK(pair->is_free(deep.get()) && pair->is_free(start.get()));
    pair->add_pair(0, 1);
    CHECK(pair->is_free(deep.get()) && !pair->is_free(start.get()) && std::fabs(pair->clearance(deep.get()) - 6) < 1e-12);
    const auto work = [&] {
        for (int i = 0; i < 200; ++i) {
            const bool is_free = pair->is_free(deep.get()), meets = !pair->cast(near.get(), start.get()).is_free;
            const double when = pair->cast(deep.get(), start.get()).time_lower;
            if (!is_free || !meets || !(when <= 0.75 && when > 0.7499)) {
                std::abort();
            }
        }
    };
    std::thread first(work), second(work);
    first.join();
    second.join();
    return check_report("ompl");
}
