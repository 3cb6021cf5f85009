//! The independent check of a cast, from the motions alone.

use super::answer::{CastAnswer, CastOutcome};
use super::bound::least_between;
use super::carried::{Carried, Moving};
use super::cast::wanted;
use super::config::{CastConfig, shortest_step};
use super::moving::{Moment, MovingPair};
use super::sweep::{Ahead, FreeStep, MOST_DOUBLINGS, Sweep, SweepGoal, after, depth_at, is_contact, upper_bound};
use crate::answer::sum_above;
use crate::base::error::{Error, Result};
use crate::pair::{DepthCache, Outcome, PairAnswer, PairCache, PairConfig, contact};
use crate::placed::Pair;
use crate::verify::{Bounds, holds_ball, in_default, verify, verify_depth};

/// A proof is given up after this much work: a query is one, an iteration in integers takes as long as ten. Steps that no longer
/// come forward would take minutes where integers answer.
const MOST_WORK: u64 = 2_000_000;

/// Re-checks an answer of [`super::cast`] for the same motions and configuration.
///
/// | outcome | what is proved |
/// |---|---|
/// | [`CastOutcome::Free`] | farther apart than `max_distance`, and at least `clearance`, at every time of the range |
/// | [`CastOutcome::Hit`] | farther apart than `max_distance` from the beginning to `time_lower`; no farther, and no farther than `upper`, at `time_upper` |
/// | [`CastOutcome::Near`] | farther apart than `max_distance` from the beginning to `time_lower`; no farther than `upper` there |
/// | [`CastOutcome::Budget`] | farther apart than `max_distance` from the beginning to `time_lower` |
///
/// The beginning is `time_parted`, if that is set: nothing is proved about times before. If `time_lower` is the beginning, nothing
/// is proved about it. `contact` is checked as an answer about the poses at `time_lower`, `proof` as one about those at
/// `time_upper`. How many queries were made is not checked, nor how narrow the interval of a hit is.
///
/// A sweep of its own, from no cache, proposes steps and directions. Each is proved anew: the gaps at both ends over all vertices
/// in double-double arithmetic, and contact by the check of a depth. So it takes time in proportion to the steps and to the
/// vertices. Where each step needs integers the check gives up after some seconds, and its message says so.
///
/// # Errors
/// [`Error::Unverified`] with what does not hold, or could not be proved; [`Error::Argument`] for an answer that holds no outcome;
/// else as [`super::cast`] and [`crate::verify::verify`].
pub fn verify_cast(bodies: [Moving; 2], config: &CastConfig, answer: &CastAnswer) -> Result<()> {
    verify_carried(bodies.map(Carried::from), config, answer)
}

/// The same of pieces of moving objects.
///
/// # Errors
/// As of [`verify_cast`].
pub(crate) fn verify_carried(bodies: [Carried; 2], config: &CastConfig, answer: &CastAnswer) -> Result<()> {
    in_default(|| {
        config.check()?;
        MovingPair::new(bodies, config.range())?;
        check_times(config, answer)?;
        let begin = if answer.time_parted.is_nan() { config.time_begin } else { answer.time_parted };
        let config = &CastConfig { time_begin: begin, ..*config };
        let pair = MovingPair::new(bodies, config.range())?;
        match answer.outcome {
            CastOutcome::None => Err(Error::Argument("the answer holds no outcome".into())),
            CastOutcome::Free => {
                if !(answer.clearance >= config.max_distance && answer.clearance < f64::INFINITY) {
                    return Err(unverified(format!(
                        "a clearance of {:?} beyond {:?}",
                        answer.clearance, config.max_distance
                    )));
                }
                prove_free(&pair, config, answer.time_lower, answer.clearance)
            }
            CastOutcome::Hit => {
                prove_free_before(&pair, config, answer.time_lower)?;
                check_contact(&pair, config.max_distance, answer)?;
                prove_contact(&pair, config.max_distance, answer)
            }
            CastOutcome::Near => {
                prove_free_before(&pair, config, answer.time_lower)?;
                let there = pair.at(answer.time_lower)?;
                check_upper(&pair, &there, &answer.contact, answer.upper)
            }
            CastOutcome::Budget => prove_free_before(&pair, config, answer.time_lower),
        }
    })
}

