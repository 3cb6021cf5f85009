/*
 * Readers of mesh files that a program registers: which files they get, what they hand over, and everything that may be wrong
 * with it. Run under valgrind it shows that nothing is read or kept beyond a call.
 *
 *     mesh_reader [folder for the files that it writes]
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "swiftprox/process.h"

static const uint32_t FACES[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

static const char *folder = ".";

/* Writes a file of some content; its path, good until the next call. */
static const char *write_file(const char *name, const char *content)
{
    static char path[1024];
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "wb");
    if (CHECK(file != NULL)) {
        CHECK(fwrite(content, 1, strlen(content), file) == strlen(content));
        fclose(file);
    }
    return path;
}

/* Reads a file and says how many vertices, triangles and what radius its shape has; removes the file. */
static swiftprox_status read_file(const char *path, swiftprox_shape_info *info)
{
    const swiftprox_shape *shape = (const swiftprox_shape *)(void *)info; /* not null: a failure must make it so */
    const swiftprox_status status = swiftprox_shape_create_from_file(path, NULL, &shape);
    CHECK((status == SWIFTPROX_OK) == (shape != NULL));
    memset(info, 0, sizeof *info);
    info->struct_size = sizeof *info;
    if (status == SWIFTPROX_OK) {
        CHECK_OK(swiftprox_shape_get_info(shape, info));
    }
    swiftprox_shape_release(shape);
    remove(path);
    return status;
}

/* ---- a format: LINES, then a line "v x y z" for each vertex and "f a b c ..." for each face, from 0 ---- */

static int fail_at(swiftprox_mesh_sink *sink, int line, const char *what)
{
    char message[64];
    snprintf(message, sizeof message, "line %d: %s", line, what);
    CHECK_OK(swiftprox_mesh_sink_fail(sink, message));
    return -1;
}

/* The number of the calls is counted in an int, `user`. */
static int32_t read_lines(void *user, const char *data, size_t size, swiftprox_mesh_sink *sink)
{
    const char *at = strstr(data, "LINES");
    int line = 1;
    ++*(int *)user;
    /* The byte behind the file is zero: string functions end there. */
    CHECK(data[size] == '\0' && strlen(data) == size && at != NULL);
    while ((at = strchr(at, '\n')) != NULL && *++at != '\0') {
        char *end = (char *)at + 1;
        ++line;
        if (*at == 'v') {
            double position[3];
            int k;
            for (k = 0; k < 3; ++k) {
                at = end;
                position[k] = strtod(at, &end);
                if (end == at) {
                    return fail_at(sink, line, "a coordinate is missing");
                }
            }
            /* A refused call refuses the file; its status need not be looked at. */
            swiftprox_mesh_sink_add_vertices(sink, position, 1);
        } else if (*at == 'f') {
            uint32_t corners[8], valence = 0;
            for (; *end != '\n' && *end != '\0' && valence < 8; ++valence) {
                corners[valence] = (uint32_t)strtoul(end, &end, 10);
            }
            swiftprox_mesh_sink_add_faces(sink, corners, &valence, 1);
        } else {
            return fail_at(sink, line, "neither v nor f");
        }
    }
    return 0;
}

/* Faces before the vertices that they name. */
#define PYRAMID "LINES\nf 0 3 2 1\nf 0 1 4\nf 1 2 4\nf 2 3 4\nf 3 0 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n"

