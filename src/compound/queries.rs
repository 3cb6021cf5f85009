//! Verdict and distance of two compounds.

use super::PlacedCompound;
use super::answer::CompoundAnswer;
use super::between::{Between, Reaches};
use super::cache::{CompoundCache, PieceCaches};
use super::front::follow;
use super::placed::{PlacedPieces, with_pieces};
use super::walk::{Aim, PiecePair, walk};
use crate::base::error::Result;
use crate::base::simd::environment::with_default;
use crate::pair::{self, Outcome, PairAnswer, PairCache, PairConfig, Placed, Query};

/// The distance of two compounds, which is the least of any two pieces, with its interval; `answer.answer` is that of the nearest
/// two, with the interval widened to hold the others'. Intersecting compounds have distance 0 and name two pieces that intersect,
/// with their proof.
///
/// For compounds beyond `config.max_distance` only `lower` is set, and no pieces are named. Pieces are about as near where
/// they share a vertex: any of them may be named.
///
/// # Errors
/// As of [`pair::distance`], and [`Error::Pose`](crate::base::error::Error::Pose) where the product of both poses of a piece is
/// refused. Then `cache` and `answer` are as they were.
pub fn distance(
    bodies: [PlacedCompound; 2],
    cache: &mut CompoundCache,
    config: &PairConfig,
    answer: &mut CompoundAnswer,
) -> Result<()> {
    with_default(|| ask(Query::Distance, &bodies.map(|body| body.placed_pieces()), cache, config, answer))
}

/// The verdict alone: [`Outcome::Intersecting`], with two pieces that do and their proof, or [`Outcome::Separated`] with
/// `lower` > 0 (0 only for a distance below the smallest double), an infinite `upper` and no pieces. With a finite
/// `config.max_distance` also [`Outcome::Beyond`]; two pieces within the tolerance are named then.
///
/// # Errors
/// As of [`distance`].
pub fn intersection(
    bodies: [PlacedCompound; 2],
    cache: &mut CompoundCache,
    config: &PairConfig,
    answer: &mut CompoundAnswer,
) -> Result<()> {
    with_default(|| ask(Query::Intersection, &bodies.map(|body| body.placed_pieces()), cache, config, answer))
}

/// The same of any pieces, of curved bodies too: [`Outcome::Undecided`] where none meet for certain and some may.
///
/// # Errors
/// As of [`distance`].
pub(crate) fn ask<C: PieceCaches>(
    query: Query,
    bodies: &[PlacedPieces; 2],
    cache: &mut C,
    config: &PairConfig,
    answer: &mut CompoundAnswer,
) -> Result<()> {
    debug_assert!(matches!(query, Query::Distance | Query::Intersection));
    config.check(query)?;
    let reaches = Reaches::new(bodies)?;
    let is_verdict = query == Query::Intersection && config.max_distance == f64::INFINITY;
    let mut least = LeastOfPieces {
        query,
        is_verdict,
        bodies,
        cache,
        // Poses of bodies are checked, those of pieces meet the limit that they were made with.
        config: *config,
        answer,
        tolerance: config.max_distance,
        enough: if is_verdict { 0.0 } else { config.max_distance },
        lower: f64::INFINITY,
        named: None,
        may_meet: false,
    };
    // Far apart is the most frequent answer of all.
    let apart = reaches.between_balls();
    if apart > least.enough {
        least.lower = apart;
        least.finish();
        return Ok(());
    }
    least.run(&Between::new(bodies, &reaches))
}

/// The least distance of the pairs of pieces that have been asked.
struct LeastOfPieces<'a, C> {
    query: Query,
    /// Whether only the verdict is asked: all that is apart is passed by.
    is_verdict: bool,
    bodies: &'a [PlacedPieces<'a>; 2],
    cache: &'a mut C,
    config: PairConfig,
    answer: &'a mut CompoundAnswer,
    tolerance: f64,
    /// Anything farther apart no longer counts.
    enough: f64,
    /// All that has been asked is at least this far apart.
    lower: f64,
    /// The pair that `answer` is about.
    named: Option<[u32; 2]>,
    /// Whether some, of which one is curved, are neither apart nor meet for certain.
    may_meet: bool,
}