/// Whether an answer contains what its outcome allows, for times in the range.
fn check_times(config: &CastConfig, answer: &CastAnswer) -> Result<()> {
    let CastAnswer { outcome, time_lower, time_upper, clearance, upper, .. } = *answer;
    let [first, end] = config.range();
    let latest = after(first, config.time_tolerance * f64::from(1 << MOST_DOUBLINGS)).min(end);
    let parted = answer.time_parted;
    let parted_holds = parted.is_nan() || (config.ignores_parting && (first..=latest).contains(&parted));
    let begin = if parted.is_nan() { first } else { parted };
    let is_in_range = |time: f64| (begin..=end).contains(&time);
    let (is_hit, is_free) = (outcome == CastOutcome::Hit, outcome == CastOutcome::Free);
    let times_hold = parted_holds
        && is_in_range(time_lower)
        && (!is_free || time_lower == end)
        && if is_hit { is_in_range(time_upper) && time_lower <= time_upper } else { time_upper.is_nan() };
    let says_distance = is_hit || outcome == CastOutcome::Near;
    let numbers_hold = clearance.is_nan() != is_free && if says_distance { upper >= 0.0 } else { upper.is_nan() };
    let contact_holds =
        (says_distance || answer.contact.outcome == Outcome::None) && (is_hit || answer.proof_count == 0);
    if outcome == CastOutcome::None || (times_hold && numbers_hold && contact_holds) {
        return Ok(());
    }
    Err(unverified(format!(
        "it is {outcome:?} and says time_lower {time_lower:?}, time_upper {time_upper:?}, clearance {clearance:?}, upper {upper:?}, {} vertex pairs \
         and a contact that is {:?}, of times from {begin:?} to {end:?}",
        answer.proof_count, answer.contact.outcome
    )))
}

fn prove_free_before(pair: &MovingPair, config: &CastConfig, end: f64) -> Result<()> {
    if end > pair.range()[0] { prove_free(pair, config, end, config.max_distance) } else { Ok(()) }
}

/// Farther apart than `max_distance` from the beginning to `end`: by the steps of a cast, else by any.
fn prove_free(pair: &MovingPair, config: &CastConfig, end: f64, max_distance: f64) -> Result<()> {
    let of_cast = wanted(config);
    let any = SweepGoal { max_distance, with_slack: false, shortest: shortest_step(pair.range()) };
    let mut work = 0;
    match prove_steps(pair, &of_cast, end, max_distance, &mut work) {
        Err(Error::Unverified(_)) if work < MOST_WORK => prove_steps(pair, &any, end, max_distance, &mut work),
        proved => proved,
    }
}

