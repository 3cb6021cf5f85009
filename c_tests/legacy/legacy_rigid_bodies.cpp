/*
 * A course project on rigid bodies: SWIFT 1.x with the broad phase, bodies from files and copies of them. It asks without a
 * tolerance, takes the result for a collision, and then moves the points of all listed pairs into the world in the scene's own
 * arrays.
 */
#include "legacy_test.h"

namespace {

struct Body {
    SWIFT_Real R[9];
    SWIFT_Real T[3];
    double speed;
};

} // namespace

int main(int argc, char** argv)
{
    const Folder folder(argc, argv);
    const std::string cube = folder.write("rigid_cube.tri", box_file(BoxMesh(0.5, 0.5, 0.5), false));
    const std::string floor = folder.write("rigid_floor.poly", box_file(BoxMesh(20, 20, 1), true));

    SWIFT_Scene scene(DEFAULT_BP, DEFAULT_GS);
    int id = -1, first = -1;
    CHECK(scene.Add_Object(floor.c_str(), id, true, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, DEFAULT_SCALE, DEFAULT_BOX_SETTING,
                           DEFAULT_BOX_ENLARGE_REL, DEFAULT_BOX_ENLARGE_ABS));
    CHECK(id == 0);
    CHECK(scene.Add_Object(cube.c_str(), first, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, DEFAULT_SCALE, DEFAULT_BOX_SETTING,
                           DEFAULT_BOX_ENLARGE_REL, DEFAULT_BOX_ENLARGE_ABS));
    CHECK(first == 1);
    std::vector<Body> bodies(1);
    for (int i = 0; i < 3; ++i) {
        /* The last copy is fixed, the original is not. */
        CHECK(scene.Add_Object(NULL, NULL, 0, 0, id, i == 2, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, DEFAULT_SCALE,
                               DEFAULT_BOX_SETTING, DEFAULT_BOX_ENLARGE_REL, DEFAULT_BOX_ENLARGE_ABS, DEFAULT_FACE_VALENCES, first, 0));
        CHECK(id == 2 + i);
    }
    scene.Activate();

    /* The floor's top is z = 0. Cubes 1 and 2 fall side by side, 3 is far away, 4 is fixed in the air. */
    const double xs[5] = {0, 0, 2.5, 10, -10}, zs[5] = {-1, 0.75, 1.5, 3, 5};
    bodies.resize(5);
    for (std::size_t i = 0; i < 5; ++i) {
        std::copy(DEFAULT_ORIENTATION, DEFAULT_ORIENTATION + 9, bodies[i].R);
        bodies[i].T[0] = static_cast<SWIFT_Real>(xs[i]), bodies[i].T[1] = 0, bodies[i].T[2] = static_cast<SWIFT_Real>(zs[i]);
        bodies[i].speed = i == 0 || i == 4 ? 0 : 1;
    }
    int collisions = 0, impulses = 0, impulses_on_far = 0;
    for (int step = 0; step < 16; ++step) {
        for (std::size_t i = 0; i < 5; ++i) {
            bodies[i].T[2] -= static_cast<SWIFT_Real>(bodies[i].speed / 16);
            scene.Set_Object_Transformation(static_cast<int>(i), bodies[i].R, bodies[i].T);
        }
        int pairs, *ids = NULL;
        SWIFT_Real *points = NULL, *normals = NULL;
        if (!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, NO_DISTANCES, &points, &normals)) {
            continue;
        }
        ++collisions;
        for (int k = 0; k < pairs; ++k) {
            double world[6];
            for (int side = 0; side < 2; ++side) {
                const Body& body = bodies[static_cast<std::size_t>(ids[2 * k + side])];
                place_point(body.R, body.T, points + 6 * k + 3 * side, world + 3 * side);
                for (int axis = 0; axis < 3; ++axis) {
                    points[6 * k + 3 * side + axis] = static_cast<SWIFT_Real>(world[3 * side + axis]);
                    CHECK(std::isfinite(static_cast<double>(points[6 * k + 3 * side + axis])));
                }
            }
            /* The normal looks from the second body to the first: the floor, below. */
            CHECK(ids[2 * k] == 0 && is_near3(normals + 3 * k, 0, 0, -1));
            const std::size_t other = static_cast<std::size_t>(ids[2 * k + 1]);
            impulses += 1;
            impulses_on_far += other > 2 ? 1 : 0;
            /* The points lie on the floor's top and on the cube's bottom. */
            CHECK(is_near(points[6 * k + 2], 0) && is_near(points[6 * k + 5], bodies[other].T[2] - 0.5));
            bodies[other].speed = 0;
        }
    }
    /* Cube 1 touches after four steps, at z = 0.5, and stays there. Cube 2 is listed from the eleventh on, where its box meets the
     * floor's. Those of the others never do. */
    CHECK(collisions == 13);
    CHECK(is_near(bodies[1].T[2], 0.5) && is_near(bodies[2].T[2], 0.8125));
    CHECK(impulses == 13 + 6 && impulses_on_far == 0);
    return check_report("legacy_rigid_bodies");
}
