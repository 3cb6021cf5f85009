//! The states of a march, for drawings. The query is asked again and again, with one more step each time: so the march itself keeps
//! no record.

use super::marching::Leg;
use super::query::{Attempt, NoBalls, Open, PairQuery};
use crate::answer::{PairAnswer, PairConfig, Query};
use crate::pair::cache::PairCache;
use crate::pair::start::policy::StartFrom;
use crate::pair::start::{Guess, start_pair};
use crate::placed::Pair;
use crate::placed::state::State;
use crate::shape::Placed;

/// Visits the states of the march of a cold exact query of two polyhedra, in their order: as many as its statistics count, or the
/// start alone where tables let expect that the bodies overlap. Poses are accepted ones.
pub(crate) fn for_each_state(bodies: &[Placed; 2], mut visit: impl FnMut(State)) {
    let start = start_pair(&Pair::of(bodies), StartFrom::Centres);
    let state = State::vertex_vertex(start.vertices());
    visit(state);
    if start.guess == Guess::Overlapping {
        return;
    }
    for budget in 1..march(bodies, state, Leg::Whole).steps {
        visit(march(bodies, state, Leg::Budget(budget)).at);
    }
}

/// The state that a march reaches, and in how many steps; of one that answers the number alone is meant.
fn march(bodies: &[Placed; 2], start: State, leg: Leg) -> Open {
    let (query, mut cache, mut answer) = (Query::Distance, PairCache::default(), PairAnswer::default());
    let (config, sweep) = (&PairConfig::default(), &mut NoBalls);
    let mut pair = PairQuery { query, bodies, cache: &mut cache, config, answer: &mut answer, sweep };
    match pair.march_on(start, 0, leg) {
        Attempt::Open(open) => open,
        _ => Open { at: start, is_minimum: true, steps: answer.statistics.marching_steps },
    }
}
