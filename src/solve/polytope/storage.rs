//! The polytope itself: vertices, triangles, and how these are joined.

use crate::base::math::Vector;
use crate::solve::exact::VertexPair;

/// A half-edge: 4·(triangle) + k runs from corner k to the next one, k < 3.
pub type HalfEdge = u16;

/// The fourth twin of a triangle, which is no half-edge's.
pub const NO_TWIN: HalfEdge = HalfEdge::MAX;

/// A triangle that is no good: the distance of its plane.
pub const NO_PLANE: f64 = -f64::MAX;

/// A closed surface of triangles over differences of vertices, with room for V vertices and T − 4 triangles: these are evaluated in
/// fours. (Arrays of known length: with slices each access would load pointer and length.)
pub struct Polytope<const V: usize, const T: usize> {
    /// Entries of `pairs` that may be in use.
    pub vertex_count: usize,
    /// Triangles in use.
    pub triangle_count: usize,
    /// The pair of vertices whose difference each vertex is.
    pub pairs: [VertexPair; V],
    /// The computed differences; the fourth number is any.
    pub positions: [[f64; 4]; V],
    /// How many triangles each vertex has; vertices without any are free.
    pub uses: [u16; V],
    /// Three vertices, counter-clockwise from outside; the fourth is any.
    pub corners: [[u8; 4]; T],
    /// The opposite of each half-edge.
    pub twins: [[HalfEdge; 4]; T],
    /// x, y and z of the outward normals, of unit length as computed.
    pub normals: [[f64; T]; 3],
    /// A lower bound of the signed distance of each triangle's plane from the origin, rounding included, or [`NO_PLANE`].
    pub distances: [f64; T],
    /// 1 where the determinant of the corners, as computed, is provably positive.
    pub certain: [u8; T],
    /// Scratch of surgery: bit 7 for a triangle of the region, bits 0 to 2 for half-edges of it that have been walked.
    pub(super) marks: [u8; T],
    /// The triangles of the region.
    pub(super) region: [u16; T],
    /// The edges around the region.
    pub(super) horizon: [HorizonEdge; T],
}

/// An edge of the region's horizon, with the triangle that is to stand on it.
#[derive(Debug, Clone, Copy)]
pub struct HorizonEdge {
    pub tail: u8,
    pub head: u8,
    /// Whether the next edge of the horizon begins another loop.
    pub ends_loop: bool,
    /// The half-edge outside the region.
    pub outer: HalfEdge,
    /// The new triangle, or [`NO_TRIANGLE`] on edges that the apex is an end of.
    pub triangle: u16,
}

/// No triangle.
pub const NO_TRIANGLE: u16 = u16::MAX;

/// The following half-edge of the same triangle.
#[inline(always)]
pub fn next(half_edge: HalfEdge) -> HalfEdge {
    if half_edge & 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The triangle of a half-edge.
#[inline(always)]
pub fn triangle_of(half_edge: HalfEdge) -> usize {
    usize::from(half_edge >> 2)
}

/// Half-edge k of a triangle.
#[inline(always)]
pub fn half_edge(triangle: usize, k: usize) -> HalfEdge {
    (4 * triangle + k) as HalfEdge
}

impl<const V: usize, const T: usize> Polytope<V, T> {
    /// How many triangles there is room for.
    pub const TRIANGLE_ROOM: usize = T - 4;

    /// An empty one. (A function would fill each array elsewhere and copy it.)
    pub const EMPTY: Polytope<V, T> = {
        assert!(V <= 255 && T <= 4096 && T > 8, "corners are bytes, half-edges two bytes");
        Polytope {
            vertex_count: 0,
            triangle_count: 0,
            pairs: [[0; 2]; V],
            positions: [[0.0; 4]; V],
            uses: [0; V],
            corners: [[0; 4]; T],
            twins: [[0; 4]; T],
            normals: [[0.0; T]; 3],
            distances: [0.0; T],
            certain: [0; T],
            marks: [0; T],
            region: [0; T],
            horizon: [HorizonEdge { tail: 0, head: 0, ends_loop: false, outer: 0, triangle: 0 }; T],
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

    /// The vertex where a half-edge begins.
    #[inline(always)]
    pub fn tail(&self, half_edge: HalfEdge) -> u8 {
        self.corners.as_flattened()[usize::from(half_edge)]
    }

    /// The opposite of a half-edge.
    #[inline(always)]
    pub fn twin(&self, half_edge: HalfEdge) -> HalfEdge {
        self.twins.as_flattened()[usize::from(half_edge)]
    }

    /// Joins two half-edges.
    #[inline(always)]
    pub fn join(&mut self, first: HalfEdge, second: HalfEdge) {
        let twins = self.twins.as_flattened_mut();
        twins[usize::from(first)] = second;
        twins[usize::from(second)] = first;
    }

    /// The vertex in use that is the difference of a pair.
    #[inline(always)]
    pub fn find(&self, pair: VertexPair) -> Option<u8> {
        // Mostly there is none: all are compared, many at a time, before one is looked for.
        let is_pair = |own: &VertexPair| (own[0] == pair[0]) & (own[1] == pair[1]);
        let pairs = &self.pairs[..self.vertex_count];
        if !pairs.iter().fold(false, |found, own| found | is_pair(own)) {
            return None;
        }
        let mut pairs = pairs.iter().zip(&self.uses[..self.vertex_count]);
        pairs.position(|(own, uses)| is_pair(own) && *uses > 0).map(|vertex| vertex as u8)
    }

    /// A vertex that no triangle has yet; `None` where there is no room.
    #[inline(always)]
    pub fn add_vertex(&mut self, pair: VertexPair, position: [f64; 4]) -> Option<u8> {
        let uses = &self.uses[..self.vertex_count];
        let is_any_free = uses.iter().fold(false, |free, uses| free | (*uses == 0));
        let free = if is_any_free { uses.iter().position(|uses| *uses == 0) } else { None };
        let vertex = free.unwrap_or(self.vertex_count);
        if vertex >= V {
            return None;
        }
        self.vertex_count = self.vertex_count.max(vertex + 1);
        self.pairs[vertex] = pair;
        self.positions[vertex] = position;
        self.uses[vertex] = 0;
        Some(vertex as u8)
    }

    /// Counts anew in how many triangles each vertex is.
    #[inline(always)]
    pub fn count_uses(&mut self) {
        self.uses[..self.vertex_count].fill(0);
        for corners in &self.corners[..self.triangle_count] {
            for corner in &corners[..3] {
                self.uses[usize::from(*corner)] += 1;
            }
        }
    }

    /// Whether the triangles are a closed oriented cycle: half-edges are in pairs, and the ends of each are those of its twin.
    /// For corners and twins nothing is known, but that the fourth corner is the first, and the fourth twin [`NO_TWIN`].
    #[inline(always)]
    pub fn is_closed(&self) -> bool {
        let (corners, twins) = (self.corners.as_flattened(), self.twins.as_flattened());
        let ends = |half_edge: usize| u16::from_le_bytes([corners[half_edge], corners[half_edge + 1]]);
        let end = (4 * self.triangle_count).min(4 * Self::TRIANGLE_ROOM);
        // Bits in which something differs.
        let mut differing = 0;
        for triangle in 0..end / 4 {
            for k in 0..3 {
                let half_edge = 4 * triangle + k;
                let twin = usize::from(twins[half_edge]);
                if twin >= end {
                    return false;
                }
                differing |= twins[twin] ^ half_edge as HalfEdge;
                differing |= ends(half_edge) ^ ends(twin).swap_bytes();
            }
        }
        differing == 0 && end == 4 * self.triangle_count
    }
}
