//! Which normals a contact with a ground may have.
//!
//! A body that slides over two triangles of a plane must not catch on the edge between them. So a contact keeps its own normal
//! only if that is a normal of the surface at the feature that is touched: no point of the surface beside it is farther out along
//! the normal, on any of the triangles around. That is the normal cone of the feature; for a flat or concave edge and for a
//! vertex in a hollow only the triangles' normals are in it. Any other contact takes the normal of its triangle.

use super::surface::{Ground, NONE, next, previous};
use crate::base::math::{Vector, is_unit};

/// How far, as an angle, a normal may be out of the cone and count as in it, 2⁻²⁰: above what rounding to float does to the normals
/// of a plane, and far below what a simulation feels.
pub(super) const TILT: f64 = 1.0 / (1 << 20) as f64;

impl Ground {
    /// Whether a contact may have a normal, a unit vector in the frame of the ground. The caller knows that no point of the
    /// triangle is farther out along it than the point that is touched.
    pub(super) fn allows(&self, triangle: u32, normal: &Vector) -> bool {
        debug_assert!(is_unit(normal));
        let own = self.normal(triangle);
        if (normal - own).norm() <= TILT {
            return true;
        }
        // NaN fails the comparison, too.
        if !(normal.dot(&own) >= -TILT) {
            return false;
        }
        let first = 3 * triangle;
        let corners = [0, 1, 2].map(|k| self.tail(first + k));
        let height = |k: usize| normal.dot(&(corners[k] - corners[0]));
        let farthest = (1..3).fold(0, |best, k| if height(k) > height(best) { k } else { best });
        let is_below = |k: &usize| {
            let down = corners[farthest] - corners[*k];
            normal.dot(&down) > TILT * down.norm()
        };
        let mut below = (0..3).filter(is_below);
        match (below.next(), below.next()) {
            // The side that it is not at.
            (Some(corner), None) => self.is_normal_at_edge(next(first + corner as u32), normal),
            _ => self.is_normal_at_vertex(first + farthest as u32, normal),
        }
    }

    /// Neither triangle beside the edge leads farther out.
    fn is_normal_at_edge(&self, half_edge: u32, normal: &Vector) -> bool {
        let tail = self.tail(half_edge);
        let along = (self.tail(next(half_edge)) - tail).normalize();
        let is_no_farther = |half_edge: u32| {
            let to_third = self.tail(previous(half_edge)) - tail;
            let inward = to_third - along * along.dot(&to_third);
            normal.dot(&inward) <= TILT * inward.norm()
        };
        let twin = self.twin(half_edge);
        is_no_farther(half_edge) && (twin == NONE || is_no_farther(twin))
    }

    /// None of the edges around the vertex at which a half-edge begins leads farther out.
    fn is_normal_at_vertex(&self, half_edge: u32, normal: &Vector) -> bool {
        let vertex = self.tail(half_edge);
        let leads_out = |to: Vector| normal.dot(&(to - vertex)) > TILT * (to - vertex).norm();
        // Around the one way, and from where the surface ends the other way. Twins are one to one: the walk comes back or ends.
        let mut at = half_edge;
        loop {
            let before = previous(at);
            if leads_out(self.tail(next(at))) || leads_out(self.tail(before)) {
                return false;
            }
            at = self.twin(before);
            if at == half_edge {
                return true;
            }
            if at == NONE {
                break;
            }
        }
        at = half_edge;
        while self.twin(at) != NONE {
            at = next(self.twin(at));
            if leads_out(self.tail(next(at))) {
                return false;
            }
        }
        true
    }
}
