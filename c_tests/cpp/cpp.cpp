/* The C++ interface over that of C: values, ranges, exceptions and their twins. With -fno-exceptions the twins alone. */
#include "swiftprox.hpp"

#include "check.h"

#include <cmath>
#include <cstddef>
#include <cstring>

using swiftprox::Placed;
using swiftprox::Pose;
using swiftprox::Shape;

/* Where the members of C's structs stand: what is between them has no value. */
struct Member {
    const char *type;
    std::size_t offset, size;
};
#define STRUCT(type, size, alignment)
#define MEMBER(type, member, offset, size) {#type, offsetof(type, member), sizeof(type::member)},
static const Member members[] = {
#include "abi/layout.h"
};

/* Defaults are those of C: each member but struct_size, which the compiler says. */
template <class C> static void check_defaults(const C &given, const C &expected, const char *type)
{
    std::size_t count = 0;
    for (const Member &member : members) {
        if (std::strcmp(member.type, type) == 0) {
            const char *ours = reinterpret_cast<const char *>(&expected) + member.offset;
            const char *theirs = reinterpret_cast<const char *>(&given) + member.offset;
            CHECK(std::memcmp(ours, theirs, member.size) == 0);
            ++count;
        }
    }
    CHECK(count > 1);
}
#define CHECK_DEFAULTS(config, type, constant)                                                                                 \
    do {                                                                                                                       \
        const type expected = constant;                                                                                        \
        check_defaults<type>(config, expected, #type);                                                                         \
    } while (false)

static void defaults()
{
    using namespace swiftprox;
    CHECK_DEFAULTS(PairConfig{}.to_c(), swiftprox_pair_config, SWIFTPROX_PAIR_CONFIG_DEFAULT);
    CHECK_DEFAULTS(DepthConfig{}.to_c(), swiftprox_depth_config, SWIFTPROX_DEPTH_CONFIG_DEFAULT);
    CHECK_DEFAULTS(ManifoldConfig{}.to_c(), swiftprox_manifold_config, SWIFTPROX_MANIFOLD_CONFIG_DEFAULT);
    CHECK_DEFAULTS(SceneOptions{}.to_c(), swiftprox_scene_options, SWIFTPROX_SCENE_OPTIONS_DEFAULT);
    CHECK_DEFAULTS(ObjectOptions{}.to_c(), swiftprox_object_options, SWIFTPROX_OBJECT_OPTIONS_DEFAULT);
    CHECK_DEFAULTS(SceneQuery{}.to_c(), swiftprox_scene_query, SWIFTPROX_SCENE_QUERY_DEFAULT);
    CHECK_DEFAULTS(CastConfig{}.to_c(), swiftprox_cast_config, SWIFTPROX_CAST_CONFIG_DEFAULT);
    CHECK_DEFAULTS(ClearanceConfig{}.to_c(), swiftprox_clearance_config, SWIFTPROX_CLEARANCE_CONFIG_DEFAULT);
    const Draw draw; // which the C struct points at
    swiftprox_draw drawing = draw.to_c();
    drawing.user = nullptr;
    CHECK_DEFAULTS(drawing, swiftprox_draw, SWIFTPROX_DRAW_DEFAULT);
    CHECK_DEFAULTS(ShapeTuning{}.to_c(), swiftprox_shape_tuning, SWIFTPROX_SHAPE_TUNING_DEFAULT);
    CHECK_DEFAULTS(PairTuning{}.to_c(), swiftprox_pair_tuning, SWIFTPROX_PAIR_TUNING_DEFAULT);
    swiftprox_shape_tuning tuning;
    const ShapeOptions options; // of which the C struct points into
    swiftprox_shape_options shape = options.to_c(tuning);
    shape.tuning = nullptr;
    shape.progress_user = nullptr;
    CHECK_DEFAULTS(shape, swiftprox_shape_options, SWIFTPROX_SHAPE_OPTIONS_DEFAULT);
}

/* A unit cube about the origin. */
static swiftprox::Result<Shape> cube()
{
    const std::array<double, 24> corners{-.5, -.5, -.5, .5, -.5, -.5, -.5, .5, -.5, .5, .5, -.5,
                                         -.5, -.5, .5,  .5, -.5, .5,  -.5, .5, .5,  .5, .5, .5};
    const std::vector<std::uint32_t> quads{0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    const std::array<std::uint32_t, 6> valences{4, 4, 4, 4, 4, 4};
    return Shape::try_from_mesh(corners, quads, valences);
}

/* A stand-in for Eigen's transforms: matrix() with entries (row, column). */
struct Transform {
    struct Matrix {
        float entries[4][4];
        float operator()(int row, int column) const { return entries[row][column]; }
    } inner;
    const Matrix &matrix() const { return inner; }
};

static void poses()
{
    const double h = std::sqrt(0.5);
    const Pose turned({0, -1, 0, 1, 0, 0, 0, 0, 1}, {1, 2, 3});
    // A quarter about z, of a quaternion three times as long as a unit one.
    const Pose quaternion = Pose::from_quaternion(3 * h, 0, 0, 3 * h, {1, 2, 3});
    const double columns[16] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1};
    const Pose column_major = Pose::from_column_major(columns);
    const Pose transform(Transform{{{{0, -1, 0, 1}, {1, 0, 0, 2}, {0, 0, 1, 3}, {0, 0, 0, 1}}}});
    for (std::size_t i = 0; i < 12; ++i) {
        CHECK(std::fabs(quaternion.rows()[i] - turned.rows()[i]) < 1e-15);
    }
    CHECK(column_major.rows() == turned.rows());
    CHECK(Pose::try_from_column_major(columns).value.rows() == turned.rows());
    CHECK(Pose::try_from_column_major(nullptr).status == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK(Pose::try_from_unit_quaternion({0, 0, 0, 1}, {1, 2, 3}).value.rows() == Pose::at(1, 2, 3).rows());
    CHECK(Pose::try_from_unit_quaternion({0, 0, 0, 3}).status == SWIFTPROX_ERROR_POSE);
    CHECK(transform.rows() == turned.rows());
    CHECK(Pose::from_quaternion(1e-200, 0, 0, 0).rows() == Pose().rows());
    CHECK(Pose::from_quaternion(1e200, 0, 0, 0).rows() == Pose().rows());
}

static void shapes()
{
    const auto made = cube();
    CHECK_OK(made.status);
    const Shape &box = made.value;
    const auto info = box.try_info();
    CHECK(info && info.value.vertex_count == 8 && info.value.face_count == 6 && info.value.triangle_count == 12);
    std::vector<std::uint32_t> labels;
    const auto vertices = box.try_vertices(&labels);
    CHECK(vertices && vertices.value.size() == 24 && labels.size() == 8);
    CHECK(box.try_triangles().value.size() == 36);
    CHECK(box.try_level_vertices(0).value.size() == 24);
    CHECK(box.try_level_triangles(0).value.size() == 36);
    CHECK(box.try_level_vertices(7).status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(box.try_tuning_info().value.level_count == 0);
    CHECK_OK(box.try_prepare().status);
    CHECK(Shape::try_box(1, 2, 3).value.try_info().value.volume == 48);
    CHECK(Shape::try_box(1, 2, 3, 0.5).value.try_info().value.swept_radius == 0.5);
    CHECK(Shape::try_sphere(2).value.try_info().value.swept_radius == 2);
    CHECK(Shape::try_capsule(1, 2).value.try_info().value.vertex_count == 2);
    CHECK(Shape::try_cylinder(1, 2).value.try_info().value.deviation <= 1e-4);
    CHECK(Shape::try_cone(1, 2, 0.01).value.try_info().value.deviation <= 0.01);
    CHECK(Shape::try_ellipsoid(1, 2, 3).value.try_info().value.deviation <= 3e-3);
    CHECK(Shape::try_box(1, 0, 3).status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    const auto large = box.try_scaled(2);
    CHECK(large && large.value.try_info().value.volume == 8);
    const swiftprox_mesh mesh = {vertices.value.data(), 8, nullptr, nullptr, 0};
    const std::array<swiftprox_mesh, 1> levels{mesh};
    swiftprox::ShapeOptions hull;
    hull.input = SWIFTPROX_INPUT_HULL;
    CHECK_OK(Shape::try_from_levels(levels, hull).status);

    // Lengths that C has to take on trust.
    const std::vector<double> coordinates(11);
    const std::vector<std::uint32_t> four{0, 1, 2, 3};
    CHECK(Shape::try_from_points(coordinates).status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(Shape::try_from_mesh(vertices.value, four).status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    const auto wrong = Shape::try_from_mesh(vertices.value, four, std::vector<std::uint32_t>{3});
    CHECK(wrong.status == SWIFTPROX_ERROR_INVALID_ARGUMENT && std::strstr(wrong.message(), "valences") != nullptr);

    // A build that is told to stop.
    swiftprox::ShapeOptions stopped;
    int reports = 0;
    stopped.progress = [&reports](double) { return ++reports > 1000; };
    CHECK(Shape::try_from_points(vertices.value, stopped).status == SWIFTPROX_ERROR_CANCELLED && reports == 1);

    // Shares: a copy outlives its original, what was moved away is empty.
    Shape first = box;
    Shape second = std::move(first);
    CHECK(!first && second);
    first = second;
    second = Shape();
    CHECK(first.try_info().value.vertex_count == 8);
}

static void pairs()
{
    const auto made = cube();
    const Shape &box = made.value;
    const Pose here, apart = Pose::at(3, 0, 0), into = Pose::at(0.75, 0, 0);
    swiftprox::PairCache cache;
    const auto distance = swiftprox::try_distance({box, here}, {box, apart}, cache);
    CHECK(distance && distance.value.lower <= 2 && distance.value.upper >= 2);
    CHECK_OK(swiftprox::try_verify({box, here}, {box, apart}, distance.value).status);
    CHECK(swiftprox::try_verify({box, here}, {box, into}, distance.value).status == SWIFTPROX_ERROR_UNVERIFIED);
    CHECK(!swiftprox::try_intersect({box, here}, {box, apart}, cache).value);
    CHECK(swiftprox::try_intersect({box, here}, {box, into}, cache).value);
    CHECK(swiftprox::try_contact({box, here}, {box, into}, cache).value.outcome == SWIFTPROX_OUTCOME_INTERSECTING);
    swiftprox::PairConfig config;
    config.absolute_error = 0.5;
    const auto rough = swiftprox::try_approximate({box, here}, {box, apart}, cache, config);
    CHECK(rough && rough.value.upper - rough.value.lower <= 0.5);
    swiftprox::DepthCache depths;
    const auto depth = swiftprox::try_depth({box, here}, {box, into}, depths);
    CHECK(depth && depth.value.lower <= 0.25 && depth.value.upper >= 0.25);
    swiftprox::ManifoldCache signed_distances;
    const auto overlap = swiftprox::try_signed_distance({box, here}, {box, into}, signed_distances);
    CHECK(overlap && overlap.value.lower == -depth.value.upper && overlap.value.upper == -depth.value.lower);
    CHECK_OK(swiftprox::try_depth_verify({box, here}, {box, into}, depths, depth.value).status);
    swiftprox::ManifoldCache manifolds;
    std::array<swiftprox_manifold_point, 8> points;
    const auto manifold = swiftprox::try_manifold({box, here}, {box, into}, manifolds, points);
    CHECK(manifold && manifold.value.point_count == 4 && manifold.value.reference != 0);
    CHECK_OK(swiftprox::try_manifold_verify({box, here}, {box, into}, manifolds, manifold.value, points).status);
    CHECK(swiftprox::gap(points[0]) <= points[0].gap_upper && swiftprox::gap(points[0]) >= points[0].gap_lower);
    const auto both = swiftprox::try_manifold_with_distance({box, here}, {box, into}, manifolds, points);
    CHECK(both && both.value.manifold.point_count == 4 && both.value.distance.lower == both.value.manifold.lower);
    const swiftprox_half_space ground{{0, 0, 2}, -1};
    const auto above = swiftprox::try_half_space_distance({box, Pose::at(0, 0, 0.25)}, ground);
    CHECK(above && above.value.lower <= 0.25 && 0.25 <= above.value.upper && above.value.normal[2] == 1);
    const auto feet = swiftprox::try_half_space_manifold({box, here}, ground, points);
    CHECK(feet && feet.value.point_count == 4 && feet.value.outcome == SWIFTPROX_OUTCOME_INTERSECTING);
    const std::array<double, 4> heights{0.25, 0.25, 0.25, 0.25};
    const auto level = swiftprox::Ground::try_from_heights(swiftprox::Range<const double>(heights), 2, 9, 9);
    CHECK(level && level.value.try_info().value.triangle_count == 2);
    std::array<double, 18> triangles;
    std::array<std::uint32_t, 6> corners;
    CHECK(level.value.try_copy_triangles(0, triangles, corners) && triangles[17] == 0.25 && corners[5] == 2);
    CHECK(level.value.try_copy_triangles(1, triangles).status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(level.value.try_copy_triangles(0, triangles, {corners.data(), 3}).status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    const Pose on_ground = Pose::at(4, 4, 1);
    const auto gap =
        swiftprox::try_ground_distance(SWIFTPROX_QUERY_KIND_DISTANCE, {box, on_ground}, {level.value, here});
    CHECK(gap && gap.value.answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && gap.value.answer.normal[2] == 1);
    std::array<swiftprox_ground_contact, 2> ground_contacts;
    const auto contacts = swiftprox::try_ground_contacts({box, on_ground}, {level.value, here}, ground_contacts, points, {});
    CHECK(contacts && contacts.value.contact_count == 0);
    const std::array<std::uint32_t, 2> two_corners{0, 1};
    CHECK(swiftprox::Ground::try_from_triangles(swiftprox::Range<const double>(heights),
                                                swiftprox::Range<const std::uint32_t>(two_corners))
              .status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    const std::array<const swiftprox_shape *, 2> parts{box.get(), box.get()};
    const std::array<Pose, 2> places{Pose::at(-2, 0, 0), Pose::at(2, 0, 0)};
    const auto pair_of_boxes = swiftprox::Compound::try_from_shapes(swiftprox::Range<const swiftprox_shape *const>(parts),
                                                                    swiftprox::Range<const Pose>(places));
    CHECK(pair_of_boxes && pair_of_boxes.value.try_info().value.piece_count == 2);
    CHECK(pair_of_boxes.value.try_piece(1).value && pair_of_boxes.value.try_piece_pose(1).value.rows() == places[1].rows());
    swiftprox::CompoundCache compound_cache;
    const swiftprox::PlacedCompound pair_here{pair_of_boxes.value, here}, pair_above{pair_of_boxes.value, Pose::at(0, 0, 3)};
    const auto compounds = swiftprox::try_compound_distance(pair_here, pair_above, compound_cache);
    CHECK(compounds && compounds.value.answer.outcome == SWIFTPROX_OUTCOME_SEPARATED && compounds.value.piece1 < 2);
    CHECK_OK(swiftprox::try_compound_verify(pair_here, pair_above, compounds.value).status);
    const auto met = swiftprox::try_compound_intersection(pair_here, pair_here, compound_cache);
    CHECK(met && met.value.answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING);
    const auto deepest = swiftprox::try_compound_signed_distance(pair_here, pair_here, compound_cache);
    CHECK(deepest && deepest.value.distance.upper < 0);
    std::array<swiftprox_compound_contact, 4> compound_contacts;
    const auto touching = swiftprox::try_compound_contacts(pair_here, pair_here, compound_contacts, points);
    CHECK(touching && touching.value.contact_count >= 2);
    CHECK(swiftprox::try_compound_cast_ray(pair_here, {{-9, 0, 0}, {1, 0, 0}, 99}).value.piece == 0);
    CHECK(swiftprox::try_compound_locate_point(pair_here, {2, 0, 0}).value.piece == 1);
    const auto fall = swiftprox::try_motion_between(Pose::at(3, 0, 10), here, {0, 0, 0}, 3);
    const auto rest = swiftprox::try_motion_between(here, here, {0, 0, 0}, 3);
    const swiftprox::MovingCompound pair_at_rest{pair_of_boxes.value, rest.value.motion};
    const swiftprox::MovingCompound pair_that_falls{pair_of_boxes.value, fall.value.motion};
    const auto fallen = swiftprox::try_compound_cast(pair_at_rest, pair_that_falls, compound_cache);
    CHECK(fallen && fallen.value.answer.outcome == SWIFTPROX_CAST_OUTCOME_HIT && fallen.value.answer.time_lower > 0.5);
    CHECK_OK(swiftprox::try_compound_cast_verify(pair_at_rest, pair_that_falls, fallen.value).status);
    const auto top = box.try_find_face(0);
    CHECK(top && box.try_face(top.value).value.corners.size() == 4 && box.try_face(top.value).value.labels[0] == 0);
    CHECK(box.try_face(6).status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    swiftprox::ShapeOptions round;
    round.input = SWIFTPROX_INPUT_HULL;
    round.swept_radius = 0.5;
    const std::array<double, 3> centre{};
    const auto ball = Shape::try_from_points(swiftprox::Range<const double>(centre), round);
    CHECK(ball && swiftprox::try_half_space_distance({ball.value, here}, {{0, 0, 1}, -2}).value.distance == 1.5);
    CHECK(swiftprox::try_distance({box, Pose(std::array<double, 12>{})}, {box, here}, cache).status == SWIFTPROX_ERROR_POSE);
    const Shape no_shape;
    CHECK(swiftprox::try_distance({no_shape, here}, {box, here}, cache).status == SWIFTPROX_ERROR_NULL_POINTER);
}

/* A cube that flies at another: contact at time 2/3, where the gap of 2 is closed at a speed of 3. */
static void motions()
{
    const auto made = cube();
    const Shape &box = made.value;
    swiftprox_motion still{};
    still.kind = SWIFTPROX_MOTION_KIND_FIXED;
    for (std::size_t i = 0; i < 12; ++i) {
        still.start[i] = Pose().rows()[i];
    }
    const auto flight = swiftprox::try_motion_between(Pose::at(3, 0.1, 0), Pose::at(0, 0.1, 0), {0, 0, 0}, 1);
    CHECK(flight && flight.value.end_error < 1e-12);
    swiftprox::PairCache cache;
    const auto hit = swiftprox::try_cast({box, still}, {box, flight.value.motion}, cache);
    CHECK(hit && hit.value.outcome == SWIFTPROX_CAST_OUTCOME_HIT);
    CHECK(hit.value.time_lower <= 2.0 / 3 && 2.0 / 3 <= hit.value.time_upper && hit.value.time_upper - hit.value.time_lower <= 1e-8);
    CHECK_OK(swiftprox::try_cast_verify({box, still}, {box, flight.value.motion}, hit.value).status);
    swiftprox_cast_answer forged = hit.value;
    forged.time_lower = 0.7;
    forged.time_upper = 0.7;
    CHECK(swiftprox::try_cast_verify({box, still}, {box, flight.value.motion}, forged).status == SWIFTPROX_ERROR_UNVERIFIED);
    const auto past = swiftprox::try_motion_between(Pose::at(3, 2, 0), Pose::at(0, 2, 0), {0, 0, 0}, 1);
    const auto clearance = swiftprox::try_clearance({box, still}, {box, past.value.motion}, cache);
    CHECK(clearance && clearance.value.lower <= 1 && 1 <= clearance.value.upper && clearance.value.lower > 0.98);
    CHECK(std::strlen(swiftprox::to_string(hit.value.outcome)) > 0);
    const std::array<double, 6> written{0.125, 0.25, 0.5, 1.123, 2.25, 3.5};
    CHECK(swiftprox::try_estimate_tolerance(written).value > 1e-9);
    // Coordinates behind the last whole point were left out: the array is of other numbers, or of others than the caller thinks.
    for (const std::size_t count : {std::size_t{1}, std::size_t{4}, std::size_t{5}}) {
        const auto odd = swiftprox::try_estimate_tolerance(swiftprox::Range<const double>(written.data(), count));
        CHECK(odd.status == SWIFTPROX_ERROR_INVALID_ARGUMENT && std::strstr(odd.message(), "not a multiple of 3"));
    }
    // A tetrahedron is one piece, an open one three.
    const std::array<double, 12> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<std::uint32_t, 12> faces{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    const auto whole = swiftprox::try_decompose(corners, faces);
    CHECK(whole && whole.value.piece_count == 1 && whole.value.corners.size() == 12 && whole.value.faces[3] < 4);
    const auto open = swiftprox::try_decompose(corners, swiftprox::Range<const std::uint32_t>(faces.data(), 9));
    CHECK(open && open.value.piece_count == 3 && open.value.pieces[2] == 2);
    CHECK(!swiftprox::try_decompose(corners, faces, {}, -1));
}

/* A ray through the middle of a cube, and one beside it. */
static void rays()
{
    const auto made = cube();
    const Shape &box = made.value;
    const swiftprox_ray through{{-3, 0.1, 0.2}, {2, 0, 0}, 10};
    const auto hit = swiftprox::try_cast_ray({box, Pose::at(1, 0, 0)}, through);
    CHECK(hit && hit.value.outcome == SWIFTPROX_RAY_OUTCOME_HIT && hit.value.normal[0] == -1);
    const auto miss = swiftprox::try_cast_ray({box, Pose::at(1, 5, 0)}, through);
    CHECK(miss && miss.value.outcome == SWIFTPROX_RAY_OUTCOME_MISS && std::isnan(miss.value.entry[0]));
    CHECK(std::strlen(swiftprox::to_string(hit.value.outcome)) > 0);
}

/* Where points are relative to a cube, and its farthest corner. */
static void points()
{
    const auto made = cube();
    const Shape &box = made.value;
    const auto beside = swiftprox::try_locate_point({box, Pose::at(1, 0, 0)}, {3, 0, 0});
    CHECK(beside && beside.value.location == SWIFTPROX_POINT_LOCATION_OUTSIDE && beside.value.normal[0] == 1);
    const auto corner = swiftprox::try_support({box, Pose::at(1, 0, 0)}, {1, 1, 2});
    CHECK(corner && corner.value.world[0] == 1.5 && corner.value.world[2] == 0.5);
    CHECK(std::strlen(swiftprox::to_string(beside.value.location)) > 0);
}

/* How distances change, from each kind of answer. */
static void gradients()
{
    const auto made = cube();
    const Shape &box = made.value;
    const swiftprox::Placed here{box, Pose::at(1.25, 0, 0)}, there{box, Pose::at(0, 0, 0)};
    swiftprox::ManifoldCache cache;
    swiftprox::PairCache distances;
    const auto signed_distance = swiftprox::try_signed_distance(here, there, cache);
    const double about[3] = {0, 0, 3};
    const auto gradient = swiftprox::try_gradient(here, there, signed_distance.value, {about, about});
    CHECK(gradient && gradient.value.is_unique == 0 && gradient.value.object1[0] == 1 && gradient.value.object2[0] == -1);
    const auto distance = swiftprox::try_distance(here, there, distances);
    const auto again = swiftprox::try_gradient(here, there, distance.value);
    CHECK(again && again.value.object1[0] == 1);
    const swiftprox::Placed into{box, Pose::at(0.75, 0, 0)};
    swiftprox::DepthCache depths;
    const auto depth = swiftprox::try_depth(into, there, depths);
    const auto out = swiftprox::try_gradient(into, there, depth.value);
    CHECK(out && out.value.object1[0] == 1 && out.value.is_unique == 0);
#if SWIFTPROX_HAS_EXCEPTIONS
    CHECK(swiftprox::gradient(into, there, depth.value).object1[0] == 1);
#endif
    CHECK(!swiftprox::try_gradient(here, there, swiftprox_signed_distance{}));
}

/* Lines, points and texts go to functions that keep what they need. */
static void drawings()
{
    const auto made = cube();
    const Shape &box = made.value;
    int edges = 0, steps = 0, words = 0;
    swiftprox::Draw draw;
    draw.line = [&](swiftprox_draw_kind kind, const double *start, const double *end) {
        edges += kind == SWIFTPROX_DRAW_KIND_EDGE && start[0] >= -0.5 && end[0] <= 3.5;
        steps += kind == SWIFTPROX_DRAW_KIND_MARCH;
    };
    draw.text = [&](swiftprox_draw_kind kind, const double *, const char *text) {
        words += kind == SWIFTPROX_DRAW_KIND_WITNESS && std::strcmp(text, "2") == 0;
    };
    const swiftprox::Placed here{box, Pose()}, there{box, Pose::at(3, 0, 0)};
    CHECK_OK(swiftprox::try_draw(here, draw).status);
    CHECK(edges == 12 && steps == 0);
    CHECK_OK(swiftprox::try_draw(here, there, draw).status);
    CHECK(edges == 36 && steps > 0 && words == 1);
    auto scene = swiftprox::Scene::try_create();
    CHECK_OK(scene.value.try_add(box).status);
    draw.kinds = swiftprox::draw_kinds(SWIFTPROX_DRAW_KIND_EDGE, SWIFTPROX_DRAW_KIND_BOX);
    CHECK(draw.kinds == 3);
    CHECK_OK(swiftprox::try_draw(scene.value, draw).status);
    CHECK(edges == 48);
#if SWIFTPROX_HAS_EXCEPTIONS
    swiftprox::draw(here, draw);
    swiftprox::draw(here, there, draw, {});
    swiftprox::draw(scene.value, draw);
    CHECK(edges == 96);
#endif
}

/* Questions about sets, and many pairs at once. */
static void sets()
{
    const auto made = cube();
    const Shape &box = made.value;
    auto created = swiftprox::Scene::try_create();
    swiftprox::Scene &scene = created.value;
    const auto here = scene.try_add(box, {});
    swiftprox::ObjectOptions options;
    options.pose = Pose::at(5, 0, 0);
    const auto there = scene.try_add(box, options);
    auto scratch = swiftprox::SetScratch::try_create();
    CHECK(here && there && scratch);
    CHECK(scene.try_prepare());
    const std::array<swiftprox_object_id, 1> ids{here.value};
    swiftprox::ObjectSet set;
    set.ids.assign(ids.begin(), ids.end());
    const auto least = scene.try_least_distance(set, scratch.value);
    CHECK(least && least.value.lower <= 4 && least.value.upper >= 4);
    const std::array<Pose, 2> poses{Pose::at(0, 3, 0), Pose::at(4.5, 0, 0)};
    const auto hit = scene.try_first_hit(set, poses, scratch.value, SWIFTPROX_POSE_ORDER_IN_ORDER);
    CHECK(hit && hit.value.time == 1);
    const swiftprox_ray along{{-3, 0, 0}, {1, 0, 0}, 10};
    const auto met = scene.try_cast_ray(along, scratch.value, SWIFTPROX_RAY_HITS_ALL);
    CHECK(met && swiftprox::hits(met.value).size() == 2 && swiftprox::hits(met.value).begin()->object == here.value);
    const auto motion = swiftprox::try_motion_between(Pose{}, Pose::at(8, 0, 0), {0, 0, 0}, 1);
    const std::array<swiftprox_motion, 1> motions{motion.value.motion};
    const auto cast = scene.try_cast(set, motions, scratch.value);
    CHECK(cast && cast.value.outcome == SWIFTPROX_CAST_OUTCOME_HIT && cast.value.pair.object2 == there.value);
    const auto edges = scene.try_cast_batch(set, motions, 1, scratch.value);
    // Both intervals hold the first contact; where they end depends on what the scratch has kept.
    CHECK(edges && edges.value.size() == 1 && edges.value[0].time_lower <= cast.value.time_upper);
    CHECK(edges.value[0].time_upper >= cast.value.time_lower);
    const std::array<double, 4> heights{-0.25, -0.25, -0.25, -0.25};
    const auto level = swiftprox::Ground::try_from_heights(swiftprox::Range<const double>(heights), 2, 9, 9);
    const Pose under = Pose::at(-2, -2, 0);
    const auto standing = scene.try_ground_contacts({level.value, under}, scratch.value, {}, &set);
    CHECK(standing && swiftprox::contacts(standing.value).size() == 1);
    const swiftprox_scene_ground_contact &foot = *swiftprox::contacts(standing.value).begin();
    CHECK(foot.object == here.value && swiftprox::points(standing.value, foot).size() == swiftprox::points(standing.value).size());
    CHECK(foot.contact.manifold.normal[2] == 1 && foot.contact.manifold.point_count >= 4);
    swiftprox::ObjectOptions lies;
    lies.pose = under;
    const auto ground = scene.try_add(level.value, lies);
    const auto own = scene.try_ground_contacts(scratch.value, {}, &set);
    CHECK(ground && own && swiftprox::contacts(own.value).size() == 1);
    CHECK(swiftprox::contacts(own.value).begin()->ground == ground.value);
    CHECK(scene.try_object_info(ground.value).value.ground == level.value.get());
    CHECK(scene.try_remove_object(ground.value));
    const auto floor = scene.try_half_space_contacts({{0, 0, 1}, -0.25}, scratch.value);
    CHECK(floor && swiftprox::contacts(floor.value).size() == 2);
    const std::array<Pose, 1> few{Pose{}};
    const std::array<swiftprox_object_id, 2> both{here.value, there.value};
    swiftprox::ObjectSet uneven;
    uneven.ids.assign(both.begin(), both.end());
    uneven.poses.assign(few.begin(), few.end());
    CHECK(scene.try_least_distance(uneven, scratch.value).status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(scene.try_ground_contacts({level.value, under}, scratch.value, {}, &uneven).status ==
          SWIFTPROX_ERROR_INVALID_ARGUMENT);
    std::array<swiftprox::PairCache, 2> caches;
    const Pose origin, beside = Pose::at(3, 0, 0);
    const std::array<swiftprox::Question, 2> questions{swiftprox::Question({box, origin}, {box, beside}, caches[0]),
                                                       swiftprox::Question({box, origin}, {box, origin}, caches[1])};
    std::vector<swiftprox_pair_answer> answers;
    CHECK(swiftprox::try_batch(SWIFTPROX_QUERY_KIND_DISTANCE, questions, answers, {}, &scene));
    CHECK(answers.size() == 2 && answers[0].lower <= 2 && answers[0].upper >= 2);
    CHECK(answers[1].outcome == SWIFTPROX_OUTCOME_INTERSECTING);
}

/* Whether an expression with a T of any kind compiles. */
template <class T, class = void> struct GivesPointer : std::false_type {
};
template <class T> struct GivesPointer<T, std::void_t<decltype(std::declval<T>().get())>> : std::true_type {
};
template <class T, class = void> struct GivesC : std::false_type {
};
template <class T> struct GivesC<T, std::void_t<decltype(std::declval<T>().to_c())>> : std::true_type {
};
template <class T, class = void> struct GivesScene : std::false_type {
};
template <class T> struct GivesScene<T, std::void_t<decltype(std::declval<T>().scene())>> : std::true_type {
};

// What would point at a temporary does not compile; what is named does.
using swiftprox::Ground;
using swiftprox::Moving;
using swiftprox::PlacedGround;
static_assert(std::is_constructible_v<Placed, const Shape &, Pose> && !std::is_constructible_v<Placed, Shape, Pose>);
static_assert(!std::is_constructible_v<Placed, const Shape, Pose>);
static_assert(std::is_constructible_v<PlacedGround, const Ground &, Pose> &&
              !std::is_constructible_v<PlacedGround, Ground, Pose>);
static_assert(std::is_constructible_v<Moving, const Shape &, swiftprox_motion>);
static_assert(!std::is_constructible_v<Moving, Shape, swiftprox_motion>);
static_assert(std::is_constructible_v<swiftprox::Question, Placed, Placed, swiftprox::PairCache &>);
static_assert(!std::is_constructible_v<swiftprox::Question, Placed, Placed, swiftprox::PairCache>);
static_assert(GivesPointer<Shape &>() && !GivesPointer<Shape>() && GivesPointer<const Ground &>() && !GivesPointer<Ground>());
static_assert(GivesPointer<swiftprox::Listener &>() && !GivesPointer<swiftprox::Listener>());
static_assert(GivesPointer<swiftprox::SetScratch &>() && !GivesPointer<swiftprox::SetScratch>());
static_assert(GivesC<swiftprox::ObjectSet &>() && !GivesC<swiftprox::ObjectSet>());
static_assert(GivesC<const swiftprox::Question &>() && !GivesC<swiftprox::Question>());
static_assert(GivesScene<swiftprox::Replay &>() && !GivesScene<swiftprox::Replay>());

/* Values own what they hold: what was written by temporaries is right after they are gone. */
static void lifetimes()
{
    const auto made = cube();
    const Shape &box = made.value;
    std::vector<swiftprox::PairCache> caches(2);
    std::vector<swiftprox::Question> questions;
    questions.push_back({{box, Pose()}, {box, Pose::at(2, 0, 0)}, caches[0]});
    questions.push_back({{box, Pose()}, {box, Pose::at(3, 0, 0)}, caches[1]});
    std::vector<swiftprox_pair_answer> answers;
    CHECK_OK(swiftprox::try_batch(SWIFTPROX_QUERY_KIND_DISTANCE, questions, answers).status);
    CHECK(answers[0].lower <= 1 && answers[0].upper >= 1 && answers[1].lower <= 2 && answers[1].upper >= 2);

    const std::vector<Pose> path{Pose::at(2, 0, 0), Pose::at(3, 0, 0)};
    swiftprox::PairCache shared;
    std::vector<swiftprox_pair_answer> along;
    CHECK_OK(swiftprox::try_distances(box, std::vector<Pose>{Pose()}, box, path, shared, along).status);
    CHECK(along.size() == 2 && along[0].lower <= 1 && along[0].upper >= 1 && along[1].lower <= 2 && along[1].upper >= 2);

    std::vector<Placed> placed;
    for (int i = 0; i < 4; ++i) {
        placed.emplace_back(box, Pose::at(3 * i, 0, 0));
    }
    const auto far = swiftprox::try_distance(placed[0], placed[3], caches[0]);
    CHECK(far && far.value.lower <= 8 && far.value.upper >= 8);
    std::vector<Moving> moving;
    for (int i = 0; i < 2; ++i) {
        moving.emplace_back(box, swiftprox::try_motion_between(Pose::at(4 * i, 0, 0), Pose::at(0, 0, 0), {}, 1).value.motion);
    }
    CHECK(swiftprox::try_cast(moving[0], moving[1], caches[0]).value.outcome == SWIFTPROX_CAST_OUTCOME_HIT);

    auto created = swiftprox::Scene::try_create();
    swiftprox::Scene &scene = created.value;
    auto scratch = swiftprox::SetScratch::try_create();
    CHECK_OK(scene.try_add(box).status);
    const swiftprox::ObjectSet all{scene.try_object_ids().value};
    swiftprox::ObjectOptions options;
    options.pose = Pose::at(3, 0, 0);
    CHECK_OK(scene.try_add(box, options).status);
    const auto least = scene.try_least_distance(all, scratch.value);
    CHECK(least && least.value.lower <= 2 && least.value.upper >= 2);
    const swiftprox::ObjectSet elsewhere{all.ids, std::vector<Pose>{Pose::at(1, 0, 0)}};
    const auto nearer = scene.try_least_distance(elsewhere, scratch.value);
    CHECK(nearer && nearer.value.lower <= 1 && nearer.value.upper >= 1);
}

static void scenes(const std::string &folder)
{
    const auto made = cube();
    auto created = swiftprox::Scene::try_create();
    CHECK_OK(created.status);
    swiftprox::Scene scene = std::move(created.value);
    const std::string recording = folder + "/cpp.swiftrec";
    CHECK_OK(scene.try_record(recording).status);

    swiftprox::ObjectOptions options;
    options.user_data = 7;
    const auto a = scene.try_add(made.value, options), b = scene.try_add(made.value);
    const std::array<Shape, 2> pieces{made.value, made.value};
    const auto c = scene.try_add(pieces);
    CHECK(a && b && c && a.value != b.value);
    CHECK_OK(scene.try_set_piece_pose(c.value, 1, Pose::at(0, 5, 0)).status);
    const std::array<swiftprox_object_id, 2> moved{b.value, c.value};
    const std::array<Pose, 2> to{Pose::at(0.75, 0, 0), Pose::at(10, 0, 0)};
    CHECK_OK(scene.try_set_poses(moved, to).status);
    CHECK(scene.try_set_poses(moved, std::vector<Pose>(1)).status == SWIFTPROX_ERROR_INVALID_ARGUMENT);
    CHECK(scene.try_piece_pose(c.value, 1).value.rows() == Pose::at(10, 5, 0).rows());
    CHECK(scene.try_object_info(a.value).value.user_data == 7);
    const auto box_of_a = scene.try_object_box(a.value);
    CHECK(box_of_a && box_of_a.value.upper[0] - box_of_a.value.lower[0] >= 1);
    CHECK(scene.try_object_ids().value.size() == 3);
    const auto piece = scene.try_piece(c.value, 1);
    CHECK(piece.value.get() == made.value.get());

    swiftprox::SceneQuery query;
    query.detail = SWIFTPROX_CONTACT_DETAIL_MANIFOLD;
    const auto touching = scene.try_query_contact(query);
    CHECK(touching && touching.value.count == 1 && touching.value.intersecting == 1);
    std::size_t listed = 0;
    for (const swiftprox_pair_result &pair : swiftprox::pairs(touching.value)) {
        CHECK(pair.object1 == a.value && pair.object2 == b.value && pair.user_data1 == 7);
        ++listed;
    }
    CHECK(listed == 1);
    CHECK(swiftprox::contacts(touching.value).size() == 1);
    CHECK(swiftprox::points(touching.value, swiftprox::contacts(touching.value)[0]).size() == 4);
    const auto apart = scene.try_get_signed_distance(0);
    CHECK(apart && apart.value.outcome == SWIFTPROX_OUTCOME_INTERSECTING && apart.value.upper <= 0);
    CHECK(!scene.try_get_signed_distance(1));
    CHECK(scene.try_query_distance().value.count == 5); // pairs of pieces
    swiftprox::SceneQuery of_objects;
    of_objects.piece_pairs = SWIFTPROX_PIECE_PAIRS_NEAREST;
    CHECK(scene.try_query_distance(of_objects).value.count == 3);
    CHECK(scene.try_query_object(c.value, SWIFTPROX_QUERY_KIND_INTERSECTION).value.count == 0);
    CHECK(scene.try_query_placed(made.value, Pose::at(10, 0, 0), SWIFTPROX_QUERY_KIND_INTERSECTION).value.count == 1);
    const auto events = scene.try_query_events();
    CHECK(swiftprox::began(events.value).size() == 1 && swiftprox::ended(events.value).empty());
    const std::array<Pose, 2> placed{Pose::at(10, 0, 0), Pose::at(0.75, 0, 0)};
    swiftprox::SceneQuery of_group;
    of_group.mask = 1;
    CHECK(scene.try_query_placed(pieces, placed, SWIFTPROX_QUERY_KIND_INTERSECTION, of_group).value.count == 3);
    of_group.mask = 2;
    CHECK(scene.try_query_placed(pieces, placed, SWIFTPROX_QUERY_KIND_INTERSECTION, of_group).value.count == 0);
    const std::array<swiftprox::ObjectOptions, 2> each{};
    const auto more = scene.try_add_objects(pieces, each);
    CHECK(more && more.value.size() == 2 && scene.try_object_ids().value.size() == 5);
    CHECK_OK(scene.try_set_piece_user_data(c.value, 1, 77).status);
    CHECK(scene.try_piece_user_data(c.value, 1).value == 77 && scene.try_piece_user_data(c.value).value == 0);
    CHECK_OK(scene.try_remove_objects(more.value).status);
    CHECK(scene.try_remove_objects(more.value).status == SWIFTPROX_ERROR_HANDLE);
    CHECK(SWIFTPROX_OBJECT_ID_NULL == swiftprox_object_id{} && !scene.try_is_object_valid(SWIFTPROX_OBJECT_ID_NULL).value);
    auto listener = swiftprox::Listener::try_create();
    CHECK_OK(listener.status);
    const auto heard = scene.try_listen(listener.value, SWIFTPROX_QUERY_KIND_CONTACT, query);
    CHECK(heard && swiftprox::pairs(heard.value.answer).size() == 1 && swiftprox::pairs(heard.value.events).size() == 1);
    const swiftprox_pair_event &event = swiftprox::pairs(heard.value.events)[0];
    CHECK(event.state == SWIFTPROX_EVENT_STATE_BEGAN && swiftprox::points(heard.value.events, event).size() == 4);
    swiftprox::Listener none;
    CHECK(scene.try_listen(none, SWIFTPROX_QUERY_KIND_CONTACT).status == SWIFTPROX_ERROR_NULL_POINTER);

    // A filter goes with the scene, wherever that is moved.
    int asked = 0;
    CHECK_OK(scene.try_set_pair_filter([&asked](swiftprox_object_id, swiftprox_object_id) { return ++asked < 0; }).status);
    swiftprox::Scene other = std::move(scene);
    CHECK(other.try_query_intersection().value.count == 0 && asked > 0);
    CHECK(scene.try_query_intersection().status == SWIFTPROX_ERROR_NULL_POINTER);
    CHECK_OK(other.try_set_pair_filter(nullptr).status);
    CHECK(other.try_query_intersection().value.count == 1);

    CHECK_OK(other.try_set_pairs({}).status);
    CHECK(other.try_query_intersection().value.count == 0);
    CHECK_OK(other.try_reset_pairs().status);
    CHECK_OK(other.try_set_pair_active(a.value, b.value, false).status);
    CHECK(!other.try_pair_active(a.value, b.value).value && other.try_is_object_valid(a.value).value);
    CHECK(other.try_query_intersection().value.count == 0);
    CHECK_OK(other.try_remove_object(a.value).status);
    CHECK(other.try_remove_object(a.value).status == SWIFTPROX_ERROR_HANDLE);
    CHECK(other.try_statistics().value.queries > 0);
    CHECK_OK(other.try_end_recording().status);
    CHECK_OK(other.try_destroy().status);

    auto opened = swiftprox::Replay::try_open(recording);
    CHECK_OK(opened.status);
    int steps = 0;
    for (auto step = opened.value.try_read(); step && step.value.has_step; step = opened.value.try_read()) {
        CHECK_OK(opened.value.try_change().status);
        if (step.value.has_query) {
            bool identical = false;
            CHECK_OK(opened.value.try_ask(SWIFTPROX_DEFAULT_MAX_DISTANCE, &identical).status);
            CHECK(identical);
            ++steps;
        }
    }
    CHECK(steps > 5);
    CHECK(opened.value.scene().try_object_ids().value.size() == 2);
}

#if SWIFTPROX_HAS_EXCEPTIONS
/* The plain forms: what is right is returned, what is wrong is thrown with its status and message. */
static void exceptions()
{
    const Shape box = swiftprox::take(cube());
    swiftprox::PairCache cache;
    CHECK(swiftprox::distance({box, Pose()}, {box, Pose::at(3, 0, 0)}, cache).outcome == SWIFTPROX_OUTCOME_SEPARATED);
    CHECK(swiftprox::intersect({box, Pose()}, {box, Pose()}, cache));
    swiftprox::Scene scene;
    const swiftprox_object_id id = scene.add(box);
    scene.set_pose(id, Pose::at(1, 2, 3));
    CHECK(scene.piece_pose(id).rows() == Pose::at(1, 2, 3).rows());
#if __cplusplus >= 202002L
    CHECK(scene.query_contact({.max_distance = 0.1}).count == 0);
#endif
    swiftprox::SetScratch scratch = swiftprox::SetScratch::create();
    swiftprox::Listener listener = swiftprox::Listener::create();
    const swiftprox_object_id beside = scene.add(box);
    scene.prepare();
    CHECK(scene.least_distance({{id}}, scratch).lower <= scene.query_distance().pairs[0].answer.upper);
    CHECK(swiftprox::pairs(scene.listen(listener, SWIFTPROX_QUERY_KIND_DISTANCE).events).size() == 1);
    scene.remove_object(beside);
    swiftprox_status status = SWIFTPROX_OK;
    try {
        scene.set_pose(swiftprox_object_id{}, Pose());
    } catch (const swiftprox::Error &error) {
        status = error.status();
        CHECK(std::strcmp(error.what(), swiftprox_library_last_error_message()) == 0 && error.what()[0] != '\0');
    }
    CHECK(status == SWIFTPROX_ERROR_HANDLE);
    try {
        status = SWIFTPROX_OK;
        static_cast<void>(Shape::from_file("/no such folder/no such file.off"));
    } catch (const std::runtime_error &error) {
        status = SWIFTPROX_ERROR_FILE;
        CHECK(std::strstr(error.what(), "no such file.off") != nullptr);
    }
    CHECK(status == SWIFTPROX_ERROR_FILE);
    swiftprox::library::check_version();
}
#endif

/* A reader in C++ of a format of its own: four vertices and four triangles. */
static void mesh_readers(const std::string &folder)
{
    const auto read = [](void *, const char *, std::size_t, swiftprox_mesh_sink *raw) -> std::int32_t {
        swiftprox::MeshSink sink(raw);
        static_cast<void>(sink.try_add_vertices(std::array<double, 12>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
        static_cast<void>(sink.try_add_faces(std::array<std::uint32_t, 12>{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}));
        return 0;
    };
    CHECK_OK(swiftprox::library::try_register_mesh_reader("CORNER", read).status);
    const std::string path = folder + "/cpp.corner";
    std::FILE *file = std::fopen(path.c_str(), "w");
    CHECK(file != nullptr && std::fputs("CORNER\n", file) >= 0 && std::fclose(file) == 0);
    CHECK(Shape::try_from_file(path).value.try_info().value.vertex_count == 4);
    // A vertex that is not whole refuses the file, whatever the callback says.
    const auto read_odd = [](void *, const char *, std::size_t, swiftprox_mesh_sink *raw) {
        swiftprox::MeshSink sink(raw);
        CHECK(!sink.try_add_vertices(std::array<double, 13>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 5}));
        static_cast<void>(sink.try_add_faces(std::array<std::uint32_t, 12>{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}));
        return 0;
    };
    CHECK_OK(swiftprox::library::try_register_mesh_reader("CORNER", read_odd).status);
    const auto refused = Shape::try_from_file(path);
    CHECK(refused.status == SWIFTPROX_ERROR_FILE && std::strstr(refused.message(), "vertices: the number of coordinates"));
    CHECK_OK(swiftprox::library::try_register_mesh_reader("CORNER", nullptr).status);
    CHECK(std::strcmp(swiftprox::to_string(SWIFTPROX_OUTCOME_SEPARATED),
                      swiftprox_library_outcome_string(SWIFTPROX_OUTCOME_SEPARATED)) == 0);
}

int main(int argc, char **argv)
{
    const std::string folder = argc > 1 ? argv[1] : ".";
    defaults();
    poses();
    shapes();
    pairs();
    lifetimes();
    motions();
    rays();
    points();
    gradients();
    drawings();
    scenes(folder);
    sets();
    mesh_readers(folder);
#if SWIFTPROX_HAS_EXCEPTIONS
    exceptions();
#endif
    return check_report("cpp");
}