static void a_format(void)
{
    swiftprox_shape_info info;
    const char *path;
    int calls = 0;

    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "not a TRI", read_file(write_file("pyramid.lines", PYRAMID), &info));
    CHECK_OK(swiftprox_library_register_mesh_reader("LINES", read_lines, &calls));
    CHECK_OK(read_file(write_file("pyramid.lines", PYRAMID), &info));
    CHECK(info.vertex_count == 5 && info.face_count == 5 && calls == 1);
    CHECK_OK(read_file(write_file("pyramid", "\xef\xbb\xbf \t\r\n\f\v" PYRAMID), &info));
    CHECK_OK(read_file(write_file("pyramid.off", PYRAMID), &info));
    CHECK(info.vertex_count == 5 && calls == 3);

    path = write_file("pyramid.stl", PYRAMID);
    CHECK_OK(read_file(path, &info));
    CHECK(info.vertex_count == 5 && calls == 4);
    remove(path);
    path = write_file("bad.stl", "LINES\nv 0 0\n");
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "bad.stl: the reader registered for \"LINES\": line 2: a coordinate is missing",
                read_file(path, &info));
    CHECK(calls == 5);

    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "line 3: neither v nor f", read_file(write_file("a", "LINES\nv 0 0 0\ng\n"), &info));
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "vertex 1: y is not finite",
                read_file(write_file("a", "LINES\nv 0 0 0\nv 0 inf 0\n"), &info));
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "face 0, corner 2: vertex index 2 is out of range",
                read_file(write_file("a", "LINES\nf 0 1 2\nv 0 0 0\nv 1 0 0\n"), &info));
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "a: there are no vertices in it", read_file(write_file("a", "LINES\n"), &info));
    /* Read without fault, but no closed mesh. */
    CHECK_FAILS(SWIFTPROX_ERROR_MESH,
                "a: ", read_file(write_file("a", "LINES\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 0 1 2\n"), &info));

    /* Others are read as ever, and these no more once the reader is taken back. */
    CHECK_OK(read_file(write_file("box.tri", "TRI 4 4 0 0 0 1 0 0 0 1 0 0 0 1 0 2 1 0 1 3 1 2 3 0 3 2"), &info));
    CHECK(info.vertex_count == 4 && calls == 10);
    CHECK_OK(swiftprox_library_register_mesh_reader("LINES", NULL, NULL));
    CHECK_OK(swiftprox_library_register_mesh_reader("LINES", NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "not a TRI", read_file(write_file("pyramid", PYRAMID), &info));
    CHECK(calls == 10);
}

/* ---- what a callback is handed ---- */

/* Keeps that it was called with exactly the bytes that `user` points to; the file is refused. */
static int32_t compare_data(void *user, const char *data, size_t size, swiftprox_mesh_sink *sink)
{
    const char *expected = (const char *)user;
    CHECK(size == strlen(expected) && memcmp(data, expected, size + 1) == 0);
    CHECK_OK(swiftprox_mesh_sink_fail(sink, "compared"));
    return 1;
}

/* The whole file, with white space before the magic and the magic itself, without a byte order mark. */
static void data(void)
{
    static char content[] = " \t\r\n\f\vWHOLE 1\nend\n";
    char marked[sizeof content + 3] = "\xef\xbb\xbf";
    swiftprox_shape_info info;
    strcat(marked, content);
    CHECK_OK(swiftprox_library_register_mesh_reader("WHOLE", compare_data, content));
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "compared", read_file(write_file("whole.mesh", content), &info));
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "compared", read_file(write_file("whole.mesh", marked), &info));
    CHECK_OK(swiftprox_library_register_mesh_reader("WHOLE", NULL, NULL));
}

/* ---- what a callback may do wrong ---- */

/* One fault at a time, and what a file with it is refused for. */
enum fault {
    NONE,
    RETURNS,
    NULL_VERTICES,
    NULL_INDICES,
    NULL_MESSAGE,
    NO_NUMBER,
    TOO_MANY,
    WRAPPED_VALENCES,
    NO_SUCH_VERTEX,
    SAYS,
    SAYS_TWICE,
    REFUSED_AND_SAYS,
    FAULTS
};

static const char *const REFUSALS[FAULTS] = {
    NULL,
    "it returned 7",
    "`vertices` is null",
    "`indices` is null",
    "`message` is null",
    "vertex 4: z is not finite",
    "more than the limit",
    "the number of indices is",
    "face 4, corner 1: vertex index 4294967295 is out of range (4 vertices)",
    "\"FAULT\": byte 5 is wrong",
    "\"FAULT\": first",
    "\"FAULT\": line 2 is wrong",
};