/// Farther apart than `max_distance` in each step of a sweep to `end`. Adds to `work`.
fn prove_steps(pair: &MovingPair, wanted: &SweepGoal, end: f64, max_distance: f64, work: &mut u64) -> Result<()> {
    let before = *work;
    let mut sweep = Sweep::new(pair, &PairCache::default());
    let mut here = pair.at(pair.range()[0])?;
    loop {
        *work = before + u64::from(sweep.queries) + 10 * sweep.exact_iterations;
        if *work >= MOST_WORK {
            return Err(unverified(format!("the check gives up at time {:?}, after much work in integers", here.time)));
        }
        let near = sweep.distance(&here)?;
        match sweep.on(&here, &near, end, wanted)? {
            Ahead::Free(step) => {
                check_step(pair, &step, max_distance)?;
                here = step.ends[1];
            }
            Ahead::Contact(there, _) => {
                return Err(unverified(format!(
                    "at time {:?} the objects are no farther apart than {max_distance:?}",
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
        "beyond time {:?} the objects are not proved to be farther apart than {max_distance:?}",
        here.time
    )))
}

/// Proves a step: that its gaps are the claimed ones, at poses computed anew, and that they suffice.
fn check_step(pair: &MovingPair, step: &FreeStep, max_distance: f64) -> Result<()> {
    let [start, end] = step.ends.map(|moment| moment.time);
    let moments = [pair.at(start)?, pair.at(end)?];
    for ((moment, direction), gap) in moments.iter().zip(&step.directions).zip(step.gaps) {
        let time = moment.time;
        let bodies = pair.placed(moment);
        let bounds = Bounds::new(&Pair::of(&bodies));
        // The gap that the poses must show for the motion, which is as far from them as they are rounded.
        let needed = sum_above((gap + moment.rounding).next_up(), pair.swept());
        if !bounds.is_some_and(|bounds| bounds.prove_lower(&bounds.gap(direction), direction, needed)) {
            return Err(unverified(format!("a gap of {needed:e} at time {time:?} is not proved")));
        }
    }
    let [first, last] = &step.directions;
    let least = least_between(step.gaps, pair.sag([&moments[0], &moments[1]], [first, last]));
    if least > max_distance {
        return Ok(());
    }
    Err(unverified(format!("from time {start:?} to {end:?} the objects may be {least:e} apart")))
}

/// The answer about the poses at `time_lower` holds, where the objects are apart, or in contact at the beginning already.
fn check_contact(pair: &MovingPair, max_distance: f64, answer: &CastAnswer) -> Result<()> {
    let here = pair.at(answer.time_lower)?;
    let contact = &answer.contact;
    let is_begun = answer.time_lower == pair.range()[0];
    let is_said = match contact.outcome {
        Outcome::Separated => answer.time_lower < answer.time_upper || is_contact(contact, &here, max_distance),
        Outcome::Intersecting => is_begun,
        _ => false,
    };
    if !is_said {
        return Err(unverified(format!("a contact at time {:?} that is {:?}", answer.time_lower, contact.outcome)));
    }
    verify(pair.placed(&here), contact)
}

/// At `time_upper` the objects are no farther apart than `max_distance`: by the answer's vertex pairs, or by a query of the check.
fn prove_contact(pair: &MovingPair, max_distance: f64, answer: &CastAnswer) -> Result<()> {
    let there = pair.at(answer.time_upper)?;
    let bodies = || pair.placed(&there);
    if answer.proof_count > 0 {
        let CastAnswer { proof, proof_count, .. } = *answer;
        if max_distance > 0.0 {
            return Err(unverified("vertex pairs of an intersection, of objects asked for a distance".into()));
        }
        let meet = PairAnswer {
            outcome: Outcome::Intersecting,
            distance: 0.0,
            lower: 0.0,
            upper: 0.0,
            proof,
            proof_count,
            ..PairAnswer::default()
        };
        verify(bodies(), &meet)?;
        if there.rounding == 0.0 || holds_ball(bodies(), &meet, there.rounding.next_up()) {
            return Ok(());
        }
    } else {
        let mut own = PairAnswer::default();
        contact(bodies(), &mut PairCache::default(), &PairConfig::default(), &mut own)?;
        if !is_contact(&own, &there, max_distance) {
            return Err(unverified(format!("no contact within {max_distance:?} at time {:?}", answer.time_upper)));
        }
        if max_distance > 0.0 {
            return check_upper(pair, &there, &own, answer.upper);
        }
        verify(bodies(), &own)?;
        if there.rounding == 0.0 || holds_ball(bodies(), &own, there.rounding.next_up()) {
            return Ok(());
        }
    }
    let mut cache = DepthCache::default();
    let depth = depth_at(pair, &there, &mut cache)?;
    verify_depth(bodies(), &cache, &depth)?;
    if depth.lower > there.rounding {
        return Ok(());
    }
    Err(unverified(format!("at time {:?} rounding hides whether the objects intersect", answer.time_upper)))
}

/// An answer about the poses of a moment holds, and `upper` for the motion.
fn check_upper(pair: &MovingPair, there: &Moment, near: &PairAnswer, upper: f64) -> Result<()> {
    verify(pair.placed(there), near)?;
    let least = upper_bound(near, there);
    if least <= upper {
        return Ok(());
    }
    Err(unverified(format!(
        "at time {:?} the objects are proved to be at most {least:e} apart, not {:e}",
        there.time, upper
    )))
}

fn unverified(what: String) -> Error {
    Error::Unverified(format!("the answer does not hold: {what}"))
}
