//! The cast: far pairs by one step, others by looks ahead, and what these leave by a sweep from there to the end of the range or
//! to contact.

use super::answer::{CastAnswer, CastOutcome};
use super::carried::{Carried, Moving};
use super::config::CastConfig;
use super::looks::{MOST_LOOKS, Shown, Way, look_ahead};
use super::moving::{Moment, MovingPair};
use super::sweep::{Ahead, Sweep, SweepGoal, upper_bound};
use crate::base::error::Result;
use crate::base::simd::environment::with_default;
use crate::pair::{Outcome, PairAnswer, PairCache};

/// Whether two moving objects stay farther apart than `max_distance`, or when they first do not. Certain for the motions exactly as
/// they are described: rounding of poses and times is accounted for.
///
/// The cache is one of [`crate::pair`]; it changes how long the cast takes, and where between two proofs a time lies, never what
/// holds.
///
/// # Errors
/// [`Error::Argument`](crate::base::error::Error::Argument) for a member of `config` that is out of range, for motions that are not
/// finite or too large, and for a callback that shows that it breaks its bound; [`Error::Pose`](crate::base::error::Error::Pose)
/// for a pose that no query accepts. Then `answer` and `cache` are as they were.
pub fn cast(bodies: [Moving; 2], cache: &mut PairCache, config: &CastConfig, answer: &mut CastAnswer) -> Result<()> {
    cast_carried(bodies.map(Carried::from), config.range(), cache, config, answer)
}

/// The same of pieces of moving objects, as a part of a cast over a range that is no shorter: its check bounds rounding for all of
/// that.
///
/// # Errors
/// As of [`cast`].
pub(crate) fn cast_carried(
    bodies: [Carried; 2],
    range: [f64; 2],
    cache: &mut PairCache,
    config: &CastConfig,
    answer: &mut CastAnswer,
) -> Result<()> {
    with_default(|| {
        config.check()?;
        debug_assert!(range[0] <= config.time_begin && config.time_end <= range[1]);
        let pair = MovingPair::new(bodies, range)?;
        let mut sweep = Sweep::new(&pair, cache);
        *answer = run(&pair, &mut sweep, config)?;
        *cache = sweep.cache;
        Ok(())
    })
}

/// The distance of two pieces of moving objects at a time of the range, as an answer's [`CastAnswer::contact`] has it.
///
/// # Errors
/// As of [`cast`].
pub(crate) fn distance_at(bodies: [Carried; 2], config: &CastConfig, time: f64) -> Result<PairAnswer> {
    debug_assert!((config.time_begin..=config.time_end).contains(&time));
    with_default(|| {
        let pair = MovingPair::new(bodies, config.range())?;
        let mut sweep = Sweep::new(&pair, &PairCache::default());
        let here = pair.at(time)?;
        sweep.distance(&here)
    })
}

fn run<'a>(pair: &'a MovingPair<'a>, sweep: &mut Sweep<'a>, config: &CastConfig) -> Result<CastAnswer> {
    debug_assert!(config.time_begin <= config.time_end);
    let wanted = wanted(config);
    let start = pair.at(config.time_begin)?;
    let parted = if config.ignores_parting { sweep.parted(&start, config.time_end, &wanted)? } else { None };
    let answer = run_from(pair, sweep, parted.unwrap_or(start), config)?;
    Ok(CastAnswer { time_parted: parted.map_or(f64::NAN, |moment| moment.time), ..answer })
}

fn run_from<'a>(
    pair: &'a MovingPair<'a>,
    sweep: &mut Sweep<'a>,
    mut here: Moment,
    config: &CastConfig,
) -> Result<CastAnswer> {
    let wanted = wanted(config);
    let mut least = f64::INFINITY;
    if here.time < config.time_end {
        let mut at_end = None;
        if let Some(least) = sweep.far(&here, config.time_end, &wanted, &mut at_end)? {
            return Ok(free(sweep, config, least));
        }
        // How fast a callback moves takes another call of it; and its poses are checked where steps end.
        if !pair.has_callback() && config.step_budget > MOST_LOOKS {
            match look_ahead(pair, sweep, &here, at_end, config)? {
                Way::Free { least } => return Ok(free(sweep, config, least)),
                Way::Hit { times, contact, shown } => return Ok(hit(sweep, times, contact, shown)),
                Way::Open { here: proved, least: left } => (here, least) = (proved, left),
            }
        }
    }
    loop {
        let near = sweep.distance(&here)?;
        match sweep.on(&here, &near, config.time_end, &wanted)? {
            Ahead::Free(step) => {
                least = least.min(step.least - step.slack - config.max_distance);
                here = step.ends[1];
            }
            Ahead::Contact(there, contact) => {
                let shown = Shown::by(&contact, &there, config.max_distance);
                let is_here = there.time == here.time;
                let contact = match near.outcome {
                    Outcome::Separated if !is_here => near,
                    _ if is_here => contact,
                    _ => sweep.contact(&here)?,
                };
                return Ok(hit(sweep, [here.time, there.time], contact, shown));
            }
            Ahead::Open => {
                let upper = upper_bound(&near, &here);
                let near_miss = CastAnswer { upper, contact: near, ..CastAnswer::default() };
                return Ok(said(CastOutcome::Near, here.time, sweep, near_miss));
            }
        }
        if here.time >= config.time_end {
            return Ok(free(sweep, config, least));
        }
        if sweep.queries >= config.step_budget {
            return Ok(said(CastOutcome::Budget, here.time, sweep, CastAnswer::default()));
        }
    }
}

/// A cast's steps; those of its check are to find them, too.
pub(super) fn wanted(config: &CastConfig) -> SweepGoal {
    SweepGoal { max_distance: config.max_distance, with_slack: true, shortest: config.time_tolerance }
}

/// Farther apart than `max_distance` by that much, beyond all slack.
fn free(sweep: &Sweep, config: &CastConfig, least: f64) -> CastAnswer {
    /// Less than is proved, so that another proof need not find the very axis.
    const SHARE: f64 = 1.0 - 1e-9;
    let clearance = ((config.max_distance + least) * SHARE).max(config.max_distance);
    let free =
        CastAnswer { outcome: CastOutcome::Free, time_lower: config.time_end, clearance, ..CastAnswer::default() };
    CastAnswer { queries: sweep.queries, ..free }
}

/// Apart up to the first time, where the contact is told, and shown to be in contact at the second.
fn hit(sweep: &Sweep, [here, there]: [f64; 2], contact: PairAnswer, shown: Shown) -> CastAnswer {
    let Shown { upper, proof, proof_count } = shown;
    let hit = CastAnswer { time_upper: there, upper, contact, proof, proof_count, ..CastAnswer::default() };
    said(CastOutcome::Hit, here, sweep, hit)
}

fn said(outcome: CastOutcome, time_lower: f64, sweep: &Sweep, rest: CastAnswer) -> CastAnswer {
    CastAnswer { outcome, time_lower, queries: sweep.queries, ..rest }
}
