//! The check of manifolds: what queries say holds, and what was changed in it is found out.

use super::{ALL, FOUR, query, stacked};
use swiftprox::error::Error;
use swiftprox::manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{DepthAnswer, DepthCache, DepthConfig, FeatureKind, Outcome, Placed, depth};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::{verify_depth, verify_manifold};
use testkit::models::{prism, random_hull};
use testkit::random::Random;
use testkit::shapes::{at, cuboid, hull};

/// A manifold, and all that it is of.
struct Case {
    shapes: [Shape; 2],
    poses: [Pose; 2],
    config: ManifoldConfig,
    cache: ManifoldCache,
    manifold: Manifold,
    points: Vec<ManifoldPoint>,
}

impl Case {
    fn new(shapes: [Shape; 2], poses: [Pose; 2], config: ManifoldConfig) -> Case {
        let mut cache = ManifoldCache::default();
        let (manifold, points) = query(shapes.each_ref(), poses.each_ref(), &mut cache, &config);
        Case { shapes, poses, config, cache, manifold, points }
    }

    fn bodies(&self) -> [Placed<'_>; 2] {
        [self.shapes[0].at(&self.poses[0]), self.shapes[1].at(&self.poses[1])]
    }

    fn verify(&self) -> Result<(), Error> {
        verify_manifold(self.bodies(), &self.cache, &self.config, &self.manifold, &self.points)
    }

    /// Whether a changed manifold, or changed points of it, are refused.
    fn refuses(&self, change: impl FnOnce(&mut Manifold, &mut Vec<ManifoldPoint>)) -> bool {
        let (mut manifold, mut points) = (self.manifold, self.points.clone());
        change(&mut manifold, &mut points);
        let said = verify_manifold(self.bodies(), &self.cache, &self.config, &manifold, &points);
        matches!(said, Err(Error::Unverified(_) | Error::Argument(_)))
    }
}

/// A cube of side 2 whose turned corners are rounded to float: its faces are flat up to that.
fn float_cube(random: &mut Random) -> Shape {
    let turn = random.rotation();
    let corner = |k: usize| Vector::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64) * 2.0;
    let corners: Vec<Vector> =
        (0..8).map(|k| (turn * (corner(k) - Vector::repeat(1.0))).map(|x| f64::from(x as f32))).collect();
    Shape::from_points(&corners, &ShapeOptions::default()).unwrap()
}

/// A turned prism with coordinates of three to six decimals.
fn rounded_prism(random: &mut Random) -> Shape {
    let (mesh, turn) = (prism(3 + random.below(60) as u32, 0.75).unwrap(), random.rotation());
    let scale = [1e3, 1e4, 1e6][random.below(3)];
    let corners: Vec<Vector> = mesh.vertices.iter().map(|v| (turn * v).map(|x| (x * scale).round() / scale)).collect();
    Shape::from_points(&corners, &ShapeOptions::default()).unwrap()
}

fn swept(points: &[Vector], swept_radius: f64) -> Shape {
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
    Shape::from_points(points, &options).unwrap()
}

fn any_shape(random: &mut Random, kind: usize) -> Shape {
    let of_mesh = |mesh| Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
    match kind {
        0 => cuboid([1.0, 0.25, 0.5].map(|half| half * random.power(-20, 1))),
        1 => of_mesh(random_hull(30, random.next_u64()).unwrap()),
        2 => rounded_prism(random),
        3 => float_cube(random),
        4 => swept(&[Vector::new(-1.0, 0.0, 0.0), Vector::new(1.0, 0.5, 0.0)], 0.25),
        _ => swept(&[0, 1, 2, 3].map(|_| random.vector()), 0.125),
    }
}

