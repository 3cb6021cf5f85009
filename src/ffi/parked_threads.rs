//! Threads of a scene's own, which wait between calls. They stand here because they are lent what lives shorter than they do:
//! that no type can say.
//!
//! | what happens | what becomes of it |
//! |---|---|
//! | a thread cannot be started | the others, at least the caller's, do its part |
//! | a part panics in a thread | the thread lives on; the call panics in the caller's when all have stopped |
//! | the scene ends, or gets other workers | the threads are told so and waited for |
//! | the process forks | the child has none of them: there the caller's thread does all parts, and none is waited for |
//! | the process exits | nobody waits for them; between calls they touch their own lock at most |

use std::any::Any;
use std::hint::spin_loop;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use crate::base::locks::locked;
use crate::scene::Workers;

/// No more threads are started, whatever count is asked for: more only wait for each other.
pub(super) const MOST_THREADS: usize = 256;

impl Workers {
    /// Threads of the standard library, started now, which wait between calls and end with the last owner of this; the caller's
    /// is one of the `count`, and more than 256 are taken as 256.
    pub fn threads(count: usize) -> Workers {
        let count = count.min(MOST_THREADS);
        let threads = ParkedThreads::new(count.saturating_sub(1));
        Workers::new(count, move |parts, work| threads.run(parts, work))
    }
}

/// A task: its parts are taken one after the other by whoever is free.
struct Task<'a> {
    work: &'a (dyn Fn(usize) + Sync),
    parts: usize,
    /// The next that nobody has taken.
    next: AtomicUsize,
    /// What the first panic in a thread carried.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

impl Task<'_> {
    fn take_parts(&self) {
        loop {
            let part = self.next.fetch_add(1, Ordering::Relaxed);
            if part >= self.parts {
                break;
            }
            (self.work)(part);
        }
    }

    /// The same in a thread that must go on living.
    fn take_parts_quietly(&self) {
        if let Err(payload) = catch_unwind(AssertUnwindSafe(|| self.take_parts())) {
            locked(&self.panic).get_or_insert(payload);
        }
    }
}

/// A task on loan, of any lifetime: [`ParkedThreads::run`] does not return before it is given back.
#[derive(Clone, Copy)]
struct Loan(*const Task<'static>);

// SAFETY: a task is shared between threads: its members are `Sync`, and what its panic carries can be sent.
unsafe impl Send for Loan {}

/// Who works on what. Threads change it one at a time, each step as a whole.
///
/// ```text
/// caller: offer ─► takes parts ─► withdraw ─► waits until is_done          (at the end of all: end)
/// thread: next = Join ─► takes parts ─► leave ─► next …       next = Wait ─► waits until posted ─► next …
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Handover<T> {
    /// What may be joined.
    task: Option<T>,
    /// Threads that have joined and not left.
    active: usize,
    ended: bool,
}

/// What a thread is to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Next<T> {
    Wait,
    Join(T),
    End,
}

impl<T: Copy> Handover<T> {
    const IDLE: Handover<T> = Handover { task: None, active: 0, ended: false };

    /// The caller lets threads join; false if there is a task already. All that wait are to be told.
    fn offer(&mut self, task: T) -> bool {
        let is_free = self.task.is_none() && self.active == 0;
        if is_free {
            self.task = Some(task);
        }
        is_free
    }

    /// What a thread is to do that does nothing.
    fn next(&mut self) -> Next<T> {
        match self.task {
            _ if self.ended => Next::End,
            Some(task) => {
                self.active += 1;
                Next::Join(task)
            }
            None => Next::Wait,
        }
    }

    /// A thread has found no more parts: nobody else need join. True if the caller is to be told that it was the last.
    fn leave(&mut self) -> bool {
        self.task = None;
        self.active -= 1;
        self.active == 0
    }

    /// The caller has found no more parts.
    fn withdraw(&mut self) {
        self.task = None;
    }

    /// Whether the task is given back.
    fn is_done(&self) -> bool {
        self.active == 0
    }

    /// There will be no more tasks. All that wait are to be told.
    fn end(&mut self) {
        self.ended = true;
    }
}

/// What the threads and the caller share.
struct Shared {
    handover: Mutex<Handover<Loan>>,
    /// How long somebody looks again and again before he sleeps.
    patience: Duration,
    /// There is a task, or the end.
    posted: Condvar,
    /// The last thread has left.
    left: Condvar,
}

