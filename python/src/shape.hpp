// Shapes as both pairs and scenes take them.
#pragma once

#include "arrays.hpp"

#include <limits>
#include <mutex>

const double infinity = std::numeric_limits<double>::infinity();

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

/// A share of a compound of C.
class Compound
{
  public:
    explicit Compound(const swiftprox_compound *owned) : compound_(owned) {}
    Compound(const Compound &other) : compound_(swiftprox_compound_retain(other.compound_)) {}
    Compound(Compound &&other) noexcept : compound_(other.compound_) { other.compound_ = nullptr; }
    Compound &operator=(const Compound &) = delete;
    ~Compound() { swiftprox_compound_release(compound_); }
    const swiftprox_compound *get() const { return compound_; }
    size_t piece_count() const
    {
        swiftprox_compound_info info;
        run([&] { return swiftprox_compound_get_info(compound_, &info); });
        return info.piece_count;
    }

  private:
    const swiftprox_compound *compound_;
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

/// Vertices of shape (n, 3).
void check_points(const Doubles &points, const char *name);

/// Triangles, polygons of one size as the rows of an array, or a list of lists.
void read_faces(nb::handle faces, std::vector<uint32_t> &indices, std::vector<uint32_t> &valences);

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

/// The options of a distance.
inline swiftprox_pair_config pair_config(double max_distance)
{
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    config.max_distance = max_distance;
    return config;
}

/// The options of a manifold.
inline swiftprox_manifold_config manifold_config(double max_distance, bool reduces)
{
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    config.max_distance = max_distance;
    config.reduces = reduces;
    return config;
}

/// The answer of a cast, with the options that its check needs.
struct Cast {
    swiftprox_cast_answer answer{};
    swiftprox_cast_config config = SWIFTPROX_CAST_CONFIG_DEFAULT;
};

inline swiftprox_outcome outcome_of(int32_t outcome)
{
    return swiftprox_outcome(outcome);
}

/// ("vertex", 3), ("edge", 1, 2), ("face", 0) or ("none",).
nb::tuple feature_of(const swiftprox_feature &feature);
const char *word(swiftprox_outcome outcome);
const char *word(swiftprox_cast_outcome outcome);

/// A number that is None from `count` on.
inline nb::object number_below(uint32_t number, size_t count)
{
    return number < count ? nb::object(nb::int_(number)) : nb::object(nb::none());
}

/// The part of a ray in a body, and the piece or triangle of that.
struct RayHit {
    swiftprox_ray_answer answer{};
    nb::object part = nb::none();
};

#define VECTOR_SIG(member) nb::sig("def " member "(self) -> numpy.typing.NDArray[numpy.float64]")
