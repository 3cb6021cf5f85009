//! Bodies and half-spaces: heights of vertices in rational numbers.

use crate::{capsule, sphere, swept};
use std::sync::Arc;
use swiftprox::error::Error;
use swiftprox::manifold::{Manifold, ManifoldConfig, ManifoldPoint, half_space_manifold};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::ObjectOptions;
use swiftprox::pair::{HalfSpace, Outcome, half_space_distance};
use swiftprox::scene::{GroupFilter, Scene, SetScratch};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::random::Random;
use testkit::shapes::at;
use testkit::swept::Length;

const GROUND: HalfSpace = HalfSpace { normal: [0.0, 0.0, 1.0], offset: 0.0 };

fn manifold(
    body: &Shape,
    pose: &Pose,
    half_space: &HalfSpace,
    max_distance: f64,
    reduces: bool,
) -> (Manifold, Vec<ManifoldPoint>) {
    let mut points = vec![ManifoldPoint::default(); 64];
    let config = ManifoldConfig { max_distance, reduces };
    let found = half_space_manifold(body.at(pose), half_space, &config, &mut points).unwrap();
    points.truncate(found.point_count as usize);
    (found, points)
}

/// Of any hulls, poses and planes: the interval holds the least (n·x − offset)/|n| of all vertices, less the radius, and so do
/// gaps; no vertex is deeper than the deepest point.
#[test]
fn intervals_hold_the_lowest_vertex() {
    let mut random = Random::new(0xa15);
    let mut seen = [0; 2];
    for round in 0..300 {
        let cloud: Vec<Vector> = (0..[1, 2, 3, 4, 12, 40][round % 6]).map(|_| random.vector()).collect();
        let radius = if round % 2 == 0 { 0.0 } else { random.uniform(0.0, 1.0) };
        let body = swept(&cloud, radius);
        let pose = Pose::new(&random.rotation(), &(random.vector() * 2.0));
        let normal = random.vector() * random.power(-8, 8);
        let half_space = HalfSpace { normal: normal.into(), offset: random.signed() * normal.norm() };
        let heights: Vec<Length> = cloud.iter().map(|v| Length::above(&half_space, &pose, v, radius)).collect();
        let answer = half_space_distance(body.at(&pose), &half_space).unwrap();
        assert!(heights.iter().all(|height| height.compared_with(answer.lower).is_ge()), "{answer:?}");
        assert!(heights.iter().any(|height| height.compared_with(answer.upper).is_le()), "{answer:?}");
        assert!(
            answer.upper - answer.lower < 1e-14 && answer.lower <= answer.distance && answer.distance <= answer.upper
        );
        let is_apart = heights.iter().all(|height| height.compared_with(0.0).is_gt());
        assert_eq!(answer.outcome, if is_apart { Outcome::Separated } else { Outcome::Intersecting });
        seen[usize::from(is_apart)] += 1;
        let [world1, world2, up] = [answer.world1, answer.world2, answer.normal].map(Vector::from);
        assert!((world1 - world2 - up * answer.distance).norm() < 1e-14, "{answer:?}");
        assert!((pose.transform(&Vector::from(answer.local1)) - world1).norm() < 1e-14);
        let (found, points) = manifold(&body, &pose, &half_space, 0.5, false);
        assert_eq!(found.outcome == Outcome::Beyond, answer.lower > 0.5);
        assert!(points.is_empty() == (found.outcome == Outcome::Beyond));
        let mut deepest = f64::INFINITY;
        for point in &points {
            let height = &heights[point.feature1.ids[0] as usize];
            assert!(height.lies_between(point.gap_lower, point.gap_upper), "{point:?}");
            assert!(point.gap_upper - point.gap_lower < 1e-13);
            deepest = deepest.min(point.gap_lower);
        }
        assert!(points.is_empty() || deepest <= answer.upper);
    }
    assert!(seen.iter().all(|&count| count > 60), "{seen:?}");
}

