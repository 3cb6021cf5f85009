//! The checks of answers about round bodies at poses that stretch and shrink: what queries say passes, and no interval does that
//! excludes the truth by one double. The truth is in rational numbers or closed form.

use crate::{sphere, swept};
use swiftprox::error::Error;
use swiftprox::manifold::manifold;
use swiftprox::manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, CastOutcome, Motion, Moving, cast, verify_cast};
use swiftprox::pair::contact;
use swiftprox::pair::{
    DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, PairCache, PairConfig, Placed, approximate, depth,
    distance, intersection,
};
use swiftprox::shape::Shape;
use swiftprox::verify::{verify, verify_depth, verify_manifold};
use testkit::cases::coordinates;
use testkit::forgery;
use testkit::random::{Random, rotation};
use testkit::shapes::{at, cuboid};
use testkit::swept::Length;

/// Turns that are off a rotation by up to what is accepted: not, as single precision is, evenly, along axes, in every entry.
fn skewed(random: &mut Random, kind: usize) -> Matrix {
    let turn = random.rotation();
    let off = random.pick(&[1e-12, 1e-9, 1e-6, 1e-3]) * random.pick(&[1.0, -1.0]);
    match kind % 5 {
        0 => turn,
        1 => turn.map(|x| f64::from(x as f32)),
        2 => turn * (1.0 + 4.0 * off),
        3 => turn * Matrix::from_diagonal(&Vector::new(1.0 + 4.0 * off, 1.0, 1.0 - 2.0 * off)),
        _ => turn + Matrix::from_fn(|_, _| off * random.signed()),
    }
}

struct Case {
    points: [Vec<Vector>; 2],
    bodies: [Shape; 2],
    poses: [Pose; 2],
}

impl Case {
    /// Points, segments, triangles, tetrahedra and hulls of eight points, one up to 10⁴ times as large as the other, apart or in
    /// each other; and radii around their distance.
    fn new(random: &mut Random, round: usize) -> Case {
        let counts = [1, 2, 3, 4, 8];
        let sizes = [1.0, random.pick(&[1.0, 1e-2, 1e-4])];
        let thin = Vector::new(1.0, random.pick(&[1.0, 1e-3, 1e-6]), 1.0);
        let points = [counts[round % 5], counts[round / 5 % 5]];
        let points = [0, 1].map(|i| (0..points[i]).map(|_| random.vector().component_mul(&thin) * sizes[i]).collect());
        let apart = random.direction() * sizes[round / 25 % 2] * random.uniform(0.0, 3.0);
        let far = random.vector() * random.pick(&[0.0, 1.0, 1e3]);
        let poses = [Pose::new(&skewed(random, round), &far), Pose::new(&skewed(random, round / 5), &(far + apart))];
        let hulls = points.each_ref().map(|points: &Vec<Vector>| swept(points, 0.0));
        let near = ask(distance, [hulls[0].at(&poses[0]), hulls[1].at(&poses[1])]).distance;
        let sum =
            random.pick(&[0.25, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.7, 20.0]) * if near > 0.0 { near } else { sizes[1] };
        let any = random.uniform(0.0, 1.0);
        let part = random.pick(&[0.0, 0.5, 1.0, any]);
        let bodies = [swept(&points[0], part * sum), swept(&points[1], (1.0 - part) * sum)];
        Case { points, bodies, poses }
    }

    fn placed(&self) -> [Placed<'_>; 2] {
        [self.bodies[0].at(&self.poses[0]), self.bodies[1].at(&self.poses[1])]
    }

    fn truth(&self) -> Length {
        let points = self.points.each_ref().map(|points| coordinates(points));
        let radii = self.bodies.each_ref().map(Shape::swept_radius);
        let (truth, is_exact) = Length::signed([&points[0], &points[1]], &self.poses, radii, 400);
        assert!(is_exact);
        truth
    }
}

type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<(), Error>;

