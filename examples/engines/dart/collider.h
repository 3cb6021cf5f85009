// swiftprox as a collision detector of DART, for boxes, spheres, capsules and meshes; a mesh counts as its convex hull.
#ifndef SWIFTPROX_EXAMPLES_DART_COLLIDER_H
#define SWIFTPROX_EXAMPLES_DART_COLLIDER_H

#include <memory>

#include <dart/collision/CollisionDetector.hpp>

// A detector for worlds (World::getConstraintSolver()->setCollisionDetector) and for groups of a program's own. A group's contacts
// are those of a scene that goes with it; of two groups, and for distances, all pairs are asked. It does not cast rays.
//
// Bodies that are up to `margin` apart have contacts, whose depth is then below 0. DART keeps nothing of a contact from one step to
// the next: without a margin those at rest come and go by rounding, and a card house falls. Where no contacts are asked for, the
// verdict is exact.
std::shared_ptr<dart::collision::CollisionDetector> collider_create(double margin = 0);

#endif
