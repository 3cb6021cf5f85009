//! Four doubles at a time, dispatched once per query to AVX2 with FMA where the machine has them, and to AVX-512 where it has that.
//!
//! A query is written once, generic over [`Lanes`], and compiled three times: with [`Portable`] for the baseline of the target, and
//! with `Wide` inside functions that enable the features. Everything on the query's path is `#[inline(always)]`, so that it is
//! compiled with the features of its caller. AVX-512 means the same operations on the same four lanes, and so the same numbers; it
//! has twice the registers and operands broadcast from memory. On AMD's Zen 5 that saved a query whose features have not changed
//! 6 % of its time, others 1 to 2 %, on an Intel Xeon 8 % and 3 to 6 %, if the functions begin at multiples of 64 bytes (see
//! `.cargo/config.toml`); if not, both are equal there.
//!
//! The only `unsafe` outside the C interface, with that of [`environment`], the floating-point environment.

#![allow(unsafe_code)]

pub mod environment;

use crate::base::math::Vector;

/// Four doubles. Of a vector in three dimensions lanes 0 to 2 are the components and lane 3 is unspecified.
pub trait Lanes: Copy {
    /// All lanes equal.
    fn splat(x: f64) -> Self;
    /// From memory.
    fn load(x: &[f64; 4]) -> Self;
    /// To memory.
    fn to_array(self) -> [f64; 4];
    /// Lanes 0 to 2 to memory.
    fn store_vector(self, to: &mut [f64; 3]);
    /// From the bits of single-precision numbers in memory.
    fn load_single(x: &[u32; 4]) -> Self;
    /// To memory, as the bits of single-precision numbers.
    fn store_single(self, to: &mut [u32; 4]);
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
    /// The vector with its sign changed.
    fn negate(self) -> Self;
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
    /// Bit i is set where lane i is at most that of `other`; a NaN is not.
    fn at_most(self, other: Self) -> u32;
    /// |x| + |y| + |z|, rounded.
    fn norm1(self) -> f64;
    /// Lane by lane the greater one.
    fn max(self, other: Self) -> Self;
    /// Quotient.
    fn div(self, other: Self) -> Self;
    /// This where the lane of `left` is greater than that of `right`, elsewhere `other`.
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self;
    /// With lane 0 of `other`.
    fn with_first(self, other: Self) -> Self;
    /// Lanes 2 and 3 of one and of the other.
    fn upper_halves(first: Self, second: Self) -> Self;
    /// Whether the products of eight vectors (their x, y and z) with this one, all in single precision, are less than a limit;
    /// a NaN is not.
    fn products_are_below(self, vectors: [&[f32; 8]; 3], limit: f32) -> bool;
    /// The greatest of such products and which it is; the first of equals. Any if one is a NaN.
    fn greatest_product(self, vectors: [&[f32; 8]; 3]) -> (f32, usize);
    /// The least lane and which it is; the first of equals. Any lane if one is a NaN.
    fn least(self) -> (f64, usize);
    /// Asks the memory for an element that may soon be needed: the first three cache lines, which are what marching reads of a
    /// feature. Any index will do.
    #[inline(always)]
    fn prefetch<T>(_elements: &[T], _index: u32) {}
    /// Does the work out of line, compiled for these lanes.
    fn out_of_line<W: Work>(work: &mut W) -> W::Output;

