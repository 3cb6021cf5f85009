//! Casts of any two bodies along motions of any kind: refused with a message, or answered. Then the proof is found anew, verdicts
//! along the motion and integers refute nothing, a damaged cache changes nothing that holds, and in the floating-point environment
//! that the last byte chooses the bits are the same.

use std::sync::Arc;

use arbitrary::{Result, Unstructured};
use swiftprox::base::simd::environment::Environment;
use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{
    Callback, CastAnswer, CastConfig, CastOutcome, Clearance, ClearanceConfig, Motion, Screw, cast, clearance,
    motion_between, verify_cast,
};
use swiftprox::pair::{self, PairAnswer, PairCache, PairConfig};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::casts::Case;
use testkit::casts::judge::{allowance, by_bisection, by_samples};

use crate::geometry::{any_cache, any_number, inside, last_is_environment, points, pose, poses};

const MOST_POINTS: usize = 12;

/// So that the worst motion takes milliseconds.
const MOST_QUERIES: u32 = 2_000;

const SAMPLES: u32 = 16;

pub fn run(bytes: &[u8]) {
    let (environment, bytes) = last_is_environment(bytes);
    // Bytes that end early end the run.
    let _: Result<()> = run_from(&mut Unstructured::new(bytes), environment);
}

fn run_from(u: &mut Unstructured, environment: Environment) -> Result<()> {
    let hulls = [points(u, MOST_POINTS)?, points(u, MOST_POINTS)?];
    let ends = [0, 1].map(|_| poses(u, [&hulls[0], &hulls[1]]));
    let [starts, ends] = [ends[0]?, ends[1]?];
    let config = config(u)?;
    let cache = any_cache(u)?;
    if u.ratio(1, 16)? {
        return check_callback(u, &hulls, starts, &config);
    }
    let motions = [motion(u, starts[0], ends[0])?, motion(u, starts[1], ends[1])?];
    let shapes = [round(u, &hulls[0])?, round(u, &hulls[1])?].map(Arc::new);
    let case = Case { shapes, motions, config, is_exact: false };
    let ask = |mut cache: PairCache| {
        let mut answer = CastAnswer::default();
        cast(case.bodies(), &mut cache, &case.config, &mut answer).map(|()| answer)
    };
    let cold = ask(PairCache::default());
    let again = inside(environment, || ask(PairCache::default()));
    assert_eq!(format!("{again:?}"), format!("{cold:?}"), "{environment:?}");
    match cold {
        Ok(answer) => check(&case, &[answer, ask(cache).expect("what a cold cache answers")]),
        Err(Error::Argument(_) | Error::Pose(_)) => {}
        Err(error) => panic!("{error}: {:?} {:?}", case.motions, case.config),
    }
    Ok(())
}

/// The hull of points with a ball of no radius swept over it, or of one up to four times their size.
fn round(u: &mut Unstructured, points: &[Vector]) -> Result<Shape> {
    let size = points.iter().map(Vector::amax).fold(0.0, f64::max).min(1e100);
    let swept_radius = size * f64::from(u.arbitrary::<u8>()?.saturating_sub(128)) / 32.0;
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
    Ok(Shape::from_points(points, &options).expect("finite points"))
}

fn check(case: &Case, answers: &[CastAnswer; 2]) {
    for answer in answers {
        let told = || format!("{:?} {:?} {}\n{answer:?}", case.motions, case.config, bodies_of(case));
        let free_for_sure = answer.outcome != CastOutcome::Budget || answer.time_lower > case.config.time_begin;
        assert!(answer.outcome != CastOutcome::None && (free_for_sure || answer.queries > 0), "{}", told());
        match verify_cast(case.bodies(), &case.config, answer) {
            Ok(()) => {}
            // Where rounding hides what all steps need, integers answer each, and the check has its limit.
            Err(error) if error.to_string().contains("gives up") => {}
            Err(error) => panic!("{error}\n{}", told()),
        }
        if is_tame(case) {
            let judged = by_samples(case, answer, SAMPLES).and_then(|()| by_bisection(case, answer));
            judged.unwrap_or_else(|why| panic!("{why}\n{}", told()));
        }
        for forged in forgeries(case, answer) {
            assert!(verify_cast(case.bodies(), &case.config, &forged).is_err(), "{forged:?}\n{}", told());
        }
    }
    check_clearance(case, &answers[0]);
}

fn bodies_of(case: &Case) -> String {
    let points = |shape: &Arc<Shape>| {
        let polyhedron = shape.polyhedron();
        let points = (0..polyhedron.vertices.len() as u32).map(|v| polyhedron.local_position(v));
        format!("{:?} with radius {:?}", points.collect::<Vec<_>>(), shape.swept_radius())
    };
    case.shapes.each_ref().map(points).join(" and ")
}

/// What contradicts an answer that holds: free up to where it hits, a hit up to where it is free.
fn forgeries(case: &Case, answer: &CastAnswer) -> Vec<CastAnswer> {
    let CastConfig { time_begin, time_end, max_distance, .. } = case.config;
    let said = CastAnswer::default();
    let mut forged = Vec::new();
    if answer.outcome == CastOutcome::Hit && answer.time_upper > time_begin {
        forged.push(CastAnswer { time_lower: answer.time_upper, ..*answer });
        forged.push(CastAnswer { outcome: CastOutcome::Budget, time_lower: answer.time_upper, ..said });
        forged.push(CastAnswer { outcome: CastOutcome::Free, time_lower: time_end, clearance: max_distance, ..said });
        if answer.time_lower > time_begin {
            forged.push(CastAnswer { time_upper: answer.time_lower, ..*answer });
        }
    }
    if answer.outcome == CastOutcome::Free {
        let mut contact = PairAnswer::default();
        let poses = case.poses(time_end);
        let placed = [case.shapes[0].at(&poses[0]), case.shapes[1].at(&poses[1])];
        if pair::contact(placed, &mut PairCache::default(), &PairConfig::default(), &mut contact).is_ok() {
            let upper = contact.upper;
            forged.push(CastAnswer {
                outcome: CastOutcome::Hit,
                time_lower: time_begin,
                time_upper: time_end,
                upper,
                contact,
                ..said
            });
            if is_tame(case) && upper < f64::INFINITY {
                forged.push(CastAnswer { clearance: upper + allowance(case), ..*answer });
            }
        }
    }
    forged
}

