/*
 * Files of SWIFT++'s decomposer, written: decompositions as they were read, byte for byte; bodies that were decomposed here, which
 * answer the same once they are read back; hierarchies, whose every field is looked at; and what cannot be written.
 */
#include "legacy_rod.h"
#include "legacy_solids.h"

namespace {

std::string content_of(const std::string& path)
{
    std::ifstream stream(path.c_str(), std::ios::in | std::ios::binary);
    std::ostringstream content;
    content << stream.rdbuf();
    return content.str();
}

bool is_big_endian()
{
    const uint16_t one = 1;
    char low;
    std::memcpy(&low, &one, 1);
    return low == 0;
}

/* What is read in any form is written in that of this machine, and is the file that the decomposer would write there. */
void files_as_they_were(const Folder& folder)
{
    Messages messages;
    for (int form = 0; form < 8; ++form) {
        const bool has_maps = (form & 4) != 0;
        const Rod file((form & 1) != 0, (form & 2) != 0, has_maps);
        const Rod native(is_big_endian(), sizeof(SWIFT_Real) == sizeof(float), has_maps);
        SWIFT_Scene scene(false);
        int rod = -1, tree = -1;
        CHECK(scene.Add_General_Object(folder.write("rod.dcp", file.decomposition()).c_str(), rod));
        CHECK(scene.Add_General_Object(folder.write("rod.chr", file.hulls()).c_str(), tree));
        CHECK(scene.Save_Decomposition_File(folder.path("rod.saved").c_str(), rod));
        CHECK(content_of(folder.path("rod.saved")) == native.decomposition());
        /* The hierarchy has the same pieces. */
        CHECK(scene.Save_Decomposition_File(folder.path("rod.saved").c_str(), tree));
        CHECK(content_of(folder.path("rod.saved")) == native.decomposition());
    }
    CHECK(messages.take().empty());
}

/* A wheel of teeth. */
Solid gear(int teeth)
{
    std::vector<double> corners;
    for (int i = 0; i < 4 * teeth; ++i) {
        const double angle = 8 * std::atan(1.0) * i / (4 * teeth), radius = i % 4 < 2 ? 1.0 : 0.7;
        corners.push_back(radius * std::cos(angle));
        corners.push_back(radius * std::sin(angle));
    }
    return extruded(reinterpret_cast<const double(*)[2]>(&corners[0]), 4 * teeth);
}

/* A ring of quadrangles around the z axis. */
Solid torus(int around, int across)
{
    const double m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, full = 8 * std::atan(1.0);
    Solid solid;
    for (int i = 0; i < around; ++i) {
        for (int k = 0; k < across; ++k) {
            const double u = full * i / around, v = full * k / across, radius = 1 + 0.4 * std::cos(v);
            solid.add_vertex(m, radius * std::cos(u), radius * std::sin(u), 0.4 * std::sin(v));
        }
    }
    for (int i = 0; i < around; ++i) {
        for (int k = 0; k < across; ++k) {
            const int next = (i + 1) % around, above = (k + 1) % across;
            const int quad[4] = {across * i + k, across * next + k, across * next + above, across * i + above};
            solid.add_face(4, quad);
        }
    }
    return solid;
}

Solid turned(Solid solid, Numbers& numbers)
{
    double m[9];
    numbers.rotation(m);
    for (std::size_t v = 0; v < solid.vertices.size(); v += 3) {
        const double p[3] = {solid.vertices[v], solid.vertices[v + 1], solid.vertices[v + 2]};
        for (std::size_t i = 0; i < 3; ++i) {
            solid.vertices[v + i] = m[3 * i] * p[0] + m[3 * i + 1] * p[1] + m[3 * i + 2] * p[2];
        }
    }
    return solid;
}

/* Looks at all that a hierarchy of this machine's form holds. */
class HullTreeReading {
public:
    /* `margin` is how far a vertex may be above a face, by the precision of the mesh. */
    HullTreeReading(const std::string& bytes, double margin) : bytes_(bytes), at_(0), margin_(margin)
    {
        const std::string words(bytes_, 1, bytes_.find("nodes ") + 16);
        std::istringstream head(words);
        std::string skipped;
        head >> skipped >> skipped >> skipped >> skipped >> skipped;
        for (int i = 0; i < 9; ++i) {
            head >> skipped >> counts[i];
        }
        at_ = bytes_.find('\n', bytes_.find("nodes ")) + 1;
    }

