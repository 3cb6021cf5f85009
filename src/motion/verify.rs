//! The independent check of a cast, from the motions alone.

use super::answer::{CastAnswer, CastOutcome};
use super::bound::least_between;
use super::carried::Moving;
use super::config::{CastConfig, shortest_step};
use super::moving::{Moment, MovingPair};
use super::sweep::{Ahead, FreeStep, Sweep, Wanted, depth_at, is_contact, upper_bound};
use crate::base::error::{Error, Result};
use crate::pair::verify::{Bounds, holds_ball, in_default, verify, verify_depth};
use crate::pair::{DepthCache, Outcome, PairCache, sum_above};

/// Steps after which a proof is given up.
const MOST_STEPS: u32 = 1_000_000;

/// Re-checks an answer of [`super::cast`] for the same motions and configuration.
///
/// | outcome | what is proved |
/// |---|---|
/// | [`CastOutcome::Free`] | farther apart than the margin, and at least `clearance`, at every time of the range |
/// | [`CastOutcome::Hit`] | farther apart than the margin from the beginning to `t_lo`; no farther, and no farther than `upper`, at `t_hi` |
/// | [`CastOutcome::Near`] | farther apart than the margin from the beginning to `t_lo`; no farther than `upper` there |
/// | [`CastOutcome::Budget`] | farther apart than the margin from the beginning to `t_lo` |
///
/// If `t_lo` is the beginning, nothing is proved about it. `contact` is checked as an answer about the poses there. How many
/// queries were made is not checked, nor how narrow the interval of a hit is.
///
/// A sweep of its own, from no cache, proposes steps and directions. Each is proved anew: the gaps at both ends over all vertices
/// in double-double arithmetic, and contact by the check of a depth. So it takes time in proportion to the steps and to the
/// vertices.
///
/// # Errors
/// [`Error::Unverified`] with what does not hold, or could not be proved; [`Error::Argument`] for an answer that holds no outcome;
/// else as [`super::cast`] and [`crate::pair::verify::verify`].
pub fn verify_cast(bodies: [Moving; 2], config: &CastConfig, answer: &CastAnswer) -> Result<()> {
    in_default(|| {
        config.check()?;
        let pair = MovingPair::new(bodies, config.range())?;
        check_times(config, answer)?;
        match answer.outcome {
            CastOutcome::None => Err(Error::Argument("the answer holds no outcome".into())),
            CastOutcome::Free => {
                if !(answer.clearance >= config.margin && answer.clearance < f64::INFINITY) {
                    return Err(unverified(format!(
                        "a clearance of {:?} beyond {:?}",
                        answer.clearance, config.margin
                    )));
                }
                prove_free(&pair, config, answer.t_lo, answer.clearance)
            }
            CastOutcome::Hit => {
                prove_free_before(&pair, config, answer.t_lo)?;
                prove_contact(&pair, config.margin, answer)
            }
            CastOutcome::Near => {
                prove_free_before(&pair, config, answer.t_lo)?;
                let there = pair.at(answer.t_lo)?;
                check_upper(&pair, &there, answer)
            }
            CastOutcome::Budget => prove_free_before(&pair, config, answer.t_lo),
        }
    })
}

/// Whether an answer contains what its outcome allows, for times in the range.
fn check_times(config: &CastConfig, answer: &CastAnswer) -> Result<()> {
    let CastAnswer { outcome, t_lo, t_hi, clearance, upper, .. } = *answer;
    let [begin, end] = config.range();
    let is_in_range = |time: f64| (begin..=end).contains(&time);
    let (is_hit, is_free) = (outcome == CastOutcome::Hit, outcome == CastOutcome::Free);
    let times_hold = is_in_range(t_lo)
        && (!is_free || t_lo == end)
        && if is_hit { is_in_range(t_hi) && t_lo <= t_hi } else { t_hi.is_nan() };
    let says_distance = is_hit || outcome == CastOutcome::Near;
    let numbers_hold = clearance.is_nan() != is_free && if says_distance { upper >= 0.0 } else { upper.is_nan() };
    let contact_holds = says_distance || answer.contact.outcome == Outcome::None;
    if outcome == CastOutcome::None || (times_hold && numbers_hold && contact_holds) {
        return Ok(());
    }
    Err(unverified(format!(
        "it is {outcome:?} and says t_lo {t_lo:?}, t_hi {t_hi:?}, clearance {clearance:?}, upper {upper:?} and a contact that is \
         {:?}, of times from {begin:?} to {end:?}",
        answer.contact.outcome
    )))
}

