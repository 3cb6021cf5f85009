//! Two vectors in single precision in a register of NEON each.

use super::twins::Twins;
use std::arch::aarch64::*;

/// Single-precision numbers 0 to 3, 4 to 7.
pub(super) type Eight = [float32x4_t; 2];

/// The first vector, the second one.
#[derive(Clone, Copy)]
pub(super) struct NeonTwins(pub(super) Eight);

impl NeonTwins {
    /// Both vectors of two by one operation.
    #[inline(always)]
    fn zip(self, other: Self, operation: impl Fn(float32x4_t, float32x4_t) -> float32x4_t) -> Self {
        NeonTwins([operation(self.0[0], other.0[0]), operation(self.0[1], other.0[1])])
    }
}

// SAFETY of every block in this file: as for `Neon`.
impl Twins for NeonTwins {
    #[inline(always)]
    fn load(first: &[f32; 4], second: &[f32; 4]) -> Self {
        // SAFETY: see above.
        NeonTwins([first, second].map(|four| unsafe { vld1q_f32(four.as_ptr()) }))
    }
    #[inline(always)]
    fn load_eight(numbers: &[f32; 8]) -> Self {
        NeonTwins(load_eight(numbers))
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        store_eight(self.0)
    }
    #[inline(always)]
    fn splat(first: f32, second: f32) -> Self {
        // SAFETY: see above.
        NeonTwins([first, second].map(|number| unsafe { vdupq_n_f32(number) }))
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: see above.
        self.zip(other, |a, b| unsafe { vaddq_f32(a, b) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: see above.
        self.zip(other, |a, b| unsafe { vsubq_f32(a, b) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: see above.
        self.zip(other, |a, b| unsafe { vmulq_f32(a, b) })
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: see above.
        NeonTwins([0, 1].map(|k| unsafe { vfmaq_f32(addend.0[k], self.0[k], factor.0[k]) }))
    }
    #[inline(always)]
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: see above.
        NeonTwins([0, 1].map(|k| unsafe { vfmsq_f32(addend.0[k], self.0[k], factor.0[k]) }))
    }
    #[inline(always)]
    fn splat_x(self) -> Self {
        // SAFETY: see above.
        NeonTwins(self.0.map(|four| unsafe { vdupq_laneq_f32::<0>(four) }))
    }
    #[inline(always)]
    fn splat_y(self) -> Self {
        // SAFETY: see above.
        NeonTwins(self.0.map(|four| unsafe { vdupq_laneq_f32::<1>(four) }))
    }
    #[inline(always)]
    fn splat_z(self) -> Self {
        // SAFETY: see above.
        NeonTwins(self.0.map(|four| unsafe { vdupq_laneq_f32::<2>(four) }))
    }
    #[inline(always)]
    fn rotate(self) -> Self {
        // SAFETY: see above. (x, y, z, w) turned by one is (y, z, w, x).
        NeonTwins(self.0.map(|four| unsafe {
            let turned = vextq_f32::<1>(four, four);
            vcopyq_laneq_f32::<3, 3>(vcopyq_laneq_f32::<2, 0>(turned, four), four)
        }))
    }
    #[inline(always)]
    fn negate_first(self) -> Self {
        // SAFETY: see above.
        NeonTwins([unsafe { vnegq_f32(self.0[0]) }, self.0[1]])
    }
    #[inline(always)]
    fn swap(self) -> Self {
        NeonTwins([self.0[1], self.0[0]])
    }
    #[inline(always)]
    fn dots(self, other: Self) -> [f32; 2] {
        self.mul(other).0.map(sum_of_three)
    }
    #[inline(always)]
    fn dot(self, other: Self) -> f32 {
        // SAFETY: see above.
        sum_of_three(unsafe { vmulq_f32(self.0[0], other.0[0]) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        NeonTwins(lesser_ones(self.0, other.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        NeonTwins(greater_ones(self.0, other.0))
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: see above.
        self.zip(other, |a, b| unsafe { vdivq_f32(a, b) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see above.
        NeonTwins(self.0.map(|four| unsafe { vsqrtq_f32(four) }))
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u32 {
        // SAFETY: see above.
        bits_of_eight([0, 1].map(|k| unsafe { vcgtq_f32(self.0[k], other.0[k]) }))
    }
    #[inline(always)]
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self {
        // SAFETY: see above.
        NeonTwins([0, 1].map(|k| unsafe { vbslq_f32(vcgtq_f32(left.0[k], right.0[k]), self.0[k], other.0[k]) }))
    }
    #[inline(always)]
    fn components([a, b, c, d]: &[Self; 4]) -> [Self; 3] {
        // SAFETY: see above.
        let [first, second] = [0, 1].map(|k| unsafe {
            let [low_ab, low_cd] = [vzip1q_f32(a.0[k], b.0[k]), vzip1q_f32(c.0[k], d.0[k])].map(as_doubles); // a.x b.x a.y b.y
            let [high_ab, high_cd] = [vzip2q_f32(a.0[k], b.0[k]), vzip2q_f32(c.0[k], d.0[k])].map(as_doubles); // a.z b.z …
            [vzip1q_f64(low_ab, low_cd), vzip2q_f64(low_ab, low_cd), vzip1q_f64(high_ab, high_cd)]
        });
        // SAFETY: see above.
        [0, 1, 2].map(|axis| NeonTwins([first, second].map(|of| unsafe { vreinterpretq_f32_f64(of[axis]) })))
    }
    #[inline(always)]
    fn least(self) -> (f32, usize) {
        let all = chosen_of_eight(self.0, lesser_ones);
        (first_of(all), (equal_ones(self.0, all) | 0x80).trailing_zeros() as usize)
    }
}

#[inline(always)]
fn as_doubles(four: float32x4_t) -> float64x2_t {
    // SAFETY: see above.
    unsafe { vreinterpretq_f64_f32(four) }
}

/// In the order of the others: (x + y) + z.
#[inline(always)]
fn sum_of_three(products: float32x4_t) -> f32 {
    // SAFETY: see above.
    unsafe { vpadds_f32(vget_low_f32(products)) + vgetq_lane_f32::<2>(products) }
}

#[inline(always)]
pub(super) fn load_eight(numbers: &[f32; 8]) -> Eight {
    // SAFETY: see above.
    unsafe { [vld1q_f32(numbers.as_ptr()), vld1q_f32(numbers.as_ptr().add(4))] }
}

#[inline(always)]
pub(super) fn store_eight(numbers: Eight) -> [f32; 8] {
    let mut out = [0.0; 8];
    // SAFETY: see above.
    unsafe {
        vst1q_f32(out.as_mut_ptr(), numbers[0]);
        vst1q_f32(out.as_mut_ptr().add(4), numbers[1]);
    }
    out
}

/// Number by number a > b ? a : b, like VMAXPS.
#[inline(always)]
pub(super) fn greater_ones(a: Eight, b: Eight) -> Eight {
    // SAFETY: see above.
    [0, 1].map(|half| unsafe { vbslq_f32(vcgtq_f32(a[half], b[half]), a[half], b[half]) })
}

/// Number by number a < b ? a : b, like VMINPS.
#[inline(always)]
pub(super) fn lesser_ones(a: Eight, b: Eight) -> Eight {
    // SAFETY: see above.
    [0, 1].map(|half| unsafe { vbslq_f32(vcltq_f32(a[half], b[half]), a[half], b[half]) })
}

/// The results of comparing eight numbers, a bit each.
#[inline(always)]
pub(super) fn bits_of_eight([low, high]: [uint32x4_t; 2]) -> u32 {
    // SAFETY: see above.
    unsafe {
        let all = vcombine_u16(vmovn_u32(low), vmovn_u32(high));
        u32::from(vaddvq_u16(vandq_u16(all, vld1q_u16([1, 2, 4, 8, 16, 32, 64, 128].as_ptr()))))
    }
}

/// Where eight numbers equal others, a bit each.
#[inline(always)]
pub(super) fn equal_ones(a: Eight, b: Eight) -> u32 {
    // SAFETY: see above.
    bits_of_eight([0, 1].map(|half| unsafe { vceqq_f32(a[half], b[half]) }))
}

/// The number that a choice takes of all eight, in all places: both halves, both halves of these, and both of these again.
#[inline(always)]
pub(super) fn chosen_of_eight(numbers: Eight, choose: impl Fn(Eight, Eight) -> Eight) -> Eight {
    // SAFETY: see above.
    let turned = |by: Eight| by.map(|four| unsafe { vextq_f32::<2>(four, four) });
    // SAFETY: see above.
    let swapped = |by: Eight| by.map(|four| unsafe { vrev64q_f32(four) });
    let four = choose(numbers, [numbers[1], numbers[0]]);
    let two = choose(four, turned(four));
    choose(two, swapped(two))
}

#[inline(always)]
pub(super) fn first_of(numbers: Eight) -> f32 {
    // SAFETY: see above.
    unsafe { vgetq_lane_f32::<0>(numbers[0]) }
}