/// Touching is intersecting; a unit in the last place is not.
#[test]
fn touching_is_decided_in_integers() {
    let tilted = HalfSpace { normal: [3.0, 0.0, 4.0], offset: 0.0 };
    for (body, height, half_space) in [
        (sphere(0.5), 0.5, GROUND),
        (capsule(2.0, 0.25), 0.25, GROUND),
        // Of a normal of length 5: 4·z/5.
        (sphere(0.4), 0.5, tilted),
    ] {
        let ask = |z: f64| half_space_distance(body.at(&at(0.0, 0.0, z)), &half_space).unwrap();
        let touching = ask(height);
        // 0.4 is no double: the sphere is larger than 2/5.
        let is_exact = half_space == GROUND;
        assert_eq!(touching.outcome, Outcome::Intersecting);
        assert!(!is_exact || (touching.lower, touching.upper) == (0.0, 0.0), "{touching:?}");
        let apart = ask(height.next_up());
        assert_eq!(apart.outcome, Outcome::Separated, "{apart:?}");
        assert!(apart.lower > 0.0 && apart.upper < 1e-15);
        assert_eq!(ask(height.next_down()).outcome, Outcome::Intersecting);
    }
}

/// A box has its four lower corners, whichever way it is turned about the vertical, two of them on an edge, one on a corner; a drum
/// four of its many, those that cover most.
#[test]
fn manifolds_are_the_corners_below() {
    let cube = swept(&testkit::models::cuboid([0.5; 3]).unwrap().vertices, 0.125);
    let slanted =
        |y: f64, x: f64| testkit::random::rotation(&Vector::x(), x) * testkit::random::rotation(&Vector::y(), y);
    let quarter = std::f64::consts::FRAC_PI_4;
    for (turn, count, height) in [
        (testkit::random::rotation(&Vector::z(), 0.4), 4, 0.625),
        (slanted(quarter, 0.0), 2, 0.5_f64.sqrt() + 0.125),
        (slanted(quarter, 0.3), 1, 0.8),
    ] {
        let (found, points) = manifold(&cube, &Pose::new(&turn, &Vector::new(0.3, 0.2, height)), &GROUND, 1e-9, false);
        assert_eq!((found.point_count, points.len()), (count, count as usize), "{found:?}");
    }
    let drum: Vec<Vector> = (0..96)
        .map(|k| {
            let angle = std::f64::consts::TAU * f64::from(k / 2) / 48.0;
            Vector::new(angle.cos(), angle.sin(), if k % 2 == 0 { 0.25 } else { -0.25 })
        })
        .collect();
    let pose = Pose::new(&Matrix::identity(), &Vector::new(0.0, 0.0, 0.2));
    let (all, _) = manifold(&swept(&drum, 0.0), &pose, &GROUND, 0.0, false);
    assert_eq!((all.point_count, all.found_count), (48, 48));
    let (four, points) = manifold(&swept(&drum, 0.0), &pose, &GROUND, 0.0, true);
    assert_eq!((four.point_count, four.found_count), (4, 48));
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| Vector::from(points[i].world1));
    let area = 0.5 * (b - a).cross(&(d - c)).norm();
    assert!(area > 1.9, "{area}: the largest square has 2");
}

/// Faces flat up to a noise are one contact face, and the lowest vertex need not be a corner of it. It was a fifth point.
#[test]
fn a_reduced_manifold_has_at_most_four_points() {
    let square =
        |height: f64| [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Vector::new(x, y, height));
    let points: Vec<Vector> =
        [square(0.0), square(1.0)].concat().into_iter().chain([Vector::new(0.1, 0.0, -1e-4)]).collect();
    let options = ShapeOptions { face_noise: Some(1e-3), ..ShapeOptions::default() };
    let body = Shape::from_points(&points, &options).unwrap();
    let ask = |reduces| manifold(&body, &Pose::IDENTITY, &GROUND, 1e-3, reduces);
    let [(all, every), (four, points)] = [false, true].map(ask);
    assert_eq!((all.point_count, all.found_count), (5, 5), "{every:?}");
    assert_eq!((four.point_count, four.found_count), (4, 5), "{points:?}");
    assert_eq!(points.iter().filter(|point| point.gap_upper < -0.9e-4).count(), 1, "{points:?}");
}

