//! Balls that are swept over the bodies of a query. The rungs search among the polyhedra; those that mostly answer take the radii
//! off as they fill the answer. What they leave open is put right once the ladder has ended ([`swept`](crate::pair::swept)).

use super::query::PairQuery;
use crate::answer::{Outcome, PairAnswer, PairConfig, Query, Radii, Side};
use crate::base::math::clamp;
use crate::distance::certificate::Interval;

/// What is swept over both bodies: [`NoBalls`] or [`Balls`].
pub(in crate::pair) trait Sweep {
    /// Beyond what distance of the polyhedra nothing more is asked.
    fn max_distance(&self, config: &PairConfig) -> f64;

    /// The sum of the radii, rounded down, if balls inside the bodies that overlap are an answer.
    fn inner_radius(&self, query: Query) -> Option<f64>;

    /// Asks of the polyhedra, as the rungs do that are rarely asked. What is swept over them is put right later.
    fn of_polyhedra<R>(pair: &mut PairQuery<Self>, ask: impl FnOnce(&mut PairQuery<NoBalls>) -> R) -> R
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
    fn of_polyhedra<R>(pair: &mut PairQuery<NoBalls>, ask: impl FnOnce(&mut PairQuery<NoBalls>) -> R) -> R {
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

/// What is asked of bodies with balls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::pair) enum BallQuery {
    /// Whether they meet.
    Verdict,
    /// Whether they meet, or are within the tolerance.
    VerdictWithin,
    /// How far they are apart.
    Distance,
    /// That, and how deep they are in each other where their polyhedra are apart.
    SignedDistance,
}

/// Balls over both bodies.
pub(in crate::pair) struct Balls<'a> {
    radii: &'a Radii,
    query: BallQuery,
    /// Beyond what distance of the bodies nothing more is asked.
    tolerance: f64,
    /// The same of the polyhedra.
    of_polyhedra: f64,
    /// Whether the answer is about the bodies, no longer about their polyhedra.
    pub are_taken_off: bool,
}

impl<'a> Balls<'a> {
    /// Those of a query. Beyond the tolerance nothing more is asked.
    #[inline(always)]
    pub fn new(radii: &'a Radii, query: BallQuery, tolerance: f64) -> Balls<'a> {
        debug_assert!(query != BallQuery::Verdict || tolerance == 0.0);
        Balls { radii, query, tolerance, of_polyhedra: radii.with(tolerance), are_taken_off: false }
    }
}

impl Sweep for Balls<'_> {
    #[inline(always)]
    fn max_distance(&self, _: &PairConfig) -> f64 {
        self.of_polyhedra
    }

    #[inline(always)]
    fn inner_radius(&self, _: Query) -> Option<f64> {
        matches!(self.query, BallQuery::Verdict | BallQuery::VerdictWithin).then_some(self.radii.lower)
    }

    #[inline(always)]
    fn of_polyhedra<R>(pair: &mut PairQuery<Self>, ask: impl FnOnce(&mut PairQuery<NoBalls>) -> R) -> R {
        let config = &PairConfig { max_distance: pair.max_distance(), ..*pair.config };
        let &mut PairQuery { query, bodies, ref mut cache, ref mut answer, .. } = pair;
        ask(&mut PairQuery { query, bodies, cache, config, answer, sweep: &mut NoBalls })
    }

    #[inline(always)]
    fn has_settled(&self) -> bool {
        self.are_taken_off
    }

    #[inline(always)]
    fn settle(
        &mut self,
        query: Query,
        config: &PairConfig,
        answer: &mut PairAnswer,
        found: PolyhedraDistance,
    ) -> Option<Surfaces> {
        let PolyhedraDistance { interval, distance } = found;
        let off = self.radii.off([interval.lower, interval.upper]);
        if query == Query::Approximate && self.radii.is_too_wide(off, config) {
            return None;
        }
        let is_beyond = interval.upper > self.of_polyhedra;
        let (side, [lower, upper]) = self.radii.side(off, self.tolerance, is_beyond)?;
        let is_within = side == Side::Within;
        // The common point of a contact is made of the nearest points of the polyhedra.
        if side == Side::Hidden || (is_within & (query == Query::Contact)) {
            return None;
        }
        self.are_taken_off = true;
        answer.proof_count = 0;
        if side == Side::Beyond {
            answer.outcome = if self.query == BallQuery::Verdict { Outcome::Separated } else { Outcome::Beyond };
            (answer.distance, answer.lower, answer.upper) = (lower, lower, upper);
            return Some(Surfaces::Normal);
        }
        answer.outcome = if is_within { Outcome::Intersecting } else { Outcome::Separated };
        if is_within & (self.query != BallQuery::SignedDistance) {
            (answer.distance, answer.lower, answer.upper) = (0.0, 0.0, 0.0);
            return Some(Surfaces::Nothing);
        }
        let [radius1, radius2] = self.radii.each;
        answer.distance = clamp(distance - radius1 - radius2, lower, upper).min(f64::MAX);
        (answer.lower, answer.upper) = (lower, upper);
        Some(Surfaces::Points { outwards: Some(self.radii.outwards()) })
    }
}