/// Threads that wait for tasks.
struct ParkedThreads {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
    /// The process that has them.
    process: u32,
}

impl Shared {
    fn serve(&self) {
        let mut handover = locked(&self.handover);
        let mut waits_since = None;
        loop {
            match handover.next() {
                Next::End => return,
                Next::Wait => handover = self.look_later(&self.posted, &mut waits_since, handover),
                Next::Join(Loan(task)) => {
                    drop(handover);
                    // SAFETY: the task lives until all that have joined have left: see `ParkedThreads::run`.
                    unsafe { &*task }.take_parts_quietly();
                    handover = locked(&self.handover);
                    if handover.leave() {
                        self.left.notify_one();
                    }
                    waits_since = None;
                }
            }
        }
    }

    /// Waits a moment, or once patience has ended until the condition is told.
    fn look_later<'a>(
        &'a self,
        condition: &Condvar,
        since: &mut Option<Instant>,
        handover: MutexGuard<'a, Handover<Loan>>,
    ) -> MutexGuard<'a, Handover<Loan>> {
        if since.get_or_insert_with(Instant::now).elapsed() >= self.patience {
            return condition.wait(handover).unwrap_or_else(PoisonError::into_inner);
        }
        drop(handover);
        (0..SPINS).for_each(|_| spin_loop());
        locked(&self.handover)
    }
}

/// One call makes several tasks one after the other. Who waits for the next, or for the last part of one, looks for it so long
/// before it sleeps: to be woken takes about as long.
const PATIENCE: Duration = Duration::from_micros(50);

/// So many turns of a loop between two looks, about a microsecond.
const SPINS: usize = 32;

impl ParkedThreads {
    /// Up to `count` threads; those that cannot be started are done without.
    fn new(count: usize) -> ParkedThreads {
        // Where threads share processors, who looks keeps others from working.
        let has_room = std::thread::available_parallelism().is_ok_and(|processors| count < processors.get());
        let patience = if has_room { PATIENCE } else { Duration::ZERO };
        let (handover, posted, left) = (Mutex::new(Handover::IDLE), Condvar::new(), Condvar::new());
        let shared = Arc::new(Shared { handover, patience, posted, left });
        let start = |_| {
            let shared = shared.clone();
            Builder::new().name("swiftprox".into()).spawn(move || shared.serve()).ok()
        };
        let threads = (0..count).map_while(start).collect();
        ParkedThreads { shared, threads, process: std::process::id() }
    }

    /// In the process that forked the threads do not go on, and one of them may have held the lock.
    fn are_in_this_process(&self) -> bool {
        std::process::id() == self.process
    }

    /// Calls `work` once for each number below `parts`, in this thread and the others, and returns when all calls have returned. A
    /// panic in any of them goes on in this one.
    fn run(&self, parts: usize, work: &(dyn Fn(usize) + Sync)) {
        let task = Task { work, parts, next: AtomicUsize::new(0), panic: Mutex::new(None) };
        if self.threads.is_empty() || !self.are_in_this_process() {
            return task.take_parts();
        }
        let loan = Loan((&raw const task).cast());
        if !locked(&self.shared.handover).offer(loan) {
            return task.take_parts();
        }
        self.shared.posted.notify_all();
        // By a panic, too: the task must not go before all have left it.
        let lent = Lent(&self.shared);
        task.take_parts();
        drop(lent);
        if let Some(payload) = locked(&task.panic).take() {
            resume_unwind(payload);
        }
    }
}

/// A task that threads may have joined. Dropped, it waits until all have left.
struct Lent<'a>(&'a Shared);

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        let mut handover = locked(&self.0.handover);
        handover.withdraw();
        let mut waits_since = None;
        while !handover.is_done() {
            handover = self.0.look_later(&self.0.left, &mut waits_since, handover);
        }
    }
}

