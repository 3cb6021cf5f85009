//! Points and segments with one another, with balls swept over them, against distances in rational numbers.

use crate::{capsule, sphere, swept};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::contact;
use swiftprox::pair::{
    DecidedBy, DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, PairCache, PairConfig, SignedDistance,
    SignedDistanceCache, depth, distance, intersection, signed_distance,
};
use swiftprox::shape::Shape;
use swiftprox::verify::{verify, verify_depth};
use testkit::oracle::{Polytope, truth};
use testkit::random::Random;
use testkit::swept::Length;

/// Ends of a point or a segment, of a family: any, with whole coordinates, of no length to speak of, along an axis.
fn ends(random: &mut Random, family: usize, size: f64) -> Vec<Vector> {
    let mut any = || match family {
        1 => Vector::from_fn(|_, _| random.uniform(-2.5, 2.5).round()),
        _ => random.vector(),
    };
    let (first, second) = (any(), any());
    let second = match family {
        0 => return vec![first * size],
        2 => first + second * 1e-300,
        3 => Vector::new(-first.x, first.y, first.z),
        _ => second,
    };
    if first == second { vec![first * size] } else { vec![first * size, second * size] }
}

/// Verdict, intervals, points and normals of every query hold: for pairs that touch, cross, are parallel or nearly so, of no
/// length, tiny, huge and of skewed poses.
#[test]
fn all_queries_say_what_rationals_say() {
    let mut random = Random::new(0x0b11);
    let (mut by_marching, mut seen) = (0, [0; 2]);
    for round in 0..if cfg!(miri) { 8 } else { 1_500 } {
        let size = [1.0, 1.0, 1.0, 1e-300, 1e150, 1e-60, 1e60][round % 7];
        let family = [round % 5, round / 5 % 5];
        let mut points = family.map(|family| ends(&mut random, family, size));
        // Parallel, with and without the rounding of a turn.
        if round % 6 == 0 && points[0].len() == 2 {
            let aside = random.vector() * size;
            points[1] = points[0].iter().map(|end| end + aside).collect();
        }
        let poses = [0, 1].map(|_| {
            let mut rotation = if round % 4 == 0 { Matrix::identity() } else { random.rotation() };
            if round % 3 == 0 {
                rotation *= 1.0 + random.uniform(-4e-3, 4e-3);
            }
            let whole = Vector::from_fn(|_, _| random.uniform(-2.5, 2.5).round());
            Pose::new(&rotation, &(if round % 2 == 0 { whole } else { random.vector() } * size))
        });
        let polytopes = points
            .each_ref()
            .map(|points| Polytope::new(&points.iter().map(|p| (*p).into()).collect::<Vec<[f64; 3]>>()));
        let rows = poses.map(|pose| std::array::from_fn(|k| pose.rows[k / 4][k % 4]));
        let apart = truth(&polytopes[0], &rows[0], &polytopes[1], &rows[1]);
        let about = apart.squared_distance.to_f64().value().sqrt();
        for share in [0.0, 0.5, 1.0, 1.5] {
            let part = random.uniform(0.1, 0.9);
            let radii = [part, 1.0 - part].map(|part| (part * share * about).min(1e100));
            let bodies = [swept(&points[0], radii[0]), swept(&points[1], radii[1])];
            let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
            let length = Length::between(&apart, radii);
            let is_apart = length.compared_with(0.0).is_gt();
            seen[usize::from(is_apart)] += 1;
            let outcome = if is_apart { Outcome::Separated } else { Outcome::Intersecting };
            for query in [distance, intersection, contact] {
                let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
                query(placed, &mut cache, &PairConfig::default(), &mut answer).unwrap();
                verify(placed, &answer).unwrap_or_else(|error| panic!("{round}: {error}: {answer:?}"));
                assert_eq!(answer.outcome, outcome, "{round} {share}: {answer:?}");
                let [lower, upper] = [answer.lower, answer.upper];
                assert!(!is_apart || length.lies_between(lower, upper), "{round} {share}: {answer:?}");
                by_marching += u32::from(answer.decided_by == DecidedBy::Marching);
            }
            let mut signed = SignedDistance::default();
            signed_distance(placed, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut signed).unwrap();
            assert_eq!(signed.outcome, outcome, "{round} {share}: {signed:?}");
            // Of segments that meet, the bodies may be deeper than the radii.
            let holds = if apart.intersecting() {
                length.compared_with(signed.lower).is_ge()
            } else {
                length.lies_between(signed.lower, signed.upper)
            };
            assert!(holds, "{round} {share}: {signed:?}");
            let (mut cache, mut deep) = (DepthCache::default(), DepthAnswer::default());
            depth(placed, &mut cache, &DepthConfig::default(), &mut deep).unwrap();
            assert_eq!(deep.outcome, outcome, "{round} {share}: {deep:?}");
            verify_depth(placed, &cache, &deep).unwrap_or_else(|error| panic!("{round}: {error}: {deep:?}"));
        }
    }
    assert!(seen.iter().all(|&count| count > 500 || cfg!(miri)), "{seen:?}");
    assert!(by_marching > 6_000 || cfg!(miri), "{by_marching}");
}

