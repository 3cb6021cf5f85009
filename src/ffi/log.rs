//! The log of the process, and calls of what the program gives.

use super::enumerators::StatusNumber;
use super::failure::{Failure, StatusCode};
use crate::base::simd::environment::with_callers;
use std::ffi::{CStr, CString, c_char, c_void};
use std::sync::{PoisonError, RwLock};

/// Calls what must not unwind, in the program's floating-point environment, and ends the program if it does: an exception of C++
/// would go through frames that expect none.
#[inline(always)]
pub(super) fn must_return<T>(callback: impl FnOnce() -> T) -> T {
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

/// Receives each failure when it happens, in the thread where it happens. It gets the status, the message (valid during the call)
/// and the pointer given to swiftprox_library_set_log. It must return; a C++ exception that leaves it ends the program.
pub type LogCallback =
    Option<unsafe extern "C-unwind" fn(status: StatusNumber, message: *const c_char, user: *mut c_void)>;

#[derive(Clone, Copy)]
struct Log {
    callback: LogCallback,
    user: *mut c_void,
}

// SAFETY: `user` is only ever handed back to the callback, which swiftprox_library_set_log requires to be callable from every
// thread.
unsafe impl Send for Log {}
// SAFETY: as above.
unsafe impl Sync for Log {}

static LOG: RwLock<Log> = RwLock::new(Log { callback: None, user: std::ptr::null_mut() });

/// Hands what went wrong to the log; gives the message.
#[cold]
#[inline(never)]
pub(super) fn log(failure: Failure) -> CString {
    let Failure { status, message } = failure;
    // A message may quote a file: C must see all of it.
    let message = CString::new(message.replace('\0', "\u{fffd}")).unwrap_or_default();
    tell(status, &message);
    message
}

/// Hands a failure to the log.
fn tell(status: StatusCode, message: &CStr) {
    // The lock is let go first: a callback may set the log.
    let log = *LOG.read().unwrap_or_else(PoisonError::into_inner);
    if let Some(callback) = log.callback {
        // SAFETY: the callback takes any status and message and its own user pointer (swiftprox_library_set_log).
        must_return(|| unsafe { callback(status as i32, message.as_ptr(), log.user) });
    }
}

/// Makes this the log; `user` is the callback's own.
pub(super) fn set_log(callback: LogCallback, user: *mut c_void) {
    *LOG.write().unwrap_or_else(PoisonError::into_inner) = Log { callback, user };
}
