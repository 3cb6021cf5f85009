/*
 * FCL's collide and distance over swiftprox, for pairs of fcl::Convex, Box, Sphere and Capsule. What they are called with, and the
 * results that they fill, are FCL's; call them by their full name, for FCL's are found by their arguments. fcl_switch.hpp makes
 * calls of fcl::collide and fcl::distance be calls of these.
 *
 * FCL answers, as it did: other geometries; what swiftprox refuses, such as a NaN or a box without thickness; geometries that are
 * not occupied; requests for costs, or for no contacts.
 *
 *   contacts       normals go from o1 to o2. One contact has the full depth and is the first; more, up to four, where the request
 *                  admits more. Touching is a collision of depth 0
 *   distance       of pairs that collide: -1, or minus the depth where the request asks for signed distances
 *   nearest points always set of pairs that are apart, and of all where the request asks for signed distances
 *   tolerances     not needed: neither those of the requests nor the choice of the solver count
 *
 * A shape is made when a geometry is first seen, or is not what it was: what stands at an address is compared, so that a geometry
 * may change, or die and be followed by another. Shapes of objects' geometries stay while these live. Those of
 * geometries given by pointer are forgotten now and then, at 1,024 or later. Any number of threads may ask.
 */
#ifndef SWIFTPROX_ADAPTERS_FCL_HPP
#define SWIFTPROX_ADAPTERS_FCL_HPP

#include "../pair.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

