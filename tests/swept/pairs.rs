//! Pair queries of swept bodies.

use crate::{capsule, sphere, swept};
use swiftprox::error::Error;
use swiftprox::manifold::manifold;
use swiftprox::manifold::{ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, CastOutcome, Motion, Moving, Screw, cast, verify_cast};
use swiftprox::pair::contact;
use swiftprox::pair::{
    DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, PairCache, PairConfig, Placed, SignedDistance,
    SignedDistanceCache, approximate, depth, distance, intersection, signed_distance,
};
use swiftprox::shape::{InputPolicy, LARGEST_SWEPT_RADIUS, Shape, ShapeOptions};
use swiftprox::verify::{verify, verify_depth};
use testkit::oracle::{Polytope, truth};
use testkit::random::Random;
use testkit::shapes::{at, cuboid};
use testkit::swept::Length;

type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<(), Error>;

fn ask(query: Query, bodies: [&Shape; 2], poses: &[Pose; 2], config: &PairConfig) -> PairAnswer {
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
    query(placed, &mut cache, config, &mut answer).unwrap();
    verify(placed, &answer).unwrap_or_else(|error| panic!("{error}: {answer:?}"));
    answer
}

/// What is proved of a depth, verified with and without the cache.
fn ask_depth(bodies: [&Shape; 2], poses: &[Pose; 2]) -> DepthAnswer {
    let (mut cache, mut answer) = (DepthCache::default(), DepthAnswer::default());
    let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
    depth(placed, &mut cache, &DepthConfig::default(), &mut answer).unwrap();
    for cache in [cache, DepthCache::default()] {
        verify_depth(placed, &cache, &answer).unwrap_or_else(|error| panic!("{error}: {answer:?}"));
    }
    answer
}

fn ask_signed(bodies: [&Shape; 2], poses: &[Pose; 2]) -> SignedDistance {
    let mut answer = SignedDistance::default();
    let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
    signed_distance(placed, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut answer).unwrap();
    answer
}

fn clouds(random: &mut Random) -> Vec<Vec<Vector>> {
    let counts = [1, 2, 3, 4, 8];
    counts.iter().map(|&count| (0..count).map(|_| random.vector()).collect()).collect()
}