    void check()
    {
        const int vertices = counts[0], surface = counts[3], all = counts[5];
        CHECK(counts[4] == 0);
        const int height = integer();
        const double body_radius = (real(), real(), real(), real(), real(), real(), real());
        CHECK(body_radius > 0);
        for (int i = 0; i < 3 * vertices; ++i) {
            coordinates_.push_back(real());
        }
        for (int i = 0; i < counts[1] + counts[2]; ++i) {
            CHECK(integer() >= 0);
        }
        for (int i = 0; i < 4 * all; ++i) {
            faces_.push_back(integer());
        }
        for (int i = 0; i < counts[6]; ++i) {
            shared_.push_back(integer());
        }
        for (int i = 0; i < 3 * surface; ++i) {
            const int twin = integer();
            CHECK(twin >= 0 && twin / 4 < surface);
            CHECK(tail(twin) == head(4 * (i / 3) + i % 3) && head(twin) == tail(4 * (i / 3) + i % 3));
        }
        int twin_count = 0;
        for (int face = 0; face < all; ++face) {
            first_twin_.push_back(twin_count);
            twin_count += 3 * levels(face);
        }
        CHECK(twin_count == counts[7]);
        for (int i = 0; i < twin_count; ++i) {
            twins_.push_back(integer());
        }
        std::vector<int> held(static_cast<std::size_t>(surface), 0), at_level(1, 0);
        int first_shared = 0, first_own = surface, deepest = 0;
        for (int node = 0; node < counts[8]; ++node) {
            int members[8];
            for (int i = 0; i < 8; ++i) {
                members[i] = integer();
            }
            const double centre[3] = {real(), real(), real()}, radius = real();
            std::vector<int> hull(shared_.begin() + first_shared, shared_.begin() + first_shared + members[0]);
            CHECK(members[1] == first_shared && members[3] == first_own);
            for (int i = 0; i < members[2]; ++i) {
                hull.push_back(first_own + i);
            }
            first_shared += members[0];
            first_own += members[2];
            if (members[5] < 0) {
                for (int i = 0; i < members[0]; ++i) {
                    ++held[static_cast<std::size_t>(hull[static_cast<std::size_t>(i)])];
                }
            }
            CHECK((members[4] < 0) == (node == 0));
            deepest = std::max(deepest, members[7]);
            check_hull(hull, members[7], centre, radius);
        }
        CHECK(deepest == height && first_own == all && at_ == bytes_.size());
        for (std::size_t i = 0; i < held.size(); ++i) {
            CHECK(held[i] == 1);
        }
    }

    int counts[9]; /* in the order of the head */

private:
    const std::string bytes_;
    std::size_t at_;
    double margin_;
    std::vector<double> coordinates_;
    std::vector<int> faces_, shared_, twins_, first_twin_;

    int integer()
    {
        int32_t number;
        std::memcpy(&number, &bytes_[at_], sizeof number);
        at_ += sizeof number;
        return number;
    }

    double real()
    {
        SWIFT_Real number;
        std::memcpy(&number, &bytes_[at_], sizeof number);
        at_ += sizeof number;
        return number;
    }

    int tail(int half_edge) const
    {
        return faces_[static_cast<std::size_t>(half_edge)];
    }

    int head(int half_edge) const
    {
        return faces_[static_cast<std::size_t>(half_edge / 4 * 4 + (half_edge % 4 + 1) % 3)];
    }

