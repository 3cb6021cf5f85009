//! Distances beyond the doubles, less radii that make doubles of them again.

use crate::swept;
use swiftprox::error::Error;
use swiftprox::manifold::manifold;
use swiftprox::manifold::{ManifoldCache, ManifoldConfig, ManifoldPoint, half_space_manifold};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::contact;
use swiftprox::pair::{
    DepthAnswer, DepthCache, DepthConfig, HalfSpace, Outcome, PairAnswer, PairCache, PairConfig, SignedDistance,
    SignedDistanceCache, approximate, depth, distance, half_space_distance, signed_distance,
};
use swiftprox::shape::Shape;
use swiftprox::verify::{verify, verify_depth, verify_manifold};
use testkit::cases::coordinates;
use testkit::shapes::{at, lattice_box};
use testkit::swept::Length;

/// Whether an interval is the truth, or the two doubles around it: beyond the doubles the largest of them and infinity.
fn is_told(truth: &Length, [lower, upper]: [f64; 2]) -> bool {
    truth.lies_between(lower, upper) && (lower == upper || lower.next_up() == upper)
}

fn accepts(checked: Result<(), Error>) -> bool {
    // Beyond the doubles.
    matches!(checked, Ok(()) | Err(Error::Argument(_)))
}

/// Halves of odd subnormal numbers are rounded: a point with such coordinates was not its own centre, which closed forms count on.
#[test]
fn a_point_of_odd_subnormal_coordinates_is_its_own_centre() {
    for units in [1, 3, 5, 7] {
        let unit = f64::from_bits(units);
        let points = [vec![Vector::new(unit, -unit, 0.0)], vec![Vector::new(0.0, unit, 3.0 * unit)]];
        for radii in [[0.0, 0.0], [unit, 0.0], [1.0, 0.5]] {
            let bodies = [swept(&points[0], radii[0]), swept(&points[1], radii[1])];
            assert!(bodies.iter().all(|body| body.polyhedron().vertices[0].position == Vector::zeros()));
            let poses: [Pose; 2] = [at(0.0, 0.0, 0.0), at(4.0 * unit, 0.0, 0.0)];
            let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
            let (first, second) = (coordinates(&points[0]), coordinates(&points[1]));
            let (truth, _) = Length::signed([&first, &second], &poses, radii, 0);
            let mut answer = SignedDistance::default();
            let cache = &mut SignedDistanceCache::default();
            signed_distance(placed, cache, &PairConfig::default(), &mut answer).unwrap();
            assert!(truth.lies_between(answer.lower, answer.upper), "{units} {radii:?} {answer:?}");
        }
    }
}

