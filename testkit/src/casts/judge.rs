//! Refutes answers of casts, if it can: by verdicts all along the motion, and by bisection in integers.
//!
//! The judge's poses are computed by formulas of its own. They are off by rounding, so it allows for that: a body is taken for in
//! contact where it is deeper than the allowance, for apart where it is farther. Lattice motions need no allowance: their poses at
//! fractions of 2⁻¹⁰ are exact.

use swiftprox::motion::{CastAnswer, CastOutcome, Motion};
use swiftprox::pair::{self, DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, PairCache, PairConfig};

use super::Case;
use crate::swept::Length;

/// Halvings of the time before a hit.
const HALVINGS: u32 = 40;

/// Vertices of the Minkowski difference by which a depth in integers is bounded.
const DEPTH_LIMIT: usize = 40;

/// Looks at the pair at so many times, each verdict proved, and refutes an answer by one of them.
pub fn by_samples(case: &Case, answer: &CastAnswer, samples: u32) -> Result<(), String> {
    let until = answer.time_lower;
    let least = least_before(case, answer);
    // A start in contact is a hit there, and nothing is said of what was before.
    if until > case.config.time_begin {
        let mut cache = PairCache::default();
        for k in 0..=samples {
            let share = (f64::from(k) / f64::from(samples) * 1024.0).floor() / 1024.0;
            let (begin, end) = (case.config.time_begin, case.config.time_end);
            let time = if k == samples { until } else { begin + share * (end - begin) };
            if time > until {
                continue;
            }
            let [_, upper] = signed_distance(case, time, &mut cache);
            let allowed = allowance_at(case, k == samples);
            let touches = case.is_exact && case.config.max_distance == 0.0 && k < samples && upper <= 0.0;
            if upper < least - allowed || touches {
                return Err(format!("at {time} they are {upper:e} apart, not {least:e}"));
            }
        }
    }
    let cache = &mut PairCache::default();
    let max_distance = case.config.max_distance;
    match answer.outcome {
        CastOutcome::Hit => {
            let [lower, _] = signed_distance(case, answer.time_upper, cache);
            refute(lower > max_distance + allowance_at(case, true), || {
                format!("at time_upper they are {lower:e} apart")
            })
        }
        CastOutcome::Near => {
            let [lower, _] = signed_distance(case, answer.time_lower, cache);
            let off = lower > answer.upper + allowance_at(case, true);
            refute(off, || format!("at time_lower they are {lower:e} apart, not {:e}", answer.upper))
        }
        CastOutcome::Free | CastOutcome::Budget => Ok(()),
        CastOutcome::None => Err("no outcome".into()),
    }
}

/// In integers and rationals, with nothing of the library: of a hit the pair is in contact at `time_upper`, and no time at which
/// bisection from the beginning finds contact lies before `time_lower`; of anything else it is apart at `time_lower`, and where it
/// is nearest.
pub fn by_bisection(case: &Case, answer: &CastAnswer) -> Result<(), String> {
    let points = [0, 1].map(|i| {
        let polyhedron = case.shapes[i].polyhedron();
        (0..polyhedron.vertices.len() as u32).map(|v| polyhedron.local_position(v).into()).collect()
    });
    let exactly = Exactly { case, points };
    let begin = case.config.time_begin;
    if answer.outcome != CastOutcome::Hit {
        let least = least_before(case, answer) - allowance_at(case, true);
        let time = nearest_time(case, begin, answer.time_lower);
        let late = [time, answer.time_lower].into_iter().filter(|_| answer.time_lower > begin);
        return match late.into_iter().find(|&time| exactly.is_closer(time, least)) {
            Some(time) => Err(format!("at {time} they are less than {least:e} apart, in integers")),
            None => Ok(()),
        };
    }
    let max_distance = case.config.max_distance;
    if !exactly.is_within(answer.time_upper, max_distance + allowance_at(case, true)) {
        return Err("at time_upper they are apart, in integers".into());
    }
    if answer.time_upper == begin || exactly.is_within(begin, max_distance) {
        return Ok(());
    }
    // Distances guide it; what integers say of the time that it comes to holds whatever they said.
    let (mut apart, mut within) = (begin, answer.time_upper);
    let mut cache = PairCache::default();
    for _ in 0..HALVINGS {
        let middle = 0.5 * (apart + within);
        let is_within = signed_distance(case, middle, &mut cache)[0] <= max_distance;
        *(if is_within { &mut within } else { &mut apart }) = middle;
    }
    let is_early = within < answer.time_lower && exactly.is_closer(within, max_distance - allowance_at(case, true));
    refute(is_early, || {
        format!("at {within}, before time_lower, they are no farther apart than {max_distance:e}, in integers")
    })
}

