//! Lower bounds of distances, by spheres and by boxes, rounded down.

use crate::base::math::UNIT_ROUNDOFF as U;
use crate::scene::world::boxes::Aabb;
use crate::scene::world::rows::{Spheres, TINY};

/// Squares beyond this may be infinite sums: no bound is taken from them.
const LARGEST_SQUARE: f64 = 1e300;

/// Two bodies in their spheres are at least this far apart; negative or 0 proves nothing.
///
/// The square is off by less than 8u of itself, its root by 5u, the sum of the radii by 2u; below [`TINY`] squares underflow.
#[inline(always)]
pub(crate) fn of_spheres(one: &Spheres, other: &Spheres) -> f64 {
    debug_assert!(one.outer >= 0.0 && other.outer >= 0.0);
    let [x, y, z] = [0, 1, 2].map(|k| one.centre[k] - other.centre[k]);
    let radii = f64::from(one.outer) + f64::from(other.outer);
    root(x * x + y * y + z * z) - radii * (1.0 + 4.0 * U) - TINY
}

/// Two bodies in their boxes are at least this far apart.
#[inline(always)]
pub(crate) fn of_boxes(one: &Aabb, other: &Aabb) -> f64 {
    // Differences of single-precision numbers, in double precision off by u.
    let gap = |k: usize| {
        let [first, second] =
            [one.lower[k] as f64 - other.upper[k] as f64, other.lower[k] as f64 - one.upper[k] as f64];
        // A NaN, of boxes without end, is no gap.
        if first > 0.0 {
            first
        } else if second > 0.0 {
            second
        } else {
            0.0
        }
    };
    let [x, y, z] = [0, 1, 2].map(gap);
    root(x * x + y * y + z * z) - TINY
}

#[inline(always)]
fn root(square: f64) -> f64 {
    if square <= LARGEST_SQUARE { square.sqrt() * (1.0 - 16.0 * U) } else { 0.0 }
}
