//! The pair's cache of its depth: the polytope that proved it, packed, or the nearest facet of two small bodies, and the facet
//! of a pair at rest. Only this module packs and unpacks it.

use crate::base::math::Vector;
use crate::base::simd::Lanes;
use crate::body::polyhedron::Polyhedron;
use crate::depth::facets::Facet;
use crate::depth::polytope::{Polytope, SearchStart};
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;
use crate::placed::state::State;

/// Vertices of a polytope that is kept.
const MOST_VERTICES: usize = 56;

/// Triangles of a polytope that is kept: a closed surface of `MOST_VERTICES` vertices, without holes and handles, has no more.
const MOST_TRIANGLES: usize = 108;

/// A pair's memory of its last depth query. Any bytes are safe; all zero is cold. It changes how fast an answer comes, and
/// which of several least directions is said; never the verdict, and no depth beyond its interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct DepthCache {
    /// Where no polytope is kept, the single-precision bits of the direction of the least overlap, in body 1's axes.
    direction: [u32; 3],
    /// The facet of least overlap of a pair that seems to rest, by its [words](Facet::words); 0 for none. For swept bodies whose
    /// polyhedra were apart, the nearest features: [`APART`] more than the kind of their state. The bodies need not have either.
    resting: [u32; 3],
    /// The vertices. Coordinates are computed anew: what is stored could lie. Of a facet, the indices are the first pair, and the
    /// next two have the bits of its direction in body 2's axes.
    pairs: [VertexPair; MOST_VERTICES],
    triangles: [PackedTriangle; MOST_TRIANGLES],
    /// Numbers of vertices and triangles, the triangle of the least overlap, and how many triangles the last first polytope came
    /// to. Where a facet is kept, which is where there are no triangles, the first is its kind, and the third says whether the
    /// objects overlapped.
    counts: [u8; 4],
}

/// Vertices in no triangle that are kept all the same: to find them takes longer.
const MOST_UNUSED: usize = 6;

/// What a [`DepthCache`] holds beside a polytope: of small bodies all there is, in a sixteenth of the room.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct DepthFacets {
    direction: [u32; 3],
    resting: [u32; 3],
    pairs: [VertexPair; 3],
    counts: [u8; 4],
}

/// Beyond all kinds of facets.
const APART: u32 = 16;

/// No vertex of the kept polytope.
const NO_PLACE: u8 = u8::MAX;

/// Three corners.
type PackedTriangle = [u8; 3];

impl Default for DepthCache {
    fn default() -> Self {
        DepthCache {
            direction: [0; 3],
            resting: [0; 3],
            pairs: [[0; 2]; MOST_VERTICES],
            triangles: [[0; 3]; MOST_TRIANGLES],
            counts: [0; 4],
        }
    }
}

impl DepthCache {
    /// One that holds no polytope.
    pub(crate) fn of_facets(&DepthFacets { direction, resting, pairs, counts }: &DepthFacets) -> DepthCache {
        let mut cache = DepthCache { direction, resting, counts, ..DepthCache::default() };
        cache.pairs[..pairs.len()].copy_from_slice(&pairs);
        cache
    }

    /// Without the polytope.
    pub(crate) fn facets(&self) -> DepthFacets {
        let [a, b, c, ..] = self.pairs;
        let counts = if self.has_polytope() { [0; 4] } else { self.counts };
        DepthFacets { direction: self.direction, resting: self.resting, pairs: [a, b, c], counts }
    }

