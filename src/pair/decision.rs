//! What marching leaves open: proofs re-tested, the fallback, the exact tier.

use super::acceptance::{Acceptance, Closely};
use super::attempt::{FAR, General, has_turned_away, may_have_come_apart};
use super::{Attempt, Levels, Outcome, PairCache, PairQuery, Query, Start, Statistics, Status, set_interval};
use crate::base::error::Result;
use crate::base::math::ROTATION_LIMIT;
use crate::base::simd::{self, Portable};
use crate::pair::contact;
use crate::pair::contact_direction::contact_direction;
use crate::pair::start::{self, Guess};
use crate::shape::Shape;
use crate::solve::decide::{self, Decision, Pairs, Wanted};
use crate::solve::enclosure::encloses_origin;
use crate::solve::frame::Frame;
use crate::solve::state::State;

impl PairQuery<'_> {
    /// The whole query, for what is not the common case from the start.
    #[cold]
    pub(super) fn begin(&mut self, shapes: [&Shape; 2]) -> Result<()> {
        if !self.config.start.asks_cache() {
            self.forget()?;
        }
        self.go_on(Attempt::Unusual, shapes)
    }

    pub(super) fn check_poses(&self) -> Result<()> {
        self.poses.iter().try_for_each(|pose| pose.check(self.config.rotation_limit))
    }

    /// Clears the cache, unless the poses are refused: who is refused finds nothing changed.
    pub(super) fn forget(&mut self) -> Result<()> {
        self.check_poses()?;
        *self.cache = PairCache::default();
        Ok(())
    }

    /// The rest of a query whose first attempt did not answer it.
    #[inline(never)]
    pub(super) fn go_on(&mut self, attempt: Attempt, shapes: [&Shape; 2]) -> Result<()> {
        let polyhedra = self.polyhedra;
        let attempt = match attempt {
            Attempt::Unusual | Attempt::Cold => {
                if self.config.levels == Levels::All {
                    return self.descend(shapes);
                }
                if let Some(pairs) = self.cache.recall_pairs(polyhedra) {
                    return self.decide(pairs, 0);
                }
                simd::dispatch(&mut General { pair: self, beginning: None })
            }
            open => open,
        };
        self.end(attempt)
    }

    /// What an attempt at the bodies themselves left open is decided.
    pub(super) fn end(&mut self, attempt: Attempt) -> Result<()> {
        match self.settle(attempt) {
            None => Ok(()),
            Some((at, steps)) => self.decide(Pairs::new(&[at.vertices(self.polyhedra)]), steps),
        }
    }

    /// What an attempt left open, after a closer look: where to go on and the steps made so far.
    fn settle(&mut self, attempt: Attempt) -> Option<(State, u32)> {
        match attempt {
            Attempt::Done => None,
            Attempt::Open { at, is_minimum: true, steps } if self.closely(at, steps) => None,
            Attempt::Open { at, steps, .. } => Some((at, steps)),
            Attempt::Unusual | Attempt::Cold => Some((State::vertex_vertex([0, 0]), 0)),
        }
    }

    /// Decides what marching left open; `hint` are vertex pairs to begin with, those of an intersection from the cache or one
    /// that marching came to, `steps` those made so far.
    #[inline(never)]
    fn decide(&mut self, mut hint: Pairs, steps: u32) -> Result<()> {
        let &mut PairQuery { query, polyhedra, poses, config, .. } = self;
        let frame = Frame::<Portable>::new(polyhedra, poses, config.rotation_limit);
        let frame = frame.usual.then_some(frame);
        if frame.is_none() {
            self.check_poses()?;
        }
        let mut statistics = Statistics { marching_steps: steps, ..Statistics::default() };
        // The tetrahedron of the last query: if it still encloses the origin, that is a proof.
        if let Some(frame) = &frame
            && let Some(weights) = encloses_origin(frame, hint.as_slice())
        {
            let decision = Decision::Intersecting { pairs: hint, weights };
            self.answer.statistics = statistics;
            self.answer.status = Status::Coherent;
            self.fill(&decision);
            frame.mark(&mut self.cache.marker);
            return Ok(());
        }
        // Bodies that intersected the last time and have jumped apart are for marching. Those whose cores may overlap have not, and
        // up to 72° the last tetrahedron is the better hint (of fat bodies at 5° to 45° it saves 15 to 5 of 100
        // instructions).
        if let Some(frame) = &frame
            && config.start != Start::Cache
            && self.cache.recall_pairs(polyhedra).is_some()
            && (frame.has_moved(&self.cache.marker, FAR)
                || (may_have_come_apart(frame, &self.cache.marker) && !start::may_cores_overlap(polyhedra, poses)))
        {
            let beginning = start::anew(polyhedra, poses, true);
            if has_turned_away(frame, &self.cache.marker) {
                hint = Pairs::new(&[beginning.vertices()]);
            }
            if beginning.guess == Guess::Apart {
                let attempt = simd::dispatch(&mut General { pair: self, beginning: Some(beginning) });
                match self.settle(attempt) {
                    None => return Ok(()),
                    Some((at, steps)) => {
                        hint = Pairs::new(&[at.vertices(polyhedra)]);
                        statistics.marching_steps = steps;
                    }
                }
            }
        }
        // Cheap bounds or not, nearest points are to be nearest.
        let tight = query != Query::Intersection || config.distance_tolerance < f64::INFINITY;
        let wanted = Wanted { tight, distance_tolerance: config.distance_tolerance };
        let (decision, work) = decide::decide(polyhedra, poses, frame.is_some(), hint.as_slice(), wanted);
        let decide::Work { fallback_iterations, exact_iterations } = work;
        statistics.fallback_iterations = fallback_iterations;
        statistics.exact_iterations = exact_iterations;
        self.answer.statistics = statistics;
        self.answer.status = if exact_iterations > 0 { Status::Exact } else { Status::Fallback };
        self.fill(&decision);
        if let Some(frame) = &frame {
            frame.mark(&mut self.cache.marker);
        }
        Ok(())
    }

    /// Whether a closer look at a minimum accepts it.
    fn closely(&mut self, at: State, steps: u32) -> bool {
        let &mut PairQuery { query, polyhedra, poses, ref mut cache, config, ref mut answer } = self;
        let judge = Acceptance { query, config, cache, answer, accepted: false };
        let mut look = Closely::<false> { judge, polyhedra, poses, at };
        simd::dispatch(&mut look);
        let mut accepted = look.judge.accepted;
        if !accepted {
            let mut look = Closely::<true> { judge: look.judge, polyhedra, poses, at };
            simd::dispatch(&mut look);
            accepted = look.judge.accepted;
        }
        if accepted {
            self.answer.statistics = Statistics { marching_steps: steps, ..Statistics::default() };
            if steps > 1 {
                self.remember_marker();
            }
        }
        accepted
    }

    pub(super) fn remember_marker(&mut self) {
        let frame = Frame::<Portable>::new(self.polyhedra, self.poses, ROTATION_LIMIT);
        frame.mark(&mut self.cache.marker);
    }

    /// Answer and cache from a decision.
    pub(super) fn fill(&mut self, decision: &Decision) {
        let &mut PairQuery { query, polyhedra, poses, ref mut cache, config, ref mut answer } = self;
        match decision {
            Decision::Separated { points, direction, interval, pairs } => {
                set_interval(answer, interval, 0.5 * interval.lower + 0.5 * interval.upper, config.distance_tolerance);
                let vertices = State::vertex_vertex(pairs.as_slice()[0]);
                if query == Query::Intersection {
                    // The points need not be nearest, so no feature need hold them, and to search all takes long.
                    cache.remember_state(vertices);
                } else {
                    let features = contact::features_of_pairs(polyhedra, poses, pairs.as_slice(), points, direction);
                    cache.remember_state(State::of_features(features).unwrap_or(vertices));
                    if answer.outcome == Outcome::Separated {
                        contact::fill_placed(answer, polyhedra, poses, points, direction, features);
                        return;
                    }
                }
                contact::fill_nothing(answer);
                answer.normal = contact::normalised(direction);
            }
            Decision::Intersecting { pairs, weights } => {
                cache.remember_pairs(pairs.as_slice());
                answer.outcome = Outcome::Intersecting;
                answer.distance = 0.0;
                answer.lower = 0.0;
                answer.upper = 0.0;
                contact::fill_proof(answer, polyhedra, pairs.as_slice());
                if query == Query::Contact {
                    let overlap = &contact_direction(polyhedra, poses, pairs.as_slice());
                    let weights = contact::refined_weights(polyhedra, poses, pairs.as_slice(), *weights);
                    let points = decide::combinations(polyhedra, pairs.as_slice(), &weights);
                    let features = contact::features_of_overlap(polyhedra, poses, pairs.as_slice(), &points, overlap);
                    contact::fill_placed(answer, polyhedra, poses, &points, &overlap.direction, features);
                } else {
                    contact::fill_nothing(answer);
                }
            }
        }
    }
}
