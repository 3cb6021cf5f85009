/*
 * The floating-point environment of the program: whatever it is, every call answers bit for bit as in the default one, calls
 * the program's functions in the program's environment, and leaves that as it was.
 *
 *     environment [folder for the files that it writes]
 */
#define _GNU_SOURCE /* feenableexcept */
#include <fenv.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "check.h"
#include "swiftprox/geometry.h"
#include "swiftprox/ground.h"
#include "swiftprox/process.h"
#include "swiftprox/scene.h"
#include "swiftprox/tuning.h"
#include "swiftprox/verify.h"

/* ---- environments ---- */

typedef struct environment {
    const char *name;
    int rounding;
    int flushes;
    int traps;
} environment;

static const environment ENVIRONMENTS[] = {
    {"default", FE_TONEAREST, 0, 0},
    {"downward", FE_DOWNWARD, 0, 0},
    {"upward", FE_UPWARD, 0, 0},
    {"toward zero", FE_TOWARDZERO, 0, 0},
    {"flushing", FE_TONEAREST, 1, 0},
    {"flushing, downward", FE_DOWNWARD, 1, 0},
    {"flushing, upward", FE_UPWARD, 1, 0},
    {"flushing, toward zero", FE_TOWARDZERO, 1, 0},
    {"trapping", FE_TONEAREST, 0, 1},
    {"trapping, downward", FE_DOWNWARD, 0, 1},
    {"trapping, upward", FE_UPWARD, 0, 1},
    {"trapping, toward zero", FE_TOWARDZERO, 0, 1},
    {"flushing, trapping", FE_TONEAREST, 1, 1},
    {"flushing, trapping, downward", FE_DOWNWARD, 1, 1},
    {"flushing, trapping, upward", FE_UPWARD, 1, 1},
    {"flushing, trapping, toward zero", FE_TOWARDZERO, 1, 1},
};

#if defined(__x86_64__)
#include <xmmintrin.h>

/* DAZ and FTZ. */
enum { FLUSH = 0x8040, FLAGS = 0x3f };

/* What is set, without the flags of exceptions. */
static unsigned long control(void)
{
    return _mm_getcsr() & ~(unsigned)FLAGS;
}

static void set_flushing(int flushes)
{
    _mm_setcsr((_mm_getcsr() & ~(unsigned)FLUSH) | (flushes ? FLUSH : 0));
}
#elif defined(__aarch64__)
static unsigned long control(void)
{
    unsigned long control;
    __asm__ volatile("mrs %0, fpcr" : "=r"(control));
    return control;
}

static void set_flushing(int flushes)
{
    const unsigned long flush = 1UL << 24;
    __asm__ volatile("msr fpcr, %0" : : "r"((control() & ~flush) | (flushes ? flush : 0)));
}
#else
#define NOT_HERE
static unsigned long control(void)
{
    return 0;
}

static void set_flushing(int flushes)
{
    (void)flushes;
}
#endif

enum { TRAPPED = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW };

/* What is set now, as control() says it. */
static unsigned long expected;

static void enter(const environment *environment)
{
    fedisableexcept(FE_ALL_EXCEPT);
    feclearexcept(FE_ALL_EXCEPT);
    fesetround(environment->rounding);
    set_flushing(environment->flushes);
    if (environment->traps)
        feenableexcept(TRAPPED);
    expected = control();
}

/* ---- what is told, byte by byte ---- */

static struct record {
    unsigned char *bytes;
    size_t size, room;
} told;

static void tell(const void *bytes, size_t size)
{
    if (told.size + size > told.room) {
        told.room = 2 * (told.size + size);
        told.bytes = realloc(told.bytes, told.room);
    }
    memcpy(told.bytes + told.size, bytes, size);
    told.size += size;
}

/* Without the padding at its end. */
static void tell_answer(const swiftprox_pair_answer *answer)
{
    tell(answer, offsetof(swiftprox_pair_answer, statistics) + sizeof answer->statistics);
}

/* A call: its status is told, and the environment is that of before. */
#define CALL(call) after_call((call), #call, __LINE__)

static swiftprox_status after_call(swiftprox_status status, const char *call, int line)
{
    check_that(control() == expected, call, "changes the environment", __FILE__, line);
    tell(&status, sizeof status);
    return status;
}

