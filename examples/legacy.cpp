// A program as it was written for SWIFT++ in 2001: two boxes pass each other. SWIFT.h serves it over swiftprox, unchanged.
#include <SWIFT.h>

#include <cstdio>
#include <string>

int main(int argc, char** argv)
{
    if (argc > 1 && std::string(argv[1]) == "--help") {
        std::printf("usage: legacy\n");
        return 0;
    }
    if (argc > 1) {
        std::fprintf(stderr, "legacy: takes no argument: %s\nusage: legacy\n", argv[1]);
        return 2;
    }
    SWIFT_Real corners[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1};
    int sides[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    int corners_of_sides[] = {4, 4, 4, 4, 4, 4};
    SWIFT_Scene scene(false, true);
    int still, moving;
    if (!scene.Add_Convex_Object(corners, sides, 8, 6, still, true, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, DEFAULT_SCALE,
                                 DEFAULT_BOX_SETTING, DEFAULT_BOX_ENLARGE_REL, DEFAULT_BOX_ENLARGE_ABS, corners_of_sides) ||
        !scene.Add_Convex_Object(corners, sides, 8, 6, moving, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, 0.5,
                                 DEFAULT_BOX_SETTING, DEFAULT_BOX_ENLARGE_REL, DEFAULT_BOX_ENLARGE_ABS, corners_of_sides)) {
        return 1;
    }
    for (int step = 0; step <= 4; ++step) {
        SWIFT_Real R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        SWIFT_Real T[3] = {3 - step * 0.5, 0.25, 0};
        scene.Set_Object_Transformation(moving, R, T);
        int pairs, *ids, *contacts;
        SWIFT_Real *distances, *points, *normals;
        bool collide = scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &contacts, &distances, &points, &normals);
        for (int k = 0; k < pairs; ++k) {
            std::printf("x = %.1f: %d and %d, %s, distance %.2f, normal (%.0f %.0f %.0f)\n", T[0], ids[2 * k], ids[2 * k + 1],
                        collide ? "a collision" : "apart", distances[k], normals[3 * k] + 0.0, normals[3 * k + 1] + 0.0,
                        normals[3 * k + 2] + 0.0);
        }
        // The old libraries had no such interval.
        if (!collide) {
            const swiftprox_pair_answer* answer = scene.Get_Answer(0);
            std::printf("    for sure within %.0e\n", answer->upper - answer->lower > 1e-15 ? answer->upper - answer->lower : 1e-15);
        }
    }
    return 0;
}
