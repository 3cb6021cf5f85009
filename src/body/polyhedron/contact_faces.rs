//! Faces for manifolds: faces that are one up to the noise of the input's coordinates count as one. Exact queries do not look
//! here.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::copied;

/// The faces that merged ones become where coordinates are off by up to a noise; empty where all merged faces stay as they are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactFaces {
    /// A bound of a coordinate's error.
    pub noise: f64,
    /// Those that differ from merged faces.
    pub faces: Vec<ContactFace>,
    /// Corners of all: for each, counter-clockwise seen from outside, no three on a line up to the noise.
    pub corners: Vec<u32>,
    /// A vertex and a contact face whose slab holds it, ascending.
    pub at_vertices: Vec<[u32; 2]>,
    /// The fate of each merged face; empty if `faces` is.
    pub parts: Vec<FacePart>,
}

/// A polygon through hull vertices in a thin slab below a support plane.
///
/// The slab holds the polygon's vertices, and nothing of the body is above it. So the surface over their hull, seen along the
/// normal, lies in the slab, whichever vertices they are: that is all that a gap's interval rests on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactFace {
    /// Outward, a unit vector up to rounding; the slab's planes are those of these doubles.
    pub normal: Vector,
    /// The product of normal and position in the middle of the slab, right to 8uρ.
    pub middle: f64,
    /// At least half the slab's thickness.
    pub slack: f64,
    /// Start of its corners.
    pub first_corner: u32,
    /// How many there are.
    pub corner_count: u32,
    /// The caller's lowest polygon in it.
    pub label: u32,
}

/// The fate of a merged face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FacePart {
    /// It is a face of its own.
    Whole,
    /// A contact face has taken it in.
    Joined,
    /// So thin that its normal says nothing.
    Sliver,
}

impl ContactFaces {
    /// A copy.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(super) fn copy(&self) -> Result<ContactFaces> {
        Ok(ContactFaces {
            noise: self.noise,
            faces: copied(&self.faces)?,
            corners: copied(&self.corners)?,
            at_vertices: copied(&self.at_vertices)?,
            parts: copied(&self.parts)?,
        })
    }

    /// Memory held, in bytes.
    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&self.faces[..])
            + size_of_val(&self.corners[..])
            + size_of_val(&self.at_vertices[..])
            + size_of_val(&self.parts[..])
    }

    /// Those whose slab holds a vertex, ascending.
    pub fn at(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let first = self.at_vertices.partition_point(|[v, _]| *v < vertex);
        self.at_vertices[first..].iter().take_while(move |[v, _]| *v == vertex).map(|[_, face]| *face)
    }

    /// The fate of a merged face.
    pub fn part(&self, merged: u32) -> FacePart {
        self.parts.get(merged as usize).copied().unwrap_or(FacePart::Whole)
    }
}
