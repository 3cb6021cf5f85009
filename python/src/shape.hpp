// Shapes as both pairs and scenes take them.
#pragma once

#include "arrays.hpp"

#include <mutex>

/// A share of a shape of C.
class Shape
{
  public:
    explicit Shape(const swiftprox_shape *owned) : shape_(owned) {}
    Shape(const Shape &other) : shape_(swiftprox_shape_retain(other.shape_)) {}
    Shape(Shape &&other) noexcept : shape_(other.shape_) { other.shape_ = nullptr; }
    Shape &operator=(const Shape &) = delete;
    ~Shape() { swiftprox_shape_release(shape_); }
    const swiftprox_shape *get() const { return shape_; }

  private:
    const swiftprox_shape *shape_;
};

/// A call of C for what calls take turns at. The lock is taken without the GIL, so that neither waits for the other; what is the
/// owner's is copied before the lock is free.
template <class Owner, class Call> void run_alone(Owner &owner, Call call)
{
    swiftprox_status status;
    {
        nb::gil_scoped_release released;
        const std::lock_guard<std::mutex> alone(owner.lock);
        status = call();
    }
    if (status != SWIFTPROX_OK) {
        fail(status, swiftprox_library_last_error_message());
    }
}

/// A motion from Python: a Motion, or a pose, which rests.
swiftprox_motion read_motion(nb::handle source, const char *name);

/// The options of a cast.
inline swiftprox_cast_config cast_config(double max_distance, double time_begin, double time_end, double time_tolerance)
{
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
    config.max_distance = max_distance;
    config.time_begin = time_begin;
    config.time_end = time_end;
    config.time_tolerance = time_tolerance;
    return config;
}
