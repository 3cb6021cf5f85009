//! Room to find contacts in, kept from query to query. No answer depends on its contents.

use crate::pair::{Manifold, ManifoldPoint};
use crate::shape::TriangleShape;

/// The room.
#[derive(Debug, Default)]
pub(super) struct Room {
    /// Made on first need.
    pub triangle: Option<TriangleShape>,
    /// The touches that a walk has found, triangle by triangle …
    pub touches: Vec<Touch>,
    /// … and the points of it.
    pub points: Vec<ManifoldPoint>,
    pub grouping: Grouping,
}

/// A contact of one triangle, with its points behind each other.
#[derive(Debug)]
pub(super) struct Touch {
    pub triangle: u32,
    pub manifold: Manifold,
    pub first_point: usize,
}

/// Room to join contacts in.
#[derive(Debug, Default)]
pub(super) struct Grouping {
    pub is_taken: Vec<bool>,
    /// The points of one contact, and their ids with their places.
    pub own: Vec<ManifoldPoint>,
    pub ids: Vec<(u64, usize)>,
}
