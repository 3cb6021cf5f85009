//! The checks of pointers.

use crate::base::error::Error;
use crate::base::mark::Mark;
use crate::compound::Compound;
use crate::ground::Ground;
use crate::shape::Shape;

use super::failure::{Checked, Failure, StatusCode};
use super::guard::guard;
use std::ffi::{CStr, c_char};
use std::sync::Arc;

/// An input that must not be null.
///
/// # Safety
/// `pointer` is null or points to a valid `T` for `'a`.
#[inline(always)]
pub(super) unsafe fn input<'a, T>(pointer: *const T, name: &str) -> Checked<&'a T> {
    // SAFETY: valid when not null, by the caller.
    unsafe { pointer.as_ref() }.ok_or_else(|| Failure::null(name))
}

/// An object that a program holds by a pointer and gives back.
pub(super) trait Handle {
    const NOUN: &str;
    fn mark(&self) -> &Mark;
}

impl Handle for Shape {
    const NOUN: &str = "shape";
    fn mark(&self) -> &Mark {
        &self.mark
    }
}

impl Handle for Ground {
    const NOUN: &str = "ground";
    fn mark(&self) -> &Mark {
        &self.mark
    }
}

impl Handle for Compound {
    const NOUN: &str = "compound";
    fn mark(&self) -> &Mark {
        &self.mark
    }
}

/// A handle that must not be null; one that was freed is refused as long as its memory shows it.
///
/// # Safety
/// `pointer` is null or points to a live `T` for `'a`, or to memory that was one's and is still mapped.
#[inline(always)]
pub(super) unsafe fn handle<'a, T: Handle>(pointer: *const T, name: &str) -> Checked<&'a T> {
    // SAFETY: by the caller.
    let handle = unsafe { input(pointer, name) }?;
    if handle.mark().is_alive() { Ok(handle) } else { Err(freed::<T>(name)) }
}

/// One more share of a handle, which is null if that is, and if there is none to share.
///
/// # Safety
/// As of [`handle`]; a live one comes from [`Arc::into_raw`].
pub(super) unsafe fn retained<T: Handle>(pointer: *const T, name: &str) -> *const T {
    let mut shared = std::ptr::null();
    let _: StatusCode = guard(|| {
        if !pointer.is_null() {
            // SAFETY: by the caller.
            unsafe {
                handle(pointer, name)?;
                Arc::increment_strong_count(pointer);
            }
            shared = pointer;
        }
        Ok(())
    });
    shared
}

/// Gives up one share of a handle; null is ignored.
///
/// # Safety
/// As of [`retained`]; the share is the caller's.
pub(super) unsafe fn release<T: Handle>(pointer: *const T, name: &str) -> Checked<()> {
    if !pointer.is_null() {
        // SAFETY: by the caller.
        unsafe {
            handle(pointer, name)?;
            Arc::decrement_strong_count(pointer);
        }
    }
    Ok(())
}

#[cold]
pub(super) fn freed<T: Handle>(name: &str) -> Failure {
    let noun = T::NOUN;
    Failure::from(Error::Handle(format!(
        "`{name}` is no living {noun}: it was released or destroyed, or is no pointer from this library; keep a share of the \
         {noun} until its last use"
    )))
}

/// An input or output that must not be null and that nobody else uses meanwhile.
///
/// # Safety
/// `pointer` is null or points to a valid `T` for `'a` that only this call uses.
#[inline(always)]
pub(super) unsafe fn exclusive<'a, T>(pointer: *mut T, name: &str) -> Checked<&'a mut T> {
    // SAFETY: valid and unshared when not null, by the caller.
    unsafe { pointer.as_mut() }.ok_or_else(|| Failure::null(name))
}

/// Writes an output that must not be null; what was there before is not looked at.
///
/// # Safety
/// `pointer` is null or points to room for a `T` that only this call uses.
pub(super) unsafe fn output<T: Copy>(pointer: *mut T, name: &str, value: T) -> Checked<()> {
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
pub(super) unsafe fn array<'a, T>(pointer: *const T, count: usize, name: &str) -> Checked<&'a [T]> {
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

/// A string that must not be null.
///
/// # Safety
/// `pointer` is null or points to a string that ends in a zero byte and stays unchanged for `'a`.
pub(super) unsafe fn string<'a>(pointer: *const c_char, name: &str) -> Checked<&'a CStr> {
    if pointer.is_null() {
        return Err(Failure::null(name));
    }
    // SAFETY: not null and terminated, by the caller.
    Ok(unsafe { CStr::from_ptr(pointer) })
}

/// Leaves nothing half-written behind a bug.
///
/// # Safety
/// The pointers meet the header's pointer rules.
#[cold]
pub(super) unsafe fn reset<C: Default, A: Default>(cache: *mut C, answer: *mut A) {
    if !cache.is_null() {
        // SAFETY: not null, and writable by the caller.
        unsafe { cache.write(C::default()) };
    }
    if !answer.is_null() {
        // SAFETY: not null, and writable by the caller.
        unsafe { answer.write(A::default()) };
    }
}
