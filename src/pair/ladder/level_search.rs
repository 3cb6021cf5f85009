//! Queries through levels of detail, and those with a step budget: the search among the levels, and where the next query is to
//! start.

use super::marching::Leg;
use super::query::{Attempt, NoBalls, Open, PairQuery};
use crate::answer::{DecidedBy, Outcome, Query, Statistics, contact};
use crate::base::error::Result;
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::Polyhedron;
use crate::distance::certificate::Interval;
use crate::distance::gjk::{self, Nearest, Simplex};
use crate::distance::marching::step_limit;
use crate::pair::levels::{Descended, LevelBounds, LevelDescent, LevelState, Leveled};
use crate::pair::start::policy::StartFrom;
use crate::pair::start::start_pair;
use crate::placed::Pair;
use crate::placed::frame::Frame;
use crate::placed::state::State;
use crate::placed::voronoi::climb;

/// The result of a search among levels.
pub(super) enum LevelSearched<'a> {
    /// The answer is there.
    Answered,
    /// There are no levels that may answer.
    Bodies,
    /// Marching at the bodies themselves, from where the search ended, ended so; where the next is to start is still to be
    /// remembered.
    Marched(LevelSearch<'a>, Attempt),
}

/// A search among levels.
pub(super) struct LevelSearch<'a> {
    bodies: Leveled<'a>,
    /// Whether it goes through levels, or has a budget alone.
    has_levels: bool,
    /// Steps of earlier queries whose budget ran out.
    before: u32,
}

impl<'a> PairQuery<'a, NoBalls> {
    /// The query through the levels of detail, from the cache or afresh.
    #[inline(never)]
    pub(super) fn search_levels(&mut self) -> Result<LevelSearched<'a>> {
        let has_levels = self.levels_may_answer()?;
        if !(has_levels || self.has_budget(self.query)) {
            return Ok(LevelSearched::Bodies);
        }
        self.forget()?;
        if self.is_still_enclosed()? {
            return Ok(LevelSearched::Answered);
        }
        let search = LevelSearch { bodies: Leveled::new(*self.bodies), has_levels, before: self.cache.spent_before() };
        Ok(search.run(self))
    }

    /// The answer that a pair of levels gives.
    #[inline(always)]
    pub(super) fn fill_found(&mut self, found: &LevelBounds, decided_by: DecidedBy, steps: u32) {
        self.answer.decided_by = decided_by;
        self.answer.statistics = Statistics { marching_steps: steps, levels: found.at.levels, ..Statistics::default() };
        self.set_open_interval(&Interval { lower: found.lower, upper: found.upper }, found.lower);
        contact::fill_nothing(self.answer);
        self.answer.normal = found.normal.into();
    }
}

