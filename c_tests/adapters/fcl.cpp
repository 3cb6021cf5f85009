/* swiftprox/adapters/fcl.hpp beside the library asked directly, bit by bit, and beside FCL within its tolerance; geometries that
 * change and die; threads. */
#include <swiftprox/adapters/fcl.hpp>
#include <swiftprox/adapters/fcl_switch.hpp>

#include "check.h"

#include <cmath>
#include <memory>
#include <new>
#include <random>
#include <thread>

#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/cylinder.h>

namespace ours = swiftprox::adapters::fcl;
using swiftprox::Pose;
using swiftprox::Shape;

namespace
{

std::mt19937 numbers(1);

double uniform(double low, double high)
{
    return std::uniform_real_distribution<double>(low, high)(numbers);
}

std::array<double, 3> direction()
{
    std::normal_distribution<double> normal;
    const double x = normal(numbers), y = normal(numbers), z = normal(numbers), length = std::sqrt(x * x + y * y + z * z);
    return {x / length, y / length, z / length};
}

template <class S> fcl::Transform3<S> pose_within(double reach)
{
    const auto axis = direction(), to = direction();
    const double angle = uniform(0, 3), far = uniform(0, reach);
    fcl::Transform3<S> pose = fcl::Transform3<S>::Identity();
    const fcl::Vector3<S> about{S(axis[0]), S(axis[1]), S(axis[2])};
    pose.linear() = fcl::AngleAxis<S>(S(angle), about.normalized()).toRotationMatrix();
    pose.translation() = fcl::Vector3<S>(S(far * to[0]), S(far * to[1]), S(far * to[2]));
    return pose;
}

/* FCL walks over edges, so that it gets the hull's triangles. */
template <class S> std::shared_ptr<fcl::Convex<S>> convex_of(const Shape &hull)
{
    const std::vector<double> points = hull.vertices();
    const std::vector<std::uint32_t> corners = hull.triangles();
    const auto vertices = std::make_shared<std::vector<fcl::Vector3<S>>>();
    for (std::size_t i = 0; i < points.size(); i += 3) {
        vertices->emplace_back(S(points[i]), S(points[i + 1]), S(points[i + 2]));
    }
    const auto faces = std::make_shared<std::vector<int>>();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i % 3 == 0) {
            faces->push_back(3);
        }
        faces->push_back(static_cast<int>(corners[i]));
    }
    return std::make_shared<fcl::Convex<S>>(vertices, static_cast<int>(corners.size() / 3), faces);
}

/* A geometry of FCL's and the same of ours, made here. */
template <class S> struct Body {
    std::shared_ptr<fcl::CollisionGeometry<S>> geometry;
    Shape shape;
};

enum Kind { CONVEX, BOX, SPHERE, CAPSULE, KIND_COUNT };

template <class S> Body<S> body_of(int kind)
{
    const S x = S(uniform(0.2, 1)), y = S(uniform(0.2, 1)), z = S(uniform(0.2, 1));
    switch (kind) {
    case BOX:
        return {std::make_shared<fcl::Box<S>>(2 * x, 2 * y, 2 * z), Shape::box(x, y, z)};
    case SPHERE:
        return {std::make_shared<fcl::Sphere<S>>(x), Shape::sphere(x)};
    case CAPSULE:
        return {std::make_shared<fcl::Capsule<S>>(x, 2 * y), Shape::capsule(y, x)};
    default:
        std::vector<double> points;
        for (int count = 8 + int(uniform(0, 32)); count > 0; --count) {
            for (const double coordinate : direction()) {
                points.push_back(S(coordinate));
            }
        }
        const auto convex = convex_of<S>(Shape::from_points(points));
        points.clear();
        for (const auto &vertex : convex->getVertices()) {
            points.insert(points.end(), {double(vertex[0]), double(vertex[1]), double(vertex[2])});
        }
        swiftprox::ShapeOptions options;
        options.input = SWIFTPROX_INPUT_HULL;
        return {convex, Shape::from_points(points, options)};
    }
}