#[test]
fn what_is_no_half_space_is_refused() {
    let (body, pose) = (sphere(1.0), Pose::IDENTITY);
    for half_space in [
        HalfSpace { normal: [0.0; 3], offset: 0.0 },
        HalfSpace { normal: [0.0, f64::NAN, 1.0], offset: 0.0 },
        HalfSpace { normal: [0.0, 0.0, 1.0], offset: f64::INFINITY },
    ] {
        let refused = half_space_distance(body.at(&pose), &half_space).unwrap_err();
        assert!(matches!(&refused, Error::Argument(message) if message.contains("half-space")), "{refused}");
    }
    let mirror = Pose::new(&Matrix::from_diagonal(&Vector::new(-1.0, 1.0, 1.0)), &Vector::zeros());
    assert!(matches!(half_space_distance(body.at(&mirror), &GROUND), Err(Error::Pose(_))));
    // At the ends of the range.
    for (normal, offset) in [([0.0, 0.0, f64::MAX], 0.0), ([0.0, 0.0, 5e-324], 0.0), ([1e300, 1e-300, 1e300], f64::MAX)]
    {
        let answer = half_space_distance(body.at(&pose), &HalfSpace { normal, offset }).unwrap();
        assert!(answer.lower <= answer.distance && answer.distance <= answer.upper, "{answer:?}");
        manifold(&body, &pose, &HalfSpace { normal, offset }, f64::INFINITY, true);
    }
}

/// Of magnitudes anywhere among the doubles, subnormal ones included, for one component.
fn any_size(random: &mut Random) -> f64 {
    let size = random.power(-1021, 1000);
    match random.below(4) {
        0 => 5e-324 * (random.below(9) as f64),
        1 => f64::MIN_POSITIVE * random.uniform(0.0, 4.0),
        _ => size * random.uniform(1.0, 2.0),
    }
    .copysign(random.signed())
}

/// Normals and offsets of any size, bodies of any size, poses that stretch. Heights were in units of a normal whose length had lost
/// its digits where it is subnormal, from 2⁻¹⁰²³ on: gaps were off by up to 13 %. A distance below the least double was put into an
/// interval that ended below its begin: an offset of −2⁻¹⁰⁷⁴ over a normal of 2 does it.
#[test]
fn no_size_of_a_half_space_hides_a_height() {
    let mut random = Random::new(0xa16);
    let (mut seen, mut points_seen) = ([0; 2], 0);
    for round in 0..400 {
        let size = [random.power(-1000, 950), random.power(-40, 40)][round % 2];
        let cloud: Vec<Vector> = (0..[1, 2, 4, 8][round % 4]).map(|_| random.vector() * size).collect();
        let radius = if round % 3 == 0 { random.uniform(0.0, 1.0) * size } else { 0.0 };
        let body = swept(&cloud, radius);
        let stretch = Matrix::identity() + Matrix::from_fn(|_, _| 2e-3 * random.signed());
        let pose = Pose::new(&(random.rotation() * stretch), &(random.vector() * size * random.power(-3, 10)));
        // Of one size, or of three; a plane near the body, or anywhere.
        let normal = match round % 5 {
            0 => [any_size(&mut random), any_size(&mut random), any_size(&mut random)],
            1 => [0.0, 0.0, any_size(&mut random)],
            _ => (random.vector() * random.power(-1072, 1020)).into(),
        };
        if normal == [0.0; 3] {
            continue;
        }
        let through = pose.transform(&(cloud[0] + random.vector() * size));
        let near: f64 = normal.iter().zip(&through).map(|(n, x)| n * x).sum();
        let offset = if near.is_finite() && round % 4 != 1 { near } else { any_size(&mut random) };
        let half_space = HalfSpace { normal, offset };
        let heights: Vec<Length> = cloud.iter().map(|v| Length::above(&half_space, &pose, v, radius)).collect();
        let answer = half_space_distance(body.at(&pose), &half_space).unwrap();
        let told = || format!("{round} {cloud:?} {radius:e} {pose:?} {half_space:?} {answer:?}");
        assert!(answer.lower <= answer.distance && answer.distance <= answer.upper, "{}", told());
        assert!(answer.distance.is_finite(), "{}", told());
        assert!(heights.iter().all(|height| height.compared_with(answer.lower).is_ge()), "{}", told());
        assert!(heights.iter().any(|height| height.compared_with(answer.upper).is_le()), "{}", told());
        let is_apart = heights.iter().all(|height| height.compared_with(0.0).is_gt());
        assert_eq!(answer.outcome, if is_apart { Outcome::Separated } else { Outcome::Intersecting }, "{}", told());
        let is_least = || heights.iter().any(|height| height.compared_with(5e-324).is_lt());
        assert!(!is_apart || answer.lower > 0.0 || is_least(), "{}", told());
        // Neighbouring doubles, but for the radius.
        let width = answer.upper - answer.lower;
        let largest = answer.upper.abs().max(answer.lower.abs()).max(radius);
        assert!(width <= 4.0 * f64::EPSILON * largest + 5e-324 || largest == f64::INFINITY, "{}", told());
        seen[usize::from(is_apart)] += 1;
        let (_, points) = manifold(&body, &pose, &half_space, f64::INFINITY, false);
        assert!(!points.is_empty(), "{}", told());
        let reach = size + pose.translation().amax() + radius;
        for point in &points {
            let height = &heights[point.feature1.ids[0] as usize];
            assert!(height.lies_between(point.gap_lower, point.gap_upper), "{point:?} {}", told());
            let width = point.gap_upper - point.gap_lower;
            let largest = point.gap_lower.abs().max(point.gap_upper.abs()).max(reach);
            assert!(
                width <= 64.0 * f64::EPSILON * largest + 5e-324 || largest == f64::INFINITY,
                "{point:?} {}",
                told()
            );
        }
        points_seen += points.len();
        // The same in a scene, which looks at boxes first.
        let mut scene = Scene::new();
        let options = ObjectOptions { pose, ..ObjectOptions::default() };
        scene.add_object(vec![Arc::new(body.clone())], &options).unwrap();
        scene.prepare().unwrap();
        let (config, mut scratch) = (ManifoldConfig::default(), SetScratch::default());
        let filter = GroupFilter::default();
        let found = scene.half_space_contacts(None, &half_space, &config, filter, &mut scratch).unwrap();
        assert_eq!(found.contacts.len(), usize::from(!is_apart), "{}", told());
    }
    assert!(seen.iter().all(|&count| count > 80) && points_seen > 400, "{seen:?} {points_seen}");
}

