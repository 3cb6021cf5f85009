//! Room to find contacts in, kept from query to query. No answer depends on its contents.

use crate::body::polyhedron::fan::PointBlock;
use crate::manifold::{Manifold, ManifoldPoint};
use crate::shape::TriangleShape;

/// The room.
#[derive(Debug, Default)]
pub(super) struct Room {
    /// Made on first need.
    pub triangle: Option<TriangleShape>,
    /// The body's vertices.
    pub vertices: Vec<PointBlock>,
    /// Triangles inside a plane that no corner of the body is over.
    pub passed: Vec<u32>,
    /// Faces of the body that look down.
    pub facing: Vec<u32>,
    /// The touches that a walk has found, triangle by triangle …
    pub touches: Vec<TriangleTouch>,
    /// … and the points of it.
    pub points: Vec<ManifoldPoint>,
    pub grouping: Grouping,
}

/// A contact of one triangle, with its points behind each other.
#[derive(Debug)]
pub(super) struct TriangleTouch {
    pub triangle: u32,
    pub manifold: Manifold,
    pub first_point: usize,
    /// How high the body's lowest vertex is along the normal.
    pub lowest: f64,
    /// The body's lowest point, if it is beside the triangle: so deep it is in it.
    pub beside: Option<ManifoldPoint>,
}

impl TriangleTouch {
    /// The least gap of its points, or of the body's lowest, as an interval.
    pub fn least_gap(&self) -> [f64; 2] {
        let Manifold { lower, upper, .. } = self.manifold;
        self.beside.map_or([lower, upper], |beside| [beside.gap_lower.min(lower), beside.gap_upper.min(upper)])
    }
}

/// A contact of triangles with one normal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joined {
    pub triangle: u32,
    pub manifold: Manifold,
    pub first_point: usize,
}

/// Room to join contacts in.
#[derive(Debug, Default)]
pub(super) struct Grouping {
    pub is_taken: Vec<bool>,
    /// The points of one contact, or of those on one side of the body; their ids with their places, or their places among all.
    pub own: Vec<ManifoldPoint>,
    pub ids: Vec<(u64, usize)>,
    pub places: Vec<usize>,
    /// Contacts that are joined, all their points, and which of these stay.
    pub joined: Vec<Joined>,
    pub gathered: Vec<ManifoldPoint>,
    pub stays: Vec<bool>,
}
