#include "shape.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <thread>

#include <nanobind/stl/string.h>

namespace
{

/// Poses of a batch that one cache serves. A number of its own, so that no bit depends on the number of threads.
const size_t CHUNK = 1024;

struct Pair {
    Shape shape1, shape2;
    swiftprox_pair_cache cache{};
    swiftprox_manifold_cache manifold_cache{};
    /// Calls from several threads take turns.
    std::mutex lock{};
};

struct Manifold {
    swiftprox_manifold manifold{};
    std::vector<swiftprox_manifold_point> points;
    double max_distance = 0;
    bool reduces = false;
};

swiftprox_pair_answer distance(Pair &pair, nb::handle pose1, nb::handle pose2, double max_distance)
{
    const Pose a = read_pose(pose1, "pose1"), b = read_pose(pose2, "pose2");
    const swiftprox_pair_config config = pair_config(max_distance);
    swiftprox_pair_answer answer;
    run_alone(pair, [&] {
        return swiftprox_pair_distance({pair.shape1.get(), a.m}, {pair.shape2.get(), b.m}, &pair.cache, &config, &answer);
    });
    return answer;
}

swiftprox_signed_distance signed_distance(Pair &pair, nb::handle pose1, nb::handle pose2, double max_distance)
{
    const Pose a = read_pose(pose1, "pose1"), b = read_pose(pose2, "pose2");
    const swiftprox_pair_config config = pair_config(max_distance);
    swiftprox_signed_distance answer;
    run_alone(pair, [&] {
        return swiftprox_pair_signed_distance({pair.shape1.get(), a.m}, {pair.shape2.get(), b.m}, &pair.manifold_cache, &config,
                                              &answer);
    });
    return answer;
}

/// Poses that go with `count` answers: as many, or one.
size_t count_of(const Poses &poses, const char *name)
{
    if (poses.axes().size() > 1) {
        refuse(std::string(name) + " has too many axes: (n, 3, 4) or (n, 4, 4) is wanted");
    }
    return poses.count();
}

nb::object distances(Pair &pair, nb::handle poses1, nb::handle poses2, double max_distance, int threads)
{
    const Poses a(poses1, "poses1"), b(poses2, "poses2");
    const size_t count1 = count_of(a, "poses1"), count2 = count_of(b, "poses2");
    const bool is_single1 = a.axes().empty(), is_single2 = b.axes().empty();
    if (!is_single1 && !is_single2 && count1 != count2) {
        refuse("poses1 has " + std::to_string(count1) + " poses, poses2 " + std::to_string(count2));
    }
    if (threads < 1) {
        refuse("threads must be 1 or more");
    }
    const size_t count = is_single1 ? count2 : count1;
    const swiftprox_pair_config config = pair_config(max_distance);
    const Records records = make_records("distance", count);
    auto *answers = static_cast<swiftprox_pair_answer *>(records.data);
    if (count == 0) {
        return records.array;
    }
    const size_t chunk_count = (count + CHUNK - 1) / CHUNK;
    swiftprox_status status = SWIFTPROX_OK;
    std::string message;
    {
        nb::gil_scoped_release released;
        const std::lock_guard<std::mutex> alone(pair.lock);
        const swiftprox_pair_cache begin = pair.cache;
        std::atomic<size_t> next{0};
        std::mutex first_lock;
        size_t first_failed = chunk_count;
        const auto work = [&] {
            for (size_t chunk = next++; chunk < chunk_count; chunk = next++) {
                const size_t first = chunk * CHUNK, room = count - first < CHUNK ? count - first : CHUNK;
                swiftprox_pair_cache cache = begin;
                const swiftprox_poses object1 = {pair.shape1.get(), a.data() + (is_single1 ? 0 : 12 * first), is_single1 ? 1 : room};
                const swiftprox_poses object2 = {pair.shape2.get(), b.data() + (is_single2 ? 0 : 12 * first), is_single2 ? 1 : room};
                const swiftprox_status said = swiftprox_pair_distances(object1, object2, &cache, &config, answers + first);
                if (chunk + 1 == chunk_count) {
                    pair.cache = cache;
                }
                if (said != SWIFTPROX_OK) {
                    const std::lock_guard<std::mutex> one(first_lock);
                    if (chunk < first_failed) {
                        first_failed = chunk;
                        status = said;
                        message = swiftprox_library_last_error_message();
                        if (first) {
                            message += " (poses count from " + std::to_string(first) + ")";
                        }
                    }
                }
            }
        };
        std::vector<std::thread> helpers;
        const size_t wanted = size_t(threads) < chunk_count ? size_t(threads) : chunk_count;
        try {
            for (size_t k = 1; k < wanted; ++k) {
                helpers.emplace_back(work);
            }
        } catch (const std::system_error &) {
            // Threads that cannot start are done without.
        }
        work();
        for (std::thread &helper : helpers) {
            helper.join();
        }
    }
    if (status != SWIFTPROX_OK) {
        fail(status, message);
    }
    return records.array;
}

Manifold manifold(Pair &pair, nb::handle pose1, nb::handle pose2, double max_distance, bool reduce)
{
    const Pose a = read_pose(pose1, "pose1"), b = read_pose(pose2, "pose2");
    const swiftprox_manifold_config config = manifold_config(max_distance, reduce);
    Manifold made;
    made.max_distance = max_distance;
    made.reduces = reduce;
    made.points.resize(16);
    run_alone(pair, [&] {
        for (;;) {
            const swiftprox_manifold_cache before = pair.manifold_cache;
            const swiftprox_manifold_room room = {made.points.data(), made.points.size(), nullptr};
            const swiftprox_status status = swiftprox_pair_manifold({pair.shape1.get(), a.m}, {pair.shape2.get(), b.m},
                                                                    &pair.manifold_cache, &config, room, &made.manifold);
            if (status != SWIFTPROX_OK || made.manifold.found_count <= made.points.size()) {
                return status;
            }
            made.points.resize(made.manifold.found_count);
            pair.manifold_cache = before;
        }
    });
    made.points.resize(made.manifold.point_count);
    return made;
}

Cast cast(Pair &pair, nb::handle motion1, nb::handle motion2, double max_distance, double time_begin, double time_end,
          double time_tolerance, bool ignores_parting)
{
    const swiftprox_motion a = read_motion(motion1, "motion1"), b = read_motion(motion2, "motion2");
    Cast made;
    made.config = cast_config(max_distance, time_begin, time_end, time_tolerance);
    made.config.ignores_parting = ignores_parting;
    run_alone(pair, [&] {
        return swiftprox_pair_cast(swiftprox_moving{pair.shape1.get(), &a}, swiftprox_moving{pair.shape2.get(), &b}, &pair.cache,
                                   &made.config, &made.answer);
    });
    return made;
}

void verify(Pair &pair, nb::handle first, nb::handle second, nb::handle answer)
{
    Cast *cast;
    if (nb::try_cast(answer, cast, false) && cast) {
        const swiftprox_motion a = read_motion(first, "pose1"), b = read_motion(second, "pose2");
        run([&] { return swiftprox_pair_cast_verify(swiftprox_moving{pair.shape1.get(), &a},
                                                    swiftprox_moving{pair.shape2.get(), &b}, &cast->config, &cast->answer); });
        return;
    }
    const Pose a = read_pose(first, "pose1"), b = read_pose(second, "pose2");
    const swiftprox_placed object1 = {pair.shape1.get(), a.m}, object2 = {pair.shape2.get(), b.m};
    swiftprox_pair_answer *distance;
    if (nb::try_cast(answer, distance, false) && distance) {
        run([&] { return swiftprox_pair_verify(object1, object2, distance); });
        return;
    }
    Manifold *manifold;
    if (nb::try_cast(answer, manifold, false) && manifold) {
        const swiftprox_manifold_config config = manifold_config(manifold->max_distance, manifold->reduces);
        run_alone(pair, [&] {
            return swiftprox_pair_manifold_verify(object1, object2, &pair.manifold_cache, &config, manifold->points.data(),
                                                  &manifold->manifold);
        });
        return;
    }
    refuse("answer must be a Distance, a Manifold or a Cast");
}

swiftprox_gradient gradient(Pair &pair, nb::handle pose1, nb::handle pose2, nb::handle answer, nb::handle reference1,
                            nb::handle reference2)
{
    const Pose a = read_pose(pose1, "pose1"), b = read_pose(pose2, "pose2");
    std::array<double, 3> about[2];
    const double *references[2] = {nullptr, nullptr};
    if (!reference1.is_none()) {
        about[0] = read_vector(reference1, "reference1");
        references[0] = about[0].data();
    }
    if (!reference2.is_none()) {
        about[1] = read_vector(reference2, "reference2");
        references[1] = about[1].data();
    }
    swiftprox_signed_distance said{}, *own;
    swiftprox_pair_answer *distance;
    if (nb::try_cast(answer, own, false) && own) {
        said = *own;
    } else if (nb::try_cast(answer, distance, false) && distance) {
        said.outcome = distance->outcome;
        said.lower = distance->lower;
        said.upper = distance->upper;
        std::copy_n(distance->normal, 3, said.normal);
        std::copy_n(distance->world1, 3, said.world1);
        std::copy_n(distance->world2, 3, said.world2);
    } else {
        refuse("answer must be a SignedDistance or a Distance");
    }
    swiftprox_gradient made;
    run([&] {
        return swiftprox_pair_gradient({pair.shape1.get(), a.m}, {pair.shape2.get(), b.m}, &said, references[0], references[1], &made);
    });
    return made;
}

/// What distances and signed distances have alike.
template <class T> nb::class_<T> bind_answer(nb::module_ &m, const char *name, const char *text)
{
    const auto vector = [](const char *member) {
        return nb::sig((new std::string("def " + std::string(member) + "(self) -> numpy.typing.NDArray[numpy.float64]"))->c_str());
    };
    nb::class_<T> answer(m, name, text);
    answer.def_prop_ro("outcome", [](const T &self) { return outcome_of(self.outcome); }, "Whether the bodies are apart.")
        .def_ro("distance", &T::distance, "The best estimate, a length.")
        .def_ro("lower", &T::lower, "The true value is at least this.")
        .def_ro("upper", &T::upper, "The true value is at most this; infinite beyond max_distance.")
        .def_prop_ro("local1", [](const T &self) { return make_array(self.local1, 3); }, vector("local1"),
                     "The nearest point of body 1 in its own frame, shape (3,). NaN where none is said.")
        .def_prop_ro("local2", [](const T &self) { return make_array(self.local2, 3); }, vector("local2"),
                     "The nearest point of body 2 in its own frame, shape (3,).")
        .def_prop_ro("world1", [](const T &self) { return make_array(self.world1, 3); }, vector("world1"),
                     "The nearest point of body 1 in the world, shape (3,).")
        .def_prop_ro("world2", [](const T &self) { return make_array(self.world2, 3); }, vector("world2"),
                     "The nearest point of body 2 in the world, shape (3,).")
        .def_prop_ro("normal", [](const T &self) { return make_array(self.normal, 3); }, vector("normal"),
                     "The unit normal in the world, from body 2 to body 1, shape (3,).")
        .def_prop_ro("feature1", [](const T &self) { return feature_of(self.feature1); },
                     nb::sig("def feature1(self) -> tuple[str, *tuple[int, ...]]"),
                     "What of body 1 holds its point: ('vertex', i), ('edge', i, j), ('face', i) or ('none',).")
        .def_prop_ro("feature2", [](const T &self) { return feature_of(self.feature2); },
                     nb::sig("def feature2(self) -> tuple[str, *tuple[int, ...]]"), "The same of body 2.")
        .def("__repr__", [name = std::string(name)](const T &self) {
            return nb::str("{}({}, distance={}, lower={}, upper={})").format(name, word(self.outcome), self.distance, self.lower, self.upper);
        });
    return answer;
}

} // namespace

