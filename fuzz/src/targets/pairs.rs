//! Pair queries about any two bodies, with any levels of detail and look-up tables, along any sequence of poses, the cache carried
//! on or corrupted: every answer is checked by `verify`, against all that answers promise, against the other queries and the
//! swapped pair from caches of every origin, and for small bodies against exact rationals. In the floating-point environment
//! that the last byte chooses bodies and answers are bit for bit the same. Depths and manifolds likewise, by `verify_depth` and
//! what holds of every manifold.

use std::sync::Mutex;

use arbitrary::{Result, Unstructured};
use swiftprox::base::simd::environment::Environment;
use swiftprox::error::Error;
use swiftprox::math::Vector;
use swiftprox::pair::contact;
use swiftprox::pair::{
    Levels, Outcome, PairAnswer, PairCache, PairConfig, Refinement, Start, approximate, distance, intersection,
};
use swiftprox::shape::Shape;
use swiftprox::verify::verify;
use testkit::bodies::Body;
use testkit::cases::{Case, Random};
use testkit::properties::{Placed, Session, Work};

use crate::contacts;
use crate::geometry::{any_cache, any_number, hull_options, inside, last_is_environment, points, poses};

/// The oracle takes time in the fourth power of this.
const FEW_POINTS: usize = 6;
const MOST_STEPS: usize = 6;

/// The most work of one query so far; each new one is printed.
static MOST_WORK: Mutex<Work> = Mutex::new(Work([0; 3]));

pub fn run(bytes: &[u8]) {
    let (environment, bytes) = last_is_environment(bytes);
    // Bytes that end early end the run.
    let _: Result<()> = run_from(&mut Unstructured::new(bytes), environment);
}

fn run_from(u: &mut Unstructured, environment: Environment) -> Result<()> {
    let most = if u.ratio(1, 4)? { 64 } else { FEW_POINTS };
    let bodies = [body(u, most, environment)?, body(u, most, environment)?];
    let mut session = Session::new(0);
    let mut memory = contacts::Memory::default();
    for _ in 0..MOST_STEPS {
        let poses = poses(u, [&bodies[0].points, &bodies[1].points])?;
        let placed = Placed { bodies: [&bodies[0], &bodies[1]], poses };
        session.random = Random::new(u.arbitrary::<u16>()?.into());
        if u.ratio(1, 4)? {
            session.own = any_cache(u)?;
        }
        if let Some(cold) = check(u, &placed, &mut session)? {
            let bodies = [0, 1].map(|i| bodies[i].shape.at(&poses[i]));
            contacts::check(u, bodies, &cold, !is_wild(&placed), environment, &mut memory)?;
        }
        check_environment(environment, &placed, session.own);
        if u.is_empty() {
            break;
        }
    }
    Ok(())
}

/// The hull of points; levels of detail and look-up tables must not change what it is.
fn body(u: &mut Unstructured, most: usize, environment: Environment) -> Result<Body> {
    let options = hull_options(u)?;
    let mut body = Body::from_points(points(u, most)?);
    let made = Shape::from_points(&body.points, &options);
    let again = inside(environment, || Shape::from_points(&body.points, &options));
    assert!(again == made, "{environment:?}: another shape");
    match made {
        Ok(shape) => body.shape = shape,
        Err(error @ Error::Bug(_)) => panic!("{error}: {options:?} of {:?}", body.points),
        // Not every body has levels.
        Err(_) => {}
    }
    Ok(body)
}

/// The exact answer of poses that are accepted.
fn check(u: &mut Unstructured, placed: &Placed, session: &mut Session) -> Result<Option<PairAnswer>> {
    let ([body1, body2], [pose1, pose2]) = (placed.bodies, &placed.poses);
    let mut answer = PairAnswer::default();
    if placed.poses.iter().any(|pose| pose.check().is_err()) {
        let (mut cache, config) = (session.own, PairConfig::default());
        let refused = distance([body1.shape.at(pose1), body2.shape.at(pose2)], &mut cache, &config, &mut answer);
        assert!(matches!(refused, Err(Error::Pose(_))), "{refused:?}");
        assert!(cache == session.own && answer.outcome == Outcome::None);
        return Ok(None);
    }
    let cold = session.check(placed);
    print_most_work(session.tally.most);
    // Beyond the range of doubles only the oracle can tell, and what the tests measure in doubles has to leave room for squares.
    session.violations.retain(|v| !v.detail.contains("too large or too far apart to be checked"));
    if is_wild(placed) {
        session.violations.retain(|v| !MEASURED.contains(&v.property));
    }
    for violation in &session.violations {
        eprintln!("{}: {}\n", violation.property, violation.detail);
    }
    assert!(session.violations.is_empty(), "see above");
    let Some(cold) = cold else { return Ok(None) };
    check_tolerance(u, placed, session.own, &cold)?;
    check_levels(u, placed, session.own, &cold)?;
    if placed.bodies.iter().all(|body| body.points.len() <= FEW_POINTS) {
        check_truth(placed, &cold);
    }
    Ok(Some(cold))
}

/// Each query, from the same cache, in the default environment and in another one.
fn check_environment(environment: Environment, placed: &Placed, own: PairCache) {
    let ([body1, body2], [pose1, pose2]) = (placed.bodies, &placed.poses);
    let config = PairConfig { relative_error: 0.1, levels: Levels::All, ..PairConfig::default() };
    for query in [distance, intersection, contact, approximate] {
        let ask = || {
            let (mut cache, mut answer) = (own, PairAnswer::default());
            let asked = query([body1.shape.at(pose1), body2.shape.at(pose2)], &mut cache, &config, &mut answer);
            let verified = asked.is_ok().then(|| verify([body1.shape.at(pose1), body2.shape.at(pose2)], &answer));
            (asked, answer, cache, verified)
        };
        let [expected, found] = [ask(), inside(environment, ask)].map(|told| format!("{told:?}"));
        assert_eq!(found, expected, "{environment:?}");
    }
}

