//! What of a minimum that marching finds is good enough an answer, at a quick look or a closer one.

use super::contact;
use super::query::{Query, set_interval};
use super::{DecidedBy, Outcome, PairAnswer, PairCache, PairConfig};
use crate::base::math::{Pose, ROTATION_LIMIT, divisor};
use crate::base::simd::{Kernel, Lanes};
use crate::polyhedron::Polyhedron;
use crate::solve::certificate::{Certify, CloserLook, Gap, Interval, Minimum};
use crate::solve::frame::Frame;
use crate::solve::marching;
use crate::solve::separating_axis::NUDGE;
use crate::solve::state::State;

/// Accepts a minimum whose interval is good enough: answer and cache are then written.
pub(super) struct Acceptance<'a> {
    pub(super) query: Query,
    pub(super) config: &'a PairConfig,
    pub(super) cache: &'a mut PairCache,
    pub(super) answer: &'a mut PairAnswer,
    pub(super) accepted: bool,
}

impl<L: Lanes> Certify<L> for Acceptance<'_> {
    #[inline(always)]
    fn certify(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>) {
        let gap = minimum.gap(frame);
        self.accepted = self.is_enough(frame.size, &gap.interval);
        if self.accepted {
            self.fill(frame, state, minimum, &gap);
        }
    }
}

/// The same at the first state of a query: mostly it is the last one, too, and what the memory is asked for then goes unused.
pub(super) struct AtFirst<'a, 'b>(pub(super) &'a mut Acceptance<'b>);

impl<L: Lanes> Certify<L> for AtFirst<'_, '_> {
    const LOOKS_AHEAD: bool = false;

    #[inline(always)]
    fn certify(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>) {
        self.0.certify(frame, state, minimum);
    }
}

impl Acceptance<'_> {
    /// Whether an interval answers the query.
    #[inline(always)]
    fn is_enough(&self, size: f64, interval: &Interval) -> bool {
        let is_narrow = interval.is_tight(size)
            || match self.query {
                // Without an upper bound a witness point may lie out of its body.
                Query::Approximate => {
                    interval.upper < f64::INFINITY && self.config.accuracy().is_met_by(interval.lower, interval.upper)
                }
                Query::Intersection => interval.lower > 0.0,
                Query::Distance | Query::Contact => false,
            };
        is_narrow && interval.settles(self.config.distance_tolerance)
    }

    /// Answer, but for the statistics, and cache from a minimum.
    #[inline(always)]
    fn fill<L: Lanes>(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>, gap: &Gap) {
        let answer = &mut *self.answer;
        let normal = minimum.direction.mul(L::splat(minimum.inverse));
        self.cache.remember_features(state);
        answer.decided_by = DecidedBy::Marching;
        set_interval(answer, &gap.interval, gap.distance, self.config.distance_tolerance);
        if self.query != Query::Intersection && answer.outcome == Outcome::Separated {
            contact::fill_separated(answer, frame, minimum, normal, state.features());
        } else {
            contact::fill_normal(answer, normal);
        }
        if self.query == Query::Intersection {
            let nudged = frame.bodies[0].offset.mul_add(L::splat(NUDGE / divisor(frame.separation)), normal);
            let direction = frame.bodies[0].rotate_back(nudged).to_vector();
            self.cache.remember_axis(state.vertices(frame.polyhedra()), direction);
        }
    }
}

/// A minimum that a quick look leaves open, looked at more closely, as [`CloserLook`] does.
pub(super) struct Closely<'a, const BETWEEN_PLANES: bool> {
    pub(super) certifier: Acceptance<'a>,
    pub(super) polyhedra: [&'a Polyhedron; 2],
    pub(super) poses: [&'a Pose; 2],
    pub(super) at: State,
}

impl<const BETWEEN_PLANES: bool> Kernel for Closely<'_, BETWEEN_PLANES> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(&mut self) {
        let frame = Frame::<L>::new(self.polyhedra, self.poses, ROTATION_LIMIT);
        let mut closer = CloserLook::<L, BETWEEN_PLANES> { found: None };
        marching::march(&frame, self.at, 1, &mut closer);
        if let Some((minimum, gap)) = &closer.found {
            self.certifier.accepted = self.certifier.is_enough(frame.size, &gap.interval);
            if self.certifier.accepted {
                self.certifier.fill(&frame, self.at, minimum, gap);
            }
        }
    }
}
