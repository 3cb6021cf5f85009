#include "shape.hpp"

#include <mutex>

#include <nanobind/stl/string.h>

namespace
{

struct Scene {
    swiftprox_scene *scene = nullptr;
    swiftprox_scratch *scratch = nullptr;
    /// Calls from several threads take turns.
    std::mutex lock{};
    ~Scene()
    {
        swiftprox_scratch_destroy(scratch);
        SWIFTPROX_IGNORE(swiftprox_scene_destroy(scene));
    }
};

struct Ground {
    const swiftprox_ground *ground = nullptr;
    size_t triangle_count = 0;
    ~Ground() { swiftprox_ground_release(ground); }
};

std::vector<swiftprox_object_id> read_ids(nb::handle ids, const char *name)
{
    std::vector<size_t> shape;
    std::vector<swiftprox_object_id> read;
    for (const uint64_t bits : read_integers(ids, name, shape)) {
        read.push_back({bits});
    }
    return read;
}

uint64_t add(Scene &scene, nb::handle pieces, nb::handle pose, bool fixed, uint64_t user_data, uint32_t groups, uint32_t mask)
{
    // Shares of their own: an iterator may make each shape as it comes.
    std::vector<Shape> held;
    std::vector<const swiftprox_shape *> shapes;
    const auto hold = [&](nb::handle piece) {
        held.push_back(nb::cast<const Shape &>(piece));
        shapes.push_back(held.back().get());
    };
    swiftprox_object_options options = SWIFTPROX_OBJECT_OPTIONS_DEFAULT;
    if (nb::isinstance<Ground>(pieces)) {
        options.ground = nb::cast<const Ground &>(pieces).ground;
    } else if (nb::isinstance<Compound>(pieces)) {
        options.compound = nb::cast<const Compound &>(pieces).get();
    } else if (nb::isinstance<Shape>(pieces)) {
        hold(pieces);
    } else {
        for (nb::handle piece : pieces) {
            hold(piece);
        }
    }
    if (!pose.is_none()) {
        std::memcpy(options.pose, read_pose(pose, "pose").m, sizeof options.pose);
    }
    options.fixed = fixed;
    options.user_data = user_data;
    options.groups = groups;
    options.mask = mask;
    swiftprox_object_id id{};
    run_alone(scene, [&] { return swiftprox_scene_add_object(scene.scene, shapes.data(), shapes.size(), &options, &id); });
    return id.bits;
}

void set_poses(Scene &scene, nb::handle poses, nb::handle ids)
{
    const Poses read(poses, "poses");
    std::vector<swiftprox_object_id> named;
    if (!ids.is_none()) {
        named = read_ids(ids, "ids");
        if (named.size() != read.count()) {
            refuse("there are " + std::to_string(named.size()) + " ids and " + std::to_string(read.count()) + " poses");
        }
    }
    run_alone(scene, [&] {
        return swiftprox_scene_set_poses(scene.scene, ids.is_none() ? nullptr : named.data(), read.data(), read.count());
    });
}

/** Those of SWIFTPROX_PIECE_PAIRS. */
swiftprox_piece_pairs read_piece_pairs(const std::string &name)
{
    if (name != "every" && name != "first" && name != "nearest") {
        refuse("piece_pairs is '" + name + "'; there are every, first and nearest");
    }
    return name == "every"   ? SWIFTPROX_PIECE_PAIRS_EVERY
           : name == "first" ? SWIFTPROX_PIECE_PAIRS_FIRST
                             : SWIFTPROX_PIECE_PAIRS_NEAREST;
}

nb::object within(Scene &scene, double max_distance, const std::string &piece_pairs)
{
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.max_distance = max_distance;
    query.piece_pairs = read_piece_pairs(piece_pairs);
    std::vector<swiftprox_pair_result> pairs;
    run_alone(scene, [&] {
        swiftprox_scene_answer answer;
        const swiftprox_status status = swiftprox_scene_query_distance(scene.scene, &query, &answer);
        pairs.assign(answer.pairs, answer.pairs + answer.count);
        return status;
    });
    return copy_records("pair", pairs.data(), pairs.size());
}

nb::tuple contacts(Scene &scene, double max_distance, bool reduce, const std::string &piece_pairs)
{
    swiftprox_scene_query query = SWIFTPROX_SCENE_QUERY_DEFAULT;
    query.max_distance = max_distance;
    query.detail = reduce ? SWIFTPROX_CONTACT_DETAIL_REDUCED_MANIFOLD : SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    query.piece_pairs = read_piece_pairs(piece_pairs);
    std::vector<SceneContact> all;
    std::vector<swiftprox_manifold_point> points;
    run_alone(scene, [&] {
        swiftprox_scene_answer answer;
        const swiftprox_status status = swiftprox_scene_query_contact(scene.scene, &query, &answer);
        if (status != SWIFTPROX_OK) {
            return status;
        }
        points.assign(answer.points, answer.points + answer.point_count);
        for (size_t k = 0; k < answer.contact_count; ++k) {
            const swiftprox_pair_result &pair = answer.pairs[k];
            all.push_back({pair.object1.bits, pair.object2.bits, pair.user_data1, pair.user_data2, pair.piece1, pair.piece2,
                           answer.contacts[k].manifold, answer.contacts[k].first_point});
        }
        return status;
    });
    return nb::make_tuple(copy_records("contact", all.data(), all.size()), copy_records("point", points.data(), points.size()));
}

/// A set of objects, with its poses for this query or without.
struct Set {
    std::vector<swiftprox_object_id> ids;
    std::unique_ptr<Poses> poses;
    size_t states = 1;
    bool many = false;
    Set(nb::handle source, nb::handle given, const char *name) : ids(read_ids(source, name))
    {
        if (given.is_none()) {
            return;
        }
        poses = std::make_unique<Poses>(given, "poses");
        const std::vector<size_t> &axes = poses->axes();
        many = axes.size() == 2;
        if (axes.empty() || axes.size() > 2 || axes.back() != ids.size()) {
            refuse("poses must have the shape (n, 3, 4) or (states, n, 3, 4), where n is the number of ids, " + std::to_string(ids.size()));
        }
        states = many ? axes[0] : 1;
    }
    swiftprox_object_set at(size_t state, bool among) const
    {
        return {ids.data(), ids.size(), poses ? poses->data() + 12 * ids.size() * state : nullptr, among};
    }
};

nb::object least_distance(Scene &scene, nb::handle ids, nb::handle against, nb::handle poses, double max_distance, bool among)
{
    const Set set(ids, poses, "ids");
    std::vector<swiftprox_object_id> others;
    if (!against.is_none()) {
        others = read_ids(against, "against");
    }
    const swiftprox_object_set other = {others.data(), others.size(), nullptr, 0};
    const Records records = make_records("least distance", set.states);
    auto *answers = static_cast<swiftprox_least_distance *>(records.data);
    run_alone(scene, [&] {
        for (size_t state = 0; state < set.states; ++state) {
            const swiftprox_object_set asked = set.at(state, among);
            const swiftprox_status status = swiftprox_scene_least_distance(
                scene.scene, &asked, against.is_none() ? nullptr : &other, max_distance, scene.scratch, answers + state);
            if (status != SWIFTPROX_OK) {
                return status;
            }
        }
        return SWIFTPROX_OK;
    });
    return set.many ? records.array : nb::object(records.array[0]);
}

struct FirstHit {
    swiftprox_first_hit answer{};
    bool hits = false;
};

FirstHit first_hit(Scene &scene, nb::handle ids, nb::handle poses, double max_distance, bool in_order, bool among)
{
    const Set set(ids, poses, "ids");
    if (!set.many) {
        refuse("poses must have the shape (times, n, 3, 4)");
    }
    const swiftprox_object_set asked = {set.ids.data(), set.ids.size(), nullptr, among};
    const swiftprox_pose_order order = in_order ? SWIFTPROX_POSE_ORDER_IN_ORDER : SWIFTPROX_POSE_ORDER_BISECTION;
    const swiftprox_path path = {set.poses->data(), set.states, order};
    FirstHit hit;
    run_alone(scene, [&] {
        return swiftprox_scene_first_hit(scene.scene, &asked, path, max_distance, scene.scratch, &hit.answer);
    });
    hit.hits = hit.answer.time < set.states;
    return hit;
}

nb::object ray(Scene &scene, nb::handle origin, nb::handle direction, double t_max, const std::string &hits, uint32_t mask)
{
    const auto o = read_vector(origin, "origin"), d = read_vector(direction, "direction");
    const swiftprox_ray asked = {{o[0], o[1], o[2]}, {d[0], d[1], d[2]}, t_max};
    if (hits != "first" && hits != "all" && hits != "any") {
        refuse("hits is '" + hits + "'; there are first, all and any");
    }
    const auto kind = hits == "first" ? SWIFTPROX_RAY_HITS_FIRST : hits == "all" ? SWIFTPROX_RAY_HITS_ALL : SWIFTPROX_RAY_HITS_ANY;
    std::vector<swiftprox_scene_ray_hit> found;
    run_alone(scene, [&] {
        swiftprox_scene_ray_answer answer;
        const swiftprox_status status = swiftprox_scene_cast_ray(scene.scene, &asked, kind, mask, scene.scratch, &answer);
        found.assign(answer.hits, answer.hits + answer.count);
        return status;
    });
    return copy_records("ray hit", found.data(), found.size());
}

swiftprox_scene_cast_answer cast(Scene &scene, nb::handle ids, nb::handle motions, double max_distance, bool among, double time_begin,
                                 double time_end, double time_tolerance)
{
    const Set set(ids, nb::none(), "ids");
    std::vector<swiftprox_motion> moving;
    if (nb::isinstance<swiftprox_motion>(motions)) {
        moving.push_back(read_motion(motions, "motions"));
    } else {
        for (nb::handle motion : motions) {
            moving.push_back(read_motion(motion, "motions"));
        }
    }
    const swiftprox_cast_config config = cast_config(max_distance, time_begin, time_end, time_tolerance);
    const swiftprox_object_set asked = set.at(0, among);
    swiftprox_scene_cast_answer answer;
    run_alone(scene, [&] {
        return swiftprox_scene_cast(scene.scene, &asked, swiftprox_motions{moving.data(), moving.size(), 1}, &config,
                                    scene.scratch, &answer);
    });
    return answer;
}

void make_ground(Ground *self, nb::handle vertices, nb::handle triangles)
{
    const Doubles points(vertices, "vertices");
    std::vector<size_t> shape;
    const std::vector<uint64_t> read = read_integers(triangles, "triangles", shape);
    if (points.ndim() != 2 || points.dim(1) != 3 || shape.size() != 2 || shape[1] != 3) {
        refuse("vertices has the shape " + text(points.shape()) + ", triangles " + text(shape) + "; (n, 3) and (m, 3) are wanted");
    }
    std::vector<uint32_t> corners;
    for (const uint64_t corner : read) {
        corners.push_back(corner > UINT32_MAX ? UINT32_MAX : uint32_t(corner));
    }
    const swiftprox_ground *made = nullptr;
    run([&] { return swiftprox_ground_create_from_triangles(points.data(), points.dim(0), corners.data(), shape[0], &made); });
    new (self) Ground{made, shape[0]};
}

nb::object ground_triangles(const Ground &ground)
{
    std::vector<double> points(9 * ground.triangle_count);
    run([&] { return swiftprox_ground_copy_triangles(ground.ground, 0, ground.triangle_count, points.data(), nullptr); });
    return make_array(points.data(), ground.triangle_count, 9).attr("reshape")(-1, 3, 3);
}

swiftprox_pair_answer ground_distance(const Ground &ground, const Shape &shape, nb::handle pose, double max_distance)
{
    const Pose a = read_pose(pose, "pose"), still;
    swiftprox_pair_config config = SWIFTPROX_PAIR_CONFIG_DEFAULT;
    config.max_distance = max_distance;
    swiftprox_ground_distance answer;
    run([&] {
        return swiftprox_pair_ground_distance(SWIFTPROX_QUERY_KIND_DISTANCE, swiftprox_placed{shape.get(), a.m},
                                              swiftprox_placed_ground{ground.ground, still.m}, &config, &answer);
    });
    return answer.answer;
}

RayHit ground_ray(const Ground &ground, nb::handle origin, nb::handle direction, double t_max)
{
    const auto o = read_vector(origin, "origin"), d = read_vector(direction, "direction");
    const swiftprox_ray asked = {{o[0], o[1], o[2]}, {d[0], d[1], d[2]}, t_max};
    const Pose still;
    swiftprox_ground_ray_answer answer;
    run([&] { return swiftprox_ground_cast_ray({ground.ground, still.m}, &asked, &answer); });
    return {answer.answer, number_below(answer.triangle, ground.triangle_count)};
}

struct GroundCast : Cast {
    nb::object triangle;
};

GroundCast ground_cast(const Ground &ground, const Shape &shape, nb::handle motion, double max_distance, double time_begin,
                       double time_end, double time_tolerance)
{
    const swiftprox_motion moves = read_motion(motion, "motion");
    const Pose still;
    const swiftprox_cast_config config = cast_config(max_distance, time_begin, time_end, time_tolerance);
    swiftprox_ground_cast_answer answer;
    run([&] { return swiftprox_pair_ground_cast({shape.get(), &moves}, {ground.ground, still.m}, &config, &answer); });
    return {{answer.answer, config}, number_below(answer.triangle, ground.triangle_count)};
}

nb::tuple ground_contacts(const Ground &ground, const Shape &shape, nb::handle pose, double max_distance, bool reduce)
{
    const Pose a = read_pose(pose, "pose"), still;
    swiftprox_manifold_config config = SWIFTPROX_MANIFOLD_CONFIG_DEFAULT;
    config.max_distance = max_distance;
    config.reduces = reduce;
    std::vector<swiftprox_ground_contact> all(16);
    std::vector<swiftprox_manifold_point> points(64);
    swiftprox_ground_count count{};
    run([&] {
        for (;;) {
            const swiftprox_status status =
                swiftprox_pair_ground_contacts(swiftprox_placed{shape.get(), a.m},
                                               swiftprox_placed_ground{ground.ground, still.m}, &config,
                                               swiftprox_ground_room{all.data(), all.size(), points.data(), points.size()},
                                               &count);
            const bool fits = count.contact_count <= all.size() && count.point_count <= points.size();
            all.resize(fits ? count.contact_count : count.contact_count + 1);
            points.resize(fits ? count.point_count : count.point_count + 1);
            if (status != SWIFTPROX_OK || fits) {
                return status;
            }
        }
    });
    return nb::make_tuple(copy_records("ground contact", all.data(), all.size()), copy_records("point", points.data(), points.size()));
}

} // namespace

