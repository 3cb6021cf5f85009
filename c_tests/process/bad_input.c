/*
 * What a program may do wrong at the C interface: every call must answer with its status and a message that names the argument,
 * lose nothing and leave everything usable. Run under valgrind it shows that nothing is read, written or leaked that should not
 * be.
 *
 *     bad_input [folder for the files that it writes]
 */
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "swiftprox/geometry.h"
#include "swiftprox/ground.h"
#include "swiftprox/process.h"
#include "swiftprox/scene.h"
#include "swiftprox/tuning.h"
#include "swiftprox/verify.h"

static const double CORNERS[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const uint32_t FACES[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
static const double HERE[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
static const double THERE[12] = {1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0};

/* Writes a number where an enumerator stands, as a program may that reads it from a file. */
static void any_number(void *enumerator, int32_t number)
{
    memcpy(enumerator, &number, sizeof number);
}

static swiftprox_status mesh(const double *vertices, size_t vertex_count, const uint32_t *indices, const uint32_t *valences,
                             size_t face_count, const swiftprox_shape_options *options)
{
    /* Not null before: a failure must make it so. */
    const swiftprox_shape *shape = (const swiftprox_shape *)(void *)vertices;
    const swiftprox_status status =
        swiftprox_shape_create_from_mesh((swiftprox_mesh){vertices, vertex_count, indices, valences, face_count}, options, &shape);
    CHECK((status == SWIFTPROX_OK) == (shape != NULL));
    swiftprox_shape_release(shape);
    return status;
}

static swiftprox_status add_tetrahedron(swiftprox_scene *scene, const swiftprox_object_options *options,
                                        swiftprox_object_id *id)
{
    const swiftprox_shape *shape = NULL;
    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 4, FACES, NULL, 4}, NULL, &shape));
    const swiftprox_status status = swiftprox_scene_add_object(scene, &shape, 1, options, id);
    swiftprox_shape_release(shape);
    return status;
}

static void meshes(void)
{
    static const uint32_t out_of_range[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 4};
    static const uint32_t turned_over[12] = {0, 1, 2, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    static const uint32_t repeated[12] = {0, 2, 2, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    static const uint32_t vast[4] = {UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX};
    static const uint32_t uneven[4] = {3, 3, 6, 0};
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    const swiftprox_shape *shape = NULL;
    size_t i;

    CHECK_OK(mesh(CORNERS, 4, FACES, NULL, 4, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "vertices",
                swiftprox_shape_create_from_mesh((swiftprox_mesh){NULL, 4, FACES, NULL, 4}, NULL, &shape));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "indices",
                swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 4, NULL, NULL, 4}, NULL, &shape));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "shape",
                swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 4, FACES, NULL, 4}, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "vertex_count", mesh(CORNERS, SIZE_MAX, FACES, NULL, 4, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "face_count", mesh(CORNERS, 4, FACES, NULL, (size_t)-4, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "indices", mesh(CORNERS, 4, FACES, NULL, UINT32_MAX, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "indices", mesh(CORNERS, 4, FACES, vast, 4, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "face 2", mesh(CORNERS, 4, FACES, uneven, 4, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "face 3", mesh(CORNERS, 4, out_of_range, NULL, 4, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "face 0", mesh(CORNERS, 4, repeated, NULL, 4, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "edge", mesh(CORNERS, 4, turned_over, NULL, 4, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "edge", mesh(CORNERS, 4, FACES, NULL, 3, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "no faces", mesh(CORNERS, 4, FACES, NULL, 0, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "0 vertices", mesh(CORNERS, 0, FACES, NULL, 4, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "no vertices", mesh(CORNERS, 0, FACES, NULL, 0, NULL));
    for (i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        double corners[12];
        memcpy(corners, CORNERS, sizeof corners);
        corners[7] = bad[i];
        CHECK_FAILS(SWIFTPROX_ERROR_MESH, "vertex 2", mesh(corners, 4, FACES, NULL, 4, NULL));
        CHECK_FAILS(SWIFTPROX_ERROR_MESH, "vertex 2: y is not finite",
                    swiftprox_shape_create_from_points(corners, 4, NULL, &shape));
        CHECK(shape == NULL);
    }
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "points", swiftprox_shape_create_from_points(NULL, 4, NULL, &shape));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "points", swiftprox_shape_create_from_points(CORNERS, SIZE_MAX / 8, NULL, &shape));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "at least one point",
                swiftprox_shape_create_from_points(CORNERS, 0, NULL, &shape));
    CHECK(shape == NULL);
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "interior", swiftprox_shape_create_from_points(CORNERS, 3, NULL, &shape));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "SWIFTPROX_INPUT_FLAT", swiftprox_shape_create_from_points(CORNERS, 3, NULL, &shape));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "SWIFTPROX_INPUT_HULL", swiftprox_shape_create_from_points(CORNERS, 2, NULL, &shape));
    swiftprox_shape_release(NULL);
    CHECK(swiftprox_shape_prepare(NULL, NULL, NULL) == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(swiftprox_shape_retain(NULL) == NULL);
}

/* What coordinates excuse: text of one decimal as much as a mesh may be off at most, doubles that were computed next to nothing. */
static void tolerances(void)
{
    const double text[6] = {0.1, 0.2, 0.5, 0.9, 0.3, 0.1}, computed[6] = {1.0 / 3, 0.1, 0.2, 2.0 / 3, 0.4, 0.7};
    const double bad[6] = {0, 1, 2, 3, NAN, 5};
    double tolerance = 7;
    CHECK_OK(swiftprox_mesh_estimate_tolerance(text, 2, &tolerance));
    CHECK(tolerance >= 0.005 && tolerance <= 0.005);
    CHECK_OK(swiftprox_mesh_estimate_tolerance(computed, 2, &tolerance));
    CHECK(tolerance >= 1e-9 && tolerance <= 1e-9);
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "vertex 1: y is not finite", swiftprox_mesh_estimate_tolerance(bad, 2, &tolerance));
    CHECK(isnan(tolerance));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "at least one point", swiftprox_mesh_estimate_tolerance(text, 0, &tolerance));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "vertices", swiftprox_mesh_estimate_tolerance(NULL, 2, &tolerance));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "tolerance", swiftprox_mesh_estimate_tolerance(text, 2, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "points", swiftprox_mesh_estimate_tolerance(text, SIZE_MAX / 8, &tolerance));
}

static swiftprox_status decompose(size_t faces, double tolerance, swiftprox_decomposition *found)
{
    return swiftprox_mesh_decompose((swiftprox_mesh){CORNERS, 4, FACES, NULL, faces}, tolerance, NULL, NULL, found);
}

/* What is no surface, no room and no tolerance; the counts are 0 then, and the arrays as they were. */
static void decompositions(void)
{
    const uint32_t twice[6] = {0, 1, 2, 0, 1, 3}, same[6] = {0, 0, 1, 2, 2, 2}, beyond[3] = {0, 1, 4};
    uint32_t corners[12], faces[4], pieces[4];
    swiftprox_decomposition found = {corners, faces, pieces, 4, 7, 7};
    swiftprox_decomposition none = {NULL, NULL, NULL, 4, 7, 7};
    CHECK_OK(decompose(4, 0, &found));
    CHECK(found.triangle_count == 4 && found.piece_count == 1 && pieces[3] == 0);
    corners[0] = 77;
    found.capacity = 3;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "has room for 3, 4 are needed", decompose(4, 0, &found));
    CHECK(corners[0] == 77 && found.triangle_count == 0 && found.piece_count == 0);
    found.capacity = 4;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "tolerance", decompose(4, NAN, &found));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "tolerance", decompose(4, -1, &found));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "no faces", decompose(0, 0, &found));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "face_count", decompose(SIZE_MAX / 8, 0, &found));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "decomposition", decompose(4, 0, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "decomposition->corners", decompose(4, 0, &none));
    CHECK(none.triangle_count == 0);
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "same direction",
                swiftprox_mesh_decompose((swiftprox_mesh){CORNERS, 4, twice, NULL, 2}, 0, NULL, NULL, &found));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "no face of the mesh has an area",
                swiftprox_mesh_decompose((swiftprox_mesh){CORNERS, 4, same, NULL, 2}, 0, NULL, NULL, &found));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "face 0", swiftprox_mesh_decompose((swiftprox_mesh){CORNERS, 4, beyond, NULL, 1}, 0, NULL,
                                                                         NULL, &found));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "vertices",
                swiftprox_mesh_decompose((swiftprox_mesh){NULL, 4, FACES, NULL, 4}, 0, NULL, NULL, &found));
}

