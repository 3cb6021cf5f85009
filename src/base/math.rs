//! Vectors, poses and the constants of rounding-error bounds.
//!
//! nalgebra's types are aliased here and nowhere else.

use crate::base::error::{Error, Result};
use crate::base::scalar::{Scalar, constant, dot};

/// A point or a direction in three dimensions.
pub type Vector = nalgebra::Vector3<f64>;
/// A 3x3 matrix.
pub type Matrix = nalgebra::Matrix3<f64>;

/// The unit roundoff u = 2⁻⁵³ of double precision: |fl(x) − x| ≤ u·|x|.
pub const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// The largest |RᵀR − I| entry at which a rotation is accepted unless the caller tightens it.
pub const ROTATION_LIMIT: f64 = 1e-2;

/// The spectral norm of a rotation whose RᵀR − I has entries up to [`ROTATION_LIMIT`] is at most √(1 + 3·1e-2).
pub const STRETCH: f64 = 1.015;

/// The length of a vector whose squares may leave the range of doubles; NaN where a coordinate is.
#[inline]
pub fn length(v: &Vector) -> f64 {
    let square = v.norm_squared();
    if (f64::MIN_POSITIVE..f64::INFINITY).contains(&square) { square.sqrt() } else { scaled_length(v) }
}

#[cold]
fn scaled_length(v: &Vector) -> f64 {
    // `amax` passes over a NaN.
    let scale = if v.iter().any(|x| x.is_nan()) { f64::NAN } else { v.amax() };
    if scale > 0.0 && scale.is_finite() { (v / scale).norm() * scale } else { scale }
}

/// `x` put into [`low`, `high`]; `low` for a NaN. In one comparison each, which `f64::max` and `f64::min` are not: they treat NaN
/// differently.
#[inline(always)]
pub fn clamp(x: f64, low: f64, high: f64) -> f64 {
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}

/// A number from 0 on to divide by: at least the least normal one, so that no 0/0 is computed where centres or points are one.
#[inline(always)]
pub fn divisor(x: f64) -> f64 {
    if x > f64::MIN_POSITIVE { x } else { f64::MIN_POSITIVE }
}

/// 2^`exponent`, from −1022 to 1023, exactly: `powi` promises no precision.
#[inline]
pub fn power_of_two(exponent: i32) -> f64 {
    debug_assert!((-1022..=1023).contains(&exponent), "{exponent}");
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

/// The exponent e of a number 2^e·m, 1 ≤ m < 2; of 0 and infinity less and more than any other. The system's `log2` may be off.
#[inline]
pub fn binary_order(x: f64) -> i32 {
    debug_assert!(x >= 0.0);
    let exponent = |x: f64| (x.to_bits() >> 52) as i32 - 1023;
    // Subnormal numbers have none of their own.
    if x < f64::MIN_POSITIVE { exponent(x * power_of_two(54)) - 54 } else { exponent(x) }
}

/// A power of two times which a length of this order has a square that is a double and not lost; 1 where it has one as it is.
#[inline]
pub fn moderate_unit(length: f64) -> f64 {
    debug_assert!(length >= 0.0);
    if (1e-100..=1e100).contains(&length) { 1.0 } else { power_of_two(-binary_order(length).clamp(-1022, 1022)) }
}

/// The vector times a power of two, such that the product of two is a double and not lost, whatever their lengths.
pub fn moderate(v: &Vector) -> Vector {
    v * moderate_unit(v.amax())
}

/// Whether all coordinates are finite.
#[inline]
pub fn are_finite(v: &Vector) -> bool {
    v.iter().all(|x| x.is_finite())
}

/// Whether |v|² is 1 up to 1e-9: the assertion for unit vectors.
#[inline]
pub fn is_unit(v: &Vector) -> bool {
    (v.norm_squared() - 1.0).abs() <= 1e-9
}

/// R·d in plain rounded arithmetic.
#[inline(always)]
pub fn rotated<S: Scalar>([a, b, c]: &[[S; 4]; 3], d: [S; 3]) -> [S; 3] {
    [dot([a[0], a[1], a[2]], d), dot([b[0], b[1], b[2]], d), dot([c[0], c[1], c[2]], d)]
}

/// The entries of RᵀR − I as computed: the diagonal, then those beside it.
#[inline(always)]
pub fn orthonormality<S: Scalar>([a, b, c]: &[[S; 4]; 3]) -> [S; 6] {
    let one = constant(1.0);
    let [x, y, z] = [[a[0], b[0], c[0]], [a[1], b[1], c[1]], [a[2], b[2], c[2]]];
    [dot(x, x) - one, dot(y, y) - one, dot(z, z) - one, dot(x, y), dot(x, z), dot(y, z)]
}

/// An object's placement: world point = R·(local point) + T, exactly as the doubles give it. R is nearly orthonormal,
/// but no answer assumes that it is perfectly so.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Pose {
    /// The row-major 3x4 matrix `[R|T]`.
    pub rows: [[f64; 4]; 3],
}

