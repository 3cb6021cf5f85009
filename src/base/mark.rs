//! Marks that tell what lives from what was freed.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// No number that memory holds by chance.
const ALIVE: u64 = 0x5357_4946_5450_524f;

/// A word of what a program holds by pointer, cleared when that is freed. Until the memory is used again, a call with the stale
/// pointer is refused instead of answered. Memory checkers report such a call first.
#[derive(Debug)]
pub(crate) struct Mark(AtomicU64);

impl Mark {
    pub fn new() -> Mark {
        Mark(AtomicU64::new(ALIVE))
    }

    /// Whether the mark was not cleared.
    #[inline(always)]
    pub fn is_alive(&self) -> bool {
        self.0.load(Relaxed) == ALIVE
    }
}

/// A copy lives on its own.
impl Clone for Mark {
    fn clone(&self) -> Mark {
        Mark::new()
    }
}

/// An atomic store: a plain one before memory is freed may be left out.
impl Drop for Mark {
    fn drop(&mut self) {
        self.0.store(0, Relaxed);
    }
}

/// It says nothing of what it marks.
impl PartialEq for Mark {
    fn eq(&self, _: &Mark) -> bool {
        true
    }
}
