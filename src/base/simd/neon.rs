//! Four doubles in two registers of NEON, which with its fused operations every 64-bit processor of Arm's has: nothing is detected.
//!
//! Each method computes what that of [`wide`](super) does, operation by operation, zeros of either sign and NaN included: digits
//! depend on the order of operations and on which of two equal numbers is taken. So the lesser and the greater are chosen by
//! comparison. NEON's own FMIN prefers −0 and passes a NaN on; x86's MINPD computes a < b ? a : b.

use super::neon_twins::{
    Eight, NeonTwins, chosen_of_eight, equal_ones, first_of, greater_ones, lesser_ones, load_eight, store_eight,
};
use super::{Lanes, Work};
use crate::base::math::Vector;
use std::arch::aarch64::*;

/// Lanes 0 and 1, lanes 2 and 3.
#[derive(Clone, Copy)]
pub(super) struct Neon([float64x2_t; 2]);

// SAFETY of every block in this file: the module is compiled for targets alone that have NEON, and the blocks need no more.
// The pointers of loads and stores are to arrays of the size that is read or written.
impl Neon {
    /// Products of eight vectors with this one.
    #[inline(always)]
    fn products(self, [x, y, z]: [&[f32; 8]; 3]) -> Eight {
        let single = self.single();
        let ([x, y], z) = ([x, y].map(load_eight), load_eight(z));
        [0, 1].map(|half| {
            // SAFETY: see above.
            unsafe {
                let product = vmulq_laneq_f32::<0>(x[half], single);
                let product = vfmaq_laneq_f32::<1>(product, y[half], single);
                vfmaq_laneq_f32::<2>(product, z[half], single)
            }
        })
    }

    /// In single precision.
    #[inline(always)]
    fn single(self) -> float32x4_t {
        // SAFETY: see above.
        unsafe { vcvt_high_f32_f64(vcvt_f32_f64(self.0[0]), self.0[1]) }
    }

    /// Both halves of two by one operation.
    #[inline(always)]
    fn zip(self, other: Self, operation: impl Fn(float64x2_t, float64x2_t) -> float64x2_t) -> Self {
        Neon([operation(self.0[0], other.0[0]), operation(self.0[1], other.0[1])])
    }
}

/// a > b ? a : b, like VMAXPD.
#[inline(always)]
fn greater_one(a: float64x2_t, b: float64x2_t) -> float64x2_t {
    // SAFETY: see above.
    unsafe { vbslq_f64(vcgtq_f64(a, b), a, b) }
}

/// a < b ? a : b, like VMINPD.
#[inline(always)]
fn lesser_one(a: float64x2_t, b: float64x2_t) -> float64x2_t {
    // SAFETY: see above.
    unsafe { vbslq_f64(vcltq_f64(a, b), a, b) }
}

/// The results of comparing lanes, a bit each.
#[inline(always)]
fn bits_of_four([low, high]: [uint64x2_t; 2]) -> u32 {
    // SAFETY: see above.
    unsafe {
        let all = vcombine_u32(vmovn_u64(low), vmovn_u64(high));
        vaddvq_u32(vandq_u32(all, vld1q_u32([1, 2, 4, 8].as_ptr())))
    }
}

/// Which of eight products are greater than others, and the places of the greater ones taken over.
#[inline(always)]
fn take_places(places: &mut [uint32x4_t; 2], block: u32, products: Eight, greatest: Eight) {
    for half in [0, 1] {
        // SAFETY: see above.
        places[half] =
            unsafe { vbslq_u32(vcgtq_f32(products[half], greatest[half]), vdupq_n_u32(block), places[half]) };
    }
}

#[inline(always)]
fn place_in(places: [uint32x4_t; 2], lane: usize) -> usize {
    let mut out = [0_u32; 8];
    // SAFETY: see above.
    unsafe {
        vst1q_u32(out.as_mut_ptr(), places[0]);
        vst1q_u32(out.as_mut_ptr().add(4), places[1]);
    }
    out[lane] as usize + lane
}

