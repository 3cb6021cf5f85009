//! Sharing of long work: by the caller's thread alone, or by several. The work is cut into parts of what belongs together, each
//! with the data it alone may change. The results are put together again in order: no bit of them depends on who did what.

mod handover;
pub(crate) mod parked;

use std::fmt;
use std::sync::Mutex;

use crate::base::error::{Error, Result};
use crate::base::locks::{locked, unlocked};
use crate::base::memory::{collected, with_capacity};
use crate::base::simd::environment::with_default;

/// Fewer pairs, pieces or objects are left to the caller's thread: waking another takes as long as some dozen tests of pairs.
const FEWEST_SHARED: usize = 2048;

/// So many parts for each thread, as some take longer than others.
const PARTS_EACH: usize = 4;

/// The threads that share the work of a scene.
pub struct Workers {
    count: usize,
    run: Box<RunParts>,
}

/// Calls the function once for each number below the first argument, in any threads, and returns when all calls have returned.
type RunParts = dyn Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync;

impl Workers {
    /// The program's own `count` threads: `run` is to call the function that it gets once for each number below the one that it
    /// gets, in any threads, several at once, and to return when all calls have returned. A panic of the function is to go on its
    /// way, and so may one of `run`: where objects were being moved, some have then moved and others have not.
    pub fn new(count: usize, run: impl Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync + 'static) -> Workers {
        Workers { count, run: Box::new(run) }
    }

    /// The caller's thread alone.
    pub(crate) fn none() -> Workers {
        Workers::new(1, |parts, work| (0..parts).for_each(work))
    }

    /// Whether so many pairs, pieces or objects are worth sharing.
    pub(crate) fn share(&self, count: usize) -> bool {
        self.count > 1 && count >= FEWEST_SHARED
    }

    /// How many of `count` things make a part.
    pub(crate) fn part_size(&self, count: usize) -> usize {
        count.div_ceil(self.count.saturating_mul(PARTS_EACH)).max(1)
    }

    /// The results of the work for each part, in their order.
    ///
    /// # Errors
    /// [`Error::Memory`]: nothing is done then. [`Error::Bug`] where the runner of the parts swallowed a panic.
    pub(crate) fn map<P: Send, R: Send>(
        &self,
        parts: impl IntoIterator<Item = P>,
        work: impl Fn(P) -> R + Sync,
    ) -> Result<Vec<R>> {
        let parts = collected(parts.into_iter().map(|part| Mutex::new((Some(part), None))))?;
        let mut results = with_capacity(parts.len())?;
        let done = |k: usize| {
            if let Some(part) = parts.get(k) {
                let (part, result) = &mut *locked(part);
                if let Some(part) = part.take() {
                    *result = Some(with_default(|| work(part)));
                }
            }
        };
        (self.run)(parts.len(), &done);
        // Whoever shares the work out may have left something.
        (0..parts.len()).for_each(done);
        for mut part in parts {
            let (_, result) = unlocked(&mut part);
            results.push(result.take().ok_or_else(|| Error::Bug("a part of the work was left undone".into()))?);
        }
        Ok(results)
    }
}

impl fmt::Debug for Workers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Workers({})", self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    #[test]
    fn parts_are_done_once_and_stand_in_order() {
        // The last part first, one twice, one left.
        let careless = |parts: usize, work: &(dyn Fn(usize) + Sync)| (1..parts).rev().chain([1]).for_each(work);
        for workers in [Workers::none(), Workers::new(2, careless)] {
            for count in 0..5 {
                let results = workers.map(vec![vec![7; 3]; count].into_iter().enumerate(), |(k, part)| k * part.len());
                assert_eq!(results.unwrap(), (0..count).map(|k| 3 * k).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn a_panic_that_is_swallowed_is_a_bug() {
        let swallows = |parts: usize, work: &(dyn Fn(usize) + Sync)| {
            for k in 0..parts {
                let _ = catch_unwind(AssertUnwindSafe(|| work(k)));
            }
        };
        let workers = Workers::new(2, swallows);
        let results = workers.map(0..4, |k| assert_ne!(k, 2, "part {k} fails"));
        assert!(matches!(results, Err(Error::Bug(_))), "{results:?}");
    }

    #[test]
    fn few_are_not_shared() {
        let many = Workers::new(3, |_, _| {});
        assert!(!many.share(FEWEST_SHARED - 1) && many.share(FEWEST_SHARED) && !Workers::none().share(usize::MAX));
        assert_eq!(many.part_size(FEWEST_SHARED), FEWEST_SHARED.div_ceil(3 * PARTS_EACH));
        assert_eq!([many.part_size(5), many.part_size(0)], [1, 1]);
        assert_eq!(Workers::new(usize::MAX, |_, _| {}).part_size(1 << 20), 1);
    }
}
