//! The polytope itself: vertices and triangles.

use crate::base::math::Vector;
use crate::placed::exact::VertexPair;

/// A triangle that is no good: the distance of its plane.
pub const NO_PLANE: f64 = -f64::MAX;

/// A cycle of triangles over differences of vertices, with room for V vertices and T − 4 triangles: these are evaluated in fours.
/// (Arrays of known length: with slices each access would load pointer and length.)
pub struct Polytope<const V: usize, const T: usize> {
    /// Vertices; triangles need not use all.
    pub vertex_count: usize,
    /// Triangles in use.
    pub triangle_count: usize,
    /// The pair of vertices whose difference each vertex is.
    pub pairs: [VertexPair; V],
    /// The computed differences; the fourth number is any.
    pub positions: [[f64; 4]; V],
    /// Three vertices, counter-clockwise from outside; the fourth is any.
    pub corners: [[u8; 4]; T],
    /// x, y and z of the outward normals, of unit length as computed.
    pub normals: [[f64; T]; 3],
    /// A lower bound of the signed distance of each triangle's plane from the origin, rounding included, or [`NO_PLANE`].
    pub distances: [f64; T],
    /// 1 where the determinant of the corners, as computed, is provably positive.
    pub certain: [u8; T],
}

impl<const V: usize, const T: usize> Polytope<V, T> {
    /// How many triangles there is room for.
    pub const TRIANGLE_ROOM: usize = T - 4;

    /// An empty one. (A function would fill each array elsewhere and copy it.)
    pub const EMPTY: Polytope<V, T> = {
        assert!(V <= 255 && T > 8, "corners are bytes");
        Polytope {
            vertex_count: 0,
            triangle_count: 0,
            pairs: [[0; 2]; V],
            positions: [[0.0; 4]; V],
            corners: [[0; 4]; T],
            normals: [[0.0; T]; 3],
            distances: [0.0; T],
            certain: [0; T],
        }
    };

    /// Without vertices and triangles.
    pub fn clear(&mut self) {
        self.vertex_count = 0;
        self.triangle_count = 0;
    }

    /// A vertex.
    #[inline(always)]
    pub fn position(&self, vertex: u8) -> Vector {
        let [x, y, z, _] = self.positions[usize::from(vertex)];
        Vector::new(x, y, z)
    }

    /// The corners of a triangle.
    #[inline(always)]
    pub fn corners_of(&self, triangle: usize) -> [u8; 3] {
        let [a, b, c, _] = self.corners[triangle];
        [a, b, c]
    }

    /// The positions of the corners of a triangle.
    #[inline(always)]
    pub fn positions_of(&self, triangle: usize) -> [Vector; 3] {
        self.corners_of(triangle).map(|corner| self.position(corner))
    }

    /// The vertex pairs of a triangle's corners.
    #[inline(always)]
    pub fn pairs_of(&self, triangle: usize) -> [VertexPair; 3] {
        self.corners_of(triangle).map(|corner| self.pairs[usize::from(corner)])
    }

    /// The normal of a triangle.
    #[inline(always)]
    pub fn normal(&self, triangle: usize) -> Vector {
        let [x, y, z] = &self.normals;
        Vector::new(x[triangle], y[triangle], z[triangle])
    }

    /// The vertex that is the difference of a pair.
    #[inline(always)]
    pub fn find(&self, pair: VertexPair) -> Option<u8> {
        // Mostly there is none: all are compared, many at a time, before one is looked for.
        let is_pair = |own: &VertexPair| (own[0] == pair[0]) & (own[1] == pair[1]);
        let pairs = &self.pairs[..self.vertex_count];
        if !pairs.iter().fold(false, |found, own| found | is_pair(own)) {
            return None;
        }
        pairs.iter().position(is_pair).map(|vertex| vertex as u8)
    }

    /// Whether a vertex is a corner.
    #[inline(always)]
    pub fn has_triangle(&self, vertex: u8) -> bool {
        let mut found = false;
        for &[a, b, c, _] in &self.corners[..self.triangle_count] {
            found |= (a == vertex) | (b == vertex) | (c == vertex);
        }
        found
    }

    /// Adds a vertex; `None` where there is no room.
    #[inline(always)]
    pub fn add_vertex(&mut self, pair: VertexPair, position: [f64; 4]) -> Option<u8> {
        let vertex = self.vertex_count;
        if vertex >= V {
            return None;
        }
        self.vertex_count = vertex + 1;
        self.pairs[vertex] = pair;
        self.positions[vertex] = position;
        Some(vertex as u8)
    }
}