static void shape_options(void)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    memset(&options, 0, sizeof options);
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "begin with SWIFTPROX_SHAPE_OPTIONS_DEFAULT",
                mesh(CORNERS, 4, FACES, NULL, 4, &options));
    memset(&options, 0xff, sizeof options);
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "swiftprox_shape_options", mesh(CORNERS, 4, FACES, NULL, 4, &options));

    options = (swiftprox_shape_options)SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    any_number(&options.input, INT32_MIN);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "input", mesh(CORNERS, 4, FACES, NULL, 4, &options));
    options = (swiftprox_shape_options)SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    options.scale = 0;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "scale", mesh(CORNERS, 4, FACES, NULL, 4, &options));
    options.scale = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "scale", mesh(CORNERS, 4, FACES, NULL, 4, &options));
    options.scale = 1e308;
    options.translation[1] = 1.7e308;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "range", mesh(CORNERS, 4, FACES, NULL, 4, &options));
    options = (swiftprox_shape_options)SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    options.rotation[4] = 0;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "transform", mesh(CORNERS, 4, FACES, NULL, 4, &options));
    options = (swiftprox_shape_options)SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    options.convexity_tolerance = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "convexity", mesh(CORNERS, 4, FACES, NULL, 4, &options));
}

/* A file with the given content is refused with a status, and the message names it. */
static void refused_file(const char *folder, const char *name, const char *content, size_t size, swiftprox_status expected)
{
    char path[1024];
    const swiftprox_shape *shape = NULL;
    FILE *file;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "wb");
    if (!CHECK(file != NULL)) {
        return;
    }
    CHECK(fwrite(content, 1, size, file) == size);
    fclose(file);
    CHECK_FAILS(expected, name, swiftprox_shape_create_from_file(path, NULL, &shape));
    CHECK(shape == NULL);
    remove(path);
}

