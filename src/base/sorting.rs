//! Sorting that can be cancelled on the way.

use std::cmp::Ordering;

use crate::base::error::Result;
use crate::base::memory::reserve;
use crate::base::progress::Progress;

/// As many items are sorted in a few milliseconds.
const BLOCK: usize = 1 << 14;

/// Sorts items, any two of which `compare` tells apart: in blocks, then merged; fast where long parts are in order.
///
/// # Errors
/// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on; the items are in any order then;
/// [`crate::base::error::Error::Memory`].
pub fn sort_in_steps<T: Copy>(
    items: &mut Vec<T>,
    compare: impl Fn(&T, &T) -> Ordering,
    progress: &mut Progress,
) -> Result<()> {
    let count = items.len();
    let all = count * (1 + count.div_ceil(BLOCK).next_power_of_two().ilog2() as usize);
    let mut done = 0;
    for block in items.chunks_mut(BLOCK) {
        block.sort_unstable_by(&compare);
        done += block.len();
        progress.steps(block.len(), done, all)?;
    }
    let mut merged = Vec::new();
    let mut length = BLOCK;
    while length < count {
        merged.clear();
        reserve(&mut merged, count)?;
        for pair in items.chunks(2 * length) {
            let (left, right) = pair.split_at(length.min(pair.len()));
            merge(left, right, &compare, &mut merged, &mut |steps| {
                done += steps;
                progress.steps(steps, done, all)
            })?;
        }
        std::mem::swap(items, &mut merged);
        length *= 2;
    }
    Ok(())
}

/// Appends the items of two sorted lists, in order; reports steps as it goes.
fn merge<T: Copy>(
    mut left: &[T],
    mut right: &[T],
    compare: impl Fn(&T, &T) -> Ordering,
    merged: &mut Vec<T>,
    tell: &mut impl FnMut(usize) -> Result<()>,
) -> Result<()> {
    debug_assert!(merged.capacity() - merged.len() >= left.len() + right.len());
    debug_assert!(left.is_sorted_by(|a, b| compare(a, b).is_le()) && right.is_sorted_by(|a, b| compare(a, b).is_le()));
    if let (Some(last), Some(first)) = (left.last(), right.first())
        && compare(last, first) == Ordering::Greater
    {
        while let ([l, left_rest @ ..], [r, right_rest @ ..]) = (left, right) {
            if compare(l, r) == Ordering::Greater {
                merged.push(*r);
                right = right_rest;
            } else {
                merged.push(*l);
                left = left_rest;
            }
            tell(1)?;
        }
    }
    merged.extend_from_slice(left);
    merged.extend_from_slice(right);
    tell(left.len() + right.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use swiftprox::random::Random;

    #[test]
    fn sorted_as_by_the_standard_library() {
        let mut random = Random::new(31);
        let counts = [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 3 * BLOCK, 5 * BLOCK + 7];
        for count in if cfg!(miri) { &counts[..2] } else { &counts[..] } {
            // Many equal keys, told apart by the data that follow them.
            let random_keys: Vec<(u64, usize)> = (0..*count).map(|i| (random.next_u64() % 1000, i)).collect();
            let ascending: Vec<(u64, usize)> = (0..*count).map(|i| (i as u64 / 3, i)).collect();
            for items in [random_keys, ascending] {
                let (mut sorted, mut expected) = (items.clone(), items);
                let mut told = vec![0.0];
                let mut tell = |fraction| {
                    told.push(fraction);
                    true
                };
                sort_in_steps(&mut sorted, Ord::cmp, &mut Progress::new(&mut tell)).unwrap();
                expected.sort_unstable();
                assert!(sorted == expected && told.is_sorted() && told.iter().all(|fraction| *fraction <= 1.0));
            }
        }
    }

    #[test]
    fn a_sort_is_cancelled() {
        let mut items: Vec<usize> = (0..3 * BLOCK).rev().collect();
        let mut asked = 0;
        let mut stop = |_| {
            asked += 1;
            asked < 5
        };
        assert!(sort_in_steps(&mut items, usize::cmp, &mut Progress::new(&mut stop)).is_err());
        assert_eq!(asked, 5);
    }
}
