//! The independent check of an answer, in O(n), trusting nothing of the solver: supports by brute force over all vertices, the
//! witness points against all faces, an intersection's proof in integers.

use crate::answer::{Outcome, PairAnswer};
use crate::error::{Error, Result};
use crate::exact;
use crate::math::{Pose, ROTATION_LIMIT, UNIT_ROUNDOFF as U, Vector};
use crate::polyhedron::Polyhedron;
use crate::shape::Shape;

/// Re-checks an answer of [`crate::pair`] for the same shapes and poses.
///
/// Separated: along the normal the bodies are at least `lower` apart, by supports over all vertices; where witness points are
/// said they lie in both bodies and their distance in [`lower`, `upper`]. Intersecting: the proof's vertex differences hold the
/// origin in their hull, exactly. The check of a separated answer is done in double precision and can see a miss of more than
/// about 64u·(ρ₁ + ρ₂ + |Δ|), Δ the distance of the bodies' origins.
///
/// # Errors
/// [`Error::Bug`] with what does not hold; [`Error::Pose`] for a pose that no query accepts; [`Error::Argument`] for an answer
/// that holds no outcome or vertex indices that the shapes do not have.
pub fn verify(shape1: &Shape, pose1: &Pose, shape2: &Shape, pose2: &Pose, answer: &PairAnswer) -> Result<()> {
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
        return Err(bug(format!("not 0 ≤ lower ≤ distance ≤ upper, 0 < upper: {lower:e}, {distance:e}, {upper:e}")));
    }
    let normal = Vector::from(answer.normal);
    if !((normal.norm_squared() - 1.0).abs() <= 16.0 * U) {
        return Err(bug(format!("the normal is not a unit vector: {normal:?}")));
    }
    // Translations first, so that bodies far out lose no digits.
    let between = (poses[0].translation() - poses[1].translation())
        + (poses[0].rotate(&polyhedra[0].centre) - poses[1].rotate(&polyhedra[1].centre));
    let centres = length(&polyhedra[0].centre) + length(&polyhedra[1].centre);
    // Some hundred operations, each with at most half the least double where its result is subnormal.
    let underflow = 128.0 * f64::from_bits(1);
    let allowed = 64.0 * U * (polyhedra[0].radius + polyhedra[1].radius + length(&between) + centres) + underflow;
    if !allowed.is_finite() {
        return Err(Error::Argument("the objects are too large or too far apart to be checked in doubles".into()));
    }
    let reach = |i: usize, direction: Vector| {
        let local = poses[i].rotate_back(&direction);
        polyhedra[i].vertices.iter().map(|v| local.dot(&v.position)).fold(f64::NEG_INFINITY, f64::max)
    };
    let gap = normal.dot(&between) - reach(0, -normal) - reach(1, normal);
    if !(gap >= lower - allowed) {
        return Err(bug(format!("along the normal the bodies are {gap:e} apart, not {lower:e}")));
    }
    // All that can be said of an upper end without witness points.
    if !(gap <= upper + allowed) {
        return Err(bug(format!("along the normal the bodies are {gap:e} apart, more than {upper:e}")));
    }
    let points = [Vector::from(answer.local1), Vector::from(answer.local2)];
    if points.iter().flatten().all(|x| x.is_nan()) {
        return Ok(());
    }
    let centred: [Vector; 2] = std::array::from_fn(|i| points[i] - polyhedra[i].centre);
    for i in 0..2 {
        let outside = distance_outside(polyhedra[i], &centred[i]);
        if !(outside <= allowed) {
            return Err(bug(format!("witness point {} lies {outside:e} out of its object", i + 1)));
        }
    }
    let apart = length(&(between + poses[0].rotate(&centred[0]) - poses[1].rotate(&centred[1])));
    if !(apart >= lower - allowed && apart <= upper + allowed) {
        return Err(bug(format!("the witness points are {apart:e} apart, not in [{lower:e}, {upper:e}]")));
    }
    Ok(())
}

/// How far a point in centred coordinates lies out of a polyhedron, at least: the largest violation of a plane, less what the
/// plane misses the hull by, which is far more than rounding where a face is a sliver.
fn distance_outside(polyhedron: &Polyhedron, point: &Vector) -> f64 {
    let vertex = |i: usize| polyhedron.vertices[i].position;
    match polyhedron.dimension {
        0 => length(&(point - vertex(0))),
        1 => {
            let along = vertex(1) - vertex(0);
            let direction = along / length(&along);
            let t = ((point - vertex(0)).dot(&direction) / length(&along)).clamp(0.0, 1.0);
            length(&(point - vertex(0) - along * t))
        }
        _ => {
            let over_faces = polyhedron.faces.iter().map(|face| face.planes.value(0, point) - face.slack);
            // A flat body is bounded by its bevels, which lie in its plane.
            let over_bevels = polyhedron
                .edges
                .iter()
                .filter_map(|edge| polyhedron.bevels.get(edge.bevel as usize).map(|bevel| (edge, bevel)))
                .map(|(edge, bevel)| bevel.normal.dot(&(point - vertex(edge.tail as usize))) - bevel.slack);
            over_faces.chain(over_bevels).fold(0.0, f64::max)
        }
    }
}

fn verify_intersecting(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], answer: &PairAnswer) -> Result<()> {
    let count = answer.proof_count as usize;
    if !(1..=4).contains(&count) {
        return Err(bug(format!("an intersection with {count} vertex pairs as proof")));
    }
    if (answer.lower, answer.upper, answer.distance) != (0.0, 0.0, 0.0) {
        return Err(bug("an intersection with a distance that is not 0".into()));
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
    if exact::encloses_origin(polyhedra[0], poses[0], polyhedra[1], poses[1], &pairs[..count]) {
        Ok(())
    } else {
        Err(bug("the proof's vertex differences do not hold the origin in their hull".into()))
    }
}

/// The length of a vector whose squares may leave the range of doubles.
fn length(v: &Vector) -> f64 {
    let scale = v.amax();
    if scale > 0.0 && scale.is_finite() { (v / scale).norm() * scale } else { scale }
}

fn bug(what: String) -> Error {
    Error::Bug(format!("the answer does not hold: {what}"))
}
