//! Triangles inside a plane. A body that stands on a plane of many triangles has its points at its own corners: none is where the
//! triangles meet, and those that no corner is over add nothing.

use super::lowest::{Limit, PlacedTriangle};
use super::vertices::Vertices;
use crate::base::math::Vector;

/// Most vertices near a plane.
const MOST: usize = 32;

/// Planes that are as near to each other, relative to where they are, are taken for one, 2⁻⁴⁰.
const ONE_PLANE: f64 = 1.0 / (1_u64 << 40) as f64;

/// How a body stands over a triangle inside a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stand {
    /// All of the body is farther than `max_distance` above the plane.
    Beyond,
    /// A vertex may be over the triangle, or there are many near its plane.
    Over,
    /// No vertex up to `max_distance` above the plane is over the triangle, and the body is above the plane.
    Beside,
    /// The same of a body that may reach through the plane.
    Through,
}

/// The vertices of a body near the last plane.
pub(super) struct Footing {
    up: Vector,
    /// How high the plane is along that.
    level: f64,
    points: [Vector; MOST],
    count: usize,
    lowest: f64,
    /// How far planes are taken for one.
    near: f64,
}

impl Footing {
    /// Of no plane; `size` is how far body and ground are from the origin, at most.
    pub fn new(size: f64) -> Footing {
        let points = [Vector::zeros(); MOST];
        Footing { up: Vector::zeros(), level: 0.0, points, count: 0, lowest: 0.0, near: ONE_PLANE * size }
    }

    /// How a body stands over a triangle.
    pub fn stand(&mut self, body: &Vertices, triangle: &PlacedTriangle, limit: Limit) -> Stand {
        let PlacedTriangle { up, corners, error, .. } = triangle;
        let level = up.dot(&corners[0]);
        if !((up - self.up).norm_squared() <= ONE_PLANE * ONE_PLANE && (level - self.level).abs() <= self.near) {
            self.stand_on(body, *up, level, limit);
        }
        match self.count {
            0 => return Stand::Beyond,
            1..=MOST => {}
            _ => return Stand::Over,
        }
        // A bit for each vertex that is certainly beside.
        let (all, mut beside) = (u32::MAX >> (MOST - self.count), 0);
        for k in 0..3 {
            let side = corners[(k + 1) % 3] - corners[k];
            let inward = up.cross(&side);
            let least = -4.0 * error * inward.norm();
            for (at, point) in self.points[..self.count].iter().enumerate() {
                beside |= u32::from(inward.dot(&(point - corners[k])) < least) << at;
            }
        }
        match (beside == all, self.lowest > 4.0 * self.near + error) {
            (false, _) => Stand::Over,
            (true, true) => Stand::Beside,
            (true, false) => Stand::Through,
        }
    }

    /// Finds the vertices near a plane, those near another that is taken for it included.
    fn stand_on(&mut self, body: &Vertices, up: Vector, level: f64, limit: Limit) {
        (self.up, self.level, self.count, self.lowest) = (up, level, 0, f64::INFINITY);
        let highest = limit.max_distance + limit.radius + 4.0 * self.near;
        if !body.are_placed() {
            self.count = MOST + 1;
            return;
        }
        for vertex in 0..body.polyhedron().vertices.len() as u32 {
            let point = body.point(vertex);
            let height = up.dot(&point) - level;
            self.lowest = self.lowest.min(height - limit.radius);
            if height <= highest {
                if let Some(to) = self.points.get_mut(self.count) {
                    *to = point;
                }
                self.count += 1;
                if self.count > MOST {
                    return;
                }
            }
        }
    }
}
