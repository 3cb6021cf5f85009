// A bullet that spins at a thin wall: when and where it hits, and that it misses a wall beside it.
#include <cstdio>
#include <swiftprox.hpp>

int main()
try {
    const swiftprox::Shape bullet = swiftprox::Shape::box(0.05, 0.01, 0.01), wall = swiftprox::Shape::box(0.01, 1, 1);
    // 400 per second along x, 1,200 radians per second about x.
    const swiftprox_motion flight = swiftprox::screw_motion(swiftprox::Pose::at(-2, 0, 0), {400, 0, 0}, {1200, 0, 0});
    const swiftprox_motion rest = swiftprox::fixed_motion(swiftprox::Pose());
    const swiftprox_motion aside = swiftprox::fixed_motion(swiftprox::Pose::at(0, 1.5, 0));

    swiftprox::CastConfig config;
    config.time_end = 0.01;
    swiftprox::PairCache caches[2];
    const swiftprox_cast_answer hit = swiftprox::cast({bullet, flight}, {wall, rest}, caches[0], config);
    std::printf("%s after %.5f, normal (%g %g %g)\n", swiftprox::to_string(hit.outcome), hit.time_lower,
                hit.contact.normal[0], hit.contact.normal[1], hit.contact.normal[2]);
    const swiftprox_cast_answer miss = swiftprox::cast({bullet, flight}, {wall, aside}, caches[1], config);
    std::printf("%s, at least %.2f away\n", swiftprox::to_string(miss.outcome), miss.clearance);
    return 0;
} catch (const swiftprox::Error &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
