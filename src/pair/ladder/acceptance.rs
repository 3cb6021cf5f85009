//! Which minima that marching finds are good enough for an answer, at a quick look or a closer one.

use super::query::{NoBalls, PairQuery, Surfaces, Sweep};
use crate::answer::{DecidedBy, Query, contact};
use crate::base::math::divisor;
use crate::base::simd::{Kernel, Lanes};
use crate::distance::certificate::{Certify, CloserLook, Gap, Minimum};
use crate::distance::marching;
use crate::distance::separating_axis::NUDGE;
use crate::placed::frame::Frame;
use crate::placed::state::State;

/// Accepts a minimum whose interval is good enough: answer and cache are then written.
pub(super) struct Acceptance<'a, 'b, S> {
    pub(super) pair: &'a mut PairQuery<'b, S>,
    pub(super) accepted: bool,
}

impl<L: Lanes, S: Sweep> Certify<L> for Acceptance<'_, '_, S> {
    #[inline(always)]
    fn certify(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>) {
        let gap = minimum.gap(frame);
        self.accepted = self.pair.is_answered_by(&gap.interval, frame.size);
        if self.accepted {
            self.fill(frame, state, minimum, &gap);
        }
    }
}

/// The same at the first state of a query: mostly it is the last one, too, and what the memory is asked for then goes unused.
pub(super) struct AtFirst<'a, 'b, 'c, S>(pub(super) &'a mut Acceptance<'b, 'c, S>);

impl<L: Lanes, S: Sweep> Certify<L> for AtFirst<'_, '_, '_, S> {
    const LOOKS_AHEAD: bool = false;

    #[inline(always)]
    fn certify(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>) {
        self.0.certify(frame, state, minimum);
    }
}

impl<S: Sweep> Acceptance<'_, '_, S> {
    /// Answer, except the statistics, and cache from a minimum.
    #[inline(always)]
    fn fill<L: Lanes>(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>, gap: &Gap) {
        let pair = &mut *self.pair;
        let normal = minimum.direction.mul(L::splat(minimum.inverse));
        pair.cache.remember_features(state);
        pair.answer.decided_by = DecidedBy::Marching;
        match pair.settle(&gap.interval, gap.distance) {
            Surfaces::Points { outwards } => {
                let nearest = contact::NearestFeatures { features: state.features(), outwards };
                contact::fill_separated(pair.answer, frame, minimum, normal, nearest);
            }
            Surfaces::Normal => contact::fill_normal(pair.answer, normal),
            Surfaces::Nothing => contact::fill_nothing(pair.answer),
        }
        if pair.query == Query::Intersection {
            // Turned by an angle, bodies reach farther along a direction by that times their size at most: half the gap.
            let most = 0.5 * gap.interval.lower / divisor(frame.size);
            let nudge = if most < NUDGE { most } else { NUDGE };
            let nudged = frame.bodies[0].offset.mul_add(L::splat(nudge / divisor(frame.separation)), normal);
            let direction = frame.bodies[0].rotate_back(nudged).to_vector();
            pair.cache.remember_axis(state.vertices(frame.polyhedra()), direction);
        }
    }
}

/// A minimum that a quick look leaves open, looked at more closely, as [`CloserLook`] does.
pub(super) struct Closely<'a, 'b, const BETWEEN_PLANES: bool> {
    pub(super) acceptance: Acceptance<'a, 'b, NoBalls>,
    pub(super) at: State,
}

impl<const BETWEEN_PLANES: bool> Kernel for Closely<'_, '_, BETWEEN_PLANES> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(&mut self) {
        let &mut Closely { ref mut acceptance, at } = self;
        let frame = Frame::<L>::new(&acceptance.pair.pair());
        let mut closer = CloserLook::<L, BETWEEN_PLANES> { found: None };
        marching::march(&frame, at, 1, &mut closer);
        if let Some((minimum, gap)) = &closer.found {
            acceptance.accepted = acceptance.pair.is_answered_by(&gap.interval, frame.size);
            if acceptance.accepted {
                acceptance.fill(&frame, at, minimum, gap);
            }
        }
    }
}