nb::tuple feature_of(const swiftprox_feature &feature)
{
    static const char *const kinds[] = {"none", "vertex", "edge", "face"};
    const char *kind = feature.kind >= 0 && feature.kind <= 3 ? kinds[feature.kind] : "none";
    return feature.kind == SWIFTPROX_FEATURE_KIND_EDGE ? nb::make_tuple(kind, feature.ids[0], feature.ids[1])
           : feature.kind == SWIFTPROX_FEATURE_KIND_NONE ? nb::make_tuple(kind)
                                                         : nb::make_tuple(kind, feature.ids[0]);
}

const char *word(swiftprox_outcome outcome)
{
    static const char *const words[] = {"none", "separated", "beyond", "intersecting", "undecided"};
    return outcome >= 0 && outcome <= 4 ? words[outcome] : "?";
}

const char *word(swiftprox_cast_outcome outcome)
{
    static const char *const words[] = {"none", "free", "hit", "near", "budget"};
    return outcome >= 0 && outcome <= 4 ? words[outcome] : "?";
}

void bind_pair(nb::module_ &m)
{
    nb::enum_<swiftprox_outcome>(m, "Outcome", nb::is_arithmetic(), "How a query about two bodies came out.")
        .value("NONE", SWIFTPROX_OUTCOME_NONE, "Nothing is said.")
        .value("SEPARATED", SWIFTPROX_OUTCOME_SEPARATED, "They have no common point.")
        .value("BEYOND", SWIFTPROX_OUTCOME_BEYOND, "They are farther apart than max_distance.")
        .value("INTERSECTING", SWIFTPROX_OUTCOME_INTERSECTING, "They have a common point; touching counts.")
        .value("UNDECIDED", SWIFTPROX_OUTCOME_UNDECIDED, "A step budget ran out, or a deviation hides it.");

    bind_answer<swiftprox_pair_answer>(m, "Distance", "The distance of two bodies: 0 where they intersect.");
    bind_answer<swiftprox_signed_distance>(m, "SignedDistance", "The distance of two bodies, or minus their depth in each other.");

    nb::class_<swiftprox_gradient>(m, "Gradient", "How a signed distance changes as both bodies move.")
        .def_prop_ro("body1", [](const swiftprox_gradient &self) { return make_array(self.object1, 6); },
                     nb::sig("def body1(self) -> numpy.typing.NDArray[numpy.float64]"),
                     "By the linear and the angular velocity of body 1, world axes, shape (6,).")
        .def_prop_ro("body2", [](const swiftprox_gradient &self) { return make_array(self.object2, 6); },
                     nb::sig("def body2(self) -> numpy.typing.NDArray[numpy.float64]"), "The same of body 2.")
        .def_prop_ro("is_unique", [](const swiftprox_gradient &self) { return self.is_unique != 0; },
                     "False where faces or edges are parallel: there the distance has no derivative.")
        .def("__repr__", [](const swiftprox_gradient &self) {
            return nb::str("Gradient(is_unique={})").format(self.is_unique != 0);
        });

    nb::class_<Manifold>(m, "Manifold", "Where two bodies meet, or nearly do.")
        .def_prop_ro("outcome", [](const Manifold &self) { return outcome_of(self.manifold.outcome); }, "Whether the bodies are apart.")
        .def_prop_ro("lower", [](const Manifold &self) { return self.manifold.lower; }, "The signed distance is at least this.")
        .def_prop_ro("upper", [](const Manifold &self) { return self.manifold.upper; }, "The signed distance is at most this.")
        .def_prop_ro("normal", [](const Manifold &self) { return make_array(self.manifold.normal, 3); },
                     nb::sig("def normal(self) -> numpy.typing.NDArray[numpy.float64]"),
                     "The unit normal in the world, from body 2 to body 1, shape (3,).")
        .def_prop_ro("points", [](const Manifold &self) { return copy_records("point", self.points.data(), self.points.size()); },
                     nb::sig("def points(self) -> numpy.typing.NDArray[numpy.void]"),
                     "A structured array of dtype('point'): points on both bodies, and the interval of their gap.")
        .def("__repr__", [](const Manifold &self) {
            return nb::str("Manifold({}, {} points, lower={}, upper={})")
                .format(word(self.manifold.outcome), self.points.size(), self.manifold.lower, self.manifold.upper);
        });

    nb::class_<Cast>(m, "Cast", "When two moving bodies first meet.")
        .def_prop_ro("outcome", [](const Cast &self) { return word(self.answer.outcome); },
                     "'free': apart at every time. 'hit'. 'near': they graze, as far as doubles tell. 'budget': steps ran out.")
        .def_prop_ro("t_lower", [](const Cast &self) { return self.answer.time_lower; }, "Up to this time the bodies are apart.")
        .def_prop_ro("t_parted", [](const Cast &self) { return self.answer.time_parted; },
                     "From here on they are cast, of a parting that is ignored; else NaN.")
        .def_prop_ro("t_upper", [](const Cast &self) { return self.answer.time_upper; }, "At this time they meet; NaN unless it is a hit.")
        .def_prop_ro("clearance", [](const Cast &self) { return self.answer.clearance; },
                     "Of free bodies: their distance is at least this at every time.")
        .def_prop_ro("contact", [](const Cast &self) { return self.answer.contact; },
                     "Of a hit and of a near miss the distance at t_lower, or the contact in which the motion begins.")
        .def("__repr__", [](const Cast &self) {
            return nb::str("Cast({}, t_lower={}, t_upper={})").format(word(self.answer.outcome), self.answer.time_lower, self.answer.time_upper);
        });

#define TWO_POSES "pose1: Pose | numpy.typing.ArrayLike, pose2: Pose | numpy.typing.ArrayLike"
    nb::class_<Pair>(m, "Pair", "Two shapes, and what is remembered from query to query. Calls from several threads take turns.")
        .def("__init__", [](Pair *self, const Shape &a, const Shape &b) { new (self) Pair{a, b}; }, nb::arg("shape1"), nb::arg("shape2"))
        .def("distance", &distance, nb::arg("pose1"), nb::arg("pose2"), nb::arg("max_distance") = infinity,
             nb::sig("def distance(self, " TWO_POSES ", max_distance: float = ...) -> Distance"),
             "The distance at two poses. Beyond max_distance only that is said, sooner.")
        .def("signed", &signed_distance, nb::arg("pose1"), nb::arg("pose2"), nb::arg("max_distance") = infinity,
             nb::sig("def signed(self, " TWO_POSES ", max_distance: float = ...) -> SignedDistance"),
             "The distance, or minus the penetration depth where the bodies overlap.")
        .def("distances", &distances, nb::arg("poses1"), nb::arg("poses2"), nb::kw_only(), nb::arg("max_distance") = infinity,
             nb::arg("threads") = 1,
             nb::sig("def distances(self, poses1: Pose | numpy.typing.ArrayLike, poses2: Pose | numpy.typing.ArrayLike, *, "
                     "max_distance: float = ..., threads: int = 1) -> numpy.typing.NDArray[numpy.void]"),
             "The distances at many poses: a structured array of dtype('distance'), shape (n,).\n\n"
             "Poses have the shape (n, 3, 4) or (n, 4, 4); one of both may be a single pose. Contiguous float64 arrays of shape\n"
             "(n, 3, 4) are not copied: leave them unchanged during the call. No bit depends on the number of threads.\n"
             "A refused pose is an InputError that names it.")
        .def("manifold", &manifold, nb::arg("pose1"), nb::arg("pose2"), nb::arg("max_distance") = 0.0, nb::kw_only(),
             nb::arg("reduce") = false,
             nb::sig("def manifold(self, " TWO_POSES ", max_distance: float = 0.0, *, reduce: bool = False) -> Manifold"),
             "The contact points of bodies at most max_distance apart. reduce: four points at most.")
        .def("cast", &cast, nb::arg("motion1"), nb::arg("motion2"), nb::arg("max_distance") = 0.0, nb::kw_only(),
             nb::arg("time_begin") = 0.0, nb::arg("time_end") = 1.0, nb::arg("time_tolerance") = 1e-9,
             nb::arg("ignores_parting") = false,
             nb::sig("def cast(self, motion1: Motion | Pose | numpy.typing.ArrayLike, motion2: Motion | Pose | "
                     "numpy.typing.ArrayLike, max_distance: float = 0.0, *, time_begin: float = 0.0, time_end: float = 1.0, "
                     "time_tolerance: float = 1e-9, ignores_parting: bool = False) -> Cast"),
             "Whether two moving bodies stay farther apart than max_distance, or when they first do not.\n\n"
             "ignores_parting: bodies that touch at time_begin and part soon are cast from t_parted on.")
        .def("gradient", &gradient, nb::arg("pose1"), nb::arg("pose2"), nb::arg("answer"), nb::arg("reference1") = nb::none(),
             nb::arg("reference2") = nb::none(),
             nb::sig("def gradient(self, " TWO_POSES ", answer: SignedDistance | Distance, "
                     "reference1: numpy.typing.ArrayLike | None = None, reference2: numpy.typing.ArrayLike | None = None) -> Gradient"),
             "How an answer of the same poses changes as the bodies move and turn about their reference points.\n\n"
             "Reference points have the shape (3,), in the world; None: the translation of the pose. The velocities are along the\n"
             "world's axes, the angular one in radians. No further search.")
        .def("verify", &verify, nb::arg("pose1"), nb::arg("pose2"), nb::arg("answer"),
             nb::sig("def verify(self, pose1: Motion | Pose | numpy.typing.ArrayLike, pose2: Motion | Pose | numpy.typing.ArrayLike, "
                     "answer: Distance | Manifold | Cast) -> None"),
             "Proves an answer anew, without the search that found it; raises Unverified if it is wrong.\n\n"
             "Of a Cast the two arguments are its motions.");
}
