//! Which normals a contact with a ground may have.
//!
//! A body that slides over two triangles of a plane must not catch on the edge between them. So a contact keeps its own normal
//! only if that is a normal of the surface at the feature that is touched: no point of the surface beside it is farther out along
//! the normal, on any of the triangles around. That is the normal cone of the feature; for a flat or concave edge and for a
//! vertex in a hollow only the triangles' normals are in it. Any other contact takes the best of those that are: `allowed.rs`.

use super::marks::Marks;
use super::surface::Ground;
use super::triangles::{NONE, next, previous};
use crate::base::error::Result;
use crate::base::math::{Vector, is_unit};
use crate::base::memory::filled;
use crate::shape::Triangle;

/// How far, as an angle, a normal may be out of the cone and count as in it, 2⁻²⁰: above what rounding to float does to the normals
/// of a plane, and far below what a simulation feels.
pub(super) const TILT: f64 = 1.0 / (1 << 20) as f64;

impl Ground {
    /// Whether a contact may have a normal, a unit vector in the frame of the ground. The caller knows that no point of the
    /// triangle is farther out along it than the point that is touched.
    pub(super) fn allows(&self, triangle: &Triangle, normal: &Vector) -> bool {
        debug_assert!(is_unit(normal));
        let Triangle { corners, normal: own, label, .. } = triangle;
        if (normal - own).norm() <= TILT {
            return true;
        }
        let first = 3 * label;
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

    /// Whether the neighbour at a side is in the same plane and faces the same way.
    fn is_flat(&self, half_edge: u32) -> bool {
        let (own, twin) = (self.normal(half_edge / 3), self.twin(half_edge));
        twin != NONE && {
            let to_third = self.tail(previous(twin)) - self.tail(half_edge);
            own.dot(&to_third).abs() <= TILT * to_third.norm() && own.dot(&self.normal(twin / 3)) > 0.0
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
        if let Some(ways) = self.layout().ways_around(half_edge) {
            // Down from a peak; along a normal that is down, up from the bottom of a pit.
            return normal.z > 0.0 && ways.iter().all(|way| normal.dot(way) <= TILT * way.norm());
        }
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

impl Ground {
    /// The marks of all triangles.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(super) fn find_marks(&self) -> Result<Vec<Marks>> {
        let mut all = filled(Marks::NONE, self.triangle_count())?;
        let is_there = |triangle: usize| !self.layout().is_left_out(triangle as u32);
        for (triangle, marks) in all.iter_mut().enumerate().filter(|(triangle, _)| is_there(*triangle)) {
            let has_far = |side: &usize| self.far_normal((3 * triangle + side) as u32).is_some();
            (0..3).filter(has_far).for_each(|side| marks.set_far_normal(side));
            if (3 * triangle..3 * triangle + 3).all(|half_edge| self.is_flat(half_edge as u32)) {
                marks.set_inner();
            }
        }
        for triangle in (0..all.len()).filter(|triangle| is_there(*triangle)) {
            all[triangle] = self.marks_around(triangle as u32, &all);
        }
        Ok(all)
    }

    /// Those of a triangle, from what is known of all sides.
    ///
    /// A peak's normals are in the cone of the normals of the triangles around it: seen from the own normal, if all are within 90°
    /// of it, these go once around each (Banchoff 1970). So none leans more than one of a triangle. A peak has three convex edges
    /// at least: those in which the cone over its edges ends. At a rim all within 90° may be allowed.
    fn marks_around(&self, triangle: u32, all: &[Marks]) -> Marks {
        let own = self.normal(triangle);
        let (mut marks, mut cosine) = (all[triangle as usize], 1.0_f64);
        for k in 0..3 {
            let half_edge = 3 * triangle + k;
            if self.twin(half_edge) == NONE && !self.covers_of_side(half_edge).is_empty() {
                cosine = -1.0;
            }
            let (mut at, mut convex) = (half_edge, 0);
            loop {
                cosine = cosine.min(own.dot(&self.normal(at / 3)));
                convex += u32::from(all[at as usize / 3].has_far_normal(at as usize % 3));
                at = self.twin(previous(at));
                if at == NONE {
                    (cosine, convex) = (cosine.min(0.0), 3);
                }
                if at == NONE || at == half_edge {
                    break;
                }
            }
            if convex >= 3 {
                marks.set_peak(k as usize);
            }
        }
        marks.set_widest(cosine);
        marks
    }
}

#[cfg(test)]
mod tests {
    use super::super::contacts::near_hills::near_hills;

    /// No normal that is allowed leans more than is marked; only corners that are marked have normals of their own.
    #[test]
    fn no_allowed_normal_leans_more_than_is_marked() {
        let (mut allowed, mut peaks) = (0, 0);
        near_hills(0x3a2, 60, |near, random| {
            let own = near.triangle.own;
            for _ in 0..20 {
                let normal = (own.normal + random.direction() * random.uniform(0.0, 1.5)).normalize();
                for k in 0..3 {
                    let is_there = near.ground.is_normal_at_vertex(3 * own.label + k, &normal);
                    assert!(!is_there || near.triangle.marks.may_be_peak(k as usize));
                    peaks += usize::from(is_there);
                }
                if near.ground.allows(&own, &normal) {
                    let cosine = normal.dot(&own.normal);
                    let tan_half = ((1.0 - cosine) / (1.0 + cosine)).sqrt();
                    assert!(near.triangle.marks.tan_half().is_none_or(|most| tan_half <= most));
                    allowed += usize::from(tan_half > 1e-3);
                }
            }
        });
        assert!(cfg!(miri) || allowed > 50 && peaks > 50, "{allowed} {peaks}");
    }
}
