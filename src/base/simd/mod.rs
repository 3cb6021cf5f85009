//! Four doubles at a time, dispatched once per query to AVX2 with FMA where the machine has them, and to AVX-512 where it has that.
//!
//! A query is written once, generic over [`Lanes`], and compiled three times: with `Plain` for what every machine of the
//! target has, and with `Wide` inside functions that enable the features. On AArch64 NEON is that, and there is nothing
//! else. Everything on the query's path is `#[inline(always)]`, so that it is compiled with the features of its caller. AVX-512
//! means the same operations on the same four lanes, and so the same numbers; it has twice the registers and operands broadcast
//! from memory. On AMD's Zen 5 that saved a query whose features have not changed 6 % of its time, others 1 to 2 %, on an Intel
//! Xeon 8 % and 3 to 6 %, if the functions begin at multiples of 64 bytes (see `.cargo/config.toml`); if not, both are equal
//! there.
//!
//! AVX2, AVX-512 and NEON give the same digits: each method does the same operations in the same order, fuses the same products,
//! and takes the same one of equal numbers. What is not dispatched computes with [`Portable`], which fuses nothing anywhere.
//!
//! Rules of code generation, which the code on a query's path keeps and cites by number. Each was measured where it is cited.
//!
//! | rule | why |
//! |---|---|
//! | R1: what was just written number by number is not read, copied or returned as a whole | a wider load of narrower stores waits for them to reach the cache: 10 to 30 ns |
//! | R2: no closures in a kernel | one that is not inlined is compiled without the features of the lanes |
//! | R3: the common case stands in line before the loop that serves the others | a loop keeps so much in registers that the common case pays for it |
//! | R4: what is as often so as otherwise is computed or looked up, not branched on | the processor guesses such a branch wrong half of the time |
//! | R5: what a step returns fits in registers: no enum around a state | an enum with a payload is handed on in memory |
//! | R6: what is known stays known by value | behind a kernel, and behind the instruction that asks for the environment, the compiler takes what is in memory for anything |
//!
//! The only `unsafe` outside the C interface, with that of [`environment`], the floating-point environment.

#![allow(unsafe_code)]

pub mod environment;
mod twins;
mod lanes;
#[cfg(target_arch = "x86_64")]
mod wide_twins;
#[cfg(target_arch = "x86_64")]
mod wide;
#[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
mod neon_twins;
#[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
mod neon;

pub use lanes::{Lanes, Portable};
pub use twins::Twins;

/// Work that can run on any [`Lanes`]; its `run` is to be `#[inline(always)]`.
pub trait Kernel {
    /// The return type.
    type Output;
    /// The work.
    fn run<L: Lanes>(&mut self) -> Self::Output;
}

/// Work on lanes that it has already; its `run` is to be `#[inline(always)]`.
pub trait Work {
    /// The return type.
    type Output;
    /// The work.
    fn run(&mut self) -> Self::Output;
}

/// The instruction sets that a query may be compiled with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Features {
    /// The instructions that every machine of the target has.
    Baseline = 1,
    /// AVX2 and FMA.
    Avx2,
    /// AVX-512 with its foundation and its operations on short registers and on doublewords, and the extensions before it.
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
    run_on_baseline(kernel)
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
    run_on_baseline(kernel)
}

