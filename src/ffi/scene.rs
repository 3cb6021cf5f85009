//! Scenes: made, ended, and told which pairs to test.

use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::sync::atomic::{AtomicU32, Ordering};

use super::failure::{Checked, Failure, StatusCode};
use super::guard::{caught, guard, keep_panics_quiet};
use super::log::log;
use super::pointers::{Handle, handle, output};
use super::structs::{Versioned, read_struct};
use super::workers::{EnqueueTaskCallback, FinishTaskCallback, workers};
use crate::base::mark::Mark;
use crate::base::workers::parked::MOST_THREADS;
use crate::scene::object::ObjectId;
use crate::scene::{Scene, Workers};
use crate::shape::Shape;

/// Objects, their poses, and the pairs that queries test. Create one with swiftprox_scene_create.
#[derive(Debug)]
pub struct SceneHandle {
    /// How many calls read the scene, and [`CHANGING`] while one changes it. Every call enters here before it makes a reference to
    /// what follows.
    users: AtomicU32,
    mark: Mark,
    content: UnsafeCell<SceneContent>,
}

#[derive(Debug)]
struct SceneContent {
    scene: Scene,
    /// A change was begun and not ended: a panic left it, and what it left behind is unknown.
    poisoned: bool,
    /// The log knows that the recording has ended early.
    told_of_recording: bool,
}

impl Handle for SceneHandle {
    const NOUN: &str = "scene";
    fn mark(&self) -> &Mark {
        &self.mark
    }
}

/// One call changes the scene, or ends it.
const CHANGING: u32 = 1 << 31;

// SAFETY: whoever uses `content` has entered by `users`: alone to change it, with other readers to read it. A scene may be sent to
// and shared between threads, as is checked below.
unsafe impl Sync for SceneHandle {}

/// A call that changes a scene, until it is dropped, by a panic, too.
struct Changing<'a>(&'a SceneHandle);

impl Changing<'_> {
    /// Enters a scene that no other call uses.
    fn enter(handle: &SceneHandle) -> Checked<Changing<'_>> {
        match handle.users.compare_exchange(0, CHANGING, Ordering::Acquire, Ordering::Relaxed) {
            Ok(_) => Ok(Changing(handle)),
            Err(_) => Err(busy()),
        }
    }

    fn content(&mut self) -> &mut SceneContent {
        // SAFETY: `users` keeps all others out while this lives, and it is borrowed exclusively.
        unsafe { &mut *self.0.content.get() }
    }
}

impl Drop for Changing<'_> {
    fn drop(&mut self) {
        // Readers that are being refused may be counted, too.
        self.0.users.fetch_sub(CHANGING, Ordering::Release);
    }
}

/// A call that reads a scene, until it is dropped.
struct Reading<'a>(&'a SceneHandle);

impl Reading<'_> {
    /// Enters a scene that no call changes.
    fn enter(handle: &SceneHandle) -> Checked<Reading<'_>> {
        let before = handle.users.fetch_add(1, Ordering::Acquire);
        let reading = Reading(handle);
        if before >= CHANGING { Err(busy()) } else { Ok(reading) }
    }

    fn content(&self) -> &SceneContent {
        // SAFETY: `users` keeps out those that change the scene while this lives.
        unsafe { &*self.0.content.get() }
    }
}

impl Drop for Reading<'_> {
    fn drop(&mut self) {
        self.0.users.fetch_sub(1, Ordering::Release);
    }
}

// The header's rule for threads needs this of both handles.
const _: () = {
    const fn is_shared_between_threads<T: Send + Sync>() {}
    is_shared_between_threads::<SceneContent>();
    is_shared_between_threads::<Shape>();
};

