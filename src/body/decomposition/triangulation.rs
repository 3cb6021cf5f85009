//! Polygons cut into triangles.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{extend, push};
use crate::base::predicates::ExactPoints;

/// Appends the triangles of a polygon, over the same vertices, by cutting off ears (G. H. Meisters, "Polygons have ears", American
/// Mathematical Monthly 82, 1975), seen along the axis of coordinates that its normal is closest to. False if no ear is left: the
/// polygon crosses itself, seen that way. One without area becomes triangles without area: they keep the surface together.
///
/// # Errors
/// [`crate::base::error::Error::Memory`].
pub fn triangulate(points: &ExactPoints, polygon: &mut Vec<u32>, triangles: &mut Vec<[u32; 3]>) -> Result<bool> {
    debug_assert!(polygon.len() >= 3);
    let normal = newell_normal(points, polygon);
    let axis = normal.iamax();
    let turn = |corners: [u32; 3]| points.projected_orientation(axis, corners) * normal[axis].signum();
    if normal[axis] == 0.0 {
        extend(triangles, polygon[1..].windows(2).map(|pair| [polygon[0], pair[0], pair[1]]))?;
        return Ok(true);
    }
    // The last one that was tried in vain: the next ear is sought behind it, so that the triangles of a round polygon are no fan.
    let mut place = 0;
    while polygon.len() > 3 {
        let count = polygon.len();
        let at = |i: usize| polygon[i % count];
        let is_ear = |i: usize| {
            let ear = [at(i), at(i + 1), at(i + 2)];
            let is_inside = |v: u32| (0..3).all(|k| turn([ear[k], ear[(k + 1) % 3], v]) >= 0.0);
            turn(ear) > 0.0 && !polygon.iter().any(|v| !ear.contains(v) && is_inside(*v))
        };
        if let Some(i) = (0..count).map(|i| place + i).find(|i| is_ear(*i)) {
            push(triangles, [at(i), at(i + 1), at(i + 2)])?;
            polygon.remove((i + 1) % count);
            place = (i + 1) % (count - 1);
        } else if let Some(i) = (0..count).find(|i| points.collinear([at(*i), at(i + 1), at(i + 2)])) {
            // A corner in the middle of a side that is a side of a neighbour: a triangle without area keeps the surface closed.
            push(triangles, [at(i), at(i + 1), at(i + 2)])?;
            polygon.remove((i + 1) % count);
        } else {
            return Ok(false);
        }
    }
    let last = [polygon[0], polygon[1], polygon[2]];
    push(triangles, last)?;
    Ok(turn(last) >= 0.0)
}

/// The area vector (M. E. Newell), good for its direction alone.
fn newell_normal(points: &ExactPoints, polygon: &[u32]) -> Vector {
    let origin = points.approximate(polygon[0]);
    let offset = |v: u32| points.approximate(v) - origin;
    polygon.windows(2).map(|pair| offset(pair[0]).cross(&offset(pair[1]))).sum()
}
