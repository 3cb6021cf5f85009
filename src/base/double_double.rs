//! Double-double arithmetic: a number as the unevaluated sum of two doubles, about 106 bits.
//!
//! Error-free transformations after T. J. Dekker, "A Floating-Point Technique for Extending the Available Precision",
//! Numerische Mathematik 18 (1971), and D. E. Knuth, The Art of Computer Programming, vol. 2, §4.2.2. Products are split
//! rather than fused: without a target that has the instruction, a fused multiply-add is a library call. The transformations
//! are error-free while nothing under- or overflows; the callers say why that does not matter to them.

use std::ops::{Add, Mul, Sub};

use crate::base::math::Vector;
use crate::base::scalar::{Ring, Scalar, constant};

/// hi + lo with |lo| ≤ u·|hi|.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DoubleDouble<S = f64> {
    /// The sum rounded to double.
    pub hi: S,
    /// The rest.
    pub lo: S,
}

/// a + b exactly.
#[inline]
pub fn two_sum<S: Scalar>(a: S, b: S) -> DoubleDouble<S> {
    let hi = a + b;
    let b_part = hi - a;
    DoubleDouble { hi, lo: (a - (hi - b_part)) + (b - b_part) }
}

/// a·b exactly.
#[inline]
pub fn two_product<S: Scalar>(a: S, b: S) -> DoubleDouble<S> {
    let hi = a * b;
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    let lo = a_low * b_low - (((hi - a_high * b_high) - a_low * b_high) - a_high * b_low);
    DoubleDouble { hi, lo }
}

/// a as the sum of two numbers of 26 bits (Veltkamp's splitting).
#[inline]
fn split<S: Scalar>(a: S) -> (S, S) {
    const SPLITTER: f64 = 134_217_729.0; // 2²⁷ + 1
    let c = constant::<S>(SPLITTER) * a;
    let high = c - (c - a);
    (high, a - high)
}

/// hi + lo where |hi| ≥ |lo| or hi = 0.
#[inline]
fn renormalise<S: Scalar>(hi: S, lo: S) -> DoubleDouble<S> {
    let sum = hi + lo;
    DoubleDouble { hi: sum, lo: lo - (sum - hi) }
}

impl<S: Scalar> From<S> for DoubleDouble<S> {
    #[inline]
    fn from(hi: S) -> Self {
        DoubleDouble { hi, lo: constant(0.0) }
    }
}

impl<S: Scalar> Add for DoubleDouble<S> {
    type Output = DoubleDouble<S>;

    /// Off by at most 3u² of the sum, to first order (M. Joldes, J.-M. Muller, V. Popescu, "Tight and Rigorous Error Bounds for
    /// Basic Building Blocks of Double-Word Arithmetic", 2017, algorithm 6). `proofs/coq/double_double.v` proves 3u² of the sum of
    /// both magnitudes.
    #[inline]
    fn add(self, other: DoubleDouble<S>) -> DoubleDouble<S> {
        let high = two_sum(self.hi, other.hi);
        let low = two_sum(self.lo, other.lo);
        let first = renormalise(high.hi, high.lo + low.hi);
        renormalise(first.hi, first.lo + low.lo)
    }
}

impl<S: Scalar> Sub for DoubleDouble<S> {
    type Output = DoubleDouble<S>;

    #[inline]
    fn sub(self, other: DoubleDouble<S>) -> DoubleDouble<S> {
        self + DoubleDouble { hi: -other.hi, lo: -other.lo }
    }
}

impl<S: Scalar> Mul for DoubleDouble<S> {
    type Output = DoubleDouble<S>;

    /// Off by at most 8u² of the product: the cross terms are at most u each and rounded by u² each, their sum by 2u², the sum
    /// with the low word by 3u², and the product of the low words, u², is left out.
    #[inline]
    fn mul(self, other: DoubleDouble<S>) -> DoubleDouble<S> {
        let product = two_product(self.hi, other.hi);
        renormalise(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

/// A vector of double-doubles.
pub type WideVector = [DoubleDouble; 3];

/// p − q, exactly (as a sum of two vectors of doubles).
#[inline]
pub fn wide_difference(p: &Vector, q: &Vector) -> WideVector {
    [two_sum(p.x, -q.x), two_sum(p.y, -q.y), two_sum(p.z, -q.z)]
}

/// a × b; each component is off by less than 2⁻¹⁰⁰·|a||b|.
#[inline]
pub fn wide_cross<D: Ring>(a: &[D; 3], b: &[D; 3]) -> [D; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a·b, off by less than 2⁻¹⁰⁰·|a||b|.
#[inline]
pub fn wide_dot<D: Ring>(a: &[D; 3], b: &[D; 3]) -> D {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A vector as double-doubles.
#[inline]
pub fn widen(v: &Vector) -> WideVector {
    [v.x.into(), v.y.into(), v.z.into()]
}

/// Rounded to doubles.
#[inline]
pub fn narrow(v: &WideVector) -> Vector {
    Vector::new(v[0].hi, v[1].hi, v[2].hi)
}
