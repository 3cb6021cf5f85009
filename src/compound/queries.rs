//! Verdict and distance of two compounds.

use super::PlacedCompound;
use super::answer::CompoundAnswer;
use super::between::{Between, Reaches};
use super::cache::CompoundCache;
use super::walk::{Aim, PiecePair, walk};
use crate::base::error::Result;
use crate::base::math::Pose;
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
    with_default(|| ask(Query::Distance, &bodies, cache, config, answer))
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
    with_default(|| ask(Query::Intersection, &bodies, cache, config, answer))
}

fn ask(
    query: Query,
    bodies: &[PlacedCompound; 2],
    cache: &mut CompoundCache,
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
struct LeastOfPieces<'a> {
    query: Query,
    /// Whether only the verdict is asked: all that is apart is passed by.
    is_verdict: bool,
    bodies: &'a [PlacedCompound<'a>; 2],
    cache: &'a mut CompoundCache,
    config: PairConfig,
    answer: &'a mut CompoundAnswer,
    tolerance: f64,
    /// Anything farther apart no longer counts.
    enough: f64,
    /// All that has been asked is at least this far apart.
    lower: f64,
    /// The pair that `answer` is about.
    named: Option<[u32; 2]>,
}

/// A distance is asked up to the least one known and this share of it more: of pieces that are as near, which is common, rounding
/// would otherwise leave it to integers which are nearer.
pub(super) const MORE: f64 = 1.0 + 1e-9;

impl LeastOfPieces<'_> {
    fn run(mut self, between: &Between) -> Result<()> {
        let counts = self.bodies.map(|body| body.compound.piece_count());
        let last = if self.is_verdict { self.cache.met(counts) } else { self.cache.nearest(counts) };
        let mut is_open = true;
        if let Some(pieces) = last {
            is_open = self.learn(pieces)?;
        }
        if is_open {
            let aim = if self.is_verdict { Aim::Verdict } else { Aim::Distance };
            let pair = PiecePair { trees: self.bodies.map(|body| &body.compound.tree), between, aim };
            let passed = walk(pair, self.enough, |pieces| {
                if last == Some(pieces) || self.learn(pieces)? { Ok(Some(self.enough)) } else { Ok(None) }
            })?;
            self.lower = self.lower.min(passed);
        }
        self.finish();
        Ok(())
    }

    /// Asks two pieces; whether others may still be nearer.
    fn learn(&mut self, pieces: [u32; 2]) -> Result<bool> {
        if !self.is_verdict {
            self.config.max_distance = (self.enough * MORE).min(self.tolerance);
        }
        let mut answer = PairAnswer::default();
        let cache = self.cache.of(pieces);
        with_pieces(self.bodies, pieces, |placed| ask_pair(self.query, placed, cache, &self.config, &mut answer))?;
        if answer.outcome == Outcome::Intersecting {
            self.lower = 0.0;
            self.name(pieces, &answer);
            return Ok(false);
        }
        self.lower = self.lower.min(answer.lower);
        // The upper end may be infinite: distances need not be doubles.
        let is_nearer = self.named.is_none() || answer.upper < self.answer.answer.upper;
        if answer.outcome == Outcome::Separated && !self.is_verdict && is_nearer {
            self.enough = self.enough.min(answer.upper);
            self.name(pieces, &answer);
        }
        Ok(true)
    }

    fn name(&mut self, pieces: [u32; 2], answer: &PairAnswer) {
        self.named = Some(pieces);
        *self.answer = CompoundAnswer { answer: *answer, piece1: pieces[0], piece2: pieces[1] };
    }

    fn finish(self) {
        let counts = self.bodies.map(|body| body.compound.piece_count());
        let answer = &mut *self.answer;
        if self.named.is_none() {
            let outcome = if self.is_verdict { Outcome::Separated } else { Outcome::Beyond };
            let unsaid = PairAnswer { outcome, upper: f64::INFINITY, distance: self.lower, ..PairAnswer::UNSAID };
            *answer = CompoundAnswer { answer: unsaid, piece1: counts[0] as u32, piece2: counts[1] as u32 };
        }
        answer.answer.lower = self.lower;
        if self.is_verdict {
            self.cache.remember_met(self.named);
        } else if self.named.is_some() {
            self.cache.remember_nearest(self.named);
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

/// Two pieces where they are.
#[inline(always)]
pub(super) fn with_pieces<T>(bodies: &[PlacedCompound; 2], pieces: [u32; 2], work: impl FnOnce([Placed; 2]) -> T) -> T {
    let (mut own1, mut own2) = (Pose::IDENTITY, Pose::IDENTITY);
    work([bodies[0].piece(pieces[0], &mut own1), bodies[1].piece(pieces[1], &mut own2)])
}

impl<'a> PlacedCompound<'a> {
    /// A piece where it is; its pose is made in `room`, unless it is that of the compound.
    #[inline(always)]
    pub(super) fn piece<'b>(&self, piece: u32, room: &'b mut Pose) -> Placed<'b>
    where
        'a: 'b,
    {
        let part = &self.compound.pieces()[piece as usize];
        if self.compound.has_placed_pieces() && part.pose != Pose::IDENTITY {
            *room = self.pose.after(&part.pose);
            part.shape.at(room)
        } else {
            part.shape.at(self.pose)
        }
    }
}
