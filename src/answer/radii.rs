//! The radii of the balls that are swept over two bodies: what they take off a distance, rounded outwards, and where they move
//! witness points to.

use super::contact::PlacedPoints;
use crate::base::double_double::two_sum;
use crate::base::math::{Pose, UNIT_ROUNDOFF, Vector};
use crate::base::simd::environment::with_default;
use crate::shape::Placed;

/// The swept radii of a pair.
#[derive(Debug, Clone, Copy)]
pub struct Radii {
    /// The radii of body 1 and body 2.
    pub each: [f64; 2],
    /// Their sum, rounded down.
    pub lower: f64,
    /// Their sum, rounded up.
    pub upper: f64,
}

impl Radii {
    /// The radii of bodies without any.
    pub const NONE: Radii = Radii { each: [0.0; 2], lower: 0.0, upper: 0.0 };

    /// `None` of two bodies without.
    #[inline(always)]
    pub fn of(bodies: &[Placed; 2]) -> Option<Radii> {
        let each = [bodies[0].shape.swept_radius(), bodies[1].shape.swept_radius()];
        // By their bits: where subnormal numbers are flushed, a tiny radius would compare as 0.
        (each.map(f64::to_bits) != [0; 2]).then(|| {
            with_default(|| {
                let [lower, upper] = [sum_below(each[0], each[1]), sum_above(each[0], each[1])];
                Radii { each, lower, upper }
            })
        })
    }

    /// The radii of a body and a partner without one.
    pub fn of_one(radius: f64) -> Radii {
        debug_assert!(radius >= 0.0);
        Radii { each: [radius, 0.0], lower: radius, upper: radius }
    }

    /// An interval of the signed distance of the polyhedra as one of the swept bodies: of sets that are offset by r it is r less,
    /// be they apart or in each other, as the support function of their difference is r more along every direction.
    pub fn off(&self, [lower, upper]: [f64; 2]) -> [f64; 2] {
        debug_assert!(lower <= upper || lower.is_nan() || upper.is_nan());
        [sum_below(lower, -self.upper), sum_above(upper, -self.lower)]
    }

    /// The least interval of the polyhedra that contains the result of [`Radii::off`] for this.
    pub fn back_on(&self, [lower, upper]: [f64; 2]) -> [f64; 2] {
        debug_assert!(lower <= upper);
        [sum_below(lower, self.lower), sum_above(upper, self.upper)]
    }

    /// Polyhedra of bodies no farther apart than this are no farther apart than …
    pub fn with(&self, length: f64) -> f64 {
        debug_assert!(length >= 0.0);
        sum_above(length, self.upper)
    }

    /// By how much witness points move along the normal, which is from body 2 to body 1, from the polyhedra to the surfaces.
    pub fn outwards(&self) -> [f64; 2] {
        [-self.each[0], self.each[1]]
    }

    /// … and back.
    pub fn inwards(&self) -> [f64; 2] {
        [self.each[0], -self.each[1]]
    }
}

/// Points moved by this much along a direction of the world. A pose does not stretch the ball: the local point is where the pose
/// takes to the moved one.
pub fn moved(points: &PlacedPoints, poses: [&Pose; 2], normal: &[f64; 3], by: [f64; 2]) -> PlacedPoints {
    let normal = Vector::from(*normal);
    let world = [0, 1].map(|i| Vector::from(points.world[i]) + normal * by[i]);
    let local = [0, 1].map(|i| Vector::from(points.local[i]) + turned_back(poses[i], &normal) * by[i]);
    PlacedPoints { local: local.map(Into::into), world: world.map(Into::into) }
}

/// R⁻¹·n: Rᵀ·n, put right by what R makes of it; where that is more than rounding, by the inverse.
#[inline(always)]
pub fn turned_back(pose: &Pose, normal: &Vector) -> Vector {
    let turned = pose.rotate_back(normal);
    let rest = normal - pose.rotate(&turned);
    // False for a NaN.
    if rest.amax() <= 64.0 * UNIT_ROUNDOFF * normal.amax() {
        turned + pose.rotate_back(&rest)
    } else {
        inverted(pose, normal)
    }
}

#[cold]
fn inverted(pose: &Pose, normal: &Vector) -> Vector {
    pose.rotation().try_inverse().map_or_else(|| pose.rotate_back(normal), |back| back * normal)
}

/// a + b, rounded down: at most the largest double where both are finite; infinite or NaN only if a or b is.
pub fn sum_below(a: f64, b: f64) -> f64 {
    let sum = two_sum(a, b);
    if !sum.hi.is_finite() {
        return beyond([a, b], sum.hi, f64::MAX);
    }
    if sum.lo < 0.0 { sum.hi.next_down() } else { sum.hi }
}

/// a + b, rounded up: the same of the other side.
pub fn sum_above(a: f64, b: f64) -> f64 {
    let sum = two_sum(a, b);
    if !sum.hi.is_finite() {
        return beyond([a, b], sum.hi, f64::MIN);
    }
    if sum.lo > 0.0 { sum.hi.next_up() } else { sum.hi }
}

/// A sum that is no finite double, rounded away from the infinity that has the sign of `last`: the last double before it where both
/// terms are finite.
#[cold]
fn beyond(terms: [f64; 2], sum: f64, last: f64) -> f64 {
    let has_overflowed = terms.iter().all(|term| term.is_finite()) && sum * last > 0.0;
    if has_overflowed { last } else { sum }
}
