#include "arrays.hpp"

#include <cmath>
#include <cstddef>
#include <memory>

#include <nanobind/stl/string.h>

namespace
{

PyObject *base_error, *input_error, *memory_error, *file_error, *unverified;

PyObject *new_error(nb::module_ &m, const char *name, const char *text, nb::handle bases)
{
    const std::string full = std::string("swiftprox.") + name;
    PyObject *made = PyErr_NewExceptionWithDoc(full.c_str(), text, bases.ptr(), nullptr);
    if (!made) {
        throw nb::python_error();
    }
    m.attr(name) = nb::borrow(made);
    return made;
}

[[noreturn]] void raise(PyObject *kind, const std::string &message)
{
    PyErr_SetString(kind, message.c_str());
    throw nb::python_error();
}

nb::module_ numpy()
{
    return nb::module_::import_("numpy");
}

bool is_one_of(const char *format, const char *letters)
{
    if (!format) {
        return false;
    }
    const char *letter = format;
    if (*letter == '@' || *letter == '=' || *letter == '<') {
        ++letter;
    }
    return *letter && !letter[1] && std::strchr(letters, *letter);
}

/// Anything with numbers, as a contiguous array of numpy's.
nb::object as_numpy(nb::handle source, const char *type, const char *name)
{
    try {
        nb::object array = nb::borrow(source);
        if (nb::hasattr(source, "__dlpack__") && !PyObject_CheckBuffer(source.ptr())) {
            array = numpy().attr("from_dlpack")(source);
        }
        return numpy().attr("ascontiguousarray")(array, nb::arg("dtype") = type);
    } catch (nb::python_error &error) {
        // The base classes: MemoryError and KeyboardInterrupt stay what they are.
        if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError) && !error.matches(PyExc_BufferError)) {
            throw;
        }
        refuse(std::string(name) + " is no array of numbers: " + nb::cast<std::string>(nb::str(error.value())));
    }
}

/// The beginning of PyArrayObject_fields, which is a part of numpy's ABI, of 1.x and of 2.x.
struct NumpyArray {
    PyObject_HEAD
    char *data;
    int nd;
    Py_ssize_t *shape;
    Py_ssize_t *strides;
    PyObject *base;
    PyObject *dtype;
};

/// An array of numpy's own class and of its own dtype of doubles in the machine's order; null for all others.
const NumpyArray *usual_array(nb::handle source)
{
    static PyObject *const type = nb::object(numpy().attr("ndarray")).release().ptr();
    static PyObject *const doubles = nb::object(numpy().attr("dtype")("float64")).release().ptr();
    if ((PyObject *)Py_TYPE(source.ptr()) != type) {
        return nullptr;
    }
    const auto *array = reinterpret_cast<const NumpyArray *>(source.ptr());
    return array->dtype == doubles ? array : nullptr;
}

/// The part of a pose that is used, with a look at the rest. `m` is rows of four.
void check_last_row(const double *m, const char *name)
{
    const auto is_last = [](double a, double b, double c, double d) {
        return std::fabs(a) <= 1e-9 && std::fabs(b) <= 1e-9 && std::fabs(c) <= 1e-9 && std::fabs(d - 1) <= 1e-9;
    };
    if (is_last(m[12], m[13], m[14], m[15])) {
        return;
    }
    if (is_last(m[3], m[7], m[11], m[15])) {
        refuse(std::string(name) + " looks column-major: its last column is 0 0 0 1, which should be its last row. Pass its transpose");
    }
    refuse(std::string(name) + ": the last row of a (4, 4) pose must be 0 0 0 1");
}

[[noreturn]] void refuse_shape(const char *name, const std::vector<size_t> &shape)
{
    const size_t n = shape.size();
    std::string message = std::string(name) + " has the shape " + text(shape) + "; a pose is (3, 4), [R|T], or (4, 4)";
    if (n >= 2 && shape[n - 2] == 4 && shape[n - 1] == 3) {
        message += ". It looks column-major: pass its transpose";
    } else if (n == 1 && (shape[0] == 12 || shape[0] == 16)) {
        message += ". Row-major numbers want reshape(" + std::string(shape[0] == 12 ? "3" : "4") + ", 4)";
    }
    refuse(message);
}

} // namespace

