//! A ray cast: a walk to both ends, the proofs of them by doubles, and integers where they do not.

use super::line::{Line, PlaneCrossing};
use super::walk::{End, Ended, LocalLine};
use super::{Ray, RayAnswer, RayOutcome, exact};
use crate::answer::{label, normalised};
use crate::base::error::Result;
use crate::base::math::Pose;
use crate::base::memory::in_integers;
use crate::body::polyhedron::{NONE, Polyhedron};
use crate::placed::state::FeatureId;

/// Corners of a face that a proof takes; for a face with more, some around the place.
const MOST_CORNERS: usize = 8;

/// The result that doubles prove.
enum ProvedHit {
    Miss,
    /// The line passes through the body: through this face, between these, and goes out between those.
    Passes {
        face: u32,
        entry: PlaneCrossing,
        exit: PlaneCrossing,
    },
    Nothing,
}

/// Casts a ray at a polyhedron at a pose; both are checked.
pub(super) fn cast(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray) -> Result<RayAnswer> {
    let mut answer = RayAnswer::default();
    let line = Line::new(polyhedron, pose, ray, 0.0);
    if let Some(line) = &line {
        match prove(line, ray, &mut answer.steps) {
            ProvedHit::Miss => {
                answer.outcome = RayOutcome::Miss;
                return Ok(answer);
            }
            ProvedHit::Passes { face, entry, exit } => {
                if fill(&mut answer, line, ray, entry.at, exit.at) {
                    if answer.outcome == RayOutcome::Hit {
                        answer.normal = normalised(&entry.normal);
                        let point = line.local_origin() + line.local_direction() * entry.at[0];
                        answer.feature = label(polyhedron, FeatureId::Face(face), &point);
                    }
                    return Ok(answer);
                }
            }
            ProvedHit::Nothing => {}
        }
    }
    in_integers(|| exact::cast(polyhedron, pose, ray, line.as_ref(), &mut answer))?;
    Ok(answer)
}

/// The same, whatever doubles prove.
pub(super) fn cast_in_integers(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray) -> Result<RayAnswer> {
    let mut answer = RayAnswer::default();
    let line = Line::new(polyhedron, pose, ray, 0.0);
    in_integers(|| exact::cast(polyhedron, pose, ray, line.as_ref(), &mut answer))?;
    Ok(answer)
}

fn prove(line: &Line, ray: &Ray, steps: &mut u32) -> ProvedHit {
    if line.passes_sphere() {
        return ProvedHit::Miss;
    }
    let polyhedron = line.polyhedron;
    if polyhedron.faces.is_empty() {
        return ProvedHit::Nothing;
    }
    let local = LocalLine::new(line);
    let entering = match local.walk(End::Entry, steps) {
        Ended::At(face) => face,
        Ended::Beside(edge) => return if passes_edge(line, ray, edge) { ProvedHit::Miss } else { ProvedHit::Nothing },
        Ended::Lost => return ProvedHit::Nothing,
    };
    let Some(entry) = line.crossing_of(&polyhedron.faces[entering as usize]) else { return ProvedHit::Nothing };
    if entry.faces && entry.at[0] > ray.t_max {
        return ProvedHit::Miss;
    }
    let Ended::At(leaving) = local.walk(End::Exit, steps) else { return ProvedHit::Nothing };
    let Some(exit) = line.crossing_of(&polyhedron.faces[leaving as usize]) else { return ProvedHit::Nothing };
    if !entry.faces || exit.faces {
        return ProvedHit::Nothing;
    }
    if exit.at[1] < 0.0 || entry.at[0] > exit.at[1] {
        return ProvedHit::Miss;
    }
    let passes = |face: u32, faces: bool| {
        let (corners, count) = corners(polyhedron, face, &local);
        line.passes_through(&corners[..count], faces)
    };
    if passes(entering, true) && passes(leaving, false) {
        return ProvedHit::Passes { face: entering, entry, exit };
    }
    ProvedHit::Nothing
}

/// Whether the line, or all of the ray on it, provably misses the body by the planes at an edge.
fn passes_edge(line: &Line, ray: &Ray, edge: u32) -> bool {
    let edge = &line.polyhedron.edges[edge as usize];
    let mut part = [0.0, ray.t_max];
    let [left, right] = [edge.left(), edge.right()].map(|face| &line.polyhedron.faces[face as usize]);
    let bevel = line.polyhedron.bevels.get(edge.bevel as usize);
    let planes =
        [Some((&left.normal, left.slack)), Some((&right.normal, right.slack)), bevel.map(|b| (&b.normal, b.slack))];
    for (normal, slack) in planes.into_iter().flatten() {
        // Both ends of the edge are as near to each plane as its slack says.
        if let Some(crossing) = line.crossing(normal, slack, edge.tail()) {
            match crossing.faces {
                true => part[0] = part[0].max(crossing.at[0]),
                false => part[1] = part[1].min(crossing.at[1]),
            }
        }
    }
    part[0] > part[1]
}

/// Corners of a face, counter-clockwise from outside; if there are many, a few around where the line meets its plane.
fn corners(polyhedron: &Polyhedron, face: u32, local: &LocalLine) -> ([u32; MOST_CORNERS], usize) {
    let count = polyhedron.faces[face as usize].side_count;
    let mut corners = [NONE; MOST_CORNERS];
    if count as usize <= MOST_CORNERS {
        (0..count).zip(&mut corners).for_each(|(side, at)| *at = corner(polyhedron, face, side));
        return (corners, count as usize);
    }
    // The triangle of the fan around the first corner that holds the place, with one more on either side.
    let point = local.point_on(face);
    let normal = &polyhedron.faces[face as usize].normal;
    let position = |side: u32| polyhedron.vertices[corner(polyhedron, face, side) as usize].position;
    let hub = position(0);
    let is_left = |side: u32| (position(side) - hub).cross(&(point - hub)).dot(normal) > 0.0;
    let (mut low, mut high) = (1, count - 1);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if is_left(middle) { low = middle } else { high = middle }
    }
    let around = (low.max(2) - 1..=(high + 1).min(count - 1)).filter(|&side| side > 0);
    let mut used = 0;
    for side in std::iter::once(0).chain(around) {
        corners[used] = corner(polyhedron, face, side);
        used += 1;
    }
    (corners, used)
}

/// Fills in what the line's part in the body tells about the ray, but for the surface; false where rounding hides an end of
/// either.
pub(super) fn fill(answer: &mut RayAnswer, line: &Line, ray: &Ray, entry: [f64; 2], exit: [f64; 2]) -> bool {
    let begins_inside = entry[1] < 0.0;
    let is_certain = (begins_inside || entry[0] >= 0.0)
        && entry[1] <= ray.t_max
        && exit[0] >= 0.0
        && line.is_narrow(entry)
        && line.is_narrow(exit);
    if !is_certain {
        return false;
    }
    answer.exit = exit.map(|t| t.min(ray.t_max));
    (answer.outcome, answer.entry) =
        if begins_inside { (RayOutcome::Inside, [0.0; 2]) } else { (RayOutcome::Hit, entry) };
    true
}

/// The corner at which a side begins, seen from outside.
fn corner(polyhedron: &Polyhedron, face: u32, side: u32) -> u32 {
    debug_assert!(side < polyhedron.faces[face as usize].side_count);
    let edge = &polyhedron.edges[polyhedron.side(&polyhedron.faces[face as usize], side) as usize];
    if edge.left() == face { edge.tail() } else { edge.head() }
}
