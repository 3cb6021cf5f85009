//! Arrays in proportion to what a caller gave: asked for in a way that can be refused.
//!
//! Rust ends the program where memory is not there. A vector that grows with the input, or with a scene, therefore gets its room
//! here: a refusal is [`Error::Memory`]. What is small whatever the input is need not ask; `docs/conventions.md` lists that.

use std::collections::TryReserveError;

use crate::error::{Error, Result};

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

/// What an iterator gives.
#[inline]
pub(crate) fn collected<T>(items: impl IntoIterator<Item = T>) -> Result<Vec<T>> {
    let mut list = Vec::new();
    extend(&mut list, items)?;
    Ok(list)
}

/// A copy of a slice.
#[inline]
pub(crate) fn copied<T: Copy>(items: &[T]) -> Result<Vec<T>> {
    let mut list = with_capacity(items.len())?;
    list.extend_from_slice(items);
    Ok(list)
}

/// Room for `count` more, and for as many again as there are, so that asking for one at a time costs little.
#[inline]
pub(crate) fn reserve<T>(list: &mut Vec<T>, count: usize) -> Result<()> {
    if count > list.capacity() - list.len() { grow(list, count) } else { Ok(()) }
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

/// All that an iterator gives at the end. What is there after a refusal is part of it.
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

#[cold]
#[inline(never)]
fn grow<T>(list: &mut Vec<T>, count: usize) -> Result<()> {
    list.try_reserve(count).map_err(|e| lacking::<T>(list.len().saturating_add(count), &e))
}

/// The error of a collection of the standard library that asked for room itself: for `count` of `T`.
#[cold]
#[inline(never)]
pub(crate) fn lacking<T>(count: usize, error: &TryReserveError) -> Error {
    let bytes = count.saturating_mul(size_of::<T>());
    Error::Memory(format!("there is no memory for an array of {bytes} bytes: {error}"))
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
            collected((0..1_u64 << 60).map(|i| i)).map(drop),
            reserve(&mut list, usize::MAX),
        ];
        for result in refused {
            assert!(matches!(result, Err(Error::Memory(_))), "{result:?}");
        }
        assert_eq!(list, [0, 1, 2, 5, 6, 7]);
    }
}