void bind_errors(nb::module_ &m)
{
    const auto type = [](PyObject *object) { return nb::borrow(object); };
    base_error = new_error(m, "Error", "What went wrong in a call, with the library's message.", type(PyExc_Exception));
    input_error = new_error(m, "InputError", "An argument is refused: a pose, a mesh, a number.",
                            nb::make_tuple(type(base_error), type(PyExc_ValueError)));
    memory_error = new_error(m, "OutOfMemory", "Memory is lacking. The same call may succeed later.",
                             nb::make_tuple(type(base_error), type(PyExc_MemoryError)));
    file_error = new_error(m, "FileError", "A file cannot be read or parsed.", nb::make_tuple(type(base_error), type(PyExc_OSError)));
    unverified = new_error(m, "Unverified", "An answer is wrong for these shapes and poses.", type(base_error));
}

void fail(swiftprox_status status, const std::string &message)
{
    switch (status) {
    case SWIFTPROX_ERROR_INVALID_ARGUMENT:
    case SWIFTPROX_ERROR_POSE:
    case SWIFTPROX_ERROR_MESH:
    case SWIFTPROX_ERROR_HANDLE:
    case SWIFTPROX_ERROR_LIMIT:
        raise(input_error, message);
    case SWIFTPROX_ERROR_MEMORY:
        raise(memory_error, message);
    case SWIFTPROX_ERROR_FILE:
        raise(file_error, message);
    case SWIFTPROX_ERROR_UNVERIFIED:
        raise(unverified, message);
    default:
        raise(base_error, message);
    }
}

void refuse(const std::string &message)
{
    raise(input_error, message);
}

std::string text(const std::vector<size_t> &shape)
{
    std::string all = "(";
    for (size_t axis = 0; axis < shape.size(); ++axis) {
        all += (axis ? ", " : "") + std::to_string(shape[axis]);
    }
    return all + (shape.size() == 1 ? ",)" : ")");
}

Doubles::Doubles(nb::handle source, const char *name)
{
    const auto get = [&](nb::handle from) {
        if (PyObject_GetBuffer(from.ptr(), &view_, PyBUF_C_CONTIGUOUS | PyBUF_FORMAT) == 0) {
            const bool is_aligned = reinterpret_cast<uintptr_t>(view_.buf) % alignof(double) == 0;
            if (view_.itemsize == sizeof(double) && is_one_of(view_.format, "d") && is_aligned) {
                return true;
            }
            PyBuffer_Release(&view_);
        } else {
            PyErr_Clear();
        }
        view_ = {};
        return false;
    };
    if (!PyObject_CheckBuffer(source.ptr()) || !get(source)) {
        const nb::object array = as_numpy(source, "float64", name);
        if (!get(array)) {
            // Contiguous doubles that are not aligned.
            refuse(std::string(name) + " is no array of numbers");
        }
    }
    shape_.assign(view_.shape, view_.shape + view_.ndim);
    data_ = static_cast<const double *>(view_.buf);
}

Doubles::~Doubles()
{
    if (view_.obj) {
        PyBuffer_Release(&view_);
    }
}