template <class S> bool same(const fcl::Vector3<S> &v, const double *of)
{
    return v[0] == S(of[0]) && v[1] == S(of[1]) && v[2] == S(of[2]);
}

/* Two bodies where they are, and what both libraries say. */
template <class S> struct Pair {
    Body<S> a, b;
    fcl::Transform3<S> at1, at2;

    fcl::CollisionResult<S> collide(std::size_t most, bool with_contacts) const
    {
        fcl::CollisionResult<S> result;
        const std::size_t count = ours::collide(a.geometry.get(), at1, b.geometry.get(), at2,
                                                fcl::CollisionRequest<S>(most, with_contacts), result);
        CHECK(count == result.numContacts());
        return result;
    }
    fcl::DistanceResult<S> distance(bool is_signed) const
    {
        fcl::DistanceResult<S> result;
        const fcl::DistanceRequest<S> request(true, is_signed);
        const S returned = ours::distance(a.geometry.get(), at1, b.geometry.get(), at2, request, result);
        CHECK(returned == result.min_distance);
        return result;
    }
};

/* What is said is what the library says. Returns the signed distance. */
template <class S> double check_direct(const Pair<S> &pair)
{
    const swiftprox::Placed a(pair.a.shape, Pose(pair.at1)), b(pair.b.shape, Pose(pair.at2));
    swiftprox::PairCache cache;
    swiftprox::ManifoldCache signed_cache, manifold_cache;
    const auto apart = swiftprox::distance(a, b, cache);
    const auto exact = swiftprox::signed_distance(a, b, signed_cache);
    const bool collides = apart.outcome == SWIFTPROX_OUTCOME_INTERSECTING;

    const auto plain = pair.distance(false), signed_distance = pair.distance(true);
    CHECK(plain.min_distance == (collides ? S(-1) : S(apart.distance)));
    CHECK(plain.o1 == pair.a.geometry.get() && plain.o2 == pair.b.geometry.get() && plain.b1 == -1 && plain.b2 == -1);
    CHECK(collides || (same(plain.nearest_points[0], apart.world1) && same(plain.nearest_points[1], apart.world2)));
    CHECK(signed_distance.min_distance == S(exact.distance) && same(signed_distance.nearest_points[0], exact.world1) &&
          same(signed_distance.nearest_points[1], exact.world2));

    const auto met = pair.collide(1, false), one = pair.collide(1, true), more = pair.collide(9, true);
    CHECK(met.numContacts() == (collides ? 1 : 0) && one.isCollision() == collides && more.isCollision() == collides);
    if (collides) {
        swiftprox::ManifoldConfig config;
        config.reduces = true;
        std::array<swiftprox_manifold_point, 4> points;
        const auto manifold = swiftprox::manifold(a, b, manifold_cache, points, config);
        CHECK(more.numContacts() == manifold.point_count);
        const auto &first = one.getContact(0);
        const double opposite[3] = {-exact.normal[0], -exact.normal[1], -exact.normal[2]};
        CHECK(same(first.normal, opposite) && first.penetration_depth == S(-exact.distance));
        CHECK(first.o1 == pair.a.geometry.get() && first.o2 == pair.b.geometry.get());
        CHECK(std::fabs(more.getContact(0).penetration_depth - first.penetration_depth) <= S(1e-6));
        for (std::size_t i = 1; i < more.numContacts(); ++i) {
            CHECK(more.getContact(i - 1).penetration_depth >= more.getContact(i).penetration_depth);
        }
        CHECK(pair.collide(2, true).numContacts() == std::min<std::size_t>(2, more.numContacts()));
    }
    return exact.distance;
}

int round_count, round_near_count;

