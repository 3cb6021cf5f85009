//! The smallest distance over a motion.

use super::carried::Moving;
use super::config::{check_times, shortest_step};
use super::moving::{Moment, MovingPair};
use super::sweep::{Ahead, Sweep, SweepGoal, upper_bound};
use crate::answer::check_accuracy;
use crate::base::error::Result;
use crate::base::simd::environment::with_default;
use crate::pair::{Outcome, PairCache};

/// How a clearance is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClearanceConfig {
    /// The start of the range of times; by default 0.
    pub time_begin: f64,
    /// The end of the range, not before it begins; by default 1.
    pub time_end: f64,
    /// `upper` − `lower` may be as large as this …
    pub absolute_error: f64,
    /// … or as this times `lower`; by default 0.01. Both 0: as narrow as can be proved.
    pub relative_error: f64,
    /// Certified queries after which it stops with its proved result, 1 or more; by default 100,000.
    pub step_budget: u32,
}

impl Default for ClearanceConfig {
    fn default() -> Self {
        ClearanceConfig {
            time_begin: 0.0,
            time_end: 1.0,
            absolute_error: 0.0,
            relative_error: 0.01,
            step_budget: 100_000,
        }
    }
}

/// The smallest distance of two objects over a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Clearance {
    /// They are at least this far apart at every time.
    pub lower: f64,
    /// They are at most this far apart at `time`; 0 where they intersect.
    pub upper: f64,
    /// A time of the range.
    pub time: f64,
    /// Certified queries made.
    pub queries: u32,
}

impl Default for Clearance {
    fn default() -> Self {
        Clearance { lower: f64::NAN, upper: f64::NAN, time: f64::NAN, queries: 0 }
    }
}

/// The smallest distance of two moving objects as an interval: as narrow as asked for, or as can be proved. It is wider where the
/// step budget runs out, or where rounding of poses hides more.
///
/// # Errors
/// As [`super::cast`]. Then `answer` and `cache` are as they were.
pub fn clearance(
    bodies: [Moving; 2],
    cache: &mut PairCache,
    config: &ClearanceConfig,
    answer: &mut Clearance,
) -> Result<()> {
    with_default(|| {
        let range = [config.time_begin, config.time_end];
        check_times(range)?;
        check_accuracy(config.absolute_error, config.relative_error, config.step_budget)?;
        let pair = MovingPair::new(bodies, range)?;
        let mut search = ClearanceSearch {
            pair: &pair,
            sweep: Sweep::new(&pair, cache),
            config,
            upper: f64::INFINITY,
            time: config.time_begin,
            error: pair.deviation(),
        };
        *answer = search.run()?;
        *cache = search.sweep.cache;
        Ok(())
    })
}

/// Times at which the distance is asked for at first, beside the ends.
const SAMPLES: u32 = 3;

/// Rounds of golden section around the smallest distance that is known.
const ROUNDS: u32 = 10;

/// Doublings of the error where nothing better can be proved.
const MOST_RELAXATIONS: u32 = 40;

struct ClearanceSearch<'a> {
    pair: &'a MovingPair<'a>,
    sweep: Sweep<'a>,
    config: &'a ClearanceConfig,
    /// The smallest distance that is known, and when.
    upper: f64,
    time: f64,
    /// The least amount by which the gap asked for is less than the known distance.
    error: f64,
}

