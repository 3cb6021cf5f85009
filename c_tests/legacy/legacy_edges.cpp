/*
 * Where SWIFT_ONLY_TRIS and SWIFT_REPORT_EDGE_IDS are defined an edge has one id, 3 * face + k; where SWIFT_HIERARCHY is, levels
 * are built for those who ask for them. Defined here as an old SWIFT_config.h would.
 */
#define SWIFT_ONLY_TRIS
#define SWIFT_REPORT_EDGE_IDS
#define SWIFT_HIERARCHY

#include "legacy_test.h"

#include <swiftprox/tuning.h>
#include <swiftprox/scene.h>

namespace {

/* Whether an id is that of the edge between two vertices, in either direction. */
bool is_edge(const BoxMesh& box, int id, int a, int b)
{
    const int face = id / 3, corner = id % 3;
    const int tail = box.triangles[3 * face + corner], head = box.triangles[3 * face + (corner + 1) % 3];
    return (tail == a && head == b) || (tail == b && head == a);
}

void edges()
{
    const BoxMesh box(0.5, 0.5, 0.5);
    SWIFT_Scene scene(false);
    int first, second;
    CHECK(box.add(scene, first));
    CHECK(box.add(scene, second));
    /* The upper edge along x of the first box at y = 0.5, across the lower edge along y that the second one's turn brings down. */
    const Rotation tilt_first(0, std::atan(1.0)), tilt_second(1, std::atan(1.0));
    scene.Set_Object_Transformation(first, tilt_first.m, DEFAULT_TRANSLATION);
    const SWIFT_Real above[3] = {0, 0, 2};
    scene.Set_Object_Transformation(second, tilt_second.m, above);
    int pairs, *ids, *counts, *types, *feature_ids;
    SWIFT_Real *distances, *points, *normals;
    CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals, &types,
                                             &feature_ids));
    CHECK(pairs == 1 && is_near(distances[0], 2 - std::sqrt(2.0)));
    CHECK(types[0] == SWIFT_EDGE && types[1] == SWIFT_EDGE);
    /* Vertex v has bit 0 for +x, bit 1 for +y, bit 2 for +z: the first edge has +y and +z; the second one, turned by an eighth
     * about y, is where x and -z meet. */
    CHECK(is_edge(box, feature_ids[0], 6, 7));
    CHECK(is_edge(box, feature_ids[1], 1, 3) || is_edge(box, feature_ids[1], 0, 2));
    CHECK(is_near3(normals, 0, 0, -1));
    int *pids;
    CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &distances, &points, &normals, &pids, &types,
                                             &feature_ids));
    CHECK(is_edge(box, feature_ids[0], 6, 7));
}