    /// The cross product.
    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        self.mul(other.rotate()).sub(self.rotate().mul(other)).rotate()
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
    fn store_vector(self, to: &mut [f64; 3]) {
        let [x, y, z, _] = self.0;
        *to = [x, y, z];
    }
    #[inline(always)]
    fn load_single(x: &[u32; 4]) -> Self {
        Portable(x.map(|bits| f32::from_bits(bits).into()))
    }
    #[inline(always)]
    fn store_single(self, to: &mut [u32; 4]) {
        *to = self.0.map(|x| (x as f32).to_bits());
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
    fn negate(self) -> Self {
        Portable(self.0.map(|x| -x))
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
    fn at_most(self, other: Self) -> u32 {
        let bit = |i: usize| u32::from(self.0[i] <= other.0[i]) << i;
        bit(0) | bit(1) | bit(2) | bit(3)
    }
    #[inline(always)]
    fn norm1(self) -> f64 {
        self.0[0].abs() + self.0[1].abs() + self.0[2].abs()
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.where_greater(self, other, other)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Portable(std::array::from_fn(|i| self.0[i] / other.0[i]))
    }
    #[inline(always)]
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self {
        Portable(std::array::from_fn(|i| if left.0[i] > right.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn with_first(self, other: Self) -> Self {
        Portable([other.0[0], self.0[1], self.0[2], self.0[3]])
    }
    #[inline(always)]
    fn upper_halves(first: Self, second: Self) -> Self {
        Portable([first.0[2], first.0[3], second.0[2], second.0[3]])
    }
    #[inline(always)]
    fn products_are_below(self, vectors: [&[f32; 8]; 3], limit: f32) -> bool {
        self.products(vectors).iter().all(|product| *product < limit)
    }
    #[inline(always)]
    fn greatest_product(self, vectors: [&[f32; 8]; 3]) -> (f32, usize) {
        let products = self.products(vectors);
        let mut best = (products[0], 0);
        for (lane, product) in products.into_iter().enumerate() {
            if product > best.0 {
                best = (product, lane);
            }
        }
        best
    }
    #[inline(always)]
    fn least(self) -> (f64, usize) {
        let mut best = (self.0[0], 0);
        for (lane, value) in self.0.into_iter().enumerate() {
            if value < best.0 {
                best = (value, lane);
            }
        }
        best
    }
    #[inline(never)]
    fn out_of_line<W: Work>(work: &mut W) -> W::Output {
        work.run()
    }
}

impl Portable {
    #[inline(always)]
    fn products(self, [x, y, z]: [&[f32; 8]; 3]) -> [f32; 8] {
        let [a, b, c, _] = self.0.map(|lane| lane as f32);
        std::array::from_fn(|i| x[i] * a + y[i] * b + z[i] * c)
    }
}

/// Work that can run on any [`Lanes`]; its `run` is to be `#[inline(always)]`.
pub trait Kernel {
    /// What it returns.
    type Output;
    /// The work.
    fn run<L: Lanes>(&mut self) -> Self::Output;
}

/// Work on lanes that it has already; its `run` is to be `#[inline(always)]`.
pub trait Work {
    /// What it returns.
    type Output;
    /// The work.
    fn run(&mut self) -> Self::Output;
}

/// What a query may be compiled with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Features {
    /// What every machine of the target has.
    Baseline = 1,
    /// AVX2 and FMA.
    Avx2,
    /// AVX-512 with its foundation and its operations on short registers and on doublewords, and what came before it.
    Avx512,
}

/// Runs the kernel with the most that this machine has.
#[inline(always)]
pub fn dispatch<K: Kernel>(kernel: &mut K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    match wide::features() {
        // SAFETY: the features have been found on this machine.
        Features::Avx512 => return unsafe { wide::run_with_avx512(kernel) },
        // SAFETY: the features have been found on this machine.
        Features::Avx2 => return unsafe { wide::run_with_avx2(kernel) },
        Features::Baseline => {}
    }
    run_portable(kernel)
}

/// The same without AVX-512, for work that copies whole structures: the compiler then copies in 512 bits, with which bodies in each
/// other took 15 % longer on an Intel Xeon.
#[inline(always)]
pub fn dispatch_to_avx2<K: Kernel>(kernel: &mut K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if wide::features() >= Features::Avx2 {
        // SAFETY: the features have been found on this machine.
        return unsafe { wide::run_with_avx2(kernel) };
    }
    run_portable(kernel)
}

/// From now on this process does without more features than these: all machines round alike at the baseline. For tests.
pub fn narrow_to(most: Features) {
    #[cfg(target_arch = "x86_64")]
    wide::narrow_to(most);
    #[cfg(not(target_arch = "x86_64"))]
    let _ = most;
}

/// Out of line: inlined beside the other branch it would spill that one's arguments.
#[inline(never)]
fn run_portable<K: Kernel>(kernel: &mut K) -> K::Output {
    kernel.run::<Portable>()
}

#[cfg(target_arch = "x86_64")]
mod wide {
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

    // SAFETY of every block below: `Wide` exists only inside `run`, whose caller has checked for AVX2 and FMA.
    impl<const WITH_AVX512: bool> Lanes for Wide<WITH_AVX512> {
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
        /// In two pieces that the compiler leaves alone. Of plain numbers it would make wider ones out of several vectors, with
        /// AVX-512 of 512 bits, which cost an Intel Xeon a fifth of the time at 0.1°.
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
                let four = _mm256_max_ps(products, _mm256_permute2f128_ps::<0x01>(products, products));
                let two = _mm256_max_ps(four, _mm256_permute_ps::<0b01_00_11_10>(four));
                let all = _mm256_max_ps(two, _mm256_permute_ps::<0b10_11_00_01>(two));
                let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_EQ_OQ>(products, all)) as u32;
                (_mm256_cvtss_f32(all), (mask | 0x80).trailing_zeros() as usize)
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
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Sample;
    impl Kernel for Sample {
        type Output = (
            [f64; 4],
            [[f64; 4]; 4],
            f64,
            u32,
            [(f64, usize); 2],
            (f32, usize),
            [bool; 2],
            [[f64; 4]; 5],
            [u32; 4],
            [f64; 4],
        );
        #[inline(always)]
        fn run<L: Lanes>(&mut self) -> Self::Output {
            let rows = [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0], [9.0, 10.0, 11.0, 12.0]].map(|r| L::load(&r));
            let [x, y, z] = rows;
            let combined = x.splat_x().mul_add(y.splat_y(), z.splat_z()).sub(x).add(y).mul(z);
            let turned = L::load(&[7.0, 1.0, 7.0, 1.0]);
            let picks = [turned.least(), z.least()];
            let vectors =
                [[1.0, 4.0, 2.0, 0.0, 4.0, 0.0, 1.0, 3.0], [0.0, 1.0, 0.0, 0.0, 1.0, 7.5, 0.0, 0.0], [0.5; 8]];
            let [a, b, c] = &vectors;
            let vectors = [a, b, c];
            let greatest = x.greatest_product(vectors);
            let below = [x.products_are_below(vectors, 16.5), x.products_are_below(vectors, 16.75)];
            let (quotient, greater) = (z.div(y), y.max(turned));
            let mut single = [0; 4];
            L::load(&[1e300, 0.1, -1e-300, -2.5]).store_single(&mut single);
            let chosen = [quotient, greater, x.where_greater(y, turned, z), x.with_first(y), L::upper_halves(x, y)];
            (
                combined.to_array(),
                L::transpose(&rows).map(L::to_array),
                x.dot(y),
                y.greater(L::splat(6.5)),
                picks,
                greatest,
                below,
                chosen.map(L::to_array),
                single,
                L::load_single(&single).to_array(),
            )
        }
    }

    #[test]
    fn dispatched_lanes_equal_portable_ones() {
        let expected = Sample.run::<Portable>();
        assert_eq!(dispatch(&mut Sample), expected);
        #[cfg(target_arch = "x86_64")]
        if wide::features() > Features::Avx2 {
            // SAFETY: the machine has more than that.
            assert_eq!(unsafe { wide::run_with_avx2(&mut Sample) }, expected);
        }
        assert_eq!(expected.1[3], [4.0, 8.0, 12.0, 0.0]);
        assert_eq!(expected.2, 38.0);
        assert_eq!(expected.8, [f32::INFINITY, 0.1, -0.0, -2.5].map(f32::to_bits));
        assert_eq!(expected.9, [f64::INFINITY, f64::from(0.1_f32), 0.0, -2.5]);
        assert_eq!(expected.3, 0b1100);
        assert_eq!(expected.4, [(1.0, 1), (9.0, 0)]);
        assert_eq!((expected.5, expected.6), ((16.5, 5), [false, true]));
        assert_eq!(
            expected.7[1..],
            [[7.0, 6.0, 7.0, 8.0], [9.0, 2.0, 11.0, 4.0], [5.0, 2.0, 3.0, 4.0], [3.0, 4.0, 7.0, 8.0]]
        );
    }
}