static void call_succeeds(swiftprox_status status, const char *call, int line)
{
    check_that(status == SWIFTPROX_OK, call, swiftprox_library_last_error_message(), __FILE__, line);
    after_call(status, call, line);
}

#define CALL_OK(call) call_succeeds((call), #call, __LINE__)

/* ---- the program's functions ---- */

static int progress_calls, reader_calls, log_calls, memory_calls;

static int32_t progress(void *user, double fraction)
{
    (void)user;
    CHECK(control() == expected);
    ++progress_calls;
    tell(&fraction, sizeof fraction);
    return 0;
}

static const double TETRAHEDRON[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const uint32_t TETRAHEDRON_FACES[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

static int32_t read_mesh(void *user, const char *data, size_t size, swiftprox_mesh_sink *sink)
{
    const swiftprox_shape *shape;
    (void)user, (void)data, (void)size;
    CHECK(control() == expected);
    ++reader_calls;
    CALL_OK(swiftprox_mesh_sink_add_vertices(sink, TETRAHEDRON, 4));
    /* The library, called from a function that it called. */
    CALL_OK(swiftprox_shape_create_from_points(TETRAHEDRON, 4, NULL, &shape));
    swiftprox_shape_release(shape);
    CALL_OK(swiftprox_mesh_sink_add_faces(sink, TETRAHEDRON_FACES, NULL, 4));
    /* What it changes ends with it. */
    fesetround(FE_UPWARD);
    return 0;
}

static void hear(swiftprox_status status, const char *message, void *user)
{
    (void)status, (void)user;
    CHECK(control() == expected && message[0] != '\0');
    ++log_calls;
}

static void *allocate(void *user, size_t size, size_t alignment)
{
    (void)user;
    CHECK(control() == expected);
    ++memory_calls;
    return aligned_alloc(alignment, size);
}

static void deallocate(void *user, void *memory, size_t size, size_t alignment)
{
    (void)user, (void)size, (void)alignment;
    CHECK(control() == expected);
    free(memory);
}

/* ---- bodies and poses, made before any environment is set ---- */

enum { POINTS = 300, POSES = 24, CORNERS = 8, SIDE = 5 };

static double sphere[3 * POINTS], cube[3 * CORNERS], low_cube[3 * CORNERS], huge_cube[3 * CORNERS], tiny_cube[3 * CORNERS];
static double poses[POSES][12], heights[SIDE * SIDE];
static char mesh_path[1024], reader_path[1024], shape_path[1024];

static void write_file(const char *path, const char *mode, int vertices)
{
    FILE *file = fopen(path, mode);
    if (!CHECK(file != NULL))
        return;
    if (vertices == 0) {
        fputs("ENVIRONMENT\n", file);
    } else {
        fprintf(file, "OFF %d 0 0\n", vertices);
        for (int i = 0; i < 3 * vertices; ++i) /* more digits than a double has */
            fprintf(file, "%.19g%c", sphere[i] * 1.1, i % 3 == 2 ? '\n' : ' ');
    }
    fclose(file);
}

static void prepare(const char *folder)
{
    for (int i = 0; i < POINTS; ++i) { /* a spiral around an ellipsoid */
        const double z = 1 - (2 * i + 1.0) / POINTS, r = sqrt(1 - z * z);
        sphere[3 * i] = r * cos(2.4 * i);
        sphere[3 * i + 1] = 0.7 * r * sin(2.4 * i);
        sphere[3 * i + 2] = 1.3 * z;
    }
    for (int i = 0; i < 3 * CORNERS; ++i) {
        cube[i] = i / 3 >> i % 3 & 1;
        low_cube[i] = cube[i] - (i % 3 == 0);
        huge_cube[i] = (cube[i] - 0.5) * 1e300 * (1 + 0.1 * (i % 7));
        tiny_cube[i] = cube[i] * 1e-310;
    }
    for (int i = 0; i < POSES; ++i) {
        const double angle = 0.1 * i * i, c = cos(angle), s = sin(angle), x = 0.2 * i - 1.3;
        const double pose[12] = {c, -s, 0, x, s, c, 0, 0.1 * x, 0, 0, 1, 0.3};
        memcpy(poses[i], pose, sizeof pose);
    }
    for (int i = 0; i < SIDE * SIDE; ++i)
        heights[i] = i == 7 ? NAN : 0.1 * (i * 5 % 7);
    snprintf(mesh_path, sizeof mesh_path, "%s/environment.off", folder);
    snprintf(reader_path, sizeof reader_path, "%s/environment.txt", folder);
    snprintf(shape_path, sizeof shape_path, "%s/environment.shape", folder);
    write_file(mesh_path, "w", 36);
    write_file(reader_path, "w", 0);
}

/* ---- what is asked ---- */

typedef swiftprox_status pair_query(swiftprox_placed, swiftprox_placed, swiftprox_pair_cache *, const swiftprox_pair_config *,
                                    swiftprox_pair_answer *);

static pair_query *const QUERIES[] = {swiftprox_pair_distance, swiftprox_pair_intersection, swiftprox_pair_contact,
                                      swiftprox_pair_approximate};
enum { QUERY_COUNT = sizeof QUERIES / sizeof QUERIES[0] };

/* All queries of a pair, and their verification. */
static void ask(const swiftprox_shape *shape1, const double *pose1, const swiftprox_shape *shape2, const double *pose2,
                swiftprox_pair_cache caches[QUERY_COUNT], const swiftprox_pair_config *config)
{
    for (int i = 0; i < QUERY_COUNT; ++i) {
        swiftprox_pair_answer answer;
        memset(&answer, 0, sizeof answer);
        CALL_OK(QUERIES[i]((swiftprox_placed){shape1, pose1}, (swiftprox_placed){shape2, pose2}, &caches[i], config, &answer));
        tell_answer(&answer);
        tell(&caches[i], sizeof caches[i]);
        CALL(swiftprox_pair_verify((swiftprox_placed){shape1, pose1}, (swiftprox_placed){shape2, pose2}, &answer));
    }
}

/* What a pair remembers of its depth and of its manifold. */
typedef struct contact_caches {
    swiftprox_depth_cache depth;
    swiftprox_manifold_cache manifold;
} contact_caches;

enum { MOST_POINTS = 64 };

/* How deep the two are in each other, and where they meet. */
static void ask_contact(const swiftprox_shape *shape1, const double *pose1, const swiftprox_shape *shape2, const double *pose2,
                        contact_caches *caches)
{
    swiftprox_depth_answer depth;
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    swiftprox_manifold manifold;
    swiftprox_manifold_point points[MOST_POINTS];
    CALL_OK(swiftprox_pair_depth((swiftprox_placed){shape1, pose1}, (swiftprox_placed){shape2, pose2}, &caches->depth, NULL,
                                 &depth));
    tell(&depth, sizeof depth);
    CALL(swiftprox_pair_depth_verify((swiftprox_placed){shape1, pose1}, (swiftprox_placed){shape2, pose2}, &caches->depth,
                                     &depth));
    config.max_distance = 0.25;
    CALL_OK(swiftprox_pair_manifold((swiftprox_placed){shape1, pose1}, (swiftprox_placed){shape2, pose2}, &caches->manifold,
                                    &config, (swiftprox_manifold_room){points, MOST_POINTS, NULL}, &manifold));
    tell(&manifold, sizeof manifold);
    tell(points, manifold.point_count * sizeof points[0]);
    tell(caches, sizeof *caches);
}

static void ask_once(const swiftprox_shape *shape1, const swiftprox_shape *shape2, double x)
{
    swiftprox_pair_cache caches[QUERY_COUNT];
    const double here[12] = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0}, there[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    contact_caches contact = {{{0}}, {{0}}};
    memset(caches, 0, sizeof caches);
    ask(shape1, here, shape2, there, caches, NULL);
    ask_contact(shape1, here, shape2, there, &contact);
}

/* Whether bodies that touch where x is 0 are apart: gaps below the normal numbers count. */
static int are_apart(const swiftprox_shape *shape1, const swiftprox_shape *shape2, double x)
{
    const double here[12] = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0}, there[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    swiftprox_pair_cache cache = {{0}};
    swiftprox_pair_answer answer;
    CALL_OK(
        swiftprox_pair_distance((swiftprox_placed){shape1, here}, (swiftprox_placed){shape2, there}, &cache, NULL, &answer));
    return answer.outcome == SWIFTPROX_OUTCOME_SEPARATED;
}

/* All that can be told of a shape. */
static void tell_shape(const swiftprox_shape *shape)
{
    double *const vertices = malloc(3 * POINTS * sizeof *vertices);
    swiftprox_shape_info info = {sizeof info};
    swiftprox_shape_tuning_info tuning = {sizeof tuning};
    swiftprox_level_info level;
    CALL_OK(swiftprox_shape_get_info(shape, &info));
    CALL_OK(swiftprox_shape_get_tuning_info(shape, &tuning));
    tell(&info.dimension, sizeof info.dimension);
    tell(&info.vertex_count, sizeof info - offsetof(swiftprox_shape_info, vertex_count));
    tell(&tuning.hierarchy, offsetof(swiftprox_shape_tuning_info, lookup_resolution) - sizeof tuning.struct_size);
    tell(&tuning.lookup_resolution, sizeof tuning.lookup_resolution);
    for (size_t i = 0; i <= tuning.level_count; ++i) {
        memset(&level, 0, sizeof level);
        level.struct_size = sizeof level;
        CALL_OK(swiftprox_shape_get_level_info(shape, i, &level));
        tell(&level, sizeof level);
        CALL_OK(swiftprox_shape_copy_level_vertices(shape, i, vertices, POINTS));
        tell(vertices, 3 * level.vertex_count * sizeof *vertices);
    }
    free(vertices);
}

static const swiftprox_shape *shape_of(const double *points, size_t count, const swiftprox_shape_options *options)
{
    const swiftprox_shape *shape = NULL;
    CALL_OK(swiftprox_shape_create_from_points(points, count, options, &shape));
    tell_shape(shape);
    return shape;
}

static void build_and_ask(void)
{
    static const swiftprox_hierarchy hierarchies[] = {SWIFTPROX_HIERARCHY_NONE, SWIFTPROX_HIERARCHY_QUADRIC,
                                          SWIFTPROX_HIERARCHY_DOBKIN_KIRKPATRICK, SWIFTPROX_HIERARCHY_OUTER_CUTS};
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    swiftprox_shape_tuning making = SWIFTPROX_SHAPE_TUNING_DEFAULT;
    swiftprox_pair_tuning asking = SWIFTPROX_PAIR_TUNING_DEFAULT;
    options.progress = progress;
    options.scale = 0.7;
    config.relative_error = 0.01;
    asking.levels = SWIFTPROX_LEVELS_ALL;
    options.tuning = &making;
    config.tuning = &asking;
    for (size_t k = 0; k < sizeof hierarchies / sizeof hierarchies[0]; ++k) {
        const swiftprox_shape *shape, *loaded = NULL;
        swiftprox_pair_cache caches[QUERY_COUNT];
        contact_caches contact = {{{0}}, {{0}}};
        making.hierarchy = hierarchies[k];
        shape = shape_of(sphere, POINTS, &options);
        CALL_OK(swiftprox_shape_prepare(shape, progress, NULL));
        CALL_OK(swiftprox_shape_save(shape, shape_path));
        CALL_OK(swiftprox_shape_load(shape_path, progress, NULL, &loaded));
        tell_shape(loaded);
        memset(caches, 0, sizeof caches);
        for (int i = 0; i < POSES; ++i) {
            ask(shape, poses[0], loaded, poses[i], caches, k == 0 ? NULL : &config);
            ask_contact(shape, poses[0], loaded, poses[i], &contact);
        }
        swiftprox_shape_release(shape);
        swiftprox_shape_release(loaded);
    }
}

static void read_files(void)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    const swiftprox_shape *shape = NULL;
    options.input = SWIFTPROX_INPUT_HULL;
    CALL_OK(swiftprox_shape_create_from_file(mesh_path, &options, &shape));
    tell_shape(shape);
    swiftprox_shape_release(shape);
    CALL_OK(swiftprox_shape_create_from_file(reader_path, &options, &shape));
    tell_shape(shape);
    swiftprox_shape_release(shape);
}

/* Contact and gaps below the normal numbers, bodies across the range of doubles, bodies in each other, and what is refused. */
static void ask_hard_questions(void)
{
    static const double shifts[] = {-1e-310, 0, 1e-310, 0.5, -0.5, 1, 1e-300, 3, 1e10};
    static const int apart[] = {0, 0, 1, 1, 0, 1, 1, 1, 1}; /* a program that flushes takes 1e-310 for 0 */
    const double not_a_number[12] = {NAN};
    const swiftprox_shape *const unit = shape_of(cube, CORNERS, NULL), *const low = shape_of(low_cube, CORNERS, NULL);
    const swiftprox_shape *const huge = shape_of(huge_cube, CORNERS, NULL), *const tiny = shape_of(tiny_cube, CORNERS, NULL);
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    swiftprox_pair_cache cache = {{0}};
    swiftprox_pair_answer answer;
    const swiftprox_shape *none = NULL;
    const int heard = log_calls;
    for (size_t i = 0; i < sizeof shifts / sizeof shifts[0]; ++i) {
        CHECK(are_apart(unit, low, shifts[i]) == apart[i]);
        ask_once(unit, low, shifts[i]);
        ask_once(unit, unit, shifts[i]);
        ask_once(huge, unit, shifts[i]);
        ask_once(tiny, unit, shifts[i]);
        ask_once(tiny, tiny, shifts[i]);
    }
    ask_once(huge, huge, 1e300);
    ask_once(huge, huge, 2e300);
    CHECK(CALL(swiftprox_pair_distance((swiftprox_placed){unit, not_a_number}, (swiftprox_placed){low, poses[0]}, &cache, NULL,
                                       &answer)) == SWIFTPROX_ERROR_POSE);
    options.convexity_tolerance = NAN;
    CHECK(CALL(swiftprox_shape_create_from_points(cube, CORNERS, &options, &none)) == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(CALL(swiftprox_shape_create_from_file("no such file", NULL, &none)) == SWIFTPROX_ERROR_FILE);
    CHECK(log_calls == heard + 3);
    swiftprox_shape_release(unit);
    swiftprox_shape_release(low);
    swiftprox_shape_release(huge);
    swiftprox_shape_release(tiny);
}

typedef swiftprox_status scene_query(swiftprox_scene *, const swiftprox_scene_query *, swiftprox_scene_answer *);

/* Of ids only the order counts: they differ from scene to scene. */
static void tell_pairs(const swiftprox_scene_answer *answer)
{
    tell(&answer->count, sizeof answer->count);
    for (size_t i = 0; i < answer->count; ++i) {
        const swiftprox_pair_result *const pair = &answer->pairs[i];
        tell(&pair->user_data1, sizeof pair->user_data1);
        tell(&pair->user_data2, sizeof pair->user_data2);
        tell_answer(&pair->answer);
    }
}

static void tell_contacts(const swiftprox_scene_answer *answer)
{
    tell(&answer->contact_count, sizeof answer->contact_count);
    if (answer->contact_count > 0)
        tell(answer->contacts, answer->contact_count * sizeof *answer->contacts);
    if (answer->point_count > 0)
        tell(answer->points, answer->point_count * sizeof *answer->points);
}

static void ask_a_scene(void)
{
    scene_query *const queries[] = {swiftprox_scene_query_intersection, swiftprox_scene_query_distance,
                                    swiftprox_scene_query_contact, swiftprox_scene_query_approximate};
    const swiftprox_shape *const shapes[] = {shape_of(sphere, POINTS, NULL), shape_of(cube, CORNERS, NULL)};
    swiftprox_scene_statistics statistics;
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    swiftprox_scene *scene = NULL;
    swiftprox_object_id ids[5];
    CALL_OK(swiftprox_scene_create(NULL, &scene));
    query.max_distance = 2;
    query.relative_error = 0.05;
    for (int i = 0; i < 4; ++i) {
        const swiftprox_shape *const piece = shapes[i % 2];
        swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
        memcpy(options.pose, poses[5 * i], sizeof poses[0]);
        options.user_data = (uint64_t)i;
        CALL_OK(swiftprox_scene_add_object(scene, &piece, 1, &options, &ids[i]));
    }
    const swiftprox_shape *tetrahedron;
    CALL_OK(swiftprox_shape_create_from_mesh((swiftprox_mesh){TETRAHEDRON, 4, TETRAHEDRON_FACES, NULL, 4}, NULL, &tetrahedron));
    CALL_OK(swiftprox_scene_add_object(scene, &tetrahedron, 1, NULL, &ids[4]));
    swiftprox_shape_release(tetrahedron);
    for (int i = 0; i < POSES; ++i) {
        CALL_OK(swiftprox_scene_set_pose(scene, ids[i % 5], poses[i]));
        for (size_t k = 0; k < sizeof queries / sizeof queries[0]; ++k) {
            swiftprox_scene_answer answer;
            query.detail = queries[k] == swiftprox_scene_query_contact ? SWIFTPROX_CONTACT_DETAIL_MANIFOLD : SWIFTPROX_CONTACT_DETAIL_NONE;
            CALL_OK(queries[k](scene, &query, &answer));
            tell_pairs(&answer);
            tell_contacts(&answer);
        }
    }
    memset(&statistics, 0, sizeof statistics);
    CALL_OK(swiftprox_scene_get_statistics(scene, &statistics));
    tell(&statistics, sizeof statistics);
    CALL_OK(swiftprox_scene_destroy(scene));
    swiftprox_shape_release(shapes[0]);
    swiftprox_shape_release(shapes[1]);
}

static void tell_signed_distance(const swiftprox_signed_distance *answer)
{
    tell(&answer->outcome, sizeof answer->outcome);
    tell(&answer->distance, sizeof *answer - offsetof(swiftprox_signed_distance, distance));
}

/* Where a body meets a ground, and how far it is from it. */
static void ask_ground(const swiftprox_shape *shape, const double *pose, const swiftprox_ground *ground, double max_distance)
{
    enum { MOST_CONTACTS = 16 };
    static const swiftprox_query_kind kinds[] = {SWIFTPROX_QUERY_KIND_DISTANCE, SWIFTPROX_QUERY_KIND_INTERSECTION};
    swiftprox_ground_distance answer;
    swiftprox_ground_contact contacts[MOST_CONTACTS];
    swiftprox_ground_count count;
    swiftprox_manifold_point points[MOST_POINTS];
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        CALL_OK(swiftprox_pair_ground_distance(kinds[i], (swiftprox_placed){shape, pose},
                                               (swiftprox_placed_ground){ground, poses[0]}, NULL, &answer));
        tell_answer(&answer.answer);
        tell(&answer.triangle, sizeof answer.triangle);
    }
    config.max_distance = max_distance;
    config.reduces = 1;
    CALL_OK(swiftprox_pair_ground_contacts((swiftprox_placed){shape, pose}, (swiftprox_placed_ground){ground, poses[0]}, &config,
                                           (swiftprox_ground_room){contacts, MOST_CONTACTS, points, MOST_POINTS}, &count));
    tell(&count, sizeof count);
    for (size_t i = 0; i < count.contact_count && i < MOST_CONTACTS; ++i) {
        tell(&contacts[i].manifold, sizeof contacts[i].manifold);
        tell(&contacts[i].triangle, sizeof contacts[i].triangle);
        tell(&contacts[i].first_point, sizeof contacts[i].first_point);
    }
    tell(points, (count.point_count < MOST_POINTS ? count.point_count : MOST_POINTS) * sizeof points[0]);
}

/* A cube with round edges: beside another one, on a slanted plane, on a soup of two triangles and on heights. */
static void ask_round_bodies(void)
{
    static const uint32_t corners[6] = {0, 1, 2, 2, 1, 3};
    const double soup[12] = {-9, -9, 0.1, 9, -9, -0.2, -9, 9, 0.3, 9, 9, 0.7};
    const swiftprox_half_space half_space = {{0.3, -0.1, 0.9}, 0.2};
    const swiftprox_ground *grounds[2];
    const swiftprox_shape *round;
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    contact_caches contact = {{{0}}, {{0}}};
    options.swept_radius = 0.1;
    options.face_noise = 1e-6;
    round = shape_of(cube, CORNERS, &options);
    CALL_OK(swiftprox_ground_create_from_triangles(soup, 4, corners, 2, &grounds[0]));
    CALL_OK(swiftprox_ground_create_from_heights(SIDE, SIDE, 0.7, 1.1, heights, &grounds[1]));
    for (int i = 0; i < POSES; ++i) {
        swiftprox_pair_cache caches[QUERY_COUNT];
        swiftprox_signed_distance distance;
        swiftprox_manifold manifold;
        swiftprox_manifold_point points[MOST_POINTS];
        memset(caches, 0, sizeof caches);
        ask(round, poses[0], round, poses[i], caches, NULL);
        ask_contact(round, poses[0], round, poses[i], &contact);
        CALL_OK(swiftprox_pair_half_space_distance((swiftprox_placed){round, poses[i]}, &half_space, &distance));
        tell_signed_distance(&distance);
        CALL_OK(swiftprox_pair_half_space_manifold((swiftprox_placed){round, poses[i]}, &half_space, NULL,
                                                   (swiftprox_manifold_room){points, MOST_POINTS, NULL}, &manifold));
        tell(&manifold, sizeof manifold);
        tell(points, manifold.point_count * sizeof points[0]);
        for (size_t k = 0; k < 2; ++k)
            ask_ground(round, poses[i], grounds[k], i % 2 ? 0.25 : 0);
    }
    for (size_t k = 0; k < 2; ++k) {
        CHECK(swiftprox_ground_retain(grounds[k]) == grounds[k]);
        swiftprox_ground_release(grounds[k]);
        swiftprox_ground_release(grounds[k]);
    }
    swiftprox_shape_release(round);
}

static void raise_underflow(void)
{
    static volatile double small = 1e-300, product;
    product = small * small;
    (void)product;
}

/* All of it in one environment. */
static void run(const environment *environment)
{
    enter(environment);
    told.size = 0;
    raise_underflow();
    build_and_ask();
    read_files();
    ask_a_scene();
    ask_round_bodies();
    /* A call's flag is not taken back. */
    CHECK(fetestexcept(FE_UNDERFLOW) != 0);
#ifdef __x86_64__
    /* What has no value is not computed. AArch64's compilers divide before they choose: that raises FE_DIVBYZERO. */
    CHECK(fetestexcept(FE_INVALID | FE_DIVBYZERO) == 0);
#endif
    ask_hard_questions();
    CHECK(fetestexcept(FE_UNDERFLOW) != 0);
    enter(&ENVIRONMENTS[0]);
}

int main(int argument_count, char **arguments)
{
    struct record first;
    swiftprox_status set;
#ifdef NOT_HERE
    puts("environment: not on this processor");
    return 0;
#endif
    enter(&ENVIRONMENTS[0]);
    prepare(argument_count > 1 ? arguments[1] : ".");
    set = swiftprox_library_set_allocator(allocate, deallocate, NULL);
    CHECK(set == SWIFTPROX_OK || set == SWIFTPROX_ERROR_UNSUPPORTED);
    swiftprox_library_set_log(hear, NULL);
    CHECK_OK(swiftprox_library_register_mesh_reader("ENVIRONMENT", read_mesh, NULL));
    run(&ENVIRONMENTS[0]);
    first = told;
    memset(&told, 0, sizeof told);
    for (size_t i = 0; i < sizeof ENVIRONMENTS / sizeof ENVIRONMENTS[0]; ++i) {
        const int failures = check_failures;
        run(&ENVIRONMENTS[i]);
        CHECK(told.size == first.size && memcmp(told.bytes, first.bytes, first.size) == 0);
        if (check_failures > failures)
            fprintf(stderr, "    in the environment \"%s\"\n", ENVIRONMENTS[i].name);
    }
    CHECK(progress_calls > 100 && reader_calls == 17 && log_calls > 17 && (memory_calls > 0) == (set == SWIFTPROX_OK));
    CHECK_OK(swiftprox_library_register_mesh_reader("ENVIRONMENT", NULL, NULL));
    swiftprox_library_set_log(NULL, NULL);
    CHECK(swiftprox_library_set_allocator(NULL, NULL, NULL) == set);
    remove(mesh_path);
    remove(reader_path);
    remove(shape_path);
    printf("environment: %zu bytes of answers, the same in %zu environments\n", first.size,
           sizeof ENVIRONMENTS / sizeof ENVIRONMENTS[0]);
    free(first.bytes);
    free(told.bytes);
    return check_report("environment");
}
