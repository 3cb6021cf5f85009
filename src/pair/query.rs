//! One query: what is asked, of which bodies, and where the answer goes.

use super::config::{check_accuracy, check_config};
use super::placed::Placed;
use super::{Outcome, PairAnswer, PairCache, PairConfig, Start};
use crate::base::error::Result;
use crate::base::math::{Pose, clamp};
use crate::polyhedron::Polyhedron;
use crate::solve::certificate::Interval;
use crate::solve::state::State;

/// What is asked of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum Query {
    /// The verdict alone.
    Intersection = 0,
    /// The distance.
    Distance = 1,
    /// The distance, and of intersecting bodies a common point and a normal.
    Contact = 2,
    /// The distance as narrow as asked for.
    Approximate = 3,
}

/// Whether the rungs that need no marching are asked first: bounding spheres and the last separating axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Glances {
    Asked,
    /// For a figure of the paper, which knew neither.
    LeftOut,
}

/// One query.
pub(super) struct PairQuery<'a> {
    pub query: Query,
    /// Where the caller has them: a copy would load at once what has just been stored pointer by pointer, and wait for it (10 ns).
    pub bodies: &'a [Placed<'a>; 2],
    pub cache: &'a mut PairCache,
    pub config: &'a PairConfig,
    pub answer: &'a mut PairAnswer,
}

impl<'a> PairQuery<'a> {
    #[inline(always)]
    pub fn polyhedra(&self) -> [&'a Polyhedron; 2] {
        [self.bodies[0].shape.polyhedron(), self.bodies[1].shape.polyhedron()]
    }

    #[inline(always)]
    pub fn poses(&self) -> [&'a Pose; 2] {
        [self.bodies[0].pose, self.bodies[1].pose]
    }

    /// Whether the quick rungs may look at it: bodies whose centres are their origins and whose sizes are in range, and a rotation
    /// limit that refuses no pose which is right up to rounding.
    #[inline(always)]
    pub fn is_simple(&self) -> bool {
        let [body1, body2] = self.polyhedra();
        body1.simple & body2.simple & self.config.admits_rounding()
    }

    /// Beyond what distance of the bounding spheres nothing more is asked. Distances without a tolerance have an infinite one.
    #[inline(always)]
    pub fn enough(&self) -> f64 {
        let tolerance = self.config.distance_tolerance;
        let is_verdict = (self.query == Query::Intersection) & (tolerance == f64::INFINITY);
        if is_verdict { 0.0 } else { tolerance }
    }

    /// Refuses a configuration that holds what is none.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::base::error::Error::Argument), naming the first such member.
    #[inline(always)]
    pub fn check_config(&self) -> Result<()> {
        let config = self.config;
        if !((config.distance_tolerance >= 0.0) & config.admits_rounding()) {
            check_config(config)?;
        }
        let is_accurate = (config.absolute_error >= 0.0) & (config.relative_error >= 0.0) & (config.step_budget > 0);
        if (self.query == Query::Approximate) & !is_accurate {
            check_accuracy(config.absolute_error, config.relative_error, config.step_budget)?;
        }
        Ok(())
    }

    pub fn check_poses(&self) -> Result<()> {
        self.poses().iter().try_for_each(|pose| pose.check(self.config.rotation_limit))
    }

    /// Clears a cache that is not to be asked, unless the poses are refused: who is refused finds nothing changed.
    pub fn forget(&mut self) -> Result<()> {
        if !self.config.start.asks_cache() {
            self.check_poses()?;
            *self.cache = PairCache::default();
        }
        Ok(())
    }

    /// Whether look-up tables may say where to start.
    #[inline(always)]
    pub fn asks_tables(&self) -> bool {
        self.config.start != Start::Cold
    }
}

/// What became of an attempt at marching.
pub(super) enum Attempt {
    /// The answer is there.
    Answered,
    /// It is left open.
    Open(Open),
    /// Nothing was tried: there are no features to begin at, or poses that are not rigid or not within range.
    Untried,
    /// The enclosure of the last intersection no longer holds the origin.
    NotEnclosed,
}

/// What marching left open.
#[derive(Clone, Copy)]
pub(super) struct Open {
    /// Where it came to.
    pub at: State,
    /// Whether that is a minimum, whose certificate does not hold.
    pub is_minimum: bool,
    /// Steps made.
    pub steps: u32,
}

/// Outcome, interval and best estimate (`distance`, put into the interval) of a separated pair. The interval settles the
/// tolerance: its upper end is beyond it just where the true distance is.
#[inline(always)]
pub(super) fn set_interval(answer: &mut PairAnswer, interval: &Interval, distance: f64, distance_tolerance: f64) {
    answer.lower = interval.lower;
    answer.proof_count = 0;
    if interval.upper > distance_tolerance {
        answer.outcome = Outcome::Beyond;
        answer.upper = f64::INFINITY;
        answer.distance = interval.lower;
    } else {
        answer.outcome = Outcome::Separated;
        answer.upper = interval.upper;
        answer.distance = clamp(distance, interval.lower, interval.upper);
    }
}