/* A good tetrahedron, then the fault that `user` points to, whose status is not looked at. */
static int32_t read_faulty(void *user, const char *data, size_t size, swiftprox_mesh_sink *sink)
{
    static const double corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const double no_number[3] = {0, 0, NAN};
    static const uint32_t vast[2] = {UINT32_MAX, UINT32_MAX}, out_of_range[3] = {0, UINT32_MAX, 1};
    CHECK(size == 5 && memcmp(data, "FAULT", 6) == 0);
    CHECK_OK(swiftprox_mesh_sink_add_vertices(sink, corners, 4));
    CHECK_OK(swiftprox_mesh_sink_add_faces(sink, FACES, NULL, 4));
    CHECK_OK(swiftprox_mesh_sink_add_vertices(sink, NULL, 0));
    CHECK_OK(swiftprox_mesh_sink_add_faces(sink, NULL, NULL, 0));
    CHECK(swiftprox_mesh_sink_add_vertices(NULL, corners, 4) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_mesh_sink_add_faces(NULL, FACES, NULL, 4) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_mesh_sink_set_single_precision(NULL) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_mesh_sink_fail(NULL, "nobody hears") == SWIFTPROX_ERROR_NULL_POINTER);
    switch (*(const enum fault *)user) {
    case RETURNS:
        return 7;
    case NULL_VERTICES:
        CHECK(swiftprox_mesh_sink_add_vertices(sink, NULL, 1) == SWIFTPROX_ERROR_NULL_POINTER);
        break;
    case NULL_INDICES:
        CHECK(swiftprox_mesh_sink_add_faces(sink, NULL, NULL, 1) == SWIFTPROX_ERROR_NULL_POINTER);
        break;
    case NULL_MESSAGE:
        CHECK(swiftprox_mesh_sink_fail(sink, NULL) == SWIFTPROX_ERROR_NULL_POINTER);
        break;
    case NO_NUMBER:
        CHECK(swiftprox_mesh_sink_add_vertices(sink, no_number, 1) == SWIFTPROX_ERROR_MESH);
        break;
    case TOO_MANY:
        CHECK(swiftprox_mesh_sink_add_vertices(sink, corners, SIZE_MAX) == SWIFTPROX_ERROR_LIMIT);
        CHECK(swiftprox_mesh_sink_add_vertices(sink, corners, UINT32_MAX - 3) == SWIFTPROX_ERROR_LIMIT);
        CHECK(swiftprox_mesh_sink_add_faces(sink, FACES, NULL, SIZE_MAX) == SWIFTPROX_ERROR_LIMIT);
        break;
    case WRAPPED_VALENCES:
        CHECK(swiftprox_mesh_sink_add_faces(sink, FACES, vast, 2) == SWIFTPROX_ERROR_LIMIT);
        break;
    case NO_SUCH_VERTEX:
        CHECK_OK(swiftprox_mesh_sink_add_faces(sink, out_of_range, NULL, 1));
        break;
    case SAYS:
        CHECK_OK(swiftprox_mesh_sink_fail(sink, "byte 5 is wrong"));
        break;
    case SAYS_TWICE:
        CHECK_OK(swiftprox_mesh_sink_fail(sink, "first"));
        CHECK_OK(swiftprox_mesh_sink_fail(sink, "second"));
        return 1;
    case REFUSED_AND_SAYS:
        CHECK(swiftprox_mesh_sink_add_vertices(sink, no_number, 1) == SWIFTPROX_ERROR_MESH);
        CHECK_OK(swiftprox_mesh_sink_fail(sink, "line 2 is wrong"));
        return 1;
    default:
        break;
    }
    return 0;
}

static void faults(void)
{
    swiftprox_shape_info info;
    enum fault fault;
    CHECK_OK(swiftprox_library_register_mesh_reader("FAULT", read_faulty, &fault));
    fault = NONE;
    CHECK_OK(read_file(write_file("fault.mesh", "FAULT"), &info));
    CHECK(info.vertex_count == 4 && info.face_count == 4);
    for (fault = RETURNS; fault < FAULTS; ++fault) {
        const swiftprox_status status = read_file(write_file("fault.mesh", "FAULT"), &info);
        CHECK_FAILS(SWIFTPROX_ERROR_FILE, REFUSALS[fault], status);
        CHECK(strstr(swiftprox_library_last_error_message(), "/fault.mesh: the reader registered for \"FAULT\": ") != NULL);
    }
    CHECK_OK(swiftprox_library_register_mesh_reader("FAULT", NULL, NULL));
}

/* ---- the registry ---- */

/* A tetrahedron whose edges are as long as the double that `user` points to. */
static int32_t read_tetrahedron(void *user, const char *data, size_t size, swiftprox_mesh_sink *sink)
{
    const double a = *(const double *)user;
    const double corners[12] = {0, 0, 0, a, 0, 0, 0, a, 0, 0, 0, a};
    (void)data;
    (void)size;
    swiftprox_mesh_sink_add_vertices(sink, corners, 4);
    swiftprox_mesh_sink_add_faces(sink, FACES, NULL, 4);
    return 0;
}

/* The size of what is read, by the upper corner of its box; 0 if nothing is. */
static double size_in(const char *content)
{
    swiftprox_shape_info info;
    return read_file(write_file("registry.mesh", content), &info) == SWIFTPROX_OK ? info.upper_corner[0] : 0;
}

