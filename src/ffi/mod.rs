//! The C interface: with `base/simd/` the only unsafe code. One file per noun; this one holds what every entry
//! point shares: the guard that turns errors and caught panics into a [`StatusCode`], the message of the last failure, and the
//! checks of pointers.
//!
//! The contract that every pointer must meet (alignment, lifetime, exclusive use behind a non-const pointer) is stated once,
//! in the head of `swiftprox.h`; the `SAFETY` comments below call it "the header's pointer rules".

#![allow(unsafe_code, reason = "this is where C comes in; the lint stays on everywhere else")]
#![allow(clippy::missing_safety_doc, reason = "the header's pointer rules, stated once, are the safety section of all")]

mod structs;
// In the order of the header.
pub mod library;
pub mod allocator;
mod arrays;
pub mod mesh_reader;
pub mod tuning;
pub mod shape_options;
pub mod shape;
pub mod level;
pub mod pair;
pub mod depth;
pub mod motion;
pub mod ray;
mod task_loan;
pub mod workers;
pub mod scene;
pub mod object;
pub mod pose;
pub mod query;
pub mod filter;
pub mod object_query;
pub mod record;

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use crate::base::enumerator::{Enumerator, enumerator};
use crate::base::error::Error;
use crate::base::simd::environment::{with_callers, with_default};
use crate::motion::CastOutcome;
use crate::pair::{DecidedBy, DepthEnding, FeatureKind, Levels, Outcome, Query, Refinement, Start};
use crate::ray::RayOutcome;
use crate::scene::ContactDetail;
use crate::shape::InputPolicy;
use motion::MotionKind;
use structs::{Versioned, init_struct, read_struct, view_struct, write_struct};

/// What a call returns. The numbers are never reused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum StatusCode {
    /// The call did what it says.
    Ok = 0,
    /// A pointer that must not be null is null: the message names the argument.
    ErrorNullPointer = 1,
    /// An argument is out of range, not finite or unknown: the message names it.
    ErrorInvalidArgument = 2,
    /// A struct_size is none: the struct was not initialised by its _init macro. Or the struct comes from a newer header and sets
    /// what this library does not know.
    ErrorStructSize = 3,
    /// A pose is refused: an entry is not finite, an entry of R^T R - I is beyond the limit, or det R is not positive.
    ErrorPose = 4,
    /// A mesh breaks the contract: the message names the face, edge or vertex in the caller's numbering.
    ErrorMesh = 5,
    /// A file cannot be read or written, or does not parse: the message names the file and the line.
    ErrorFile = 6,
    /// An object id is null, stale or of another scene.
    ErrorHandle = 7,
    /// A limit of the library is reached: a count that does not fit.
    ErrorLimit = 8,
    /// A callback asked to stop.
    ErrorCancelled = 9,
    /// A bug of the library, caught: please report the message.
    ErrorBug = 10,
    /// The handle met a bug in an earlier call; all that can be done with it is to destroy it.
    ErrorPoisoned = 11,
    /// The program was compiled with a header that does not go with this library.
    ErrorVersion = 12,
    /// The answer given to swiftprox_pair_verify does not hold for these shapes and poses: the message says what does not.
    ErrorUnverified = 13,
    /// The library was built without what the call is about.
    ErrorUnsupported = 14,
    /// There is no memory for an array in proportion to what the caller gave or to a scene: the message says how much was asked
    /// for. Nothing has changed, and the same call may succeed when there is more.
    ErrorMemory = 15,
    /// The scene is in use: by another thread, which the rules for threads forbid, or by a call that this one was made in. Nothing
    /// has changed.
    ErrorBusy = 16,
}

/// Why a call did not do what it says.
#[derive(Debug)]
struct Failure {
    status: StatusCode,
    message: String,
}

/// The result of what runs inside the guard.
type Checked<T> = Result<T, Failure>;

impl Failure {
    #[cold]
    fn new(status: StatusCode, message: impl Into<String>) -> Failure {
        Failure { status, message: message.into() }
    }

