//! How the triangles of a ground are kept: as a soup, or as heights.

use super::grid::GroundGrid;
use super::tree::{NodeBounds, Visit};
use super::triangles::{Soup, next};
use crate::base::error::Result;
use crate::base::math::Vector;

/// The triangles of a ground.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum GroundLayout {
    Soup(Soup),
    Grid(GroundGrid),
}

impl GroundLayout {
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn try_clone(&self) -> Result<GroundLayout> {
        Ok(match self {
            GroundLayout::Soup(soup) => GroundLayout::Soup(soup.try_clone()?),
            GroundLayout::Grid(grid) => GroundLayout::Grid(grid.try_clone()?),
        })
    }

    /// Memory held beside the struct, in bytes.
    pub fn heap_bytes(&self) -> usize {
        match self {
            GroundLayout::Soup(soup) => soup.heap_bytes(),
            GroundLayout::Grid(grid) => grid.heap_bytes(),
        }
    }

    /// Those included that are left out.
    pub fn triangle_count(&self) -> usize {
        match self {
            GroundLayout::Soup(soup) => soup.triangle_count(),
            GroundLayout::Grid(grid) => grid.triangle_count(),
        }
    }

    pub fn vertex_count(&self) -> usize {
        match self {
            GroundLayout::Soup(soup) => soup.vertex_count(),
            GroundLayout::Grid(grid) => grid.vertex_count(),
        }
    }

    pub fn vertex(&self, vertex: u32) -> Vector {
        match self {
            GroundLayout::Soup(soup) => soup.vertex(vertex),
            GroundLayout::Grid(grid) => grid.vertex(vertex),
        }
    }

    /// The vertices of a triangle, all one of a triangle that is left out.
    pub fn corners(&self, triangle: u32) -> [u32; 3] {
        match self {
            GroundLayout::Soup(soup) => soup.corners(triangle),
            GroundLayout::Grid(grid) => grid.corners(triangle),
        }
    }

    pub fn is_left_out(&self, triangle: u32) -> bool {
        let corners = self.corners(triangle);
        corners[0] == corners[1]
    }

    /// The unit normal of a triangle, out of its front; 0 of one that is left out.
    pub fn normal(&self, triangle: u32) -> Vector {
        match self {
            GroundLayout::Soup(soup) => soup.normal(triangle),
            GroundLayout::Grid(grid) => grid.normal(triangle),
        }
    }

    /// Start of a half-edge of a triangle that is not left out.
    pub fn tail(&self, half_edge: u32) -> Vector {
        match self {
            GroundLayout::Soup(soup) => soup.vertex(soup.corners(half_edge / 3)[half_edge as usize % 3]),
            GroundLayout::Grid(grid) => grid.tail(half_edge),
        }
    }

    /// The corners of a triangle that is not left out.
    pub fn points(&self, triangle: u32) -> [Vector; 3] {
        match self {
            GroundLayout::Soup(soup) => soup.corners(triangle).map(|v| soup.vertex(v)),
            GroundLayout::Grid(grid) => grid.points(triangle),
        }
    }

    /// The ways along the edges at the start of a half-edge, where that is within a surface over a plane, whose triangles look up;
    /// `None` where it may not be.
    pub fn ways_around(&self, half_edge: u32) -> Option<[Vector; 6]> {
        match self {
            GroundLayout::Soup(_) => None,
            GroundLayout::Grid(grid) => grid.ways_around(half_edge),
        }
    }

    /// Both ends of a half-edge of a triangle that is not left out.
    pub fn ends(&self, half_edge: u32) -> [Vector; 2] {
        [self.tail(half_edge), self.tail(next(half_edge))]
    }

    /// The half-edge on the other side, or [`NONE`](super::triangles::NONE).
    pub fn twin(&self, half_edge: u32) -> u32 {
        match self {
            GroundLayout::Soup(soup) => soup.twin(half_edge),
            GroundLayout::Grid(grid) => grid.twin(half_edge),
        }
    }

    /// The box of all triangles.
    pub fn bounds(&self) -> NodeBounds {
        match self {
            GroundLayout::Soup(soup) => *soup.tree().bounds(),
            GroundLayout::Grid(grid) => grid.bounds(),
        }
    }

    /// Goes to all triangles whose boxes have points in common with a box, and some beside them.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn overlapping(&self, body: &NodeBounds, visit: impl FnMut(u32) -> Result<()>) -> Result<()> {
        match self {
            GroundLayout::Soup(soup) => soup.tree().overlapping(body, visit),
            GroundLayout::Grid(grid) => grid.overlapping(body, visit),
        }
    }

    /// Goes to all triangles that `visit` wants.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn walk(&self, visit: &mut impl Visit) -> Result<()> {
        match self {
            GroundLayout::Soup(soup) => soup.tree().walk(visit),
            GroundLayout::Grid(grid) => grid.walk(visit),
        }
    }
}
