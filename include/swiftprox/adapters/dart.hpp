/*
 * swiftprox as a collision detector of DART, for boxes, spheres, capsules and meshes; a mesh counts as its convex hull.
 *
 *   world->getConstraintSolver()->setCollisionDetector(swiftprox::adapters::dart::create_detector(1e-4));
 *
 * What swiftprox refuses, and shapes of other types, are not tested; DART's console says so. Nothing of ours throws, unless memory
 * is lacking.
 */
#ifndef SWIFTPROX_ADAPTERS_DART_HPP
#define SWIFTPROX_ADAPTERS_DART_HPP

#include "../pair.hpp"
#include "../scene.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <assimp/scene.h>
#include <dart/collision/CollisionDetector.hpp>
#include <dart/collision/CollisionFilter.hpp>
#include <dart/collision/CollisionGroup.hpp>
#include <dart/collision/CollisionObject.hpp>
#include <dart/collision/DistanceFilter.hpp>
#include <dart/common/Console.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/CapsuleShape.hpp>
#include <dart/dynamics/MeshShape.hpp>
#include <dart/dynamics/SphereShape.hpp>

namespace swiftprox::adapters::dart
{

namespace detail
{

using namespace ::dart::collision;

inline Eigen::Vector3d vector_of(const double *v)
{
    return Eigen::Vector3d(v[0], v[1], v[2]);
}

/** Says what is wrong; whether nothing is. */
inline bool is_good(const Status &status)
{
    if (!status) {
        dtwarn << "[swiftprox] " << status.message() << "\n";
    }
    return static_cast<bool>(status);
}

/** No shape for what is neither box nor sphere, capsule or mesh, and for what is refused. */
inline Shape shape_of(const ::dart::dynamics::Shape &shape)
{
    Result<Shape> made;
    if (const auto *box = dynamic_cast<const ::dart::dynamics::BoxShape *>(&shape)) {
        const Eigen::Vector3d half = 0.5 * box->getSize();
        made = Shape::try_box(half[0], half[1], half[2]);
    } else if (const auto *sphere = dynamic_cast<const ::dart::dynamics::SphereShape *>(&shape)) {
        made = Shape::try_sphere(sphere->getRadius());
    } else if (const auto *capsule = dynamic_cast<const ::dart::dynamics::CapsuleShape *>(&shape)) {
        made = Shape::try_capsule(0.5 * capsule->getHeight(), capsule->getRadius());
    } else if (const auto *mesh = dynamic_cast<const ::dart::dynamics::MeshShape *>(&shape)) {
        std::vector<double> points;
        const aiScene &from = *mesh->getMesh();
        for (unsigned part = 0; part < from.mNumMeshes; ++part) {
            for (unsigned i = 0; i < from.mMeshes[part]->mNumVertices; ++i) {
                const aiVector3D &vertex = from.mMeshes[part]->mVertices[i];
                for (unsigned k = 0; k < 3; ++k) {
                    points.push_back(mesh->getScale()[k] * static_cast<double>(vertex[k]));
                }
            }
        }
        ShapeOptions options;
        options.input = SWIFTPROX_INPUT_HULL;
        made = Shape::try_from_points(points, options);
    } else {
        dtwarn << "[swiftprox] a shape of type " << shape.getType() << " is not tested.\n";
        return {};
    }
    return is_good(made) ? made.value : Shape();
}

struct Object final : CollisionObject {
    Object(CollisionDetector *detector, const ::dart::dynamics::ShapeFrame *frame)
        : CollisionObject(detector, frame), shape(shape_of(*getShape()))
    {
    }
    void updateEngineData() override {}

    Shape shape;
};

/** Objects, and a scene with one for each that has a shape. */
class Group final : public CollisionGroup
{
  public:
    using CollisionGroup::CollisionGroup;
    using CollisionGroup::updateEngineData;

    const std::vector<Object *> &objects() const { return objects_; }
    Scene &scene() { return scene_; }

  protected:
    void initializeEngineData() override {}

    void addCollisionObjectToEngine(CollisionObject *added) override
    {
        const auto object = static_cast<Object *>(added);
        if (!object->shape) {
            return;
        }
        ObjectOptions options;
        options.user_data = reinterpret_cast<std::uintptr_t>(object);
        options.pose = Pose(object->getTransform());
        const Result<swiftprox_object_id> id = scene_.try_add(object->shape, options);
        if (is_good(id)) {
            ids_.push_back(id.value);
            objects_.push_back(object);
        }
    }

    void addCollisionObjectsToEngine(const std::vector<CollisionObject *> &added) override
    {
        for (CollisionObject *object : added) {
            addCollisionObjectToEngine(object);
        }
    }

