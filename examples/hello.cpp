#include <cstdio>
#include <swiftprox.hpp>

using namespace swiftprox;

int main()
{
    const Shape box = Shape::box(1, 1, 1), ball = Shape::sphere(0.5);
    PairCache cache; // one per pair, kept from query to query
    for (int step = 0; step < 4; ++step) {
        const auto answer = distance({box, Pose()}, {ball, Pose::at(4 - step, 0, 0)}, cache);
        std::printf("%s: %g, guaranteed within [%.17g, %.17g]\n", to_string(answer.outcome), answer.distance, answer.lower, answer.upper);
    }
}