/// Manifolds of needles and boxes, hulls, cubes and prisms of few digits, capsules and round tetrahedra, near each other and in
/// each other: all hold, whatever cache is handed over and however many points there was room for.
#[test]
fn what_queries_say_holds() {
    let mut random = Random::new(0x3e41f);
    let (mut outcomes, mut points) = ([0; 5], 0);
    for round in 0..240 {
        let shapes = [round % 6, round / 6 % 6].map(|kind| any_shape(&mut random, kind));
        let far = [0.1, 1.0, 10.0, 100.0, 1000.0][round % 5];
        let direction = random.direction();
        let place = random.vector() * far;
        let apart = direction * random.uniform(0.3, 2.6);
        // Half of them flat on each other: along one axis, turned about it.
        let turns = if round % 2 == 0 {
            [random.rotation(), random.rotation()]
        } else {
            let turn = testkit::random::rotation(&Vector::z(), random.uniform(0.0, 3.0));
            [turn, turn * testkit::random::rotation(&Vector::z(), random.uniform(0.0, 3.0))]
        };
        let poses = [Pose::new(&turns[0], &(place + apart)), Pose::new(&turns[1], &place)];
        let config = ManifoldConfig { max_distance: 0.75, ..if round % 3 == 0 { FOUR } else { ALL } };
        let mut case = Case::new(shapes, poses, config);
        assert!(case.verify().is_ok(), "{round}: {:?} {:?} {:?}", case.verify(), case.manifold, case.points);
        outcomes[case.manifold.outcome as usize] += 1;
        points += case.points.len();
        case.cache = ManifoldCache::default();
        assert!(case.verify().is_ok(), "{round}: {:?}", case.verify());
        let room = case.points.len().min(2);
        let mut few = vec![ManifoldPoint::default(); room];
        let cache = &mut ManifoldCache::default();
        let bodies = [case.shapes[0].at(&case.poses[0]), case.shapes[1].at(&case.poses[1])];
        let said = swiftprox::manifold::manifold(bodies, cache, &case.config, &mut few).unwrap();
        let held = verify_manifold(bodies, cache, &case.config, &said, &few);
        assert!(held.is_ok(), "{round}: {held:?} {said:?} {few:?}");
    }
    let [_, separated, beyond, intersecting, _] = outcomes;
    assert!(separated > 40 && beyond > 10 && intersecting > 40 && points > 400, "{outcomes:?} {points}");
}

/// Boxes with a gap of exactly 0.5, or exactly 0.125 in each other: what a double more or less would make false is refused.
#[test]
fn an_interval_that_misses_the_truth_by_one_double_is_refused() {
    for (height, truth) in [(1.25, 0.5), (0.625, -0.125)] {
        let shapes = [cuboid([1.0, 1.0, 0.25]), cuboid([2.0, 2.0, 0.5])];
        let poses = [at(0.0, 0.0, height), at(0.0, 0.0, 0.0)];
        let case = Case::new(shapes, poses, ManifoldConfig { max_distance: 1.0, ..ALL });
        assert_eq!(case.points.len(), 4);
        let with =
            |lower: f64, upper: f64| case.refuses(|manifold, _| (manifold.lower, manifold.upper) = (lower, upper));
        let [low, high] = [truth - 0.0625, truth + 0.0625];
        assert!(!with(truth, truth) && !with(low, truth) && !with(truth, high));
        assert!(with(truth.next_up(), high) && with(low, truth.next_down()) && with(high, low));
        for point in &case.points {
            assert!(point.gap_lower <= truth && truth <= point.gap_upper && (point.gap() - truth).abs() < 1e-14);
        }
    }
}