    void removeCollisionObjectFromEngine(CollisionObject *removed) override
    {
        const auto at = std::find(objects_.begin(), objects_.end(), removed);
        if (at != objects_.end()) {
            const auto id = ids_.begin() + (at - objects_.begin());
            is_good(scene_.try_remove_object(*id));
            ids_.erase(id);
            objects_.erase(at);
        }
    }

    void removeAllCollisionObjectsFromEngine() override
    {
        is_good(scene_.try_remove_objects(ids_));
        ids_.clear();
        objects_.clear();
    }

    void updateCollisionGroupEngineData() override
    {
        poses_.clear();
        for (const Object *object : objects_) {
            poses_.emplace_back(object->getTransform());
        }
        // A pose is refused where the simulation has gone to infinity: then all stay where they were.
        is_good(scene_.try_set_poses(ids_, poses_));
    }

  private:
    Scene scene_;
    std::vector<Object *> objects_;
    std::vector<swiftprox_object_id> ids_; // of the objects, in their order
    std::vector<Pose> poses_;
};

/** What a check of collisions has found so far, as far as it was asked for. */
struct Collisions {
    const CollisionOption &option;
    CollisionResult *result;
    std::size_t count = 0;

    bool is_enough() const { return count >= option.maxNumContacts || (!result && count > 0); }

    bool ignores(const Object *a, const Object *b) const
    {
        return option.collisionFilter && option.collisionFilter->ignoresCollision(a, b);
    }

    void add(Object *a, Object *b, const double *normal, Range<const swiftprox_manifold_point> points)
    {
        Contact contact;
        contact.collisionObject1 = a;
        contact.collisionObject2 = b;
        if (!option.enableContact) {
            add(contact);
            return;
        }
        for (const swiftprox_manifold_point &point : points) {
            // Both normals go from 2 to 1.
            contact.normal = vector_of(normal);
            contact.point = 0.5 * (vector_of(point.world1) + vector_of(point.world2));
            contact.penetrationDepth = -gap(point);
            add(contact);
        }
    }

    void add(const Contact &contact)
    {
        if (!is_enough()) {
            ++count;
            if (result) {
                result->addContact(contact);
            }
        }
    }
};

using Pairs = std::vector<std::pair<Object *, Object *>>;

inline Pairs pairs_of(const Group &group)
{
    Pairs pairs;
    for (auto b = group.objects().begin(); b != group.objects().end(); ++b) {
        for (auto a = group.objects().begin(); a != b; ++a) {
            pairs.emplace_back(*a, *b);
        }
    }
    return pairs;
}

inline Pairs pairs_between(const Group &first, const Group &second)
{
    Pairs pairs;
    for (Object *a : first.objects()) {
        for (Object *b : second.objects()) {
            if (a != b) {
                pairs.emplace_back(a, b);
            }
        }
    }
    return pairs;
}

/** The least signed distance: from 0 down it is minus the depth. */
inline double least_distance(const Pairs &pairs, const DistanceOption &option, DistanceResult *result)
{
    if (result) {
        result->clear();
    }
    double least = std::numeric_limits<double>::infinity();
    for (const auto &[a, b] : pairs) {
        if (option.distanceFilter && !option.distanceFilter->needDistance(a, b)) {
            continue;
        }
        PairConfig config;
        config.max_distance = std::max(least, 0.0);
        ManifoldCache cache;
        const Pose at[2] = {Pose(a->getTransform()), Pose(b->getTransform())};
        const auto asked = try_signed_distance({a->shape, at[0]}, {b->shape, at[1]}, cache, config);
        const swiftprox_signed_distance &found = asked.value;
        if (!is_good(asked) || found.outcome == SWIFTPROX_OUTCOME_BEYOND || !(found.distance < least)) {
            continue;
        }
        least = found.distance;
        if (result) {
            result->shapeFrame1 = a->getShapeFrame();
            result->shapeFrame2 = b->getShapeFrame();
            if (option.enableNearestPoints) {
                result->nearestPoint1 = vector_of(found.world1);
                result->nearestPoint2 = vector_of(found.world2);
            }
        }
        if (least <= option.distanceLowerBound) {
            break;
        }
    }
    if (least == std::numeric_limits<double>::infinity()) {
        return 0; // DART returns 0 for no pairs
    }
    const double clamped = std::max(least, option.distanceLowerBound);
    if (result) {
        result->unclampedMinDistance = least;
        result->minDistance = clamped;
    }
    return clamped;
}

class Detector final : public CollisionDetector
{
  public:
    explicit Detector(double margin) : margin_(margin)
    {
        mCollisionObjectManager.reset(new ManagerForSharableCollisionObjects(this));
    }

