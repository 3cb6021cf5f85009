//! A lower bound of the depth of small bodies by all facets of their Minkowski difference. Double-double arithmetic decides most,
//! integers what that leaves open. It knows nothing of the search by facets: it walks the triangles of the exact hulls. Their
//! normals are nodes and their edges are arcs of the exact normal fans (`depth/facets/` has the lemma; of exact fans nothing is
//! lost).
//!
//! Every direction of a facet of C = {x − y} is the normal of a triangle or is perpendicular to an edge of each body. An arc
//! between two normals is done with where one vertex of the other body is deep enough below both planes. For the edges left, both
//! directions across each pair are tried over all vertices, whether the arcs cross or not: h is at least the depth everywhere.
//! Parallel edges have no facet between them.

use super::bounds::Bounds;
use crate::base::double_double::{DoubleDouble, WideVector, narrow, wide_cross, wide_dot};
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::base::memory::listed;
use crate::body::polyhedron::Polyhedron;
use crate::placed::exact::{Differences, Normal, PairEdge};
use std::cell::OnceCell;

/// Triangles times vertices beyond which it is not tried.
const MOST_WORK: usize = 100_000;

/// Pairs of edges beyond which it is not tried.
const MOST_PAIRS: usize = 4_096;

/// Whether the depth is at least `lower`, more than 0. It takes time in proportion to triangles times vertices.
pub fn prove_lower(polyhedra: [&Polyhedron; 2], bounds: &Bounds, exact: &Differences, lower: f64) -> bool {
    let work = |i: usize| polyhedra[i].triangles.len() * polyhedra[1 - i].vertices.len();
    if polyhedra.iter().any(|polyhedron| polyhedron.dimension < 3) || work(0) + work(1) > MOST_WORK {
        return false;
    }
    let proof = FacetProof::new(polyhedra, bounds, exact, lower);
    let Some(edges) = proof.open_edges(0).zip(proof.open_edges(1)) else { return false };
    let is_small = edges.0.len() * edges.1.len() <= MOST_PAIRS;
    is_small && edges.0.iter().all(|e| edges.1.iter().all(|g| proof.covers_crossing(*e, *g)))
}

/// Whether a point is at least `lower` deep in a body, in integers: so far are the planes of all triangles.
pub fn prove_point(polyhedra: [&Polyhedron; 2], exact: &Differences, lower: f64) -> bool {
    let body = match polyhedra.map(|polyhedron| polyhedron.dimension) {
        [3, 0] => 0,
        [0, 3] => 1,
        _ => return false,
    };
    let triangles = &polyhedra[body].triangles;
    triangles.len() <= MOST_WORK
        && triangles.iter().all(|&[a, b, c]| {
            let normals = exact.across([(body, [a, b]), (body, [a, c])].map(pair_edge));
            let pair = if body == 0 { [a, 0] } else { [0, a] };
            normals.is_some_and(|both| exact.is_beyond(&both[body], pair, lower))
        })
}

struct FacetProof<'a> {
    polyhedra: [&'a Polyhedron; 2],
    /// The vertices of both bodies in the world, relative to the first one of body 2, in units of the pair.
    points: [Vec<WideVector>; 2],
    exact: &'a Differences<'a>,
    lower: f64,
    /// The same in units of the pair.
    needed: f64,
    /// By how much a coordinate of a point may be off.
    error: f64,
    /// No difference of points of both is longer.
    longest: f64,
}

/// An edge of a body: which body, its tail and head.
type BodyEdge = (usize, [u32; 2]);

/// The edge of the Minkowski difference that an edge of a body is.
fn pair_edge((body, [tail, head]): BodyEdge) -> PairEdge {
    match body {
        0 => [[tail, 0], [head, 0]],
        _ => [[0, head], [0, tail]],
    }
}

fn difference(a: &WideVector, b: &WideVector) -> WideVector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A direction across two edges: rounded, of about unit length, and exactly where that is asked for.
struct Direction {
    unit: WideVector,
    /// By how much a product of it with a difference of both bodies' points may be off from that with the exact one.
    error: f64,
    edges: [PairEdge; 2],
    exact: OnceCell<Option<[Normal; 2]>>,
}

