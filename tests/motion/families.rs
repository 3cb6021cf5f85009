//! Adversarial families, judged by many exact verdicts along each motion.
//!
//! The judge computes poses of its own, by other formulas and the machine's sine. They are off by rounding, so it allows for that:
//! a body is taken for in contact where it is deeper than the allowance, for apart where it is farther. Lattice motions need no
//! allowance: their poses at fractions of 2⁻¹⁰ are exact.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, CastOutcome, Motion, Screw, motion_between, verify_cast};
use swiftprox::pair::{self, DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::shape::Shape;
use testkit::random::{Random, rotation};
use testkit::shapes::{cuboid, hull};

use crate::{moving, run};

/// A pair in motion, and how the judge looks at it.
struct Case {
    shapes: [Shape; 2],
    motions: [Motion<'static>; 2],
    config: CastConfig,
    /// Whether poses at fractions of 2⁻¹⁰ are exact.
    is_exact: bool,
}

fn ellipsoid(random: &mut Random, count: usize, half_axes: [f64; 3]) -> Shape {
    let points: Vec<Vector> = (0..count).map(|_| random.direction().component_mul(&Vector::from(half_axes))).collect();
    hull(&points)
}

fn body(random: &mut Random, scale: f64) -> Shape {
    let s = scale;
    match random.below(5) {
        0 => cuboid([0.5 * s, 0.5 * s, 0.5 * s]),
        1 => ellipsoid(random, 20, [s, s, s]),
        2 => ellipsoid(random, 60, [s, 0.3 * s, 0.3 * s]),
        // A needle and a plate.
        3 => ellipsoid(random, 12, [s, 1e-3 * s, 1e-3 * s]),
        _ => cuboid([s, s, 1e-3 * s]),
    }
}

fn screw(random: &mut Random, start: Pose, velocity: Vector, rotation: Vector, scale: f64) -> Motion<'static> {
    let centre = if random.below(3) == 0 { random.vector() * scale } else { Vector::zeros() };
    Motion::Screw(Screw { start, centre, velocity, rotation })
}

/// Bodies that pass each other somewhere near the middle, at a scale, turning by some radians.
fn passing(random: &mut Random, scale: f64, radians: f64) -> Case {
    let smaller = scale * random.pick(&[1.0, 1.0, 0.1]);
    let shapes = [body(random, scale), body(random, smaller)];
    let far = random.pick(&[0.0, 0.0, 10.0, 1e4]) * scale;
    let origin = random.vector() * far;
    let config = CastConfig { time_tolerance: random.pick(&[1e-9, 1e-6, 1e-3, 1e-12]), ..CastConfig::default() };
    let motions = [0, 1].map(|i| {
        let velocity = random.direction() * scale * random.pick(&[0.0, 1.0, 4.0, 30.0]);
        let miss = random.direction() * scale * random.pick(&[0.0, 0.5, 1.0, 1.5, 2.0]) * f64::from(i);
        let turn = random.direction() * radians * random.uniform(0.0, 1.0);
        let start = Pose::new(&random.rotation(), &(origin + miss - velocity * random.uniform(0.2, 0.8)));
        screw(random, start, velocity, turn, scale)
    });
    Case { shapes, motions, config, is_exact: false }
}

/// Boxes with corners on a lattice that move by whole steps of it: they touch at corners, edges and faces, or slide along them.
fn lattice(random: &mut Random) -> Case {
    let side = |random: &mut Random| (1 + random.below(3)) as f64 * 0.5;
    let shapes = [0, 1].map(|_| cuboid([side(random), side(random), side(random)]));
    let motions = [0, 1].map(|_| {
        let start = Pose::new(&random.quarter_turns(), &(random.lattice(6) * 0.5));
        let velocity = random.lattice(8);
        Motion::Screw(Screw { start, centre: Vector::zeros(), velocity, rotation: Vector::zeros() })
    });
    Case { shapes, motions, config: CastConfig::default(), is_exact: true }
}

/// Slivers that turn past each other, and touch about edge to edge.
fn slivers(random: &mut Random) -> Case {
    let thin = random.pick(&[1e-2, 1e-4, 1e-6]);
    let shapes = [cuboid([1.0, thin, thin]), cuboid([1.0, 1.0, thin])];
    let motions = [0, 1].map(|i| {
        let start = Pose::new(&random.rotation(), &(random.vector() * 0.7 * f64::from(i)));
        let (velocity, turn) = (random.vector() * 0.5, random.direction() * random.uniform(0.0, 6.0));
        screw(random, start, velocity, turn, 1.0)
    });
    Case { shapes, motions, config: CastConfig::default(), is_exact: false }
}

/// A turning square whose corner passes a wall at a clearance of a power of ten, from 1e-4 to 1e-12, or in it by as much.
fn grazing(random: &mut Random) -> Case {
    let half = random.uniform(0.2, 1.0);
    let shapes = [cuboid([half, half, 0.3]), cuboid([0.5, 5.0, 5.0])];
    let clearance = 10f64.powi(-4 - random.below(9) as i32) * random.pick(&[1.0, -1.0]);
    let world = Pose::new(&random.rotation(), &random.vector());
    let reach = half * 2f64.sqrt();
    let wall = Pose::new(&world.rotation(), &world.transform(&Vector::new(reach + 0.5 + clearance, 0.0, 0.0)));
    let turn = world.rotate(&Vector::z()) * random.uniform(1.0, 3.0);
    let motions = [
        Motion::Screw(Screw { start: world, centre: Vector::zeros(), velocity: Vector::zeros(), rotation: turn }),
        Motion::Fixed(wall),
    ];
    Case { shapes, motions, config: CastConfig::default(), is_exact: false }
}

/// Between two poses, as a planner has them; some of it with entries that change linearly.
fn edges(random: &mut Random) -> Case {
    let shapes = [body(random, 1.0), body(random, 1.0)];
    let motions = [0, 1].map(|i| {
        let first = Pose::new(&random.rotation(), &(random.vector() * 1.5 * f64::from(i)));
        let small = rotation(&random.direction(), random.uniform(0.0, 0.15)) * first.rotation();
        let is_affine = random.below(2) == 0;
        let turned = if is_affine { small } else { random.rotation() };
        let second = Pose::new(&turned, &(first.translation() + random.vector()));
        if is_affine {
            return Motion::Affine { start: first, end: second };
        }
        Motion::Screw(motion_between(&first, &second, &Vector::zeros(), 2.0).unwrap().0)
    });
    let margin = random.pick(&[0.0, 0.0, 0.05]);
    Case { shapes, motions, config: CastConfig { margin, ..CastConfig::default() }, is_exact: false }
}

fn case(random: &mut Random, round: usize) -> Case {
    match round % 8 {
        0 => lattice(random),
        1 => slivers(random),
        2 => grazing(random),
        3 => edges(random),
        4 => passing(random, 1e6, 2.0),
        5 => passing(random, 1e-6, 2.0),
        6 => passing(random, 1.0, 100.0),
        _ => passing(random, 1.0, random_radians(round)),
    }
}

fn random_radians(round: usize) -> f64 {
    [0.0, 0.3, 2.0, 20.0][round / 8 % 4]
}

/// The judge's own pose: Rodrigues' formula with the machine's sine.
fn pose_at(motion: &Motion, time: f64) -> Pose {
    match motion {
        Motion::Fixed(pose) => *pose,
        Motion::Affine { start, end } => {
            let mut pose = *start;
            for (i, row) in pose.rows.iter_mut().enumerate() {
                for (k, entry) in row.iter_mut().enumerate() {
                    *entry += time * (end.rows[i][k] - *entry);
                }
            }
            pose
        }
        Motion::Screw(Screw { start, centre, velocity, rotation: turn }) => {
            let angle = turn.norm();
            let turned = if angle > 0.0 { rotation(&(turn / angle), angle * time) } else { Matrix::identity() };
            let matrix = if angle > 0.0 { turned * start.rotation() } else { start.rotation() };
            let fixed = if angle > 0.0 { start.rotate(centre) - matrix * centre } else { Vector::zeros() };
            Pose::new(&matrix, &(start.translation() + velocity * time + fixed))
        }
        Motion::Callback(_) => unreachable!("no family has callbacks"),
    }
}

/// Distance if apart, else minus the depth: an interval each.
fn signed_distance(case: &Case, time: f64) -> [f64; 2] {
    let poses = [pose_at(&case.motions[0], time), pose_at(&case.motions[1], time)];
    let bodies = [case.shapes[0].at(&poses[0]), case.shapes[1].at(&poses[1])];
    let mut answer = PairAnswer::default();
    pair::distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
    if answer.outcome == Outcome::Separated {
        return [answer.lower, answer.upper];
    }
    let mut depth = DepthAnswer::default();
    pair::depth(bodies, &mut DepthCache::default(), &DepthConfig::default(), &mut depth).unwrap();
    [-depth.upper, -depth.lower]
}

/// What the judge's own poses may be off, in all.
fn allowance(case: &Case) -> f64 {
    if case.is_exact {
        return 0.0;
    }
    let size = |i: usize| {
        let reach = case.shapes[i].polyhedron().radius;
        match &case.motions[i] {
            Motion::Fixed(pose) => pose.translation().norm() + reach,
            Motion::Affine { start, end } => start.translation().norm() + end.translation().norm() + reach,
            Motion::Screw(screw) => {
                let turning = (1.0 + screw.rotation.norm()) * (reach + screw.centre.norm());
                screw.start.translation().norm() + screw.velocity.norm() + turning
            }
            Motion::Callback(_) => 0.0,
        }
    };
    64.0 * f64::EPSILON * (size(0) + size(1))
}

/// Refutes an answer by verdicts along the motion, if it can.
fn judge(case: &Case, answer: &CastAnswer, samples: u32) -> Option<String> {
    let (margin, allowed) = (case.config.margin, allowance(case));
    let until = answer.t_lo;
    let least = if answer.outcome == CastOutcome::Free { answer.clearance } else { margin };
    // A start in contact is a hit there, and nothing is said of what was before.
    if until > 0.0 {
        for k in 0..=samples {
            let time = if k == samples { until } else { (f64::from(k) / f64::from(samples) * 1024.0).floor() / 1024.0 };
            if time > until {
                continue;
            }
            let [_, upper] = signed_distance(case, time);
            // At a lattice time nothing is rounded; t_lo is not such a time.
            let allowed = if k == samples { allowed.max(1e-14 * case.shapes[0].polyhedron().radius) } else { allowed };
            if upper < least - allowed || (case.is_exact && margin == 0.0 && k < samples && upper <= 0.0) {
                return Some(format!("at {time} they are {upper:e} apart, not {least:e}"));
            }
        }
    }
    match answer.outcome {
        CastOutcome::Hit => {
            let [lower, _] = signed_distance(case, answer.t_hi);
            let allowed = allowed.max(1e-14 * case.shapes[0].polyhedron().radius);
            (lower > margin + allowed).then(|| format!("at t_hi they are {lower:e} apart"))
        }
        CastOutcome::Near => {
            let [lower, _] = signed_distance(case, answer.t_lo);
            (lower > answer.upper + allowed)
                .then(|| format!("at t_lo they are {lower:e} apart, not {:e}", answer.upper))
        }
        CastOutcome::Free | CastOutcome::Budget => None,
        CastOutcome::None => Some("no outcome".into()),
    }
}

/// How often each outcome came, hits wider than the tolerance, and the most queries.
#[derive(Debug, Default)]
struct Tally {
    free: u32,
    hit: u32,
    near: u32,
    budget: u32,
    wide: u32,
    queries: u32,
    unverified: u32,
}

fn judge_many(seed: u64, count: usize, samples: u32) -> Tally {
    let mut random = Random::new(seed);
    let mut tally = Tally::default();
    for round in 0..count {
        let case = case(&mut random, round);
        let bodies = moving([&case.shapes[0], &case.shapes[1]], [&case.motions[0], &case.motions[1]]);
        let answer = run(bodies, &case.config);
        if let Some(refuted) = judge(&case, &answer, samples) {
            panic!("seed {seed:#x}, round {round}: {refuted}\n{:?}\n{:?}\n{answer:?}", case.motions, case.config);
        }
        match answer.outcome {
            CastOutcome::Free => tally.free += 1,
            CastOutcome::Hit => tally.hit += 1,
            CastOutcome::Near => tally.near += 1,
            _ => tally.budget += 1,
        }
        tally.wide += u32::from(answer.t_hi - answer.t_lo > case.config.time_tolerance);
        tally.queries = tally.queries.max(answer.queries);
        if let Err(error) = verify_cast(bodies, &case.config, &answer) {
            tally.unverified += 1;
            println!("seed {seed:#x}, round {round}: {error}\n{:?}\n{:?}\n{answer:?}", case.motions, case.config);
        }
    }
    tally
}

#[test]
fn no_answer_is_refuted_and_all_verify() {
    let tally = judge_many(0x600d, 480, 64);
    println!("{tally:?}");
    assert!(tally.free > 60 && tally.hit > 60, "{tally:?}");
    // Lattice bodies that touch without overlapping, and little else.
    assert!(tally.near < 30 && tally.budget == 0, "{tally:?}");
    assert_eq!(tally.unverified, 0, "{tally:?}");
}

/// By hand: `MOTIONS=40000 SEED=7 cargo test --profile checked --test motion -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn many_answers_are_not_refuted() {
    let number = |name: &str, default: u64| std::env::var(name).map_or(default, |text| text.parse().unwrap());
    let tally = judge_many(number("SEED", 1), number("MOTIONS", 20_000) as usize, 150);
    println!("{tally:?}");
    assert_eq!(tally.unverified, 0, "{tally:?}");
}