/// Each number is changed to what no number may be, each count and enumerator to another one; points are moved to where no contact
/// is.
#[test]
fn forgeries_are_refused() {
    let ([upper, lower], poses) = stacked(-0.0625, 0.3);
    let tilted = Pose::new(&testkit::random::rotation(&Vector::y(), 0.01), &Vector::new(0.0, 0.0, 0.75));
    let cases = [
        Case::new([upper, lower], poses, ManifoldConfig { max_distance: 0.05, ..ALL }),
        Case::new(
            [cuboid([1.0, 1.0, 0.25]), cuboid([2.0, 2.0, 0.5])],
            [tilted, Pose::IDENTITY],
            ManifoldConfig { max_distance: 0.25, ..ALL },
        ),
    ];
    for case in &cases {
        assert!(case.verify().is_ok() && case.points.len() == 4, "{:?}", case.verify());
        for forged in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(case.refuses(|manifold, _| manifold.lower = forged));
            assert!(case.refuses(|manifold, _| manifold.upper = forged));
            for axis in 0..3 {
                assert!(case.refuses(|manifold, _| manifold.normal[axis] = forged));
                for k in 0..4 {
                    assert!(case.refuses(|_, points| points[k].local1[axis] = forged));
                    assert!(case.refuses(|_, points| points[k].local2[axis] = forged));
                    assert!(case.refuses(|_, points| points[k].world1[axis] = forged));
                    assert!(case.refuses(|_, points| points[k].world2[axis] = forged));
                }
            }
            assert!(case.refuses(|_, points| points[2].gap_lower = forged));
            assert!(case.refuses(|_, points| points[2].gap_upper = forged));
        }
        // Numbers that are some, and not the right ones.
        assert!(case.refuses(|manifold, _| manifold.normal = manifold.normal.map(|x| x * 1.000_001)));
        assert!(case.refuses(|manifold, _| manifold.normal = manifold.normal.map(|x| -x)));
        assert!(case.refuses(|_, points| points[1].world1[0] += 1e-9));
        assert!(case.refuses(|_, points| points[1].local2[2] += 1e-9));
        assert!(case.refuses(|_, points| (points[1].gap_lower, points[1].gap_upper) = (0.03, 0.04)));
        assert!(case.refuses(|_, points| {
            let point = &mut points[1];
            (point.gap_lower, point.gap_upper) = (point.gap_upper.next_up(), point.gap_lower.next_down());
        }));
        assert!(case.refuses(|_, points| points[0].id ^= 1));
        assert!(case.refuses(|_, points| points[0].feature1.ids[0] = 99));
        assert!(case.refuses(|_, points| points[0].feature2.kind = FeatureKind::None));
        // One object's places for the other's.
        assert!(case.refuses(|_, points| (points[3].local1, points[3].local2) = (points[3].local2, points[3].local1)));
        for outcome in [Outcome::None, Outcome::Separated, Outcome::Beyond, Outcome::Intersecting, Outcome::Undecided] {
            assert_eq!(case.refuses(|manifold, _| manifold.outcome = outcome), outcome != case.manifold.outcome);
        }
        assert!(case.refuses(|manifold, _| manifold.reference = 0));
        assert!(case.refuses(|manifold, _| manifold.reference = 3));
        assert!(case.refuses(|manifold, _| manifold.found_count = 3));
        assert!(case.refuses(|manifold, _| manifold.point_count = 5));
        // The deepest is left out, or all are put on the far sides of the upper box, with gaps to match.
        assert!(
            case.refuses(|manifold, points| {
                let deepest = points.iter().map(|point| point.gap_upper).fold(f64::INFINITY, f64::min);
                points.retain(|point| point.gap_upper > deepest + 1e-3);
                let count = points.len() as u32;
                (manifold.point_count, manifold.found_count) = (count, count);
            }) || case.points.iter().all(|point| point.gap_upper - case.points[0].gap_upper < 1e-3)
        );
        assert!(case.refuses(|manifold, points| {
            let [pose, normal] = [case.poses[0].rotation() * Vector::z(), Vector::from(manifold.normal)];
            for point in points {
                point.local1[2] += 0.5;
                point.world1 = (Vector::from(point.world1) + pose * 0.5).into();
                let more = 0.5 * pose.dot(&normal);
                (point.gap_lower, point.gap_upper) = (point.gap_lower + more - 1e-9, point.gap_upper + more + 1e-9);
                point.feature1.ids[0] ^= 4;
            }
        }));
    }
}