static void files(const char *folder)
{
    static const char off[] = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    static const char *const names[] = {"garbage.tri", "garbage.poly", "garbage.off", "garbage.obj", "garbage.stl", "garbage"};
    static const char open_off[] = "OFF\n4 3 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n";
    static const char nan_off[] = "OFF\n4 4 6\n0 0 nan\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    char garbage[4096], stl[134];
    const swiftprox_shape *shape = NULL;
    uint32_t state = 1, count = UINT32_MAX;
    size_t i, length;

    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "path", swiftprox_shape_create_from_file(NULL, NULL, &shape));
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, "no-such-file.off", swiftprox_shape_create_from_file("no-such-file.off", NULL, &shape));
    CHECK_FAILS(SWIFTPROX_ERROR_FILE, folder, swiftprox_shape_create_from_file(folder, NULL, &shape));
    for (i = 0; i < sizeof garbage; ++i) {
        state = state * 1664525u + 1013904223u;
        garbage[i] = (char)(state >> 24);
    }
    for (i = 0; i < sizeof names / sizeof names[0]; ++i) {
        refused_file(folder, names[i], "", 0, SWIFTPROX_ERROR_FILE);
        refused_file(folder, names[i], garbage, sizeof garbage, SWIFTPROX_ERROR_FILE);
        refused_file(folder, names[i], "999999999999999999999 4 6\n", 26, SWIFTPROX_ERROR_FILE);
    }
    refused_file(folder, "open.off", open_off, sizeof open_off - 1, SWIFTPROX_ERROR_MESH);
    refused_file(folder, "nan.off", nan_off, sizeof nan_off - 1, SWIFTPROX_ERROR_FILE);
    /* Cut behind every byte of it but those of the last line, whose face could be a shorter number. */
    for (length = 0; length < sizeof off - 8; ++length) {
        refused_file(folder, "cut.off", off, length, SWIFTPROX_ERROR_FILE);
    }
    /* A binary STL that promises 2^32 - 1 triangles and has one. */
    memset(stl, 0, sizeof stl);
    memcpy(stl + 80, &count, 4);
    refused_file(folder, "promise.stl", stl, sizeof stl, SWIFTPROX_ERROR_FILE);
}

/* HERE with one entry replaced. */
static const double *with(int entry, double value)
{
    static double pose[12];
    memcpy(pose, HERE, sizeof pose);
    pose[entry] = value;
    return pose;
}