impl<'a> FacetProof<'a> {
    fn new(polyhedra: [&'a Polyhedron; 2], bounds: &Bounds, exact: &'a Differences<'a>, lower: f64) -> FacetProof<'a> {
        let first = bounds.difference([0, 0]);
        let of_first = (0..polyhedra[0].vertices.len() as u32).map(|v| bounds.difference([v, 0]));
        let of_second = (0..polyhedra[1].vertices.len() as u32).map(|w| difference(&first, &bounds.difference([0, w])));
        let points = [listed(of_first), listed(of_second)];
        let reach = |points: &[WideVector]| points.iter().map(|p| narrow(p).norm()).fold(0.0, f64::max);
        let longest = (reach(&points[0]) + reach(&points[1])) * (1.0 + 8.0 * U);
        let (needed, error) = (bounds.in_units(lower), 4.0 * bounds.error());
        FacetProof { polyhedra, points, exact, lower, needed, error, longest }
    }

    /// The direction across two edges, in double-double arithmetic. Edges are off by 2e in each coordinate, e the error of a
    /// point, their product by 8e(|a| + |b|) with its own rounding: it is turned by the part of its length that this is, and by
    /// as much longer or shorter. For edges that are nearly parallel the error is infinite.
    fn across(&self, edges: [BodyEdge; 2]) -> Direction {
        let [a, b] = edges.map(|(body, [tail, head])| {
            difference(&self.points[body][head as usize], &self.points[body][tail as usize])
        });
        let product = wide_cross(&a, &b);
        let length = narrow(&product).norm();
        let off = 8.0 * self.error * (narrow(&a).norm() + narrow(&b).norm()) / length;
        // The second-order part is less than the slack of 8. False for a NaN.
        let error = if off < 1e-3 { 2.0 * self.longest * off + 8.0 * self.error } else { f64::INFINITY };
        let scale = DoubleDouble::from(1.0 / length);
        Direction { unit: product.map(|x| x * scale), error, edges: edges.map(pair_edge), exact: OnceCell::new() }
    }

    /// Whether a product with a direction is at least `lower` times its length; `None` where rounding hides it. The length is 1 up
    /// to 8u beside what the direction's error tells.
    fn is_enough(&self, product: DoubleDouble, direction: &Direction) -> Option<bool> {
        let more = |needed: f64| (product - DoubleDouble::from(needed)).hi;
        if more(self.needed * (1.0 + 16.0 * U)) > direction.error {
            return Some(true);
        }
        (more(self.needed * (1.0 - 16.0 * U)) < -direction.error).then_some(false)
    }

    /// The direction and its opposite in integers; `None` of parallel edges.
    fn exactly<'b>(&self, direction: &'b Direction) -> Option<&'b [Normal; 2]> {
        direction.exact.get_or_init(|| self.exact.across(direction.edges)).as_ref()
    }

    /// The edges of a body whose arcs no single vertex of the other proves, as their ends; `None` if the normal of a triangle has
    /// none that proves it.
    fn open_edges(&self, body: usize) -> Option<Vec<[u32; 2]>> {
        let mut is_proved = true;
        let masks = self.polyhedra[body].triangles.iter().map_while(|triangle| {
            let mask = self.mask(body, *triangle);
            is_proved &= mask.is_some();
            mask
        });
        let masks: Vec<Vec<u64>> = listed(masks);
        if !is_proved {
            return None;
        }
        let mut sides = listed(self.polyhedra[body].triangles.iter().enumerate().flat_map(|(index, triangle)| {
            [0, 1, 2].map(|k| {
                let (tail, head) = (triangle[k], triangle[(k + 1) % 3]);
                ([tail.min(head), tail.max(head)], index)
            })
        }));
        sides.sort_unstable();
        let is_closed = sides.chunk_by(|a, b| a.0 == b.0).all(|both| both.len() == 2);
        let is_open = |both: &&[([u32; 2], usize)]| {
            let [(_, left), (_, right)] = both else { return true };
            masks[*left].iter().zip(&masks[*right]).all(|(a, b)| a & b == 0)
        };
        let open = listed(sides.chunk_by(|a, b| a.0 == b.0).filter(is_open).map(|both| both[0].0));
        is_closed.then_some(open)
    }

    /// Which vertices of the other body are deep enough below the plane of a triangle, as bits; `None` if none is.
    fn mask(&self, body: usize, [a, b, c]: [u32; 3]) -> Option<Vec<u64>> {
        let outward = self.across([(body, [a, b]), (body, [a, c])]);
        let corner = &self.points[body][a as usize];
        let others = &self.points[1 - body];
        let mut mask = listed((0..others.len().div_ceil(64)).map(|_| 0));
        for (index, point) in others.iter().enumerate() {
            let product = wide_dot(&outward.unit, &difference(corner, point));
            let is_enough = self.is_enough(product, &outward).unwrap_or_else(|| {
                let pair = if body == 0 { [a, index as u32] } else { [index as u32, a] };
                self.exactly(&outward).is_some_and(|both| self.exact.is_beyond(&both[body], pair, self.lower))
            });
            if is_enough {
                mask[index / 64] |= 1 << (index % 64);
            }
        }
        mask.iter().any(|bits| *bits != 0).then_some(mask)
    }

    /// Whether the bodies overlap enough along both directions across two edges.
    fn covers_crossing(&self, edge1: [u32; 2], edge2: [u32; 2]) -> bool {
        let direction = self.across([(0, edge1), (1, edge2)]);
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
        let both = [high1 - low2, high2 - low1].map(|overlap| self.is_enough(overlap, &direction));
        match both {
            [Some(along), Some(against)] => along && against,
            _ => self
                .exactly(&direction)
                .is_none_or(|normals| normals.iter().all(|normal| self.exact.overlaps_by(normal, self.lower))),
        }
    }
}
