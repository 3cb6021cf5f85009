//! Arrays in proportion to the caller's input: requested in a way that can be refused.
//!
//! Rust ends the program where memory is not there. A vector that grows with the input, or with a scene, therefore gets its room
//! here: a refusal is [`Error::Memory`]. An allocation that is small for any input needs no such request; `docs/conventions.md`
//! lists that.

use std::any::Any;
use std::cell::Cell;
use std::collections::{BinaryHeap, TryReserveError};
use std::panic::{AssertUnwindSafe, catch_unwind, panic_any, resume_unwind};
use std::sync::{Mutex, OnceLock};

use crate::base::error::{Error, Result};
use crate::base::locks::locked;

/// An empty vector with room for `count`.
#[inline]
pub(crate) fn with_capacity<T>(count: usize) -> Result<Vec<T>> {
    let mut list = Vec::new();
    list.try_reserve_exact(count).map_err(|e| lacking::<T>(count, &e))?;
    Ok(list)
}

/// `count` times the same.
#[inline]
pub(crate) fn filled<T: Clone>(value: T, count: usize) -> Result<Vec<T>> {
    let mut list = with_capacity(count)?;
    list.resize(count, value);
    Ok(list)
}

/// The items of an iterator.
#[inline]
pub(crate) fn collected<T>(items: impl IntoIterator<Item = T>) -> Result<Vec<T>> {
    let mut list = Vec::new();
    extend(&mut list, items)?;
    Ok(list)
}

/// A copy of a slice.
#[inline]
pub(crate) fn copied<T: Clone>(items: &[T]) -> Result<Vec<T>> {
    let mut list = with_capacity(items.len())?;
    list.extend_from_slice(items);
    Ok(list)
}

/// Room for `count` more, and for as many again as there are, so that asking for one at a time costs little.
#[inline]
pub(crate) fn reserve<T>(list: &mut Vec<T>, count: usize) -> Result<()> {
    if count > list.capacity() - list.len() { grow(list, count) } else { Ok(()) }
}

/// Same as [`reserve`], for an eighth of the present length: for lists that are large and stay, and seldom grow.
#[inline]
pub(crate) fn reserve_sparingly<T>(list: &mut Vec<T>, count: usize) -> Result<()> {
    if count <= list.capacity() - list.len() {
        return Ok(());
    }
    let count = count.max(list.len() / 8).max(4);
    list.try_reserve_exact(count).map_err(|e| lacking::<T>(list.len().saturating_add(count), &e))
}

/// One more at the end.
#[inline(always)]
pub(crate) fn push<T>(list: &mut Vec<T>, item: T) -> Result<()> {
    if list.len() == list.capacity() {
        grow(list, 1)?;
    }
    list.push(item);
    Ok(())
}

/// Appends all items of an iterator. Those that are there after a refusal are among them.
#[inline]
pub(crate) fn extend<T>(list: &mut Vec<T>, items: impl IntoIterator<Item = T>) -> Result<()> {
    let items = items.into_iter();
    let (least, most) = items.size_hint();
    if most == Some(least) {
        reserve(list, least)?;
        list.extend(items);
        return Ok(());
    }
    for item in items {
        push(list, item)?;
    }
    Ok(())
}

/// One more in a heap.
#[inline(always)]
pub(crate) fn push_to_heap<T: Ord>(heap: &mut BinaryHeap<T>, item: T) -> Result<()> {
    if heap.len() == heap.capacity() {
        heap.try_reserve(1).map_err(|e| lacking::<T>(heap.len() + 1, &e))?;
    }
    heap.push(item);
    Ok(())
}

/// The value of a result, if there is one; only a lack of memory and a cancelling caller are errors here.
pub(crate) fn found<T>(result: Result<T>) -> Result<Option<T>> {
    match result {
        Err(error @ (Error::Memory(_) | Error::Cancelled(_))) => Err(error),
        other => Ok(other.ok()),
    }
}

#[cold]
#[inline(never)]
fn grow<T>(list: &mut Vec<T>, count: usize) -> Result<()> {
    list.try_reserve(count).map_err(|e| lacking::<T>(list.len().saturating_add(count), &e))
}

/// The error of a collection of the standard library that requested room itself: for `count` of `T`.
#[cold]
#[inline(never)]
pub(crate) fn lacking<T>(count: usize, error: &TryReserveError) -> Error {
    let bytes = count.saturating_mul(size_of::<T>());
    Error::Memory(format!("there is no memory for an array of {bytes} bytes: {error}"))
}

/// The payload of the panic where integers of any size get no new block (the crate dashu-int).
const NO_MEMORY: &str = "out of memory";

/// … and where theirs is not made another size: its `Buffer::reallocate_raw` unwraps the pointer. Nothing of ours unwraps an
/// option, as a test of the project sees to, and all other options that dashu-int unwraps are there.
const NO_OTHER_SIZE: &str = "called `Option::unwrap()` on a `None` value";

