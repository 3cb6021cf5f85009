//! The same each time: verdicts and the order of results on every machine, every bit of every answer in every run and from every
//! thread, and on every machine with the same instructions. AVX2, AVX-512 and NEON are the same in this.
//!
//! The scenes are made of sums, products, quotients and square roots, which are rounded alike everywhere; sines are not.

mod digits;
mod flight;

use digits::Digits;
use flight::{Flight, fly, shapes};
use swiftprox::base::simd::{self, Features};
use swiftprox::pair::Outcome;

/// Of the verdicts and the order of results, on every machine. It stays as long as the flight does.
const VERDICTS: u64 = 0x5733_1957_f757_a2bb;

/// Of every bit of every answer, on the baseline of x86-64. It changes with how answers are found, and is recorded anew then;
/// verdicts do not change.
const BITS: u64 = 0x5e360f482b1b105c;

/// The same with AVX2, AVX-512 and NEON.
const FUSED_BITS: u64 = 0xdf8307adb63c3729;

/// Of the verdicts of all kinds of queries, on every machine.
const DIGITS_VERDICTS: u64 = 0x1358_638d_9cea_80e6;

/// Of every digit of every answer to them, with AVX2, AVX-512 and NEON.
const DIGITS: u64 = 0x7bf7_a0e5_3c51_0cdc;

/// FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo), which is the same in every version of everything.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Hash(u64);

impl Hash {
    const EMPTY: Hash = Hash(0xcbf2_9ce4_8422_2325);

    fn add_byte(&mut self, byte: u8) {
        self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }

    fn add(&mut self, number: u64) {
        number.to_le_bytes().into_iter().for_each(|byte| self.add_byte(byte));
    }
}

/// Whether this machine fuses products and sums in the lanes of a query.
fn is_fused() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    cfg!(target_arch = "aarch64")
}

/// One test: what machine it is on is the same for all threads of a process.
#[test]
fn answers_are_the_same_each_time() {
    let check = |flight: Flight| {
        println!("{flight:x?}");
        // The same before there are tables and after, in other shapes made alike, and from four threads at once.
        let made = shapes();
        assert_eq!((fly(&made), fly(&made)), (flight, flight));
        std::thread::scope(|scope| {
            let threads = [(); 4].map(|()| scope.spawn(|| fly(&made)));
            for thread in threads {
                assert_eq!(thread.join().unwrap(), flight);
            }
        });
        assert_eq!(flight.verdicts, Hash(VERDICTS), "verdicts {:#018x}", flight.verdicts.0);
    };
    let flight = fly(&shapes());
    check(flight);
    let [separated, beyond, intersecting, undecided] = flight.outcomes;
    assert!(separated > 10_000 && beyond > 500 && intersecting > 5_000 && undecided > 100, "{:?}", flight.outcomes);
    assert_eq!(Outcome::Undecided as usize, flight.outcomes.len());
    let digits = Digits::of_all();
    println!("{digits:x?}");
    assert!(digits.answers >= 100_000, "{} answers", digits.answers);
    assert_eq!(digits.verdicts, Hash(DIGITS_VERDICTS), "verdicts {:#018x}", digits.verdicts.0);
    if is_fused() {
        assert_eq!(digits.all, Hash(DIGITS), "digits {:#018x}", digits.all.0);
        assert_eq!(flight.bits, Hash(FUSED_BITS), "bits {:#018x}", flight.bits.0);
    }

    // AVX-512 brings registers, no other numbers.
    simd::narrow_to(Features::Avx2);
    assert_eq!(fly(&shapes()), flight);
    assert_eq!(Digits::of_all(), digits);

    simd::narrow_to(Features::Baseline);
    let narrow = fly(&shapes());
    check(narrow);
    assert_eq!(Digits::of_all().verdicts, digits.verdicts);
    if cfg!(all(target_arch = "x86_64", not(target_feature = "fma"))) {
        assert_eq!(
            narrow.bits,
            Hash(BITS),
            "bits {:#018x}: to be recorded if answers were meant to change",
            narrow.bits.0
        );
    }
}
