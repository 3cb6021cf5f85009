//! Turns about an axis, right to a bound that is derived here: no library's sine is trusted, and all machines compute the same.

use crate::base::math::Vector;
use crate::base::scalar::{Scalar, constant, dot};

/// The largest angle in radians that [`Turn::weights`] takes.
pub(super) const LARGEST_ANGLE: f64 = 1_048_576.0;

/// A constant angular velocity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    /// The unit axis, off by at most 6.5u of its length; 0 where nothing turns.
    pub axis: Vector,
    /// Radians per unit of time, off by at most 5.5u of themselves.
    pub speed: f64,
}

impl Turn {
    /// From the vector along the axis whose length is the speed, all of it finite.
    ///
    /// Scaled so that its largest component is 1, for any size. Quotients err by u, the sum of squares by 5u, its root by 3.5u,
    /// speed and axis by two more roundings.
    pub fn new(rotation: &Vector) -> Turn {
        let scale = rotation.amax();
        if !(scale > 0.0) {
            return Turn { axis: Vector::zeros(), speed: 0.0 };
        }
        let (axis, speed) = axis_and_speed((*rotation).into(), scale);
        Turn { axis: axis.into(), speed }
    }

    /// The sine of the angle turned by after a time, and 1 less its cosine, both exactly 0 at time 0. The angle is at most
    /// [`LARGEST_ANGLE`] and errs by 6.5u of itself, 5.5u of the speed and a product; beside that the sine is off by 4u, the other
    /// by a rounding more, 6u.
    pub fn weights(&self, time: f64) -> [f64; 2] {
        let (sine, cosine) = sin_cos(angle(time, self.speed));
        [sine, versine(cosine)]
    }
}

/// A vector over its length, and its length; the scale is its largest component.
#[inline(always)]
pub fn axis_and_speed<S: Scalar>(rotation: [S; 3], scale: S) -> ([S; 3], S) {
    let scaled = rotation.map(|x| x / scale);
    let length = dot(scaled, scaled).sqrt();
    (scaled.map(|x| x / length), length * scale)
}

/// The angle of a turn.
#[inline(always)]
pub fn angle<S: Scalar>(time: S, speed: S) -> S {
    time * speed
}

/// 1 less a cosine.
#[inline(always)]
pub fn versine<S: Scalar>(cosine: S) -> S {
    constant::<S>(1.0) - cosine
}

/// a × b.
#[inline(always)]
pub fn crossed<S: Scalar>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// An entry of a pose from those of the three matrices that it is a sum of.
#[inline(always)]
pub fn entry<S: Scalar>(start: S, parts: [S; 2], weights: [S; 2]) -> S {
    start + (weights[0] * parts[0] + weights[1] * parts[1])
}

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
fn sin_cos(angle: f64) -> (f64, f64) {
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
    fn no_time_turns_nothing() {
        let turn = Turn::new(&Vector::new(3.0, -1e-3, 7e5));
        assert_eq!(turn.weights(0.0), [0.0; 2]);
        assert_eq!(Turn::new(&Vector::zeros()).weights(9.0), [0.0; 2]);
        // Whatever the size of the vector.
        let small = Turn::new(&(Vector::new(3.0, -1.0, 0.5) * f64::MIN_POSITIVE));
        assert!((small.axis.norm() - 1.0).abs() < 1e-3 && small.speed > 0.0);
    }
}
