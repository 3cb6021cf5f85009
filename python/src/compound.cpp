#include "shape.hpp"

#include <nanobind/stl/string.h>

namespace
{

struct CompoundPair {
    Compound compound1, compound2;
    /// Calls from several threads take turns.
    std::mutex lock{};
    swiftprox_compound_cache cache{};
};

/// The members of the pieces' answer, and which pieces they are.
struct CompoundDistance : swiftprox_pair_answer {
    nb::object piece1, piece2;
    /// As C says them.
    uint32_t numbers[2];
};

struct CompoundSignedDistance : swiftprox_signed_distance {
    nb::object piece1, piece2;
};

/// The members of the deepest pieces' signed distance, but for the ends.
struct CompoundDepth {
    swiftprox_compound_depth_answer answer{};
    CompoundSignedDistance deepest;
};

struct CompoundCast : Cast {
    nb::object piece1, piece2;
    uint32_t numbers[2];
};

struct CompoundPoint {
    swiftprox_point_answer answer{};
    uint32_t piece = 0;
};

Compound make_compound(nb::handle pieces, nb::handle poses)
{
    // Shares of their own: an iterator may make each shape as it comes.
    std::vector<Shape> held;
    std::vector<const swiftprox_shape *> shapes;
    for (nb::handle piece : pieces) {
        held.push_back(nb::cast<const Shape &>(piece));
        shapes.push_back(held.back().get());
    }
    std::unique_ptr<Poses> read;
    if (!poses.is_none()) {
        read = std::make_unique<Poses>(poses, "poses");
        if (read->axes().size() != 1 || read->count() != shapes.size()) {
            refuse("there are " + std::to_string(shapes.size()) + " pieces; poses must have the shape (" +
                   std::to_string(shapes.size()) + ", 3, 4)");
        }
    }
    const swiftprox_compound *made = nullptr;
    run([&] { return swiftprox_compound_create(shapes.data(), read ? read->data() : nullptr, shapes.size(), &made); });
    return Compound(made);
}

Compound compound_from_mesh(nb::handle points, nb::handle faces, double tolerance)
{
    const Doubles vertices(points, "points");
    check_points(vertices, "points");
    std::vector<uint32_t> indices, valences;
    read_faces(faces, indices, valences);
    const swiftprox_mesh mesh = {vertices.data(), vertices.dim(0), indices.data(), valences.data(), valences.size()};
    const swiftprox_compound *made = nullptr;
    run([&] { return swiftprox_compound_create_from_mesh(mesh, tolerance, nullptr, nullptr, &made); });
    return Compound(made);
}

nb::tuple piece_of(const Compound &compound, uint32_t piece)
{
    const swiftprox_shape *shape = nullptr;
    Pose pose;
    run([&] { return swiftprox_compound_get_piece(compound.get(), piece, &shape, pose.m); });
    return nb::make_tuple(Shape(swiftprox_shape_retain(shape)), make_array(pose.m, 3, 4));
}

RayHit ray(const Compound &compound, nb::handle pose, nb::handle origin, nb::handle direction, double t_max)
{
    const Pose at = read_pose(pose, "pose");
    const auto o = read_vector(origin, "origin"), d = read_vector(direction, "direction");
    const swiftprox_ray asked = {{o[0], o[1], o[2]}, {d[0], d[1], d[2]}, t_max};
    swiftprox_compound_ray_answer answer;
    run([&] { return swiftprox_compound_cast_ray({compound.get(), at.m}, &asked, &answer); });
    return {answer.answer, number_below(answer.piece, compound.piece_count())};
}

CompoundPoint point(const Compound &compound, nb::handle pose, nb::handle point)
{
    const Pose at = read_pose(pose, "pose");
    const auto p = read_vector(point, "point");
    swiftprox_compound_point_answer answer;
    run([&] { return swiftprox_compound_locate_point({compound.get(), at.m}, p.data(), &answer); });
    return {answer.answer, answer.piece};
}

/// A compound, or the one of a single shape.
Compound read_compound(nb::handle source, const char *name)
{
    if (nb::isinstance<Compound>(source)) {
        return nb::cast<const Compound &>(source);
    }
    if (!nb::isinstance<Shape>(source)) {
        refuse(std::string(name) + " must be a Compound or a Shape");
    }
    const swiftprox_shape *const shape = nb::cast<const Shape &>(source).get();
    const swiftprox_compound *made = nullptr;
    run([&] { return swiftprox_compound_create(&shape, nullptr, 1, &made); });
    return Compound(made);
}

using Query = decltype(&swiftprox_compound_distance);

swiftprox_compound_answer ask(CompoundPair &pair, Query query, nb::handle pose1, nb::handle pose2, double max_distance)
{
    const Pose a = read_pose(pose1, "pose1"), b = read_pose(pose2, "pose2");
    const swiftprox_pair_config config = pair_config(max_distance);
    swiftprox_compound_answer answer;
    run_alone(pair, [&] {
        return query({pair.compound1.get(), a.m}, {pair.compound2.get(), b.m}, &pair.cache, &config, &answer);
    });
    return answer;
}

nb::object piece1(const CompoundPair &pair, uint32_t piece)
{
    return number_below(piece, pair.compound1.piece_count());
}

nb::object piece2(const CompoundPair &pair, uint32_t piece)
{
    return number_below(piece, pair.compound2.piece_count());
}

bool intersects(CompoundPair &pair, nb::handle pose1, nb::handle pose2)
{
    return ask(pair, &swiftprox_compound_intersection, pose1, pose2, infinity).answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING;
}

CompoundDistance distance(CompoundPair &pair, nb::handle pose1, nb::handle pose2, double max_distance)
{
    const swiftprox_compound_answer answer = ask(pair, &swiftprox_compound_distance, pose1, pose2, max_distance);
    return {answer.answer, piece1(pair, answer.piece1), piece2(pair, answer.piece2), {answer.piece1, answer.piece2}};
}

CompoundSignedDistance signed_distance(CompoundPair &pair, nb::handle pose1, nb::handle pose2, double max_distance)
{
    const Pose a = read_pose(pose1, "pose1"), b = read_pose(pose2, "pose2");
    const swiftprox_pair_config config = pair_config(max_distance);
    swiftprox_compound_signed_distance_answer answer;
    run_alone(pair, [&] {
        return swiftprox_compound_signed_distance({pair.compound1.get(), a.m}, {pair.compound2.get(), b.m}, &pair.cache, &config,
                                                  &answer);
    });
    return {answer.distance, piece1(pair, answer.piece1), piece2(pair, answer.piece2)};
}

CompoundDepth depth(const CompoundPair &pair, nb::handle pose1, nb::handle pose2, double relative_error)
{
    const Pose a = read_pose(pose1, "pose1"), b = read_pose(pose2, "pose2");
    swiftprox_depth_config config = SWIFTPROX_DEPTH_CONFIG_DEFAULT;
    config.relative_error = relative_error;
    CompoundDepth found;
    run([&] {
        return swiftprox_compound_depth({pair.compound1.get(), a.m}, {pair.compound2.get(), b.m}, &config, &found.answer);
    });
    const swiftprox_compound_signed_distance_answer &deepest = found.answer.deepest;
    found.deepest = {deepest.distance, piece1(pair, deepest.piece1), piece2(pair, deepest.piece2)};
    return found;
}

nb::tuple contacts(CompoundPair &pair, nb::handle pose1, nb::handle pose2, double max_distance, bool reduce)
{
    const Pose a = read_pose(pose1, "pose1"), b = read_pose(pose2, "pose2");
    const swiftprox_manifold_config config = manifold_config(max_distance, reduce);
    std::vector<swiftprox_compound_contact> all(16);
    std::vector<swiftprox_manifold_point> points(64);
    run([&] {
        for (;;) {
            swiftprox_compound_contacts found = {all.data(), all.size(), points.data(), points.size(), 0, 0};
            const swiftprox_status status = swiftprox_compound_get_contacts({pair.compound1.get(), a.m},
                                                                            {pair.compound2.get(), b.m}, &config, &found);
            const bool fits = found.contact_count <= all.size() && found.point_count <= points.size();
            all.resize(found.contact_count);
            points.resize(found.point_count);
            if (status != SWIFTPROX_OK || fits) {
                return status;
            }
        }
    });
    return nb::make_tuple(copy_records("compound contact", all.data(), all.size()),
                          copy_records("point", points.data(), points.size()));
}

CompoundCast cast(CompoundPair &pair, nb::handle motion1, nb::handle motion2, double max_distance, double time_begin,
                  double time_end, double time_tolerance)
{
    const swiftprox_motion a = read_motion(motion1, "motion1"), b = read_motion(motion2, "motion2");
    const swiftprox_cast_config config = cast_config(max_distance, time_begin, time_end, time_tolerance);
    swiftprox_compound_cast_answer answer;
    run_alone(pair, [&] {
        return swiftprox_compound_cast({pair.compound1.get(), &a}, {pair.compound2.get(), &b}, &pair.cache, &config, &answer);
    });
    return {{answer.answer, config}, piece1(pair, answer.piece1), piece2(pair, answer.piece2), {answer.piece1, answer.piece2}};
}

void verify(const CompoundPair &pair, nb::handle first, nb::handle second, nb::handle answer)
{
    CompoundCast *cast;
    if (nb::try_cast(answer, cast, false) && cast) {
        const swiftprox_motion a = read_motion(first, "pose1"), b = read_motion(second, "pose2");
        const swiftprox_compound_cast_answer said = {cast->answer, cast->numbers[0], cast->numbers[1]};
        run([&] {
            return swiftprox_compound_cast_verify({pair.compound1.get(), &a}, {pair.compound2.get(), &b}, &cast->config, &said);
        });
        return;
    }
    const Pose a = read_pose(first, "pose1"), b = read_pose(second, "pose2");
    CompoundDepth *depth;
    if (nb::try_cast(answer, depth, false) && depth) {
        run([&] {
            return swiftprox_compound_depth_verify({pair.compound1.get(), a.m}, {pair.compound2.get(), b.m}, &depth->answer);
        });
        return;
    }
    CompoundDistance *distance;
    if (!nb::try_cast(answer, distance, false) || !distance) {
        refuse("answer must be a CompoundDistance, a CompoundDepth or a CompoundCast");
    }
    const swiftprox_compound_answer said = {*distance, distance->numbers[0], distance->numbers[1]};
    run([&] { return swiftprox_compound_verify({pair.compound1.get(), a.m}, {pair.compound2.get(), b.m}, &said); });
}

template <class T, class Base> void bind_pieces(nb::class_<T, Base> &answer, const char *name)
{
    answer.def_ro("piece1", &T::piece1, nb::sig("def piece1(self) -> int | None"), "The piece of body 1; None where none is named.")
        .def_ro("piece2", &T::piece2, nb::sig("def piece2(self) -> int | None"), "The piece of body 2; None where none is named.")
        .def("__repr__", [name = std::string(name)](const T &self) {
            return nb::str("{}({}, distance={}, lower={}, upper={}, piece1={}, piece2={})")
                .format(name, word(outcome_of(self.outcome)), self.distance, self.lower, self.upper, self.piece1, self.piece2);
        });
}

} // namespace

