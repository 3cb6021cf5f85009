/* Every method that is not about files and pieces, with its defaults, and what it says of a mistake. */
#include "legacy_test.h"

namespace {

void constants()
{
    CHECK(DEFAULT_BP && DEFAULT_GS && !DEFAULT_FIXED && DEFAULT_COPY == -1 && DEFAULT_MIN_TCOUNT == 50);
    CHECK(is_same(DEFAULT_SCALE, 1) && is_same(DEFAULT_QSLIM_TRATIO, 0.25) && is_same(DEFAULT_CUBE_ASPECT_RATIO, 2));
    CHECK(DEFAULT_BOX_SETTING == 0 && BOX_SETTING_DEFAULT == 0 && BOX_SETTING_CUBE == 1 && BOX_SETTING_DYNAMIC == 2);
    CHECK(BOX_SETTING_CHOOSE == 3 && BOX_SETTING_COPY == 4 && SWIFT_VERTEX == 1 && SWIFT_EDGE == 2 && SWIFT_FACE == 3);
    CHECK(is_same(DEFAULT_BOX_ENLARGE_REL, 0) && is_same(DEFAULT_BOX_ENLARGE_ABS, 0) && DEFAULT_FACE_VALENCES == NULL);
    CHECK(DEFAULT_ORIENTATIONS == NULL && DEFAULT_TRANSLATIONS == NULL && DEFAULT_SCALES == NULL && DEFAULT_BOX_SETTINGS == NULL);
    CHECK(DEFAULT_ORIENTATIONSS == NULL && DEFAULT_TRANSLATIONSS == NULL && DEFAULT_SCALESS == NULL && DEFAULT_COPIES == NULL);
    CHECK(DEFAULT_BOX_ENLARGE_RELS == NULL && DEFAULT_BOX_ENLARGE_ABSS == NULL && DEFAULT_FACE_VALENCESS == NULL);
    CHECK(DEFAULT_FACE_VALENCESSS == NULL && DEFAULT_MIN_TCOUNTS == NULL && DEFAULT_QSLIM_TRATIOS == NULL);
    CHECK(DEFAULT_CUBE_ASPECT_RATIOS == NULL && DEFAULT_SPLIT_TYPE == MIDPOINT && MEDIAN == 0 && MEAN == 2 && GAP == 3);
    CHECK(NO_DISTANCES == NULL && NO_NEAREST_PTS == NULL && NO_NORMALS == NULL && NO_PIDS == NULL && NO_FEAT_TYPES == NULL);
    CHECK(NO_FEAT_IDS == NULL && DISJOINT == -3 && PENETRATION == -2 && LOCAL_MINIMUM == -1 && CONTINUE_VV == 0);
    CHECK(CONTINUE_VE == 1 && CONTINUE_EV == 2 && CONTINUE_VF == 3 && CONTINUE_FV == 4 && CONTINUE_EE == 5 && CONTINUE_EF == 6);
    CHECK(CONTINUE_FE == 7 && is_near(PI, 4 * std::atan(1.0)) && is_near(2 * PI_2, PI) && is_near(SQRT2 * SQRT1_2, 1));
    CHECK(is_same(SWIFT_INFINITY, sizeof(SWIFT_Real) == 4 ? FLT_MAX : DBL_MAX) && is_near(EPSILON1 * EPSILON14 / EPSILON15, 1));
    CHECK(is_same(SWIFT_min(1, 2.5), 1) && is_same(SWIFT_max(1, 2.5), 2.5) && is_same(myfabs(-2), 2));
    const SWIFT_Matrix matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int i = 0; i < 9; ++i) {
        CHECK(is_same(matrix[i], DEFAULT_ORIENTATION[i]) && is_same(DEFAULT_TRANSLATION[i / 3], 0));
    }
    CHECK(SWIFT_MAX_VALENCE == 100);
}