fn ask(query: Query, bodies: [Placed; 2]) -> PairAnswer {
    let mut answer = PairAnswer::default();
    query(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
    answer
}

fn ask_depth(bodies: [Placed; 2]) -> (DepthAnswer, DepthCache) {
    let (mut answer, mut cache) = (DepthAnswer::default(), DepthCache::default());
    depth(bodies, &mut cache, &DepthConfig::default(), &mut answer).unwrap();
    (answer, cache)
}

fn ask_manifold(bodies: [Placed; 2], config: &ManifoldConfig) -> (Manifold, Vec<ManifoldPoint>, ManifoldCache) {
    let (mut points, mut cache) = (vec![ManifoldPoint::default(); 64], ManifoldCache::default());
    let found = manifold(bodies, &mut cache, config, &mut points).unwrap();
    points.truncate(found.point_count as usize);
    (found, points, cache)
}

/// Whether an answer is found not to hold; other refusals are none.
fn is_refused(checked: Result<(), Error>) -> bool {
    match checked {
        Ok(()) => false,
        Err(Error::Unverified(_)) => true,
        Err(error) => panic!("{error}"),
    }
}

/// Of any kinds of bodies and poses. Cause: points of bodies that intersect by their radii were measured in the body's own frame,
/// where the ball is not round; so half of all contacts at poses that shrink were refused, and points out of the ball passed at
/// such as stretch. The common point of thin bodies that are nearly parallel was two, as much as 1e-8 of the radius apart.
#[test]
fn what_queries_say_passes_and_one_double_beyond_the_truth_does_not() {
    let mut random = Random::new(0x5ed1);
    let (mut passed, mut refused, mut outcomes) = ([0; 3], [0; 3], [0; 5]);
    for round in 0..600 {
        let case = Case::new(&mut random, round);
        let (bodies, truth) = (case.placed(), case.truth());
        let told = || {
            format!("{round}: {:?} {:?} {:?}", case.points, case.bodies.each_ref().map(Shape::swept_radius), case.poses)
        };
        for query in [distance as Query, contact, approximate, intersection] {
            let answer = ask(query, bodies);
            verify(bodies, &answer).unwrap_or_else(|error| panic!("{error}: {answer:?} {}", told()));
            passed[0] += 1;
            outcomes[answer.outcome as usize] += 1;
            let holds = truth.lies_between(answer.lower, answer.upper) || answer.outcome == Outcome::Intersecting;
            assert!(
                holds && (answer.outcome == Outcome::Separated) == truth.compared_with(0.0).is_gt(),
                "{answer:?} {}",
                told()
            );
            for forged in forgery::pairs(&answer, &truth) {
                assert!(is_refused(verify(bodies, &forged)), "{forged:?} {}", told());
                refused[0] += 1;
            }
            // The normal of what says no points separates, and need not be along the shortest connection.
            if answer.outcome == Outcome::Separated && answer.local1[0].is_finite() {
                let [below, above] = truth.beside([answer.lower, answer.upper]);
                // The truth itself, where it is a double.
                let next = below.next_up();
                let (lower, upper) = if next < above { (next, next) } else { (below, above) };
                let tight = PairAnswer { lower, distance: lower, upper, ..answer };
                assert_eq!(verify(bodies, &tight), Ok(()), "{tight:?} {}", told());
            }
        }
        let (answer, own) = ask_depth(bodies);
        for cache in [own, DepthCache::default()] {
            verify_depth(bodies, &cache, &answer).unwrap_or_else(|error| panic!("{error}: {answer:?} {}", told()));
            passed[1] += 1;
            for forged in forgery::depths(&answer, &truth) {
                assert!(is_refused(verify_depth(bodies, &cache, &forged)), "{forged:?} {}", told());
                refused[1] += 1;
            }
        }
        for max_distance in [0.0, 0.5] {
            let config = ManifoldConfig { max_distance, ..ManifoldConfig::default() };
            let (found, points, cache) = ask_manifold(bodies, &config);
            let check = |found: &Manifold| verify_manifold(bodies, &cache, &config, found, &points);
            check(&found).unwrap_or_else(|error| panic!("{error}: {found:?} {points:?} {}", told()));
            passed[2] += 1;
            for forged in forgery::manifolds(&found, &truth) {
                assert!(is_refused(check(&forged)), "{forged:?} {}", told());
                refused[2] += 1;
            }
        }
    }
    println!("{passed:?} passed, {refused:?} refused, {outcomes:?}");
    assert!(outcomes[Outcome::Separated as usize] > 600 && outcomes[Outcome::Intersecting as usize] > 600);
    assert!(refused.iter().all(|&count| count > 1_000), "{refused:?}");
}

/// A point in a square with a ball of 1/2 swept over it is 1/2 deep: no less, not by one double. Cause: less than the radii left
/// less than nothing for the polyhedra, which counted as touching. It showed from one double to 45 % too little, where the
/// witness points gave it away, as what a manifold said of the depth, not as a depth.
#[test]
fn a_manifold_is_not_less_deep_than_its_radii() {
    let square = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]].map(Vector::from);
    let (point, plate) = (swept(&[Vector::zeros()], 0.0), swept(&square, 0.5));
    let bodies = [point.at(&Pose::IDENTITY), plate.at(&Pose::IDENTITY)];
    let config = ManifoldConfig::default();
    let (found, points, cache) = ask_manifold(bodies, &config);
    let check =
        |lower: f64, upper: f64| verify_manifold(bodies, &cache, &config, &Manifold { lower, upper, ..found }, &points);
    assert_eq!((found.lower, found.upper, check(-0.5, -0.5)), (-0.5, -0.5, Ok(())));
    let mut less = 0.5_f64.next_down();
    while less > 0.0 {
        assert!(is_refused(check(-less, -less)) && is_refused(check(-less, 0.0)), "{less:e}");
        let deeper = 0.5 + 2.0 * (0.5 - less);
        assert!(is_refused(check(-deeper, -deeper)), "{deeper:e}");
        less = 0.5 - 3.0 * (0.5 - less);
    }
}

