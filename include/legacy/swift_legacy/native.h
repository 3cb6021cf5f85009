/* What is asked of swiftprox, in one place: shapes from meshes, and what its options and queries are filled with. */
#ifndef SWIFT_LEGACY_NATIVE_H
#define SWIFT_LEGACY_NATIVE_H

#include <algorithm>
#include <cstring>
#include <limits>
#include <swiftprox.h>
#include <swiftprox/compound.h>
#include <swiftprox/geometry.h>
#include <swiftprox/scene.h>
#include <swiftprox/tuning.h>

#include "defaults.h"
#include "mesh.h"

namespace swift_legacy {

/* How far a vertex may lie outside a face in any case, as a part of the bounding box's diagonal. */
const double CONVEXITY_TOLERANCE = 1e-6;

/* How many levels of detail a caller may give: a limit of SWIFT 1.x. */
const int MOST_LEVELS = 32;

enum Convexity {
    CONVEXITY_REQUIRED, /* the mesh is to be convex, flat ones included */
    CONVEXITY_BY_HULL,  /* of another mesh the convex hull counts */
    CONVEXITY_OF_PATCH  /* the mesh is a piece of a decomposition, on its hull: that counts */
};

/* How levels of detail are made for a body that comes without. */
struct LevelOptions {
    int least_triangles;
    double ratio;

    LevelOptions(int min_tri_count, SWIFT_Real qslim_tri_ratio)
        : least_triangles(min_tri_count), ratio(qslim_tri_ratio)
    {
    }

    bool are_asked_for() const
    {
#ifdef SWIFT_HIERARCHY
        return least_triangles != DEFAULT_MIN_TCOUNT || ratio < DEFAULT_QSLIM_TRATIO || ratio > DEFAULT_QSLIM_TRATIO;
#else
        return false;
#endif
    }
};

inline swiftprox_mesh native_mesh(const Mesh& mesh)
{
    swiftprox_mesh native;
    native.vertices = mesh.vertices.empty() ? NULL : &mesh.vertices[0];
    native.vertex_count = mesh.vertex_count();
    native.indices = mesh.indices.empty() ? NULL : &mesh.indices[0];
    native.valences = mesh.valences.empty() ? NULL : &mesh.valences[0];
    native.face_count = mesh.face_count;
    return native;
}

/* To be called before any transform, which hides how coordinates were written. */
inline void find_tolerance(Mesh& mesh)
{
    mesh.tolerance = CONVEXITY_TOLERANCE;
#ifndef SWIFT_LEGACY_STRICT
    double found;
    if (swiftprox_mesh_estimate_tolerance(&mesh.vertices[0], mesh.vertex_count(), &found) == SWIFTPROX_OK) {
        mesh.tolerance = std::max(mesh.tolerance, found);
    }
#endif
}

/* A shape, or null after a failure, which swiftprox_library_last_error_message explains. levels[0] is the body. */
inline const swiftprox_shape* make_shape(const std::vector<Mesh>& levels, const LevelOptions& level_options)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
#ifdef SWIFT_LEGACY_STRICT
    options.input = SWIFTPROX_INPUT_FLAT;
#else
    options.input = SWIFTPROX_INPUT_NEARLY_CONVEX;
#endif
    options.convexity_tolerance = levels[0].tolerance;
    swiftprox_shape_tuning tuning = SWIFTPROX_SHAPE_TUNING_DEFAULT;
    const swiftprox_shape* shape = NULL;
    swiftprox_status status;
    if (levels.size() > 1) {
        std::vector<swiftprox_mesh> native;
        for (std::size_t i = 0; i < levels.size(); ++i) {
            native.push_back(native_mesh(levels[i]));
        }
        status = swiftprox_shape_create_from_levels(&native[0], native.size(), &options, &shape);
    } else {
        if (level_options.are_asked_for()) {
            tuning.hierarchy = SWIFTPROX_HIERARCHY_QUADRIC;
            if (level_options.ratio > 0 && level_options.ratio < 1) {
                tuning.decimation = level_options.ratio;
            }
            if (level_options.least_triangles >= 0) {
                tuning.minimum_triangles = static_cast<std::size_t>(level_options.least_triangles);
            }
            options.tuning = &tuning;
        }
        const swiftprox_mesh body = native_mesh(levels[0]);
        status = swiftprox_shape_create_from_mesh(body, &options, &shape);
    }
    return status == SWIFTPROX_OK ? shape : NULL;
}

