//! The signed distance of two compounds: the least over all pairs of pieces.

use super::PlacedCompound;
use super::answer::CompoundSignedDistance;
use super::between::{Between, Reaches};
use super::cache::{CompoundCache, PieceCaches};
use super::placed::{PlacedPieces, with_pieces};
use super::queries::MORE;
use super::walk::{Aim, PiecePair, walk};
use crate::base::error::Result;
use crate::base::simd::environment::with_default;
use crate::pair::{self, Outcome, PairAnswer, PairConfig, Placed, Query, SignedDistance, SignedDistanceCache};

/// The least signed distance of any two pieces: how far the compounds are apart, or minus how deep the deepest two pieces are in
/// each other.
///
/// Of compounds that are apart it is their distance. Of compounds that intersect it is not their own depth, which is the least
/// translation that parts them: that is at least as long as the interval's depth, and longer where to free one pair pushes others
/// into each other.
///
/// Normal, points and features are those of the two pieces. Depths are searched cold.
///
/// # Errors
/// As of [`distance`](super::distance).
pub fn signed_distance(
    bodies: [PlacedCompound; 2],
    cache: &mut CompoundCache,
    config: &PairConfig,
    answer: &mut CompoundSignedDistance,
) -> Result<()> {
    with_default(|| {
        config.check(Query::Distance)?;
        let bodies = bodies.map(|body| body.placed_pieces());
        let between = Between::new(&bodies, &Reaches::new(&bodies)?);
        let least = LeastSigned {
            bodies: &bodies,
            cache,
            config: *config,
            tolerance: config.max_distance,
            enough: config.max_distance,
            lower: f64::INFINITY,
            named: None,
        };
        *answer = least.run(&between)?;
        Ok(())
    })
}

/// The least of the pairs of pieces that have been asked.
struct LeastSigned<'a> {
    bodies: &'a [PlacedPieces<'a>; 2],
    cache: &'a mut CompoundCache,
    config: PairConfig,
    tolerance: f64,
    /// Anything farther apart no longer counts; negative where pieces that are as deep are known.
    enough: f64,
    lower: f64,
    named: Option<([u32; 2], SignedDistance)>,
}

impl LeastSigned<'_> {
    fn run(mut self, between: &Between) -> Result<CompoundSignedDistance> {
        let counts = self.bodies.map(|body| body.count());
        let last = self.cache.last().nearest(counts);
        if let Some(pieces) = last {
            self.learn(pieces)?;
        }
        let trees = self.bodies.map(|body| body.tree);
        let passed = walk(PiecePair { trees, between, aim: Aim::Distance }, self.enough, |pieces| {
            if last != Some(pieces) {
                self.learn(pieces)?;
            }
            Ok(Some(self.enough))
        })?;
        let lower = self.lower.min(passed);
        let Some((pieces, found)) = self.named else {
            let distance = SignedDistance {
                outcome: Outcome::Beyond,
                distance: lower,
                lower,
                upper: f64::INFINITY,
                ..SignedDistance::default()
            };
            let [piece1, piece2] = counts.map(|count| count as u32);
            return Ok(CompoundSignedDistance { distance, piece1, piece2 });
        };
        self.cache.last().remember_nearest(Some(pieces));
        let distance = SignedDistance { lower, ..found };
        Ok(CompoundSignedDistance { distance, piece1: pieces[0], piece2: pieces[1] })
    }

    fn learn(&mut self, pieces: [u32; 2]) -> Result<()> {
        self.config.max_distance = (self.enough * MORE).clamp(0.0, self.tolerance);
        let (cache, config) = (self.cache.of(pieces), &self.config);
        let found = with_pieces(self.bodies, pieces, |placed| ask_pair(placed, cache, config))?;
        self.lower = self.lower.min(found.lower);
        // Of pairs that rounding lets touch at most, one that may overlap goes before one that does not.
        let is_less = |least: &SignedDistance| (found.upper, found.lower) < (least.upper, least.lower);
        let is_least = self.named.is_none_or(|(_, least)| is_less(&least));
        if found.outcome != Outcome::Beyond && is_least {
            self.enough = self.enough.min(found.upper);
            self.named = Some((pieces, found));
        }
        Ok(())
    }
}

fn ask_pair(placed: [Placed; 2], cache: &mut pair::PairCache, config: &PairConfig) -> Result<SignedDistance> {
    let mut apart = PairAnswer::default();
    pair::distance(placed, cache, config, &mut apart)?;
    if apart.outcome != Outcome::Intersecting {
        return Ok(SignedDistance::from(&apart));
    }
    let mut deep = SignedDistance::default();
    pair::signed_distance(placed, &mut SignedDistanceCache::default(), config, &mut deep)?;
    Ok(deep)
}