/// A ball of radius 1/2 about (1.25, 0, 0) in a cube that ends at x = 1: they have the points from 0.75 to 1 on the axis in common,
/// however the pose stretches the axis. Cause: the radius was measured in the ball's own frame.
#[test]
fn the_ball_is_round_in_the_world() {
    let (ball, cube) = (sphere(0.5), cuboid([1.0; 3]));
    let (mut off, mut seen) = (1e-15, 0);
    while off < 5e-3 {
        for skew in [off, -off] {
            let mut pose = at(1.25, 0.0, 0.0);
            pose.rows[0][0] += skew;
            let bodies = [ball.at(&pose), cube.at(&Pose::IDENTITY)];
            let told = ask(contact, bodies);
            assert_eq!((told.outcome, verify(bodies, &told)), (Outcome::Intersecting, Ok(())), "{skew:e} {told:?}");
            let point_at = |x: f64| {
                let local1 = [(x - 1.25) / pose.rows[0][0], 0.0, 0.0];
                verify(
                    bodies,
                    &PairAnswer { local1, world1: [x, 0.0, 0.0], local2: [x, 0.0, 0.0], world2: [x, 0.0, 0.0], ..told },
                )
            };
            assert_eq!((point_at(0.75), point_at(1.0)), (Ok(()), Ok(())), "{skew:e}");
            assert!(is_refused(point_at(0.75 - 1e-12)) && is_refused(point_at(1.0 + 1e-12)), "{skew:e}");
            // Touching at (1, 0, 0).
            let mut pose = at(1.5, 0.0, 0.0);
            pose.rows[0][0] += skew;
            let bodies = [ball.at(&pose), cube.at(&Pose::IDENTITY)];
            let told = ask(contact, bodies);
            assert_eq!((told.outcome, verify(bodies, &told)), (Outcome::Intersecting, Ok(())), "{skew:e} {told:?}");
            assert_eq!(told.world1, [1.0, 0.0, 0.0]);
            seen += 1;
        }
        off *= 3.0;
    }
    assert!(seen > 40);
}

/// A cube that turns while its pose's entries change linearly is smaller in between; a ball that rests is hit all the same, and
/// each hit is proved. Cause: as above; all 200 were refused.
#[test]
fn casts_of_balls_at_cubes_that_are_distorted_pass() {
    let (ball, cube) = (sphere(0.5), cuboid([1.0; 3]));
    let still = Motion::Fixed(Pose::IDENTITY);
    for k in 0..200 {
        let (height, angle) = (-0.9 + 0.009 * f64::from(k), 0.05 + 0.0007 * f64::from(k));
        let end = Pose::new(&rotation(&Vector::z(), angle), &Vector::new(0.0, height, 0.0));
        let motion = Motion::Affine { start: at(3.0, height, 0.0), end };
        for (shapes, motions) in [([&ball, &cube], [&motion, &still]), ([&cube, &ball], [&motion, &still])] {
            let pair = [0, 1].map(|i| Moving { shape: shapes[i], motion: motions[i] });
            let mut answer = CastAnswer::default();
            cast(pair, &mut PairCache::default(), &CastConfig::default(), &mut answer).unwrap();
            let checked = verify_cast(pair, &CastConfig::default(), &answer);
            assert_eq!((answer.outcome, checked), (CastOutcome::Hit, Ok(())), "{k} {answer:?}");
        }
    }
}

/// Thin bodies that are nearly parallel: where they are nearest is hardly told along them, and the normal is off the line between
/// the two places. Cause: the common point was looked for along the normal, from either, and was two points.
#[test]
fn thin_bodies_have_a_common_point() {
    let mut random = Random::new(0x9e3d1e);
    let mut seen = 0;
    for round in 0..400 {
        let thin = Vector::new(1.0, 1e-5, 1e-5);
        let mut needle = || -> Vec<Vector> { (0..6).map(|_| random.direction().component_mul(&thin)).collect() };
        let (first, second) = (needle(), needle());
        let radius = random.uniform(0.3, 1.0);
        let bodies = [swept(&first, radius), swept(&second, if round % 2 == 0 { 0.0 } else { 0.1 })];
        let turn = skewed(&mut random, round);
        let beside = turn * rotation(&random.direction(), 10f64.powf(random.uniform(-9.0, -1.0)));
        let apart = turn * Vector::new(0.3 * random.signed(), radius * random.uniform(0.7, 0.99), 0.0);
        let poses = [Pose::new(&turn, &Vector::zeros()), Pose::new(&beside, &apart)];
        let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
        let answer = ask(contact, placed);
        assert_eq!(verify(placed, &answer), Ok(()), "{round} {answer:?}");
        if answer.outcome == Outcome::Intersecting {
            let apart = (Vector::from(answer.world1) - Vector::from(answer.world2)).norm();
            assert!(apart < 1e-14, "{round}: {apart:e}");
            seen += 1;
        }
    }
    assert!(seen > 200, "{seen}");
}

