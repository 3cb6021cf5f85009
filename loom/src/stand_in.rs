//! What `std` is to the library's files: locks, conditions, atomics and threads are loom's, the rest is the standard library's.
//! What a file uses and is not here does not compile, so nothing goes unseen by loom.

pub use standard::{any, mem, panic, process};

pub mod hint {
    /// What follows it, locking, lets others go on.
    pub fn spin_loop() {}
}

pub mod sync {
    pub use loom::sync::{Arc, Mutex, MutexGuard};
    pub use standard::sync::PoisonError;

    use standard::cell::RefCell;
    use standard::sync::LockResult;

    pub mod atomic {
        pub use loom::sync::atomic::{AtomicUsize, Ordering};
    }

    type Condition = standard::sync::Arc<loom::sync::Condvar>;

    thread_local! {
        static MADE: RefCell<Vec<Condition>> = const { RefCell::new(Vec::new()) };
    }

    /// The conditions that were made since the last call.
    pub fn take_conditions() -> Vec<Condition> {
        MADE.take()
    }

    pub struct Condvar(Condition);

    #[expect(clippy::new_without_default, reason = "nobody asks for it")]
    impl Condvar {
        pub fn new() -> Condvar {
            let condition = Condition::default();
            MADE.with_borrow_mut(|all| all.push(condition.clone()));
            Condvar(condition)
        }

        #[track_caller]
        pub fn wait<'a, T>(&self, guard: MutexGuard<'a, T>) -> LockResult<MutexGuard<'a, T>> {
            self.0.wait(guard)
        }

        pub fn notify_one(&self) {
            self.0.notify_one();
        }

        pub fn notify_all(&self) {
            self.0.notify_all();
        }
    }
}

pub mod thread {
    pub use loom::thread::{Builder, JoinHandle};

    use standard::cell::Cell;
    use standard::io::Result;
    use standard::num::NonZero;

    thread_local! {
        /// How many processors the machine has: with more than threads who waits looks again before it sleeps.
        pub static PROCESSORS: Cell<NonZero<usize>> = const { Cell::new(NonZero::<usize>::MIN) };
    }

    pub fn available_parallelism() -> Result<NonZero<usize>> {
        Ok(PROCESSORS.get())
    }
}

pub mod time {
    pub use standard::time::Duration;

    use standard::cell::Cell;

    /// Loom has no time, and runs must repeat: at the first look none has gone by, at the next all patience has ended.
    pub struct Instant {
        was_asked: Cell<bool>,
    }

    impl Instant {
        pub fn now() -> Instant {
            Instant { was_asked: Cell::new(false) }
        }

        pub fn elapsed(&self) -> Duration {
            if self.was_asked.replace(true) { Duration::MAX } else { Duration::ZERO }
        }
    }
}
