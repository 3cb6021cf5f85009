//! Doubles as integers times powers of two, and back with directed rounding.

use dashu_int::ops::{BitTest, SquareRootRem};
use dashu_int::{IBig, UBig};

use crate::base::math::Vector;
use crate::base::predicates::mantissa_and_exponent;

/// Three integers: a vector up to a common scale.
pub(crate) type IntVector = [IBig; 3];

/// Bits that a quotient or a root is computed to before it is rounded to the 53 of a double.
const QUOTIENT_BITS: usize = 66;

pub(crate) fn dot(a: &IntVector, b: &IntVector) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn cross(a: &IntVector, b: &IntVector) -> IntVector {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

/// The exact vector `components`·2^`exponent`.
#[derive(Debug, Clone)]
pub(crate) struct DyadicVector {
    pub components: IntVector,
    pub exponent: i32,
}

impl DyadicVector {
    /// Exactly the three finite doubles.
    pub fn from_doubles(values: [f64; 3]) -> DyadicVector {
        let parts = values.map(decode);
        let exponent = parts.iter().filter(|p| p.0 != 0).map(|p| p.1).min().unwrap_or(0);
        let components = parts.map(|(mantissa, own)| match mantissa {
            0 => IBig::ZERO,
            _ => IBig::from(mantissa) << (own - exponent) as usize,
        });
        DyadicVector { components, exponent }
    }

    /// The same vector over a finer power of two: `exponent` is at most the present one.
    pub fn refine(&mut self, exponent: i32) {
        let shift = (self.exponent - exponent) as usize;
        if shift > 0 {
            self.components.iter_mut().for_each(|c| *c <<= shift);
            self.exponent = exponent;
        }
    }

    pub fn sum(mut self, mut other: DyadicVector) -> DyadicVector {
        let exponent = self.exponent.min(other.exponent);
        self.refine(exponent);
        other.refine(exponent);
        for (own, add) in self.components.iter_mut().zip(other.components) {
            *own += add;
        }
        self
    }

    pub fn difference(self, mut other: DyadicVector) -> DyadicVector {
        other.components = other.components.map(|c| -c);
        self.sum(other)
    }
}

/// x = mantissa·2^exponent with an odd mantissa, or (0, 0).
pub(crate) fn decode(x: f64) -> (i64, i32) {
    let (mantissa, exponent) = mantissa_and_exponent(x);
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    (mantissa >> zeros, exponent + zeros as i32)
}

/// A positive multiple of `v` in doubles: every component is within 1 + u·|component| of the same multiple of the exact one,
/// and the largest lies between 2⁶² and 2⁶³. Zero for zero.
pub(crate) fn leading_bits(v: &IntVector) -> Vector {
    let bits = v.iter().map(|c| c.bit_len()).max().unwrap_or(0);
    let component = |c: &IBig| {
        let top = if bits > 63 { c >> (bits - 63) } else { c << (63 - bits) };
        // |top| ≤ 2⁶³ with equality only for a negative number rounded down, which an i64 holds.
        i64::try_from(top).map_or(0.0, |t| t as f64)
    };
    Vector::new(component(&v[0]), component(&v[1]), component(&v[2]))
}

/// numerator / denominator of a fraction in [0, 1], rounded down.
pub(crate) fn fraction_to_double(numerator: &IBig, denominator: &IBig) -> f64 {
    let (numerator, denominator) = (magnitude(numerator), magnitude(denominator));
    if numerator.is_zero() {
        return 0.0;
    }
    let shift = QUOTIENT_BITS + denominator.bit_len() - numerator.bit_len().min(denominator.bit_len());
    round((numerator << shift) / denominator, -(shift as i64), Rounding::Down)
}

/// The doubles next to numerator / √square · 2^exponent, below and above; both the same when it is one. All positive.
pub(crate) fn bounds_of_quotient_by_root(numerator: &IBig, square: &IBig, exponent: i32) -> (f64, f64) {
    let (numerator, square) = (magnitude(numerator), magnitude(square));
    // ⌊√⌊x⌋⌋ = ⌊√x⌋ for every real x ≥ 0, so the two roundings are one.
    let shift = (QUOTIENT_BITS + square.bit_len().div_ceil(2)).saturating_sub(numerator.bit_len());
    let scaled = (&numerator * &numerator) << (2 * shift);
    let quotient = &scaled / &square;
    let divides = &quotient * &square == scaled;
    let (root, rest) = quotient.sqrt_rem();
    let exponent = i64::from(exponent) - shift as i64;
    let above = if divides && rest.is_zero() { root.clone() } else { &root + UBig::ONE };
    (round(root, exponent, Rounding::Down), round(above, exponent, Rounding::Up))
}

pub(super) fn magnitude(x: &IBig) -> UBig {
    x.clone().into_parts().1
}

#[derive(Clone, Copy, PartialEq)]
enum Rounding {
    Down,
    Up,
}

/// The double next to mantissa·2^exponent (positive) in the given direction: down to `f64::MAX` or 0, up to +∞ at the ends
/// of the range.
fn round(mantissa: UBig, exponent: i64, rounding: Rounding) -> f64 {
    // The value lies in [2^(top−1), 2^top).
    let top = mantissa.bit_len() as i64 + exponent;
    if top > 1024 {
        return if rounding == Rounding::Down { f64::MAX } else { f64::INFINITY };
    }
    // The unit in the last place of doubles of this size, subnormal ones included.
    let unit = (top - 53).max(-1074);
    let integer = if unit <= exponent {
        mantissa << (exponent - unit) as usize
    } else {
        let shift = (unit - exponent) as usize;
        let kept = &mantissa >> shift;
        let up = rounding == Rounding::Up && (&kept << shift) != mantissa;
        if up { kept + UBig::ONE } else { kept }
    };
    u64::try_from(integer).map_or(f64::INFINITY, |i| in_units(i, unit as i32))
}

/// integer·2^unit, for at most 2⁵³ units, each the last place of the result; 2¹⁰²⁴ is +∞. Put together from bits: a product with a
/// subnormal unit would be 0 where these are flushed.
fn in_units(integer: u64, unit: i32) -> f64 {
    // A fraction of 52 bits, the biased exponent above it. In normal numbers the leading bit, 2⁵², is the exponent's: it adds 1 to
    // one less. That of 2⁵³ carries into the next exponent, from the largest one to that of +∞.
    let exponent_below = (unit + 1074) as u64;
    f64::from_bits((exponent_below << 52) + integer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::power_of_two;

    #[test]
    fn doubles_decode_exactly() {
        for x in [1.0, -0.75, 3.0e300, f64::MAX, f64::MIN_POSITIVE, 5e-324, -1.1e-310, 0.1] {
            let (mantissa, exponent) = decode(x);
            assert_eq!(mantissa & 1, 1);
            let half = exponent / 2;
            assert_eq!(mantissa as f64 * power_of_two(half) * power_of_two(exponent - half), x);
        }
        assert_eq!(decode(-0.0), (0, 0));
    }

    #[test]
    fn rounding_encloses() {
        let third = |exponent| bounds_of_quotient_by_root(&IBig::ONE, &IBig::from(9), exponent);
        assert_eq!(third(0), (1.0 / 3.0, (1.0_f64 / 3.0).next_up()));
        // √2/2, from 1/√2.
        let (lower, upper) = bounds_of_quotient_by_root(&IBig::ONE, &IBig::from(2), 0);
        assert!(lower <= std::f64::consts::FRAC_1_SQRT_2 && std::f64::consts::FRAC_1_SQRT_2 <= upper);
        assert_eq!(lower.next_up(), upper);
        // An exact value is its own interval.
        assert_eq!(bounds_of_quotient_by_root(&IBig::from(50), &IBig::from(100), -1), (2.5, 2.5));
    }

    #[test]
    fn rounding_at_the_ends_of_the_range() {
        let power = |exponent| bounds_of_quotient_by_root(&IBig::ONE, &IBig::ONE, exponent);
        assert_eq!(power(-1074), (5e-324, 5e-324));
        assert_eq!(power(-1075), (0.0, 5e-324));
        assert_eq!(power(-5000), (0.0, 5e-324));
        assert_eq!(power(1023), (power_of_two(1023), power_of_two(1023)));
        assert_eq!(power(1024), (f64::MAX, f64::INFINITY));
        let below = (IBig::ONE << 54) - 1;
        assert_eq!(bounds_of_quotient_by_root(&below, &IBig::ONE, 1024 - 54), (f64::MAX, f64::INFINITY));
        let subnormal = bounds_of_quotient_by_root(&IBig::from(7), &IBig::ONE, -1075);
        assert_eq!(subnormal, (3.0 * 5e-324, 4.0 * 5e-324));
    }

    #[test]
    fn fractions_round_down() {
        assert_eq!(fraction_to_double(&IBig::from(1), &IBig::from(4)), 0.25);
        assert_eq!(fraction_to_double(&IBig::from(5), &IBig::from(5)), 1.0);
        assert_eq!(fraction_to_double(&IBig::from(1), &(IBig::ONE << 3000)), 0.0);
        assert_eq!(fraction_to_double(&IBig::from(2), &IBig::from(3)), 2.0 / 3.0);
    }
}
