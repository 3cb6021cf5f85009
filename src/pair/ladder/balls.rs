//! Balls that are swept over the bodies of a query. The rungs search among the polyhedra; those that mostly answer take the radii
//! off as they fill the answer. What they leave open is put right once the ladder has ended ([`swept`](crate::pair::swept)).

use super::query::{NoBalls, PairQuery, PolyhedraDistance, Surfaces, Sweep};
use crate::answer::{Outcome, PairAnswer, PairConfig, Query, Radii, Side};
use crate::base::math::clamp;

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
    polyhedra_tolerance: f64,
    /// Whether the answer is about the bodies, no longer about their polyhedra.
    pub are_taken_off: bool,
}

impl<'a> Balls<'a> {
    /// Those of a query. Beyond the tolerance nothing more is asked.
    #[inline(always)]
    pub fn new(radii: &'a Radii, query: BallQuery, tolerance: f64) -> Balls<'a> {
        debug_assert!(query != BallQuery::Verdict || tolerance == 0.0);
        Balls { radii, query, tolerance, polyhedra_tolerance: radii.with(tolerance), are_taken_off: false }
    }
}

impl Sweep for Balls<'_> {
    #[inline(always)]
    fn max_distance(&self, _: &PairConfig) -> f64 {
        self.polyhedra_tolerance
    }

    #[inline(always)]
    fn inner_radius(&self, _: Query) -> Option<f64> {
        matches!(self.query, BallQuery::Verdict | BallQuery::VerdictWithin).then_some(self.radii.lower)
    }

    #[inline(always)]
    fn ask_polyhedra<R>(pair: &mut PairQuery<Self>, ask: impl FnOnce(&mut PairQuery<NoBalls>) -> R) -> R {
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
        let is_beyond = interval.upper > self.polyhedra_tolerance;
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