    std::shared_ptr<CollisionDetector> cloneWithoutCollisionObjects() const override { return std::make_shared<Detector>(margin_); }

    const std::string &getType() const override
    {
        static const std::string type = "swiftprox";
        return type;
    }

    std::unique_ptr<CollisionGroup> createCollisionGroup() override { return std::make_unique<Group>(shared_from_this()); }

    bool collide(CollisionGroup *of, const CollisionOption &option, CollisionResult *result) override
    {
        Group &group = updated(of);
        Collisions found = begin(option, result);
        SceneQuery query;
        query.max_distance = margin_for(option, result);
        query.detail = option.enableContact ? SWIFTPROX_CONTACT_DETAIL_REDUCED_MANIFOLD : SWIFTPROX_CONTACT_DETAIL_NONE;
        const auto asked = group.scene().try_query_contact(query);
        const swiftprox_scene_answer &answer = asked.value;
        is_good(asked);
        for (std::size_t i = 0; i < answer.count && !found.is_enough(); ++i) {
            const auto a = reinterpret_cast<Object *>(static_cast<std::uintptr_t>(answer.pairs[i].user_data1));
            const auto b = reinterpret_cast<Object *>(static_cast<std::uintptr_t>(answer.pairs[i].user_data2));
            if (found.ignores(a, b)) {
                continue;
            }
            if (option.enableContact) {
                found.add(a, b, answer.contacts[i].manifold.normal, points(answer, answer.contacts[i]));
            } else {
                found.add(a, b, nullptr, {});
            }
        }
        return found.count > 0;
    }

    bool collide(CollisionGroup *first, CollisionGroup *second, const CollisionOption &option, CollisionResult *result) override
    {
        enum { MOST_POINTS = 4 };
        Collisions found = begin(option, result);
        ManifoldConfig config;
        config.reduces = true;
        config.max_distance = margin_for(option, result);
        for (const auto &[a, b] : pairs_between(updated(first), updated(second))) {
            if (found.is_enough()) {
                break;
            }
            if (found.ignores(a, b)) {
                continue;
            }
            ManifoldCache cache;
            swiftprox_manifold_point points[MOST_POINTS];
            const Pose at[2] = {Pose(a->getTransform()), Pose(b->getTransform())};
            const auto met = try_manifold({a->shape, at[0]}, {b->shape, at[1]}, cache, {points, MOST_POINTS}, config);
            if (is_good(met) && met.value.point_count > 0) {
                found.add(a, b, met.value.normal, {points, met.value.point_count});
            }
        }
        return found.count > 0;
    }

    double distance(CollisionGroup *group, const DistanceOption &option, DistanceResult *result) override
    {
        return least_distance(pairs_of(updated(group)), option, result);
    }

    double distance(CollisionGroup *first, CollisionGroup *second, const DistanceOption &option, DistanceResult *result) override
    {
        return least_distance(pairs_between(updated(first), updated(second)), option, result);
    }

  protected:
    std::unique_ptr<CollisionObject> createCollisionObject(const ::dart::dynamics::ShapeFrame *frame) override
    {
        return std::make_unique<Object>(this, frame);
    }

    void refreshCollisionObject(CollisionObject *object) override
    {
        static_cast<Object *>(object)->shape = shape_of(*object->getShape());
    }

  private:
    static Group &updated(CollisionGroup *of)
    {
        Group &group = static_cast<Group &>(*of);
        group.updateEngineData();
        return group;
    }

    static Collisions begin(const CollisionOption &option, CollisionResult *result)
    {
        if (result) {
            result->clear();
        }
        return {option, result};
    }

    double margin_for(const CollisionOption &option, const CollisionResult *result) const
    {
        return option.enableContact && result ? margin_ : 0;
    }

    double margin_;
};

} // namespace detail

/**
 * A detector for worlds (World::getConstraintSolver()->setCollisionDetector) and for groups of a program's own. A group's contacts
 * are those of a scene that goes with it; of two groups, and for distances, all pairs are asked. It does not cast rays.
 *
 * Bodies that are up to `margin` apart have contacts, whose depth is then below 0. DART keeps nothing of a contact from one step to
 * the next: without a margin those at rest come and go by rounding, and a card house falls. Where no contacts are asked for, the
 * verdict is exact.
 */
inline std::shared_ptr<::dart::collision::CollisionDetector> create_detector(double margin = 0)
{
    return std::make_shared<detail::Detector>(margin);
}

} // namespace swiftprox::adapters::dart

#endif