/// How a scene is made. Initialise with SWIFTPROX_SCENE_OPTIONS_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneOptions {
    /// Set by SWIFTPROX_SCENE_OPTIONS_DEFAULT.
    pub struct_size: usize,
    /// Number of threads for a query, or for poses that are set together, including the caller's. It changes no bit of any
    /// answer. Some work uses the caller's thread only: queries that stop early, queries without a max_distance over many objects,
    /// and few pairs or objects. Numbers above 256 mean 256. Default: 0, which means 1.
    pub worker_count: u32,
    /// Starts work on the program's own threads. Default: null, and finish_task too: the scene then has threads of its own,
    /// which wait between calls. swiftprox_scene_create starts them, and does without threads that cannot start.
    /// swiftprox_scene_destroy ends them and waits. After fork() the child has none; its calls use the caller's thread. exit()
    /// does not wait for them. Destroy all scenes before the library is unloaded.
    pub enqueue_task: EnqueueTaskCallback,
    /// Waits for the work that enqueue_task started. Default: null.
    pub finish_task: FinishTaskCallback,
    /// Passed to both callbacks. Default: null.
    pub task_user: *mut c_void,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CSceneOptions {
    const NAME: &'static str = "swiftprox_scene_options";
}

impl CSceneOptions {
    /// The defaults, as in the header.
    pub const DEFAULT: CSceneOptions = CSceneOptions {
        struct_size: size_of::<CSceneOptions>(),
        worker_count: 0,
        enqueue_task: None,
        finish_task: None,
        task_user: std::ptr::null_mut(),
    };
}

// --- Scenes --------------------------------------------------------------------------------------------------------------

/// Creates an empty scene. The caller owns it and frees it with swiftprox_scene_destroy. Null `options` mean the defaults. On
/// failure `*scene` is null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: only one of enqueue_task and finish_task is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_create(
    options: *const CSceneOptions,
    scene: *mut *mut SceneHandle,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(scene, "scene", std::ptr::null_mut())?;
        keep_panics_quiet();
        let options = read_struct(options, CSceneOptions::DEFAULT)?;
        scene.write(new_scene(&options)?);
        Ok(())
    })
}

/// Destroys a scene, even a poisoned one. It releases its shares of shapes; its ids and results become invalid. Null is ignored.
///
/// SWIFTPROX_ERROR_BUSY: another call uses the scene, which stays alive. After all other errors the scene is gone.
/// SWIFTPROX_ERROR_BUG: some memory may be lost. SWIFTPROX_ERROR_FILE, SWIFTPROX_ERROR_MEMORY: the end of its recording is missing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_destroy(scene: *mut SceneHandle) -> StatusCode {
    guard(|| {
        if !scene.is_null() {
            // Nobody enters any more.
            // SAFETY: a live scene by the header's pointer rules.
            std::mem::forget(Changing::enter(unsafe { handle(scene, "scene") }?)?);
            // SAFETY: a live scene by the header's pointer rules; every one comes from Box::into_raw.
            let handle = unsafe { Box::from_raw(scene) };
            let SceneContent { mut scene, poisoned, .. } = handle.content.into_inner();
            // A bug was told when it was met: what there is of a recording ends here.
            return if poisoned { Ok(()) } else { Ok(scene.end_recording()?) };
        }
        Ok(())
    })
}

/// Sets for how many pairs of pieces a scene keeps caches. Queries without a max_distance test all pairs. Up to `limit` pairs, each
/// keeps its last answer, in about 150 bytes if there is memory. The next answer is then several times faster. Beyond `limit` only
/// near pairs keep theirs, as with 0. Results and their order stay the same. Default: 1048576 pairs, about 150 MB, from 1448 single
/// pieces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_kept_pair_limit(scene: *mut SceneHandle, limit: u64) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            scene.set_kept_pair_limit(limit);
            Ok(())
        })
    }
}

/// Frees memory that a scene keeps for later: the last query's results, which become invalid, and memory of removed pairs. Caches
/// of other pairs stay. The next query allocates what it needs.
///
/// SWIFTPROX_ERROR_MEMORY: no memory for a smaller list of pairs; nothing has changed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_shrink(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.shrink()?)) }
}

// --- Activation ----------------------------------------------------------------------------------------------------------

/// Sets whether queries test pairs of objects: `active` is not 0, or 0. Two ids select their pair, in either order, with all its
/// pairs of pieces. One null id selects all present pairs of the other object; two null ids select all present pairs. Pairs of
/// objects added later are active. Two fixed objects are never tested.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: both ids are equal.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_pair_active(
    scene: *mut SceneHandle,
    id1: *const ObjectId,
    id2: *const ObjectId,
    active: i32,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            let active = active != 0;
            match (id1.as_ref(), id2.as_ref()) {
                (Some(&id1), Some(&id2)) => scene.set_pair_active(id1, id2, active)?,
                (Some(&id), None) | (None, Some(&id)) => scene.set_object_active(id, active)?,
                (None, None) => scene.set_all_active(active),
            }
            Ok(())
        })
    }
}

