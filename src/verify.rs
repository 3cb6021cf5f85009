//! The independent check of an answer, trusting nothing of the solver that made it: supports by brute force over all vertices, the
//! witness points against all faces, an intersection's proof in integers, and so a gap that rounding hides.

mod witness;

use crate::answer::{FeatureKind, Outcome, PairAnswer};
use crate::error::{Error, Result};
use crate::exact;
use crate::math::{Pose, ROTATION_LIMIT, UNIT_ROUNDOFF as U, Vector};
use crate::polyhedron::Polyhedron;
use crate::shape::Shape;
use crate::simd::environment::with_default;
use witness::Witness;

/// Re-checks an answer of [`crate::pair`] for the same shapes and poses.
///
/// Separated: along the normal the bodies are at least `lower` apart, by supports over all vertices. Intersecting: the proof's
/// vertex differences hold the origin in their hull, exactly. Where witness points are said they lie in both bodies, world and
/// local ones are the same, and their features are those of the bodies. Those of a separated answer lie on their features, at a
/// distance in [`lower`, `upper`]; those of a contact are one point. All but the proof is checked in double precision, which
/// can see a miss of more than about 64u·(ρ₁ + ρ₂ + |Δ|), Δ the distance of the bodies' origins. Where that hides whether there
/// is a gap at all, verdict and interval are held against the exact tier, asked afresh. Otherwise it takes time in proportion
/// to the vertices.
///
/// # Errors
/// [`Error::Unverified`] with what does not hold; [`Error::Pose`] for a pose that no query accepts; [`Error::Argument`] for an
/// answer that holds no outcome or vertex indices that the shapes do not have, and for separated objects so large or far apart that
/// doubles cannot tell.
pub fn verify(shape1: &Shape, pose1: &Pose, shape2: &Shape, pose2: &Pose, answer: &PairAnswer) -> Result<()> {
    with_default(|| check_answer(shape1, pose1, shape2, pose2, answer))
}

fn check_answer(shape1: &Shape, pose1: &Pose, shape2: &Shape, pose2: &Pose, answer: &PairAnswer) -> Result<()> {
    let polyhedra = [shape1.polyhedron(), shape2.polyhedron()];
    let poses = [pose1, pose2];
    for pose in poses {
        pose.check(ROTATION_LIMIT)?;
    }
    match answer.outcome {
        Outcome::None => Err(Error::Argument("the answer holds no outcome".into())),
        Outcome::Undecided => Err(Error::Argument("the answer holds no verdict".into())),
        Outcome::Separated | Outcome::Beyond => verify_separated(polyhedra, poses, answer),
        Outcome::Intersecting => verify_intersecting(polyhedra, poses, answer),
    }
}

fn verify_separated(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], answer: &PairAnswer) -> Result<()> {
    let PairAnswer { lower, upper, distance, .. } = *answer;
    // A distance below the smallest double leaves `lower` at 0.
    if !(lower >= 0.0 && upper > 0.0 && lower <= distance && distance <= upper) {
        return Err(unverified(format!(
            "not 0 ≤ lower ≤ distance ≤ upper, 0 < upper: {lower:e}, {distance:e}, {upper:e}"
        )));
    }
    let normal = Vector::from(answer.normal);
    check_unit(&normal)?;
    let between = between_origins(polyhedra, poses);
    let Some(allowed) = allowed(polyhedra, &between) else {
        return Err(Error::Argument("the objects are too large or too far apart to be checked in doubles".into()));
    };
    let reach = |i: usize, direction: Vector| {
        let local = poses[i].rotate_back(&direction);
        polyhedra[i].vertices.iter().map(|v| local.dot(&v.position)).fold(f64::NEG_INFINITY, f64::max)
    };
    let gap = normal.dot(&between) - reach(0, -normal) - reach(1, normal);
    if !(gap >= lower - allowed) {
        return Err(unverified(format!("along the normal the bodies are {gap:e} apart, not {lower:e}")));
    }
    // All that can be said of an upper end without witness points.
    if !(gap <= upper + allowed) {
        return Err(unverified(format!("along the normal the bodies are {gap:e} apart, more than {upper:e}")));
    }
    if !(gap > allowed) {
        let truth = exact::solve(polyhedra[0], poses[0], polyhedra[1], poses[1], &[]);
        if truth.intersecting || lower > truth.upper || upper < truth.lower {
            let exact::ExactAnswer { lower, upper, .. } = truth;
            return Err(unverified(format!("their distance is in [{lower:e}, {upper:e}]")));
        }
    }
    if answer.proof_count != 0 {
        return Err(unverified("a proof of intersection of objects that are separated".into()));
    }
    let witnesses = witnesses(polyhedra, poses, answer);
    if !are_said(&witnesses) {
        return Ok(());
    }
    for witness in &witnesses {
        witness.check_point(allowed)?;
        // A point is on the surface as far as the interval tells that it is nearest.
        witness.check_on_feature(allowed + (upper - lower))?;
    }
    let [first, second] = [0, 1].map(|i| poses[i].rotate(&witnesses[i].centred()));
    let apart = length(&(between + first - second));
    if !(apart >= lower - allowed && apart <= upper + allowed) {
        return Err(unverified(format!("the witness points are {apart:e} apart, not in [{lower:e}, {upper:e}]")));
    }
    Ok(())
}

