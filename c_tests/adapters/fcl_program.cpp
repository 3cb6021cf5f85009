/* A program for FCL, compiled twice: COLLISION is <fcl/fcl.h> or <swiftprox/adapters/fcl_switch.hpp>, and nothing else differs.
 *
 *   fcl_program TOLERANCE CONTACTS    what its distances and depths may be off by; contacts of a box on a box
 */
#include COLLISION

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace
{

double tolerance;
int failures;

void expect(const char *what, double found, double expected, double allowed)
{
    std::printf("%s: %.17g\n", what, found);
    if (!(std::fabs(found - expected) <= allowed)) {
        std::fprintf(stderr, "%s: %.17g, not %.17g up to %g\n", what, found, expected, allowed);
        ++failures;
    }
}

// A cube with sides of 2.
std::shared_ptr<fcl::Convexd> cube()
{
    const auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (int i = 0; i < 8; ++i) {
        vertices->emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    }
    const std::vector<int> faces{4, 0, 2, 3, 1, 4, 4, 5, 7, 6, 4, 0, 1, 5, 4, 4, 2, 6, 7, 3, 4, 0, 4, 6, 2, 4, 1, 3, 7, 5};
    return std::make_shared<fcl::Convexd>(vertices, 6, std::make_shared<std::vector<int>>(faces));
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 3) {
        return EXIT_FAILURE;
    }
    tolerance = std::atof(argv[1]);
    const auto geometry = cube();
    fcl::CollisionObjectd still(geometry), moving(geometry), ball(std::make_shared<fcl::Sphered>(0.7));
    moving.setTranslation(fcl::Vector3d(1.5, 0.25, 0.125));
    ball.setTranslation(fcl::Vector3d(2.1, 1.3, 1.2));
    moving.computeAABB();
    ball.computeAABB();

    fcl::CollisionResultd result;
    fcl::collide(&still, &moving, fcl::CollisionRequestd(100, true), result);
    expect("contacts", double(result.numContacts()), std::atof(argv[2]), 0);
    expect("depth", result.getContact(0).penetration_depth, 0.5, tolerance);
    expect("normal", result.getContact(0).normal[0], 1, tolerance);

    fcl::DistanceResultd apart;
    const double distance = fcl::distance(&still, &ball, fcl::DistanceRequestd(true), apart);
    expect("distance", distance, std::sqrt(1.1 * 1.1 + 0.3 * 0.3 + 0.2 * 0.2) - 0.7, tolerance);
    expect("distance of points", (apart.nearest_points[0] - apart.nearest_points[1]).norm(), distance, tolerance);
    fcl::DistanceResultd deep;
    expect("signed distance", fcl::distance(&still, &moving, fcl::DistanceRequestd(true, true), deep), -0.5, tolerance);

    fcl::DynamicAABBTreeCollisionManagerd manager;
    manager.registerObject(&moving);
    manager.registerObject(&ball);
    manager.setup();
    fcl::DefaultCollisionData<double> data;
    data.request = fcl::CollisionRequestd(100, true);
    manager.collide(&still, &data, fcl::DefaultCollisionFunction<double>);
    expect("contacts of the broad phase", double(data.result.numContacts()), std::atof(argv[2]), 0);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
