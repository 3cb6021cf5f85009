//! Whether a point is inside a solid ground, and which triangle is nearest to it.

use super::surface::Ground;
use super::tree::{FOUR, FourBoxes, NodeBounds, Visit};
use super::triangles::NONE;
use crate::base::error::Result;
use crate::base::math::Vector;

/// Squares of distances that agree so far are equal, 2⁻⁴⁰.
const AS_NEAR: f64 = 1.0 / (1_u64 << 40) as f64;

/// The triangle nearest to a point, if the point is behind it and all others that are as near, and not beside a rim, by at most the
/// thickness of the ground. The nearest point of a surface around a solid is never on a convex edge.
pub(super) fn triangle_over(ground: &Ground, point: &Vector) -> Result<Option<u32>> {
    let mut nearest = NearestSurface {
        ground,
        point,
        square: ground.thickness() * ground.thickness(),
        triangle: NONE,
        is_behind: false,
    };
    let bounds = ground.layout().bounds();
    // Inside of what is closed is inside of the box.
    if ground.thickness() == f64::INFINITY
        && (point.inf(&bounds.lower) != bounds.lower || point.sup(&bounds.upper) != bounds.upper)
    {
        return Ok(None);
    }
    ground.layout().walk(&mut nearest)?;
    Ok(nearest.is_behind.then_some(nearest.triangle))
}

struct NearestSurface<'a> {
    ground: &'a Ground,
    point: &'a Vector,
    /// The square of the distance that was found, or of the largest that counts.
    square: f64,
    triangle: u32,
    is_behind: bool,
}

impl Visit for NearestSurface<'_> {
    fn keys(&self, boxes: &FourBoxes) -> [f64; FOUR] {
        NodeBounds { lower: *self.point, upper: *self.point }.gaps(boxes)
    }

    fn goes_to(&mut self, _: &NodeBounds, gap: f64) -> bool {
        gap * gap <= self.square * (1.0 + AS_NEAR)
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        let own = self.ground.triangle(triangle);
        let (point, side) = nearest_point(&own.corners, self.point);
        let square = (self.point - point).norm_squared();
        let is_rim = side.is_some_and(|k| {
            let half_edge = 3 * triangle + k;
            self.ground.twin(half_edge) == NONE && self.ground.covers_of_side(half_edge).is_empty()
        });
        let is_behind = !is_rim && own.normal.dot(&(self.point - own.corners[0])) < 0.0;
        if self.triangle != NONE && (square - self.square).abs() <= AS_NEAR * self.square {
            self.is_behind &= is_behind;
        } else if square <= self.square {
            (self.square, self.triangle, self.is_behind) = (square, triangle, is_behind);
        }
        Ok(true)
    }
}

/// The point of a triangle nearest to another, and the side that it is on unless it is inside.
pub(super) fn nearest_point(corners: &[Vector; 3], point: &Vector) -> (Vector, Option<u32>) {
    let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
    let mut best: Option<(f64, Vector, u32)> = None;
    for k in 0..3 {
        let [tail, head] = [corners[k], corners[(k + 1) % 3]];
        let (side, to) = (head - tail, point - tail);
        if normal.cross(&side).dot(&to) >= 0.0 {
            continue;
        }
        let on = tail + side * (to.dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
        let square = (point - on).norm_squared();
        if best.is_none_or(|(before, ..)| square < before) {
            best = Some((square, on, k as u32));
        }
    }
    match best {
        Some((_, on, k)) => (on, Some(k)),
        None => (point - normal * (normal.dot(&(point - corners[0])) / normal.norm_squared()), None),
    }
}
