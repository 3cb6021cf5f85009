// A box above a floor, in C++: a distance, and a scene whose near pairs are listed at each step.
#include <array>
#include <cstdio>
#include <vector>

#include <swiftprox.hpp>

int main()
try {
    const std::vector<double> corners{-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1};
    const swiftprox::Shape box = swiftprox::Shape::from_points(corners);
    const swiftprox::Shape floor = box.scaled(4);

    swiftprox::PairCache cache; // one per pair, kept from query to query
    const swiftprox_pair_answer answer =
        swiftprox::distance({floor, swiftprox::Pose()}, {box, swiftprox::Pose::at(0, 0, 7)}, cache);
    std::printf("distance %.17g, guaranteed within [%.17g, %.17g]\n", answer.distance, answer.lower, answer.upper);

    swiftprox::Scene scene;
    scene.add(floor);
    const swiftprox_object_id falling = scene.add(box);
    swiftprox::SceneQuery query;
    query.max_distance = 1; // pairs farther apart are not reported
    for (int step = 0; step < 4; ++step) {
        scene.set_pose(falling, swiftprox::Pose::at(0, 0, 7 - 0.75 * step));
        const swiftprox_scene_answer near = scene.query_distance(query);
        std::printf("step %d: %zu near\n", step, near.count);
        for (const swiftprox_pair_result &pair : swiftprox::pairs(near)) {
            std::printf("  %s at %g\n", swiftprox::to_string(pair.answer.outcome), pair.answer.distance);
        }
    }
    return 0;
} catch (const swiftprox::Error &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
