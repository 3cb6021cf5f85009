//! The independent check of a depth of two compounds: of the named pieces by the pair layer's own check, of all others that none is
//! deeper, and of the translation that it frees. Walks over the trees are made anew; that boxes contain their pieces is taken from
//! the making of the compounds.

use super::PlacedCompound;
use super::answer::{CompoundAnswer, CompoundDepth, CompoundSignedDistance};
use super::between::{Between, Reaches};
use super::depth::{freeing_length, placing_error, translated};
use super::placed::with_pieces;
use super::verify::{about, check_apart, verify};
use super::walk::{Aim, PiecePair, walk};
use crate::base::error::{Error, Result};
use crate::base::simd::environment::with_default;
use crate::depth::{DepthAnswer, DepthCache, DepthEnding};
use crate::pair::{self, Outcome, PairAnswer, PairConfig, Placed, SignedDistance, SignedDistanceCache};
use crate::verify::verify_depth as verify_pair;

/// Re-checks an answer of [`depth`](super::depth) for the same compounds and poses.
///
/// | member | what is proved |
/// |---|---|
/// | `deepest` | of the named pieces as [`verify_pair`] does, or [`verify`](super::verify) of compounds apart; no two are deeper |
/// | `lower` | the named pieces are that deep |
/// | `translation` | added to the pose of compound 1 it leaves each two pieces apart or touching |
/// | `upper` | the translation is no longer |
///
/// # Errors
/// As of [`verify`](super::verify) and [`verify_pair`].
pub fn verify_depth(bodies: [PlacedCompound; 2], found: &CompoundDepth) -> Result<()> {
    with_default(|| {
        let CompoundDepth { deepest, lower, upper, translation } = found;
        let signed = &deepest.distance;
        if signed.outcome != Outcome::Intersecting {
            verify(bodies, &as_distance(deepest))?;
        } else {
            check_deepest(&bodies, deepest)?;
        }
        if signed.outcome != Outcome::Intersecting || signed.lower == 0.0 {
            let are_all_zero = *lower == 0.0 && *upper == 0.0 && *translation == [0.0; 3];
            return if are_all_zero { Ok(()) } else { Err(unverified("a depth of compounds that do not overlap")) };
        }
        let most = (-signed.upper - placing_error(&bodies[0], *upper)).max(0.0);
        if !(0.0 <= *lower && *lower <= most && *lower <= *upper && *upper > 0.0) {
            return Err(unverified(&format!(
                "not 0 ≤ lower ≤ {most:e}, lower ≤ upper, 0 < upper: {lower:e}, {upper:e}"
            )));
        }
        if *upper == f64::INFINITY && translation.iter().all(|x| x.is_nan()) {
            return Ok(());
        }
        // False for a NaN.
        let length = freeing_length(&bodies[0], translation);
        if !(length <= *upper && translation.iter().all(|x| x.is_finite())) {
            return Err(unverified(&format!("the translation {translation:?} is longer than {upper:e}")));
        }
        let pose = translated(&bodies[0], translation);
        check_pairs(&[bodies[0].compound.at(&pose), bodies[1]], 0.0, None)
    })
}

fn unverified(message: &str) -> Error {
    Error::Unverified(message.into())
}

/// That no two pieces but those named have a signed distance below `least`, which is 0 or less.
fn check_pairs(bodies: &[PlacedCompound; 2], least: f64, named: Option<[u32; 2]>) -> Result<()> {
    debug_assert!(least <= 0.0);
    let bodies = bodies.map(|body| body.placed_pieces());
    let between = Between::new(&bodies, &Reaches::new(&bodies)?);
    let trees = bodies.map(|body| body.tree);
    walk(PiecePair { trees, between: &between, aim: Aim::Distance }, least, |pieces| {
        if named != Some(pieces) {
            with_pieces(&bodies, pieces, |placed| check_pair(placed, least)).map_err(|error| about(error, pieces))?;
        }
        Ok(Some(least))
    })?;
    Ok(())
}

fn check_pair(placed: [Placed; 2], least: f64) -> Result<()> {
    let mut found = SignedDistance::default();
    pair::signed_distance(placed, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut found)?;
    if found.outcome != Outcome::Intersecting {
        return check_apart(placed, 0.0);
    }
    // What overlaps less than rounding shows is said to overlap, and touching by 0.
    if !(found.lower >= least) {
        return Err(unverified(&format!("they overlap by up to {:e}, not at most {:e}", -found.lower, -least)));
    }
    verify_pair(placed, &DepthCache::default(), &as_depth(&found))
}

fn check_deepest(bodies: &[PlacedCompound; 2], deepest: &CompoundSignedDistance) -> Result<()> {
    let (pieces, counts) = ([deepest.piece1, deepest.piece2], bodies.map(|body| body.compound.piece_count() as u32));
    if !(pieces[0] < counts[0] && pieces[1] < counts[1]) {
        let [one, two] = pieces;
        let message = format!("pieces {one} and {two} of compounds that have {} and {}", counts[0], counts[1]);
        return Err(Error::Argument(message));
    }
    let depth = as_depth(&deepest.distance);
    with_pieces(&bodies.map(|body| body.placed_pieces()), pieces, |placed| {
        verify_pair(placed, &DepthCache::default(), &depth)
    })
    .map_err(|error| about(error, pieces))?;
    check_pairs(bodies, deepest.distance.lower, Some(pieces))
}

fn as_depth(found: &SignedDistance) -> DepthAnswer {
    let &SignedDistance { outcome, distance, lower, upper, local1, local2, world1, world2, normal, .. } = found;
    let &SignedDistance { feature1, feature2, .. } = found;
    let (depth, lower, upper) = (-distance, -upper, -lower);
    let said = DepthAnswer { outcome, depth, lower, upper, local1, local2, ..DepthAnswer::default() };
    DepthAnswer { world1, world2, normal, feature1, feature2, ending: DepthEnding::Narrow, ..said }
}

fn as_distance(found: &CompoundSignedDistance) -> CompoundAnswer {
    let CompoundSignedDistance { distance, piece1, piece2 } = *found;
    let SignedDistance { outcome, distance, lower, upper, local1, local2, world1, world2, normal, .. } = distance;
    let SignedDistance { feature1, feature2, .. } = found.distance;
    let said = PairAnswer { outcome, distance, lower, upper, local1, local2, ..PairAnswer::UNSAID };
    CompoundAnswer { answer: PairAnswer { world1, world2, normal, feature1, feature2, ..said }, piece1, piece2 }
}
