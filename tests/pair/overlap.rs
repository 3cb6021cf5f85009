//! Pairs that intersect: deep ones are proved without integers however symmetric they lie, the filter accepts nothing that is
//! not so, touching ones get the normal of a plane that separates them, and what a cache holds never changes a verdict.

use swiftprox::base::simd::Portable;
use swiftprox::distance::enclosure::encloses_origin;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::contact;
use swiftprox::pair::{DecidedBy, Outcome, PairAnswer, PairCache, PairConfig, distance, intersection};
use swiftprox::placed::Pair;
use swiftprox::placed::exact;
use swiftprox::placed::frame::Frame;
use swiftprox::shape::Shape;
use swiftprox::verify::verify;
use testkit::random::Random;
use testkit::shapes::{cuboid, hull};

fn moved(translation: Vector) -> Pose {
    Pose::new(&Matrix::identity(), &translation)
}

fn octahedron() -> Shape {
    let axes = [Vector::x(), Vector::y(), Vector::z()];
    hull(&axes.iter().flat_map(|axis| [*axis, -axis]).collect::<Vec<_>>())
}

fn query(shapes: [&Shape; 2], poses: [&Pose; 2]) -> PairAnswer {
    let mut answer = PairAnswer::default();
    let (mut cache, config) = (PairCache::default(), PairConfig::default());
    contact([shapes[0].at(poses[0]), shapes[1].at(poses[1])], &mut cache, &config, &mut answer).unwrap();
    answer
}

#[test]
fn coincident_bodies_are_proved_without_integers() {
    let mut random = Random::new(1);
    let simplex = [Vector::zeros(), Vector::x(), Vector::y(), Vector::z()];
    let round: Vec<Vector> = (0..60).map(|_| random.vector().normalize()).collect();
    let shapes = [cuboid([1.0, 1.0, 1.0]), cuboid([1.0, 2.0, 0.01]), octahedron(), hull(&simplex)];
    for shape in shapes.iter().chain([&hull(&round)]) {
        for turn in 0..20 {
            let rotation = if turn == 0 { Matrix::identity() } else { random.rotation() };
            let pose = Pose::new(&rotation, &(random.vector() * 10.0));
            let answer = query([shape, shape], [&pose, &pose]);
            assert_eq!(answer.outcome, Outcome::Intersecting);
            assert_eq!(answer.statistics.exact_iterations, 0, "{answer:?}");
        }
    }
}

#[test]
fn stacked_boxes_are_proved_without_integers_down_to_a_shallow_overlap() {
    let (lower, upper) = (cuboid([1.0, 1.0, 1.0]), cuboid([0.5, 0.75, 0.25]));
    let mut random = Random::new(2);
    for exponent in 1..=12 {
        let depth = 10f64.powi(-exponent);
        for centred in [true, false] {
            let aside = if centred { Vector::zeros() } else { random.vector() * 0.5 };
            let [x, y, _] = aside.into();
            let poses = [moved(Vector::zeros()), moved(Vector::new(x, y, 1.25 - depth))];
            let answer = query([&lower, &upper], [&poses[0], &poses[1]]);
            assert_eq!(answer.outcome, Outcome::Intersecting);
            assert_eq!(answer.statistics.exact_iterations, 0, "depth {depth}, {answer:?}");
            assert!((answer.normal[2] + 1.0).abs() < 1e-12, "depth {depth}, {answer:?}");
        }
    }
}

#[test]
fn the_filter_accepts_only_what_integers_confirm() {
    let origin = hull(&[Vector::zeros()]);
    let mut random = Random::new(3);
    let (mut accepted, mut refused_inside) = (0, 0);
    for number in 0..4000 {
        // A tetrahedron with the origin near a face, an edge or a corner, some of them slivers.
        let flatten = if number % 4 == 0 { 1e-9 } else { 1.0 };
        let corners = [(); 4].map(|()| random.vector().component_mul(&Vector::new(1.0, 1.0, flatten)));
        let on = 1 + random.below(3);
        let weights = [(); 4].map(|()| 1.0 + random.signed());
        let sum: f64 = weights[..on].iter().sum();
        let near: Vector = (0..on).map(|k| corners[k] * (weights[k] / sum)).sum();
        let gap = random.vector() * 2f64.powi(-(random.below(60) as i32));
        let rotation = random.rotation();
        let pose = Pose::new(&rotation, &(rotation * (gap.component_mul(&Vector::new(1.0, 1.0, flatten)) - near)));
        let shape = hull(&corners);
        let polyhedra = [shape.polyhedron(), origin.polyhedron()];
        if polyhedra[0].vertices.len() < 4 {
            continue;
        }
        let pairs = [[0, 0], [1, 0], [2, 0], [3, 0]];
        let frame = Frame::<Portable>::new(&Pair { polyhedra, poses: [&pose, &Pose::IDENTITY] });
        assert!(frame.in_range);
        let truth = exact::encloses_origin(&Pair { polyhedra, poses: [&pose, &Pose::IDENTITY] }, &pairs);
        match encloses_origin(&frame, &pairs) {
            Some(weights) => {
                assert!(truth, "{corners:?} {pose:?}");
                assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12 && weights.iter().all(|w| *w > 0.0));
                accepted += 1;
            }
            None => refused_inside += i32::from(truth),
        }
    }
    assert!(accepted > 500 && refused_inside > 50, "{accepted} accepted, {refused_inside} refused although inside");
}

