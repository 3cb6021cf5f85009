//! Recordings: changes and queries of a scene, written to a file and replayed from it.

use std::ffi::c_char;

use super::arrays::read_path;
use super::enumerators::QueryNumber;
use super::failure::{Checked, StatusCode};
use super::guard::{guard, keep_panics_quiet};
use super::pointers::{exclusive, input, output};
use super::query::{CSceneAnswer, DEFAULT_MAX_DISTANCE};
use super::scene::{CSceneOptions, SceneHandle, change, look, new_scene, swiftprox_scene_destroy};
use super::structs::{Versioned, read_struct, write_struct};
use crate::pair::Query;
use crate::scene::object::ObjectId;
use crate::scene::{Replay, Scene};

/// Records a scene in a file from now on, for bug reports and benchmarks. Its present content comes first. An existing file is
/// replaced, and a running recording ends. Null `path` only ends it, as swiftprox_scene_destroy does. swiftprox-replay and
/// swiftprox_replay_open play recordings back.
///
/// The file has every change that affects answers, and each query with a digest of its answer. A pair filter is recorded by its
/// decisions. The file is updated before each query, so a query that crashes is its last record. For a replay with the same
/// bits, record before the first object is added: pair caches are not recorded.
///
/// If writing fails, the recording ends and the scene goes on. The log and the call that ends the recording report it.
///
/// SWIFTPROX_ERROR_FILE: the file is not writable or not regular; or the former recording could not be completed, and no new
/// one begins. SWIFTPROX_ERROR_INVALID_ARGUMENT: it is no path.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_record(scene: *mut SceneHandle, path: *const c_char) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            if path.is_null() {
                return Ok(scene.end_recording()?);
            }
            Ok(scene.record(read_path(path)?)?)
        })
    }
}

/// Plays back a recording of swiftprox_scene_record. Create one with swiftprox_replay_open.
///
/// A step is a query and all changes before it. For each step call swiftprox_replay_read, swiftprox_replay_change and
/// swiftprox_replay_ask. You may replace the last by your own queries of the scene. Files of any content are safe: they cause an
/// error, or change the scene as a program could.
#[derive(Debug)]
pub struct ReplayHandle {
    replay: Replay,
    scene: *mut SceneHandle,
}

/// A step of a recording. Set struct_size to sizeof(swiftprox_replay_step_info) before the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CReplayStep {
    /// Set by the caller.
    pub struct_size: usize,
    /// 1 if there is a step, 0 at the end of the recording.
    pub has_step: i32,
    /// 1 if the step ends in a query. 0 at the end of the recording, and for a query that was refused.
    pub has_query: i32,
    /// The kind of the query.
    pub kind: QueryNumber,
    /// 1 at the end of an unfinished recording, such as that of a program that crashed, else 0.
    pub cut_off: i32,
    /// Part of the file read so far, from 0 to 1.
    pub fraction: f64,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CReplayStep {
    const NAME: &'static str = "swiftprox_replay_step_info";
}

impl CReplayStep {
    const NONE: CReplayStep = CReplayStep {
        struct_size: size_of::<CReplayStep>(),
        has_step: 0,
        has_query: 0,
        kind: Query::Intersection as i32,
        cut_off: 0,
        fraction: f64::NAN,
    };
}

/// Opens a recording and creates a scene for it, with the workers of `options`. Null `options` mean
/// the defaults. The caller frees both with swiftprox_replay_close. On failure `*replay` is null.
///
/// SWIFTPROX_ERROR_FILE: the file is unreadable, not regular, not a recording, of another version, or damaged at its beginning.
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: it is no path, or only one of enqueue_task and finish_task is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_open(
    path: *const c_char,
    options: *const CSceneOptions,
    replay: *mut *mut ReplayHandle,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(replay, "replay", std::ptr::null_mut())?;
        keep_panics_quiet();
        let options = read_struct(options, CSceneOptions::DEFAULT)?;
        let opened = Replay::open(read_path(path)?)?;
        let scene = new_scene(&options)?;
        replay.write(Box::into_raw(Box::new(ReplayHandle { replay: opened, scene })));
        Ok(())
    })
}

/// Ends a replay and destroys its scene. Null is ignored.
///
/// SWIFTPROX_ERROR_BUSY: another call uses the scene; both stay alive. Else same errors as swiftprox_scene_destroy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_close(replay: *mut ReplayHandle) -> StatusCode {
    // SAFETY: a live replay by the header's pointer rules, or null.
    let Some(handle) = (unsafe { replay.as_ref() }) else {
        return StatusCode::Ok;
    };
    // SAFETY: the replay's own scene.
    let status = unsafe { swiftprox_scene_destroy(handle.scene) };
    if status == StatusCode::ErrorBusy {
        return status;
    }
    let freed = guard(|| {
        // SAFETY: every replay comes from Box::into_raw.
        drop(unsafe { Box::from_raw(replay) });
        Ok(())
    });
    if status == StatusCode::Ok { freed } else { status }
}

