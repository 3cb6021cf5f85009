//! Scenes: made, ended, and told which pairs to test.

use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::sync::atomic::{AtomicU32, Ordering};

use super::failure::{Checked, Failure, StatusCode};
use super::guard::{guard, keep_panics_quiet};
use super::log::log;
use super::pointers::{input, output};
use super::structs::{Versioned, read_struct};
use super::workers::{EnqueueTaskCallback, FinishTaskCallback, workers};
use crate::base::math::ROTATION_LIMIT;
use crate::base::workers::parked::MOST_THREADS;
use crate::scene::object::ObjectId;
use crate::scene::{Scene, SceneOptions, Workers};
use crate::shape::Shape;

/// Objects, their poses and the pairs that queries test. Make one with swiftprox_scene_create.
#[derive(Debug)]
pub struct SceneHandle {
    /// How many calls read the scene, and [`CHANGING`] while one changes it. Every call enters here before it makes a reference to
    /// what follows.
    users: AtomicU32,
    content: UnsafeCell<Content>,
}

#[derive(Debug)]
struct Content {
    scene: Scene,
    /// A change was begun and not ended: a panic left it, and what it left behind is unknown.
    poisoned: bool,
    /// The log knows that the recording has ended early.
    told_of_recording: bool,
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

    fn content(&mut self) -> &mut Content {
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

    fn content(&self) -> &Content {
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
    is_shared_between_threads::<Content>();
    is_shared_between_threads::<Shape>();
};

/// How a scene is made. Begin with SWIFTPROX_SCENE_OPTIONS_DEFAULT, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneOptions {
    /// Set by SWIFTPROX_SCENE_OPTIONS_DEFAULT.
    pub struct_size: usize,
    /// Largest accepted |RᵀR − I| entry of a pose, from 0 to 1e-2 (the default).
    pub rotation_limit: f64,
    /// How many threads may work on a query or on poses that are set together, the caller's among them. It changes no bit of any
    /// answer. Queries that stop early, those without a tolerance over many objects, and few pairs or objects stay in the caller's
    /// thread. More than 256 count as 256. Default: 0, which means 1.
    pub worker_count: u32,
    /// Shares the work out among the program's own threads. Default: null, together with finish_task: the scene has threads of its
    /// own, which wait between calls. swiftprox_scene_create starts them, and does without those that cannot be started;
    /// swiftprox_scene_destroy ends them and waits for that. The child of a fork() has none: its calls stay in the caller's
    /// thread. exit() does not wait for them. A program that unloads the library destroys its scenes first.
    pub enqueue_task: EnqueueTaskCallback,
    /// Waits for what enqueue_task has shared out. Default: null.
    pub finish_task: FinishTaskCallback,
    /// Handed to both. Default: null.
    pub task_user: *mut c_void,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CSceneOptions {
    const NAME: &'static str = "swiftprox_scene_options";
}

impl CSceneOptions {
    /// What the header calls its default.
    pub const DEFAULT: CSceneOptions = CSceneOptions {
        struct_size: size_of::<CSceneOptions>(),
        rotation_limit: ROTATION_LIMIT,
        worker_count: 0,
        enqueue_task: None,
        finish_task: None,
        task_user: std::ptr::null_mut(),
    };
}

// --- Scenes --------------------------------------------------------------------------------------------------------------

/// Makes an empty scene; the caller owns it and gives it back with swiftprox_scene_destroy. On failure `*scene` is null. `options`
/// may be null for the defaults.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the rotation limit is out of range, or of enqueue_task and finish_task one is null and the
/// other is not. SWIFTPROX_ERROR_NULL_POINTER, SWIFTPROX_ERROR_STRUCT_SIZE:
/// the message names the argument.
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
        scene.write(new_scene(&SceneOptions { rotation_limit: options.rotation_limit }, &options)?);
        Ok(())
    })
}

/// Ends a scene, which the caller owns, a poisoned one too. Its shares of shapes are given back; its ids and results end with it.
/// Null is ignored.
///
/// SWIFTPROX_ERROR_BUSY: another call uses the scene, which lives on. SWIFTPROX_ERROR_BUG: the scene is gone, but perhaps not all
/// of its memory. SWIFTPROX_ERROR_FILE, SWIFTPROX_ERROR_MEMORY: the scene is gone, and its recording was not written to its end.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_destroy(scene: *mut SceneHandle) -> StatusCode {
    guard(|| {
        // SAFETY: a live scene by the header's pointer rules, or null.
        if let Some(handle) = unsafe { scene.as_ref() } {
            // Nobody enters any more: whoever tries while the scene is freed is told so as long as its memory is there.
            std::mem::forget(Changing::enter(handle)?);
            // SAFETY: a live scene by the header's pointer rules; every one comes from Box::into_raw.
            let handle = unsafe { Box::from_raw(scene) };
            let Content { mut scene, poisoned, .. } = handle.content.into_inner();
            // A bug was told when it was met: what there is of a recording ends here.
            return if poisoned { Ok(()) } else { Ok(scene.end_recording()?) };
        }
        Ok(())
    })
}

/// Queries without a tolerance are about all pairs of pieces. While these are no more than `limit`, each remembers its last answer,
/// which makes the next one several times faster and takes about 150 bytes, if there is memory for that. Of more than `limit` only
/// near pairs remember theirs. Results and their order are the same. Default: 1048576 pairs, about 150 MB, which 1448
/// single pieces make. 0: none but near pairs.
///
/// SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
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

/// Gives back the memory that a scene keeps for later: that of the last query's results, which end, and that of pairs that are no
/// more. What the others remember stays. The next query takes anew what it needs.
///
/// SWIFTPROX_ERROR_MEMORY: there is not enough for a smaller list of pairs; nothing has changed.
/// SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_shrink(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.shrink()?)) }
}

// --- Activation ----------------------------------------------------------------------------------------------------------

/// Sets whether queries test pairs of objects: `active` other than 0, or 0. With two ids it is their pair, in either order, with all
/// its pairs of pieces; with one null pointer all pairs that the other object is in now; with two all that there are now. Objects
/// added later begin with all their pairs active; two fixed objects are never tested.
///
/// SWIFTPROX_ERROR_HANDLE: an id names no object of this scene. SWIFTPROX_ERROR_INVALID_ARGUMENT: one object twice.
/// SWIFTPROX_ERROR_MEMORY. SWIFTPROX_ERROR_NULL_POINTER: scene is null. SWIFTPROX_ERROR_POISONED.
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

/// Sets `*active` to 1 if queries test the pair of two objects, given in either order, else to 0 (also on failure).
///
/// Errors as of swiftprox_scene_set_pair_active; SWIFTPROX_ERROR_NULL_POINTER also when active is null.
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
pub(super) fn new_scene(options: &SceneOptions, workers: &CSceneOptions) -> Checked<*mut SceneHandle> {
    let mut made = Scene::new(options)?;
    made.set_workers(read_workers(workers)?);
    let content = Content { scene: made, poisoned: false, told_of_recording: false };
    let handle = SceneHandle { users: AtomicU32::new(0), content: UnsafeCell::new(content) };
    Ok(Box::into_raw(Box::new(handle)))
}

/// Who works for a scene.
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
    let reading = Reading::enter(unsafe { input(scene, "scene") }?)?;
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
    let mut changing = Changing::enter(unsafe { input(scene, "scene") }?)?;
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

impl Content {
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

    /// What a thread is handed of a scene.
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
        let mut answer = CSceneAnswer { pairs: null(), count: 7, intersecting: 7, found: null() };
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
