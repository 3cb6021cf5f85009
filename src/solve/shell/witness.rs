//! The point of a shell where it is least deep, as points of both bodies.

use super::storage::Shell;
use super::{Expansion, Rounding};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector, divisor};
use crate::base::simd::Lanes;
use crate::solve::exact::VertexPair;
use crate::solve::frame::Frame;
use crate::solve::gjk::Simplex;

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

/// Where the ray from the origin along the direction of least overlap leaves the shell, and the triangle there.
#[inline(always)]
pub fn witness<L: Lanes>(frame: &Frame<L>, shell: &Shell, found: &Expansion) -> (Witness, usize) {
    let rounding = Rounding::of(frame);
    let direction = &found.direction;
    let mut best = (f64::NEG_INFINITY, 0);
    for triangle in 0..shell.triangle_count {
        // Mostly one triangle is as near as the support is far.
        if shell.distances[triangle] <= found.upper && shell.normal(triangle).dot(direction) > 0.0 {
            let inside = least_side(&shell.positions_of(triangle), direction);
            if inside > best.0 {
                best = (inside, triangle);
            }
        }
    }
    let (mut point, mut misses) = on_triangle(shell, best.1, direction);
    // The sides of slivers are noise: there the distances tell.
    if misses > 64.0 * U * (frame.size + frame.separation) {
        for triangle in 0..shell.triangle_count {
            let near = shell.distances[triangle] <= found.upper + 2.0 * rounding.plane;
            if near && shell.normal(triangle).dot(direction) > 0.0 {
                let (other, distance) = on_triangle(shell, triangle, direction);
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

/// The point of a triangle nearest to where the ray meets its plane, and how far that is.
fn on_triangle(shell: &Shell, triangle: usize, ray: &Vector) -> (Witness, f64) {
    let corners = shell.positions_of(triangle);
    let normal = shell.normal(triangle);
    let depth = normal.dot(&corners[0]) / divisor(normal.dot(ray));
    let target = ray * depth;
    let mut simplex = Simplex::default();
    for (pair, corner) in shell.pairs_of(triangle).into_iter().zip(corners) {
        simplex.add(pair, corner - target);
    }
    let misses = simplex.reduce().norm();
    let [first, second, third, _] = simplex.pairs;
    (Witness { pairs: [first, second, third], count: simplex.count, weights: simplex.weights, depth }, misses)
}