/// Rounded tetrahedra whose edges cross, at poses that stretch, some body lengths apart: the manifold is the pair of witness
/// points, in line along the normal. Cause: marching took the images of edges for as long as themselves, and the points lay up to
/// 4e-7 beside the line; `verify_manifold` allows 3e-8 of the pair's size.
#[test]
fn manifolds_of_crossing_edges_pass_at_poses_that_stretch() {
    let mut random = Random::new(0x5ed4);
    let upward = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 1.0], [0.0, 1.0, 1.0]].map(Vector::from);
    let downward = upward.map(|p| Vector::new(p.y, p.x, -p.z));
    let mut worst = 0.0_f64;
    for round in 0..400 {
        let bodies = [swept(&upward, 0.1), swept(&downward, random.pick(&[0.0, 0.2]))];
        let off = 10f64.powf(random.uniform(-7.0, -2.7));
        let turns = [(); 2].map(|()| Matrix::identity() + Matrix::from_fn(|_, _| off * random.signed()));
        let away = Vector::new(0.3 * random.signed(), 0.3 * random.signed(), random.uniform(0.5, 6.0));
        let frame = random.rotation();
        let poses = [Pose::new(&(frame * turns[0]), &(frame * away)), Pose::new(&(frame * turns[1]), &Vector::zeros())];
        let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
        let config = ManifoldConfig { max_distance: f64::INFINITY, ..ManifoldConfig::default() };
        let (found, points, cache) = ask_manifold(placed, &config);
        assert_eq!(verify_manifold(placed, &cache, &config, &found, &points), Ok(()), "{round} {found:?} {points:?}");
        let [world1, world2, normal] = [points[0].world1, points[0].world2, found.normal].map(Vector::from);
        let apart = world1 - world2;
        worst = worst.max((apart - normal * normal.dot(&apart)).norm());
    }
    assert!(worst < 1e-13, "{worst:e}");
}

/// A common point of a cube and a bar 8·10³¹ long is known to the bar's rounding, and is as far out of the cube. The check of both
/// frames allowed for the rounding of the cube alone, and refused a true answer: the world's point was 2 off, of 4.5·10¹⁵. A point
/// that is farther off is refused as before.
#[test]
fn a_point_that_a_long_body_rounds_is_the_same_in_both_frames() {
    let (thin, far) = (0.9999999999999998, 8.112963841460668e31);
    let corners = |half: [f64; 3]| -> Vec<Vector> {
        (0..8).map(|k| Vector::from_fn(|i, _| if k >> i & 1 == 0 { -half[i] } else { half[i] })).collect()
    };
    let mut bar = corners([thin, 32.0, far]);
    bar.iter_mut().for_each(|p| *p = Vector::new(p.x, p.z, -p.y));
    let bodies = [swept(&corners([32.0; 3]), 127.0), swept(&bar, 3.2198325245797027e32)];
    let places = [Vector::new(-1.0, 1.0, -1.0), Vector::new(-34.99999999999999, -far, -2.0)];
    let poses = places.map(|place| Pose::new(&Matrix::identity(), &place));
    let placed = [bodies[0].at(&poses[0]), bodies[1].at(&poses[1])];
    let motions = poses.map(Motion::Fixed);
    let moving = [0, 1].map(|i| Moving { shape: &bodies[i], motion: &motions[i] });
    let mut hit = CastAnswer::default();
    cast(moving, &mut PairCache::default(), &CastConfig::default(), &mut hit).unwrap();
    assert_eq!((hit.outcome, hit.contact.outcome), (CastOutcome::Hit, Outcome::Intersecting));
    for answer in [hit.contact, ask(contact, placed)] {
        verify(placed, &answer).unwrap();
        let mut forged = answer;
        forged.world1[1] += 1e-12 * answer.local1[1].abs().max(100.0);
        assert!(verify(placed, &forged).is_err(), "{forged:?}");
    }
    verify_cast(moving, &CastConfig::default(), &hit).unwrap();
}
