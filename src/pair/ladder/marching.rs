//! Attempts at the bodies themselves: marching from the last features, from the tables' vertices, or afresh, each minimum judged
//! as it is found.

use super::acceptance::{Acceptance, AtFirst};
use super::query::{Attempt, NoBalls, Open, PairQuery, Sweep};
use crate::answer::{Query, Statistics};
use crate::base::simd::{self, Kernel, Lanes, Work};
use crate::body::polyhedron::Polyhedron;
use crate::distance::marching::{self, March, Transition, step_limit};
use crate::pair::levels::TRIAL_STEPS;
use crate::pair::start::policy::{self, StartFrom};
use crate::pair::start::{Guess, StartPair, start_pair};
use crate::placed::frame::Frame;
use crate::placed::state::State;

impl<S: Sweep> PairQuery<'_, S> {
    /// Marching from the last features, for bodies that are [simple](PairQuery::is_simple).
    #[inline(always)]
    pub(super) fn march_from_last_features(&mut self) -> Attempt {
        simd::dispatch(&mut Coherent { pair: self })
    }
}

impl PairQuery<'_, NoBalls> {
    /// Marching of any bodies, from the features that the cache holds; else from `start`, if that is known.
    pub(super) fn march(&mut self, start: Option<StartPair>) -> Attempt {
        simd::dispatch(&mut General { pair: self, start })
    }

    /// Marching on at the bodies themselves from a state that a search among levels reached.
    pub(super) fn march_on(&mut self, start: State, steps: u32, leg: Leg) -> Attempt {
        simd::dispatch(&mut FromState { pair: self, start, steps, leg })
    }
}

/// How long marching may go on from where it starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Leg {
    /// From the features of an earlier query: a few steps, then a new start, as the pair has jumped.
    Trial,
    /// To the end.
    Whole,
    /// The number of steps.
    Budget(u32),
}

impl Leg {
    /// With this many steps of a budget left; `u32::MAX` means no budget. A trial may go on for longer than a budget.
    pub(super) fn of(left: u32, is_trial: bool) -> Leg {
        match left {
            u32::MAX if is_trial => Leg::Trial,
            u32::MAX => Leg::Whole,
            left => Leg::Budget(left),
        }
    }

    /// The most steps.
    #[inline(always)]
    pub(super) fn limit(self, polyhedra: [&Polyhedron; 2]) -> u32 {
        match self {
            Leg::Trial => TRIAL_STEPS,
            Leg::Whole => step_limit(polyhedra),
            Leg::Budget(steps) => step_limit(polyhedra).min(steps),
        }
    }
}

/// The common case: the cached features still are the nearest. One state, straight through to the answer (R3).
struct Coherent<'a, 'b, S> {
    pair: &'a mut PairQuery<'b, S>,
}

impl<S: Sweep> Kernel for Coherent<'_, '_, S> {
    type Output = Attempt;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Attempt {
        let frame = self.pair.frame_of_simple::<L>();
        if !frame.in_range {
            return Attempt::Untried;
        }
        let Some(state) = self.pair.cache.features() else { return Attempt::Untried };
        let mut acceptance = Acceptance { pair: &mut *self.pair, accepted: false };
        let step = marching::visit(&frame, state, &mut AtFirst(&mut acceptance));
        if acceptance.accepted {
            self.pair.answer.statistics = Statistics { marching_steps: 1, ..Statistics::default() };
            return Attempt::Answered;
        }
        match step.transition {
            Transition::Minimum => return Attempt::Open(Open { at: state, is_minimum: true, steps: 1 }),
            Transition::Nowhere => return Attempt::Untried,
            Transition::Move | Transition::Behind | Transition::Crossing => {}
        }
        // A verdict after a jump is for a walk.
        if self.pair.query == Query::Intersection
            && self.pair.last_marker().is_some_and(|marker| policy::has_jumped(&frame, marker))
        {
            return Attempt::Untried;
        }
        // In line (R3).
        MarchOn { pair: self.pair, frame, start: step.at, steps: 1, leg: Leg::Trial }.run()
    }
}

