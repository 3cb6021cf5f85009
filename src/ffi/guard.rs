//! The guard that every entry point runs in: it turns errors and caught panics into a [`StatusCode`] and the message of the last
//! failure.

use super::failure::{Checked, Failure, StatusCode};
use super::log::{log, must_return};
use crate::base::memory::becomes_an_error;
use crate::base::simd::environment::with_default;
use std::any::Any;
use std::cell::{Cell, RefCell};
use std::ffi::CString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

/// Runs the body of an entry point in the default floating-point environment: nothing unwinds into C.
#[inline(always)]
pub(super) fn guard(body: impl FnOnce() -> Checked<()>) -> StatusCode {
    caught(|| with_default(body))
}

/// As [`guard`], in whatever environment the program has set: for what computes nothing itself, and calls what sees to it. Nothing
/// but the result is looked at on success, so that a pair query pays a few instructions for it.
#[inline(always)]
pub(super) fn caught(body: impl FnOnce() -> Checked<()>) -> StatusCode {
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

thread_local! {
    /// What `swiftprox_library_last_error_message` returns.
    pub(super) static LAST_ERROR: RefCell<CString> = RefCell::new(CString::default());
    /// The panic that the hook saw, on its way to the guard.
    static LAST_PANIC: Cell<Option<String>> = const { Cell::new(None) };
    /// Whether this thread is in a call from C: its panics are caught.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Calls a callback of the caller's, whose panics are no bugs of ours.
pub(super) fn call_out<T>(callback: impl FnOnce() -> T) -> T {
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
/// What becomes an error says so itself.
/// Called by the functions that make handles: without a handle there is nothing that could panic, and queries need not ask.
///
/// The hook is one for all that was linked with one standard library, which the C libraries have for themselves. A Rust program
/// shares its own: its other panics go on to the hook that it had.
pub(super) fn keep_panics_quiet() {
    static INSTALLED: Once = Once::new();
    if std::thread::panicking() {
        return; // The hook cannot be changed now; the next handle will.
    }
    INSTALLED.call_once(|| {
        let previous = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if becomes_an_error(info.payload()) {
                return;
            }
            if INSIDE.get() {
                let _ = LAST_PANIC.try_with(|last| last.set(Some(info.to_string().replace('\n', " "))));
            } else {
                previous(info);
            }
        }));
    });
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
        let run =
            this.args(["--exact", "ffi::guard::tests::panics_inside_and_outside", "--ignored", "--nocapture"]).output();
        let run = run.unwrap();
        assert!(run.status.success(), "{run:?}");
        let printed = String::from_utf8(run.stderr).unwrap();
        for seen in ["a panic outside", "a panic in a callback", "a panic after a call"] {
            assert!(printed.contains(seen), "{seen}: {printed}");
        }
        assert!(!printed.contains("panic inside"), "{printed}");
    }
}
