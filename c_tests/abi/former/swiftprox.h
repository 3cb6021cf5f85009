/* swiftprox.h of 0.1.0 before motions and face_noise were added, without its comments. Programs compiled with it must run on. */
#ifndef SWIFTPROX_H
#define SWIFTPROX_H

#include <stddef.h>
#include <stdint.h>

#ifndef SWIFTPROX_NODISCARD
#if (defined(__cplusplus) && __cplusplus >= 201703L) || (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L)
#define SWIFTPROX_NODISCARD [[nodiscard]]
#elif defined(__GNUC__)
#define SWIFTPROX_NODISCARD __attribute__((warn_unused_result))
#else
#define SWIFTPROX_NODISCARD
#endif
#endif

#ifndef SWIFTPROX_INT32
#if (defined(__cplusplus) && __cplusplus >= 201103L) || (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L)
#define SWIFTPROX_INT32 : int32_t
#else
#define SWIFTPROX_INT32
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define SWIFTPROX_VERSION_MAJOR 0

#define SWIFTPROX_VERSION_MINOR 1

#define SWIFTPROX_VERSION_PATCH 0

const char *swiftprox_library_version(void);

typedef enum swiftprox_status SWIFTPROX_INT32 {
  SWIFTPROX_OK = 0,
  SWIFTPROX_ERROR_NULL_POINTER = 1,
  SWIFTPROX_ERROR_INVALID_ARGUMENT = 2,
  SWIFTPROX_ERROR_STRUCT_SIZE = 3,
  SWIFTPROX_ERROR_POSE = 4,
  SWIFTPROX_ERROR_MESH = 5,
  SWIFTPROX_ERROR_FILE = 6,
  SWIFTPROX_ERROR_HANDLE = 7,
  SWIFTPROX_ERROR_LIMIT = 8,
  SWIFTPROX_ERROR_CANCELLED = 9,
  SWIFTPROX_ERROR_BUG = 10,
  SWIFTPROX_ERROR_POISONED = 11,
  SWIFTPROX_ERROR_VERSION = 12,
  SWIFTPROX_ERROR_UNVERIFIED = 13,
  SWIFTPROX_ERROR_UNSUPPORTED = 14,
  SWIFTPROX_ERROR_MEMORY = 15,
  SWIFTPROX_ERROR_BUSY = 16
} swiftprox_status;

typedef char swiftprox_enums_are_32_bits[sizeof(swiftprox_status) == 4 ? 1 : -1];

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_library_check_version(int32_t major,
                                                 int32_t minor,
                                                 int32_t patch);

const char *swiftprox_library_last_error_message(void);

const char *swiftprox_library_status_string(swiftprox_status status);

typedef struct swiftprox_shape swiftprox_shape;

typedef enum swiftprox_input SWIFTPROX_INT32 {
  SWIFTPROX_INPUT_STRICT = 0,
  SWIFTPROX_INPUT_FLAT = 1,
  SWIFTPROX_INPUT_HULL = 2
} swiftprox_input;

typedef int32_t (*swiftprox_progress_callback)(void *user, double fraction);

typedef struct swiftprox_shape_options {
  size_t struct_size;
  swiftprox_input input;
  double rotation[9];
  double translation[3];
  double scale;
  double convexity_tolerance;
  swiftprox_progress_callback progress;
  void *progress_user;
  const struct swiftprox_shape_tuning *tuning;
} swiftprox_shape_options;

void swiftprox_shape_options_init_sized(struct swiftprox_shape_options *options,
                                        size_t struct_size);
#define swiftprox_shape_options_init(pointer) swiftprox_shape_options_init_sized((pointer), sizeof *(pointer))

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_mesh(const double *vertices,
                                                  size_t vertex_count,
                                                  const uint32_t *indices,
                                                  const uint32_t *valences,
                                                  size_t face_count,
                                                  const struct swiftprox_shape_options *options,
                                                  const struct swiftprox_shape **shape);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_points(const double *points,
                                                    size_t point_count,
                                                    const struct swiftprox_shape_options *options,
                                                    const struct swiftprox_shape **shape);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_file(const char *path,
                                                  const struct swiftprox_shape_options *options,
                                                  const struct swiftprox_shape **shape);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_scaled(const struct swiftprox_shape *source,
                                               double scale,
                                               swiftprox_progress_callback progress,
                                               void *progress_user,
                                               const struct swiftprox_shape **shape);

