//! Unit normals of triangles, right to a few units in the last place however thin the triangle.

use dashu_int::IBig;

use crate::base::double_double::{WideVector, narrow, wide_cross, wide_difference};
use crate::base::math::Vector;
use crate::base::predicates::mantissa_and_exponent;
use crate::base::scalar::{Scalar, dot};

/// Below this ratio |n|/(|a|·|b|) the error 2⁻¹⁰⁰·|a||b| of a wide cross product could show in doubles; 2⁻⁴⁰.
const THINNEST_FOR_WIDE: f64 = f64::from_bits((1023 - 40) << 52);

/// Below this |a|·|b| error terms of a wide cross product may underflow; 2⁻⁸⁰⁰.
const SMALLEST_FOR_WIDE: f64 = f64::from_bits((1023 - 800) << 52);

/// v/|v|, each component right to 4u; zero for zero.
pub fn unit(v: &Vector) -> Vector {
    let mut v = *v;
    let largest = v.amax();
    if largest == 0.0 {
        return v;
    }
    // Keeps the squares in range; at most three rounds, all exact. Infinite values stay infinite.
    const STEP: f64 = f64::from_bits((1023 + 400) << 52);
    while v.amax() < 1.0 / STEP {
        v *= STEP;
    }
    while v.amax() > STEP && v.amax() <= f64::MAX {
        v /= STEP;
    }
    over_length(v.into()).into()
}

/// v/|v| for squares that are in range.
#[inline(always)]
pub fn over_length<S: Scalar>(v: [S; 3]) -> [S; 3] {
    let length = dot(v, v).sqrt();
    [v[0] / length, v[1] / length, v[2] / length]
}

/// Twice the area vector of the triangle o, p, q: (p − o) × (q − o), off by less than 2⁻¹⁰⁰·|p − o||q − o|.
#[inline]
pub fn area_vector(o: &Vector, p: &Vector, q: &Vector) -> WideVector {
    wide_cross(&wide_difference(p, o), &wide_difference(q, o))
}

/// The unit normal of the triangle o, p, q, counter-clockwise; zero for three collinear points. `area` is its
/// [`area_vector`].
pub fn normal_of(area: &WideVector, o: &Vector, p: &Vector, q: &Vector) -> Vector {
    let size = (p - o).amax() * (q - o).amax();
    let normal = narrow(area);
    if size > SMALLEST_FOR_WIDE && normal.amax() > THINNEST_FOR_WIDE * size {
        unit(&normal)
    } else {
        exact_normal(o, p, q)
    }
}

/// Same as [`normal_of`], by integers: for the thinnest triangles.
#[cold]
fn exact_normal(o: &Vector, p: &Vector, q: &Vector) -> Vector {
    let parts = [o, p, q].into_iter().flat_map(|v| v.iter().map(|x| mantissa_and_exponent(*x)));
    let lowest = parts.filter(|(mantissa, _)| *mantissa != 0).map(|(_, exponent)| exponent).min().unwrap_or(0);
    let integer = |x: f64| match mantissa_and_exponent(x) {
        (0, _) => IBig::ZERO,
        (mantissa, exponent) => IBig::from(mantissa) << ((exponent - lowest) as usize),
    };
    let difference = |v: &Vector| [0, 1, 2].map(|k| integer(v[k]) - integer(o[k]));
    let (a, b) = (difference(p), difference(q));
    let cross = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i]);
    // Only the ratios matter: 62 leading bits of the largest component.
    let bits = |x: &IBig| dashu_int::ops::BitTest::bit_len(x);
    let excess = cross.iter().map(bits).max().unwrap_or(0).saturating_sub(62);
    let leading = |x: &IBig| i64::try_from(x.clone() >> excess).unwrap_or(0) as f64;
    unit(&Vector::new(leading(&cross[0]), leading(&cross[1]), leading(&cross[2])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normal(o: [f64; 3], p: [f64; 3], q: [f64; 3]) -> Vector {
        let (o, p, q) = (Vector::from(o), Vector::from(p), Vector::from(q));
        normal_of(&area_vector(&o, &p, &q), &o, &p, &q)
    }

    #[test]
    fn slivers_keep_their_normal() {
        assert_eq!(normal([0.0; 3], [1.0, 0.0, 0.0], [0.5, 1e-200, 0.0]), Vector::z());
        assert_eq!(normal([0.0; 3], [1e-300, 0.0, 0.0], [0.0, 0.0, 1e-300]), -Vector::y());
        // One unit in the last place off the line through (1, 1, 1), along y.
        let n = normal([0.0; 3], [1.0, 1.0, 1.0], [0.5, 0.5 + f64::EPSILON / 2.0, 0.5]);
        assert!((n - Vector::new(-1.0, 0.0, 1.0) / 2.0_f64.sqrt()).amax() < 1e-15, "{n:?}");
        // So thin that double-double cannot tell it from a segment.
        let n = normal([1e-150, 0.0, 0.0], [1.0, 1.0, 1.0], [0.5, 0.5, 0.5]);
        assert!((n - Vector::new(0.0, -1.0, 1.0) / 2.0_f64.sqrt()).amax() < 1e-15, "{n:?}");
        assert_eq!(normal([0.0; 3], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]), Vector::zeros());
    }

    #[test]
    fn unit_vectors_of_any_length() {
        for length in [1e-320, 1e-200, 1.0, 1e200, 1e307] {
            let v = unit(&Vector::new(length, -2.0 * length, 2.0 * length));
            assert!((v - Vector::new(1.0, -2.0, 2.0) / 3.0).amax() < 1e-3, "{v:?}");
            assert!((v.norm() - 1.0).abs() < 1e-15);
        }
        assert_eq!(unit(&Vector::zeros()), Vector::zeros());
    }
}