/// The interval of the smallest distance agrees with a cast without `max_distance`.
fn check_clearance(case: &Case, answer: &CastAnswer) {
    let CastConfig { time_begin, time_end, step_budget, .. } = case.config;
    let config = ClearanceConfig { time_begin, time_end, step_budget, ..ClearanceConfig::default() };
    let mut smallest = Clearance::default();
    match clearance(case.bodies(), &mut PairCache::default(), &config, &mut smallest) {
        Ok(()) => {}
        // A cast has not seen the poses behind its hit.
        Err(Error::Pose(_)) if answer.outcome != CastOutcome::Free => return,
        Err(error) => panic!("{error}: what a cast answers"),
    }
    let Clearance { lower, upper, .. } = smallest;
    let agrees = match answer.outcome {
        CastOutcome::Free => upper >= answer.clearance,
        CastOutcome::Hit => lower <= answer.upper,
        _ => true,
    };
    assert!(0.0 <= lower && lower <= upper && agrees, "{smallest:?} {answer:?} {:?}", case.motions);
}

/// Poses of a function that may be nonsense: refused or answered, but it ends.
fn check_callback(
    u: &mut Unstructured,
    hulls: &[Vec<Vector>; 2],
    starts: [Pose; 2],
    config: &CastConfig,
) -> Result<()> {
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let shapes = [0, 1].map(|i| Shape::from_points(&hulls[i], &options).expect("finite points"));
    let mut last = 1.0;
    let (bend, rounding) = (any_number(u, &mut last)?, any_number(u, &mut last)?);
    let (velocity, jump) = (any_number(u, &mut last)?, any_number(u, &mut last)?);
    let told = |time: f64| {
        let mut pose = starts[0];
        pose.rows[0][3] += velocity * time + if time > 0.5 { jump } else { 0.0 };
        pose
    };
    let (moving, still) = (Motion::Callback(Callback { pose: &told, bend, rounding }), Motion::Fixed(starts[1]));
    let bodies = [0, 1].map(|i| swiftprox::motion::Moving { shape: &shapes[i], motion: [&moving, &still][i] });
    let mut answer = CastAnswer::default();
    match cast(bodies, &mut PairCache::default(), config, &mut answer) {
        Ok(()) => assert_ne!(answer.outcome, CastOutcome::None),
        Err(Error::Argument(_) | Error::Pose(_)) => assert_eq!(answer.outcome, CastOutcome::None),
        Err(error) => panic!("{error}"),
    }
    Ok(())
}

fn config(u: &mut Unstructured) -> Result<CastConfig> {
    let mut config = CastConfig { step_budget: MOST_QUERIES, ..CastConfig::default() };
    let mut last = 1.0;
    match u.int_in_range(0..=5)? {
        0 => config.time_tolerance = any_number(u, &mut last)?,
        1 => config.max_distance = any_number(u, &mut last)?,
        2 => (config.time_begin, config.time_end) = (any_number(u, &mut last)?, any_number(u, &mut last)?),
        3 => config.step_budget = u.int_in_range(0..=3)?,
        _ => {}
    }
    Ok(config)
}

fn motion(u: &mut Unstructured, start: Pose, end: Pose) -> Result<Motion<'static>> {
    let mut last = 1.0;
    let mut vector = |u: &mut Unstructured| {
        Ok(Vector::new(any_number(u, &mut last)?, any_number(u, &mut last)?, any_number(u, &mut last)?))
    };
    Ok(match u.int_in_range(0..=4)? {
        0 => Motion::Fixed(start),
        1 => Motion::Affine { start, end },
        2 => Motion::Screw(Screw { start, centre: Vector::zeros(), velocity: vector(u)?, rotation: Vector::zeros() }),
        3 => Motion::Screw(Screw { start, centre: vector(u)?, velocity: vector(u)?, rotation: vector(u)? }),
        _ => match motion_between(&start, &end, &Vector::zeros(), 1.0) {
            Ok((screw, _)) => Motion::Screw(screw),
            Err(_) => Motion::Fixed(pose(u)?),
        },
    })
}

/// Whether all numbers are so far inside the doubles that the judge can measure in them.
fn is_tame(case: &Case) -> bool {
    let tame = |x: f64| x == 0.0 || (1e-30..1e30).contains(&x.abs());
    let poses = [case.config.time_begin, case.config.time_end].map(|time| case.poses(time));
    let vertices = |shape: &Shape| shape.polyhedron().vertices.iter().all(|v| v.position.iter().all(|&x| tame(x)));
    let turns_little = case.motions.iter().all(|motion| match motion {
        Motion::Screw(screw) => screw.rotation.norm() < 1e3 && screw.centre.iter().all(|&x| tame(x)),
        _ => true,
    });
    let places = poses.as_flattened().iter().flat_map(|pose| pose.rows.map(|row| row[3]));
    let times = [case.config.time_begin, case.config.time_end].into_iter().all(|time| time.abs() <= 1.0);
    case.shapes.iter().all(|shape| vertices(shape)) && places.into_iter().all(tame) && turns_little && times
}
