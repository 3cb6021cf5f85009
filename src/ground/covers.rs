//! What lies on the rims of a ground: where triangles overlap, or a side meets the middle of another (a T-junction), or two grounds
//! were made one along a seam, a side has no twin and still the surface does not end there.

use super::layout::GroundLayout;
use super::tree::{FOUR, FourBoxes, NodeBounds, Visit};
use super::triangles::{NONE, previous};
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
    pub fn new(layout: &GroundLayout) -> Result<Covers> {
        let (mut covers, mut around) = (Covers::default(), Vec::new());
        for half_edge in 0..3 * layout.triangle_count() as u32 {
            if layout.twin(half_edge) != NONE || layout.is_left_out(half_edge / 3) {
                continue;
            }
            let [tail, head] = layout.ends(half_edge);
            let near = NEAR * (head - tail).norm();
            // Two places on the side, in no simple ratio.
            for part in [0.4142, 0.6180] {
                let point = tail + (head - tail) * part;
                Holding { layout, half_edge, own: &[half_edge / 3], point, near, found: &mut covers.sides }.find()?;
            }
            around.clear();
            let mut at = half_edge;
            while at != NONE {
                push(&mut around, at / 3)?;
                at = layout.twin(previous(at));
            }
            Holding { layout, half_edge, own: &around, point: tail, near, found: &mut covers.corners }.find()?;
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
    layout: &'a GroundLayout,
    half_edge: u32,
    /// Those that do not count.
    own: &'a [u32],
    point: Vector,
    near: f64,
    found: &'a mut Vec<(u32, u32)>,
}

impl Holding<'_> {
    fn find(mut self) -> Result<()> {
        self.layout.walk(&mut self)
    }

    fn holds(&self, triangle: u32) -> bool {
        let normal = self.layout.normal(triangle);
        (0..3).all(|k| {
            let [tail, head] = self.layout.ends(3 * triangle + k);
            let (to, inward) = (self.point - tail, normal.cross(&(head - tail)));
            normal.dot(&to).abs() <= self.near && inward.dot(&to) >= -self.near * inward.norm()
        })
    }
}

impl Visit for Holding<'_> {
    fn keys(&self, boxes: &FourBoxes) -> [f64; FOUR] {
        NodeBounds { lower: self.point, upper: self.point }.gaps(boxes)
    }

    fn goes_to(&mut self, _: &NodeBounds, gap: f64) -> bool {
        gap <= self.near
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        if !self.own.contains(&triangle) && self.holds(triangle) {
            push(self.found, (self.half_edge, triangle))?;
        }
        Ok(true)
    }
}
