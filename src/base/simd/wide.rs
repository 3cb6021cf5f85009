//! Four doubles in one register of AVX2 with FMA, and the same with AVX-512.

use super::wide_twins::WideTwins;
use super::{Features, Kernel, Lanes, Work};
use crate::base::math::Vector;
use std::arch::x86_64::*;
use std::sync::atomic::{AtomicU8, Ordering};

/// The number of the [`Features`] that there are, 0 before anybody looked. The standard library's own memory of them takes
/// twice as long to read.
static FOUND: AtomicU8 = AtomicU8::new(0);

#[inline(always)]
pub(super) fn features() -> Features {
    const AVX512: u8 = Features::Avx512 as u8;
    const AVX2: u8 = Features::Avx2 as u8;
    match FOUND.load(Ordering::Relaxed) {
        AVX512 => Features::Avx512,
        AVX2 => Features::Avx2,
        0 => look(),
        _ => Features::Baseline,
    }
}

pub(super) fn narrow_to(most: Features) {
    FOUND.store(features().min(most) as u8, Ordering::Relaxed);
}

#[cold]
fn look() -> Features {
    use std::arch::is_x86_feature_detected as has;
    let found = if !(has!("avx2") && has!("fma")) {
        Features::Baseline
    } else if has!("avx512f") && has!("avx512vl") && has!("avx512dq") && has!("bmi1") && has!("bmi2") {
        Features::Avx512
    } else {
        Features::Avx2
    };
    FOUND.store(found as u8, Ordering::Relaxed);
    found
}

/// # Safety
/// The machine has AVX2 and FMA.
#[target_feature(enable = "avx2,fma")]
pub(super) unsafe fn run_with_avx2<K: Kernel>(kernel: &mut K) -> K::Output {
    kernel.run::<Wide<false>>()
}

/// # Safety
/// The machine has all these features.
#[target_feature(enable = "avx2,fma,bmi1,bmi2,avx512f,avx512vl,avx512dq")]
pub(super) unsafe fn run_with_avx512<K: Kernel>(kernel: &mut K) -> K::Output {
    kernel.run::<Wide<true>>()
}

/// # Safety
/// The machine has AVX2 and FMA.
#[target_feature(enable = "avx2,fma")]
#[inline(never)]
unsafe fn work_with_avx2<W: Work>(work: &mut W) -> W::Output {
    work.run()
}

/// # Safety
/// The machine has all these features.
#[target_feature(enable = "avx2,fma,bmi1,bmi2,avx512f,avx512vl,avx512dq")]
#[inline(never)]
unsafe fn work_with_avx512<W: Work>(work: &mut W) -> W::Output {
    work.run()
}

/// An AVX register. Only the functions above make the type reachable, so its methods only run where the features are there.
#[derive(Clone, Copy)]
pub(super) struct Wide<const WITH_AVX512: bool>(__m256d);

impl<const WITH_AVX512: bool> Wide<WITH_AVX512> {
    /// Products of eight vectors with this one.
    #[inline(always)]
    fn products(self, [x, y, z]: [&[f32; 8]; 3]) -> __m256 {
        // SAFETY: `Wide` exists only where AVX2 and FMA have been found; the pointers are to eight readable numbers.
        unsafe {
            let half = _mm256_cvtpd_ps(self.0);
            let both = _mm256_set_m128(half, half);
            let product = _mm256_mul_ps(_mm256_loadu_ps(x.as_ptr()), _mm256_permute_ps::<0b00_00_00_00>(both));
            let product =
                _mm256_fmadd_ps(_mm256_loadu_ps(y.as_ptr()), _mm256_permute_ps::<0b01_01_01_01>(both), product);
            _mm256_fmadd_ps(_mm256_loadu_ps(z.as_ptr()), _mm256_permute_ps::<0b10_10_10_10>(both), product)
        }
    }
}

/// The greatest of eight numbers, in all lanes.
///
/// # Safety
/// The machine has AVX2.
#[inline(always)]
unsafe fn greatest_lane(numbers: __m256) -> __m256 {
    // SAFETY: as above.
    unsafe {
        let four = _mm256_max_ps(numbers, _mm256_permute2f128_ps::<0x01>(numbers, numbers));
        let two = _mm256_max_ps(four, _mm256_permute_ps::<0b01_00_11_10>(four));
        _mm256_max_ps(two, _mm256_permute_ps::<0b10_11_00_01>(two))
    }
}

