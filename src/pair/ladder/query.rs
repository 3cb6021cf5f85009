//! One query: the request, its bodies, and the destination of the answer.

use crate::answer::{Accuracy, Outcome, PairAnswer, PairConfig, Query, Start};
use crate::base::error::Result;
use crate::base::math::{Pose, clamp};
use crate::base::simd::Lanes;
use crate::body::polyhedron::Polyhedron;
use crate::distance::certificate::Interval;
use crate::distance::decide::Wanted;
use crate::pair::cache::PairCache;
use crate::placed::Pair;
use crate::placed::frame::{Frame, Marker};
use crate::placed::state::State;
use crate::shape::Placed;

/// Whether the rungs that need no marching are asked first: bounding spheres and the last separating axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Glances {
    Asked,
    /// For a figure of the paper, which knew neither.
    LeftOut,
}

/// One query, its configuration checked. The requested result is read only here and in [`level_choice`](super::level_choice).
pub(crate) struct PairQuery<'a, S> {
    pub query: Query,
    /// Borrowed from the caller: a copy would load at once what has just been stored pointer by pointer, and wait for it (R1).
    pub bodies: &'a [Placed<'a>; 2],
    pub cache: &'a mut PairCache,
    pub config: &'a PairConfig,
    pub answer: &'a mut PairAnswer,
    /// What is swept over the bodies.
    pub sweep: &'a mut S,
}

impl<'a, S: Sweep> PairQuery<'a, S> {
    #[inline(always)]
    pub fn polyhedra(&self) -> [&'a Polyhedron; 2] {
        [self.bodies[0].shape.polyhedron(), self.bodies[1].shape.polyhedron()]
    }

    #[inline(always)]
    pub fn poses(&self) -> [&'a Pose; 2] {
        [self.bodies[0].pose, self.bodies[1].pose]
    }

    #[inline(always)]
    pub fn pair(&self) -> Pair<'a> {
        Pair::of(self.bodies)
    }

    /// Whether the quick rungs may look at it: bodies whose centres are their origins and whose sizes are in range.
    #[inline(always)]
    pub fn is_simple(&self) -> bool {
        let [body1, body2] = self.polyhedra();
        body1.simple & body2.simple
    }

    /// Beyond what distance of the polyhedra nothing more is asked.
    #[inline(always)]
    pub fn max_distance(&self) -> f64 {
        self.sweep.max_distance(self.config)
    }

    /// The accuracy that an approximate query needs.
    #[inline(always)]
    pub fn accuracy(&self) -> Accuracy {
        let config = self.config;
        Accuracy { absolute: config.absolute_error, relative: config.relative_error, beyond: self.max_distance() }
    }

    /// Beyond what distance of the bounding spheres nothing more is asked. Distances without a tolerance have an infinite one.
    #[inline(always)]
    pub fn enough(&self) -> f64 {
        let tolerance = self.max_distance();
        let is_verdict = (self.query == Query::Intersection) & (tolerance == f64::INFINITY);
        if is_verdict { 0.0 } else { tolerance }
    }

    /// Made in place by the caller: it is large.
    #[inline(always)]
    pub fn frame<L: Lanes>(&self) -> Frame<'a, L> {
        Frame::new(&self.pair())
    }

    /// The frame of bodies that are [simple](PairQuery::is_simple).
    #[inline(always)]
    pub fn frame_of_simple<L: Lanes>(&self) -> Frame<'a, L> {
        Frame::of_rigid(&self.pair())
    }

    pub fn check_poses(&self) -> Result<()> {
        self.poses().iter().try_for_each(|pose| pose.check())
    }

    /// Clears a cache that is not to be asked, unless the poses are refused: who is refused finds nothing changed.
    pub fn forget(&mut self) -> Result<()> {
        if !self.asks_cache() {
            self.check_poses()?;
            *self.cache = PairCache::default();
        }
        Ok(())
    }

    /// Whether the cache may give the start.
    #[inline(always)]
    pub fn asks_cache(&self) -> bool {
        matches!(self.config.start, Start::Automatic | Start::Cache)
    }

    /// Whether look-up tables may give the start.
    #[inline(always)]
    pub fn asks_tables(&self) -> bool {
        self.config.start != Start::Cold
    }

    /// Whether a pair that has jumped may start anew, or must begin at its last features regardless.
    #[inline(always)]
    pub fn may_start_anew(&self) -> bool {
        self.config.start != Start::Cache
    }

    /// From where the pair may have jumped, if it may then start anew.
    #[inline(always)]
    pub fn last_marker(&self) -> Option<&Marker> {
        self.may_start_anew().then_some(&self.cache.marker)
    }

    /// The result that the integers and the fallback must deliver. Cheap bounds or not, nearest points must be nearest.
    pub fn wanted(&self) -> Wanted {
        let max_distance = self.max_distance();
        let tight = self.query != Query::Intersection || max_distance < f64::INFINITY;
        Wanted { tight, max_distance }
    }

    // --- Answers -----------------------------------------------------------------------------------------------------------------

    /// Whether an interval of the distance, for bodies of a size, answers the query.
    #[inline(always)]
    pub fn is_answered_by(&self, interval: &Interval, size: f64) -> bool {
        let is_narrow = interval.is_tight(size)
            || match self.query {
                // Without an upper bound a witness point may lie out of its body.
                Query::Approximate => {
                    interval.upper < f64::INFINITY && self.accuracy().is_met_by(interval.lower, interval.upper)
                }
                Query::Intersection => interval.lower > 0.0,
                Query::Distance | Query::Contact => false,
            };
        is_narrow && self.is_settled_by(interval)
    }

    /// Whether an interval tells on which side of the tolerance the distance is.
    #[inline(always)]
    pub fn is_settled_by(&self, interval: &Interval) -> bool {
        interval.settles(self.max_distance())
    }

    /// Outcome, interval and best estimate of a separated pair, as [`PairQuery::set_interval`] has them; of the bodies, if what is
    /// swept over the polyhedra leaves nothing open.
    #[inline(always)]
    pub fn settle(&mut self, interval: &Interval, distance: f64) -> Surfaces {
        let found = PolyhedraDistance { interval: *interval, distance };
        if let Some(surfaces) = self.sweep.settle(self.query, self.config, self.answer, found) {
            return surfaces;
        }
        self.set_interval(interval, distance);
        let has_points = (self.query != Query::Intersection) & (self.answer.outcome == Outcome::Separated);
        if has_points { Surfaces::Points { outwards: None } } else { Surfaces::Normal }
    }

    /// Outcome, interval and best estimate (`distance`, put into the interval) of a separated pair. The interval settles the
    /// tolerance: its upper end is beyond it just where the true distance is.
    #[inline(always)]
    pub fn set_interval(&mut self, interval: &Interval, distance: f64) {
        let max_distance = self.max_distance();
        set_interval(self.answer, interval, distance, max_distance);
    }

    /// The same for an interval that need not settle the tolerance: a case that a budget leaves open is not beyond.
    #[inline(always)]
    pub fn set_open_interval(&mut self, interval: &Interval, distance: f64) {
        let tolerance = if self.is_settled_by(interval) { self.max_distance() } else { f64::INFINITY };
        set_interval(self.answer, interval, distance, tolerance);
    }
}

