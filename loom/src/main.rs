//! The library's threads that wait between calls, its very files over loom's locks and atomics: loom runs a model in every order of
//! the steps of its threads that makes a difference, and watches that nothing is read but after it was written.
//!
//! Each run must end: no notice is lost, and nobody waits for another in a ring. Each part is done once, and the caller sees what
//! it wrote. When a call returns nobody has its task, or uses what was lent with it. A panic comes back to the caller whose part
//! it is, and the threads live on.
//!
//! Nothing is left out with one thread and one caller, who is told whenever he is to wake. Of the other models those runs are left
//! out that interrupt threads more often than stated: `src/base/workers/handover.rs` has a coarser model that tries all of them.
//! Not modelled: a fork, a thread that cannot be started, lengths of time.
//!
//! What is printed before the failure is the model. `LOOM_LOCATION=1 make loom` says where its threads stood.

// To the files below this crate is the standard library.
extern crate self as std;
extern crate std as standard;

mod stand_in;

pub use stand_in::{any, hint, mem, panic, process, sync, thread, time};

#[path = "../../src/base"]
mod base {
    #[expect(dead_code, reason = "not all of it is used here")]
    pub mod locks;
    pub mod workers {
        mod handover;
        #[expect(dead_code, reason = "not all of it is used here")]
        pub mod parked;
    }
}

use standard::num::NonZero;
use standard::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use standard::sync::Arc;
use standard::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use base::workers::parked::{ParkedThreads, Parts, Task};
use loom::cell::UnsafeCell;

/// What is accessed without a lock: loom fails where an access does not happen after a change, or a change after an access.
struct Plain(UnsafeCell<()>);

// SAFETY: there is nothing in it; loom watches the accesses.
unsafe impl Sync for Plain {}

impl Plain {
    fn new() -> Plain {
        Plain(UnsafeCell::new(()))
    }

    fn change(&self) {
        self.0.with_mut(|_| ());
    }
}

/// What a caller lends for the time of a call.
struct Lent {
    parts: Parts<Box<dyn Fn(usize) + Send + Sync>>,
    /// In use while somebody takes parts.
    lives: Plain,
}

/// How many have it is not loom's to see: it would order what they do.
#[derive(Clone)]
struct Loan(Arc<Lent>);

// SAFETY: as in the library, the members are to be used by several threads.
unsafe impl Send for Loan {}

impl Task for Loan {
    fn take_parts(&self) {
        self.0.lives.0.with(|_| self.0.parts.take());
    }
}

/// What one call has done.
#[derive(Clone, Copy, Debug)]
enum Call {
    /// So many parts.
    Parts(usize),
    /// Two parts, each of which panics or does not.
    Fails([bool; 2]),
    /// So many parts, each of which ends when all have begun: each needs a thread of its own.
    Meets(usize),
}

impl Call {
    fn run(self, threads: &ParkedThreads<Loan>) {
        let (count, fails, meet) = match self {
            Call::Parts(count) => (count, [false; 2], None),
            Call::Fails(fails) => (2, fails, None),
            Call::Meets(count) => (count, [false; 2], Some((loom::sync::Mutex::new(0), loom::sync::Condvar::new()))),
        };
        // Written without a lock by whoever does the part, then read by the caller.
        let done: Arc<Vec<_>> = Arc::new((0..count).map(|_| (Plain::new(), AtomicUsize::new(0))).collect());
        let noted = done.clone();
        let work = move |part: usize| {
            let (plain, times) = &noted[part];
            plain.change();
            times.fetch_add(1, Relaxed);
            if let Some((begun, all_begun)) = &meet {
                let mut begun = begun.lock().unwrap();
                *begun += 1;
                all_begun.notify_all();
                while *begun < count {
                    begun = all_begun.wait(begun).unwrap();
                }
            } else if fails[part] {
                // Without the hook, to which all others are failures.
                resume_unwind(Box::new(part));
            }
        };
        let loan = Loan(Arc::new(Lent { parts: Parts::new(Box::new(work), count), lives: Plain::new() }));
        let result = catch_unwind(AssertUnwindSafe(|| threads.run(&loan)));
        loan.0.lives.change();
        let times = done.iter().map(|(plain, times)| plain.0.with(|_| times.load(Relaxed))).collect::<Vec<_>>();
        match result {
            Ok(()) => assert!(times.iter().all(|times| *times == 1) && fails == [false; 2], "{self:?}: {times:?}"),
            // Who panics takes no more parts; if all do, some are left.
            Err(payload) => {
                let part = *payload.downcast::<usize>().expect("a panic of `fails`");
                let is_his = fails[part] && times[part] == 1;
                assert!(is_his && times.iter().all(|times| *times <= 1), "{self:?}: {times:?}");
            }
        }
        assert_eq!(Arc::strong_count(&loan.0), 1, "the task is with somebody yet");
    }
}

