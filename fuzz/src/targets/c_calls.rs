//! The C interface driven by arbitrary bytes as a careless C program would: any order of calls, ids that are stale, foreign or
//! made up, null pointers, sizes and enumerators of no struct, poses of NaN, handles that are made and never used. Nothing may
//! panic, be poisoned, leak, or read or write a byte that was not handed over (arrays and structs have exactly the room that they
//! claim); what a scene answers is held against a plain model of its objects and pairs. The last byte chooses the floating-point
//! environment of the program.

use std::ffi::CStr;

use arbitrary::{Result, Unstructured};
use swiftprox::ffi::StatusCode;
use swiftprox::ffi::library::*;

use crate::c_program::{Program, last_message};
use crate::geometry::last_is_environment;

const MOST_CALLS: usize = 64;

pub fn run(bytes: &[u8]) {
    let (environment, bytes) = last_is_environment(bytes);
    let mut program = Program::begin(environment);
    let mut u = Unstructured::new(bytes);
    for _ in 0..MOST_CALLS {
        if u.is_empty() || step(&mut program, &mut u).is_err() {
            break;
        }
    }
    program.end();
}

fn step(program: &mut Program, u: &mut Unstructured) -> Result<()> {
    let status = program.call(u)?;
    // SAFETY: never null, terminated, valid for ever.
    let words = unsafe { CStr::from_ptr(swiftprox_library_status_string(status as i32)) };
    assert_ne!(words.to_bytes(), b"not a status");
    let bug = matches!(status, StatusCode::ErrorBug | StatusCode::ErrorPoisoned | StatusCode::ErrorVersion);
    assert!(!bug, "{status:?}: {}", last_message());
    assert!(status == StatusCode::Ok || !last_message().is_empty(), "{status:?} without a message");
    Ok(())
}
