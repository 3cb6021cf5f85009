/*
 * Two TRI files, one of which is never moved, and all that is asked about contacts within 2; readers of the program's own; files
 * that are damaged.
 */
#include "legacy_test.h"

#include <sys/stat.h>
#include <unistd.h>

namespace {

void two_files(const Folder& folder)
{
    const std::string first = folder.write("first.tri", box_file(BoxMesh(1, 1, 1), false));
    const std::string second = folder.write("second.tri", box_file(BoxMesh(0.5, 0.5, 0.5), false));
    SWIFT_Scene* scene = new SWIFT_Scene(true, false);
    int ids[2];
    CHECK(scene->Add_General_Object(first.c_str(), ids[0], false));
    CHECK(scene->Add_General_Object(second.c_str(), ids[1], false));
    int pairs, *oids, *counts, *types, *feature_ids;
    SWIFT_Real *distances, *points, *normals;
    for (int step = 0; step <= 8; ++step) {
        const double x = 4 - 0.5 * step;
        const SWIFT_Real T[3] = {static_cast<SWIFT_Real>(x), 0, 0};
        scene->Set_Object_Transformation(ids[1], Rotation(0, 0).m, T);
        const bool hits = scene->Query_Contact_Determination(false, 2.0, pairs, &oids, &counts, &distances, &points, &normals, &types,
                                                             &feature_ids);
        /* Not at exactly the tolerance, as SWIFT++; touching at 1.5. The boxes in the way are smaller than 2: none is missed. */
        CHECK(hits == (x <= 1.5));
        CHECK(pairs == (x < 3.5 ? 1 : 0));
        if (pairs == 1) {
            CHECK(oids[0] == 0 && oids[1] == 1 && counts[0] == (hits ? -1 : 1));
            CHECK(is_near(distances[0], hits ? -1 : x - 1.5));
        }
        if (pairs == 1 && !hits) {
            CHECK(is_near3(normals, -1, 0, 0) && is_near(points[0], 1) && is_near(points[3], -0.5));
        }
    }
    delete scene;
}

/* The format of one program: the number of a cube's half side. */
class CubeReader : public SWIFT_File_Reader {
public:
    int calls;

    CubeReader() : calls(0) {}

