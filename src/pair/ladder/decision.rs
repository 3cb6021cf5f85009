//! The cases that marching leaves open: a closer look, the last enclosure re-tested, the fallback, integers.

use super::acceptance::{Acceptance, Closely};
use super::query::{Attempt, NoBalls, PairQuery};
use crate::answer::{DecidedBy, Outcome, Query, Statistics, contact};
use crate::base::error::Result;
use crate::base::memory::in_integers;
use crate::base::simd::{self, Kernel, Lanes, Portable};
use crate::body::tables::tuning::TURNED_AWAY;
use crate::depth::facets::{self, Proved};
use crate::depth::{KeptFacets, deepest};
use crate::distance::decide::{self, Decision, Pairs};
use crate::distance::enclosure::encloses_origin;
use crate::pair::start::policy;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;
use crate::placed::state::State;

/// The place to go on from.
#[derive(Clone, Copy)]
pub(super) struct Hint {
    /// The vertex pairs of the last intersection, or one near which marching ended.
    pub pairs: Pairs,
    /// Steps of marching made so far.
    pub steps: u32,
}

impl PairQuery<'_, NoBalls> {
    /// Whether a closer look at the result of marching answers; else where to go on.
    pub(super) fn look_closer(&mut self, attempt: Attempt) -> Option<Hint> {
        let (at, steps) = match attempt {
            Attempt::Answered => return None,
            Attempt::Open(open) if open.is_minimum && self.accepts_closely(open.at, open.steps) => return None,
            Attempt::Open(open) => (open.at, open.steps),
            Attempt::Untried | Attempt::NotEnclosed => (State::vertex_vertex([0, 0]), 0),
        };
        Some(Hint { pairs: Pairs::new(&[at.vertices(self.polyhedra())]), steps })
    }

    fn accepts_closely(&mut self, at: State, steps: u32) -> bool {
        let mut look = Closely::<false> { acceptance: Acceptance { pair: self, accepted: false }, at };
        simd::dispatch(&mut look);
        let mut accepted = look.acceptance.accepted;
        if !accepted {
            let mut look = Closely::<true> { acceptance: look.acceptance, at };
            simd::dispatch(&mut look);
            accepted = look.acceptance.accepted;
        }
        if accepted {
            self.answer.statistics = Statistics { marching_steps: steps, ..Statistics::default() };
            if steps > 1 {
                self.remember_marker();
            }
        }
        accepted
    }

    /// Whether the tetrahedron of the last query still encloses the origin, for bodies that are [simple](PairQuery::is_simple).
    #[inline(always)]
    pub(super) fn look_at_last_proof(&mut self) -> Attempt {
        simd::dispatch_to_avx2(&mut LastEnclosure { pair: self })
    }

    /// Whether the tetrahedron of the last query, or what else the hint holds, encloses the origin: that is a proof.
    ///
    /// # Errors
    /// As of [`PairQuery::decide`].
    pub(super) fn is_enclosed(&mut self, frame: &Frame<Portable>, hint: &Hint) -> Result<bool> {
        let Some(weights) = encloses_origin(frame, hint.pairs.as_slice()) else { return Ok(false) };
        self.fill_enclosed(frame, hint, weights)?;
        Ok(true)
    }

    /// The same of the last enclosure alone, for bodies and poses of any kind.
    ///
    /// # Errors
    /// As of [`PairQuery::decide`].
    pub(super) fn is_still_enclosed(&mut self) -> Result<bool> {
        let Some(pairs) = self.cache.enclosure(self.polyhedra()) else { return Ok(false) };
        let frame = self.frame::<Portable>();
        if !frame.in_range {
            return Ok(false);
        }
        self.is_enclosed(&frame, &Hint { pairs, steps: 0 })
    }

    /// Answer and cache from a hint that holds the origin.
    #[inline(always)]
    fn fill_enclosed<L: Lanes>(&mut self, frame: &Frame<L>, hint: &Hint, weights: [f64; 4]) -> Result<()> {
        let statistics = Statistics { marching_steps: hint.steps, ..Statistics::default() };
        self.fill(&Decision::Intersecting { pairs: hint.pairs, weights }, statistics, DecidedBy::Coherence)?;
        frame.mark(&mut self.cache.marker);
        Ok(())
    }

    /// Whether the bodies intersected the last time and have jumped so that they are for marching.
    pub(super) fn may_have_come_apart(&self, frame: &Frame<Portable>) -> bool {
        self.may_start_anew()
            && self.cache.enclosure(self.polyhedra()).is_some()
            && policy::may_have_come_apart(frame, &self.cache.marker, self.poses())
    }

    /// Whether the pair has moved so far that a pair from the tables is a better hint than the last enclosure.
    pub(super) fn has_turned_away(&self, frame: &Frame<Portable>) -> bool {
        frame.has_moved(&self.cache.marker, TURNED_AWAY)
    }

    /// The last rungs: the fallback, where there is a frame in range, and integers.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory) where integers get none: answer and cache are as they were.
    #[inline(never)]
    pub(super) fn decide(&mut self, frame: Option<&Frame<Portable>>, hint: &Hint) -> Result<()> {
        let pair = &self.pair();
        let wanted = self.wanted();
        let (decision, effort) = in_integers(|| decide::decide(pair, frame.is_some(), hint.pairs.as_slice(), wanted))?;
        let decide::Effort { fallback_iterations, exact_iterations } = effort;
        let statistics =
            Statistics { marching_steps: hint.steps, fallback_iterations, exact_iterations, ..Statistics::default() };
        let decided_by = if exact_iterations > 0 { DecidedBy::Integers } else { DecidedBy::Fallback };
        self.fill(&decision, statistics, decided_by)?;
        if let Some(frame) = frame {
            frame.mark(&mut self.cache.marker);
        }
        Ok(())
    }

    pub(super) fn remember_marker(&mut self) {
        let frame = Frame::<Portable>::new(&self.pair());
        frame.mark(&mut self.cache.marker);
    }

    /// Answer and cache from a decision.
    fn fill(&mut self, decision: &Decision, statistics: Statistics, decided_by: DecidedBy) -> Result<()> {
        let pair = &self.pair();
        // A pair that intersected the last time may rest. All that may fail comes first.
        let may_rest = self.is_simple() && self.cache.holds_enclosure();
        let keeps = if may_rest { KeptFacets::Shallow } else { KeptFacets::None };
        let is_contact = self.query == Query::Contact && matches!(decision, Decision::Intersecting { .. });
        let depth = if is_contact { Some(deepest(pair, keeps)?) } else { None };
        (self.answer.statistics, self.answer.decided_by) = (statistics, decided_by);
        if let Decision::Separated { interval, .. } = decision {
            self.set_interval(interval, 0.5 * interval.lower + 0.5 * interval.upper);
        }
        let &mut PairQuery { query, ref mut cache, ref mut answer, .. } = self;
        match decision {
            Decision::Separated { points, direction, pairs, .. } => {
                let vertices = State::vertex_vertex(pairs.as_slice()[0]);
                if query == Query::Intersection {
                    // The points need not be nearest, so no feature need hold them, and to search all takes long.
                    cache.remember_features(vertices);
                } else {
                    let features = contact::features_of_pairs(pair, pairs.as_slice(), points, direction, 0.0);
                    cache.remember_features(State::of_features(features).unwrap_or(vertices));
                    if answer.outcome == Outcome::Separated {
                        contact::fill_placed(answer, pair, points, features);
                        answer.normal = contact::normalised(direction);
                        return Ok(());
                    }
                }
                contact::fill_nothing(answer);
                answer.normal = contact::normalised(direction);
            }
            Decision::Intersecting { pairs, weights } => {
                cache.remember_enclosure(pairs.as_slice());
                answer.outcome = Outcome::Intersecting;
                answer.distance = 0.0;
                answer.lower = 0.0;
                answer.upper = 0.0;
                contact::fill_proof(answer, pair.polyhedra, pairs.as_slice());
                if let Some((least, facet)) = depth {
                    let weights = contact::refined_weights(pair, pairs.as_slice(), *weights);
                    let points = decide::combinations(pair.polyhedra, pairs.as_slice(), &weights);
                    if let Some(facet) = facet {
                        cache.remember_facet(facet);
                    }
                    let contact::PlacedPoints { local, world } = contact::placed_points(pair, &points);
                    [answer.local1, answer.local2] = local;
                    [answer.world1, answer.world2] = world;
                    answer.normal = least.normal;
                    (answer.feature1, answer.feature2) = (least.feature1, least.feature2);
                    answer.statistics.exact_iterations += least.statistics.exact_iterations;
                } else {
                    contact::fill_nothing(answer);
                }
            }
        }
        Ok(())
    }
}