/* FCL's tolerance is 1e-6. Of round bodies its distances come from above, and end where a step changes less, however far off. */
void check_beside_fcl(const Pair<double> &pair, double exact)
{
    constexpr double TOLERANCE = 1e-6;
    const auto is_round = [](const Body<double> &body) {
        return body.geometry->getNodeType() == fcl::GEOM_SPHERE || body.geometry->getNodeType() == fcl::GEOM_CAPSULE;
    };
    fcl::DistanceResultd theirs;
    const fcl::DistanceRequestd request(true, true);
    fcl::distance<double>(pair.a.geometry.get(), pair.at1, pair.b.geometry.get(), pair.at2, request, theirs);
    const double above = theirs.min_distance - exact;
    CHECK(above >= -TOLERANCE);
    if (exact <= 0 || !(is_round(pair.a) || is_round(pair.b))) {
        CHECK(above <= TOLERANCE);
    } else {
        ++round_count;
        round_near_count += above <= 1e-4;
    }
    const auto collides = [&](const fcl::Transform3d &at2) {
        fcl::CollisionResultd result;
        fcl::collide<double>(pair.a.geometry.get(), pair.at1, pair.b.geometry.get(), at2, fcl::CollisionRequestd(), result);
        return result.isCollision();
    };
    if (std::fabs(exact) > 2 * TOLERANCE) {
        CHECK(collides(pair.at2) == (exact < 0));
    }
    if (exact >= 0) {
        return;
    }
    // FCL's normals go from o1 to o2: along it FCL's verdict, too, ends at the depth.
    const auto result = pair.collide(1, true);
    const auto &contact = result.getContact(0);
    const auto moved = [&](double by) { return fcl::Translation3d(by * contact.normal) * pair.at2; };
    CHECK(collides(moved(contact.penetration_depth - 1e-4)) && !collides(moved(contact.penetration_depth + 1e-4)));
    CHECK(collides(moved(-contact.penetration_depth - 1e-4)));
    fcl::CollisionResultd by_fcl;
    fcl::collide<double>(pair.a.geometry.get(), pair.at1, pair.b.geometry.get(), pair.at2, fcl::CollisionRequestd(1, true), by_fcl);
    // FCL's own normal need not be that of the depth, but for spheres.
    if (pair.a.geometry->getNodeType() == fcl::GEOM_SPHERE && pair.b.geometry->getNodeType() == fcl::GEOM_SPHERE) {
        CHECK((by_fcl.getContact(0).normal - contact.normal).norm() < 1e-9);
    } else if (contact.penetration_depth > 0.01 && contact.penetration_depth < 0.1) {
        CHECK(by_fcl.getContact(0).normal.dot(contact.normal) > 0);
    }
}

void test_random_pairs()
{
    int apart = 0, together = 0;
    for (int i = 0; i < 4000; ++i) {
        const int kind1 = i % KIND_COUNT, kind2 = i / KIND_COUNT % KIND_COUNT;
        const Pair<double> pair{body_of<double>(kind1), body_of<double>(kind2), pose_within<double>(2), pose_within<double>(2)};
        const double exact = check_direct(pair);
        check_beside_fcl(pair, exact);
        ++(exact > 0 ? apart : together);
        const Pair<float> narrow{body_of<float>(kind1), body_of<float>(kind2), pose_within<float>(2), pose_within<float>(2)};
        check_direct(narrow);
    }
    CHECK(apart > 500 && together > 500);
    CHECK(round_near_count > 0.98 * round_count);
}

const fcl::Transform3d HERE = fcl::Transform3d::Identity();

fcl::Transform3d at(double x)
{
    fcl::Transform3d pose = HERE;
    pose.translation()[0] = x;
    return pose;
}

double distance_of(const fcl::CollisionGeometryd &a, const fcl::CollisionGeometryd &b, double x)
{
    fcl::DistanceResultd result;
    return ours::distance(&a, HERE, &b, at(x), fcl::DistanceRequestd(), result);
}