void ids_and_deletion()
{
    Messages messages;
    const BoxMesh box(0.5, 0.5, 0.5);
    SWIFT_Scene scene(false);
    int ids[5];
    for (int i = 0; i < 5; ++i) {
        ids[i] = 1000;
        CHECK(box.add(scene, ids[i]) && ids[i] == i);
    }
    int id = 55;
    CHECK(!scene.Add_Convex_Object(box.vertices, box.triangles, 8, 11, id) && id == 55);
    CHECK(messages.take().find("Error: The mesh is not closed --\n       all edges must belong to exactly two triangles\n"
                               "Error (Add_Convex_Object obj 5 piece 0): ") == 0);
    CHECK(scene.Delete_Object(1) && scene.Delete_Object(3));
    CHECK(!scene.Delete_Object(3) && messages.has("Delete_Object: 3"));
    CHECK(!scene.Delete_Object(-1) && !scene.Delete_Object(5) && messages.has("Error: Object id out of range given to"));
    CHECK(box.add(scene, id) && id == 3);
    CHECK(box.add(scene, id) && id == 1);
    CHECK(box.add(scene, id) && id == 5);
    CHECK(messages.take().empty());
}

void refused_meshes()
{
    Messages messages;
    SWIFT_Scene scene;
    BoxMesh box(0.5, 0.5, 0.5);
    int id = 9;
    CHECK(!scene.Add_Object(NULL, box.triangles, 8, 12, id) && messages.has("no vertices or no faces are given"));
    CHECK(!scene.Add_Object(box.vertices, NULL, 8, 12, id) && messages.has("no vertices or no faces are given"));
    CHECK(!scene.Add_Object(box.vertices, box.triangles, 0, 12, id) && messages.has("0 vertices and 12 faces"));
    CHECK(!scene.Add_Object(box.vertices, box.triangles, 8, -1, id) && messages.has("8 vertices and -1 faces"));
    box.triangles[4] = 8;
    CHECK(!scene.Add_Object(box.vertices, box.triangles, 8, 12, id) && messages.has("face 1 has vertex 8 of 8"));
    box.triangles[4] = -1;
    CHECK(!scene.Add_Object(box.vertices, box.triangles, 8, 12, id) && messages.has("face 1 has vertex -1 of 8"));
    box = BoxMesh(0.5, 0.5, 0.5);
    box.valences[3] = 2;
    CHECK(!scene.Add_Object(box.vertices, box.quads, 8, 6, id, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, 1, 0, 0, 0,
                            box.valences));
    CHECK(messages.has("face 3 has 2 corners"));
    box.vertices[5] = std::numeric_limits<SWIFT_Real>::quiet_NaN();
    CHECK(!scene.Add_Object(box.vertices, box.triangles, 8, 12, id) && messages.has("vertex 1 is not finite"));
    box = BoxMesh(0.5, 0.5, 0.5);
    /* An edge of four faces, a body inside out, one that is not convex. */
    int twice[72];
    std::copy(box.triangles, box.triangles + 36, twice);
    std::copy(box.triangles, box.triangles + 36, twice + 36);
    CHECK(!scene.Add_Object(box.vertices, twice, 8, 24, id));
    CHECK(messages.take().find("Error: The mesh is not a 2-manifold --\n       all edges must belong to exactly two triangles\n") == 0);
    int inside_out[36];
    for (int i = 0; i < 36; ++i) {
        inside_out[i] = box.triangles[35 - i];
    }
    {
        /* It is turned. */
        SWIFT_Scene turned(false);
        int first = -1, second = -1;
        CHECK(turned.Add_Object(box.vertices, inside_out, 8, 12, first) && box.add(turned, second) && messages.take().empty());
        move_to(turned, second, 3, 0, 0);
        int pairs, *ids;
        SWIFT_Real* distances;
        CHECK(!turned.Query_Exact_Distance(false, 10, pairs, &ids, &distances) && pairs == 1 && is_near(distances[0], 2));
    }
    SWIFT_Real dented[24];
    std::copy(box.vertices, box.vertices + 24, dented);
    dented[0] = dented[1] = dented[2] = static_cast<SWIFT_Real>(0.25);
    CHECK(!scene.Add_Convex_Object(dented, box.triangles, 8, 12, id));
    const std::string said = messages.take();
    CHECK(said.find("Error (Add_Convex_Object obj 0 piece 0): face ") == 0 && said.find("vertex ") != std::string::npos);
    CHECK(said.find("outside of its plane") != std::string::npos && said.find("Set_Take_Hull(true)") != std::string::npos);
    CHECK(said.find("SWIFTPROX") == std::string::npos);
    CHECK(!scene.Add_Object(box.vertices, box.triangles, 8, 12, id, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, 1,
                            BOX_SETTING_COPY));
    CHECK(messages.take() == "Error (Add_Object obj 0 piece 0): Cannot set box type to COPY when copy is not done\n");
    CHECK(!scene.Add_Object(NULL, NULL, 0, 0, id, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, 1, 0, 0, 0, NULL, 3));
    CHECK(messages.take() == "Error (Add_Object obj 0 piece 0): Invalid object id given to copy a piece: 3\n");
    CHECK(id == 9);
    /* Where the program says so, the hull of the dented body counts, and faces have no numbers. */
    scene.Set_Take_Hull(true);
    CHECK(scene.Add_Convex_Object(dented, box.triangles, 8, 12, id) && id == 0);
    scene.Set_Take_Hull(false);
    CHECK(!scene.Add_Convex_Object(dented, box.triangles, 8, 12, id));
    messages.take();
    /* Equal vertices are one, those of no face are none. */
    SWIFT_Real more[30];
    std::copy(box.vertices, box.vertices + 24, more + 3);
    std::copy(box.vertices + 21, box.vertices + 24, more + 27);
    more[0] = more[1] = more[2] = 100;
    int renumbered[36];
    for (int i = 0; i < 36; ++i) {
        renumbered[i] = box.triangles[i] + (box.triangles[i] == 7 && i % 2 == 0 ? 2 : 1);
    }
    CHECK(scene.Add_Object(more, renumbered, 10, 12, id) && id == 1);
    CHECK(box.add(scene, id) && id == 2);
    scene.Deactivate(0);
    move_to(scene, 2, 3, 4, 5);
    int pairs, *oids, *types, *feature_ids;
    SWIFT_Real* distances;
    CHECK(!scene.Query_Contact_Determination(false, 100, pairs, &oids, &distances, NO_NEAREST_PTS, NO_NORMALS, NO_PIDS, &types,
                                             &feature_ids));
    /* Corner to corner: the numbers are the caller's, of equal vertices the first, although no face names that one. */
    CHECK(pairs == 1 && is_near(distances[0], std::sqrt(4.0 + 9 + 16)));
    CHECK(types[0] == SWIFT_VERTEX && types[1] == SWIFT_VERTEX && feature_ids[0] == 8 && feature_ids[1] == 0);
    CHECK(messages.take().empty());
}