impl<'a> LevelSearch<'a> {
    fn run(self, pair: &mut PairQuery<'a, NoBalls>) -> LevelSearched<'a> {
        let bodies = self.bodies;
        let (from, is_trial) = self.start(pair);
        // Marching in pieces, a budget at a time, does not see that it goes round in circles: penetration, mostly.
        if self.before > step_limit(pair.polyhedra()) {
            let at = bodies.descended(from, [0, 0]).state;
            return LevelSearched::Marched(self, Attempt::Open(Open { at, is_minimum: false, steps: 0 }));
        }
        let mut descent = pair.descent(bodies, from, is_trial);
        let mut descended = simd::dispatch(&mut descent);
        if descended == Descended::Lost {
            if pair.may_start_anew() && has_tables(bodies.polyhedra(from.levels)) {
                descent.at = self.start_anew(pair);
            }
            descent.is_trial = false;
            descended = simd::dispatch(&mut descent);
        }
        let LevelDescent { at, is_trial, steps, step_limit, found, .. } = descent;
        match (descended, found) {
            (Descended::Enough, Some(found)) => {
                pair.fill_found(&found, DecidedBy::Tolerance, steps);
                self.remember_at(pair, at, found.lower);
                if steps > 1 {
                    pair.remember_marker();
                }
                LevelSearched::Answered
            }
            (Descended::Finest, _) => self.march(pair, at.state, steps, Leg::of(step_limit - steps, is_trial)),
            _ => self.spend(pair, found, at, steps),
        }
    }

    /// The start of the search: where the last one ended, else at the coarsest levels. Also returns whether it is the former.
    fn start(&self, pair: &PairQuery<NoBalls>) -> (LevelState, bool) {
        let recalled = if pair.asks_cache() { pair.cache.level_state(&self.bodies) } else { None };
        match recalled {
            // An exact query left it.
            Some(last)
                if last.levels == [0, 0] && self.has_levels && pair.query == Query::Approximate && self.before == 0 =>
            {
                (self.bodies.coarsened(last, f64::INFINITY, pair.surely_near_enough()), true)
            }
            Some(last) if self.has_levels || last.levels == [0, 0] => (last, true),
            _ => (self.start_anew(pair), false),
        }
    }

    /// The start if it is not where the last search ended: at the levels that may be near enough, at the vertices from their
    /// tables. Without tables it is at the coarsest levels.
    fn start_anew(&self, pair: &PairQuery<NoBalls>) -> LevelState {
        let bodies = &self.bodies;
        let levels = if !self.has_levels {
            [0, 0]
        } else if pair.asks_tables() && has_tables(pair.polyhedra()) {
            let finest = LevelState { levels: [0, 0], state: State::vertex_vertex([0, 0]) };
            bodies.coarsened(finest, f64::INFINITY, pair.surely_near_enough()).levels
        } else {
            bodies.coarsest()
        };
        let from = if pair.asks_tables() { StartFrom::Centres } else { StartFrom::Farthest };
        let vertices = start_pair(&bodies.pair(levels), from).vertices();
        LevelState { levels, state: State::vertex_vertex(vertices) }
    }

    /// Marching at the bodies themselves, from a state of theirs, of an earlier query or not; `steps` are made already.
    fn march(self, pair: &mut PairQuery<'a, NoBalls>, state: State, steps: u32, leg: Leg) -> LevelSearched<'a> {
        let at_bodies = |state| LevelState { levels: [0, 0], state };
        if leg == Leg::Budget(0) {
            return self.spend(pair, None, at_bodies(state), steps);
        }
        let attempt = pair.march_on(state, steps, leg);
        if let Attempt::Open(Open { at, is_minimum: false, steps: made }) = attempt
            && leg == Leg::Budget(made - steps)
        {
            return self.spend(pair, None, at_bodies(at), made);
        }
        LevelSearched::Marched(self, attempt)
    }

    /// The cache for the next query, after the bodies themselves have answered.
    pub(super) fn remember(&self, pair: &mut PairQuery<NoBalls>) {
        if pair.answer.outcome != Outcome::Intersecting
            && let Some(state) = pair.cache.features_of(pair.polyhedra())
        {
            let gap = pair.answer.lower;
            self.remember_at(pair, LevelState { levels: [0, 0], state }, gap);
        }
    }

    /// The cache for the next query: as high up as its levels would be disjoint and, where that is all that counts, near enough.
    fn remember_at(&self, pair: &mut PairQuery<NoBalls>, at: LevelState, gap: f64) {
        if !self.has_levels {
            pair.cache.remember_features(at.state);
            return;
        }
        let most = pair.near_enough(gap);
        pair.cache.remember_level_state(self.bodies.coarsened(at, gap, most), 0);
    }

    /// The answer when the steps are spent: the bounds of the levels, or of a look along the line of two vertices.
    #[cold]
    fn spend(
        &self,
        pair: &mut PairQuery<NoBalls>,
        found: Option<LevelBounds>,
        at: LevelState,
        steps: u32,
    ) -> LevelSearched<'a> {
        let bodies = pair.pair();
        let finest = self.bodies.descended(at, [0, 0]);
        let vertices = finest.state.vertices(bodies.polyhedra);
        let glance = simd::dispatch(&mut Glance { pair: bodies, vertices });
        let mut known = LevelBounds { at: finest, lower: 0.0, upper: f64::INFINITY, normal: glance.direction };
        if glance.interval.lower > 0.0 {
            known.lower = glance.interval.lower;
            known.normal = contact::normalised(&glance.direction).into();
        }
        if glance.interval.upper < known.upper {
            known.upper = glance.interval.upper;
        }
        if let Some(found) = found {
            if found.lower > known.lower {
                known = LevelBounds { upper: known.upper, ..found };
            }
            known.upper = if found.upper < known.upper { found.upper } else { known.upper };
        }
        pair.fill_found(&known, DecidedBy::Budget, steps);
        if !(known.lower > 0.0) {
            pair.answer.outcome = Outcome::Undecided;
            contact::fill_nothing(pair.answer);
        }
        pair.cache.remember_level_state(at, self.before.saturating_add(steps));
        LevelSearched::Answered
    }
}

/// Whether two bodies, or levels, have look-up tables to start from.
fn has_tables([first, second]: [&Polyhedron; 2]) -> bool {
    first.lookup.serves_with(&second.lookup)
}

/// The bounds on the distance from the line through two vertices: their distance from above, supports along it from below.
struct Glance<'a> {
    pair: Pair<'a>,
    vertices: [u32; 2],
}

impl Kernel for Glance<'_> {
    type Output = Nearest;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Nearest {
        let frame = Frame::<L>::new(&self.pair);
        let direction = gjk::difference(&frame, self.vertices);
        let simplex =
            Simplex { count: 1, pairs: [self.vertices; 4], differences: [direction; 4], weights: [1.0, 0.0, 0.0, 0.0] };
        let [g1, g2] = gjk::towards(&frame, &direction);
        let [v, w] = self.vertices;
        let supports = [climb(self.pair.polyhedra[0], g1, v), climb(self.pair.polyhedra[1], g2, w)];
        gjk::certify(&frame, simplex, &direction, supports)
    }
}
