//! How deep two placed bodies are in each other at least: the ball around the origin in a tetrahedron of vertex differences.

use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{self, Kernel, Lanes};
use crate::placed::Pair;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;

/// Two placed bodies, and vertex pairs whose differences may hold the origin.
pub(super) struct EnclosedBall<'a> {
    pub pair: Pair<'a>,
    pub pairs: &'a [VertexPair],
}

impl EnclosedBall<'_> {
    /// A ball of this radius around the origin is in the hull of the differences; 0 where that is not proved.
    pub fn radius(mut self) -> f64 {
        simd::dispatch(&mut self)
    }
}

/// The faces of a tetrahedron, and the corner opposite each.
const FACES: [([usize; 3], usize); 4] = [([1, 2, 3], 0), ([0, 2, 3], 1), ([0, 1, 3], 2), ([0, 1, 2], 3)];

impl Kernel for EnclosedBall<'_> {
    type Output = f64;

    /// Whatever the pairs are: it is proved here that the origin is inside. A tetrahedron whose corners are off by `error` has a
    /// ball that is so much smaller.
    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> f64 {
        let &[p, q, r, s] = self.pairs else { return 0.0 };
        let frame = Frame::<L>::new(&self.pair);
        if !frame.in_range {
            return 0.0;
        }
        let [body1, body2] = self.pair.polyhedra;
        let corners = [p, q, r, s].map(|[v, w]| {
            frame.difference(&body1.vertices[v as usize].position, &body2.vertices[w as usize].position).to_vector()
        });
        let longest = corners.iter().map(Vector::norm).fold(0.0, f64::max);
        let ball = FACES.iter().map(|face| inside_of_face(&corners, face, longest)).fold(f64::INFINITY, f64::min);
        (ball - frame.difference_error(longest)).max(0.0)
    }
}

/// How far the origin is inside of a face, at least; 0 where it may not be on the side of the opposite corner.
///
/// Edges are no longer than W, twice the longest corner. The normal, a product of two of them, errs by less than 8uW²; its products
/// with corners and edges err by less than 16uW³.
fn inside_of_face(corners: &[Vector; 4], (face, opposite): &([usize; 3], usize), longest: f64) -> f64 {
    let width = 2.0 * longest;
    let [a, b, c] = face.map(|k| corners[k]);
    let normal = (b - a).cross(&(c - a));
    let [of_origin, of_corner] = [-normal.dot(&a), normal.dot(&(corners[*opposite] - a))];
    let off = 16.0 * U * width * width * width;
    let is_inside = of_origin.abs() > off && of_corner.abs() > off && (of_origin > 0.0) == (of_corner > 0.0);
    let steepest = normal.norm() * (1.0 + 16.0 * U) + 8.0 * U * width * width;
    // Tiny products underflow.
    if is_inside && steepest > 0.0 { (of_origin.abs() - off) / steepest * (1.0 - 8.0 * U) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests a regular tetrahedron around the origin, and others that do not hold it.
    #[test]
    fn the_ball_touches_the_nearest_face() {
        let corners = |shift: f64| {
            [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]
                .map(|[x, y, z]| Vector::new(x + shift, y + shift, z + shift))
        };
        let ball = |corners: [Vector; 4]| {
            FACES.iter().map(|face| inside_of_face(&corners, face, 2.0)).fold(f64::INFINITY, f64::min)
        };
        let inner = 1.0 / 3.0_f64.sqrt();
        assert!(ball(corners(0.0)) <= inner && ball(corners(0.0)) > inner - 1e-13);
        // The face opposite the first corner comes nearer as it goes away along the diagonal.
        let shifted = ball(corners(0.25));
        let nearest = inner - 0.25 * 3.0_f64.sqrt();
        assert!(shifted <= nearest && shifted > nearest - 1e-13, "{shifted} {nearest}");
        for outside in [corners(0.4), corners(-2.0), [Vector::zeros(); 4], corners(1.0 / 3.0)] {
            assert_eq!(ball(outside), 0.0, "{outside:?}");
        }
    }
}
