//! Doubles with an exponent that does not end: as precise as doubles, and nothing under- or overflows.

use std::ops::{Add, Mul, Sub};

use crate::base::math::power_of_two;

/// mantissa·2^exponent. The mantissa may have any size between 2⁻²⁰⁰ and 2²⁰⁰: it is not normalised after an operation.
#[derive(Debug, Clone, Copy)]
pub struct Extended {
    /// 0, or far from under- and overflow.
    pub mantissa: f64,
    /// Any, whatever the mantissa.
    pub exponent: i32,
}

impl Extended {
    /// p − q, off by u of itself at most: finite doubles.
    pub fn difference(p: f64, q: f64) -> Extended {
        debug_assert!(p.is_finite() && q.is_finite());
        let difference = p - q;
        if difference.is_finite() {
            return Extended::from(difference);
        }
        // Twice the difference of the halves. The bit that halving loses of a subnormal is negligible beside the other number.
        let half = Extended::from(0.5 * p - 0.5 * q);
        Extended { exponent: half.exponent + 1, ..half }
    }

    /// |x|.
    pub fn abs(self) -> Extended {
        Extended { mantissa: self.mantissa.abs(), ..self }
    }

    /// A double of the same sign, 0 only for 0, that grows with x; its magnitude is between 2⁻¹⁰²² and 2⁻¹⁰⁰⁸.
    pub fn rank(self) -> f64 {
        if self.mantissa == 0.0 {
            return 0.0;
        }
        let Extended { mantissa, exponent } = Extended::from(self.mantissa);
        let place = f64::from(self.exponent + exponent) + mantissa.abs();
        (place + 8192.0).clamp(1.0, 16_384.0).copysign(mantissa) * f64::MIN_POSITIVE
    }
}

impl From<f64> for Extended {
    /// With a mantissa from 1 to 2.
    fn from(x: f64) -> Extended {
        const EXPONENT: u64 = 0x7ff << 52;
        let (bits, shift) = match x.to_bits() & EXPONENT {
            // 0 or subnormal.
            0 => ((x * power_of_two(64)).to_bits(), 64),
            _ => (x.to_bits(), 0),
        };
        let biased = (bits & EXPONENT) >> 52;
        if biased == 0 {
            return Extended { mantissa: 0.0, exponent: 0 };
        }
        Extended { mantissa: f64::from_bits(bits & !EXPONENT | 1023 << 52), exponent: biased as i32 - 1023 - shift }
    }
}

impl Mul for Extended {
    type Output = Extended;

    /// Off by u of the product.
    fn mul(self, other: Extended) -> Extended {
        Extended { mantissa: self.mantissa * other.mantissa, exponent: self.exponent + other.exponent }
    }
}

impl Add for Extended {
    type Output = Extended;

    /// Off by u of the sum, with the right sign.
    fn add(self, other: Extended) -> Extended {
        // Beyond this, for mantissas as they are here, the smaller one is less than u² of the sum.
        const FARTHEST: i32 = 600;
        let (large, small) = if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        if large.mantissa == 0.0 {
            return small;
        }
        match large.exponent - small.exponent {
            shift @ 0..=FARTHEST => {
                Extended { mantissa: large.mantissa + small.mantissa * power_of_two(-shift), ..large }
            }
            _ => large,
        }
    }
}

impl Sub for Extended {
    type Output = Extended;

    fn sub(self, other: Extended) -> Extended {
        self + Extended { mantissa: -other.mantissa, ..other }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_ratio::RBig;
    use swiftprox::random::Random;

    fn exact(x: Extended) -> RBig {
        let two = RBig::from(2);
        let power = two.pow(x.exponent.abs() as isize);
        let mantissa = RBig::try_from(x.mantissa).unwrap();
        if x.exponent < 0 { mantissa / power } else { mantissa * power }
    }

    /// Any finite double, often a subnormal one or one of the largest.
    fn any_double(random: &mut Random) -> f64 {
        let exponent = match random.next_u64() % 4 {
            0 => random.next_u64() % 3,
            1 => 2046 - random.next_u64() % 3,
            _ => random.next_u64() % 2047,
        };
        f64::from_bits(random.next_u64() & !(0x7ff << 52) | exponent << 52)
    }

    #[test]
    fn operations_round_once_at_any_exponent() {
        let mut random = Random::new(21);
        let most = RBig::from(1) / RBig::from(2).pow(52_isize);
        for _ in 0..if cfg!(miri) { 50 } else { 5_000 } {
            let [a, b, c] = [(); 3].map(|()| any_double(&mut random));
            let [x, y, z] = [a, b, c].map(Extended::from);
            assert_eq!(exact(x), RBig::try_from(a).unwrap());
            let near = f64::from_bits(a.to_bits() ^ 1);
            let pairs = [
                (x * y, exact(x) * exact(y)),
                (x + y, exact(x) + exact(y)),
                (x * y - y * z, exact(x) * exact(y) - exact(y) * exact(z)),
                (Extended::difference(a, b), exact(x) - exact(y)),
                (Extended::difference(a, near), exact(x) - RBig::try_from(near).unwrap()),
                (Extended::difference(a, -a), exact(x) + exact(x)),
            ];
            let products = exact((x * y).abs()) + exact((y * z).abs());
            for (i, (computed, truth)) in pairs.into_iter().enumerate() {
                let size = if i == 2 { products.clone() } else { truth.clone() };
                let error = exact(computed) - &truth;
                let error = if error < RBig::ZERO { -error } else { error };
                let size = if size < RBig::ZERO { -size } else { size };
                assert!(error <= size * &most, "{i}: {a:e} {b:e} {c:e}: {computed:?}");
            }
        }
    }

    #[test]
    fn ranks_are_in_order_and_below_what_a_filter_decides() {
        let mut random = Random::new(22);
        for _ in 0..if cfg!(miri) { 50 } else { 5_000 } {
            let [x, y] = [(); 2].map(|()| {
                let [a, b, c] = [(); 3].map(|()| Extended::from(any_double(&mut random)));
                a * b * c
            });
            let difference = x - y;
            let ranks = [x.rank(), y.rank()];
            assert!(ranks.iter().all(|rank| rank.abs() < power_of_two(-1000) && *rank != 0.0));
            assert!((ranks[0] - ranks[1]) * difference.mantissa.signum() >= 0.0, "{x:?} {y:?} {ranks:?}");
        }
        assert_eq!(Extended::from(-0.0).rank(), 0.0);
    }
}
