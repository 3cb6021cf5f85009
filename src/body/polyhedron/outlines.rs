//! The corners of faces and contact faces, side by side, for manifolds.

use super::fan::PointBlock;
use super::planes::PlaneBlock;
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::copied;

/// The corners of the faces of a body with an interior and at most [`MOST_IN_BLOCKS`](super::MOST_IN_BLOCKS) vertices; of larger
/// ones the first two numbers, of flat ones nothing. About 28 bytes a corner of a face.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outlines {
    /// The mean of the vertices, in centred coordinates: each of its sums is rounded.
    pub middle: Vector,
    /// The length of the shortest side.
    pub shortest: f64,
    /// The first block of each face, of each contact face, and the end; empty where there are none.
    pub starts: Vec<u32>,
    /// Positions of a face's corners in the order of its sides; its last block repeats its last corner.
    pub blocks: Vec<PointBlock>,
    /// The vertices, as in `blocks`.
    pub vertices: Vec<[u32; 4]>,
    /// The sides of contact faces, inside positive, as the last of `blocks`; other faces have their own.
    pub contact_sides: Vec<PlaneBlock>,
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
            contact_sides: copied(&self.contact_sides)?,
        })
    }

    /// Memory held, in bytes.
    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.starts[..])
            + size_of_val(&self.blocks[..])
            + size_of_val(&self.vertices[..])
            + size_of_val(&self.contact_sides[..])
    }

    /// Whether there are none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }

    /// The blocks of a patch's corners, faces before contact faces; none of one that there is not.
    #[inline(always)]
    pub fn corners(&self, patch: u32) -> (&[PointBlock], &[[u32; 4]]) {
        let at = |place: usize| self.starts.get(place).copied().unwrap_or(u32::MAX) as usize;
        let range = at(patch as usize)..at(patch as usize + 1);
        (self.blocks.get(range.clone()).unwrap_or(&[]), self.vertices.get(range).unwrap_or(&[]))
    }

    /// The plane of a contact face's side, behind so many faces.
    #[inline(always)]
    pub fn contact_side(&self, faces: u32, contact: u32, side: usize) -> [f64; 4] {
        let first = self.starts[(faces + contact) as usize] - self.starts[faces as usize];
        let (block, lane) = (&self.contact_sides[first as usize + side / 4], side % 4);
        [block.x[lane], block.y[lane], block.z[lane], block.offset[lane]]
    }
}