impl Drop for ParkedThreads {
    fn drop(&mut self) {
        let threads = std::mem::take(&mut self.threads);
        if !self.are_in_this_process() {
            // There is nobody to be told or waited for.
            std::mem::forget(threads);
            return;
        }
        locked(&self.shared.handover).end();
        self.shared.posted.notify_all();
        for thread in threads {
            // It catches panics of its own.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    // --- A model: every interleaving of the caller and the threads over the hand-over itself -------------------------------------

    /// Where a thread of the model is.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    enum At {
        /// About to look what is next, told or woken by chance.
        Looking,
        /// Waits until it is told.
        Waiting,
        /// Has joined this task, and is about to take a part of it.
        Taking(usize),
        /// Does a part of it.
        Working(usize, usize),
        /// About to leave.
        Leaving,
        Gone,
    }

    /// Where the caller is.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    enum Caller {
        Offering(usize),
        Telling(usize),
        Taking(usize),
        Working(usize, usize),
        Withdrawing(usize),
        /// About to look whether all have left.
        Checking(usize),
        /// Waits until it is told so.
        Waiting(usize),
        Ending,
        TellingEnd,
        Joining,
        Finished,
    }

    const TASKS: usize = 2;
    const PARTS: usize = 2;

    #[derive(Debug, Clone, PartialEq, Eq, Hash)]
    struct World<const THREADS: usize> {
        handover: Handover<usize>,
        caller: Caller,
        threads: [At; THREADS],
        /// Of each task the next part, how often each was done, and whether the task still lives.
        next: [usize; TASKS],
        done: [[u8; PARTS]; TASKS],
        lives: [bool; TASKS],
    }

    impl<const THREADS: usize> World<THREADS> {
        fn tell_all(&mut self) {
            for thread in &mut self.threads {
                if *thread == At::Waiting {
                    *thread = At::Looking;
                }
            }
        }

        /// Takes a part of a task that must still live.
        fn take(&mut self, task: usize) -> Option<usize> {
            assert!(self.lives[task], "a task is used after it is given back: {self:?}");
            self.next[task] += 1;
            Some(self.next[task] - 1).filter(|&part| part < PARTS)
        }

        /// The world after the caller's next step, if it can make one.
        fn after_caller(&self) -> Option<Self> {
            let mut world = self.clone();
            world.caller = match self.caller {
                Caller::Offering(task) => {
                    world.lives[task] = true;
                    assert!(world.handover.offer(task), "the last task was given back: {self:?}");
                    Caller::Telling(task)
                }
                Caller::Telling(task) => {
                    world.tell_all();
                    Caller::Taking(task)
                }
                Caller::Taking(task) => match world.take(task) {
                    Some(part) => Caller::Working(task, part),
                    None => Caller::Withdrawing(task),
                },
                Caller::Working(task, part) => {
                    world.done[task][part] += 1;
                    Caller::Taking(task)
                }
                Caller::Withdrawing(task) => {
                    world.handover.withdraw();
                    // Under the same lock it looks whether it is done.
                    world.check(task)
                }
                Caller::Checking(task) => world.check(task),
                Caller::Ending => {
                    world.handover.end();
                    Caller::TellingEnd
                }
                Caller::TellingEnd => {
                    world.tell_all();
                    Caller::Joining
                }
                Caller::Joining if self.threads == [At::Gone; THREADS] => Caller::Finished,
                Caller::Waiting(_) | Caller::Joining | Caller::Finished => return None,
            };
            Some(world)
        }

        fn check(&mut self, task: usize) -> Caller {
            if !self.handover.is_done() {
                return Caller::Waiting(task);
            }
            assert_eq!(self.done[task], [1; PARTS], "a part is left: {self:?}");
            self.lives[task] = false;
            if task + 1 < TASKS { Caller::Offering(task + 1) } else { Caller::Ending }
        }

        /// The same of a thread.
        fn after_thread(&self, k: usize) -> Option<Self> {
            let mut world = self.clone();
            world.threads[k] = match self.threads[k] {
                At::Looking => match world.handover.next() {
                    Next::Wait => At::Waiting,
                    Next::Join(task) => At::Taking(task),
                    Next::End => At::Gone,
                },
                At::Taking(task) => match world.take(task) {
                    Some(part) => At::Working(task, part),
                    None => At::Leaving,
                },
                At::Working(task, part) => {
                    assert!(world.lives[task]);
                    world.done[task][part] += 1;
                    At::Taking(task)
                }
                At::Leaving => {
                    if world.handover.leave()
                        && let Caller::Waiting(task) = world.caller
                    {
                        world.caller = Caller::Checking(task);
                    }
                    At::Looking
                }
                At::Waiting | At::Gone => return None,
            };
            Some(world)
        }

