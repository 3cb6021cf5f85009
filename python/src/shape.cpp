#include "shape.hpp"

#include <nanobind/stl/string.h>

namespace
{

swiftprox_input input_of(const std::string &policy)
{
    static const char *const names[] = {"strict", "flat", "hull", "nearly_convex", "patch"};
    for (int k = 0; k < 5; ++k) {
        if (policy == names[k]) {
            return swiftprox_input(k);
        }
    }
    refuse("policy is '" + policy + "'; there are strict, flat, hull, nearly_convex and patch");
}

swiftprox_shape_options options_of(const std::string &policy, double swept_radius, double scale)
{
    swiftprox_shape_options options = SWIFTPROX_SHAPE_OPTIONS_DEFAULT;
    options.input = input_of(policy);
    options.swept_radius = swept_radius;
    options.scale = scale;
    return options;
}

uint32_t vertex_number(uint64_t number)
{
    if (number > UINT32_MAX) {
        refuse("faces has the vertex number " + std::to_string(number));
    }
    return uint32_t(number);
}

Shape make_shape(nb::handle points, nb::handle faces, const std::string &policy, double swept_radius, double scale)
{
    const Doubles vertices(points, "points");
    check_points(vertices, "points");
    const swiftprox_shape_options options = options_of(policy, swept_radius, scale);
    const swiftprox_shape *made = nullptr;
    if (faces.is_none()) {
        run([&] { return swiftprox_shape_create_from_points(vertices.data(), vertices.dim(0), &options, &made); });
        return Shape(made);
    }
    std::vector<uint32_t> indices, valences;
    read_faces(faces, indices, valences);
    const swiftprox_mesh mesh = {vertices.data(), vertices.dim(0), indices.data(), valences.data(), valences.size()};
    run([&] { return swiftprox_shape_create_from_mesh(mesh, &options, &made); });
    return Shape(made);
}

Shape load(nb::handle path, const std::string &policy, double swept_radius, double scale)
{
    const swiftprox_shape_options options = options_of(policy, swept_radius, scale);
    const nb::bytes name = nb::steal<nb::bytes>([&] {
        PyObject *encoded = nullptr;
        if (!PyUnicode_FSConverter(path.ptr(), &encoded)) {
            throw nb::python_error();
        }
        return encoded;
    }());
    const swiftprox_shape *made = nullptr;
    run([&] { return swiftprox_shape_create_from_file(name.c_str(), &options, &made); });
    return Shape(made);
}

swiftprox_shape_info info_of(const Shape &shape)
{
    swiftprox_shape_info info{};
    info.struct_size = sizeof info;
    run([&] { return swiftprox_shape_get_info(shape.get(), &info); });
    return info;
}

swiftprox_motion fixed_at(const Pose &pose)
{
    swiftprox_motion motion{};
    motion.kind = SWIFTPROX_MOTION_KIND_FIXED;
    std::memcpy(motion.start, pose.m, sizeof pose.m);
    return motion;
}

} // namespace

void read_faces(nb::handle faces, std::vector<uint32_t> &indices, std::vector<uint32_t> &valences)
{
    std::vector<size_t> shape;
    if (nb::isinstance<nb::list>(faces) || nb::isinstance<nb::tuple>(faces)) {
        for (nb::handle face : faces) {
            const std::vector<uint64_t> corners = read_integers(face, "a face of faces", shape);
            for (const uint64_t corner : corners) {
                indices.push_back(vertex_number(corner));
            }
            valences.push_back(uint32_t(corners.size()));
        }
        return;
    }
    const std::vector<uint64_t> corners = read_integers(faces, "faces", shape);
    if (shape.size() != 2) {
        refuse("faces has the shape " + text(shape) + ", not (m, 3)");
    }
    for (const uint64_t corner : corners) {
        indices.push_back(vertex_number(corner));
    }
    valences.assign(shape[0], uint32_t(shape[1]));
}

void check_points(const Doubles &points, const char *name)
{
    if (points.ndim() != 2 || points.dim(1) != 3) {
        refuse(std::string(name) + " has the shape " + text(points.shape()) + ", not (n, 3)");
    }
}

swiftprox_motion read_motion(nb::handle source, const char *name)
{
    swiftprox_motion *motion;
    if (nb::try_cast(source, motion, false) && motion) {
        return *motion;
    }
    return fixed_at(read_pose(source, name));
}

