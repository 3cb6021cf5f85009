//! Boxes along the world's axes in single precision, rounded outwards.

use crate::shape::extent::Reach;

/// Closed: boxes that touch overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aabb {
    pub lower: [f32; 3],
    pub upper: [f32; 3],
}

impl Aabb {
    pub const EVERYWHERE: Aabb = Aabb { lower: [f32::NEG_INFINITY; 3], upper: [f32::INFINITY; 3] };
    pub const NOWHERE: Aabb = Aabb { lower: [f32::INFINITY; 3], upper: [f32::NEG_INFINITY; 3] };

    /// The box of a body at `centre`, grown by so much on each side.
    pub fn around(centre: [f64; 3], reach: &Reach, grown: f64) -> Aabb {
        let mut found = Aabb::EVERYWHERE;
        for (axis, centre) in centre.into_iter().enumerate() {
            // Sums of what is added are off by u of the parts; the last one by u of the end itself, which rounding outwards covers.
            let size = reach.lower[axis].abs().max(reach.upper[axis].abs());
            let grown = (grown + 4.0 * f64::EPSILON * size) * (1.0 + 4.0 * f64::EPSILON);
            found.lower[axis] = below(centre + (reach.lower[axis] - grown));
            found.upper[axis] = above(centre + (reach.upper[axis] + grown));
        }
        found
    }

    #[inline(always)]
    pub fn overlaps(&self, other: &Aabb) -> bool {
        (self.lower[0] <= other.upper[0])
            & (other.lower[0] <= self.upper[0])
            & (self.lower[1] <= other.upper[1])
            & (other.lower[1] <= self.upper[1])
            & (self.lower[2] <= other.upper[2])
            & (other.lower[2] <= self.upper[2])
    }

    #[inline(always)]
    pub fn contains(&self, other: &Aabb) -> bool {
        (0..3).all(|k| self.lower[k] <= other.lower[k] && other.upper[k] <= self.upper[k])
    }

    #[inline(always)]
    pub fn union(&self, other: &Aabb) -> Aabb {
        let least = |a: f32, b: f32| if a < b { a } else { b };
        let greatest = |a: f32, b: f32| if a > b { a } else { b };
        Aabb {
            lower: [0, 1, 2].map(|k| least(self.lower[k], other.lower[k])),
            upper: [0, 1, 2].map(|k| greatest(self.upper[k], other.upper[k])),
        }
    }

    /// Sum of the sides; NaN for a box without end.
    #[inline(always)]
    pub fn girth(&self) -> f32 {
        let side = |k: usize| self.upper[k] - self.lower[k];
        side(0) + side(1) + side(2)
    }

    /// Twice the middle; 0 where a box has no ends, as those do whose pairs are near at any distance.
    #[inline(always)]
    pub fn doubled_middle(&self) -> [f32; 3] {
        /// As far out as an end counts: the sum of two is a number.
        const FAR: f32 = f32::MAX / 4.0;
        [0, 1, 2].map(|k| self.lower[k].max(-FAR) + self.upper[k].min(FAR))
    }
}

/// A single-precision number that is certainly less, by at most four steps; −∞ for a NaN.
#[inline(always)]
pub(crate) fn below(x: f64) -> f32 {
    -above(-x)
}

/// The same, greater.
///
/// Rounding to nearest moves by at most half of a step, ulp, of the rounded number r. The sum's second term is at least 1.9 ulp, or
/// for a subnormal r one step. So the sum is at least r + ulp, as that is a number and rounding is monotone. It is a NaN where r is
/// one, and where r is −∞.
#[inline(always)]
pub(crate) fn above(x: f64) -> f32 {
    const TINY: f32 = f32::from_bits(1);
    let rounded = x as f32;
    let greater = rounded + (rounded.abs() * (2.0 * f32::EPSILON) + TINY);
    if greater.is_nan() { beyond(rounded) } else { greater }
}

#[cold]
fn beyond(rounded: f32) -> f32 {
    if rounded == f32::NEG_INFINITY { f32::MIN } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_outwards() {
        for x in [0.0, 1.0, -1.0, 0.1, 1e-300, -1e-300, 1e300, -1e300, f64::MAX, -f64::MAX, 16_777_217.0, 1e-45] {
            assert!(f64::from(below(x)) < x && x < f64::from(above(x)), "{x}");
        }
        assert_eq!((below(f64::INFINITY), above(f64::NEG_INFINITY)), (f32::MAX, f32::MIN));
        assert_eq!((below(f64::NAN), above(f64::NAN)), (f32::NEG_INFINITY, f32::INFINITY));
    }
}
