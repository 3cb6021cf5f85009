/* What calls of FCL's interface take by FCL and by swiftprox, in turns, on two hulls of 100 vertices: the table of docs/engines.md.
 * Processor times of 2,000 poses each, the least of seven passes. No test. */
#include <swiftprox/adapters/fcl.hpp>

#include <array>
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

/* By FCL and by swiftprox. */
using Times = std::array<double, 2>;

template <class Theirs, class Ours>
Times least_times(std::vector<fcl::CollisionObjectd> &at, const fcl::CollisionObjectd &still, Theirs theirs, Ours ours)
{
    Times least{INFINITY, INFINITY};
    for (int pass = 0; pass < PASSES; ++pass) {
        least[0] = std::fmin(least[0], nanoseconds(at, still, theirs));
        least[1] = std::fmin(least[1], nanoseconds(at, still, ours));
    }
    return least;
}

/* Of each call, at poses whose centres are so far apart. */
std::array<Times, 4> column(double low, double high)
{
    const fcl::CollisionObjectd still(hull());
    const auto other = hull();
    std::vector<fcl::CollisionObjectd> at;
    for (int i = 0; i < POSES; ++i) {
        const double far = std::uniform_real_distribution<double>(low, high)(numbers);
        const fcl::AngleAxisd turn(std::uniform_real_distribution<double>(0, 3)(numbers), direction());
        at.emplace_back(other, turn.toRotationMatrix(), far * direction());
    }
    const auto with = [](auto call, bool option) { return [=](const auto &a, const auto &b) { return call(a, b, option); }; };
    return {least_times(at, still, with(distance<false>, false), with(distance<true>, false)),
            least_times(at, still, with(distance<false>, true), with(distance<true>, true)),
            least_times(at, still, with(collide<false>, false), with(collide<true>, false)),
            least_times(at, still, with(collide<false>, true), with(collide<true>, true))};
}

} // namespace

int main()
{
    const char *const calls[4] = {"`distance`", "`distance`, signed", "`collide`", "`collide` with a contact"};
    const std::array<Times, 4> columns[3] = {column(2.5, 3.5), column(1.9, 2.1), column(1, 1.8)};
    std::printf("| call | about 1 apart: FCL | swiftprox | near: FCL | swiftprox | overlapping: FCL | swiftprox |\n"
                "| --- | --: | --: | --: | --: | --: | --: |\n");
    for (std::size_t call = 0; call < 4; ++call) {
        std::printf("| %s |", calls[call]);
        for (const auto &of : columns) {
            std::printf(" %.0f | %.0f |", of[call][0], of[call][1]);
        }
        std::printf("\n");
    }
    std::fprintf(stderr, "%g\n", sum);
    return 0;
}