namespace swiftprox::adapters::fcl
{

namespace detail
{

template <class S> using Geometry = ::fcl::CollisionGeometry<S>;
template <class S> using Transform = ::fcl::Transform3<S>;

/** All that makes a geometry what it is; a view of it. */
template <class S> class Content
{
  public:
    explicit Content(const Geometry<S> &geometry) : type_(geometry.getNodeType())
    {
        if (type_ == ::fcl::GEOM_CONVEX) {
            const auto &vertices = static_cast<const ::fcl::Convex<S> &>(geometry).getVertices();
            static_assert(sizeof vertices[0] == 3 * sizeof(S), "vertices are 3 numbers each");
            points_ = {vertices.data()->data(), 3 * vertices.size()};
        } else if (type_ == ::fcl::GEOM_BOX) {
            const auto &side = static_cast<const ::fcl::Box<S> &>(geometry).side;
            sizes_ = {side[0], side[1], side[2]};
        } else if (type_ == ::fcl::GEOM_SPHERE) {
            sizes_[0] = static_cast<const ::fcl::Sphere<S> &>(geometry).radius;
        } else if (type_ == ::fcl::GEOM_CAPSULE) {
            const auto &capsule = static_cast<const ::fcl::Capsule<S> &>(geometry);
            sizes_ = {capsule.radius, capsule.lz, 0};
        } else {
            is_ours_ = false;
        }
    }

    bool is_ours() const { return is_ours_; }

    /** None where swiftprox refuses it. */
    Shape make() const
    {
        const double x = sizes_[0], y = sizes_[1], z = sizes_[2];
        switch (type_) {
        case ::fcl::GEOM_BOX:
            return Shape::try_box(x / 2, y / 2, z / 2).value;
        case ::fcl::GEOM_SPHERE:
            return Shape::try_sphere(x).value;
        case ::fcl::GEOM_CAPSULE:
            return Shape::try_capsule(y / 2, x).value;
        default:
            ShapeOptions options;
            options.input = SWIFTPROX_INPUT_HULL;
            return Shape::try_from_points(std::vector<double>(points_.begin(), points_.end()), options).value;
        }
    }

    /** A content that stays when the geometry goes, with its shape. */
    struct Kept {
        Kept(const Content &content, const Shape &of, std::weak_ptr<const Geometry<S>> by)
            : type(content.type_), sizes(content.sizes_), points(content.points_.begin(), content.points_.end()), shape(of),
              owner(std::move(by))
        {
        }
        bool is(const Content &other) const
        {
            return type == other.type_ && points.size() == other.points_.size() &&
                   std::memcmp(sizes.data(), other.sizes_.data(), sizeof sizes) == 0 &&
                   (points.empty() || std::memcmp(points.data(), other.points_.data(), points.size() * sizeof(S)) == 0);
        }

        ::fcl::NODE_TYPE type;
        std::array<S, 3> sizes;
        std::vector<S> points;
        Shape shape;
        std::weak_ptr<const Geometry<S>> owner;
    };

  private:
    ::fcl::NODE_TYPE type_;
    bool is_ours_ = true;
    std::array<S, 3> sizes_{};
    Range<const S> points_;
};

/** The shapes of all geometries that were seen. */
template <class S> class Shapes
{
  public:
    /** Never destroyed: other statics of a program may ask until the end. */
    static Shapes &all()
    {
        static Shapes &shapes = *new Shapes;
        return shapes;
    }

    /** None for a geometry that FCL answers. */
    Shape of(const Geometry<S> *geometry, const std::shared_ptr<const Geometry<S>> *owner)
    {
        const Content<S> content(*geometry);
        if (!content.is_ours()) {
            return {};
        }
        {
            const std::shared_lock lock(mutex_);
            const auto at = kept_.find(geometry);
            if (at != kept_.end() && at->second.is(content)) {
                return at->second.shape;
            }
        }
        const Shape shape = content.make();
        const std::unique_lock lock(mutex_);
        make_room();
        kept_.erase(geometry);
        kept_.try_emplace(geometry, content, shape, owner ? *owner : nullptr);
        return shape;
    }

    std::size_t size() const
    {
        const std::shared_lock lock(mutex_);
        return kept_.size();
    }

  private:
    static constexpr std::size_t LEAST_ROOM = 1024;

    /** Nobody tells when a geometry without an owner dies: those go, too, and are made anew where they live. */
    void make_room()
    {
        if (kept_.size() < most_) {
            return;
        }
        for (auto at = kept_.begin(); at != kept_.end();) {
            at = at->second.owner.expired() ? kept_.erase(at) : std::next(at);
        }
        most_ = std::max(LEAST_ROOM, 2 * kept_.size());
    }

    mutable std::shared_mutex mutex_;
    std::unordered_map<const Geometry<S> *, typename Content<S>::Kept> kept_;
    std::size_t most_ = LEAST_ROOM;
};

template <class S> ::fcl::Vector3<S> vector_of(const double *v)
{
    return ::fcl::Vector3<double>(v[0], v[1], v[2]).template cast<S>();
}

/** Which of two geometries collide where. */
template <class S> struct Contacts {
    const Geometry<S> *o1, *o2;
    ::fcl::CollisionResult<S> &result;

    void add() { result.addContact({o1, o2, ::fcl::Contact<S>::NONE, ::fcl::Contact<S>::NONE}); }

    /** Our normals go from 2 to 1. */
    void add(const double *world1, const double *world2, const double *normal, double gap)
    {
        const double middle[3] = {(world1[0] + world2[0]) / 2, (world1[1] + world2[1]) / 2, (world1[2] + world2[2]) / 2};
        result.addContact({o1, o2, ::fcl::Contact<S>::NONE, ::fcl::Contact<S>::NONE, vector_of<S>(middle), -vector_of<S>(normal),
                           static_cast<S>(-gap)});
    }
};

/** Adds up to `most` contacts; whether swiftprox could answer. */
template <class S> bool find_contacts(const Placed &a, const Placed &b, std::size_t most, Contacts<S> contacts)
{
    ManifoldCache cache;
    if (most == 1) {
        PairConfig config;
        config.max_distance = 0;
        const auto found = try_signed_distance(a, b, cache, config);
        if (found && found.value.outcome == SWIFTPROX_OUTCOME_INTERSECTING) {
            contacts.add(found.value.world1, found.value.world2, found.value.normal, found.value.distance);
        }
        return static_cast<bool>(found);
    }
    ManifoldConfig config;
    config.reduces = true;
    std::array<swiftprox_manifold_point, 4> points;
    const auto found = try_manifold(a, b, cache, points, config);
    const auto end = points.begin() + found.value.point_count;
    const auto enough = points.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(most, found.value.point_count));
    std::partial_sort(points.begin(), enough, end, [](const auto &one, const auto &other) { return gap(one) < gap(other); });
    for (auto point = points.begin(); point != enough; ++point) {
        contacts.add(point->world1, point->world2, found.value.normal, gap(*point));
    }
    return static_cast<bool>(found);
}

/** A geometry where it is, and who owns it where that is known. */
template <class S> struct Body {
    const Geometry<S> *geometry;
    const Transform<S> &at;
    const std::shared_ptr<const Geometry<S>> *owner = nullptr;

    explicit Body(const ::fcl::CollisionObject<S> &object)
        : geometry(object.collisionGeometry().get()), at(object.getTransform()), owner(&object.collisionGeometry())
    {
    }
    Body(const Geometry<S> *of, const Transform<S> &where) : geometry(of), at(where) {}
    Shape shape() const { return Shapes<S>::all().of(geometry, owner); }
};

template <class S>
std::size_t collide(const Body<S> &o1, const Body<S> &o2, const ::fcl::CollisionRequest<S> &request,
                    ::fcl::CollisionResult<S> &result)
{
    if (request.isSatisfied(result)) {
        return result.numContacts();
    }
    const auto by_fcl = [&] { return ::fcl::collide<S>(o1.geometry, o1.at, o2.geometry, o2.at, request, result); };
    if (request.enable_cost || request.num_max_contacts == 0 || !o1.geometry->isOccupied() || !o2.geometry->isOccupied()) {
        return by_fcl();
    }
    const Shape shape1 = o1.shape(), shape2 = o2.shape();
    if (!shape1 || !shape2) {
        return by_fcl();
    }
    const Placed a(shape1, Pose(o1.at)), b(shape2, Pose(o2.at));
    Contacts<S> contacts{o1.geometry, o2.geometry, result};
    if (request.enable_contact) {
        if (!find_contacts(a, b, request.num_max_contacts - result.numContacts(), contacts)) {
            return by_fcl();
        }
    } else {
        PairCache cache;
        const auto met = try_intersect(a, b, cache);
        if (!met) {
            return by_fcl();
        }
        if (met.value) {
            contacts.add();
        }
    }
    if (request.enable_cached_gjk_guess) {
        result.cached_gjk_guess = request.cached_gjk_guess;
    }
    return result.numContacts();
}

template <class S>
S distance(const Body<S> &o1, const Body<S> &o2, const ::fcl::DistanceRequest<S> &request, ::fcl::DistanceResult<S> &result)
{
    if (request.isSatisfied(result)) {
        return result.min_distance;
    }
    const auto by_fcl = [&] { return ::fcl::distance<S>(o1.geometry, o1.at, o2.geometry, o2.at, request, result); };
    const Shape shape1 = o1.shape(), shape2 = o2.shape();
    if (!shape1 || !shape2) {
        return by_fcl();
    }
    const Placed a(shape1, Pose(o1.at)), b(shape2, Pose(o2.at));
    // Of a pair that is farther apart than another one before it, no more need be known.
    PairConfig config;
    config.max_distance = static_cast<double>(result.min_distance);
    const auto update = [&](double distance, const double *world1, const double *world2) {
        result.update(static_cast<S>(distance), o1.geometry, o2.geometry, result.NONE, result.NONE, vector_of<S>(world1),
                      vector_of<S>(world2));
    };
    if (request.enable_signed_distance) {
        ManifoldCache cache;
        const auto found = try_signed_distance(a, b, cache, config);
        if (!found) {
            return by_fcl();
        }
        if (found.value.outcome != SWIFTPROX_OUTCOME_BEYOND) {
            update(found.value.distance, found.value.world1, found.value.world2);
        }
        return result.min_distance;
    }
    PairCache cache;
    const auto found = try_distance(a, b, cache, config);
    if (!found) {
        return by_fcl();
    }
    if (found.value.outcome == SWIFTPROX_OUTCOME_INTERSECTING) {
        const double nowhere[3] = {};
        update(-1, nowhere, nowhere);
    } else if (found.value.outcome == SWIFTPROX_OUTCOME_SEPARATED) {
        update(found.value.distance, found.value.world1, found.value.world2);
    }
    return result.min_distance;
}

} // namespace detail

