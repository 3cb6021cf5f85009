//! Times on a machine that others use, too.
//!
//! The clock is the thread's CPU time, so that being preempted does not count. The methods that are handed in take turns pass by
//! pass, so that a slow spell of the machine hits all of them. Each turn begins untimed with the same poses backwards: the method
//! then finds its data in the machine's caches as it leaves them itself, not as the others do, but has not taught the branch
//! predictors what comes; nor may the method before it, so no two that run the same code are to follow each other. A pass is cut
//! into chunks, and each chunk's best over the passes is summed: what a whole undisturbed pass would take. Coherence flows
//! through a pass and is dropped between passes.

use std::ops::Range;

use crate::method::Method;

const CHUNKS: usize = 9;

/// Nanoseconds a query.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    /// Sum of each chunk's best.
    pub best: f64,
    /// Median of the whole passes.
    pub median: f64,
}

/// What is timed: queries in passes.
pub trait Timed {
    /// Drops all coherence.
    fn forget(&mut self);

    /// All queries from the last to the first.
    fn run_backwards(&mut self, count: usize);

    fn run(&mut self, queries: Range<usize>);
}

impl Timed for Box<dyn Method + '_> {
    fn forget(&mut self) {
        (**self).forget();
    }

    fn run_backwards(&mut self, count: usize) {
        (**self).run_backwards(count);
    }

    fn run(&mut self, queries: Range<usize>) {
        (**self).run(queries);
    }
}

/// Times `passes` passes over `count` loaded queries, after one pass untimed (the caller's check).
pub fn time_methods<M: Timed>(methods: &mut [M], count: usize, passes: usize) -> Vec<Time> {
    let mut best = vec![[f64::INFINITY; CHUNKS]; methods.len()];
    let mut totals = vec![Vec::with_capacity(passes); methods.len()];
    for _ in 0..passes {
        for (m, method) in methods.iter_mut().enumerate() {
            method.run_backwards(count);
            method.forget();
            let mut total = 0.0;
            for (chunk, best) in best[m].iter_mut().enumerate() {
                let ns = measure(|| method.run(chunk_range(chunk, count)));
                *best = best.min(ns);
                total += ns;
            }
            totals[m].push(total);
        }
    }
    let per_query = 1.0 / count as f64;
    (best.iter().zip(&mut totals))
        .map(|(best, totals)| Time { best: best.iter().sum::<f64>() * per_query, median: median(totals) * per_query })
        .collect()
}

fn chunk_range(chunk: usize, count: usize) -> Range<usize> {
    chunk * count / CHUNKS..(chunk + 1) * count / CHUNKS
}

/// Nanoseconds of CPU time that `work` takes in this thread.
pub fn measure(work: impl FnOnce()) -> f64 {
    let start = thread_time();
    work();
    thread_time() - start
}

/// Nanoseconds on the wall's clock: of work that other threads share.
pub fn measure_on_the_wall(work: &mut dyn FnMut()) -> f64 {
    let start = std::time::Instant::now();
    work();
    start.elapsed().as_nanos() as f64
}

/// The CPU time of this thread in nanoseconds.
fn thread_time() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `time` is a timespec to write to.
    let status = unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    assert_eq!(status, 0, "this system has no CPU clock for a thread");
    time.tv_sec as f64 * 1e9 + time.tv_nsec as f64
}

/// The middle value (the upper one of two); NaN for none. Sorts.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
