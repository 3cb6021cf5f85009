/*
 * A planner that reads the first entry of each array without looking at the count, an application whose bodies lie far from their
 * origins, and the contact of a body that is not convex.
 */
#include "legacy_rod.h"

#include <SWIFT_mesh.h>

namespace {

/* Each array is there, and its first entry can be read and written. */
template <class Value> bool has_entry(Value* array, int size)
{
    for (int i = 0; array != NULL && i < size; ++i) {
        array[i] = static_cast<Value>(array[i] + 1 - 1);
    }
    return array != NULL;
}

/* Two boxes, `apart` from centre to centre; with early exit or without, within a tolerance or beyond: arrays are there. */
void arrays(double apart, bool exits_early)
{
    SWIFT_Scene scene(false);
    const BoxMesh box(0.5, 0.5, 0.5);
    int first = -1, second = -1;
    CHECK(box.add(scene, first) && box.add(scene, second));
    move_to(scene, second, apart, 0, 0);
    const bool intersects = apart <= 1;
    const int listed = intersects && !exits_early ? 1 : 0;
    const SWIFT_Real tolerance = static_cast<SWIFT_Real>(0.25);
    int pairs, *ids = NULL, *counts = NULL, *pids = NULL, *types = NULL, *features = NULL;
    SWIFT_Real *distances = NULL, *points = NULL, *normals = NULL, *errors = NULL;
    CHECK(scene.Query_Intersection(exits_early, pairs, &ids) == intersects && pairs == listed && has_entry(ids, 2));
    ids = NULL;
    CHECK(scene.Query_Tolerance_Verification(exits_early, tolerance, pairs, &ids) == intersects && has_entry(ids, 2));
    ids = NULL;
    CHECK(scene.Query_Exact_Distance(exits_early, tolerance, pairs, &ids, &distances) == intersects && pairs == listed);
    CHECK(has_entry(ids, 2) && has_entry(distances, 1));
    /* What ended the query is in its place. */
    CHECK(intersects ? is_same(distances[0], -1) && ids[0] == 0 && ids[1] == 1 : is_same(distances[0], 0));
    CHECK((scene.Get_Answer(0) != NULL) == (listed == 1));
    ids = NULL, distances = NULL;
    scene.Query_Approximate_Distance(exits_early, tolerance, 0, pairs, &ids, &distances, &errors);
    CHECK(pairs == listed && has_entry(ids, 2) && has_entry(distances, 1) && has_entry(errors, 1));
    ids = NULL, distances = NULL;
    CHECK(scene.Query_Contact_Determination(exits_early, tolerance, pairs, &ids, &distances, &points, &normals, &pids, &types,
                                            &features) == intersects);
    CHECK(pairs == listed && has_entry(ids, 2) && has_entry(distances, 1) && has_entry(points, 6) && has_entry(normals, 3));
    CHECK(has_entry(pids, 2) && has_entry(types, 2) && has_entry(features, 4));
    ids = types = features = NULL, distances = points = normals = NULL;
    CHECK(scene.Query_Contact_Determination(exits_early, tolerance, pairs, &ids, &counts, &distances, &points, &normals, &types,
                                            &features) == intersects);
    CHECK(pairs == listed && has_entry(ids, 2) && has_entry(counts, 1) && has_entry(distances, 1) && has_entry(points, 6));
    CHECK(has_entry(normals, 3) && has_entry(types, 2) && has_entry(features, 4));
}

/*
 * A box that is 0.5 to 1.5 from the origin of its frame along each axis. SWIFT++ measures its cube from that origin, so it reaches
 * farther than the body, and the pair is listed without a tolerance; measured from the centroid it was not. SWIFT 1.x lists less.
 */
void far_from_the_origin()
{
    BoxMesh far(0.5, 0.5, 0.5);
    const BoxMesh box(0.5, 0.5, 0.5);
    for (int i = 0; i < 24; ++i) {
        far.vertices[i] += 1;
    }
    const double reach = std::sqrt(3 * 1.5 * 1.5) + std::sqrt(0.75);
    for (int by_old = 0; by_old < 2; ++by_old) {
        SWIFT_Scene scene;
        int first = -1, second = -1, copy = -1, pairs, *ids;
        SWIFT_Real* distances;
        if (by_old == 0) {
            CHECK(far.add(scene, first) && box.add(scene, second));
        } else {
            CHECK(scene.Add_Object(far.vertices, far.triangles, 8, 12, first));
            CHECK(scene.Add_Object(box.vertices, box.triangles, 8, 12, second));
        }
        move_to(scene, second, 0.99 - reach, 0, 0);
        CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1 - by_old);
        CHECK(by_old == 1 || is_near(distances[0], reach - 0.99));
        move_to(scene, second, 2 - reach, 0, 0);
        CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1 - by_old);
        CHECK(scene.Copy_Object(first, copy));
        CHECK(scene.Query_Intersection(false, pairs, &ids) && pairs == 1);
        move_to(scene, second, -50, 0, 0);
        CHECK(scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1);
    }
}