#define ARRAY "numpy.typing.ArrayLike"
#define RECORDS "numpy.typing.NDArray[numpy.void]"

void bind_scene(nb::module_ &m)
{
    nb::class_<FirstHit>(m, "FirstHit", "At which of many times a set of objects meets something.")
        .def_prop_ro("time", [](const FirstHit &self) -> nb::object { return self.hits ? nb::int_(self.answer.time) : nb::object(nb::none()); },
                     nb::sig("def time(self) -> int | None"), "The number of the time; None if nothing hits.")
        .def_prop_ro("tried", [](const FirstHit &self) { return self.answer.tried; }, "How many times were tried.")
        .def_prop_ro("object1", [](const FirstHit &self) { return self.answer.pair.object1.bits; }, "The object of the set; 0 if none.")
        .def_prop_ro("object2", [](const FirstHit &self) { return self.answer.pair.object2.bits; }, "What it meets; 0 if nothing.");

    nb::class_<swiftprox_scene_cast_answer>(m, "SceneCast", "When moving objects of a scene first meet another one.")
        .def_prop_ro("outcome", [](const swiftprox_scene_cast_answer &self) {
            static const char *const words[] = {"none", "free", "hit", "near", "budget"};
            return words[self.outcome];
        }, "'free', 'hit', 'near' or 'budget', as of a Cast.")
        .def_ro("t_lower", &swiftprox_scene_cast_answer::time_lower, "Up to this time all pairs are apart.")
        .def_ro("t_upper", &swiftprox_scene_cast_answer::time_upper, "At this time a pair meets; NaN unless it is a hit.")
        .def_prop_ro("object1", [](const swiftprox_scene_cast_answer &self) { return self.pair.object1.bits; }, "The moving object; 0 if none.")
        .def_prop_ro("object2", [](const swiftprox_scene_cast_answer &self) { return self.pair.object2.bits; }, "What it meets; 0 if nothing.");

    nb::class_<Scene>(m, "Scene", "Objects with poses. Objects are named by numbers. Calls from several threads take turns.")
        .def("__init__", [](Scene *self, uint32_t threads) {
            swiftprox_scene_options options = SWIFTPROX_SCENE_OPTIONS_DEFAULT;
            options.worker_count = threads;
            swiftprox_scene *scene = nullptr;
            swiftprox_scratch *scratch = nullptr;
            run([&] { return swiftprox_scene_create(&options, &scene); });
            new (self) Scene{scene};
            run([&] { return swiftprox_scratch_create(&scratch); });
            self->scratch = scratch;
        }, nb::arg("threads") = 1, "An empty scene, whose queries share this many threads. Their number changes no bit.")
        .def("add", &add, nb::arg("pieces"), nb::arg("pose").none() = nb::none(), nb::kw_only(), nb::arg("fixed") = false,
             nb::arg("user_data") = 0, nb::arg("groups") = 1, nb::arg("mask") = UINT32_MAX,
             nb::sig("def add(self, pieces: Shape | collections.abc.Sequence[Shape] | Ground | Compound, pose: Pose | " ARRAY " | None = None, *, fixed: bool = False, "
                     "user_data: int = 0, groups: int = 1, mask: int = 0xffffffff) -> int"),
             "Adds an object of one or more convex pieces, a compound as one body, or a ground, which is fixed, and returns its\n"
             "number. Two fixed objects\n"
             "are never tested.")
        .def("remove", [](Scene &self, uint64_t id) {
            run_alone(self, [&] { return swiftprox_scene_remove_object(self.scene, {id}); });
        }, nb::arg("id"), "Removes an object.")
        .def("set_poses", &set_poses, nb::arg("poses"), nb::arg("ids").none() = nb::none(),
             nb::sig("def set_poses(self, poses: " ARRAY ", ids: " ARRAY " | None = None) -> None"),
             "Moves objects: poses of shape (n, 3, 4) or (n, 4, 4). Without ids: all that are not fixed, in order of creation.")
        .def("within", &within, nb::arg("max_distance") = infinity, nb::kw_only(), nb::arg("piece_pairs") = "every",
             nb::sig("def within(self, max_distance: float = ..., *, piece_pairs: typing.Literal['every', 'first', 'nearest'] = "
                     "'every') -> " RECORDS),
             "The pairs at most max_distance apart: a structured array of dtype('pair'), in order of creation.\n\n"
             "piece_pairs: for every two objects all pairs of pieces, the first, or the nearest.")
        .def("contacts", &contacts, nb::arg("max_distance") = 0.0, nb::kw_only(), nb::arg("reduce") = false,
             nb::arg("piece_pairs") = "every",
             nb::sig("def contacts(self, max_distance: float = 0.0, *, reduce: bool = False, "
                     "piece_pairs: typing.Literal['every', 'first', 'nearest'] = 'every') -> tuple[" RECORDS ", " RECORDS "]"),
             "The contacts of pairs at most max_distance apart, and the points of all of them: dtype('contact'), dtype('point').\n\n"
             "The points of a contact begin at its first_point; there are point_count. reduce: four points each at most.\n"
             "piece_pairs: as of within.")
        .def("least_distance", &least_distance, nb::arg("ids"), nb::kw_only(), nb::arg("against").none() = nb::none(),
             nb::arg("poses").none() = nb::none(), nb::arg("max_distance") = infinity, nb::arg("among") = false,
             nb::sig("def least_distance(self, ids: " ARRAY ", *, against: " ARRAY " | None = None, poses: " ARRAY " | None = None, "
                     "max_distance: float = ..., among: bool = False) -> typing.Any"),
             "The least distance of a set of n objects from others, or from those of `against`: a record of dtype('least distance').\n\n"
             "poses: where the set is for this query, shape (n, 3, 4); of shape (states, n, 3, 4) the answer is an array of records.\n"
             "among: pairs within the set count, too. Beyond max_distance upper is infinite.")
        .def("first_hit", &first_hit, nb::arg("ids"), nb::arg("poses"), nb::arg("max_distance") = 0.0, nb::kw_only(),
             nb::arg("in_order") = false, nb::arg("among") = false,
             nb::sig("def first_hit(self, ids: " ARRAY ", poses: " ARRAY ", max_distance: float = 0.0, *, in_order: bool = False, "
                     "among: bool = False) -> FirstHit"),
             "A time at which the set is at most max_distance from another object. poses: shape (times, n, 3, 4).\n\n"
             "in_order: the first such time; else any, found soonest.")
        .def("ray", &ray, nb::arg("origin"), nb::arg("direction"), nb::kw_only(), nb::arg("t_max") = infinity, nb::arg("hits") = "first",
             nb::arg("mask") = UINT32_MAX,
             nb::sig("def ray(self, origin: " ARRAY ", direction: " ARRAY ", *, t_max: float = ..., hits: str = 'first', "
                     "mask: int = 0xffffffff) -> " RECORDS),
             "What a ray meets: a structured array of dtype('ray hit'). Points are origin + t * direction, each of shape (3,).\n\n"
             "hits: 'first', 'all' in order, or 'any', found soonest.")
        .def("cast", &cast, nb::arg("ids"), nb::arg("motions"), nb::arg("max_distance") = 0.0, nb::kw_only(), nb::arg("among") = false,
             nb::arg("time_begin") = 0.0, nb::arg("time_end") = 1.0, nb::arg("time_tolerance") = 1e-9,
             nb::sig("def cast(self, ids: " ARRAY ", motions: Motion | collections.abc.Sequence[Motion], max_distance: float = 0.0, *, "
                     "among: bool = False, time_begin: float = 0.0, time_end: float = 1.0, time_tolerance: float = 1e-9) -> SceneCast"),
             "Whether moving objects stay farther than max_distance from all that rest. One motion moves the set as one body.");

    nb::class_<GroundCast, Cast>(m, "GroundCast", "When a moving body first meets a ground.")
        .def_ro("triangle", &GroundCast::triangle, nb::sig("def triangle(self) -> int | None"),
                "The triangle that it meets; None if it meets none.");

    nb::class_<Ground>(m, "Ground", "A fixed surface of triangles.")
        .def("__init__", &make_ground, nb::arg("vertices"), nb::arg("triangles"),
             nb::sig("def __init__(self, vertices: " ARRAY ", triangles: " ARRAY ") -> None"),
             "vertices: shape (n, 3). triangles: vertex numbers from 0, shape (m, 3), counter-clockwise seen from the front.")
        .def_prop_ro("triangles", &ground_triangles, nb::sig("def triangles(self) -> numpy.typing.NDArray[numpy.float64]"),
                     "Where the corners of each triangle are, shape (m, 3, 3).")
        .def("distance", &ground_distance, nb::arg("shape"), nb::arg("pose"), nb::arg("max_distance") = infinity,
             nb::sig("def distance(self, shape: Shape, pose: Pose | " ARRAY ", max_distance: float = ...) -> Distance"),
             "The distance of a shape at a pose from the surface. The shape is body 1.")
        .def("contacts", &ground_contacts, nb::arg("shape"), nb::arg("pose"), nb::arg("max_distance") = 0.0, nb::kw_only(),
             nb::arg("reduce") = false,
             nb::sig("def contacts(self, shape: Shape, pose: Pose | " ARRAY ", max_distance: float = 0.0, *, reduce: bool = False) -> "
                     "tuple[" RECORDS ", " RECORDS "]"),
             "The contacts of a shape and all their points: structured arrays of dtype('ground contact') and dtype('point').")
        .def("ray", &ground_ray, nb::arg("origin"), nb::arg("direction"), nb::kw_only(), nb::arg("t_max") = infinity,
             nb::sig("def ray(self, origin: " ARRAY ", direction: " ARRAY ", *, t_max: float = ...) -> RayHit"),
             "Where a ray first meets the surface, from either side. origin, direction: shape (3,).")
        .def("cast", &ground_cast, nb::arg("shape"), nb::arg("motion"), nb::arg("max_distance") = 0.0, nb::kw_only(),
             nb::arg("time_begin") = 0.0, nb::arg("time_end") = 1.0, nb::arg("time_tolerance") = 1e-9,
             nb::sig("def cast(self, shape: Shape, motion: Motion | Pose | " ARRAY ", max_distance: float = 0.0, *, "
                     "time_begin: float = 0.0, time_end: float = 1.0, time_tolerance: float = 1e-9) -> GroundCast"),
             "Whether a moving shape stays farther than max_distance from the surface, or when it first does not.");
}