/// What is swept over both bodies: [`NoBalls`] or [`Balls`](super::balls::Balls).
pub(in crate::pair) trait Sweep {
    /// Beyond what distance of the polyhedra nothing more is asked.
    fn max_distance(&self, config: &PairConfig) -> f64;

    /// The sum of the radii, rounded down, if balls inside the bodies that overlap are an answer.
    fn inner_radius(&self, query: Query) -> Option<f64>;

    /// Asks of the polyhedra, as the rungs do that are rarely asked. What is swept over them is put right later.
    fn ask_polyhedra<R>(pair: &mut PairQuery<Self>, ask: impl FnOnce(&mut PairQuery<NoBalls>) -> R) -> R
    where
        Self: Sized;

    /// Whether [`Sweep::settle`] has made the answer.
    fn has_settled(&self) -> bool;

    /// Outcome, interval and best estimate of the bodies, from those of their polyhedra, which are apart. The answer is left alone
    /// if there are no balls, or where they leave something open.
    fn settle(
        &mut self,
        query: Query,
        config: &PairConfig,
        answer: &mut PairAnswer,
        found: PolyhedraDistance,
    ) -> Option<Surfaces>;
}

/// The distance of two polyhedra.
#[derive(Clone, Copy)]
pub(in crate::pair) struct PolyhedraDistance {
    pub interval: Interval,
    /// The best estimate.
    pub distance: f64,
}

/// The part of an answer beside its interval.
#[derive(Clone, Copy)]
pub(in crate::pair) enum Surfaces {
    /// Neither points nor a normal.
    Nothing,
    /// The normal alone.
    Normal,
    /// Normal, features and witness points, which move by this much along the normal.
    Points { outwards: Option<[f64; 2]> },
}

/// The polyhedra are the bodies.
pub(in crate::pair) struct NoBalls;

impl Sweep for NoBalls {
    #[inline(always)]
    fn max_distance(&self, config: &PairConfig) -> f64 {
        config.max_distance
    }

    #[inline(always)]
    fn inner_radius(&self, query: Query) -> Option<f64> {
        (query == Query::Intersection).then_some(0.0)
    }

    #[inline(always)]
    fn ask_polyhedra<R>(pair: &mut PairQuery<NoBalls>, ask: impl FnOnce(&mut PairQuery<NoBalls>) -> R) -> R {
        ask(pair)
    }

    #[inline(always)]
    fn has_settled(&self) -> bool {
        false
    }

    #[inline(always)]
    fn settle(&mut self, _: Query, _: &PairConfig, _: &mut PairAnswer, _: PolyhedraDistance) -> Option<Surfaces> {
        None
    }
}

/// The result of an attempt at marching.
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

/// The state that marching leaves open.
#[derive(Clone, Copy)]
pub(super) struct Open {
    /// The state that marching reached.
    pub at: State,
    /// Whether that is a minimum, whose certificate does not hold.
    pub is_minimum: bool,
    /// Steps made.
    pub steps: u32,
}

#[inline(always)]
fn set_interval(answer: &mut PairAnswer, interval: &Interval, distance: f64, max_distance: f64) {
    answer.lower = interval.lower;
    answer.proof_count = 0;
    if interval.upper > max_distance {
        answer.outcome = Outcome::Beyond;
        answer.upper = f64::INFINITY;
        answer.distance = interval.lower;
    } else {
        answer.outcome = Outcome::Separated;
        answer.upper = interval.upper;
        answer.distance = clamp(distance, interval.lower, interval.upper);
    }
}
