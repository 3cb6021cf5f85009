//! The independent check of a verdict or a distance of two compounds: of the pieces that are named by the pair layer's own check,
//! of all others that they are as far apart as is said. The walk over the tree is made anew; that boxes contain their pieces is
//! taken from the making of the compounds.

use super::PlacedCompound;
use super::answer::CompoundAnswer;
use super::between::{Between, Reaches};
use super::placed::with_pieces;
use super::walk::{Aim, PiecePair, walk};
use crate::base::error::{Error, Result};
use crate::base::simd::environment::with_default;
use crate::pair::{self, Outcome, PairAnswer, PairCache, PairConfig, Placed};
use crate::verify::{prove_apart, verify as verify_pair};

/// Re-checks an answer of [`distance`](super::distance) or [`intersection`](super::intersection) for the same compounds and poses.
///
/// An intersection is proved by the two pieces that are named. Otherwise `lower` is proved of each two pieces whose boxes are not
/// farther apart, and what else is said of the two that are named, if any are. Checks and allowances are those of
/// [`verify_pair`].
///
/// # Errors
/// As of [`verify_pair`]; [`Error::Argument`] for numbers of pieces that the compounds do not have.
pub fn verify(bodies: [PlacedCompound; 2], found: &CompoundAnswer) -> Result<()> {
    with_default(|| {
        let bodies = bodies.map(|body| body.placed_pieces());
        let between = Between::new(&bodies, &Reaches::new(&bodies)?);
        let pieces = [found.piece1, found.piece2];
        let counts = bodies.map(|body| body.count() as u32);
        let answer = &found.answer;
        if pieces == counts && answer.outcome != Outcome::Intersecting {
            check_unnamed(answer)?;
        } else if pieces[0] < counts[0] && pieces[1] < counts[1] {
            with_pieces(&bodies, pieces, |placed| verify_pair(placed, answer)).map_err(|error| about(error, pieces))?;
        } else {
            let [one, two] = pieces;
            let message = format!("pieces {one} and {two} of compounds that have {} and {}", counts[0], counts[1]);
            return Err(Error::Argument(message));
        }
        if answer.outcome == Outcome::Intersecting {
            return Ok(());
        }
        let trees = bodies.map(|body| body.tree);
        walk(PiecePair { trees, between: &between, aim: Aim::Distance }, answer.lower, |pieces| {
            with_pieces(&bodies, pieces, |placed| check_apart(placed, answer.lower))
                .map_err(|error| about(error, pieces))?;
            Ok(Some(answer.lower))
        })?;
        Ok(())
    })
}

pub(super) fn about(error: Error, [one, two]: [u32; 2]) -> Error {
    error.about(&format!("pieces {one} and {two}"))
}

/// An answer that names no pieces says nothing of them.
fn check_unnamed(answer: &PairAnswer) -> Result<()> {
    let PairAnswer { outcome, distance, lower, upper, local1, local2, world1, world2, normal, .. } = *answer;
    let is_known = matches!(outcome, Outcome::Separated | Outcome::Beyond);
    if !(is_known && lower >= 0.0 && distance == lower && upper == f64::INFINITY) {
        return Err(Error::Unverified(format!(
            "of no pieces, not apart with 0 ≤ lower = distance, upper = ∞: {outcome:?}, {lower:e}, {distance:e}, {upper:e}"
        )));
    }
    if [local1, local2, world1, world2, normal].as_flattened().iter().all(|x| x.is_nan()) && answer.proof_count == 0 {
        return Ok(());
    }
    Err(Error::Unverified("points, a normal or a proof of an answer that names no pieces".into()))
}

/// Proves that two pieces are disjoint, and at least so far apart. The direction is a query's; the proof trusts nothing of it.
pub(super) fn check_apart(placed: [Placed; 2], lower: f64) -> Result<()> {
    let mut found = PairAnswer::default();
    pair::distance(placed, &mut PairCache::default(), &PairConfig::default(), &mut found)?;
    if found.outcome == Outcome::Intersecting {
        return Err(Error::Unverified("they intersect".into()));
    }
    prove_apart(placed, found.normal, lower)
}
