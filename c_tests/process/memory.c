/*
 * Memory that is not there: an allocator refuses one block after the other. Each call then ends in SWIFTPROX_ERROR_MEMORY, keeps
 * nothing, and has changed nothing; queries of pairs go on without what they would have made. Of queries every block is refused,
 * whatever its size.
 *
 *     memory [folder for the files that it writes]
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "swiftprox/compound.h"
#include "swiftprox/geometry.h"
#include "swiftprox/process.h"
#include "swiftprox/scene.h"
#include "swiftprox/tuning.h"
#include "swiftprox/verify.h"

/* No block that must not be refused is as large, one pointer behind its end included. */
enum { SMALL = 2048 + 64, VERTICES = 2200, OBJECTS = 400 };

static size_t least = SMALL;  /* blocks of at least so much are looked at */
static size_t asked, refused; /* such blocks, and which of them is refused; 0: none */
static int for_good;          /* and all that follow */
static long blocks;           /* that were given and not yet given back */

static void *take(void *user, size_t size, size_t alignment)
{
    void *block;
    (void)user;
    if (size >= least) {
        ++asked;
        if (refused > 0 && (asked == refused || (asked > refused && for_good))) {
            return NULL;
        }
    }
    block = aligned_alloc(alignment, size);
    blocks += block != NULL;
    return block;
}

static void give_back(void *user, void *memory, size_t size, size_t alignment)
{
    (void)user;
    (void)size;
    (void)alignment;
    --blocks;
    free(memory);
}

static double points[3 * VERTICES], rotations[9 * OBJECTS], translations[3 * OBJECTS];
static double vertices[3 * VERTICES];
static uint32_t corners[6 * VERTICES];
static size_t triangle_count;
static const swiftprox_shape *ball;
static swiftprox_scene *scene;
static swiftprox_object_id id;
static char mesh_path[4096], shape_path[4096];
static swiftprox_hierarchy kind;

/* What a call made, to be given back where it succeeds. */
static const swiftprox_shape *made;

static swiftprox_status from_points(void)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_shape_tuning tuning = SWIFTPROX_SHAPE_TUNING_DEFAULT;
    tuning.hierarchy = kind;
    options.tuning = &tuning;
    return swiftprox_shape_create_from_points(points, VERTICES, &options, &made);
}

static swiftprox_status from_mesh(void)
{
    return swiftprox_shape_create_from_mesh((swiftprox_mesh){vertices, VERTICES, corners, NULL, triangle_count}, NULL, &made);
}

static swiftprox_status from_levels(void)
{
    swiftprox_mesh meshes[2] = {{vertices, VERTICES, corners, NULL, triangle_count}, {vertices, VERTICES, NULL, NULL, 0}};
    return swiftprox_shape_create_from_levels(meshes, 2, NULL, &made);
}

static swiftprox_status from_file(void)
{
    return swiftprox_shape_create_from_file(mesh_path, NULL, &made);
}

static swiftprox_status from_saved(void)
{
    return swiftprox_shape_load(shape_path, NULL, NULL, &made);
}

static swiftprox_status save(void)
{
    return swiftprox_shape_save(ball, shape_path);
}

static swiftprox_status add_object(void)
{
    const swiftprox_shape *pieces[OBJECTS];
    int i;
    for (i = 0; i < OBJECTS; ++i) {
        pieces[i] = ball;
    }
    id.bits = 7;
    return swiftprox_scene_add_object(scene, pieces, OBJECTS, NULL, &id);
}

static swiftprox_status shrink(void)
{
    return swiftprox_scene_shrink(scene);
}

static swiftprox_status move_all(void)
{
    return swiftprox_scene_set_transforms(scene, NULL, rotations, translations, OBJECTS);
}

/* Not 0: a scene may keep room that the refused call had made before. Whoever sets it counts at the end. */
static int keeps_room;

/*
 * Refuses one block after the other until the call gets all that it asks for: the first ones all, then a few of a hundred, so that
 * building a body a thousand times is not what takes the time.
 */