/* What stands at an address counts, whatever stood there; what is gone makes room. */
void test_lifetimes()
{
    const fcl::Sphered ball(1);
    alignas(fcl::Boxd) unsigned char memory[sizeof(fcl::Boxd)];
    static_assert(sizeof(fcl::Sphered) <= sizeof memory && alignof(fcl::Sphered) <= alignof(fcl::Boxd));
    static_assert(sizeof(fcl::Capsuled) <= sizeof memory && alignof(fcl::Capsuled) <= alignof(fcl::Boxd));
    fcl::Boxd *box = new (memory) fcl::Boxd(2, 2, 2);
    CHECK(distance_of(*box, ball, 8) == 6);
    box->~Box();
    box = new (memory) fcl::Boxd(4, 2, 2);
    CHECK(distance_of(*box, ball, 8) == 5);
    box->side[0] = 6;
    CHECK(distance_of(*box, ball, 8) == 4);
    box->~Box();
    fcl::Sphered *const sphere = new (memory) fcl::Sphered(4);
    CHECK(distance_of(*sphere, ball, 8) == 3);
    sphere->~Sphere();
    // The same numbers, of another kind: FCL answers boxes without thickness.
    fcl::Capsuled *const capsule = new (memory) fcl::Capsuled(1, 2);
    CHECK(distance_of(*capsule, ball, 8) == 6);
    capsule->~Capsule();
    box = new (memory) fcl::Boxd(1, 2, 0);
    CHECK(std::fabs(distance_of(*box, ball, 8) - 6.5) < 1e-6);
    box->~Box();

    // The allocator gives the next the memory of the last, and the program may edit the vertices that it shares with FCL.
    const Shape cube = Shape::box(1, 1, 1);
    for (int i = 0; i < 1000; ++i) {
        const auto convex = convex_of<double>(Shape::box(1 + i, 1, 1));
        CHECK(distance_of(*convex, ball, 2000) == 1998 - i);
    }
    const auto convex = convex_of<double>(cube);
    for (auto &vertex : const_cast<std::vector<fcl::Vector3d> &>(convex->getVertices())) {
        vertex *= 2;
    }
    CHECK(distance_of(*convex, ball, 8) == 5);

    const auto &all = ours::detail::Shapes<double>::all();
    const auto by_object = [&](const std::shared_ptr<fcl::CollisionGeometryd> &geometry) {
        const fcl::CollisionObjectd object(geometry, HERE), other(std::make_shared<fcl::Sphered>(1), at(3));
        fcl::DistanceResultd result;
        return ours::distance(&object, &other, fcl::DistanceRequestd(), result);
    };
    std::vector<std::shared_ptr<fcl::Sphered>> balls;
    for (int i = 0; i < 5000; ++i) {
        balls.push_back(std::make_shared<fcl::Sphered>(1));
        CHECK(distance_of(*balls.back(), ball, 3) == 1 && all.size() <= 1024);
    }
    // As many as live, or twice as many.
    for (const auto &each : balls) {
        CHECK(by_object(each) == 1);
    }
    CHECK(all.size() > balls.size());
    balls.clear();
    for (int i = 0; i < 20000; ++i) {
        balls.push_back(std::make_shared<fcl::Sphered>(1));
        CHECK(by_object(balls.back()) == 1);
        balls.erase(balls.begin(), balls.end() - std::min<std::ptrdiff_t>(100, std::ptrdiff_t(balls.size())));
    }
    CHECK(all.size() <= 1024);
}

