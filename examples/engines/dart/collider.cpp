#include "collider.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <assimp/scene.h>
#include <dart/collision/CollisionFilter.hpp>
#include <dart/collision/CollisionGroup.hpp>
#include <dart/collision/CollisionObject.hpp>
#include <dart/collision/DistanceFilter.hpp>
#include <dart/common/Console.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/CapsuleShape.hpp>
#include <dart/dynamics/MeshShape.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <swiftprox.hpp>

namespace
{

using namespace dart::collision;

Eigen::Vector3d vector_of(const double *v)
{
    return Eigen::Vector3d(v[0], v[1], v[2]);
}

// No shape for what is neither box nor sphere, capsule or mesh.
swiftprox::Shape shape_of(const dart::dynamics::Shape &shape)
{
    swiftprox::ShapeOptions options;
    options.input = SWIFTPROX_INPUT_HULL;
    std::vector<double> points;
    if (const auto *box = dynamic_cast<const dart::dynamics::BoxShape *>(&shape)) {
        const Eigen::Vector3d half = 0.5 * box->getSize();
        for (int corner = 0; corner < 8; ++corner) {
            for (int k = 0; k < 3; ++k) {
                points.push_back(corner >> k & 1 ? half[k] : -half[k]);
            }
        }
    } else if (const auto *sphere = dynamic_cast<const dart::dynamics::SphereShape *>(&shape)) {
        points = {0, 0, 0};
        options.swept_radius = sphere->getRadius();
    } else if (const auto *capsule = dynamic_cast<const dart::dynamics::CapsuleShape *>(&shape)) {
        const double half = 0.5 * capsule->getHeight();
        points = {0, 0, -half, 0, 0, half};
        options.swept_radius = capsule->getRadius();
    } else if (const auto *mesh = dynamic_cast<const dart::dynamics::MeshShape *>(&shape)) {
        const aiScene &from = *mesh->getMesh();
        for (unsigned part = 0; part < from.mNumMeshes; ++part) {
            for (unsigned i = 0; i < from.mMeshes[part]->mNumVertices; ++i) {
                const aiVector3D &vertex = from.mMeshes[part]->mVertices[i];
                for (unsigned k = 0; k < 3; ++k) {
                    points.push_back(mesh->getScale()[k] * double(vertex[k]));
                }
            }
        }
    } else {
        dtwarn << "[swiftprox] a shape of type " << shape.getType() << " is not tested.\n";
        return {};
    }
    return swiftprox::Shape::from_points(points, options);
}

struct Object final : CollisionObject {
    Object(CollisionDetector *detector, const dart::dynamics::ShapeFrame *frame)
        : CollisionObject(detector, frame), shape(shape_of(*getShape()))
    {
    }
    void updateEngineData() override {}

    swiftprox::Shape shape;
};

// Objects, and a scene with one for each that has a shape.
class Group final : public CollisionGroup
{
  public:
    using CollisionGroup::CollisionGroup;
    using CollisionGroup::updateEngineData;

    const std::vector<Object *> &objects() const { return objects_; }
    swiftprox::Scene &scene() { return scene_; }

  protected:
    void initializeEngineData() override {}

    void addCollisionObjectToEngine(CollisionObject *added) override
    {
        const auto object = static_cast<Object *>(added);
        if (object->shape) {
            swiftprox::ObjectOptions options;
            options.user_data = reinterpret_cast<std::uintptr_t>(object);
            options.pose = swiftprox::Pose(object->getTransform());
            ids_.push_back(scene_.add(object->shape, options));
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
            scene_.remove_object(*id);
            ids_.erase(id);
            objects_.erase(at);
        }
    }

    void removeAllCollisionObjectsFromEngine() override
    {
        scene_.remove_objects(ids_);
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
        if (!scene_.try_set_poses(ids_, poses_)) {
            dtwarn << "[swiftprox] " << swiftprox_library_last_error_message() << "\n";
        }
    }

