//! Which normals a contact with a ground may have.
//!
//! A body that slides over two triangles of a plane must not catch on the edge between them. So a contact keeps its own normal
//! only if that is a normal of the surface at the feature that is touched: no point of the surface beside it is farther out along
//! the normal, on any of the triangles around. That is the normal cone of the feature; for a flat or concave edge and for a
//! vertex in a hollow only the triangles' normals are in it. Any other contact takes the best of those that are: `allowed.rs`.

use super::surface::Ground;
use super::triangles::{NONE, next, previous};
use crate::base::math::{Vector, is_unit};

/// How far, as an angle, a normal may be out of the cone and count as in it, 2⁻²⁰: above what rounding to float does to the normals
/// of a plane, and far below what a simulation feels.
pub(super) const TILT: f64 = 1.0 / (1 << 20) as f64;

impl Ground {
    /// Whether a contact may have a normal, a unit vector in the frame of the ground. The caller knows that no point of the
    /// triangle is farther out along it than the point that is touched.
    pub(super) fn allows(&self, triangle: u32, normal: &Vector) -> bool {
        debug_assert!(is_unit(normal));
        debug_assert!(is_unit(normal));
        let own = self.normal(triangle);
        if (normal - own).norm() <= TILT {
            return true;
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
        debug_assert!(is_unit(normal));
        let tail = self.tail(half_edge);
        let along = (self.tail(next(half_edge)) - tail).normalize();
        let is_no_farther = |half_edge: u32| {
            let to_third = self.tail(previous(half_edge)) - tail;
            let inward = to_third - along * along.dot(&to_third);
            normal.dot(&inward) <= TILT * inward.norm()
        };
        let (twin, covers) = (self.twin(half_edge), self.covers_of_side(half_edge));
        let is_no_farther = is_no_farther(half_edge)
            && (twin == NONE || is_no_farther(twin))
            && self.do_not_lead_out(covers, &tail, normal);
        is_no_farther && self.is_out_of_front(half_edge, normal)
    }

    /// Whether a direction that is a normal at an edge, or its opposite, is out of the front: in a groove the opposites of both
    /// triangles' normals lead no farther out either.
    fn is_out_of_front(&self, half_edge: u32, normal: &Vector) -> bool {
        let own = self.normal(half_edge / 3);
        let beside = match (self.twin(half_edge), self.covers_of_side(half_edge)) {
            (NONE, []) => return normal.dot(&own) >= -TILT,
            (NONE, [(_, cover), ..]) => self.normal(*cover),
            (twin, _) => self.normal(twin / 3),
        };
        let between = own + beside;
        // The triangles of a fold are each the other's back.
        normal.dot(&between) > 0.0 || between.norm() <= TILT
    }

    /// The normal at the other end of those that contacts with a side may have: the neighbour's, or straight outwards at a rim.
    /// `None` where the edge is flat or concave, and the triangle's own is the only one.
    pub(super) fn far_normal(&self, half_edge: u32) -> Option<Vector> {
        let (own, tail) = (self.normal(half_edge / 3), self.tail(half_edge));
        let is_below = |point: Vector| own.dot(&(point - tail)) < -TILT * (point - tail).norm();
        match (self.twin(half_edge), self.covers_of_side(half_edge)) {
            (NONE, []) => Some((self.tail(next(half_edge)) - tail).cross(&own).normalize()),
            (NONE, covers) => {
                let normals = covers.iter().map(|(_, cover)| self.normal(*cover));
                normals
                    .filter(|normal| (normal - own).norm() > TILT)
                    .find(|normal| self.is_normal_at_edge(half_edge, normal))
            }
            (twin, _) => is_below(self.tail(previous(twin))).then(|| self.normal(twin / 3)),
        }
    }

    /// No corner of these triangles is farther out than a point.
    fn do_not_lead_out(&self, covers: &[(u32, u32)], point: &Vector, normal: &Vector) -> bool {
        debug_assert!(is_unit(normal));
        let corners = covers.iter().flat_map(|(_, cover)| (3 * cover..3 * cover + 3).map(|corner| self.tail(corner)));
        corners.map(|corner| corner - point).all(|to| normal.dot(&to) <= TILT * to.norm())
    }

    /// None of the edges around the vertex at which a half-edge begins leads farther out.
    pub(super) fn is_normal_at_vertex(&self, half_edge: u32, normal: &Vector) -> bool {
        debug_assert!(is_unit(normal));
        let vertex = self.tail(half_edge);
        // The edge nearest to leading out, as the sine of its angle and a half-edge on it.
        let mut nearest = (f64::NEG_INFINITY, half_edge);
        let mut leads_out = |to: Vector, on: u32| {
            let sine = normal.dot(&to) / to.norm();
            if sine > nearest.0 {
                nearest = (sine, on);
            }
            // A NaN leads nowhere.
            !(sine <= TILT)
        };
        // Around the one way, and from where the surface ends the other way. Twins are one to one: the walk comes back or ends.
        let (mut at, mut is_open) = (half_edge, false);
        loop {
            let before = previous(at);
            if leads_out(self.tail(next(at)) - vertex, at) || leads_out(self.tail(before) - vertex, before) {
                return false;
            }
            at = self.twin(before);
            if at == half_edge {
                break;
            }
            if at == NONE {
                is_open = true;
                break;
            }
        }
        if is_open {
            at = half_edge;
            while self.twin(at) != NONE {
                at = next(self.twin(at));
                if leads_out(self.tail(next(at)) - vertex, at) {
                    return false;
                }
            }
            return normal.dot(&self.normal(half_edge / 3)) >= -TILT
                && self.do_not_lead_out(self.covers_of_corner(at), &vertex, normal);
        }
        // All edges lead down from a peak, and up from the bottom of a pit. The edge tells which: across it the normal is one of
        // the edge's, or the opposite.
        let along = (self.tail(next(nearest.1)) - self.tail(nearest.1)).normalize();
        self.is_out_of_front(nearest.1, &(normal - along * along.dot(normal)))
    }
}
