//! The faces' corners, side by side, for bodies that rest on each other.

use super::fan::PointBlock;
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::copied;

/// The corners of the faces of a body with an interior and at most [`MOST_IN_BLOCKS`](super::MOST_IN_BLOCKS) vertices; of others
/// nothing. About 28 bytes a corner of a face.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outlines {
    /// The mean of the vertices, in centred coordinates: each of its sums is rounded.
    pub middle: Vector,
    /// The length of the shortest side.
    pub shortest: f64,
    /// The first block of each face, and the end; empty where there are none.
    pub starts: Vec<u32>,
    /// Positions of a face's corners in the order of its sides; its last block repeats its last corner.
    pub blocks: Vec<PointBlock>,
    /// The vertices, as in `blocks`.
    pub vertices: Vec<[u32; 4]>,
}

impl Outlines {
    /// A copy.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(super) fn copy(&self) -> Result<Outlines> {
        Ok(Outlines {
            middle: self.middle,
            shortest: self.shortest,
            starts: copied(&self.starts)?,
            blocks: copied(&self.blocks)?,
            vertices: copied(&self.vertices)?,
        })
    }

    /// Memory held, in bytes.
    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.starts[..]) + size_of_val(&self.blocks[..]) + size_of_val(&self.vertices[..])
    }

    /// Whether there are none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }

    /// The blocks of a face's corners; none of a face that there is not.
    #[inline(always)]
    pub fn corners(&self, face: u32) -> (&[PointBlock], &[[u32; 4]]) {
        let at = |place: usize| self.starts.get(place).copied().unwrap_or(u32::MAX) as usize;
        let range = at(face as usize)..at(face as usize + 1);
        (self.blocks.get(range.clone()).unwrap_or(&[]), self.vertices.get(range).unwrap_or(&[]))
    }
}
