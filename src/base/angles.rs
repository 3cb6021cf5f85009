//! Angles. The last digits of a library's sine or arctangent are each machine's own; these are sums, products and quotients.

use crate::base::math::divisor;
use crate::base::scalar::{Scalar, constant};

/// The largest angle in radians that [`sin_cos`] takes.
pub const LARGEST_ANGLE: f64 = 1_048_576.0;

/// π/2 in three parts of 33 bits, so that products with integers up to 2²⁰ are exact; all three together are off by less than 2⁻¹⁰²
/// (after the C library of Sun Microsystems, e_rem_pio2.c, 1993).
const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3ff9_21fb_5440_0000),
    f64::from_bits(0x3dd0_b461_1a60_0000),
    f64::from_bits(0x3ba3_198a_2e00_0000),
];

/// The coefficients of r³, r⁵, … r¹⁷ of the sine.
const SINE: [f64; 8] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
];

/// The coefficients of r⁴, r⁶, … r¹⁸ of the cosine.
const COSINE: [f64; 8] = [
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
    -1.0 / 6_402_373_705_728_000.0,
];

/// Sine and cosine of an angle of up to 2²⁰ radians, each off by less than 4u.
///
/// The angle loses a multiple k of π/2. Its first difference is exact (Sterbenz), the next two are rounded by u·0.8 each; the
/// remainder that the parts of π/2 leave out is far below. The rest, at most 0.7854 + 2⁻³⁰, goes into Taylor's series, which
/// break off below 2⁻⁶³. The sine's rounding is u of r, and 6u of the rest, which is less than 0.1; the cosine's u of 1, and
/// twice u of r²/2 < 0.31. So both are off by less than 1.7u + 2u.
pub fn sin_cos(angle: f64) -> (f64, f64) {
    debug_assert!(angle.abs() <= LARGEST_ANGLE);
    // Beside 1.5·2⁵² doubles are integers: the sum is rounded to one, whose last bits are the multiple's.
    const INTEGERS: f64 = f64::from_bits((1023 + 52) << 52 | 1 << 51);
    let shifted = angle * std::f64::consts::FRAC_2_PI + INTEGERS;
    let r = reduced(angle, shifted - INTEGERS);
    let (sine, cosine) = (sine(r), cosine(r));
    match shifted.to_bits() & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// An angle less a multiple of π/2.
#[inline(always)]
pub fn reduced<S: Scalar>(angle: S, multiple: S) -> S {
    let [first, second, third] = HALF_PI.map(constant::<S>);
    ((angle - multiple * first) - multiple * second) - multiple * third
}

/// The sine of at most 0.7854.
#[inline(always)]
pub fn sine<S: Scalar>(r: S) -> S {
    let square = r * r;
    r + r * (square * polynomial(square, &SINE))
}

/// The cosine of at most 0.7854.
#[inline(always)]
pub fn cosine<S: Scalar>(r: S) -> S {
    let square = r * r;
    constant::<S>(1.0) - square * (constant::<S>(0.5) - square * polynomial(square, &COSINE))
}

#[inline(always)]
fn polynomial<S: Scalar>(x: S, coefficients: &[f64; 8]) -> S {
    let [others @ .., last] = coefficients;
    others.iter().rev().fold(constant(*last), |sum, coefficient| sum * x + constant(*coefficient))
}

/// A number in [0, 4) that rises with the azimuth of (x, y): where a ray meets the square |x| + |y| = 1, going round.
#[inline]
pub fn around(x: f64, y: f64) -> f64 {
    let along = y / divisor(x.abs() + y.abs());
    if x < 0.0 {
        2.0 - along
    } else if along < 0.0 {
        4.0 + along
    } else {
        along
    }
}

/// The angle of (x, y) from x, for both from 0 on and not both 0, off by less than 10u.
///
/// A start that is off by less than 0.08 is turned back twice: of the angle δ that is left, t − t³/3 of its tangent t takes all but
/// δ⁵/5, first 4e-7, then less than 2⁻¹⁰⁰. Cosine and sine are off by 4u.
pub fn arctangent(y: f64, x: f64) -> f64 {
    debug_assert!(x >= 0.0 && y >= 0.0);
    let turned_back = |angle: f64| {
        let (sine, cosine) = sin_cos(angle);
        let tangent = (y * cosine - x * sine) / (x * cosine + y * sine);
        angle + (tangent - tangent * tangent * tangent / 3.0)
    };
    turned_back(turned_back(std::f64::consts::FRAC_PI_2 * around(x, y)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::{UNIT_ROUNDOFF as U, power_of_two};
    use swiftprox::random::Random;

    /// Against the machine's own functions, which are right to 1 u where they are good: twice as much is allowed as is promised.
    #[test]
    fn sines_and_cosines_are_right() {
        let mut random = Random::new(0x51);
        let mut worst = 0.0_f64;
        for round in 0..200_000 {
            let angle = random.signed() * power_of_two(round % 40 - 20);
            let (sine, cosine) = sin_cos(angle);
            worst = worst.max((sine - angle.sin()).abs()).max((cosine - angle.cos()).abs());
            assert!((sine * sine + cosine * cosine - 1.0).abs() < 16.0 * U, "{angle}");
        }
        assert!(worst < 5.0 * U, "{:e}", worst / U);
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
    }

    #[test]
    fn arctangents_are_right() {
        let mut random = Random::new(0xa7);
        let mut worst = 0.0_f64;
        for round in 0..200_000 {
            let (x, y) = (random.uniform(0.0, 1.0), random.uniform(0.0, 1.0) * power_of_two(round % 120 - 60));
            worst = worst.max((arctangent(y, x) - y.atan2(x)).abs());
        }
        assert!(worst < 10.0 * U, "{:e}", worst / U);
        assert_eq!([arctangent(0.0, 2.0), arctangent(3.0, 0.0)], [0.0, std::f64::consts::FRAC_PI_2]);
    }
}
