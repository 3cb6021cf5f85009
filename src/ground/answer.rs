//! The answer for a body that meets a ground.

use super::room::Room;
use crate::manifold::{Manifold, ManifoldPoint};

/// One contact of a body, which is object 1, with a ground: points with one normal.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct GroundContact {
    /// Its normal is out of the ground. Its outcome is that of the body and the triangles that it meets with this normal; `lower`
    /// and `upper` are the least gap of its points.
    pub manifold: Manifold,
    /// The triangle that has the least.
    pub triangle: u32,
    /// Start of the contact's points among all points.
    pub first_point: usize,
}

/// The contacts of a body with a ground, and their points. It keeps the room that they were found in, some 10 kB: once that is
/// large enough, queries that write over it ask for no memory.
#[derive(Debug, Default)]
pub struct GroundContacts {
    /// By their triangles.
    pub contacts: Vec<GroundContact>,
    /// The points of each contact, together. The face of object 2 is a triangle of the ground.
    pub points: Vec<ManifoldPoint>,
    pub(super) room: Room,
}
