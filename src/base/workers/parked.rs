//! Threads that wait between calls, and take parts of a task together with the caller.
//!
//! | what happens | what becomes of it |
//! |---|---|
//! | a thread cannot be started | the others, at least the caller's, do its part |
//! | a part panics in a thread | the thread lives on; the call panics in the caller's when all have stopped |
//! | the owner ends, or gets other threads | the threads are told so and waited for |
//! | the process forks | the child has none of them: there the caller's thread does all parts, and none is waited for |
//! | the process exits | nobody waits for them; between calls they touch their own lock at most |
//! | several call at once | one shares, the others do their parts themselves |
//!
//! `make loom` runs this file with loom's locks in place of the standard library's.

use std::any::Any;
use std::hint::spin_loop;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use super::handover::{Handover, NextTask};
use crate::base::locks::locked;

/// No more threads are started, whatever count is requested: more only wait for each other.
pub(crate) const MOST_THREADS: usize = 256;

/// One call makes several tasks one after the other. A thread that waits for the next, or for the last part of one, spins this
/// long before it sleeps: to be woken takes about as long.
const PATIENCE: Duration = Duration::from_micros(50);

/// So many turns of a loop between two looks, about a microsecond.
const SPINS: usize = 32;

/// Work shared by several threads.
pub(crate) trait Task: Clone + Send + 'static {
    /// Takes parts, one after the other, and does them until there are none left.
    fn take_parts(&self);
}

/// Parts that are taken one after the other by any free thread.
pub(crate) struct Parts<Work> {
    work: Work,
    count: usize,
    /// The next that nobody has taken.
    next: AtomicUsize,
}

impl<Work: Fn(usize) + Sync> Parts<Work> {
    pub fn new(work: Work, count: usize) -> Parts<Work> {
        Parts { work, count, next: AtomicUsize::new(0) }
    }

    /// See [`Task::take_parts`].
    pub fn take(&self) {
        loop {
            let part = self.next.fetch_add(1, Ordering::Relaxed);
            if part >= self.count {
                break;
            }
            (self.work)(part);
        }
    }
}

/// Threads that wait for tasks.
pub(crate) struct ParkedThreads<T: Task> {
    parking: Arc<Parking<T>>,
    threads: Vec<JoinHandle<()>>,
    /// The process that has them.
    process: u32,
}

/// The state that the threads and the caller share.
struct Parking<T> {
    handover: Mutex<Handover<T>>,
    /// The payload of the first panic in a thread.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
    /// How long somebody looks again and again before he sleeps.
    patience: Duration,
    /// There is a task, or the end.
    posted: Condvar,
    /// The last thread has left.
    left: Condvar,
}

impl<T: Task> ParkedThreads<T> {
    /// Up to `count` threads; the work goes on without those that cannot be started.
    pub fn new(count: usize) -> ParkedThreads<T> {
        // If threads share processors, one that spins keeps others from working.
        let has_room = std::thread::available_parallelism().is_ok_and(|processors| count < processors.get());
        let patience = if has_room { PATIENCE } else { Duration::ZERO };
        let (handover, panic) = (Mutex::new(Handover::IDLE), Mutex::new(None));
        let parking = Arc::new(Parking { handover, panic, patience, posted: Condvar::new(), left: Condvar::new() });
        let start = |_| {
            let parking = parking.clone();
            Builder::new().name("swiftprox".into()).spawn(move || parking.serve()).ok()
        };
        let threads = (0..count).map_while(start).collect();
        ParkedThreads { parking, threads, process: std::process::id() }
    }

    /// Runs all parts of a task in this thread and the others, and returns or panics when all of these have left it: none of them
    /// holds a clone of it any more. A panic in any of them goes on in this one.
    pub fn run(&self, task: &T) {
        if self.threads.is_empty() || !self.are_in_this_process() || !locked(&self.parking.handover).offer(task.clone())
        {
            return task.take_parts();
        }
        self.parking.posted.notify_all();
        // After a panic, too: the task must not go before all have left it.
        let own = catch_unwind(AssertUnwindSafe(|| task.take_parts()));
        let others = self.parking.take_back();
        if let Some(payload) = own.err().or(others) {
            resume_unwind(payload);
        }
    }

    /// In the process that forked the threads do not go on, and one of them may have held the lock.
    fn are_in_this_process(&self) -> bool {
        std::process::id() == self.process
    }
}

impl<T: Task> Parking<T> {
    /// The main loop of a thread.
    fn serve(&self) {
        let mut handover = locked(&self.handover);
        let mut waits_since = None;
        loop {
            match handover.next() {
                NextTask::End => return,
                NextTask::Wait => handover = self.look_later(&self.posted, &mut waits_since, handover),
                NextTask::Join(task) => {
                    drop(handover);
                    self.take_parts_quietly(task);
                    handover = locked(&self.handover);
                    if handover.leave() {
                        self.left.notify_one();
                    }
                    waits_since = None;
                }
            }
        }
    }