impl Pose {
    /// The identity.
    pub const IDENTITY: Pose = Pose { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] };

    /// From twelve numbers, row-major `[R|T]`. Nothing is checked; see [`Pose::check`].
    pub fn from_row_major(m: &[f64; 12]) -> Pose {
        Pose { rows: [[m[0], m[1], m[2], m[3]], [m[4], m[5], m[6], m[7]], [m[8], m[9], m[10], m[11]]] }
    }

    /// From a rotation and a translation.
    pub fn new(rotation: &Matrix, translation: &Vector) -> Pose {
        let row = |i: usize| [rotation[(i, 0)], rotation[(i, 1)], rotation[(i, 2)], translation[i]];
        Pose { rows: [row(0), row(1), row(2)] }
    }

    /// R.
    pub fn rotation(&self) -> Matrix {
        let r = &self.rows;
        Matrix::new(r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2])
    }

    /// T.
    pub fn translation(&self) -> Vector {
        Vector::new(self.rows[0][3], self.rows[1][3], self.rows[2][3])
    }

    /// R·p + T in plain rounded arithmetic.
    pub fn transform(&self, p: &Vector) -> Vector {
        self.rotate(p) + self.translation()
    }

    /// The pose of an object at `inner` in a frame that is at this pose, each number rounded.
    pub(crate) fn after(&self, inner: &Pose) -> Pose {
        Pose::new(&(self.rotation() * inner.rotation()), &self.transform(&inner.translation()))
    }

    /// R·d in plain rounded arithmetic.
    pub fn rotate(&self, d: &Vector) -> Vector {
        rotated(&self.rows, (*d).into()).into()
    }

    /// Rᵀ·d in plain rounded arithmetic: maps a world direction *into* the object. For any R the support function of R·K in
    /// direction U is that of K in direction RᵀU.
    pub fn rotate_back(&self, d: &Vector) -> Vector {
        let r = &self.rows;
        Vector::new(
            r[0][0] * d.x + r[1][0] * d.y + r[2][0] * d.z,
            r[0][1] * d.x + r[1][1] * d.y + r[2][1] * d.z,
            r[0][2] * d.x + r[1][2] * d.y + r[2][2] * d.z,
        )
    }

    /// The largest entry of |RᵀR − I| as computed (its own rounding error is at most 4u for an accepted R), or NaN.
    #[inline(always)]
    pub fn rotation_defect(&self) -> f64 {
        let entries = orthonormality(&self.rows).map(f64::abs);
        // One instruction each, where f64::max takes several.
        let worst = entries.into_iter().fold(0.0, |worst, entry| if entry > worst { entry } else { worst });
        // A comparison loses a NaN, a sum does not.
        if entries.into_iter().sum::<f64>().is_nan() { f64::NAN } else { worst }
    }

    /// R makes a vector at most so many times as long: where no entry of RᵀR − I exceeds d, |R·v|² ≤ (1 + 3d)·|v|².
    pub fn most_stretched(&self) -> f64 {
        1.0 + 1.5 * (self.rotation_defect() + 8.0 * UNIT_ROUNDOFF)
    }

    /// Accepts a pose of finite numbers with |RᵀR − I| ≤ [`ROTATION_LIMIT`] in every entry and det R > 0.
    pub fn check(&self) -> Result<()> {
        self.checked_defect().map(|_| ())
    }

    /// The same, and what [`Pose::rotation_defect`] says.
    #[inline]
    pub fn checked_defect(&self) -> Result<f64> {
        let defect = self.rotation_defect();
        // If x is not finite, 0·x is a NaN. Where R is not, the defect is a NaN or infinite.
        let [[.., x], [.., y], [.., z]] = self.rows;
        let is_finite = 0.0 * (x + y + z) == 0.0;
        if is_finite & (defect <= ROTATION_LIMIT) && self.rotation().determinant() > 0.0 {
            return Ok(defect);
        }
        self.refusal()
    }

    /// Why a pose is not accepted; the sum of its numbers may have overflowed.
    #[cold]
    fn refusal(&self) -> Result<f64> {
        if let Some(k) = self.rows.iter().flatten().position(|x| !x.is_finite()) {
            return Err(Error::Pose(format!("pose entry {k} (row {}, column {}) is not finite", k / 4, k % 4)));
        }
        let defect = self.rotation_defect();
        if !(defect <= ROTATION_LIMIT) {
            return Err(Error::Pose(format!(
                "the rotation is not orthonormal: an entry of RᵀR − I is {defect:e}, the limit is {ROTATION_LIMIT:e}"
            )));
        }
        if !(self.rotation().determinant() > 0.0) {
            return Err(Error::Pose("the rotation is a reflection: its determinant is negative".into()));
        }
        Ok(defect)
    }
}
