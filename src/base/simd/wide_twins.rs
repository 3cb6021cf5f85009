//! Two vectors in single precision in one register of AVX2 with FMA.

use super::twins::Twins;
use std::arch::x86_64::*;

/// An AVX register. Only where [`super::wide::Wide`] exists is one made.
#[derive(Clone, Copy)]
pub(super) struct WideTwins(pub(super) __m256);

// SAFETY of every block below: same as `Wide`, whose lanes alone lead here.
impl Twins for WideTwins {
    #[inline(always)]
    fn load(first: &[f32; 4], second: &[f32; 4]) -> Self {
        // SAFETY: see above; the pointers are to four readable numbers each.
        WideTwins(unsafe { _mm256_set_m128(_mm_loadu_ps(second.as_ptr()), _mm_loadu_ps(first.as_ptr())) })
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        let mut out = [0.0; 8];
        // SAFETY: see above; the pointer is to eight writable numbers.
        unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn splat(first: f32, second: f32) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_set_m128(_mm_set1_ps(second), _mm_set1_ps(first)) })
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_add_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_sub_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_mul_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_fmadd_ps(self.0, factor.0, addend.0) })
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_fnmadd_ps(self.0, factor.0, addend.0) })
    }
    #[inline(always)]
    fn splat_x(self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_permute_ps::<0b00_00_00_00>(self.0) })
    }
    #[inline(always)]
    fn splat_y(self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_permute_ps::<0b01_01_01_01>(self.0) })
    }
    #[inline(always)]
    fn splat_z(self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_permute_ps::<0b10_10_10_10>(self.0) })
    }
    #[inline(always)]
    fn rotate(self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_permute_ps::<0b11_00_10_01>(self.0) })
    }
    #[inline(always)]
    fn negate_first(self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_xor_ps(self.0, _mm256_set_m128(_mm_setzero_ps(), _mm_set1_ps(-0.0))) })
    }
    #[inline(always)]
    fn swap(self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_permute2f128_ps::<1>(self.0, self.0) })
    }
    #[inline(always)]
    fn dots(self, other: Self) -> [f32; 2] {
        // SAFETY: see above.
        unsafe {
            let products = _mm256_mul_ps(self.0, other.0);
            [sum_of_three(_mm256_castps256_ps128(products)), sum_of_three(_mm256_extractf128_ps::<1>(products))]
        }
    }
    #[inline(always)]
    fn dot(self, other: Self) -> f32 {
        // SAFETY: see above.
        unsafe { sum_of_three(_mm_mul_ps(_mm256_castps256_ps128(self.0), _mm256_castps256_ps128(other.0))) }
    }
}

/// # Safety
/// The machine has AVX2.
#[inline(always)]
unsafe fn sum_of_three(products: __m128) -> f32 {
    // SAFETY: by the caller.
    unsafe {
        let sum = _mm_add_ss(products, _mm_movehdup_ps(products));
        _mm_cvtss_f32(_mm_add_ss(sum, _mm_movehl_ps(products, products)))
    }
}
