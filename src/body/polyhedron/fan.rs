//! The arrays that the depth of a small body is read from: its faces' normals as a closed fan around the sphere of directions,
//! and the corners that face them.
//!
//! The **fan** of a body is a net on the sphere of directions. Its nodes are the faces' normals, just as the doubles give them; an
//! arc joins two nodes across each edge; the arcs around a corner go round its cell. Merged and rounded as the normals are, the fan
//! is not the exact normal fan of the exact hull. It covers the sphere all the same (`build/fan.rs` proves it), and `slack` is what
//! a bound over its cells loses.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::copied;

/// Bodies of more corners have no fan: a set of corners is the bits of one number.
pub const MOST_CORNERS: usize = 64;

/// A closed surface of so many corners has no more faces.
pub const MOST_FACES: usize = 2 * MOST_CORNERS - 4;

/// Nor more edges.
pub const MOST_EDGES: usize = 3 * MOST_CORNERS - 6;

/// Four points, one in each lane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(32))]
pub struct PointBlock {
    /// First coordinates.
    pub x: [f64; 4],
    /// Second coordinates.
    pub y: [f64; 4],
    /// Third coordinates.
    pub z: [f64; 4],
}

/// The planes of four faces, one in each lane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(32))]
pub struct FaceBlock {
    /// First components of the unit normals.
    pub x: [f64; 4],
    /// Second components.
    pub y: [f64; 4],
    /// Third components.
    pub z: [f64; 4],
    /// How far the body reaches along them.
    pub reach: [f64; 4],
}

/// An edge: an arc of the fan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FanEdge {
    /// Unit vector from the first corner to the second, right to 4u in each component.
    pub direction: Vector,
    /// An upper bound of |n·R·`direction`|, apart from the rounding of `direction`, over all unit vectors n of the placed arc:
    /// those with Rᵀn in the cone of both normals, for any accepted R.
    pub lean: f64,
    /// The faces beside it, left and right.
    pub faces: [u8; 2],
    /// Its ends, as places in `corners`.
    pub corners: [u8; 2],
}

/// The fan of a body of few corners. About 32 bytes a face, 28 a corner and 40 an edge: 1 kB for a box, 13 kB at most.
#[derive(Debug, Clone, PartialEq)]
pub struct Fan {
    /// The vertices that are corners of merged faces, ascending.
    pub corners: Vec<u32>,
    /// Positions of the corners, in centred coordinates; the last block repeats the last corner.
    pub points: Vec<PointBlock>,
    /// The faces, in the order of the body's; the last block repeats the last one.
    pub planes: Vec<FaceBlock>,
    /// The edges, in the order of the body's.
    pub edges: Vec<FanEdge>,
    /// σ: the most by which a corner of a face is below its plane, which the body reaches.
    pub face_slack: f64,
    /// The greatest κσ of a corner: for a unit direction in a corner's cell no point of the body is farther along it than the
    /// corner by more than this.
    pub cell_slack: f64,
}

impl Fan {
    /// A copy.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn copy(&self) -> Result<Fan> {
        let Fan { corners, points, planes, edges, face_slack, cell_slack } = self;
        Ok(Fan {
            corners: copied(corners)?,
            points: copied(points)?,
            planes: copied(planes)?,
            edges: copied(edges)?,
            face_slack: *face_slack,
            cell_slack: *cell_slack,
        })
    }

    /// Memory held beside the struct, in bytes.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.corners[..])
            + size_of_val(&self.points[..])
            + size_of_val(&self.planes[..])
            + size_of_val(&self.edges[..])
    }
}
