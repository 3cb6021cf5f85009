/*
 * What SWIFT.h costs over the interface of C: the same queries by both.
 *
 *   legacy_cost pair|scene|near c|legacy STEPS [DEGREES]
 *
 * pair: contacts of two bodies of 1,002 vertices in orbit, DEGREES a step (1). scene: all distances of 1,000 boxes. near: pairs
 * of them within a tolerance that few are. Count instructions (valgrind --tool=callgrind) with two numbers of STEPS and take the
 * difference: they repeat exactly, and what making the scene takes is in both.
 */
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "legacy_bodies.h"
#include "swiftprox/scene.h"

namespace {

/* Where object i is at a step: on an orbit of its own, turning. */
void place(int i, int count, double turn, SWIFT_Real* R, SWIFT_Real* T)
{
    const double angle = turn * (i % 7 + 1), c = std::cos(angle), s = std::sin(angle);
    const double rows[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
    std::copy(rows, rows + 9, R);
    if (count == 2) {
        T[0] = i == 0 ? 0 : 2.2 * c;
        T[1] = i == 0 ? 0 : 2.2 * s;
        T[2] = 0;
    } else {
        T[0] = 2 * (i % 10) + 0.1 * s;
        T[1] = 2 * (i / 10 % 10) + 0.1 * c;
        T[2] = 2 * (i / 100);
    }
}

struct Task {
    Body body;
    int count;
    bool asks_contacts;
    double tolerance;
    double turn; /* a step */
};

double by_legacy(const Task& task, int steps)
{
    SWIFT_Scene scene(false);
    int id;
    for (int i = 0; i < task.count; ++i) {
        if (i == 0) {
            scene.Add_Convex_Object(&task.body.vertices[0], &task.body.triangles[0], static_cast<int>(task.body.vertices.size() / 3),
                                    static_cast<int>(task.body.triangles.size() / 3), id);
        } else {
            scene.Copy_Object(0, id);
        }
    }
    double sum = 0;
    for (int step = 0; step < steps; ++step) {
        SWIFT_Real R[9], T[3];
        for (int i = 0; i < task.count; ++i) {
            place(i, task.count, step * task.turn, R, T);
            scene.Set_Object_Transformation(i, R, T);
        }
        int pairs, *ids;
        SWIFT_Real *distances, *points, *normals;
        if (task.asks_contacts) {
            int* counts;
            scene.Query_Contact_Determination(false, task.tolerance, pairs, &ids, &counts, &distances, &points, &normals);
            for (int k = 0; k < pairs; ++k) {
                sum += distances[k] + points[6 * k] + normals[3 * k] + ids[2 * k];
            }
        } else {
            scene.Query_Exact_Distance(false, task.tolerance, pairs, &ids, &distances);
            for (int k = 0; k < pairs; ++k) {
                sum += distances[k] + ids[2 * k];
            }
        }
    }
    return sum;
}

void must(swiftprox_status status)
{
    if (status != SWIFTPROX_OK) {
        std::fprintf(stderr, "%s\n", swiftprox_library_last_error_message());
        std::exit(1);
    }
}

double by_c(const Task& task, int steps)
{
    swiftprox_scene* scene;
    must(swiftprox_scene_create(NULL, &scene));
    std::vector<uint32_t> triangles(task.body.triangles.begin(), task.body.triangles.end());
    std::vector<swiftprox_object_id> ids(static_cast<std::size_t>(task.count));
    for (std::size_t i = 0; i < ids.size(); ++i) {
        swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        if (i == 0) {
            const swiftprox_shape *shape;
            const swiftprox_mesh mesh = {&task.body.vertices[0], task.body.vertices.size() / 3, &triangles[0], NULL,
                                         triangles.size() / 3};
            must(swiftprox_shape_create_from_mesh(mesh, NULL, &shape));
            must(swiftprox_scene_add_object(scene, &shape, 1, &options, &ids[0]));
            swiftprox_shape_release(shape);
        } else {
            must(swiftprox_scene_copy_object(scene, ids[0], &ids[i]));
            swiftprox_object_info info;
            info.struct_size = sizeof info;
            must(swiftprox_scene_get_object_info(scene, ids[i], &info));
            info.user_data = i;
            must(swiftprox_scene_set_object_info(scene, ids[i], &info));
        }
    }
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.max_distance = task.tolerance;
    double sum = 0;
    for (int step = 0; step < steps; ++step) {
        SWIFT_Real R[9], T[3];
        for (int i = 0; i < task.count; ++i) {
            place(i, task.count, step * task.turn, R, T);
            must(swiftprox_scene_set_transform(scene, ids[static_cast<std::size_t>(i)], R, T));
        }
        swiftprox_scene_answer answer;
        must(task.asks_contacts ? swiftprox_scene_query_contact(scene, &query, &answer)
                                : swiftprox_scene_query_distance(scene, &query, &answer));
        for (std::size_t k = 0; k < answer.count; ++k) {
            const swiftprox_pair_result& pair = answer.pairs[k];
            sum += pair.answer.distance + static_cast<double>(pair.user_data1);
            if (task.asks_contacts) {
                sum += pair.answer.local1[0] + pair.answer.normal[0];
            }
        }
    }
    must(swiftprox_scene_destroy(scene));
    return sum;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 4 && argc != 5) {
        std::fprintf(stderr, "legacy_cost pair|scene|near c|legacy STEPS [DEGREES]\n");
        return 2;
    }
    const std::string what = argv[1], by = argv[2];
    const int steps = std::atoi(argv[3]);
    Task task;
    task.body = what == "pair" ? ellipsoid() : box();
    task.count = what == "pair" ? 2 : 1000;
    task.asks_contacts = what != "scene";
    const double pi = PI;
    task.turn = (argc == 5 ? std::atof(argv[4]) : 1) * pi / 180;
    task.tolerance = what == "near" ? 1.1 : 1e300;
    std::printf("%.6f\n", by == "c" ? by_c(task, steps) : by_legacy(task, steps));
    return 0;
}