#define ARRAY "numpy.typing.ArrayLike"
#define POSE "Pose | " ARRAY
#define RECORDS "numpy.typing.NDArray[numpy.void]"
#define TWO_POSES "pose1: " POSE ", pose2: " POSE

void bind_compound(nb::module_ &m)
{
    nb::class_<RayHit>(m, "RayHit", "The part of a ray that is in a body. Points are origin + t * direction.")
        .def_prop_ro("outcome", [](const RayHit &self) {
            static const char *const words[] = {"none", "miss", "hit", "inside", "undecided"};
            return words[self.answer.outcome];
        }, "'miss', 'hit', 'inside' where the ray begins in the body, or 'undecided' where a deviation hides it.")
        .def_prop_ro("entry", [](const RayHit &self) { return make_array(self.answer.entry, 2); }, VECTOR_SIG("entry"),
                     "The interval of t where the part begins, shape (2,); NaN of a miss.")
        .def_prop_ro("exit", [](const RayHit &self) { return make_array(self.answer.exit, 2); }, VECTOR_SIG("exit"),
                     "The interval of t where the ray leaves the convex piece, shape (2,).")
        .def_prop_ro("normal", [](const RayHit &self) { return make_array(self.answer.normal, 3); }, VECTOR_SIG("normal"),
                     "Of a hit the outward unit normal in the world, shape (3,).")
        .def_prop_ro("feature", [](const RayHit &self) { return feature_of(self.answer.feature); },
                     nb::sig("def feature(self) -> tuple[str, *tuple[int, ...]]"), "Of a hit the feature that the ray enters through.")
        .def_ro("part", &RayHit::part, nb::sig("def part(self) -> int | None"),
                "The piece of a compound or the triangle of a ground that the ray meets first; None of a miss.")
        .def("__repr__", [](const RayHit &self) {
            return nb::str("RayHit(entry=[{}, {}], part={})").format(self.answer.entry[0], self.answer.entry[1], self.part);
        });

    nb::class_<CompoundPoint>(m, "CompoundPoint", "Where a point is, by the piece with the least signed distance.")
        .def_prop_ro("location", [](const CompoundPoint &self) {
            static const char *const words[] = {"none", "inside", "on", "outside", "undecided"};
            return words[self.answer.location];
        }, "'inside' a piece, 'on' the surface of one and inside none, or 'outside'.")
        .def_prop_ro("distance", [](const CompoundPoint &self) { return self.answer.distance; },
                     "The signed distance from the piece's surface, a length: negative inside.")
        .def_prop_ro("lower", [](const CompoundPoint &self) { return self.answer.lower; }, "The true value is at least this.")
        .def_prop_ro("upper", [](const CompoundPoint &self) { return self.answer.upper; }, "The true value is at most this.")
        .def_prop_ro("world", [](const CompoundPoint &self) { return make_array(self.answer.world, 3); }, VECTOR_SIG("world"),
                     "The nearest point of the piece's surface in the world, shape (3,).")
        .def_prop_ro("normal", [](const CompoundPoint &self) { return make_array(self.answer.normal, 3); }, VECTOR_SIG("normal"),
                     "The unit normal in the world, shape (3,): along it the distance grows as the point moves.")
        .def_prop_ro("feature", [](const CompoundPoint &self) { return feature_of(self.answer.feature); },
                     nb::sig("def feature(self) -> tuple[str, *tuple[int, ...]]"), "What of the piece holds that point.")
        .def_ro("piece", &CompoundPoint::piece, "The piece.")
        .def("__repr__", [](const CompoundPoint &self) {
            return nb::str("CompoundPoint(lower={}, upper={}, piece={})").format(self.answer.lower, self.answer.upper, self.piece);
        });

    nb::class_<Compound>(m, "Compound", "The union of convex pieces, which never changes. Pairs and threads share it.")
        .def("__init__", [](Compound *self, nb::handle pieces, nb::handle poses) { new (self) Compound(make_compound(pieces, poses)); },
             nb::arg("pieces"), nb::arg("poses").none() = nb::none(),
             nb::sig("def __init__(self, pieces: collections.abc.Iterable[Shape], poses: " ARRAY " | None = None) -> None"),
             "Pieces may overlap. poses: where each is in the compound, shape (n, 3, 4); by default the identity.")
        .def_static("from_mesh", &compound_from_mesh, nb::arg("points"), nb::arg("faces"), nb::arg("tolerance") = 0.0,
                    nb::sig("def from_mesh(points: " ARRAY ", faces: " ARRAY " | collections.abc.Sequence[Sequence[int]], "
                            "tolerance: float = 0.0) -> Compound"),
                    "The convex pieces that the surface of a closed mesh is cut into; arguments as of Shape.\n\n"
                    "tolerance, relative to the box's diagonal: 0 keeps the surface and leaves hollows; from 1e-4 on pieces are solid, "
                    "and no farther than that from the body.")
        .def_prop_ro("piece_count", &Compound::piece_count, "The number of pieces.")
        .def("piece", &piece_of, nb::arg("piece"),
             nb::sig("def piece(self, piece: int) -> tuple[Shape, numpy.typing.NDArray[numpy.float64]]"),
             "The shape of a piece, and its pose in the compound, shape (3, 4).")
        .def("ray", &ray, nb::arg("pose"), nb::arg("origin"), nb::arg("direction"), nb::kw_only(), nb::arg("t_max") = infinity,
             nb::sig("def ray(self, pose: " POSE ", origin: " ARRAY ", direction: " ARRAY ", *, t_max: float = ...) -> RayHit"),
             "Where a ray of the world first enters a piece. origin, direction: shape (3,).")
        .def("point", &point, nb::arg("pose"), nb::arg("point"),
             nb::sig("def point(self, pose: " POSE ", point: " ARRAY ") -> CompoundPoint"), "Where a point of the world is, shape (3,).");

    nb::class_<CompoundDistance, swiftprox_pair_answer> distances(
        m, "CompoundDistance", "The distance of two compounds; points, normal and features are those of the nearest two pieces.");
    bind_pieces(distances, "CompoundDistance");
    nb::class_<CompoundSignedDistance, swiftprox_signed_distance> signed_distances(
        m, "CompoundSignedDistance", "The least signed distance of two pieces, with their points, normal and features.");
    bind_pieces(signed_distances, "CompoundSignedDistance");

    nb::class_<CompoundDepth>(m, "CompoundDepth", "How deep two compounds are in each other, and a translation that frees them.")
        .def_prop_ro("lower", [](const CompoundDepth &self) { return self.answer.lower; },
                     "No translation frees that is shorter: the depth of the deepest two pieces; 0 of bodies that do not overlap.")
        .def_prop_ro("upper", [](const CompoundDepth &self) { return self.answer.upper; }, "The translation is no longer than this.")
        .def_prop_ro("translation", [](const CompoundDepth &self) { return make_array(self.answer.translation, 3); },
                     VECTOR_SIG("translation"), "Added to the pose of body 1 it leaves no two pieces that overlap, shape (3,).")
        .def_ro("deepest", &CompoundDepth::deepest, "The signed distance of the deepest two pieces.")
        .def("__repr__", [](const CompoundDepth &self) {
            return nb::str("CompoundDepth(lower={}, upper={})").format(self.answer.lower, self.answer.upper);
        });

    nb::class_<CompoundCast, Cast>(m, "CompoundCast", "When two moving compounds first meet; contact is about the two pieces.")
        .def_ro("piece1", &CompoundCast::piece1, nb::sig("def piece1(self) -> int | None"), "The piece of body 1; None if they are free.")
        .def_ro("piece2", &CompoundCast::piece2, nb::sig("def piece2(self) -> int | None"), "The piece of body 2; None if they are free.");

    nb::class_<CompoundPair>(m, "CompoundPair",
                             "Two compounds, and what is remembered from query to query. Calls from several threads take turns.")
        .def("__init__", [](CompoundPair *self, nb::handle a, nb::handle b) {
            new (self) CompoundPair{read_compound(a, "compound1"), read_compound(b, "compound2")};
        }, nb::arg("compound1"), nb::arg("compound2"),
             nb::sig("def __init__(self, compound1: Compound | Shape, compound2: Compound | Shape) -> None"))
        .def("intersects", &intersects, nb::arg("pose1"), nb::arg("pose2"),
             nb::sig("def intersects(self, " TWO_POSES ") -> bool"), "Whether they have a common point; touching counts.")
        .def("distance", &distance, nb::arg("pose1"), nb::arg("pose2"), nb::arg("max_distance") = infinity,
             nb::sig("def distance(self, " TWO_POSES ", max_distance: float = ...) -> CompoundDistance"),
             "The least distance of two pieces. Beyond max_distance only that is said, sooner.")
        .def("signed", &signed_distance, nb::arg("pose1"), nb::arg("pose2"), nb::arg("max_distance") = infinity,
             nb::sig("def signed(self, " TWO_POSES ", max_distance: float = ...) -> CompoundSignedDistance"),
             "The distance, or minus the depth of the deepest two pieces: the translation that frees the bodies may be longer.")
        .def("depth", &depth, nb::arg("pose1"), nb::arg("pose2"), nb::kw_only(), nb::arg("relative_error") = 0.0,
             nb::sig("def depth(self, " TWO_POSES ", *, relative_error: float = 0.0) -> CompoundDepth"),
             "The least translation of body 1 that frees the bodies, as an interval, and one that is proved to free.\n\n"
             "relative_error: (upper - lower) / lower at which the search may stop.")
        .def("contacts", &contacts, nb::arg("pose1"), nb::arg("pose2"), nb::arg("max_distance") = 0.0, nb::kw_only(),
             nb::arg("reduce") = false,
             nb::sig("def contacts(self, " TWO_POSES ", max_distance: float = 0.0, *, reduce: bool = False) -> "
                     "tuple[" RECORDS ", " RECORDS "]"),
             "The contacts of pieces at most max_distance apart, and the points of all: dtype('compound contact'), dtype('point').\n\n"
             "The points of a contact begin at its first_point; there are point_count. reduce: four points each at most.")
        .def("cast", &cast, nb::arg("motion1"), nb::arg("motion2"), nb::arg("max_distance") = 0.0, nb::kw_only(),
             nb::arg("time_begin") = 0.0, nb::arg("time_end") = 1.0, nb::arg("time_tolerance") = 1e-9,
             nb::sig("def cast(self, motion1: Motion | " POSE ", motion2: Motion | " POSE ", max_distance: float = 0.0, *, "
                     "time_begin: float = 0.0, time_end: float = 1.0, time_tolerance: float = 1e-9) -> CompoundCast"),
             "Whether two moving compounds stay farther apart than max_distance, or when they first do not.")
        .def("verify", &verify, nb::arg("pose1"), nb::arg("pose2"), nb::arg("answer"),
             nb::sig("def verify(self, pose1: Motion | " POSE ", pose2: Motion | " POSE ", "
                     "answer: CompoundDistance | CompoundDepth | CompoundCast) -> None"),
             "Proves an answer anew, without the search that found it; raises Unverified if it is wrong.\n\n"
             "Of a CompoundCast the two arguments are its motions.");
}