static void registry(void)
{
    static double one = 1, two = 2;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "magic", swiftprox_library_register_mesh_reader(NULL, read_tetrahedron, &one));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "magic", swiftprox_library_register_mesh_reader(NULL, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "empty", swiftprox_library_register_mesh_reader("", read_tetrahedron, &one));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "white space",
                swiftprox_library_register_mesh_reader(" A", read_tetrahedron, &one));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "byte order mark",
                swiftprox_library_register_mesh_reader("\xef\xbb\xbf"
                                                       "A",
                                                       read_tetrahedron, &one));
    CHECK(size_in("MESH 2") == 0);
    CHECK_OK(swiftprox_library_register_mesh_reader("MESH", read_tetrahedron, &one));
    CHECK(size_in("MESH 2") == 1 && size_in("MESHES") == 1 && size_in("MES") == 0);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "\"MESH\"",
                swiftprox_library_register_mesh_reader("MESH 2", read_tetrahedron, &two));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "\"MESH\"",
                swiftprox_library_register_mesh_reader("M", read_tetrahedron, &two));
    CHECK(size_in("MESH 2") == 1 && size_in("MAX") == 0);
    CHECK_OK(swiftprox_library_register_mesh_reader("MESH", read_tetrahedron, &two));
    CHECK(size_in("MESH 2") == 2);
    CHECK_OK(swiftprox_library_register_mesh_reader("MASH", read_tetrahedron, &one));
    CHECK(size_in("MASH") == 1 && size_in("MESH") == 2);
    CHECK_OK(swiftprox_library_register_mesh_reader("MESH", NULL, NULL));
    CHECK(size_in("MASH") == 1 && size_in("MESH") == 0);
    CHECK_OK(swiftprox_library_register_mesh_reader("MASH", NULL, NULL));
    /* In the place of a built-in reader. */
    CHECK_OK(swiftprox_library_register_mesh_reader("TRI", read_tetrahedron, &two));
    CHECK(size_in("TRI 4 4") == 2);
    CHECK_OK(swiftprox_library_register_mesh_reader("TRI", NULL, NULL));
    CHECK(size_in("TRI 4 4") == 0);
}

/* Takes itself back, registers another, and reads a file by it. */
static int32_t read_by_another(void *user, const char *data, size_t size, swiftprox_mesh_sink *sink)
{
    (void)data;
    (void)size;
    CHECK_OK(swiftprox_library_register_mesh_reader("NEST", NULL, NULL));
    CHECK_OK(swiftprox_library_register_mesh_reader("NESTED", read_tetrahedron, user));
    CHECK(size_in("NESTED") == 3);
    return read_tetrahedron(user, NULL, 0, sink);
}

static void nested(void)
{
    static double three = 3;
    CHECK_OK(swiftprox_library_register_mesh_reader("NEST", read_by_another, &three));
    CHECK(size_in("NEST") == 3);
    CHECK(size_in("NEST") == 0 && size_in("NESTED") == 3);
    CHECK_OK(swiftprox_library_register_mesh_reader("NESTED", NULL, NULL));
}

/* A cube with one corner pushed 1e-8 out of its sides: by default only what went through single precision may be so crooked. */
static int32_t read_crooked(void *user, const char *data, size_t size, swiftprox_mesh_sink *sink)
{
    static const uint32_t sides[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    static const uint32_t valences[6] = {4, 4, 4, 4, 4, 4};
    static const double corners[24] = {0, 0, 0, 1, 0, 0, 1,        1,        0,        0, 1, 0,
                                       0, 0, 1, 1, 0, 1, 1 + 1e-8, 1 + 1e-8, 1 + 1e-8, 0, 1, 1};
    (void)data;
    (void)size;
    if (user != NULL) {
        swiftprox_mesh_sink_set_single_precision(sink);
    }
    swiftprox_mesh_sink_add_vertices(sink, corners, 8);
    swiftprox_mesh_sink_add_faces(sink, sides, valences, 6);
    return 0;
}

static void single_precision(void)
{
    swiftprox_shape_info info;
    int single = 1;
    CHECK_OK(swiftprox_library_register_mesh_reader("CROOKED", read_crooked, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "face", read_file(write_file("crooked.mesh", "CROOKED"), &info));
    CHECK_OK(swiftprox_library_register_mesh_reader("CROOKED", read_crooked, &single));
    CHECK_OK(read_file(write_file("crooked.mesh", "CROOKED"), &info));
    CHECK_OK(swiftprox_library_register_mesh_reader("CROOKED", NULL, NULL));
}

int main(int argc, char **argv)
{
    if (argc > 1) {
        folder = argv[1];
    }
    a_format();
    data();
    faults();
    registry();
    nested();
    single_precision();
    return check_report("mesh_reader");
}