fn print_most_work(of_session: Work) {
    let mut most = MOST_WORK.lock().expect("no panic");
    let now = most.max(of_session);
    if now.0 != most.0 {
        *most = now;
        let [steps, iterations, exact_iterations] = now.0;
        eprintln!("most work: {steps} steps, {iterations} iterations, {exact_iterations} in integers");
    }
}

/// Properties that the tests measure in doubles.
const MEASURED: [&str; 7] = [
    "a tight interval",
    "world = pose · local",
    "one common point",
    "normal along points",
    "the vertex is the witness point",
    "the edge holds the witness point",
    "the face holds the witness point",
];

/// Whether a number other than 0 is larger than 10⁶⁰ or smaller than its reciprocal.
fn is_wild(placed: &Placed) -> bool {
    let coordinates = placed.bodies.into_iter().flat_map(|body| body.points.iter().flatten().copied());
    let translations = placed.poses.iter().flat_map(|pose| pose.rows.map(|row| row[3]));
    coordinates.chain(translations).any(|x| x != 0.0 && !(1e-60..1e60).contains(&x.abs()))
}

/// With a distance tolerance: beyond it exactly if the interval says so, and then only the lower end is said.
fn check_tolerance(u: &mut Unstructured, placed: &Placed, mut cache: PairCache, cold: &PairAnswer) -> Result<()> {
    let ([body1, body2], [pose1, pose2]) = (placed.bodies, &placed.poses);
    let mut last = cold.distance;
    let max_distance = any_number(u, &mut last)?;
    let config = PairConfig { max_distance, ..PairConfig::default() };
    let mut answer = PairAnswer::default();
    let asked = distance([body1.shape.at(pose1), body2.shape.at(pose2)], &mut cache, &config, &mut answer);
    if max_distance < 0.0 || max_distance.is_nan() {
        assert!(matches!(asked, Err(Error::Argument(_))), "{asked:?}");
        return Ok(());
    }
    asked.expect("accepted poses and a tolerance");
    let intersecting = answer.outcome == Outcome::Intersecting;
    assert_eq!(intersecting, cold.outcome == Outcome::Intersecting, "{answer:?}\n{cold:?}");
    let is_beyond = answer.outcome == Outcome::Beyond;
    let is_so = if is_beyond { answer.lower >= max_distance } else { answer.upper <= max_distance };
    assert!(is_so, "{max_distance:e}: {answer:?}");
    assert!(answer.lower <= cold.upper && cold.lower <= answer.upper, "{answer:?}\n{cold:?}");
    if answer.outcome == Outcome::Beyond {
        let points = [answer.local1, answer.local2, answer.world1, answer.world2];
        assert!(points.as_flattened().iter().all(|x| x.is_nan()), "{answer:?}");
        assert!(answer.upper == f64::INFINITY && answer.distance == answer.lower, "{answer:?}");
    }
    match verify([body1.shape.at(pose1), body2.shape.at(pose2)], &answer) {
        Ok(()) | Err(Error::Argument(_)) => {}
        Err(error) => panic!("{error}: {answer:?}"),
    }
    Ok(())
}

/// Through whatever levels the bodies have, to within any error, from where any start says: the verdict of the exact query and a
/// number in common with its interval.
fn check_levels(u: &mut Unstructured, placed: &Placed, mut cache: PairCache, cold: &PairAnswer) -> Result<()> {
    let ([body1, body2], [pose1, pose2]) = (placed.bodies, &placed.poses);
    let mut last = cold.distance;
    let config = PairConfig {
        absolute_error: any_number(u, &mut last)?.abs(),
        relative_error: *u.choose(&[0.0, 1e-9, 0.1, 10.0])?,
        levels: Levels::All,
        start: *u.choose(&[Start::Automatic, Start::Cache, Start::Table, Start::Cold])?,
        refinement: *u.choose(&[Refinement::Adaptive, Refinement::Single, Refinement::DoubleDouble])?,
        ..PairConfig::default()
    };
    if config.absolute_error.is_nan() {
        return Ok(());
    }
    let mut answer = PairAnswer::default();
    approximate([body1.shape.at(pose1), body2.shape.at(pose2)], &mut cache, &config, &mut answer)
        .expect("accepted poses");
    let same = (answer.outcome == Outcome::Intersecting) == (cold.outcome == Outcome::Intersecting);
    assert!(same && answer.lower <= cold.upper && cold.lower <= answer.upper, "{config:?} {answer:?}\n{cold:?}");
    match verify([body1.shape.at(pose1), body2.shape.at(pose2)], &answer) {
        Ok(()) | Err(Error::Argument(_)) => {}
        Err(error) => panic!("{error}: {config:?} {answer:?}"),
    }
    Ok(())
}

fn check_truth(placed: &Placed, answer: &PairAnswer) {
    let [points_a, points_b] = placed.bodies.map(|body| body.points.clone());
    let case = Case { points_a, pose_a: placed.poses[0], points_b, pose_b: placed.poses[1] };
    let truth = case.truth();
    let holds = truth.intersecting() == (answer.outcome == Outcome::Intersecting)
        && truth.lies_between(answer.lower, answer.upper);
    assert!(holds, "{answer:?}, the truth is {truth:?}\n{}", case.describe());
    let said = |p: [f64; 3]| Vector::from(p).iter().all(|x| !x.is_nan());
    if answer.outcome == Outcome::Separated {
        let points = [answer.local1, answer.local2, answer.world1, answer.world2, answer.normal];
        assert!(points.into_iter().all(said), "{answer:?}\n{}", case.describe());
    }
}