void transformations()
{
    Messages messages;
    const BoxMesh box(0.5, 0.5, 0.5);
    SWIFT_Scene scene(false);
    int id;
    for (int i = 0; i < 4; ++i) {
        CHECK(scene.Add_Object(box.vertices, box.triangles, 8, 12, id, i == 1));
    }
    /* All that are not fixed, in order of creation: 0, 3 and the new 2. */
    scene.Delete_Object(2);
    CHECK(box.add(scene, id) && id == 2);
    SWIFT_Real RT[36], R[27], T[9];
    for (int i = 0; i < 3; ++i) {
        std::copy(DEFAULT_ORIENTATION, DEFAULT_ORIENTATION + 9, R + 9 * i);
        T[3 * i] = static_cast<SWIFT_Real>(4 * (i + 1)), T[3 * i + 1] = T[3 * i + 2] = 0;
        for (int row = 0; row < 3; ++row) {
            std::copy(DEFAULT_ORIENTATION + 3 * row, DEFAULT_ORIENTATION + 3 * row + 3, RT + 12 * i + 4 * row);
            RT[12 * i + 4 * row + 3] = row == 0 ? static_cast<SWIFT_Real>(2 * (i + 1)) : 0;
        }
    }
    int pairs, *oids;
    SWIFT_Real* distances;
    scene.Set_All_Object_Transformations(RT);
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &oids, &distances) && pairs == 6);
    /* By the one that was created later: 0-1, 0-3, 1-3, 0-2, 1-2, 3-2. */
    const int expected[12] = {0, 1, 0, 3, 1, 3, 0, 2, 1, 2, 2, 3};
    const double gaps[6] = {1, 1, 3, 3, 5, 1};
    for (int k = 0; k < 6; ++k) {
        CHECK(oids[2 * k] == expected[2 * k] && oids[2 * k + 1] == expected[2 * k + 1] && is_near(distances[k], gaps[k]));
    }
    scene.Set_All_Object_Transformations(R, T);
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &oids, &distances) && is_near(distances[0], 3));
    scene.Set_Object_Transformation(0, RT);
    scene.Set_Object_Transformation(0, R, T + 0);
    CHECK(messages.take().empty());
    /* What is no rigid motion is refused, and the object stays. */
    SWIFT_Real stretched[9] = {2, 0, 0, 0, 2, 0, 0, 0, 2}, mirrored[9] = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
    SWIFT_Real nowhere[3] = {std::numeric_limits<SWIFT_Real>::quiet_NaN(), 0, 0};
    scene.Set_Object_Transformation(0, stretched, T);
    CHECK(messages.has("Error (Set_Object_Transformation): "));
    scene.Set_Object_Transformation(0, mirrored, T);
    CHECK(messages.has("Error (Set_Object_Transformation): "));
    scene.Set_Object_Transformation(0, R, nowhere);
    CHECK(messages.has("Error (Set_Object_Transformation): "));
    scene.Set_Object_Transformation(0, NULL, T);
    scene.Set_Object_Transformation(0, R, NULL);
    scene.Set_Object_Transformation(0, NULL);
    CHECK(messages.has("Error (Set_Object_Transformation): "));
    scene.Set_All_Object_Transformations(NULL);
    scene.Set_All_Object_Transformations(R, NULL);
    CHECK(messages.has("Error (Set_All_Object_Transformations): "));
    R[9] = 3;
    scene.Set_All_Object_Transformations(R, T);
    CHECK(messages.has("Error (Set_All_Object_Transformations): "));
    scene.Set_Object_Transformation(4, RT);
    CHECK(messages.take() == "Error: Object id out of range given to Set_Object_Transformation(id): 4\n");
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &oids, &distances) && is_near(distances[0], 3));
    SWIFT_Scene empty;
    empty.Set_All_Object_Transformations(RT);
    empty.Activate();
    empty.Deactivate();
    int* none = oids;
    CHECK(!empty.Query_Intersection(false, pairs, &none) && pairs == 0);
    CHECK(!empty.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &none, &distances) && pairs == 0);
    CHECK(messages.take().empty());
}