static void pairs(void)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300};
    const swiftprox_shape *shape = NULL;
    swiftprox_pair_cache cache = {{0}};
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    swiftprox_pair_tuning tuning = SWIFTPROX_PAIR_TUNING_DEFAULT;
    swiftprox_pair_answer answer;
    size_t i;
    int entry;

    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 4, FACES, NULL, 4}, NULL, &shape));
    CHECK_FAILS(
        SWIFTPROX_ERROR_NULL_POINTER, "object1.shape",
        swiftprox_pair_distance((swiftprox_placed){NULL, HERE}, (swiftprox_placed){shape, THERE}, &cache, NULL, &answer));
    CHECK_FAILS(
        SWIFTPROX_ERROR_NULL_POINTER, "object1.pose",
        swiftprox_pair_contact((swiftprox_placed){shape, NULL}, (swiftprox_placed){shape, THERE}, &cache, NULL, &answer));
    CHECK_FAILS(
        SWIFTPROX_ERROR_NULL_POINTER, "object2.shape",
        swiftprox_pair_intersection((swiftprox_placed){shape, HERE}, (swiftprox_placed){NULL, THERE}, &cache, NULL, &answer));
    CHECK_FAILS(
        SWIFTPROX_ERROR_NULL_POINTER, "object2.pose",
        swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, NULL}, &cache, NULL, &answer));
    CHECK_FAILS(
        SWIFTPROX_ERROR_NULL_POINTER, "cache",
        swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, NULL, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer",
                swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &cache, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer",
                swiftprox_pair_verify((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, NULL));

    for (entry = 0; entry < 12; ++entry) {
        for (i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
            const double *pose = with(entry, bad[i]);
            const int far_away = entry % 4 == 3 && isfinite(bad[i]);
            const swiftprox_status status = swiftprox_pair_distance((swiftprox_placed){shape, HERE},
                                                                    (swiftprox_placed){shape, pose}, &cache, NULL, &answer);
            CHECK(status == (far_away ? SWIFTPROX_OK : SWIFTPROX_ERROR_POSE));
            CHECK(answer.outcome == (far_away ? SWIFTPROX_OUTCOME_SEPARATED : SWIFTPROX_OUTCOME_NONE));
            if (far_away) {
                CHECK(answer.lower <= 1e300 && 1e300 <= answer.upper * (1 + 1e-15));
            }
        }
    }
    CHECK_FAILS(
        SWIFTPROX_ERROR_POSE, "orthonormal",
        swiftprox_pair_distance((swiftprox_placed){shape, with(5, 0)}, (swiftprox_placed){shape, HERE}, &cache, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal",
                swiftprox_pair_distance((swiftprox_placed){shape, with(1, 0.02)}, (swiftprox_placed){shape, HERE}, &cache, NULL,
                                        &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "reflection",
                swiftprox_pair_distance((swiftprox_placed){shape, with(0, -1)}, (swiftprox_placed){shape, HERE}, &cache, NULL,
                                        &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "entry 0",
                swiftprox_pair_verify((swiftprox_placed){shape, with(0, NAN)}, (swiftprox_placed){shape, HERE}, &answer));
    /* A shear within the limit is the caller's to use. */
    CHECK_OK(swiftprox_pair_distance((swiftprox_placed){shape, with(1, 0.009)}, (swiftprox_placed){shape, THERE}, &cache, NULL,
                                     &answer));
    CHECK_OK(swiftprox_pair_verify((swiftprox_placed){shape, with(1, 0.009)}, (swiftprox_placed){shape, THERE}, &answer));
    config.max_distance = -1;
    CHECK_FAILS(
        SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
        swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &cache, &config, &answer));
    config = (swiftprox_pair_config)SWIFTPROX_PAIR_CONFIG_DEFAULT;
    any_number(&tuning.levels, 17);
    config.tuning = &tuning;
    CHECK_FAILS(
        SWIFTPROX_ERROR_INVALID_ARGUMENT, "tuning->levels is 17",
        swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &cache, &config, &answer));
    memset(&tuning, 0, sizeof tuning);
    CHECK_FAILS(
        SWIFTPROX_ERROR_STRUCT_SIZE, "SWIFTPROX_PAIR_TUNING_DEFAULT",
        swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &cache, &config, &answer));
    memset(&config, 0, sizeof config);
    CHECK_FAILS(
        SWIFTPROX_ERROR_STRUCT_SIZE, "SWIFTPROX_PAIR_CONFIG_DEFAULT",
        swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &cache, &config, &answer));

    /* After all that the pair is answered as ever. */
    CHECK_OK(swiftprox_pair_distance((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &cache, NULL, &answer));
    CHECK(answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.lower <= 2 && 2 <= answer.upper);
    CHECK_OK(swiftprox_pair_verify((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_UNVERIFIED, "apart",
                swiftprox_pair_verify((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, HERE}, &answer));
    memset(&answer, 0x7f, sizeof answer);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "outcome",
                swiftprox_pair_verify((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &answer));
    memset(&answer, 0, sizeof answer);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "outcome",
                swiftprox_pair_verify((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &answer));
    answer.outcome = SWIFTPROX_OUTCOME_INTERSECTING;
    answer.proof_count = UINT32_MAX;
    CHECK_FAILS(SWIFTPROX_ERROR_UNVERIFIED, "4294967295 vertex pairs",
                swiftprox_pair_verify((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &answer));
    answer.proof_count = 4;
    answer.proof[3][1] = UINT32_MAX;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "vertex",
                swiftprox_pair_verify((swiftprox_placed){shape, HERE}, (swiftprox_placed){shape, THERE}, &answer));

    /* Tiny and vast bodies: whatever is accepted is answered. */
    for (i = 0; i < 2; ++i) {
        swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
        const swiftprox_shape *extreme = NULL;
        options.scale = i == 0 ? 1e-300 : 1e300;
        CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 4, FACES, NULL, 4}, &options, &extreme));
        CHECK_OK(swiftprox_pair_distance((swiftprox_placed){extreme, HERE}, (swiftprox_placed){shape, THERE}, &cache, NULL,
                                         &answer));
        CHECK_OK(swiftprox_pair_verify((swiftprox_placed){extreme, HERE}, (swiftprox_placed){shape, THERE}, &answer));
        CHECK_OK(swiftprox_pair_contact((swiftprox_placed){extreme, HERE}, (swiftprox_placed){extreme, HERE}, &cache, NULL,
                                        &answer));
        CHECK(answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING);
        swiftprox_shape_release(extreme);
    }
    swiftprox_shape_release(shape);
}

/* Shapes with a ball swept over them, and what is no radius and no noise. */
static void swept_shapes(void)
{
    static const double bad[] = {NAN, INFINITY, -1};
    const swiftprox_shape *const before = (const swiftprox_shape *)(const void *)CORNERS, *shape;
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    size_t i;
    for (i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        options = (swiftprox_shape_options)SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
        options.swept_radius = bad[i];
        shape = before;
        CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "swept_radius",
                    swiftprox_shape_create_from_points(CORNERS, 4, &options, &shape));
        CHECK(shape == NULL);
        CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "swept_radius", mesh(CORNERS, 4, FACES, NULL, 4, &options));
    }
    options.swept_radius = 1e300;
    options.scale = 1e10;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "swept_radius times scale", mesh(CORNERS, 4, FACES, NULL, 4, &options));
    options = (swiftprox_shape_options)SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    options.face_noise = INFINITY;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "face_noise", mesh(CORNERS, 4, FACES, NULL, 4, &options));
}

