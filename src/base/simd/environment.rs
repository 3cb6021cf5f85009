//! The floating-point environment: how the processor rounds, whether it flushes subnormal numbers to zero, which exceptions trap.
//!
//! Every bound of this library, and so every proof, counts on the default of IEEE 754: to nearest, gradual underflow, no traps. The
//! environment is the thread's and may be any: simulators flush, interval libraries round upward, debug builds trap. So each entry
//! of the library runs [`with_default`], and whatever it calls of the program's own runs [`with_callers`].
//!
//! On x86-64 that is the register MXCSR, on AArch64 FPCR. On other targets nothing is done: there the program must see to it. The
//! x87 unit, which has an environment of its own, computes nothing here. Flags of exceptions are left to the processor, which
//! only ever raises them.
//!
//! LLVM takes it for granted that Rust code runs in the default environment, and does not know what the registers mean: it could
//! move arithmetic across the instructions that set them. It cannot move code that is in another function. So all that runs
//! behind a change does so in a call that is never inlined, and is handed no number that was computed just before. Where nothing
//! is changed, moving does no harm: a value moved up before the test is used only where the environment is the default. (It could
//! trap where it is not. LLVM moves up what both sides of a branch compute, what is the same in all rounds of a loop, and so
//! little that the whole side becomes a selection; here one side is a call, the other a function of the interface, its loops and
//! all.)

use std::cell::Cell;

/// A register's bits that control arithmetic, without the flags of exceptions.
type Control = u64;

thread_local! {
    /// The program's setting when it called in, if that was not the default.
    static CALLERS: Cell<Option<Control>> = const { Cell::new(None) };
}

/// Runs `body` in the default environment; behind it, also if it unwinds, the environment is the caller's again.
#[inline(always)]
pub fn with_default<T>(body: impl FnOnce() -> T) -> T {
    let found = register::control();
    if found == register::DEFAULT { body() } else { with_default_instead_of(found, body) }
}

/// Whether the environment is the default one. A function that takes some tens of nanoseconds asks this itself and goes the other
/// way by calling itself [`with_default`]: a closure of its body would have to be put into memory.
#[inline(always)]
pub fn is_default() -> bool {
    register::control() == register::DEFAULT
}

#[cold]
#[inline(never)]
fn with_default_instead_of<T>(found: Control, body: impl FnOnce() -> T) -> T {
    let _end = Restore { control: found, callers: CALLERS.replace(Some(found)) };
    register::set_control(register::DEFAULT);
    out_of_line(body)
}

/// Runs a function of the program's in the environment of the program; behind it, also if it unwinds and whatever it has set, the
/// environment is that of before.
pub fn with_callers<T>(callback: impl FnOnce() -> T) -> T {
    // The program's function may call the library: then it is the caller.
    let end = Restore { control: register::control(), callers: CALLERS.take() };
    if let Some(callers) = end.callers {
        register::set_control(callers);
    }
    out_of_line(callback)
}

/// Sets the environment back.
struct Restore {
    control: Control,
    callers: Option<Control>,
}

impl Drop for Restore {
    fn drop(&mut self) {
        if register::control() != self.control {
            register::set_control(self.control);
        }
        CALLERS.set(self.callers);
    }
}

#[inline(never)]
fn out_of_line<T>(body: impl FnOnce() -> T) -> T {
    body()
}

/// An environment that a program may have set. For tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Environment {
    /// How results are rounded.
    pub rounding: Rounding,
    /// Subnormal operands and results are 0.
    pub flushes: bool,
    /// Invalid operations, divisions by zero and overflows end the program.
    pub traps: bool,
}

/// A direction of rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rounding {
    /// To the nearest double; a tie goes to the even one.
    Nearest,
    /// Towards −∞.
    Down,
    /// Towards +∞.
    Up,
    /// Towards 0.
    TowardZero,
}

impl Environment {
    /// All of them, the default one first.
    pub fn all() -> impl Iterator<Item = Environment> {
        let roundings = [Rounding::Nearest, Rounding::Down, Rounding::Up, Rounding::TowardZero];
        let with = move |[flushes, traps]: [bool; 2]| {
            roundings.into_iter().map(move |rounding| Environment { rounding, flushes, traps })
        };
        [[false, false], [true, false], [false, true], [true, true]].into_iter().flat_map(with)
    }

    /// Runs `body` as a program would that has set this environment.
    pub fn run<T>(self, body: impl FnOnce() -> T) -> T {
        let _end = Restore { control: register::control(), callers: CALLERS.get() };
        register::set_control(register::of(self));
        out_of_line(body)
    }

    /// Whether this environment is set now.
    pub fn is_set(self) -> bool {
        register::control() == register::of(self)
    }
}

/// Whether `body` computes an undefined value, as 0/0 or ∞ − ∞, or divides by zero. For tests.
pub fn is_invalid<T>(body: impl FnOnce() -> T) -> bool {
    register::clear_flags();
    out_of_line(body);
    register::has_invalid_flag()
}

/// MXCSR (Intel 64 and IA-32 Architectures Software Developer's Manual, volume 1, section 10.2.3).
#[cfg(all(target_arch = "x86_64", not(miri)))]
mod register {
    use super::{Control, Environment, Rounding};
    use std::arch::asm;

