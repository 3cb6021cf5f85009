//! The checks of polyhedra that are apart: the interval, less the swept radii of the bodies, the normal and the points.

use super::bounds::{Bounds, PointInside};
use super::checks::{allowed, between_origins, check_normal, check_unit, in_default, too_large, unverified};
use super::witness::{Witness, difference_of};
use crate::answer::{Outcome, PairAnswer, Radii, sum_above, sum_below};
use crate::base::error::{Error, Result};
use crate::base::math::{Vector, length};
use crate::base::memory::listed;
use crate::placed::Pair;
use crate::placed::exact::{self, VertexPair};
use crate::shape::Placed;

/// Proves verdict and interval, and checks the normal; returns the rounding allowance for a length.
pub(super) fn verify_disjoint(pair: &Pair, radii: &Radii, answer: &PairAnswer) -> Result<f64> {
    let normal = Vector::from(answer.normal);
    check_unit(&normal)?;
    let proof = prove_interval(pair, radii, answer);
    if !(proof.lower && proof.upper) {
        prove_interval_exactly(pair, radii, answer, &proof.near)?;
    }
    let between = between_origins(pair);
    let allowed = allowed(pair.polyhedra, &between, radii.each).ok_or_else(too_large)?;
    if !proof.lower {
        check_normal(pair, &normal, &between, answer.lower + radii.lower - allowed)?;
    }
    Ok(allowed)
}

/// Proves that bodies are apart, by at least `lower`. The direction is a hint, of about unit length: where it proves nothing,
/// integers do.
///
/// # Errors
/// [`Error::Unverified`] where they are not, [`Error::Memory`].
pub(crate) fn prove_apart(bodies: [Placed; 2], direction: [f64; 3], lower: f64) -> Result<()> {
    let outcome = Outcome::Beyond;
    let apart =
        PairAnswer { outcome, distance: lower, lower, upper: f64::INFINITY, normal: direction, ..PairAnswer::UNSAID };
    in_default(|| {
        let (pair, radii) = (Pair::of(&bodies), Radii::of(&bodies).unwrap_or(Radii::NONE));
        let proof = prove_interval(&pair, &radii, &apart);
        if proof.lower { Ok(()) } else { prove_interval_exactly(&pair, &radii, &apart, &proof.near) }
    })
}

/// The proved part of an interval, and vertex pairs near where the objects are nearest.
struct ApartProof {
    lower: bool,
    upper: bool,
    near: Vec<VertexPair>,
}

/// The interval of a disjoint pair that double-double arithmetic proves. The lower bound is the gap along the normal. The upper
/// bound comes from the witness points if they are reported, else from the vertices that face each other.
fn prove_interval(pair: &Pair, radii: &Radii, answer: &PairAnswer) -> ApartProof {
    let most = sum_below(answer.upper, radii.lower);
    let nothing = ApartProof { lower: false, upper: answer.upper == f64::INFINITY, near: Vec::new() };
    let Some(bounds) = Bounds::new(pair) else { return nothing };
    let normal = Vector::from(answer.normal);
    let gap = bounds.gap(&normal);
    let witnesses = Witness::of_both(pair, radii, &normal, answer);
    let points = [0, 1].map(|i| witnesses[i].point_inside().unwrap_or(PointInside::vertex(gap.vertices[i])));
    let mut near: Vec<VertexPair> = listed(points[0].vertices.iter().flat_map(|&v| points[1].vertices.map(|w| [v, w])));
    near.sort_unstable();
    near.dedup();
    ApartProof {
        // A gap of 0 separates nothing.
        lower: answer.lower != 0.0 && bounds.prove_lower(&gap, &normal, sum_above(answer.lower, radii.upper)),
        upper: nothing.upper || (most >= 0.0 && bounds.prove_upper(&points, most)),
        near,
    }
}

/// Proves the interval of a disjoint pair in integers, or refutes it.
fn prove_interval_exactly(pair: &Pair, radii: &Radii, answer: &PairAnswer, near: &[VertexPair]) -> Result<()> {
    let truth = exact::distance(pair, near);
    let ([least1, least2], [most1, most2, deviation]) = (radii.each, radii.most());
    let against = |length: f64| truth.compare_sum(&[length, most1, most2, deviation]);
    // Not 0, even where it is less than the least double.
    let says_apart = !matches!(answer.outcome, Outcome::Intersecting | Outcome::Undecided);
    let is_verdict_right = !says_apart || against(0.0).is_gt();
    let is_near_enough = truth.compare_sum(&[answer.upper, least1, least2]).is_le();
    if !(is_verdict_right && against(answer.lower).is_ge() && is_near_enough) {
        return Err(not_in_interval(&truth, radii, answer));
    }
    let least = f64::from_bits(1);
    if answer.outcome == Outcome::Separated && answer.lower == 0.0 && against(least).is_ge() {
        return Err(unverified(format!("a lower end of 0, though the objects are at least {least:e} apart")));
    }
    Ok(())
}

pub(super) fn not_in_interval(truth: &exact::ExactDistance, radii: &Radii, answer: &PairAnswer) -> Error {
    let PairAnswer { lower: said_lower, upper: said_upper, .. } = answer;
    let [lower, upper] = radii.off(truth.bounds().into());
    unverified(match truth.is_zero() {
        true => format!("the objects intersect, they are not [{said_lower:e}, {said_upper:e}] apart"),
        false => format!("their distance is in [{lower:e}, {upper:e}], not in [{said_lower:e}, {said_upper:e}]"),
    })
}

/// The points are on their features, and as far apart as the interval requires.
pub(super) fn check_points(pair: &Pair, radii: &Radii, allowed: f64, answer: &PairAnswer) -> Result<()> {
    let PairAnswer { lower, upper, .. } = *answer;
    let apart = length(&check_on_features(pair, radii, allowed, answer)?);
    if apart >= lower + radii.lower - allowed && apart <= upper + radii.upper + allowed {
        return Ok(());
    }
    Err(unverified(format!("the witness points are {apart:e} apart, not in [{lower:e}, {upper:e}] and the radii")))
}

/// The points are on their features; from that of the second polyhedron to that of the first, in the world.
pub(super) fn check_on_features(pair: &Pair, radii: &Radii, allowed: f64, answer: &PairAnswer) -> Result<Vector> {
    let witnesses = Witness::of_both(pair, radii, &answer.normal.into(), answer);
    for witness in &witnesses {
        witness.check_point(allowed)?;
        witness.check_feature()?;
        // A point is on the surface as far as the interval tells that it is nearest.
        witness.check_on_feature(allowed + (answer.upper - answer.lower))?;
    }
    Ok(difference_of(pair, &witnesses))
}
