//! Readers of mesh files that the caller registers, and what such a reader hands its mesh to.

use std::ffi::{c_char, c_void};
use std::sync::Arc;

use super::arrays::{Faces, check_count, read_faces, read_vectors};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::{call_out, guard};
use super::pointers::{exclusive, string};
use crate::base::error::{Error, Result};
use crate::base::memory::{extend, reserve, with_capacity};
use crate::mesh::io::{register_mesh_reader, unregister_mesh_reader};
use crate::mesh::{PolygonMesh, check_vertex};

/// Receives the mesh that a swiftprox_mesh_reader_callback reads: vertices, faces, or why it has none. It is good during the call
/// of the callback, for its thread.
#[derive(Default)]
pub struct MeshSink {
    mesh: PolygonMesh,
    /// The valences of all faces; `mesh` becomes whole at the end.
    valences: Vec<u32>,
    /// What the reader says went wrong.
    said: Option<String>,
    /// The first of its calls that was refused, and whether that was for memory.
    refused: Option<(StatusCode, String)>,
}

/// Reads a mesh file: calls swiftprox_mesh_sink_add_vertices and swiftprox_mesh_sink_add_faces as often as it likes and returns 0;
/// or says what is wrong with the file by swiftprox_mesh_sink_fail. Anything but 0 refuses the file, too, and so does every call to
/// the sink that was refused, whether or not the callback has looked at its status.
///
/// `user` is the pointer given with the callback. `data` holds the `size` bytes of the whole file without a UTF-8 byte order mark:
/// it begins with the white space before the magic, if there is any, and the magic itself, which are the callback's to skip. Behind
/// them is one zero byte more, where strtod and its like end. (What strtod takes for the decimal point depends on LC_NUMERIC, the
/// program's locale: where that wants a comma it reads 0.5 as 0. The library's own readers take the point in every locale.) Data
/// and sink are gone when the callback returns; what the sink was given it has copied. The callback may call the library: read
/// other files, and register readers. It must return, and a C++ exception that leaves it ends the program.
pub type MeshReaderCallback = Option<
    unsafe extern "C-unwind" fn(user: *mut c_void, data: *const c_char, size: usize, sink: *mut MeshSink) -> i32,
>;

/// No more bytes of a message of a reader are kept.
const LONGEST_MESSAGE: usize = 4096;

/// A callback and its user pointer.
struct Reader {
    callback: unsafe extern "C-unwind" fn(*mut c_void, *const c_char, usize, *mut MeshSink) -> i32,
    user: *mut c_void,
}

// SAFETY: `user` is only ever handed back to the callback, which swiftprox_library_register_mesh_reader requires to be callable
// from every thread.
unsafe impl Send for Reader {}
// SAFETY: as above.
unsafe impl Sync for Reader {}

impl Reader {
    /// What the callback makes of a file.
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

/// Registers a reader of mesh files, which swiftprox_shape_create_from_file calls for every file that
/// begins with the bytes of `magic`, a string that is copied, behind white space and a UTF-8 byte order mark: whatever the
/// extension of the file is, and before the built-in readers for TRI, POLY, OFF, OBJ and STL, which a magic such as "OFF" replaces.
/// The first bytes alone count: "PLY" is the magic of a file that begins with PLYMOUTH, too. The callback is handed what was
/// skipped and the magic with the rest of the file, all but the byte order mark.
///
/// The registry is the process's own; it may be changed at any time from any thread, from a callback as well. A reader registered
/// under a magic that has one replaces it, a null callback takes it back (and may do nothing). The callback may be
/// called from every thread that reads files, from several at once. `user` must be good until the reader is replaced or taken back
/// and no other thread is still reading a file by it.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: magic is empty or begins with white space or a byte order mark, which are skipped in files; or
/// it begins with the magic of another reader, or that one with it: a file could be for both. SWIFTPROX_ERROR_MEMORY.
/// SWIFTPROX_ERROR_NULL_POINTER: magic is null.
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
        let reader = Reader { callback, user };
        Ok(register_mesh_reader(magic, Arc::new(move |bytes| reader.read(bytes)))?)
    })
}

/// Adds `vertex_count` vertices, 3 coordinates each, to the mesh that a callback reads. They are numbered from 0 in the order in
/// which they are added. The array is copied.
///
/// SWIFTPROX_ERROR_MESH: a coordinate is not finite; the message names the vertex. SWIFTPROX_ERROR_LIMIT: too many vertices.
/// SWIFTPROX_ERROR_MEMORY, which is then the status of what reads the file, too.
/// SWIFTPROX_ERROR_NULL_POINTER: sink is null, or vertices while vertex_count is not 0. Nothing is added, and the file is refused.
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

/// Adds `face_count` faces to the mesh that a callback reads: `indices` holds the numbers of their vertices, one face after the
/// other, each counter-clockwise seen from outside; `valences` the number of vertices of each face, or null when all are triangles.
/// They are numbered from 0 in the order in which they are added. A face may name vertices that are added later: that they exist is
/// checked when the callback returns. The arrays are copied.
///
/// SWIFTPROX_ERROR_LIMIT: too many faces or indices. SWIFTPROX_ERROR_MEMORY: as of swiftprox_mesh_sink_add_vertices.
/// SWIFTPROX_ERROR_NULL_POINTER: sink is null, or indices while there are any. Nothing is added, and the file is refused.
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

/// Says that the coordinates of the file went through single precision, as those of STL files have: how far a vertex may lie
/// outside a face is then 1e-6 of the bounding-box diagonal, not 1e-9, unless swiftprox_shape_options.convexity_tolerance says
/// otherwise.
///
/// SWIFTPROX_ERROR_NULL_POINTER: sink is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_mesh_sink_set_single_precision(sink: *mut MeshSink) -> StatusCode {
    change(sink, |sink| {
        sink.mesh.single_precision = true;
        Ok(())
    })
}

/// Refuses the file that a callback reads, whatever the callback returns. `message`, a string of which up to 4,096 bytes are
/// copied, says what is wrong, best with the line; the library adds which file and which reader. The first message holds, also
/// where a call to the sink was refused before, unless that was for memory.
///
/// SWIFTPROX_ERROR_NULL_POINTER: sink or message is null; the file is refused all the same if sink is not.
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