/// Sets `*active` to 1 if the pair of two objects is active, else to 0. The order of the ids does not matter. On failure it is 0.
///
/// Same errors as swiftprox_scene_set_pair_active.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_pair_active(
    scene: *const SceneHandle,
    id1: ObjectId,
    id2: ObjectId,
    active: *mut i32,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(active, "active", 0)?;
        look(scene, |scene| {
            active.write(i32::from(scene.is_pair_active(id1, id2)?));
            Ok(())
        })
    })
}

/// A scene that the caller is to end, with the workers of `workers`.
pub(super) fn new_scene(workers: &CSceneOptions) -> Checked<*mut SceneHandle> {
    let mut made = Scene::new();
    made.set_workers(read_workers(workers)?);
    let content = SceneContent { scene: made, poisoned: false, told_of_recording: false };
    let handle = SceneHandle { users: AtomicU32::new(0), mark: Mark::new(), content: UnsafeCell::new(content) };
    Ok(Box::into_raw(Box::new(handle)))
}

/// The workers of a scene.
fn read_workers(options: &CSceneOptions) -> Checked<Option<Workers>> {
    let count = (options.worker_count as usize).min(MOST_THREADS);
    match (options.enqueue_task, options.finish_task) {
        (None, None) => Ok((count > 1).then(|| Workers::threads(count))),
        (Some(enqueue), Some(finish)) => Ok((count > 1).then(|| workers(count, enqueue, finish, options.task_user))),
        _ => Err(Failure::new(
            StatusCode::ErrorInvalidArgument,
            "options->enqueue_task and finish_task belong together: set both, or neither",
        )),
    }
}

// --- What the functions above share --------------------------------------------------------------------------------------

fn poisoned() -> Failure {
    Failure::new(
        StatusCode::ErrorPoisoned,
        "the scene met a bug in an earlier call; all that can be done with it is to destroy it",
    )
}

#[cold]
fn busy() -> Failure {
    Failure::new(
        StatusCode::ErrorBusy,
        "the scene is in use by another call: of another thread, or of the one that this call was made in; let one thread use a \
         scene at a time, and do not call it from callbacks",
    )
}

/// Runs `body` on a scene that nobody changes meanwhile.
///
/// # Safety
/// `scene` meets the header's pointer rules.
pub(super) unsafe fn look<T>(scene: *const SceneHandle, body: impl FnOnce(&Scene) -> Checked<T>) -> Checked<T> {
    // SAFETY: by the caller.
    let reading = Reading::enter(unsafe { handle(scene, "scene") }?)?;
    let content = reading.content();
    if content.poisoned { Err(poisoned()) } else { body(&content.scene) }
}

/// Runs `body` on a scene that nobody else uses meanwhile; if a panic leaves `body`, the scene stays poisoned.
///
/// # Safety
/// `scene` meets the header's pointer rules.
#[inline(always)]
pub(super) unsafe fn change(scene: *mut SceneHandle, body: impl FnOnce(&mut Scene) -> Checked<()>) -> StatusCode {
    // SAFETY: by the caller.
    guard(|| unsafe { change_guarded(scene, body) })
}

/// The same in whatever environment the program has set, for a body that calls what sees to it itself.
///
/// # Safety
/// As of [`change`].
#[inline(always)]
pub(super) unsafe fn change_in_any(
    scene: *mut SceneHandle,
    body: impl FnOnce(&mut Scene) -> Checked<()>,
) -> StatusCode {
    // SAFETY: by the caller.
    caught(|| unsafe { change_guarded(scene, body) })
}

/// The same, inside the guard.
///
/// # Safety
/// As of [`change`].
#[inline(always)]
pub(super) unsafe fn change_guarded(
    scene: *mut SceneHandle,
    body: impl FnOnce(&mut Scene) -> Checked<()>,
) -> Checked<()> {
    // SAFETY: by the caller.
    let mut changing = Changing::enter(unsafe { handle(scene, "scene") }?)?;
    let content = changing.content();
    if content.poisoned {
        return Err(poisoned());
    }
    content.poisoned = true;
    let result = body(&mut content.scene);
    content.poisoned = false;
    content.tell_of_recording();
    result
}