void activation()
{
    Messages messages;
    const BoxMesh box(0.5, 0.5, 0.5);
    SWIFT_Scene scene(false);
    int id, pairs, *oids;
    for (int i = 0; i < 4; ++i) {
        box.add(scene, id);
    }
    CHECK(scene.Query_Intersection(false, pairs, &oids) && pairs == 6);
    scene.Deactivate();
    CHECK(!scene.Query_Intersection(false, pairs, &oids) && pairs == 0);
    scene.Activate(2);
    scene.Activate(2);
    CHECK(scene.Query_Intersection(false, pairs, &oids) && pairs == 3 && oids[0] == 0 && oids[1] == 2 && oids[4] == 2 && oids[5] == 3);
    scene.Deactivate(3);
    scene.Activate(3, 0);
    CHECK(scene.Query_Intersection(false, pairs, &oids) && pairs == 3 && oids[4] == 0 && oids[5] == 3);
    scene.Deactivate(0, 3);
    CHECK(scene.Query_Intersection(true, pairs, &oids) && pairs == 0);
    CHECK(scene.Query_Intersection(false, pairs, &oids) && pairs == 2);
    /* An object that comes later is active with all others. */
    box.add(scene, id);
    CHECK(scene.Query_Intersection(false, pairs, &oids) && pairs == 6);
    scene.Activate();
    CHECK(scene.Query_Intersection(false, pairs, &oids) && pairs == 10);
    scene.Activate(1, 1);
    scene.Deactivate(1, 1);
    CHECK(messages.take().empty());
    scene.Activate(1, 5);
    CHECK(messages.take() == "Error: Object id out of range given to Activate(id1,id2): 5\n");
    scene.Deactivate(-1, 1);
    CHECK(messages.take() == "Error: Object id out of range given to Deactivate(id1,id2): -1\n");
    scene.Activate(9);
    CHECK(messages.take() == "Error: Object id out of range given to Activate(id): 9\n");
    scene.Deactivate(9);
    CHECK(messages.take() == "Error: Object id out of range given to Deactivate(id): 9\n");
    CHECK(scene.Query_Intersection(false, pairs, &oids) && pairs == 10);
}