  private:
    swiftprox::Scene scene_;
    std::vector<Object *> objects_;
    std::vector<swiftprox_object_id> ids_; // of the objects, in their order
    std::vector<swiftprox::Pose> poses_;
};

// What a check of collisions has found so far, as far as it was asked for.
struct Collisions {
    const CollisionOption &option;
    CollisionResult *result;
    std::size_t count = 0;

    bool is_enough() const { return count >= option.maxNumContacts || (!result && count > 0); }

    bool ignores(const Object *a, const Object *b) const
    {
        return option.collisionFilter && option.collisionFilter->ignoresCollision(a, b);
    }

    void add(Object *a, Object *b, const double *normal, swiftprox::Range<const swiftprox_manifold_point> points)
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
            contact.penetrationDepth = -swiftprox::gap(point);
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

Pairs pairs_of(const Group &group)
{
    Pairs pairs;
    for (auto b = group.objects().begin(); b != group.objects().end(); ++b) {
        for (auto a = group.objects().begin(); a != b; ++a) {
            pairs.emplace_back(*a, *b);
        }
    }
    return pairs;
}

Pairs pairs_between(const Group &first, const Group &second)
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

// The least signed distance: from 0 down it is minus the depth.
double least_distance(const Pairs &pairs, const DistanceOption &option, DistanceResult *result)
{
    if (result) {
        result->clear();
    }
    double least = std::numeric_limits<double>::infinity();
    for (const auto &[a, b] : pairs) {
        if (option.distanceFilter && !option.distanceFilter->needDistance(a, b)) {
            continue;
        }
        swiftprox::PairConfig config;
        config.max_distance = std::max(least, 0.0);
        swiftprox::ManifoldCache cache;
        const swiftprox::Pose at[2] = {swiftprox::Pose(a->getTransform()), swiftprox::Pose(b->getTransform())};
        const auto found = swiftprox::signed_distance({a->shape, at[0]}, {b->shape, at[1]}, cache, config);
        if (found.outcome == SWIFTPROX_OUTCOME_BEYOND || !(found.distance < least)) {
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

    std::shared_ptr<CollisionDetector> cloneWithoutCollisionObjects() const override { return collider_create(margin_); }

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
        swiftprox::SceneQuery query;
        query.max_distance = margin_for(option, result);
        query.detail = option.enableContact ? SWIFTPROX_CONTACT_DETAIL_REDUCED_MANIFOLD : SWIFTPROX_CONTACT_DETAIL_NONE;
        const swiftprox_scene_answer answer = group.scene().query_contact(query);
        for (std::size_t i = 0; i < answer.count && !found.is_enough(); ++i) {
            const auto a = reinterpret_cast<Object *>(static_cast<std::uintptr_t>(answer.pairs[i].user_data1));
            const auto b = reinterpret_cast<Object *>(static_cast<std::uintptr_t>(answer.pairs[i].user_data2));
            if (found.ignores(a, b)) {
                continue;
            }
            if (option.enableContact) {
                found.add(a, b, answer.contacts[i].manifold.normal, swiftprox::points(answer, answer.contacts[i]));
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
        swiftprox::ManifoldConfig config;
        config.reduces = true;
        config.max_distance = margin_for(option, result);
        for (const auto &[a, b] : pairs_between(updated(first), updated(second))) {
            if (found.is_enough()) {
                break;
            }
            if (found.ignores(a, b)) {
                continue;
            }
            swiftprox::ManifoldCache cache;
            swiftprox_manifold_point points[MOST_POINTS];
            const swiftprox::Pose at[2] = {swiftprox::Pose(a->getTransform()), swiftprox::Pose(b->getTransform())};
            const auto manifold = swiftprox::manifold({a->shape, at[0]}, {b->shape, at[1]}, cache, {points, MOST_POINTS}, config);
            if (manifold.point_count > 0) {
                found.add(a, b, manifold.normal, {points, manifold.point_count});
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
    std::unique_ptr<CollisionObject> createCollisionObject(const dart::dynamics::ShapeFrame *frame) override
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

} // namespace

std::shared_ptr<dart::collision::CollisionDetector> collider_create(double margin)
{
    return std::make_shared<Detector>(margin);
}