/// A distance is asked up to the least one known and this share of it more: of pieces that are as near, which is common, rounding
/// would otherwise leave it to integers which are nearer.
pub(crate) const MORE: f64 = 1.0 + 1e-9;

impl<C: PieceCaches> LeastOfPieces<'_, C> {
    fn run(mut self, between: &Between) -> Result<()> {
        let counts = self.bodies.map(|body| body.count());
        let last = if self.is_verdict { self.cache.last().met(counts) } else { self.cache.last().nearest(counts) };
        let mut is_open = true;
        if let Some(pieces) = last {
            is_open = self.learn(pieces, between)?;
        }
        if is_open {
            let aim = if self.is_verdict { Aim::Verdict } else { Aim::Distance };
            let pair = PiecePair { trees: self.bodies.map(|body| body.tree), between, aim };
            // Bodies that met before may meet again, which the usual order finds sooner.
            let follows = self.is_verdict && last.is_none() && self.cache.front().is_near(between);
            let passed = if follows {
                let mut front = *self.cache.front();
                let passed = follow(&mut front, pair, |pieces| self.learn(pieces, between))?;
                *self.cache.front() = front;
                passed
            } else {
                walk(pair, self.enough, |pieces| {
                    if last == Some(pieces) || self.learn(pieces, between)? { Ok(Some(self.enough)) } else { Ok(None) }
                })?
            };
            self.lower = self.lower.min(passed);
        }
        self.finish();
        Ok(())
    }

    /// Asks two pieces; whether others may still be nearer.
    fn learn(&mut self, pieces: [u32; 2], between: &Between) -> Result<bool> {
        if !self.is_verdict {
            self.config.max_distance = (self.enough * MORE).min(self.tolerance);
        }
        let mut answer = PairAnswer::default();
        let cache = self.cache.of(pieces);
        with_pieces(self.bodies, pieces, |placed| ask_pair(self.query, placed, cache, &self.config, &mut answer))?;
        if answer.outcome == Outcome::Intersecting {
            self.lower = 0.0;
            self.may_meet = false;
            self.name(pieces, &answer);
            return Ok(false);
        }
        self.lower = self.lower.min(answer.lower);
        // The upper end may be infinite: distances need not be doubles.
        let is_nearer = self.named.is_none() || answer.upper < self.answer.answer.upper;
        let is_undecided = answer.outcome == Outcome::Undecided;
        self.may_meet |= is_undecided;
        if self.is_verdict {
            if is_undecided && self.named.is_none() {
                self.name(pieces, &answer);
            }
        } else if (is_undecided || answer.outcome == Outcome::Separated) && is_nearer {
            self.enough = self.enough.min(answer.upper);
            self.name(pieces, &answer);
            between.look_along(&answer.normal, self.bodies[0].pose);
        }
        Ok(true)
    }

    fn name(&mut self, pieces: [u32; 2], answer: &PairAnswer) {
        self.named = Some(pieces);
        *self.answer = CompoundAnswer { answer: *answer, piece1: pieces[0], piece2: pieces[1] };
    }

    fn finish(self) {
        let counts = self.bodies.map(|body| body.count());
        let answer = &mut *self.answer;
        if self.named.is_none() {
            let outcome = if self.is_verdict { Outcome::Separated } else { Outcome::Beyond };
            let unsaid = PairAnswer { outcome, upper: f64::INFINITY, distance: self.lower, ..PairAnswer::UNSAID };
            *answer = CompoundAnswer { answer: unsaid, piece1: counts[0] as u32, piece2: counts[1] as u32 };
        }
        answer.answer.lower = self.lower;
        if self.may_meet {
            answer.answer.outcome = Outcome::Undecided;
        }
        if self.is_verdict {
            self.cache.last().remember_met(self.named);
        } else if self.named.is_some() {
            self.cache.last().remember_nearest(self.named);
        }
    }
}

/// In line, so that each query is called directly.
#[inline(always)]
fn ask_pair(
    query: Query,
    placed: [Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    match query {
        Query::Intersection => pair::intersection(placed, cache, config, answer),
        _ => pair::distance(placed, cache, config, answer),
    }
}
