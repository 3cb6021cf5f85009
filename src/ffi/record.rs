//! What is done to a scene, written down in a file, and done again from it.

use std::ffi::c_char;

use super::arrays::read_path;
use super::enumerators::QueryNumber;
use super::failure::{Checked, StatusCode};
use super::guard::{guard, keep_panics_quiet};
use super::pointers::{exclusive, input, output};
use super::query::{CSceneAnswer, DEFAULT_TOLERANCE};
use super::scene::{CSceneOptions, SceneHandle, change, look, new_scene, swiftprox_scene_destroy};
use super::structs::{Versioned, read_struct, write_struct};
use crate::pair::Query;
use crate::scene::object::ObjectId;
use crate::scene::{Replay, Scene};

/// Writes down what is done to a scene from now on, in a file, replacing what was there: a bug report and a benchmark in one. First
/// comes what the scene holds. `path` null: ends the recording, if there is one, as swiftprox_scene_destroy does. A recording that
/// is going on ends before another one begins. swiftprox-replay plays recordings back, and swiftprox_replay_open does.
///
/// All that changes what queries answer is written down, and each query with a digest of its answer; workers and statistics are
/// not. Of the callback of swiftprox_scene_set_pair_filter the decisions are. Each shape is written down once. The file is brought
/// up to date before each query: one that ends the program is its last record. Record from the scene's beginning, before its first
/// object, for a replay that answers with the same bits; later on what pairs remember is not written down.
///
/// Where the file cannot be written any more the recording ends, and the scene goes on. The log is told, and so is the call that
/// ends the recording.
///
/// SWIFTPROX_ERROR_FILE: the file cannot be written, or is no regular file; or the recording before could not be written to its
/// end, and then no other is begun. SWIFTPROX_ERROR_INVALID_ARGUMENT: it is no path. The scene is not recorded then.
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

/// Plays back what swiftprox_scene_record has written. Make one with swiftprox_replay_open.
///
/// A step is what was done up to a query, and the query. For each step call swiftprox_replay_read, which reads it,
/// swiftprox_replay_change, which does what was done in it, and swiftprox_replay_ask, which makes its query; or make queries of
/// your own of the scene instead. A file of any content is safe: it is an error, or does to the scene what a program could.
#[derive(Debug)]
pub struct ReplayHandle {
    replay: Replay,
    scene: *mut SceneHandle,
}

/// A step of a recording. Set struct_size to sizeof(swiftprox_replay_step_info) before asking for it.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CReplayStep {
    /// Set by the caller.
    pub struct_size: usize,
    /// 1 if there is a step, 0 at the end of the recording.
    pub has_step: i32,
    /// 1 if the step ends in a query, else 0: at the end of the recording, and of a query that was refused.
    pub has_query: i32,
    /// The kind of the query.
    pub kind: QueryNumber,
    /// 1 at the end of a recording that was not ended, as when the program was, else 0.
    pub cut_off: i32,
    /// How much of the file is read, from 0 to 1.
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

/// Opens a recording and makes a scene to play it back in, with the workers of `options`, which may be null for the defaults, and
/// the rotation limit of the recorded scene. The caller gives both back with swiftprox_replay_close. On failure `*replay` is null.
///
/// SWIFTPROX_ERROR_FILE: the file cannot be read, is no regular file, no recording, of another version, or damaged at its
/// beginning. SWIFTPROX_ERROR_INVALID_ARGUMENT: it is no path, or of enqueue_task and finish_task one is null and the other is not.
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
        let scene = new_scene(&opened.scene_options(), &options)?;
        replay.write(Box::into_raw(Box::new(ReplayHandle { replay: opened, scene })));
        Ok(())
    })
}

/// Ends a replay and its scene, which the caller owns. Null is ignored.
///
/// SWIFTPROX_ERROR_BUSY: another call uses the scene, and both live on. Other errors as of swiftprox_scene_destroy.
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

/// Gives the scene of a replay, which owns it: ask it what you like between the steps, change nothing, and do not destroy it. Null
/// for null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_scene(replay: *mut ReplayHandle) -> *mut SceneHandle {
    // SAFETY: a live replay by the header's pointer rules, or null.
    unsafe { replay.as_ref() }.map_or(std::ptr::null_mut(), |handle| handle.scene)
}

/// Reads the next step. Set step->struct_size first. A recording that is cut off ends with its last whole record. On failure
/// `*step` says that there is no step.
///
/// SWIFTPROX_ERROR_FILE: the recording is damaged here, the message says where; the steps before are good.
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the step before has not been done.
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

/// Does what was done in the step that was read, without its query.
///
/// SWIFTPROX_ERROR_FILE: the scene refuses it, as the program has changed it or the recording is damaged; it cannot be gone on
/// with.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_change(replay: *mut ReplayHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { with_replay(replay, |replay, scene| Ok(replay.change(scene)?)) }
}

/// Makes the query of the step that was read and done, and holds its answer against the recorded one: the same pairs are to be
/// listed with the same outcomes, and the sums of their lower and of their upper ends are to be those of intervals that have a
/// number in common. That holds on every machine, except with a step budget: such answers are not checked. The answer is
/// as of the query itself; of a query about events it lists the pairs of pieces that are near. `*identical` is 1 if its distances,
/// intervals, points, normals and depths are bit for bit the recorded ones, else 0; `identical` may be null.
///
/// With another `distance_tolerance` than SWIFTPROX_DEFAULT_TOLERANCE that is taken in place of the recorded one, and the answer is
/// not checked.
///
/// SWIFTPROX_ERROR_UNVERIFIED: it is not the recorded answer; the message says what of it is not. The answer is there all the same;
/// on other failures it is empty. SWIFTPROX_ERROR_INVALID_ARGUMENT: there is no such query, or the step has not been done; or the
/// query is out of range, as the last of a recording that is cut off may be. SWIFTPROX_ERROR_FILE: the recording is damaged, its
/// query is about an object or a shape that it has not told of. SWIFTPROX_ERROR_HANDLE: the query is about an object that has been
/// removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_replay_ask(
    replay: *mut ReplayHandle,
    distance_tolerance: f64,
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
            let tolerance = (distance_tolerance != DEFAULT_TOLERANCE).then_some(distance_tolerance);
            let said = replay.ask(scene, tolerance)?;
            answer.write(CSceneAnswer::new(&said.answer));
            if let Some(identical) = identical.as_mut() {
                *identical = i32::from(said.is_identical);
            }
            Ok(said.check?)
        })
    }
}

/// Writes the number of an object of the replay's scene: how many there were before it in the recording. On failure it is 0.
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