/// Two places as far beside a corner of the upper box: in line, their gap in an interval wide enough for both to be off. Cause: a
/// point could be out of its body by what corners at one place are apart, 2⁻²⁵ of the size. Cut-off: 256 times the allowance,
/// 1.4e-11 here.
#[test]
fn a_point_beside_its_body_is_refused_however_wide_its_gap() {
    let ([upper, lower], poses) = stacked(-0.0625, 0.3);
    let case = Case::new([upper, lower], poses, ManifoldConfig { max_distance: 0.05, ..ALL });
    for k in 0..4 {
        assert_eq!(case.points[k].feature1.kind, FeatureKind::Vertex);
        let is_refused = |off: f64| {
            case.refuses(|_, points| {
                let point = &mut points[k];
                let aside = Vector::x() * (off * point.local1[0]);
                let shift = case.poses[0].rotation() * aside;
                let moved = |place: [f64; 3], by: Vector| <[f64; 3]>::from(Vector::from(place) + by);
                (point.local1, point.world1) = (moved(point.local1, aside), moved(point.world1, shift));
                (point.local2, point.world2) = (moved(point.local2, shift), moved(point.world2, shift));
                (point.gap_lower, point.gap_upper) = (point.gap_lower - 1e-6, point.gap_upper + 1e-6);
            })
        };
        assert!([0.0, 1e-12, -1e-8].iter().all(|&off| !is_refused(off)));
        assert!([1e-10, 1e-8, 1e-6].iter().all(|&off| is_refused(off)));
    }
}

/// A place on the far face of a plate in the place of the one below it, over a corner of a box: on the surface, in line with its
/// partner, with the gap of the two and their id. Only that the face looks up gives it away.
#[test]
fn a_point_on_the_far_side_is_refused() {
    let of = |turn: Vector| {
        let shapes = [cuboid([2.0, 2.0, 0.25]), cuboid([1.0, 1.0, 0.5])];
        let above = Pose::new(&Matrix::from_diagonal(&turn), &Vector::new(0.0, 0.0, 0.75));
        Case::new(shapes, [above, Pose::IDENTITY], ManifoldConfig { max_distance: 1.0, ..ALL })
    };
    // Turned over, the plate lies on its far face, and says its name.
    let (case, turned_over) = (of(Vector::repeat(1.0)), of(Vector::new(1.0, -1.0, -1.0)));
    assert!(case.verify().is_ok() && case.points.len() == 4);
    let (manifold, mut points) = (case.manifold, case.points.clone());
    let point = &mut points[1];
    let far = turned_over.points.iter().find(|far| far.feature2 == point.feature2).expect("the same corner");
    assert!(far.feature1.kind == FeatureKind::Face && far.feature1 != point.feature1);
    (point.feature1, point.id) = (far.feature1, far.id);
    (point.local1[2], point.world1[2]) = (point.local1[2] + 0.5, point.world1[2] + 0.5);
    (point.gap_lower, point.gap_upper) = (point.gap_lower + 0.5, point.gap_upper + 0.5);
    let refused = verify_manifold(case.bodies(), &case.cache, &case.config, &manifold, &points).unwrap_err();
    assert!(refused.message().contains("on no face that looks towards the other"), "{refused}");
}

/// Segments through hulls, so long that squares of lengths overflow. Cause: weights of points on edges
/// were quotients of such squares, NaN, and what was right was refused. Found by fuzzing.
#[test]
fn what_is_said_of_bodies_whose_squares_overflow_holds() {
    let mut random = Random::new(0x302);
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let shape = |corners: &[Vector]| Shape::from_points(corners, &options).unwrap();
    for size in [1e100, 1e160, 1e280, 1e302] {
        for _ in 0..20 {
            let end = random.direction() * size;
            let small: Vec<Vector> = (0..8).map(|_| random.vector() * 40.0).collect();
            let plate: Vec<Vector> = (0..3).map(|_| random.vector() * size).collect();
            for other in [shape(&small), shape(&plate)] {
                let poses = [Pose::IDENTITY, Pose::new(&Matrix::identity(), &random.vector())];
                let case = Case::new([other, shape(&[end, -end])], poses, ALL);
                let said = case.verify();
                // Rounding is told to be too much for doubles, or the answer holds.
                assert!(
                    matches!(said, Ok(()) | Err(Error::Argument(_))),
                    "{said:?} {:?} {:?}",
                    case.manifold,
                    case.points
                );
            }
        }
    }
}