fn refute(is_refuted: bool, why: impl FnOnce() -> String) -> Result<(), String> {
    if is_refuted { Err(why()) } else { Ok(()) }
}

/// What an answer says of all times before `time_lower`.
fn least_before(case: &Case, answer: &CastAnswer) -> f64 {
    if answer.outcome == CastOutcome::Free { answer.clearance } else { case.config.max_distance }
}

/// Distance if apart, else minus the depth: an interval each.
fn signed_distance(case: &Case, time: f64, cache: &mut PairCache) -> [f64; 2] {
    let poses = case.poses(time);
    let bodies = [case.shapes[0].at(&poses[0]), case.shapes[1].at(&poses[1])];
    let mut answer = PairAnswer::default();
    pair::distance(bodies, cache, &PairConfig::default(), &mut answer).unwrap();
    if answer.outcome == Outcome::Separated {
        return [answer.lower, answer.upper];
    }
    let mut depth = DepthAnswer::default();
    pair::depth(bodies, &mut DepthCache::default(), &DepthConfig::default(), &mut depth).unwrap();
    [-depth.upper, -depth.lower]
}

/// About when the pair is nearest: a guess by samples and golden section. What is asked there holds whenever it is.
fn nearest_time(case: &Case, begin: f64, end: f64) -> f64 {
    const SAMPLES: u32 = 32;
    let mut cache = PairCache::default();
    let mut at = |time: f64| signed_distance(case, time, &mut cache)[1];
    let part = (end - begin) / f64::from(SAMPLES);
    let times = (0..=SAMPLES).map(|k| begin + part * f64::from(k));
    let (_, mut best) = times.map(|time| (at(time), time)).min_by(|a, b| a.0.total_cmp(&b.0)).expect("samples");
    let mut least = at(best);
    let mut reach = part;
    while reach > 1e-9 * (end - begin) {
        for time in [(best - reach).max(begin), (best + reach).min(end)] {
            let distance = at(time);
            if distance < least {
                (least, best) = (distance, time);
            }
        }
        reach *= 0.5;
    }
    best
}

/// The judge's own, or of a lattice less; at a time that is no fraction of 2⁻¹⁰ poses of a lattice are rounded, too.
fn allowance_at(case: &Case, is_rounded: bool) -> f64 {
    if case.is_exact {
        return if is_rounded { 1e-14 * case.shapes[0].polyhedron().radius } else { 0.0 };
    }
    allowance(case)
}

/// What poses by the judge's formulas may be off, in all.
pub fn allowance(case: &Case) -> f64 {
    let size = |i: usize| {
        let reach = case.shapes[i].polyhedron().radius;
        match &case.motions[i] {
            Motion::Fixed(pose) => pose.translation().norm() + reach,
            Motion::Affine { start, end } => start.translation().norm() + end.translation().norm() + reach,
            Motion::Screw(screw) => {
                let turning = (1.0 + screw.rotation.norm()) * (reach + screw.centre.norm());
                screw.start.translation().norm() + screw.velocity.norm() + turning
            }
            Motion::Callback(callback) => callback.rounding,
        }
    };
    64.0 * f64::EPSILON * (size(0) + size(1))
}

/// A pair whose poses are taken as the doubles have them.
struct Exactly<'a> {
    case: &'a Case,
    points: [Vec<[f64; 3]>; 2],
}

impl Exactly<'_> {
    /// Whether they are no farther apart than `most`, from 0 on.
    fn is_within(&self, time: f64, most: f64) -> bool {
        self.length(time, 0).compared_with(most).is_le()
    }

    /// Whether they are nearer than `least`; if that is negative, surely deeper in each other than as much.
    fn is_closer(&self, time: f64, least: f64) -> bool {
        self.length(time, if least > 0.0 { 0 } else { DEPTH_LIMIT }).compared_with(least).is_lt()
    }

    /// The signed distance or more.
    fn length(&self, time: f64, limit: usize) -> Length {
        let radii = self.case.shapes.each_ref().map(|shape| shape.swept_radius());
        Length::signed([&self.points[0], &self.points[1]], &self.case.poses(time), radii, limit).0
    }
}