/* What is not ours is FCL's. */
void test_passed_on()
{
    using Geometry = fcl::CollisionGeometryd;
    const auto by_both = [](const Geometry &a, const Geometry &b, const fcl::CollisionRequestd &request) {
        fcl::CollisionResultd mine, theirs;
        ours::collide(&a, HERE, &b, at(1), request, mine);
        fcl::collide<double>(&a, HERE, &b, at(1), request, theirs);
        CHECK(mine.numContacts() == theirs.numContacts() && mine.numCostSources() == theirs.numCostSources());
        for (std::size_t i = 0; request.enable_contact && i < theirs.numContacts(); ++i) {
            CHECK(mine.getContact(i).normal == theirs.getContact(i).normal && mine.getContact(i).pos == theirs.getContact(i).pos);
        }
        return theirs.numContacts() + theirs.numCostSources();
    };
    const fcl::Cylinderd cylinder(1, 2);
    fcl::Boxd box(1.5, 2, 2), flat(2, 2, 0);
    CHECK(by_both(cylinder, box, fcl::CollisionRequestd(4, true)) == 1);
    CHECK(by_both(flat, box, fcl::CollisionRequestd(8, true)) == 0); // FCL sees nothing in a box without thickness
    CHECK(by_both(box, box, fcl::CollisionRequestd(8, true, 1, true)) > 1);
    CHECK(by_both(box, box, fcl::CollisionRequestd(0, true)) == 0);
    fcl::DistanceResultd result;
    CHECK(ours::distance(&cylinder, HERE, &box, at(4), fcl::DistanceRequestd(), result) ==
          fcl::distance<double>(&cylinder, HERE, &box, at(4), fcl::DistanceRequestd(), *std::make_unique<fcl::DistanceResultd>()));
    // FCL answers a pose that is none, too, with whatever it makes of it.
    fcl::Transform3d none = HERE;
    none.linear() *= 2;
    fcl::CollisionResultd mine, theirs;
    ours::collide(&box, HERE, &box, none, fcl::CollisionRequestd(1, true), mine);
    fcl::collide<double>(&box, HERE, &box, none, fcl::CollisionRequestd(1, true), theirs);
    CHECK(mine.numContacts() == theirs.numContacts() && mine.getContact(0).pos == theirs.getContact(0).pos);
    box.threshold_occupied = 2;
    CHECK(by_both(box, cylinder, fcl::CollisionRequestd()) == 0 && by_both(box, flat, fcl::CollisionRequestd()) == 0);
    CHECK(by_both(box, fcl::Sphered(1), fcl::CollisionRequestd()) == 0);
}

/* Results that are passed from pair to pair, as broad phases do. */
void test_results_add_up()
{
    const fcl::Boxd box(2, 2, 2);
    fcl::DistanceResultd least;
    const auto ask = [&](double x, bool is_signed) {
        return ours::distance(&box, HERE, &box, at(x), fcl::DistanceRequestd(true, is_signed), least);
    };
    CHECK(ask(5, false) == 3 && ask(4, true) == 2 && ask(6, false) == 2 && ask(9, true) == 2 && least.nearest_points[1][0] == 3);
    CHECK(ask(2.5, false) == 0.5 && ask(1.5, true) == -0.5 && ask(1, true) == -0.5 && least.nearest_points[1][0] == 0.5);
    fcl::CollisionResultd result;
    const auto collide = [&](double x, std::size_t most) {
        return ours::collide(&box, HERE, &box, at(x), fcl::CollisionRequestd(most, true), result);
    };
    CHECK(collide(3, 6) == 0 && collide(1.5, 6) == 4 && collide(1.75, 6) == 6 && collide(1, 6) == 6);
    CHECK(collide(1.5, 2) == 6 && ours::collide(&box, HERE, &box, at(1), fcl::CollisionRequestd(), result) == 6);
    CHECK(result.getContact(0).penetration_depth == 0.5 && result.getContact(5).penetration_depth == 0.25);
    CHECK(result.getContact(0).normal == fcl::Vector3d(1, 0, 0) && result.getContact(0).pos[0] == 0.75);
    result.clear();
    CHECK(collide(2, 6) == 4 && result.getContact(0).penetration_depth == 0);
    result.clear();
    CHECK(collide(std::nextafter(2.0, 3.0), 6) == 0);
    fcl::CollisionRequestd guess;
    guess.enable_cached_gjk_guess = true;
    guess.cached_gjk_guess = fcl::Vector3d(1, 2, 3);
    ours::collide(&box, HERE, &box, at(1), guess, result);
    CHECK(result.cached_gjk_guess == guess.cached_gjk_guess);
}

/* fcl_switch.hpp: by whichever name, the answers are ours. FCL has one contact of two hulls, and its distances of balls are off.
 * Only what names the scalar is FCL's. */