    /// Puts the kept polytope into an empty one, its positions computed for the pair's poses, and returns where to begin. The
    /// polytope stays empty where none is kept, or what is kept has vertices that the bodies have not; it need not be a cycle.
    #[inline(always)]
    pub fn unpack<L: Lanes, const V: usize, const T: usize>(
        &self,
        frame: &Frame<L>,
        polytope: &mut Polytope<V, T>,
    ) -> SearchStart {
        let [vertices, triangles, best, first_triangles] = self.counts.map(usize::from);
        let mut start =
            SearchStart { triangle: None, direction: self.direction(frame), first_triangles, only_known: false };
        let is_kept = (4..=MOST_VERTICES).contains(&vertices) && (4..=MOST_TRIANGLES).contains(&triangles);
        if !(is_kept && self.are_vertices(frame.polyhedra(), vertices)) {
            return start;
        }
        if !self.unpack_triangles(polytope, vertices, triangles) {
            return start;
        }
        polytope.vertex_count = vertices;
        polytope.triangle_count = triangles;
        let [vertices1, vertices2] = [&frame.bodies[0].polyhedron.vertices, &frame.bodies[1].polyhedron.vertices];
        for (index, &[v, w]) in self.pairs[..vertices].iter().enumerate() {
            let difference = frame.difference(&vertices1[v as usize].position, &vertices2[w as usize].position);
            polytope.positions[index] = difference.to_array();
        }
        polytope.pairs[..vertices].copy_from_slice(&self.pairs[..vertices]);
        start.triangle = Some(if best < triangles { best } else { 0 });
        start
    }

    /// The direction of the least overlap when that was last searched for, in the world; `None` where none is kept.
    #[inline(always)]
    pub fn direction<L: Lanes>(&self, frame: &Frame<L>) -> Option<Vector> {
        let direction = frame.bodies[0].rotate(&number(self.direction)).to_vector();
        let square = direction.norm_squared();
        // False for a NaN.
        (square > 0.25 && square < 4.0).then_some(direction)
    }

    /// Whether the bodies have the vertices.
    #[inline(always)]
    fn are_vertices(&self, polyhedra: [&Polyhedron; 2], vertices: usize) -> bool {
        let [count1, count2] = polyhedra.map(|polyhedron| polyhedron.vertices.len());
        let largest = self.pairs[..vertices].iter().fold([0; 2], |[v, w], pair| [v.max(pair[0]), w.max(pair[1])]);
        (largest[0] as usize) < count1 && (largest[1] as usize) < count2
    }

    /// Whether all corners are vertices.
    #[inline(always)]
    fn unpack_triangles<const V: usize, const T: usize>(
        &self,
        polytope: &mut Polytope<V, T>,
        vertices: usize,
        triangles: usize,
    ) -> bool {
        for (&[a, b, c], corners) in self.triangles[..triangles].iter().zip(&mut polytope.corners) {
            *corners = [a, b, c, a];
        }
        let largest = polytope.corners[..triangles].as_flattened().iter().fold(0, |a, b| a.max(*b));
        usize::from(largest) < vertices
    }

    /// The facet that was the nearest; the bodies need not have it.
    #[inline(always)]
    pub fn facet(&self) -> Option<Facet> {
        let [first, second] = self.pairs[0];
        let [kind, 0, _, 0] = self.counts else { return None };
        Facet::of_words([kind.into(), first, second])
    }

    /// Keeps the nearest facet and its direction, and no polytope.
    #[inline(always)]
    pub fn keep_facet<L: Lanes>(&mut self, frame: &Frame<L>, facet: Facet, direction: &Vector, overlap: bool) {
        self.remember(frame, direction);
        let [x, y, z] = bits(frame.bodies[1].rotate_vector_back(direction).to_vector());
        let [kind, first, second] = facet.words();
        (self.counts, self.pairs[0]) = ([kind as u8, 0, u8::from(overlap), 0], [first, second]);
        (self.pairs[1], self.pairs[2]) = ([x, y], [z, 0]);
    }

    /// The direction of the least overlap in either body's axes, where a facet is kept; any numbers.
    #[inline(always)]
    pub fn facet_directions(&self) -> Option<[Vector; 2]> {
        self.facet()?;
        let ([x, y], [z, _]) = (self.pairs[1], self.pairs[2]);
        Some([number(self.direction), number([x, y, z])])
    }

    /// The facet of least overlap of a pair that seems to rest; the bodies need not have it.
    #[inline(always)]
    pub fn resting(&self) -> Option<Facet> {
        Facet::of_words(self.resting)
    }

    /// Keeps the facet of least overlap of a pair that seems to rest.
    #[inline(always)]
    pub fn rest_on(&mut self, facet: Facet) {
        self.resting = facet.words();
    }