// SAFETY of every block below: `Wide` exists only inside `run`, whose caller has checked for AVX2 and FMA.
impl<const WITH_AVX512: bool> Lanes for Wide<WITH_AVX512> {
    type Twins = WideTwins;
    const IS_FUSED: bool = true;
    #[inline(always)]
    fn twins(self, second: Self) -> WideTwins {
        // SAFETY: see above.
        WideTwins(unsafe { _mm256_set_m128(_mm256_cvtpd_ps(second.0), _mm256_cvtpd_ps(self.0)) })
    }
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
    /// In two pieces that the compiler leaves alone. From plain numbers it would merge several vectors into wider ones, with
    /// AVX-512 of 512 bits. These cost an Intel Xeon a fifth of the time at 0.1°.
    #[inline(always)]
    fn store_vector(self, to: &mut [f64; 3]) {
        // SAFETY: see above; the pointers are to two and to one writable doubles.
        unsafe {
            _mm_storeu_pd(to.as_mut_ptr(), _mm256_castpd256_pd128(self.0));
            _mm_store_sd(to.as_mut_ptr().add(2), _mm256_extractf128_pd::<1>(self.0));
        }
    }
    #[inline(always)]
    fn load_single(x: &[u32; 4]) -> Self {
        // SAFETY: see above; the pointer is to four readable words.
        Wide(unsafe { _mm256_cvtps_pd(_mm_loadu_ps(x.as_ptr().cast())) })
    }
    #[inline(always)]
    fn store_single(self, to: &mut [u32; 4]) {
        // SAFETY: see above; the pointer is to four writable words.
        unsafe { _mm_storeu_ps(to.as_mut_ptr().cast(), _mm256_cvtpd_ps(self.0)) };
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
    fn negate(self) -> Self {
        // SAFETY: see above.
        Wide(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)) })
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
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: see above.
        unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0)) as u32 }
    }
    #[inline(always)]
    fn norm1(self) -> f64 {
        // SAFETY: see above.
        let magnitude = unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) };
        Wide(magnitude).dot(Self::splat(1.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see above.
        Wide(unsafe { _mm256_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see above.
        Wide(unsafe { _mm256_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see above.
        Wide(unsafe { _mm256_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn components(vectors: &[Self; 4]) -> [Self; 3] {
        let [a, b, c, d] = vectors;
        // SAFETY: see above.
        unsafe {
            let even_ab = _mm256_unpacklo_pd(a.0, b.0); // a.x b.x a.z b.z
            let odd_ab = _mm256_unpackhi_pd(a.0, b.0); // a.y b.y …
            let even_cd = _mm256_unpacklo_pd(c.0, d.0);
            let odd_cd = _mm256_unpackhi_pd(c.0, d.0);
            [
                Wide(_mm256_permute2f128_pd::<0x20>(even_ab, even_cd)),
                Wide(_mm256_permute2f128_pd::<0x20>(odd_ab, odd_cd)),
                Wide(_mm256_permute2f128_pd::<0x31>(even_ab, even_cd)),
            ]
        }
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: see above.
        Wide(unsafe { _mm256_div_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self {
        // SAFETY: see above.
        Wide(unsafe { _mm256_blendv_pd(other.0, self.0, _mm256_cmp_pd::<_CMP_GT_OQ>(left.0, right.0)) })
    }
    #[inline(always)]
    fn with_first(self, other: Self) -> Self {
        // SAFETY: see above.
        Wide(unsafe { _mm256_blend_pd::<0b0001>(self.0, other.0) })
    }
    #[inline(always)]
    fn upper_halves(first: Self, second: Self) -> Self {
        // SAFETY: see above.
        Wide(unsafe { _mm256_permute2f128_pd::<0x31>(first.0, second.0) })
    }
    #[inline(always)]
    fn products_are_below(self, vectors: [&[f32; 8]; 3], limit: f32) -> bool {
        let products = self.products(vectors);
        // SAFETY: see above.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(products, _mm256_set1_ps(limit))) == 0xff }
    }
    #[inline(always)]
    fn greatest_product(self, vectors: [&[f32; 8]; 3]) -> (f32, usize) {
        let products = self.products(vectors);
        // SAFETY: see above.
        unsafe {
            let all = greatest_lane(products);
            let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_EQ_OQ>(products, all)) as u32;
            (_mm256_cvtss_f32(all), (mask | 0x80).trailing_zeros() as usize)
        }
    }
    #[inline(always)]
    fn extreme_products(self, vectors: &[[[f32; 8]; 3]]) -> [f32; 2] {
        // SAFETY: see above.
        unsafe {
            let (mut least, mut greatest) = (_mm256_set1_ps(f32::INFINITY), _mm256_set1_ps(f32::NEG_INFINITY));
            for [x, y, z] in vectors {
                let products = self.products([x, y, z]);
                least = _mm256_min_ps(least, products);
                greatest = _mm256_max_ps(greatest, products);
            }
            let (mut low, mut high) = ([0.0; 8], [0.0; 8]);
            _mm256_storeu_ps(low.as_mut_ptr(), least);
            _mm256_storeu_ps(high.as_mut_ptr(), greatest);
            [low.into_iter().fold(f32::INFINITY, f32::min), high.into_iter().fold(f32::NEG_INFINITY, f32::max)]
        }
    }
    #[inline(always)]
    fn farthest_product(self, vectors: &[[[f32; 8]; 3]]) -> (usize, [f32; 2]) {
        // SAFETY: see above.
        unsafe {
            let mut greatest = _mm256_set1_ps(f32::NEG_INFINITY);
            let mut second = greatest;
            let (mut place, mut block) = (_mm256_setzero_si256(), _mm256_setzero_si256());
            for [x, y, z] in vectors {
                let products = self.products([x, y, z]);
                let is_greater = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_GT_OQ>(products, greatest));
                place = _mm256_blendv_epi8(place, block, is_greater);
                second = _mm256_max_ps(second, _mm256_min_ps(greatest, products));
                greatest = _mm256_max_ps(greatest, products);
                block = _mm256_add_epi32(block, _mm256_set1_epi32(8));
            }
            let all = greatest_lane(greatest);
            let is_greatest = _mm256_cmp_ps::<_CMP_EQ_OQ>(greatest, all);
            let mask = _mm256_movemask_ps(is_greatest) as u32;
            let lane = (mask | 0x80).trailing_zeros() as usize;
            let mut places = [0_u32; 8];
            _mm256_storeu_si256(places.as_mut_ptr().cast(), place);
            // Of two that are equal one is the second.
            let others =
                if mask & mask.wrapping_sub(1) == 0 { _mm256_blendv_ps(greatest, second, is_greatest) } else { all };
            (places[lane] as usize + lane, [_mm256_cvtss_f32(all), _mm256_cvtss_f32(greatest_lane(others))])
        }
    }
    /// Two blocks at a time, each with its own greatest numbers: one alone would wait for those before.
    #[inline(always)]
    fn farthest_of(self, vectors: &[[[f32; 8]; 3]]) -> usize {
        // SAFETY: see above.
        unsafe {
            let mut greatest = [_mm256_set1_ps(f32::NEG_INFINITY); 2];
            let mut places = [_mm256_setzero_si256(); 2];
            let mut block = _mm256_setzero_si256();
            let (pairs, rest) = vectors.as_chunks::<2>();
            for pair in pairs {
                for (half, [x, y, z]) in pair.iter().enumerate() {
                    let products = self.products([x, y, z]);
                    let is_greater = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_GT_OQ>(products, greatest[half]));
                    places[half] = _mm256_blendv_epi8(places[half], block, is_greater);
                    greatest[half] = _mm256_max_ps(greatest[half], products);
                }
                block = _mm256_add_epi32(block, _mm256_set1_epi32(16));
            }
            for [x, y, z] in rest {
                let products = self.products([x, y, z]);
                let is_greater = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_GT_OQ>(products, greatest[0]));
                places[0] = _mm256_blendv_epi8(places[0], block, is_greater);
                greatest[0] = _mm256_max_ps(greatest[0], products);
            }
            let is_greater = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_GT_OQ>(greatest[1], greatest[0]));
            let of_second = _mm256_add_epi32(places[1], _mm256_set1_epi32(8));
            let place = _mm256_blendv_epi8(places[0], of_second, is_greater);
            let greatest = _mm256_max_ps(greatest[0], greatest[1]);
            let all = greatest_lane(greatest);
            let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_EQ_OQ>(greatest, all)) as u32;
            let lane = (mask | 0x80).trailing_zeros() as usize;
            let mut places = [0_u32; 8];
            _mm256_storeu_si256(places.as_mut_ptr().cast(), place);
            places[lane] as usize + lane
        }
    }
    #[inline(always)]
    fn least(self) -> (f64, usize) {
        // SAFETY: see above.
        unsafe {
            let pair = _mm256_min_pd(self.0, _mm256_permute2f128_pd::<0x01>(self.0, self.0));
            let all = _mm256_min_pd(pair, _mm256_permute_pd::<0b0101>(pair));
            let mask = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_EQ_OQ>(self.0, all)) as u32;
            (_mm256_cvtsd_f64(all), (mask | 0b1000).trailing_zeros() as usize)
        }
    }
    #[inline(always)]
    fn prefetch<T>(elements: &[T], index: u32) {
        let first = elements.as_ptr().wrapping_add(index as usize).cast::<i8>();
        for line in [0, 64, 128] {
            // SAFETY: a hint; nothing is read, whatever the address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(line)) };
        }
    }
    #[inline(always)]
    fn out_of_line<W: Work>(work: &mut W) -> W::Output {
        // SAFETY: see above.
        unsafe { if WITH_AVX512 { work_with_avx512(work) } else { work_with_avx2(work) } }
    }
}
