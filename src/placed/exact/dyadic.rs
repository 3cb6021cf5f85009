//! Doubles as integers times powers of two, and back with directed rounding.

use dashu_int::ops::{BitTest, SquareRootRem};
use dashu_int::{IBig, UBig};

use crate::base::math::Vector;
use crate::base::predicates::mantissa_and_exponent;

/// Three integers: a vector up to a common scale.
pub(crate) type IntVector = [IBig; 3];

/// A floating-point format, and how to round to it.
#[derive(Clone, Copy)]
struct FloatFormat {
    /// Bits of a significand, the leading one of normal numbers included.
    precision: i64,
    /// The exponent of the least positive number.
    least: i64,
    /// That of the first power of two beyond the largest number.
    end: i64,
    /// A quotient or a root is computed to this many bits more than it is rounded to; right from 0 on.
    spare: i64,
}

/// A constant to the functions that take a format: only tests give another, so narrow that all its numbers can be tried.
const DOUBLE: FloatFormat = FloatFormat { precision: 53, least: -1074, end: 1024, spare: 13 };

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
    f64::from_bits(fraction(DOUBLE, numerator, denominator))
}

fn fraction(format: FloatFormat, numerator: &IBig, denominator: &IBig) -> u64 {
    let (numerator, denominator) = (magnitude(numerator), magnitude(denominator));
    if numerator.is_zero() {
        return 0;
    }
    let bits = (format.precision + format.spare) as usize;
    let shift = bits + denominator.bit_len() - numerator.bit_len().min(denominator.bit_len());
    round(format, (numerator << shift) / denominator, -(shift as i64), RoundingMode::Down)
}

/// The doubles next to numerator / √square · 2^exponent, below and above; both the same when it is one. All positive.
pub(crate) fn bounds_of_quotient_by_root(numerator: &IBig, square: &IBig, exponent: i32) -> (f64, f64) {
    let (lower, upper) = quotient_by_root(DOUBLE, numerator, square, exponent);
    (f64::from_bits(lower), f64::from_bits(upper))
}

fn quotient_by_root(format: FloatFormat, numerator: &IBig, square: &IBig, exponent: i32) -> (u64, u64) {
    let (numerator, square) = (magnitude(numerator), magnitude(square));
    let bits = (format.precision + format.spare) as usize;
    // ⌊√⌊x⌋⌋ = ⌊√x⌋ for every real x ≥ 0, so the two roundings are one.
    let shift = (bits + square.bit_len().div_ceil(2)).saturating_sub(numerator.bit_len());
    let scaled = (&numerator * &numerator) << (2 * shift);
    let quotient = &scaled / &square;
    let divides = &quotient * &square == scaled;
    let (root, rest) = quotient.sqrt_rem();
    let exponent = i64::from(exponent) - shift as i64;
    let above = if divides && rest.is_zero() { root.clone() } else { &root + UBig::ONE };
    (round(format, root, exponent, RoundingMode::Down), round(format, above, exponent, RoundingMode::Up))
}

pub(super) fn magnitude(x: &IBig) -> UBig {
    x.clone().into_parts().1
}

#[derive(Clone, Copy, PartialEq)]
enum RoundingMode {
    Down,
    Up,
}

/// The bits of the number next to mantissa·2^exponent (positive) in the given direction: down to the largest or 0, up to +∞ at
/// the ends of the range.
fn round(format: FloatFormat, mantissa: UBig, exponent: i64, rounding: RoundingMode) -> u64 {
    debug_assert!(!mantissa.is_zero());
    let FloatFormat { precision, least, end, .. } = format;
    // The value lies in [2^(top−1), 2^top).
    let top = mantissa.bit_len() as i64 + exponent;
    let infinity = in_units(format, 1 << precision, end - precision);
    if top > end {
        return if rounding == RoundingMode::Down { infinity - 1 } else { infinity };
    }
    // The unit in the last place of numbers of this size, subnormal ones included.
    let unit = (top - precision).max(least);
    let integer = if unit <= exponent {
        mantissa << (exponent - unit) as usize
    } else {
        let shift = (unit - exponent) as usize;
        let kept = &mantissa >> shift;
        let up = rounding == RoundingMode::Up && (&kept << shift) != mantissa;
        if up { kept + UBig::ONE } else { kept }
    };
    u64::try_from(integer).map_or(infinity, |i| in_units(format, i, unit))
}

