//! What lies on the rims of a ground: where triangles overlap, or a side meets the middle of another (a T-junction), or two grounds
//! were made one along a seam, a side has no twin and still the surface does not end there.

use super::tree::{GroundTree, NodeBounds, Visit};
use super::triangles::{GroundTriangles, NONE, next, previous};
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{copied, push};

/// How far a point may be from a triangle and lie on it, relative to the side that it is of, 2⁻²⁰.
const NEAR: f64 = 1.0 / (1 << 20) as f64;

/// The triangles on which sides and corners of rims lie, by half-edges without a twin; of a corner it is the one that begins there.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Covers {
    sides: Vec<(u32, u32)>,
    corners: Vec<(u32, u32)>,
}

impl Covers {
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(triangles: &GroundTriangles, tree: &GroundTree) -> Result<Covers> {
        let (mut covers, mut around) = (Covers::default(), Vec::new());
        for half_edge in 0..3 * triangles.records.len() as u32 {
            if triangles.twin(half_edge) != NONE || triangles.normal(half_edge / 3) == Vector::zeros() {
                continue;
            }
            let [tail, head] = [triangles.tail(half_edge), triangles.tail(next(half_edge))];
            let near = NEAR * (head - tail).norm();
            // Two places on the side, in no simple ratio.
            for part in [0.4142, 0.6180] {
                let point = tail + (head - tail) * part;
                Holding { triangles, key: half_edge, own: &[half_edge / 3], point, near, found: &mut covers.sides }
                    .find(tree)?;
            }
            around.clear();
            let mut at = half_edge;
            while at != NONE {
                push(&mut around, at / 3)?;
                at = triangles.twin(previous(at));
            }
            Holding { triangles, key: half_edge, own: &around, point: tail, near, found: &mut covers.corners }
                .find(tree)?;
        }
        covers.sides.sort_unstable();
        covers.sides.dedup();
        Ok(covers)
    }

    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn try_clone(&self) -> Result<Covers> {
        Ok(Covers { sides: copied(&self.sides)?, corners: copied(&self.corners)? })
    }

    /// Memory held beside the struct, in bytes.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.sides[..]) + size_of_val(&self.corners[..])
    }

    pub fn of_side(&self, half_edge: u32) -> &[(u32, u32)] {
        those_of(&self.sides, half_edge)
    }

    pub fn of_corner(&self, half_edge: u32) -> &[(u32, u32)] {
        those_of(&self.corners, half_edge)
    }
}

fn those_of(all: &[(u32, u32)], half_edge: u32) -> &[(u32, u32)] {
    let first = all.partition_point(|(key, _)| *key < half_edge);
    let rest = &all[first..];
    &rest[..rest.partition_point(|(key, _)| *key == half_edge)]
}

/// A search for the triangles on which a point lies.
struct Holding<'a> {
    triangles: &'a GroundTriangles,
    key: u32,
    /// Those that do not count.
    own: &'a [u32],
    point: Vector,
    near: f64,
    found: &'a mut Vec<(u32, u32)>,
}

impl Holding<'_> {
    fn find(mut self, tree: &GroundTree) -> Result<()> {
        tree.walk(&NodeBounds { lower: self.point, upper: self.point }, &mut self)
    }

    fn holds(&self, triangle: u32) -> bool {
        let normal = self.triangles.normal(triangle);
        (0..3).all(|k| {
            let [tail, head] = [3 * triangle + k, next(3 * triangle + k)].map(|corner| self.triangles.tail(corner));
            let (to, inward) = (self.point - tail, normal.cross(&(head - tail)));
            normal.dot(&to).abs() <= self.near && inward.dot(&to) >= -self.near * inward.norm()
        })
    }
}

impl Visit for Holding<'_> {
    fn goes_to(&mut self, _: &NodeBounds, gap: f64) -> bool {
        gap <= self.near
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        if !self.own.contains(&triangle) && self.holds(triangle) {
            push(self.found, (self.key, triangle))?;
        }
        Ok(true)
    }
}