/// Prefetches data that will be read soon.
#[inline(always)]
pub fn prefetch<T>(place: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        const LINE: usize = 64;
        let first = std::ptr::from_ref(place).cast::<i8>();
        for at in (0..size_of::<T>()).step_by(LINE) {
            // SAFETY: a hint reads nothing, and the addresses are those of one object.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(first.add(at)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = place;
}

/// From now on this process uses no more features than these: all machines of x86-64 round alike at the baseline. For tests.
pub fn narrow_to(most: Features) {
    #[cfg(target_arch = "x86_64")]
    wide::narrow_to(most);
    #[cfg(not(target_arch = "x86_64"))]
    let _ = most;
}

/// Out of line: inlined beside the other branch it would spill that one's arguments.
#[inline(never)]
fn run_on_baseline<K: Kernel>(kernel: &mut K) -> K::Output {
    #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
    return kernel.run::<neon::Neon>();
    // Products are fused where that is one instruction.
    #[cfg(not(all(target_arch = "aarch64", target_feature = "neon")))]
    kernel.run::<lanes::Plain<{ cfg!(target_feature = "fma") }>>()
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
            [[f64; 4]; 7],
            [u32; 4],
            [f64; 4],
            ([f32; 2], [(usize, [f32; 2]); 2]),
            ([[f32; 8]; 20], [[f32; 2]; 5]),
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
            let [.., third] = L::components(&[x, y, z, turned]);
            let (sides, others) = (x.twins(y), L::Twins::load(&[3.0, 1.0, 4.0, 1.0], &[5.0, 9.0, 2.0, 6.0]));
            let eight = L::Twins::load_eight(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
            let [first, second, third_of_eight] = L::Twins::components(&[sides, others, eight, others]);
            let (least, place) = others.least();
            let blocks = [[*a, *b, *c], [*b, *a, *b], [*c, *b, *c]];
            let farthest = [x.farthest_of(&blocks[..1]) as f32, x.farthest_of(&blocks) as f32];
            let twins = [
                sides,
                others.add(sides),
                others.sub(sides),
                others.mul_add(sides, others).mul(L::Twins::splat(2.0, 0.5)),
                others.negated_mul_add(sides, others),
                others.splat_x(),
                others.splat_y(),
                others.splat_z(),
                others.negate_first(),
                others.sum(),
                others.cross(sides),
                L::Twins::product(&[sides, others, sides], others),
                others.min(sides),
                others.max(sides),
                others.div(sides),
                others.sqrt(),
                sides.where_greater(others, sides, others),
                first,
                second,
                third_of_eight,
            ]
            .map(L::Twins::to_array);
            let chosen = [
                quotient,
                greater,
                x.where_greater(y, turned, z),
                x.with_first(y),
                L::upper_halves(x, y),
                y.min(turned),
                third.sqrt(),
            ];
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
                (
                    x.extreme_products(&[[*a, *b, *c], [*b, *a, *b]]),
                    [[*a, *b, *c], [*b, *a, *b]].map(|block| x.farthest_product(&[block, [*c, *b, *c]])),
                ),
                (
                    twins,
                    [
                        sides.dots(others),
                        [sides.dot(others), others.swap().dot(sides)],
                        [least, place as f32],
                        [others.greater(sides) as f32, eight.greater(others) as f32],
                        farthest,
                    ],
                ),
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
        assert_eq!(expected.10.0, [0.0, 30.0]);
        assert_eq!(expected.1[3], [4.0, 8.0, 12.0, 0.0]);
        assert_eq!(expected.2, 38.0);
        assert_eq!(expected.8, [f32::INFINITY, 0.1, -0.0, -2.5].map(f32::to_bits));
        assert_eq!(expected.9, [f64::INFINITY, f64::from(0.1_f32), 0.0, -2.5]);
        let [least, greater, farthest] = [[1.0, 1.0], [37.0, 202.0], [5.0, 13.0]];
        assert_eq!(expected.11.1, [[17.0, 93.0], [17.0, 29.0], least, greater, farthest]);
        assert_eq!(expected.3, 0b1100);
        assert_eq!(expected.4, [(1.0, 1), (9.0, 0)]);
        assert_eq!((expected.5, expected.6), ((16.5, 5), [false, true]));
        assert_eq!(
            expected.7[1..],
            [
                [7.0, 6.0, 7.0, 8.0],
                [9.0, 2.0, 11.0, 4.0],
                [5.0, 2.0, 3.0, 4.0],
                [3.0, 4.0, 7.0, 8.0],
                [5.0, 1.0, 7.0, 1.0],
                [3.0, 7.0, 11.0, 7.0].map(f64::sqrt)
            ]
        );
    }

    /// Roundings, zeros of either sign and NaN.
    struct Odd;
    impl Kernel for Odd {
        type Output = ([[u64; 4]; 4], [[u32; 8]; 4]);
        #[inline(always)]
        fn run<L: Lanes>(&mut self) -> Self::Output {
            let (numbers, others) = ([0.0, -0.0, f64::NAN, 2.0], [-0.0, 0.0, 2.0, f64::NAN]);
            let (a, b) = (L::load(&numbers), L::load(&others));
            let (x, one) = (L::splat(1.0 + NEXT), L::splat(1.0));
            let doubles = [a.max(b), a.min(b), x.mul_add(x, one.negate()), x.negated_mul_add(x, one)];
            let single = 1.0 + NEXT_SINGLE;
            let (x, one) = (L::Twins::splat(single, single), L::Twins::splat(1.0, 1.0));
            let (a, b) = (a.twins(b), b.twins(a));
            let singles = [a.max(b), a.min(b), x.mul_add(x, L::Twins::splat(-1.0, -1.0)), x.negated_mul_add(x, one)];
            (doubles.map(|x| x.to_array().map(f64::to_bits)), singles.map(|x| x.to_array().map(f32::to_bits)))
        }
    }

    /// The square of 1 more than these has a last digit that only a fused sum keeps.
    const NEXT: f64 = 1.0 / (1_u64 << 30) as f64;
    const NEXT_SINGLE: f32 = 1.0 / (1 << 15) as f32;

    /// Equal numbers, of which any may be taken.
    struct Equal;
    impl Kernel for Equal {
        type Output = ((usize, [f32; 2]), usize, (u64, usize), (f32, usize));
        #[inline(always)]
        fn run<L: Lanes>(&mut self) -> Self::Output {
            let mut blocks = [[[0.0; 8]; 3]; 3];
            for (block, lane) in [(0, 3), (1, 1), (2, 1)] {
                blocks[block][0][lane] = 1.0;
            }
            let x = L::load(&[1.0, 0.0, 0.0, 0.0]);
            let (least, lane) = L::load(&[0.0, -0.0, 5.0, 5.0]).least();
            let [first, second, third] = &blocks[0];
            (
                x.farthest_product(&blocks),
                x.farthest_of(&blocks),
                (least.to_bits(), lane),
                x.greatest_product([first, second, third]),
            )
        }
    }

    fn is_fused() -> bool {
        #[cfg(target_arch = "x86_64")]
        return wide::features() >= Features::Avx2;
        #[cfg(not(target_arch = "x86_64"))]
        cfg!(all(target_arch = "aarch64", target_feature = "neon"))
    }

    /// The digits of AVX2, by which those of others go.
    #[test]
    fn lanes_agree_where_digits_could_differ() {
        let (zeros, ones) = ([-0.0, 0.0, 2.0, f64::NAN], [0.0, -0.0, f64::NAN, 2.0]);
        let [fused, fused_single] =
            [2.0 * NEXT + NEXT * NEXT, f64::from(2.0 * NEXT_SINGLE + NEXT_SINGLE * NEXT_SINGLE)];
        let doubles = [zeros, zeros, [fused; 4], [-fused; 4]].map(|x| x.map(f64::to_bits));
        let (first, second) = (zeros.map(|x| x as f32), ones.map(|x| x as f32));
        let both = std::array::from_fn(|i| if i < 4 { first[i] } else { second[i - 4] });
        let fused = fused_single as f32;
        let singles = [both, both, [fused; 8], [-fused; 8]].map(|x| x.map(f32::to_bits));
        assert_eq!(Odd.run::<lanes::Plain<true>>(), (doubles, singles));
        if is_fused() {
            assert_eq!(dispatch(&mut Odd), (doubles, singles));
            assert_eq!(dispatch(&mut Equal), ((9, [1.0; 2]), 17, ((-0.0_f64).to_bits(), 0), (1.0, 3)));
        }
    }
}
