//! The independent check of an answer, which trusts nothing of the solver that made it: bounds of the distance over all vertices,
//! the witness points on their features, an intersection's proof in integers, and likewise anything that rounding hides of a
//! distance.

mod checks;
mod numbers;
mod bounds;
mod facets;
mod polygon;
mod witness;
mod apart;
mod depth;
mod manifold;

use crate::answer::{DecidedBy, Outcome, PairAnswer, Radii};
use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector, length};
use crate::base::memory::listed;
use crate::placed::Pair;
use crate::placed::exact::{self, VertexPair};
use crate::shape::Placed;
pub(crate) use apart::prove_apart;
use apart::{check_points, not_in_interval, verify_disjoint};
pub(crate) use bounds::Bounds;
#[doc(hidden)]
pub use bounds::{ERROR, over_both, plus_difference, turned};
pub(crate) use checks::in_default;
use checks::{allowed, between_origins, check_unit, proof_of, too_large, unverified};
pub(crate) use depth::holds_ball;
pub use depth::{CLEAR, verify_depth};
pub use manifold::verify_manifold;
use numbers::{are_points_said, check_numbers};
use witness::{Witness, difference_of};

/// Re-checks an answer of [`crate::pair`] for the same shapes and poses.
///
/// The verdict and the interval are proved for the exact objects R·v + T, with no tolerance; of shapes with a swept radius for
/// those with the ball around each point, of curved ones for all bodies that hold the polyhedron and reach no farther from it than
/// the deviation:
///
/// | outcome | what is proved, d the true distance |
/// |---|---|
/// | [`Outcome::Separated`] | d > 0; `lower` ≤ d ≤ `upper`; `lower` > 0, or d is below the smallest double |
/// | [`Outcome::Beyond`] | d > 0; `lower` ≤ d |
/// | [`Outcome::Intersecting`] | the differences of the proof's vertex pairs hold the origin in their hull |
/// | [`Outcome::Undecided`] | d ≤ `upper`; `lower` is 0; of curved objects, unless by [`DecidedBy::Budget`], also what is checked of disjoint objects |
///
/// `lower` ≤ `distance` ≤ `upper` holds for every outcome. `upper` is +∞ and `distance` is `lower` for [`Outcome::Beyond`]; all
/// three are 0 for [`Outcome::Intersecting`].
///
/// Every number that is set is finite, except an `upper` of +∞: of [`Outcome::Beyond`], of [`Outcome::Undecided`], of separated
/// objects with no points reported, and of objects farther apart than the largest double.
///
/// The other members are rounded, so they hold up to an allowance a = 64u·(ρ₁ + ρ₂ + |Δ| + |c₁| + |c₂| + r₁ + r₂). There ρ is a
/// body's radius about its centre c, Δ joins the centres in the world, and r is the swept radius.
///
/// | member | what is checked |
/// |---|---|
/// | `normal` | a unit vector up to 8u; disjoint objects are at least `lower` − a apart along it |
/// | `local1`, `local2` | the point is at most a out of its object |
/// | `world1`, `world2` | R·local + T up to 64u·(ρ + \|c\| + \|T\|) |
/// | both points | `lower` − a ≤ their distance ≤ `upper` + a; of a contact their distance is at most a |
/// | `feature1`, `feature2` | the object has it; of a separated answer the point is on it up to a + 64uρ + `upper` − `lower` |
/// | a polygon that shares a face | none of the others that do is nearer to the point by more than that |
///
/// Points and features are reported together, or not at all. Outcomes without points, normal or proof may not have them.
/// `decided_by` and the statistics describe the search, and are not checked. For a contact's normal only its length is checked.
/// [`DecidedBy::InscribedSpheres`] and swept radii excuse an intersection from a proof: integers decide it anew. Points on a
/// swept body are moved back by its radius along the normal, and checked on the polyhedron. All lengths are of the world, where
/// the ball is round.
///
/// It takes time in proportion to the vertices: bounds in double-double arithmetic mostly prove the interval, else integers do.
///
/// # Errors
/// [`Error::Unverified`] with what does not hold; [`Error::Pose`] for a pose that no query accepts; [`Error::Argument`] for an
/// answer that holds no outcome or vertex indices that the shapes do not have, and for a normal or points of objects so large or
/// far apart that doubles cannot tell.
pub fn verify(bodies: [Placed; 2], answer: &PairAnswer) -> Result<()> {
    in_default(|| check_answer(bodies, answer))
}

fn check_answer(bodies: [Placed; 2], answer: &PairAnswer) -> Result<()> {
    let pair = &Pair::of(&bodies);
    let radii = Radii::of(&bodies).unwrap_or(Radii::NONE);
    for pose in pair.poses {
        pose.check()?;
    }
    if answer.outcome != Outcome::None {
        check_numbers(&answer.into())?;
    }
    if answer.outcome != Outcome::Intersecting && answer.proof_count != 0 {
        return Err(unverified("a proof of intersection of objects that are not said to intersect".into()));
    }
    match answer.outcome {
        Outcome::None => Err(Error::Argument("the answer holds no outcome".into())),
        Outcome::Separated => verify_separated(pair, &radii, answer),
        Outcome::Beyond => verify_beyond(pair, &radii, answer),
        Outcome::Intersecting => verify_intersecting(pair, &radii, answer),
        Outcome::Undecided => verify_undecided(pair, &radii, answer),
    }
}