void bind_shape(nb::module_ &m)
{
    nb::class_<Pose>(m, "Pose", "A pose that is read once and used often: pairs take it faster than an array.")
        .def(
            "__init__",
            [](Pose *self, nb::handle matrix) { new (self) Pose(matrix.is_none() ? Pose() : read_pose(matrix, "matrix")); },
            nb::arg("matrix").none() = nb::none(),
            nb::sig("def __init__(self, matrix: numpy.typing.ArrayLike | Pose | None = None) -> None"),
            "From an array of shape (3, 4), row-major [R|T], or (4, 4) with the last row 0 0 0 1; by default the identity.")
        .def_prop_ro("matrix", [](const Pose &self) { return make_array(self.m, 3, 4); },
                     nb::sig("def matrix(self) -> numpy.typing.NDArray[numpy.float64]"), "[R|T], a copy of shape (3, 4).");

    nb::class_<Shape>(m, "Shape", "A convex body that never changes. Pairs, scenes and threads share it.")
        .def(
            "__init__",
            [](Shape *self, nb::handle points, nb::handle faces, const std::string &policy, double swept_radius, double scale) {
                new (self) Shape(make_shape(points, faces, policy, swept_radius, scale));
            },
            nb::arg("points"), nb::arg("faces").none() = nb::none(), nb::kw_only(), nb::arg("policy") = "strict",
            nb::arg("swept_radius") = 0.0, nb::arg("scale") = 1.0,
            nb::sig("def __init__(self, points: numpy.typing.ArrayLike, faces: numpy.typing.ArrayLike | collections.abc.Sequence[Sequence[int]] | "
                    "None = None, *, policy: str = 'strict', swept_radius: float = 0.0, scale: float = 1.0) -> None"),
            "The convex hull of points, shape (n, 3), or the mesh of these vertices and faces.\n\n"
            "faces: triangles of shape (m, 3), or lists of vertex numbers from 0, counter-clockwise seen from outside.\n"
            "policy: 'strict' wants a closed convex mesh with interior; 'flat' admits bodies without; 'hull' takes the hull of the\n"
            "vertices; 'nearly_convex' admits rounded coordinates; 'patch' takes the hull of the vertices that the faces use.\n"
            "swept_radius: a ball swept over the body, in the unit of the points. scale: multiplies all lengths.")
        .def_static(
            "box",
            [](double x, double y, double z, double radius) {
                const double half_extents[3] = {x, y, z};
                const swiftprox_shape *made = nullptr;
                run([&] { return swiftprox_shape_create_box(half_extents, radius, &made); });
                return Shape(made);
            },
            nb::arg("x"), nb::arg("y"), nb::arg("z"), nb::arg("radius") = 0.0,
            "The box of the half extents x, y and z about the origin. A ball of the radius rounds and enlarges it.")
        .def_static(
            "sphere",
            [](double radius) {
                const swiftprox_shape *made = nullptr;
                run([&] { return swiftprox_shape_create_sphere(radius, &made); });
                return Shape(made);
            },
            nb::arg("radius"), "The sphere about the origin.")
        .def_static(
            "capsule",
            [](double half_length, double radius) {
                const swiftprox_shape *made = nullptr;
                run([&] { return swiftprox_shape_create_capsule(half_length, radius, &made); });
                return Shape(made);
            },
            nb::arg("half_length"), nb::arg("radius"), "All points within the radius of the segment from -half_length to half_length along z.")
        .def_static(
            "cylinder",
            [](double radius, double half_height, double deviation) {
                const swiftprox_shape *made = nullptr;
                run([&] { return swiftprox_shape_create_cylinder(radius, half_height, deviation, &made); });
                return Shape(made);
            },
            nb::arg("radius"), nb::arg("half_height"), nb::arg("deviation") = 0.0,
            "The cylinder from z = -half_height to half_height. It reaches at most the deviation beyond its prism; 0: 1e-4 of the radius.")
        .def_static(
            "cone",
            [](double radius, double half_height, double deviation) {
                const swiftprox_shape *made = nullptr;
                run([&] { return swiftprox_shape_create_cone(radius, half_height, deviation, &made); });
                return Shape(made);
            },
            nb::arg("radius"), nb::arg("half_height"), nb::arg("deviation") = 0.0,
            "The cone with its base at z = -half_height and its tip at half_height; the deviation as of a cylinder.")
        .def_static(
            "ellipsoid",
            [](double x, double y, double z, double deviation) {
                const double semi_axes[3] = {x, y, z};
                const swiftprox_shape *made = nullptr;
                run([&] { return swiftprox_shape_create_ellipsoid(semi_axes, deviation, &made); });
                return Shape(made);
            },
            nb::arg("x"), nb::arg("y"), nb::arg("z"), nb::arg("deviation") = 0.0,
            "The ellipsoid of the semi-axes x, y and z about the origin. The deviation as of a cylinder; 0: 1e-3 of the largest semi-axis.")
        .def_prop_ro("vertex_count", [](const Shape &self) { return info_of(self).vertex_count; }, "Vertices of the hull.")
        .def_prop_ro("face_count", [](const Shape &self) { return info_of(self).face_count; }, "Faces; coplanar triangles count as one.")
        .def_prop_ro("volume", [](const Shape &self) { return info_of(self).volume; }, "Volume without the swept ball, in length cubed.")
        .def_prop_ro("swept_radius", [](const Shape &self) { return info_of(self).swept_radius; }, "Radius of the swept ball, a length.")
        .def_prop_ro("deviation", [](const Shape &self) { return info_of(self).deviation; },
                     "How far a cylinder, cone or ellipsoid reaches beyond its polyhedron at most; 0 for other shapes.")
        .def_prop_ro("centre_of_mass", [](const Shape &self) { return make_array(info_of(self).centre_of_mass, 3); },
                     nb::sig("def centre_of_mass(self) -> numpy.typing.NDArray[numpy.float64]"), "In the local frame, shape (3,).")
        .def_prop_ro(
            "vertices",
            [](const Shape &self) {
                const size_t count = info_of(self).vertex_count;
                std::vector<double> vertices(3 * count);
                run([&] { return swiftprox_shape_copy_vertices(self.get(), vertices.data(), nullptr, count); });
                return make_array(vertices.data(), count, 3);
            },
            nb::sig("def vertices(self) -> numpy.typing.NDArray[numpy.float64]"), "Vertices of the hull in the local frame, shape (n, 3).");

    m.def("load", &load, nb::arg("path"), nb::kw_only(), nb::arg("policy") = "strict", nb::arg("swept_radius") = 0.0,
          nb::arg("scale") = 1.0,
          nb::sig("def load(path: str | bytes | os.PathLike[str], *, policy: str = 'strict', swept_radius: float = 0.0, scale: float = 1.0) -> Shape"),
          "A shape from a mesh file: TRI, POLY, OFF, OBJ or STL. The other arguments are those of Shape.");

    nb::class_<swiftprox_motion>(m, "Motion", "How a body moves. A pose where a motion is wanted is a body that rests.")
        .def_static("fixed", [](nb::handle pose) { return fixed_at(read_pose(pose, "pose")); }, nb::arg("pose"),
                    nb::sig("def fixed(pose: Pose | numpy.typing.ArrayLike) -> Motion"), "The body rests at the pose.")
        .def_static(
            "between",
            [](nb::handle start, nb::handle end, nb::handle centre) {
                const Pose a = read_pose(start, "start"), b = read_pose(end, "end");
                std::array<double, 3> c{};
                if (!centre.is_none()) {
                    c = read_vector(centre, "centre");
                }
                swiftprox_motion motion{};
                run([&] { return swiftprox_motion_between(a.m, b.m, c.data(), 0, &motion, nullptr); });
                return motion;
            },
            nb::arg("start"), nb::arg("end"), nb::arg("centre").none() = nb::none(),
            nb::sig("def between(start: Pose | numpy.typing.ArrayLike, end: Pose | numpy.typing.ArrayLike, "
                    "centre: numpy.typing.ArrayLike | None = None) -> Motion"),
            "From the pose start at time 0 to end at time 1 by the shortest turn, at a constant rate.\n\n"
            "centre: the point of the body's frame, shape (3,), that moves on a line; by default the origin.")
        .def_static(
            "screw",
            [](nb::handle start, nb::handle velocity, nb::handle rotation, nb::handle centre) {
                swiftprox_motion motion = fixed_at(read_pose(start, "start"));
                motion.kind = SWIFTPROX_MOTION_KIND_SCREW;
                const auto v = read_vector(velocity, "velocity"), w = read_vector(rotation, "rotation");
                std::array<double, 3> c{};
                if (!centre.is_none()) {
                    c = read_vector(centre, "centre");
                }
                std::memcpy(motion.velocity, v.data(), sizeof v);
                std::memcpy(motion.rotation, w.data(), sizeof w);
                std::memcpy(motion.centre, c.data(), sizeof c);
                return motion;
            },
            nb::arg("start"), nb::arg("velocity"), nb::arg("rotation"), nb::arg("centre").none() = nb::none(),
            nb::sig("def screw(start: Pose | numpy.typing.ArrayLike, velocity: numpy.typing.ArrayLike, rotation: "
                    "numpy.typing.ArrayLike, centre: numpy.typing.ArrayLike | None = None) -> Motion"),
            "The centre moves at a velocity, length per unit of time, shape (3,).\n\n"
            "rotation: the angular velocity in the world, radians per unit of time, shape (3,).");
}