/// A needle of 10¹⁶ times its thickness: of its faces two are left after merging, and both look away from +x. Cause: a point had
/// to be on a face that looks towards the other body, where there is none. Found by fuzzing.
#[test]
fn points_on_a_needle_hold_whose_faces_all_look_away() {
    let far = 4.683743612465316e17;
    let corners =
        [[0.0, -1.0, 31.0], [29.0, 0.0, -2.75], [-32.0; 3], [8.0, -32.0, -32.0], [0.0, 0.0, -32.0], [1.625, far, far]]
            .map(Vector::from);
    let needle =
        Shape::from_points(&corners, &ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() }).unwrap();
    assert!(needle.polyhedron().faces.iter().all(|face| face.normal.x < -0.1));
    let stretched = Matrix::from_diagonal(&Vector::new(1.00390625, 1.0, 1.0));
    let pose = Pose::new(&stretched, &Vector::repeat(-32.0));
    let case = Case::new([needle, cuboid([32.0; 3])], [pose, pose], ALL);
    assert_eq!((case.manifold.outcome, case.verify()), (Outcome::Intersecting, Ok(())), "{:?}", case.points);
}

/// A small body in a vast one, of which it is said that the depth is anything up to the vast one's size, and that its point is in
/// the middle of that: less than could be said, and true. Cause: the point is far behind the surface, as its gap's width says, and
/// was refused. Found by fuzzing.
#[test]
fn a_point_as_far_behind_the_surface_as_its_gap_is_wide_holds() {
    let size = 1e101;
    let vast = hull(&[Vector::x(), Vector::y(), Vector::z()].map(|axis| [axis * size, -axis * size]).concat());
    let poses = [Vector::new(16.0, 0.0, -32.0), Vector::repeat(16.0)].map(|at| Pose::new(&Matrix::identity(), &at));
    let mut case = Case::new([cuboid([1.0; 3]), vast], poses, ALL);
    assert_eq!((case.manifold.outcome, case.verify()), (Outcome::Intersecting, Ok(())));
    let [lower, upper] = [-size, -0.0];
    (case.manifold.lower, case.manifold.upper) = (lower, upper);
    case.points.truncate(1);
    (case.manifold.reference, case.manifold.point_count, case.manifold.found_count) = (0, 1, 1);
    let point = &mut case.points[0];
    (point.world2, point.gap_lower, point.gap_upper) = (point.world1, lower, upper);
    point.local2 = (Vector::from(point.world1) - poses[1].translation()).into();
    assert_eq!(case.verify(), Ok(()), "{:?}", case.points);
    assert!(case.refuses(|_, points| (points[0].gap_lower, points[0].gap_upper) = (-1.0, 1.0)));
}