/// Of points, segments, triangles and hulls that are apart as such: verdict and interval, for radii around their distance.
#[test]
fn intervals_hold_the_distance_less_the_radii() {
    let mut random = Random::new(0x5be1);
    let mut seen = [0; 2];
    for round in 0..60 {
        let clouds = clouds(&mut random);
        let points = [&clouds[round % 5], &clouds[round / 5 % 5]];
        let poses = [0, 1].map(|i| Pose::new(&random.rotation(), &Vector::new(4.0 * f64::from(i), 0.0, 0.0)));
        let [first, second] =
            points.map(|points| Polytope::new(&points.iter().map(|p| (*p).into()).collect::<Vec<[f64; 3]>>()));
        let rows = poses.map(|pose| std::array::from_fn(|k| pose.rows[k / 4][k % 4]));
        let of_polytopes = truth(&first, &rows[0], &second, &rows[1]);
        let apart = of_polytopes.squared_distance.to_f64().value().sqrt();
        for share in [0.3, 0.999_999, 1.0, 1.000_001, 1.7] {
            let part = random.uniform(0.0, 1.0);
            let radii = [part * share * apart, (1.0 - part) * share * apart];
            let bodies = [swept(points[0], radii[0]), swept(points[1], radii[1])];
            let bodies = [&bodies[0], &bodies[1]];
            let length = Length::between(&of_polytopes, radii);
            let at_least = |bound: f64| length.compared_with(bound).is_ge();
            let at_most = |bound: f64| length.compared_with(bound).is_le();
            let is_apart = length.compared_with(0.0).is_gt();
            seen[usize::from(is_apart)] += 1;
            let outcome = if is_apart { Outcome::Separated } else { Outcome::Intersecting };
            let exact = PairConfig::default();
            for query in [distance as Query, contact, approximate, intersection] {
                let answer = ask(query, bodies, &poses, &exact);
                assert_eq!(answer.outcome, outcome, "{answer:?}");
                assert!(!is_apart || (answer.lower > 0.0 && at_least(answer.lower)), "{answer:?}");
                assert!(!is_apart || answer.upper == f64::INFINITY || at_most(answer.upper), "{answer:?}");
            }
            let near = ask(distance, bodies, &poses, &exact);
            assert!(near.upper - near.lower < 1e-13, "{near:?}");
            let signed = ask_signed(bodies, &poses);
            assert_eq!((signed.outcome, signed.lower > 0.0), (outcome, is_apart));
            assert!(at_least(signed.lower) && at_most(signed.upper) && signed.upper - signed.lower < 1e-13);
            let [world1, world2, normal] = [signed.world1, signed.world2, signed.normal].map(Vector::from);
            assert!((world1 - world2 - normal * signed.distance).norm() < 1e-12, "{signed:?}");
            let deep = ask_depth(bodies, &poses);
            assert_eq!(deep.outcome, outcome);
            assert!(is_apart || (at_least(-deep.upper) && at_most(-deep.lower)), "{deep:?}");
            // On either side of what it is.
            for tolerance in [0.5 * near.upper, 2.0 * near.upper] {
                let config = PairConfig { max_distance: tolerance, ..exact };
                let answer = ask(distance, bodies, &poses, &config);
                let is_beyond = is_apart && !at_most(tolerance);
                assert_eq!(answer.outcome, if is_beyond { Outcome::Beyond } else { outcome }, "{answer:?}");
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 90), "{seen:?}");
}

/// Where doubles cannot tell: spheres in the distance 5 of a triangle of sides 3 and 4, and a unit in the last place beside it.
#[test]
fn touching_is_decided_in_integers() {
    let poses = [at(0.0, 0.0, 0.0), at(3.0, 4.0, 0.0)];
    for (radii, outcome) in [
        ([2.0, 3.0], Outcome::Intersecting),
        ([2.0, 3.0_f64.next_down()], Outcome::Separated),
        ([2.0, 3.0_f64.next_up()], Outcome::Intersecting),
        ([2.5, 2.5], Outcome::Intersecting),
        ([2.5, 2.5_f64.next_down()], Outcome::Separated),
        // No double holds the sum.
        ([1e-20, 5.0], Outcome::Intersecting),
        ([1e-20, 5.0_f64.next_down()], Outcome::Separated),
    ] {
        let bodies = radii.map(sphere);
        let bodies = [&bodies[0], &bodies[1]];
        let [near, touching] =
            [distance as Query, contact].map(|query| ask(query, bodies, &poses, &PairConfig::default()));
        assert_eq!((near.outcome, touching.outcome), (outcome, outcome), "{radii:?}");
        let deep = ask_depth(bodies, &poses);
        assert_eq!(deep.outcome, outcome);
        if radii == [2.0, 3.0] || radii == [2.5, 2.5] {
            assert_eq!((deep.lower, deep.upper), (0.0, 0.0));
            let [world1, world2] = [touching.world1, touching.world2].map(Vector::from);
            assert!((world1 - world2).norm() < 4e-15, "{touching:?}");
        }
        if outcome == Outcome::Separated {
            assert!(near.lower > 0.0 && near.upper < 1e-15 && near.upper <= near.lower * 1.01, "{near:?}");
        }
    }
}

/// Polyhedra in each other: the radii deeper.
#[test]
fn depths_are_deeper_by_the_radii() {
    let mut random = Random::new(0x5be2);
    let mut overlapping = 0;
    for _ in 0..60 {
        let clouds = clouds(&mut random);
        let points = [&clouds[3 + random.below(2)], &clouds[random.below(5)]];
        let poses = [0, 1].map(|_| Pose::new(&random.rotation(), &(random.vector() * 0.05)));
        let radii = [random.uniform(0.1, 2.0), 0.3];
        let plain = [swept(points[0], 0.0), swept(points[1], 0.0)];
        let bodies = [swept(points[0], radii[0]), swept(points[1], radii[1])];
        let signed = ask_signed([&plain[0], &plain[1]], &poses);
        if signed.outcome != Outcome::Intersecting {
            continue;
        }
        overlapping += 1;
        let deep = ask_depth([&bodies[0], &bodies[1]], &poses);
        let sum = radii[0] + radii[1];
        assert!((deep.depth - (sum - signed.distance)).abs() < 1e-13, "{deep:?} {signed:?}");
        assert!(deep.upper - deep.lower < 1e-13);
        let touching = ask(contact, [&bodies[0], &bodies[1]], &poses, &PairConfig::default());
        assert_eq!(touching.outcome, Outcome::Intersecting);
    }
    assert!(overlapping > 15, "{overlapping}");
}

/// A pair whose polyhedra come and go, and others with the same cache: each depth is that of a cold cache.
#[test]
fn kept_features_change_no_depth() {
    let mut random = Random::new(0x5be3);
    let (mut seen, mut cache) = ([0; 2], DepthCache::default());
    for _ in 0..40 {
        let clouds = clouds(&mut random);
        let points = [&clouds[4], &clouds[random.below(5)]];
        let bodies = [swept(points[0], 0.3), swept(points[1], 0.8)];
        let turn = random.rotation();
        for step in 0..20 {
            let way = Vector::new(0.15 * f64::from(step), 0.1, 0.0);
            let other = if step % 2 == 0 { Matrix::identity() } else { random.rotation() };
            let poses = [Pose::new(&turn, &Vector::zeros()), Pose::new(&other, &way)];
            let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
            let mut warm = DepthAnswer::default();
            depth(placed, &mut cache, &DepthConfig::default(), &mut warm).unwrap();
            verify_depth(placed, &cache, &warm).unwrap_or_else(|error| panic!("{error}: {warm:?}"));
            let cold = ask_depth([&bodies[0], &bodies[1]], &poses);
            assert_eq!(warm.outcome, cold.outcome);
            assert!(warm.lower <= cold.upper && cold.lower <= warm.upper, "{warm:?} {cold:?}");
            assert!(warm.upper - warm.lower < 1e-12, "{warm:?}");
            seen[usize::from(warm.depth > 1.1)] += usize::from(warm.outcome == Outcome::Intersecting);
        }
    }
    // Polyhedra that are apart, and such as overlap.
    assert!(seen.iter().all(|count| *count > 50), "{seen:?}");
}

/// A capsule that lies on a table has two points, a cube with round edges four, each with a gap of what it is above it.
#[test]
fn manifolds_are_those_of_the_polyhedra_moved_to_the_surfaces() {
    let table = cuboid([4.0, 4.0, 0.5]);
    // As narrow as intervals of this size are promised to be.
    let width = 2e-14 * 8.0;
    let turned = Matrix::new(0.8, -0.6, 0.0, 0.6, 0.8, 0.0, 0.0, 0.0, 1.0);
    let corners = testkit::models::cuboid([0.5; 3]).unwrap().vertices;
    for (body, count, half) in [(capsule(1.0, 0.25), 2, 0.0), (swept(&corners, 0.25), 4, 0.5), (sphere(0.25), 1, 0.0)] {
        for above in [0.125, 0.0, -0.125, -0.5] {
            let height = 0.5 + 0.25 + half + above;
            let poses = [Pose::new(&turned, &Vector::new(0.25, 0.0, height)), Pose::IDENTITY];
            let mut points = [ManifoldPoint::default(); 8];
            let config = ManifoldConfig { max_distance: 0.25, ..ManifoldConfig::default() };
            let bodies = [body.at(&poses[0]), table.at(&poses[1])];
            let found = manifold(bodies, &mut ManifoldCache::default(), &config, &mut points).unwrap();
            assert_eq!((found.point_count, found.found_count), (count, count), "{above} {found:?}");
            assert_eq!(found.outcome == Outcome::Separated, above > 0.0);
            assert!(found.lower <= above && above <= found.upper && found.upper - found.lower < width, "{found:?}");
            for point in &points[..count as usize] {
                assert!(point.gap_lower <= above && above <= point.gap_upper, "{point:?}");
                assert!(point.gap_upper - point.gap_lower < 1e-12);
                assert!((point.world1[2] - (0.5 + above)).abs() < 1e-14 && (point.world2[2] - 0.5).abs() < 1e-14);
                let again = poses[0].transform(&Vector::from(point.local1)) - Vector::from(point.world1);
                assert!(again.norm() < 1e-14);
            }
        }
    }
}

/// A pose may be off a rotation by a hundredth: the ball stays round, and local points are where the pose takes to the world's.
#[test]
fn a_pose_does_not_stretch_the_ball() {
    let stretched = Matrix::from_diagonal(&Vector::new(1.004, 0.997, 1.001));
    let poses = [Pose::new(&stretched, &Vector::new(0.0, 0.0, 0.0)), at(0.0, 3.0, 0.0)];
    let bodies = [sphere(1.0), sphere(0.5)];
    let answer = ask(distance, [&bodies[0], &bodies[1]], &poses, &PairConfig::default());
    assert!(answer.lower <= 1.5 && 1.5 <= answer.upper && answer.upper - answer.lower < 1e-14, "{answer:?}");
    assert!((answer.local1[1] - 1.0 / 0.997).abs() < 1e-15, "{answer:?}");
}

/// A lie about any number is found out.
#[test]
fn verify_refuses_what_is_not_so() {
    let poses = [at(0.0, 0.0, 0.0), at(3.0, 0.5, 0.25)];
    let bodies = [capsule(0.5, 0.5), sphere(0.75)];
    let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
    let told = ask(distance, [&bodies[0], &bodies[1]], &poses, &PairConfig::default());
    let lies = [
        PairAnswer { lower: told.upper.next_up(), distance: told.upper.next_up(), upper: 2.0, ..told },
        PairAnswer { upper: told.lower.next_down(), distance: 0.5, lower: 0.5, ..told },
        PairAnswer { world1: told.world2, ..told },
        // The points of the segment and of the centre.
        PairAnswer { local1: [0.5, 0.0, 0.0], world1: [0.5, 0.0, 0.0], ..told },
        PairAnswer { normal: [0.0, 0.0, 1.0], ..told },
        PairAnswer { outcome: Outcome::Intersecting, lower: 0.0, upper: 0.0, distance: 0.0, ..told },
    ];
    for lie in lies {
        assert!(matches!(verify(placed, &lie), Err(Error::Unverified(_))), "{lie:?}");
    }
    let poses = [at(0.0, 0.0, 0.0), at(1.5, 0.0, 0.0)];
    let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
    let told = ask_depth([&bodies[0], &bodies[1]], &poses);
    assert!(told.lower <= 0.25 && 0.25 <= told.upper && told.upper - told.lower < 1e-14);
    for lie in [
        DepthAnswer { lower: told.upper.next_up(), depth: told.upper.next_up(), upper: 1.0, ..told },
        DepthAnswer { lower: 0.0, depth: 0.0, upper: told.lower.next_down(), ..told },
        DepthAnswer { lower: 0.0, depth: 0.0, upper: 0.0, ..told },
        DepthAnswer { local2: [0.0; 3], world2: [1.5, 0.0, 0.0], ..told },
    ] {
        assert!(matches!(verify_depth(placed, &DepthCache::default(), &lie), Err(Error::Unverified(_))), "{lie:?}");
    }
}

/// A ball flies at a wall: 10 to go at 4 a unit of time, of which the radii take 1.
#[test]
fn a_cast_hits_with_the_surface() {
    let (ball, wall) = (sphere(0.75), swept(&testkit::models::cuboid([0.5, 3.0, 3.0]).unwrap().vertices, 0.25));
    let flight = Motion::Screw(Screw {
        start: at(-11.0, 0.5, 0.0),
        centre: Vector::zeros(),
        velocity: Vector::new(4.0, 0.0, 0.0),
        rotation: Vector::zeros(),
    });
    let still = Motion::Fixed(Pose::IDENTITY);
    let pair = || [Moving { shape: &ball, motion: &flight }, Moving { shape: &wall, motion: &still }];
    let config = CastConfig { time_end: 5.0, ..CastConfig::default() };
    let mut answer = CastAnswer::default();
    cast(pair(), &mut PairCache::default(), &config, &mut answer).unwrap();
    let first = (11.0 - 0.5 - 0.75 - 0.25) / 4.0;
    assert_eq!(answer.outcome, CastOutcome::Hit);
    assert!(
        answer.time_lower < first && first <= answer.time_upper && answer.time_upper - answer.time_lower < 1e-8,
        "{answer:?}"
    );
    verify_cast(pair(), &config, &answer).unwrap();
}

#[test]
fn what_is_no_radius_is_refused() {
    let points = [Vector::zeros()];
    let with = |swept_radius, scale| {
        let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, scale, ..ShapeOptions::default() };
        Shape::from_points(&points, &options)
    };
    for radius in [-1.0, f64::NAN, f64::INFINITY, LARGEST_SWEPT_RADIUS.next_up()] {
        let refused = with(radius, 1.0).unwrap_err();
        assert!(matches!(&refused, Error::Argument(message) if message.contains("swept_radius")), "{refused}");
    }
    assert!(matches!(with(LARGEST_SWEPT_RADIUS, 4.0), Err(Error::Argument(_))));
    assert_eq!(with(0.5, 4.0).unwrap().swept_radius(), 2.0);
}
