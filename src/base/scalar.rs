//! Numbers that a formula of rounding is written for: doubles, or their stand-ins where its rounding is proved (`proofs/`).
//!
//! A formula on which a bound rests is generic over [`Scalar`], so that the proved code is the code that runs. For doubles all of
//! it is inlined.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number whose operations round.
pub trait Scalar:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
}

impl Scalar for f64 {
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }
}

/// Numbers that can be added and multiplied: double-doubles, or their stand-ins.
pub trait Ring: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl<D: Copy + Add<Output = D> + Sub<Output = D> + Mul<Output = D>> Ring for D {}

/// A constant.
#[inline(always)]
pub fn constant<S: Scalar>(x: f64) -> S {
    S::from(x)
}

/// (x·x′ + y·y′) + z·z′.
#[inline(always)]
pub fn dot<S: Scalar>([x, y, z]: [S; 3], other: [S; 3]) -> S {
    x * other[0] + y * other[1] + z * other[2]
}

/// a·(b × c).
#[inline(always)]
pub fn determinant<S: Scalar>([a, b, c]: [[S; 3]; 3]) -> S {
    let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
    dot(a, cross)
}