/// Small bodies on plates 10⁹ to 10¹² as long, smaller than what is one place of the pair. Cause: their corners were clipped all
/// the same, and a point was 8,191 out of a body of radius 1. Found by fuzzing.
#[test]
fn bodies_smaller_than_one_place_touch_in_one() {
    let mut random = Random::new(0x17);
    for k in 0..600 {
        let long = 10_f64.powf(random.uniform(9.0, 12.0));
        let plate = hull(
            &[[-long, -20.0, 21.0], [1.0, -20.0, 15.0], [-32.0, -20.0, -32.0], [12.0, -20.0, -32.0]].map(Vector::from),
        );
        let thickness = if k % 2 == 0 { 3e-8 } else { 1.0 };
        let small: Vec<Vector> =
            (0..20).map(|_| random.direction().component_mul(&Vector::new(1.0, 1.0, thickness))).collect();
        let place =
            Vector::new(random.uniform(-30.0, 30.0), -20.0 + random.uniform(-1.0, 1.0), random.uniform(-30.0, 0.0));
        let mut shear = Matrix::identity();
        shear[(2, 1)] = 0.001_953_125;
        let case = Case::new([plate, hull(&small)], [Pose::IDENTITY, Pose::new(&shear, &place)], ALL);
        if case.manifold.outcome == Outcome::Beyond {
            continue;
        }
        assert_eq!((case.manifold.reference, case.manifold.found_count), (0, 1));
        assert_eq!(case.verify(), Ok(()), "{:?} {:?}", case.manifold, case.points);
    }
}

/// Cubes that overlap by more than the largest double: no interval ends there, and checks say that doubles do not reach so far.
/// Cause: the manifold's was called wrong. Found by fuzzing.
#[test]
fn a_depth_beyond_the_largest_double_is_told_to_be_too_large() {
    let vast = || cuboid([1.5e308; 3]);
    let case = Case::new([vast(), vast()], [Pose::IDENTITY; 2], ALL);
    assert_eq!((case.manifold.outcome, case.manifold.lower), (Outcome::Intersecting, f64::NEG_INFINITY));
    let told = case.verify();
    assert!(matches!(&told, Err(Error::Argument(text)) if text.contains("too large")), "{told:?}");
    let mut cache = DepthCache::default();
    let mut answer = DepthAnswer::default();
    depth(case.bodies(), &mut cache, &DepthConfig::default(), &mut answer).unwrap();
    assert_eq!(answer.upper, f64::INFINITY);
    assert_eq!(verify_depth(case.bodies(), &cache, &answer), told);
}

/// A corner of a cube beside a sliver 1e-5 long that stands on edge to the normal: no point is deeper than the objects are, and
/// each is in its body. Cause: what is nearer than one place took its height from the sliver's plane, which goes on out of it a
/// hundred times as far; the point was 1.3e-6 out of a body of 1e-5, with a gap of as much. From a slope of ten or so on.
#[test]
fn a_corner_beside_a_body_on_edge_is_as_high_as_that() {
    let sliver = [
        [-4.2604912158980206e-5, -2.299132988802567e-7, -3.852574899955092e-8],
        [-3.395101875432557e-5, 2.5747520605095943e-7, 4.4682106535472024e-8],
        [-3.2804096372315374e-5, 9.649468009270698e-8, 7.164358477445894e-8],
    ];
    let poses = [
        [
            [0.776837009041211, -0.21926382077030313, -0.5902945351984158, 0.0],
            [-0.5911577429709899, -0.57687092675009, -0.5636953581465228, 0.0],
            [-0.216925757597733, 0.786856601148964, -0.5777541907411397, 0.0],
        ],
        [
            [0.9128036730828025, 0.2548756752133827, 0.31906067826953255, -0.5739039587606443],
            [-0.26634032970882415, 0.9638114595346005, -0.008466887002192839, 0.3021578248858195],
            [-0.30961969178556836, -0.077542994051816, 0.9476411261208245, -0.5738527233828885],
        ],
    ];
    let case = Case::new([cuboid([0.5; 3]), hull(&sliver.map(Vector::from))], poses.map(|rows| Pose { rows }), ALL);
    assert_eq!((case.manifold.outcome, case.verify()), (Outcome::Intersecting, Ok(())), "{:?}", case.points);
    // Up to b of the check.
    let deepest = case.points.iter().map(|point| point.gap_upper).fold(f64::INFINITY, f64::min);
    assert!(deepest >= case.manifold.lower - 6e-8, "{deepest:e} {:?}", case.manifold);
}
