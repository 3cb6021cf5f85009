/* What calls of FCL's interface take by FCL and by swiftprox, in turns, on two hulls of 100 vertices: the table of docs/engines.md.
 * Processor times of 2,000 poses each, the least of seven passes. No test. */
#include <swiftprox/adapters/fcl.hpp>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <random>

namespace
{

enum { VERTICES = 100, POSES = 2000, PASSES = 7 };

std::mt19937 numbers(1);

fcl::Vector3d direction()
{
    std::normal_distribution<double> normal;
    return fcl::Vector3d(normal(numbers), normal(numbers), normal(numbers)).normalized();
}

/* On a sphere of radius 1; FCL walks over edges, so that it gets the hull's triangles. */
std::shared_ptr<fcl::Convexd> hull()
{
    std::vector<double> points;
    for (int i = 0; i < VERTICES; ++i) {
        const fcl::Vector3d point = direction();
        points.insert(points.end(), point.data(), point.data() + 3);
    }
    const swiftprox::Shape shape = swiftprox::Shape::from_points(points);
    points = shape.vertices();
    const auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (std::size_t i = 0; i < points.size(); i += 3) {
        vertices->emplace_back(points[i], points[i + 1], points[i + 2]);
    }
    const auto faces = std::make_shared<std::vector<int>>();
    for (const std::uint32_t corner : shape.triangles()) {
        if (faces->size() % 4 == 0) {
            faces->push_back(3);
        }
        faces->push_back(static_cast<int>(corner));
    }
    return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(faces->size() / 4), faces);
}

double sum; // so that nothing is left out

/* By FCL, or by swiftprox. */
template <bool ours> double distance(const fcl::CollisionObjectd &a, const fcl::CollisionObjectd &b, bool is_signed)
{
    fcl::DistanceResultd result;
    const fcl::DistanceRequestd request(true, is_signed);
    return ours ? swiftprox::adapters::fcl::distance(&a, &b, request, result) : fcl::distance<double>(&a, &b, request, result);
}
template <bool ours> double collide(const fcl::CollisionObjectd &a, const fcl::CollisionObjectd &b, bool with_contact)
{
    fcl::CollisionResultd result;
    const fcl::CollisionRequestd request(1, with_contact);
    const std::size_t count =
        ours ? swiftprox::adapters::fcl::collide(&a, &b, request, result) : fcl::collide<double>(&a, &b, request, result);
    return static_cast<double>(count);
}

template <class Call> double nanoseconds(std::vector<fcl::CollisionObjectd> &at, const fcl::CollisionObjectd &still, Call call)
{
    const std::clock_t before = std::clock();
    for (const fcl::CollisionObjectd &moving : at) {
        sum += call(still, moving);
    }
    return double(std::clock() - before) / CLOCKS_PER_SEC / POSES * 1e9;
}

template <class Theirs, class Ours> void row(const char *what, std::vector<fcl::CollisionObjectd> &at,
                                             const fcl::CollisionObjectd &still, Theirs theirs, Ours ours)
{
    double least[2] = {INFINITY, INFINITY};
    for (int pass = 0; pass < PASSES; ++pass) {
        least[0] = std::fmin(least[0], nanoseconds(at, still, theirs));
        least[1] = std::fmin(least[1], nanoseconds(at, still, ours));
    }
    std::printf("| %s | %.0f | %.0f |\n", what, least[0], least[1]);
}

/* Poses whose centres are so far apart. */
void rows(const char *where, double low, double high)
{
    const fcl::CollisionObjectd still(hull());
    const auto other = hull();
    std::vector<fcl::CollisionObjectd> at;
    for (int i = 0; i < POSES; ++i) {
        const double far = std::uniform_real_distribution<double>(low, high)(numbers);
        const fcl::AngleAxisd turn(std::uniform_real_distribution<double>(0, 3)(numbers), direction());
        at.emplace_back(other, turn.toRotationMatrix(), far * direction());
    }
    char what[100];
    const auto name = [&](const char *call) {
        std::snprintf(what, sizeof what, "%s, %s", call, where);
        return what;
    };
    const auto with = [](auto call, bool option) { return [=](const auto &a, const auto &b) { return call(a, b, option); }; };
    row(name("`distance`"), at, still, with(distance<false>, false), with(distance<true>, false));
    row(name("`distance`, signed"), at, still, with(distance<false>, true), with(distance<true>, true));
    row(name("`collide`"), at, still, with(collide<false>, false), with(collide<true>, false));
    row(name("`collide`, a contact"), at, still, with(collide<false>, true), with(collide<true>, true));
}

} // namespace

int main()
{
    std::printf("| call, bodies | FCL | swiftprox |\n|---|--:|--:|\n");
    rows("1 apart", 2.5, 3.5);
    rows("near", 1.9, 2.1);
    rows("overlapping", 1, 1.8);
    std::fprintf(stderr, "%g\n", sum);
    return 0;
}
