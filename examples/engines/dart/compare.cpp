// Scenes in DART with its own collision detector, by FCL, and with swiftprox, in one run, taking turns.
//
//   dart_compare [--quick] [FOLDER]    --quick: the wall is left out, and by FCL what takes minutes
//
// DART's detector by Bullet is no measure: it finds no contacts of two meshes.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/MeshShape.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>
#include <swiftprox.hpp>
#include <swiftprox/adapters/dart.hpp>

#include "../report.h"

namespace
{

using namespace dart::dynamics;

// As ../scenes.c has them.
enum { DRUMS = 1, WALL = 2, TRAY = 5 };
enum { QUICK_STEPS = 480, STEPS = 2400 };
constexpr double STEP = 1.0 / 240;
constexpr double MARGIN = 1e-4;

enum class Collider { DART, SWIFTPROX };

// The hull of points, read as a program reads a file.
ShapePtr mesh_of(const swiftprox::Shape &hull)
{
    const std::vector<double> vertices = hull.vertices();
    const std::vector<std::uint32_t> corners = hull.triangles();
    std::string text;
    char line[128];
    for (std::size_t i = 0; i < vertices.size(); i += 3) {
        std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", vertices[i], vertices[i + 1], vertices[i + 2]);
        text += line;
    }
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::snprintf(line, sizeof line, "f %u %u %u\n", corners[i] + 1, corners[i + 1] + 1, corners[i + 2] + 1);
        text += line;
    }
    const aiScene *const read =
        aiImportFileFromMemory(text.data(), static_cast<unsigned>(text.size()), aiProcess_JoinIdenticalVertices, "obj");
    if (!read) {
        std::fprintf(stderr, "dart_compare: %s\n", aiGetErrorString());
        std::exit(EXIT_FAILURE);
    }
    return std::make_shared<MeshShape>(Eigen::Vector3d::Ones(), read);
}

// A body of one shape, welded to the world or free.
SkeletonPtr skeleton_of(const std::string &name, const ShapePtr &shape, const Eigen::Isometry3d &place, bool fixed)
{
    const SkeletonPtr skeleton = Skeleton::create(name);
    BodyNode *body;
    if (fixed) {
        WeldJoint *joint;
        std::tie(joint, body) = skeleton->createJointAndBodyNodePair<WeldJoint>();
        joint->setTransformFromParentBodyNode(place);
    } else {
        FreeJoint *joint;
        std::tie(joint, body) = skeleton->createJointAndBodyNodePair<FreeJoint>();
        joint->setPositions(FreeJoint::convertToPositions(place));
    }
    const auto node = body->createShapeNodeWith<CollisionAspect, DynamicsAspect>(shape);
    node->getDynamicsAspect()->setFrictionCoeff(0.8); // of two the lesser counts
    return skeleton;
}

// Of density 1000.
Inertia inertia_of(const swiftprox_shape_info &info)
{
    const double mass = 1000 * info.volume, *const m = info.inertia, *const c = info.centre_of_mass;
    return Inertia(mass, c[0], c[1], c[2], mass * m[0], mass * m[4], mass * m[8], mass * m[1], mass * m[2], mass * m[5]);
}

void play(const scene &scene, Collider collider, int steps, run &run)
{
    const dart::simulation::WorldPtr world = dart::simulation::World::create();
    world->setGravity(Eigen::Vector3d(0, 0, -9.81));
    world->setTimeStep(STEP);
    if (collider == Collider::SWIFTPROX) {
        world->getConstraintSolver()->setCollisionDetector(swiftprox::adapters::dart::create_detector(MARGIN));
    }
    const auto floor = std::make_shared<BoxShape>(Eigen::Vector3d(10, 10, 1));
    world->addSkeleton(skeleton_of("floor", floor, Eigen::Isometry3d(Eigen::Translation3d(0, 0, -0.5)), true));
    std::vector<SkeletonPtr> skeletons;
    for (int i = 0; i < scene.count; ++i) {
        const scene_body &from = scene.bodies[i];
        std::vector<double> points;
        for (int k = 0; k < from.count; ++k) {
            points.insert(points.end(), from.points[k], from.points[k] + 3);
        }
        const swiftprox::Shape hull = swiftprox::Shape::from_points(points);
        const double *const q = from.quaternion, *const t = from.place;
        const Eigen::Isometry3d place =
            Eigen::Translation3d(t[0], t[1], t[2]) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
        skeletons.push_back(skeleton_of("body" + std::to_string(i), mesh_of(hull), place, from.fixed));
        skeletons.back()->getBodyNode(0)->setInertia(inertia_of(hull.info()));
        world->addSkeleton(skeletons.back());
    }
    std::vector<double> times;
    for (int step = 0; step < steps; ++step) {
        const double before = report_now();
        world->step();
        if (step >= steps - steps / 5) {
            times.push_back(report_now() - before);
        }
    }
    run.is_played = true;
    run.energy = 0;
    for (int i = 0; i < scene.count; ++i) {
        const SkeletonPtr &skeleton = skeletons[static_cast<std::size_t>(i)];
        Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(run.poses[i]) =
            skeleton->getBodyNode(0)->getWorldTransform().matrix().topRows<3>();
        run.energy += skeleton->computeKineticEnergy();
    }
    run.microseconds = report_median(times.data(), static_cast<int>(times.size()));
    run.contacts = static_cast<int>(world->getLastCollisionResult().getNumContacts());
}

} // namespace

int main(int argc, char **argv)
try {
    static report report;
    bool good = true;
    int status;
    if (!report_begin(&report, "DART", argc, argv, &status)) {
        return status;
    }
    const int steps = report.is_quick ? QUICK_STEPS : STEPS;
    for (int i = 0; i < SCENE_COUNT; ++i) {
        if (report.is_quick && i == WALL) {
            continue;
        }
        played &played = report.played[report.count];
        scene_make(i, &played.scene);
        if (!report.is_quick || (i != DRUMS && i != TRAY)) {
            play(played.scene, Collider::DART, steps, played.theirs);
        }
        play(played.scene, Collider::SWIFTPROX, steps, played.ours);
        report_add(&report);
        good = good && report_stands_as_well(&played);
    }
    return report_end(&report, good);
} catch (const swiftprox::Error &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
}
