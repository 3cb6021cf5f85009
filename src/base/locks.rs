//! Locks whose content a panic does not spoil: the value behind each is as good half done as whole, or done anew.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// The value behind a lock.
#[inline(always)]
pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The same of a lock that nobody else can hold.
#[inline(always)]
pub(crate) fn unlocked<T>(mutex: &mut Mutex<T>) -> &mut T {
    mutex.get_mut().unwrap_or_else(PoisonError::into_inner)
}
