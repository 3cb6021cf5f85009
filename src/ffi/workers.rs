//! A program's own threads that work for a scene.

use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};

use super::log::must_return;
use crate::base::workers::Workers;

/// Runs the items of a task from `first` up to, but not including, `end`; `context` is the one passed with the task. Any threads
/// may call it, several at once, each item once.
pub type TaskCallback = unsafe extern "C" fn(first: u32, end: u32, context: *mut c_void);

/// Must call `task` once for each item below `item_count`, in any ranges, from any threads, with `context`. `user` is the pointer
/// given with the callback. Returns the task for swiftprox_finish_task_callback, or null if all is done already. It must return; a
/// C++ exception that leaves it ends the program.
pub type EnqueueTaskCallback = Option<
    unsafe extern "C-unwind" fn(
        task: TaskCallback,
        item_count: u32,
        context: *mut c_void,
        user: *mut c_void,
    ) -> *mut c_void,
>;
type EnqueueTask = unsafe extern "C-unwind" fn(
    task: TaskCallback,
    item_count: u32,
    context: *mut c_void,
    user: *mut c_void,
) -> *mut c_void;

/// Must return when the task from swiftprox_enqueue_task_callback is done. It must return; a C++ exception that leaves it ends the
/// program.
pub type FinishTaskCallback = Option<unsafe extern "C-unwind" fn(task: *mut c_void, user: *mut c_void)>;
type FinishTask = unsafe extern "C-unwind" fn(task: *mut c_void, user: *mut c_void);

/// The callbacks' companions from call to call.
struct UserWorkers(*mut c_void);

// SAFETY: the pointer is only ever handed back to the callbacks, in the thread that calls.
unsafe impl Send for UserWorkers {}
// SAFETY: as above.
unsafe impl Sync for UserWorkers {}

/// A task's work. It lives until the task is finished.
struct Context<'a> {
    work: &'a (dyn Fn(usize) + Sync),
    /// A panic has left an item.
    failed: AtomicBool,
}

/// # Safety
/// `context` is a [`Context`] whose task is not finished.
unsafe extern "C" fn run_task(first: u32, end: u32, context: *mut c_void) {
    // SAFETY: by the caller.
    let context = unsafe { &*context.cast::<Context>() };
    // Nothing unwinds into the program's threads; what an item left behind nobody looks at after a failure.
    let items = AssertUnwindSafe(|| (first..end).for_each(|item| (context.work)(item as usize)));
    if catch_unwind(items).is_err() {
        context.failed.store(true, Ordering::Relaxed);
    }
}

/// Workers that are a program's own threads.
pub(super) fn workers(count: usize, enqueue: EnqueueTask, finish: FinishTask, user: *mut c_void) -> Workers {
    let user = UserWorkers(user);
    Workers::new(count, move |parts, work| {
        let UserWorkers(user) = &user;
        let context = Context { work, failed: AtomicBool::new(false) };
        let pointer = (&raw const context).cast_mut().cast::<c_void>();
        // SAFETY: the callbacks take such a task, its context, which outlives both calls, and their own pointer.
        let task = must_return(|| unsafe { enqueue(run_task, parts as u32, pointer, *user) });
        if !task.is_null() {
            // SAFETY: as above; it gets what it returned.
            must_return(|| unsafe { finish(task, *user) });
        }
        assert!(!context.failed.load(Ordering::Relaxed), "a task of a scene met a bug");
    })
}