/// Lattice polytopes of any dimension that touch in a common point of two faces, edges or vertices, exactly: both lie on their
/// sides of a plane, and a point of one in the plane is moved onto a point of the other.
#[test]
fn normals_of_touching_bodies_separate_them() {
    let mut random = Random::new(4);
    let mut tested = 0;
    while tested < 3000 {
        let points: [Vec<Vector>; 2] = std::array::from_fn(|_| {
            let count = 1 + random.below(9);
            (0..count).map(|_| random.lattice(3)).collect()
        });
        let normal = random.lattice(2);
        if normal == Vector::zeros() {
            continue;
        }
        let touching: [Vector; 2] = std::array::from_fn(|i| {
            let towards = if i == 0 { -normal } else { normal };
            let highest = points[i].iter().map(|p| p.dot(&towards)).fold(f64::NEG_INFINITY, f64::max);
            let ends: Vec<&Vector> = points[i].iter().filter(|p| p.dot(&towards) == highest).collect();
            // The middle of any two, possibly the same.
            let mut end = || ends[random.below(ends.len())];
            (end() + end()) * 0.5
        });
        let shapes = [hull(&points[0]), hull(&points[1])];
        let poses = [moved(Vector::zeros()), moved(touching[0] - touching[1])];
        let answer = query([&shapes[0], &shapes[1]], [&poses[0], &poses[1]]);
        assert_eq!(answer.outcome, Outcome::Intersecting);
        let found = Vector::from(answer.normal);
        let lowest = points[0].iter().map(|p| found.dot(&poses[0].transform(p))).fold(f64::INFINITY, f64::min);
        let highest = points[1].iter().map(|p| found.dot(&poses[1].transform(p))).fold(f64::NEG_INFINITY, f64::max);
        // Coordinates up to 12, a unit normal, three products.
        assert!(highest - lowest <= 1e-14, "{} {points:?} {poses:?} {answer:?}", highest - lowest);
        tested += 1;
    }
}

#[test]
fn a_vertex_inside_a_face_has_the_normal_of_the_face() {
    // A box with a vertex in the middle of its top, and a pyramid on its tip there, leaning far to one side.
    let mut points: Vec<Vector> =
        (0..8).map(|k| Vector::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64)).collect();
    points.push(Vector::new(0.5, 0.5, 1.0));
    let tip = Vector::new(0.5, 0.5, 1.0);
    let lean = [[9.0, 0.0, 0.5], [9.0, 1.0, 0.25], [8.0, 0.5, 3.0]];
    let above: Vec<Vector> = lean.iter().map(|p| tip + Vector::from(*p)).chain([tip]).collect();
    for turn in [Matrix::identity(), Random::new(7).rotation()] {
        let pose = Pose::new(&turn, &Vector::zeros());
        let answer = query([&hull(&points), &hull(&above)], [&pose, &pose]);
        assert_eq!(answer.outcome, Outcome::Intersecting);
        let normal = Vector::from(answer.normal);
        let lowest = points.iter().map(|p| normal.dot(&(turn * p))).fold(f64::INFINITY, f64::min);
        let highest = above.iter().map(|p| normal.dot(&(turn * p))).fold(f64::NEG_INFINITY, f64::max);
        assert!(highest - lowest <= 1e-14, "{} {answer:?}", highest - lowest);
    }
}