impl ClearanceSearch<'_> {
    fn run(&mut self) -> Result<Clearance> {
        let [begin, end] = self.pair.range();
        self.look_around(begin, end)?;
        let lower = self.prove(begin, end)?;
        Ok(Clearance { lower: lower.min(self.upper), upper: self.upper, time: self.time, queries: self.sweep.queries })
    }

    /// Distances here and there, and around the smallest.
    fn look_around(&mut self, begin: f64, end: f64) -> Result<()> {
        let part = (end - begin) / f64::from(SAMPLES + 1);
        for k in 0..=SAMPLES + 1 {
            let time = if k > SAMPLES { end } else { begin + f64::from(k) * part };
            self.ask(time)?;
        }
        let (low, high) = ((self.time - part).max(begin), (self.time + part).min(end));
        self.narrow(low, high)
    }

    /// Golden section. Only a guess of where the distance is least: results at its times hold wherever they are.
    fn narrow(&mut self, mut low: f64, mut high: f64) -> Result<()> {
        const GOLDEN: f64 = 0.381_966_011_250_105;
        let mut times = [low + GOLDEN * (high - low), high - GOLDEN * (high - low)];
        let mut distances = [self.ask(times[0])?, self.ask(times[1])?];
        for _ in 0..ROUNDS {
            if self.upper == 0.0 {
                return Ok(());
            }
            if distances[0] <= distances[1] {
                high = times[1];
                (times[1], distances[1]) = (times[0], distances[0]);
                times[0] = low + GOLDEN * (high - low);
                distances[0] = self.ask(times[0])?;
            } else {
                low = times[0];
                (times[0], distances[0]) = (times[1], distances[1]);
                times[1] = high - GOLDEN * (high - low);
                distances[1] = self.ask(times[1])?;
            }
        }
        Ok(())
    }

    /// The distance at a time, up to rounding.
    fn ask(&mut self, time: f64) -> Result<f64> {
        let moment = self.pair.at(time)?;
        let near = self.sweep.distance(&moment)?;
        let is_in_contact = near.outcome == Outcome::Intersecting && self.sweep.is_contact(&moment)?;
        self.learn(&moment, if is_in_contact { 0.0 } else { upper_bound(&near, &moment) });
        Ok(near.distance)
    }

    /// Whether that is the smallest distance so far.
    fn learn(&mut self, moment: &Moment, upper: f64) -> bool {
        let is_smaller = upper < self.upper;
        if is_smaller {
            (self.upper, self.time) = (upper, moment.time);
        }
        is_smaller
    }

    /// The gap that must be proved, given what is known.
    fn wanted(&self, moment: &Moment) -> f64 {
        debug_assert!(self.upper >= 0.0);
        let ClearanceConfig { absolute_error, relative_error, .. } = self.config;
        // Whichever error allows more.
        let asked = (self.upper - absolute_error).min(self.upper / (1.0 + relative_error));
        asked.min(self.upper - 2.0 * self.pair.slack(moment) - self.error)
    }

    /// Sweeps over the range; returns the bound proved for all of it.
    fn prove(&mut self, begin: f64, end: f64) -> Result<f64> {
        let mut here = self.pair.at(begin)?;
        let mut proved = f64::INFINITY;
        let mut relaxations = 0;
        while here.time < end || proved == f64::INFINITY {
            let near = self.sweep.distance(&here)?;
            if self.learn(&here, upper_bound(&near, &here)) && near.outcome == Outcome::Separated {
                let part = (end - begin) / f64::from(SAMPLES + 1);
                self.narrow(here.time, (here.time + part).min(end))?;
            }
            let max_distance = self.wanted(&here);
            if !(max_distance > 0.0) || self.sweep.queries >= self.config.step_budget {
                return Ok(0.0);
            }
            let wanted = SweepGoal { max_distance, with_slack: false, shortest: shortest_step(self.pair.range()) };
            match self.sweep.on(&here, &near, end, &wanted)? {
                Ahead::Free(step) => {
                    proved = proved.min(step.least);
                    here = step.ends[1];
                }
                Ahead::Contact(there, _) => {
                    self.ask(there.time)?;
                }
                Ahead::Open if relaxations < MOST_RELAXATIONS => {
                    relaxations += 1;
                    self.error = 2.0 * self.error + self.pair.slack(&here);
                }
                Ahead::Open => return Ok(0.0),
            }
        }
        Ok(proved)
    }
}
