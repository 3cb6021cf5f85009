// Scenes in Bullet with its own collider and with swiftprox, in one run, taking turns.
//
//   bullet_compare [--quick] [FOLDER]
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>
#include <swiftprox.hpp>
#include <swiftprox/adapters/bullet.hpp>

#include "../report.h"

namespace
{

enum { QUICK_STEPS = 480, STEPS = 2400 };
constexpr btScalar STEP = 1 / btScalar(240);

enum class Collider { BULLET, SWIFTPROX };

// A world, its bodies and their shapes, ended in the order that Bullet asks for.
struct World {
    std::unique_ptr<btDefaultCollisionConfiguration> configuration;
    std::unique_ptr<btCollisionDispatcher> dispatcher;
    btDbvtBroadphase broad_phase;
    btSequentialImpulseConstraintSolver solver;
    std::unique_ptr<btDiscreteDynamicsWorld> world;
    std::vector<std::unique_ptr<swiftprox::Shape>> ours;
    std::vector<std::unique_ptr<btConvexHullShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;

    explicit World(Collider collider)
    {
        btDefaultCollisionConstructionInfo info;
        info.m_customCollisionAlgorithmMaxElementSize = swiftprox::adapters::bullet::algorithm_size();
        configuration = std::make_unique<btDefaultCollisionConfiguration>(info);
        dispatcher = std::make_unique<btCollisionDispatcher>(configuration.get());
        if (collider == Collider::SWIFTPROX) {
            swiftprox::adapters::bullet::install(*dispatcher);
        }
        world = std::make_unique<btDiscreteDynamicsWorld>(dispatcher.get(), &broad_phase, &solver, configuration.get());
        world->setGravity(btVector3(0, 0, btScalar(-9.81)));
        // With Bullet's defaults, one direction of friction and 10 iterations, stacks creep, and an arch and a card house fall,
        // whichever collider there is.
        world->getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
        world->getSolverInfo().m_numIterations = 20;
    }
    ~World()
    {
        for (const auto &body : bodies) {
            world->removeRigidBody(body.get());
        }
    }

    // A hull of points, of density 1000, or fixed.
    void add(const std::vector<double> &points, const btTransform &place, bool fixed)
    {
        ours.push_back(std::make_unique<swiftprox::Shape>(swiftprox::Shape::from_points(points)));
        auto hull = std::make_unique<btConvexHullShape>();
        for (std::size_t i = 0; i < points.size(); i += 3) {
            hull->addPoint(btVector3(btScalar(points[i]), btScalar(points[i + 1]), btScalar(points[i + 2])), false);
        }
        hull->recalcLocalAabb();
        hull->setMargin(btScalar(0.001));
        hull->initializePolyhedralFeatures();
        swiftprox::adapters::bullet::attach(*hull, *ours.back());
        const btScalar mass = fixed ? 0 : btScalar(1000 * ours.back()->info().volume);
        btVector3 inertia(0, 0, 0);
        if (!fixed) {
            hull->calculateLocalInertia(mass, inertia);
        }
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, hull.get(), inertia);
        info.m_startWorldTransform = place;
        info.m_friction = btScalar(0.9); // Bullet multiplies two: 0.8
        bodies.push_back(std::make_unique<btRigidBody>(info));
        bodies.back()->setActivationState(DISABLE_DEACTIVATION);
        world->addRigidBody(bodies.back().get());
        shapes.push_back(std::move(hull));
    }
};

void play(const scene &scene, Collider collider, int steps, run &run)
{
    World world(collider);
    const std::vector<double> floor{-5, -5, -.5, 5, -5, -.5, -5, 5, -.5, 5, 5, -.5, -5, -5, .5, 5, -5, .5, -5, 5, .5, 5, 5, .5};
    world.add(floor, btTransform(btQuaternion::getIdentity(), btVector3(0, 0, btScalar(-0.5))), true);
    for (int i = 0; i < scene.count; ++i) {
        const scene_body &body = scene.bodies[i];
        std::vector<double> points;
        for (int k = 0; k < body.count; ++k) {
            points.insert(points.end(), body.points[k], body.points[k] + 3);
        }
        const double *const q = body.quaternion, *const t = body.place;
        world.add(points,
                  btTransform(btQuaternion(btScalar(q[1]), btScalar(q[2]), btScalar(q[3]), btScalar(q[0])),
                              btVector3(btScalar(t[0]), btScalar(t[1]), btScalar(t[2]))),
                  body.fixed);
    }
    std::vector<double> times;
    for (int step = 0; step < steps; ++step) {
        const double before = report_now();
        world.world->stepSimulation(STEP, 1, STEP);
        if (step >= steps - steps / 5) {
            times.push_back(report_now() - before);
        }
    }
    run.is_played = true;
    run.energy = 0;
    for (int i = 0; i < scene.count; ++i) {
        const btRigidBody &body = *world.bodies[static_cast<std::size_t>(i) + 1];
        const btTransform place = body.getWorldTransform();
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                run.poses[i][4 * row + column] = double(place.getBasis()[row][column]);
            }
            run.poses[i][4 * row + 3] = double(place.getOrigin()[row]);
        }
        if (!scene.bodies[i].fixed) {
            const btVector3 spin = body.getAngularVelocity();
            const btMatrix3x3 inverse = body.getInvInertiaTensorWorld();
            run.energy += 0.5 * double(body.getLinearVelocity().length2() / body.getInvMass() + spin.dot(inverse.inverse() * spin));
        }
    }
    run.microseconds = report_median(times.data(), static_cast<int>(times.size()));
    run.contacts = 0;
    for (int i = 0; i < world.dispatcher->getNumManifolds(); ++i) {
        run.contacts += world.dispatcher->getManifoldByIndexInternal(i)->getNumContacts();
    }
}

} // namespace

int main(int argc, char **argv)
try {
    static report report;
    bool good = true;
    int status;
    if (!report_begin(&report, "Bullet", argc, argv, &status)) {
        return status;
    }
    const int steps = report.is_quick ? QUICK_STEPS : STEPS;
    for (int i = 0; i < SCENE_COUNT; ++i) {
        played &played = report.played[i];
        scene_make(i, &played.scene);
        play(played.scene, Collider::BULLET, steps, played.theirs);
        play(played.scene, Collider::SWIFTPROX, steps, played.ours);
        report_add(&report);
        good = good && report_stands_as_well(&played);
    }
    return report_end(&report, good);
} catch (const swiftprox::Error &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
}