#[test]
fn crossing_edges_at_any_rotation_have_the_normal_of_both() {
    let shape = cuboid([1.0, 1.0, 1.0]);
    let mut random = Random::new(5);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    for _ in 0..200 {
        let turn = random.rotation();
        let tilt = |angle: f64| nalgebra::Rotation3::from_axis_angle(&Vector::x_axis(), angle).into_inner();
        let across = nalgebra::Rotation3::from_axis_angle(&Vector::z_axis(), 0.2 + 2.5 * random.signed().abs());
        // Both stand on an edge; they overlap by 1e-9 where two edges cross.
        let on_edge = tilt(std::f64::consts::FRAC_PI_4);
        let up = Vector::z() * (2.0 / half - 1e-9);
        let poses = [
            Pose::new(&(turn * across.matrix() * on_edge), &(turn * up)),
            Pose::new(&(turn * on_edge), &Vector::zeros()),
        ];
        let answer = query([&shape, &shape], [&poses[0], &poses[1]]);
        assert_eq!(answer.outcome, Outcome::Intersecting);
        assert!((Vector::from(answer.normal) - turn * Vector::z()).norm() < 1e-7, "{answer:?}");
    }
}

#[test]
fn a_cache_never_changes_a_verdict() {
    let mut random = Random::new(6);
    let config = PairConfig::default();
    let shapes = [cuboid([1.0, 0.5, 0.25]), octahedron(), hull(&[Vector::x(), Vector::y(), Vector::z()])];
    let mut intersecting = 0;
    for first in &shapes {
        for second in &shapes {
            let mut cache = PairCache::default();
            for number in 0..500 {
                // Half of them touch or overlap exactly on the lattice.
                let mut pose = |exact: bool| {
                    if exact {
                        moved(random.lattice(4) * 0.25)
                    } else {
                        Pose::new(&random.rotation(), &(random.vector() * 0.8))
                    }
                };
                let poses = [pose(number % 2 == 0), pose(number % 2 == 0)];
                let ask = if number % 3 == 0 { intersection } else { distance };
                let (mut cold, mut warm) = (PairAnswer::default(), PairAnswer::default());
                let mut fresh = PairCache::default();
                ask([first.at(&poses[0]), second.at(&poses[1])], &mut fresh, &config, &mut cold).unwrap();
                ask([first.at(&poses[0]), second.at(&poses[1])], &mut cache, &config, &mut warm).unwrap();
                assert_eq!(cold.outcome, warm.outcome, "{poses:?}");
                assert!(cold.lower <= warm.upper && warm.lower <= cold.upper, "{cold:?} {warm:?}");
                intersecting += i32::from(cold.outcome == Outcome::Intersecting);
            }
        }
    }
    assert!((1000..4000).contains(&intersecting), "{intersecting}");
}

/// A verdict about bodies of which nothing is known walks to the origin. Marching answers what the walk leaves open, and poses that
/// are not rigid to the last digits.
#[test]
fn cold_verdicts_walk_to_the_truth() {
    let mut random = Random::new(0x3a1c);
    let round: Vec<Vector> = (0..40).map(|_| random.direction()).collect();
    let flat: Vec<Vector> = round.iter().map(|v| v.component_mul(&Vector::new(1.0, 1.0, 0.1))).collect();
    let shapes = [cuboid([1.0, 1.0, 1.0]), cuboid([1.0, 0.5, 0.1]), octahedron(), hull(&round), hull(&flat)];
    let (mut walked, mut marched, mut intersecting) = (0, 0, 0);
    for _ in 0..4_000 {
        let [a, b] = [0, 1].map(|_| &shapes[random.below(shapes.len())]);
        let pose1 = Pose::new(&random.rotation(), &random.vector());
        let away = random.direction() * random.uniform(0.5, 2.5);
        let pose2 = Pose::new(&random.rotation(), &(pose1.translation() + away));
        let mut answer = PairAnswer::default();
        intersection([a.at(&pose1), b.at(&pose2)], &mut PairCache::default(), &PairConfig::default(), &mut answer)
            .unwrap();
        verify([a.at(&pose1), b.at(&pose2)], &answer).unwrap();
        let truth =
            exact::solve(&Pair { polyhedra: [a.polyhedron(), b.polyhedron()], poses: [&pose1, &pose2] }, &[[0, 0]]);
        assert_eq!(answer.outcome == Outcome::Intersecting, truth.intersecting, "{pose1:?} {pose2:?} {answer:?}");
        intersecting += usize::from(truth.intersecting);
        match answer.decided_by {
            DecidedBy::Fallback if answer.statistics.marching_steps == 0 => walked += 1,
            DecidedBy::BoundingSpheres | DecidedBy::InscribedSpheres => {}
            _ => marched += 1,
        }
    }
    assert!((1_000..3_000).contains(&intersecting), "{intersecting}");
    assert!(marched < walked / 10, "{marched} marched, {walked} walked");
}