    #[cold]
    fn null(name: &str) -> Failure {
        Failure::new(StatusCode::ErrorNullPointer, format!("the pointer `{name}` is null"))
    }
}

impl From<Error> for Failure {
    #[cold]
    fn from(error: Error) -> Failure {
        let status = match error {
            Error::Argument(_) => StatusCode::ErrorInvalidArgument,
            Error::Pose(_) => StatusCode::ErrorPose,
            Error::Mesh(_) => StatusCode::ErrorMesh,
            Error::File(_) => StatusCode::ErrorFile,
            Error::Handle(_) => StatusCode::ErrorHandle,
            Error::Limit(_) => StatusCode::ErrorLimit,
            Error::Memory(_) => StatusCode::ErrorMemory,
            Error::Cancelled(_) => StatusCode::ErrorCancelled,
            Error::Unverified(_) => StatusCode::ErrorUnverified,
            Error::Bug(_) => StatusCode::ErrorBug,
        };
        Failure::new(status, error.message())
    }
}

// --- The guard ---------------------------------------------------------------------------------------------------------

/// Runs the body of an entry point in the default floating-point environment: nothing unwinds into C.
#[inline(always)]
fn guard(body: impl FnOnce() -> Checked<()>) -> StatusCode {
    caught(|| with_default(body))
}

/// As [`guard`], in whatever environment the program has set: for what computes nothing itself, and calls what sees to it. Nothing
/// but the result is looked at on success, so that a pair query pays a few instructions for it.
#[inline(always)]
fn caught(body: impl FnOnce() -> Checked<()>) -> StatusCode {
    let outside = INSIDE.replace(true);
    // Unwind safety: what a panic may leave half-changed is reset or poisoned by the entry points themselves.
    let ended = catch_unwind(AssertUnwindSafe(body)).map_err(discard);
    INSIDE.set(outside);
    match ended {
        Ok(Ok(())) => StatusCode::Ok,
        Ok(Err(failure)) => report(failure),
        Err(()) => report(bug()),
    }
}

/// Frees what a panic carries. Dropping it may panic in its turn (no payload of ours does); what that one carries is forgotten.
#[cold]
#[inline(never)]
fn discard(payload: Box<dyn Any + Send>) {
    if let Err(another) = catch_unwind(AssertUnwindSafe(|| drop(payload))) {
        std::mem::forget(another);
    }
}

/// The cold end of every failing call: remembers the message for this thread and hands it to the log.
#[cold]
#[inline(never)]
fn report(failure: Failure) -> StatusCode {
    let status = failure.status;
    let message = log(failure);
    // At the end of a thread the message has no place any more; the status still says what happened.
    let _ = LAST_ERROR.try_with(|last| last.replace(message));
    status
}

/// Hands what went wrong to the log; gives the message.
#[cold]
#[inline(never)]
fn log(failure: Failure) -> CString {
    let Failure { status, message } = failure;
    // A message may quote a file: C must see all of it.
    let message = CString::new(message.replace('\0', "\u{fffd}")).unwrap_or_default();
    library::log(status, &message);
    message
}