Pose read_pose(nb::handle source, const char *name)
{
    Pose *kept;
    if (nb::try_cast(source, kept, false)) {
        if (kept) {
            return *kept;
        }
        refuse(std::string(name) + " is None");
    }
    Pose pose;
    // The usual array, read in place: half as long as by its buffer or DLPack.
    const NumpyArray *array = usual_array(source);
    if (array && array->nd == 2 && array->shape[1] == 4 && (array->shape[0] == 3 || array->shape[0] == 4)) {
        double all[16];
        for (Py_ssize_t row = 0; row < array->shape[0]; ++row) {
            for (Py_ssize_t column = 0; column < 4; ++column) {
                std::memcpy(&all[4 * row + column], array->data + row * array->strides[0] + column * array->strides[1], sizeof(double));
            }
        }
        if (array->shape[0] == 4) {
            check_last_row(all, name);
        }
        std::memcpy(pose.m, all, sizeof pose.m);
        return pose;
    }
    const Poses poses(source, name);
    if (!poses.axes().empty()) {
        std::vector<size_t> shape = poses.axes();
        refuse(std::string(name) + " is " + std::to_string(poses.count()) + " poses; one is wanted");
    }
    std::memcpy(pose.m, poses.data(), sizeof pose.m);
    return pose;
}

Poses::Poses(nb::handle source, const char *name)
{
    Pose *kept;
    if (nb::try_cast(source, kept, false) && kept) {
        copy_.assign(kept->m, kept->m + 12);
        data_ = copy_.data();
        return;
    }
    doubles_ = std::make_unique<Doubles>(source, name);
    const std::vector<size_t> &shape = doubles_->shape();
    const size_t n = shape.size();
    if (n < 2 || shape[n - 1] != 4 || (shape[n - 2] != 3 && shape[n - 2] != 4)) {
        refuse_shape(name, shape);
    }
    axes_.assign(shape.begin(), shape.end() - 2);
    for (const size_t axis : axes_) {
        count_ *= axis;
    }
    data_ = doubles_->data();
    if (shape[n - 2] == 4) {
        copy_.resize(12 * count_);
        for (size_t k = 0; k < count_; ++k) {
            check_last_row(data_ + 16 * k, name);
            std::memcpy(copy_.data() + 12 * k, data_ + 16 * k, 12 * sizeof(double));
        }
        data_ = copy_.data();
        doubles_.reset();
    }
}

std::array<double, 3> read_vector(nb::handle source, const char *name)
{
    const Doubles doubles(source, name);
    if (doubles.ndim() != 1 || doubles.dim(0) != 3) {
        refuse(std::string(name) + " has the shape " + text(doubles.shape()) + ", not (3,)");
    }
    return {doubles.data()[0], doubles.data()[1], doubles.data()[2]};
}

std::vector<uint64_t> read_integers(nb::handle source, const char *name, std::vector<size_t> &shape)
{
    nb::object array = nb::hasattr(source, "__dlpack__") && !PyObject_CheckBuffer(source.ptr())
                           ? numpy().attr("from_dlpack")(source)
                           : numpy().attr("asarray")(source);
    const char kind = nb::cast<std::string>(array.attr("dtype").attr("kind"))[0];
    const bool is_empty = nb::cast<size_t>(array.attr("size")) == 0;
    if (kind != 'u' && kind != 'i' && !is_empty) {
        refuse(std::string(name) + " must be whole numbers");
    }
    if (kind == 'i' && !is_empty && nb::cast<int64_t>(nb::int_(array.attr("min")())) < 0) {
        refuse(std::string(name) + " has a negative number");
    }
    array = as_numpy(array, "uint64", name);
    Py_buffer view{};
    if (PyObject_GetBuffer(array.ptr(), &view, PyBUF_C_CONTIGUOUS) != 0) {
        throw nb::python_error();
    }
    shape.assign(view.shape, view.shape + view.ndim);
    std::vector<uint64_t> numbers(view.len / sizeof(uint64_t));
    if (!numbers.empty()) {
        std::memcpy(numbers.data(), view.buf, view.len);
    }
    PyBuffer_Release(&view);
    return numbers;
}

// --- Structs as numpy sees them --------------------------------------------------------------------------------------------------