static void refuse_each(const char *what, swiftprox_status (*call)(void))
{
    size_t number;
    for (number = 1;; number += 1 + number / 16) {
        int turn;
        swiftprox_status status = SWIFTPROX_OK;
        for (turn = 0; turn < 1 + (number % 8 == 1); ++turn) {
            /* The last message and the like are there already. */
            const long before = blocks;
            made = NULL;
            for_good = turn;
            asked = 0;
            refused = number;
            status = call();
            refused = 0;
            if (asked < number) {
                break;
            }
            if (!CHECK(status == SWIFTPROX_ERROR_MEMORY && made == NULL && (keeps_room || blocks == before))) {
                fprintf(stderr, "    %s, block %lu: %s, %ld blocks\n", what, (unsigned long)number,
                        swiftprox_library_last_error_message(), blocks - before);
                swiftprox_shape_release(made);
                return;
            }
            CHECK(strstr(swiftprox_library_last_error_message(), "memory") != NULL);
        }
        if (asked < number) {
            CHECK(number > 1 && status == SWIFTPROX_OK);
            break;
        }
    }
}

/* As above for what makes a shape. */
static void refuse_each_of_shape(const char *what, swiftprox_status (*call)(void))
{
    refuse_each(what, call);
    CHECK(made != NULL);
    swiftprox_shape_release(made);
    made = NULL;
}

static void write_mesh(void)
{
    FILE *file = fopen(mesh_path, "w");
    size_t i;
    if (!CHECK(file != NULL)) {
        return;
    }
    for (i = 0; i < VERTICES; ++i) {
        fprintf(file, "v %.17g %.17g %.17g\n", vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]);
    }
    for (i = 0; i < triangle_count; ++i) {
        fprintf(file, "f %u %u %u\n", (unsigned)corners[3 * i] + 1, (unsigned)corners[3 * i + 1] + 1,
                (unsigned)corners[3 * i + 2] + 1);
    }
    CHECK(fclose(file) == 0);
}

static void test_shapes(void)
{
    static const swiftprox_hierarchy kinds[4] = {SWIFTPROX_HIERARCHY_AUTOMATIC, SWIFTPROX_HIERARCHY_QUADRIC,
                                     SWIFTPROX_HIERARCHY_DOBKIN_KIRKPATRICK, SWIFTPROX_HIERARCHY_OUTER_CUTS};
    int i;
    for (i = 0; i < 4; ++i) {
        kind = kinds[i];
        refuse_each_of_shape("points", from_points);
    }
    refuse_each_of_shape("mesh", from_mesh);
    refuse_each_of_shape("levels", from_levels);
    refuse_each_of_shape("file", from_file);
    refuse_each("save", save);
    refuse_each_of_shape("load", from_saved);
}

/* The first queries of shapes go on without tables; what insists on a table is told. */
static void test_first_queries(void)
{
    const double there[12] = {1, 0, 0, 2.5, 0, 1, 0, 1, 0, 0, 1, 0.25};
    const double here[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    size_t number;
    for (number = 1;; ++number) {
        swiftprox_pair_cache cache;
        swiftprox_pair_answer answer;
        const swiftprox_shape *shape = NULL;
        CHECK_OK(swiftprox_shape_create_from_points(points, VERTICES, NULL, &shape));
        memset(&cache, 0, sizeof cache);
        for_good = 0;
        asked = 0;
        refused = number;
        CHECK_OK(
            swiftprox_pair_distance((swiftprox_placed){shape, here}, (swiftprox_placed){shape, there}, &cache, NULL, &answer));
        refused = 0;
        CHECK(answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && answer.upper - answer.lower < 1e-12);
        CHECK_OK(swiftprox_pair_verify((swiftprox_placed){shape, here}, (swiftprox_placed){shape, there}, &answer));
        if (asked < number) {
            swiftprox_shape_release(shape);
            break;
        }
        asked = 0;
        refused = 1;
        CHECK_FAILS(SWIFTPROX_ERROR_MEMORY, "memory", swiftprox_shape_prepare(shape, NULL, NULL));
        refused = 0;
        CHECK_OK(swiftprox_shape_prepare(shape, NULL, NULL));
        CHECK_OK(
            swiftprox_pair_distance((swiftprox_placed){shape, here}, (swiftprox_placed){shape, there}, &cache, NULL, &answer));
        swiftprox_shape_release(shape);
    }
    CHECK(number > 3);
}

static void test_scenes(void)
{
    swiftprox_scene_answer answer;
    swiftprox_scene_statistics statistics;
    swiftprox_object_info info;
    swiftprox_status status;
    size_t number;
    int i;

    const long begin = blocks;

    /* What is not added leaves no id, and nothing beyond the scene. */
    keeps_room = 1;
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    refuse_each("add_object", add_object);
    CHECK_OK(swiftprox_scene_destroy(scene));
    keeps_room = 0;
    CHECK(blocks == begin);

    /* Lists that grow: each call again where it is refused. */
    CHECK_OK(swiftprox_scene_create(NULL, &scene));
    for (i = 0; i < OBJECTS; ++i) {
        const swiftprox_shape *piece = ball;
        id.bits = 7;
        asked = 0;
        refused = 1;
        status = swiftprox_scene_add_object(scene, &piece, 1, NULL, &id);
        refused = 0;
        if (status == SWIFTPROX_ERROR_MEMORY) {
            CHECK(id.bits == 0);
            status = swiftprox_scene_add_object(scene, &piece, 1, NULL, &id);
        }
        CHECK(status == SWIFTPROX_OK && id.bits != 0);
    }
    refuse_each("move_all", move_all);
    memset(&info, 0, sizeof info);
    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_scene_get_object_info(scene, id, &info));
    CHECK(info.pose[3] == translations[3 * (OBJECTS - 1)]);
    for (number = 1;; ++number) {
        asked = 0;
        refused = number;
        status = swiftprox_scene_query_intersection(scene, NULL, &answer);
        refused = 0;
        if (asked < number) {
            break;
        }
        CHECK(status == SWIFTPROX_ERROR_MEMORY && answer.count == 0 && answer.pairs == NULL);
        CHECK_OK(swiftprox_scene_get_statistics(scene, &statistics));
        CHECK(statistics.queries == 0);
    }
    CHECK(number > 2);
    CHECK_OK(status);
    CHECK(answer.count == OBJECTS - 1 && answer.pairs != NULL);
    CHECK_OK(swiftprox_scene_remove_object(scene, id));
    refuse_each("shrink", shrink);
    CHECK_OK(swiftprox_scene_query_intersection(scene, NULL, &answer));
    CHECK(answer.count == OBJECTS - 2);
    CHECK_OK(swiftprox_scene_destroy(scene));
}

