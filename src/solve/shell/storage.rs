//! The shell itself: vertices, triangles, and how these are joined.

use crate::base::math::Vector;
use crate::solve::exact::VertexPair;

/// A half-edge: 4·(triangle) + k runs from corner k to the next one, k < 3.
pub type HalfEdge = u16;

/// A triangle that is no good: the distance of its plane.
pub const NO_PLANE: f64 = -f64::MAX;

/// Room for a shell. Triangles are evaluated in fours: of `T` the last four are never in use.
pub struct Storage<const V: usize, const T: usize> {
    pairs: [VertexPair; V],
    positions: [[f64; 4]; V],
    uses: [u16; V],
    corners: [[u8; 4]; T],
    twins: [[HalfEdge; 4]; T],
    normals: [[f64; T]; 3],
    distances: [f64; T],
    heights: [f64; T],
    certain: [u8; T],
    marks: [u8; T],
    region: [u16; T],
    rim: [RimEdge; T],
}

impl<const V: usize, const T: usize> Storage<V, T> {
    /// For no shell yet.
    #[inline(always)]
    pub fn empty() -> Storage<V, T> {
        const { assert!(V <= 255 && T <= 4096 && T > 8, "corners are bytes, half-edges two bytes") };
        Storage {
            pairs: [[0; 2]; V],
            positions: [[0.0; 4]; V],
            uses: [0; V],
            corners: [[0; 4]; T],
            twins: [[0; 4]; T],
            normals: [[0.0; T]; 3],
            distances: [0.0; T],
            heights: [0.0; T],
            certain: [0; T],
            marks: [0; T],
            region: [0; T],
            rim: [RimEdge::default(); T],
        }
    }

    /// An empty shell in this room.
    #[inline(always)]
    pub fn shell(&mut self) -> Shell<'_> {
        let [x, y, z] = &mut self.normals;
        Shell {
            vertex_count: 0,
            triangle_count: 0,
            pairs: &mut self.pairs,
            positions: &mut self.positions,
            uses: &mut self.uses,
            corners: &mut self.corners,
            twins: &mut self.twins,
            normals: [x, y, z],
            distances: &mut self.distances,
            heights: &mut self.heights,
            certain: &mut self.certain,
            marks: &mut self.marks,
            region: &mut self.region,
            rim: &mut self.rim,
        }
    }
}

/// A closed surface of triangles over differences of vertices.
pub struct Shell<'a> {
    /// Entries of `pairs` that may be in use.
    pub vertex_count: usize,
    /// Triangles in use.
    pub triangle_count: usize,
    /// Of which vertices each vertex is the difference.
    pub pairs: &'a mut [VertexPair],
    /// The computed differences; the fourth number is any.
    pub positions: &'a mut [[f64; 4]],
    /// How many triangles each vertex has; vertices without any are free.
    pub uses: &'a mut [u16],
    /// Three vertices, counter-clockwise from outside.
    pub corners: &'a mut [[u8; 4]],
    /// The opposite of each half-edge.
    pub twins: &'a mut [[HalfEdge; 4]],
    /// x, y and z of the outward normals, of unit length as computed.
    pub normals: [&'a mut [f64]; 3],
    /// A lower bound of the signed distance of each triangle's plane from the origin, rounding included, or [`NO_PLANE`].
    pub distances: &'a mut [f64],
    /// How high the centre of the differences is below each plane, as computed.
    pub heights: &'a mut [f64],
    /// 1 where the determinant of the corners, as computed, is positive for sure.
    pub certain: &'a mut [u8],
    /// Scratch of surgery: bit 7 for a triangle of the region, bits 0 to 2 for half-edges of it that have been walked.
    pub(super) marks: &'a mut [u8],
    /// The triangles of the region.
    pub(super) region: &'a mut [u16],
    /// The edges around the region.
    pub(super) rim: &'a mut [RimEdge],
}

/// An edge of the region's rim, with the triangle that is to stand on it.
#[derive(Debug, Clone, Copy, Default)]
pub struct RimEdge {
    pub tail: u8,
    pub head: u8,
    /// Whether the next edge of the rim begins another loop.
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

impl Shell<'_> {
    /// How many vertices there is room for.
    pub fn vertex_room(&self) -> usize {
        self.pairs.len()
    }

    /// How many triangles there is room for.
    #[inline(always)]
    pub fn triangle_room(&self) -> usize {
        self.corners.len() - 4
    }

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

    /// Where the corners of a triangle are.
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
        self.corners[triangle_of(half_edge)][usize::from(half_edge & 3)]
    }

    /// The opposite of a half-edge.
    #[inline(always)]
    pub fn twin(&self, half_edge: HalfEdge) -> HalfEdge {
        self.twins[triangle_of(half_edge)][usize::from(half_edge & 3)]
    }

    /// Joins two half-edges.
    #[inline(always)]
    pub fn join(&mut self, first: HalfEdge, second: HalfEdge) {
        self.twins[triangle_of(first)][usize::from(first & 3)] = second;
        self.twins[triangle_of(second)][usize::from(second & 3)] = first;
    }

    /// The vertex in use that is the difference of a pair.
    #[inline(always)]
    pub fn find(&self, pair: VertexPair) -> Option<u8> {
        let mut pairs = self.pairs[..self.vertex_count].iter().zip(&self.uses[..self.vertex_count]);
        pairs.position(|(own, uses)| *own == pair && *uses > 0).map(|vertex| vertex as u8)
    }

    /// A vertex that no triangle has yet; `None` where there is no room.
    #[inline(always)]
    pub fn add_vertex(&mut self, pair: VertexPair, position: [f64; 4]) -> Option<u8> {
        let free = self.uses[..self.vertex_count].iter().position(|uses| *uses == 0);
        let vertex = free.unwrap_or(self.vertex_count);
        if vertex >= self.vertex_room() {
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

    /// Whether a shell of at most 128 triangles is a closed oriented cycle: half-edges are in pairs, and the ends of each are those
    /// of its twin. Of corners and twins nothing is known.
    #[inline(always)]
    pub fn is_closed(&self) -> bool {
        const MOST: usize = 128;
        const NONE: u32 = u32::MAX;
        // Twin, tail and head of each half-edge, in 11, 8 and 8 bits. No half-edge is like what is not in use.
        let mut told = [[NONE; 4]; MOST];
        let surface = self.corners.iter().zip(&*self.twins).take(self.triangle_count);
        for (told, (&[a, b, c, _], &[x, y, z, _])) in told.iter_mut().zip(surface) {
            let tell =
                |twin: HalfEdge, tail: u8, head: u8| u32::from(twin) | u32::from(tail) << 11 | u32::from(head) << 19;
            *told = [tell(x, a, b), tell(y, b, c), tell(z, c, a), NONE];
        }
        let mut is_open = self.triangle_count > MOST;
        for (triangle, own) in told.iter().take(self.triangle_count).enumerate() {
            for (k, &own) in own[..3].iter().enumerate() {
                let twin = own as usize & 2047;
                let (tail, head) = (own >> 11 & 255, own >> 19);
                let expected = (4 * triangle + k) as u32 | head << 11 | tail << 19;
                is_open |= told[twin / 4 % MOST][twin % 4] != expected || twin / 4 >= MOST;
            }
        }
        !is_open
    }
}
