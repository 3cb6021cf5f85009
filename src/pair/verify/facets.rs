//! A lower bound of the depth of small bodies by all facets of their Minkowski difference, in double-double arithmetic. It knows
//! nothing of the search by facets: it walks the triangles of the exact hulls, whose normals are nodes and whose edges are arcs of
//! the exact normal fans (`solve/facets/` has the lemma; of exact fans nothing is lost).
//!
//! Every direction of a facet of C = {x − y} is the normal of a triangle or is perpendicular to an edge of each body. An arc
//! between two normals is done with where one vertex of the other body is deep enough below both planes. Of the edges left, both
//! directions across each pair are tried over all vertices, whether the arcs cross or not: h is at least the depth everywhere.

use super::bounds::Bounds;
use crate::base::double_double::{DoubleDouble, WideVector, narrow, wide_cross, wide_dot};
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::polyhedron::Polyhedron;

/// Triangles times vertices beyond which it is not tried.
const MOST_WORK: usize = 100_000;

/// Pairs of edges beyond which it is not tried.
const MOST_PAIRS: usize = 4_096;

/// Whether the depth is at least `lower`, more than 0 and in units of the pair. It takes time in proportion to triangles times
/// vertices.
pub fn prove_lower(polyhedra: [&Polyhedron; 2], bounds: &Bounds, lower: f64) -> bool {
    let work = |i: usize| polyhedra[i].triangles.len() * polyhedra[1 - i].vertices.len();
    if polyhedra.iter().any(|polyhedron| polyhedron.dimension < 3) || work(0) + work(1) > MOST_WORK {
        return false;
    }
    let proof = Proof::new(polyhedra, bounds, lower);
    let Some(edges) = proof.open_edges(0).zip(proof.open_edges(1)) else { return false };
    let is_small = edges.0.len() * edges.1.len() <= MOST_PAIRS;
    is_small && edges.0.iter().all(|e| edges.1.iter().all(|g| proof.covers_crossing(*e, *g)))
}

struct Proof<'a> {
    polyhedra: [&'a Polyhedron; 2],
    /// The vertices of both bodies in the world, relative to the first one of body 2.
    points: [Vec<WideVector>; 2],
    lower: f64,
    /// By how much a coordinate of a point may be off.
    error: f64,
    /// No difference of points of both is longer.
    longest: f64,
}

fn difference(a: &WideVector, b: &WideVector) -> WideVector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A direction of unit length up to 8u.
struct Direction {
    unit: WideVector,
    /// By how much a product of it with a difference of both bodies' points may be off.
    error: f64,
}

impl<'a> Proof<'a> {
    fn new(polyhedra: [&'a Polyhedron; 2], bounds: &Bounds, lower: f64) -> Proof<'a> {
        let first = bounds.difference([0, 0]);
        let of_first = (0..polyhedra[0].vertices.len() as u32).map(|v| bounds.difference([v, 0])).collect::<Vec<_>>();
        let of_second = (0..polyhedra[1].vertices.len() as u32).map(|w| difference(&first, &bounds.difference([0, w])));
        let points = [of_first, of_second.collect()];
        let reach = |points: &[WideVector]| points.iter().map(|p| narrow(p).norm()).fold(0.0, f64::max);
        let longest = (reach(&points[0]) + reach(&points[1])) * (1.0 + 8.0 * U);
        Proof { polyhedra, points, lower, error: 4.0 * bounds.error(), longest }
    }

    /// The direction across two sides of triangles or two edges, in double-double arithmetic: sides are off by 2e in each
    /// coordinate, e the error of a point, their product by 8e(|a| + |b|) with its own rounding. `None` where that is no
    /// direction.
    fn across(&self, a: &WideVector, b: &WideVector) -> Option<Direction> {
        let product = wide_cross(a, b);
        let length = narrow(&product).norm();
        let off = 8.0 * self.error * (narrow(a).norm() + narrow(b).norm()) / length;
        let error = 2.0 * self.longest * off + 8.0 * self.error;
        // False for a NaN.
        let is_good = error <= 8.0 * U * self.longest;
        let scale = DoubleDouble::from(1.0 / length);
        is_good.then(|| Direction { unit: product.map(|x| x * scale), error })
    }

    /// Whether a product with a direction is surely at least `lower` times its length.
    fn is_enough(&self, product: DoubleDouble, direction: &Direction) -> bool {
        (product - DoubleDouble::from(self.lower * (1.0 + 16.0 * U))).hi > direction.error
    }

    /// The edges of a body whose arcs no single vertex of the other proves, as their ends; `None` if the normal of a triangle has
    /// none that proves it.
    fn open_edges(&self, body: usize) -> Option<Vec<[u32; 2]>> {
        let masks: Option<Vec<Vec<u64>>> =
            self.polyhedra[body].triangles.iter().map(|triangle| self.mask(body, triangle)).collect();
        let masks = masks?;
        let mut sides = Vec::with_capacity(3 * masks.len());
        for (index, triangle) in self.polyhedra[body].triangles.iter().enumerate() {
            for k in 0..3 {
                let (tail, head) = (triangle[k], triangle[(k + 1) % 3]);
                sides.push(([tail.min(head), tail.max(head)], index));
            }
        }
        sides.sort_unstable();
        let is_closed = sides.chunk_by(|a, b| a.0 == b.0).all(|both| both.len() == 2);
        let is_open = |both: &&[([u32; 2], usize)]| {
            let [(_, left), (_, right)] = both else { return true };
            masks[*left].iter().zip(&masks[*right]).all(|(a, b)| a & b == 0)
        };
        let open = sides.chunk_by(|a, b| a.0 == b.0).filter(is_open).map(|both| both[0].0).collect();
        is_closed.then_some(open)
    }

    /// Which vertices of the other body are deep enough below the plane of a triangle, as bits; `None` if none is.
    fn mask(&self, body: usize, triangle: &[u32; 3]) -> Option<Vec<u64>> {
        let [a, b, c] = triangle.map(|v| &self.points[body][v as usize]);
        let outward = self.across(&difference(b, a), &difference(c, a))?;
        let others = &self.points[1 - body];
        let mut mask = vec![0; others.len().div_ceil(64)];
        for (index, point) in others.iter().enumerate() {
            if self.is_enough(wide_dot(&outward.unit, &difference(a, point)), &outward) {
                mask[index / 64] |= 1 << (index % 64);
            }
        }
        mask.iter().any(|bits| *bits != 0).then_some(mask)
    }

    /// Whether the bodies overlap enough along both directions across two edges.
    fn covers_crossing(&self, edges1: [u32; 2], edges2: [u32; 2]) -> bool {
        let [along1, along2] = [(0, edges1), (1, edges2)].map(|(body, [tail, head])| {
            difference(&self.points[body][head as usize], &self.points[body][tail as usize])
        });
        let Some(direction) = self.across(&along1, &along2) else { return false };
        let ends = [0, 1].map(|body| {
            let products = self.points[body].iter().map(|point| wide_dot(&direction.unit, point));
            let is_less = |a: &DoubleDouble, b: &DoubleDouble| (*a - *b).hi < 0.0;
            products.fold(None, |ends: Option<[DoubleDouble; 2]>, x| match ends {
                None => Some([x, x]),
                Some([low, high]) => {
                    Some([if is_less(&x, &low) { x } else { low }, if is_less(&high, &x) { x } else { high }])
                }
            })
        });
        let [Some([low1, high1]), Some([low2, high2])] = ends else { return false };
        self.is_enough(high1 - low2, &direction) && self.is_enough(high2 - low1, &direction)
    }
}