thread_local! {
    /// Whether this thread is in [`in_integers`].
    static CATCHES: Cell<bool> = const { Cell::new(false) };
}

/// Runs work that computes with integers of any size: their lack of memory is an error here, and the panic that reports it goes
/// no further. `work` only computes: after an error its result alone is read, and nothing else that it writes to.
///
/// # Errors
/// [`Error::Memory`].
#[cold]
#[inline(never)]
pub(crate) fn in_integers<T>(work: impl FnOnce() -> T) -> Result<T> {
    let outside = CATCHES.replace(true);
    let ended = catch_unwind(AssertUnwindSafe(work));
    CATCHES.set(outside);
    ended.map_err(|payload| {
        if !is_lack_of_memory(&*payload) {
            resume_unwind(payload);
        }
        Error::Memory("there is no memory for an integer of a few hundred bytes".into())
    })
}

/// Whether a panic of this thread becomes an error: nobody need hear of it.
pub(crate) fn becomes_an_error(payload: &(dyn Any + Send)) -> bool {
    CATCHES.get() && is_lack_of_memory(payload)
}

fn is_lack_of_memory(payload: &(dyn Any + Send)) -> bool {
    payload.downcast_ref::<&str>().is_some_and(|message| [NO_MEMORY, NO_OTHER_SIZE].contains(message))
}

/// A list of an iterator's items, with room for a few more at least, for [`in_integers`].
///
/// # Panics
/// As integers do, where there is no memory.
pub(crate) fn listed<T>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    const ROOM: usize = 5;
    let mut list = Vec::new();
    let grow = |list: &mut Vec<T>| list.try_reserve(ROOM).unwrap_or_else(|_| panic_any(NO_MEMORY));
    grow(&mut list);
    for item in items {
        if list.len() == list.capacity() {
            grow(&mut list);
        }
        list.push(item);
    }
    list
}

/// A value that the first thread to need it makes, while others that need it wait.
#[derive(Debug)]
pub struct OnNeed<T> {
    made: OnceLock<T>,
    /// Held while it is made. True where memory was lacking: then callers manage without it until one insists, as trying again
    /// takes long.
    lacked: Mutex<bool>,
}

impl<T> OnNeed<T> {
    /// Not made yet.
    pub const fn new() -> OnNeed<T> {
        OnNeed { made: OnceLock::new(), lacked: Mutex::new(false) }
    }

    /// The value, if it is made.
    #[inline(always)]
    pub fn get(&self) -> Option<&T> {
        self.made.get()
    }

    /// Made for a caller that needs no value: `None` where memory is or was lacking.
    #[cold]
    #[inline(never)]
    pub fn make(&self, make: impl FnOnce() -> Result<T>) -> Option<&T> {
        let mut lacked = locked(&self.lacked);
        if !*lacked && self.get().is_none() {
            match make() {
                Ok(made) => drop(self.made.set(made)),
                Err(_) => *lacked = true,
            }
        }
        self.get()
    }

    /// Made for a caller that insists.
    ///
    /// # Errors
    /// Those of `make`, usually [`Error::Memory`]; the value is not made then.
    pub fn insist(&self, make: impl FnOnce() -> Result<T>) -> Result<()> {
        let mut lacked = locked(&self.lacked);
        if self.get().is_none() {
            let _ = self.made.set(make()?);
            *lacked = false;
        }
        Ok(())
    }

    /// Made elsewhere; dropped if another was first.
    pub fn set(&self, made: T) {
        let _ = self.made.set(made);
    }
}

impl<T> From<T> for OnNeed<T> {
    fn from(made: T) -> Self {
        OnNeed { made: OnceLock::from(made), lacked: Mutex::new(false) }
    }
}

impl<T: Clone> Clone for OnNeed<T> {
    fn clone(&self) -> Self {
        self.get().cloned().map_or_else(OnNeed::new, OnNeed::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_for_comes_or_is_refused() {
        assert_eq!(filled(7_u8, 3).unwrap(), [7; 3]);
        assert_eq!(copied(&[1, 2]).unwrap(), [1, 2]);
        assert_eq!(collected((0..9).filter(|i| i % 2 == 1)).unwrap(), [1, 3, 5, 7]);
        let mut list = collected(0..3).unwrap();
        extend(&mut list, [5, 6]).unwrap();
        push(&mut list, 7).unwrap();
        assert_eq!(list, [0, 1, 2, 5, 6, 7]);
        let refused = [
            with_capacity::<u64>(1 << 60).map(drop),
            filled(0_u64, 1 << 60).map(drop),
            collected(0..1_u64 << 60).map(drop),
            reserve(&mut list, usize::MAX),
        ];
        for result in refused {
            assert!(matches!(result, Err(Error::Memory(_))), "{result:?}");
        }
        assert_eq!(list, [0, 1, 2, 5, 6, 7]);
    }
}
