//! Calls about recordings: of scenes as they are, and of files that were damaged.

use std::ffi::CString;
use std::ptr::{null, null_mut};

use arbitrary::{Result, Unstructured};
use swiftprox::ffi::StatusCode;
use swiftprox::ffi::query::{CSceneAnswer, DEFAULT_MAX_DISTANCE};
use swiftprox::ffi::record::*;
use swiftprox::object::ObjectId;

use super::arguments::{or_null, temporary_file};
use super::{Program, last_message};

/// More are no use, and disks are slow.
const MOST_STEPS: usize = 64;

impl Program {
    /// Begins to record a scene, ends it, or plays what there is.
    pub fn record(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let handle = or_null(u, self.scenes[place].handle)?;
        // A file for each living scene.
        let path = temporary_file(&format!("{:x}.swiftprox", handle.addr()));
        // SAFETY: a living scene or null, a path or null.
        unsafe {
            match u.int_in_range(0..=3)? {
                0 | 1 => {
                    let status = swiftprox_scene_record(handle, path.as_ptr());
                    if status == StatusCode::Ok && !self.recordings.contains(&path) {
                        self.recordings.push(path);
                    }
                    Ok(status)
                }
                2 => Ok(swiftprox_scene_record(handle, null())),
                _ => {
                    // What is being written is handed over.
                    for scene in &self.scenes {
                        assert_eq!(swiftprox_scene_record(scene.handle, null()), StatusCode::Ok, "{}", last_message());
                    }
                    if self.recordings.is_empty() {
                        return Ok(StatusCode::Ok);
                    }
                    let chosen = u.choose_index(self.recordings.len())?;
                    play(u, &self.recordings[chosen])
                }
            }
        }
    }
}

/// Plays a file, as it is or with a byte changed.
///
/// # Safety
/// Nobody else uses the file.
unsafe fn play(u: &mut Unstructured, path: &CString) -> Result<StatusCode> {
    let name = path.to_str().expect("a path in UTF-8");
    let mut bytes = std::fs::read(name).expect("the file of a recording");
    let is_damaged = u.ratio(1, 4)? && !bytes.is_empty();
    if is_damaged {
        let at = u.choose_index(bytes.len())?;
        bytes[at] ^= 1 << u.int_in_range(0..=7)?;
        std::fs::write(name, bytes).expect("a file for the fuzz target");
    }
    let mut replay = null_mut();
    // SAFETY: a path, room for all outputs, and a living replay.
    unsafe {
        let status = swiftprox_replay_open(path.as_ptr(), null(), &mut replay);
        assert_eq!(status == StatusCode::Ok, !replay.is_null());
        assert!(is_damaged || status == StatusCode::Ok, "{}", last_message());
        let mut end = status;
        for _ in 0..MOST_STEPS {
            let mut step = std::mem::zeroed::<CReplayStep>();
            step.struct_size = size_of::<CReplayStep>();
            end = if replay.is_null() { end } else { swiftprox_replay_read(replay, &mut step) };
            if end != StatusCode::Ok || step.has_step == 0 {
                break;
            }
            assert_eq!(swiftprox_replay_change(replay), StatusCode::Ok, "{}", last_message());
            let mut answer = std::mem::zeroed::<CSceneAnswer>();
            let asked = swiftprox_replay_ask(replay, DEFAULT_MAX_DISTANCE, &mut answer, null_mut());
            let is_right = asked == if step.has_query == 1 { StatusCode::Ok } else { StatusCode::ErrorInvalidArgument };
            assert!(is_right, "{}", last_message());
            let mut number = 7;
            if answer.count > 0 {
                let found = swiftprox_replay_get_number(replay, (*answer.pairs).object1, &mut number);
                assert_eq!(found, StatusCode::Ok);
            }
            let none = swiftprox_replay_get_number(replay, ObjectId::NULL, &mut number);
            assert_eq!((none, number), (StatusCode::ErrorHandle, 0));
        }
        assert!(is_damaged || end == StatusCode::Ok, "{}", last_message());
        assert_eq!(swiftprox_replay_close(replay), StatusCode::Ok);
        Ok(status)
    }
}