    /// All exceptions masked, to nearest, nothing flushed: the state that a process begins with.
    pub(super) const DEFAULT: Control = 0x1f80;

    /// FZ, the rounding, the masks of the six exceptions, DAZ.
    const CONTROL: u32 = 0xffc0;
    const FLAGS: u32 = 0x003f;
    const INVALID_OR_DIVISION_BY_ZERO: u32 = 0x0005;
    const DENORMALS_ARE_ZERO: u32 = 1 << 6;
    const FLUSH_TO_ZERO: u32 = 1 << 15;
    /// Masks of invalid operation, division by zero and overflow.
    const MASKS: u32 = 1 << 7 | 1 << 9 | 1 << 10;

    #[inline(always)]
    fn read() -> u32 {
        let mut word = 0_u32;
        // SAFETY: writes the four bytes of `word`.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut word, options(nostack, preserves_flags)) };
        word
    }

    fn write(word: u32) {
        // SAFETY: reads the four bytes of `word`, which come from `read`, apart from bits that every processor has. The code that
        // follows computes in the default environment or is the program's own, by this module's functions.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack, preserves_flags)) };
    }

    #[inline(always)]
    pub(super) fn control() -> Control {
        (read() & CONTROL).into()
    }

    /// A flag that is set traps nothing, also where its exception is trapped from now on: only the next one does.
    pub(super) fn set_control(control: Control) {
        write(read() & !CONTROL | control as u32);
    }

    pub(super) fn clear_flags() {
        write(read() & !FLAGS);
    }

    pub(super) fn has_invalid_flag() -> bool {
        read() & INVALID_OR_DIVISION_BY_ZERO != 0
    }

    pub(super) fn of(environment: Environment) -> Control {
        let rounding = match environment.rounding {
            Rounding::Nearest => 0,
            Rounding::Down => 1 << 13,
            Rounding::Up => 2 << 13,
            Rounding::TowardZero => 3 << 13,
        };
        let flushing = if environment.flushes { DENORMALS_ARE_ZERO | FLUSH_TO_ZERO } else { 0 };
        let masks = if environment.traps { MASKS } else { 0 };
        (DEFAULT as u32 & !masks | rounding | flushing).into()
    }
}

/// FPCR, whose flags are in a register of their own, FPSR (Arm Architecture Reference Manual for A-profile, D24.2.59 and C5.2.9).
#[cfg(all(target_arch = "aarch64", not(miri)))]
mod register {
    use super::{Control, Environment, Rounding};
    use std::arch::asm;

    /// To nearest, nothing flushed, no traps, NaN handed on: the state that a process begins with.
    pub(super) const DEFAULT: Control = 0;

    const INVALID_OR_DIVISION_BY_ZERO: u64 = 0b11;
    const FLUSH_TO_ZERO: u64 = 1 << 24;
    /// Traps of invalid operation, division by zero and overflow, which many processors do not have.
    const TRAPS: u64 = 0b111 << 8;

    #[inline(always)]
    pub(super) fn control() -> Control {
        let control;
        // SAFETY: reads a register that every program may read.
        unsafe { asm!("mrs {}, fpcr", out(reg) control, options(nomem, nostack, preserves_flags)) };
        control
    }

    pub(super) fn set_control(control: Control) {
        // SAFETY: every program may write it. The code that follows computes in the default environment or is the program's own,
        // by this module's functions.
        unsafe { asm!("msr fpcr, {}", in(reg) control, options(nostack, preserves_flags)) };
    }

    pub(super) fn clear_flags() {
        // SAFETY: every program may write it.
        unsafe { asm!("msr fpsr, {}", in(reg) 0_u64, options(nostack, preserves_flags)) };
    }

    pub(super) fn has_invalid_flag() -> bool {
        let flags: u64;
        // SAFETY: reads a register that every program may read.
        unsafe { asm!("mrs {}, fpsr", out(reg) flags, options(nostack, preserves_flags)) };
        flags & INVALID_OR_DIVISION_BY_ZERO != 0
    }

    pub(super) fn of(environment: Environment) -> Control {
        let rounding = match environment.rounding {
            Rounding::Nearest => 0,
            Rounding::Up => 1 << 22,
            Rounding::Down => 2 << 22,
            Rounding::TowardZero => 3 << 22,
        };
        let flushing = if environment.flushes { FLUSH_TO_ZERO } else { 0 };
        let traps = if environment.traps { TRAPS } else { 0 };
        rounding | flushing | traps
    }
}

/// No register that this library knows of: the environment is taken for the default.
#[cfg(any(miri, not(any(target_arch = "x86_64", target_arch = "aarch64"))))]
mod register {
    use super::{Control, Environment};

    pub(super) const DEFAULT: Control = 0;

    #[inline(always)]
    pub(super) fn control() -> Control {
        DEFAULT
    }

    pub(super) fn set_control(_control: Control) {}

    pub(super) fn clear_flags() {}

    pub(super) fn has_invalid_flag() -> bool {
        false
    }

    pub(super) fn of(_environment: Environment) -> Control {
        DEFAULT
    }
}
