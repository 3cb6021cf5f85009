//! A mesh reader as a careless program writes it: the file says what it does with the sink.

use std::cell::Cell;
use std::ffi::{CStr, c_char, c_void};
use std::ptr::{null, null_mut};

use arbitrary::{Result, Unstructured};
use swiftprox::ffi::StatusCode;
use swiftprox::ffi::mesh_reader::*;

use super::arguments::{array, mesh_arrays, or_null};

const MAGIC: &CStr = c"READ";

thread_local! {
    /// Whether the reader ran, and refused its file: by what it returned or said, or by a call that was refused.
    static REFUSED: Cell<Option<bool>> = const { Cell::new(None) };
}

pub fn register() {
    // SAFETY: a string, and a callback that takes any file.
    let status = unsafe { swiftprox_library_register_mesh_reader(MAGIC.as_ptr(), Some(read), null_mut()) };
    assert_eq!(status, StatusCode::Ok);
}

pub fn take_back() {
    // SAFETY: as above.
    let status = unsafe { swiftprox_library_register_mesh_reader(MAGIC.as_ptr(), None, null_mut()) };
    assert_eq!(status, StatusCode::Ok);
}

/// Reads a file by a call of the library: what the reader refuses is refused.
pub fn reading(call: impl FnOnce() -> StatusCode) -> StatusCode {
    REFUSED.set(None);
    let status = call();
    assert!(REFUSED.get() != Some(true) || status == StatusCode::ErrorFile, "{status:?} for a file that was refused");
    status
}

unsafe extern "C-unwind" fn read(_: *mut c_void, data: *const c_char, size: usize, sink: *mut MeshSink) -> i32 {
    // SAFETY: the bytes of the file and a zero byte.
    let bytes = unsafe { std::slice::from_raw_parts(data.cast::<u8>(), size + 1) };
    assert_eq!(bytes[size], 0);
    let start = bytes.windows(4).position(|window| window == MAGIC.to_bytes()).expect("the magic is in it");
    let mut refused = false;
    let returned = follow(&mut Unstructured::new(&bytes[start + 4..size]), sink, &mut refused).unwrap_or(0);
    REFUSED.set(Some(refused || returned != 0));
    returned
}

/// Does what the file says, and returns what it says.
fn follow(u: &mut Unstructured, sink: *mut MeshSink, refused: &mut bool) -> Result<i32> {
    for _ in 0..u.int_in_range(1..=4)? {
        let arrays = mesh_arrays(u)?;
        for _ in 0..u.int_in_range(1..=4)? {
            let call = u.int_in_range(0..=7)?;
            let sink = if u.ratio(1, 16)? { null_mut() } else { sink };
            // SAFETY: the sink of this callback or null; what is not null has the room that it claims.
            let status = unsafe {
                match call {
                    0..=2 => {
                        let (vertices, count) = array(u, arrays.vertices.at(), arrays.vertex_count)?;
                        swiftprox_mesh_sink_add_vertices(sink, vertices, count)
                    }
                    3..=5 => {
                        let valences = if arrays.triangles { null_mut() } else { arrays.valences.at() };
                        let indices = or_null(u, arrays.indices.at())?;
                        swiftprox_mesh_sink_add_faces(sink, indices, valences, arrays.face_count)
                    }
                    6 => swiftprox_mesh_sink_set_single_precision(sink),
                    _ => {
                        *refused |= !sink.is_null();
                        swiftprox_mesh_sink_fail(sink, if u.arbitrary()? { c"rubbish".as_ptr() } else { null() })
                    }
                }
            };
            *refused |= status != StatusCode::Ok && !sink.is_null();
        }
    }
    // Mostly the file is good apart from what was refused.
    if !u.arbitrary()? {
        const CORNERS: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        const FACES: [u32; 12] = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2];
        // SAFETY: the sink of this callback, and arrays of these sizes.
        let status = unsafe {
            assert_eq!(swiftprox_mesh_sink_add_vertices(sink, CORNERS.as_ptr(), 4), StatusCode::Ok);
            swiftprox_mesh_sink_add_faces(sink, FACES.as_ptr(), null(), 4)
        };
        assert_eq!(status, StatusCode::Ok);
    }
    u.int_in_range(0..=1)
}
