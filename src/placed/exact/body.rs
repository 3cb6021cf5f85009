//! A polyhedron at a pose, in integers: world vertices and support vertices.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::dyadic::{DyadicVector, IntVector, dot, leading_bits};
use crate::base::math::{Pose, Vector};
use crate::body::polyhedron::Polyhedron;

/// Sums of differences from here, 2⁻⁸⁰⁰ …
const SMALLEST_FOR_DOUBLES: f64 = f64::from_bits((1023 - 800) << 52);

/// … to here, 2⁸⁰⁰, are compared in doubles where these decide.
const LARGEST_FOR_DOUBLES: f64 = f64::from_bits((1023 + 800) << 52);

/// The objects' exact description: world vertex = R·(centre + position) + T.
pub(crate) struct ExactBody<'a> {
    polyhedron: &'a Polyhedron,
    centre: DyadicVector,
    /// The rows of R, over `rotation_exponent`.
    rotation: [IntVector; 3],
    rotation_exponent: i32,
    translation: DyadicVector,
}

/// A direction in a body's own frame: exactly, and its leading bits as doubles for the filter.
pub(crate) struct LocalDirection {
    exact: IntVector,
    rounded: Vector,
}

impl<'a> ExactBody<'a> {
    pub fn new(polyhedron: &'a Polyhedron, pose: &Pose) -> ExactBody<'a> {
        let mut rows = pose.rows.map(|row| DyadicVector::from_doubles([row[0], row[1], row[2]]));
        let exponent = rows.iter().map(|row| row.exponent).min().unwrap_or(0);
        rows.iter_mut().for_each(|row| row.refine(exponent));
        ExactBody {
            polyhedron,
            centre: DyadicVector::from_doubles(polyhedron.centre.into()),
            rotation: rows.map(|row| row.components),
            rotation_exponent: exponent,
            translation: DyadicVector::from_doubles(pose.translation().into()),
        }
    }

    pub fn vertex_count(&self) -> usize {
        self.polyhedron.vertices.len()
    }

    /// World coordinates of a vertex.
    pub fn world_vertex(&self, vertex: u32) -> DyadicVector {
        let position = self.polyhedron.vertices[vertex as usize].position;
        let local = self.centre.clone().sum(DyadicVector::from_doubles(position.into()));
        let rotated = DyadicVector {
            components: [0, 1, 2].map(|k| dot(&self.rotation[k], &local.components)),
            exponent: self.rotation_exponent + local.exponent,
        };
        rotated.sum(self.translation.clone())
    }

    /// Rᵀ·d, up to a positive factor: the world direction d mapped *into* the body. d·(R·o + T) and (Rᵀd)·o differ by a constant,
    /// for any R.
    pub fn local_direction(&self, d: &IntVector) -> LocalDirection {
        let r = &self.rotation;
        let exact = [0, 1, 2].map(|k| &r[0][k] * &d[0] + &r[1][k] * &d[1] + &r[2][k] * &d[2]);
        LocalDirection { rounded: leading_bits(&exact), exact }
    }

    /// A vertex of largest value along `direction`, by hill climbing from `start` over the triangulated exact hull.
    ///
    /// Every comparison is exact, so the climb ends. It ends at a global maximum: at an extreme vertex and inside an edge the
    /// neighbours span the cone of the hull; inside a face they span its plane, so that all of them tie only if the direction is
    /// perpendicular to the face, outward (a maximum) or inward (the *minimum*: any vertex off the plane decides).
    pub fn support(&self, start: u32, direction: &LocalDirection) -> u32 {
        let mut vertex = start;
        loop {
            let mut best = vertex;
            let mut all_tie = true;
            for head in self.polyhedron.neighbour_blocks(vertex).flat_map(|block| block.head) {
                match self.rise(best, head, direction) {
                    Ordering::Equal => continue,
                    Ordering::Greater => best = head,
                    Ordering::Less => {}
                }
                all_tie = false;
            }
            if all_tie && self.polyhedron.dimension == 3 {
                let off_plane = (0..self.vertex_count() as u32)
                    .find(|&v| self.rise(vertex, v, direction).is_ne())
                    .unwrap_or(vertex);
                if self.rise(vertex, off_plane, direction).is_gt() {
                    best = off_plane;
                }
            }
            if best == vertex {
                return vertex;
            }
            vertex = best;
        }
    }

    /// The vertex of largest value along `direction`, among all.
    pub fn support_of_all(&self, direction: &LocalDirection) -> u32 {
        let higher = |best: u32, vertex: u32| if self.rise(best, vertex, direction).is_gt() { vertex } else { best };
        (0..self.vertex_count() as u32).fold(0, higher)
    }

    /// direction·head against direction·tail: in doubles where their error bound allows, else in integers.
    fn rise(&self, tail: u32, head: u32, direction: &LocalDirection) -> Ordering {
        if tail == head {
            return Ordering::Equal;
        }
        let o = &self.polyhedron.vertices[tail as usize].position;
        let p = &self.polyhedron.vertices[head as usize].position;
        let t = p - o;
        let spread = t.x.abs() + t.y.abs() + t.z.abs();
        if (SMALLEST_FOR_DOUBLES..=LARGEST_FOR_DOUBLES).contains(&spread) {
            // With |g| ≤ 2⁶³ a component: each rounded g misses by 1 + v|g|, each difference by v, each product by v, the two
            // sums by 2v, together less than (6.1v·2⁶³ + 1)Σ|t| < 12500 Σ|t|, in any rounding direction, with v = 2u. In this
            // range nothing overflows, to +∞ or the largest double; the part flushed to 0 changes a product by 2⁶³·2⁻¹⁰²² at
            // most.
            let value = direction.rounded.dot(&t);
            if value.abs() > 16384.0 * spread {
                return value.total_cmp(&0.0);
            }
        }
        dot(&direction.exact, &exact_difference(p, o)).cmp(&IBig::ZERO)
    }
}

/// A positive multiple of p − o.
fn exact_difference(p: &Vector, o: &Vector) -> IntVector {
    DyadicVector::from_doubles((*p).into()).difference(DyadicVector::from_doubles((*o).into())).components
}