/// Marching from a state to the end.
struct MarchOn<'a, 'b, L, S> {
    pair: &'a mut PairQuery<'b, S>,
    frame: Frame<'b, L>,
    start: State,
    /// Those made before.
    steps: u32,
    leg: Leg,
}

impl<L: Lanes, S: Sweep> Work for MarchOn<'_, '_, L, S> {
    type Output = Attempt;

    #[inline(always)]
    fn run(&mut self) -> Attempt {
        let pair = &self.pair.pair();
        let may_start_anew = self.pair.may_start_anew();
        let mut acceptance = Acceptance { pair: &mut *self.pair, accepted: false };
        let (mut state, mut steps, mut leg) = (self.start, self.steps, self.leg);
        let frame = self.frame;
        if (leg == Leg::Trial) & may_start_anew
            && let Some(from) = policy::choose(&frame, &acceptance.pair.cache.marker, state)
        {
            let start = start_pair(pair, from);
            state = State::vertex_vertex(start.vertices());
            leg = Leg::Whole;
            if start.guess == Guess::Overlapping {
                return Attempt::Open(Open { at: state, is_minimum: false, steps });
            }
        }
        let (at, is_minimum) = loop {
            let (march, more) = marching::march(&frame, state, leg.limit(pair.polyhedra), &mut acceptance);
            steps += more;
            state = match march {
                March::Minimum(at) => break (at, true),
                March::Open(at) => break (at, false),
                March::Limit(at) if leg != Leg::Trial => break (at, false),
                March::Limit(at) if !may_start_anew => at,
                March::Limit(_) => State::vertex_vertex(start_pair(pair, StartFrom::Centres).vertices()),
            };
            leg = Leg::Whole;
        };
        if !acceptance.accepted {
            return Attempt::Open(Open { at, is_minimum, steps });
        }
        self.pair.answer.statistics = Statistics { marching_steps: steps, ..Statistics::default() };
        // A pair that stays on its features keeps its old marker: they are near.
        frame.mark(&mut self.pair.cache.marker);
        Attempt::Answered
    }
}

/// The general case: any bodies, poses and caches.
struct General<'a, 'b> {
    pair: &'a mut PairQuery<'b, NoBalls>,
    /// The start if the cache holds no features, if it is known.
    start: Option<StartPair>,
}

impl Kernel for General<'_, '_> {
    type Output = Attempt;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Attempt {
        let pair = &self.pair.pair();
        let frame = self.pair.frame::<L>();
        if !frame.in_range {
            return Attempt::Untried;
        }
        let (state, leg) = match self.pair.cache.features_of(pair.polyhedra) {
            Some(state) => (state, Leg::Trial),
            None => {
                let from = if self.pair.asks_tables() { StartFrom::Centres } else { StartFrom::Farthest };
                let start = self.start.unwrap_or_else(|| start_pair(pair, from));
                let state = State::vertex_vertex(start.vertices());
                if start.guess == Guess::Overlapping {
                    return Attempt::Open(Open { at: state, is_minimum: false, steps: 0 });
                }
                (state, Leg::Whole)
            }
        };
        L::out_of_line(&mut MarchOn { pair: self.pair, frame, start: state, steps: 0, leg })
    }
}

/// From a given state.
struct FromState<'a, 'b> {
    pair: &'a mut PairQuery<'b, NoBalls>,
    start: State,
    steps: u32,
    leg: Leg,
}

impl Kernel for FromState<'_, '_> {
    type Output = Attempt;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Attempt {
        let &mut FromState { start, steps, leg, .. } = self;
        let frame = self.pair.frame::<L>();
        if !frame.in_range {
            return Attempt::Untried;
        }
        L::out_of_line(&mut MarchOn { pair: self.pair, frame, start, steps, leg })
    }
}