const struct swiftprox_shape *swiftprox_shape_retain(const struct swiftprox_shape *shape);

void swiftprox_shape_release(const struct swiftprox_shape *shape);

typedef struct swiftprox_shape_info {
  size_t struct_size;
  int32_t dimension;
  size_t vertex_count;
  size_t edge_count;
  size_t face_count;
  size_t triangle_count;
  double volume;
  double centre_of_mass[3];
  double radius;
  double lower_corner[3];
  double upper_corner[3];
  size_t bytes;
  double inertia[9];
} swiftprox_shape_info;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_info(const struct swiftprox_shape *shape,
                                          struct swiftprox_shape_info *info);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_vertices(const struct swiftprox_shape *shape,
                                               double *vertices,
                                               uint32_t *labels,
                                               size_t capacity);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_triangles(const struct swiftprox_shape *shape,
                                                uint32_t *corners,
                                                size_t capacity);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_prepare(const struct swiftprox_shape *shape,
                                         swiftprox_progress_callback progress,
                                         void *progress_user);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_save(const struct swiftprox_shape *shape,
                                      const char *path);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_load(const char *path,
                                      swiftprox_progress_callback progress,
                                      void *progress_user,
                                      const struct swiftprox_shape **shape);

typedef enum swiftprox_outcome SWIFTPROX_INT32 {
  SWIFTPROX_OUTCOME_NONE = 0,
  SWIFTPROX_OUTCOME_SEPARATED = 1,
  SWIFTPROX_OUTCOME_BEYOND = 2,
  SWIFTPROX_OUTCOME_INTERSECTING = 3,
  SWIFTPROX_OUTCOME_UNDECIDED = 4
} swiftprox_outcome;

typedef enum swiftprox_decided_by SWIFTPROX_INT32 {
  SWIFTPROX_DECIDED_BY_NONE = 0,
  SWIFTPROX_DECIDED_BY_MARCHING = 1,
  SWIFTPROX_DECIDED_BY_COHERENCE = 2,
  SWIFTPROX_DECIDED_BY_FALLBACK = 3,
  SWIFTPROX_DECIDED_BY_INTEGERS = 4,
  SWIFTPROX_DECIDED_BY_TOLERANCE = 5,
  SWIFTPROX_DECIDED_BY_BUDGET = 6,
  SWIFTPROX_DECIDED_BY_BOUNDING_SPHERES = 7,
  SWIFTPROX_DECIDED_BY_INSCRIBED_SPHERES = 8
} swiftprox_decided_by;

typedef enum swiftprox_feature_kind SWIFTPROX_INT32 {
  SWIFTPROX_FEATURE_KIND_NONE = 0,
  SWIFTPROX_FEATURE_KIND_VERTEX = 1,
  SWIFTPROX_FEATURE_KIND_EDGE = 2,
  SWIFTPROX_FEATURE_KIND_FACE = 3
} swiftprox_feature_kind;

typedef struct swiftprox_feature {
  swiftprox_feature_kind kind;
  uint32_t ids[2];
} swiftprox_feature;

typedef struct swiftprox_statistics {
  uint32_t marching_steps;
  uint32_t fallback_iterations;
  uint32_t exact_iterations;
  uint16_t levels[2];
} swiftprox_statistics;

typedef struct swiftprox_pair_answer {
  swiftprox_outcome outcome;
  swiftprox_decided_by decided_by;
  double distance;
  double lower;
  double upper;
  double local1[3];
  double local2[3];
  double world1[3];
  double world2[3];
  double normal[3];
  struct swiftprox_feature feature1;
  struct swiftprox_feature feature2;
  uint32_t proof[4][2];
  uint32_t proof_count;
  struct swiftprox_statistics statistics;
} swiftprox_pair_answer;