/// The common case of bodies that intersect: the last proof still holds.
struct LastEnclosure<'a, 'b> {
    pair: &'a mut PairQuery<'b, NoBalls>,
}

impl Kernel for LastEnclosure<'_, '_> {
    type Output = Attempt;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Attempt {
        let bodies = self.pair.pair();
        let Some(pairs) = self.pair.cache.enclosure(bodies.polyhedra) else { return Attempt::Untried };
        let frame = Frame::<L>::of_rigid(&bodies);
        if !frame.in_range {
            return Attempt::Untried;
        }
        let Some(weights) = encloses_origin(&frame, pairs.as_slice()) else { return Attempt::NotEnclosed };
        if self.pair.query == Query::Contact
            && let Some(facet) = self.pair.cache.facet()
            && let Ok(proved) = facets::prove(&frame, facet)
        {
            self.fill_at_rest(&frame, pairs.as_slice(), weights, &proved);
            return Attempt::Answered;
        }
        // If memory is lacking for integers, the later rungs report it.
        if self.pair.fill_enclosed(&frame, &Hint { pairs, steps: 0 }, weights).is_err() {
            return Attempt::Untried;
        }
        Attempt::Answered
    }
}

impl LastEnclosure<'_, '_> {
    /// The contact of bodies whose depth the facet of before still proves.
    #[inline(always)]
    fn fill_at_rest<L: Lanes>(
        &mut self,
        frame: &Frame<L>,
        pairs: &[VertexPair],
        weights: [f64; 4],
        proved: &Proved<L>,
    ) {
        let pair = &mut *self.pair;
        let bodies = &pair.pair();
        let mut points = decide::combinations(bodies.polyhedra, pairs, &weights);
        // If the tetrahedron is thin, the two points do not coincide yet.
        let error = frame.difference_error(0.0);
        if frame.difference(&points[0], &points[1]).to_vector().norm() > error {
            let weights = contact::refined_weights(bodies, pairs, weights);
            points = decide::combinations(bodies.polyhedra, pairs, &weights);
        }
        pair.cache.remember_facet(proved.facet);
        frame.mark(&mut pair.cache.marker);
        let answer = &mut *pair.answer;
        answer.statistics = Statistics::default();
        answer.decided_by = DecidedBy::Coherence;
        answer.outcome = Outcome::Intersecting;
        (answer.distance, answer.lower, answer.upper) = (0.0, 0.0, 0.0);
        contact::fill_proof(answer, bodies.polyhedra, pairs);
        let contact::PlacedPoints { local, world } = contact::placed_points(bodies, &points);
        [answer.local1, answer.local2] = local;
        [answer.world1, answer.world2] = world;
        proved.direction.negate().store_vector(&mut answer.normal);
        let [first, second] = proved.features;
        answer.feature1 = contact::label(bodies.polyhedra[0], first, &proved.points[0].to_vector());
        answer.feature2 = contact::label(bodies.polyhedra[1], second, &proved.points[1].to_vector());
    }
}
