/* swiftprox/adapters/bullet.hpp: contacts of hulls that have shapes of ours, and Bullet's own of those that have none. */
#include <swiftprox/adapters/bullet.hpp>

#include "check.h"

#include <cmath>

namespace
{

namespace adapter = swiftprox::adapters::bullet;

// Two cubes with sides of 2, in each other by 0.25 along x, and the manifolds of a step of their world.
struct World {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broad_phase;
    btCollisionWorld world{&dispatcher, &broad_phase, &configuration};
    btConvexHullShape hulls[2];
    btCollisionObject objects[2];

    static btDefaultCollisionConstructionInfo info()
    {
        btDefaultCollisionConstructionInfo info;
        info.m_customCollisionAlgorithmMaxElementSize = adapter::algorithm_size();
        return info;
    }

    World(const swiftprox::Shape *first, const swiftprox::Shape *second) : configuration(info())
    {
        adapter::install(dispatcher);
        const swiftprox::Shape *const shapes[2] = {first, second};
        for (int i = 0; i < 2; ++i) {
            for (int corner = 0; corner < 8; ++corner) {
                hulls[i].addPoint(btVector3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1), false);
            }
            hulls[i].recalcLocalAabb();
            if (shapes[i]) {
                adapter::attach(hulls[i], *shapes[i]);
            }
            objects[i].setCollisionShape(&hulls[i]);
            place(i, btScalar(1.75) * btScalar(i));
            world.addCollisionObject(&objects[i]);
        }
    }
    ~World()
    {
        for (btCollisionObject &object : objects) {
            world.removeCollisionObject(&object);
        }
    }
    void place(int i, btScalar x) { objects[i].setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 0))); }

    const btPersistentManifold &step()
    {
        world.performDiscreteCollisionDetection();
        CHECK(dispatcher.getNumManifolds() == 1);
        return *dispatcher.getManifoldByIndexInternal(0);
    }
};

} // namespace

int main()
{
    const swiftprox::Shape cube = swiftprox::Shape::try_box(1, 1, 1).value;
    World ours(&cube, &cube);
    const btPersistentManifold &contacts = ours.step();
    CHECK(contacts.getNumContacts() == 4);
    for (int i = 0; i < contacts.getNumContacts(); ++i) {
        const btManifoldPoint &point = contacts.getContactPoint(i);
        CHECK(point.getDistance() == btScalar(-0.25) && point.m_normalWorldOnB[0] == -1);
        CHECK(point.getPositionWorldOnA()[0] == 1 && std::fabs(point.getPositionWorldOnA()[1]) == 1);
        ours.dispatcher.getManifoldByIndexInternal(0)->getContactPoint(i).m_appliedImpulse = btScalar(i + 1);
    }
    // Points keep their impulses while their features stay.
    ours.place(1, btScalar(1.8125));
    ours.step();
    btScalar impulses = 0;
    for (int i = 0; i < contacts.getNumContacts(); ++i) {
        const btManifoldPoint &point = contacts.getContactPoint(i);
        CHECK(point.getDistance() == btScalar(-0.1875) && point.getLifeTime() == 1);
        impulses += point.m_appliedImpulse;
    }
    CHECK(contacts.getNumContacts() == 4 && impulses == 10);
    // Refused, and no contact: the simulation has gone to infinity.
    ours.place(1, SIMD_INFINITY);
    btCollisionObjectWrapper first(nullptr, &ours.hulls[0], &ours.objects[0], ours.objects[0].getWorldTransform(), -1, -1);
    btCollisionObjectWrapper second(nullptr, &ours.hulls[1], &ours.objects[1], ours.objects[1].getWorldTransform(), -1, -1);
    btCollisionAlgorithm *const algorithm = ours.dispatcher.findAlgorithm(&first, &second, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    btManifoldResult result(&first, &second);
    algorithm->processCollision(&first, &second, ours.world.getDispatchInfo(), &result);
    CHECK(result.getPersistentManifold()->getNumContacts() == 0);
    CHECK(algorithm->calculateTimeOfImpact(nullptr, nullptr, {}, nullptr) == 1);
    algorithm->~btCollisionAlgorithm();
    ours.dispatcher.freeCollisionAlgorithm(algorithm);
    ours.place(1, 3);

    // Bullet's own answers where one has no shape: with its margin the cubes are deeper in each other.
    for (const swiftprox::Shape *second_shape : {static_cast<const swiftprox::Shape *>(nullptr), &cube}) {
        World theirs(nullptr, second_shape);
        const btPersistentManifold &found = theirs.step();
        CHECK(found.getNumContacts() > 0 && found.getContactPoint(0).getDistance() != btScalar(-0.25));
        CHECK(found.getContactPoint(0).getDistance() < btScalar(-0.2));
    }
    return check_report("bullet");
}