/// What a cylinder deviates from its polyhedron takes a unit off the lower end, and leaves no upper one: the estimate was infinite,
/// and the interval had no end for the check.
#[test]
fn curved_bodies_as_far_apart_as_the_largest_double() {
    let drum = Shape::from_cylinder(1.0, 16.0, 1e-3).unwrap();
    for other in [
        Shape::from_cone(1.0, 1.0, 1e-3).unwrap(),
        swept(&[Vector::zeros()], 1.0),
        swept(&lattice_box([1.0; 3], 2), 0.0),
    ] {
        for height in [f64::MAX, f64::MAX.next_down(), f64::MAX.next_down().next_down()] {
            let poses = [at(-32.0, -32.0, -16.0), at(160.0, 0.0, height)];
            let placed = [drum.at(&poses[0]), other.at(&poses[1])];
            for query in [distance, contact, approximate] {
                let mut answer = PairAnswer::default();
                query(placed, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
                assert!(answer.outcome == Outcome::Separated && answer.distance.is_finite(), "{answer:?}");
                assert!(accepts(verify(placed, &answer)), "{answer:?}");
            }
        }
    }
}

/// Poses at the largest double and a little on the other side of the origin. Cause: an upper end that was infinite for the
/// polyhedra stayed so less the radii, beside a lower end that was no longer the largest double; `verify_manifold` refused it. A
/// manifold's sum of the largest double and the radii was infinite as a lower end. The largest double's unit is 2⁹⁷¹; the radii go
/// from 1 to 2¹⁰⁰⁰.
#[test]
fn distances_beyond_the_doubles_less_the_radii() {
    let power = |exponent: i32| 2f64.powi(exponent);
    let clouds = [vec![Vector::zeros()], vec![-Vector::x(), Vector::x()], lattice_box([1.0; 3], 2)];
    let mut seen = [0; 2];
    for (round, further) in [power(971), power(980), power(990), power(999)].into_iter().enumerate() {
        for radii in [[power(970), 0.0], [power(1000); 2], [power(971), power(990)], [further, 0.0], [1.0, 1.0]] {
            for kinds in [[0, 0], [0, 1], [1, 2], [2, 2]] {
                let points = kinds.map(|kind: usize| &clouds[kind]);
                let bodies = [swept(points[0], radii[0]), swept(points[1], radii[1])];
                let poses: [Pose; 2] = [at(f64::MAX, 0.0, 0.0), at(-further, 0.0, 0.0)];
                let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
                let (first, second) = (coordinates(points[0]), coordinates(points[1]));
                let (truth, is_exact) = Length::signed([&first, &second], &poses, radii, 0);
                assert!(is_exact);
                seen[usize::from(truth.compared_with(f64::MAX).is_gt())] += 1;
                let told = || format!("{round} {radii:?} {kinds:?}");
                for query in [distance, contact, approximate] {
                    let mut answer = PairAnswer::default();
                    query(placed, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
                    assert_eq!(answer.outcome, Outcome::Separated, "{}", told());
                    assert!(is_told(&truth, [answer.lower, answer.upper]), "{answer:?} {}", told());
                    assert!(accepts(verify(placed, &answer)), "{answer:?} {}", told());
                }
                let mut signed = SignedDistance::default();
                let cache = &mut SignedDistanceCache::default();
                signed_distance(placed, cache, &PairConfig::default(), &mut signed).unwrap();
                assert!(is_told(&truth, [signed.lower, signed.upper]), "{signed:?} {}", told());
                let config = ManifoldConfig { max_distance: f64::INFINITY, ..ManifoldConfig::default() };
                let (mut cache, mut found) = (ManifoldCache::default(), [ManifoldPoint::default(); 4]);
                let answer = manifold(placed, &mut cache, &config, &mut found).unwrap();
                assert_eq!((answer.outcome, answer.point_count), (Outcome::Separated, 1), "{}", told());
                for interval in [[answer.lower, answer.upper], [found[0].gap_lower, found[0].gap_upper]] {
                    assert!(is_told(&truth, interval), "{answer:?} {found:?} {}", told());
                }
                let checked = verify_manifold(placed, &cache, &config, &answer, &found);
                assert!(accepts(checked.clone()), "{checked:?} {answer:?} {}", told());
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 10), "{seen:?}");
}

/// The same over a half-space, of the lowest vertex and of each corner of the manifold.
#[test]
fn heights_beyond_the_doubles_less_the_radius() {
    let points = lattice_box([1.0; 3], 2);
    for (further, radius) in [(980, 990), (999, 1000), (990, 971), (971, 0)].map(|(a, b)| (2f64.powi(a), 2f64.powi(b)))
    {
        let (body, pose) = (swept(&points, radius), at(f64::MAX, 0.0, 0.0));
        let half_space = HalfSpace { normal: [1.0, 0.0, 0.0], offset: -further };
        let heights: Vec<Length> =
            points.iter().map(|point| Length::above(&half_space, &pose, point, radius)).collect();
        let answer = half_space_distance(body.at(&pose), &half_space).unwrap();
        assert!(heights.iter().any(|height| is_told(height, [answer.lower, answer.upper])), "{answer:?} {radius:e}");
        let config = ManifoldConfig { max_distance: f64::INFINITY, ..ManifoldConfig::default() };
        let mut found = [ManifoldPoint::default(); 8];
        let manifold = half_space_manifold(body.at(&pose), &half_space, &config, &mut found).unwrap();
        assert!(manifold.point_count > 0);
        for point in &found[..manifold.point_count as usize] {
            let height = &heights[point.feature1.ids[0] as usize];
            assert!(is_told(height, [point.gap_lower, point.gap_upper]), "{point:?} {radius:e}");
        }
    }
}

/// A ball at the end of the doubles, whose surface is a little beyond it: its witness point is the last double.
#[test]
fn surfaces_beyond_the_doubles_are_at_their_end() {
    let ball = swept(&[Vector::new(f64::MIN, 0.0, 0.0)], 6e293);
    let points = [[-32.0, -32.0, -32.0], [0.0, -32.0, -32.0], [-32.0, 0.0, -32.0], [-18.0, -32.0, 30.0]];
    let body = swept(&points.map(Vector::from), 0.0);
    let at = |x: f64| Pose { rows: [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] };
    for x in [f64::MIN, f64::MIN.next_up(), 0.0] {
        let poses = [Pose::IDENTITY, at(x)];
        let placed = [ball.at(&poses[0]), body.at(&poses[1])];
        let (mut cache, mut answer) = (DepthCache::default(), DepthAnswer::default());
        depth(placed, &mut cache, &DepthConfig::default(), &mut answer).unwrap();
        assert!(accepts(verify_depth(placed, &cache, &answer)), "{answer:?}");
        let surface = [answer.local1, answer.world1];
        let is_there = surface.as_flattened().iter().all(|x| x.is_finite());
        assert!(is_there || answer.outcome == Outcome::Separated, "{answer:?}");
        let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
        distance(placed, &mut cache, &PairConfig::default(), &mut answer).unwrap();
        assert!(accepts(verify(placed, &answer)), "{answer:?}");
    }
}