        /// All worlds that one step leads to; with `chance` a thread or the caller may also wake without being told.
        fn steps(&self, chance: bool) -> Vec<Self> {
            let mut steps: Vec<Self> = (0..THREADS).filter_map(|k| self.after_thread(k)).collect();
            steps.extend(self.after_caller());
            assert!(!steps.is_empty() || self.caller == Caller::Finished, "nobody can go on: {self:?}");
            if chance {
                for k in (0..THREADS).filter(|&k| self.threads[k] == At::Waiting) {
                    let mut world = self.clone();
                    world.threads[k] = At::Looking;
                    steps.push(world);
                }
                if let Caller::Waiting(task) = self.caller {
                    steps.push(World { caller: Caller::Checking(task), ..self.clone() });
                }
            }
            steps
        }
    }

    /// Every world that can be reached: in each somebody can go on or all is finished, tasks are used only while they live, and
    /// each part is done once. Without wakes by chance a lost notice would leave a world in which nobody can go on.
    fn explore<const THREADS: usize>(chance: bool) -> usize {
        let first = World {
            handover: Handover::IDLE,
            caller: Caller::Offering(0),
            threads: [At::Looking; THREADS],
            next: [0; TASKS],
            done: [[0; PARTS]; TASKS],
            lives: [false; TASKS],
        };
        let (mut seen, mut open, mut ends) = (HashSet::from([first.clone()]), vec![first], 0);
        while let Some(world) = open.pop() {
            ends += usize::from(world.caller == Caller::Finished);
            for next in world.steps(chance) {
                if seen.insert(next.clone()) {
                    open.push(next);
                }
            }
        }
        assert!(ends > 0);
        seen.len()
    }

    #[test]
    #[cfg_attr(miri, ignore = "long")]
    fn every_interleaving_ends_with_each_part_done_once() {
        for chance in [false, true] {
            let sizes = [explore::<1>(chance), explore::<2>(chance), explore::<3>(chance)];
            assert!(sizes[0] > 50 && sizes[1] > 10 * sizes[0] / 2 && sizes[2] > 3 * sizes[1], "{sizes:?}");
        }
    }

    // --- The threads themselves --------------------------------------------------------------------------------------------------

    /// How often each part was done, the parts that `fails` says by a panic.
    fn count(threads: &ParkedThreads, parts: usize, fails: impl Fn(usize) -> bool + Sync) -> Vec<usize> {
        let counts: Vec<AtomicUsize> = (0..parts).map(|_| AtomicUsize::new(0)).collect();
        let work = |part: usize| {
            counts[part].fetch_add(1, Ordering::Relaxed);
            assert!(!fails(part), "part {part} fails");
        };
        let run = catch_unwind(AssertUnwindSafe(|| threads.run(parts, &work)));
        assert_eq!(run.is_err(), (0..parts).any(&fails));
        counts.into_iter().map(AtomicUsize::into_inner).collect()
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
                let counts = count(&threads, 4, |part| part == failing);
                assert!(counts.iter().all(|&count| count <= 1) && counts[failing] == 1);
            }
            // All panic, and the threads live on.
            count(&threads, 8, |_| true);
            assert_eq!(count(&threads, 8, |_| false), vec![1; 8]);
        }
    }

    #[test]
    fn parts_of_slow_threads_are_waited_for() {
        let threads = ParkedThreads::new(2);
        let caller = std::thread::current().id();
        for _ in 0..if cfg!(miri) { 3 } else { 50 } {
            let done = AtomicUsize::new(0);
            threads.run(3, &|_| {
                // The caller is slow enough that the others join, and they end after it.
                for _ in 0..if std::thread::current().id() == caller { 100 } else { 200 } {
                    std::thread::yield_now();
                }
                done.fetch_add(1, Ordering::Relaxed);
            });
            assert_eq!(done.into_inner(), 3);
        }
    }

    #[test]
    fn another_process_does_all_by_itself() {
        let mut threads = ParkedThreads::new(2);
        let (inside, process) = (std::thread::current().id(), threads.process);
        threads.process ^= 1;
        // As after a fork: the lock may be held for ever.
        let shared = threads.shared.clone();
        let held = locked(&shared.handover);
        threads.run(5, &|_| assert_eq!(std::thread::current().id(), inside));
        drop(held);
        threads.process = process;
    }

    #[test]
    fn two_callers_do_not_mix() {
        let threads = ParkedThreads::new(1);
        let outer = |_: usize| assert_eq!(count(&threads, 3, |_| false), vec![1; 3]);
        threads.run(2, &outer);
    }
}
