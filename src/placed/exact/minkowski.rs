//! The Minkowski difference of two bodies with integer vertices, and the descent to its point nearest to the origin.

use super::body::ExactBody;
use super::simplex::{DifferenceVertex, ExactSimplex, VertexPair, nearest_of_hull};
use crate::base::memory::listed;
use crate::placed::Pair;

/// The Minkowski difference: all differences (point of A) − (point of B). It holds the origin exactly when A and B have a common
/// point, and its point nearest to the origin is the shortest vector from B to A.
pub(super) struct MinkowskiDifference<'a> {
    pub(super) a: ExactBody<'a>,
    pub(super) b: ExactBody<'a>,
}

impl<'a> MinkowskiDifference<'a> {
    /// The difference of two placed bodies, for any finite poses.
    pub(super) fn new(pair: &Pair<'a>) -> MinkowskiDifference<'a> {
        let Pair { polyhedra, poses } = *pair;
        MinkowskiDifference { a: ExactBody::new(polyhedra[0], poses[0]), b: ExactBody::new(polyhedra[1], poses[1]) }
    }

    pub(super) fn corner(&self, pair: VertexPair) -> DifferenceVertex {
        let position = self.a.world_vertex(pair[0]).difference(self.b.world_vertex(pair[1]));
        DifferenceVertex { pair, position }
    }

    /// The corners of those pairs whose indices are in range.
    pub(super) fn corners(&self, pairs: &[VertexPair]) -> Vec<DifferenceVertex> {
        let in_range =
            |p: &&VertexPair| (p[0] as usize) < self.a.vertex_count() && (p[1] as usize) < self.b.vertex_count();
        listed(pairs.iter().filter(in_range).map(|&p| self.corner(p)))
    }

    /// From the hinted pairs to the nearest point, and the iterations made.
    pub(super) fn descend(&self, start: &[VertexPair]) -> (ExactSimplex, u32) {
        let hints = self.corners(start);
        let first = hints.first().cloned().unwrap_or_else(|| self.corner([0, 0]));
        let mut simplex = nearest_of_hull(first, &hints);
        let mut iterations = 1;
        while !simplex.holds_origin() {
            iterations += 1;
            let support = self.support_towards_origin(&simplex);
            if !simplex.improve(&support) {
                break;
            }
        }
        (simplex, iterations)
    }

    /// A vertex of least value along P, climbed to from the simplex's latest pair.
    pub(super) fn support_towards_origin(&self, simplex: &ExactSimplex) -> DifferenceVertex {
        let along = &simplex.direction;
        let against = [0, 1, 2].map(|k| -&along[k]);
        let [from_a, from_b] = simplex.corners[0].pair;
        let vertex_a = self.a.support(from_a, &self.a.local_direction(&against));
        let vertex_b = self.b.support(from_b, &self.b.local_direction(along));
        self.corner([vertex_a, vertex_b])
    }

    /// The same for all vertices, regardless of their neighbours.
    pub(super) fn support_of_all(&self, simplex: &ExactSimplex) -> DifferenceVertex {
        let along = &simplex.direction;
        let against = [0, 1, 2].map(|k| -&along[k]);
        let vertex_a = self.a.support_of_all(&self.a.local_direction(&against));
        let vertex_b = self.b.support_of_all(&self.b.local_direction(along));
        self.corner([vertex_a, vertex_b])
    }
}
