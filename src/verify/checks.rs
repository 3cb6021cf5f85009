//! Shared parts of all checks: lengths, their rounding allowance, and the refusal.

use crate::answer::PairAnswer;
use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector, length};
use crate::base::memory::{in_integers, listed};
use crate::base::simd::environment::with_default;
use crate::body::polyhedron::Polyhedron;
use crate::placed::Pair;
use crate::placed::exact::VertexPair;

/// From the centred origin of object 2 to that of object 1. Translations first, so that bodies far out lose no digits.
pub(super) fn between_origins(pair: &Pair) -> Vector {
    let Pair { polyhedra, poses } = *pair;
    (poses[0].translation() - poses[1].translation())
        + (poses[0].rotate(&polyhedra[0].centre) - poses[1].rotate(&polyhedra[1].centre))
}

/// The rounding allowance for a length as it is checked here, for bodies over which balls are swept; `None` where sums of eight
/// such lengths may overflow.
pub(super) fn allowed(polyhedra: [&Polyhedron; 2], between: &Vector, swept: [f64; 2]) -> Option<f64> {
    let centres = length(&polyhedra[0].centre) + length(&polyhedra[1].centre);
    let all = polyhedra[0].radius + polyhedra[1].radius + length(between) + centres + swept[0] + swept[1];
    // Some hundred operations, each with at most half the least double where its result is subnormal.
    let underflow = 128.0 * f64::from_bits(1);
    (all <= f64::MAX / 8.0).then_some(64.0 * U * all + underflow)
}

/// Along the normal the bodies are at least `least` apart, as far as doubles tell.
pub(super) fn check_normal(pair: &Pair, normal: &Vector, between: &Vector, least: f64) -> Result<()> {
    let Pair { polyhedra, poses } = *pair;
    let support = |i: usize, direction: Vector| {
        let local = poses[i].rotate_back(&direction);
        polyhedra[i].vertices.iter().map(|v| local.dot(&v.position)).fold(f64::NEG_INFINITY, f64::max)
    };
    let gap = normal.dot(between) - support(0, -normal) - support(1, *normal);
    if gap >= least {
        return Ok(());
    }
    Err(unverified(format!("along the normal the bodies are {gap:e} apart, not {least:e}")))
}

pub(super) fn check_unit(normal: &Vector) -> Result<()> {
    if (normal.norm_squared() - 1.0).abs() <= 16.0 * U {
        return Ok(());
    }
    Err(unverified(format!("the normal is not a unit vector: {normal:?}")))
}

pub(super) fn too_large() -> Error {
    Error::Argument("the objects are too large or too far apart to be checked in doubles".into())
}

pub(super) fn unverified(what: String) -> Error {
    Error::Unverified(format!("the answer does not hold: {what}"))
}

/// A check in the default environment of floating point: it only reads, so what memory integers lack is its error.
pub(crate) fn in_default(check: impl FnOnce() -> Result<()>) -> Result<()> {
    in_integers(|| with_default(check))?
}

/// The vertex pairs of an intersection's proof.
pub(super) fn proof_of(polyhedra: [&Polyhedron; 2], answer: &PairAnswer) -> Result<Vec<VertexPair>> {
    let count = answer.proof_count as usize;
    if !(1..=4).contains(&count) {
        return Err(unverified(format!("an intersection with {count} vertex pairs as proof")));
    }
    let index_of = |i: usize, label: u32| {
        let found = polyhedra[i].vertex_labels.iter().position(|&other| other == label);
        found
            .map(|index| index as u32)
            .ok_or_else(|| Error::Argument(format!("vertex {label} of object {} is no vertex of its hull", i + 1)))
    };
    let mut pairs = listed([]);
    for &[v, w] in &answer.proof[..count] {
        pairs.push([index_of(0, v)?, index_of(1, w)?]);
    }
    Ok(pairs)
}
