//! Threads of a scene's own. Only lending them a task stands here: they live longer than what they are lent, and that no type can
//! say.

use crate::base::workers::Workers;
use crate::base::workers::parked::{MOST_THREADS, ParkedThreads, Parts, Task};

impl Workers {
    /// Threads of the standard library, started now, which wait between calls and end with the last owner of this; the caller's
    /// is one of the `count`, and more than 256 are taken as 256. Of several who call at once one shares, the others do all their
    /// parts themselves.
    pub fn threads(count: usize) -> Workers {
        let count = count.min(MOST_THREADS);
        let threads = ParkedThreads::new(count.saturating_sub(1));
        Workers::new(count, move |count, work| {
            let parts = Parts::new(work, count);
            threads.run(&Loan((&raw const parts).cast()));
        })
    }
}

/// Parts on loan, of any lifetime: [`ParkedThreads::run`] does not return before no thread has a copy.
#[derive(Clone, Copy)]
struct Loan(*const Parts<&'static (dyn Fn(usize) + Sync)>);

// SAFETY: the parts are shared between threads: their members are `Sync`.
unsafe impl Send for Loan {}

impl Task for Loan {
    fn take_parts(&self) {
        // SAFETY: the parts live until all that have the loan have given it back: see `Workers::threads`.
        unsafe { &*self.0 }.take();
    }
}
