/* swiftprox_tuning.h of 0.1.0 before motions and face_noise, without comments. Programs compiled with it must run on. */
#ifndef SWIFTPROX_TUNING_H
#define SWIFTPROX_TUNING_H

#include "swiftprox.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum swiftprox_hierarchy SWIFTPROX_INT32 {
  SWIFTPROX_HIERARCHY_NONE = 0,
  SWIFTPROX_HIERARCHY_QUADRIC = 1,
  SWIFTPROX_HIERARCHY_DOBKIN_KIRKPATRICK = 2,
  SWIFTPROX_HIERARCHY_OUTER_CUTS = 3,
  SWIFTPROX_HIERARCHY_GIVEN = 4,
  SWIFTPROX_HIERARCHY_AUTOMATIC = 5
} swiftprox_hierarchy;

typedef enum swiftprox_lookup SWIFTPROX_INT32 {
  SWIFTPROX_LOOKUP_AUTOMATIC = 0,
  SWIFTPROX_LOOKUP_NONE = 1,
  SWIFTPROX_LOOKUP_SHELLS = 2,
  SWIFTPROX_LOOKUP_SPHERICAL = 3
} swiftprox_lookup;

typedef struct swiftprox_shape_tuning {
  size_t struct_size;
  swiftprox_hierarchy hierarchy;
  swiftprox_lookup lookup;
  double decimation;
  size_t minimum_triangles;
  size_t most_levels;
  double lookup_radius_factor;
  uint32_t lookup_resolution;
} swiftprox_shape_tuning;

void swiftprox_shape_tuning_init_sized(struct swiftprox_shape_tuning *tuning,
                                       size_t struct_size);
#define swiftprox_shape_tuning_init(pointer) swiftprox_shape_tuning_init_sized((pointer), sizeof *(pointer))

typedef struct swiftprox_shape_tuning_info {
  size_t struct_size;
  swiftprox_hierarchy hierarchy;
  swiftprox_lookup lookup;
  size_t level_count;
  size_t level_bytes;
  size_t lookup_bytes;
  uint32_t lookup_resolution;
} swiftprox_shape_tuning_info;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_tuning_info(const struct swiftprox_shape *shape,
                                                 struct swiftprox_shape_tuning_info *info);

typedef struct swiftprox_mesh {
  const double *vertices;
  size_t vertex_count;
  const uint32_t *indices;
  const uint32_t *valences;
  size_t face_count;
} swiftprox_mesh;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_create_from_levels(const struct swiftprox_mesh *levels,
                                                    size_t level_count,
                                                    const struct swiftprox_shape_options *options,
                                                    const struct swiftprox_shape **shape);

typedef struct swiftprox_level_info {
  size_t struct_size;
  size_t vertex_count;
  size_t edge_count;
  size_t face_count;
  size_t triangle_count;
  double deviation;
  size_t bytes;
} swiftprox_level_info;

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_get_level_info(const struct swiftprox_shape *shape,
                                                size_t level,
                                                struct swiftprox_level_info *info);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_level_vertices(const struct swiftprox_shape *shape,
                                                     size_t level,
                                                     double *vertices,
                                                     size_t capacity);

SWIFTPROX_NODISCARD
swiftprox_status swiftprox_shape_copy_level_triangles(const struct swiftprox_shape *shape,
                                                      size_t level,
                                                      uint32_t *corners,
                                                      size_t capacity);

typedef enum swiftprox_start SWIFTPROX_INT32 {
  SWIFTPROX_START_AUTOMATIC = 0,
  SWIFTPROX_START_CACHE = 1,
  SWIFTPROX_START_TABLE = 2,
  SWIFTPROX_START_COLD = 3
} swiftprox_start;

typedef enum swiftprox_levels SWIFTPROX_INT32 {
  SWIFTPROX_LEVELS_AUTOMATIC = 0,
  SWIFTPROX_LEVELS_NONE = 1,
  SWIFTPROX_LEVELS_ALL = 2
} swiftprox_levels;

typedef enum swiftprox_refinement SWIFTPROX_INT32 {
  SWIFTPROX_REFINEMENT_ADAPTIVE = 0,
  SWIFTPROX_REFINEMENT_SINGLE = 1,
  SWIFTPROX_REFINEMENT_SINGLE_SINGLE = 2,
  SWIFTPROX_REFINEMENT_DOUBLE_DOUBLE = 3
} swiftprox_refinement;

typedef struct swiftprox_pair_tuning {
  size_t struct_size;
  swiftprox_start start;
  swiftprox_levels levels;
  swiftprox_refinement refinement;
} swiftprox_pair_tuning;

void swiftprox_pair_tuning_init_sized(struct swiftprox_pair_tuning *tuning,
                                      size_t struct_size);
#define swiftprox_pair_tuning_init(pointer) swiftprox_pair_tuning_init_sized((pointer), sizeof *(pointer))

#ifdef __cplusplus
}
#endif

#endif