/* Two cubes of side 2 that just touch: doubles cannot tell. The upper one is turned by an angle of sine .6. */
static const double upper_pose[12] = {.8, -.6, 0, 0, .6, .8, 0, 0, 0, 0, 1, 2};
static const swiftprox_shape *cube;

/* A scene that has not been asked before, if the last question was answered; else that one again. */
static swiftprox_status ask_scene(uint64_t *told)
{
    static int is_answered;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene_answer answer;
    swiftprox_status status;
    if (scene == NULL || is_answered) {
        const size_t number = refused;
        refused = 0;
        CHECK_OK(swiftprox_scene_destroy(scene));
        CHECK_OK(swiftprox_scene_create(NULL, &scene));
        CHECK_OK(swiftprox_scene_add_object(scene, &cube, 1, NULL, &id));
        CHECK_OK(swiftprox_scene_add_object(scene, &cube, 1, NULL, &id));
        CHECK_OK(swiftprox_scene_set_pose(scene, id, upper_pose));
        asked = 0;
        refused = number;
    }
    query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    status = swiftprox_scene_query_contact(scene, &query, &answer);
    is_answered = status == SWIFTPROX_OK;
    *told = answer.count;
    return status;
}

/*
 * Every block that a question asks for is refused once: it is answered all the same, or ends in SWIFTPROX_ERROR_MEMORY, and the
 * next time it is answered. Integers got no memory by a panic, which was SWIFTPROX_ERROR_BUG and the end of a scene, and lists
 * beside them ended the program: of these cubes blocks of 48 to 64 bytes.
 */
static void refuse_every_block(const char *what, swiftprox_status (*ask)(uint64_t *told))
{
    uint64_t expected, told;
    size_t number, refusals = 0;
    int came_to_that;
    CHECK_OK(ask(&expected));
    for (number = 1;; ++number) {
        swiftprox_status status;
        least = 1;
        asked = 0;
        for_good = 0;
        refused = number;
        status = ask(&told);
        refused = 0;
        least = SMALL;
        refusals += status == SWIFTPROX_ERROR_MEMORY;
        if (!CHECK(status == SWIFTPROX_ERROR_MEMORY || (status == SWIFTPROX_OK && told == expected))) {
            fprintf(stderr, "    %s, block %lu: status %d, %s\n", what, (unsigned long)number, (int)status,
                    swiftprox_library_last_error_message());
            return;
        }
        came_to_that = asked >= number;
        CHECK_OK(ask(&told));
        CHECK(told == expected);
        if (!came_to_that) {
            break;
        }
    }
    CHECK(refusals > 0);
}

