// The detector asked as a program asks DART's own: contacts and signed distances of a group and of two, with filters.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>

#include <dart/collision/CollisionFilter.hpp>
#include <dart/collision/CollisionGroup.hpp>
#include <dart/collision/CollisionObject.hpp>
#include <dart/collision/DistanceFilter.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/CapsuleShape.hpp>
#include <dart/dynamics/CylinderShape.hpp>
#include <dart/dynamics/SimpleFrame.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <swiftprox/adapters/dart.hpp>

namespace
{

using namespace dart::collision;
using namespace dart::dynamics;

int failures = 0;

void check(bool holds, const char *what)
{
    if (!holds) {
        std::fprintf(stderr, "dart_queries: failed: %s\n", what);
        ++failures;
    }
}

#define CHECK(condition) check(condition, #condition)

bool is_near(double a, double b)
{
    return std::fabs(a - b) < 1e-12;
}

std::shared_ptr<SimpleFrame> frame_of(const ShapePtr &shape, double x)
{
    const auto frame = std::make_shared<SimpleFrame>(Frame::World());
    frame->setShape(shape);
    frame->setTranslation(Eigen::Vector3d(x, 0, 0));
    return frame;
}

// Neither the one nor the other tests what has a frame.
struct Without final : CollisionFilter, DistanceFilter {
    explicit Without(const ShapeFrame *of) : frame(of) {}
    bool has(const CollisionObject *a, const CollisionObject *b) const
    {
        return a->getShapeFrame() == frame || b->getShapeFrame() == frame;
    }
    bool ignoresCollision(const CollisionObject *a, const CollisionObject *b) const override { return has(a, b); }
    bool needDistance(const CollisionObject *a, const CollisionObject *b) const override { return !has(a, b); }

    const ShapeFrame *frame;
};

} // namespace

int main()
{
    const auto detector = swiftprox::adapters::dart::create_detector();
    const auto cube = std::make_shared<BoxShape>(Eigen::Vector3d(2, 2, 2));
    // Two cubes 0.25 in each other, a sphere 0.5 beyond, a capsule 1 beyond that.
    const auto left = frame_of(cube, 0), right = frame_of(cube, 1.75), ball = frame_of(std::make_shared<SphereShape>(1), 4.25),
               pill = frame_of(std::make_shared<CapsuleShape>(0.5, 3), 6.75);
    const auto group = detector->createCollisionGroup(left.get(), right.get(), ball.get(), pill.get());
    CHECK(detector->getType() == "swiftprox" && group->getNumShapeFrames() == 4);

    CollisionResult contacts;
    CHECK(group->collide(CollisionOption(true, 100), &contacts));
    CHECK(contacts.getNumContacts() == 4 && contacts.inCollision(left.get()) && !contacts.inCollision(ball.get()));
    for (const Contact &contact : contacts.getContacts()) {
        CHECK(contact.collisionObject1->getShapeFrame() == left.get());
        CHECK(is_near(contact.normal.x(), -1) && is_near(contact.penetrationDepth, 0.25));
        CHECK(is_near(contact.point.x(), 0.875) && is_near(std::fabs(contact.point.y()), 1));
    }
    CHECK(group->collide() && !group->collide(CollisionOption(true, 0), &contacts));
    CHECK(group->collide(CollisionOption(true, 3), &contacts) && contacts.getNumContacts() == 3);
    CHECK(group->collide(CollisionOption(false, 100), &contacts) && contacts.getNumContacts() == 1);
    const auto without = std::make_shared<Without>(left.get());
    CHECK(!group->collide(CollisionOption(true, 100, without), &contacts) && contacts.getNumContacts() == 0);

    const double least = -std::numeric_limits<double>::infinity();
    DistanceResult result;
    CHECK(is_near(group->distance(DistanceOption(true, least), &result), -0.25) && is_near(result.minDistance, -0.25));
    CHECK(is_near((result.nearestPoint1 - result.nearestPoint2).norm(), 0.25) && result.shapeFrame1 == left.get());
    CHECK(group->distance() == 0);
    CHECK(is_near(group->distance(DistanceOption(true, 0, without), &result), 0.5));
    CHECK(is_near(result.nearestPoint1.x(), 2.75) && is_near(result.nearestPoint2.x(), 3.25));
    CHECK(result.shapeFrame1 == right.get() && result.shapeFrame2 == ball.get());

    // Of two groups only the pairs between them count.
    const auto cubes = detector->createCollisionGroup(left.get(), right.get());
    const auto others = detector->createCollisionGroup(ball.get(), pill.get());
    CHECK(!cubes->collide(others.get()) && is_near(cubes->distance(others.get()), 0.5));
    CHECK(is_near(others->distance(), 1));
    ball->setTranslation(Eigen::Vector3d(3.5, 0, 0));
    CHECK(cubes->collide(others.get(), CollisionOption(true, 100), &contacts) && contacts.getNumContacts() == 1);
    CHECK(is_near(contacts.getContact(0).penetrationDepth, 0.25) && is_near(contacts.getContact(0).point.x(), 2.625));
    CHECK(is_near(cubes->distance(others.get(), DistanceOption(false, least)), -0.25));

    // What leaves a group, and what comes back.
    group->removeShapeFrame(right.get());
    CHECK(!group->collide() && is_near(group->distance(), 1.5));
    group->addShapeFrame(right.get());
    CHECK(group->collide() && is_near(group->distance(DistanceOption(false, least)), -0.25));
    group->removeAllShapeFrames();
    CHECK(group->distance(DistanceOption(), &result) == 0 && !result.found() && !group->collide());

    // With a margin cubes that are nearly together have contacts, and collide only where contacts are asked for.
    const auto wary = swiftprox::adapters::dart::create_detector(0.01);
    const auto below = wary->createCollisionGroup(left.get()), above = wary->createCollisionGroup(right.get());
    const auto both = wary->createCollisionGroup(left.get(), right.get());
    right->setTranslation(Eigen::Vector3d(2 + 0x1p-8, 0, 0));
    CHECK(both->collide(CollisionOption(true, 100), &contacts) && contacts.getNumContacts() == 4);
    CHECK(is_near(contacts.getContact(0).penetrationDepth, -0x1p-8) && is_near(contacts.getContact(0).normal.x(), -1));
    CHECK(below->collide(above.get(), CollisionOption(true, 100), &contacts) && contacts.getNumContacts() == 4);
    CHECK(is_near(contacts.getContact(0).penetrationDepth, -0x1p-8));
    CHECK(!both->collide() && !both->collide(CollisionOption(false, 100), &contacts) && !below->collide(above.get()));
    right->setTranslation(Eigen::Vector3d(2 + 0x1p-6, 0, 0));
    CHECK(!both->collide(CollisionOption(true, 100), &contacts) && !below->collide(above.get(), CollisionOption(true, 100), &contacts));

    // What is refused is not tested, and nothing throws: another type of shape, a capsule beyond the doubles, a pose that is none.
    const auto odd = frame_of(std::make_shared<CylinderShape>(5, 5), 0), huge = frame_of(std::make_shared<CapsuleShape>(1e305, 1), 0);
    const auto untested = detector->createCollisionGroup(left.get(), odd.get(), huge.get());
    CHECK(untested->getNumShapeFrames() == 3 && !untested->collide() && untested->distance() == 0);
    right->setTranslation(Eigen::Vector3d(std::numeric_limits<double>::infinity(), 0, 0));
    CHECK(!both->collide() && !below->collide(above.get()) && below->distance(above.get()) == 0);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
