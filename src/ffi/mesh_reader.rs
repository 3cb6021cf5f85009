//! Readers of mesh files that the caller registers, and what such a reader hands its mesh to.

use std::ffi::{c_char, c_void};
use std::sync::Arc;

use super::arrays::{Faces, check_count, read_faces, read_vectors};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::{call_out, guard};
use super::pointers::{exclusive, string};
use crate::base::error::{Error, Result};
use crate::base::memory::{extend, reserve, with_capacity};
use crate::body::mesh::io::{register_mesh_reader, unregister_mesh_reader};
use crate::body::mesh::{PolygonMesh, check_vertex};

/// Receives the mesh that a swiftprox_mesh_reader_callback reads. It is valid only during the callback, in its thread.
#[derive(Default)]
pub struct MeshSink {
    mesh: PolygonMesh,
    /// The valences of all faces; `mesh` becomes whole at the end.
    valences: Vec<u32>,
    /// The reader's own message.
    said: Option<String>,
    /// The first of its calls that was refused, and whether that was for memory.
    refused: Option<(StatusCode, String)>,
}

/// Reads a mesh file. It calls swiftprox_mesh_sink_add_vertices and swiftprox_mesh_sink_add_faces any number of times and
/// returns 0. To refuse the file, it calls swiftprox_mesh_sink_fail or returns another number. A failed call to the sink refuses
/// the file, too, even if the callback ignores it.
///
/// `user` is the pointer given with the callback. `data` holds the `size` bytes of the file, without a UTF-8 byte order mark. It
/// starts with any white space and the magic, which the callback must skip. A zero byte follows, where strtod stops. (strtod uses
/// the decimal point of the program's locale, LC_NUMERIC; the built-in readers use a point in every locale.)
///
/// Data and sink are valid until the callback returns; the sink copies what it is given. The callback may call the library, to read
/// files or to register readers. It must return; a C++ exception that leaves it ends the program.
pub type MeshReaderCallback = Option<
    unsafe extern "C-unwind" fn(user: *mut c_void, data: *const c_char, size: usize, sink: *mut MeshSink) -> i32,
>;

/// No more bytes of a message of a reader are kept.
const LONGEST_MESSAGE: usize = 4096;

/// A callback and its user pointer.
struct CallbackReader {
    callback: unsafe extern "C-unwind" fn(*mut c_void, *const c_char, usize, *mut MeshSink) -> i32,
    user: *mut c_void,
}

// SAFETY: `user` is only ever handed back to the callback, which swiftprox_library_register_mesh_reader requires to be callable
// from every thread.
unsafe impl Send for CallbackReader {}
// SAFETY: as above.
unsafe impl Sync for CallbackReader {}

impl CallbackReader {
    /// The mesh that the callback makes of a file.
    fn read(&self, bytes: &[u8]) -> Result<PolygonMesh> {
        let mut data = with_capacity(bytes.len() + 1)?;
        data.extend_from_slice(bytes);
        data.push(0);
        let mut sink = MeshSink::default();
        // SAFETY: the callback takes its own user pointer, the bytes of a file, and a sink, which all outlive the call
        // (swiftprox_library_register_mesh_reader).
        let returned = call_out(|| unsafe { (self.callback)(self.user, data.as_ptr().cast(), bytes.len(), &mut sink) });
        sink.finish(returned)
    }
}

impl MeshSink {
    /// The mesh, if the reader is content and nothing was refused.
    fn finish(self, returned: i32) -> Result<PolygonMesh> {
        if let Some((StatusCode::ErrorMemory, message)) = self.refused {
            return Err(Error::Memory(message));
        }
        // The reader's own words come first: they know the line.
        if let Some(message) = self.said.or(self.refused.map(|(_, message)| message)) {
            return Err(Error::File(message));
        }
        if returned != 0 {
            return Err(Error::File(format!("it returned {returned} and no message")));
        }
        let PolygonMesh { vertices, indices, single_precision, .. } = self.mesh;
        Ok(PolygonMesh { single_precision, ..PolygonMesh::new(vertices, indices, Some(&self.valences))? })
    }
}

/// Registers a reader of mesh files, for the process. swiftprox_shape_create_from_file calls it for each file that begins with
/// `magic`, whatever its extension. White space and a UTF-8 byte order mark before the magic are skipped. "PLY" also matches
/// PLYMOUTH. Registered readers precede the built-in ones: "OFF" replaces one.
///
/// Any thread, and any callback, may call this at any time. A reader replaces one with the same magic; a null callback removes
/// it. Several threads may call the callback at once. `user` must stay valid until the reader is replaced or removed, and no
/// thread still reads a file with it.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: magic is empty, or begins with white space, a byte order mark or another reader's magic,
/// or that one begins with it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_library_register_mesh_reader(
    magic: *const c_char,
    callback: MeshReaderCallback,
    user: *mut c_void,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let magic = unsafe { string(magic, "magic") }?.to_bytes();
        let Some(callback) = callback else {
            unregister_mesh_reader(magic);
            return Ok(());
        };
        let reader = CallbackReader { callback, user };
        Ok(register_mesh_reader(magic, Arc::new(move |bytes| reader.read(bytes)))?)
    })
}