/* The hull's edge along the top front is two of the caller's in one line. */
void divided_edge()
{
    SWIFT_Scene scene(false);
    const BoxMesh box(0.5, 0.5, 0.5);
    std::vector<SWIFT_Real> vertices(box.vertices, box.vertices + 24);
    const SWIFT_Real middle[3] = {0, static_cast<SWIFT_Real>(0.5), static_cast<SWIFT_Real>(0.5)};
    vertices.insert(vertices.end(), middle, middle + 3);
    /* Both triangles at the edge 6-7 are divided at vertex 8. */
    std::vector<int> triangles;
    for (int face = 0; face < 12; ++face) {
        const int* t = box.triangles + 3 * face;
        bool is_divided = false;
        for (int corner = 0; corner < 3 && !is_divided; ++corner) {
            const int a = t[corner], b = t[(corner + 1) % 3], c = t[(corner + 2) % 3];
            if ((a == 6 && b == 7) || (a == 7 && b == 6)) {
                const int halves[6] = {a, 8, c, 8, b, c};
                triangles.insert(triangles.end(), halves, halves + 6);
                is_divided = true;
            }
        }
        if (!is_divided) {
            triangles.insert(triangles.end(), t, t + 3);
        }
    }
    int first, second;
    CHECK(scene.Add_Convex_Object(&vertices[0], &triangles[0], 9, static_cast<int>(triangles.size() / 3), first));
    CHECK(box.add(scene, second));
    const Rotation tilt_first(0, std::atan(1.0)), tilt_second(1, std::atan(1.0));
    scene.Set_Object_Transformation(first, tilt_first.m, DEFAULT_TRANSLATION);
    const SWIFT_Real above[3] = {static_cast<SWIFT_Real>(0.25), 0, 2};
    scene.Set_Object_Transformation(second, tilt_second.m, above);
    int pairs, *ids, *types, *feature_ids;
    CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, NO_DISTANCES, NO_NEAREST_PTS, NO_NORMALS, NO_PIDS,
                                             &types, &feature_ids));
    CHECK(pairs == 1 && types[0] == SWIFT_EDGE);
    const int face = feature_ids[0] / 3, corner = feature_ids[0] % 3;
    const int tail = triangles[static_cast<std::size_t>(3 * face + corner)];
    const int head = triangles[static_cast<std::size_t>(3 * face + (corner + 1) % 3)];
    CHECK((tail == 8 || head == 8) && (tail == 6 || tail == 7 || head == 6 || head == 7));
}

/* Levels for a ball of 1,000 and more triangles, where they are asked for. */
void built_levels()
{
    std::vector<SWIFT_Real> vertices;
    std::vector<int> faces;
    const int rings = 16, around = 32;
    const double pi = PI;
    for (int ring = 0; ring <= rings; ++ring) {
        const double polar = pi * ring / rings;
        for (int i = 0; i < (ring % rings == 0 ? 1 : around); ++i) {
            vertices.push_back(static_cast<SWIFT_Real>(std::sin(polar) * std::cos(2 * pi * i / around)));
            vertices.push_back(static_cast<SWIFT_Real>(std::sin(polar) * std::sin(2 * pi * i / around)));
            vertices.push_back(static_cast<SWIFT_Real>(std::cos(polar)));
        }
    }
    const int last = static_cast<int>(vertices.size() / 3) - 1;
    for (int ring = 0; ring < rings; ++ring) {
        for (int i = 0; i < around; ++i) {
            const int next = (i + 1) % around, below = 1 + ring * around, above = below - around;
            const int lower[3] = {ring == 0 ? 0 : above + i, ring == rings - 1 ? last : below + i, below + next};
            const int upper[3] = {ring == rings - 1 ? last : below + next, ring == 0 ? 0 : above + next, above + i};
            if (ring < rings - 1) {
                faces.insert(faces.end(), lower, lower + 3);
            }
            if (ring > 0) {
                faces.insert(faces.end(), upper, upper + 3);
            }
        }
    }
    SWIFT_Scene scene(false);
    int ids[2];
    const int counts[2] = {DEFAULT_MIN_TCOUNT, 20};
    for (int i = 0; i < 2; ++i) {
        CHECK(scene.Add_Object(&vertices[0], &faces[0], last + 1, static_cast<int>(faces.size() / 3), ids[i], false,
                               DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, 1, 0, 0, 0, DEFAULT_FACE_VALENCES, -1, -1, counts[i],
                               static_cast<SWIFT_Real>(i == 0 ? 0.25 : 0.5)));
        const swiftprox_shape* shape = NULL;
        CHECK_OK(swiftprox_scene_get_piece(scene.Get_Native_Scene(), scene.Get_Native_Object(ids[i]), 0, &shape));
        swiftprox_shape_tuning_info info;
        info.struct_size = sizeof info;
        CHECK_OK(swiftprox_shape_get_tuning_info(shape, &info));
        CHECK(i == 0 ? info.level_count == 0 : info.level_count >= 3);
    }
}

} // namespace

int main()
{
    edges();
    divided_edge();
    built_levels();
    return check_report("legacy_edges");
}