    /// In a thread that must go on living; the task is given back.
    fn take_parts_quietly(&self, task: T) {
        if let Err(payload) = catch_unwind(AssertUnwindSafe(|| task.take_parts())) {
            locked(&self.panic).get_or_insert(payload);
        }
    }

    /// Waits until all have left the task; returns the payload of a panic in one of them.
    fn take_back(&self) -> Option<Box<dyn Any + Send>> {
        let mut handover = locked(&self.handover);
        let mut waits_since = None;
        while !handover.take_back() {
            handover = self.look_later(&self.left, &mut waits_since, handover);
        }
        locked(&self.panic).take()
    }

    /// Waits a moment, or once patience has ended until the condition is told.
    fn look_later<'a>(
        &'a self,
        condition: &Condvar,
        since: &mut Option<Instant>,
        handover: MutexGuard<'a, Handover<T>>,
    ) -> MutexGuard<'a, Handover<T>> {
        if since.get_or_insert_with(Instant::now).elapsed() >= self.patience {
            return condition.wait(handover).unwrap_or_else(PoisonError::into_inner);
        }
        drop(handover);
        (0..SPINS).for_each(|_| spin_loop());
        locked(&self.handover)
    }
}

impl<T: Task> Drop for ParkedThreads<T> {
    fn drop(&mut self) {
        let threads = std::mem::take(&mut self.threads);
        if !self.are_in_this_process() {
            // There is nobody to be told or waited for.
            std::mem::forget(threads);
            return;
        }
        locked(&self.parking.handover).end();
        self.parking.posted.notify_all();
        for thread in threads {
            // It catches panics of its own.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Work = Box<dyn Fn(usize) + Send + Sync>;

    impl Task for Arc<Parts<Work>> {
        fn take_parts(&self) {
            self.take();
        }
    }

    type Threads = ParkedThreads<Arc<Parts<Work>>>;

    fn run(threads: &Threads, parts: usize, work: impl Fn(usize) + Send + Sync + 'static) {
        let work: Work = Box::new(work);
        threads.run(&Arc::new(Parts::new(work, parts)));
    }

    /// How often each part was done, the parts that `fails` says by a panic.
    fn count(threads: &Threads, parts: usize, fails: impl Fn(usize) -> bool + Send + Sync + 'static) -> Vec<usize> {
        let counts: Arc<Vec<AtomicUsize>> = Arc::new((0..parts).map(|_| AtomicUsize::new(0)).collect());
        let is_to_fail = (0..parts).any(&fails);
        let counted = counts.clone();
        let work = move |part: usize| {
            counted[part].fetch_add(1, Ordering::Relaxed);
            assert!(!fails(part), "part {part} fails");
        };
        let run = catch_unwind(AssertUnwindSafe(|| run(threads, parts, work)));
        assert_eq!(run.is_err(), is_to_fail);
        counts.iter().map(|count| count.load(Ordering::Relaxed)).collect()
    }

    #[test]
    fn parts_are_done_once_and_a_panic_comes_back() {
        for thread_count in [0, 1, 3] {
            let threads = ParkedThreads::new(thread_count);
            assert_eq!(threads.threads.len(), thread_count);
            for round in 0..if cfg!(miri) { 3 } else { 200 } {
                assert_eq!(count(&threads, round % 9, |_| false), vec![1; round % 9]);
            }
            for failing in 0..4 {
                let counts = count(&threads, 4, move |part| part == failing);
                assert!(counts.iter().all(|&count| count <= 1) && counts[failing] == 1);
            }
            // All panic, and the threads live on.
            count(&threads, 8, |_| true);
            assert_eq!(count(&threads, 8, |_| false), vec![1; 8]);
        }
    }

    /// When a call returns no thread holds its task.
    #[test]
    fn parts_of_slow_threads_are_waited_for() {
        let threads = ParkedThreads::new(2);
        let caller = std::thread::current().id();
        for _ in 0..if cfg!(miri) { 3 } else { 50 } {
            let done = Arc::new(AtomicUsize::new(0));
            let counted = done.clone();
            run(&threads, 3, move |_| {
                // The caller is slow enough that the others join, and they end after it.
                for _ in 0..if std::thread::current().id() == caller { 100 } else { 200 } {
                    std::thread::yield_now();
                }
                counted.fetch_add(1, Ordering::Relaxed);
            });
            assert_eq!((done.load(Ordering::Relaxed), Arc::strong_count(&done)), (3, 1));
        }
    }

    #[test]
    fn another_process_does_all_by_itself() {
        let mut threads = Threads::new(2);
        let (inside, process) = (std::thread::current().id(), threads.process);
        threads.process ^= 1;
        // As after a fork: the lock may be held for ever.
        let parking = threads.parking.clone();
        let held = locked(&parking.handover);
        run(&threads, 5, move |_| assert_eq!(std::thread::current().id(), inside));
        drop(held);
        threads.process = process;
    }

    #[test]
    fn two_callers_do_not_mix() {
        let threads = Arc::new(Threads::new(1));
        let inner = threads.clone();
        run(&threads, 2, move |_| assert_eq!(count(&inner, 3, |_| false), vec![1; 3]));
    }
}
