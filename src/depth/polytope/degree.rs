//! Whether the degree of a polytope about the origin is provably positive.
//!
//! It is the sum of the signs with which a ray from the origin crosses triangles. The proof is about the computed corners; the
//! exact ones are off by no more than the difference's error, and every triangle is farther from the origin than that, so that
//! none meets it on the way from the one cycle to the other.

use super::PairRounding;
use super::storage::Polytope;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};

/// All planes of the polytope are known to be at a positive distance. If all determinants are positive the solid angles sum up to
/// more than 0. Otherwise a ray through a certainly positive triangle does, if it certainly misses the uncertain ones.
#[inline(always)]
pub fn is_positive<const V: usize, const T: usize>(polytope: &Polytope<V, T>, rounding: &PairRounding) -> bool {
    let certain = &polytope.certain[..polytope.triangle_count];
    certain.iter().fold(1, |all, certain| all & certain) == 1 || ray_proves(polytope, rounding)
}

#[cold]
fn ray_proves<const V: usize, const T: usize>(polytope: &Polytope<V, T>, rounding: &PairRounding) -> bool {
    let triangles = 0..polytope.triangle_count;
    let certain = triangles.clone().filter(|&t| polytope.certain[t] == 1);
    // A large one that is far away.
    let weight = |t: usize| {
        let [p, q, r] = polytope.positions_of(t);
        (q - p).cross(&(r - p)).norm() * polytope.distances[t]
    };
    let Some(through) = certain.reduce(|a, b| if weight(b) > weight(a) { b } else { a }) else { return false };
    let ray = polytope.positions_of(through).iter().sum::<Vector>() / 3.0;
    let length = ray.norm();
    triangles.filter(|&t| polytope.certain[t] == 0).all(|t| {
        let corners = polytope.positions_of(t);
        // A ray into the cone of a triangle is on one side of the three planes through the origin and its sides.
        let (mut left, mut right) = (false, false);
        for k in 0..3 {
            let (p, q) = (&corners[k], &corners[(k + 1) % 3]);
            let side = ray.dot(&p.cross(q));
            let error = 16.0 * U * length * p.norm() * q.norm() + f64::MIN_POSITIVE;
            left |= side > error;
            right |= side < -error;
        }
        // Or it goes the other way: the whole triangle is behind the origin, or beyond a plane that the ray leaves behind. A
        // product with the ray errs by 3u of the lengths, and the corners are at most 1/10u times `determinant` long.
        let is_behind = corners.iter().all(|corner| ray.dot(corner) < -length * rounding.determinant);
        let leaves = polytope.distances[t] > 0.0 && polytope.normal(t).dot(&ray) < -8.0 * U * length;
        (left && right) || is_behind || leaves
    })
}