/// Returns the scene of a replay, which the replay owns. You may query it between the steps, but must not change or destroy it. For
/// null it returns null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_scene(replay: *mut ReplayHandle) -> *mut SceneHandle {
    // SAFETY: a live replay by the header's pointer rules, or null.
    unsafe { replay.as_ref() }.map_or(std::ptr::null_mut(), |handle| handle.scene)
}

/// Reads the next step. Set step->struct_size first. An unfinished recording ends with its last whole record. On failure `*step`
/// has no step.
///
/// SWIFTPROX_ERROR_FILE: the recording is damaged here; the message says where. Earlier steps are good.
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: swiftprox_replay_change was not called for the step before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_read(replay: *mut ReplayHandle, step: *mut CReplayStep) -> StatusCode {
    // SAFETY: the header's pointer rules.
    let refused = guard(|| unsafe { write_struct(step, "step", &CReplayStep::NONE) });
    if refused != StatusCode::Ok {
        return refused;
    }
    // SAFETY: the header's pointer rules.
    unsafe {
        with_replay(replay, |replay, _| {
            let read = replay.read()?;
            let query = read.and_then(|read| read.query);
            let value = CReplayStep {
                has_step: i32::from(read.is_some()),
                has_query: i32::from(query.is_some()),
                kind: query.map_or(Query::Intersection, |(kind, _)| kind) as i32,
                cut_off: i32::from(read.is_none() && replay.is_cut_off()),
                fraction: read.map_or(1.0, |read| read.fraction),
                ..CReplayStep::NONE
            };
            write_struct(step, "step", &value)
        })
    }
}

/// Applies the changes of the step that was read, without its query.
///
/// SWIFTPROX_ERROR_FILE: the scene refuses a change, because the program changed the scene or the recording is damaged. The replay
/// cannot go on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_change(replay: *mut ReplayHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { with_replay(replay, |replay, scene| Ok(replay.change(scene)?)) }
}

/// Runs the query of the step that was read and applied, and checks its answer against the recording. Pairs and outcomes must be
/// equal. The sums of lower ends and of upper ends must form intervals that overlap. This is guaranteed on every machine, except
/// for queries with a step budget, which are not checked.
///
/// The answer is as from the query itself; queries of events list near pairs of pieces. `*identical` is 1 if distances, intervals,
/// points, normals and depths have the recorded bits, else 0; `identical` may be null. A `max_distance` other than
/// SWIFTPROX_DEFAULT_MAX_DISTANCE replaces the recorded one, and the answer is not checked.
///
/// SWIFTPROX_ERROR_UNVERIFIED: the answer differs; the message says where. It is still returned; after other errors it is empty.
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no query, the step was not applied, or the query is out of range. The last query of
/// an unfinished recording may be. SWIFTPROX_ERROR_FILE: the query names an unknown object or shape. SWIFTPROX_ERROR_HANDLE: it
/// names a removed object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_ask(
    replay: *mut ReplayHandle,
    max_distance: f64,
    answer: *mut CSceneAnswer,
    identical: *mut i32,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    let refused = guard(|| unsafe {
        if let Some(identical) = identical.as_mut() {
            *identical = 0;
        }
        output(answer, "answer", CSceneAnswer::EMPTY)
    });
    if refused != StatusCode::Ok {
        return refused;
    }
    // SAFETY: the header's pointer rules; `answer` was written before.
    unsafe {
        with_replay(replay, |replay, scene| {
            let tolerance = (max_distance != DEFAULT_MAX_DISTANCE).then_some(max_distance);
            let said = replay.ask(scene, tolerance)?;
            answer.write(CSceneAnswer::new(&said.answer));
            if let Some(identical) = identical.as_mut() {
                *identical = i32::from(said.is_identical);
            }
            Ok(said.check?)
        })
    }
}

/// Writes the number of an object of the replay's scene: how many objects the recording has before it. On failure it is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_get_number(
    replay: *const ReplayHandle,
    id: ObjectId,
    number: *mut u32,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(number, "number", 0)?;
        let handle = input(replay, "replay")?;
        look(handle.scene, |scene| {
            number.write(handle.replay.number(scene, id)?);
            Ok(())
        })
    })
}

/// Runs `body` on a replay and its scene; a bug that is met poisons the scene, and the replay with it.
///
/// # Safety
/// `replay` meets the header's pointer rules.
unsafe fn with_replay(
    replay: *mut ReplayHandle,
    body: impl FnOnce(&mut Replay, &mut Scene) -> Checked<()>,
) -> StatusCode {
    let mut found = None;
    let refused = guard(|| {
        // SAFETY: by the caller.
        found = Some(unsafe { exclusive(replay, "replay") }?);
        Ok(())
    });
    let Some(ReplayHandle { replay, scene }) = found else {
        return refused;
    };
    // SAFETY: the replay's own scene.
    unsafe { change(*scene, |scene| body(replay, scene)) }
}
