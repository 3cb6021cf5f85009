//! The vertex of a body nearest to a point, as the start of marching: from its table, or among all vertices where these are few.
//!
//! Points are relative to the body's centre of mass, as multiples of its radius.

use crate::base::math::Vector;
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::lookup::Shells;

/// Finds vertices of a body.
pub trait NearestVertex {
    /// A vertex near a point.
    fn nearest(&self, point: [f32; 3]) -> u32;

    /// A vertex nearly farthest in a direction.
    fn farthest(&self, direction: [f32; 3]) -> u32;

    /// The position of a vertex; the fourth number is 0.
    fn position(&self, vertex: u32) -> [f32; 4];

    /// See [`Shells::rounds`].
    fn rounds(&self) -> u32;

    /// See [`Shells::outward`]; with few vertices, the nearest one does not tell on which side of the body a point is.
    fn outward(&self) -> Option<&[[f32; 3]; 3]>;
}

impl NearestVertex for Shells {
    #[inline(always)]
    fn nearest(&self, point: [f32; 3]) -> u32 {
        Shells::nearest(self, point)
    }

    #[inline(always)]
    fn farthest(&self, direction: [f32; 3]) -> u32 {
        Shells::farthest(self, direction)
    }

    #[inline(always)]
    fn position(&self, vertex: u32) -> [f32; 4] {
        Shells::position(self, vertex)
    }

    #[inline(always)]
    fn rounds(&self) -> u32 {
        self.rounds
    }

    #[inline(always)]
    fn outward(&self) -> Option<&[[f32; 3]; 3]> {
        Some(&self.outward)
    }
}

/// A body of few vertices.
pub struct AllVertices<'a> {
    /// The body; the square of its radius is a number.
    pub polyhedron: &'a Polyhedron,
    /// See [`Shells::rounds`].
    pub rounds: u32,
}

impl AllVertices<'_> {
    #[inline(always)]
    fn centre_of_mass(&self) -> Vector {
        self.polyhedron.mass.centre_of_mass - self.polyhedron.centre
    }
}

impl NearestVertex for AllVertices<'_> {
    #[inline(always)]
    fn nearest(&self, point: [f32; 3]) -> u32 {
        let point = Vector::from(point.map(f64::from)) * self.polyhedron.mass.radius + self.centre_of_mass();
        let mut best = (f64::INFINITY, 0);
        for (v, vertex) in self.polyhedron.vertices.iter().enumerate() {
            let square = (vertex.position - point).norm_squared();
            if square < best.0 {
                best = (square, v as u32);
            }
        }
        best.1
    }

    #[inline(always)]
    fn farthest(&self, direction: [f32; 3]) -> u32 {
        let direction = Vector::from(direction.map(f64::from));
        let mut best = (f64::NEG_INFINITY, 0);
        for (v, vertex) in self.polyhedron.vertices.iter().enumerate() {
            let height = vertex.position.dot(&direction);
            if height > best.0 {
                best = (height, v as u32);
            }
        }
        best.1
    }

    #[inline(always)]
    fn position(&self, vertex: u32) -> [f32; 4] {
        let position = &self.polyhedron.vertices[vertex as usize].position;
        let p = (position - self.centre_of_mass()) / self.polyhedron.mass.radius;
        [p.x as f32, p.y as f32, p.z as f32, 0.0]
    }

    #[inline(always)]
    fn rounds(&self) -> u32 {
        self.rounds
    }

    #[inline(always)]
    fn outward(&self) -> Option<&[[f32; 3]; 3]> {
        None
    }
}
