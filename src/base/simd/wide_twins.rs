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
    fn load_eight(numbers: &[f32; 8]) -> Self {
        // SAFETY: see above; the pointer is to eight readable numbers.
        WideTwins(unsafe { _mm256_loadu_ps(numbers.as_ptr()) })
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
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_div_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u32 {
        // SAFETY: see above.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(self.0, other.0)) as u32 }
    }
    #[inline(always)]
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_blendv_ps(other.0, self.0, _mm256_cmp_ps::<_CMP_GT_OQ>(left.0, right.0)) })
    }
    #[inline(always)]
    fn components(twins: &[Self; 4]) -> [Self; 3] {
        let [a, b, c, d] = twins;
        // SAFETY: see above.
        unsafe {
            let low_ab = _mm256_unpacklo_ps(a.0, b.0); // a.x b.x a.y b.y
            let low_cd = _mm256_unpacklo_ps(c.0, d.0);
            let high_ab = _mm256_unpackhi_ps(a.0, b.0); // a.z b.z …
            let high_cd = _mm256_unpackhi_ps(c.0, d.0);
            [
                WideTwins(_mm256_shuffle_ps::<0b01_00_01_00>(low_ab, low_cd)),
                WideTwins(_mm256_shuffle_ps::<0b11_10_11_10>(low_ab, low_cd)),
                WideTwins(_mm256_shuffle_ps::<0b01_00_01_00>(high_ab, high_cd)),
            ]
        }
    }
    #[inline(always)]
    fn least(self) -> (f32, usize) {
        // SAFETY: see above.
        unsafe {
            let four = _mm256_min_ps(self.0, _mm256_permute2f128_ps::<0x01>(self.0, self.0));
            let two = _mm256_min_ps(four, _mm256_permute_ps::<0b01_00_11_10>(four));
            let all = _mm256_min_ps(two, _mm256_permute_ps::<0b10_11_00_01>(two));
            let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_EQ_OQ>(self.0, all)) as u32;
            (_mm256_cvtss_f32(all), (mask | 0x80).trailing_zeros() as usize)
        }
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