/* A point below the ground, with a ball swept over it: however often it is refused, it is answered in the end. */
static void half_spaces(void)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    const swiftprox_half_space ground = {{0, 0, 2}, 8};
    const double origin[3] = {0, 0, 0};
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    const swiftprox_shape *shape = NULL;
    swiftprox_half_space other;
    swiftprox_signed_distance answer;
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    swiftprox_manifold manifold;
    swiftprox_manifold_point point, untouched;
    size_t i;
    options.input = SWIFTPROX_INPUT_HULL;
    options.swept_radius = 0.5;
    CHECK_OK(swiftprox_shape_create_from_points(origin, 1, &options, &shape));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "shape",
                swiftprox_pair_half_space_distance((swiftprox_placed){NULL, HERE}, &ground, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pose",
                swiftprox_pair_half_space_distance((swiftprox_placed){shape, NULL}, &ground, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "half_space",
                swiftprox_pair_half_space_distance((swiftprox_placed){shape, HERE}, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer",
                swiftprox_pair_half_space_distance((swiftprox_placed){shape, HERE}, &ground, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "entry 5",
                swiftprox_pair_half_space_distance((swiftprox_placed){shape, with(5, NAN)}, &ground, &answer));
    CHECK(answer.outcome == SWIFTPROX_OUTCOME_NONE && isnan(answer.lower) && isnan(answer.world1[0]));
    for (i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        other = ground;
        other.normal[i] = bad[i];
        CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "normal of the half-space",
                    swiftprox_pair_half_space_distance((swiftprox_placed){shape, HERE}, &other, &answer));
        other = ground;
        other.offset = bad[i];
        CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "offset of the half-space",
                    swiftprox_pair_half_space_manifold((swiftprox_placed){shape, HERE}, &other, NULL,
                                                       (swiftprox_manifold_room){&point, 1, NULL}, &manifold));
        CHECK(manifold.outcome == SWIFTPROX_OUTCOME_NONE && manifold.point_count == 0);
    }
    config.max_distance = NAN;
    memset(&point, 0x5a, sizeof point);
    memset(&untouched, 0x5a, sizeof untouched);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
                swiftprox_pair_half_space_manifold((swiftprox_placed){shape, HERE}, &ground, &config,
                                                   (swiftprox_manifold_room){&point, 1, NULL}, &manifold));
    memset(&config, 0, sizeof config);
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "SWIFTPROX_MANIFOLD_CONFIG_DEFAULT",
                swiftprox_pair_half_space_manifold((swiftprox_placed){shape, HERE}, &ground, &config,
                                                   (swiftprox_manifold_room){&point, 1, NULL}, &manifold));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "points",
                swiftprox_pair_half_space_manifold((swiftprox_placed){shape, HERE}, &ground, NULL,
                                                   (swiftprox_manifold_room){NULL, 1, NULL}, &manifold));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "points",
                swiftprox_pair_half_space_manifold((swiftprox_placed){shape, HERE}, &ground, NULL,
                                                   (swiftprox_manifold_room){&point, SIZE_MAX, NULL}, &manifold));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "manifold",
                swiftprox_pair_half_space_manifold((swiftprox_placed){shape, HERE}, &ground, NULL,
                                                   (swiftprox_manifold_room){&point, 1, NULL}, NULL));
    CHECK(memcmp(&point, &untouched, sizeof point) == 0);
    CHECK_OK(swiftprox_pair_half_space_manifold((swiftprox_placed){shape, HERE}, &ground, NULL,
                                                (swiftprox_manifold_room){&point, 1, NULL}, &manifold));
    CHECK(manifold.point_count == 1 && point.gap_lower <= -4.5 && -4.5 <= point.gap_upper);
    swiftprox_shape_release(shape);
}