/** fcl::collide of two objects. */
template <class S>
std::size_t collide(const ::fcl::CollisionObject<S> *o1, const ::fcl::CollisionObject<S> *o2,
                    const ::fcl::CollisionRequest<S> &request, ::fcl::CollisionResult<S> &result)
{
    return detail::collide(detail::Body<S>(*o1), detail::Body<S>(*o2), request, result);
}
/** fcl::collide of two geometries where they are. */
template <class S>
std::size_t collide(const ::fcl::CollisionGeometry<S> *o1, const ::fcl::Transform3<S> &tf1, const ::fcl::CollisionGeometry<S> *o2,
                    const ::fcl::Transform3<S> &tf2, const ::fcl::CollisionRequest<S> &request, ::fcl::CollisionResult<S> &result)
{
    return detail::collide(detail::Body<S>(o1, tf1), detail::Body<S>(o2, tf2), request, result);
}
/** fcl::distance of two objects. */
template <class S>
S distance(const ::fcl::CollisionObject<S> *o1, const ::fcl::CollisionObject<S> *o2, const ::fcl::DistanceRequest<S> &request,
           ::fcl::DistanceResult<S> &result)
{
    return detail::distance(detail::Body<S>(*o1), detail::Body<S>(*o2), request, result);
}
/** fcl::distance of two geometries where they are. */
template <class S>
S distance(const ::fcl::CollisionGeometry<S> *o1, const ::fcl::Transform3<S> &tf1, const ::fcl::CollisionGeometry<S> *o2,
           const ::fcl::Transform3<S> &tf2, const ::fcl::DistanceRequest<S> &request, ::fcl::DistanceResult<S> &result)
{
    return detail::distance(detail::Body<S>(o1, tf1), detail::Body<S>(o2, tf2), request, result);
}

} // namespace swiftprox::adapters::fcl

#endif