/// The bits of integer·2^unit, for at most 2^precision units, each the last place of the result; 2^end is +∞. Put together from
/// bits: a product with a subnormal unit would be 0 where these are flushed.
fn in_units(FloatFormat { precision, least, .. }: FloatFormat, integer: u64, unit: i64) -> u64 {
    debug_assert!(integer <= 1 << precision && unit >= least && (unit == least || integer >= 1 << (precision - 1)));
    // A fraction of one bit less than the precision, the biased exponent above it. In normal numbers the leading bit is the
    // exponent's: it adds 1 to one less. That of 2^precision carries into the next exponent, from the largest one to that of +∞.
    (((unit - least) as u64) << (precision - 1)) + integer
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

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

    /// So narrow that all numbers are listed, by their definition: the multiples of 2^least below 2^end whose bits, without zeros
    /// at their end, are as many as the precision at most. Bits count them from 0 on, and +∞ is the next.
    fn narrow(precision: i64, spare: i64) -> (FloatFormat, Vec<u128>) {
        let format = FloatFormat { precision, least: -12, end: 4, spare };
        let is_number = |k: &u128| *k == 0 || k >> k.trailing_zeros() < 1 << precision;
        (format, (0..1 << (format.end - format.least)).filter(is_number).collect())
    }

    /// The places of the numbers next to a value in a list of them, below and above.
    fn next_to(numbers: &[u128], order: impl Fn(u128) -> Ordering) -> (u64, u64) {
        let below = numbers.partition_point(|&number| order(number) != Ordering::Greater) - 1;
        let above = numbers.partition_point(|&number| order(number) == Ordering::Less);
        (below as u64, above as u64)
    }

    #[test]
    #[cfg_attr(miri, ignore = "long")]
    fn every_integer_is_rounded_to_the_number_next_to_it() {
        for precision in [1, 2, 5, 8] {
            let (format, numbers) = narrow(precision, 0);
            // From values that are 0 but for their last bit to those beyond all numbers; four bits more than there is room for.
            let finest = format.least - precision - 6;
            for (exponent, mantissa) in
                (finest..format.end + 3).flat_map(|exponent| (1..1u128 << (precision + 4)).map(move |m| (exponent, m)))
            {
                let value = mantissa << (exponent - finest);
                let expected = next_to(&numbers, |number| (number << (format.least - finest)).cmp(&value));
                let [below, above] =
                    [RoundingMode::Down, RoundingMode::Up].map(|r| round(format, mantissa.into(), exponent, r));
                assert_eq!((below, above), expected, "{mantissa}·2^{exponent} to {precision} bits");
            }
        }
    }

    #[test]
    #[cfg_attr(miri, ignore = "long")]
    fn every_fraction_and_quotient_by_a_root_is_rounded_to_the_number_next_to_it() {
        for (format, numbers) in [0, 1, 13].map(|spare| narrow(5, spare)) {
            for (denominator, numerator) in (1..=200u128).flat_map(|d| (0..=d).map(move |n| (d, n))) {
                let (expected, _) = next_to(&numbers, |number| (number * denominator).cmp(&(numerator << 12)));
                let fraction = fraction(format, &numerator.into(), &denominator.into());
                assert_eq!(fraction, expected, "{numerator}/{denominator}");
            }
            for (numerator, square) in (1..=32u128).flat_map(|n| (1..=100u128).map(move |s| (n, s))) {
                for exponent in -24..8 {
                    // Both sides squared, over 2⁻²⁴.
                    let value = (numerator << (exponent + 24)).pow(2);
                    let expected = next_to(&numbers, |number| ((number << 12).pow(2) * square).cmp(&value));
                    // The second has more bits than are computed.
                    for shift in [0, 40] {
                        let numerator = IBig::from(numerator << shift);
                        let bounds = quotient_by_root(format, &numerator, &square.into(), exponent - shift);
                        assert_eq!(bounds, expected, "{numerator}/√{square}·2^({exponent} − {shift})");
                    }
                }
            }
        }
    }

    /// For doubles, the edge cases: ties, carries into the next power of two, subnormal ones, both ends. By exact comparisons.
    #[test]
    fn doubles_are_next_to_what_is_rounded() {
        let order = |double: f64, value: &UBig, exponent: i64| {
            if double == f64::INFINITY {
                return Ordering::Greater;
            }
            let (mantissa, own) = decode(double);
            let least = exponent.min(own.into());
            (IBig::from(mantissa) << (i64::from(own) - least) as usize)
                .cmp(&(IBig::from(value.clone()) << (exponent - least) as usize))
        };
        let around = |bits: usize| (0..=4u8).map(move |k| (UBig::ONE << bits) + k - UBig::from(2u8));
        let mut mantissas: Vec<UBig> = [2, 51, 52, 53, 54, 63, 64, 65, 106, 200].into_iter().flat_map(around).collect();
        // All but the last of 53 bits are 0, or 1, and behind them a half and what is next to it.
        for leading in [(1u64 << 52) + 1, (1 << 53) - 2, (1 << 53) - 1] {
            mantissas.extend(around(9).map(|rest| (UBig::from(leading) << 10) + rest));
        }
        let tops = [-5000..=-4999, -1130..=-1120, -1080..=-1015, -1..=2, 960..=1030, 5000..=5001];
        for mantissa in &mantissas {
            for top in tops.iter().cloned().flatten() {
                let exponent = top - mantissa.bit_len() as i64;
                let [below, above] = [RoundingMode::Down, RoundingMode::Up]
                    .map(|rounding| f64::from_bits(round(DOUBLE, mantissa.clone(), exponent, rounding)));
                let orders =
                    [below, below.next_up(), above, above.next_down()].map(|double| order(double, mantissa, exponent));
                assert!(below >= 0.0 && orders[0].is_le() && orders[1].is_gt(), "{mantissa}·2^{exponent}: {below:e}");
                assert!(orders[2].is_ge() && orders[3].is_lt(), "{mantissa}·2^{exponent}: {above:e}");
            }
        }
    }
}