/* A ground of one triangle, and all that may be wrong about it, about a shape on it and about the room for answers. */
static void grounds(void)
{
    static const uint32_t one[3] = {0, 1, 2}, absent[3] = {0, 1, 4}, thin[3] = {0, 1, 1};
    const double heights[4] = {0, 1, 2, 3}, holes[4] = {NAN, 1, 2, 3}, vast[4] = {0, 1, INFINITY, 3};
    double vertices[12];
    const swiftprox_shape *shape = NULL;
    const swiftprox_ground *ground = NULL, *none = (const swiftprox_ground *)(const void *)vertices;
    swiftprox_ground_info info;
    swiftprox_ground_distance answer;
    swiftprox_ground_contact contact;
    swiftprox_ground_count count;
    swiftprox_manifold_point point;
    swiftprox_manifold_config config;
    swiftprox_pair_config distance;
    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 4, FACES, NULL, 4}, NULL, &shape));
    CHECK_OK(swiftprox_ground_create_from_triangles(CORNERS, 4, one, 1, &ground));

    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ground", swiftprox_ground_create_from_triangles(CORNERS, 4, one, 1, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "vertices", swiftprox_ground_create_from_triangles(NULL, 4, one, 1, &none));
    CHECK(none == NULL);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "corners", swiftprox_ground_create_from_triangles(CORNERS, 4, NULL, 1, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "points", swiftprox_ground_create_from_triangles(CORNERS, SIZE_MAX, one, 1, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "triangle_count",
                swiftprox_ground_create_from_triangles(CORNERS, 4, one, (size_t)-1, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "triangle 0", swiftprox_ground_create_from_triangles(CORNERS, 4, absent, 1, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "area", swiftprox_ground_create_from_triangles(CORNERS, 4, thin, 1, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "area", swiftprox_ground_create_from_triangles(CORNERS, 4, one, 0, &none));
    memcpy(vertices, CORNERS, sizeof vertices);
    vertices[10] = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "vertex 3", swiftprox_ground_create_from_triangles(vertices, 4, one, 1, &none));

    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "1 columns", swiftprox_ground_create_from_heights(4, 1, 1, 1, heights, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "spacing", swiftprox_ground_create_from_heights(2, 2, 0, 1, heights, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "spacing", swiftprox_ground_create_from_heights(2, 2, 1, NAN, heights, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "rows * columns",
                swiftprox_ground_create_from_heights(SIZE_MAX, SIZE_MAX, 1, 1, heights, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "heights", swiftprox_ground_create_from_heights(2, 2, 1, 1, NULL, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "area", swiftprox_ground_create_from_heights(2, 2, 1, 1, holes, &none));
    CHECK_FAILS(SWIFTPROX_ERROR_MESH, "vertex 2", swiftprox_ground_create_from_heights(2, 2, 1, 1, vast, &none));

    memset(&info, 0x7f, sizeof info);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ground", swiftprox_ground_get_info(NULL, &info));
    CHECK(info.triangle_count == 0 && info.bytes == 0);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "info", swiftprox_ground_get_info(ground, NULL));
    CHECK(swiftprox_ground_retain(NULL) == NULL);
    swiftprox_ground_release(NULL);

#define DISTANCE(kind, shape, pose, ground, place, config, answer)                                     \
    swiftprox_pair_ground_distance((swiftprox_query_kind)(kind), (swiftprox_placed){shape, pose},       \
                                   (swiftprox_placed_ground){ground, place}, config, answer)
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "kind is 77", DISTANCE(77, shape, HERE, ground, HERE, NULL, &answer));
    CHECK(answer.answer.outcome == SWIFTPROX_OUTCOME_NONE && isnan(answer.answer.distance));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "distance or intersection",
                DISTANCE(SWIFTPROX_QUERY_KIND_APPROXIMATE, shape, HERE, ground, HERE, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "shape",
                DISTANCE(SWIFTPROX_QUERY_KIND_DISTANCE, NULL, HERE, ground, HERE, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pose",
                DISTANCE(SWIFTPROX_QUERY_KIND_DISTANCE, shape, NULL, ground, HERE, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ground",
                DISTANCE(SWIFTPROX_QUERY_KIND_DISTANCE, shape, HERE, NULL, HERE, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "ground.pose",
                DISTANCE(SWIFTPROX_QUERY_KIND_DISTANCE, shape, HERE, ground, NULL, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer",
                DISTANCE(SWIFTPROX_QUERY_KIND_DISTANCE, shape, HERE, ground, HERE, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal",
                DISTANCE(SWIFTPROX_QUERY_KIND_DISTANCE, shape, with(5, 0), ground, HERE, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "reflection",
                DISTANCE(SWIFTPROX_QUERY_KIND_INTERSECTION, shape, HERE, ground, with(0, -1), NULL, &answer));
    distance = (swiftprox_pair_config)SWIFTPROX_PAIR_CONFIG_DEFAULT;
    distance.max_distance = -1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance",
                DISTANCE(SWIFTPROX_QUERY_KIND_DISTANCE, shape, HERE, ground, HERE, &distance, &answer));
    memset(&distance, 0, sizeof distance);
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "SWIFTPROX_PAIR_CONFIG_DEFAULT",
                DISTANCE(SWIFTPROX_QUERY_KIND_DISTANCE, shape, HERE, ground, HERE, &distance, &answer));
#undef DISTANCE

#define CONTACTS(config, contacts, contact_room, points, point_room)                                                    \
    swiftprox_pair_ground_contacts((swiftprox_placed){shape, HERE}, (swiftprox_placed_ground){ground, HERE}, config, \
                                   (swiftprox_ground_room){contacts, contact_room, points, point_room}, &count)
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "contacts", CONTACTS(NULL, NULL, 1, &point, 1));
    CHECK(count.contact_count == 0 && count.point_count == 0);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "points", CONTACTS(NULL, &contact, 1, NULL, 1));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "contacts", CONTACTS(NULL, &contact, SIZE_MAX, &point, 1));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "points", CONTACTS(NULL, &contact, 1, &point, SIZE_MAX));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "count",
                swiftprox_pair_ground_contacts((swiftprox_placed){shape, HERE}, (swiftprox_placed_ground){ground, HERE}, NULL,
                                               (swiftprox_ground_room){NULL, 0, NULL, 0}, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "entry 3",
                swiftprox_pair_ground_contacts((swiftprox_placed){shape, with(3, NAN)}, (swiftprox_placed_ground){ground, HERE},
                                               NULL, (swiftprox_ground_room){NULL, 0, NULL, 0}, &count));
    config = (swiftprox_manifold_config)SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    config.max_distance = -1;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance", CONTACTS(&config, &contact, 1, &point, 1));
    memset(&config, 0, sizeof config);
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "SWIFTPROX_MANIFOLD_CONFIG_DEFAULT", CONTACTS(&config, &contact, 1, &point, 1));

    /* After all that the tetrahedron stands on the triangle, with more points than there is room for. */
    CHECK_OK(CONTACTS(NULL, &contact, 1, &point, 1));
    CHECK(count.contact_count == 1 && count.point_count == 3 && contact.manifold.point_count == 3);
    CHECK(point.gap_lower <= 0 && 0 <= point.gap_upper);
#undef CONTACTS
    swiftprox_ground_release(ground);
    swiftprox_shape_release(shape);
}

/* The scene still holds two tetrahedra at distance 2. */
static void still_usable(swiftprox_scene *scene, int line)
{
    swiftprox_scene_answer answer;
    check_that(swiftprox_scene_query_distance(scene, NULL, &answer) == SWIFTPROX_OK && answer.count == 1 &&
                   answer.pairs[0].answer.lower <= 2 && 2 <= answer.pairs[0].answer.upper,
               "the scene is usable", swiftprox_library_last_error_message(), __FILE__, line);
}

static void scenes(void)
{
    swiftprox_scene *scene = NULL, *other = NULL;
    swiftprox_scene_options options = SWIFTPROX_SCENE_OPTIONS_DEFAULT;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    swiftprox_object_options object_options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    swiftprox_object_info info;
    const swiftprox_shape *shape = NULL;
    const swiftprox_shape *pieces[2] = {NULL, NULL};
    swiftprox_pair_tuning tuning = SWIFTPROX_PAIR_TUNING_DEFAULT;
    const swiftprox_shape *piece = NULL;
    swiftprox_object_id here, there, stale, foreign, id = {7};
    int32_t active = 7, valid = 7;
    size_t i;

    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_create(NULL, NULL));
    CHECK(scene == NULL);
    CHECK_OK(swiftprox_scene_destroy(NULL));
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    CHECK_OK(swiftprox_scene_create(NULL, &other));

    memcpy(object_options.pose, THERE, sizeof THERE);
    CHECK_OK(add_tetrahedron(scene, NULL, &here));
    CHECK_OK(add_tetrahedron(scene, &object_options, &there));
    CHECK_OK(swiftprox_scene_copy_object(scene, there, &stale));
    CHECK_OK(swiftprox_scene_remove_object(scene, stale));
    CHECK_OK(add_tetrahedron(other, NULL, &foreign));
    still_usable(scene, __LINE__);

    /* Ids: null, stale, another scene's, made up. */
    {
        const swiftprox_object_id wrong[] = {{0}, stale, foreign, {here.bits + 7}, {UINT64_MAX}};
        for (i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
            CHECK(swiftprox_scene_set_pose(scene, wrong[i], HERE) == SWIFTPROX_ERROR_HANDLE);
            CHECK(swiftprox_scene_remove_object(scene, wrong[i]) == SWIFTPROX_ERROR_HANDLE);
            id.bits = 7;
            CHECK(swiftprox_scene_copy_object(scene, wrong[i], &id) == SWIFTPROX_ERROR_HANDLE && id.bits == 0);
            CHECK_OK(swiftprox_scene_is_object_valid(scene, wrong[i], &valid));
            CHECK(valid == 0);
            CHECK(swiftprox_scene_set_pair_active(scene, &wrong[i], NULL, 1) == SWIFTPROX_ERROR_HANDLE);
            CHECK(swiftprox_scene_set_pair_active(scene, &here, &wrong[i], 0) == SWIFTPROX_ERROR_HANDLE);
            CHECK(swiftprox_scene_get_pair_active(scene, wrong[i], there, &active) == SWIFTPROX_ERROR_HANDLE && active == 0);
            info.struct_size = sizeof info;
            CHECK(swiftprox_scene_get_object_info(scene, wrong[i], &info) == SWIFTPROX_ERROR_HANDLE);
            CHECK(swiftprox_scene_set_object_info(scene, wrong[i], &info) == SWIFTPROX_ERROR_HANDLE);
            CHECK(swiftprox_scene_get_piece(scene, wrong[i], 0, &piece) == SWIFTPROX_ERROR_HANDLE && piece == NULL);
        }
    }
    CHECK_OK(swiftprox_scene_is_object_valid(scene, here, &valid));
    CHECK(valid == 1);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_is_object_valid(NULL, here, &valid));
    CHECK(valid == 0);
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "valid", swiftprox_scene_is_object_valid(scene, here, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "twice", swiftprox_scene_set_pair_active(scene, &here, &here, 0));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "piece 1", swiftprox_scene_get_piece(scene, here, 1, &piece));
    CHECK_OK(swiftprox_scene_get_object_info(scene, here, &info));
    info.piece_count = 2;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "piece_count is 2", swiftprox_scene_set_object_info(scene, here, &info));
    info.piece_count = 1;
    info.pose[3] = NAN;
    info.user_data = 7;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "finite", swiftprox_scene_set_object_info(scene, here, &info));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "info", swiftprox_scene_set_object_info(scene, here, NULL));
    CHECK_OK(swiftprox_scene_get_object_info(scene, here, &info));
    CHECK(info.user_data == 0);
    still_usable(scene, __LINE__);

    /* Adding. */
    CHECK_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){CORNERS, 4, FACES, NULL, 4}, NULL, &shape));
    pieces[0] = shape;
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "id", swiftprox_scene_add_object(scene, pieces, 1, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pieces[0]", swiftprox_scene_add_object(scene, &pieces[1], 1, NULL, &id));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pieces[1]", swiftprox_scene_add_object(scene, pieces, 2, NULL, &id));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pieces", swiftprox_scene_add_object(scene, NULL, 2, NULL, &id));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "piece", swiftprox_scene_add_object(scene, pieces, 0, NULL, &id));
    CHECK_FAILS(SWIFTPROX_ERROR_LIMIT, "pieces", swiftprox_scene_add_object(scene, pieces, SIZE_MAX, NULL, &id));
    object_options.pose[0] = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "finite", swiftprox_scene_add_object(scene, pieces, 1, &object_options, &id));
    object_options.struct_size = 3;
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "swiftprox_object_options",
                swiftprox_scene_add_object(scene, pieces, 1, &object_options, &id));
    CHECK(id.bits == 0);
    swiftprox_shape_release(shape);
    still_usable(scene, __LINE__);

    /* Moving: what is refused leaves the object where it is. */
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "pose", swiftprox_scene_set_pose(scene, here, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "finite", swiftprox_scene_set_pose(scene, here, with(3, INFINITY)));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal", swiftprox_scene_set_pose(scene, here, with(10, 1e-300)));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "rotation", swiftprox_scene_set_transform(scene, here, NULL, CORNERS));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "translation", swiftprox_scene_set_transform(scene, here, CORNERS, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_POSE, "orthonormal", swiftprox_scene_set_transform(scene, here, CORNERS, CORNERS));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "3 poses", swiftprox_scene_set_poses(scene, NULL, HERE, 3));
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "poses", swiftprox_scene_set_poses(scene, NULL, HERE, SIZE_MAX));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "poses", swiftprox_scene_set_poses(scene, NULL, NULL, 2));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "rotations", swiftprox_scene_set_transforms(scene, NULL, NULL, HERE, 2));
    {
        double poses[24];
        memcpy(poses, THERE, sizeof THERE);
        memcpy(poses + 12, with(0, 2), sizeof HERE);
        CHECK_FAILS(SWIFTPROX_ERROR_POSE, "pose 1", swiftprox_scene_set_poses(scene, NULL, poses, 2));
    }
    still_usable(scene, __LINE__);

    /* Asking. */
    query.max_distance = -2;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance", swiftprox_scene_query_distance(scene, &query, &answer));
    CHECK(answer.count == 0 && answer.pairs == NULL);
    query.max_distance = NAN;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "max_distance", swiftprox_scene_query_distance(scene, &query, &answer));
    query = (swiftprox_scene_query)SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.step_budget = 0;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "step_budget", swiftprox_scene_query_intersection(scene, &query, &answer));
    query = (swiftprox_scene_query)SWIFTPROX_SCENE_QUERY_DEFAULT;
    any_number(&tuning.refinement, -3);
    query.tuning = &tuning;
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "tuning->refinement is -3",
                swiftprox_scene_query_contact(scene, &query, &answer));
    query = (swiftprox_scene_query)SWIFTPROX_SCENE_QUERY_DEFAULT;
    any_number(&query.piece_pairs, 3);
    CHECK_FAILS(SWIFTPROX_ERROR_INVALID_ARGUMENT, "query->piece_pairs is 3",
                swiftprox_scene_query_distance(scene, &query, &answer));
    query.struct_size = 0;
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "swiftprox_scene_query", swiftprox_scene_query_contact(scene, &query, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "answer", swiftprox_scene_query_intersection(scene, NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_shrink(NULL));
    still_usable(scene, __LINE__);

    /* No scene. */
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_query_intersection(NULL, NULL, &answer));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "scene", swiftprox_scene_set_pose(NULL, here, HERE));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "statistics", swiftprox_scene_get_statistics(NULL, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "statistics", swiftprox_scene_get_statistics(scene, NULL));
    CHECK_FAILS(SWIFTPROX_ERROR_NULL_POINTER, "info", swiftprox_scene_get_object_info(scene, here, NULL));
    info.struct_size = 1;
    CHECK_FAILS(SWIFTPROX_ERROR_STRUCT_SIZE, "swiftprox_object_info", swiftprox_scene_get_object_info(scene, here, &info));
    still_usable(scene, __LINE__);

    CHECK_OK(swiftprox_scene_destroy(scene));
    CHECK_OK(swiftprox_scene_destroy(other));
}