/// Adds `vertex_count` vertices, 3 coordinates each, to the mesh. They are numbered from 0 in order of addition. The array is
/// copied.
///
/// On failure nothing is added, and the file is refused. SWIFTPROX_ERROR_MESH: a coordinate is not finite; the message names the
/// vertex. SWIFTPROX_ERROR_LIMIT: too many vertices. After SWIFTPROX_ERROR_MEMORY reading the file fails with the same status.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_mesh_sink_add_vertices(
    sink: *mut MeshSink,
    vertices: *const f64,
    vertex_count: usize,
) -> StatusCode {
    change(sink, |sink| {
        let before = sink.mesh.vertices.len();
        check_count(before.saturating_add(vertex_count), "the number of vertices")?;
        // SAFETY: the header's pointer rules.
        let points = unsafe { read_vectors(vertices, vertex_count, "vertices") }?;
        for (i, point) in points.iter().enumerate() {
            check_vertex(before + i, point)?;
        }
        Ok(extend(&mut sink.mesh.vertices, points)?)
    })
}

/// Adds `face_count` faces to the mesh, numbered from 0 in order of addition. `indices` holds their vertex numbers, face after
/// face, counter-clockwise from outside. `valences` holds the number of vertices per face; null means triangles. Faces may name
/// vertices that are added later; this is checked when the callback returns. The arrays are copied.
///
/// On failure nothing is added, and the file is refused. SWIFTPROX_ERROR_LIMIT: too many faces or indices. SWIFTPROX_ERROR_MEMORY:
/// as for swiftprox_mesh_sink_add_vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_mesh_sink_add_faces(
    sink: *mut MeshSink,
    indices: *const u32,
    valences: *const u32,
    face_count: usize,
) -> StatusCode {
    change(sink, |sink| {
        check_count(sink.valences.len().saturating_add(face_count), "the number of faces")?;
        // SAFETY: the header's pointer rules.
        let Faces { indices, valences } = unsafe { read_faces(indices, valences, face_count) }?;
        check_count(sink.mesh.indices.len() + indices.len(), "the number of indices")?;
        reserve(&mut sink.mesh.indices, indices.len())?;
        reserve(&mut sink.valences, face_count)?;
        sink.mesh.indices.extend_from_slice(indices);
        match valences {
            Some(valences) => sink.valences.extend_from_slice(valences),
            None => sink.valences.resize(sink.valences.len() + face_count, 3),
        }
        Ok(())
    })
}

/// Marks the coordinates as single precision, like those of STL files. A vertex may then lie outside a face by 1e-6 of the
/// bounding-box diagonal, not 1e-9. A swiftprox_shape_options.convexity_tolerance overrides this.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_mesh_sink_set_single_precision(sink: *mut MeshSink) -> StatusCode {
    change(sink, |sink| {
        sink.mesh.single_precision = true;
        Ok(())
    })
}

/// Refuses the file, whatever the callback returns. `message` says what is wrong, best with the line; up to 4,096 bytes are copied.
/// The library adds the names of file and reader. The first message is kept. It replaces that of a failed call to the sink, except
/// for SWIFTPROX_ERROR_MEMORY.
///
/// SWIFTPROX_ERROR_NULL_POINTER: sink or message is null. A null message still refuses the file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_mesh_sink_fail(sink: *mut MeshSink, message: *const c_char) -> StatusCode {
    change(sink, |sink| {
        // SAFETY: the header's pointer rules.
        let message = unsafe { string(message, "message") }?.to_bytes();
        let shown = &message[..message.len().min(LONGEST_MESSAGE)];
        sink.said.get_or_insert_with(|| String::from_utf8_lossy(shown).into_owned());
        Ok(())
    })
}

/// Runs a call to a sink in the guard; the sink remembers the first that is refused.
fn change(sink: *mut MeshSink, body: impl FnOnce(&mut MeshSink) -> Checked<()>) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let sink = unsafe { exclusive(sink, "sink") }?;
        let done = body(sink);
        if let Err(Failure { status, message }) = &done {
            sink.refused.get_or_insert_with(|| (*status, message.clone()));
        }
        done
    })
}