    bool Read(ifstream& fin, SWIFT_Real*& vs, int*& fs, int& vn, int& fn, int*& fv)
    {
        ++calls;
        std::string magic;
        double half;
        if (!(fin >> magic >> half)) {
            return false;
        }
        const BoxMesh box(half, half, half);
        vs = new SWIFT_Real[24];
        fs = new int[24];
        fv = new int[6];
        std::copy(box.vertices, box.vertices + 24, vs);
        std::copy(box.quads, box.quads + 24, fs);
        std::copy(box.valences, box.valences + 6, fv);
        vn = 8;
        fn = 6;
        return true;
    }
};

/* It has taken memory when it fails. */
class FailingReader : public SWIFT_File_Reader {
public:
    bool Read(ifstream&, SWIFT_Real*& vs, int*& fs, int&, int&, int*&)
    {
        vs = new SWIFT_Real[3];
        fs = new int[3];
        return false;
    }
};

void own_readers(const Folder& folder)
{
    Messages messages;
    SWIFT_Scene scene(false), other(false);
    CubeReader reader, better;
    FailingReader failing;
    CHECK(scene.Register_File_Reader("CUBE", &reader));
    CHECK(messages.take().empty());
    int id = -1;
    CHECK(scene.Add_Object(folder.write("own.cube", "  \n CUBE 0.5\n").c_str(), id) && id == 0 && reader.calls == 1);
    /* All scenes have it; what it is called does not count. */
    CHECK(other.Add_General_Object(folder.write("own.tri", "CUBE 2").c_str(), id) && id == 0 && reader.calls == 2);
    SWIFT_Real x, y, z;
    other.Get_Center_Of_Mass(id, x, y, z);
    CHECK(is_near(x, 0) && is_near(y, 0) && is_near(z, 0));
    CHECK(messages.take().empty());
    /* The same magic is replaced with a warning, one that begins like it is refused. */
    CHECK(other.Register_File_Reader("CUBE", &better));
    CHECK(messages.take() ==
          "Warning (Register_File_Reader): Replacing already registered file reader for magic number: \"CUBE\"\n");
    CHECK(scene.Add_Object(folder.write("again.cube", "CUBE 1").c_str(), id) && id == 1 && better.calls == 1);
    CHECK(!scene.Register_File_Reader("CUB", &reader) && messages.has("\"CUB\""));
    CHECK(!scene.Register_File_Reader("CUBES", &reader) && messages.has("\"CUBES\""));
    CHECK(!scene.Register_File_Reader("TRIANGLES", &reader) && messages.has("\"TRI\""));
    CHECK(!scene.Register_File_Reader("", &reader) && !scene.Register_File_Reader(NULL, &reader));
    CHECK(!scene.Register_File_Reader("A B", &reader) && !scene.Register_File_Reader("NONE", NULL));
    CHECK(scene.get_File_Read_Dispatcher()->Register("FAIL", &failing));
    messages.take();
    id = 77;
    CHECK(!scene.Add_Object(folder.write("failing", "FAIL").c_str(), id) && id == 77);
    CHECK(messages.take() == "Error (Add_Object obj 2 piece 0): File read failed\n");
}

void formats(const Folder& folder)
{
    const BoxMesh box(1, 2, 3);
    std::ostringstream obj;
    obj << "#OBJ\n# a comment\n";
    for (int v = 0; v < 8; ++v) {
        obj << "v " << box.vertices[3 * v] << " " << box.vertices[3 * v + 1] << " " << box.vertices[3 * v + 2] << "\n";
    }
    for (int f = 0; f < 6; ++f) {
        obj << "f";
        for (int c = 0; c < 4; ++c) {
            const int v = box.quads[4 * f + c];
            obj << " ";
            if (f == 0) {
                obj << v + 1;
            } else if (f == 1) {
                obj << v + 1 << "/7";
            } else if (f == 2) {
                obj << v + 1 << "/7/8";
            } else if (f == 3) {
                obj << v + 1 << "//8";
            } else {
                obj << v - 8;
            }
        }
        obj << "\n";
    }
    std::vector<std::string> files;
    files.push_back(folder.write("box.tri", "\n\t " + box_file(box, false) + "\nwhat stands behind"));
    files.push_back(folder.write("box.poly", box_file(box, true)));
    files.push_back(folder.write("box.obj", obj.str()));
    SWIFT_Scene scene(false);
    for (std::size_t i = 0; i < files.size(); ++i) {
        int id = -1;
        CHECK(scene.Add_Object(files[i].c_str(), id) && id == static_cast<int>(i));
        move_to(scene, id, 10 * static_cast<double>(i), 0, 0);
    }
    int pairs, *ids, *types, *feature_ids;
    SWIFT_Real* distances;
    CHECK(!scene.Query_Contact_Determination(false, 9, pairs, &ids, &distances, NULL, NULL, NULL, &types, &feature_ids));
    CHECK(pairs == 2 && is_near(distances[0], 8) && is_near(distances[1], 8));
    /* A face is a polygon of the file: with x = 1 the sixth, with x = -1 the fifth; of triangles two each. */
    int at = 0;
    for (int k = 0; k < 2; ++k) {
        for (int side = 0; side < 2; ++side) {
            const int type = types[2 * k + side], polygon = side == 0 ? 5 : 4;
            if (type == SWIFT_FACE) {
                CHECK((ids[2 * k + side] == 0 ? feature_ids[at] / 2 : feature_ids[at]) == polygon);
            }
            at += type == SWIFT_EDGE ? 2 : 1;
        }
    }
}

void damaged(const Folder& folder)
{
    Messages messages;
    SWIFT_Scene scene(false);
    int id = 77;
    CHECK(!scene.Add_Object(static_cast<const char*>(NULL), id) && messages.has("Error: Invalid filename given to read file"));
    CHECK(!scene.Add_Object("there is no such file", id));
    CHECK(messages.take() == "Error: file could not be opened for reading \"there is no such file\"\n"
                             "Error (Add_Object obj 0 piece 0): File read failed\n");
    /* What is not there is not told to be convex. */
    CHECK(!scene.Add_General_Object("there is no such file", id));
    CHECK(messages.take() == "Error: file could not be opened for reading \"there is no such file\"\n");
    CHECK(!scene.Add_General_Object(folder.write("cut", "TRI 8 12 0").c_str(), id));
    const std::string general = messages.take();
    CHECK(general.find("onvex") == std::string::npos);
    CHECK(general.find("Error (Add_General_Object obj 0 piece 0): File read failed\n") != std::string::npos);
    const std::string tri = box_file(BoxMesh(1, 1, 1), false), poly = box_file(BoxMesh(1, 1, 1), true);
    const struct {
        const char* name;
        std::string content;
        const char* message;
    } cases[] = {
        {"unknown", "PLY 1 2 3", "can handle the type: \"PLY\""},
        {"empty", "", "can handle the type: \"\""},
        {"triangle", "TRIANGLE 3 1", "\"TRIANGLE\", not with TRI"},
        {"no counts", "TRI", "the numbers of vertices and faces are missing"},
        {"negative", "POLY -8 6 0", "not positive"},
        {"words", "TRI 4 4 0 0 zero", "vertex 0 is missing or no number"},
        {"huge", "TRI 2000000000 2000000000 0 0 0", "vertex 1 is missing"},
        {"cut off", tri.substr(0, tri.size() - 3), "face 11 is missing"},
        {"range", tri.substr(0, tri.size() - 2) + "8\n", "face 11 is missing or has a vertex that there is not"},
        {"two corners", poly.substr(0, poly.rfind("4 ")) + "2 0 1", "face 5 is missing"},
        {"open", poly.substr(0, 7) + poly.substr(7, poly.rfind("\n4 ") - 6), "Error: The mesh is not closed --\n       all edges"},
        {"obj vertex", "OBJ\nv 1 2\n", "line 2: a vertex has fewer than three coordinates"},
        {"obj face", "OBJ\nv 1 2 3\nf 1 1/2 x\n", "line 3: \"x\" is no vertex"},
        {"obj corners", "OBJ\nv 1 2 3\nf 1 1\n", "line 3: a face has fewer than three corners"},
        {"obj range", "OBJ\nv 1 2 3\nf 1 1 9\n", "a face names vertex 9 of 1"},
        {"obj zero", "OBJ\nv 1 2 3\nf 0 1 1\n", "line 3: \"0\" is no vertex"},
        {"obj empty", "#OBJ\n", "there are no vertices or no faces"},
    };
    for (std::size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        std::string content = cases[i].content;
        if (std::string(cases[i].name) == "open") {
            content[5] = '8', content[7] = '5';
        }
        const std::string file = folder.write(cases[i].name, content);
        CHECK(!scene.Add_Object(file.c_str(), id));
        const std::string said = messages.take();
        if (!CHECK(said.find(cases[i].message) != std::string::npos)) {
            std::printf("%s: %s", cases[i].name, said.c_str());
        }
        const bool is_mesh = std::string(cases[i].name) == "open";
        const std::string end = is_mesh ? "Mesh creation failed\n" : "File read failed\n";
        CHECK(said.find("Error (Add_Object obj 0 piece 0): " + end) != std::string::npos);
    }
    CHECK(id == 77);
    /* A file that failed does not spoil the next one. */
    CHECK(scene.Add_Object(folder.write("good", tri).c_str(), id) && id == 0);
}

/*
 * Cause: a file was opened as a stream whatever it is. Cut-off: a FIFO that nobody writes to is waited for, and reading a device
 * never ends. Repro: Add_Object with the name of a FIFO. The alarm ends a program that waits.
 */
void no_regular_files(const Folder& folder)
{
    const char* const names[] = {"fifo", "", "/dev/zero"};
    SWIFT_Scene scene(false, true);
    Messages messages;
    int id = 77;
    CHECK(mkfifo(folder.path(names[0]).c_str(), 0600) == 0);
    alarm(10);
    for (int i = 0; i < 3; ++i) {
        const std::string file = i < 2 ? folder.path(names[i]) : names[i];
        CHECK(!scene.Add_Object(file.c_str(), id) && id == 77);
        const std::string said = messages.take();
        CHECK(said.find("only regular files are read, not a pipe, a device or a folder \"" + file + "\"") != std::string::npos);
    }
    alarm(0);
    CHECK(std::remove(folder.path(names[0]).c_str()) == 0);
}

} // namespace

int main(int argc, char** argv)
{
    const Folder folder(argc, argv);
    two_files(folder);
    own_readers(folder);
    formats(folder);
    damaged(folder);
    no_regular_files(folder);
    return check_report("legacy_files");
}
