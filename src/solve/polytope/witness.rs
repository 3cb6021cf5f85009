//! The point of a polytope where it is least deep, as points of both bodies.

use super::storage::Polytope;
use super::{Expansion, Rounding};
use crate::base::math::{Matrix, UNIT_ROUNDOFF as U, Vector, clamp, divisor};
use crate::base::simd::Lanes;
use crate::solve::exact::VertexPair;
use crate::solve::frame::Frame;

/// A convex combination of vertex pairs.
#[derive(Debug, Clone, Copy)]
pub struct Witness {
    /// The vertex pairs.
    pub pairs: [VertexPair; 3],
    /// How many of them.
    pub count: usize,
    /// Their weights.
    pub weights: [f64; 4],
    /// How far it is from the origin along the direction of least overlap.
    pub depth: f64,
}

/// Where the ray from the origin along the direction of least overlap leaves the polytope, and the triangle there.
#[inline(always)]
pub fn witness<L: Lanes, const V: usize, const T: usize>(
    frame: &Frame<L>,
    polytope: &Polytope<V, T>,
    found: &Expansion,
) -> (Witness, usize) {
    let rounding = Rounding::of(frame);
    let direction = &found.direction;
    let mut best = (f64::NEG_INFINITY, 0);
    for triangle in 0..polytope.triangle_count {
        // Mostly one triangle is as near as the support is far.
        if polytope.distances[triangle] <= found.upper && polytope.normal(triangle).dot(direction) > 0.0 {
            let inside = least_side(&polytope.positions_of(triangle), direction);
            if inside > best.0 {
                best = (inside, triangle);
            }
        }
    }
    let (mut point, mut misses) = on_triangle(polytope, best.1, direction);
    // The sides of slivers are noise: there the distances tell.
    if misses > 16.0 * U * (frame.size + frame.separation) {
        for triangle in 0..polytope.triangle_count {
            let near = polytope.distances[triangle] <= found.upper + 2.0 * rounding.plane;
            if near && polytope.normal(triangle).dot(direction) > 0.0 {
                let (other, distance) = on_triangle(polytope, triangle, direction);
                if distance < misses {
                    (point, misses, best.1) = (other, distance, triangle);
                }
            }
        }
    }
    (point, best.1)
}

/// On which side of the ray the sides of a triangle are: the least of three, over their sum.
#[inline(always)]
fn least_side([p, q, r]: &[Vector; 3], ray: &Vector) -> f64 {
    let sides = [ray.dot(&p.cross(q)), ray.dot(&q.cross(r)), ray.dot(&r.cross(p))];
    let least = if sides[0] < sides[1] { sides[0] } else { sides[1] };
    let least = if least < sides[2] { least } else { sides[2] };
    least / divisor((sides[0] + sides[1] + sides[2]).abs())
}

/// Rounds of refinement of the weights: each gains the digits that the inverse has, and a triangle 10⁻⁸ times as wide as it is long
/// leaves it eight.
const REFINEMENTS: usize = 3;

/// Where the ray meets a triangle, and by how much it misses it: p + w₁(q − p) + w₂(r − p) = s·ray.
fn on_triangle<const V: usize, const T: usize>(
    polytope: &Polytope<V, T>,
    triangle: usize,
    ray: &Vector,
) -> (Witness, f64) {
    let pairs = polytope.pairs_of(triangle);
    let corners @ [p, q, r] = polytope.positions_of(triangle);
    let (e, g) = (q - p, r - p);
    let mut solution = Vector::new(0.0, 0.0, 0.0);
    // Columns of one length: the triangle may be small, or thin.
    let scales = Vector::new(1.0 / divisor(e.norm()), 1.0 / divisor(g.norm()), 1.0);
    let matrix = Matrix::from_columns(&[e * scales.x, g * scales.y, -ray]);
    if let Some(inverse) = matrix.try_inverse() {
        for _ in 0..REFINEMENTS {
            let residual = p + e * solution.x + g * solution.y - ray * solution.z;
            solution -= (inverse * residual).component_mul(&scales);
        }
    }
    let positive = [1.0 - solution.x - solution.y, solution.x, solution.y].map(|weight| clamp(weight, 0.0, 1.0));
    let sum: f64 = positive.iter().sum();
    let [a, b, c] = positive.map(|weight| weight / sum);
    let point = corners[0] * a + corners[1] * b + corners[2] * c;
    let misses = (point - ray * point.dot(ray)).norm();
    (Witness { pairs, count: 3, weights: [a, b, c, 0.0], depth: point.dot(ray) }, misses)
}