/// The plane x + y + z = 4 in any unit that its numbers are exact in is one plane.
#[test]
fn the_length_of_a_normal_says_nothing() {
    let cube = swept(&testkit::models::cuboid([1.0; 3]).unwrap().vertices, 0.0);
    let of = |exponent: i32| {
        // 2⁻¹⁰⁷⁴ is no product of powers that are doubles.
        let unit = if exponent < -1022 { 5e-324 * 2f64.powi(exponent + 1074) } else { 2f64.powi(exponent) };
        let half_space = HalfSpace { normal: [unit; 3], offset: 4.0 * unit };
        let (_, points) = manifold(&cube, &Pose::IDENTITY, &half_space, f64::INFINITY, false);
        points.iter().map(|point| (point.id, point.gap_lower, point.gap_upper, point.world2)).collect::<Vec<_>>()
    };
    for exponent in (-1074..=1021).step_by(15).chain(-1074..-1000) {
        assert_eq!(of(exponent), of(0), "{exponent}");
    }
    let point = swept(&[Vector::zeros()], 0.0);
    let half_space = HalfSpace { normal: [0.0, 0.0, -2.0], offset: -5e-324 };
    let answer = half_space_distance(point.at(&Pose::IDENTITY), &half_space).unwrap();
    assert_eq!((answer.outcome, answer.lower, answer.upper), (Outcome::Separated, 0.0, 5e-324));
}

/// By how much a distance exceeds the radii where both are as small: their squares are no doubles.
#[test]
fn what_is_left_of_a_distance_has_its_digits() {
    for scale in [1.0, 1e-160, 1e-200, 1e-300] {
        let ball = sphere(0.5 * scale);
        for step in 1..20 {
            let height = (0..step).fold(0.5 * scale, |height, _| height.next_up());
            let answer = half_space_distance(ball.at(&at(0.0, 0.0, height)), &GROUND).unwrap();
            let truth = height - 0.5 * scale;
            assert_eq!((answer.lower, answer.upper), (truth, truth), "{scale:e} {step}");
        }
    }
}