    int bits(int face) const
    {
        return faces_[static_cast<std::size_t>(4 * face + 3)];
    }

    int levels(int face) const
    {
        return bits(face) >> 24 & 0xff;
    }

    int twin(int half_edge, int level) const
    {
        const int face = half_edge / 4, place = level - (bits(face) >> 16 & 0xff);
        CHECK(place >= 0 && place < levels(face));
        return twins_[static_cast<std::size_t>(first_twin_[static_cast<std::size_t>(face)] + half_edge % 4 * levels(face) + place)];
    }

    const double* place(int vertex) const
    {
        return &coordinates_[3 * static_cast<std::size_t>(vertex)];
    }

    /* Closed, convex about all its corners, around its centre, and with a look-up table of the farthest vertices. */
    void check_hull(const std::vector<int>& hull, int level, const double* centre, double radius)
    {
        double most = 0;
        for (std::size_t i = 0; i < hull.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                const int edge = 4 * hull[i] + k, across = twin(edge, level);
                CHECK(std::find(hull.begin(), hull.end(), across / 4) != hull.end());
                CHECK(tail(across) == head(edge) && head(across) == tail(edge) && twin(across, level) == edge);
                double square = 0;
                for (int axis = 0; axis < 3; ++axis) {
                    square += (place(tail(edge))[axis] - centre[axis]) * (place(tail(edge))[axis] - centre[axis]);
                }
                most = std::max(most, std::sqrt(square));
            }
            for (std::size_t j = 0; j < hull.size(); ++j) {
                CHECK(height(hull[i], place(tail(4 * hull[j]))) <= margin_);
            }
        }
        CHECK(std::fabs(most - radius) <= 1e-5);
        CHECK(integer() == 0);
        for (int entry = 0; entry < 114; ++entry) {
            const double step = std::atan(1.0) / 2, pole = (entry == 112 ? 4 : -4) * step;
            const double north = entry < 112 ? (3 - entry / 16) * step : pole;
            const double east = entry % 16 * step;
            const double direction[3] = {std::cos(north) * std::cos(east), std::cos(north) * std::sin(east), std::sin(north)};
            const int edge = integer();
            CHECK(std::find(hull.begin(), hull.end(), edge / 4) != hull.end());
            for (std::size_t j = 0; j < hull.size(); ++j) {
                CHECK(along(direction, place(tail(4 * hull[j]))) <= along(direction, place(tail(edge))) + 1e-6);
            }
        }
    }

    static double along(const double* direction, const double* point)
    {
        return direction[0] * point[0] + direction[1] * point[1] + direction[2] * point[2];
    }

    /* Of a point over the plane of a face. */
    double height(int face, const double* point) const
    {
        const double *a = place(tail(4 * face)), *b = place(tail(4 * face + 1)), *c = place(tail(4 * face + 2));
        double normal[3], square = 0, sum = 0;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            normal[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
            square += normal[i] * normal[i];
        }
        for (int i = 0; i < 3; ++i) {
            sum += normal[i] * (point[i] - a[i]);
        }
        return sum / std::sqrt(square);
    }
};

/*
 * The distance of each of several objects from a box at many poses: all of them are the same, up to the precision of the mesh where
 * the pieces may be others. Then a box inside of the body need not meet one.
 */
void check_same_answers(SWIFT_Scene& scene, const int* bodies, int count, double margin, Numbers& numbers)
{
    const BoxMesh box(0.2, 0.3, 0.1);
    int cube = -1;
    CHECK(box.add(scene, cube));
    scene.Deactivate();
    for (int i = 0; i < count; ++i) {
        scene.Activate(bodies[i], cube);
    }
    for (int pose = 0; pose < 40; ++pose) {
        double m[9];
        SWIFT_Real R[9];
        numbers.rotation(m);
        std::copy(m, m + 9, R);
        const SWIFT_Real T[3] = {static_cast<SWIFT_Real>(4 * numbers.next() - 2), static_cast<SWIFT_Real>(4 * numbers.next() - 2),
                                 static_cast<SWIFT_Real>(2 * numbers.next() - 1)};
        scene.Set_Object_Transformation(cube, R, T);
        int pairs, *ids;
        SWIFT_Real* distances;
        scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances);
        CHECK(pairs == count);
        for (int i = 1; i < pairs; ++i) {
            CHECK(std::fabs(distances[i] - distances[0]) <= margin || (margin > 1e-3 && distances[0] < 0));
        }
    }
}