template <class S> void test_switch()
{
    const auto cube = convex_of<S>(Shape::box(1, 1, 1));
    const auto ball = std::make_shared<fcl::Sphere<S>>(S(0.7));
    fcl::Transform3<S> beside = fcl::Transform3<S>::Identity(), off = beside;
    beside.translation()[0] = S(1.5);
    off.translation() = fcl::Vector3<S>(S(2.1), S(1.3), S(1.2));
    fcl::CollisionObject<S> a(cube), b(cube, beside), c(ball, off);
    const fcl::CollisionRequest<S> request(8, true);
    const auto count = [&](auto &&collide_into) {
        fcl::CollisionResult<S> result;
        collide_into(result);
        return result.numContacts();
    };
    CHECK(count([&](auto &result) { fcl::collide<S>(&a, &b, request, result); }) == 1);
    CHECK(count([&](auto &result) { ours::collide(&a, &b, request, result); }) == 4);
    CHECK(count([&](auto &result) { fcl::collide(&a, &b, request, result); }) == 4);
    CHECK(count([&](auto &result) { collide(&a, &b, request, result); }) == 4);
    CHECK(count([&](auto &result) { fcl::collide(cube.get(), a.getTransform(), cube.get(), beside, request, result); }) == 4);
    CHECK(count([&](auto &result) {
              using namespace fcl;
              collide(&a, &b, request, result);
          }) == 4);
    // The callbacks of broad phases are templates, and find the function where they are made.
    fcl::DefaultCollisionData<S> data;
    data.request = request;
    fcl::DefaultCollisionFunction<S>(&a, &b, &data);
    CHECK(data.result.numContacts() == 4);

    const fcl::DistanceRequest<S> nearest(true);
    const auto least = [&](auto &&ask) {
        fcl::DistanceResult<S> result;
        return ask(result);
    };
    const S exact = least([&](auto &result) { return ours::distance(&a, &c, nearest, result); });
    CHECK(std::fabs(exact - (std::hypot(S(1.1), S(0.3), S(0.2)) - S(0.7))) < 4 * std::numeric_limits<S>::epsilon());
    CHECK(least([&](auto &result) { return fcl::distance<S>(&a, &c, nearest, result); }) != exact);
    CHECK(least([&](auto &result) { return fcl::distance(&a, &c, nearest, result); }) == exact);
    CHECK(least([&](auto &result) { return distance(&a, &c, nearest, result); }) == exact);
    CHECK(least([&](auto &result) {
              return fcl::distance(cube.get(), a.getTransform(), ball.get(), off, nearest, result);
          }) == exact);
}

/* Threads ask about the same geometries, and about some that come and go. */
void test_threads()
{
    enum { THREADS = 4, BODIES = 24, ROUNDS = 10 };
    std::vector<Body<double>> bodies;
    std::vector<fcl::Transform3d> poses;
    for (int i = 0; i < BODIES; ++i) {
        bodies.push_back(body_of<double>(i % KIND_COUNT));
        poses.push_back(pose_within<double>(2));
    }
    const auto all = [&] {
        std::vector<double> found;
        for (std::size_t i = 0; i < BODIES; ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                const auto *const a = bodies[i].geometry.get(), *const b = bodies[k].geometry.get();
                fcl::DistanceResultd result;
                found.push_back(ours::distance(a, poses[i], b, poses[k], fcl::DistanceRequestd(true, true), result));
            }
        }
        return found;
    };
    std::vector<std::thread> threads;
    std::vector<std::vector<double>> found[THREADS];
    std::atomic<int> wrong{0};
    for (auto &mine : found) {
        threads.emplace_back([&] {
            const fcl::Sphered ball(1);
            for (int round = 0; round < ROUNDS; ++round) {
                for (int i = 1; i < 20; ++i) {
                    wrong += distance_of(*std::make_unique<fcl::Sphered>(i), ball, 100) != 99 - i;
                }
                mine.push_back(all());
            }
        });
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
    const std::vector<double> expected = all();
    for (const auto &mine : found) {
        for (const auto &round : mine) {
            CHECK(round == expected);
        }
    }
    CHECK(wrong == 0);
}

} // namespace

int main()
{
    test_lifetimes(); // counts what is kept: first
    test_random_pairs();
    test_passed_on();
    test_results_add_up();
    test_switch<double>();
    test_switch<float>();
    test_threads();
    return check_report("fcl");
}