impl SceneContent {
    /// Tells the log once that the recording has ended early: the call that met it did what it says all the same.
    #[inline(always)]
    fn tell_of_recording(&mut self) {
        match self.scene.recording_failure() {
            None => self.told_of_recording = false,
            Some(_) if self.told_of_recording => {}
            Some(error) => {
                self.told_of_recording = true;
                log(Failure::from(error.clone()));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ffi::query::{CSceneAnswer, swiftprox_scene_query_intersection};
    use std::ptr::{null, null_mut};

    /// A thread's share of a scene.
    #[derive(Clone, Copy)]
    struct Shared(*mut SceneHandle);

    // SAFETY: a handle may be used by any thread; what must not be done at once, the test does to see it refused.
    unsafe impl Send for Shared {}

    fn new_scene() -> *mut SceneHandle {
        let mut scene = null_mut();
        // SAFETY: null options, and room for a pointer.
        assert_eq!(unsafe { swiftprox_scene_create(null(), &mut scene) }, StatusCode::Ok);
        scene
    }

    #[test]
    fn calls_of_several_threads_at_once_are_done_one_by_one_or_refused() {
        let shared = Shared(new_scene());
        let rounds = if cfg!(miri) { 20 } else { 20_000 };
        let work = move |number: u32| {
            let Shared(scene) = { shared };
            (0..rounds).fold(0, |done, round| {
                // SAFETY: a living scene, and ids that it refuses.
                let status = unsafe {
                    match (round + number) % 3 {
                        0 => swiftprox_scene_set_pair_active(scene, null(), null(), 1),
                        1 => swiftprox_scene_set_pair_active(scene, null(), null(), 0),
                        _ => guard(|| {
                            look(scene, |scene| {
                                std::hint::black_box(scene.objects().count());
                                Ok(())
                            })
                        }),
                    }
                };
                assert!(matches!(status, StatusCode::Ok | StatusCode::ErrorBusy), "{status:?}");
                done + u32::from(status == StatusCode::Ok)
            })
        };
        let done: u32 = std::thread::scope(|threads| {
            let threads = [0, 1, 2].map(|number| threads.spawn(move || work(number)));
            threads.into_iter().map(|thread| thread.join().unwrap()).sum()
        });
        assert!(done > 0);
        // SAFETY: a living scene, used by this thread only.
        unsafe {
            assert_eq!(swiftprox_scene_set_pair_active(shared.0, null(), null(), 1), StatusCode::Ok);
            assert_eq!(swiftprox_scene_destroy(shared.0), StatusCode::Ok);
        }
    }

    #[test]
    fn a_call_inside_a_call_is_refused() {
        let scene = new_scene();
        let mut answer = CSceneAnswer { count: 7, intersecting: 7, ..CSceneAnswer::EMPTY };
        // SAFETY: a living scene, used by this thread only, and room for every output.
        unsafe {
            let status = change(scene, |_| {
                assert_eq!(swiftprox_scene_query_intersection(scene, null(), &mut answer), StatusCode::ErrorBusy);
                assert_eq!((answer.count, answer.intersecting), (0, 0));
                assert_eq!(guard(|| look(scene, |_| Ok(()))), StatusCode::ErrorBusy);
                assert_eq!(swiftprox_scene_destroy(scene), StatusCode::ErrorBusy);
                Ok(())
            });
            assert_eq!(status, StatusCode::Ok);
            let status = guard(|| {
                look(scene, |_| {
                    assert_eq!(swiftprox_scene_set_pair_active(scene, null(), null(), 1), StatusCode::ErrorBusy);
                    assert_eq!(swiftprox_scene_destroy(scene), StatusCode::ErrorBusy);
                    // Those that change nothing may be many.
                    look(scene, |_| Ok(()))
                })
            });
            assert_eq!(status, StatusCode::Ok);
            assert_eq!(swiftprox_scene_query_intersection(scene, null(), &mut answer), StatusCode::Ok);
            assert_eq!(swiftprox_scene_destroy(scene), StatusCode::Ok);
        }
    }
}