thread_local! {
    /// What `swiftprox_library_last_error_message` returns.
    static LAST_ERROR: RefCell<CString> = RefCell::new(CString::default());
    /// What the panic hook saw, on its way to the guard.
    static LAST_PANIC: Cell<Option<String>> = const { Cell::new(None) };
    /// Whether this thread is in a call from C: its panics are caught.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Calls what must not unwind, in the program's floating-point environment, and ends the program if it does: an exception of C++
/// would go through frames that expect none.
#[inline(always)]
fn must_return<T>(callback: impl FnOnce() -> T) -> T {
    struct Abort;
    impl Drop for Abort {
        fn drop(&mut self) {
            std::process::abort();
        }
    }
    let abort = Abort;
    let result = with_callers(callback);
    std::mem::forget(abort);
    result
}

/// Calls a callback of the caller's, whose panics are no bugs of ours.
fn call_out<T>(callback: impl FnOnce() -> T) -> T {
    let inside = INSIDE.replace(false);
    let result = must_return(callback);
    INSIDE.set(inside);
    result
}

/// The failure that a caught panic becomes.
fn bug() -> Failure {
    let seen = LAST_PANIC.try_with(Cell::take).ok().flatten();
    let seen = seen.unwrap_or_else(|| "a panic that left no message".into());
    Failure::new(StatusCode::ErrorBug, format!("a bug in swiftprox, please report it: {seen}"))
}

/// Keeps the message and the place of a panic in a call from C for [`bug`] and keeps them off the standard error of the program.
/// Called by the functions that make handles: without a handle there is nothing that could panic, and queries need not ask.
///
/// The hook is one for all that was linked with one standard library, which the C libraries have for themselves. A Rust program
/// shares its own: its other panics go on to the hook that it had.
fn keep_panics_quiet() {
    static INSTALLED: Once = Once::new();
    if std::thread::panicking() {
        return; // The hook cannot be changed now; the next handle will.
    }
    INSTALLED.call_once(|| {
        let previous = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if INSIDE.get() {
                let _ = LAST_PANIC.try_with(|last| last.set(Some(info.to_string().replace('\n', " "))));
            } else {
                previous(info);
            }
        }));
    });
}

// --- Arguments -----------------------------------------------------------------------------------------------------------

/// An input that must not be null.
///
/// # Safety
/// `pointer` is null or points to a valid `T` for `'a`.
#[inline(always)]
unsafe fn input<'a, T>(pointer: *const T, name: &str) -> Checked<&'a T> {
    // SAFETY: valid when not null, by the caller.
    unsafe { pointer.as_ref() }.ok_or_else(|| Failure::null(name))
}

/// An input or output that must not be null and that nobody else uses meanwhile.
///
/// # Safety
/// `pointer` is null or points to a valid `T` for `'a` that only this call uses.
#[inline(always)]
unsafe fn exclusive<'a, T>(pointer: *mut T, name: &str) -> Checked<&'a mut T> {
    // SAFETY: valid and unshared when not null, by the caller.
    unsafe { pointer.as_mut() }.ok_or_else(|| Failure::null(name))
}

/// Writes an output that must not be null; what was there before is not looked at.
///
/// # Safety
/// `pointer` is null or points to room for a `T` that only this call uses.
unsafe fn output<T: Copy>(pointer: *mut T, name: &str, value: T) -> Checked<()> {
    if pointer.is_null() {
        return Err(Failure::null(name));
    }
    // SAFETY: not null, and writable by the caller.
    unsafe { pointer.write(value) };
    Ok(())
}

/// An array that must not be null unless it is empty.
///
/// # Safety
/// `pointer` is null or points to `count` valid `T` for `'a`.
unsafe fn array<'a, T>(pointer: *const T, count: usize, name: &str) -> Checked<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        return Err(Failure::null(name));
    }
    // No array in memory is longer: a negative count that became a size_t, most likely.
    if count > isize::MAX as usize / size_of::<T>() {
        return Err(Failure::new(StatusCode::ErrorLimit, format!("`{name}` cannot have {count} entries")));
    }
    // SAFETY: not null, `count` valid entries by the caller, and no more bytes than isize::MAX.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// An enumerator, as C passes it in `member`, one of the C type `kind`.
#[inline(always)]
fn read_enumerator<T: Enumerator>(number: i32, member: &str, kind: &str) -> Checked<T> {
    T::from_number(number).ok_or_else(|| unknown(number, member, kind))
}

#[cold]
fn unknown(number: i32, member: &str, kind: &str) -> Failure {
    Failure::new(StatusCode::ErrorInvalidArgument, format!("{member} is {number}, which is no {kind}"))
}

