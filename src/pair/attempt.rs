//! Attempts at the bodies themselves: marching from the last features, from where the tables say, or afresh, each minimum judged
//! as it is found.

use super::acceptance::{Acceptance, AtFirst};
use super::{Attempt, PairQuery, Start, Statistics};
use crate::base::simd::{Kernel, Lanes, Work};
use crate::pair::descent::TRIAL_STEPS;
use crate::pair::start::{self, Beginning, FROM_CENTRES, Guess};
use crate::polyhedron::Polyhedron;
use crate::solve::frame::{Frame, Marker};
use crate::solve::marching::{self, March, Way};
use crate::solve::state::State;

/// The common case, for [ordinary](Polyhedron::ordinary) bodies: the cached features still are the nearest. One state, straight
/// through to the answer, without the loop that would keep so much in registers.
pub(super) struct Coherent<'a, 'b> {
    pub(super) pair: &'a mut PairQuery<'b>,
}

impl Kernel for Coherent<'_, '_> {
    type Output = Attempt;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Attempt {
        let &mut PairQuery { query, polyhedra, poses, ref mut cache, config, ref mut answer } = self.pair;
        let frame = Frame::<L>::of_rigid(polyhedra, poses);
        if !frame.usual {
            return Attempt::Unusual;
        }
        let Some(state) = State::unchecked(cache.kind, cache.indices) else { return Attempt::Cold };
        let mut judge = Acceptance { query, config, cache, answer, accepted: false };
        let step = marching::visit(&frame, state, &mut AtFirst(&mut judge));
        if judge.accepted {
            judge.answer.statistics = Statistics { marching_steps: 1, ..Statistics::default() };
            return Attempt::Done;
        }
        match step.way {
            Way::Minimum => return Attempt::Open { at: state, is_minimum: true, steps: 1 },
            Way::Nowhere => return Attempt::Cold,
            Way::Move | Way::Behind | Way::Crossing => {}
        }
        // In line: the frame stays in registers.
        MarchOn { pair: self.pair, frame, start: step.at, steps: 1, limit: TRIAL_STEPS }.run()
    }
}

/// Marching from a state to the end.
pub(super) struct MarchOn<'a, 'b, L> {
    pub(super) pair: &'a mut PairQuery<'b>,
    pub(super) frame: Frame<'b, L>,
    pub(super) start: State,
    /// Those made before.
    pub(super) steps: u32,
    /// For the first leg: [`TRIAL_STEPS`] from a cache, else [`step_limit`].
    pub(super) limit: u32,
}

impl<L: Lanes> Work for MarchOn<'_, '_, L> {
    type Output = Attempt;

    #[inline(always)]
    fn run(&mut self) -> Attempt {
        let &mut PairQuery { query, polyhedra, poses, ref mut cache, config, ref mut answer } = self.pair;
        let mut judge = Acceptance { query, config, cache, answer, accepted: false };
        let (mut state, mut steps, mut limit) = (self.start, self.steps, self.limit);
        let frame = self.frame;
        if limit == TRIAL_STEPS && frame.has_jumped(&judge.cache.marker) && config.start != Start::Cache {
            let rounds = frame.rounds_from_last(&judge.cache.marker);
            let last = if rounds == FROM_CENTRES { [0; 2] } else { state.vertices(polyhedra) };
            let beginning = start::anew_after(polyhedra, poses, true, last, rounds);
            state = State::vertex_vertex(beginning.vertices());
            limit = step_limit(polyhedra);
            if beginning.guess == Guess::Overlapping {
                return Attempt::Open { at: state, is_minimum: false, steps };
            }
        }
        let (at, is_minimum) = loop {
            let (march, more) = marching::march(&frame, state, limit, &mut judge);
            steps += more;
            state = match march {
                March::Minimum(at) => break (at, true),
                March::Open(at) => break (at, false),
                March::Limit(at) if limit != TRIAL_STEPS => break (at, false),
                March::Limit(at) if config.start == Start::Cache => at,
                March::Limit(_) => State::vertex_vertex(start::anew(polyhedra, poses, true).vertices()),
            };
            limit = step_limit(polyhedra);
        };
        if !judge.accepted {
            return Attempt::Open { at, is_minimum, steps };
        }
        judge.answer.statistics = Statistics { marching_steps: steps, ..Statistics::default() };
        // A pair that stays on its features keeps its old marker: they are near.
        frame.mark(&mut judge.cache.marker);
        Attempt::Done
    }
}

/// The general case: any bodies, poses and caches.
pub(super) struct General<'a, 'b> {
    pub(super) pair: &'a mut PairQuery<'b>,
    /// Where to start if the cache holds no features, if that is known.
    pub(super) beginning: Option<Beginning>,
}

impl Kernel for General<'_, '_> {
    type Output = Attempt;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Attempt {
        let &mut PairQuery { polyhedra, poses, ref cache, config, .. } = self.pair;
        let frame = Frame::<L>::new(polyhedra, poses, config.rotation_limit);
        if !frame.usual {
            return Attempt::Unusual;
        }
        let (start, limit) = match State::checked(cache.kind, cache.indices, polyhedra) {
            Some(state) => (state, TRIAL_STEPS),
            None => {
                let beginning = match self.beginning {
                    Some(beginning) => beginning,
                    None => start::anew(polyhedra, poses, config.start != Start::Cold),
                };
                let state = State::vertex_vertex(beginning.vertices());
                if beginning.guess == Guess::Overlapping {
                    return Attempt::Open { at: state, is_minimum: false, steps: 0 };
                }
                (state, step_limit(polyhedra))
            }
        };
        // A segment or a point has no faces to march over.
        if polyhedra[0].dimension.min(polyhedra[1].dimension) < 2 {
            return Attempt::Open { at: start, is_minimum: false, steps: 0 };
        }
        L::out_of_line(&mut MarchOn { pair: self.pair, frame, start, steps: 0, limit })
    }
}

/// More steps than any start needs; only cycles that the cycle detection misses meet it.
#[inline(always)]
pub(super) fn step_limit(polyhedra: [&Polyhedron; 2]) -> u32 {
    64 + polyhedra[0].vertices.len().max(polyhedra[1].vertices.len()) as u32
}

/// Whether the pair has moved so far that a tetrahedron around the origin is no better to begin with than a pair from the tables:
/// by about half a radian. (Of fat bodies at random poses the pair saves a tenth of the instructions, at 10° it costs a tenth.)
#[inline(always)]
pub(super) fn has_turned_away<L: Lanes>(frame: &Frame<L>, last: &Marker) -> bool {
    frame.has_moved(last, 0.25)
}

/// Whether a pair that intersected has moved so far that it may be apart, and nearest where the tables say: farther than one that
/// was apart has to (on the deep orbit that takes plates 3 to 12 % less time at 5° to 10°, long bodies 8 % more at 7°, and round
/// ones within 3 % of the same).
#[inline(always)]
pub(super) fn may_have_come_apart<L: Lanes>(frame: &Frame<L>, last: &Marker) -> bool {
    frame.has_moved_reaches(last, 3.0)
}

/// The square of an angle of about 72°.
pub(super) const FAR: f64 = 1.6;