/* Any number gets words, one that is no enumerator, too. */
static void words(void)
{
    CHECK(strcmp(swiftprox_library_status_string(SWIFTPROX_ERROR_POSE), "a pose is refused") == 0);
    CHECK(strcmp(swiftprox_library_status_string((swiftprox_status)-1), "not a status") == 0);
    CHECK(strcmp(swiftprox_library_outcome_string(SWIFTPROX_OUTCOME_INTERSECTING), "intersecting") == 0);
    CHECK(strcmp(swiftprox_library_outcome_string((swiftprox_outcome)(SWIFTPROX_OUTCOME_UNDECIDED + 1)), "not an outcome") == 0);
    CHECK(strcmp(swiftprox_library_outcome_string((swiftprox_outcome)INT32_MIN), "not an outcome") == 0);
    CHECK(strcmp(swiftprox_library_feature_kind_string(SWIFTPROX_FEATURE_KIND_EDGE), "edge") == 0);
    CHECK(strcmp(swiftprox_library_feature_kind_string((swiftprox_feature_kind)(SWIFTPROX_FEATURE_KIND_FACE + 1)), "not a feature kind") == 0);
    CHECK(strcmp(swiftprox_library_feature_kind_string((swiftprox_feature_kind)INT32_MIN), "not a feature kind") == 0);
    CHECK(strcmp(swiftprox_library_decided_by_string(SWIFTPROX_DECIDED_BY_INTEGERS), "integer arithmetic") == 0);
    CHECK(strcmp(swiftprox_library_decided_by_string((swiftprox_decided_by)-1), "not what decides") == 0);
}

int main(int argc, char **argv)
{
    CHECK_OK(swiftprox_library_check_version(SWIFTPROX_VERSION_MAJOR, SWIFTPROX_VERSION_MINOR, SWIFTPROX_VERSION_PATCH));
    CHECK_FAILS(SWIFTPROX_ERROR_VERSION, "1000", swiftprox_library_check_version(1000, 0, 0));
    words();
    meshes();
    tolerances();
    decompositions();
    shape_options();
    files(argc > 1 ? argv[1] : ".");
    pairs();
    swept_shapes();
    half_spaces();
    grounds();
    scenes();
    return check_report("bad_input");
}