fn verify_separated(pair: &Pair, radii: &Radii, answer: &PairAnswer) -> Result<()> {
    let PairAnswer { lower, upper, distance, .. } = *answer;
    // A distance below the smallest double leaves `lower` at 0. Without an upper end is a distance above the largest, less what
    // curved bodies deviate and the radii round, and one of which only a separating direction is known: that has no points.
    let is_above_all = lower + 2.0 * radii.deviation >= f64::MAX * (1.0 - 8.0 * U);
    let has_end = upper < f64::INFINITY || is_above_all || !are_points_said(&answer.into());
    if !(lower >= 0.0 && upper > 0.0 && lower <= distance && distance <= upper && has_end) {
        return Err(unverified(format!(
            "not 0 ≤ lower ≤ distance ≤ upper < ∞, 0 < upper: {lower:e}, {distance:e}, {upper:e}"
        )));
    }
    let allowed = verify_disjoint(pair, radii, answer)?;
    if !are_points_said(&answer.into()) {
        return Ok(());
    }
    check_points(pair, radii, allowed, answer)
}

fn verify_beyond(pair: &Pair, radii: &Radii, answer: &PairAnswer) -> Result<()> {
    let PairAnswer { lower, upper, distance, .. } = *answer;
    if !(lower >= 0.0 && distance == lower && upper == f64::INFINITY) {
        return Err(unverified(format!("not 0 ≤ lower = distance, upper = ∞: {lower:e}, {distance:e}, {upper:e}")));
    }
    check_no_points(answer)?;
    verify_disjoint(pair, radii, answer).map(|_| ())
}

/// An interval proves no more than that the objects are not farther apart.
fn verify_undecided(pair: &Pair, radii: &Radii, answer: &PairAnswer) -> Result<()> {
    let PairAnswer { lower, upper, distance, .. } = *answer;
    if !(lower == 0.0 && 0.0 <= distance && distance <= upper) {
        return Err(unverified(format!("not 0 = lower ≤ distance ≤ upper: {lower:e}, {distance:e}, {upper:e}")));
    }
    if radii.deviation > 0.0 && answer.decided_by != DecidedBy::Budget {
        return verify_hidden(pair, radii, answer);
    }
    check_no_points(answer)?;
    check_no_normal(answer)?;
    if upper == f64::INFINITY {
        return Ok(());
    }
    let truth = exact::distance(pair, &[]);
    let [radius1, radius2] = radii.each;
    if truth.compare_sum(&[upper, radius1, radius2]).is_gt() {
        Err(not_in_interval(&truth, radii, answer))
    } else {
        Ok(())
    }
}

/// The polyhedra are apart: the bodies are no deeper in each other than all that is swept and their deviations.
fn verify_hidden(pair: &Pair, radii: &Radii, answer: &PairAnswer) -> Result<()> {
    let allowed = verify_disjoint(pair, radii, &PairAnswer { lower: -radii.upper, ..*answer })?;
    if !are_points_said(&answer.into()) {
        return Ok(());
    }
    check_points(pair, radii, allowed, answer)
}

fn check_no_points(answer: &PairAnswer) -> Result<()> {
    if are_points_said(&answer.into()) {
        return Err(unverified(format!("points or features of an answer that is {:?}", answer.outcome)));
    }
    Ok(())
}

fn check_no_normal(answer: &PairAnswer) -> Result<()> {
    if answer.normal.iter().all(|x| x.is_nan()) {
        return Ok(());
    }
    Err(unverified(format!("a normal of an answer that says no points: {:?}", answer.normal)))
}

fn verify_intersecting(pair: &Pair, radii: &Radii, answer: &PairAnswer) -> Result<()> {
    let polyhedra = pair.polyhedra;
    if answer.proof_count == 0 && (answer.decided_by == DecidedBy::InscribedSpheres || radii.upper > 0.0) {
        return verify_without_proof(pair, radii, answer);
    }
    if (answer.lower, answer.upper, answer.distance) != (0.0, 0.0, 0.0) {
        return Err(unverified("an intersection with a distance that is not 0".into()));
    }
    let pairs = proof_of(polyhedra, answer)?;
    if !exact::encloses_origin(pair, &pairs) {
        return Err(unverified("the proof's vertex differences do not hold the origin in their hull".into()));
    }
    if !are_points_said(&answer.into()) {
        return check_no_normal(answer);
    }
    // The point is a convex combination of the proof's vertices.
    check_common_point(pair, &Radii::NONE, answer, &pairs)
}

/// Overlapping balls, and swept radii, leave no vertex pairs as a proof: integers decide anew.
fn verify_without_proof(pair: &Pair, radii: &Radii, answer: &PairAnswer) -> Result<()> {
    if (answer.lower, answer.upper, answer.distance) != (0.0, 0.0, 0.0) {
        return Err(unverified("an intersection with a distance that is not 0".into()));
    }
    let truth = exact::distance(pair, &[]);
    if truth.compare_sum(&radii.each).is_gt() {
        return Err(not_in_interval(&truth, radii, answer));
    }
    if are_points_said(&answer.into()) && radii.upper > 0.0 {
        return check_common_point(pair, radii, answer, &[]);
    }
    check_no_points(answer)?;
    check_no_normal(answer)
}

/// One point, which is no farther from either polyhedron than its radius; `proof` has vertices around it.
fn check_common_point(pair: &Pair, radii: &Radii, answer: &PairAnswer, proof: &[VertexPair]) -> Result<()> {
    let allowed = allowed(pair.polyhedra, &between_origins(pair), radii.each).ok_or_else(too_large)?;
    check_unit(&answer.normal.into())?;
    let witnesses = Witness::of_both(pair, radii, &Vector::zeros(), answer);
    for (i, witness) in witnesses.iter().enumerate() {
        let around = listed(proof.iter().map(|pair| pair[i]));
        witness.check_swept_point(allowed, &around)?;
        witness.check_feature()?;
    }
    let apart = length(&difference_of(pair, &witnesses));
    if apart <= allowed {
        return Ok(());
    }
    Err(unverified(format!("the witness points of a contact are {apart:e} apart")))
}