fn prove_free_before(pair: &MovingPair, config: &CastConfig, end: f64) -> Result<()> {
    if end > pair.range()[0] { prove_free(pair, config, end, config.margin) } else { Ok(()) }
}

/// Farther apart than the margin from the beginning to `end`: by the steps of a cast, else by any.
fn prove_free(pair: &MovingPair, config: &CastConfig, end: f64, margin: f64) -> Result<()> {
    let of_cast = Wanted { margin: config.margin, with_slack: true, shortest: config.time_tolerance };
    let any = Wanted { margin, with_slack: false, shortest: shortest_step(pair.range()) };
    match prove_steps(pair, &of_cast, end, margin) {
        Err(Error::Unverified(_)) => prove_steps(pair, &any, end, margin),
        proved => proved,
    }
}

/// Farther apart than the margin in each step of a sweep to `end`.
fn prove_steps(pair: &MovingPair, wanted: &Wanted, end: f64, margin: f64) -> Result<()> {
    let mut sweep = Sweep::new(pair, &PairCache::default());
    let mut here = pair.at(pair.range()[0])?;
    for _ in 0..MOST_STEPS {
        let near = sweep.distance(&here)?;
        match sweep.on(&here, &near, end, wanted)? {
            Ahead::Free(step) => {
                check_step(pair, &step, margin)?;
                here = step.ends[1];
            }
            Ahead::Contact(there, _) => {
                return Err(unverified(format!(
                    "at time {:?} the objects are no farther apart than {margin:?}",
                    there.time
                )));
            }
            Ahead::Open => break,
        }
        if here.time >= end {
            return Ok(());
        }
    }
    Err(unverified(format!(
        "beyond time {:?} the objects are not proved to be farther apart than {margin:?}",
        here.time
    )))
}

/// Proves a step: that its gaps are the claimed ones, at poses computed anew, and that they suffice.
fn check_step(pair: &MovingPair, step: &FreeStep, margin: f64) -> Result<()> {
    let [start, end] = step.ends.map(|moment| moment.time);
    let moments = [pair.at(start)?, pair.at(end)?];
    for ((moment, direction), gap) in moments.iter().zip(&step.directions).zip(step.gaps) {
        let time = moment.time;
        let bodies = pair.placed(moment);
        let bounds = Bounds::new(bodies.map(|body| body.shape.polyhedron()), bodies.map(|body| body.pose));
        // The gap that the poses must show for the motion, which is as far from them as they are rounded.
        let needed = sum_above((gap + moment.rounding).next_up(), pair.swept());
        if !bounds.is_some_and(|bounds| bounds.prove_lower(&bounds.gap(direction), direction, needed)) {
            return Err(unverified(format!("a gap of {needed:e} at time {time:?} is not proved")));
        }
    }
    let [first, last] = &step.directions;
    let least = least_between(step.gaps, pair.sag([&moments[0], &moments[1]], [first, last]));
    if least > margin {
        return Ok(());
    }
    Err(unverified(format!("from time {start:?} to {end:?} the objects may be {least:e} apart")))
}

fn prove_contact(pair: &MovingPair, margin: f64, answer: &CastAnswer) -> Result<()> {
    let there = pair.at(answer.t_hi)?;
    if !is_contact(&answer.contact, &there, margin) {
        return Err(unverified(format!("no contact within {margin:?} at time {:?}", answer.t_hi)));
    }
    if margin > 0.0 {
        return check_upper(pair, &there, answer);
    }
    verify(pair.placed(&there), &answer.contact)?;
    if there.rounding == 0.0 || holds_ball(pair.placed(&there), &answer.contact, there.rounding.next_up()) {
        return Ok(());
    }
    let mut cache = DepthCache::default();
    let depth = depth_at(pair, &there, &mut cache)?;
    verify_depth(pair.placed(&there), &cache, &depth)?;
    if depth.lower > there.rounding {
        return Ok(());
    }
    Err(unverified(format!("at time {:?} rounding hides whether the objects intersect", answer.t_hi)))
}

/// The answer about the poses of a moment holds, and `upper` for the motion.
fn check_upper(pair: &MovingPair, there: &Moment, answer: &CastAnswer) -> Result<()> {
    verify(pair.placed(there), &answer.contact)?;
    let least = upper_bound(&answer.contact, there);
    if least <= answer.upper {
        return Ok(());
    }
    Err(unverified(format!(
        "at time {:?} the objects are proved to be at most {least:e} apart, not {:e}",
        there.time, answer.upper
    )))
}

fn unverified(what: String) -> Error {
    Error::Unverified(format!("the answer does not hold: {what}"))
}