/* The hull of a piece of a decomposition; null after a failure. */
inline const swiftprox_shape* make_hull_of_patch(const Mesh& mesh)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    options.input = SWIFTPROX_INPUT_PATCH;
    const swiftprox_shape* shape = NULL;
    const swiftprox_mesh body = native_mesh(mesh);
    const swiftprox_status status = swiftprox_shape_create_from_mesh(body, &options, &shape);
    return status == SWIFTPROX_OK ? shape : NULL;
}

/* The convex hull of a mesh's vertices, which may be flat; null after a failure. */
inline const swiftprox_shape* make_hull(const Mesh& mesh)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    options.input = SWIFTPROX_INPUT_HULL;
    const swiftprox_shape* shape = NULL;
    const swiftprox_status status =
        swiftprox_shape_create_from_points(&mesh.vertices[0], mesh.vertex_count(), &options, &shape);
    return status == SWIFTPROX_OK ? shape : NULL;
}

/* Numbers as doubles: as they are, or converted into `room`. */
inline const double* doubles(const double* numbers, double*, std::size_t)
{
    return numbers;
}

inline const double* doubles(const float* numbers, double* room, std::size_t count)
{
    if (numbers == NULL) {
        return NULL;
    }
    std::copy(numbers, numbers + count, room);
    return room;
}

inline std::size_t room_for(const double*, std::size_t)
{
    return 1;
}

inline std::size_t room_for(const float*, std::size_t count)
{
    return count;
}

inline swiftprox_status set_transform(swiftprox_scene* scene, swiftprox_object_id id, const SWIFT_Real* rotation,
                                      const SWIFT_Real* translation)
{
    double R[9], T[3];
    return swiftprox_scene_set_transform(scene, id, doubles(rotation, R, 9), doubles(translation, T, 3));
}

inline swiftprox_status set_pose(swiftprox_scene* scene, swiftprox_object_id id, const SWIFT_Real* pose)
{
    double RT[12];
    return swiftprox_scene_set_pose(scene, id, doubles(pose, RT, 12));
}

inline swiftprox_status set_all_transforms(swiftprox_scene* scene, const SWIFT_Real* rotations, const SWIFT_Real* translations,
                                           std::size_t count)
{
    std::vector<double> R(room_for(rotations, 9 * count)), T(room_for(translations, 3 * count));
    return swiftprox_scene_set_transforms(scene, NULL, doubles(rotations, &R[0], 9 * count), doubles(translations, &T[0], 3 * count),
                                          count);
}

inline swiftprox_status set_all_poses(swiftprox_scene* scene, const SWIFT_Real* poses, std::size_t count)
{
    std::vector<double> RT(room_for(poses, 12 * count));
    return swiftprox_scene_set_poses(scene, NULL, doubles(poses, &RT[0], 12 * count), count);
}

/* The largest double below a positive one. */
inline double next_below(double x)
{
    uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    --bits;
    std::memcpy(&x, &bits, sizeof bits);
    return x;
}

/* Whether pairs at exactly the tolerance count: in SWIFT 1.x they do, in SWIFT++ they do not. */
enum Bound { BOUND_INCLUDED, BOUND_EXCLUDED };

/* As swiftprox takes it. Negative ones are 0, SWIFT_INFINITY stands for no tolerance. */
inline double native_tolerance(SWIFT_Real tolerance, Bound bound)
{
    if (tolerance >= SWIFT_INFINITY) {
        return std::numeric_limits<double>::infinity();
    }
    const double value = tolerance;
    if (value <= 0) {
        return 0;
    }
    return bound == BOUND_EXCLUDED ? next_below(value) : value;
}

inline double native_error(SWIFT_Real error)
{
    const double value = error;
    return value < 0 ? 0 : value;
}

typedef swiftprox_status (*NativeQuery)(swiftprox_scene*, const swiftprox_scene_query*, swiftprox_scene_answer*);

/* What a scene is asked. */
struct Question {
    NativeQuery ask;
    bool early_exit;
    double tolerance;
    double absolute_error;
    double relative_error;

    Question(NativeQuery query, bool exits_early, double max_distance)
        : ask(query), early_exit(exits_early), tolerance(max_distance), absolute_error(0), relative_error(0)
    {
    }
};

/* The last failure of swiftprox, after what failed. */
inline void report_failure(const std::string& what)
{
    report(what + swiftprox_library_last_error_message());
}

inline void report_failure_of(const char* method)
{
    report_failure("Error (" + std::string(method) + "): ");
}

} // namespace swift_legacy

#endif
