// swiftprox as a collision algorithm of Bullet, for pairs of convex hulls and boxes.
#ifndef SWIFTPROX_EXAMPLES_BULLET_COLLIDER_H
#define SWIFTPROX_EXAMPLES_BULLET_COLLIDER_H

#include <btBulletCollisionCommon.h>
#include <swiftprox.hpp>

// Gives a shape of Bullet's its shape of ours, made from the same points: Bullet's margin is no part of it. To be called of each
// shape before the first step; `shape` lives as long as Bullet's does.
void collider_attach(btCollisionShape &bullet_shape, const swiftprox::Shape &shape);

// How large an algorithm is: Bullet takes them from a pool whose elements are to be as large
// (btDefaultCollisionConstructionInfo::m_customCollisionAlgorithmMaxElementSize).
int collider_size();

// From now on a dispatcher asks swiftprox about pairs of convex hulls.
void collider_install(btCollisionDispatcher &dispatcher);

#endif
