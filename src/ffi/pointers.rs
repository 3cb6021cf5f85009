//! The checks of pointers.

use super::failure::{Checked, Failure, StatusCode};
use std::ffi::{CStr, c_char};

/// An input that must not be null.
///
/// # Safety
/// `pointer` is null or points to a valid `T` for `'a`.
#[inline(always)]
pub(super) unsafe fn input<'a, T>(pointer: *const T, name: &str) -> Checked<&'a T> {
    // SAFETY: valid when not null, by the caller.
    unsafe { pointer.as_ref() }.ok_or_else(|| Failure::null(name))
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
