//! The point of a polytope where it is least deep, as points of both bodies.

use super::storage::Polytope;
use super::{Expansion, PairRounding};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector, clamp, divisor};
use crate::base::simd::Lanes;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;

/// A convex combination of vertex pairs.
#[derive(Debug, Clone, Copy)]
pub struct PolytopeWitness {
    /// The vertex pairs.
    pub pairs: [VertexPair; 3],
    /// How many of them.
    pub count: usize,
    /// Their weights.
    pub weights: [f64; 4],
    /// How far it is from the origin along the direction of least overlap.
    pub depth: f64,
}

/// The point where the ray from the origin along the direction of least overlap leaves the polytope, and the triangle there.
#[inline(always)]
pub fn witness<L: Lanes, const V: usize, const T: usize>(
    frame: &Frame<L>,
    polytope: &Polytope<V, T>,
    found: &Expansion,
) -> (PolytopeWitness, usize) {
    let rounding = PairRounding::of(frame);
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
    let enough = 16.0 * U * (frame.size + frame.separation);
    let (mut point, mut misses) = on_triangle(polytope, best.1, direction, enough);
    // The sides of slivers are noise: there the distances decide.
    if misses > enough {
        for triangle in 0..polytope.triangle_count {
            let near = polytope.distances[triangle] <= found.upper + 2.0 * rounding.plane;
            if near && polytope.normal(triangle).dot(direction) > 0.0 {
                let (other, distance) = on_triangle(polytope, triangle, direction, enough);
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

/// The most rounds of refinement of the weights: each gains the digits that an area has, and a triangle 10⁻¹² times as wide as it
/// is long leaves it four.
const REFINEMENTS: usize = 8;

/// The point where the ray meets a triangle, and by how much it misses it: refined until that is `enough`.
///
/// Seen along the ray, a corner's weight is twice the area that the ray spans with the other two, and computed from those alone:
/// they may be near it, and the corner 10¹² times as far out.
fn on_triangle<const V: usize, const T: usize>(
    polytope: &Polytope<V, T>,
    triangle: usize,
    ray: &Vector,
    enough: f64,
) -> (PolytopeWitness, f64) {
    let corners = polytope.positions_of(triangle);
    let seen @ [p, q, r] = corners.map(|corner| corner - ray * corner.dot(ray));
    let areas = [ray.dot(&q.cross(&r)), ray.dot(&r.cross(&p)), ray.dot(&p.cross(&q))];
    let area: f64 = areas.iter().sum();
    let mut weights = [1.0, 0.0, 0.0];
    if area.abs() > f64::MIN_POSITIVE {
        weights = areas.map(|part| part / area);
        for _ in 0..REFINEMENTS {
            let off = weighted(&seen, &weights);
            if off.norm() <= enough {
                break;
            }
            let across = ray.cross(&off);
            for (weight, side) in weights.iter_mut().zip([r - q, p - r, q - p]) {
                *weight += across.dot(&side) / area;
            }
        }
    }
    if weights.iter().any(|weight| !(*weight >= 0.0)) {
        weights = on_side(&seen);
    }
    let sum: f64 = weights.iter().sum();
    let weights @ [a, b, c] = weights.map(|weight| weight / sum);
    let depth = weighted(&corners, &weights).dot(ray);
    let witness = PolytopeWitness { pairs: polytope.pairs_of(triangle), count: 3, weights: [a, b, c, 0.0], depth };
    (witness, weighted(&seen, &weights).norm())
}

/// The weights of the point of a triangle's sides that is nearest to the origin. To cut a negative weight off instead would move
/// the point by that times the triangle's length: of one 10⁻⁴ times as wide, 10⁴ times as far as the origin is beside a side.
#[cold]
fn on_side(corners: &[Vector; 3]) -> [f64; 3] {
    let of_side = |k: usize| {
        let (next, mut weights) = ((k + 1) % 3, [0.0; 3]);
        let along = corners[next] - corners[k];
        weights[next] = clamp(-corners[k].dot(&along) / divisor(along.norm_squared()), 0.0, 1.0);
        weights[k] = 1.0 - weights[next];
        weights
    };
    let nearer = |a: [f64; 3], b: [f64; 3]| {
        if weighted(corners, &b).norm_squared() < weighted(corners, &a).norm_squared() { b } else { a }
    };
    nearer(nearer(of_side(0), of_side(1)), of_side(2))
}

/// The point of these weights.
#[inline(always)]
fn weighted([p, q, r]: &[Vector; 3], [a, b, c]: &[f64; 3]) -> Vector {
    p * *a + q * *b + r * *c
}
