//! The input and the result of merging.

use crate::base::math::Vector;
use crate::body::polyhedron::triangulation::{Triangulation, next};

/// The triangles of a hull.
pub struct Triangles<'a> {
    /// Their corners and neighbours.
    pub surface: &'a Triangulation,
    /// Positions of the hull's vertices.
    pub positions: &'a [Vector],
    /// Their unit normals.
    pub normals: &'a [Vector],
    /// Sizes to order them by.
    pub areas: &'a [f64],
}

/// The faces of a hull, in order of their lowest vertex.
#[derive(Debug, Clone)]
pub struct MergedFaces {
    /// The face of each triangle.
    pub face_of: Vec<u32>,
    /// Unit normal of each face, that of a large triangle among its vertices.
    pub normals: Vec<Vector>,
    /// A half-edge on the boundary of each face, whose tail is a corner.
    pub first_half_edges: Vec<u32>,
    /// Whether a vertex is a corner of the merged faces; other vertices lie inside a face or an edge.
    pub corners: Vec<bool>,
}

impl MergedFaces {
    /// The face left of a half-edge.
    #[inline]
    pub fn left(&self, half_edge: u32) -> u32 {
        self.face_of[half_edge as usize / 3]
    }

    /// Whether two faces meet at a half-edge.
    #[inline]
    pub fn is_boundary(&self, surface: &Triangulation, half_edge: u32) -> bool {
        self.left(half_edge) != self.left(surface.twins[half_edge as usize])
    }

    /// The half-edge after `half_edge` on the boundary of its face.
    #[inline]
    pub fn next_on_boundary(&self, surface: &Triangulation, half_edge: u32) -> u32 {
        let mut h = next(half_edge);
        while !self.is_boundary(surface, h) {
            h = next(surface.twins[h as usize]);
        }
        h
    }

    /// The last half-edge of the straight edge that begins with `first` at a corner.
    pub fn last_of_edge(&self, surface: &Triangulation, first: u32) -> u32 {
        let mut h = first;
        while !self.corners[surface.head(h) as usize] {
            h = self.next_on_boundary(surface, h);
        }
        h
    }
}
