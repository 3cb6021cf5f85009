/*
 * How long SWIFT.h takes for what was measured with SWIFT 1.x and SWIFT++; benches/legacy.py prints one beside the other.
 *
 *   legacy_bench pair DEGREES      contacts of two bodies of 1,002 vertices, so far turned a step: microseconds a step
 *   legacy_bench boxes SIDE        contacts of 1,000 boxes of side 1 in a cube, where their enlarged boxes overlap: milliseconds
 *   legacy_bench all               contacts of all pairs of 200 boxes: milliseconds a step
 *
 * It prints the time of a step and the number of pairs that a step lists: the least of several runs, in the time of the processor.
 */
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "legacy_bodies.h"

namespace {

/* From 0 to 1, the same numbers everywhere. */
class Numbers {
public:
    Numbers() : state_(1) {}

    double next()
    {
        state_ = state_ * 1664525u + 1013904223u;
        return (state_ >> 8) / 16777216.0;
    }

private:
    unsigned int state_;
};

struct Task {
    Body body;
    int count;
    double side;     /* of the cube in which the bodies are */
    double turn;     /* a step */
    bool has_boxes;  /* the broad phase is on */
    int steps;
};

/* Turned about an axis of its own, where it is; one beside another one on an orbit. */
void place(SWIFT_Scene& scene, const Task& task, int i, const double* centre, int step)
{
    const double angle = task.turn * step * (i % 3 + 1), c = std::cos(angle), s = std::sin(angle);
    const int u = (i + 1) % 3, v = (i + 2) % 3, w = i % 3;
    SWIFT_Real R[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0}, T[3];
    R[3 * u + u] = R[3 * v + v] = static_cast<SWIFT_Real>(c);
    R[3 * v + u] = static_cast<SWIFT_Real>(s);
    R[3 * u + v] = -R[3 * v + u];
    R[3 * w + w] = 1;
    for (int axis = 0; axis < 3; ++axis) {
        T[axis] = static_cast<SWIFT_Real>(centre[axis] + 0.2 * std::sin(angle + axis));
    }
    if (task.count == 2 && i == 1) {
        T[0] = static_cast<SWIFT_Real>(2.2 * c);
        T[1] = static_cast<SWIFT_Real>(2.2 * s);
        T[2] = 0;
    }
    scene.Set_Object_Transformation(i, R, T);
}

/* Seconds a step; `listed` receives the pairs of the last one. */
double run(const Task& task, int& listed)
{
    SWIFT_Scene scene(task.has_boxes);
    Numbers numbers;
    std::vector<double> centres;
    int id;
    for (int i = 0; i < task.count; ++i) {
        if (i == 0) {
            scene.Add_Convex_Object(&task.body.vertices[0], &task.body.triangles[0], static_cast<int>(task.body.vertices.size() / 3),
                                    static_cast<int>(task.body.triangles.size() / 3), id);
        } else {
            scene.Copy_Object(0, id);
        }
        for (int axis = 0; axis < 3; ++axis) {
            centres.push_back(task.side * numbers.next());
        }
    }
    std::clock_t begin = 0;
    /* The first step makes what queries need. */
    for (int step = 0; step <= task.steps; ++step) {
        begin = step == 1 ? std::clock() : begin;
        for (int i = 0; i < task.count; ++i) {
            place(scene, task, i, &centres[static_cast<std::size_t>(3 * i)], step);
        }
        int *ids, *counts;
        SWIFT_Real *distances, *points, *normals;
        scene.Query_Contact_Determination(false, SWIFT_INFINITY, listed, &ids, &counts, &distances, &points, &normals);
    }
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / task.steps;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string what = argc > 1 ? argv[1] : "";
    const double number = argc > 2 ? std::atof(argv[2]) : 0, pi = PI;
    if (!((what == "pair" && number > 0) || (what == "boxes" && number > 0) || what == "all")) {
        std::fprintf(stderr, "legacy_bench pair DEGREES | boxes SIDE | all\n");
        return 2;
    }
    const bool is_pair = what == "pair";
    Task task;
    task.body = is_pair ? ellipsoid() : box();
    task.count = is_pair ? 2 : what == "all" ? 200 : 1000;
    task.side = is_pair ? 0 : what == "all" ? 20 : number;
    task.turn = (is_pair ? number : 1) * pi / 180;
    task.has_boxes = what == "boxes";
    task.steps = is_pair ? 50000 : 20;
    double least = 1e300;
    int listed = 0;
    for (int repeat = 0; repeat < 5; ++repeat) {
        least = std::min(least, run(task, listed));
    }
    std::printf("%.4f %d\n", least * (is_pair ? 1e6 : 1e3), listed);
    return 0;
}