/* Written, read and written again: the same bytes, and the same answers. */
void there_and_back(const Folder& folder, const Solid& solid, int decimals, Numbers& numbers)
{
    Messages messages;
    SWIFT_Scene scene(false);
    const std::string mesh = folder.write("saving.poly", solid.file(decimals)), decomposition = folder.path("saving.dcp"),
                      hierarchy = folder.path("saving.chr"), again = folder.path("saving.again");
    int body = -1, pieces = -1, leaves = -1;
    if (!CHECK(scene.Add_General_Object(mesh.c_str(), body) && scene.Save_Decomposition_File(decomposition.c_str(), body) &&
               scene.Save_Hierarchy_File(hierarchy.c_str(), body) && scene.Add_General_Object(decomposition.c_str(), pieces) &&
               scene.Add_General_Object(hierarchy.c_str(), leaves))) {
        std::printf("%s", messages.take().c_str());
        return;
    }
    const int bodies[3] = {body, pieces, leaves};
    for (int i = 1; i < 3; ++i) {
        CHECK(scene.Save_Hierarchy_File(again.c_str(), bodies[i]) && content_of(again) == content_of(hierarchy));
    }
    CHECK(scene.Save_Decomposition_File(again.c_str(), pieces) && content_of(again) == content_of(decomposition));
    /* Twice the four units of the last place that are excused, and floats. */
    const double margin = std::max(8 * std::pow(10.0, -decimals), 1e-5);
    HullTreeReading(content_of(hierarchy), margin).check();
    check_same_answers(scene, bodies, 3, margin, numbers);
    CHECK(messages.take().empty());
}

/* Where an object stands does not matter; what its input transform made of it does. */
void in_the_local_frame(const Folder& folder)
{
    SWIFT_Scene scene(false);
    const BoxMesh box(1, 1, 1);
    const SWIFT_Translation away = {2, 0, 0};
    int body = -1, saved = -1;
    const std::string path = folder.path("frame.chr");
    CHECK(scene.Add_Convex_Object(box.vertices, box.quads, 8, 6, body, false, DEFAULT_ORIENTATION, away, 0.5, BOX_SETTING_DEFAULT, 0,
                                  0, box.valences));
    move_to(scene, body, 0, 7, 0);
    CHECK(scene.Save_Hierarchy_File(path.c_str(), body) && scene.Add_General_Object(path.c_str(), saved));
    HullTreeReading reading(content_of(path), 0);
    reading.check();
    CHECK(reading.counts[0] == 8 && reading.counts[3] == 12 && reading.counts[8] == 1);
    SWIFT_Real x, y, z;
    scene.Get_Center_Of_Mass(saved, x, y, z);
    CHECK(is_near(x, 2) && is_near(y, 0) && is_near(z, 0));
    int pairs, *ids;
    SWIFT_Real* distances;
    CHECK(!scene.Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances) && pairs == 1 && is_near(distances[0], 6));
}