namespace
{

struct Member {
    const char *name;
    const char *type;
    int rows, columns;
    size_t offset;
};

#define NUMBER(of, member, type) Member{#member, type, 0, 0, offsetof(of, member)}
#define VECTOR(of, member) Member{#member, "f8", 3, 0, offsetof(of, member)}
#define FEATURE(of, member) Member{#member, "feature", 0, 0, offsetof(of, member)}

std::vector<Member> at(size_t offset, std::vector<Member> members)
{
    for (Member &member : members) {
        member.offset += offset;
    }
    return members;
}

std::vector<Member> join(std::vector<Member> all, const std::vector<Member> &more)
{
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

std::vector<Member> members_of_distance()
{
    using T = swiftprox_pair_answer;
    return {NUMBER(T, outcome, "i4"), NUMBER(T, decided_by, "i4"), NUMBER(T, distance, "f8"), NUMBER(T, lower, "f8"),
            NUMBER(T, upper, "f8"),   VECTOR(T, local1),           VECTOR(T, local2),         VECTOR(T, world1),
            VECTOR(T, world2),        VECTOR(T, normal),           FEATURE(T, feature1),      FEATURE(T, feature2),
            Member{"proof", "u4", 4, 2, offsetof(T, proof)},       NUMBER(T, proof_count, "u4")};
}

std::vector<Member> members_of_pair()
{
    using T = swiftprox_pair_result;
    return join({NUMBER(T, object1, "u8"), NUMBER(T, object2, "u8"), NUMBER(T, user_data1, "u8"), NUMBER(T, user_data2, "u8"),
                 NUMBER(T, piece1, "u4"), NUMBER(T, piece2, "u4")},
                at(offsetof(T, answer), members_of_distance()));
}

std::vector<Member> members_of_manifold()
{
    using T = swiftprox_manifold;
    return {NUMBER(T, outcome, "i4"), NUMBER(T, reference, "u4"),   NUMBER(T, lower, "f8"),      NUMBER(T, upper, "f8"),
            VECTOR(T, normal),        NUMBER(T, point_count, "u4"), NUMBER(T, found_count, "u4")};
}

std::vector<Member> members_of_point()
{
    using T = swiftprox_manifold_point;
    return {VECTOR(T, local1), VECTOR(T, local2), VECTOR(T, world1), VECTOR(T, world2),
            Member{"lower", "f8", 0, 0, offsetof(T, gap_lower)}, Member{"upper", "f8", 0, 0, offsetof(T, gap_upper)},
            FEATURE(T, feature1), FEATURE(T, feature2), NUMBER(T, id, "u8")};
}

std::vector<Member> members_of_contact()
{
    using T = SceneContact;
    return join({NUMBER(T, object1, "u8"), NUMBER(T, object2, "u8"), NUMBER(T, user_data1, "u8"), NUMBER(T, user_data2, "u8"),
                 NUMBER(T, piece1, "u4"), NUMBER(T, piece2, "u4"), NUMBER(T, first_point, "u8")},
                at(offsetof(T, manifold), members_of_manifold()));
}

std::vector<Member> members_of_least_distance()
{
    using T = swiftprox_least_distance;
    std::vector<Member> nearest = at(offsetof(T, nearest), members_of_pair());
    // The interval is that of the sets.
    std::vector<Member> kept = {NUMBER(T, lower, "f8"), NUMBER(T, upper, "f8")};
    for (const Member &member : nearest) {
        if (std::strcmp(member.name, "lower") && std::strcmp(member.name, "upper")) {
            kept.push_back(member);
        }
    }
    return kept;
}

std::vector<Member> members_of_ray_hit()
{
    using T = swiftprox_scene_ray_hit;
    using A = swiftprox_ray_answer;
    return join({NUMBER(T, object, "u8"), NUMBER(T, user_data, "u8"), NUMBER(T, piece, "u4")},
                at(offsetof(T, answer), {NUMBER(A, outcome, "i4"), Member{"entry", "f8", 2, 0, offsetof(A, entry)},
                                         Member{"exit", "f8", 2, 0, offsetof(A, exit)}, VECTOR(A, normal), FEATURE(A, feature)}));
}

std::vector<Member> members_of_ground_contact()
{
    using T = swiftprox_ground_contact;
    return join(at(offsetof(T, manifold), members_of_manifold()), {NUMBER(T, triangle, "u4"), NUMBER(T, first_point, "u8")});
}

std::vector<Member> members_of_compound_contact()
{
    using T = swiftprox_compound_contact;
    return join(at(offsetof(T, manifold), members_of_manifold()),
                {NUMBER(T, first_point, "u4"), NUMBER(T, piece1, "u4"), NUMBER(T, piece2, "u4")});
}

nb::object make_dtype(const std::vector<Member> &members, size_t size)
{
    nb::list names, formats, offsets;
    for (const Member &member : members) {
        nb::object format = nb::str(member.type);
        if (!std::strcmp(member.type, "feature")) {
            format = make_dtype({Member{"kind", "i4", 0, 0, offsetof(swiftprox_feature, kind)},
                                 Member{"ids", "u4", 2, 0, offsetof(swiftprox_feature, ids)}},
                                sizeof(swiftprox_feature));
        }
        if (member.columns) {
            format = nb::make_tuple(format, nb::make_tuple(member.rows, member.columns));
        } else if (member.rows) {
            format = nb::make_tuple(format, nb::make_tuple(member.rows));
        }
        names.append(member.name);
        formats.append(format);
        offsets.append(member.offset);
    }
    nb::dict all;
    all["names"] = names;
    all["formats"] = formats;
    all["offsets"] = offsets;
    all["itemsize"] = size;
    return numpy().attr("dtype")(all);
}

} // namespace

nb::object dtype(const std::string &name)
{
    // Made at the first use, and then kept for ever.
    static PyObject *made = PyDict_New();
    const nb::str key(name.c_str());
    if (PyObject *found = PyDict_GetItemWithError(made, key.ptr())) {
        return nb::borrow(found);
    }
    nb::object fresh;
    if (name == "distance") {
        fresh = make_dtype(members_of_distance(), sizeof(swiftprox_pair_answer));
    } else if (name == "pair") {
        fresh = make_dtype(members_of_pair(), sizeof(swiftprox_pair_result));
    } else if (name == "point") {
        fresh = make_dtype(members_of_point(), sizeof(swiftprox_manifold_point));
    } else if (name == "contact") {
        fresh = make_dtype(members_of_contact(), sizeof(SceneContact));
    } else if (name == "least distance") {
        fresh = make_dtype(members_of_least_distance(), sizeof(swiftprox_least_distance));
    } else if (name == "ray hit") {
        fresh = make_dtype(members_of_ray_hit(), sizeof(swiftprox_scene_ray_hit));
    } else if (name == "ground contact") {
        fresh = make_dtype(members_of_ground_contact(), sizeof(swiftprox_ground_contact));
    } else if (name == "compound contact") {
        fresh = make_dtype(members_of_compound_contact(), sizeof(swiftprox_compound_contact));
    } else {
        refuse("no dtype is called " + name +
               "; there are: distance, pair, point, contact, least distance, ray hit, ground contact, compound contact");
    }
    PyDict_SetItem(made, key.ptr(), fresh.ptr());
    return fresh;
}

Records make_records(const char *name, size_t count)
{
    Records records;
    records.array = numpy().attr("empty")(count, nb::arg("dtype") = dtype(name));
    Py_buffer view{};
    // Its memory stays where it is: the array owns it.
    if (PyObject_GetBuffer(records.array.ptr(), &view, PyBUF_STRIDES) != 0) {
        throw nb::python_error();
    }
    records.data = view.buf;
    PyBuffer_Release(&view);
    return records;
}

nb::object make_array(const double *first, size_t rows, size_t columns)
{
    nb::object array = columns ? numpy().attr("empty")(nb::make_tuple(rows, columns)) : numpy().attr("empty")(rows);
    Py_buffer view{};
    if (PyObject_GetBuffer(array.ptr(), &view, PyBUF_STRIDES) != 0) {
        throw nb::python_error();
    }
    std::memcpy(view.buf, first, view.len);
    PyBuffer_Release(&view);
    return array;
}