void copies()
{
    Messages messages;
    const BoxMesh box(1, 0.5, 0.5);
    SWIFT_Scene scene(false);
    int original, copy, clone, id = 70;
    const Rotation quarter(2, 2 * std::atan(1.0));
    const SWIFT_Real away[3] = {5, 0, 0};
    CHECK(scene.Add_Object(box.vertices, box.triangles, 8, 12, original, true));
    scene.Set_Object_Transformation(original, quarter.m, away);
    /* SWIFT++: where it is and fixed as the original is. */
    CHECK(scene.Copy_Object(original, copy) && copy == 1);
    int pairs, *oids;
    CHECK(!scene.Query_Intersection(false, pairs, &oids) && pairs == 0);
    /* SWIFT 1.x: neither; with a transform on top of the original's. */
    CHECK(scene.Add_Object(NULL, NULL, 0, 0, clone, false, quarter.m, away, 2, BOX_SETTING_COPY, 0, 0, DEFAULT_FACE_VALENCES, original));
    CHECK(clone == 2);
    SWIFT_Real x, y, z, *distances, *points, *normals;
    scene.Get_Center_Of_Mass(clone, x, y, z);
    CHECK(is_near(x, 5) && is_near(y, 0) && is_near(z, 0));
    /* The original spans 4.5 to 5.5 in x and -1 to 1 in y, the clone 4 to 6 and -2 to 2. */
    CHECK(scene.Query_Intersection(false, pairs, &oids) && pairs == 2);
    move_to(scene, clone, 0, 4, 0);
    int *types, *feature_ids;
    CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &oids, &distances, &points, &normals, NO_PIDS, &types,
                                             &feature_ids));
    CHECK(pairs == 2 && is_near(distances[0], 1) && is_near3(normals, 0, -1, 0) && is_near(points[4], -2));
    for (int i = 0; i < 2; ++i) {
        CHECK(feature_ids[i] >= 0 && feature_ids[i] < 12);
    }
    CHECK(!scene.Copy_Object(8, id) && id == 70 && messages.has("Copy_Object: 8"));
    CHECK(!scene.Add_Object(NULL, NULL, 0, 0, id, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, 1, 0, 0, 0, NULL, 0, 1));
    CHECK(messages.take() == "Error (Add_Object obj 3 piece 0): Invalid piece id given to copy a piece: 1\n");
    /* The geometry stays when the original goes. */
    scene.Delete_Object(original);
    CHECK(!scene.Query_Exact_Distance(false, 2, pairs, &oids, &distances) && pairs == 1 && is_near(distances[0], 1));
}

void centre_of_mass()
{
    Messages messages;
    /* A pyramid over a square: the surface's centroid is lower than the volume's, which is a quarter of the height. */
    const SWIFT_Real vertices[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 3};
    const int faces[] = {3, 2, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}, valences[] = {4, 3, 3, 3, 3};
    const SWIFT_Real away[3] = {1, 2, 3};
    SWIFT_Scene scene;
    int id;
    CHECK(scene.Add_Convex_Object(vertices, faces, 5, 5, id, false, DEFAULT_ORIENTATION, away, 2, 0, 0, 0, valences));
    move_to(scene, id, 50, 50, 50);
    SWIFT_Real x, y, z;
    scene.Get_Center_Of_Mass(id, x, y, z);
    const double side = std::sqrt(10.0); /* the area of a side; the bottom's is 4 */
    CHECK(is_near(x, 1) && is_near(y, 2) && is_near(z, 3 + 2 * (4 * side * 1) / (4 * side + 4)));
    scene.Get_Center_Of_Mass(4, x, y, z);
    CHECK(is_same(x, 0) && is_same(y, 0) && is_same(z, 0) && messages.has("Get_Center_Of_Mass: 4"));
}

} // namespace

int main()
{
    constants();
    ids_and_deletion();
    refused_meshes();
    transformations();
    activation();
    copies();
    centre_of_mass();
    return check_report("legacy_methods");
}