void refused(const Folder& folder)
{
    Messages messages;
    SWIFT_Scene scene(false);
    const BoxMesh box(1, 1, 1);
    int body = -1, several = -1, hull = -1;
    CHECK(box.add(scene, body));
    CHECK(!scene.Save_Decomposition_File(NULL, body) && messages.take() == "Error: Invalid filename given to write decomp\n");
    CHECK(!scene.Save_Hierarchy_File(NULL, body) && messages.take() == "Error: Invalid filename given to write model\n");
    /* A folder, one that there is not, a file in its place. */
    folder.write("file", "");
    const std::string places[3] = {folder.path("."), folder.path("none/box.dcp"), folder.path("file/box.dcp")};
    for (int i = 0; i < 3; ++i) {
        const std::string message = "Error: file could not be opened for writing \"" + places[i] + "\"\n";
        CHECK(!scene.Save_Decomposition_File(places[i].c_str(), body) && messages.take() == message);
        CHECK(!scene.Save_Hierarchy_File(places[i].c_str(), body) && messages.take() == message);
    }
    if (std::ofstream("/dev/full")) {
        const char* const message = "could not be written whole, is the disk full? \"/dev/full\"";
        CHECK(!scene.Save_Decomposition_File("/dev/full", body) && messages.has(message));
        CHECK(!scene.Save_Hierarchy_File("/dev/full", body) && messages.has(message));
    }
    const std::string path = folder.write("kept", "as it was");
    CHECK(!scene.Save_Hierarchy_File(path.c_str(), 7) && messages.has("Object id out of range given to Save_Hierarchy_File: 7"));
    const SWIFT_Real* vertices[2] = {box.vertices, box.vertices};
    const int* faces[2] = {box.triangles, box.triangles};
    const int eight[2] = {8, 8}, twelve[2] = {12, 12};
    CHECK(scene.Add_Pieced_Object(vertices, faces, eight, twelve, 2, several));
    CHECK(!scene.Save_Decomposition_File(path.c_str(), several));
    CHECK(messages.has("Error (Save_Decomposition_File obj 1 piece 0): a file of the decomposer has one object, not 2 pieces"));
    scene.Set_Take_Hull(true);
    CHECK(scene.Add_General_Object(folder.write("hull.poly", extruded(L_POLYGON, 6).file(3)).c_str(), hull));
    CHECK(!scene.Save_Hierarchy_File(path.c_str(), hull) && messages.has("the convex hull of piece 0 counts"));
    CHECK(content_of(path) == "as it was");
    /* Both sides of a square have its diagonal. */
    const SWIFT_Real square[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const int sides[8] = {0, 1, 2, 3, 0, 3, 2, 1}, four[2] = {4, 4};
    int flat = -1, read = -1;
    CHECK(scene.Add_Convex_Object(square, sides, 4, 2, flat, false, DEFAULT_ORIENTATION, DEFAULT_TRANSLATION, 1, 0, 0, 0, four));
    CHECK(!scene.Save_Hierarchy_File(path.c_str(), flat) && messages.has("the hull of node 0 is not closed"));
    CHECK(content_of(path) == "as it was");
    CHECK(scene.Save_Decomposition_File(folder.path("square.dcp").c_str(), flat));
    CHECK(scene.Add_General_Object(folder.path("square.dcp").c_str(), read) && messages.take().empty());
    scene.Delete_Object(body);
    CHECK(!scene.Save_Decomposition_File(path.c_str(), body) && messages.has("Object id out of range"));
}

} // namespace

int main(int argc, char** argv)
{
    const Folder folder(argc, argv);
    Numbers numbers(7);
    files_as_they_were(folder);
    there_and_back(folder, extruded(L_POLYGON, 6), 3, numbers);
    there_and_back(folder, gear(7), 6, numbers);
    for (int decimals = 3; decimals <= 8; decimals += 5) {
        there_and_back(folder, turned(extruded(L_POLYGON, 6), numbers), decimals, numbers);
        there_and_back(folder, turned(gear(5), numbers), decimals, numbers);
        there_and_back(folder, turned(torus(8, 5), numbers), decimals, numbers);
    }
    /* Dense for its decimals: patches are bent, some into flat pieces. */
    there_and_back(folder, turned(torus(12, 10), numbers), 3, numbers);
    in_the_local_frame(folder);
    refused(folder);
    return check_report("legacy_saving");
}
