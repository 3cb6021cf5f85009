// What Python hands over and gets: poses, arrays, structured arrays, errors.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <swiftprox.h>
#include <swiftprox/batch.h>
#include <swiftprox/compound.h>
#include <swiftprox/curved.h>
#include <swiftprox/geometry.h>
#include <swiftprox/ground.h>
#include <swiftprox/motion.h>
#include <swiftprox/sets.h>
#include <swiftprox/verify.h>

namespace nb = nanobind;

/// An exception of Python's for a status of C, with C's message. It needs the GIL, in the thread that made the call.
[[noreturn]] void fail(swiftprox_status status, const std::string &message);
[[noreturn]] void refuse(const std::string &message); // InputError

/// A call of C without the GIL. The message is read in the same thread.
template <class Call> void run(Call call)
{
    swiftprox_status status;
    {
        nb::gil_scoped_release released;
        status = call();
    }
    if (status != SWIFTPROX_OK) {
        fail(status, swiftprox_library_last_error_message());
    }
}

struct Pose {
    double m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

/// A buffer of an array, held while this lives; whatever the array is, of doubles or converted to doubles.
class Doubles
{
  public:
    explicit Doubles(nb::handle source, const char *name);
    ~Doubles();
    Doubles(const Doubles &) = delete;
    Doubles &operator=(const Doubles &) = delete;
    const double *data() const { return data_; }
    size_t ndim() const { return shape_.size(); }
    size_t dim(size_t axis) const { return shape_[axis]; }
    const std::vector<size_t> &shape() const { return shape_; }

  private:
    Py_buffer view_{};
    const double *data_ = nullptr;
    std::vector<size_t> shape_;
};

std::string text(const std::vector<size_t> &shape);

/// One pose from a Pose, or an array of shape (3, 4) or (4, 4).
Pose read_pose(nb::handle source, const char *name);

/// Poses from a Pose or an array of shape (..., 3, 4) or (..., 4, 4); `axes` says how many axes there are before.
class Poses
{
  public:
    Poses(nb::handle source, const char *name);
    const double *data() const { return data_; }
    /// The axes before (3, 4).
    const std::vector<size_t> &axes() const { return axes_; }
    size_t count() const { return count_; }

  private:
    std::vector<double> copy_;
    std::unique_ptr<Doubles> doubles_;
    const double *data_ = nullptr;
    std::vector<size_t> axes_;
    size_t count_ = 1;
};

/// Three numbers.
std::array<double, 3> read_vector(nb::handle source, const char *name);
/// Whole numbers from 0, such as vertex numbers, of any integer type.
std::vector<uint64_t> read_integers(nb::handle source, const char *name, std::vector<size_t> &shape);

/// numpy's dtype of a struct of C: "distance", "pair", "contact", "point", "least distance", "ray hit", "ground contact", "compound contact".
nb::object dtype(const std::string &name);

/// An array of `count` structs, and where they are. The array owns them.
struct Records {
    nb::object array;
    void *data = nullptr;
};
Records make_records(const char *name, size_t count);
template <class T> nb::object copy_records(const char *name, const T *first, size_t count)
{
    Records records = make_records(name, count);
    if (count) {
        std::memcpy(records.data, first, count * sizeof(T));
    }
    return records.array;
}

/// A numpy array of doubles that is a copy.
nb::object make_array(const double *first, size_t rows, size_t columns = 0);

/// A contact of two pieces of a scene, in one record.
struct SceneContact {
    uint64_t object1, object2, user_data1, user_data2;
    uint32_t piece1, piece2;
    swiftprox_manifold manifold;
    uint64_t first_point;
};

void bind_shape(nb::module_ &);
void bind_pair(nb::module_ &);
void bind_compound(nb::module_ &);
void bind_scene(nb::module_ &);
void bind_errors(nb::module_ &);