#[inline(always)]
fn eight_of(number: f32) -> Eight {
    // SAFETY: see above.
    [unsafe { vdupq_n_f32(number) }; 2]
}

impl Lanes for Neon {
    type Twins = NeonTwins;
    const IS_FUSED: bool = true;
    #[inline(always)]
    fn twins(self, second: Self) -> NeonTwins {
        NeonTwins([self.single(), second.single()])
    }
    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: see above.
        Neon([unsafe { vdupq_n_f64(x) }; 2])
    }
    #[inline(always)]
    fn load(x: &[f64; 4]) -> Self {
        // SAFETY: see above.
        Neon(unsafe { [vld1q_f64(x.as_ptr()), vld1q_f64(x.as_ptr().add(2))] })
    }
    #[inline(always)]
    fn to_array(self) -> [f64; 4] {
        let mut out = [0.0; 4];
        // SAFETY: see above.
        unsafe {
            vst1q_f64(out.as_mut_ptr(), self.0[0]);
            vst1q_f64(out.as_mut_ptr().add(2), self.0[1]);
        }
        out
    }
    #[inline(always)]
    fn store_vector(self, to: &mut [f64; 3]) {
        // SAFETY: see above.
        unsafe {
            vst1q_f64(to.as_mut_ptr(), self.0[0]);
            vst1q_lane_f64::<0>(to.as_mut_ptr().add(2), self.0[1]);
        }
    }
    #[inline(always)]
    fn load_single(x: &[u32; 4]) -> Self {
        // SAFETY: see above.
        unsafe {
            let single = vld1q_f32(x.as_ptr().cast());
            Neon([vcvt_f64_f32(vget_low_f32(single)), vcvt_high_f64_f32(single)])
        }
    }
    #[inline(always)]
    fn store_single(self, to: &mut [u32; 4]) {
        // SAFETY: see above.
        unsafe { vst1q_f32(to.as_mut_ptr().cast(), self.single()) };
    }
    #[inline(always)]
    fn from_vector(v: &Vector) -> Self {
        // SAFETY: see above.
        unsafe { Neon([vsetq_lane_f64::<1>(v.y, vdupq_n_f64(v.x)), vdupq_n_f64(v.z)]) }
    }
    #[inline(always)]
    fn to_vector(self) -> Vector {
        let [x, y, z, _] = self.to_array();
        Vector::new(x, y, z)
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: see above.
        self.zip(other, |a, b| unsafe { vaddq_f64(a, b) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: see above.
        self.zip(other, |a, b| unsafe { vsubq_f64(a, b) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: see above.
        self.zip(other, |a, b| unsafe { vmulq_f64(a, b) })
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: see above.
        Neon([0, 1].map(|half| unsafe { vfmaq_f64(addend.0[half], self.0[half], factor.0[half]) }))
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: see above.
        Neon([0, 1].map(|half| unsafe { vfmsq_f64(addend.0[half], self.0[half], factor.0[half]) }))
    }
    #[inline(always)]
    fn negate(self) -> Self {
        // SAFETY: see above.
        Neon(self.0.map(|half| unsafe { vnegq_f64(half) }))
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u32 {
        // SAFETY: see above.
        bits_of_four([0, 1].map(|half| unsafe { vcgtq_f64(self.0[half], other.0[half]) }))
    }
    #[inline(always)]
    fn splat_x(self) -> Self {
        // SAFETY: see above.
        Neon([unsafe { vdupq_laneq_f64::<0>(self.0[0]) }; 2])
    }
    #[inline(always)]
    fn splat_y(self) -> Self {
        // SAFETY: see above.
        Neon([unsafe { vdupq_laneq_f64::<1>(self.0[0]) }; 2])
    }
    #[inline(always)]
    fn splat_z(self) -> Self {
        // SAFETY: see above.
        Neon([unsafe { vdupq_laneq_f64::<0>(self.0[1]) }; 2])
    }
    #[inline(always)]
    fn transpose([a, b, c]: &[Self; 3]) -> [Self; 4] {
        // SAFETY: see above.
        unsafe {
            let zero = vdupq_n_f64(0.0);
            let [first, second] = [0, 1].map(|half| {
                let [a, b, c] = [a.0[half], b.0[half], c.0[half]];
                [Neon([vzip1q_f64(a, b), vzip1q_f64(c, zero)]), Neon([vzip2q_f64(a, b), vzip2q_f64(c, zero)])]
            });
            [first[0], first[1], second[0], second[1]]
        }
    }
    #[inline(always)]
    fn rotate(self) -> Self {
        let [low, high] = self.0;
        // SAFETY: see above.
        unsafe { Neon([vextq_f64::<1>(low, high), vcopyq_laneq_f64::<0, 0>(high, low)]) }
    }
    #[inline(always)]
    fn dot(self, other: Self) -> f64 {
        let [low, high] = self.mul(other).0;
        // SAFETY: see above.
        unsafe { vpaddd_f64(low) + vgetq_lane_f64::<0>(high) }
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        // SAFETY: see above.
        bits_of_four([0, 1].map(|half| unsafe { vcleq_f64(self.0[half], other.0[half]) }))
    }
    #[inline(always)]
    fn norm1(self) -> f64 {
        // SAFETY: see above.
        let [low, high] = self.0.map(|half| unsafe { vabsq_f64(half) });
        // SAFETY: see above.
        unsafe { vpaddd_f64(low) + vgetq_lane_f64::<0>(high) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, greater_one)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, lesser_one)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: see above.
        self.zip(other, |a, b| unsafe { vdivq_f64(a, b) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see above.
        Neon(self.0.map(|half| unsafe { vsqrtq_f64(half) }))
    }
    #[inline(always)]
    fn components([a, b, c, d]: &[Self; 4]) -> [Self; 3] {
        // SAFETY: see above.
        unsafe {
            [
                Neon([vzip1q_f64(a.0[0], b.0[0]), vzip1q_f64(c.0[0], d.0[0])]),
                Neon([vzip2q_f64(a.0[0], b.0[0]), vzip2q_f64(c.0[0], d.0[0])]),
                Neon([vzip1q_f64(a.0[1], b.0[1]), vzip1q_f64(c.0[1], d.0[1])]),
            ]
        }
    }
    #[inline(always)]
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self {
        // SAFETY: see above.
        let choose =
            |half: usize| unsafe { vbslq_f64(vcgtq_f64(left.0[half], right.0[half]), self.0[half], other.0[half]) };
        Neon([choose(0), choose(1)])
    }
    #[inline(always)]
    fn with_first(self, other: Self) -> Self {
        // SAFETY: see above.
        Neon([unsafe { vcopyq_laneq_f64::<0, 0>(self.0[0], other.0[0]) }, self.0[1]])
    }
    #[inline(always)]
    fn upper_halves(first: Self, second: Self) -> Self {
        Neon([first.0[1], second.0[1]])
    }
    #[inline(always)]
    fn products_are_below(self, vectors: [&[f32; 8]; 3], limit: f32) -> bool {
        let [low, high] = self.products(vectors);
        // SAFETY: see above.
        unsafe {
            let limit = vdupq_n_f32(limit);
            vminvq_u32(vandq_u32(vcltq_f32(low, limit), vcltq_f32(high, limit))) != 0
        }
    }
    #[inline(always)]
    fn greatest_product(self, vectors: [&[f32; 8]; 3]) -> (f32, usize) {
        let products = self.products(vectors);
        let all = chosen_of_eight(products, greater_ones);
        (first_of(all), (equal_ones(products, all) | 0x80).trailing_zeros() as usize)
    }
    #[inline(always)]
    fn extreme_products(self, vectors: &[[[f32; 8]; 3]]) -> [f32; 2] {
        let (mut least, mut greatest) = (eight_of(f32::INFINITY), eight_of(f32::NEG_INFINITY));
        for [x, y, z] in vectors {
            let products = self.products([x, y, z]);
            least = lesser_ones(least, products);
            greatest = greater_ones(greatest, products);
        }
        let low = store_eight(least).into_iter().fold(f32::INFINITY, |low, x| if x < low { x } else { low });
        let high = store_eight(greatest).into_iter().fold(f32::NEG_INFINITY, |high, x| if x > high { x } else { high });
        [low, high]
    }
    #[inline(always)]
    fn farthest_product(self, vectors: &[[[f32; 8]; 3]]) -> (usize, [f32; 2]) {
        let mut greatest = eight_of(f32::NEG_INFINITY);
        let mut second = greatest;
        // SAFETY: see above.
        let mut places = [unsafe { vdupq_n_u32(0) }; 2];
        for (block, [x, y, z]) in (0..).step_by(8).zip(vectors) {
            let products = self.products([x, y, z]);
            take_places(&mut places, block, products, greatest);
            second = greater_ones(second, lesser_ones(greatest, products));
            greatest = greater_ones(greatest, products);
        }
        let all = chosen_of_eight(greatest, greater_ones);
        let mask = equal_ones(greatest, all);
        // Of two that are equal one is the second.
        let others = if mask & mask.wrapping_sub(1) == 0 {
            // SAFETY: see above.
            [0, 1].map(|half| unsafe { vbslq_f32(vceqq_f32(greatest[half], all[half]), second[half], greatest[half]) })
        } else {
            all
        };
        let next = first_of(chosen_of_eight(others, greater_ones));
        (place_in(places, (mask | 0x80).trailing_zeros() as usize), [first_of(all), next])
    }
    /// Even blocks and odd ones each with their own greatest numbers, as with AVX2: of equal products another would be taken.
    #[inline(always)]
    fn farthest_of(self, vectors: &[[[f32; 8]; 3]]) -> usize {
        let mut greatest = [eight_of(f32::NEG_INFINITY); 2];
        // SAFETY: see above.
        let mut places = [[unsafe { vdupq_n_u32(0) }; 2]; 2];
        let (pairs, rest) = vectors.as_chunks::<2>();
        let mut block = 0;
        for pair in pairs {
            for (parity, [x, y, z]) in pair.iter().enumerate() {
                let products = self.products([x, y, z]);
                take_places(&mut places[parity], block, products, greatest[parity]);
                greatest[parity] = greater_ones(greatest[parity], products);
                block += 8;
            }
        }
        for [x, y, z] in rest {
            let products = self.products([x, y, z]);
            take_places(&mut places[0], block, products, greatest[0]);
            greatest[0] = greater_ones(greatest[0], products);
        }
        let [even, odd] = greatest;
        // SAFETY: see above.
        let places =
            [0, 1].map(|half| unsafe { vbslq_u32(vcgtq_f32(odd[half], even[half]), places[1][half], places[0][half]) });
        let greatest = greater_ones(even, odd);
        let all = chosen_of_eight(greatest, greater_ones);
        place_in(places, (equal_ones(greatest, all) | 0x80).trailing_zeros() as usize)
    }
    #[inline(always)]
    fn least(self) -> (f64, usize) {
        let pair = self.min(Neon([self.0[1], self.0[0]]));
        // SAFETY: see above.
        let all = pair.min(Neon(pair.0.map(|half| unsafe { vextq_f64::<1>(half, half) })));
        // SAFETY: see above.
        let mask = bits_of_four([0, 1].map(|half| unsafe { vceqq_f64(self.0[half], all.0[half]) }));
        // SAFETY: see above.
        (unsafe { vgetq_lane_f64::<0>(all.0[0]) }, (mask | 0b1000).trailing_zeros() as usize)
    }
    #[inline(never)]
    fn out_of_line<W: Work>(work: &mut W) -> W::Output {
        work.run()
    }
}
