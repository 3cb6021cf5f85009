//! The cast: a sweep from the beginning of a range of times until it ends, or something does.

use super::answer::{CastAnswer, CastOutcome};
use super::carried::{Carried, Moving};
use super::config::CastConfig;
use super::moving::{Moment, MovingPair};
use super::sweep::{Ahead, FreeStep, Sweep, Wanted, upper_bound};
use crate::base::error::Result;
use crate::base::simd::environment::with_default;
use crate::pair::PairCache;

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
    cast_carried(bodies.map(Carried::from), cache, config, answer)
}

/// The same of pieces of moving objects.
///
/// # Errors
/// As of [`cast`].
pub(crate) fn cast_carried(
    bodies: [Carried; 2],
    cache: &mut PairCache,
    config: &CastConfig,
    answer: &mut CastAnswer,
) -> Result<()> {
    with_default(|| {
        config.check()?;
        let pair = MovingPair::new(bodies, config.range())?;
        let mut sweep = Sweep::new(&pair, cache);
        *answer = run(&pair, &mut sweep, config)?;
        *cache = sweep.cache;
        Ok(())
    })
}

fn run(pair: &MovingPair, sweep: &mut Sweep, config: &CastConfig) -> Result<CastAnswer> {
    let wanted = Wanted { max_distance: config.max_distance, with_slack: true, shortest: config.time_tolerance };
    let mut here = pair.at(config.time_begin)?;
    let mut clearance = f64::INFINITY;
    loop {
        let near = sweep.distance(&here)?;
        match sweep.on(&here, &near, config.time_end, &wanted)? {
            Ahead::Free(step) => {
                clearance = clearance.min(clearance_of(&step));
                here = step.ends[1];
            }
            Ahead::Contact(there, contact) => {
                let upper = if config.max_distance == 0.0 { 0.0 } else { upper_bound(&contact, &there) };
                let hit = CastAnswer { time_upper: there.time, upper, contact, ..CastAnswer::default() };
                return Ok(said(CastOutcome::Hit, &here, sweep, hit));
            }
            Ahead::Open => {
                let near_miss = CastAnswer { upper: upper_bound(&near, &here), contact: near, ..CastAnswer::default() };
                return Ok(said(CastOutcome::Near, &here, sweep, near_miss));
            }
        }
        if here.time >= config.time_end {
            let free = CastAnswer { clearance: clearance.max(config.max_distance), ..CastAnswer::default() };
            return Ok(said(CastOutcome::Free, &here, sweep, free));
        }
        if sweep.queries >= config.step_budget {
            return Ok(said(CastOutcome::Budget, &here, sweep, CastAnswer::default()));
        }
    }
}

fn said(outcome: CastOutcome, here: &Moment, sweep: &Sweep, rest: CastAnswer) -> CastAnswer {
    CastAnswer { outcome, time_lower: here.time, queries: sweep.queries, ..rest }
}

/// Less than the sweep has proved, so that another proof need not find the very axis.
fn clearance_of(step: &FreeStep) -> f64 {
    const SHARE: f64 = 1.0 - 1e-9;
    (step.least - step.slack) * SHARE
}