typedef struct swiftprox_pair_cache {
  uint32_t words[24];
} swiftprox_pair_cache;

typedef struct swiftprox_pair_config {
  size_t struct_size;
  double distance_tolerance;
  double rotation_limit;
  double absolute_error;
  double relative_error;
  uint32_t step_budget;
  const struct swiftprox_pair_tuning *tuning;
} swiftprox_pair_config;

void swiftprox_pair_config_init_sized(struct swiftprox_pair_config *config,
                                      size_t struct_size);
#define swiftprox_pair_config_init(pointer) swiftprox_pair_config_init_sized((pointer), sizeof *(pointer))

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_distance(const struct swiftprox_shape *shape1,
                                         const double *pose1,
                                         const struct swiftprox_shape *shape2,
                                         const double *pose2,
                                         struct swiftprox_pair_cache *cache,
                                         const struct swiftprox_pair_config *config,
                                         struct swiftprox_pair_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_contact(const struct swiftprox_shape *shape1,
                                        const double *pose1,
                                        const struct swiftprox_shape *shape2,
                                        const double *pose2,
                                        struct swiftprox_pair_cache *cache,
                                        const struct swiftprox_pair_config *config,
                                        struct swiftprox_pair_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_intersection(const struct swiftprox_shape *shape1,
                                             const double *pose1,
                                             const struct swiftprox_shape *shape2,
                                             const double *pose2,
                                             struct swiftprox_pair_cache *cache,
                                             const struct swiftprox_pair_config *config,
                                             struct swiftprox_pair_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_approximate(const struct swiftprox_shape *shape1,
                                            const double *pose1,
                                            const struct swiftprox_shape *shape2,
                                            const double *pose2,
                                            struct swiftprox_pair_cache *cache,
                                            const struct swiftprox_pair_config *config,
                                            struct swiftprox_pair_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_verify(const struct swiftprox_shape *shape1,
                                       const double *pose1,
                                       const struct swiftprox_shape *shape2,
                                       const double *pose2,
                                       const struct swiftprox_pair_answer *answer);

const char *swiftprox_library_outcome_string(swiftprox_outcome outcome);

const char *swiftprox_library_decided_by_string(swiftprox_decided_by decided_by);

const char *swiftprox_library_feature_kind_string(swiftprox_feature_kind kind);

typedef enum swiftprox_depth_ending SWIFTPROX_INT32 {
  SWIFTPROX_DEPTH_ENDING_NONE = 0,
  SWIFTPROX_DEPTH_ENDING_NARROW = 1,
  SWIFTPROX_DEPTH_ENDING_SEPARATED = 2,
  SWIFTPROX_DEPTH_ENDING_INTEGERS = 3,
  SWIFTPROX_DEPTH_ENDING_BUDGET = 4,
  SWIFTPROX_DEPTH_ENDING_STALLED = 5
} swiftprox_depth_ending;

typedef struct swiftprox_depth_statistics {
  uint32_t steps;
  uint32_t supports;
  uint32_t triangles;
  uint32_t exact_iterations;
} swiftprox_depth_statistics;

typedef struct swiftprox_depth_answer {
  swiftprox_outcome outcome;
  swiftprox_depth_ending ending;
  double depth;
  double lower;
  double upper;
  double local1[3];
  double local2[3];
  double world1[3];
  double world2[3];
  double normal[3];
  struct swiftprox_feature feature1;
  struct swiftprox_feature feature2;
  struct swiftprox_depth_statistics statistics;
} swiftprox_depth_answer;

typedef struct swiftprox_depth_cache {
  uint32_t words[352];
} swiftprox_depth_cache;

typedef struct swiftprox_depth_config {
  size_t struct_size;
  double rotation_limit;
  double absolute_error;
  double relative_error;
  uint32_t step_budget;
} swiftprox_depth_config;

void swiftprox_depth_config_init_sized(struct swiftprox_depth_config *config,
                                       size_t struct_size);
#define swiftprox_depth_config_init(pointer) swiftprox_depth_config_init_sized((pointer), sizeof *(pointer))

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_depth(const struct swiftprox_shape *shape1,
                                      const double *pose1,
                                      const struct swiftprox_shape *shape2,
                                      const double *pose2,
                                      struct swiftprox_depth_cache *cache,
                                      const struct swiftprox_depth_config *config,
                                      struct swiftprox_depth_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_depth_verify(const struct swiftprox_shape *shape1,
                                             const double *pose1,
                                             const struct swiftprox_shape *shape2,
                                             const double *pose2,
                                             const struct swiftprox_depth_cache *cache,
                                             const struct swiftprox_depth_answer *answer);

const char *swiftprox_library_depth_ending_string(swiftprox_depth_ending ending);

typedef struct swiftprox_manifold_point {
  double local1[3];
  double local2[3];
  double world1[3];
  double world2[3];
  double gap_lower;
  double gap_upper;
  struct swiftprox_feature feature1;
  struct swiftprox_feature feature2;
  uint64_t id;
} swiftprox_manifold_point;

typedef struct swiftprox_manifold {
  swiftprox_outcome outcome;
  uint32_t reference;
  double lower;
  double upper;
  double normal[3];
  uint32_t point_count;
  uint32_t found_count;
} swiftprox_manifold;

typedef struct swiftprox_manifold_cache {
  uint32_t words[384];
} swiftprox_manifold_cache;

typedef struct swiftprox_manifold_config {
  size_t struct_size;
  double rotation_limit;
  double margin;
  uint32_t reduces;
} swiftprox_manifold_config;

void swiftprox_manifold_config_init_sized(struct swiftprox_manifold_config *config,
                                          size_t struct_size);
#define swiftprox_manifold_config_init(pointer) swiftprox_manifold_config_init_sized((pointer), sizeof *(pointer))

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_pair_manifold(const struct swiftprox_shape *shape1,
                                         const double *pose1,
                                         const struct swiftprox_shape *shape2,
                                         const double *pose2,
                                         struct swiftprox_manifold_cache *cache,
                                         const struct swiftprox_manifold_config *config,
                                         struct swiftprox_manifold_point *points,
                                         size_t capacity,
                                         struct swiftprox_manifold *manifold);

typedef struct swiftprox_scene swiftprox_scene;

typedef void (*swiftprox_task_callback)(uint32_t first, uint32_t end, void *context);

typedef void *(*swiftprox_enqueue_task_callback)(swiftprox_task_callback task,
                                                 uint32_t item_count,
                                                 void *context,
                                                 void *user);

typedef void (*swiftprox_finish_task_callback)(void *task, void *user);

typedef struct swiftprox_scene_options {
  size_t struct_size;
  double rotation_limit;
  uint32_t worker_count;
  swiftprox_enqueue_task_callback enqueue_task;
  swiftprox_finish_task_callback finish_task;
  void *task_user;
} swiftprox_scene_options;

void swiftprox_scene_options_init_sized(struct swiftprox_scene_options *options,
                                        size_t struct_size);
#define swiftprox_scene_options_init(pointer) swiftprox_scene_options_init_sized((pointer), sizeof *(pointer))

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_create(const struct swiftprox_scene_options *options,
                                        struct swiftprox_scene **scene);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_destroy(struct swiftprox_scene *scene);

typedef struct swiftprox_object_id {
  uint64_t bits;
} swiftprox_object_id;

typedef struct swiftprox_object_options {
  size_t struct_size;
  uint64_t user_data;
  double pose[12];
  int32_t fixed;
  uint32_t groups;
  uint32_t mask;
} swiftprox_object_options;

void swiftprox_object_options_init_sized(struct swiftprox_object_options *options,
                                         size_t struct_size);
#define swiftprox_object_options_init(pointer) swiftprox_object_options_init_sized((pointer), sizeof *(pointer))

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_add_shape(struct swiftprox_scene *scene,
                                           const struct swiftprox_shape *shape,
                                           const struct swiftprox_object_options *options,
                                           struct swiftprox_object_id *id);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_add_object(struct swiftprox_scene *scene,
                                            const struct swiftprox_shape *const *pieces,
                                            size_t piece_count,
                                            const struct swiftprox_object_options *options,
                                            struct swiftprox_object_id *id);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_add_mesh(struct swiftprox_scene *scene,
                                          const double *vertices,
                                          size_t vertex_count,
                                          const uint32_t *indices,
                                          const uint32_t *valences,
                                          size_t face_count,
                                          const struct swiftprox_shape_options *shape_options,
                                          const struct swiftprox_object_options *object_options,
                                          struct swiftprox_object_id *id);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_add_file(struct swiftprox_scene *scene,
                                          const char *path,
                                          const struct swiftprox_shape_options *shape_options,
                                          const struct swiftprox_object_options *object_options,
                                          struct swiftprox_object_id *id);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_copy_object(struct swiftprox_scene *scene,
                                             struct swiftprox_object_id original,
                                             struct swiftprox_object_id *id);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_remove_object(struct swiftprox_scene *scene,
                                               struct swiftprox_object_id id);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_is_object_valid(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id,
                                                 int32_t *valid);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_copy_object_ids(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id *ids,
                                                 size_t capacity,
                                                 size_t *count);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pose(struct swiftprox_scene *scene,
                                          struct swiftprox_object_id id,
                                          const double *pose);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_transform(struct swiftprox_scene *scene,
                                               struct swiftprox_object_id id,
                                               const double *rotation,
                                               const double *translation);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_poses(struct swiftprox_scene *scene,
                                           const struct swiftprox_object_id *ids,
                                           const double *poses,
                                           size_t count);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_all_poses(struct swiftprox_scene *scene,
                                               const double *poses,
                                               size_t count);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_all_transforms(struct swiftprox_scene *scene,
                                                    const double *rotations,
                                                    const double *translations,
                                                    size_t count);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_piece_pose(struct swiftprox_scene *scene,
                                                struct swiftprox_object_id id,
                                                uint32_t piece,
                                                const double *pose);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_piece_pose(const struct swiftprox_scene *scene,
                                                struct swiftprox_object_id id,
                                                uint32_t piece,
                                                double *pose);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_fixed(struct swiftprox_scene *scene,
                                           struct swiftprox_object_id id,
                                           int32_t fixed);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_user_data(struct swiftprox_scene *scene,
                                               struct swiftprox_object_id id,
                                               uint64_t user_data);

typedef struct swiftprox_object_info {
  size_t struct_size;
  uint64_t user_data;
  size_t piece_count;
  double pose[12];
  int32_t fixed;
  uint32_t groups;
  uint32_t mask;
} swiftprox_object_info;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_object_info(const struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id,
                                                 struct swiftprox_object_info *info);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_piece(const struct swiftprox_scene *scene,
                                           struct swiftprox_object_id id,
                                           size_t piece,
                                           const struct swiftprox_shape **shape);

#define SWIFTPROX_DEFAULT_TOLERANCE (-1.0)

typedef enum swiftprox_contact_detail SWIFTPROX_INT32 {
  SWIFTPROX_CONTACT_DETAIL_NONE = 0,
  SWIFTPROX_CONTACT_DETAIL_DEPTH = 1,
  SWIFTPROX_CONTACT_DETAIL_MANIFOLD = 2,
  SWIFTPROX_CONTACT_DETAIL_REDUCED_MANIFOLD = 3
} swiftprox_contact_detail;

typedef struct swiftprox_scene_query {
  size_t struct_size;
  double distance_tolerance;
  double absolute_error;
  double relative_error;
  double error_budget;
  uint32_t step_budget;
  int32_t early_exit;
  const struct swiftprox_pair_tuning *tuning;
  double margin;
  swiftprox_contact_detail detail;
} swiftprox_scene_query;

void swiftprox_scene_query_init_sized(struct swiftprox_scene_query *query,
                                      size_t struct_size);
#define swiftprox_scene_query_init(pointer) swiftprox_scene_query_init_sized((pointer), sizeof *(pointer))

typedef struct swiftprox_pair_result {
  struct swiftprox_object_id object1;
  struct swiftprox_object_id object2;
  uint64_t user_data1;
  uint64_t user_data2;
  uint32_t piece1;
  uint32_t piece2;
  struct swiftprox_pair_answer answer;
} swiftprox_pair_result;

typedef struct swiftprox_scene_answer {
  const struct swiftprox_pair_result *pairs;
  size_t count;
  int32_t intersecting;
  const struct swiftprox_pair_result *found;
} swiftprox_scene_answer;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_intersection(struct swiftprox_scene *scene,
                                                    const struct swiftprox_scene_query *query,
                                                    struct swiftprox_scene_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_tolerance(struct swiftprox_scene *scene,
                                                 const struct swiftprox_scene_query *query,
                                                 struct swiftprox_scene_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_exact_distance(struct swiftprox_scene *scene,
                                                      const struct swiftprox_scene_query *query,
                                                      struct swiftprox_scene_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_approximate_distance(struct swiftprox_scene *scene,
                                                            const struct swiftprox_scene_query *query,
                                                            struct swiftprox_scene_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_contacts(struct swiftprox_scene *scene,
                                                const struct swiftprox_scene_query *query,
                                                struct swiftprox_scene_answer *answer);

typedef struct swiftprox_contact {
  struct swiftprox_depth_answer depth;
  struct swiftprox_manifold manifold;
  size_t first_point;
} swiftprox_contact;

typedef struct swiftprox_scene_contacts {
  const struct swiftprox_contact *contacts;
  size_t count;
  const struct swiftprox_manifold_point *points;
  size_t point_count;
} swiftprox_scene_contacts;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_contacts(const struct swiftprox_scene *scene,
                                              struct swiftprox_scene_contacts *contacts);

typedef enum swiftprox_query_kind SWIFTPROX_INT32 {
  SWIFTPROX_QUERY_KIND_INTERSECTION = 0,
  SWIFTPROX_QUERY_KIND_DISTANCE = 1,
  SWIFTPROX_QUERY_KIND_CONTACT = 2,
  SWIFTPROX_QUERY_KIND_APPROXIMATE = 3
} swiftprox_query_kind;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_object(struct swiftprox_scene *scene,
                                              struct swiftprox_object_id id,
                                              swiftprox_query_kind kind,
                                              const struct swiftprox_scene_query *query,
                                              struct swiftprox_scene_answer *answer);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_placed(struct swiftprox_scene *scene,
                                              const struct swiftprox_shape *shape,
                                              const double *pose,
                                              swiftprox_query_kind kind,
                                              const struct swiftprox_scene_query *query,
                                              struct swiftprox_scene_answer *answer);

typedef struct swiftprox_object_pair {
  struct swiftprox_object_id object1;
  struct swiftprox_object_id object2;
  uint64_t user_data1;
  uint64_t user_data2;
} swiftprox_object_pair;

typedef struct swiftprox_scene_events {
  const struct swiftprox_object_pair *began;
  size_t began_count;
  const struct swiftprox_object_pair *ended;
  size_t ended_count;
} swiftprox_scene_events;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_query_events(struct swiftprox_scene *scene,
                                              double distance,
                                              struct swiftprox_scene_events *events);

typedef struct swiftprox_scene_statistics {
  uint64_t queries;
  uint64_t pairs;
  uint64_t marched;
  uint64_t coherent;
  uint64_t fallback;
  uint64_t exact;
  uint64_t marching_steps;
  uint64_t fallback_iterations;
  uint64_t exact_iterations;
  uint64_t within_tolerance;
  uint64_t budget_spent;
  uint64_t by_level[8];
  double error_spent;
  uint64_t bounding_spheres;
  uint64_t inscribed_spheres;
  uint64_t unmoved;
  uint64_t out_of_reach;
} swiftprox_scene_statistics;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_get_statistics(const struct swiftprox_scene *scene,
                                                struct swiftprox_scene_statistics *statistics);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_reset_statistics(struct swiftprox_scene *scene);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_shrink(struct swiftprox_scene *scene);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_activate_pair(struct swiftprox_scene *scene,
                                               struct swiftprox_object_id id1,
                                               struct swiftprox_object_id id2);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_deactivate_pair(struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id1,
                                                 struct swiftprox_object_id id2);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_activate_object(struct swiftprox_scene *scene,
                                                 struct swiftprox_object_id id);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_deactivate_object(struct swiftprox_scene *scene,
                                                   struct swiftprox_object_id id);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_activate_all(struct swiftprox_scene *scene);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_deactivate_all(struct swiftprox_scene *scene);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_is_pair_active(const struct swiftprox_scene *scene,
                                                struct swiftprox_object_id id1,
                                                struct swiftprox_object_id id2,
                                                int32_t *active);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_filter(struct swiftprox_scene *scene,
                                            struct swiftprox_object_id id,
                                            uint32_t groups,
                                            uint32_t mask);

typedef int32_t (*swiftprox_pair_filter_callback)(struct swiftprox_object_id object1,
                                                  struct swiftprox_object_id object2,
                                                  void *user);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pair_filter(struct swiftprox_scene *scene,
                                                 swiftprox_pair_filter_callback filter,
                                                 void *user);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_filter_again(struct swiftprox_scene *scene);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_set_pairs(struct swiftprox_scene *scene,
                                           const struct swiftprox_object_id *pairs,
                                           size_t count);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_find_pairs(struct swiftprox_scene *scene);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_scene_record(struct swiftprox_scene *scene,
                                        const char *path);

typedef struct swiftprox_replay swiftprox_replay;

typedef struct swiftprox_replay_step_info {
  size_t struct_size;
  int32_t has_step;
  int32_t has_query;
  swiftprox_query_kind kind;
  int32_t cut_off;
  double fraction;
} swiftprox_replay_step_info;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_open(const char *path,
                                       const struct swiftprox_scene_options *options,
                                       struct swiftprox_replay **replay);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_close(struct swiftprox_replay *replay);

struct swiftprox_scene *swiftprox_replay_scene(struct swiftprox_replay *replay);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_read(struct swiftprox_replay *replay,
                                       struct swiftprox_replay_step_info *step);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_change(struct swiftprox_replay *replay);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_ask(struct swiftprox_replay *replay,
                                      double distance_tolerance,
                                      struct swiftprox_scene_answer *answer,
                                      int32_t *identical);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_replay_get_number(const struct swiftprox_replay *replay,
                                             struct swiftprox_object_id id,
                                             uint32_t *number);

typedef void (*swiftprox_log_callback)(swiftprox_status status, const char *message, void *user);

void swiftprox_library_set_log(swiftprox_log_callback callback,
                               void *user);

typedef void *(*swiftprox_allocate_callback)(void *user, size_t size, size_t alignment);

typedef void (*swiftprox_deallocate_callback)(void *user, void *memory, size_t size, size_t alignment);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_library_set_allocator(swiftprox_allocate_callback allocate,
                                                 swiftprox_deallocate_callback deallocate,
                                                 void *user);

typedef struct swiftprox_mesh_sink swiftprox_mesh_sink;

typedef int32_t (*swiftprox_mesh_reader_callback)(void *user,
                                                  const char *data,
                                                  size_t size,
                                                  struct swiftprox_mesh_sink *sink);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_library_register_mesh_reader(const char *magic,
                                                        swiftprox_mesh_reader_callback callback,
                                                        void *user);

swiftprox_status swiftprox_mesh_sink_add_vertices(struct swiftprox_mesh_sink *sink,
                                                  const double *vertices,
                                                  size_t vertex_count);

swiftprox_status swiftprox_mesh_sink_add_faces(struct swiftprox_mesh_sink *sink,
                                               const uint32_t *indices,
                                               const uint32_t *valences,
                                               size_t face_count);

swiftprox_status swiftprox_mesh_sink_set_single_precision(struct swiftprox_mesh_sink *sink);

swiftprox_status swiftprox_mesh_sink_fail(struct swiftprox_mesh_sink *sink,
                                          const char *message);

#ifdef __cplusplus
}
#endif

#endif
