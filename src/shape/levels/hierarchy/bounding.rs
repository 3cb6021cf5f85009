//! Making a level bound the body: translation and scaling (Ehmann & Lin 2000, §4.3), rounded outward, the result proved.

use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{collected, filled};
use crate::body::build::assembly::{build, copy_labels};
use crate::body::polyhedron::Polyhedron;
use crate::shape::levels::containment::contains;

/// Growing a level that rounding left too small: so many times, each by four times as much as before.
const ATTEMPTS: u32 = 16;

/// Moves points by a translation.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn translated(points: &[Vector], by: &Vector) -> Result<Vec<Vector>> {
    collected(points.iter().map(|p| p + by))
}

/// The hull of the points if it contains `base` as it is, else scaled about `centre` so that it barely does; decided exactly
/// ([`contains`]). All in the centred coordinates of `base`, whose `centre` is 0. `None` if the hull has no interior or
/// `centre` lies too near its surface, or outside. The vertex labels of the result are indices of `points`.
///
/// The factor is the largest over the faces of the height of the body's extreme vertex over that of the face, both above
/// `centre`, and a margin for the rounding of planes and vertices: each of a few u·ρ, so 64uρ over the least height, and four
/// times as much each time that it does not do.
///
/// # Errors
/// [`Error::Bug`](crate::base::error::Error::Bug) if the triangles of a polyhedron are no closed surface.
pub fn bounding(points: &[Vector], centre: &Vector, base: &Polyhedron, scale: Scaling) -> Result<Option<Polyhedron>> {
    debug_assert_eq!(base.centre, Vector::zeros());
    let hull = build(points, None)?;
    let offset = hull.centre;
    if hull.dimension < 3 {
        return Ok(None);
    }
    if scale == Scaling::WhereNeeded && hull.centre == base.centre && contains(&hull, base)? {
        return Ok(Some(hull));
    }
    let from_centre: Vec<Vector> = collected(hull.vertices.iter().map(|v| v.position + offset - centre))?;
    let (mut factor, mut least) = (0.0_f64, f64::INFINITY);
    let mut start = 0;
    for face in faces_in_order(&hull)? {
        let face = &hull.faces[face as usize];
        let height = face.normal.dot(&from_centre[face.vertex as usize]);
        start = base.support(&face.normal, start).0;
        let support = face.normal.dot(&(base.vertices[start as usize].position - centre));
        least = least.min(height);
        factor = factor.max(support / height);
    }
    if !(least > 0.0 && factor > 0.0 && factor.is_finite()) {
        return Ok(None);
    }
    let mut margin = 64.0 * UNIT_ROUNDOFF * (hull.mass.radius + base.radius / factor) / least;
    for _ in 0..ATTEMPTS {
        if !(margin < 1.0) {
            break;
        }
        let grown = factor * (1.0 + margin);
        let points: Vec<Vector> = collected(from_centre.iter().map(|p| centre + p * grown))?;
        let mut level = build(&points, None)?;
        for label in &mut level.vertex_labels {
            *label = hull.vertex_labels[*label as usize];
        }
        copy_labels(&mut level);
        if level.centre == base.centre && contains(&level, base)? {
            return Ok(Some(level));
        }
        margin *= 4.0;
    }
    Ok(None)
}

/// When [`bounding`] scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scaling {
    /// Only where the hull does not contain the body yet.
    WhereNeeded,
    /// Always, down where the hull is larger than need be.
    Always,
}

/// The faces of a polyhedron, neighbours near each other: by their lowest vertex, as the vertices are in such an order.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn faces_in_order(polyhedron: &Polyhedron) -> Result<Vec<u32>> {
    let mut lowest = filled(u32::MAX, polyhedron.faces.len())?;
    for (corners, &face) in polyhedron.triangles.iter().zip(&polyhedron.face_of_triangle) {
        for &v in corners {
            lowest[face as usize] = lowest[face as usize].min(v);
        }
    }
    let mut order: Vec<u32> = collected(0..polyhedron.faces.len() as u32)?;
    order.sort_unstable_by_key(|face| (lowest[*face as usize], *face));
    Ok(order)
}