enumerator!(InputPolicy { Strict, Flat, Hull, NearlyConvex });
enumerator!(Start { Automatic, Cache, Table, Cold });
enumerator!(Levels { Automatic, None, All });
enumerator!(Refinement { Adaptive, Single, SingleSingle, DoubleDouble });
enumerator!(Query { Intersection, Distance, Contact, Approximate });
enumerator!(Outcome { None, Separated, Beyond, Intersecting, Undecided });
enumerator!(DecidedBy {
    None,
    Marching,
    Coherence,
    Fallback,
    Integers,
    Tolerance,
    Budget,
    BoundingSpheres,
    InscribedSpheres
});
enumerator!(FeatureKind { None, Vertex, Edge, Face });
enumerator!(ContactDetail { None, Depth, Manifold, ReducedManifold });
enumerator!(DepthEnding { None, Narrow, Separated, Integers, Budget, Stalled });
enumerator!(RayOutcome { None, Miss, Hit, Inside });
enumerator!(CastOutcome { None, Free, Hit, Near, Budget });
enumerator!(MotionKind { Fixed, Screw, Affine, Callback });

// Enumerators as C hands them over. In the header they bear the names of the enums, so that compilers of C and C++ see them mixed
// up; here they are numbers, as a program may hand over any.

/// A [`StatusCode`].
pub type StatusNumber = i32;
/// A [`Query`].
pub type QueryNumber = i32;
/// An [`Outcome`].
pub type OutcomeNumber = i32;
/// A [`DecidedBy`].
pub type DecidedByNumber = i32;
/// A [`FeatureKind`].
pub type FeatureKindNumber = i32;
/// A [`ContactDetail`].
pub type ContactDetailNumber = i32;
/// A [`DepthEnding`].
pub type DepthEndingNumber = i32;
/// A [`CastOutcome`].
pub type CastOutcomeNumber = i32;
/// A [`RayOutcome`].
pub type RayOutcomeNumber = i32;
/// A [`MotionKind`].
pub type MotionKindNumber = i32;
/// An [`InputPolicy`].
pub type InputNumber = i32;
/// A [`HierarchyKind`](crate::levels::hierarchy::HierarchyKind).
pub type HierarchyNumber = i32;
/// A [`LookupKind`](crate::tables::LookupKind).
pub type LookupNumber = i32;
/// A [`Start`].
pub type StartNumber = i32;
/// A [`Levels`].
pub type LevelsNumber = i32;
/// A [`Refinement`].
pub type RefinementNumber = i32;

/// A string that must not be null.
///
/// # Safety
/// `pointer` is null or points to a string that ends in a zero byte and stays unchanged for `'a`.
unsafe fn string<'a>(pointer: *const c_char, name: &str) -> Checked<&'a CStr> {
    if pointer.is_null() {
        return Err(Failure::null(name));
    }
    // SAFETY: not null and terminated, by the caller.
    Ok(unsafe { CStr::from_ptr(pointer) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the test below looks at: in a process of its own, since the hook is set once.
    #[test]
    #[ignore = "run by the_messages_of_other_threads_are_not_swallowed"]
    fn panics_inside_and_outside() {
        keep_panics_quiet();
        let threads = [
            std::thread::spawn(|| assert_eq!(guard(|| panic!("a panic inside")), StatusCode::ErrorBug)),
            std::thread::spawn(|| panic!("a panic outside")),
            std::thread::spawn(|| {
                let status = guard(|| {
                    // What the caller's own code does in its callback is not kept quiet.
                    let caught = call_out(|| catch_unwind(|| panic!("a panic in a callback")));
                    assert!(caught.is_err());
                    panic!("a second panic inside");
                });
                assert_eq!(status, StatusCode::ErrorBug);
                panic!("a panic after a call");
            }),
        ];
        assert_eq!(threads.map(|thread| thread.join().is_ok()), [true, false, false]);
    }

    #[test]
    #[cfg_attr(miri, ignore = "no processes")]
    fn the_messages_of_other_threads_are_not_swallowed() {
        let mut this = std::process::Command::new(std::env::current_exe().unwrap());
        let run = this.args(["--exact", "ffi::tests::panics_inside_and_outside", "--ignored", "--nocapture"]).output();
        let run = run.unwrap();
        assert!(run.status.success(), "{run:?}");
        let printed = String::from_utf8(run.stderr).unwrap();
        for seen in ["a panic outside", "a panic in a callback", "a panic after a call"] {
            assert!(printed.contains(seen), "{seen}: {printed}");
        }
        assert!(!printed.contains("panic inside"), "{printed}");
    }
}
