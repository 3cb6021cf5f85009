//! Four doubles at a time, dispatched once per query to AVX2 with FMA where the machine has them.
//!
//! A query is written once, generic over [`Lanes`], and compiled twice: with [`Portable`] for the baseline of the target, and
//! with `Wide` inside a function that enables the features. Everything on the query's path is `#[inline(always)]`, so that
//! it is compiled with the features of its caller. Not AVX-512: an early version with it
//! was slower (2026-11).
//!
//! The only `unsafe` outside the C interface.

#![allow(unsafe_code)]

use crate::math::Vector;

/// Four doubles. Of a vector in three dimensions lanes 0 to 2 are the components and lane 3 is unspecified.
pub trait Lanes: Copy {
    /// All lanes equal.
    fn splat(x: f64) -> Self;
    /// From memory.
    fn load(x: &[f64; 4]) -> Self;
    /// To memory.
    fn to_array(self) -> [f64; 4];
    /// A vector.
    fn from_vector(v: &Vector) -> Self;
    /// Lanes 0 to 2.
    fn to_vector(self) -> Vector;
    /// Sum.
    fn add(self, other: Self) -> Self;
    /// Difference.
    fn sub(self, other: Self) -> Self;
    /// Product.
    fn mul(self, other: Self) -> Self;
    /// self·factor + addend; fused where the machine can, which only lowers the rounding error.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// addend − self·factor, like [`Lanes::mul_add`].
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self;
    /// Bit i is set where lane i is greater than that of `other`; a NaN is not.
    fn greater(self, other: Self) -> u32;
    /// All lanes equal to lane 0.
    fn splat_x(self) -> Self;
    /// All lanes equal to lane 1.
    fn splat_y(self) -> Self;
    /// All lanes equal to lane 2.
    fn splat_z(self) -> Self;
    /// The columns of the 3x4 matrix with these rows; lane 3 of each is 0.
    fn transpose(rows: &[Self; 3]) -> [Self; 4];
    /// Lanes 1, 2, 0: (y, z, x) of a vector.
    fn rotate(self) -> Self;
    /// Sum of the products of lanes 0 to 2.
    fn dot(self, other: Self) -> f64;
    /// Whether lanes 0 to 2 of every value are at most the limit in magnitude; a NaN is not.
    fn all_within<const N: usize>(values: [(Self, Self); N]) -> bool;
    /// |x| + |y| + |z|, rounded.
    fn norm1(self) -> f64;

    /// The cross product.
    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        self.mul(other.rotate()).sub(self.rotate().mul(other)).rotate()
    }
    /// The vector with its sign changed.
    #[inline(always)]
    fn negate(self) -> Self {
        Self::splat(0.0).sub(self)
    }
}

/// Plain arrays, for any target.
#[derive(Clone, Copy)]
pub struct Portable([f64; 4]);