/*
 * The one contact of a body in two pieces is the nearest: SWIFT++ counted what it had found on the way to it as well, in an order
 * that nobody could rely on.
 */
void contacts(const Folder& folder)
{
    const BoxMesh box(0.5, 0.4, 0.3);
    SWIFT_Scene scene(false);
    int rod = -1, other = -1, pairs, *ids, *counts;
    SWIFT_Real *distances, *points;
    CHECK(scene.Add_General_Object(folder.write("rod.dcp", Rod(false, false, true).decomposition()).c_str(), rod));
    CHECK(box.add(scene, other));
    for (int step = 0; step < 400; ++step) {
        const Rotation turn(step % 3, 0.1 + 0.37 * step);
        const SWIFT_Real T[3] = {static_cast<SWIFT_Real>(step % 4 == 0 ? 0 : 3 * std::sin(1.0 * step)),
                                 static_cast<SWIFT_Real>(0.5 + 2.5 * std::cos(0.7 * step)), static_cast<SWIFT_Real>(2.2)};
        scene.Set_Object_Transformation(other, turn.m, T);
        CHECK(!scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points) && pairs == 1);
        double placed[3], sum = 0;
        place_point(turn.m, T, points + 3, placed);
        for (int i = 0; i < 3; ++i) {
            sum += (placed[i] - points[i]) * (placed[i] - points[i]);
        }
        const double nearest = distances[0];
        CHECK(counts[0] == 1 && is_near(std::sqrt(sum), nearest));
        scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances);
        CHECK(is_near(distances[0], nearest));
    }
}

/* A reader as they were written for the headers of old: with their names, without namespaces. */
class OldReader : public SWIFT_File_Reader {
public:
    virtual bool Read(ifstream& fin, SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv)
    {
        istream& stream = fin;
        if (!stream.good()) {
            cerr << "no stream" << endl;
            return false;
        }
        const BoxMesh box(1, 1, 1);
        vn = 8, fn = 12;
        vs = new SWIFT_Real[24];
        fs = new int[36];
        fv = NULL;
        std::copy(box.vertices, box.vertices + 24, vs);
        std::copy(box.triangles, box.triangles + 36, fs);
        return true;
    }
};

void old_names(const Folder& folder)
{
    static OldReader reader;
    SWIFT_Scene scene(false);
    int id;
    CHECK(scene.Register_File_Reader("OLDBOX", &reader));
    CHECK(scene.Add_Object(folder.write("old.box", "OLDBOX\n").c_str(), id));
    ostream& out = cout;
    ofstream unused;
    unused.setstate(ios::failbit);
    CHECK(out.good() && cin.good() && !unused);
}

} // namespace

int main(int argc, char** argv)
{
    const Folder folder(argc, argv);
    for (int exits_early = 0; exits_early < 2; ++exits_early) {
        arrays(0.75, exits_early != 0);
        arrays(3, exits_early != 0);
    }
    far_from_the_origin();
    contacts(folder);
    old_names(folder);
    return check_report("legacy_planner");
}