    /// The nearest features of polyhedra that were apart; the bodies need not have them.
    #[inline(always)]
    pub fn apart(&self) -> Option<State> {
        let [kind, first, second] = self.resting;
        State::unchecked(kind.wrapping_sub(APART), [first, second])
    }

    /// Keeps the nearest features of polyhedra that are apart.
    #[inline(always)]
    pub fn keep_apart(&mut self, state: State) {
        let [first, second] = state.indices();
        self.resting = [APART + state.kind as u32, first, second];
    }

    /// The pair does not seem to rest.
    #[inline(always)]
    pub fn rest_no_more(&mut self) {
        self.resting = [0; 3];
    }

    /// Whether a polytope is kept, of these bodies or of others.
    #[inline(always)]
    pub fn has_polytope(&self) -> bool {
        self.counts[1] > 0
    }

    /// The polytope that it holds stays, with another direction of least overlap.
    #[inline(always)]
    pub fn keep<L: Lanes>(&mut self, frame: &Frame<L>, triangle: usize, direction: &Vector) {
        self.remember(frame, direction);
        self.counts[2] = triangle.min(255) as u8;
    }

    #[inline(always)]
    fn remember<L: Lanes>(&mut self, frame: &Frame<L>, direction: &Vector) {
        self.direction = bits(frame.bodies[0].rotate_vector_back(direction).to_vector());
    }

    /// Keeps a polytope, if it is small enough, else the direction of least overlap alone; `triangle` has its normal, about.
    #[inline(always)]
    pub fn pack<L: Lanes, const V: usize, const T: usize>(
        &mut self,
        frame: &Frame<L>,
        polytope: &Polytope<V, T>,
        triangle: usize,
        direction: &Vector,
        first_triangles: usize,
    ) {
        self.remember(frame, direction);
        self.counts = [0; 4];
        let triangles = polytope.triangle_count;
        if !((4..=MOST_TRIANGLES).contains(&triangles) && triangle < triangles) {
            return;
        }
        // Of a closed surface without handles few vertices are in no triangle.
        let vertices = polytope.vertex_count;
        if vertices <= MOST_VERTICES && vertices <= triangles / 2 + MOST_UNUSED {
            self.pairs[..vertices].copy_from_slice(&polytope.pairs[..vertices]);
            for (packed, [a, b, c, _]) in self.triangles.iter_mut().zip(&polytope.corners[..triangles]) {
                *packed = [*a, *b, *c];
            }
            self.counts = [vertices, triangles, triangle, first_triangles].map(|count| count.min(255) as u8);
            return;
        }
        // Vertices that no triangle has any more are left out.
        let (mut places, mut vertices) = ([NO_PLACE; V], 0);
        for (packed, corners) in self.triangles.iter_mut().zip(&polytope.corners[..triangles]) {
            for (own, corner) in packed.iter_mut().zip(corners) {
                let corner = usize::from(*corner);
                if places[corner] == NO_PLACE {
                    if vertices == MOST_VERTICES {
                        return;
                    }
                    self.pairs[vertices] = polytope.pairs[corner];
                    places[corner] = vertices as u8;
                    vertices += 1;
                }
                *own = places[corner];
            }
        }
        self.counts = [vertices, triangles, triangle, first_triangles].map(|count| count.min(255) as u8);
    }

    /// Whether a polytope is kept, or a facet of objects that overlapped.
    pub fn expects_overlap(&self) -> bool {
        let [_, triangles, overlap, _] = self.counts;
        triangles > 0 || (overlap == 1 && self.facet().is_some())
    }

    /// The objects were apart.
    #[inline(always)]
    pub fn expect_apart(&mut self) {
        if self.has_polytope() {
            self.counts = [0; 4];
        }
    }
}

/// A direction in single precision.
#[inline(always)]
fn bits(direction: Vector) -> [u32; 3] {
    [(direction.x as f32).to_bits(), (direction.y as f32).to_bits(), (direction.z as f32).to_bits()]
}

/// A direction that was kept.
#[inline(always)]
fn number([x, y, z]: [u32; 3]) -> Vector {
    let [x, y, z] = [f32::from_bits(x), f32::from_bits(y), f32::from_bits(z)];
    Vector::new(x.into(), y.into(), z.into())
}