/* What is said of the two cubes, and its proofs. */
static const double lower_pose[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
static swiftprox_pair_answer contact;
static swiftprox_depth_answer depth;
static swiftprox_depth_cache depth_cache;
static swiftprox_manifold manifold;
static swiftprox_manifold_cache manifold_cache;
static swiftprox_manifold_point manifold_points[16];
static swiftprox_cast_answer hit;

static swiftprox_status check_answer(uint64_t *told)
{
    *told = 0;
    return swiftprox_pair_verify((swiftprox_placed){cube, lower_pose}, (swiftprox_placed){cube, upper_pose}, &contact);
}

static swiftprox_status check_depth(uint64_t *told)
{
    *told = 0;
    return swiftprox_pair_depth_verify((swiftprox_placed){cube, lower_pose}, (swiftprox_placed){cube, upper_pose}, &depth_cache,
                                       &depth);
}

static swiftprox_status check_manifold(uint64_t *told)
{
    *told = 0;
    return swiftprox_pair_manifold_verify((swiftprox_placed){cube, lower_pose}, (swiftprox_placed){cube, upper_pose},
                                          &manifold_cache, NULL, manifold_points, &manifold);
}

/* The upper cube falls on the lower one; or what was said of that is checked. */
static swiftprox_status cast_or_check(int is_check)
{
    swiftprox_pair_cache cache = {{0}};
    swiftprox_motion fixed = {0}, down = {0};
    fixed.kind = SWIFTPROX_MOTION_KIND_FIXED;
    down.kind = SWIFTPROX_MOTION_KIND_SCREW;
    memcpy(fixed.start, lower_pose, sizeof lower_pose);
    memcpy(down.start, upper_pose, sizeof upper_pose);
    down.start[11] += 1;
    down.velocity[2] = -2;
    return is_check ? swiftprox_pair_cast_verify((swiftprox_moving){cube, &fixed}, (swiftprox_moving){cube, &down}, NULL, &hit)
                    : swiftprox_pair_cast((swiftprox_moving){cube, &fixed}, (swiftprox_moving){cube, &down}, &cache, NULL, &hit);
}

static swiftprox_status check_cast(uint64_t *told)
{
    *told = 0;
    return cast_or_check(1);
}

/*
 * Checks of answers: the names of members that a message may need were put together for every check, in blocks of 8 to 64 bytes,
 * and where one was refused the program ended. Cut-off: the first block of each check.
 */
static void test_checks(void)
{
    swiftprox_pair_cache cache = {{0}};
    const swiftprox_placed lower = {cube, lower_pose}, upper = {cube, upper_pose};
    CHECK_OK(swiftprox_pair_contact(lower, upper, &cache, NULL, &contact));
    CHECK_OK(swiftprox_pair_depth(lower, upper, &depth_cache, NULL, &depth));
    CHECK_OK(swiftprox_pair_manifold(lower, upper, &manifold_cache, NULL, (swiftprox_manifold_room){manifold_points, 16, NULL},
                                     &manifold));
    CHECK(manifold.point_count == 8);
    CHECK_OK(cast_or_check(0));
    CHECK(hit.outcome == SWIFTPROX_CAST_OUTCOME_HIT);
    refuse_every_block("check of a contact", check_answer);
    refuse_every_block("check of a depth", check_depth);
    refuse_every_block("check of a manifold", check_manifold);
    refuse_every_block("check of a cast", check_cast);
}

/* The cube as a compound, and its fall. */
static const swiftprox_compound *compound;
static swiftprox_compound_cast_answer compound_hit;

static swiftprox_status cast_or_check_compound(int is_check)
{
    static swiftprox_compound_cache cache;
    swiftprox_motion fixed = {0}, down = {0};
    const swiftprox_moving_compound lower = {compound, &fixed}, upper = {compound, &down};
    fixed.kind = SWIFTPROX_MOTION_KIND_FIXED;
    down.kind = SWIFTPROX_MOTION_KIND_SCREW;
    memcpy(fixed.start, lower_pose, sizeof lower_pose);
    memcpy(down.start, upper_pose, sizeof upper_pose);
    down.start[11] += 1;
    down.velocity[2] = -2;
    memset(&cache, 0, sizeof cache);
    return is_check ? swiftprox_compound_cast_verify(lower, upper, NULL, &compound_hit)
                    : swiftprox_compound_cast(lower, upper, &cache, NULL, &compound_hit);
}

static swiftprox_status cast_compound(uint64_t *told)
{
    const swiftprox_status status = cast_or_check_compound(0);
    *told = compound_hit.answer.outcome;
    return status;
}

static swiftprox_status check_compound_cast(uint64_t *told)
{
    *told = 0;
    return cast_or_check_compound(1);
}

static swiftprox_status ask_compound(uint64_t *told)
{
    static swiftprox_compound_cache cache;
    swiftprox_compound_signed_distance_answer answer;
    const swiftprox_placed_compound lower = {compound, lower_pose}, upper = {compound, upper_pose};
    const swiftprox_status status = swiftprox_compound_signed_distance(lower, upper, &cache, NULL, &answer);
    memset(&cache, 0, sizeof cache);
    *told = answer.distance.outcome;
    return status;
}

/* A cast of compounds ended the program where the first 8 bytes that it asks for were refused, however small the compounds. */
static void test_compounds(void)
{
    CHECK_OK(swiftprox_compound_create(&cube, lower_pose, 1, &compound));
    refuse_every_block("compound", ask_compound);
    refuse_every_block("cast of a compound", cast_compound);
    CHECK(compound_hit.answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT);
    refuse_every_block("check of a compound's cast", check_compound_cast);
    swiftprox_compound_release(compound);
}

static void test_every_block(void)
{
    double box[24];
    int i, j;
    for (i = 0; i < 8; ++i) {
        for (j = 0; j < 3; ++j) {
            box[3 * i + j] = i >> j & 1 ? 1 : -1;
        }
    }
    CHECK_OK(swiftprox_shape_create_from_points(box, 8, NULL, &cube));
    scene = NULL;
    refuse_every_block("scene", ask_scene);
    test_checks();
    test_compounds();
    CHECK_OK(swiftprox_scene_destroy(scene));
    scene = NULL;
    swiftprox_shape_release(cube);
}

/* A reader of the program: its file is the ball's mesh, whatever it says. */
static int32_t read_ball(void *user, const char *data, size_t size, swiftprox_mesh_sink *sink)
{
    (void)user;
    (void)data;
    (void)size;
    swiftprox_mesh_sink_add_vertices(sink, vertices, VERTICES);
    swiftprox_mesh_sink_add_faces(sink, corners, NULL, triangle_count);
    return 0;
}

static void test_readers(void)
{
    CHECK_OK(swiftprox_library_register_mesh_reader("v ", read_ball, NULL));
    refuse_each_of_shape("reader", from_file);
    CHECK_OK(swiftprox_library_register_mesh_reader("v ", NULL, NULL));
}

int main(int argc, char **argv)
{
    swiftprox_shape_info info;
    int i;
    const char *folder = argc > 1 ? argv[1] : ".";
    snprintf(mesh_path, sizeof mesh_path, "%s/memory.obj", folder);
    snprintf(shape_path, sizeof shape_path, "%s/memory.shape", folder);
    for (i = 0; i < VERTICES; ++i) {
        const double z = (2 * i + 1) / (double)VERTICES - 1.0, r = sqrt(1.0 - z * z);
        points[3 * i] = r * cos(2.4 * i);
        points[3 * i + 1] = r * sin(2.4 * i);
        points[3 * i + 2] = z;
    }
    for (i = 0; i < OBJECTS; ++i) {
        rotations[9 * i] = rotations[9 * i + 4] = rotations[9 * i + 8] = 1;
        translations[3 * i + 2] = 1.99 * i;
    }
    CHECK_OK(swiftprox_library_set_allocator(take, give_back, NULL));
    CHECK_OK(swiftprox_shape_create_from_points(points, VERTICES, NULL, &ball));
    CHECK_OK(swiftprox_shape_prepare(ball, NULL, NULL));
    memset(&info, 0, sizeof info);
    info.struct_size = sizeof info;
    CHECK_OK(swiftprox_shape_get_info(ball, &info));
    triangle_count = info.triangle_count;
    CHECK(info.vertex_count == VERTICES);
    CHECK_OK(swiftprox_shape_copy_vertices(ball, vertices, NULL, VERTICES));
    CHECK_OK(swiftprox_shape_copy_triangles(ball, corners, 2 * VERTICES));
    write_mesh();
    CHECK(swiftprox_shape_create_from_points(NULL, 1, NULL, &made) == SWIFTPROX_ERROR_NULL_POINTER);

    test_shapes();
    test_first_queries();
    test_scenes();
    test_readers();
    test_every_block();
    swiftprox_shape_release(ball);
    remove(mesh_path);
    remove(shape_path);
    return check_report("memory");
}
