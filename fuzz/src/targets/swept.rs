//! Pairs of bodies with a ball of any radius swept over them and faces that are flat up to any noise: refused exactly if a number
//! is out of range, else judged by exact rationals less the radii, by `verify`, `verify_depth` and `verify_manifold`. Likewise a
//! body and a half-space, and a body and a cylinder, cone or ellipsoid. In the floating-point environment that the last byte
//! chooses the bits are the same.

use arbitrary::{Result, Unstructured};
use swiftprox::base::simd::environment::Environment;
use swiftprox::error::Error;
use swiftprox::manifold::{ManifoldConfig, ManifoldPoint, half_space_manifold};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::contact;
use swiftprox::pair::{
    HalfSpace, Outcome, PairAnswer, PairCache, PairConfig, Placed, SignedDistance, SignedDistanceCache, approximate,
    distance, half_space_distance, intersection, signed_distance,
};
use swiftprox::shape::{InputPolicy, LARGEST_SWEPT_RADIUS, Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::cases::Case;
use testkit::swept::Length;

use crate::contacts;
use crate::geometry::{any_cache, any_number, inside, last_is_environment, points, poses};

/// The truth takes time in the fourth power of this.
const MOST_POINTS: usize = 6;

const MOST_STEPS: usize = 4;

struct Body {
    points: Vec<Vector>,
    radius: f64,
    shape: Shape,
}

pub fn run(bytes: &[u8]) {
    let (environment, bytes) = last_is_environment(bytes);
    // Bytes that end early end the run.
    let _: Result<()> = run_from(&mut Unstructured::new(bytes), environment);
}

fn run_from(u: &mut Unstructured, environment: Environment) -> Result<()> {
    let (Some(body1), Some(body2)) = (body(u)?, body(u)?) else { return Ok(()) };
    let bodies = [body1, body2];
    let mut memory = contacts::Memory::default();
    for _ in 0..MOST_STEPS {
        let poses = touching(u, &bodies)?;
        let is_accepted = poses.iter().all(|pose| pose.check().is_ok());
        if is_accepted {
            check_pair(u, &bodies, &poses, environment, &mut memory)?;
        }
        check_half_space(u, &bodies[0], &poses[0], environment)?;
        if is_accepted && u.ratio(1, 4)? {
            check_curved(u, &bodies[1], &poses, environment)?;
        }
        if u.is_empty() {
            break;
        }
    }
    Ok(())
}

/// The hull of points with a radius and a noise, if these are accepted.
fn body(u: &mut Unstructured) -> Result<Option<Body>> {
    let points = points(u, MOST_POINTS)?;
    let mut last = points[0].amax();
    let radius = if u.ratio(1, 4)? { 0.0 } else { any_number(u, &mut last)? };
    let face_noise = if u.arbitrary()? { None } else { Some(any_number(u, &mut last)?) };
    let options =
        ShapeOptions { input: InputPolicy::Hull, swept_radius: radius, face_noise, ..ShapeOptions::default() };
    let is_sound = (0.0..=LARGEST_SWEPT_RADIUS).contains(&radius)
        && face_noise.is_none_or(|noise| (0.0..=f64::MAX).contains(&noise));
    match Shape::from_points(&points, &options) {
        Ok(shape) => {
            assert!(is_sound && shape.swept_radius() == radius, "{options:?}");
            Ok(Some(Body { points, radius, shape }))
        }
        Err(error) => {
            assert!(!is_sound && matches!(error, Error::Argument(_)), "{error:?}: {options:?} of {points:?}");
            Ok(None)
        }
    }
}

/// Poses as of other targets, or such that the balls may touch as the points else would.
fn touching(u: &mut Unstructured, bodies: &[Body; 2]) -> Result<[Pose; 2]> {
    let mut poses = poses(u, [&bodies[0].points, &bodies[1].points])?;
    if u.arbitrary()? {
        let sum = bodies[0].radius + bodies[1].radius;
        // Of length 1 up to rounding.
        let direction =
            *u.choose(&[[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.0, 0.8], [2.0 / 3.0, 1.0 / 3.0, -2.0 / 3.0]])?;
        let moved = poses[1].translation() + Vector::from(direction) * sum;
        if moved.iter().all(|x| x.is_finite()) {
            poses[1] = Pose::new(&poses[1].rotation(), &moved);
        }
    }
    Ok(poses)
}

fn check_pair(
    u: &mut Unstructured,
    bodies: &[Body; 2],
    poses: &[Pose; 2],
    environment: Environment,
    memory: &mut contacts::Memory,
) -> Result<()> {
    let placed = [bodies[0].shape.at(&poses[0]), bodies[1].shape.at(&poses[1])];
    let case = Case {
        points_a: bodies[0].points.clone(),
        pose_a: poses[0],
        points_b: bodies[1].points.clone(),
        pose_b: poses[1],
    };
    let of_polytopes = case.truth();
    let overlap = of_polytopes.intersecting();
    let length = Length::between(&of_polytopes, bodies.each_ref().map(|body| body.radius));
    let cache = if u.ratio(1, 4)? { any_cache(u)? } else { PairCache::default() };
    let described = || format!("radii {:?}\n{}", bodies.each_ref().map(|body| body.radius), case.describe());
    let ask = |query: Query| {
        let (mut cache, mut answer) = (cache, PairAnswer::default());
        query(placed, &mut cache, &PairConfig::default(), &mut answer).expect("accepted poses");
        answer
    };
    for query in [distance as Query, intersection, contact, approximate] {
        let answer = ask(query);
        assert_eq!(format!("{:?}", inside(environment, || ask(query))), format!("{answer:?}"), "{environment:?}");
        let is_apart = answer.outcome == Outcome::Separated;
        assert_eq!(is_apart, length.compared_with(0.0).is_gt(), "{answer:?}\n{}", described());
        assert!(!is_apart || length.lies_between(answer.lower, answer.upper), "{answer:?}\n{}", described());
        match verify(placed, &answer) {
            // Beyond the range of doubles.
            Ok(()) | Err(Error::Argument(_)) => {}
            Err(error) => panic!("{error}: {answer:?}\n{}", described()),
        }
    }
    let mut signed = SignedDistance::default();
    signed_distance(placed, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut signed)
        .expect("accepted poses");
    let holds = if overlap {
        length.compared_with(signed.lower).is_ge() && signed.upper <= 0.0
    } else {
        length.lies_between(signed.lower, signed.upper)
    };
    assert!(holds && signed.lower <= signed.distance && signed.distance <= signed.upper, "{signed:?}\n{}", described());
    let measured = is_tame(bodies, poses);
    contacts::check(u, placed, &ask(contact), measured, environment, memory)
}

/// A curved body of any lengths, if these are accepted, beside one of points: all queries agree, and pass their checks.
fn check_curved(u: &mut Unstructured, body: &Body, poses: &[Pose; 2], environment: Environment) -> Result<()> {
    let mut last = 1.0;
    let lengths = [any_number(u, &mut last)?, any_number(u, &mut last)?, any_number(u, &mut last)?];
    let deviation = lengths.iter().fold(0.0, |most: f64, &length| most.max(length)) * u.choose(&[0.3, 0.1, 0.02])?;
    let made = match u.int_in_range(0..=2)? {
        0 => Shape::from_cylinder(lengths[0], lengths[1], deviation),
        1 => Shape::from_cone(lengths[0], lengths[1], deviation),
        _ => Shape::from_ellipsoid(&lengths.into(), deviation),
    };
    let Ok(curved) = made else { return Ok(()) };
    assert!(curved.deviation() <= deviation);
    let placed = [curved.at(&poses[0]), body.shape.at(&poses[1])];
    let mut signed = SignedDistance::default();
    signed_distance(placed, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut signed)
        .expect("accepted poses");
    let described =
        || format!("{signed:?}\n{lengths:?} {deviation:e}, {:?} of radius {:?} at {poses:?}", body.points, body.radius);
    assert!(signed.lower <= signed.distance && signed.distance <= signed.upper, "{}", described());
    let is_open = signed.lower <= 0.0 && signed.upper > 0.0;
    assert_eq!(signed.outcome == Outcome::Undecided, is_open, "{}", described());
    for query in [distance as Query, intersection, contact, approximate] {
        let ask = || {
            let mut answer = PairAnswer::default();
            query(placed, &mut PairCache::default(), &PairConfig::default(), &mut answer).expect("accepted poses");
            answer
        };
        let answer = ask();
        assert_eq!(format!("{:?}", inside(environment, ask)), format!("{answer:?}"), "{environment:?}");
        // The ends of a depth and of a distance are rounded apart.
        assert!(answer.lower <= signed.upper.max(0.0) && answer.upper >= signed.lower, "{answer:?}\n{}", described());
        match verify(placed, &answer) {
            // Beyond the range of doubles.
            Ok(()) | Err(Error::Argument(_)) => {}
            Err(error) => panic!("{error}: {answer:?}\n{}", described()),
        }
    }
    Ok(())
}

type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> swiftprox::error::Result<()>;

/// Any plane, or one that touches the body.
fn check_half_space(u: &mut Unstructured, body: &Body, pose: &Pose, environment: Environment) -> Result<()> {
    let mut last = 1.0;
    let normal: [f64; 3] = [any_number(u, &mut last)?, any_number(u, &mut last)?, any_number(u, &mut last)?];
    let offset = if u.arbitrary()? {
        any_number(u, &mut last)?
    } else {
        let along = Vector::from(normal);
        along.dot(&pose.transform(u.choose(&body.points)?)) - body.radius * along.norm()
    };
    let half_space = HalfSpace { normal, offset };
    let placed = body.shape.at(pose);
    let ask = || half_space_distance(placed, &half_space);
    let answer = ask();
    assert_eq!(format!("{:?}", inside(environment, ask)), format!("{answer:?}"), "{environment:?}");
    let is_plane = normal != [0.0; 3] && normal.iter().chain([&offset]).all(|x| x.is_finite());
    let is_accepted = pose.check().is_ok();
    let answer = match answer {
        Ok(answer) => answer,
        Err(Error::Argument(_)) => {
            assert!(!is_plane, "{half_space:?}");
            return Ok(());
        }
        Err(Error::Pose(_)) => {
            assert!(!is_accepted, "{pose:?}");
            return Ok(());
        }
        Err(error) => panic!("{error}: {half_space:?}"),
    };
    assert!(is_plane && is_accepted, "{half_space:?} {pose:?}");
    let described = || format!("{answer:?}\n{half_space:?} {:?} of radius {:?} at {pose:?}", body.points, body.radius);
    let heights: Vec<Length> =
        body.points.iter().map(|point| Length::above(&half_space, pose, point, body.radius)).collect();
    assert!(heights.iter().all(|height| height.compared_with(answer.lower).is_ge()), "{}", described());
    assert!(heights.iter().any(|height| height.compared_with(answer.upper).is_le()), "{}", described());
    let is_apart = heights.iter().all(|height| height.compared_with(0.0).is_gt());
    assert_eq!(answer.outcome == Outcome::Separated, is_apart, "{}", described());
    assert!(answer.lower <= answer.distance && answer.distance <= answer.upper, "{}", described());
    let mut points = [ManifoldPoint::default(); 2 * MOST_POINTS];
    let config = ManifoldConfig { max_distance: any_number(u, &mut last)?.abs(), reduces: u.arbitrary()? };
    let found = match half_space_manifold(placed, &half_space, &config, &mut points) {
        Ok(found) => found,
        Err(error) => {
            assert!(matches!(error, Error::Argument(_)) && config.max_distance.is_nan(), "{error}");
            return Ok(());
        }
    };
    assert_eq!(found.outcome == Outcome::Beyond, answer.lower > config.max_distance, "{found:?} {}", described());
    assert!(found.point_count <= if config.reduces { 4 } else { found.found_count }, "{found:?}");
    assert_eq!(found.point_count == 0, found.outcome == Outcome::Beyond, "{found:?}");
    for point in &points[..found.point_count as usize] {
        let height = &heights[point.feature1.ids[0] as usize];
        assert!(height.lies_between(point.gap_lower, point.gap_upper), "{point:?} {}", described());
    }
    Ok(())
}

/// Whether all numbers are so far inside the doubles that points can be measured in them.
fn is_tame(bodies: &[Body; 2], poses: &[Pose; 2]) -> bool {
    let coordinates = bodies.iter().flat_map(|body| body.points.iter().flatten().copied().chain([body.radius]));
    let places = poses.iter().flat_map(|pose| pose.rows.map(|row| row[3]));
    coordinates.chain(places).all(|x| x == 0.0 || (1e-60..1e60).contains(&x.abs()))
}