impl Lanes for Portable {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Portable([x; 4])
    }
    #[inline(always)]
    fn load(x: &[f64; 4]) -> Self {
        Portable(*x)
    }
    #[inline(always)]
    fn to_array(self) -> [f64; 4] {
        self.0
    }
    #[inline(always)]
    fn from_vector(v: &Vector) -> Self {
        Portable([v.x, v.y, v.z, v.z])
    }
    #[inline(always)]
    fn to_vector(self) -> Vector {
        Vector::new(self.0[0], self.0[1], self.0[2])
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Portable(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Portable(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Portable(std::array::from_fn(|i| self.0[i] * other.0[i]))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Portable(std::array::from_fn(|i| self.0[i] * factor.0[i] + addend.0[i]))
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        Portable(std::array::from_fn(|i| addend.0[i] - self.0[i] * factor.0[i]))
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u32 {
        let bit = |i: usize| u32::from(self.0[i] > other.0[i]) << i;
        bit(0) | bit(1) | bit(2) | bit(3)
    }
    #[inline(always)]
    fn splat_x(self) -> Self {
        Portable([self.0[0]; 4])
    }
    #[inline(always)]
    fn splat_y(self) -> Self {
        Portable([self.0[1]; 4])
    }
    #[inline(always)]
    fn splat_z(self) -> Self {
        Portable([self.0[2]; 4])
    }
    #[inline(always)]
    fn transpose(rows: &[Self; 3]) -> [Self; 4] {
        std::array::from_fn(|i| Portable([rows[0].0[i], rows[1].0[i], rows[2].0[i], 0.0]))
    }
    #[inline(always)]
    fn rotate(self) -> Self {
        Portable([self.0[1], self.0[2], self.0[0], self.0[3]])
    }
    #[inline(always)]
    fn dot(self, other: Self) -> f64 {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }
    #[inline(always)]
    fn all_within<const N: usize>(values: [(Self, Self); N]) -> bool {
        values.iter().all(|(value, limit)| (0..3).all(|i| value.0[i].abs() <= limit.0[i]))
    }
    #[inline(always)]
    fn norm1(self) -> f64 {
        self.0[0].abs() + self.0[1].abs() + self.0[2].abs()
    }
}

/// Work that can run on any [`Lanes`]; its `run` is to be `#[inline(always)]`.
pub trait Kernel {
    /// What it returns.
    type Output;
    /// The work.
    fn run<L: Lanes>(&mut self) -> Self::Output;
}

/// Runs the kernel on the widest lanes that this machine has.
#[inline(always)]
pub fn dispatch<K: Kernel>(kernel: &mut K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if wide::available() {
        // SAFETY: the features were just found on this machine.
        return unsafe { wide::run(kernel) };
    }
    run_portable(kernel)
}

/// Out of line: inlined beside the other branch it would spill that one's arguments.
#[inline(never)]
fn run_portable<K: Kernel>(kernel: &mut K) -> K::Output {
    kernel.run::<Portable>()
}

#[cfg(target_arch = "x86_64")]
mod wide {
    use super::{Kernel, Lanes};
    use crate::math::Vector;
    use std::arch::x86_64::*;

    #[inline(always)]
    pub(super) fn available() -> bool {
        std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
    }

    /// # Safety
    /// The machine has AVX2 and FMA.
    #[target_feature(enable = "avx2,fma")]
    pub(super) unsafe fn run<K: Kernel>(kernel: &mut K) -> K::Output {
        kernel.run::<Wide>()
    }

    /// An AVX register. Only `run` makes the type reachable, so its methods only run where the features are there.
    #[derive(Clone, Copy)]
    pub(super) struct Wide(__m256d);

    // SAFETY of every block below: `Wide` exists only inside `run`, whose caller has checked for AVX2 and FMA.
    impl Lanes for Wide {
        #[inline(always)]
        fn splat(x: f64) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_set1_pd(x) })
        }
        #[inline(always)]
        fn load(x: &[f64; 4]) -> Self {
            // SAFETY: see above; the pointer is to four readable doubles.
            Wide(unsafe { _mm256_loadu_pd(x.as_ptr()) })
        }
        #[inline(always)]
        fn to_array(self) -> [f64; 4] {
            let mut out = [0.0; 4];
            // SAFETY: see above; the pointer is to four writable doubles.
            unsafe { _mm256_storeu_pd(out.as_mut_ptr(), self.0) };
            out
        }
        #[inline(always)]
        fn from_vector(v: &Vector) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_set_pd(v.z, v.z, v.y, v.x) })
        }
        #[inline(always)]
        fn to_vector(self) -> Vector {
            let [x, y, z, _] = self.to_array();
            Vector::new(x, y, z)
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_add_pd(self.0, other.0) })
        }
        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_sub_pd(self.0, other.0) })
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_mul_pd(self.0, other.0) })
        }
        #[inline(always)]
        fn mul_add(self, factor: Self, addend: Self) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_fmadd_pd(self.0, factor.0, addend.0) })
        }
        #[inline(always)]
        fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_fnmadd_pd(self.0, factor.0, addend.0) })
        }
        #[inline(always)]
        fn greater(self, other: Self) -> u32 {
            // SAFETY: see above.
            unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(self.0, other.0)) as u32 }
        }
        #[inline(always)]
        fn splat_x(self) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_permute4x64_pd::<0b00_00_00_00>(self.0) })
        }
        #[inline(always)]
        fn splat_y(self) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_permute4x64_pd::<0b01_01_01_01>(self.0) })
        }
        #[inline(always)]
        fn splat_z(self) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_permute4x64_pd::<0b10_10_10_10>(self.0) })
        }
        #[inline(always)]
        fn transpose(rows: &[Self; 3]) -> [Self; 4] {
            // SAFETY: see above.
            unsafe {
                let zero = _mm256_setzero_pd();
                let even01 = _mm256_unpacklo_pd(rows[0].0, rows[1].0); // r0.x r1.x r0.z r1.z
                let odd01 = _mm256_unpackhi_pd(rows[0].0, rows[1].0); // r0.y r1.y r0.w r1.w
                let even2 = _mm256_unpacklo_pd(rows[2].0, zero); // r2.x 0 r2.z 0
                let odd2 = _mm256_unpackhi_pd(rows[2].0, zero); // r2.y 0 r2.w 0
                [
                    Wide(_mm256_permute2f128_pd::<0x20>(even01, even2)),
                    Wide(_mm256_permute2f128_pd::<0x20>(odd01, odd2)),
                    Wide(_mm256_permute2f128_pd::<0x31>(even01, even2)),
                    Wide(_mm256_permute2f128_pd::<0x31>(odd01, odd2)),
                ]
            }
        }
        #[inline(always)]
        fn rotate(self) -> Self {
            // SAFETY: see above.
            Wide(unsafe { _mm256_permute4x64_pd::<0b11_00_10_01>(self.0) })
        }
        #[inline(always)]
        fn dot(self, other: Self) -> f64 {
            // SAFETY: see above.
            unsafe {
                let product = _mm256_mul_pd(self.0, other.0);
                let low = _mm256_castpd256_pd128(product);
                let high = _mm256_extractf128_pd::<1>(product);
                let sum = _mm_add_sd(low, _mm_unpackhi_pd(low, low));
                _mm_cvtsd_f64(_mm_add_sd(sum, high))
            }
        }
        #[inline(always)]
        fn all_within<const N: usize>(values: [(Self, Self); N]) -> bool {
            // SAFETY: see above.
            unsafe {
                let sign = _mm256_set1_pd(-0.0);
                let mut all = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
                for (value, limit) in values {
                    let magnitude = _mm256_andnot_pd(sign, value.0);
                    all = _mm256_and_pd(all, _mm256_cmp_pd::<_CMP_LE_OQ>(magnitude, limit.0));
                }
                _mm256_movemask_pd(all) & 0b111 == 0b111
            }
        }
        #[inline(always)]
        fn norm1(self) -> f64 {
            // SAFETY: see above.
            let magnitude = unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) };
            Wide(magnitude).dot(Self::splat(1.0))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Sample;
    impl Kernel for Sample {
        type Output = ([f64; 4], [[f64; 4]; 4], f64, u32);
        #[inline(always)]
        fn run<L: Lanes>(&mut self) -> Self::Output {
            let rows = [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0], [9.0, 10.0, 11.0, 12.0]].map(|r| L::load(&r));
            let [x, y, z] = rows;
            let combined = x.splat_x().mul_add(y.splat_y(), z.splat_z()).sub(x).add(y).mul(z);
            (combined.to_array(), L::transpose(&rows).map(L::to_array), x.dot(y), y.greater(L::splat(6.5)))
        }
    }

    #[test]
    fn dispatched_lanes_equal_portable_ones() {
        let expected = Sample.run::<Portable>();
        assert_eq!(dispatch(&mut Sample), expected);
        assert_eq!(expected.1[3], [4.0, 8.0, 12.0, 0.0]);
        assert_eq!(expected.2, 38.0);
        assert_eq!(expected.3, 0b1100);
    }
}
