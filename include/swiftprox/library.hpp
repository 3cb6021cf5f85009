/* The library itself: version, log, allocator, mesh readers, enumerators in words. */
#ifndef SWIFTPROX_LIBRARY_HPP
#define SWIFTPROX_LIBRARY_HPP

#include "geometry.h"
#include "motion.h"
#include "process.h"
#include "result.hpp"

#include <cstddef>
#include <cstdint>

namespace swiftprox
{

namespace library
{
inline const char *version() noexcept
{
    return swiftprox_library_version();
}
/** Whether this program's header goes with the library that runs. */
inline Result<void> try_check_version() noexcept
{
    return detail::status(
        swiftprox_library_check_version(SWIFTPROX_VERSION_MAJOR, SWIFTPROX_VERSION_MINOR, SWIFTPROX_VERSION_PATCH));
}
inline void set_log(swiftprox_log_callback callback, void *user = nullptr) noexcept
{
    swiftprox_library_set_log(callback, user);
}
inline Result<void> try_set_allocator(swiftprox_allocate_callback allocate, swiftprox_deallocate_callback deallocate,
                                      void *user = nullptr) noexcept
{
    return detail::status(swiftprox_library_set_allocator(allocate, deallocate, user));
}
inline Result<void> try_register_mesh_reader(const char *magic, swiftprox_mesh_reader_callback callback,
                                             void *user = nullptr) noexcept
{
    return detail::status(swiftprox_library_register_mesh_reader(magic, callback, user));
}
#if SWIFTPROX_HAS_EXCEPTIONS
inline void check_version()
{
    take(try_check_version());
}
inline void set_allocator(swiftprox_allocate_callback allocate, swiftprox_deallocate_callback deallocate, void *user = nullptr)
{
    take(try_set_allocator(allocate, deallocate, user));
}
inline void register_mesh_reader(const char *magic, swiftprox_mesh_reader_callback callback, void *user = nullptr)
{
    take(try_register_mesh_reader(magic, callback, user));
}
#endif
} // namespace library

/** What a registered mesh reader fills, while it runs. A refused call refuses the file, so statuses need no look. */
class MeshSink
{
  public:
    explicit MeshSink(swiftprox_mesh_sink *sink) noexcept : sink_(sink) {}
    Result<void> try_add_vertices(Range<const double> vertices) noexcept
    {
        if (const char *fault = detail::mesh_fault(vertices, {}, {})) {
            return refuse(fault);
        }
        return detail::status(swiftprox_mesh_sink_add_vertices(sink_, vertices.data(), vertices.size() / 3));
    }
    Result<void> try_add_faces(Range<const std::uint32_t> indices, Range<const std::uint32_t> valences = {}) noexcept
    {
        if (const char *fault = detail::mesh_fault({}, indices, valences)) {
            return refuse(fault);
        }
        return detail::status(swiftprox_mesh_sink_add_faces(sink_, indices.data(), valences.empty() ? nullptr : valences.data(),
                                                            valences.empty() ? indices.size() / 3 : valences.size()));
    }
    Result<void> try_set_single_precision() noexcept { return detail::status(swiftprox_mesh_sink_set_single_precision(sink_)); }
    Result<void> try_fail(const char *message) noexcept { return detail::status(swiftprox_mesh_sink_fail(sink_, message)); }

  private:
    /* The file, for what C could not see. */
    Result<void> refuse(const char *fault) noexcept
    {
        static_cast<void>(swiftprox_mesh_sink_fail(sink_, fault));
        return detail::refused<void>(fault);
    }

    swiftprox_mesh_sink *sink_;
};

inline const char *to_string(swiftprox_status status) noexcept
{
    return swiftprox_library_status_string(status);
}
inline const char *to_string(swiftprox_outcome outcome) noexcept
{
    return swiftprox_library_outcome_string(outcome);
}
inline const char *to_string(swiftprox_decided_by decided_by) noexcept
{
    return swiftprox_library_decided_by_string(decided_by);
}
inline const char *to_string(swiftprox_feature_kind kind) noexcept
{
    return swiftprox_library_feature_kind_string(kind);
}
inline const char *to_string(swiftprox_cast_outcome outcome) noexcept
{
    return swiftprox_library_cast_outcome_string(outcome);
}
inline const char *to_string(swiftprox_ray_outcome outcome) noexcept
{
    return swiftprox_library_ray_outcome_string(outcome);
}
inline const char *to_string(swiftprox_point_location location) noexcept
{
    return swiftprox_library_point_location_string(location);
}
inline const char *to_string(swiftprox_depth_ending ending) noexcept
{
    return swiftprox_library_depth_ending_string(ending);
}

} // namespace swiftprox

#endif