#[derive(Clone, Copy, Debug)]
struct Model {
    threads: usize,
    /// The calls of each caller, one after the other; the callers all at once.
    callers: &'static [&'static [Call]],
    /// Who waits looks once more before it sleeps.
    patient: bool,
    /// At any time of each run all conditions wake one that waits for them, if any does, although nobody tells it: those of the
    /// system may do so, loom's do not.
    chance: bool,
    /// How often a thread may be interrupted that could go on; `None`: ever so often.
    interruptions: Option<usize>,
}

impl Model {
    const PLAIN: Model = Model { threads: 1, callers: &[], patient: false, chance: false, interruptions: None };

    fn run(self) {
        thread::PROCESSORS.set(if self.patient { NonZero::<usize>::MAX } else { NonZero::<usize>::MIN });
        let threads = Arc::new(ParkedThreads::new(self.threads));
        let conditions = sync::take_conditions();
        if self.chance {
            loom::thread::spawn(move || conditions.iter().for_each(|condition| condition.notify_one()));
        }
        let [first, others @ ..] = self.callers else { return };
        let call_all =
            |calls: &'static [Call], threads: Arc<_>| move || calls.iter().for_each(|call| call.run(&threads));
        let others: Vec<_> = others.iter().map(|calls| loom::thread::spawn(call_all(calls, threads.clone()))).collect();
        call_all(first, threads.clone())();
        others.into_iter().for_each(|caller| caller.join().unwrap());
        // It is the last owner, and waits for the threads.
        drop(threads);
    }

    /// How many runs there were.
    fn check(self) -> usize {
        let mut builder = loom::model::Builder::new();
        builder.preemption_bound = self.interruptions;
        let runs: Arc<AtomicUsize> = Arc::default();
        let counted = runs.clone();
        builder.check(move || {
            counted.fetch_add(1, Relaxed);
            self.run();
        });
        runs.load(Relaxed)
    }
}

fn main() {
    use Call::{Fails, Meets, Parts};
    let models = [
        Model { callers: &[&[]], ..Model::PLAIN },
        Model { callers: &[&[Parts(2), Parts(1)]], ..Model::PLAIN },
        Model { callers: &[&[Parts(2)]], patient: true, ..Model::PLAIN },
        Model { callers: &[&[Meets(2)]], ..Model::PLAIN },
        Model { callers: &[&[Fails([true, false]), Parts(1)]], ..Model::PLAIN },
        Model { callers: &[&[Fails([false, true]), Parts(1)]], ..Model::PLAIN },
        Model { callers: &[&[Fails([true, true]), Parts(1)]], ..Model::PLAIN },
        Model { callers: &[&[Parts(1)]], chance: true, interruptions: Some(3), ..Model::PLAIN },
        Model { callers: &[&[Parts(1)], &[Parts(1)]], interruptions: Some(3), ..Model::PLAIN },
        Model { callers: &[&[Fails([true, true])], &[Parts(1)]], interruptions: Some(3), ..Model::PLAIN },
        Model { threads: 2, callers: &[&[]], ..Model::PLAIN },
        Model { threads: 2, callers: &[&[Parts(2), Parts(2)]], interruptions: Some(3), ..Model::PLAIN },
        Model { threads: 2, callers: &[&[Parts(2)]], patient: true, interruptions: Some(3), ..Model::PLAIN },
        Model { threads: 2, callers: &[&[Parts(2)]], chance: true, interruptions: Some(2), ..Model::PLAIN },
        Model { threads: 2, callers: &[&[Meets(3)]], interruptions: Some(2), ..Model::PLAIN },
        Model { threads: 2, callers: &[&[Fails([true, true]), Parts(2)]], interruptions: Some(3), ..Model::PLAIN },
        Model { threads: 2, callers: &[&[Parts(2)], &[Parts(2)]], interruptions: Some(2), ..Model::PLAIN },
    ];
    // At once, before the library catches it, or what is torn down fails as well.
    panic::set_hook(Box::new(|failure| {
        eprintln!("{failure}");
        process::exit(1);
    }));
    let start = standard::time::Instant::now();
    for model in models {
        println!("{model:?}");
        println!("    {} runs; {:.1} s so far", model.check(), start.elapsed().as_secs_f64());
    }
}