/// Of spheres and capsules at common places no integers are asked, and no search is made.
#[test]
fn doubles_tell_what_round_bodies_are_to_each_other() {
    let mut random = Random::new(0x0b12);
    let bodies = [sphere(0.3), capsule(0.5, 0.2)];
    for round in 0..if cfg!(miri) { 8 } else { 2_000 } {
        let pair: [&Shape; 2] = [&bodies[round % 2], &bodies[round / 2 % 2]];
        let poses = [0, 1].map(|_| Pose::new(&random.rotation(), &(random.direction() * random.uniform(0.2, 1.0))));
        let placed = [pair[0].at(&poses[0]), pair[1].at(&poses[1])];
        let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
        distance(placed, &mut cache, &PairConfig::default(), &mut answer).unwrap();
        verify(placed, &answer).unwrap();
        assert_eq!((answer.decided_by, answer.statistics.exact_iterations), (DecidedBy::Marching, 0), "{answer:?}");
        assert_eq!(cache, PairCache::default());
    }
}

/// Balls and points so near that the square of their distance underflows. Cause: that of two balls was taken for right to rounding,
/// and balls apart by 2e-166 were told to intersect, from distances of 1e-161 down.
#[test]
fn tiny_balls_are_told_apart() {
    for exponent in [-70, -100, -140, -155, -160, -161, -162, -163, -165, -200, -290, -300, -306] {
        let unit = 10.0_f64.powi(exponent);
        for share in [0.0, 0.2, 0.45, 0.49999, 0.50001, 0.6, 3.0] {
            let ball = swept(&[Vector::zeros()], share * unit);
            let there = Pose::new(&Matrix::identity(), &Vector::new(unit, 0.0, 0.0));
            let bodies = [ball.at(&Pose::IDENTITY), ball.at(&there)];
            let expected = if share < 0.5 { Outcome::Separated } else { Outcome::Intersecting };
            let (mut answer, mut signed) = (PairAnswer::default(), SignedDistance::default());
            intersection(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
            signed_distance(bodies, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut signed).unwrap();
            let told = || format!("{exponent} {share} {answer:?} {signed:?}");
            assert_eq!([answer.outcome, signed.outcome], [expected; 2], "{}", told());
            let (truth, slack) = (unit * (1.0 - 2.0 * share), unit * 1e-14);
            assert!(signed.lower <= truth + slack && signed.upper >= truth - slack, "{}", told());
        }
    }
}

/// A ball deep in a hull, or the ball about a capsule's middle, decides the verdict at a glance where it and the ball in the hull
/// overlap: a cube of half side 1, so that they do where the centres are nearer than 1 and the radius.
#[test]
fn balls_in_bodies_that_are_deep_decide_the_verdict() {
    let mut random = Random::new(0x0b12);
    let cube = testkit::shapes::cuboid([1.0; 3]);
    let radius = 0.25;
    for (round, body) in [sphere(radius), capsule(0.7, radius)].iter().cycle().take(400).enumerate() {
        let skew = if round % 3 == 0 { 1.0 - 4e-3 } else { 1.0 };
        let reach = 1.25 * [0.3, 0.9, 1.0 - 1e-10, 1.0 + 1e-10, 1.2][round % 5];
        let place = random.vector() * 10.0;
        let poses = [place, place + random.direction() * reach].map(|at| Pose::new(&(random.rotation() * skew), &at));
        let bodies = [cube.at(&poses[0]), body.at(&poses[1])];
        let mut answer = PairAnswer::default();
        intersection(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
        // The pose stretches the cube, and no ball.
        let overlap = reach < skew + radius;
        let is_decided = answer.decided_by == DecidedBy::InscribedSpheres;
        assert!(overlap || !is_decided, "{round}: {answer:?}");
        assert!(is_decided || !overlap || skew < 1.0 && reach > 1.2, "{round}: {answer:?}");
        if overlap {
            assert_eq!(answer.outcome, Outcome::Intersecting, "{round}");
        }
        verify(bodies, &answer).unwrap();
    }
}