/// From the centred origin of object 2 to that of object 1. Translations first, so that bodies far out lose no digits.
fn between_origins(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> Vector {
    (poses[0].translation() - poses[1].translation())
        + (poses[0].rotate(&polyhedra[0].centre) - poses[1].rotate(&polyhedra[1].centre))
}

/// What rounding may make of a length as it is checked here; `None` where sums of eight such lengths may overflow.
fn allowed(polyhedra: [&Polyhedron; 2], between: &Vector) -> Option<f64> {
    let centres = length(&polyhedra[0].centre) + length(&polyhedra[1].centre);
    let all = polyhedra[0].radius + polyhedra[1].radius + length(between) + centres;
    // Some hundred operations, each with at most half the least double where its result is subnormal.
    let underflow = 128.0 * f64::from_bits(1);
    (all <= f64::MAX / 8.0).then_some(64.0 * U * all + underflow)
}

fn check_unit(normal: &Vector) -> Result<()> {
    if (normal.norm_squared() - 1.0).abs() <= 16.0 * U {
        return Ok(());
    }
    Err(unverified(format!("the normal is not a unit vector: {normal:?}")))
}

/// What the answer says of each object.
fn witnesses<'a>(polyhedra: [&'a Polyhedron; 2], poses: [&'a Pose; 2], answer: &PairAnswer) -> [Witness<'a>; 2] {
    let said = [(answer.local1, answer.world1, answer.feature1), (answer.local2, answer.world2, answer.feature2)];
    std::array::from_fn(|i| {
        let (local, world, feature) = said[i];
        let (polyhedron, pose) = (polyhedra[i], poses[i]);
        Witness { object: i + 1, polyhedron, pose, local: local.into(), world: world.into(), feature }
    })
}

/// Whether any witness point or feature is said.
fn are_said(witnesses: &[Witness; 2]) -> bool {
    witnesses.iter().any(|witness| {
        let mut coordinates = witness.local.iter().chain(&witness.world);
        coordinates.any(|x| !x.is_nan()) || witness.feature.kind != FeatureKind::None
    })
}

fn verify_intersecting(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], answer: &PairAnswer) -> Result<()> {
    let count = answer.proof_count as usize;
    if !(1..=4).contains(&count) {
        return Err(unverified(format!("an intersection with {count} vertex pairs as proof")));
    }
    if (answer.lower, answer.upper, answer.distance) != (0.0, 0.0, 0.0) {
        return Err(unverified("an intersection with a distance that is not 0".into()));
    }
    let mut pairs = [[0; 2]; 4];
    for (pair, labels) in pairs.iter_mut().zip(answer.proof).take(count) {
        for i in 0..2 {
            let found = polyhedra[i].vertex_labels.iter().position(|&label| label == labels[i]);
            let index = found.ok_or_else(|| {
                Error::Argument(format!("vertex {} of object {} is no vertex of its hull", labels[i], i + 1))
            })?;
            pair[i] = index as u32;
        }
    }
    if !exact::encloses_origin(polyhedra[0], poses[0], polyhedra[1], poses[1], &pairs[..count]) {
        return Err(unverified("the proof's vertex differences do not hold the origin in their hull".into()));
    }
    let witnesses = witnesses(polyhedra, poses, answer);
    let between = between_origins(polyhedra, poses);
    let Some(allowed) = allowed(polyhedra, &between) else { return Ok(()) };
    if !are_said(&witnesses) {
        return Ok(());
    }
    check_unit(&Vector::from(answer.normal))?;
    for witness in &witnesses {
        witness.check_point(allowed)?;
        witness.check_feature()?;
    }
    let [first, second] = [0, 1].map(|i| poses[i].rotate(&witnesses[i].centred()));
    let apart = length(&(between + first - second));
    if !(apart <= allowed) {
        return Err(unverified(format!("the witness points of a contact are {apart:e} apart")));
    }
    Ok(())
}

/// The length of a vector whose squares may leave the range of doubles.
fn length(v: &Vector) -> f64 {
    let scale = v.amax();
    if scale > 0.0 && scale.is_finite() { (v / scale).norm() * scale } else { scale }
}

fn unverified(what: String) -> Error {
    Error::Unverified(format!("the answer does not hold: {what}"))
}
